//! One search for contacts among cloths: the contacts that it replaces, and the inputs of its tasks.

use crate::contact::boundary::{BoundaryElements, ElementGroup};
use crate::contact::bvh::SweptBox;
use crate::contact::cloth::element_bounds::ElementBounds;
use crate::contact::cloth::elements::ElementGroups;
use crate::contact::cloth::untangling::Untangling;
use crate::contact::material::ContactMaterial;
use crate::contact::pair_filter::PairFilter;
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
    pub(super) materials: &'a [Option<ContactMaterial<R>>],
    pub(super) bounds: &'a ElementBounds,
    pub(super) untangling: &'a Untangling,
    pub(super) input: SearchInput<'a, R>,
    pub(super) bounds_violated: &'a [bool],
    /// Half of the largest interaction range, in metres.
    pub(super) margin: f32,
}

impl<R: Real> ClothSearch<'_, R> {
    /// A group's elements, and the boundary that contains them.
    pub(super) fn elements(&self, group: u32) -> (&BoundaryElements, &ElementGroup) {
        let target = &self.elements.groups[group as usize];
        (&self.input.cloths[target.cloth as usize].boundary, &target.group)
    }

    /// The swept box of some points, inflated by half of the largest interaction range.
    #[inline(always)]
    pub(super) fn bound(&self, points: &[u32]) -> SweptBox {
        self.bounds.bound(points, self.margin)
    }

    /// Whether any of these points has a new bound.
    #[inline(always)]
    pub(super) fn has_new_bound(&self, points: &[u32]) -> bool {
        points.iter().any(|&point| self.bounds_violated[point as usize])
    }
}
