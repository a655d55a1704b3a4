//! Links on surfaces: a place and a face, held along the face's normal and along the face with strengths of their own.
//!
//! A sliding link moves its foot, the place on the face, to the nearest place of the surface in every time step. It walks
//! from face to neighbouring face and so stays on the sheet where it began. Friction leaves the foot behind by a lag, which
//! the tangent strength then pulls on. These rows are swept one by one in their order: a foot may move to any face of the
//! surface, so they have no lasting colours.

use crate::constraints::stretch::LinkStrength;
use crate::contact::collider::ColliderState;
use crate::input::frame::{COUNT_PERIOD, FrameInput};
use crate::input::links::ConstraintFrame;
use crate::math::Real;
use crate::state::State;

use super::ends::{Ends, Prescribed, vector};
use super::lists::{ConstraintLinks, Links, Models};
use super::placed::{Direction, Placed};
use super::sweep::LinkSweep;
use super::topology::SurfaceId;

impl<R: Real> ConstraintLinks<R> {
    fn placed<'a>(
        &'a self,
        at: usize,
        (cloths, colliders): Models<'a, R>,
        state: &'a State<R>,
        prescribed: Prescribed<'a>,
        time: f64,
    ) -> Option<Placed<'a, R>> {
        let id = SurfaceId::of(&self.links[at].sides[1])?;
        Some(Placed { id, faces: self.topology.of(id)?, cloths, colliders, state, prescribed, time })
    }

    /// Moves the feet of all links to the surface below them, at a time of the frame, in a time step of `h` seconds.
    fn slide(
        &mut self,
        models: Models<'_, R>,
        state: &State<R>,
        prescribed: Prescribed<'_>,
        [time, h]: [f64; 2],
    ) {
        let friction = prescribed.frame.friction.clamp(0.0, 1.0);
        let lag = friction * COUNT_PERIOD;
        let share = (1.0 - friction) * h / ((1.0 - friction) * h + lag);
        for k in 0..self.surface.len() {
            let at = self.surface[k].link as usize;
            let moved = self.placed(at, models, state, prescribed, time).map(|placed| {
                let link = &self.links[at];
                let (corners, weights) = placed.corners(&link.sides[1]);
                let foot = placed.at(corners, weights);
                let place = foot + vector(link, &self.surface[k].ends, state, prescribed, time);
                let mut nearest = placed.nearest(place, corners, weights);
                let is_on_edge = nearest.1.iter().any(|weight| *weight <= 0.0);
                let line = place - placed.at(nearest.0, nearest.1);
                let beside = line.try_normalize(0.0).filter(|_| is_on_edge);
                if share < 1.0 {
                    let lagging = foot + (placed.at(nearest.0, nearest.1) - foot) * share;
                    nearest = placed.nearest(lagging, corners, weights);
                }
                (placed.side(nearest.0, nearest.1), beside)
            });
            if let Some((side, beside)) = moved {
                self.links[at].sides[1] = side;
                self.surface[k].beside = beside;
                self.surface[k].ends = Ends::new(&self.links[at], models.0);
            }
        }
    }

    /// One sweep over the links on surfaces, one by one.
    pub(super) fn relax_surface(
        &mut self,
        sweep: &LinkSweep<R>,
        frame: &ConstraintFrame,
        prescribed: Prescribed<'_>,
        models: Models<'_, R>,
        state: &mut State<R>,
        [time, h]: [f64; 2],
    ) {
        let softness = |factor: f64| if self.layout.is_physical { factor } else { 1.0 };
        for k in 0..self.surface.len() {
            let at = self.surface[k].link as usize;
            if self.broken[at] {
                continue;
            }
            // Without friction a foot slides freely: what pulls it along the surface is the lag of friction alone.
            let is_held_along = !frame.slides || frame.friction > 0.0;
            let directions = [Direction::Normal, Direction::Tangent];
            for direction in directions.into_iter().take(1 + usize::from(is_held_along)) {
                let Some(placed) = self.placed(at, models, state, prescribed, time) else { continue };
                let (link, row) = (&self.links[at], &self.surface[k]);
                let d = vector(link, &row.ends, state, prescribed, time);
                let normal = placed.hold(link, row, frame, d);
                let along = d.dot(&normal);
                let across = d - normal * along;
                let unit = match direction {
                    Direction::Normal => normal,
                    Direction::Tangent => across.try_normalize(0.0).unwrap_or_default(),
                };
                let gradient = placed.gradient(link, row, direction, [d, normal, unit]);
                let mobility = gradient.mobility(&state.displacement);
                if mobility <= 0.0 {
                    continue;
                }
                let pull = |strength: &LinkStrength<R>, factor: f64, c: f64| {
                    let sides = if c > 0.0 {
                        [strength.share.above, strength.compliance.above]
                    } else {
                        [strength.share.below, strength.compliance.below]
                    };
                    let [share, compliance] = sides.map(R::to_f64);
                    let softened = softness(factor) * mobility + compliance;
                    if softened > 0.0 { share * factor * c / softened } else { 0.0 }
                };
                let lambda = match direction {
                    Direction::Tangent => pull(&sweep.tangent, link.tangent_strength, across.norm()),
                    Direction::Normal => {
                        // A sliding point without a fixed side keeps the distance on the side where it is now.
                        let is_sided = frame.single_sided || !frame.slides;
                        let side = if is_sided { 1.0 } else { along.signum() * link.rest.signum() };
                        let rest = link.rest * side * frame.rest_scale_at(time);
                        let lambda = pull(&sweep.normal, link.strength, along - rest);
                        // Beyond the spring: on its side, a point stays outside of the kept distance.
                        let sign = if link.rest * side < 0.0 { -1.0 } else { 1.0 };
                        let after = (along - lambda * mobility) * sign;
                        let short = frame.keep_off.map_or(0.0, |keep_off| (keep_off - after).max(0.0));
                        lambda - sign * short / mobility
                    }
                };
                gradient.displace(&mut state.displacement, -lambda);
                self.surface[k].impulse += unit * (lambda / h);
            }
        }
    }
}

/// Moves the feet of sliding links, after prediction, in a time step of `h` seconds that ends at `time`.
pub fn slide_links<R: Real>(
    links: &mut Links<R>,
    models: Models<'_, R>,
    state: &State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
    [time, h]: [f64; 2],
) {
    for (own, settings) in links.constraints.iter_mut().zip(&frame.constraints) {
        if settings.slides && !own.surface.is_empty() {
            let prescribed = Prescribed { colliders, frame: settings };
            own.slide(models, state, prescribed, [time, h]);
        }
    }
}
