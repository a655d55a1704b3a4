//! Every number in the input of a frame may be NaN, infinite, huge or negative: the frame is solved all the same.
//!
//! The visitors in `numbers.rs` name every field of the input without `..`, so a field that is added does not compile until
//! it is visited.

use crate::scenes::{Vec3, frame, grid, ground, physical, pins};
use nucleus_core::nalgebra::Matrix3;
use nucleus_core::{
    Bending, Birth, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, ColliderId,
    ConstraintFrame, Elements, Falloff, Field, FieldKind, FieldSide, Fold, ForceField, FrameInput,
    InputAttract, InputMesh, InvalidInput, Link, LinkForce, LinkKind, LinkSide, Liquid, Mass, ModelBuilder,
    Noise, ParticleChange, Particles, PointField, PointId, Pressure, PushOut, Reach, ResistanceModel,
    SelfCollision, Solver, StartVelocity, StateView, Stiffness, Surface, Volume, VolumeAxis, VolumeShape,
    WindField,
};

mod numbers;

use numbers::Numbers;

const SHEET: ClothId = ClothId(0);
const BEADS: ClothId = ClothId(2);

/// Two sheets, particles and a liquid above a ball.
fn model() -> ModelBuilder {
    let lists = ClothLists {
        bend_angles: true,
        pressure: true,
        shape: true,
        plastic: true,
        tethers: true,
        buckling: true,
        ..ClothLists::DEFAULT
    };
    let mut builder = ModelBuilder::new();
    for height in [0.3, 0.35] {
        let mut sheet = grid(4, 4, Vec3::x() * 0.4, Vec3::z() * 0.4);
        sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.2, height, -0.2));
        let warp = vec![Vec3::x(); sheet.faces.len()];
        let cloth = Cloth { warp, ..Cloth::new(sheet, Mass::PerArea(0.2), lists) };
        builder.cloth(cloth).expect("a good mesh");
    }
    for at in [0.0, 0.3] {
        let positions = (0..4).map(|k| Vec3::new(at + 0.03 * f64::from(k), 0.5, 0.0)).collect();
        let surface = Surface { positions, ..Surface::default() };
        let particles = Some(Particles { capacity: 9, rotates: true, ..Particles::default() });
        let lists = ClothLists { air: true, self_collision: true, ..ClothLists::NONE };
        let cloth = Cloth { particles, ..Cloth::new(surface, Mass::PerPoint(0.01), lists) };
        builder.cloth(cloth).expect("good particles");
    }
    builder.collider(Collider { surface: Surface::sphere(Vec3::zeros(), 0.25, 1) }).expect("a good mesh");
    builder
}

fn surface_fields() -> (Option<ForceField>, Option<PointField>, WindField) {
    let force = ForceField {
        side: FieldSide::Double,
        magnitude: 1.0,
        distance: 0.5,
        falloff: [1.0; ForceField::SAMPLES],
    };
    let point =
        PointField { magnitude: 1.0, self_attract: 0.1, radius: 0.01, distance: 0.3, falloff: [1.0; 17] };
    let wind = WindField {
        shadow_distance: 0.2,
        shadow_diffusion: 0.1,
        self_shadow: true,
        push_distance: 0.2,
        push_vorticity: 0.1,
    };
    (Some(force), Some(point), wind)
}

