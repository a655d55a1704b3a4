//! What a solver is built from: cloth, particles and colliders.

use std::fmt;

use nalgebra::Vector3;

use crate::input::PointId;
use crate::input::particles::{CollisionEvent, ParticleRamp};
use crate::model::lists::ClothLists;
use crate::model::surface::Surface;
use crate::model::topology::point_areas;
use crate::model::vertex_maps::VertexMaps;

/// The mass of a cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mass {
    /// Kilograms at every point, like Maya's `pointMass`.
    PerPoint(f64),
    /// Kilograms per square metre, distributed by the area of each point; independent of the mesh.
    PerArea(f64),
}

/// The order in which the links of a cloth are corrected in a sweep.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum LinkOrder {
    /// One after another, by colours.
    #[default]
    Sequential,
    /// One after another as the mesh numbers them: edges by their lower end, then cross links. A block of points keeps
    /// this order, and the links between blocks follow. It costs more than colours.
    Mesh,
    /// One after another, outwards from these points (`sortLinks`).
    Outwards(Vec<PointId>),
    /// All from the same state (`evaluationOrder`: Parallel).
    Parallel,
}

/// A mesh that becomes cloth. Its shape is the rest shape, and the start unless `start` gives another.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloth {
    /// The mesh in world space, in metres. Without faces its points are free particles.
    pub surface: Surface,
    /// Its mass.
    pub mass: Mass,
    /// The lists that it can ever need.
    pub lists: ClothLists,
    /// Of woven cloth, the direction of the warp in each face of the surface; empty for other cloth.
    pub warp: Vec<Vector3<f64>>,
    /// Vertex maps of its attributes.
    pub vertex_maps: VertexMaps,
    /// Positions and velocities at the start, where they differ from the mesh at rest.
    pub start: Start,
    /// Capacity for particles that are born and die; only without faces.
    pub particles: Option<Particles>,
    /// Of each of the last points, the point that it was split off, so that the mesh can tear between the two. For the air
    /// inside, a mesh is whole until it tears.
    pub split_off: Vec<u32>,
}

/// An object in which particles are born and die. Its points are the first particles; there may be none.
#[derive(Clone, PartialEq, Default)]
pub struct Particles {
    /// The largest number of particles at any time.
    pub capacity: usize,
    /// Ages in seconds at which the first particles die, one per point; empty for never.
    pub lifespans: Vec<f64>,
    /// Ages of the first particles in seconds, one per point; empty for zero.
    pub ages: Vec<f64>,
    /// Numbers of the first particles, one per point; empty to count them from 0.
    pub ids: Vec<u64>,
    /// Radius in metres that ramps read.
    pub radius: f64,
    /// Factors on attributes of each particle, one per attribute at most.
    pub ramps: Vec<ParticleRamp>,
    /// What happens when particles collide.
    pub events: Vec<CollisionEvent>,
    /// Whether contact turns them (`computeRotation`).
    pub rotates: bool,
}

/// Without the capacity, which says how far a run goes and nothing about its objects.
impl fmt::Debug for Particles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { capacity: _, lifespans, ages, ids, radius, ramps, events, rotates } = self;
        f.debug_struct("Particles")
            .field("lifespans", lifespans)
            .field("ages", ages)
            .field("ids", ids)
            .field("radius", radius)
            .field("ramps", ramps)
            .field("events", events)
            .field("rotates", rotates)
            .finish_non_exhaustive()
    }
}

/// The start of a cloth, one entry per point in the mesh's order. The rest shape is still the mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Start {
    /// In metres; empty for those of the mesh.
    pub positions: Vec<Vector3<f64>>,
    /// In m/s; empty for zero.
    pub velocities: Vec<Vector3<f64>>,
}

impl Cloth {
    /// A cloth without vertex maps, at rest in the shape of its mesh.
    pub fn new(surface: Surface, mass: Mass, lists: ClothLists) -> Self {
        Self {
            surface,
            mass,
            lists,
            warp: Vec::new(),
            vertex_maps: VertexMaps::default(),
            start: Start::default(),
            particles: None,
            split_off: Vec::new(),
        }
    }

    /// The positions at the start, in metres.
    pub fn positions(&self) -> &[Vector3<f64>] {
        if self.start.positions.is_empty() { &self.surface.positions } else { &self.start.positions }
    }

    /// The mass of each point in kilograms, in the mesh's order, as the solver uses it.
    pub fn point_masses(&self) -> Vec<f64> {
        point_masses(self)
    }
}

/// A passive mesh that cloth collides with (an nRigid), in world space; [`ColliderFrame`](crate::ColliderFrame) moves
/// it.
#[derive(Debug, Clone, PartialEq)]
pub struct Collider {
    /// The mesh at the start, in metres.
    pub surface: Surface,
}

/// The mass of each point in kilograms, in the mesh's order.
pub fn point_masses(cloth: &Cloth) -> Vec<f64> {
    let mut masses = even_masses(cloth);
    masses.iter_mut().zip(&cloth.vertex_maps.mass).for_each(|(mass, factor)| *mass *= factor);
    masses
}

fn even_masses(cloth: &Cloth) -> Vec<f64> {
    match cloth.mass {
        Mass::PerPoint(mass) => vec![mass; cloth.surface.positions.len()],
        Mass::PerArea(density) => {
            let areas = point_areas(&cloth.surface);
            // A point of no face has no area: it gets the average mass.
            let faces = areas.iter().filter(|&&area| area > 0.0).count().max(1);
            let average = areas.iter().sum::<f64>() / faces as f64;
            let average = if average > 0.0 { average } else { 1.0 };
            areas.iter().map(|&area| density * if area > 0.0 { area } else { average }).collect()
        }
    }
}
