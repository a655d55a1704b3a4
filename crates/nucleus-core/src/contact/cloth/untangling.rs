//! Untangling of intersecting meshes: scenes that start so, and pairs that the safeguard accepted.
//!
//! Where an edge pierces a face, the intersection contour crosses that edge, and one of its ends is on the wrong
//! side. Between two cloths, the right side is where most of the first is. Within one cloth, the smallest piece
//! that the contour cuts off is on the wrong side (after Baraff, Witkin and Kass 2003, *Untangling cloth*). Those
//! ends return through the faces. Where the contour cuts no piece off, edge and face move so that it shrinks
//! (Volino and Magnenat-Thalmann 2006, *Resolving surface collisions through intersection contour minimization*).
//! Contacts near a contour are disabled, because they would lock it.

use crate::bytes::checkpoint_struct;
use crate::contact::cloth::contact::ClothStep;
use crate::contact::cloth::elements::ElementGroups;
use crate::contact::response::Mobility;
use crate::math::{Real, Row4, add, cross, dot, scale, sub, unit};

/// In metres.
type Vector = [f64; 3];

/// Speed of untangling in edge lengths per second: half of one in a film frame.
pub const UNTANGLING_SPEED: f64 = 12.0;
/// Motion of an end, as a factor on its depth behind the face.
const OVERSHOOT: f64 = 1.25;
/// Smallest cosine between an edge and a face's normal: an edge parallel to the face gives no direction.
const MIN_SLANT: f64 = 0.1;

/// An edge that pierces a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Intersection {
    /// The edge.
    pub edge: [u32; 2],
    /// The third point of each face at the edge; the edge's first point where there is none.
    pub wings: [u32; 2],
    /// The face.
    pub face: [u32; 3],
    /// The chosen correction.
    pub correction: Correction,
}

/// How an intersection is corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Correction {
    /// This end of the edge returns to the side of the other.
    ReturnEnd(usize),
    /// The contour becomes shorter.
    ShortenContour,
    /// None: other intersections of the same contour are corrected.
    None,
}

/// A face at an edge: the edge's ends, the lower first; the third point; whether the face runs along the edge
/// from the lower end to the higher.
pub type Wing = ([u32; 2], u32, bool);

/// All intersections.
#[derive(Debug, Clone, Default)]
pub struct Untangling {
    /// Edges that pierce faces.
    pub intersections: Vec<Intersection>,
    /// Whether a point is a corner of an intersection, or joined to one by an edge.
    pub near_contour: Vec<bool>,
    /// Pairs of intersecting cloths, the lower index first.
    pub(super) cloth_pairs: Vec<[u32; 2]>,
    /// Whether a point is on the wrong side of a contour.
    pub(super) is_on_wrong_side: Vec<bool>,
    /// For two intersecting cloths, whether the first belongs on the outer side of the second.
    pub(super) sides: Vec<([u32; 2], bool)>,
    /// Whether each cloth may have intersections that no search has found.
    pub is_search_due: Vec<bool>,
    /// The faces at each edge, sorted; built when the first intersection is found.
    pub(super) wings: Vec<Wing>,
    /// Edge and face of each intersection of the last search, sorted: a buffer.
    pub(super) known: Vec<([u32; 2], [u32; 3])>,
}

checkpoint_struct!([] Untangling {
    columns: [near_contour, is_on_wrong_side, is_search_due],
    values: [intersections, cloth_pairs, sides],
    parts: [],
    rebuilt: [wings, known],
});

impl Untangling {
    /// No intersections yet; the start of all cloths is searched.
    pub fn new(rows: usize, cloths: usize) -> Self {
        Self {
            intersections: Vec::new(),
            near_contour: vec![false; rows],
            is_on_wrong_side: vec![false; rows],
            sides: Vec::new(),
            cloth_pairs: Vec::new(),
            is_search_due: vec![true; cloths],
            wings: Vec::new(),
            known: Vec::new(),
        }
    }

    /// Whether any is known.
    pub fn any(&self) -> bool {
        !self.intersections.is_empty()
    }

    /// Pairs of intersecting cloths, the lower index first.
    pub fn cloth_pairs(&self) -> &[[u32; 2]] {
        if self.any() { &self.cloth_pairs } else { &[] }
    }

    /// Whether any is known, or a search is due.
    pub fn may_exist(&self) -> bool {
        self.is_search_due.contains(&true) || self.any()
    }

    /// Whether contacts between two elements are disabled: both are near a contour of their cloths.
    #[inline(always)]
    pub fn is_disabled(&self, ours: &[u32], theirs: &[u32], cloths: [u32; 2]) -> bool {
        let is_near = |points: &[u32]| points.iter().any(|&point| self.near_contour[point as usize]);
        let [low, high] = [cloths[0].min(cloths[1]), cloths[0].max(cloths[1])];
        self.any() && self.cloth_pairs.contains(&[low, high]) && is_near(ours) && is_near(theirs)
    }

    /// Applies the corrections of all intersections that persist, at [`UNTANGLING_SPEED`] and the untangling rate of the
    /// material, in the shorter edge length of the two cloths. The time step has `h` seconds.
    pub fn untangle<R: Real>(&self, step: &ClothStep<'_, R>, elements: &ElementGroups, h: f64) {
        for intersection in &self.intersections {
            let [ours, theirs] = [intersection.edge[0], intersection.face[0]]
                .map(|point| elements.cloth[point as usize] as usize);
            if !step.mask.is_empty() && !step.mask[ours] {
                continue;
            }
            let material = &step.materials[[ours, theirs]];
            let rate = material.as_ref().map_or(1.0, |material| material.untangling_rate);
            let edge_length = elements.edge_lengths[ours].min(elements.edge_lengths[theirs]);
            intersection.untangle(step, edge_length * UNTANGLING_SPEED * h * rate);
        }
    }
}

