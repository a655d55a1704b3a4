//! Infeasible contact neither locks nor explodes, and recovers once it is feasible.

use crate::scenes::{
    INSCRIBED, LINKS, Vec3, cuboid, frame, grid, ground, one_cloth, physical, pins, sphere, still,
};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, FrameInput, Mass,
    ModelBuilder, Pin, PointId, ResistanceModel, Solver, Stage, StateView, StepObserver, StepReport,
    SubstepIndex, Surface,
};

/// A sheet held at two edges between two boxes, which close on it within a second until there is `gap` between them,
/// stay for a second, and part again. The report of each frame.
fn pinch(gap: f64) -> Vec<StepReport> {
    pinch_until(130, gap, &mut ())
}

fn pinch_until(end: u32, gap: f64, observer: &mut dyn StepObserver) -> Vec<StepReport> {
    let mut sheet = grid(17, 17, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| *p -= Vec3::new(0.5, 0.0, 0.5));
    let held = pins(&sheet, (0..17).chain(272..289));
    let mut builder = one_cloth(sheet, ClothLists { self_collision: false, ..ClothLists::DEFAULT });
    let slab = cuboid(Vec3::new(-0.4, -0.1, -0.4), Vec3::new(0.4, 0.1, 0.4));
    for _ in 0..2 {
        builder.collider(Collider { surface: slab.clone() }).expect("a good mesh");
    }
    let mut solver = Solver::<f32>::new(builder, 1);
    let height = |frame: f64| {
        let closed = (frame / 24.0).min((72.0 - frame) / 24.0).clamp(0.0, 1.0);
        0.4 + closed * (0.1 + gap / 2.0 - 0.4)
    };
    let cloth = ClothFrame {
        thickness: 0.005,
        friction: 0.25,
        stretch_damp: 0.1,
        damp: 1.0,
        bend_resistance: 0.1,
        ..still()
    };
    let one = |frame: u32| {
        let collider = |sign: f64| {
            let at =
                |frame: f64| slab.positions.iter().map(|p| p + Vec3::y() * (sign * height(frame))).collect();
            let (start, end) = (at(f64::from(frame)), at(f64::from(frame + 1)));
            ColliderFrame {
                start,
                end,
                collide: true,
                thickness: 0.005,
                friction: 0.25,
                ..ColliderFrame::default()
            }
        };
        FrameInput {
            gravity: Vec3::new(0.0, -1.0, 0.0),
            pins: held.clone(),
            colliders: vec![collider(-1.0), collider(1.0)],
            cloths: vec![cloth],
            ..crate::scenes::frame(3, physical(96.0))
        }
    };
    (0..end).map(|frame| solver.step(&one(frame), observer)).collect()
}

/// Counts the runs of the broad phase.
#[derive(Default)]
struct BroadPhases(u64);

impl StepObserver for BroadPhases {
    fn substep(&mut self, _: SubstepIndex, _: &dyn StateView) {}

    fn enter(&mut self, stage: Stage) {
        self.0 += u64::from(stage == Stage::BroadPhase);
    }
}

#[test]
fn cloth_with_too_little_room_is_separated_by_two_further_sweeps() {
    let of_frames = |end: u32, gap: f64| {
        let mut count = BroadPhases::default();
        pinch_until(end, gap, &mut count);
        count.0
    };
    // The boxes are closed in frames 24 to 48; 20 mm are the thickness of the sheet and both boxes.
    let [ample, scarce] = [0.03, 0.006].map(|gap| of_frames(48, gap) - of_frames(26, gap));
    // A sweep and its certificates begin with a broad phase each. Pushed by the whole thickness and then by halves of it, the
    // sheet took 12.7 runs per step.
    assert!(scarce <= 3 * ample, "{scarce} runs, {ample} with room");
}

// EVIDENCE: N2.1-2  what cannot be satisfied does not lock or explode
#[test]
fn cloth_pinched_between_two_boxes_goes_on_and_recovers_when_they_part() {
    for gap in [0.021, 0.0, -0.05] {
        let reports = pinch(gap);
        assert!(reports.iter().all(|report| report.finite));
        let closed = &reports[30];
        // Only boxes that touch or overlap leave no position for a point.
        assert_eq!(closed.depenetrating > 0, gap <= 0.0, "gap {gap}: {closed:?}");
        let last = reports.last().expect("frames");
        assert!(last.strain_99 < 0.01, "gap {gap}: {last:?}");
        assert!(last.kinetic_energy < 1e-2, "gap {gap}: {last:?}");
        assert_eq!((last.depenetrating, last.pairs_reverted), (0, 0), "gap {gap}: {last:?}");
    }
}

