//! The swept boxes of the elements of each group, kept between searches.

use crate::contact::boundary::{BoundaryElements, ElementGroup};
use crate::contact::box_row::BoxRow;
use crate::contact::cloth::element_bounds::ElementBounds;

/// Boxes of the elements of a group.
#[derive(Debug, Clone, Default)]
pub struct GroupBounds {
    /// Boxes of its points.
    pub points: BoxRow,
    /// Boxes of its edges.
    pub edges: BoxRow,
    /// Boxes of its triangles.
    pub triangles: BoxRow,
}

impl GroupBounds {
    /// Replaces the boxes by those of the elements of a group.
    pub fn fill(
        &mut self,
        boundary: &BoundaryElements,
        group: &ElementGroup,
        bounds: &ElementBounds,
        margin: f32,
    ) {
        self.points.fill(&boundary.points[group.points.clone()], |&point| bounds.bound(&[point], margin));
        self.edges.fill(&boundary.edges[group.edges.clone()], |ends| bounds.bound(ends, margin));
        self.triangles.fill(&boundary.triangles[group.triangles.clone()], |face| bounds.bound(face, margin));
    }
}