/// The point where an edge pierces a face.
struct Piercing {
    /// The point, as weights of the edge's ends and of the face's corners.
    weights: ([f64; 2], [f64; 3]),
    /// Unit normal of the face.
    normal: Vector,
}

/// The point where a segment pierces a triangle; `None` where it does not.
fn piercing([a, b]: [Vector; 2], [p, q, r]: [Vector; 3]) -> Option<Piercing> {
    let normal = unit(cross(sub(q, p), sub(r, p)), 0.0)?;
    let (from, to) = (dot(normal, sub(a, p)), dot(normal, sub(b, p)));
    if from * to >= 0.0 {
        return None;
    }
    let share = from / (from - to);
    let position = add(a, scale(sub(b, a), share));
    let area = |u: Vector, v: Vector| dot(normal, cross(sub(u, position), sub(v, position)));
    let parts = [area(q, r), area(r, p), area(p, q)];
    let all: f64 = parts.into_iter().sum();
    let is_inside = all > 0.0 && parts.into_iter().all(|part| part >= 0.0);
    is_inside.then(|| Piercing { weights: ([1.0 - share, share], parts.map(|part| part / all)), normal })
}

/// Whether a segment pierces a triangle.
pub fn pierces(edge: [Vector; 2], face: [Vector; 3]) -> bool {
    piercing(edge, face).is_some()
}

impl Intersection {
    /// Corrects the intersection by `most` metres at most, if it persists.
    fn untangle<R: Real>(&self, step: &ClothStep<'_, R>, most: f64) {
        let position = |point: u32| add(step.origins[point as usize], step.row(point).xyz().map(R::to_f64));
        let ends = self.edge.map(position);
        let Some(piercing) = piercing(ends, self.face.map(position)) else { return };
        match self.correction {
            Correction::None => {}
            Correction::ReturnEnd(end) => self.return_end(end, step, ends, piercing, most),
            Correction::ShortenContour => {
                self.shorten_contour(step, ends, self.wings.map(position), &piercing, most)
            }
        }
    }

    /// Moves one end to the other's side of the face.
    fn return_end<R: Real>(
        &self,
        end: usize,
        step: &ClothStep<'_, R>,
        ends: [Vector; 2],
        mut piercing: Piercing,
        most: f64,
    ) {
        let depth =
            OVERSHOOT * dot(piercing.normal, sub(ends[1 - end], ends[end])) * piercing.weights.0[1 - end];
        piercing.weights.0 = [0.0; 2];
        piercing.weights.0[end] = 1.0;
        self.displace(step, &piercing, scale(piercing.normal, depth.clamp(-most, most)));
    }

    /// Moves the intersection point along the face, so that the contour becomes shorter.
    fn shorten_contour<R: Real>(
        &self,
        step: &ClothStep<'_, R>,
        ends: [Vector; 2],
        wings: [Vector; 2],
        piercing: &Piercing,
        most: f64,
    ) {
        let Some(along) = unit(sub(ends[1], ends[0]), 0.0) else { return };
        let wings = wings.into_iter().zip(self.wings).filter(|(_, point)| *point != self.edge[0]);
        let inward = wings.filter_map(|(wing, _)| into_wing(sub(wing, ends[0]), along, piercing.normal));
        let inward = inward.fold([0.0; 3], add);
        let slant = dot(along, piercing.normal);
        let slant = slant.abs().max(MIN_SLANT).copysign(slant);
        let motion = sub(inward, scale(piercing.normal, dot(inward, along) / slant));
        // A straight contour cannot become shorter.
        let share = dot(inward, inward).sqrt().min(1.0);
        if let Some(direction) = unit(motion, 1e-9) {
            self.displace(step, piercing, scale(direction, most * share));
        }
    }

    /// Moves edge and face relative to each other by `motion` metres, each by its mobility, without velocity.
    fn displace<R: Real>(&self, step: &ClothStep<'_, R>, piercing: &Piercing, motion: Vector) {
        let (ours, theirs) = piercing.weights;
        let inverse_mass = |point: u32| step.row(point).0[3].to_f64();
        let (edge, face) = (self.edge.map(inverse_mass), self.face.map(inverse_mass));
        let all = Mobility::of(edge, ours).and(Mobility::of(face, theirs)).total();
        if all <= 0.0 {
            return;
        }
        let of_edge = (0..2).map(|k| (self.edge[k], edge[k] * ours[k]));
        let of_face = (0..3).map(|k| (self.face[k], -(face[k] * theirs[k])));
        for (point, mobile) in of_edge.chain(of_face) {
            let moved = scale(motion, mobile / all).map(R::from_f64);
            let row = step.row(point);
            let [x, y, z] = add(row.xyz(), moved);
            step.writer.push(point, Row4([x, y, z, row.0[3]]), moved);
        }
    }
}

/// The direction in which the contour continues through a wing of the edge.
fn into_wing(wing: Vector, along: Vector, normal: Vector) -> Option<Vector> {
    let inward = sub(wing, scale(along, dot(wing, along)));
    let curve = unit(cross(cross(along, inward), normal), 0.0)?;
    Some(if dot(curve, inward) < 0.0 { scale(curve, -1.0) } else { curve })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_pierces_a_triangle_only_inside_it() {
        let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(pierces([[0.2, 0.2, -1.0], [0.2, 0.2, 1.0]], face));
        assert!(!pierces([[0.8, 0.8, -1.0], [0.8, 0.8, 1.0]], face), "beside it");
        assert!(!pierces([[0.2, 0.2, 0.5], [0.2, 0.2, 1.0]], face), "above it");
    }
}
