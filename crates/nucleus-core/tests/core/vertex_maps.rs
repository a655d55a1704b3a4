//! Vertex maps: factors on attributes, point by point; and the start of a cloth.

use crate::scenes::{LINKS, Vec3, frame, grid, ground, physical, pins, still};
use nucleus_core::{
    BendSolver, Bending, BuildError, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame,
    FrameInput, GroundPlane, Mass, ModelBuilder, Pin, PointId, ResistanceModel, Solver, Start, StateView,
    Surface, VertexMaps,
};

const CLOTH: ClothId = ClothId(0);
const SIDE: u32 = 9;
const PATCH: usize = 81;
const AIRY: ClothLists =
    ClothLists { self_collision: false, bend_angles: true, plastic: true, ..ClothLists::DEFAULT };

/// Two unconnected sheets of 1 m, as one mesh.
fn two_sheets() -> Surface {
    let mut sheets = grid(SIDE, SIDE, Vec3::x(), Vec3::z());
    let other = grid(SIDE, SIDE, Vec3::x(), Vec3::z());
    sheets.positions.extend(other.positions.iter().map(|p| p + Vec3::new(3.0, 0.0, 0.0)));
    other.faces.iter().for_each(|face| {
        let face: Vec<u32> = face.iter().map(|point| point + PATCH as u32).collect();
        sheets.faces.push(&face);
    });
    sheets
}

/// A map with this factor on the first sheet, and 1 on the second.
fn on_the_first(factor: f64) -> Vec<f64> {
    (0..2 * PATCH).map(|point| if point < PATCH { factor } else { 1.0 }).collect()
}

