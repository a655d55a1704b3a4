//! What is fixed once a scene is compiled: the lists of each cloth, laid out to be swept.

pub mod builder;
mod order;
mod row_maps;
mod rows;
pub mod surface;
mod topology;
pub mod vertex_maps;

use std::ops::Range;

use nalgebra::Vector3;

use crate::constraints::hinge::{self, HingeGroup};
use crate::constraints::shear;
use crate::constraints::stretch::{LinkGroup, LinkRow};
use crate::contact::boundary::{BoundaryElements, Pseudonormals, sort_spatially};
use crate::integrate::aerodynamics::AirFactors;
use crate::math::Real;
use crate::model::builder::{Cloth, Collider, Mass};
use crate::model::surface::Surface;
use crate::model::vertex_maps::mean;

pub use order::{Order, by_halves};
pub use row_maps::{Factors, Shares};
pub use rows::{Blocks, Part, Row, RowList};
pub use topology::{
    Link, Seam, fan_triangles, point_areas, seams, shear_links, stretch_links, triangle_area, triangle_edges,
};

/// One cloth: where its points are in the columns of the state, and its lists.
#[derive(Debug, Clone)]
pub struct ClothModel<R> {
    /// Between the user's points and the solver's places (counted from the cloth's first).
    pub order: Order,
    /// Its points in the columns, in blocks.
    pub blocks: Blocks,
    /// Links along edges and, where they are asked for, cross links.
    pub stretch: RowList<LinkGroup<R>>,
    /// Cross links again, held by a resistance of their own.
    pub shear: RowList<LinkGroup<R>>,
    /// Hinges between triangles, and twists of quads.
    pub bend: RowList<HingeGroup<R, 4>>,
    /// Hinges between quads.
    pub fold: RowList<HingeGroup<R, 6>>,
    /// The triangles that touch each block, for normals; empty where no air is felt.
    pub triangles: Vec<Vec<[u32; 3]>>,
    /// What can touch; empty where the scene has no collider.
    pub boundary: BoundaryElements,
    /// Whether its sweeps turn round from time to time: its links close rings of an odd number (triangles, or
    /// quads with cross links), and swept always in one order they would stir it.
    pub turns: bool,
    /// `pointMass`, as a number: air forces are divided by it.
    pub weight: f64,
    /// Mean length of an edge at rest in metres; nought without edges.
    pub edge_length: f64,
    /// Whether velocities are ever damped.
    pub damps: bool,
    /// What its rows get of the strength of a sweep; empty where all get all of it.
    pub shares: Shares<R>,
    /// Factors on what its points feel of the air; empty where they are none.
    pub air: Vec<AirFactors>,
}

