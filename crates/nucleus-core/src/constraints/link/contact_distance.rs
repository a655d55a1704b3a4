//! The distance that contact keeps between the two sides of a link.
//!
//! A link that is shorter than that would pull together what contact pushes apart, in every step, and the two would heat
//! up. So such a link does not pull up to this distance: it then holds its sides between its rest length and the contact
//! thickness.

use crate::contact::material::ContactMaterial;
use crate::contact::pair_filter::PairFilter;
use crate::input::frame::FrameInput;
use crate::input::links::{Link, LinkSide};
use crate::math::Real;
use crate::model::ClothModel;

/// Which sides of links collide.
pub(super) struct Collisions<'a, R> {
    pub(super) frame: &'a FrameInput,
    pub(super) pair_filter: &'a PairFilter,
    pub(super) cloths: &'a [ClothModel<R>],
}

impl<R: Real> Collisions<'_, R> {
    /// The contact thickness of the two sides in metres, before vertex maps; 0 where they do not collide, of a fold, and
    /// within a cloth, where contact keeps no more than half of the distance at rest.
    pub(super) fn distance(&self, link: &Link) -> f64 {
        let FrameInput { cloths, colliders, layer_range, .. } = self.frame;
        let material = match link.sides {
            _ if link.fold().is_some() => None,
            [LinkSide::Cloth { cloth: a, .. }, LinkSide::Cloth { cloth: b, .. }] if a != b => {
                let pair = [a, b].map(|cloth| &cloths[cloth.index()]);
                ContactMaterial::<R>::for_cloths(pair, [1.0; 2], *layer_range).filter(|_| {
                    let [ours, theirs] = link.sides.map(|side| self.rows(&side));
                    !self.pair_filter.excludes(&ours, &theirs)
                })
            }
            [own @ LinkSide::Cloth { cloth, .. }, LinkSide::Collider { collider, points, .. }]
            | [LinkSide::Collider { collider, points, .. }, own @ LinkSide::Cloth { cloth, .. }] => {
                let (at, theirs) = (collider.index(), points.map(|point| point.0));
                let own_frame = &cloths[cloth.index()];
                ContactMaterial::<R>::for_collider(own_frame, &colliders[at], [1.0; 2], *layer_range)
                    .filter(|_| !self.pair_filter.excludes_collider(&self.rows(&own), at, &theirs))
            }
            _ => None,
        };
        material.map_or(0.0, |material| material.thickness)
    }

    /// The rows of the points of a side, the first of them again where it has fewer than three.
    fn rows(&self, side: &LinkSide) -> [u32; 3] {
        let LinkSide::Cloth { cloth, points, weights } = *side else { return [0; 3] };
        let used = points.into_iter().zip(weights).find(|(_, weight)| *weight != 0.0);
        let first = used.map_or(points[0], |(point, _)| point);
        std::array::from_fn(|k| {
            let point = if weights[k] == 0.0 { first } else { points[k] };
            self.cloths[cloth.index()].place(point.index())
        })
    }
}
