//! Fixtures of validation, experiments and benchmarks: sheets, frame inputs without any effect but gravity, and runs to
//! rest. SI units.

use nalgebra::Vector3;
use nucleus_core::{
    BuildError, COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Faces, FrameInput, Mass, ModelBuilder,
    Pin, PointId, Real, ResistanceModel, Solver, StateView, StepReport, Stiffness, Surface,
};

/// A vector in double precision.
pub type Vec3 = Vector3<f64>;

/// Mass of the cloth in kg/m².
pub const DENSITY: f64 = 0.2;
/// Gravity in m/s².
pub const GRAVITY: f64 = 9.81;
/// The only cloth of a fixture.
pub const CLOTH: ClothId = ClothId(0);

/// A cloth, its solver, and the input of every frame.
pub struct Fixture<R: Real> {
    /// The cloth at the start, which is its rest shape.
    pub surface: Surface,
    /// The solver, on one thread.
    pub solver: Solver<R>,
    /// The input of every frame.
    pub frame: FrameInput,
}

impl<R: Real> Fixture<R> {
    /// A cloth of [`DENSITY`] in empty space, read as Physical with `evaluations` per 1/24 s.
    ///
    /// # Errors
    /// When the builder rejects the mesh.
    pub fn new(surface: Surface, lists: ClothLists, evaluations: f64) -> Result<Self, BuildError> {
        let mut builder = ModelBuilder::new();
        builder.cloth(Cloth::new(surface.clone(), Mass::PerArea(DENSITY), lists))?;
        Ok(Self::from_builder(builder, surface, evaluations))
    }

    /// The same for a builder that has its cloth already.
    pub fn from_builder(builder: ModelBuilder, surface: Surface, evaluations: f64) -> Self {
        Self { surface, solver: Solver::new(builder, 1), frame: gravity_only(evaluations) }
    }

    /// Inputs of the cloth.
    pub fn cloth(&mut self) -> &mut ClothFrame {
        &mut self.frame.cloths[0]
    }

    /// Isotropic drag that damps velocity at `rate`, in 1/s.
    pub fn damp_velocity(&mut self, rate: f64) {
        self.cloth().drag = rate * COUNT_PERIOD * DENSITY;
        self.cloth().tangential_drag = 1.0;
    }

    /// Pins points at their initial positions.
    pub fn pin(&mut self, points: impl IntoIterator<Item = usize>) {
        let pin = |point: usize| {
            let place = self.surface.positions[point];
            Pin { cloth: CLOTH, point: PointId(point as u32), start: place, end: place }
        };
        self.frame.pins.extend(points.into_iter().map(pin));
    }

    /// Steps one frame.
    pub fn step(&mut self) -> StepReport {
        self.solver.step(&self.frame, &mut ())
    }

    /// Steps `frames` frames.
    pub fn run(&mut self, frames: u32) {
        (0..frames).for_each(|_| {
            self.step();
        });
    }

    /// Steps until the kinetic energy is below that of the whole cloth at `speed` in m/s, at most `frames` frames.
    pub fn run_to_rest(&mut self, speed: f64, frames: u32) {
        let mass: f64 = vertex_areas(&self.surface).iter().sum::<f64>() * DENSITY;
        for frame in 0..frames {
            let slow = self.step().kinetic_energy < mass * speed * speed / 2.0;
            if slow && frame > 4 {
                break;
            }
        }
    }

    /// Position of a point in metres.
    pub fn point(&self, point: usize) -> Vec3 {
        self.solver.point(CLOTH, point)
    }

    /// Positions of all points in metres.
    pub fn points(&self) -> Vec<Vec3> {
        (0..self.surface.positions.len()).map(|point| self.point(point)).collect()
    }
}

/// Input of a frame of 1/24 s: one cloth without stiffness and air, gravity only.
pub fn gravity_only(evaluations: f64) -> FrameInput {
    let none = Some(0.0);
    let cloth = ClothFrame {
        stiffness: Stiffness { stretch: none, compression: none, shear: none, bend: none, ..Stiffness::NONE },
        stretch_damp: 0.0,
        drag: 0.0,
        lift: 0.0,
        ..ClothFrame::default()
    };
    FrameInput {
        duration: COUNT_PERIOD,
        substeps: 1,
        collision_iterations: 4.0,
        self_collision_iterations: 4.0,
        layer_range: 4.0,
        resistance: ResistanceModel::Physical { evaluations },
        gravity: Vec3::new(0.0, -GRAVITY, 0.0),
        wind: Vec3::zeros(),
        air_density: 1.0,
        plane: None,
        cloths: vec![cloth],
        colliders: Vec::new(),
        pins: Vec::new(),
        ..FrameInput::default()
    }
}

/// The same stiffness in tension and compression, in N/m.
pub fn membrane(stiffness: f64) -> Stiffness {
    Stiffness {
        stretch: Some(stiffness),
        compression: Some(stiffness),
        shear: Some(0.0),
        bend: Some(0.0),
        ..Stiffness::NONE
    }
}

/// A sheet of quads: `columns` by `rows` points, from `origin` along `u` and `v`, row by row along `u`.
pub fn sheet([columns, rows]: [u32; 2], origin: Vec3, u: Vec3, v: Vec3) -> Surface {
    let at = |k: u32, of: u32| f64::from(k) / f64::from(of - 1);
    let points = (0..columns * rows).map(|k| (k % columns, k / columns));
    let positions =
        points.map(|(column, row)| origin + u * at(column, columns) + v * at(row, rows)).collect();
    let mut faces = Faces::default();
    for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
        let a = row * columns + column;
        faces.push(&[a, a + columns, a + columns + 1, a + 1]);
    }
    Surface { positions, faces }
}

/// Area of each vertex in m²: a third of each adjacent triangle, as the solver lumps mass.
pub fn vertex_areas(surface: &Surface) -> Vec<f64> {
    let mut vertex_areas = vec![0.0; surface.positions.len()];
    for triangle in surface.faces.triangles() {
        let [a, b, c] = triangle.map(|point| surface.positions[point as usize]);
        let third = (b - a).cross(&(c - a)).norm() / 6.0;
        triangle.iter().for_each(|&point| vertex_areas[point as usize] += third);
    }
    vertex_areas
}

/// Lists of a strip: links, cross links, bending, air.
pub const STRIP: ClothLists =
    ClothLists { stretch: true, cross_links: true, bend: true, air: true, ..ClothLists::NONE };
