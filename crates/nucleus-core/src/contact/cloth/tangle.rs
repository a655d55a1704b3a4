//! Meshes that pass through each other, because the scene began so or nothing helped: found, let go, and worked apart.
//!
//! Where an edge goes through a face, the curve in which the two surfaces cut each other crosses that edge, and one of its
//! ends is on the wrong side. Of two cloths that is told by where most of the first is. Of one cloth it is the piece that
//! the curve cuts off, if it does, the smallest (after Baraff, Witkin and Kass 2003, *Untangling cloth*). Those ends are
//! led back through the faces. Where no piece of a cloth is cut off, edge and face are moved so that the curve grows
//! shorter (Volino and Magnenat-Thalmann 2006, *Resolving surface collisions through intersection contour minimization*).
//! Pass the curve nothing is kept apart: contacts would hold the tangle as it is.

use super::near::Motion;
use crate::bytes::checkpoint_struct;
use crate::math::{Real, Row4, add, cross, dot, scale, sub, unit};

/// Metres.
type Vector = [f64; 3];

/// Edge lengths by which an edge and a face are worked apart in a second: half of one in a film frame.
pub const SPEED: f64 = 12.0;
/// How far an end is led, in its depth behind the face.
const BEYOND: f64 = 1.25;
/// Cosine between an edge and a face's normal below which it counts as that: along the face there is no way out.
const LEAST_SLANT: f64 = 0.1;

/// An edge that goes through a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crossing {
    /// The edge.
    pub edge: [u32; 2],
    /// The third point of each face at the edge; the first of the edge where there is none.
    pub wings: [u32; 2],
    /// The face.
    pub face: [u32; 3],
    /// What is done about it.
    pub remedy: Remedy,
}

/// How an edge and a face are worked apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remedy {
    /// This end of the edge goes back to the side of the other.
    Back(usize),
    /// The curve is made shorter.
    Shorten,
    /// Nothing: others of the same curve do it.
    Wait,
}

/// A face beside an edge: the edge's ends, the lower first; the third point; whether the face runs along the edge from
/// the lower end to the higher.
pub type Wing = ([u32; 2], u32, bool);

/// All that passes through each other.
#[derive(Debug, Clone, Default)]
pub struct Tangle {
    /// Edges in faces.
    pub crossings: Vec<Crossing>,
    /// Whether a point is near one: a corner of it, or joined to one by an edge.
    pub points: Vec<bool>,
    /// The cloths that pass through each other, the lower index first.
    pub(super) pairs: Vec<[u32; 2]>,
    /// Whether a point is on the wrong side of something.
    pub(super) is_wrong: Vec<bool>,
    /// Of two cloths that pass through each other, whether the first belongs on the outer side of the second.
    pub(super) sides: Vec<([u32; 2], bool)>,
    /// Whether there may be any that have not been looked for.
    pub is_suspected: bool,
    /// The third point of each face beside each edge, sorted; made when the first crossing is found.
    pub(super) wings: Vec<Wing>,
}

checkpoint_struct!([] Tangle {
    columns: [points, is_wrong],
    values: [crossings, pairs, sides, is_suspected],
    parts: [],
    rebuilt: [wings],
});

impl Tangle {
    /// None known yet; the start is looked at.
    pub fn new(rows: usize) -> Self {
        Self {
            crossings: Vec::new(),
            points: vec![false; rows],
            is_wrong: vec![false; rows],
            sides: Vec::new(),
            pairs: Vec::new(),
            is_suspected: true,
            wings: Vec::new(),
        }
    }

    /// Whether there is any.
    pub fn is_there(&self) -> bool {
        !self.crossings.is_empty()
    }

    /// The cloths that pass through each other, the lower index first.
    pub fn pairs(&self) -> &[[u32; 2]] {
        if self.is_there() { &self.pairs } else { &[] }
    }

    /// Whether any is known, or to be looked for.
    pub fn may_be_there(&self) -> bool {
        self.is_suspected || self.is_there()
    }

    /// Whether a pair of elements of two cloths is let alone, because both are near where these pass through each other.
    #[inline(always)]
    pub fn lets_pass(&self, ours: &[u32], theirs: &[u32], cloths: [u32; 2]) -> bool {
        let is_near = |points: &[u32]| points.iter().any(|&point| self.points[point as usize]);
        let [low, high] = [cloths[0].min(cloths[1]), cloths[0].max(cloths[1])];
        self.is_there() && self.pairs.contains(&[low, high]) && is_near(ours) && is_near(theirs)
    }

    /// Works every crossing that is still there a step farther apart, by `most` metres at most, or more where the scene
    /// pushes. `cloth` says for each point of which cloth it is.
    pub fn work_apart<R: Real>(&self, anchors: &[Vector], step: &Motion<'_, R>, cloth: &[u32], most: f64) {
        let cloths = step.terms.len().isqrt();
        for crossing in &self.crossings {
            let [ours, theirs] =
                [crossing.edge[0], crossing.face[0]].map(|point| cloth[point as usize] as usize);
            let terms = &step.terms[ours * cloths + theirs];
            let pace = terms.as_ref().map_or(1.0, |terms| terms.untangling);
            crossing.work_apart(anchors, step, most * pace);
        }
    }
}

