//! The source of a constraint's frames, and its members.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Vector3;
use nucleus_core::{ClothId, ColliderId, Exclusion, Faces};

use crate::attributes::ElementKind;
use crate::graph::NodeId;

/// Source of the frames of a constraint.
#[derive(Debug, Clone)]
pub(crate) struct ConstraintSource {
    pub(crate) node: NodeId,
    /// Its members, in the order of `componentIds`.
    pub(crate) members: Vec<Member>,
    /// Whether its transform is ever animated.
    pub(crate) moves: bool,
    /// The role of its links; `None` for exclusions alone.
    pub(crate) part: Option<Part>,
    /// Elements that do not collide while it is enabled.
    pub(crate) exclusion: Option<Arc<Exclusion>>,
    /// Whether its links can ever break.
    pub(crate) can_break: bool,
    /// Welds of a tearable surface: the cloth, two of its points and the ends of an edge that they are half of.
    pub(super) seams: Vec<(ClothId, [u32; 2], [u32; 2])>,
    /// The edges of these welds: of both faces the ends of the edge, and the next corner behind each end.
    pub(super) creases: Vec<(ClothId, [[u32; 4]; 2])>,
    /// `bendResistance` of the cloth of a tearable surface that keeps it where it is whole.
    pub(super) kept_bend: Option<f64>,
}

/// The role of the links of a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// The strength and the glue of the constraint.
    Links,
    /// A force to the origin of its transform.
    ForceToOrigin,
}

/// An object that can be constrained.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MemberObject {
    Cloth(ClothId),
    Collider(ColliderId),
}

impl MemberObject {
    /// A number of its own, in the order of cloths, then colliders.
    pub(crate) fn key(self) -> (u32, u32) {
        match self {
            Self::Cloth(cloth) => (0, cloth.0),
            Self::Collider(collider) => (1, collider.0),
        }
    }
}

/// A component of a constraint.
#[derive(Debug, Clone)]
pub(crate) struct Member {
    pub(crate) object: MemberObject,
    pub(crate) kind: ElementKind,
    /// The points of each element.
    pub(crate) elements: Faces,
    /// The next corners of a face behind the ends of each edge; none for an edge without a face. Empty for other elements.
    pub(super) behind: Vec<Option<[u32; 2]>>,
    /// Points with the other end of an edge of the object that they stand for. Empty for edges, whose points stand for them.
    pub(super) spans: Vec<[u32; 2]>,
    /// All faces of the object, where links slide on more than the elements.
    pub(super) sheet: Faces,
    /// Factors of the component on strength, tangent strength, glue and weight.
    pub(super) scalars: [f64; 4],
    /// Maps by point on strength, glue and weight; empty where there are none.
    pub(super) maps: [Vec<f64>; 3],
    /// The name of the object.
    pub(crate) name: String,
    /// How many particles there may be at a time of a whole object of which they come and go.
    pub(super) capacity: Option<u32>,
}

impl Member {
    /// Each point of its elements once, with the first element that has it.
    pub(crate) fn points(&self) -> Vec<(u32, u32)> {
        let all = (0..).zip(self.elements.iter());
        let mut points: Vec<(u32, u32)> =
            all.flat_map(|(at, corners)| corners.iter().map(move |&point| (point, at))).collect();
        points.sort_unstable();
        points.dedup_by_key(|(point, _)| *point);
        points
    }

    /// Strength, tangent strength, glue and weight of an element.
    pub(crate) fn factors(&self, element: u32) -> [f64; 4] {
        let corners = self.elements.face(element as usize);
        let mean = |map: &Vec<f64>| match map.is_empty() {
            true => 1.0,
            false => corners.iter().map(|&point| map[point as usize]).sum::<f64>() / corners.len() as f64,
        };
        let [strength, glue, weight] = [0, 1, 2].map(|map| mean(&self.maps[map]));
        let own = [strength, strength, glue, weight];
        std::array::from_fn(|k| self.scalars[k] * own[k])
    }

    /// The length in metres that each of its points stands for: of edges half of those at it, else the mean of its spans. A
    /// point without an edge is not in the list.
    pub(crate) fn lengths(&self, places: &Places) -> BTreeMap<u32, f64> {
        let length = |ends: [u32; 2]| {
            let [a, b] = ends.map(|end| places.point(self.object, end));
            (b - a).norm()
        };
        let mut lengths = BTreeMap::new();
        if self.kind == ElementKind::Edge {
            for ends in self.elements.iter().map(|edge| [edge[0], edge[edge.len() - 1]]) {
                // An edge between a point and itself counts once.
                for end in &ends[..if ends[0] == ends[1] { 1 } else { 2 }] {
                    *lengths.entry(*end).or_default() += length(ends) / 2.0;
                }
            }
        }
        for at_point in self.spans.chunk_by(|a, b| a[0] == b[0]) {
            let sum: f64 = at_point.iter().map(|span| length(*span)).sum();
            lengths.insert(at_point[0][0], sum / at_point.len() as f64);
        }
        lengths
    }
}

/// Positions of all members at a time, in metres.
pub(crate) struct Places {
    pub(super) cloths: Vec<Vec<Vector3<f64>>>,
    pub(super) colliders: Vec<Vec<Vector3<f64>>>,
}

impl Places {
    pub(crate) fn point(&self, object: MemberObject, point: u32) -> Vector3<f64> {
        match object {
            MemberObject::Cloth(cloth) => self.cloths[cloth.index()][point as usize],
            MemberObject::Collider(collider) => self.colliders[collider.index()][point as usize],
        }
    }
}
