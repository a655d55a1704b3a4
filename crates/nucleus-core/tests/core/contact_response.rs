//! Contact response: adhesion, restitution, partial collision, push-out, vertex maps.

use crate::scenes::{LINKS, Vec3, cuboid, frame, grid, ground, physical, pins, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, Faces, FrameInput,
    GroundPlane, Mass, ModelBuilder, PushOut, ResistanceModel, SelfCollision, Solver, Start, StateView,
    Surface, VertexMaps,
};

const FIRST: ClothId = ClothId(0);
const SECOND: ClothId = ClothId(1);
const THICKNESS: f64 = 0.01;

/// Points without links.
fn beads(positions: Vec<Vec3>) -> Surface {
    Surface { positions, faces: Faces::default() }
}

fn bead_settings() -> ClothFrame {
    ClothFrame { thickness: THICKNESS, friction: 0.0, elements: Elements::Points, ..still() }
}

fn moving(surface: Surface, mass: f64, velocity: Vec3) -> Cloth {
    let velocities = vec![velocity; surface.positions.len()];
    let start = Start { velocities, ..Start::default() };
    Cloth { start, ..Cloth::new(surface, Mass::PerPoint(mass), ClothLists::NONE) }
}

fn solver(cloths: Vec<Cloth>, colliders: Vec<Surface>) -> Solver<f64> {
    let mut builder = ModelBuilder::new();
    for cloth in cloths {
        builder.cloth(cloth).expect("a good mesh");
    }
    for surface in colliders {
        builder.collider(Collider { surface }).expect("a good mesh");
    }
    Solver::new(builder, 2)
}

fn velocity(solver: &Solver<f64>, cloth: ClothId) -> Vec3 {
    let mut all = Vec::new();
    solver.velocities(cloth, 1.0, &mut all);
    Vec3::from(all[0].map(f64::from))
}

fn weightless(cloths: Vec<ClothFrame>) -> FrameInput {
    FrameInput { gravity: Vec3::zeros(), cloths, ..frame(3, physical(96.0)) }
}

/// The speeds after two beads met head on, and before.
fn head_on(masses: [f64; 2], speeds: [f64; 2], bounce: [f64; 2]) -> [f64; 2] {
    let bead = |x: f64, k: usize| moving(beads(vec![Vec3::x() * x]), masses[k], Vec3::x() * speeds[k]);
    let mut solver = solver(vec![bead(-0.1, 0), bead(0.1, 1)], Vec::new());
    let settings = bounce.map(|bounce| ClothFrame { bounce, ..bead_settings() });
    let input = weightless(settings.to_vec());
    (0..6).for_each(|_| {
        solver.step(&input, &mut ());
    });
    [FIRST, SECOND].map(|bead| velocity(&solver, bead).x)
}

#[test]
fn two_beads_in_a_head_on_collision_follow_newtons_law_of_restitution() {
    for (masses, speeds, bounce) in [
        ([1.0, 1.0], [1.0, -1.0], [1.0, 1.0]),
        ([1.0, 3.0], [2.0, 0.0], [0.5, 0.0]),
        ([5.0, 1.0], [1.0, -2.0], [0.2, 0.8]),
        ([1.0, 2.0], [3.0, 0.0], [0.0, 0.0]),
        // More than all of the speed would be energy from nowhere.
        ([1.0, 2.0], [3.0, 0.0], [40.0, 0.0]),
    ] {
        let restitution = f64::max(bounce[0], bounce[1]).min(1.0);
        let [m, n] = masses;
        let common = (m * speeds[0] + n * speeds[1]) / (m + n);
        let parting = restitution * (speeds[0] - speeds[1]) / (m + n);
        let expected = [common - n * parting, common + m * parting];
        let found = head_on(masses, speeds, bounce);
        for k in 0..2 {
            assert!(
                (found[k] - expected[k]).abs() < 1e-6 * speeds[0],
                "{masses:?}: {found:?}, not {expected:?}"
            );
        }
    }
}

