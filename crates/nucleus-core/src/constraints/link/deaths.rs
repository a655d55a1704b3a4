//! Links of particles that die: a link follows its particle to another place in the object, and goes with it.

use crate::constraints::link::lists::{ConstraintLinks, Links, Models};
use crate::input::links::{Link, LinkKind, LinkSide};
use crate::input::{ClothId, PointId};
use crate::math::Real;

impl<R: Real> Links<R> {
    /// Follows the particles of an object that closes up; `number` gives their new places, and none for the dead. Links of the
    /// dead are removed. Returns whether the object has any links; their rows need a new start of the frame.
    pub fn close_up(
        &mut self,
        cloth: ClothId,
        number: impl Fn(PointId) -> Option<PointId>,
        models: Models<'_, R>,
    ) -> bool {
        let mut any = false;
        for own in &mut self.constraints {
            if own.links.iter().any(|link| link.cloths().any(|other| other == cloth.index())) {
                own.close_up(cloth, &number);
                own.lay_out_again(own.layout, models, &self.blocks);
                any = true;
            }
        }
        any
    }
}

impl<R: Real> ConstraintLinks<R> {
    fn close_up(&mut self, cloth: ClothId, number: &impl Fn(PointId) -> Option<PointId>) {
        let Self { links, broken, .. } = self;
        let mut kept = 0;
        // The new index of each link; folds name the links that hold them by index.
        let mut indices = vec![u32::MAX; links.len()];
        for at in 0..links.len() {
            let Some(link) = renumbered(&links[at], cloth, number) else { continue };
            (links[kept], broken[kept]) = (link, broken[at]);
            indices[at] = kept as u32;
            kept += 1;
        }
        links.truncate(kept);
        broken.truncate(kept);
        for link in links {
            if let LinkKind::Fold(fold) = &mut link.kind {
                fold.holds = fold.holds.map(|hold| indices.get(hold as usize).copied().unwrap_or(u32::MAX));
            }
        }
    }
}

/// A link with the new places of its points; `None` where one of them is dead.
fn renumbered(link: &Link, cloth: ClothId, number: impl Fn(PointId) -> Option<PointId>) -> Option<Link> {
    let mut link = *link;
    for side in &mut link.sides {
        let LinkSide::Cloth { cloth: own, points, weights } = side else { continue };
        if *own != cloth {
            continue;
        }
        let first = points[0];
        for (point, weight) in points.iter_mut().zip(weights) {
            // Unused points repeat the first.
            let used = if *weight == 0.0 { first } else { *point };
            *point = number(used)?;
        }
    }
    Some(link)
}
