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
//! | the order of points; the order of links | `order.rs`, `link_order.rs` |
//! | blocks of points; colours and lane groups of rows | `blocks.rs`, `rows.rs` |
//! | distances along a mesh | [`geodesic`] |
//! | links of woven cloth | [`weave`] |
//! | vertex maps, as given and per row | [`vertex_maps`], `strength_maps.rs` |

pub mod blocks;
pub mod build_error;
pub mod builder;
pub mod geodesic;
pub mod link_order;
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

use crate::bytes::hash_word;
use crate::constraints::angle::AngleGroup;
use crate::constraints::hinge::{self, HingeGroup, HingeRow, RestGroup};
use crate::constraints::pressure::PressureModel;
use crate::constraints::shape::ShapeModel;
use crate::constraints::stretch::{LinkGroup, LinkRow, shear_rows};
use crate::contact::boundary::{BoundaryElements, Pseudonormals, sort_spatially};
use crate::math::Real;
use crate::model::blocks::{Blocks, triangles_by_block};
use crate::model::objects::{Cloth, Collider, LinkOrder, Mass, point_masses};
use crate::model::order::Order;
use crate::model::rows::RowList;
use crate::model::strength_maps::{AirFactors, MapReader, StrengthMaps, weave_of};
use crate::model::surface::Surface;
use crate::model::topology::{Link, rows_of_parts, stretch_links};
use crate::model::vertex_maps::mean;
use crate::model::weave::woven_links;

/// One cloth: its range in the columns of the state, and its lists. Points are numbered by their row in the columns.
#[derive(Debug, Clone)]
pub struct ClothModel<R> {
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
    /// Whether links and bends can stay as they are deformed.
    pub plastic: bool,
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
    /// Whether damping is ever non-zero.
    pub damps: bool,
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
    /// Compiles a cloth whose first row in the columns is `first`. `collides`: contact is possible.
    pub fn new(cloth: &Cloth, order_of_links: &LinkOrder, first: u32, collides: bool) -> Self {
        let surface = &cloth.surface;
        let capacity = cloth.particles.as_ref().map_or(0, |particles| particles.capacity);
        let rows = surface.positions.len().max(capacity);
        let order = match cloth.particles {
            Some(_) => Order::identity(rows),
            None => Order::morton(&surface.positions),
        };
        let blocks = Blocks::new(first, rows);
        let (Mass::PerPoint(point_mass) | Mass::PerArea(point_mass)) = cloth.mass;
        let mut model = Self {
            order,
            blocks,
            stretch: RowList::default(),
            shear: RowList::default(),
            bend: RowList::default(),
            bend_six: RowList::default(),
            bend_rest: RowList::default(),
            bend_six_rest: RowList::default(),
            bend_angles: RowList::default(),
            bend_six_angles: RowList::default(),
            pressure: PressureModel::default(),
            shape: ShapeModel::default(),
            plastic: cloth.lists.plastic,
            has_faces: !surface.faces.is_empty(),
            attract: cloth.vertex_maps.input_attract.clone(),
            triangles: Vec::new(),
            parts: Vec::new(),
            boundary: BoundaryElements::default(),
            alternates_direction: cloth.lists.cross_links
                || !cloth.warp.is_empty()
                || surface.faces.iter().any(|face| face.len() % 2 == 1),
            point_mass,
            is_mass_per_area: matches!(cloth.mass, Mass::PerArea(_)),
            mass_map: Vec::new(),
            edge_length: 0.0,
            damps: cloth.lists.damp,
            rest_shape: rest_shape(cloth),
            strength_maps: StrengthMaps::default(),
            air: Vec::new(),
            field_map: Vec::new(),
            valence: Vec::new(),
        };
        let places = model.order.places().to_vec();
        let place = |point: u32| first + places[point as usize];
        let point = |place: u32| model.order.user((place - first) as usize);
        let blocks = model.blocks.clone();
        let maps = MapReader { maps: &cloth.vertex_maps, point: &point, blocks: &blocks };
        let distances = link_order::distances(surface, order_of_links);
        let keeps_order = *order_of_links == LinkOrder::Mesh;
        let row_count = model.blocks.row_count();
        let levels = |rows: &[LinkRow<R>]| match keeps_order {
            true => link_order::levels_of_list(rows, first, row_count),
            false => link_order::levels(rows, &distances, point),
        };
        let mut strength_maps = StrengthMaps::default();
        if cloth.lists.stretch {
            model.parts = rows_of_parts(surface, place);
            let mut rows = stretch_rows(surface, cloth, place);
            if !keeps_order {
                rows.sort_unstable_by_key(|row| (row.ends[0].min(row.ends[1]), row.ends[0].max(row.ends[1])));
            }
            let levels = levels(&rows);
            strength_maps.stretch = maps.links(&rows, &levels);
            strength_maps.damp = maps.damping(&rows, &levels);
            if cloth.lists.buckling || !cloth.warp.is_empty() {
                strength_maps.stretch_weave = weave_of(&rows, &levels, &blocks);
            }
            model.stretch = RowList::in_levels(&rows, &levels, &blocks);
        }
        if cloth.lists.shear {
            let rest = &cloth.vertex_maps.rest_length;
            let rows = shear_rows(surface, &cloth.warp, rest, place);
            let levels = levels(&rows);
            if !cloth.warp.is_empty() {
                strength_maps.shear_weave = weave_of(&rows, &levels, &blocks);
            }
            model.shear = RowList::in_levels(&rows, &levels, &blocks);
        }
        if cloth.lists.bend {
            let rows = hinge::rows(surface, place);
            strength_maps.bend = maps.hinges(&rows.of_four);
            strength_maps.bend_six = maps.hinges(&rows.of_six);
            model.bend = RowList::new(&rows.of_four, &model.blocks);
            model.bend_six = RowList::new(&rows.of_six, &model.blocks);
            model.bend_rest = rests(&rows.of_four, &model.blocks);
            model.bend_six_rest = rests(&rows.of_six, &model.blocks);
            let is_bent = model.bend_rest.len() + model.bend_six_rest.len() > 0;
            if cloth.lists.bend_angles || cloth.lists.signed_bend && is_bent {
                let four: Vec<_> = rows.of_four.iter().map(|row| row.angle(surface, point)).collect();
                let six: Vec<_> = rows.of_six.iter().map(|row| row.angle(surface, point)).collect();
                model.bend_angles = RowList::new(&four, &model.blocks);
                model.bend_six_angles = RowList::new(&six, &model.blocks);
                strength_maps.angles = maps.angles(&rows.of_four);
                strength_maps.angles_six = maps.angles(&rows.of_six);
            }
        }
        if cloth.lists.pressure {
            model.pressure = PressureModel::new(surface, place, &model.blocks);
        }
        if cloth.lists.shape {
            let masses = point_masses(cloth);
            model.shape = ShapeModel::new(
                surface,
                place,
                &masses,
                [&cloth.vertex_maps.rigidity, &cloth.vertex_maps.deform],
                cloth.lists.shells,
            );
        }
        if cloth.lists.air {
            model.air = maps.air(model.points());
        }
        let by_row = |factors: &Vec<f64>| model.points().map(|row| factors[point(row)]).collect::<Vec<_>>();
        let maps = [&cloth.vertex_maps.field_magnitude, &cloth.vertex_maps.mass];
        let maps = maps.map(|map| if map.is_empty() { Vec::new() } else { by_row(map) });
        [model.field_map, model.mass_map] = maps;
        if *order_of_links == LinkOrder::Parallel {
            let groups = model.stretch.groups().iter().chain(model.shear.groups());
            model.valence = link_order::valence(groups, first, model.blocks.row_count());
        }
        model.strength_maps = strength_maps;
        if cloth.lists.air {
            model.triangles = triangles_by_block(surface, place, &model.blocks);
        }
        if collides {
            let triangles: Vec<_> = surface.faces.triangles().collect();
            let place_at = |point: u32| surface.positions[point as usize];
            let triangles = sort_spatially(&triangles, place_at).into_iter().map(|t| t.map(place)).collect();
            model.boundary = BoundaryElements::new(triangles, model.points());
            model.edge_length = mean_length(surface);
        }
        model
    }

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

