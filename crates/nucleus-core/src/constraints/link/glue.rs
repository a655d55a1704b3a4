//! Glue: links that break under load.
//!
//! The load of a link is the mean force that it carries over a substep, from the impulses of its projections, per length
//! of the edge that it stands for. It follows from the balance of momentum alone, so it depends on neither mesh, time step
//! nor the solver's stiffness. At the end of a substep all links above their breaking load break at once.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::input::PointId;
use crate::input::frame::FrameInput;
use crate::input::links::{ConstraintFrame, Link, LinkSide};
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::schedule::PassTime;
use crate::state::{Chamber, State};

use super::lists::{ConstraintLinks, Links};
use super::pairs::PairGroup;

/// Load in N/m that breaks half-strong glue (`glueStrength` 0.5).
pub const LOAD_OF_HALF: f64 = 100.0;

/// The breaking load in N/m of a glue strength: zero at 0, any load at 1.
pub fn breaking_load(glue_strength: f64) -> f64 {
    match glue_strength {
        glue if glue >= 1.0 => f64::INFINITY,
        glue => LOAD_OF_HALF * glue.max(0.0) / (1.0 - glue.max(0.0)),
    }
}

/// The elements that a link joins: of each side its object and points. Links formed anew between them are the same link.
type Joined = [Option<(bool, usize, [u32; 3])>; 2];

fn joined(link: &Link) -> (bool, Joined) {
    let of = |points: [PointId; 3]| points.map(|point| point.0);
    let side = |side: LinkSide| match side {
        LinkSide::Cloth { cloth, points, .. } => Some((true, cloth.index(), of(points))),
        LinkSide::Collider { collider, points, .. } => Some((false, collider.index(), of(points))),
        LinkSide::Space(_) => None,
    };
    (link.fold().is_some(), link.sides.map(side))
}

impl<R: Real> ConstraintLinks<R> {
    /// Breaks the links that were broken `before` they were formed anew.
    pub(super) fn keep_broken(&mut self, before: &Self) {
        let pairs = before.links.iter().zip(&before.broken);
        let known: BTreeSet<_> = pairs.filter(|(_, broken)| **broken).map(|(link, _)| joined(link)).collect();
        if !known.is_empty() {
            self.broken = self.links.iter().map(|link| known.contains(&joined(link))).collect();
        }
    }

    /// Breaks the links that carry nothing, before they pull. Whether there were any.
    pub(super) fn break_unglued(&mut self, settings: &ConstraintFrame) -> bool {
        let mut any = false;
        for (link, broken) in self.links.iter().zip(&mut self.broken) {
            let carries = breaking_load(settings.glue_strength * link.glue) * settings.glue_scale > 0.0
                || link.fold().is_some();
            any |= !carries && !*broken;
            *broken |= !carries;
        }
        any
    }

    /// Breaks the links whose load in a substep that ends `now` was above theirs; of the welds round a point, those along
    /// which it tears. Whether there were any.
    fn break_links(&mut self, settings: &ConstraintFrame, state: &State<R>, now: PassTime) -> bool {
        let Self { links, broken, pairs, nodes, combined, surface, .. } = self;
        let limit = |link: &Link| {
            breaking_load(settings.glue_strength * link.glue) * settings.glue_scale * now.length
        };
        let mut loads = vec![Vector3::zeros(); if pairs.rows.len() > 0 { links.len() } else { 0 }];
        pairs.loads.take(pairs.rows.groups().iter().map(|group| &group.link), |at, impulse| {
            loads[at as usize] = impulse;
        });
        let rest_scale = settings.rest_scale_at(now.at);
        for (at, ends) in pairs.rows.groups().iter().flat_map(PairGroup::pairs) {
            if is_held_by_pins(state, ends, links[at as usize].rest * rest_scale) {
                loads[at as usize] = Vector3::zeros();
            }
        }
        let whole = |at: u32| {
            let link = &links[at as usize];
            (!broken[at as usize]).then(|| [link.length, limit(link) * link.length])
        };
        let torn = nodes.tears(|at| loads[at as usize], whole, |row| Vector3::from(state.position(row)));
        let mut any = !torn.is_empty();
        torn.into_iter().for_each(|at| broken[at as usize] = true);
        let mut judge = |at: u32, impulse: Vector3<f64>| {
            let (link, broken): (&Link, &mut bool) = (&links[at as usize], &mut broken[at as usize]);
            if !*broken && impulse.norm() > limit(link) * link.length {
                (*broken, any) = (true, true);
            }
        };
        combined.take_impulses(&mut judge);
        for row in surface {
            judge(row.link, std::mem::take(&mut row.impulse));
        }
        if any {
            pairs.release(broken);
            combined.release(broken);
        }
        any
    }
}

/// Rounding errors of a length, in those of the numbers that it is computed from.
const ROUNDING: f64 = 16.0;

/// Whether both points are pinned and not farther apart than the length at rest, up to rounding. No projection moves them, so
/// the rounding error of the length of a rigid link would count as an unlimited load. Such a link breaks when the pins part.
fn is_held_by_pins<R: Real>(state: &State<R>, ends: [u32; 2], rest: f64) -> bool {
    let rows = ends.map(|row| state.displacement[row as usize]);
    if rows.iter().any(|row| row.0[3] > R::ZERO) {
        return false;
    }
    let [a, b] = ends.map(|row| Vector3::from(state.position(row)));
    let length = (b - a).norm();
    let moved: f64 = rows.iter().map(|row| Vector3::from(row.xyz().map(R::to_f64)).norm()).sum();
    length - rest <= ROUNDING * R::EPSILON.to_f64() * (moved + length)
}

/// Breaks links and folds in a substep that ends `now`. Whether any broke.
pub fn break_links<R: Real>(
    links: &mut Links<R>,
    scene: (&Model<R>, &[ColliderState]),
    state: &State<R>,
    frame: &FrameInput,
    now: PassTime,
) -> bool {
    let mut any = false;
    for (own, settings) in links.constraints.iter_mut().zip(&frame.constraints) {
        any |= settings.can_break && own.break_links(settings, state, now);
        any |= own.has_folds() && own.break_folds(scene, state, settings, now.at);
    }
    any
}

/// Finds the pieces of all meshes under pressure that can tear, once links have formed or broken.
pub fn find_pieces<R: Real>(cloths: &mut [ClothModel<R>], links: &Links<R>) {
    if cloths.iter().any(|cloth| cloth.pressure.can_tear()) {
        let clusters = links.clusters(cloths);
        cloths.iter_mut().for_each(|cloth| cloth.pressure.find_pieces(cloth.points().start, &clusters));
    }
}

/// Sets the holes of all chambers to those at the welds that are torn.
pub fn tear_chambers<R: Real>(cloths: &[ClothModel<R>], chambers: &mut [Chamber], links: &Links<R>) {
    chambers.iter_mut().for_each(|chamber| chamber.torn = 0.0);
    let broken = links.constraints.iter().flat_map(|own| own.links.iter().zip(&own.broken));
    for link in broken.filter(|(_, broken)| **broken).map(|(link, _)| link) {
        let [LinkSide::Cloth { cloth, points, .. }, LinkSide::Cloth { cloth: other, .. }] = link.sides else {
            continue;
        };
        if cloth != other || link.fold().is_some() {
            continue;
        }
        let model = &cloths[cloth.index()];
        let at = model.pressure.chamber_of(model.place(points[0].index()) - model.points().start);
        at.into_iter().for_each(|at| chambers[at].torn += link.length * link.length);
    }
}