/// Where an edge goes through a face.
struct Cut {
    /// The place, as weights of the edge's ends and of the face's corners.
    weights: ([f64; 2], [f64; 3]),
    /// Of the face, of unit length.
    normal: Vector,
}

/// Where a segment goes through a triangle; nothing where it does not.
fn cut([a, b]: [Vector; 2], [p, q, r]: [Vector; 3]) -> Option<Cut> {
    let normal = unit(cross(sub(q, p), sub(r, p)), 0.0)?;
    let (from, to) = (dot(normal, sub(a, p)), dot(normal, sub(b, p)));
    if from * to >= 0.0 {
        return None;
    }
    let share = from / (from - to);
    let place = add(a, scale(sub(b, a), share));
    let area = |u: Vector, v: Vector| dot(normal, cross(sub(u, place), sub(v, place)));
    let parts = [area(q, r), area(r, p), area(p, q)];
    let all: f64 = parts.into_iter().sum();
    let is_inside = all > 0.0 && parts.into_iter().all(|part| part >= 0.0);
    is_inside.then(|| Cut { weights: ([1.0 - share, share], parts.map(|part| part / all)), normal })
}

/// Whether a segment goes through a triangle.
pub fn goes_through(edge: [Vector; 2], face: [Vector; 3]) -> bool {
    cut(edge, face).is_some()
}

impl Crossing {
    /// Works the two apart by `most` metres at most, if the one still goes through the other.
    fn work_apart<R: Real>(&self, anchors: &[Vector], step: &Motion<'_, R>, most: f64) {
        let place = |point: u32| add(anchors[point as usize], step.row(point).xyz().map(R::to_f64));
        let ends = self.edge.map(place);
        let Some(cut) = cut(ends, self.face.map(place)) else { return };
        match self.remedy {
            Remedy::Wait => {}
            Remedy::Back(end) => self.lead_back(end, step, ends, cut, most),
            Remedy::Shorten => self.shorten(step, ends, self.wings.map(place), &cut, most),
        }
    }

    /// Leads one end to the other's side of the face.
    fn lead_back<R: Real>(
        &self,
        end: usize,
        step: &Motion<'_, R>,
        ends: [Vector; 2],
        mut cut: Cut,
        most: f64,
    ) {
        let depth = BEYOND * dot(cut.normal, sub(ends[1 - end], ends[end])) * cut.weights.0[1 - end];
        cut.weights.0 = [0.0; 2];
        cut.weights.0[end] = 1.0;
        self.shift(step, &cut, scale(cut.normal, depth.clamp(-most, most)));
    }

    /// Moves the place where the edge goes through the face inward, so that the curve grows shorter.
    fn shorten<R: Real>(
        &self,
        step: &Motion<'_, R>,
        ends: [Vector; 2],
        wings: [Vector; 2],
        cut: &Cut,
        most: f64,
    ) {
        let Some(along) = unit(sub(ends[1], ends[0]), 0.0) else { return };
        let wings = wings.into_iter().zip(self.wings).filter(|(_, point)| *point != self.edge[0]);
        let inward = wings.filter_map(|(wing, _)| into_wing(sub(wing, ends[0]), along, cut.normal));
        let inward = inward.fold([0.0; 3], add);
        let slant = dot(along, cut.normal);
        let slant = slant.abs().max(LEAST_SLANT).copysign(slant);
        let way = sub(inward, scale(cut.normal, dot(inward, along) / slant));
        // A curve that goes straight on has no shorter way.
        let share = dot(inward, inward).sqrt().min(1.0);
        if let Some(direction) = unit(way, 1e-9) {
            self.shift(step, cut, scale(direction, most * share));
        }
    }

    /// Moves edge and face by so much against each other, each by its mobility, without velocity.
    fn shift<R: Real>(&self, step: &Motion<'_, R>, cut: &Cut, way: Vector) {
        let (ours, theirs) = &cut.weights;
        let edge = self.edge.iter().zip(ours).map(|(&point, &weight)| (point, weight));
        let sides = edge.chain(self.face.iter().zip(theirs).map(|(&point, &weight)| (point, -weight)));
        let mobility = |point: u32| step.row(point).0[3].to_f64();
        let all: f64 = sides.clone().map(|(point, weight)| mobility(point) * weight * weight).sum();
        if all <= 0.0 {
            return;
        }
        for (point, weight) in sides {
            let moved = scale(way, mobility(point) * weight / all).map(R::from_f64);
            let row = step.row(point);
            let [x, y, z] = add(row.xyz(), moved);
            step.mover.part(point, Row4([x, y, z, row.0[3]]), moved);
        }
    }
}

/// Into which direction the curve goes on through a face beside the edge, along the face that the edge goes through.
fn into_wing(wing: Vector, along: Vector, normal: Vector) -> Option<Vector> {
    let inward = sub(wing, scale(along, dot(wing, along)));
    let curve = unit(cross(cross(along, inward), normal), 0.0)?;
    Some(if dot(curve, inward) < 0.0 { scale(curve, -1.0) } else { curve })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_goes_through_a_triangle_or_beside_it() {
        let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(goes_through([[0.2, 0.2, -1.0], [0.2, 0.2, 1.0]], face));
        assert!(!goes_through([[0.8, 0.8, -1.0], [0.8, 0.8, 1.0]], face), "beside it");
        assert!(!goes_through([[0.2, 0.2, 0.5], [0.2, 0.2, 1.0]], face), "above it");
    }
}
