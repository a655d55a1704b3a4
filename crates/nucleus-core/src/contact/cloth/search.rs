//! One search for contacts among cloths: the contacts that it replaces, and the inputs of its tasks.

use crate::contact::bvh::SweptBox;
use crate::contact::cloth::element_bounds::ElementBounds;
use crate::contact::cloth::elements::{ClothGroup, ElementGroups, NewBounds};
use crate::contact::cloth::group_bounds::GroupBounds;
use crate::contact::cloth::untangling::Untangling;
use crate::contact::pair_filter::PairFilter;
use crate::contact::pair_table::{ContactMaterials, PairTable};
use crate::math::{Real, Row4};
use crate::model::ClothModel;

/// Which contacts a search replaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefreshKind {
    /// All of them: a candidate interval begins.
    Full,
    /// Those of points that violated their motion bounds.
    Incremental,
}

impl RefreshKind {
    /// Whether contacts of points that keep their bounds stay.
    pub fn is_incremental(self) -> bool {
        self == Self::Incremental
    }
}

/// The input of a search.
#[derive(Clone, Copy)]
pub struct SearchInput<'a, R> {
    /// The cloths.
    pub cloths: &'a [ClothModel<R>],
    /// Anchors in metres.
    pub anchors: &'a [[f64; 3]],
    /// Displacements at the start and at the end of the time step.
    pub displacement: [&'a [Row4<R>]; 2],
    /// The start of the time step, as a share of the candidate interval.
    pub interval_share: f64,
    /// A factor on the collide strength of each point; empty without a map.
    pub strength: &'a [R],
    /// Elements that do not collide.
    pub filter: &'a PairFilter,
}

/// A search, shared by its tasks.
pub(super) struct ClothSearch<'a, R> {
    pub(super) elements: &'a ElementGroups,
    pub(super) materials: &'a ContactMaterials<R>,
    /// Whether two cloths may overlap.
    pub(super) overlapping: &'a PairTable<bool>,
    pub(super) bounds: &'a ElementBounds,
    pub(super) untangling: &'a Untangling,
    pub(super) input: SearchInput<'a, R>,
    pub(super) group_bounds: &'a [GroupBounds],
    /// In metres by cloth, by which the boxes of its elements are larger.
    pub(super) margins: &'a [f32],
    pub(super) bounds_violated: &'a [bool],
    /// By group.
    pub(super) new_bounds: &'a [NewBounds],
}

impl<R: Real> ClothSearch<'_, R> {
    /// The elements of a group.
    pub(super) fn group(&self, group: u32) -> SearchedGroup<'_> {
        let ClothGroup { cloth, group: own } = &self.elements.groups[group as usize];
        let boundary = &self.input.cloths[*cloth as usize].boundary;
        SearchedGroup {
            points: &boundary.points[own.points.clone()],
            edges: &boundary.edges[own.edges.clone()],
            triangles: &boundary.triangles[own.triangles.clone()],
            first_edge: (*cloth as usize, own.edges.start),
            swept_box: &self.elements.swept_boxes[group as usize],
            bounds: &self.group_bounds[group as usize],
            new_bounds: self.new_bounds[group as usize],
        }
    }

    /// Whether any of these points has a new bound.
    #[inline(always)]
    pub(super) fn has_new_bound(&self, points: &[u32]) -> bool {
        points.iter().any(|&point| self.bounds_violated[point as usize])
    }
}

/// The elements of a group, with their boxes.
pub(super) struct SearchedGroup<'a> {
    pub(super) points: &'a [u32],
    pub(super) edges: &'a [[u32; 2]],
    pub(super) triangles: &'a [[u32; 3]],
    /// Its cloth, and the index of its first edge in the boundary.
    pub(super) first_edge: (usize, usize),
    /// Swept box of the whole group.
    pub(super) swept_box: &'a SweptBox,
    pub(super) bounds: &'a GroupBounds,
    pub(super) new_bounds: NewBounds,
}

impl SearchedGroup<'_> {
    /// Whether it is a group of free points.
    pub(super) fn is_free(&self) -> bool {
        self.triangles.is_empty()
    }
}