// A point that one box has pressed into another is nearer to the other's side than to its front, once it is deep: pushed out
// there, it would stretch the cloth by half an edge.
#[test]
fn cloth_between_overlapping_boxes_stays_between_them() {
    let strain = pinch(-0.05).iter().map(|report| report.strain_99).fold(0.0, f64::max);
    // The edge of 1/16 m that leads out from between them may climb half of the overlap, and half a centimetre of thickness.
    let climb = 0.025 + 0.005;
    let bound = (16.0f64 * climb).hypot(1.0) - 1.0;
    assert!(strain < bound, "{strain}, at most {bound}");
}

// Cloth without room for its thickness is pushed from both sides in every step. It must not tremble.
#[test]
fn cloth_with_room_for_less_than_its_thickness_rests() {
    for gap in [0.016, 0.012] {
        let reports = pinch(gap);
        let closed = &reports[30..46];
        let most = |of: fn(&StepReport) -> f64| closed.iter().map(of).fold(0.0, f64::max);
        let (energy, strain) = (most(|report| report.kinetic_energy), most(|report| report.strain_99));
        println!("gap {gap}: {energy} J, {strain}");
        // 0.2 kg at 5 cm/s. Pushed out at 1 m/s from both sides, and with velocity, it would have 20 times that speed.
        assert!(energy < 0.2 * 0.05 * 0.05 / 2.0, "gap {gap}: {energy} J");
        assert!(strain < 0.05, "gap {gap}: {strain}");
    }
}

#[test]
fn cloth_that_starts_inside_a_ball_depenetrates_slowly() {
    let mut patch = grid(9, 9, Vec3::x() * 0.2, Vec3::z() * 0.2);
    patch.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.1, 0.2, -0.1));
    let mut builder = one_cloth(patch, LINKS);
    builder.collider(Collider { surface: sphere(0.3, Vec3::zeros()) }).expect("a good mesh");
    let colliders = vec![ColliderFrame { collide: true, friction: 2.0, ..ColliderFrame::default() }];
    let cloths = vec![ClothFrame { thickness: 0.005, ..still() }];
    let input = FrameInput { cloths, colliders, ..frame(3, physical(96.0)) };
    let mut solver = Solver::<f32>::new(builder, 1);
    let first = solver.step(&input, &mut ());
    assert_eq!(first.depenetrating, 81, "{first:?}");
    // Points move out at 1 m/s. Points that they pull along may have that speed, and none may be much faster.
    let energy = 0.2 * 0.2 * 0.2 * 2.0 * 2.0 / 2.0;
    for frame in 0..6 {
        let report = solver.step(&input, &mut ());
        assert!(report.finite && report.kinetic_energy < energy, "frame {frame}, {energy} J: {report:?}");
        assert_eq!(report.depenetrating == 0, frame > 0, "frame {frame}: {report:?}");
    }
    assert!((0..81).all(|k| solver.point(ClothId(0), k).norm() > 0.3 * INSCRIBED), "a point is inside");
}

/// The reports of two cloths of the same `crossover_push`, in empty space; the first has a map of its collide strength.
fn two_in_empty_space(surfaces: [Surface; 2], crossover_push: f64, strength: &[f64]) -> Vec<StepReport> {
    let mut builder = ModelBuilder::new();
    for (surface, strength) in surfaces.into_iter().zip([strength, &[]]) {
        let mass = Mass::PerArea(0.2);
        let factors = nucleus_core::VertexMaps { collide_strength: strength.to_vec(), ..Default::default() };
        let cloth = Cloth { vertex_maps: factors, ..Cloth::new(surface, mass, LINKS) };
        builder.cloth(cloth).expect("a good mesh");
    }
    let mut solver = Solver::<f32>::new(builder, 1);
    let cloth = ClothFrame { thickness: 0.004, damp: 1.0, bend_resistance: 0.1, crossover_push, ..still() };
    let input = FrameInput { gravity: Vec3::zeros(), cloths: vec![cloth; 2], ..frame(3, physical(96.0)) };
    (0..96).map(|_| solver.step(&input, &mut ())).collect()
}