    /// The row of a point of the mesh.
    pub fn place(&self, point: usize) -> u32 {
        self.points().start + self.order.place(point)
    }
}

/// A hash of the positions of a cloth at rest; zero for particles.
fn rest_shape(cloth: &Cloth) -> u64 {
    let positions = cloth.surface.positions.iter().filter(|_| cloth.particles.is_none());
    positions.flat_map(|p| [p.x, p.y, p.z]).map(f64::to_bits).fold(0, hash_word)
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

/// The lengths of the bending vectors at rest; empty where all hinges are flat.
fn rests<R: Real, const N: usize>(rows: &[HingeRow<R, N>], blocks: &Blocks) -> RowList<RestGroup<R>> {
    if !rows.iter().any(HingeRow::is_bent) {
        return RowList::default();
    }
    RowList::new(&rows.iter().map(HingeRow::at_rest).collect::<Vec<_>>(), blocks)
}

fn stretch_rows<R: Real>(surface: &Surface, cloth: &Cloth, place: impl Fn(u32) -> u32) -> Vec<LinkRow<R>> {
    let links = match cloth.warp.is_empty() {
        true => stretch_links(surface, cloth.lists.cross_links),
        false => woven_links(surface, &cloth.warp).edges,
    };
    let rest =
        |link: &Link| mean(&cloth.vertex_maps.rest_length, link.ends.map(|end| end as usize).into_iter());
    links.iter().map(|link| LinkRow::new(link, rest(link), &place)).collect()
}

fn mean_length(surface: &Surface) -> f64 {
    let links = stretch_links(surface, false);
    links.iter().map(|link| link.rest_length).sum::<f64>() / links.len().max(1) as f64
}
