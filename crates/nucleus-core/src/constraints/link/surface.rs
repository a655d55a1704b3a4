//! Links on surfaces: a place and a face, held along the face's normal and along the face with strengths of their own. A place
//! beside the face, nearest to an edge or a corner, is held along a direction that turns with the face, and across it.
//!
//! A sliding link moves its foot, the place on the face, to the nearest place of the surface in every time step. It walks
//! from face to neighbouring face and so stays on the sheet where it began. Friction takes from the motion along the face
//! in a time step, and never pulls towards a place: a foot that lagged behind and then crossed an edge of a folded face
//! would pull with energy that nothing supplied. At an open border a point that keeps a distance goes round the edge, and
//! then is on the other side: held on its first one, it would be drawn through the face. These rows are swept one by one in
//! their order: a foot may move to any face of the surface, so they have no lasting colours.

use crate::constraints::stretch::LinkStrength;
use crate::contact::collider::ColliderState;
use crate::input::frame::FrameInput;
use crate::input::links::{ConstraintFrame, Link};
use crate::math::Real;
use crate::state::State;

use super::ends::{Ends, Prescribed, start_vector, vector};
use super::lists::{ConstraintLinks, Links, Models};
use super::placed::{Direction, Placed};
use super::sweep::LinkSweep;
use super::topology::{SurfaceId, SurfaceRow};

/// Share of a vector below which its part along a surface is rounding, which has no direction.
const ROUNDING: f64 = 1e-12;

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

    /// Moves the feet of all links to the nearest place of their surface, at a time of the frame.
    fn slide(&mut self, models: Models<'_, R>, state: &State<R>, prescribed: Prescribed<'_>, time: f64) {
        for k in 0..self.surface.len() {
            let at = self.surface[k].link as usize;
            let moved = self.placed(at, models, state, prescribed, time).map(|placed| {
                let link = &self.links[at];
                let (corners, weights) = placed.corners(&link.sides[1]);
                let foot = placed.at(corners, weights);
                let place = foot + vector(link, &self.surface[k].ends, state, prescribed, time);
                let nearest = placed.nearest(place, corners, weights);
                let line = (place - placed.at(nearest.0, nearest.1)).try_normalize(0.0);
                let beside = line.filter(|line| placed.is_beside(nearest, *line));
                let normal = placed.normal(nearest.0, nearest.1, false);
                let is_other_side = line.is_some_and(|line| line.dot(&normal) * link.rest < 0.0);
                let is_round = self.surface[k].beside.is_some() && beside.is_none() && is_other_side;
                (placed.side(nearest.0, nearest.1), beside, is_round)
            });
            if let Some((side, beside, is_round)) = moved {
                if is_round {
                    self.links[at].rest = -self.links[at].rest;
                }
                self.links[at].sides[1] = side;
                self.surface[k].beside = beside;
                self.surface[k].ends = Ends::new(&self.links[at], models.0);
            }
        }
    }

    /// One sweep over the links on surfaces, one by one, in order or backward.
    pub(super) fn relax_surface(&mut self, pass: &SurfacePass<'_, R>, state: &mut State<R>, backward: bool) {
        let count = self.surface.len();
        for k in (0..count).map(|k| if backward { count - 1 - k } else { k }) {
            if self.broken[self.surface[k].link as usize] {
                continue;
            }
            let directions = match (self.is_held_along(k, pass.prescribed.frame), backward) {
                (false, _) => &[Direction::Normal][..],
                (true, false) => &[Direction::Normal, Direction::Tangent],
                (true, true) => &[Direction::Tangent, Direction::Normal],
            };
            for &direction in directions {
                self.relax_along(k, direction, pass, state);
            }
        }
    }

    /// Whether a link resists along its surface: by its tangent strength or, where it slides, by friction. An edge of cloth
    /// takes up no torque, so there is no friction beside it.
    fn is_held_along(&self, k: usize, frame: &ConstraintFrame) -> bool {
        let row = &self.surface[k];
        let surface = SurfaceId::of(&self.links[row.link as usize].sides[1]);
        let is_on_edge_of_cloth = row.beside.is_some() && matches!(surface, Some(SurfaceId::Cloth(_)));
        !frame.slides || frame.friction > 0.0 && !is_on_edge_of_cloth
    }

    /// Projects a link along the normal of its face or along the face.
    fn relax_along(
        &mut self,
        k: usize,
        direction: Direction,
        pass: &SurfacePass<'_, R>,
        state: &mut State<R>,
    ) {
        let SurfacePass { sweep, prescribed, models, from, time, h } = *pass;
        let at = self.surface[k].link as usize;
        let Some(placed) = self.placed(at, models, state, prescribed, time) else { return };
        let (link, row, frame) = (&self.links[at], &self.surface[k], prescribed.frame);
        let d = vector(link, &row.ends, state, prescribed, time);
        let normal = placed.hold(link, row, frame, d);
        let along = d.dot(&normal);
        let unit = match direction {
            Direction::Normal => normal,
            Direction::Tangent => {
                // Friction acts on the motion of this step.
                let moved =
                    if frame.slides { d - start_vector(link, &row.ends, state, prescribed, from) } else { d };
                let rounding = ROUNDING * moved.norm();
                (moved - normal * moved.dot(&normal)).try_normalize(rounding).unwrap_or_default()
            }
        };
        let gradient = placed.gradient(link, row, direction, [d, normal, unit]);
        let mobility = gradient.mobility(&state.displacement);
        if mobility <= 0.0 {
            return;
        }
        let dropped = frame.dropoff.map_or(1.0, |dropoff| dropoff.at(d.norm()));
        let projection = Projection { mobility, dropped, is_physical: self.layout.is_physical };
        let lambda = match direction {
            Direction::Tangent => {
                let travel = prescribed.vector(link, time) - prescribed.vector(link, from);
                let length = match frame.slides {
                    true => (gradient.motion(state) + unit.dot(&travel)).max(0.0),
                    false => d.dot(&unit),
                };
                // A count of friction is a share of the motion: it has no strength that a component could scale.
                let is_share = frame.slides && !projection.is_physical;
                projection.pull(&sweep.tangent, if is_share { 1.0 } else { link.tangent_strength }, length)
            }
            Direction::Normal => projection.along_normal(sweep, (link, row), (frame, time), along),
        };
        gradient.displace(&mut state.displacement, -lambda);
        self.surface[k].impulse += unit * (lambda / h);
    }
}

