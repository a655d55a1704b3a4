//! Woven cloth: its moduli along warp, weft and bias, compression up to the buckling load, and the laws of every pass.

use crate::scenes::{Vec3, drape, frame, grid, physical, pins, still};
use nucleus_core::{
    BuildError, Cloth, ClothFrame, ClothId, ClothLists, FrameInput, Mass, ModelBuilder, Pin, PointId, Solver,
    StateView, Stiffness, Surface,
};
use proptest::prelude::*;

const CLOTH: ClothId = ClothId(0);
const WOVEN: ClothLists = ClothLists { stretch: true, shear: true, ..ClothLists::NONE };
const WARP: f64 = 900.0;
const WEFT: f64 = 500.0;
const COMPRESSION: f64 = 400.0;
const SHEAR: f64 = 2.0;
const BEND: f64 = 1e-5;

fn threads() -> Stiffness {
    Stiffness {
        stretch: Some(WARP),
        compression: Some(COMPRESSION),
        shear: Some(SHEAR),
        bend: Some(BEND),
        warp: Some(WARP),
        weft: Some(WEFT),
    }
}

fn woven(surface: Surface, lists: ClothLists, warp: Vec3) -> Cloth {
    let warp = vec![warp; surface.faces.len()];
    Cloth { warp, ..Cloth::new(surface, Mass::PerArea(0.2), lists) }
}

fn model(cloth: Cloth) -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth).expect("a good mesh");
    builder
}

/// A square of 1 m, each cell of which is cut into two triangles if `cut`.
fn square(cut: bool) -> Surface {
    let mut sheet = grid(9, 9, Vec3::x(), Vec3::z());
    if cut {
        let quads: Vec<Vec<u32>> = sheet.faces.iter().map(<[u32]>::to_vec).collect();
        sheet.faces = nucleus_core::Faces::default();
        for quad in quads {
            sheet.faces.push(&[quad[0], quad[1], quad[2]]);
            sheet.faces.push(&[quad[0], quad[2], quad[3]]);
        }
    }
    sheet
}

/// Energy in joules of a woven square of 1 m whose points are moved by `deform`.
fn energy(surface: Surface, warp: Vec3, buckles: bool, deform: impl Fn(Vec3) -> Vec3) -> f64 {
    let positions = surface.positions.iter().map(|&point| deform(point)).collect();
    let mut cloth = woven(surface, ClothLists { buckling: buckles, ..WOVEN }, warp);
    cloth.start.positions = positions;
    let settings = ClothFrame { stiffness: threads(), buckles, ..still() };
    let input = FrameInput { cloths: vec![settings], ..frame(1, physical(24.0)) };
    Solver::<f64>::new(model(cloth), 1).elastic_energy(&input)
}

#[test]
fn the_moduli_along_edges_are_those_of_warp_weft_and_shear() {
    let strain = 1e-4;
    for cut in [false, true] {
        let of = |deform: fn(Vec3, f64) -> Vec3| {
            2.0 * energy(square(cut), Vec3::x(), false, |p| deform(p, strain)) / strain.powi(2)
        };
        // Diagonals, which resist shear, add their own stiffness along the threads.
        let found = of(|p, e| Vec3::new(p.x * (1.0 + e), p.y, p.z));
        assert!((found / (WARP + SHEAR) - 1.0).abs() < 2e-3, "warp, cut {cut}: {found}");
        let found = of(|p, e| Vec3::new(p.x, p.y, p.z * (1.0 + e)));
        assert!((found / (WEFT + SHEAR) - 1.0).abs() < 2e-3, "weft, cut {cut}: {found}");
        let found = of(|p, e| Vec3::new(p.x + e * p.z, p.y, p.z));
        assert!((found / SHEAR - 1.0).abs() < 1e-2, "shear, cut {cut}: {found}");
    }
}

#[test]
fn quads_cut_on_the_bias_have_the_same_moduli_along_their_diagonals() {
    let (strain, bias) = (1e-4, Vec3::new(1.0, 0.0, 1.0));
    let of = |deform: fn(Vec3, f64) -> Vec3| {
        let rotated = |p: Vec3| {
            // Along the warp, across it, and back.
            let turn = |p: Vec3| Vec3::new(p.x + p.z, 0.0, p.z - p.x) * 0.5f64.sqrt();
            let back = |p: Vec3| Vec3::new(p.x - p.z, 0.0, p.x + p.z) * 0.5f64.sqrt();
            back(deform(turn(p), strain))
        };
        2.0 * energy(square(false), bias, false, rotated) / strain.powi(2)
    };
    let found = of(|p, e| Vec3::new(p.x * (1.0 + e), p.y, p.z));
    assert!((found / (WARP + SHEAR) - 1.0).abs() < 5e-3, "warp: {found}");
    let found = of(|p, e| Vec3::new(p.x, p.y, p.z * (1.0 + e)));
    assert!((found / (WEFT + SHEAR) - 1.0).abs() < 5e-3, "weft: {found}");
    let found = of(|p, e| Vec3::new(p.x + e * p.z, p.y, p.z));
    assert!((found / SHEAR - 1.0).abs() < 2e-2, "shear: {found}");
}

