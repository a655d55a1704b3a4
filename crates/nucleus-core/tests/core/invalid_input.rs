//! An invalid value in the input of a frame is replaced and reported; the rest of the frame is solved as usual.

use crate::scenes::{LINKS, Vec3, drape, frame, grid, ground, one_cloth, physical, pins};
use std::sync::Arc;

use nucleus_core::{
    Birth, Cloth, ClothFrame, ClothId, ClothLists, ColliderFrame, ColliderId, ConstraintFrame, ExcludedSide,
    Exclusion, Field, FieldKind, FrameInput, GroundPlane, InputMesh, InvalidInput, Link, LinkSide,
    MAX_COORDINATE, MAX_EXCLUSIONS, Mass, ModelBuilder, ParticleChange, Particles, Pin, PointId, Pressure,
    Reach, ResistanceModel, Solver, StateView, Surface,
};

/// The points of the ball at this height in metres.
fn ball(height: f64) -> Vec<Vec3> {
    crate::scenes::sphere(0.31, Vec3::y() * height).positions
}

/// Runs a solver for twelve frames; `plant` may change the input of the sixth. The hash of the state at the end, the
/// number of replaced values and the first of them, and whether every state was finite.
fn run(mut plant: impl FnMut(&mut FrameInput)) -> (u64, u64, Option<InvalidInput>, bool) {
    let (builder, mut usual) = drape(9, 24.0);
    let mut solver: Solver = Solver::new(builder, 1);
    let moved = |frame: u32| ball(0.01 * f64::from(frame));
    let (mut count, mut first, mut finite) = (0, None, true);
    for frame in 0..12 {
        usual.colliders[0].end = moved(frame);
        let mut input = usual.clone();
        if frame == 5 {
            plant(&mut input);
        }
        let report = solver.step(&input, &mut ());
        count += report.sanitized.count;
        first = first.or(report.sanitized.first);
        finite &= report.finite;
    }
    (solver.state_hash(), count, first, finite)
}

#[test]
fn no_value_of_a_valid_frame_is_replaced() {
    let (_, count, first, finite) = run(|_| {});
    assert_eq!((count, first, finite), (0, None, true));
}

#[test]
fn an_invalid_collider_point_keeps_its_last_position() {
    for bad in [f64::NAN, f64::INFINITY, -2.0 * MAX_COORDINATE] {
        let held = run(|input| input.colliders[0].end[17] = ball(0.04)[17]);
        let planted = run(|input| input.colliders[0].end[17].z = bad);
        assert_eq!(planted.0, held.0, "the same bits as with a fixed point");
        assert_eq!(planted.1, 1);
        assert_eq!(planted.2, Some(InvalidInput::ColliderPoint(ColliderId(0), PointId(17))));
        assert!(planted.3);
    }
}

#[test]
fn a_collider_with_the_wrong_number_of_points_does_not_move() {
    let (_, count, first, finite) = run(|input| input.colliders[0].end.truncate(3));
    assert_eq!((count, first, finite), (1, Some(InvalidInput::ColliderMotion(ColliderId(0))), true));
}

#[test]
fn invalid_attributes_are_replaced_and_reported_with_their_object() {
    let (_, _, first, finite) = run(|input| input.cloths[0].thickness = f64::NAN);
    assert_eq!((first, finite), (Some(InvalidInput::Cloth(ClothId(0))), true));
    let (_, _, first, finite) = run(|input| input.gravity.x = f64::NAN);
    assert_eq!((first, finite), (Some(InvalidInput::Setting), true));
    let (_, _, first, finite) = run(|input| input.colliders[0].friction = f64::INFINITY);
    assert_eq!((first, finite), (Some(InvalidInput::Collider(ColliderId(0))), true));
}

