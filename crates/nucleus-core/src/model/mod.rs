//! The model: everything about the objects of a scene that is fixed once it is compiled.
//!
//! A mesh becomes lists of constraint rows. Links keep lengths (stretch, compression, shear) and hinges keep angles
//! (bending, Bergou et al. 2006); the Nucleus paper has the same two kinds (§2.2, §2.4). Points are reordered along a
//! Morton curve and cut into blocks, and rows are coloured, so that a Gauss-Seidel sweep of position-based dynamics
//! (Müller et al. 2007) runs in parallel with the same bits on any number of threads. Stiffness is scaled by the strip
//! of cloth that each row stands for, so that it does not depend on the mesh.
//!
//! | You want to know… | Read |
//! |---|---|
//! | what a cloth or collider is built from, and what is refused | [`objects`], [`builder`], [`build_error`], `refusals.rs` |
//! | polygon meshes | [`surface`] |
//! | edges, cross links, seams, areas | `topology.rs` |
//! | how a mesh becomes the lists of a cloth | `cloth_lists.rs` |
//! | the order of points; the order of links | `order.rs`, `link_order.rs` |
//! | which list an attribute needs | `lists.rs` |
//! | blocks of points; colours and lane groups of rows | `blocks.rs`, `rows.rs` |
//! | distances along a mesh | [`geodesic`] |
//! | links of woven cloth | [`weave`] |
//! | vertex maps, as given and per row | [`vertex_maps`], `strength_maps.rs` |

pub mod blocks;
pub mod build_error;
pub mod builder;
pub mod cloth_lists;
pub mod geodesic;
pub mod link_order;
pub mod lists;
pub mod objects;
pub mod order;
mod refusals;
pub mod rows;
pub mod strength_maps;
pub mod surface;
pub mod topology;
pub mod vertex_maps;
pub mod weave;

use std::ops::Range;

use nalgebra::Vector3;

use crate::constraints::angle::AngleGroup;
use crate::constraints::hinge::{HingeGroup, RestGroup};
use crate::constraints::pressure::PressureModel;
use crate::constraints::shape::ShapeModel;
use crate::constraints::stretch::LinkGroup;
use crate::contact::boundary::{BoundaryElements, Pseudonormals, sort_spatially};
use crate::math::Real;
use crate::model::blocks::Blocks;
use crate::model::lists::ClothLists;
use crate::model::objects::Collider;
use crate::model::order::Order;
use crate::model::rows::RowList;
use crate::model::strength_maps::{AirFactors, StrengthMaps};

/// One cloth: its range in the columns of the state, and its lists. Points are numbered by their row in the columns.
#[derive(Debug, Clone)]
pub struct ClothModel<R> {
    /// The lists that it was built with.
    pub lists: ClothLists,
    /// Between points of the mesh and places, counted from the cloth's first row.
    pub order: Order,
    /// Its rows in the columns, in blocks.
    pub blocks: Blocks,
    /// Links along edges and, with `addCrossLinks`, cross links.
    pub stretch: RowList<LinkGroup<R>>,
    /// Cross links with the shear resistance.
    pub shear: RowList<LinkGroup<R>>,
    /// Hinges of four points: between triangles, and twists of quads.
    pub bend: RowList<HingeGroup<R, 4>>,
    /// Hinges of six points: between quads.
    pub bend_six: RowList<HingeGroup<R, 6>>,
    /// Lengths at rest of the bending vectors of `bend`; empty where it is flat.
    pub bend_rest: RowList<RestGroup<R>>,
    /// The same of `bend_six`.
    pub bend_six_rest: RowList<RestGroup<R>>,
    /// Signed angles of `bend`; empty where only the size of an angle matters.
    pub bend_angles: RowList<AngleGroup<R>>,
    /// The same of `bend_six`.
    pub bend_six_angles: RowList<AngleGroup<R>>,
    /// Chambers whose gas pushes the faces.
    pub pressure: PressureModel,
    /// The shapes that it is pulled back to.
    pub shape: ShapeModel,
    /// Whether it has faces. Particles have none.
    pub has_faces: bool,
    /// Factors on the attraction to the input mesh, by the user's points; empty where it is the same everywhere.
    pub attract: Vec<f64>,
    /// By block: the triangles with a point in it, for normals; empty where no air is felt.
    pub triangles: Vec<Vec<[u32; 3]>>,
    /// The rows of its unconnected parts; empty where it is one part.
    pub parts: Vec<Vec<u32>>,
    /// The elements of contact; empty where no contact is possible.
    pub boundary: BoundaryElements,
    /// Whether its sweeps alternate their direction: its links form odd rings (triangles, or quads with cross links),
    /// and sweeps in one direction would stir it; see [`Schedule::direction`](crate::schedule::Schedule::direction).
    pub alternates_direction: bool,
    /// The number of `pointMass`, whatever its unit; aerodynamic forces are divided by it.
    pub point_mass: f64,
    /// Whether that is per area.
    is_mass_per_area: bool,
    /// Factors on the mass, by row; empty where they are 1.
    mass_map: Vec<f64>,
    /// Mean rest length of an edge in metres; zero without edges, and where no contact is possible.
    pub edge_length: f64,
    /// A hash of its positions at rest; zero for particles, which have no such shape.
    pub rest_shape: u64,
    /// Vertex maps per row; empty where there are none.
    pub strength_maps: StrengthMaps<R>,
    /// Vertex maps of the aerodynamic forces, by row; empty where there are none.
    pub air: Vec<AirFactors>,
    /// Factors on the magnitude of the force field, by row; empty where they are 1.
    pub field_map: Vec<f64>,
    /// The number of links at each point, by row with padding points; empty where links are corrected one after
    /// another.
    pub valence: Vec<R>,
}

