//! Cloths that start closer than their thickness, or in layers of which one is held, come apart and are not thrown.

use crate::scenes::{LINKS, Vec3, frame, grid, physical, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, Elements, FrameInput, Mass, ModelBuilder, Pin, PointId, Solver, StateView,
    StepReport, Surface,
};

/// Contact thickness of each cloth in metres; two keep twice as much.
const THICKNESS: f64 = 0.01;
const DENSITY: f64 = 0.2;

/// Sheets of a square metre above each other, each turned a little against the last so that no points coincide.
fn stack(sheets: u32, distance: f64, turn: f64) -> Vec<Surface> {
    let sheet = |at: u32| {
        let mut sheet = grid(11, 11, Vec3::x(), Vec3::z());
        let (sin, cos) = (turn * f64::from(at)).sin_cos();
        for place in &mut sheet.positions {
            let (x, z) = (place.x - 0.5, place.z - 0.5);
            *place = Vec3::new(cos * x - sin * z, distance * f64::from(at), sin * x + cos * z);
        }
        sheet
    };
    (0..sheets).map(sheet).collect()
}

/// Sheets in a vacuum and without weight.
fn in_space(sheets: &[Surface]) -> (Solver<f32>, FrameInput) {
    let mut builder = ModelBuilder::new();
    for sheet in sheets {
        builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(DENSITY), LINKS)).expect("a good mesh");
    }
    let cloth = ClothFrame { collide: true, thickness: THICKNESS, elements: Elements::Faces, ..still() };
    let input = FrameInput {
        gravity: Vec3::zeros(),
        air_density: 0.0,
        cloths: vec![cloth; sheets.len()],
        ..frame(3, physical(96.0))
    };
    (Solver::new(builder, 1), input)
}

/// The reports of the first second of some sheets, and the largest root mean square of the speed of all points, in m/s.
fn fly(sheets: &[Surface]) -> (Vec<StepReport>, f64) {
    let (mut solver, input) = in_space(sheets);
    let reports: Vec<_> = (0..24).map(|_| solver.step(&input, &mut ())).collect();
    let mass = DENSITY * sheets.len() as f64;
    let speeds = reports.iter().map(|report| (2.0 * report.kinetic_energy / mass).sqrt());
    let fastest = speeds.fold(0.0, f64::max);
    (reports, fastest)
}

#[test]
fn layers_that_start_too_close_come_apart_and_are_not_thrown() {
    // Before, what one contact had moved without velocity the next returned with it: 10 m/s.
    let (reports, fastest) = fly(&stack(8, 0.1 * THICKNESS, 0.12));
    assert!(fastest < 3.0, "{fastest} m/s");
    let last = reports.last().expect("24 frames");
    assert!(last.min_cloth_gap > 0.99, "they are apart: {}", last.min_cloth_gap);
    assert!(reports.iter().all(|report| report.pairs_unresolved == 0));
}

#[test]
fn two_cloths_in_one_place_come_apart_slowly() {
    let (_, fastest) = fly(&stack(2, 0.0, 0.0));
    assert!(fastest < 0.5, "{fastest} m/s");
}

#[test]
fn a_lower_layer_gives_way_where_the_higher_one_is_held() {
    // The higher layer is pinned as a whole and moves through the place of the lower one, which is free.
    let sheets = stack(2, 3.0 * THICKNESS, 0.12);
    let (mut solver, mut input) = in_space(&sheets);
    input.cloths[1].layer = 1.0;
    let height = |frame: u32| Vec3::y() * (-0.01 * f64::from(frame));
    let mut unresolved = 0;
    for frame in 0..20 {
        let pin = |(point, place): (usize, &Vec3)| Pin {
            cloth: ClothId(1),
            point: PointId(point as u32),
            start: place + height(frame),
            end: place + height(frame + 1),
        };
        input.pins = sheets[1].positions.iter().enumerate().map(pin).collect();
        unresolved += solver.step(&input, &mut ()).pairs_unresolved;
    }
    assert_eq!(unresolved, 0);
    let (held, free) = (0.03 - 0.2, (0..121).map(|point| solver.point(ClothId(0), point).y));
    assert!(free.fold(f64::MIN, f64::max) < held, "it is pushed on before the held one");
}
