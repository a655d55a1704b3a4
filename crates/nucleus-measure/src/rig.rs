//! What cases of validation and experiments are built from: sheets, frames without anything that is not asked for, and
//! runs until nothing moves. Everything in SI units.

use nalgebra::Vector3;
use nucleus_core::{
    BuildError, COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Faces, FrameInput, Mass, ModelBuilder,
    Pin, PointId, Real, ResistanceModel, Solver, StateView, StepReport, Stiffness, Surface,
};

pub type Vec3 = Vector3<f64>;

/// The mass of the cloth in kg/m².
pub const DENSITY: f64 = 0.2;
/// Gravity in m/s².
pub const GRAVITY: f64 = 9.81;
/// The only cloth of a case.
pub const CLOTH: ClothId = ClothId(0);

/// A cloth, its solver, and what each frame brings.
pub struct Rig<R: Real> {
    pub surface: Surface,
    pub solver: Solver<R>,
    pub frame: FrameInput,
}

impl<R: Real> Rig<R> {
    /// A cloth of [`DENSITY`] alone in empty space, in Physical steps: `evaluations` in 1/24 s.
    pub fn new(surface: Surface, lists: ClothLists, evaluations: f64) -> Result<Self, BuildError> {
        let mut builder = ModelBuilder::new();
        builder.cloth(Cloth::new(surface.clone(), Mass::PerArea(DENSITY), lists))?;
        Ok(Self::of(builder, surface, evaluations))
    }

    /// The same of a builder that has its cloth already.
    pub fn of(builder: ModelBuilder, surface: Surface, evaluations: f64) -> Self {
        Self { surface, solver: Solver::new(builder, 1), frame: frame(evaluations) }
    }

    /// The cloth's settings.
    pub fn cloth(&mut self) -> &mut ClothFrame {
        &mut self.frame.cloths[0]
    }

    /// Drag that takes away the velocity in all directions alike, in 1/s.
    pub fn slow_down(&mut self, rate: f64) {
        self.cloth().drag = rate * COUNT_PERIOD * DENSITY;
        self.cloth().tangential_drag = 1.0;
    }

    /// Holds points where they start.
    pub fn hold(&mut self, points: impl IntoIterator<Item = usize>) {
        let pin = |point: usize| {
            let place = self.surface.positions[point];
            Pin { cloth: CLOTH, point: PointId(point as u32), start: place, end: place }
        };
        self.frame.pins.extend(points.into_iter().map(pin));
    }

    pub fn step(&mut self) -> StepReport {
        self.solver.step(&self.frame, &mut ())
    }

    pub fn run(&mut self, frames: u32) {
        (0..frames).for_each(|_| {
            self.step();
        });
    }

    /// Runs until the fastest that the cloth could be on the whole is below `speed` in m/s, or `frames` are over.
    pub fn settle(&mut self, speed: f64, frames: u32) {
        let mass: f64 = areas(&self.surface).iter().sum::<f64>() * DENSITY;
        for frame in 0..frames {
            let slow = self.step().kinetic_energy < mass * speed * speed / 2.0;
            if slow && frame > 4 {
                break;
            }
        }
    }

    pub fn point(&self, point: usize) -> Vec3 {
        self.solver.point(CLOTH, point)
    }

    pub fn points(&self) -> Vec<Vec3> {
        (0..self.surface.positions.len()).map(|point| self.point(point)).collect()
    }
}

/// A frame of 1/24 s in which a cloth feels gravity and nothing else, and has no stiffness of any kind.
pub fn frame(evaluations: f64) -> FrameInput {
    let none = Some(0.0);
    let cloth = ClothFrame {
        stiffness: Stiffness { stretch: none, compression: none, shear: none, bend: none },
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
    }
}

/// As stiff against being shorter as against being longer, in N/m.
pub fn membrane(stiffness: f64) -> Stiffness {
    Stiffness { stretch: Some(stiffness), compression: Some(stiffness), shear: Some(0.0), bend: Some(0.0) }
}

/// Quads, `columns` by `rows` points, from `origin` along `u` and `v`.
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

/// A third of each triangle's area for each of its corners, in m²: how mass is shared out.
pub fn areas(surface: &Surface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.positions.len()];
    for triangle in surface.faces.triangles() {
        let [a, b, c] = triangle.map(|point| surface.positions[point as usize]);
        let third = (b - a).cross(&(c - a)).norm() / 6.0;
        triangle.iter().for_each(|&point| areas[point as usize] += third);
    }
    areas
}

/// Everything that a strip needs: links, cross links, bending, air.
pub const STRIP: ClothLists =
    ClothLists { stretch: true, cross_links: true, bend: true, air: true, ..ClothLists::NONE };
