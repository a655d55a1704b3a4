//! Links on surfaces: a place and a face, held along the face's normal and along the face with strengths of their own.
//!
//! A sliding link moves its foot, the place on the face, to the nearest place of the surface in every time step. It walks
//! from face to neighbouring face and so stays on the sheet where it began. Friction leaves the foot behind by a lag, which
//! the tangent strength then pulls on. These rows are swept one by one in their order: a foot may move to any face of the
//! surface, so they have no lasting colours.

use nalgebra::Vector3;

use crate::constraints::stretch::LinkStrength;
use crate::contact::cloth::elements::CsrLists;
use crate::contact::collider::ColliderState;
use crate::contact::narrow_phase::closest_on_triangle;
use crate::input::PointId;
use crate::input::frame::{COUNT_PERIOD, FrameInput};
use crate::input::links::{ConstraintFrame, LinkSide};
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};
use crate::state::State;

use super::ends::{Ends, Prescribed, vector};
use super::lists::{ConstraintLinks, Links, Models};
use super::sweep::LinkSweep;
use super::topology::SurfaceId;

type Point = Vector3<f64>;

/// Steps of a walk from face to face, at most.
const MAX_STEPS: usize = 64;

/// A surface at a time of the frame. Points are numbered by rows (cloth), or as in the mesh (collider).
struct Placed<'a, R> {
    id: SurfaceId,
    faces: &'a CsrLists,
    cloths: &'a [ClothModel<R>],
    colliders: &'a [ColliderModel],
    state: &'a State<R>,
    prescribed: Prescribed<'a>,
    time: f64,
}

impl<R: Real> Placed<'_, R> {
    fn triangle(&self, at: u32) -> [u32; 3] {
        match self.id {
            SurfaceId::Cloth(cloth) => self.cloths[cloth.index()].boundary.triangles[at as usize],
            SurfaceId::Collider(collider) => self.colliders[collider.index()].boundary.triangles[at as usize],
        }
    }

    fn position(&self, point: u32) -> Point {
        match self.id {
            SurfaceId::Cloth(_) => Point::from(self.state.position(point)),
            SurfaceId::Collider(collider) => {
                self.prescribed.colliders[collider.index()].point(point, self.time)
            }
        }
    }

    fn first(&self) -> u32 {
        match self.id {
            SurfaceId::Cloth(cloth) => self.cloths[cloth.index()].points().start,
            SurfaceId::Collider(_) => 0,
        }
    }

    /// The points of a side, as this surface numbers them, and their weights.
    fn corners(&self, side: &LinkSide) -> ([u32; 3], [f64; 3]) {
        match *side {
            LinkSide::Cloth { cloth, points, weights } => {
                (points.map(|point| self.cloths[cloth.index()].place(point.index())), weights)
            }
            LinkSide::Collider { points, weights, .. } => (points.map(|point| point.0), weights),
            LinkSide::Space(_) => ([0; 3], [0.0; 3]),
        }
    }

    fn side(&self, corners: [u32; 3], weights: [f64; 3]) -> LinkSide {
        match self.id {
            SurfaceId::Cloth(cloth) => {
                let model = &self.cloths[cloth.index()];
                let first = model.points().start;
                let points = corners.map(|row| PointId(model.order.user((row - first) as usize) as u32));
                LinkSide::Cloth { cloth, points, weights }
            }
            SurfaceId::Collider(collider) => {
                LinkSide::Collider { collider, points: corners.map(PointId), weights }
            }
        }
    }

    fn at(&self, corners: [u32; 3], weights: [f64; 3]) -> Point {
        corners.into_iter().zip(weights).map(|(corner, weight)| self.position(corner) * weight).sum()
    }

    /// The nearest place of the surface, on a walk that begins at these corners.
    fn nearest(&self, place: Point, mut corners: [u32; 3], mut weights: [f64; 3]) -> ([u32; 3], [f64; 3]) {
        let mut distance = (place - self.at(corners, weights)).norm_squared();
        for _ in 0..MAX_STEPS {
            let before = distance;
            let around = corners;
            for corner in around {
                for &face in self.faces.of(corner - self.first()) {
                    let candidate = self.triangle(face);
                    let positions = candidate.map(|point| self.position(point));
                    let found = closest_on_triangle(place.into(), positions.map(Into::into));
                    let foot: Point = positions.iter().zip(found).map(|(p, weight)| p * weight).sum();
                    let squared = (place - foot).norm_squared();
                    if squared < distance {
                        (distance, corners, weights) = (squared, candidate, found);
                    }
                }
            }
            if distance >= before {
                break;
            }
        }
        (corners, weights)
    }

    /// The unit normal at a place: of its face, or, where links slide, interpolated between those of the corners so that
    /// it changes smoothly.
    fn normal(&self, corners: [u32; 3], weights: [f64; 3], is_smooth: bool) -> Point {
        let of_face = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.position(corner));
            (b - a).cross(&(c - a))
        };
        let of_corner = |corner: u32| {
            let faces = self.faces.of(corner - self.first()).iter();
            let sum: Point = faces.map(|&face| of_face(self.triangle(face))).sum();
            sum.try_normalize(0.0).unwrap_or_default()
        };
        let smooth: Point =
            corners.into_iter().zip(weights).map(|(corner, weight)| of_corner(corner) * weight).sum();
        smooth
            .try_normalize(1e-6)
            .filter(|_| is_smooth)
            .or_else(|| of_face(corners).try_normalize(0.0))
            .unwrap_or_default()
    }
}