#[test]
fn compressed_threads_carry_the_load_of_an_elastica_and_no_more() {
    // Euler's load per width of an edge of 1/8 m with clamped ends; an elastica that is shortened by ε carries 1 + ε/2 times
    // as much.
    let load = 4.0 * std::f64::consts::PI.powi(2) * BEND * 64.0;
    let of = |strain: f64, buckles: bool| {
        energy(square(false), Vec3::x(), buckles, |p| Vec3::new(p.x * (1.0 - strain), p.y, p.z))
    };
    let step = 1e-6;
    let force =
        |strain: f64, buckles: bool| (of(strain + step, buckles) - of(strain - step, buckles)) / (2.0 * step);
    // Diagonals carry half of the shear stiffness each, and buckle too.
    for strain in [0.001, 0.01, 0.05] {
        let own = force(strain, true) / (load * (1.0 + strain / 2.0));
        assert!((1.0..1.6).contains(&own), "{strain}: {own} times the load");
        assert!(force(strain, false) > 10.0 * load, "{strain}");
    }
    let weak = load / COMPRESSION / 10.0;
    assert!(
        (force(weak, true) / force(weak, false) - 1.0).abs() < 1e-6,
        "below the load the threads are elastic"
    );
    let stretched = |buckles| energy(square(false), Vec3::x(), buckles, |p| p * 1.01);
    assert_eq!(stretched(true), stretched(false), "stretched threads do not buckle");
}

#[test]
fn a_column_shortens_to_where_its_buckling_load_carries_its_weight() {
    // One cell of 0.1 m stands on its lower edge: two threads of half its width each carry a point.
    let side = 0.1;
    let column = grid(2, 2, Vec3::x() * side, Vec3::y() * side);
    let lists = ClothLists { air: true, buckling: true, ..WOVEN };
    let load = 4.0 * std::f64::consts::PI.powi(2) * BEND / (side * side) * (side / 2.0);
    let strain = 0.04;
    let mass = load * (1.0 + strain / 2.0) / 9.81;
    let cloth = Cloth { mass: Mass::PerPoint(mass), ..woven(column.clone(), lists, Vec3::x()) };
    let settings = ClothFrame {
        stiffness: Stiffness { shear: Some(0.0), ..threads() },
        buckles: true,
        drag: 14.0 / 24.0 * mass,
        tangential_drag: 1.0,
        ..still()
    };
    let input =
        FrameInput { cloths: vec![settings], pins: pins(&column, [0, 1]), ..frame(1, physical(2400.0)) };
    let mut solver = Solver::<f64>::new(model(cloth), 1);
    // A step takes the drag of the step from gravity too, and a percent of the load is half the strain: short steps.
    for _ in 0..48 {
        solver.step(&input, &mut ());
    }
    for point in [2, 3] {
        let found = 1.0 - solver.point(CLOTH, point).y / side;
        assert!((found - strain).abs() < 1e-3, "{found} instead of {strain}");
    }
}

#[test]
fn woven_cloth_of_no_buckling_and_equal_threads_has_a_pass_and_other_cloth_none() {
    let rows = |cloth: Cloth| {
        let input = FrameInput { cloths: vec![still()], ..frame(1, physical(24.0)) };
        let passes = Solver::<f32>::new(model(cloth), 1).passes(&input);
        passes.iter().find(|pass| pass.name == "weave").map(|pass| pass.rows)
    };
    // 2 · 8 · 9 edges and 2 · 64 diagonals.
    assert_eq!(rows(woven(square(false), WOVEN, Vec3::x())), Some(144 + 128));
    assert_eq!(rows(Cloth::new(square(false), Mass::PerArea(0.2), WOVEN)), None);
    let buckling = ClothLists { stretch: true, buckling: true, ..ClothLists::NONE };
    assert_eq!(rows(Cloth::new(square(false), Mass::PerArea(0.2), buckling)), Some(144));
}

