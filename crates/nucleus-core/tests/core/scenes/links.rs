//! What the tests of links share.

use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, ConstraintFrame, FrameInput, LinkSide, Mass, ModelBuilder,
    PointId, ResistanceModel, Solver, StateView, StepReport, Surface,
};

use super::{Vec3, frame, still};

/// The budget of these tests.
pub const PHYSICAL: ResistanceModel = ResistanceModel::Physical { evaluations: 96.0 };

/// A point of a cloth.
pub fn point(cloth: u32, point: u32) -> LinkSide {
    LinkSide::point(ClothId(cloth), PointId(point))
}

/// A face or an edge of a cloth with weights.
pub fn place(cloth: u32, points: [u32; 3], weights: [f64; 3]) -> LinkSide {
    LinkSide::Cloth { cloth: ClothId(cloth), points: points.map(PointId), weights }
}

/// Free points of one kilogram each.
pub fn points(places: &[Vec3]) -> Cloth {
    let surface = Surface { positions: places.to_vec(), ..Surface::default() };
    Cloth::new(surface, Mass::PerPoint(1.0), ClothLists::NONE)
}

pub fn model(cloths: impl IntoIterator<Item = Cloth>) -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    for cloth in cloths {
        builder.cloth(cloth).expect("a good mesh");
    }
    builder
}

/// A frame of `cloths` cloths without contact, with one constraint.
pub fn tied(cloths: usize, resistance: ResistanceModel, constraint: ConstraintFrame) -> FrameInput {
    let settings = ClothFrame { collide: false, ..still() };
    FrameInput { cloths: vec![settings; cloths], constraints: vec![constraint], ..frame(3, resistance) }
}

/// Steps through `frames` frames; links are formed in the first.
pub fn run(solver: &mut Solver<f64>, input: &mut FrameInput, frames: usize) -> StepReport {
    let mut report = StepReport::default();
    for _ in 0..frames {
        report = solver.step(input, &mut ());
        input.constraints.iter_mut().for_each(|constraint| constraint.formed = None);
    }
    report
}

/// Momentum and angular momentum of free points of one kilogram.
pub fn momenta(solver: &Solver<f64>, counts: &[usize]) -> [Vec3; 2] {
    let (mut linear, mut angular) = (Vec3::zeros(), Vec3::zeros());
    for (cloth, &count) in (0..).map(ClothId).zip(counts) {
        let mut velocities = Vec::new();
        solver.velocities(cloth, 1.0, &mut velocities);
        for (k, velocity) in (0..count).zip(velocities) {
            let velocity = Vec3::from(velocity.map(f64::from));
            linear += velocity;
            angular += solver.point(cloth, k).cross(&velocity);
        }
    }
    [linear, angular]
}
