//! Whether links refer to points that exist, with numbers in range.

use crate::input::links::{Link, LinkSide};
use crate::input::validation::{MAX_FACTOR, is_in_range};

/// Largest weight of a point; those of a fold are large where its faces are small.
const MAX_WEIGHT: f64 = 1e9;
/// Largest length of a link in metres: the velocity of a point that moves so far in a time step is finite in `f32`.
const MAX_LENGTH: f64 = 1e9;

/// The number of points of each cloth and collider, where there is one.
pub struct ModelSizes<'a> {
    /// By cloth.
    pub cloths: &'a dyn Fn(usize) -> Option<usize>,
    /// By collider.
    pub colliders: &'a dyn Fn(usize) -> Option<usize>,
}

impl ModelSizes<'_> {
    /// Whether a link refers to points that exist, and its numbers are in range.
    pub fn has(&self, link: &Link) -> bool {
        let is_side = |side: &LinkSide| match side {
            LinkSide::Cloth { cloth, points, weights } => {
                let count = (self.cloths)(cloth.index());
                count.is_some_and(|count| points.iter().all(|point| point.index() < count))
                    && weights.iter().all(|weight| weight.abs() <= MAX_WEIGHT)
            }
            LinkSide::Collider { collider, points, weights } => {
                let count = (self.colliders)(collider.index());
                count.is_some_and(|count| points.iter().all(|point| point.index() < count))
                    && weights.iter().all(|weight| weight.abs() <= MAX_WEIGHT)
            }
            LinkSide::Space(place) => is_in_range(place),
        };
        let factors = [link.strength, link.tangent_strength, link.glue, link.weight[0], link.weight[1]];
        let lengths = [link.length, link.fold().map_or(0.0, |fold| fold.max_length)];
        link.sides.iter().all(is_side)
            && link.rest.abs() <= MAX_LENGTH
            && link.oblique().iter().flatten().all(|component| component.abs() <= 1.0)
            && lengths.iter().all(|length| (0.0..=MAX_LENGTH).contains(length))
            && factors.iter().all(|factor| (0.0..=MAX_FACTOR).contains(factor))
            && !(link.is_on_surface() && matches!(link.sides[1], LinkSide::Space(_)))
    }
}
