//! The surface of a link at a time of the frame: its nearest place, its normal, and the gradient of a link on it.

use nalgebra::Vector3;

use crate::contact::narrow_phase::closest_on_triangle;
use crate::input::PointId;
use crate::input::links::{ConstraintFrame, Link, LinkSide};
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};
use crate::state::State;

use super::ends::Prescribed;
use super::gradient::{Gradient, direction_on};
use super::topology::{CsrLists, SurfaceId, SurfaceRow};

type Point = Vector3<f64>;

/// Along which direction a link on a surface is projected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Normal,
    Tangent,
}

/// Sine of the angle to the normal within which a link on an edge is above it.
const ABOVE: f64 = 1e-3;

/// Steps of a walk from face to face, at most.
const MAX_STEPS: usize = 64;

/// A surface at a time of the frame. Points are numbered by rows (cloth), or as in the mesh (collider).
pub(super) struct Placed<'a, R> {
    pub(super) id: SurfaceId,
    pub(super) faces: &'a CsrLists,
    pub(super) cloths: &'a [ClothModel<R>],
    pub(super) colliders: &'a [ColliderModel],
    pub(super) state: &'a State<R>,
    pub(super) prescribed: Prescribed<'a>,
    pub(super) time: f64,
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
    pub(super) fn corners(&self, side: &LinkSide) -> ([u32; 3], [f64; 3]) {
        match *side {
            LinkSide::Cloth { cloth, points, weights } => {
                (points.map(|point| self.cloths[cloth.index()].place(point.index())), weights)
            }
            LinkSide::Collider { points, weights, .. } => (points.map(|point| point.0), weights),
            LinkSide::Space(_) => ([0; 3], [0.0; 3]),
        }
    }

    pub(super) fn side(&self, corners: [u32; 3], weights: [f64; 3]) -> LinkSide {
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

    pub(super) fn at(&self, corners: [u32; 3], weights: [f64; 3]) -> Point {
        corners.into_iter().zip(weights).map(|(corner, weight)| self.position(corner) * weight).sum()
    }

    /// The nearest place of the surface, on a walk that begins at these corners.
    pub(super) fn nearest(
        &self,
        place: Point,
        mut corners: [u32; 3],
        mut weights: [f64; 3],
    ) -> ([u32; 3], [f64; 3]) {
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

    /// Whether a link leaves the surface at a place on an edge sideways. Where faces meet flat its line is their normal, and it
    /// is above both.
    pub(super) fn is_beside(&self, (corners, weights): ([u32; 3], [f64; 3]), line: Point) -> bool {
        let is_on_edge = weights.iter().any(|weight| *weight <= 0.0);
        is_on_edge && line.cross(&self.normal(corners, weights, false)).norm() > ABOVE
    }

    /// The unit normal at a place: of its face, or interpolated between those of the corners, so that it changes smoothly
    /// where links slide on the surface itself.
    pub(super) fn normal(&self, corners: [u32; 3], weights: [f64; 3], is_smooth: bool) -> Point {
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
    /// The direction of a link that leaves its surface sideways, while it slides.
    fn beside(&self, row: &SurfaceRow) -> Option<Point> {
        row.beside.filter(|_| self.prescribed.frame.slides)
    }

    /// The unit vector along which a link with the distance vector `d` keeps its rest length: the normal; of an oblique link
    /// its direction, which turns with the face; of a sliding link beside its face the line from its foot on an edge, where it
    /// has no side. An edge of cloth takes up no torque: there the line is `d`, and friction does not act.
    pub(super) fn hold(&self, link: &Link, row: &SurfaceRow, frame: &ConstraintFrame, d: Point) -> Point {
        let (corners, weights) = self.corners(&link.sides[1]);
        if let Some(direction) = self.oblique(link) {
            return direction_on(corners.map(|corner| self.position(corner)), direction);
        }
        // At a distance, a place above a face is not along the normal between corners.
        let normal = self.normal(corners, weights, frame.slides && link.rest == 0.0);
        match (self.beside(row).filter(|_| link.rest != 0.0), self.id) {
            (None, _) => normal,
            (Some(line), SurfaceId::Collider(_)) => line * link.rest.signum(),
            (Some(_), SurfaceId::Cloth(_)) => d.try_normalize(0.0).unwrap_or(normal) * link.rest.signum(),
        }
    }

    /// The direction of an oblique link. One that slides is along the normal, or beside.
    fn oblique(&self, link: &Link) -> Option<[f64; 2]> {
        link.oblique().filter(|_| !self.prescribed.frame.slides)
    }

    /// The gradient of d·`unit`, with the turn of the face where that is cloth. `hold` is the vector that turns with it.
    pub(super) fn gradient(
        &self,
        link: &Link,
        row: &SurfaceRow,
        direction: Direction,
        [d, hold, unit]: [Point; 3],
    ) -> Gradient {
        let mut gradient = Gradient::along(&row.ends, unit);
        let turns = matches!(self.id, SurfaceId::Cloth(_)) && self.beside(row).is_none();
        if turns {
            let (corners, _) = self.corners(&link.sides[1]);
            let face = corners.map(|corner| self.position(corner));
            let (lever, factor) = match direction {
                Direction::Normal => (d, -1.0),
                Direction::Tangent => (unit, d.dot(&hold)),
            };
            match self.oblique(link) {
                None => gradient.add_tilt((corners, face), hold, (lever, factor), link.weight[0]),
                Some(_) => gradient.add_turn((corners, face), lever.cross(&hold) * factor, link.weight[0]),
            }
        }
        gradient
    }
}