impl<R: Real> Placed<'_, R> {
    /// The unit vector along which a sliding link keeps its rest length: the normal of the face that its foot is on, or
    /// `beside`, the line from a foot on an edge, on the side that the rest length names.
    fn away(&self, corners: [u32; 3], weights: [f64; 3], beside: Point, rest: f64) -> Point {
        let normal = self.normal(corners, weights, false);
        let is_below = beside.dot(&normal) * rest.signum() < -0.5;
        match beside == Point::zeros() {
            true => normal,
            false if is_below => -beside * rest.signum(),
            false => beside * rest.signum(),
        }
    }
}

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
                let beside = line.try_normalize(0.0).filter(|_| is_on_edge).unwrap_or_default();
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
            let (link, ends) = (self.links[at], self.surface[k].ends);
            let Some(placed) = self.placed(at, models, state, prescribed, time) else { continue };
            let (corners, weights) = placed.corners(&link.sides[1]);
            let normal = match frame.slides && link.rest != 0.0 {
                true => placed.away(corners, weights, self.surface[k].beside, link.rest),
                false => placed.normal(corners, weights, frame.slides),
            };
            let d = vector(&link, &ends, state, prescribed, time);
            let mobility = ends.mobility(&state.displacement);
            if mobility <= 0.0 {
                continue;
            }
            let along = d.dot(&normal);
            let across = d - normal * along;
            // A sliding point without a fixed side keeps the distance on the side where it is now.
            let side =
                if frame.single_sided || !frame.slides { 1.0 } else { along.signum() * link.rest.signum() };
            let rest = link.rest * side * frame.rest_scale_at(time);
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
            let mut lambda = pull(&sweep.normal, link.strength, along - rest);
            if let Some(keep_off) = frame.keep_off {
                // Beyond the spring: on its side, a point stays outside of the kept distance.
                let sign = if link.rest * side < 0.0 { -1.0 } else { 1.0 };
                let after = (along - lambda * mobility) * sign;
                lambda -= sign * (keep_off - after).max(0.0) / mobility;
            }
            let tangent = pull(&sweep.tangent, link.tangent_strength, across.norm());
            let across = across.try_normalize(0.0).unwrap_or_default();
            let push = normal * lambda + across * tangent;
            ends.displace(&mut state.displacement, -push);
            self.surface[k].impulse += push / h;
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