// EVIDENCE: N1.1-1  beads act on cloth and cloth on beads
#[test]
fn a_bead_that_bounces_on_a_free_sheet_gives_it_the_momentum_it_loses() {
    let sheet = grid(9, 9, Vec3::x() * 0.4, Vec3::z() * 0.4);
    let bead = moving(beads(vec![Vec3::new(0.2, 0.1, 0.2)]), 0.05, Vec3::y() * -3.0);
    let mut solver = solver(vec![Cloth::new(sheet, Mass::PerPoint(0.001), LINKS), bead], Vec::new());
    let sheet = ClothFrame { thickness: 0.0, bounce: 0.7, friction: 0.0, ..still() };
    let input = weightless(vec![sheet, bead_settings()]);
    (0..6).for_each(|_| {
        solver.step(&input, &mut ());
    });
    let mut all = Vec::new();
    solver.velocities(FIRST, 1.0, &mut all);
    let of_sheet: f64 = all.iter().map(|v| 0.001 * f64::from(v[1])).sum();
    let of_bead = 0.05 * velocity(&solver, SECOND).y;
    assert!(velocity(&solver, SECOND).y > -2.9, "they have met");
    assert!((of_sheet + of_bead + 0.15).abs() < 1e-6, "{of_sheet} and {of_bead}");
}

/// The height of a bead that starts touching a ceiling, after some frames.
fn hanging(stickiness: [f64; 2], frames: u32, resistance: ResistanceModel) -> f64 {
    let ceiling = cuboid(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.2, 1.0));
    let start = Vec3::new(0.13, -THICKNESS, 0.21);
    let mut solver = solver(vec![moving(beads(vec![start]), 0.1, Vec3::zeros())], vec![ceiling]);
    let ceiling =
        ColliderFrame { collide: true, stickiness: stickiness[1], friction: 1.0, ..ColliderFrame::default() };
    let bead = ClothFrame { stickiness: stickiness[0], ..bead_settings() };
    let input = FrameInput { cloths: vec![bead], colliders: vec![ceiling], ..frame(3, resistance) };
    (0..frames).for_each(|_| {
        solver.step(&input, &mut ());
    });
    solver.point(FIRST, 0).y
}

#[test]
fn cloth_with_a_stickiness_of_one_in_sum_never_leaves_a_ceiling() {
    for resistance in [physical(96.0), ResistanceModel::Classic] {
        for stickiness in [[0.5, 0.5], [2.0, 0.0], [0.0, 1.0]] {
            let height = hanging(stickiness, 48, resistance);
            assert!((height + THICKNESS).abs() < 1e-4, "{stickiness:?}: {height}");
        }
        assert!(hanging([0.0, 0.0], 24, resistance) < -4.0, "without stickiness it falls");
    }
}

#[test]
fn cloth_leaves_a_ceiling_later_with_more_stickiness() {
    for resistance in [physical(96.0), ResistanceModel::Classic] {
        let heights = [0.0, 0.5, 0.8, 0.9].map(|x| hanging([x, 0.0], 3, resistance));
        assert!(heights.is_sorted() && heights[3] > heights[0] + 0.01, "{heights:?}");
    }
}

#[test]
fn the_separation_speed_under_adhesion_hardly_depends_on_evaluations() {
    // Within reach of the ceiling it sinks at a speed that it soon has, g T (1 - s) / s, whatever the steps are.
    let heights = [48.0, 192.0, 768.0].map(|evaluations| hanging([0.9, 0.0], 2, physical(evaluations)));
    let way = heights[2] + THICKNESS;
    assert!(
        way < 0.0 && heights.iter().all(|y| (y + THICKNESS - way).abs() < 0.25 * way.abs()),
        "{heights:?}"
    );
}

#[test]
fn sticky_cloth_hangs_from_sticky_cloth_and_leaves_other_cloth() {
    let hangs = |stickiness: f64| {
        let upper = grid(5, 5, Vec3::x() * 0.4, Vec3::z() * 0.4);
        let mut lower = grid(5, 5, Vec3::x() * 0.3, Vec3::z() * 0.3);
        lower.positions.iter_mut().for_each(|p| *p += Vec3::new(0.043, -0.01, 0.057));
        let held = pins(&upper, 0..25);
        let sheet = |surface| Cloth::new(surface, Mass::PerArea(0.2), LINKS);
        let mut solver = solver(vec![sheet(upper), sheet(lower)], Vec::new());
        let settings = ClothFrame { thickness: 0.005, stickiness, friction: 0.5, ..still() };
        let input = FrameInput { cloths: vec![settings; 2], pins: held, ..frame(3, physical(96.0)) };
        (0..24).for_each(|_| {
            solver.step(&input, &mut ());
        });
        (0..25).map(|point| solver.point(SECOND, point).y).fold(f64::INFINITY, f64::min)
    };
    assert!(hangs(0.5) > -0.0105, "{}", hangs(0.5));
    assert!(hangs(0.0) < -1.0);
}