/// The positions of two sheets after twelve frames, each pinned at two corners.
fn swung(factors: VertexMaps, settings: &ClothFrame, mass: f64, resistance: ResistanceModel) -> Vec<Vec3> {
    let surface = two_sheets();
    let held = [0, SIDE as usize - 1].into_iter().flat_map(|k| [k, k + PATCH]);
    let input = FrameInput {
        cloths: vec![*settings],
        pins: pins(&surface, held),
        wind: Vec3::new(0.5, 1.0, 2.0),
        ..frame(3, resistance)
    };
    let mut builder = ModelBuilder::new();
    let cloth = Cloth { vertex_maps: factors, ..Cloth::new(surface, Mass::PerArea(mass), AIRY) };
    builder.cloth(cloth).expect("a good mesh");
    let mut solver = Solver::<f64>::new(builder, 1);
    (0..12).for_each(|_| {
        solver.step(&input, &mut ());
    });
    (0..2 * PATCH).map(|point| solver.point(CLOTH, point)).collect()
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// A map, and the attribute on which the same factor everywhere acts.
type Column = (&'static str, fn(Vec<f64>) -> VertexMaps, fn(&mut ClothFrame, &mut f64, f64));

const COLUMNS: [Column; 11] = [
    ("mass", |mass| VertexMaps { mass, ..VertexMaps::default() }, |_, mass, f| *mass *= f),
    (
        "stretch",
        |stretch| VertexMaps { stretch, ..VertexMaps::default() },
        |cloth, _, f| cloth.stretch_resistance *= f,
    ),
    (
        "compression",
        |compression| VertexMaps { compression, ..VertexMaps::default() },
        |cloth, _, f| cloth.compression_resistance *= f,
    ),
    ("bend", |bend| VertexMaps { bend, ..VertexMaps::default() }, |cloth, _, f| cloth.bend_resistance *= f),
    (
        "rest length",
        |rest_length| VertexMaps { rest_length, ..VertexMaps::default() },
        |cloth, _, f| cloth.rest_length_scale *= f,
    ),
    ("damp", |damp| VertexMaps { damp, ..VertexMaps::default() }, |cloth, _, f| cloth.damp *= f),
    ("drag", |drag| VertexMaps { drag, ..VertexMaps::default() }, |cloth, _, f| cloth.drag *= f),
    (
        "tangential drag",
        |tangential_drag| VertexMaps { tangential_drag, ..VertexMaps::default() },
        |cloth, _, f| cloth.tangential_drag *= f,
    ),
    ("lift", |lift| VertexMaps { lift, ..VertexMaps::default() }, |cloth, _, f| cloth.lift *= f),
    (
        "bend angle dropoff",
        |angle_dropoff| VertexMaps { angle_dropoff, ..VertexMaps::default() },
        |cloth, _, f| cloth.bending.angle_dropoff *= f,
    ),
    (
        "restitution angle",
        |yield_angle| VertexMaps { yield_angle, ..VertexMaps::default() },
        |cloth, _, f| cloth.bending = yielding(cloth.bending.yield_half_angle * f),
    ),
];

/// Resistances with less than one evaluation per substep in Classic: half the resistance is half the strength.
fn lively() -> ClothFrame {
    ClothFrame {
        stretch_resistance: 2.5,
        compression_resistance: 2.0,
        shear_resistance: 1.0,
        bend_resistance: 1.0,
        stretch_damp: 0.1,
        damp: 0.2,
        drag: 0.1,
        tangential_drag: 0.3,
        lift: 0.1,
        bending: yielding(0.02),
        ..still()
    }
}

/// Bends whose half angle is above this stay; the resistance partly grows with the angle.
fn yielding(half_angle: f64) -> Bending {
    Bending {
        solver: BendSolver::Signed,
        angle_dropoff: 0.4,
        yield_sine: half_angle.sin(),
        yield_half_angle: half_angle,
        ..Bending::DEFAULT
    }
}

#[test]
fn a_sheet_with_a_uniform_map_moves_like_one_with_the_scaled_attribute() {
    for resistance in [ResistanceModel::Classic, physical(24.0)] {
        let plain = swung(VertexMaps::default(), &lively(), 0.2, resistance);
        for (name, column, scale) in COLUMNS {
            let varied = swung(column(on_the_first(0.5)), &lively(), 0.2, resistance);
            let (mut settings, mut mass) = (lively(), 0.2);
            scale(&mut settings, &mut mass, 0.5);
            let scaled = swung(VertexMaps::default(), &settings, mass, resistance);
            let first = farthest(&varied[..PATCH], &scaled[..PATCH]);
            let second = farthest(&varied[PATCH..], &plain[PATCH..]);
            // Gravity kicks are rounded to a grid that depends on the largest speed of the whole cloth.
            assert!(first < 1e-9 && second < 1e-9, "{name}, {resistance:?}: {first:e}, {second:e}");
            let effect = farthest(&scaled[..PATCH], &plain[..PATCH]);
            assert!(effect > 1e-6, "{name}, {resistance:?} has no effect here: {effect:e}");
        }
    }
}

#[test]
fn a_map_of_ones_changes_no_bit() {
    for resistance in [ResistanceModel::Classic, physical(24.0)] {
        let plain = swung(VertexMaps::default(), &lively(), 0.2, resistance);
        for (name, column, _) in COLUMNS {
            assert_eq!(swung(column(on_the_first(1.0)), &lively(), 0.2, resistance), plain, "{name}");
        }
    }
}

/// The lengths of the links of a hanging strip at rest, from the top down, in metres.
fn hanging(factors: VertexMaps) -> Vec<f64> {
    let rows = 11;
    let strip = grid(2, rows, Vec3::x() * 0.1, -Vec3::y());
    let cloth = ClothFrame { stretch_damp: 5.0, ..still() };
    let input = FrameInput { cloths: vec![cloth], pins: pins(&strip, [0, 1]), ..frame(24, physical(960.0)) };
    let mut builder = ModelBuilder::new();
    let lists = ClothLists { damp: true, ..LINKS };
    builder
        .cloth(Cloth { vertex_maps: factors, ..Cloth::new(strip, Mass::PerArea(20.0), lists) })
        .expect("a good mesh");
    let mut solver = Solver::<f64>::new(builder, 1);
    (0..240).for_each(|_| {
        solver.step(&input, &mut ());
    });
    // The two sides differ in mass; their mean carries the weight of the row.
    let height =
        |row: u32| [0, 1].map(|k| solver.point(CLOTH, 2 * row as usize + k).y).iter().sum::<f64>() / 2.0;
    (1..rows).map(|row| height(row - 1) - height(row)).collect()
}

/// The exact strains. The strip is 0.1 m wide and has K = 20 · 500 N/m. Mass is by area, so the lowest row has half.
fn strains(mass: impl Fn(usize) -> f64, share: impl Fn(usize) -> f64) -> Vec<f64> {
    let weight = |row: usize| 9.81 * 20.0 * 0.1 * 0.1 * mass(row) * if row == 10 { 0.5 } else { 1.0 };
    let strain = |link: usize| (link + 1..=10).map(weight).sum::<f64>() / (10_000.0 * 0.1 * share(link));
    (0..10).map(strain).collect()
}

fn of_rows(factor: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..22).map(|point| factor(point / 2)).collect()
}

#[test]
fn each_link_of_a_strip_with_a_mass_map_stretches_by_the_weight_below_it() {
    let heavy = |row: usize| if row > 5 { 3.0 } else { 1.0 };
    let lengths = hanging(VertexMaps { mass: of_rows(heavy), ..VertexMaps::default() });
    for (link, (length, strain)) in lengths.iter().zip(strains(heavy, |_| 1.0)).enumerate() {
        assert!((length / 0.1 - 1.0 - strain).abs() < 0.01 * strain, "link {link}: {length}, {strain}");
    }
}

#[test]
fn a_strip_with_a_stretch_map_stretches_by_the_local_stiffness() {
    let soft = |row: usize| if row > 5 { 0.25 } else { 1.0 };
    // A link has the mean of its two ends.
    let of_link = |link: usize| (soft(link) + soft(link + 1)) / 2.0;
    let lengths = hanging(VertexMaps { stretch: of_rows(soft), ..VertexMaps::default() });
    for (link, (length, strain)) in lengths.iter().zip(strains(|_| 1.0, of_link)).enumerate() {
        assert!((length / 0.1 - 1.0 - strain).abs() < 0.01 * strain, "link {link}: {length}, {strain}");
    }
}

#[test]
fn a_link_with_the_factor_zero_exerts_no_force() {
    let surface = grid(2, 3, Vec3::x(), -Vec3::y());
    for resistance in [ResistanceModel::Classic, physical(24.0)] {
        // The upper links have the factor 1/2, the lower ones 0.
        let column: Vec<f64> = (0..6).map(|point| if point < 2 { 1.0 } else { 0.0 }).collect();
        let factors = VertexMaps { stretch: column.clone(), compression: column, ..VertexMaps::default() };
        let mut builder = ModelBuilder::new();
        let cloth = Cloth { vertex_maps: factors, ..Cloth::new(surface.clone(), Mass::PerArea(1.0), LINKS) };
        builder.cloth(cloth).expect("a good mesh");
        let input = FrameInput { pins: pins(&surface, [0, 1]), ..frame(3, resistance) };
        let mut solver = Solver::<f64>::new(builder, 1);
        (0..24).for_each(|_| {
            solver.step(&input, &mut ());
        });
        // Symplectic Euler in 72 steps or more: up to 1/72 more than 9.81/2 m.
        let fall = -1.0 - solver.point(CLOTH, 4).y;
        assert!((fall / 4.905 - 1.0).abs() < 0.015, "{resistance:?}: {fall}");
        assert!((solver.point(CLOTH, 2).y + 0.5).abs() < 0.1, "{resistance:?}");
    }
}

fn refused(cloth: impl Fn(Cloth) -> Cloth) -> BuildError {
    let plain = Cloth::new(grid(2, 2, Vec3::x(), Vec3::z()), Mass::PerPoint(1.0), LINKS);
    ModelBuilder::new().cloth(cloth(plain)).expect_err("it is refused")
}

#[test]
fn an_invalid_vertex_map_is_refused_with_its_attribute_and_point() {
    let none = VertexMaps::default;
    let message =
        |factors: VertexMaps| refused(|cloth| Cloth { vertex_maps: factors.clone(), ..cloth }).to_string();
    let few = message(VertexMaps { drag: vec![1.0; 3], ..none() });
    assert_eq!(few, "there are 3 factors on drag, but 4 points");
    let weightless = message(VertexMaps { mass: vec![1.0, 1.0, 0.0, 1.0], ..none() });
    assert_eq!(weightless, "the factor on mass of point 2 must be between 0.000001 and 1000000, not 0");
    let no_number = message(VertexMaps { bend: vec![1.0, f64::NAN, 0.0, 1.0], ..none() });
    assert_eq!(no_number, "the factor on bend of point 1 must be between 0 and 1, not NaN");
}

#[test]
fn a_cloth_that_starts_from_another_runs_state_continues_like_it() {
    let surface = grid(SIDE, SIDE, Vec3::x(), Vec3::z());
    let cloth = ClothFrame { bend_resistance: 0.5, ..still() };
    let input = FrameInput { cloths: vec![cloth], pins: pins(&surface, [0, 8]), ..frame(3, physical(48.0)) };
    let of = |start: Start| {
        let mut builder = ModelBuilder::new();
        let cloth = Cloth { start, ..Cloth::new(surface.clone(), Mass::PerArea(0.2), AIRY) };
        builder.cloth(cloth).expect("a good mesh");
        Solver::<f64>::new(builder, 1)
    };
    let points = |solver: &Solver<f64>| (0..PATCH).map(|k| solver.point(CLOTH, k)).collect::<Vec<_>>();
    let run = |solver: &mut Solver<f64>| {
        (0..6).for_each(|_| {
            solver.step(&input, &mut ());
        });
    };
    let mut whole = of(Start::default());
    run(&mut whole);
    let mut fast = Vec::new();
    whole.velocities(CLOTH, 1.0, &mut fast);
    let velocities = fast.iter().map(|v| Vec3::new(v[0].into(), v[1].into(), v[2].into())).collect();
    let mut again = of(Start { positions: points(&whole), velocities });
    assert_eq!(points(&again), points(&whole));
    run(&mut whole);
    run(&mut again);
    // Observers read velocities as `f32`: 1e-7 of some m/s, for a quarter of a second.
    let apart = farthest(&points(&again), &points(&whole));
    assert!(apart < 1e-5, "{apart:e}");
    let fallen = points(&whole).iter().map(|p| p.y).fold(0.0, f64::min);
    assert!(fallen < -0.2, "{fallen}");
}

#[test]
fn an_invalid_start_is_refused() {
    let few = Start { positions: vec![Vec3::zeros(); 3], ..Start::default() };
    let few = refused(|cloth| Cloth { start: few.clone(), ..cloth });
    assert_eq!(few, BuildError::StartCount { what: "positions", given: 3, points: 4 });
    let mut velocities = vec![Vec3::zeros(); 4];
    velocities[2].y = f64::INFINITY;
    let endless = Start { velocities, ..Start::default() };
    let endless = refused(|cloth| Cloth { start: endless.clone(), ..cloth });
    assert_eq!(endless, BuildError::BadStart { what: "velocity", point: 2 });
}

/// The ground under a sheet.
#[derive(Debug, Clone, Copy)]
enum Floor {
    Plane,
    Collider,
    /// Cloth with every point pinned.
    Cloth,
}

/// The distance that a sheet slides in half a second down a slope of 30 degrees, in metres. Its friction is 0.4, that
/// of the slope 0.1.
fn slid(floor: Floor, factor: f64) -> f64 {
    let lying = |mut surface: Surface, height: f64, middle: f64| {
        surface.positions.iter_mut().for_each(|p| *p += Vec3::new(-middle, height, -middle));
        surface
    };
    let mut builder = ModelBuilder::new();
    let sheet = lying(grid(5, 5, Vec3::x() * 0.2, Vec3::z() * 0.2), 0.0101, 0.1);
    let factors = VertexMaps { friction: vec![factor; 25], ..VertexMaps::default() };
    let mass = Mass::PerArea(0.2);
    builder.cloth(Cloth { vertex_maps: factors, ..Cloth::new(sheet, mass, LINKS) }).expect("a good mesh");
    let cloth = ClothFrame { thickness: 0.005, friction: 0.4, ..still() };
    let slope = Vec3::new(9.81 * 0.5, -9.81 * 0.75f64.sqrt(), 0.0);
    let mut input = FrameInput { gravity: slope, cloths: vec![cloth], ..frame(3, physical(48.0)) };
    let wide = lying(grid(9, 9, Vec3::x() * 8.0, Vec3::z() * 8.0), 0.0, 4.0);
    match floor {
        Floor::Plane => {
            let origin = Vec3::y() * 0.005;
            input.plane = Some(GroundPlane { origin, ..ground(0.1) });
        }
        Floor::Collider => {
            builder.collider(Collider { surface: wide }).expect("a good mesh");
            let collider =
                ColliderFrame { collide: true, thickness: 0.005, friction: 0.1, ..Default::default() };
            input.colliders.push(collider);
        }
        Floor::Cloth => {
            let pin = |(point, place): (usize, &Vec3)| Pin {
                cloth: ClothId(1),
                point: PointId(point as u32),
                start: *place,
                end: *place,
            };
            input.pins = wide.positions.iter().enumerate().map(pin).collect();
            builder.cloth(Cloth::new(wide, mass, LINKS)).expect("a good mesh");
            input.cloths.push(ClothFrame { friction: 0.1, ..cloth });
        }
    }
    let mut solver = Solver::<f64>::new(builder, 1);
    (0..12).for_each(|_| {
        solver.step(&input, &mut ());
    });
    solver.point(CLOTH, 12).x
}

#[test]
fn a_sheet_slides_down_a_slope_by_its_mapped_friction_plus_that_of_the_slope() {
    for floor in [Floor::Plane, Floor::Collider, Floor::Cloth] {
        for factor in [0.0, 0.5, 1.0, 2.0] {
            let friction = 0.4 * factor + 0.1;
            let down = (0.5 - friction * 0.75f64.sqrt()).max(0.0);
            let expected = 9.81 * down * 0.125;
            let found = slid(floor, factor);
            // Relative to the 0.61 m without friction. The sheet falls a tenth of a millimetre first.
            assert!((found - expected).abs() < 0.03 * 0.61, "{floor:?}, {factor}: {found} for {expected}");
        }
    }
}

/// A sheet of 0.2 m at rest on two halves of a floor, one collider of 8 m with a map that is `factors[0]` where x < 0 and
/// `factors[1]` where x > 0; the position and the height of its middle after half a second.
fn on_a_mapped_floor(
    x: f64,
    maps: VertexMaps,
    cloth: ClothFrame,
    collider: ColliderFrame,
    pull: Vec3,
) -> Vec3 {
    let mut builder = ModelBuilder::new();
    let mut sheet = grid(5, 5, Vec3::x() * 0.2, Vec3::z() * 0.2);
    sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(x - 0.1, 0.0201, -0.1));
    builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), LINKS)).expect("a good mesh");
    let collider_of = builder.collider(Collider { surface: floor() }).expect("a good mesh");
    builder.set_collider_maps(collider_of, maps).expect("good maps");
    let input = FrameInput {
        gravity: pull,
        cloths: vec![cloth],
        colliders: vec![collider],
        ..frame(6, physical(48.0))
    };
    let mut solver = Solver::<f64>::new(builder, 1);
    (0..12).for_each(|_| {
        solver.step(&input, &mut ());
    });
    solver.point(CLOTH, 12)
}

