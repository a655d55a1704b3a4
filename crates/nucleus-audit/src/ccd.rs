//! Continuous collision test of one pair: does a point pass through a face, or an edge through an edge, while their
//! points move linearly?
//!
//! Three stages of increasing cost, each for fewer pairs: a separating plane; signs of the coplanarity cubic and of the
//! inside quartics (see [`Coplanarity`]) by bisection with certified error bounds; exact integer arithmetic.

use nalgebra::Vector3;

use crate::coplanarity::Coplanarity;
use crate::exact;
use crate::float_filter::{Bernstein, FilteredPolynomial};
use crate::pair::{CcdResult, Corners, PairKind};

/// Bisection depth after which integers decide: beyond it the error bounds exceed the coefficients.
const MAX_DEPTH: u32 = 24;

/// Number of time intervals that bisection visits before integers decide.
const MAX_INTERVALS: u32 = 96;

/// Bounds the rounding of the slack along an axis.
const SLACK_ROUNDING: f64 = 1.0 + 1e-12;

/// The result of a pair while its points move linearly from `before` to `after`, in the order that [`PairKind`] states.
/// Exact: the bits of the input decide.
pub fn ccd(kind: PairKind, before: &Corners, after: &Corners) -> CcdResult {
    let all = before.iter().chain(after).flat_map(|corner| corner.iter());
    if !all.clone().all(|x| x.is_finite()) {
        return CcdResult::Undecided;
    }
    let vectors = [before, after].map(|corners| vectors(kind, corners));
    if has_separating_plane(kind, &vectors, 0.0) {
        return CcdResult::Separated;
    }
    match classify_by_bisection(kind, &vectors) {
        Some(result) => result,
        None => exact::ccd(kind, before, after),
    }
}

/// Whether a plane certifiably separates a pair during a linear motion, even if the distance of any two points is
/// smaller by `slack` along every axis.
pub fn separated_throughout(kind: PairKind, [before, after]: [&Corners; 2], slack: f64) -> bool {
    has_separating_plane(kind, &[vectors(kind, before), vectors(kind, after)], slack)
}

/// The three vectors of [`Coplanarity`].
fn vectors(kind: PairKind, corners: &Corners) -> [Vector3<f64>; 3] {
    match (kind, corners) {
        (PairKind::PointFace, [p, a, b, c]) => [b - a, c - a, p - a],
        (PairKind::EdgeEdge, [a, b, c, d]) => [b - a, d - c, c - a],
    }
}

/// Whether a plane that translates with the first element separates the two. Heights over it are linear in time, so
/// both ends of the motion suffice.
fn has_separating_plane(kind: PairKind, vectors: &[[Vector3<f64>; 3]; 2], slack: f64) -> bool {
    let [first, second, third] = std::array::from_fn(|k| 0.5 * (vectors[0][k] + vectors[1][k]));
    // From centre to centre: separates max neighbouring pairs.
    let centres = match kind {
        PairKind::PointFace => third - (first + second) / 3.0,
        PairKind::EdgeEdge => third + 0.5 * (second - first),
    };
    let separates = |axis: &Vector3<f64>| separates(kind, vectors, axis, slack);
    if separates(&centres) {
        return true;
    }
    let normal = first.cross(&second);
    if separates(&normal) {
        return true;
    }
    match kind {
        PairKind::PointFace => {
            // Planes through an edge, perpendicular to the face.
            let sides = [first, second, second - first];
            sides.iter().any(|side| separates(&normal.cross(side)))
        }
        PairKind::EdgeEdge => [first, second].iter().any(|edge| {
            let across = edge.cross(&centres);
            separates(&edge.cross(&across))
        }),
    }
}

fn separates(kind: PairKind, vectors: &[[Vector3<f64>; 3]; 2], axis: &Vector3<f64>, slack: f64) -> bool {
    let mut min = f64::INFINITY;
    let mut max = f64::NEG_INFINITY;
    let mut size = 0.0_f64;
    for [first, second, third] in vectors {
        let heights = [first, second, third].map(|vector| axis.dot(vector));
        size = [first, second, third].iter().fold(size, |size, vector| size.max(vector.amax()));
        let [x, y, z] = heights;
        // Heights of all points of the second element over all points of the first.
        let all = match kind {
            PairKind::PointFace => [z, z - x, z - y, z],
            PairKind::EdgeEdge => [z, z - x, z + y, z + y - x],
        };
        min = all.iter().fold(min, |min, height| min.min(*height));
        max = all.iter().fold(max, |max, height| max.max(*height));
    }
    // Vectors are rounded once, each height five times, their sums twice: below 32 roundings.
    let rounding = 32.0 * f64::EPSILON * axis.amax() * size + f64::MIN_POSITIVE;
    let error = rounding + SLACK_ROUNDING * slack * (axis.x.abs() + axis.y.abs() + axis.z.abs());
    min > error || max < -error
}

/// Decides by bisection; `None` where the signs cannot be certified.
fn classify_by_bisection(kind: PairKind, vectors: &[[Vector3<f64>; 3]; 2]) -> Option<CcdResult> {
    let [start, end] = vectors;
    let moving =
        |k: usize| std::array::from_fn(|axis| FilteredPolynomial::linear(start[k][axis], end[k][axis]));
    let pair = Coplanarity::new(kind, [moving(0), moving(1), moving(2)]);
    let volume = pair.volume().bernstein();
    if volume.is_positive() || volume.is_negative() {
        return Some(CcdResult::Separated);
    }
    let inside = pair.inside().map(|estimate| estimate.bernstein());
    let mut search = Search { intervals: 0, open: false };
    match search.first_crossing(&volume, &inside, [0.0, 1.0], 0) {
        Some(at) => Some(CcdResult::Crossing { at }),
        None if search.open => None,
        None => Some(CcdResult::Separated),
    }
}

struct Search {
    intervals: u32,
    /// Whether a time interval remained undecided.
    open: bool,
}

impl Search {
    /// The first certified crossing in a time interval.
    fn first_crossing(
        &mut self,
        volume: &Bernstein,
        inside: &[Bernstein; 4],
        interval: [f64; 2],
        depth: u32,
    ) -> Option<f64> {
        self.intervals += 1;
        if volume.is_positive() || volume.is_negative() || inside.iter().any(Bernstein::is_negative) {
            return None;
        }
        let middle = 0.5 * (interval[0] + interval[1]);
        if volume.changes_sign() && inside.iter().all(Bernstein::is_positive) {
            return Some(middle);
        }
        if depth == MAX_DEPTH || self.intervals > MAX_INTERVALS {
            self.open = true;
            return None;
        }
        let [early, late] = volume.halves();
        let halves = inside.map(|condition| condition.halves());
        self.first_crossing(&early, &halves.map(|[early, _]| early), [interval[0], middle], depth + 1)
            .or_else(|| {
                self.first_crossing(&late, &halves.map(|[_, late]| late), [middle, interval[1]], depth + 1)
            })
    }
}

#[cfg(test)]
mod tests;