#[test]
fn the_ground_holds_sticky_cloth() {
    let jump = |stickiness: f64| {
        let bead = moving(beads(vec![Vec3::y() * THICKNESS]), 1.0, Vec3::new(1.0, 2.0, 0.0));
        let mut solver = solver(vec![bead], Vec::new());
        let plane = GroundPlane { stickiness, ..ground(1.0) };
        let input = FrameInput { plane: Some(plane), ..weightless(vec![bead_settings()]) };
        solver.step(&input, &mut ());
        solver.point(FIRST, 0)
    };
    assert!((jump(1.0) - Vec3::y() * THICKNESS).norm() < 1e-9, "{}", jump(1.0));
    assert!((jump(0.0) - Vec3::new(1.0 / 24.0, 2.0 / 24.0 + THICKNESS, 0.0)).norm() < 1e-9);
}

/// The distance that a bead moves in half a second towards a wall 0.1 m away, in metres.
fn past_a_wall(strength: [f64; 2]) -> f64 {
    let wall = cuboid(Vec3::new(0.1, -1.0, -1.0), Vec3::new(0.2, 1.0, 1.0));
    let bead = moving(beads(vec![Vec3::new(0.0, 0.11, 0.07)]), 0.1, Vec3::x());
    let mut solver = solver(vec![bead], vec![wall]);
    let wall = ColliderFrame { collide: true, collide_strength: strength[1], ..ColliderFrame::default() };
    let bead = ClothFrame { collide_strength: strength[0], ..bead_settings() };
    let input = FrameInput { colliders: vec![wall], ..weightless(vec![bead]) };
    (0..12).for_each(|_| {
        solver.step(&input, &mut ());
    });
    solver.point(FIRST, 0).x
}

#[test]
fn a_collision_of_full_strength_stops_and_one_of_none_does_nothing() {
    for strength in [[1.0, 1.0], [2.0, 1.0]] {
        assert!((past_a_wall(strength) - 0.09).abs() < 1e-4, "{}", past_a_wall(strength));
    }
    for strength in [[0.0, 1.0], [1.0, 0.0], [-1.0, 1.0]] {
        assert!((past_a_wall(strength) - 0.5).abs() < 1e-9, "{}", past_a_wall(strength));
    }
}

#[test]
fn partial_collide_strength_lets_cloth_pass_under_a_large_force() {
    let heavy = |strength: f64| {
        let sheet = grid(9, 9, Vec3::x() * 0.4, Vec3::z() * 0.4);
        let held = pins(&sheet, [0, 8, 72, 80]);
        let bead = moving(beads(vec![Vec3::new(0.21, 0.05, 0.18)]), 0.001, Vec3::y() * -1.0);
        let mut solver = solver(vec![Cloth::new(sheet, Mass::PerArea(0.2), LINKS), bead], Vec::new());
        let sheet = ClothFrame { collide_strength: strength, friction: 0.0, ..still() };
        let input = FrameInput { pins: held, ..weightless(vec![sheet, bead_settings()]) };
        (0..12).for_each(|_| {
            solver.step(&input, &mut ());
        });
        solver.point(SECOND, 0).y
    };
    let [none, little, all] = [0.0, 0.01, 1.0].map(heavy);
    assert!((none + 0.45).abs() < 1e-9, "{none}");
    assert!(little < -0.1 && little > none, "it is slowed, and passes: {little}");
    assert!(all > -0.1, "{all}");
}