/// A floor of 8 m with a row of points at x = 0.
fn floor() -> Surface {
    let mut floor = grid(9, 9, Vec3::x() * 8.0, Vec3::z() * 8.0);
    floor.positions.iter_mut().for_each(|p| *p -= Vec3::new(4.0, 0.0, 4.0));
    floor
}

/// `low` at the points with x below zero, `high` at those above, the mean between.
fn by_half(low: f64, high: f64) -> Vec<f64> {
    let of = |p: &Vec3| {
        if p.x < -0.1 {
            low
        } else if p.x > 0.1 {
            high
        } else {
            (low + high) / 2.0
        }
    };
    floor().positions.iter().map(of).collect()
}

const FLOOR: fn() -> ColliderFrame =
    || ColliderFrame { collide: true, thickness: 0.01, friction: 0.4, ..ColliderFrame::default() };
const LYING: fn() -> ClothFrame = || ClothFrame { thickness: 0.01, friction: 0.1, ..still() };

#[test]
fn a_sheet_slides_down_a_collider_by_the_friction_of_the_colliders_map() {
    let slope = Vec3::new(0.0, -9.81 * 0.75f64.sqrt(), 9.81 * 0.5);
    let maps = || VertexMaps { friction: by_half(0.0, 2.0), ..VertexMaps::default() };
    // On the low half only the sheet's own 0.1 holds; on the high half 0.9, more than the slope of 0.577.
    let [slippery, rough] = [-2.5, 2.5].map(|x| on_a_mapped_floor(x, maps(), LYING(), FLOOR(), slope).z);
    let expected = 9.81 * (0.5 - 0.1 * 0.75f64.sqrt()) * 0.125;
    assert!((slippery - expected).abs() < 0.03 * 0.61, "{slippery} for {expected}");
    assert!(rough.abs() < 1e-3, "{rough}");
}