impl<R: Real> ClothModel<R> {
    /// Its rows in the columns.
    pub fn points(&self) -> Range<u32> {
        self.blocks.range(0).start..self.blocks.range(self.blocks.len() - 1).end
    }

    /// The maps of the aerodynamic forces at these rows; empty where there are none.
    pub fn air_factors(&self, points: &Range<u32>) -> &[AirFactors] {
        let at = |point: u32| (point - self.points().start) as usize;
        if self.air.is_empty() { &[] } else { &self.air[at(points.start)..at(points.end)] }
    }

    /// The inverse of the mass that the force of a field accelerates at a row, given that of the point: in 1/kg, or in m²/kg
    /// where the mass is per area, so that the motion of cloth in a field does not depend on its mesh.
    pub fn inverse_field_mass(&self, row: u32, inverse_mass: f64) -> f64 {
        if !self.is_mass_per_area || inverse_mass == 0.0 {
            return inverse_mass;
        }
        let factor = self.mass_map.get((row - self.points().start) as usize).copied().unwrap_or(1.0);
        1.0 / (self.point_mass * factor)
    }

    /// Uses only the first `points` rows: those of living particles.
    pub fn resize(&mut self, points: usize) {
        self.blocks.resize(points);
        self.boundary.resize(points);
    }

    /// The places of all points in use, in the order of the mesh.
    pub fn places(&self) -> &[u32] {
        &self.order.places()[..self.points().len()]
    }

    /// The number of rows and points with factors of vertex maps.
    pub fn factors(&self) -> usize {
        self.strength_maps.len() + self.air.len()
    }

    /// The triangles of its surface, each once, in its rows.
    pub fn surface_triangles(&self) -> Vec<[u32; 3]> {
        if !self.boundary.triangles.is_empty() {
            return self.boundary.triangles.clone();
        }
        let of_block = |(block, triangles): (usize, &Vec<[u32; 3]>)| {
            let own = |triangle: &&[u32; 3]| self.blocks.of(triangle[0]) as usize == block;
            triangles.iter().filter(own).copied().collect::<Vec<_>>()
        };
        self.triangles.iter().enumerate().flat_map(of_block).collect()
    }

    /// Whether it has triangles of a surface.
    pub fn has_surface(&self) -> bool {
        !self.boundary.triangles.is_empty() || !self.triangles.iter().all(Vec::is_empty)
    }

    /// The triangles of its surface, counted from its first row.
    pub fn corner_triangles(&self) -> Vec<[u32; 3]> {
        let first = self.points().start;
        self.surface_triangles().into_iter().map(|triangle| triangle.map(|row| row - first)).collect()
    }

    /// The row of a point of the mesh.
    pub fn place(&self, point: usize) -> u32 {
        self.points().start + self.order.place(point)
    }
}

/// The objects of a scene, by their ids.
pub struct Model<R: Real> {
    /// By cloth.
    pub cloths: Vec<ClothModel<R>>,
    /// By collider.
    pub colliders: Vec<ColliderModel>,
}

/// One collider: its mesh, in its own order.
#[derive(Debug, Clone)]
pub struct ColliderModel {
    /// Positions at the start, in metres.
    pub positions: Vec<Vector3<f64>>,
    /// The elements of contact.
    pub boundary: BoundaryElements,
    /// Pseudonormals for the inside test, where every edge has two faces.
    pub pseudonormals: Option<Pseudonormals>,
    /// Factors on the magnitude of its force field, by point; empty where they are 1.
    pub field_map: Vec<f64>,
}

impl ColliderModel {
    /// Compiles a collider with the map of its force field.
    pub fn new(collider: Collider, field_map: Vec<f64>) -> Self {
        let triangles: Vec<_> = collider.surface.faces.triangles().collect();
        let triangles = sort_spatially(&triangles, |point| collider.surface.positions[point as usize]);
        let boundary = BoundaryElements::new(triangles, 0..collider.surface.positions.len() as u32);
        let pseudonormals = Pseudonormals::of(&boundary);
        Self { positions: collider.surface.positions, boundary, pseudonormals, field_map }
    }
}