/// A cube's faces look outward; beads start inside and outside.
fn pushed(share: f64, radius: f64, substeps: u32) -> Vec<Vec3> {
    let cube = cuboid(Vec3::repeat(-0.5), Vec3::repeat(0.5));
    let inside = Vec3::new(0.4, 0.11, 0.07);
    let deep = Vec3::new(0.02, 0.01, 0.0);
    let outside = Vec3::new(0.6, 0.11, 0.07);
    let bead = moving(beads(vec![inside, deep, outside]), 0.1, Vec3::zeros());
    let mut solver = solver(vec![bead], vec![cube]);
    let push_out = PushOut { share, radius };
    let cube = ColliderFrame { push_out, collide: false, thickness: 0.02, ..ColliderFrame::default() };
    let input = FrameInput { substeps, colliders: vec![cube], ..weightless(vec![bead_settings()]) };
    solver.step(&input, &mut ());
    (0..3).map(|point| solver.point(FIRST, point)).collect()
}

#[test]
fn push_out_brings_points_within_its_radius_to_the_side_that_its_sign_says() {
    // To the nearest face, and both thicknesses beyond it; in one substep, or by its share in each.
    let all = pushed(1.0, 0.2, 1);
    assert!((all[0] - Vec3::new(0.53, 0.11, 0.07)).norm() < 1e-9, "{}", all[0]);
    assert_eq!(all[1], Vec3::new(0.02, 0.01, 0.0), "it is too deep");
    assert_eq!(all[2], Vec3::new(0.6, 0.11, 0.07), "it is clear");
    let half = pushed(0.5, 0.2, 2);
    assert!((half[0].x - (0.53 - 0.13 * 0.25)).abs() < 1e-9, "{}", half[0]);
    let inward = pushed(-1.0, 0.2, 1);
    assert_eq!(inward[0], Vec3::new(0.4, 0.11, 0.07), "it is clear of the inner side");
    assert!((inward[2].x - 0.47).abs() < 1e-9, "{}", inward[2]);
}

#[test]
fn push_out_by_a_small_share_passes_a_surface_that_holds_points_on_its_far_side() {
    let mut floor = grid(3, 3, Vec3::x() * 2.0, Vec3::z() * 2.0);
    floor.positions.iter_mut().for_each(|place| *place -= Vec3::new(1.0, 0.0, 1.0));
    let bead = moving(beads(vec![Vec3::new(0.11, -0.05, 0.07)]), 0.1, Vec3::zeros());
    let mut solver = solver(vec![bead], vec![floor]);
    let push_out = PushOut { share: 0.1, radius: 0.1 };
    let floor = ColliderFrame { push_out, thickness: 0.004, ..ColliderFrame::default() };
    let thickness = floor.thickness + bead_settings().thickness;
    let input = FrameInput { substeps: 3, colliders: vec![floor], ..weightless(vec![bead_settings()]) };
    for _ in 0..48 {
        solver.step(&input, &mut ());
    }
    let height = solver.point(FIRST, 0).y;
    assert!((height - thickness).abs() < 0.1 * thickness, "{height}, not {thickness}");
}

/// The speed of the centre of a sheet in m/s after a ball has pushed it out. It starts `aside` from its place over the ball, in
/// metres along X and Z.
fn speed_after_push_out(share: f64, aside: [f64; 2]) -> f64 {
    let mut sheet = grid(9, 9, Vec3::x() * 0.4, Vec3::z() * 0.4);
    sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(aside[0] - 0.2, 0.3, aside[1] - 0.2));
    let cloth = Cloth::new(sheet, Mass::PerArea(0.2), LINKS);
    let mut solver = solver(vec![cloth], vec![crate::scenes::sphere(0.5, Vec3::zeros())]);
    let push_out = PushOut { share, radius: 1.0 };
    let ball = ColliderFrame { collide: true, push_out, thickness: THICKNESS, ..ColliderFrame::default() };
    let sheet = ClothFrame { thickness: THICKNESS, ..still() };
    let input = FrameInput { colliders: vec![ball], ..weightless(vec![sheet]) };
    (0..12).for_each(|_| _ = solver.step(&input, &mut ()));
    assert!((0..81).all(|point| solver.point(FIRST, point).norm() > 0.45), "it is outside");
    let mut velocities = Vec::new();
    solver.velocities(FIRST, 1.0, &mut velocities);
    (velocities.iter().map(|v| Vec3::from(v.map(f64::from))).sum::<Vec3>() / 81.0).norm()
}