/// The projection of a link on a surface in one direction.
struct Projection {
    /// How far a unit push changes its length, in 1/kg.
    mobility: f64,
    /// The factor on its strength over its length.
    dropped: f64,
    is_physical: bool,
}

impl Projection {
    /// The push that takes from an error `c` in metres what a strength with a factor takes.
    fn pull<R: Real>(&self, strength: &LinkStrength<R>, factor: f64, c: f64) -> f64 {
        let factor = factor * self.dropped;
        let LinkStrength { share, compliance, .. } = strength;
        let sides = if c > 0.0 { [share.above, compliance.above] } else { [share.below, compliance.below] };
        let [share, compliance] = sides.map(R::to_f64);
        let softened = if self.is_physical { factor } else { 1.0 } * self.mobility + compliance;
        if softened > 0.0 { share * factor * c / softened } else { 0.0 }
    }

    /// The push along the normal, at this distance along it.
    fn along_normal<R: Real>(
        &self,
        sweep: &LinkSweep<R>,
        (link, row): (&Link, &SurfaceRow),
        (frame, time): (&ConstraintFrame, f64),
        along: f64,
    ) -> f64 {
        // A sliding point without a fixed side keeps the distance on the side where it is now.
        let is_sided = frame.single_sided || !frame.slides;
        let side = if is_sided { 1.0 } else { along.signum() * link.rest.signum() };
        let rest = link.rest * side * frame.rest_scale_at(time);
        let outward = if rest == 0.0 { along.signum() } else { rest.signum() };
        let beyond = (along * outward - rest.abs().max(row.contact_distance)).max(0.0);
        let c = if (along - rest) * outward > 0.0 { beyond * outward } else { along - rest };
        let lambda = self.pull(&sweep.normal, link.strength, c);
        // Beyond the spring: on its side, a point stays outside of the kept distance, unless it started nearer.
        let sign = if link.rest * side < 0.0 { -1.0 } else { 1.0 };
        let after = (along - lambda * self.mobility) * sign;
        let short = frame.keep_off.map_or(0.0, |keep_off| (keep_off.min(link.rest.abs()) - after).max(0.0));
        lambda - sign * short / self.mobility
    }
}

/// A sweep over links on surfaces.
pub(super) struct SurfacePass<'a, R> {
    pub(super) sweep: &'a LinkSweep<R>,
    pub(super) prescribed: Prescribed<'a>,
    pub(super) models: Models<'a, R>,
    /// Start and end of the time step, as shares of the frame.
    pub(super) from: f64,
    pub(super) time: f64,
    /// Its length in seconds.
    pub(super) h: f64,
}

/// Moves the feet of sliding links, after prediction, in a time step that ends at `time`.
pub fn slide_links<R: Real>(
    links: &mut Links<R>,
    models: Models<'_, R>,
    state: &State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
    time: f64,
) {
    for (own, settings) in links.constraints.iter_mut().zip(&frame.constraints) {
        if settings.slides && !own.surface.is_empty() {
            let prescribed = Prescribed { colliders, frame: settings };
            own.slide(models, state, prescribed, time);
        }
    }
}
