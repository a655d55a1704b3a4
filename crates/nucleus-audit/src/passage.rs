//! Whether a point passes through a face, or an edge through an edge, while their points go straight from one
//! state to the next.
//!
//! Three stages, each dearer and for fewer pairs: a plane between the two that stays between them; signs of the
//! cubic and the quartics of [`Coplanarity`] by bisection, with certified bounds; the same in integers.

use nalgebra::Vector3;

use crate::coplanarity::Coplanarity;
use crate::estimate::{Bernstein, Estimate};
use crate::exact;

/// Halvings after which integers decide: beyond, the bounds of the coefficients outweigh what is left of them.
const HALVINGS: u32 = 24;

/// Spans that are looked at before integers decide.
const SPANS: u32 = 96;

/// Pays for the rounding of what slack comes to along an axis.
const SLACK_ROUNDING: f64 = 1.0 + 1e-12;

/// The two ways in which surfaces pass through each other (N2.3-3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A point and a face: `[p, a, b, c]`.
    PointFace,
    /// Two edges: `[a, b, c, d]`.
    EdgeEdge,
}

/// What a pair does in a motion. Times are shares of the motion, for people to read; they decide nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Passage {
    /// They do not meet.
    Apart,
    /// They change sides.
    Crosses {
        /// The first time that it happens.
        at: f64,
    },
    /// They touch and do not change sides; also where they touch at the very start or end, or slide in a plane.
    Touches {
        /// When.
        at: f64,
    },
    /// They meet when the face has no area, when the edges are parallel, or the input is not finite.
    Undecided,
}

/// Four points at one time.
pub type Corners = [Vector3<f64>; 4];

/// What a pair does while its points go from `before` to `after`, in the order that [`Kind`] names.
/// Exact: the bits of the input decide.
pub fn passage(kind: Kind, before: &Corners, after: &Corners) -> Passage {
    let all = before.iter().chain(after).flat_map(|corner| corner.iter());
    if !all.clone().all(|x| x.is_finite()) {
        return Passage::Undecided;
    }
    let vectors = [before, after].map(|corners| vectors(kind, corners));
    if has_plane_between(kind, &vectors, 0.0) {
        return Passage::Apart;
    }
    match by_bisection(kind, &vectors) {
        Some(passage) => passage,
        None => exact::passage(kind, before, after),
    }
}

/// Whether a plane is proven to keep a pair apart while its points go from one set of places to the other, and each
/// pair of points may be nearer to each other by `slack` along every axis at any time.
pub fn are_kept_apart(kind: Kind, [before, after]: [&Corners; 2], slack: f64) -> bool {
    has_plane_between(kind, &[vectors(kind, before), vectors(kind, after)], slack)
}

/// The vectors of [`Coplanarity`].
fn vectors(kind: Kind, corners: &Corners) -> [Vector3<f64>; 3] {
    match (kind, corners) {
        (Kind::PointFace, [p, a, b, c]) => [b - a, c - a, p - a],
        (Kind::EdgeEdge, [a, b, c, d]) => [b - a, d - c, c - a],
    }
}

/// Whether some plane that is carried along with the first element, without turning, keeps the two apart.
/// What is linear in time has its extremes at the ends.
fn has_plane_between(kind: Kind, vectors: &[[Vector3<f64>; 3]; 2], slack: f64) -> bool {
    let [first, second, third] = std::array::from_fn(|k| 0.5 * (vectors[0][k] + vectors[1][k]));
    // From middle to middle: good for most pairs that are only neighbours.
    let middles = match kind {
        Kind::PointFace => third - (first + second) / 3.0,
        Kind::EdgeEdge => third + 0.5 * (second - first),
    };
    let is_between = |axis: &Vector3<f64>| is_between(kind, vectors, axis, slack);
    if is_between(&middles) {
        return true;
    }
    let normal = first.cross(&second);
    if is_between(&normal) {
        return true;
    }
    match kind {
        Kind::PointFace => {
            // Through the edges, at right angles to the face.
            let sides = [first, second, second - first];
            sides.iter().any(|side| is_between(&normal.cross(side)))
        }
        Kind::EdgeEdge => [first, second].iter().any(|edge| {
            let across = edge.cross(&middles);
            is_between(&edge.cross(&across))
        }),
    }
}

fn is_between(kind: Kind, vectors: &[[Vector3<f64>; 3]; 2], axis: &Vector3<f64>, slack: f64) -> bool {
    let mut least = f64::INFINITY;
    let mut most = f64::NEG_INFINITY;
    let mut reach = 0.0_f64;
    for [first, second, third] in vectors {
        let heights = [first, second, third].map(|vector| axis.dot(vector));
        reach = [first, second, third].iter().fold(reach, |reach, vector| reach.max(vector.amax()));
        let [x, y, z] = heights;
        // Every height of the second element above every one of the first.
        let all = match kind {
            Kind::PointFace => [z, z - x, z - y, z],
            Kind::EdgeEdge => [z, z - x, z + y, z + y - x],
        };
        least = all.iter().fold(least, |least, height| least.min(*height));
        most = all.iter().fold(most, |most, height| most.max(*height));
    }
    // Vectors are rounded once, each height five times, their sums twice: below 32 roundings.
    let rounding = 32.0 * f64::EPSILON * axis.amax() * reach + f64::MIN_POSITIVE;
    let error = rounding + SLACK_ROUNDING * slack * (axis.x.abs() + axis.y.abs() + axis.z.abs());
    least > error || most < -error
}

/// Signs by bisection; nothing where they cannot be certified.
fn by_bisection(kind: Kind, vectors: &[[Vector3<f64>; 3]; 2]) -> Option<Passage> {
    let [start, end] = vectors;
    let moving = |k: usize| std::array::from_fn(|axis| Estimate::linear(start[k][axis], end[k][axis]));
    let pair = Coplanarity::new(kind, [moving(0), moving(1), moving(2)]);
    let volume = pair.volume().bernstein();
    if volume.is_positive() || volume.is_negative() {
        return Some(Passage::Apart);
    }
    let inside = pair.inside().map(|estimate| estimate.bernstein());
    let mut search = Search { spans: 0, open: false };
    match search.look(&volume, &inside, [0.0, 1.0], 0) {
        Some(at) => Some(Passage::Crosses { at }),
        None if search.open => None,
        None => Some(Passage::Apart),
    }
}

struct Search {
    spans: u32,
    /// Some span could not be decided.
    open: bool,
}

impl Search {
    /// The first proven crossing in a span.
    fn look(
        &mut self,
        volume: &Bernstein,
        inside: &[Bernstein; 4],
        span: [f64; 2],
        depth: u32,
    ) -> Option<f64> {
        self.spans += 1;
        if volume.is_positive() || volume.is_negative() || inside.iter().any(Bernstein::is_negative) {
            return None;
        }
        let middle = 0.5 * (span[0] + span[1]);
        if volume.changes_sign() && inside.iter().all(Bernstein::is_positive) {
            return Some(middle);
        }
        if depth == HALVINGS || self.spans > SPANS {
            self.open = true;
            return None;
        }
        let [early, late] = volume.halves();
        let halves = inside.map(|condition| condition.halves());
        self.look(&early, &halves.map(|[early, _]| early), [span[0], middle], depth + 1)
            .or_else(|| self.look(&late, &halves.map(|[_, late]| late), [middle, span[1]], depth + 1))
    }
}

#[cfg(test)]
mod tests;
