//! The builder of a solver's objects. It checks every mesh once, and refuses an invalid one with the element named
//! ([`BuildError`]); later code relies on it.

use nalgebra::Vector3;

use crate::contact::cloth::contact::ContactKind;
use crate::input::{ClothId, ColliderId};
use crate::model::build_error::BuildError;
use crate::model::objects::{Cloth, Collider, LinkOrder, Mass};
use crate::model::refusals::{check_particles, check_split, check_start, check_surface, check_warp};
use crate::model::vertex_maps::VertexMaps;

/// Collects the objects of one solver.
#[derive(Debug, Clone, Default)]
pub struct ModelBuilder {
    pub(crate) cloths: Vec<Cloth>,
    pub(crate) colliders: Vec<Collider>,
    /// By cloth.
    pub(crate) link_orders: Vec<LinkOrder>,
    /// By collider: vertex maps of its contact attributes and its force field.
    pub(crate) collider_maps: Vec<VertexMaps>,
}

impl ModelBuilder {
    /// An empty solver.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a cloth.
    ///
    /// # Errors
    /// When the mesh is empty, without area, not finite or names points it does not have, a face of woven cloth has no
    /// direction of the warp, the mass is not positive, or there are 11,585 cloths already; see [`BuildError`].
    pub fn cloth(&mut self, cloth: Cloth) -> Result<ClothId, BuildError> {
        if self.cloths.len() >= ContactKind::MAX_CLOTHS {
            return Err(BuildError::TooManyCloths { most: ContactKind::MAX_CLOTHS });
        }
        match &cloth.particles {
            Some(particles) => check_particles(&cloth.surface, particles)?,
            None => check_surface(&cloth.surface)?,
        }
        let (Mass::PerPoint(mass) | Mass::PerArea(mass)) = cloth.mass;
        if !(mass > 0.0 && mass.is_finite()) {
            return Err(BuildError::BadMass { mass });
        }
        check_warp(&cloth)?;
        cloth.vertex_maps.check(cloth.surface.positions.len())?;
        check_start(&cloth.start, cloth.surface.positions.len())?;
        check_split(&cloth)?;
        self.cloths.push(cloth);
        self.link_orders.push(LinkOrder::Sequential);
        Ok(ClothId(self.cloths.len() as u32 - 1))
    }

    /// The cloths, by their ids.
    pub fn cloths(&self) -> &[Cloth] {
        &self.cloths
    }

    /// The positions of a cloth at the start, in metres.
    ///
    /// # Panics
    /// When there is no such cloth.
    pub fn positions(&self, cloth: ClothId) -> &[Vector3<f64>] {
        self.cloths[cloth.index()].positions()
    }

    /// The colliders, by their ids.
    pub fn colliders(&self) -> &[Collider] {
        &self.colliders
    }

    /// Adds a collider.
    ///
    /// # Errors
    /// When the mesh is empty, without area, not finite or names points it does not have; see [`BuildError`].
    pub fn collider(&mut self, collider: Collider) -> Result<ColliderId, BuildError> {
        check_surface(&collider.surface)?;
        self.colliders.push(collider);
        self.collider_maps.push(VertexMaps::default());
        Ok(ColliderId(self.colliders.len() as u32 - 1))
    }

    /// Sets the order in which the links of a cloth are corrected.
    ///
    /// # Errors
    /// When there is no such cloth, or the cloth lacks a point that the order begins at.
    pub fn set_link_order(&mut self, cloth: ClothId, order: LinkOrder) -> Result<(), BuildError> {
        let id = cloth.0;
        let cloth = self.cloths.get(cloth.index()).ok_or(BuildError::NoCloth { cloth: id })?;
        let points = cloth.surface.positions.len();
        if let LinkOrder::Outwards(sources) = &order
            && let Some(point) = sources.iter().find(|point| point.index() >= points)
        {
            return Err(BuildError::NoSource { point: point.0, points });
        }
        self.link_orders[id as usize] = order;
        Ok(())
    }

    /// The vertex maps of each collider.
    pub fn collider_maps(&self) -> &[VertexMaps] {
        &self.collider_maps
    }

    /// Sets the vertex maps of a collider, one factor per point in the mesh's order. Those of contact attributes and of
    /// the force field have an effect.
    ///
    /// # Errors
    /// When there is no such collider, there is not one factor per point, or one is no number from 0 to 1e6.
    pub fn set_collider_maps(&mut self, collider: ColliderId, maps: VertexMaps) -> Result<(), BuildError> {
        let of = self.colliders.get(collider.index());
        maps.check(of.ok_or(BuildError::NoCollider { collider: collider.0 })?.surface.positions.len())?;
        self.collider_maps[collider.index()] = maps;
        Ok(())
    }
}
