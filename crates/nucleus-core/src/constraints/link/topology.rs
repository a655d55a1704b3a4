//! Rows of links on surfaces, and the faces round each point of these surfaces.

use nalgebra::Vector3;

use crate::contact::cloth::elements::CsrLists;
use crate::input::links::{Link, LinkSide};
use crate::input::{ClothId, ColliderId};
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};

use super::ends::Ends;

type Point = Vector3<f64>;

/// One link on a surface.
#[derive(Debug, Clone)]
pub struct SurfaceRow {
    /// The link.
    pub link: u32,
    /// Its free points; those of the foot change where it slides.
    pub ends: Ends,
    /// Direction from the foot of a sliding link to the place, where that is beside the faces and the foot on an edge.
    pub beside: Option<Point>,
    /// Distance that contact keeps between the sides in metres, up to which the link does not pull.
    pub contact_distance: f64,
    /// Impulse since the start of the substep in N·s.
    pub impulse: Point,
}

impl SurfaceRow {
    /// The row of a link.
    pub fn new(link: u32, ends: Ends) -> Self {
        Self { link, ends, beside: None, contact_distance: 0.0, impulse: Point::zeros() }
    }
}

/// The faces round each point of the surfaces that links slide on.
#[derive(Debug, Clone, Default)]
pub struct Topology {
    surfaces: Vec<(SurfaceId, CsrLists)>,
}

/// A surface that links are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceId {
    /// A cloth.
    Cloth(ClothId),
    /// A collider.
    Collider(ColliderId),
}

impl SurfaceId {
    /// The surface of a side.
    pub fn of(side: &LinkSide) -> Option<Self> {
        match side {
            LinkSide::Cloth { cloth, .. } => Some(Self::Cloth(*cloth)),
            LinkSide::Collider { collider, .. } => Some(Self::Collider(*collider)),
            LinkSide::Space(_) => None,
        }
    }
}

impl Topology {
    /// The topology of all surfaces that these links are on.
    pub fn new<R: Real>(links: &[Link], cloths: &[ClothModel<R>], colliders: &[ColliderModel]) -> Self {
        let mut surfaces: Vec<(SurfaceId, CsrLists)> = Vec::new();
        for link in links.iter().filter(|link| link.on_surface) {
            let Some(id) = SurfaceId::of(&link.sides[1]) else { continue };
            if surfaces.iter().any(|(known, _)| *known == id) {
                continue;
            }
            let (first, points, triangles) = match id {
                SurfaceId::Cloth(cloth) => {
                    let model = &cloths[cloth.index()];
                    (model.points().start, model.points().len(), &model.boundary.triangles)
                }
                SurfaceId::Collider(collider) => {
                    let model = &colliders[collider.index()];
                    (0, model.positions.len(), &model.boundary.triangles)
                }
            };
            let corners =
                (0..).zip(triangles).flat_map(|(at, corners)| corners.map(|corner| (corner - first, at)));
            surfaces.push((id, CsrLists::new(points, corners)));
        }
        Self { surfaces }
    }

    /// The faces round each point of a surface.
    pub fn of(&self, id: SurfaceId) -> Option<&CsrLists> {
        self.surfaces.iter().find(|(known, _)| *known == id).map(|(_, faces)| faces)
    }
}