#[test]
fn an_attribute_below_zero_counts_as_zero_and_is_reported() {
    type Plant = fn(&mut FrameInput, f64);
    let cloth: [Plant; 6] = [
        |input, x| input.cloths[0].drag = x,
        |input, x| input.cloths[0].damp = x,
        |input, x| input.cloths[0].friction = x,
        |input, x| input.cloths[0].thickness = x,
        |input, x| input.cloths[0].stretch_resistance = x,
        |input, x| input.cloths[0].rest_length_scale = x,
    ];
    for plant in cloth {
        let (hash, _, first, finite) = run(|input| plant(input, -5.0));
        assert_eq!((first, finite), (Some(InvalidInput::Cloth(ClothId(0))), true));
        assert_eq!(hash, run(|input| plant(input, 0.0)).0);
    }
    let (hash, _, first, _) = run(|input| input.air_density = -1.0);
    assert_eq!((hash, first), (run(|input| input.air_density = 0.0).0, Some(InvalidInput::Setting)));
    let (hash, _, first, _) = run(|input| input.colliders[0].friction = -1.0);
    let collider = Some(InvalidInput::Collider(ColliderId(0)));
    assert_eq!((hash, first), (run(|input| input.colliders[0].friction = 0.0).0, collider));
}

#[test]
fn a_frame_without_a_valid_duration_changes_nothing() {
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let (builder, input) = drape(9, 24.0);
        let mut solver: Solver = Solver::new(builder, 1);
        solver.step(&input, &mut ());
        let before = solver.state_hash();
        let report = solver.step(&FrameInput { duration, ..input }, &mut ());
        assert_eq!(solver.state_hash(), before);
        assert_eq!(report.sanitized.first, Some(InvalidInput::Duration));
    }
}

#[test]
fn an_invalid_pin_holds_its_point_at_its_current_position() {
    let sheet = grid(5, 5, Vec3::x(), Vec3::y());
    let mut input = frame(3, physical(24.0));
    input.pins = pins(&sheet, [20, 24]);
    let place = input.pins[0].start;
    let mut solver: Solver = Solver::new(one_cloth(sheet, LINKS), 1);
    solver.step(&input, &mut ());
    input.pins[0].start.x = f64::NAN;
    input.pins[0].end.y = f64::INFINITY;
    let report = solver.step(&input, &mut ());
    assert_eq!(report.sanitized.first, Some(InvalidInput::Pin(ClothId(0), PointId(20))));
    let after = solver.point(ClothId(0), 20);
    assert!(report.finite && after == place, "{after}");
}

#[test]
fn a_missing_entry_is_the_default_and_is_reported() {
    let defaults = |input: &mut FrameInput| {
        input.cloths[0] = ClothFrame::default();
        input.colliders[0] = ColliderFrame::default();
    };
    let (expected, ..) = run(defaults);
    let (found, count, first, finite) = run(|input| {
        input.cloths.clear();
        input.colliders.clear();
    });
    assert_eq!((found, count, first, finite), (expected, 2, Some(InvalidInput::ClothCount), true));
    let (_, count, first, _) = run(|input| input.colliders.push(ColliderFrame::default()));
    assert_eq!((count, first), (1, Some(InvalidInput::ColliderCount)));
}

#[test]
fn a_pin_or_input_mesh_of_nothing_is_dropped_and_reported() {
    let pin = |cloth, point| Pin {
        cloth: ClothId(cloth),
        point: PointId(point),
        start: Vec3::zeros(),
        end: Vec3::zeros(),
    };
    let (expected, ..) = run(|_| {});
    for (cloth, point) in [(0, 81), (1, 0), (u32::MAX, u32::MAX)] {
        let (found, count, first, _) = run(|input| input.pins.push(pin(cloth, point)));
        assert_eq!(found, expected);
        assert_eq!((count, first), (1, Some(InvalidInput::NoSuchPin(ClothId(cloth), PointId(point)))));
    }
    let mesh = InputMesh { cloth: ClothId(3), start: Vec::new(), end: Vec::new() };
    let (found, count, first, _) = run(|input| input.input_meshes.push(mesh.clone()));
    assert_eq!((found, count, first), (expected, 1, Some(InvalidInput::InputMesh(ClothId(3)))));
}

