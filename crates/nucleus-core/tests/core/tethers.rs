//! Tethers: what they hold, what they leave alone, and their pass.

use crate::scenes::{LINKS, Vec3, drape, frame, grid, one_cloth, physical, pins, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, FrameInput, Mass, ModelBuilder, Pin, PointId, Solver, StateView,
    Stiffness, VertexMaps,
};
use proptest::prelude::*;

const CLOTH: ClothId = ClothId(0);
const TETHERED: ClothLists = ClothLists { tethers: true, ..LINKS };

fn tethered() -> ClothFrame {
    ClothFrame { tethers: Some(1.0), ..still() }
}

/// A sheet of 1 m and 0.2 kg/m² that swings down from its pins.
fn swinging(side: u32, held: &[usize], cloth: ClothFrame) -> (ModelBuilder, FrameInput) {
    let sheet = grid(side, side, Vec3::x(), Vec3::z());
    let input = FrameInput {
        pins: pins(&sheet, held.iter().copied()),
        cloths: vec![cloth],
        ..frame(3, physical(96.0))
    };
    (one_cloth(sheet, TETHERED), input)
}

/// The largest strain of a sheet of 65 by 65 points that swings down from two corners.
fn worst_strain(cloth: ClothFrame, evaluations: f64) -> f64 {
    let (builder, mut input) = swinging(65, &[0, 64], cloth);
    input.resistance = physical(evaluations);
    let mut solver = Solver::<f32>::new(builder, 1);
    (0..24).map(|_| solver.step(&input, &mut ()).max_strain).fold(0.0, f64::max)
}

#[test]
fn a_tethered_sheet_stretches_less_than_one_without_tethers_at_four_times_the_evaluations() {
    let (with, without) = (worst_strain(tethered(), 96.0), worst_strain(still(), 384.0));
    assert!(with < without, "{with} with tethers, {without} at four times the evaluations");
}

#[test]
fn no_point_is_farther_from_a_pin_than_the_flat_sheet_reaches() {
    let (builder, input) = swinging(17, &[0, 16], tethered());
    let rest = grid(17, 17, Vec3::x(), Vec3::z()).positions;
    let mut solver = Solver::<f32>::new(builder, 1);
    for _ in 0..24 {
        solver.step(&input, &mut ());
        for (point, own) in rest.iter().enumerate() {
            for pin in [0, 16] {
                let reach = (own - rest[pin]).norm();
                let found = (solver.point(CLOTH, point) - rest[pin]).norm();
                // Lengths along a mesh are up to 1 % above the straight line, and the farther pin comes first.
                assert!(found < 1.011 * reach + 2e-3, "{point} from {pin}: {found} m of {reach} m");
            }
        }
    }
}

/// Positions and the largest 99 % strain of a strip that hangs by its upper edge in a wind.
fn in_wind(lists: ClothLists, evaluations: f64, threads: usize) -> (u64, f64) {
    let strip = grid(9, 129, Vec3::x() / 8.0, -2.0 * Vec3::y());
    let cloth = ClothFrame { drag: 0.05, ..tethered() };
    let input = FrameInput {
        pins: pins(&strip, 0..9),
        cloths: vec![cloth],
        wind: 3.0 * Vec3::z(),
        ..frame(3, physical(evaluations))
    };
    let mut solver = Solver::<f32>::new(one_cloth(strip, ClothLists { air: true, ..lists }), threads);
    let worst = (0..16).map(|_| solver.step(&input, &mut ()).strain_99).fold(0.0, f64::max);
    (solver.state_hash(), worst)
}

#[test]
fn long_links_hold_a_strip_in_wind_better_than_four_times_the_evaluations_without() {
    let linked = ClothLists { long_links: true, ..TETHERED };
    let (with, without) = (in_wind(linked, 24.0, 1).1, in_wind(TETHERED, 96.0, 1).1);
    assert!(with < without, "{with} with long links, {without} without at four times the evaluations");
}

#[test]
fn long_links_give_the_same_bits_on_any_number_of_threads() {
    let linked = ClothLists { long_links: true, ..TETHERED };
    let [one, two] = [1, 2].map(|threads| in_wind(linked, 24.0, threads).0);
    assert_eq!(one, two);
    assert_ne!(one, in_wind(TETHERED, 24.0, 1).0);
}

// The hem weighs 0.96 N, and the strip carries 312 N: it stretches by 0.3 %. Sweeps alone leave far more, because a light
// point takes nearly all of each correction.
#[test]
fn a_light_strip_holds_a_hem_of_a_thousand_times_the_mass() {
    let strip = grid(2, 33, Vec3::x() / 32.0, -Vec3::y());
    let mass: Vec<f64> = (0..66).map(|point| if point < 64 { 1.0 } else { 1e3 }).collect();
    let worst = |cloth: ClothFrame| {
        let vertex_maps = VertexMaps { mass: Vec::clone(&mass), ..VertexMaps::default() };
        let hung = Cloth { vertex_maps, ..Cloth::new(strip.clone(), Mass::PerArea(0.2), TETHERED) };
        let mut builder = ModelBuilder::new();
        builder.cloth(hung).expect("a good mesh");
        let input =
            FrameInput { pins: pins(&strip, [0, 1]), cloths: vec![cloth], ..frame(3, physical(96.0)) };
        let mut solver = Solver::<f32>::new(builder, 1);
        (0..24).map(|_| solver.step(&input, &mut ()).max_strain).fold(0.0, f64::max)
    };
    let [with, without] = [tethered(), still()].map(worst);
    assert!(with < 0.01 && without > 0.1, "{with} with tethers, {without} without");
}