#[test]
fn a_face_without_a_direction_of_the_warp_is_refused() {
    let mut cloth = woven(square(false), WOVEN, Vec3::x());
    cloth.warp.pop();
    let refused = ModelBuilder::new().cloth(cloth.clone());
    assert!(matches!(refused, Err(BuildError::WarpCount { given: 63, faces: 64 })), "{refused:?}");
    cloth.warp.insert(5, Vec3::zeros());
    assert!(matches!(ModelBuilder::new().cloth(cloth), Err(BuildError::BadWarp { face: 5 })));
}

/// A woven drape on a ball, whose warp is off the edges.
fn woven_drape() -> (ModelBuilder, FrameInput) {
    let (of, mut input) = drape(33, 48.0);
    let mut builder = ModelBuilder::new();
    let own = of.cloths()[0].clone();
    let lists = ClothLists { cross_links: false, shear: true, bend: true, buckling: true, ..own.lists };
    let warp = vec![Vec3::new(0.8, 0.0, 0.6); own.surface.faces.len()];
    builder.cloth(Cloth { lists, warp, ..own }).expect("it was good");
    builder.collider(of.colliders()[0].clone()).expect("it was good");
    input.cloths[0].stiffness = Stiffness { shear: Some(30.0), ..threads() };
    input.cloths[0].buckles = true;
    (builder, input)
}

#[test]
fn woven_cloth_gives_the_same_bits_on_any_number_of_threads_and_from_a_checkpoint() {
    let run = |threads: usize, restored: bool| {
        let (builder, input) = woven_drape();
        let mut solver = Solver::<f32>::new(builder.clone(), threads);
        for frame in 0..10 {
            if frame == 5 && restored {
                solver =
                    Solver::restored(builder.clone(), threads, &solver.save()).expect("its own checkpoint");
            }
            let report = solver.step(&input, &mut ());
            assert!(report.finite && report.pairs_unresolved == 0, "{report:?}");
        }
        solver.state_hash()
    };
    let one = run(1, false);
    assert_eq!([run(2, false), run(4, false), run(2, true)], [one; 3]);
}

#[test]
fn single_precision_drapes_woven_cloth_like_double_precision() {
    let (builder, input) = woven_drape();
    let mut single = Solver::<f32>::new(builder.clone(), 1);
    let mut double = Solver::<f64>::new(builder.clone(), 1);
    for _ in 0..6 {
        single.step(&input, &mut ());
        double.step(&input, &mut ());
    }
    let points = builder.cloths()[0].surface.positions.len();
    let far = (0..points).map(|k| (single.point(CLOTH, k) - double.point(CLOTH, k)).norm());
    let far = far.fold(0.0, f64::max);
    assert!(far < 1e-3, "{far} m of a sheet of 1 m, before folds differ");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn woven_cloth_gains_no_energy_in_a_swing(
        first in 0_usize..81,
        second in 0_usize..81,
        degrees in 0.0f64..180.0,
        shear in 0.5f64..500.0,
    ) {
        let sheet = square(false);
        let turn = degrees.to_radians();
        let lists = ClothLists { buckling: true, ..WOVEN };
        let cloth = woven(sheet.clone(), lists, Vec3::new(turn.cos(), 0.0, turn.sin()));
        let masses = cloth.point_masses();
        let settings =
            ClothFrame { stiffness: Stiffness { shear: Some(shear), ..threads() }, buckles: true, ..still() };
        let held: [Pin; 2] = [first, second].map(|point| {
            let at = sheet.positions[point];
            Pin { cloth: CLOTH, point: PointId(point as u32), start: at, end: at }
        });
        let pins = if first == second { vec![held[0]] } else { held.to_vec() };
        // Links left unsolved by few evaluations count as elastic energy, though it never moves the cloth.
        for (evaluations, counts_links) in [(48.0, false), (192.0, true)] {
            let input = FrameInput {
                cloths: vec![settings], pins: pins.clone(), ..frame(1, physical(evaluations))
            };
            let mut solver = Solver::<f64>::new(model(cloth.clone()), 1);
            for _ in 0..24 {
                let report = solver.step(&input, &mut ());
                let height: f64 =
                    masses.iter().enumerate().map(|(k, m)| m * solver.point(CLOTH, k).y).sum();
                let links = if counts_links { solver.elastic_energy(&input) } else { 0.0 };
                let gain = report.kinetic_energy + 9.81 * height + links;
                prop_assert!(report.finite && gain < 2e-4, "{gain} J at {evaluations} evaluations");
            }
        }
    }
}