/// Two sheets that intersect at an angle; the second turned over if `flipped`.
fn at_a_slant(flipped: bool, strength: &[f64]) -> Vec<StepReport> {
    let level = grid(13, 13, Vec3::x(), Vec3::z());
    let turn =
        nalgebra::Rotation3::from_euler_angles(0.15, 0.4, if flipped { std::f64::consts::PI } else { 0.0 });
    let middle = Vec3::new(0.5, 0.0, 0.5);
    let mut slant = level.clone();
    slant.positions.iter_mut().for_each(|p| *p = turn * (*p - middle) + middle + Vec3::y() * 0.01);
    two_in_empty_space([level, slant], 0.0, strength)
}

#[test]
fn sheets_that_start_intersecting_untangle_whichever_way_they_face() {
    for flipped in [false, true] {
        let reports = at_a_slant(flipped, &[]);
        assert!(reports[0].intersections > 20, "{:?}", reports[0]);
        let last = reports.last().expect("frames");
        assert_eq!((last.intersections, last.pairs_unresolved), (0, 0), "flipped {flipped}: {last:?}");
        // They separate at a few decimetres per second, and nothing stops them here.
        assert!(reports.iter().all(|report| report.finite && report.kinetic_energy < 0.2 * 2.0 * 0.5 * 0.5));
        assert!(last.max_strain < 0.05, "flipped {flipped}: {last:?}");
    }
}

#[test]
fn points_of_partial_collide_strength_are_no_intersections() {
    let intersections = |strength: f64| {
        let reports = at_a_slant(false, &[strength; 169]);
        [reports[0].intersections, reports[0].pairs_unresolved]
    };
    assert_eq!([0.0, 0.5].map(intersections), [[0; 2]; 2]);
    assert!(intersections(1.0)[0] > 20, "{:?}", intersections(1.0));
}

#[test]
fn crossover_push_untangles_sheets_sooner() {
    // A strip stands in a level sheet, four and a half of its edges deep.
    let apart_after = |push: f64| {
        let level = grid(13, 13, Vec3::x(), Vec3::z());
        let mut strip = grid(4, 13, Vec3::x() * 0.25, Vec3::y());
        strip.positions.iter_mut().for_each(|p| *p += Vec3::new(0.39, -4.5 / 12.0, 0.46));
        let reports = two_in_empty_space([level, strip], push, &[]);
        reports.iter().position(|report| report.intersections == 0).expect("they come apart")
    };
    let [alone, pushed] = [0.0, 0.5].map(apart_after);
    assert!(2 * pushed < alone, "after {pushed} frames, {alone} without");
}

/// The report of a frame of one time step in which a pin carries a point from `height` metres above the middle of a
/// triangle to below it. The triangle is of a collider or of a pinned cloth.
fn carried_through_a_triangle(height: f64, of_cloth: bool) -> StepReport {
    let triangle = || {
        let positions = vec![Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0)];
        let mut surface = Surface { positions, ..Surface::default() };
        surface.faces.push(&[0, 2, 1]);
        surface
    };
    let point = Surface { positions: vec![Vec3::y() * height], ..Surface::default() };
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(point, Mass::PerPoint(1.0), ClothLists::NONE)).expect("a point");
    let (start, end) = (Vec3::y() * height, Vec3::y() * -0.1);
    let mut input = frame(1, ResistanceModel::Classic);
    input.collision_iterations = 8.0;
    input.cloths[0] = ClothFrame { thickness: 0.001, elements: Elements::Points, ..still() };
    input.pins = vec![Pin { cloth: ClothId(0), point: PointId(0), start, end }];
    if of_cloth {
        builder.cloth(Cloth::new(triangle(), Mass::PerArea(0.2), LINKS)).expect("a triangle");
        input.cloths.push(ClothFrame { thickness: 0.001, ..still() });
        input.pins.extend(pins(&triangle(), 0..3).into_iter().map(|pin| Pin { cloth: ClothId(1), ..pin }));
    } else {
        builder.collider(Collider { surface: triangle() }).expect("a triangle");
        input.colliders = vec![ColliderFrame { collide: true, thickness: 0.001, ..ColliderFrame::default() }];
    }
    Solver::<f64>::new(builder, 1).step(&input, &mut ())
}