#[test]
fn check_frame_refuses_what_a_step_would_replace() {
    let (builder, _) = drape(9, 24.0);
    let solver: Solver = Solver::new(builder, 1);
    let usual = solver.default_frame();
    assert_eq!(solver.check_frame(&usual), Ok(()));
    let without = FrameInput { colliders: Vec::new(), ..usual.clone() };
    let refused = solver.check_frame(&without).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the frame has not one entry per collider; `Solver::default_frame` makes one"
    );
    let still = FrameInput { duration: 0.0, ..usual };
    assert_eq!(solver.check_frame(&still), Err(InvalidInput::Duration));
}

#[test]
fn check_frame_names_the_object_the_field_the_value_and_its_documented_range() {
    type Plant = fn(&mut FrameInput);
    let link = |sides: [LinkSide; 2]| ConstraintFrame {
        formed: Some(vec![Link::new(sides, 0.0)]),
        ..ConstraintFrame::default()
    };
    let plants: [(Plant, &str); 15] = [
        (|input| input.substeps = 0, "`substeps` of the frame is 0; it must be from 1 to 1e5"),
        (
            |input| input.resistance = ResistanceModel::Physical { evaluations: 0.0 },
            "`resistance.evaluations` of the frame is 0; it must be above 0, and at most 1e6",
        ),
        (
            |input| input.resistance = ResistanceModel::Physical { evaluations: -3.0 },
            "`resistance.evaluations` of the frame is -3; it must be above 0, and at most 1e6",
        ),
        (|input| input.gravity.y = f64::NAN, "`gravity` of the frame is NaN; it must be from -1e12 to 1e12"),
        (
            |input| input.plane = Some(GroundPlane { bounce: 99.0, ..ground(0.0) }),
            "`bounce` of the ground plane is 99; it must be from 0 to 1",
        ),
        (|input| input.cloths[0].bounce = 99.0, "`bounce` of cloth 0 is 99; it must be from 0 to 1"),
        (|input| input.cloths[0].stickiness = 99.0, "`stickiness` of cloth 0 is 99; it must be from 0 to 2"),
        (
            |input| input.cloths[0].tangential_drag = 9.0,
            "`tangential_drag` of cloth 0 is 9; it must be from 0 to 1",
        ),
        (
            |input| input.cloths[0].stiffness.warp = Some(-1.0),
            "`stiffness.warp` of cloth 0 is -1; it must be from 0 to 1e12",
        ),
        (
            |input| input.cloths[0].yield_strain = f64::NAN,
            "`yield_strain` of cloth 0 is NaN; it must be at least 0",
        ),
        (|input| input.colliders[0].bounce = -0.5, "`bounce` of collider 0 is -0.5; it must be from 0 to 1"),
        (
            |input| input.colliders[0].friction = f64::INFINITY,
            "`friction` of collider 0 is inf; it must be from 0 to 1e12",
        ),
        (
            |input| input.constraints[0].motion_drag = 1.5,
            "`motion_drag` of constraint 0 is 1.5; it must be from 0 to 1",
        ),
        (
            |input| set_weights(input, [0.5, 0.5, 0.5]),
            "`sum of weights` of link 0 of constraint 0 is 1.5; it must be from 0.9999 to 1.0001",
        ),
        (
            |input| set_weights(input, [f64::NAN, 0.0, 0.0]),
            "`weights` of link 0 of constraint 0 is NaN; it must be from -1e12 to 1e12",
        ),
    ];
    let (builder, _) = drape(9, 24.0);
    let solver: Solver = Solver::new(builder, 1);
    let mut usual = solver.default_frame();
    let points = [0, 1, 9].map(PointId);
    let place = LinkSide::Cloth { cloth: ClothId(0), points, weights: [0.25, 0.25, 0.5] };
    usual.constraints = vec![link([place, LinkSide::Space(Vec3::zeros())])];
    assert_eq!(solver.check_frame(&usual), Ok(()));
    for (plant, said) in plants {
        let mut frame = usual.clone();
        plant(&mut frame);
        assert_eq!(solver.check_frame(&frame).unwrap_err().to_string(), said);
    }
}

