//! Whether links refer to points that exist.

use crate::input::links::{Link, LinkSide};

/// The number of points of each cloth and collider, where there is one.
pub struct ModelSizes<'a> {
    /// By cloth.
    pub cloths: &'a dyn Fn(usize) -> Option<usize>,
    /// By collider.
    pub colliders: &'a dyn Fn(usize) -> Option<usize>,
}

impl ModelSizes<'_> {
    /// Whether a link refers to points that exist, and its numbers are finite.
    pub fn has(&self, link: &Link) -> bool {
        let is_side = |side: &LinkSide| match side {
            LinkSide::Cloth { cloth, points, weights } => {
                let count = (self.cloths)(cloth.index());
                count.is_some_and(|count| points.iter().all(|point| point.index() < count))
                    && weights.iter().all(|weight| weight.is_finite())
            }
            LinkSide::Collider { collider, points, weights } => {
                let count = (self.colliders)(collider.index());
                count.is_some_and(|count| points.iter().all(|point| point.index() < count))
                    && weights.iter().all(|weight| weight.is_finite())
            }
            LinkSide::Space(place) => crate::input::validation::is_in_range(place),
        };
        let numbers = [link.rest, link.strength, link.tangent_strength, link.glue, link.length];
        link.sides.iter().all(is_side)
            && link.fold.is_none_or(|fold| fold.max_length.is_finite())
            && numbers.iter().chain(&link.weight).all(|number| number.is_finite())
            && !(link.on_surface && matches!(link.sides[1], LinkSide::Space(_)))
    }
}