fn cloths() -> Vec<ClothFrame> {
    let (field, point_field, wind_field) = surface_fields();
    let own = SelfCollision { on: true, thickness: 0.01, elements: Elements::Faces, edges: true };
    let gas =
        Pressure::Gas { start: 0.1, bulk: 10.0, pump: 0.1, tightness: 0.9, damping: 0.01, sealed: true };
    let sheet = ClothFrame {
        shear_resistance: 1.0,
        tethers: Some(1.0),
        buckles: true,
        damp: 0.1,
        local_force: Vec3::x() * 0.01,
        thickness: 0.01,
        push_out: PushOut { share: 0.1, radius: 0.02 },
        crossover_push: 0.1,
        self_collision: own,
        yield_strain: 0.2,
        bending: Bending { yield_sine: 0.5, yield_half_angle: 0.5, ..Bending::DEFAULT },
        pressure: gas,
        rigidity: 0.1,
        deform_resistance: 0.1,
        input_attract: InputAttract { strength: 0.1, damp: 0.1, motion_drag: 0.1 },
        field,
        point_field,
        wind_field,
        ..ClothFrame::default()
    };
    let given = Some(1000.0);
    let stiffness = Stiffness {
        stretch: given,
        compression: given,
        shear: given,
        bend: Some(1e-5),
        warp: given,
        weft: given,
    };
    let pressure = Pressure::Manual { pascals: 1.0, damping: 0.01 };
    let balls = SelfCollision { elements: Elements::Points, edges: false, ..own };
    let beads = ClothFrame { thickness: 0.01, elements: Elements::Points, self_collision: balls, ..sheet };
    let liquid = Liquid { spacing: 0.03, incompressibility: 1.0, viscosity: 0.01, surface_tension: 1e-4 };
    vec![
        sheet,
        ClothFrame { stiffness, pressure, ..sheet },
        beads,
        ClothFrame { liquid: Some(liquid), ..beads },
    ]
}

fn fields() -> Vec<Field> {
    let noise = Noise { frequency: Vec3::repeat(1.0), phase: Vec3::zeros(), octaves: 2, ratio: 0.5 };
    let (force, axis) = (0.01, Vec3::y());
    let volume_axis = VolumeAxis {
        from_center: force,
        from_axis: force,
        along_axis: force,
        around_axis: force,
        directional: axis * force,
        axis,
        turbulence: force,
        noise,
    };
    let volume = Volume {
        shape: VolumeShape::Torus,
        to_local: Matrix3::identity(),
        offset: Vec3::zeros(),
        section: 0.5,
        sweep: Some([0.5, 0.5]),
        is_excluded: false,
    };
    let kinds = [
        FieldKind::Gravity { acceleration: axis * force },
        FieldKind::Uniform { force: axis * force },
        FieldKind::Radial { force },
        FieldKind::Newton { magnitude: force, min_distance: 0.1 },
        FieldKind::Drag { magnitude: force, along: Some(axis), velocity: axis, half_speed: 1.0 },
        FieldKind::Air { velocity: axis, rate: 0.1, component_only: true, spread: Some(0.5) },
        FieldKind::Turbulence { force, noise },
        FieldKind::Vortex { force, axis },
        FieldKind::VolumeAxis(volume_axis),
    ];
    let field = |(at, kind): (usize, FieldKind)| Field {
        kind,
        reach: Reach {
            attenuation: 1.0,
            max_distance: 2.0,
            volume: (at == 2).then_some(volume),
            ..Reach::everywhere()
        },
        targets: (0..4).map(|cloth| (ClothId(cloth), 1.0)).collect(),
    };
    kinds.into_iter().enumerate().map(field).collect()
}

