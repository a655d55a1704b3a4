//! Stacks and folds at rest do not creep.

use crate::scenes::{LINKS, Vec3, frame, grid, ground, physical, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Elements, FrameInput, Mass, ModelBuilder, SelfCollision, Solver,
    StateView, Surface,
};

const SHEETS: u32 = 5;
/// Points of a sheet.
const POINTS: usize = 36;
const THICKNESS: f64 = 0.003;

/// How far each point of five sheets of 10 cm slides down a slope in a second, in metres, starting `from` frames after
/// they were laid on it. Their friction is 0.5 among each other, and 0.25 plus that of the ground with it.
fn slid(degrees: f64, ground_friction: f64, from: usize) -> Vec<f64> {
    let (sin, cos) = f64::to_radians(degrees).sin_cos();
    let mut builder = ModelBuilder::new();
    for sheet in 0..SHEETS {
        let mut surface = grid(6, 6, Vec3::x() * 0.1, Vec3::z() * 0.1);
        let height = THICKNESS * (1.0 + 2.0 * f64::from(sheet)) * 1.01;
        surface.positions.iter_mut().for_each(|p| p.y += height);
        builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), LINKS)).expect("a good mesh");
    }
    let cloth = ClothFrame { thickness: THICKNESS, friction: 0.25, ..still() };
    let input = FrameInput {
        // Gravity is tilted instead of the slope.
        gravity: Vec3::new(9.81 * sin, -9.81 * cos, 0.0),
        plane: Some(ground(ground_friction)),
        cloths: vec![cloth; SHEETS as usize],
        ..frame(3, physical(96.0))
    };
    let mut solver = Solver::<f32>::new(builder, 1);
    let mut after = |frames: usize| {
        (0..frames).for_each(|_| {
            solver.step(&input, &mut ());
        });
        let along = |sheet: u32| (0..POINTS).map(move |k| (sheet, k));
        (0..SHEETS).flat_map(along).map(|(sheet, k)| solver.point(ClothId(sheet), k).x).collect::<Vec<_>>()
    };
    let (laid, gone) = (after(from), after(24));
    laid.iter().zip(gone).map(|(laid, gone)| gone - laid).collect()
}

#[test]
fn a_stack_of_sheets_holds_on_a_slope_that_its_friction_holds_on() {
    // Friction holds up to atan 0.5 = 26.57 degrees. While it settles, the stack slips by half a millimetre.
    let gone = [0, 24].map(|from| slid(20.0, 0.25, from));
    assert!(gone[0].iter().all(|x| x.abs() < 1e-3), "{gone:?}");
    assert!(gone[1].iter().all(|x| x.abs() < 1e-5), "{gone:?}");
}

#[test]
fn a_stack_of_sheets_slides_down_a_smoother_slope_as_one() {
    let gone = slid(20.0, 0.0, 3);
    let steep = f64::to_radians(20.0);
    let pace = 9.81 * (steep.sin() - 0.25 * steep.cos());
    let exact = pace / 2.0 * ((27.0f64 / 24.0).powi(2) - (3.0f64 / 24.0).powi(2));
    assert!(gone.iter().all(|x| (x / exact - 1.0).abs() < 0.02), "{gone:?} for {exact}");
}

/// A strip of 9 by 45 cm that stands upright, sinks to the ground and folds onto itself.
fn folding_strip() -> (Surface, FrameInput) {
    let mut strip = grid(5, 21, Vec3::x() * 0.09, Vec3::new(0.0, 0.45, 0.02));
    strip.positions.iter_mut().for_each(|p| p.y += 0.004);
    let self_collision =
        SelfCollision { on: true, thickness: THICKNESS, elements: Elements::Faces, edges: true };
    let cloth = ClothFrame {
        bend_resistance: 0.1,
        thickness: THICKNESS,
        friction: 0.2,
        damp: 0.2,
        self_collision,
        ..still()
    };
    (strip, FrameInput { plane: Some(ground(0.2)), cloths: vec![cloth], ..frame(3, physical(96.0)) })
}

#[test]
fn a_strip_folded_onto_itself_rests_for_a_thousand_frames() {
    const SIZE: f64 = 0.45;
    let (strip, input) = folding_strip();
    let points = strip.positions.len();
    let lists = ClothLists { bend: true, damp: true, self_collision: true, ..LINKS };
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(strip, Mass::PerArea(0.2), lists)).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let mut step = || {
        let contacts = solver.step(&input, &mut ()).contacts;
        (contacts, (0..points).map(|k| solver.point(ClothId(0), k)).collect::<Vec<Vec3>>())
    };
    let farthest = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    // The last fold turns over in the tenth second.
    (0..360).for_each(|_| {
        step();
    });
    let (contacts, settled) = step();
    assert!(contacts > 0 && settled.iter().all(|p| p.y < 0.1), "it touches itself");
    let mut last = settled.clone();
    for frame in 0..1000 {
        let (_, now) = step();
        let squares = last.iter().zip(&now).map(|(a, b)| (a - b).norm_squared());
        let speed = (squares.sum::<f64>() / points as f64).sqrt() * 24.0;
        assert!(speed < 1e-3 * SIZE, "{speed} m/s {frame} frames later");
        last = now;
    }
    let crept = farthest(&settled, &last);
    assert!(crept < 1e-3 * SIZE, "a point of it crept {crept} m");
    // The velocities for caches show no motion either: a picture would be blurred.
    let mut velocities = Vec::new();
    solver.velocities(ClothId(0), 1.0, &mut velocities);
    let squares = velocities.iter().flatten().map(|v| f64::from(*v).powi(2));
    let speed = (squares.sum::<f64>() / points as f64).sqrt();
    assert!(speed < 2e-3 * SIZE, "it lies still at {speed} m/s");
}