/// Positions after some frames.
fn run(builder: ModelBuilder, input: &FrameInput, frames: usize, points: usize) -> Vec<Vec3> {
    let mut solver = Solver::<f64>::new(builder, 1);
    (0..frames).for_each(|_| {
        solver.step(input, &mut ());
    });
    (0..points).map(|point| solver.point(CLOTH, point)).collect()
}

#[test]
fn slack_tethers_change_not_one_bit() {
    let with = |tethers| {
        let (builder, input) = swinging(9, &[0, 8], ClothFrame { tethers, ..still() });
        run(builder, &input, 12, 81)
    };
    assert_eq!(with(Some(10.0)), with(None));
}

// Closed form: between two pins that are drawn apart, a strip stretches evenly.
#[test]
fn a_strip_that_its_pins_draw_apart_stretches_evenly() {
    let strip = grid(33, 2, Vec3::x(), Vec3::z() / 32.0);
    let stiffness = Stiffness { stretch: Some(1e4), compression: Some(1e4), ..Stiffness::NONE };
    let cloth = ClothFrame { stiffness, drag: 0.2, tangential_drag: 1.0, ..tethered() };
    let mut input = FrameInput {
        gravity: Vec3::zeros(),
        pins: pins(&strip, [0, 33, 32, 65]),
        cloths: vec![cloth],
        ..frame(3, physical(384.0))
    };
    let lists = ClothLists { air: true, ..TETHERED };
    let mut solver = Solver::<f32>::new(one_cloth(strip, lists), 1);
    for frame in 0..48 {
        for pin in &mut input.pins[2..] {
            pin.start = pin.end;
            pin.end.x = 1.0 + 0.2 * f64::from(frame + 1).min(12.0) / 12.0;
        }
        solver.step(&input, &mut ());
    }
    for point in 0..33 {
        let (found, even) = (solver.point(CLOTH, point).x, 1.2 * point as f64 / 32.0);
        assert!((found - even).abs() < 2e-3, "{point}: {found} m, evenly {even} m");
    }
}

#[test]
fn a_free_sheet_has_no_tethers() {
    let (builder, input) = swinging(9, &[], tethered());
    let solver = Solver::<f32>::new(builder, 1);
    assert!(solver.passes(&input).iter().all(|pass| pass.name != "tethers"));
}

#[test]
fn only_a_cloth_that_asks_for_them_has_a_pass_of_tethers() {
    let rows = |cloth: ClothFrame| {
        let (builder, input) = swinging(9, &[0, 8], cloth);
        let passes = Solver::<f32>::new(builder, 1).passes(&input);
        passes.iter().find(|pass| pass.name == "tethers").map(|pass| (pass.rows, pass.sweeps))
    };
    // Two for each point that is no pin.
    assert_eq!(rows(tethered()), Some((2 * 79, 96.0)));
    assert_eq!(rows(still()), None);
}

/// A drape on a ball, with tethers to one corner.
fn held_drape() -> (ModelBuilder, FrameInput) {
    let (of, mut input) = drape(33, 48.0);
    let mut builder = ModelBuilder::new();
    let lists = ClothLists { tethers: true, ..of.cloths()[0].lists };
    builder.cloth(Cloth { lists, ..of.cloths()[0].clone() }).expect("it was good");
    builder.collider(of.colliders()[0].clone()).expect("it was good");
    let corner = of.cloths()[0].surface.positions[0];
    input.pins = vec![Pin { cloth: CLOTH, point: PointId(0), start: corner, end: corner }];
    input.cloths[0].tethers = Some(1.0);
    (builder, input)
}

#[test]
fn nothing_passes_through_a_ball_that_tethers_pull_cloth_over() {
    let (builder, input) = held_drape();
    let mut solver = Solver::<f32>::new(builder, 2);
    for _ in 0..36 {
        let report = solver.step(&input, &mut ());
        assert_eq!(report.pairs_unresolved, 0);
        assert!(report.finite && report.min_gap > 0.0, "{report:?}");
    }
}

#[test]
fn tethers_give_the_same_bits_on_any_number_of_threads_and_from_a_checkpoint() {
    let run = |threads: usize, restored: bool| {
        let (builder, mut input) = held_drape();
        let pin = input.pins[0];
        let mut solver = Solver::<f32>::new(builder.clone(), threads);
        for frame in 0..10 {
            if frame == 5 && restored {
                solver =
                    Solver::restored(builder.clone(), threads, &solver.save()).expect("its own checkpoint");
            }
            // A second pin comes and goes.
            let at = solver.point(CLOTH, 32);
            let second = Pin { point: PointId(32), start: at, end: at, ..pin };
            input.pins = if frame % 4 < 2 { vec![pin] } else { vec![pin, second] };
            solver.step(&input, &mut ());
        }
        solver.state_hash()
    };
    let one = run(1, false);
    assert_eq!([run(2, false), run(4, false), run(1, true), run(2, true)], [one; 4]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn tethers_add_no_energy_to_a_swing(first in 0_usize..81, second in 0_usize..81, evaluations in 12_u32..96) {
        let (builder, mut input) = swinging(9, &[first, second], tethered());
        input.resistance = physical(f64::from(evaluations));
        if first == second {
            input.pins.pop();
        }
        let mut solver = Solver::<f64>::new(builder, 1);
        let masses: Vec<f64> = (0..81).map(|k| solver.mass(CLOTH, PointId(k))).collect();
        for _ in 0..24 {
            let kinetic = solver.step(&input, &mut ()).kinetic_energy;
            let height: f64 = masses.iter().enumerate().map(|(k, mass)| mass * solver.point(CLOTH, k).y).sum();
            // It starts at zero; a fall by its own size frees 1.96 J.
            let total = kinetic + 9.81 * height;
            prop_assert!(total < 1e-6, "{total} J");
        }
    }
}