fn set_weights(input: &mut FrameInput, new: [f64; 3]) {
    let links = input.constraints[0].formed.iter_mut().flatten();
    for side in links.flat_map(|link| &mut link.sides) {
        if let LinkSide::Cloth { weights, .. } = side {
            *weights = new;
        }
    }
}

#[test]
fn check_frame_refuses_births_that_are_not_in_the_order_of_their_times() {
    let particles = Some(Particles { capacity: 4, ..Particles::default() });
    let surface = Surface { positions: vec![Vec3::zeros()], ..Surface::default() };
    let mut builder = ModelBuilder::new();
    let beads = Cloth { particles, ..Cloth::new(surface, Mass::PerPoint(0.01), ClothLists::NONE) };
    let cloth = builder.cloth(beads).expect("good particles");
    let solver: Solver = Solver::new(builder, 1);
    let birth =
        |time| Birth { cloth, time, position: Vec3::x(), velocity: Vec3::y(), lifespan: f64::INFINITY };
    let of = |times: [f64; 3]| FrameInput { births: times.map(birth).to_vec(), ..solver.default_frame() };
    assert_eq!(solver.check_frame(&of([0.25, 0.25, 0.5])), Ok(()));
    let refused = solver.check_frame(&of([0.25, 0.75, 0.5])).unwrap_err().to_string();
    assert_eq!(
        refused,
        "`time` of birth 2 is 0.5, before 0.75 of the birth before it; `births` must be in the order of their times"
    );
}

#[test]
fn check_frame_refuses_an_attribute_whose_list_was_not_built() {
    type Set = fn(&mut ClothFrame);
    let attributes: [(Set, &str); 6] = [
        (|cloth| cloth.pressure = Pressure::Manual { pascals: 1.0, damping: 0.0 }, "`pressure` of cloth 0"),
        (|cloth| cloth.deform_resistance = 1.0, "`ClothLists::shape`"),
        (|cloth| cloth.yield_strain = 0.1, "`ClothLists::plastic`"),
        (|cloth| cloth.bending.angle_scale = 0.0, "`ClothLists::bend_angles`"),
        (|cloth| cloth.tethers = Some(1.0), "`ClothLists::tethers`"),
        (|cloth| cloth.stiffness.bend = Some(1e-3), "`ClothLists::bend`"),
    ];
    let with = |lists| Solver::<f32>::new(one_cloth(grid(3, 3, Vec3::x(), Vec3::y()), lists), 1);
    let every = ClothLists {
        bend_angles: true,
        pressure: true,
        shape: true,
        plastic: true,
        tethers: true,
        ..ClothLists::DEFAULT
    };
    let (without, every) = (with(ClothLists::NONE), with(every));
    assert_eq!(without.check_frame(&without.default_frame()), Ok(()), "defaults need no list");
    for (set, words) in attributes {
        let mut frame = without.default_frame();
        set(&mut frame.cloths[0]);
        let refused = without.check_frame(&frame).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
        assert_eq!(every.check_frame(&frame), Ok(()));
    }
}

#[test]
fn a_default_frame_collides() {
    let (builder, _) = drape(9, 24.0);
    let mut solver: Solver = Solver::new(builder, 1);
    let frame = solver.default_frame();
    for _ in 0..24 {
        assert!(solver.step(&frame, &mut ()).finite);
    }
    let middle = solver.point(ClothId(0), 40);
    assert!(middle.y > 0.3, "the sheet rests on the ball, not below it: {middle}");
}

#[test]
fn a_second_input_mesh_of_a_cloth_is_dropped_and_reported() {
    let (builder, _) = drape(9, 24.0);
    let points = builder.positions(ClothId(0)).to_vec();
    let mesh = InputMesh { cloth: ClothId(0), start: points.clone(), end: points };
    let (_, count, first, _) = run(|input| input.input_meshes = vec![mesh.clone()]);
    assert_eq!((count, first), (0, None));
    let (_, count, first, _) = run(|input| input.input_meshes = vec![mesh.clone(); 3]);
    assert_eq!((count, first), (2, Some(InvalidInput::InputMesh(ClothId(0)))));
}