#[test]
fn a_sheet_lies_as_high_as_the_thickness_map_of_a_collider_says() {
    let maps = || VertexMaps { thickness: by_half(0.0, 3.0), ..VertexMaps::default() };
    let down = Vec3::new(0.0, -9.81, 0.0);
    // Below 3 thicknesses of 0.01 the start is inside: the depth is resolved at 1 m/s.
    let [thin, thick] = [-2.5, 2.5].map(|x| on_a_mapped_floor(x, maps(), LYING(), FLOOR(), down).y);
    assert!((thin - 0.01).abs() < 2e-4 && (thick - 0.04).abs() < 2e-4, "{thin} {thick}");
    // Half way between a point of factor 0 and the row of 1.5: 0.75.
    let between = on_a_mapped_floor(-0.5, maps(), LYING(), FLOOR(), down).y;
    assert!((between - 0.0175).abs() < 2e-3, "{between}");
}

#[test]
fn a_collider_collides_bounces_and_sticks_where_its_maps_say() {
    let down = Vec3::new(0.0, -9.81, 0.0);
    let strength = || VertexMaps { collide_strength: by_half(0.0, 1.0), ..VertexMaps::default() };
    let [fallen, held] = [-2.5, 2.5].map(|x| on_a_mapped_floor(x, strength(), LYING(), FLOOR(), down).y);
    assert!((fallen + 9.81 * 0.125).abs() < 0.05 && (held - 0.02).abs() < 2e-4, "{fallen} {held}");
    // Pulled upwards: what sticks with 1 never parts.
    let stickiness = || VertexMaps { stickiness: by_half(0.0, 1.0), ..VertexMaps::default() };
    let sticky = || ColliderFrame { stickiness: 1.0, ..FLOOR() };
    let [risen, stuck] =
        [-2.5, 2.5].map(|x| on_a_mapped_floor(x, stickiness(), LYING(), sticky(), -down * 0.1).y);
    assert!(risen > 0.1 && stuck < 0.025, "{risen} {stuck}");
}