#[test]
fn a_sheet_that_is_pushed_out_of_a_ball_is_not_thrown() {
    // A share of 1 pushes it out before its links pull. Of a share of 0.3 they stretch by up to 73 % meanwhile, and what they
    // spring back with depends on the start by chance: over twelve starts 1.2 to 3.1 m/s, 1.9 in the mean, where a share of 1
    // gives 0.03 to 0.08. A push that keeps its velocity gives 10 and 24 m/s.
    for (share, most) in [(0.3, 3.0), (1.0, 0.3)] {
        let starts = (0..4).map(|k| [0.003, -0.002].map(|step| step * f64::from(k)));
        let mean = starts.map(|aside| speed_after_push_out(share, aside)).sum::<f64>() / 4.0;
        assert!(mean < most, "{share}: {mean} m/s");
    }
}

#[test]
fn cloth_pushes_points_of_other_cloth_out_and_none_of_its_own() {
    let sheet = grid(9, 9, Vec3::x(), Vec3::z());
    let bead = moving(beads(vec![Vec3::new(0.51, -0.03, 0.52)]), 0.1, Vec3::zeros());
    let before = sheet.positions.clone();
    let mut solver = solver(vec![Cloth::new(sheet, Mass::PerArea(0.2), LINKS), bead], Vec::new());
    let push_out = PushOut { share: 1.0, radius: 0.1 };
    let sheet = ClothFrame { push_out, collide: false, ..still() };
    let input = weightless(vec![sheet, bead_settings()]);
    solver.step(&input, &mut ());
    assert!((solver.point(SECOND, 0).y - THICKNESS).abs() < 1e-9, "{}", solver.point(SECOND, 0));
    assert!((0..81).all(|point| solver.point(FIRST, point) == before[point]));
}

#[test]
fn points_stay_inside_a_collider_without_trapped_check() {
    let stays = |trapped_check: bool| {
        let cube = cuboid(Vec3::repeat(-0.5), Vec3::repeat(0.5));
        let bead = moving(beads(vec![Vec3::new(0.1, 0.03, 0.02)]), 0.1, Vec3::x() * 2.0);
        let mut solver = solver(vec![bead], vec![cube]);
        let cube = ColliderFrame { collide: true, trapped_check, ..ColliderFrame::default() };
        let input = FrameInput { colliders: vec![cube], ..weightless(vec![bead_settings()]) };
        (0..24).for_each(|_| {
            solver.step(&input, &mut ());
        });
        solver.point(FIRST, 0).amax()
    };
    assert!(stays(false) < 0.5, "{}", stays(false));
    assert!(stays(true) > 0.5, "{}", stays(true));
}

// EVIDENCE: N2.3-2  contact is at the thickness, point by point
#[test]
fn the_thickness_of_each_point_counts() {
    let sheet = grid(9, 9, Vec3::x(), Vec3::z());
    let factor = |p: &Vec3| if p.x < 0.5 { 0.5 } else { 2.0 };
    let thickness: Vec<f64> = sheet.positions.iter().map(factor).collect();
    let mut lifted = sheet.clone();
    lifted.positions.iter_mut().for_each(|p| p.y += 0.1);
    let factors = VertexMaps { thickness: thickness.clone(), ..VertexMaps::default() };
    let cloth = Cloth { vertex_maps: factors, ..Cloth::new(lifted, Mass::PerArea(0.2), ClothLists::NONE) };
    let floor = cuboid(Vec3::new(-1.0, -0.5, -1.0), Vec3::new(2.0, 0.0, 2.0));
    let settings = ClothFrame { thickness: THICKNESS, self_collision: SelfCollision::OFF, ..still() };
    let on_a_box = {
        let mut solver = solver(vec![cloth.clone()], vec![floor]);
        let floor = ColliderFrame { collide: true, thickness: 0.003, ..ColliderFrame::default() };
        let input = FrameInput { cloths: vec![settings], colliders: vec![floor], ..frame(3, physical(96.0)) };
        (0..48).for_each(|_| {
            solver.step(&input, &mut ());
        });
        solver
    };
    let on_the_plane = {
        let mut solver = solver(vec![cloth], Vec::new());
        let input =
            FrameInput { cloths: vec![settings], plane: Some(ground(0.1)), ..frame(3, physical(96.0)) };
        (0..48).for_each(|_| {
            solver.step(&input, &mut ());
        });
        solver
    };
    for (point, factor) in thickness.iter().enumerate() {
        let expected = THICKNESS * factor;
        let heights = [on_a_box.point(FIRST, point).y - 0.003, on_the_plane.point(FIRST, point).y];
        assert!(
            heights.iter().all(|y| (y - expected).abs() < 1e-5),
            "point {point}: {heights:?}, {expected}"
        );
    }
}