#[test]
fn exclusions_targets_and_changes_of_nothing_are_dropped_and_reported() {
    let (expected, ..) = run(|_| {});
    let points = |cloth, point| ExcludedSide::Points(vec![(ClothId(cloth), PointId(point))], Vec::new());
    for side in [points(0, 81), points(1, 0), ExcludedSide::Points(vec![], vec![(ColliderId(1), PointId(0))])]
    {
        let exclusion = Arc::new(Exclusion { sides: [side, ExcludedSide::Everything] });
        let (found, count, first, _) = run(|input| input.exclusions = vec![exclusion.clone()]);
        assert_eq!((found, count, first), (expected, 1, Some(InvalidInput::Exclusion(0))));
    }
    let field = Field {
        kind: FieldKind::Uniform { force: Vec3::x() },
        reach: Reach::everywhere(),
        targets: vec![(ClothId(4), 1.0)],
    };
    let (found, count, first, _) = run(|input| input.fields = vec![field.clone()]);
    assert_eq!((found, count, first), (expected, 1, Some(InvalidInput::Field(0))));
    let sound = Field { targets: Vec::new(), ..field.clone() };
    let endless = Field { kind: FieldKind::Uniform { force: Vec3::x() * 1e30 }, ..sound.clone() };
    let (found, count, first, _) =
        run(|input| input.fields = vec![sound.clone(), endless.clone(), field.clone()]);
    assert_eq!((found, count, first), (expected, 2, Some(InvalidInput::Field(1))));
    let change = ParticleChange { cloth: ClothId(0), place: 0, velocity: None, lifespan: Some(1.0) };
    let (found, count, first, _) = run(|input| input.particle_changes = vec![change]);
    assert_eq!((found, count, first), (expected, 1, Some(InvalidInput::ParticleChange(ClothId(0)))));
}

#[test]
fn exclusions_beyond_the_limit_are_dropped_and_reported() {
    let corner = ExcludedSide::Points(vec![(ClothId(0), PointId(0))], Vec::new());
    let exclusion = Arc::new(Exclusion { sides: [corner.clone(), corner] });
    let (_, count, ..) = run(|input| input.exclusions = vec![exclusion.clone(); MAX_EXCLUSIONS]);
    assert_eq!(count, 0);
    let (_, count, first, _) = run(|input| input.exclusions = vec![exclusion.clone(); MAX_EXCLUSIONS + 2]);
    assert_eq!((count, first), (2, Some(InvalidInput::Exclusion(MAX_EXCLUSIONS as u32))));
}

#[test]
fn a_frame_of_more_steps_than_ever_end_is_refused() {
    let (builder, usual) = drape(9, 24.0);
    let solver: Solver = Solver::new(builder, 1);
    let divided = FrameInput { substeps: u32::MAX, ..usual.clone() };
    let refused = |frame| solver.check_frame(frame).unwrap_err().to_string();
    assert_eq!(refused(&divided), "`substeps` of the frame is 4.294967295e9; it must be from 1 to 1e5");
    let evaluated = FrameInput { resistance: ResistanceModel::Physical { evaluations: 1e12 }, ..usual };
    let said = "`resistance.evaluations` of the frame is 1e12; it must be above 0, and at most 1e6";
    assert_eq!(refused(&evaluated), said);
}

#[test]
fn the_passes_of_an_invalid_frame_are_those_of_its_replacement() {
    let (builder, usual) = drape(9, 24.0);
    let solver: Solver = Solver::new(builder, 1);
    let mut surplus = usual.clone();
    surplus.cloths.resize(9, ClothFrame::default());
    surplus.colliders.resize(9, ColliderFrame::default());
    assert_eq!(solver.passes(&surplus), solver.passes(&usual));
}