impl<R: Real> ClothModel<R> {
    /// Compiles a cloth whose first point is `first` in the columns.
    pub fn new(cloth: &Cloth, first: u32, collides: bool) -> Self {
        let surface = &cloth.surface;
        let order = Order::morton(&surface.positions);
        let blocks = Blocks::new(first, surface.positions.len());
        let (Mass::PerPoint(weight) | Mass::PerArea(weight)) = cloth.mass;
        let mut model = Self {
            order,
            blocks,
            stretch: RowList::default(),
            shear: RowList::default(),
            bend: RowList::default(),
            fold: RowList::default(),
            triangles: Vec::new(),
            boundary: BoundaryElements::default(),
            turns: cloth.lists.cross_links || surface.faces.iter().any(|face| face.len() % 2 == 1),
            weight,
            edge_length: 0.0,
            damps: cloth.lists.damp,
            shares: Shares::default(),
            air: Vec::new(),
        };
        let places = model.order.places().to_vec();
        let place = |point: u32| first + places[point as usize];
        let point = |place: u32| model.order.user((place - first) as usize);
        let factors = Factors { factors: &cloth.factors, point: &point };
        let mut shares = Shares::default();
        if cloth.lists.stretch {
            let rows = stretch_rows(surface, cloth, place);
            shares.stretch = factors.of_links(&rows, &model.blocks);
            shares.damp = factors.of_damping(&rows, &model.blocks);
            model.stretch = RowList::new(&rows, &model.blocks);
        }
        if cloth.lists.shear {
            let rest = &cloth.factors.rest_length;
            model.shear = RowList::new(&shear::rows(surface, rest, place), &model.blocks);
        }
        if cloth.lists.bend {
            let rows = hinge::rows(surface, place);
            shares.bend = factors.of_hinges(&rows.of_four, &model.blocks);
            shares.fold = factors.of_hinges(&rows.of_six, &model.blocks);
            model.bend = RowList::new(&rows.of_four, &model.blocks);
            model.fold = RowList::new(&rows.of_six, &model.blocks);
        }
        if cloth.lists.air {
            model.air = factors.of_air(model.points());
        }
        model.shares = shares;
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

    /// Its points in the columns.
    pub fn points(&self) -> Range<u32> {
        self.blocks.range(0).start..self.blocks.range(self.blocks.len() - 1).end
    }

    /// The factors on what some of its points feel of the air; none where they are none.
    pub fn air_factors(&self, points: &Range<u32>) -> &[AirFactors] {
        let at = |point: u32| (point - self.points().start) as usize;
        if self.air.is_empty() { &[] } else { &self.air[at(points.start)..at(points.end)] }
    }

    /// How many rows and points have factors of their own.
    pub fn factors(&self) -> usize {
        self.shares.len() + self.air.len()
    }

    /// The place in the columns of one of the user's points.
    pub fn place(&self, point: usize) -> u32 {
        self.points().start + self.order.place(point)
    }
}

/// One collider: its mesh, in the user's order.
#[derive(Debug, Clone)]
pub struct ColliderModel {
    /// Where it starts, in metres.
    pub positions: Vec<Vector3<f64>>,
    /// What can touch.
    pub boundary: BoundaryElements,
    /// Its pseudonormals, if it is closed: every edge has two faces.
    pub pseudonormals: Option<Pseudonormals>,
}

impl ColliderModel {
    /// Compiles a collider.
    pub fn new(collider: Collider) -> Self {
        let triangles: Vec<_> = collider.surface.faces.triangles().collect();
        let triangles = sort_spatially(&triangles, |point| collider.surface.positions[point as usize]);
        let boundary = BoundaryElements::new(triangles, 0..collider.surface.positions.len() as u32);
        let pseudonormals = Pseudonormals::of(&boundary);
        Self { positions: collider.surface.positions, boundary, pseudonormals }
    }
}

/// The mass of each point in kilograms, in the user's order.
pub fn point_masses(cloth: &Cloth) -> Vec<f64> {
    let mut masses = even_masses(cloth);
    masses.iter_mut().zip(&cloth.factors.mass).for_each(|(mass, factor)| *mass *= factor);
    masses
}

fn even_masses(cloth: &Cloth) -> Vec<f64> {
    match cloth.mass {
        Mass::PerPoint(mass) => vec![mass; cloth.surface.positions.len()],
        Mass::PerArea(density) => {
            let areas = point_areas(&cloth.surface);
            // A point of no face has no area: it weighs like an average one.
            let faces = areas.iter().filter(|&&area| area > 0.0).count().max(1);
            let average = areas.iter().sum::<f64>() / faces as f64;
            let average = if average > 0.0 { average } else { 1.0 };
            areas.iter().map(|&area| density * if area > 0.0 { area } else { average }).collect()
        }
    }
}

fn stretch_rows<R: Real>(surface: &Surface, cloth: &Cloth, place: impl Fn(u32) -> u32) -> Vec<LinkRow<R>> {
    let links = stretch_links(surface, cloth.lists.cross_links);
    let rest = |link: &Link| mean(&cloth.factors.rest_length, link.ends.map(|end| end as usize).into_iter());
    let mut rows: Vec<LinkRow<R>> = links.iter().map(|link| LinkRow::new(link, rest(link), &place)).collect();
    rows.sort_unstable_by_key(|row| (row.ends[0].min(row.ends[1]), row.ends[0].max(row.ends[1])));
    rows
}

fn mean_length(surface: &Surface) -> f64 {
    let links = stretch_links(surface, false);
    links.iter().map(|link| link.rest_length).sum::<f64>() / links.len().max(1) as f64
}

/// Each block's triangles: all that touch one of its points, so that a block's normals need no other's work.
fn triangles_by_block(surface: &Surface, place: impl Fn(u32) -> u32, blocks: &Blocks) -> Vec<Vec<[u32; 3]>> {
    let mut by_block = vec![Vec::new(); blocks.len()];
    for triangle in surface.faces.triangles() {
        let triangle = triangle.map(&place);
        let [a, b, c] = triangle.map(|point| blocks.of(point));
        by_block[a as usize].push(triangle);
        if b != a {
            by_block[b as usize].push(triangle);
        }
        if c != a && c != b {
            by_block[c as usize].push(triangle);
        }
    }
    by_block.iter_mut().for_each(|triangles| triangles.sort_unstable());
    by_block
}