#[test]
fn cloth_on_cloth_rests_at_the_thickness_of_the_points_that_touch() {
    let table = grid(2, 2, Vec3::z() * 2.0, Vec3::x() * 2.0);
    let held = pins(&table, 0..4);
    let beads = beads(vec![Vec3::new(0.5, 0.1, 0.6), Vec3::new(1.5, 0.1, 1.4)]);
    let factors = VertexMaps { thickness: vec![0.5, 3.0], ..VertexMaps::default() };
    let beads = Cloth { vertex_maps: factors, ..Cloth::new(beads, Mass::PerPoint(0.1), ClothLists::NONE) };
    let mut solver = solver(vec![Cloth::new(table, Mass::PerPoint(1.0), LINKS), beads], Vec::new());
    let table = ClothFrame { thickness: 0.002, ..still() };
    let input = FrameInput { cloths: vec![table, bead_settings()], pins: held, ..frame(3, physical(96.0)) };
    (0..24).for_each(|_| {
        solver.step(&input, &mut ());
    });
    for (bead, factor) in [0.5, 3.0].into_iter().enumerate() {
        let height = solver.point(SECOND, bead).y;
        assert!((height - 0.002 - factor * THICKNESS).abs() < 1e-5, "{height} of {factor}");
    }
}

/// Two beads that differ in a map, and where they are after some frames at a box that reaches up to 0 and down to -0.2.
fn two_at_a_box(factors: VertexMaps, settings: ClothFrame, start: [f64; 2], gravity: f64) -> [f64; 2] {
    let slab = cuboid(Vec3::new(-1.0, -0.2, -1.0), Vec3::new(1.0, 0.0, 1.0));
    let [y, speed] = start;
    let positions = vec![Vec3::new(-0.31, y, 0.11), Vec3::new(0.33, y, 0.17)];
    let cloth = Cloth { vertex_maps: factors, ..moving(beads(positions), 0.1, Vec3::y() * speed) };
    let mut solver = solver(vec![cloth], vec![slab]);
    let slab = ColliderFrame { collide: true, ..ColliderFrame::default() };
    let input = FrameInput {
        gravity: Vec3::y() * gravity,
        cloths: vec![settings],
        colliders: vec![slab],
        ..frame(3, physical(96.0))
    };
    (0..12).for_each(|_| {
        solver.step(&input, &mut ());
    });
    [0, 1].map(|point| solver.point(FIRST, point).y)
}

#[test]
fn stickiness_bounce_and_collide_strength_of_each_point_count() {
    let map = || vec![0.0, 1.0];
    let sticky = ClothFrame { stickiness: 1.0, ..bead_settings() };
    let factors = VertexMaps { stickiness: map(), ..VertexMaps::default() };
    let [falls, hangs] = two_at_a_box(factors, sticky, [-0.2 - THICKNESS, 0.0], -9.81);
    assert!(falls < -1.0 && (hangs + 0.2 + THICKNESS).abs() < 1e-4, "{falls} and {hangs}");

    let elastic = ClothFrame { bounce: 1.0, ..bead_settings() };
    let factors = VertexMaps { bounce: map(), ..VertexMaps::default() };
    let [stays, returns] = two_at_a_box(factors, elastic, [0.25, -1.0], 0.0);
    // Down for 0.24 s, up for the rest of the half second.
    assert!((stays - THICKNESS).abs() < 1e-4, "{stays}");
    assert!((returns - THICKNESS - 0.26).abs() < 0.01, "{returns}");

    let factors = VertexMaps { collide_strength: map(), ..VertexMaps::default() };
    let [passes, stops] = two_at_a_box(factors, bead_settings(), [0.25, -1.0], 0.0);
    assert!((passes + 0.25).abs() < 1e-6 && (stops - THICKNESS).abs() < 1e-4, "{passes} and {stops}");
}