#[test]
fn a_drop_bounces_only_where_the_bounce_map_of_a_collider_says() {
    let maps = || VertexMaps { bounce: by_half(0.0, 1.0), ..VertexMaps::default() };
    let highest = |x: f64| {
        let mut builder = ModelBuilder::new();
        let mut sheet = grid(3, 3, Vec3::x() * 0.1, Vec3::z() * 0.1);
        sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(x - 0.05, 0.52, -0.05));
        builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), LINKS)).expect("a good mesh");
        let floor = builder.collider(Collider { surface: floor() }).expect("a good mesh");
        builder.set_collider_maps(floor, maps()).expect("good maps");
        let bouncy = ColliderFrame { bounce: 0.8, ..FLOOR() };
        let input =
            FrameInput { cloths: vec![LYING()], colliders: vec![bouncy], ..frame(20, physical(48.0)) };
        let mut solver = Solver::<f64>::new(builder, 1);
        // It lands after 0.32 s, and is highest 0.26 s later.
        (0..8).for_each(|_| _ = solver.step(&input, &mut ()));
        let after = |_| {
            solver.step(&input, &mut ());
            solver.point(CLOTH, 4).y
        };
        (8..18).map(after).fold(0.0, f64::max)
    };
    let [dead, lively] = [-2.5, 2.5].map(highest);
    // 0.8² of the 0.5 m that it fell.
    assert!(dead < 0.03 && (lively - 0.02 - 0.32).abs() < 0.03, "{dead} {lively}");
}

#[test]
fn maps_of_ones_on_a_collider_change_a_slide_by_rounding_alone() {
    let slope = Vec3::new(0.0, -9.81 * 0.75f64.sqrt(), 9.81 * 0.5);
    let ones = || vec![1.0; floor().positions.len()];
    let maps = VertexMaps { friction: ones(), thickness: ones(), ..VertexMaps::default() };
    let [mapped, plain] =
        [maps, VertexMaps::default()].map(|maps| on_a_mapped_floor(2.5, maps, LYING(), FLOOR(), slope));
    assert!((mapped - plain).norm() < 1e-9 && plain.z > 0.01, "{mapped:?} {plain:?}");
}