#[test]
fn a_pair_that_pins_carry_through_each_other_is_one_unresolved_pair() {
    for of_cloth in [false, true] {
        let report = carried_through_a_triangle(0.1, of_cloth);
        assert_eq!(report.pairs_unresolved, 1, "{of_cloth}: {report:?}");
        assert!(report.pairs_reverted > 1, "{of_cloth}: {report:?}");
    }
}

#[test]
fn an_inseparable_pair_is_counted_once_per_step_whatever_the_number_of_passes() {
    let report = carried_through_a_triangle(0.0, false);
    assert_eq!((report.pairs_unresolved, report.pairs_reverted), (1, 0), "{report:?}");
}

#[test]
fn points_that_pins_carry_through_the_ground_are_unresolved_pairs_in_that_frame() {
    let sheet = grid(2, 2, Vec3::x(), Vec3::z());
    let mut solver = Solver::<f32>::new(one_cloth(sheet.clone(), LINKS), 1);
    let mut input = frame(1, physical(24.0));
    input.cloths[0] = ClothFrame { thickness: 0.01, ..still() };
    input.plane = Some(ground(0.0));
    let mut heights = [0.0; 4];
    let mut carried = |to: [f64; 4]| {
        input.pins = pins(&sheet, 0..4);
        for (pin, (height, to)) in input.pins.iter_mut().zip(heights.iter_mut().zip(to)) {
            (pin.start.y, pin.end.y, *height) = (*height, to, to);
        }
        solver.step(&input, &mut ()).pairs_unresolved
    };
    // Two go through it, and on, and come back; one rests on it but for rounding.
    let moved = [[-0.1, 0.1, -1e-6, -0.01], [-0.2, 0.0, -1e-6, -0.02], [0.1, 0.0, 0.0, 0.1]];
    assert_eq!(moved.map(&mut carried), [2, 0, 0]);
}

// The ground is certified as colliders are: cloth that has no room above it is unresolved, and does not slip below unseen.
#[test]
fn cloth_that_a_plate_presses_through_the_ground_is_counted_as_unresolved() {
    let mut sheet = grid(9, 9, Vec3::x() * 0.4, Vec3::z() * 0.4);
    sheet.positions.iter_mut().for_each(|p| p.y = 0.01);
    let mut builder = one_cloth(sheet, LINKS);
    let plate = |height: f64| {
        let mut plate = grid(2, 2, Vec3::x() * 0.2, Vec3::z() * 0.2);
        plate.positions.iter_mut().for_each(|p| *p += Vec3::new(0.1, height, 0.1));
        plate
    };
    builder.collider(Collider { surface: plate(0.2) }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let height = |frame: u32| 0.2 - f64::from(frame) * 0.03;
    let mut unresolved = 0;
    for frame in 0..10 {
        let [start, end] = [frame, frame + 1].map(|frame| plate(height(frame)).positions);
        let collider =
            ColliderFrame { start, end, collide: true, thickness: 0.002, ..ColliderFrame::default() };
        let cloth = ClothFrame { thickness: 0.002, friction: 0.25, ..still() };
        let input = FrameInput {
            plane: Some(ground(0.5)),
            colliders: vec![collider],
            cloths: vec![cloth],
            ..crate::scenes::frame(3, physical(24.0))
        };
        let report = solver.step(&input, &mut ());
        unresolved += report.pairs_unresolved;
        let lowest = (0..81).map(|k| solver.point(ClothId(0), k).y).fold(f64::MAX, f64::min);
        assert!(report.finite);
        if height(frame + 1) > 0.006 {
            assert!(
                lowest > 0.0019,
                "frame {frame}: there is room, and the cloth is at {lowest}: {report:?}"
            );
            assert_eq!(unresolved, 0, "frame {frame}: {report:?}");
        }
        assert!(lowest >= 0.0 || unresolved > 0, "frame {frame}: {lowest} and unseen: {report:?}");
    }
    assert!(unresolved > 0, "there was no room");
}