#[test]
fn a_point_in_depenetration_from_a_plane_falls_freely_once_the_plane_is_gone() {
    // A tenth of its thickness above the plane: at 1 m/s depenetration takes longer than a frame.
    let bead = moving(beads(vec![Vec3::y() * 0.1]), 1.0, Vec3::zeros());
    let mut solver = solver(vec![bead], Vec::new());
    let cloths = vec![ClothFrame { thickness: 1.0, ..bead_settings() }];
    let with_plane = FrameInput { plane: Some(ground(0.0)), cloths, ..frame(1, physical(48.0)) };
    let without = FrameInput { plane: None, ..with_plane.clone() };
    let mut speed = |input: &FrameInput| {
        solver.step(input, &mut ());
        let mut velocities = Vec::new();
        solver.velocities(FIRST, 1.0, &mut velocities);
        f64::from(velocities[0][1])
    };
    let led = speed(&with_plane);
    assert!((led - 1.0).abs() < 1e-5, "depenetrated at {led} m/s");
    let fallen = speed(&without);
    let free = without.gravity.y * without.duration;
    assert!((fallen / free - 1.0).abs() < 1e-5, "{fallen} m/s, free fall is {free} m/s");
}

/// Whether a sheet of one face rests on a box, narrower or wider than it, half a second after it began to fall from 5 cm
/// above; else it must have fallen through.
fn rests_on_a_box(is_narrow: bool, cloth: ClothFrame, collider: ColliderFrame) -> bool {
    let mut sheet = grid(2, 2, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.5, 0.05, -0.5));
    let half = if is_narrow { 0.2 } else { 0.8 };
    let corner = Vec3::new(half, 0.0, half);
    let thin = Cloth::new(sheet, Mass::PerArea(0.2), ClothLists { shear: true, ..LINKS });
    let mut solver = solver(vec![thin], vec![cuboid(-corner - Vec3::y() * 0.3, corner)]);
    let cloths =
        vec![ClothFrame { thickness: THICKNESS, shear_resistance: 20.0, bend_resistance: 20.0, ..cloth }];
    let input = FrameInput { cloths, colliders: vec![collider], ..frame(3, physical(96.0)) };
    (0..12).for_each(|_| {
        solver.step(&input, &mut ());
    });
    let height = (0..4).map(|k| solver.point(FIRST, k).y).sum::<f64>() / 4.0;
    let rests = height > 0.5 * THICKNESS;
    assert!(rests || height < -0.5, "neither on the box nor through it: {height}");
    rests
}

// EVIDENCE: N2.3-3  points, edges and faces collide as the flags of both sides say
#[test]
fn cloth_and_collider_touch_with_the_elements_that_their_flags_name() {
    use Elements::{Edges, Faces, Points};
    // Corners and edges of a narrow box meet edges and the face of the sheet; points of the sheet meet faces of a wide one.
    for (is_narrow, cloth, collider, rests) in [
        (true, Faces, Faces, true),
        (true, Faces, Points, true),
        (true, Faces, Edges, true),
        (true, Points, Faces, false),
        (false, Points, Faces, true),
        (false, Faces, Points, false),
    ] {
        let own = ClothFrame { elements: cloth, ..still() };
        let theirs = ColliderFrame { collide: true, elements: collider, ..ColliderFrame::default() };
        let found = rests_on_a_box(is_narrow, own, theirs);
        assert_eq!(found, rests, "narrow: {is_narrow}, {cloth:?} on {collider:?}");
    }
}

#[test]
fn a_collider_holds_cloth_of_its_layer_and_of_higher_ones_within_the_range() {
    for (cloth, collider, rests) in
        [(0.0, 0.0, true), (1.5, 1.5, true), (3.0, 0.0, true), (4.0, 0.0, false), (0.0, 1.0, false)]
    {
        let theirs = ColliderFrame { collide: true, layer: collider, ..ColliderFrame::default() };
        let found = rests_on_a_box(false, ClothFrame { layer: cloth, ..still() }, theirs);
        assert_eq!(found, rests, "layer {cloth} on {collider}");
    }
}