fn constraints() -> Vec<ConstraintFrame> {
    let point = |cloth: u32, point: u32| LinkSide::point(ClothId(cloth), PointId(point));
    let face = [1, 2, 5].map(PointId);
    let weights = [0.3, 0.3, 0.4];
    let place = LinkSide::Cloth { cloth: SHEET, points: face, weights };
    let on_ball = LinkSide::Collider { collider: ColliderId(0), points: face, weights };
    let fold = Fold { max_length: 0.1, holds: [0, u32::MAX] };
    let hinge = LinkSide::Cloth { cloth: ClothId(1), points: face, weights: [-0.5, -0.5, 1.0] };
    let links = vec![
        Link::new([point(0, 0), point(1, 0)], 0.05),
        Link::new([place, point(1, 3)], 0.05),
        Link::new([point(0, 7), on_ball], 0.05),
        Link::new([point(0, 12), LinkSide::Space(Vec3::new(0.1, 0.4, 0.0))], 0.05),
        Link { kind: LinkKind::Fold(fold), ..Link::new([place, hinge], 0.05) },
    ];
    let ramp = Falloff { distance: 1.0, samples: [1.0; Falloff::SAMPLES] };
    let force = Some(LinkForce { acceleration: 0.1, falloff: ramp });
    let springs = ConstraintFrame {
        formed: Some(links),
        bend_strength: 5.0,
        break_half_sine: 0.9,
        glue_strength: 0.9,
        can_break: true,
        damp: 0.1,
        motion_drag: 0.1,
        force,
        dropoff: Some(ramp),
        ..ConstraintFrame::default()
    };
    let sliding = Link { kind: LinkKind::Surface, ..Link::new([point(1, 15), place], 0.02) };
    let oblique = Link { kind: LinkKind::Oblique([0.6, 0.3]), ..sliding };
    let rubber = ConstraintFrame {
        formed: Some(vec![sliding, oblique]),
        slides: true,
        friction: 0.3,
        keep_off: Some(0.01),
        ..ConstraintFrame::default()
    };
    vec![springs, rubber]
}

/// A frame in which everything acts.
fn input(builder: &ModelBuilder, resistance: ResistanceModel) -> FrameInput {
    let sheet = &builder.cloths()[0].surface;
    let ball = &builder.colliders()[0].surface.positions;
    let (field, point_field, wind_field) = surface_fields();
    let collider = ColliderFrame {
        start: ball.clone(),
        end: ball.iter().map(|p| p + Vec3::y() * 0.001).collect(),
        thickness: 0.01,
        push_out: PushOut { share: 0.1, radius: 0.02 },
        field,
        point_field,
        wind_field,
        ..ColliderFrame::default()
    };
    let birth = |time: f64| Birth {
        cloth: BEADS,
        time,
        position: Vec3::new(0.1, 0.6, 0.1),
        velocity: Vec3::y(),
        lifespan: 3.0,
    };
    let change = ParticleChange { cloth: BEADS, place: 1, velocity: Some(Vec3::x()), lifespan: Some(2.0) };
    FrameInput {
        wind: Vec3::new(1.0, 0.0, 0.2),
        wind_noise: 0.5,
        plane: Some(ground(0.2)),
        cloths: cloths(),
        colliders: vec![collider],
        pins: pins(sheet, [3]),
        velocities: vec![StartVelocity {
            cloth: SHEET,
            point: PointId(1),
            velocity: Vec3::y(),
            acceleration: Vec3::z(),
        }],
        input_meshes: vec![InputMesh {
            cloth: SHEET,
            start: sheet.positions.clone(),
            end: sheet.positions.clone(),
        }],
        constraints: constraints(),
        births: vec![birth(0.3), birth(0.7)],
        particle_changes: vec![change],
        fields: fields(),
        ..frame(1, resistance)
    }
}

/// What a value did: how many replaced values were reported, and whether all positions stayed finite.
fn outcome(builder: &ModelBuilder, input: &FrameInput) -> (u64, bool) {
    let mut solver = Solver::<f32>::new(builder.clone(), 1);
    let refused = solver.check_frame(input).err();
    let sanitized = solver.step(input, &mut ()).sanitized.count;
    let is_bad = refused.is_some_and(|refused| !matches!(refused, InvalidInput::NoList { .. }));
    // A number that the documentation excludes may be one that a step can compute with.
    let is_excluded =
        matches!(refused, Some(InvalidInput::OutOfRange { .. } | InvalidInput::BirthOrder { .. }));
    assert!(is_bad || sanitized == 0, "what is replaced is refused beforehand");
    assert!(!is_bad || is_excluded || sanitized > 0, "{refused:?} is refused, and is within its range");
    let mut later = input.clone();
    later.constraints.iter_mut().for_each(|constraint| constraint.formed = None);
    let report = solver.step(&later, &mut ());
    let finite = (0..4).map(ClothId).all(|cloth| {
        let mut out = Vec::new();
        solver.positions(cloth, 1.0, &mut out);
        out.iter().flatten().all(|x| x.is_finite())
    });
    (sanitized, finite && report.finite)
}

/// Numbers that may be infinite: a limit that is never reached.
const MAY_BE_INFINITE: [&str; 4] =
    ["lifespan of a birth", "lifespan of a change", "yield limit", "largest distance"];

fn check_every_number(resistance: ResistanceModel, bad_numbers: &[f64]) {
    let builder = model();
    let usual = input(&builder, resistance);
    assert_eq!(outcome(&builder, &usual), (0, true), "the frame itself is valid");
    let mut count_of = usual.clone();
    let mut all = Numbers::default();
    all.frame(&mut count_of);
    let mut wrong = Vec::new();
    for at in 0..all.0.len() {
        for &bad in bad_numbers {
            let mut planted = usual.clone();
            let mut numbers = Numbers::default();
            numbers.frame(&mut planted);
            let (name, number) = numbers.0.swap_remove(at);
            *number = bad;
            let (sanitized, finite) = outcome(&builder, &planted);
            let must_be_reported =
                bad.is_nan() || bad.is_infinite() && !MAY_BE_INFINITE.contains(&name.as_str());
            if !finite || must_be_reported && sanitized == 0 {
                wrong.push(format!("{name} ({at}) = {bad:e}: {sanitized} replaced, finite: {finite}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_number_of_a_physical_frame_is_reported_or_harmless() {
    let infinite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    check_every_number(physical(4.0), &[&infinite[..], &[1e30, -1e30, -1.0]].concat());
}

#[test]
fn every_number_of_a_classic_frame_is_reported_or_harmless() {
    // Which numbers are replaced does not depend on the model of resistance, what the solver does with the rest does.
    check_every_number(ResistanceModel::Classic, &[f64::NAN, 1e30, -1.0]);
}

#[test]
fn the_largest_valid_numbers_of_a_constraint_are_harmless() {
    let builder = model();
    let mut usual = input(&builder, physical(4.0));
    // Cloth of such a size beside a liquid has so many samples that a frame takes minutes.
    usual.cloths[3].liquid = None;
    type Plant = fn(&mut FrameInput);
    let plants: [(&str, Plant); 8] = [
        ("rest", |input| links(input)[0].rest = 1e9),
        ("rest on a surface", |input| links_of(input, 1)[0].rest = 1e9),
        ("weights", |input| side(input, 1, [1e9; 3])),
        ("force", |input| force(input).acceleration = 1e12),
        ("falloff", |input| force(input).falloff.samples = [1e6; Falloff::SAMPLES]),
        ("space", |input| input.constraints[0].space[1].0 *= 1e6),
        ("field", |input| {
            input.colliders[0].field.iter_mut().for_each(|field| field.falloff = [1e6; 17]);
        }),
        ("duration", |input| input.duration = 1e-12),
    ];
    for (name, plant) in plants {
        let mut planted = usual.clone();
        plant(&mut planted);
        assert_eq!(outcome(&builder, &planted), (0, true), "{name}");
    }
    let mut beyond = usual;
    links(&mut beyond)[0].rest = 1.1e9;
    assert_eq!(outcome(&builder, &beyond), (1, true));
}

fn links(input: &mut FrameInput) -> &mut Vec<Link> {
    links_of(input, 0)
}

fn links_of(input: &mut FrameInput, constraint: usize) -> &mut Vec<Link> {
    input.constraints[constraint].formed.as_mut().expect("formed in this frame")
}

fn force(input: &mut FrameInput) -> &mut LinkForce {
    input.constraints[0].force.as_mut().expect("a force")
}

fn side(input: &mut FrameInput, link: usize, given: [f64; 3]) {
    if let LinkSide::Cloth { weights, .. } = &mut links(input)[link].sides[0] {
        *weights = given;
    }
}
