//! Contact with colliders and the ground: no penetration, rest at the thickness, friction, restitution.

use crate::scenes::{
    INSCRIBED, LINKS, Vec3, cuboid, drape, frame, grid, ground, one_cloth, physical, pins, sphere, still,
};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, ContactState, Faces, FrameInput,
    GroundPlane, Mass, ModelBuilder, Pin, PointId, ResistanceModel, Solver, Start, StateView, StepObserver,
    SubstepIndex, Surface,
};

const CLOTH: ClothId = ClothId(0);

// EVIDENCE: N2.3-2  contact is at the thickness
#[test]
fn cloth_rests_on_the_ground_at_its_thickness_without_sinking_or_jitter() {
    for resistance in [ResistanceModel::Classic, physical(96.0)] {
        let mut sheet = grid(9, 9, Vec3::x(), Vec3::z());
        sheet.positions.iter_mut().for_each(|p| p.y = 0.3);
        let mut solver = Solver::<f32>::new(one_cloth(sheet, LINKS), 1);
        let cloths = vec![ClothFrame { thickness: 0.21803, ..still() }];
        let input = FrameInput { plane: Some(ground(0.1)), cloths, ..frame(3, resistance) };
        for step in 0..67 {
            solver.step(&input, &mut ());
            if step > 12 {
                let lowest = (0..81).map(|k| solver.point(CLOTH, k).y).fold(f64::INFINITY, f64::min);
                assert!((lowest - 0.21803).abs() < 1e-5, "{resistance:?}, frame {step}: {lowest}");
            }
        }
    }
}

// EVIDENCE: N2.3-2  cloth and collider both have a thickness
#[test]
fn cloth_rests_on_a_mesh_at_the_sum_of_the_thicknesses() {
    for resistance in [ResistanceModel::Classic, physical(96.0)] {
        let mut sheet = grid(9, 9, Vec3::x() * 0.5, Vec3::z() * 0.5);
        sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.25, 0.05, -0.25));
        let mut builder = one_cloth(sheet, LINKS);
        let mut table = grid(4, 4, Vec3::x() * 2.0, Vec3::z() * 2.0);
        table.positions.iter_mut().for_each(|p| *p -= Vec3::new(1.0, 0.0, 1.0));
        builder.collider(Collider { surface: table }).expect("a good mesh");
        let colliders =
            vec![ColliderFrame { collide: true, thickness: 0.01, friction: 0.1, ..Default::default() }];
        let cloths = vec![ClothFrame { thickness: 0.02, ..still() }];
        let input = FrameInput { cloths, colliders, ..frame(3, resistance) };
        let mut solver = Solver::<f32>::new(builder, 1);
        for step in 0..48 {
            solver.step(&input, &mut ());
            if step > 12 {
                let heights = (0..81).map(|k| solver.point(CLOTH, k).y);
                assert!(
                    heights.clone().all(|y| (y - 0.03).abs() < 1e-5),
                    "{:?}",
                    heights.collect::<Vec<_>>()
                );
            }
        }
    }
}

#[test]
fn contact_states_are_touching_over_a_table_and_free_beyond_its_edge() {
    let mut sheet = grid(9, 9, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(0.0, 0.031, -0.5));
    let mut builder = one_cloth(sheet.clone(), LINKS);
    let mut table = grid(4, 4, Vec3::x() * 2.0, Vec3::z() * 2.0);
    table.positions.iter_mut().for_each(|p| *p -= Vec3::new(1.49, 0.0, 1.0));
    builder.collider(Collider { surface: table }).expect("a good mesh");
    let colliders =
        vec![ColliderFrame { collide: true, thickness: 0.01, friction: 0.9, ..Default::default() }];
    let cloths = vec![ClothFrame { thickness: 0.02, ..still() }];
    let input = FrameInput { cloths, colliders, ..frame(3, physical(96.0)) };
    let mut solver = Solver::<f32>::new(builder, 1);
    let mut contacts = Vec::new();
    solver.contacts(&mut contacts);
    assert!(
        contacts[CLOTH.index()].iter().all(|&contact| contact == ContactState::Free),
        "before the first frame"
    );
    for _ in 0..6 {
        solver.step(&input, &mut ());
    }
    solver.contacts(&mut contacts);
    for (point, &contact) in sheet.positions.iter().zip(&contacts[CLOTH.index()]) {
        if (point.x - 0.5).abs() > 0.2 {
            let expected = if point.x < 0.5 { ContactState::Touching } else { ContactState::Free };
            assert_eq!(contact, expected, "{point}");
        }
    }
}

/// Watches a ball of radius 0.15 m that flies along z, and counts points on its wrong side. No point of the sheet may be
/// inside it. When its centre has just passed the sheet's plane, points that were in its path must be in front of it.
/// (Later the sheet wraps round the ball, and its rim may trail behind.)
struct Wrong {
    from: f64,
    speed: f64,
    steps: u32,
    points: usize,
    wrong: usize,
    passed_plane: bool,
}

impl StepObserver for Wrong {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        self.steps += 1;
        let time = f64::from(self.steps) / f64::from(moment.substeps) / 24.0;
        let centre = Vec3::new(0.5, -0.5, self.from + self.speed * time);
        let passes = centre.z > 0.0 && !std::mem::replace(&mut self.passed_plane, centre.z > 0.0);
        let columns = (self.points as f64).sqrt() as usize;
        for k in 0..self.points {
            let at_rest =
                Vec3::new((k % columns) as f64, -((k / columns) as f64), 0.0) / (columns - 1) as f64;
            let away = state.point(CLOTH, k) - centre;
            let in_its_way = (at_rest - centre).xy().norm() < 0.1;
            self.wrong +=
                usize::from(away.norm() < 0.15 * INSCRIBED || (passes && in_its_way && away.z < 0.0));
        }
    }
}

// EVIDENCE: N2.4-8  even one substep sees the motion of the collider's points
// EVIDENCE: N2.3-4  a collision is the meeting of thickened elements in space and time
#[test]
fn a_fast_ball_never_gets_through_a_hanging_sheet() {
    let settings = [ResistanceModel::Classic, physical(10.0), physical(96.0)];
    let speed = 10.0;
    for resistance in settings {
        for substeps in [1, 3] {
            let sheet = grid(33, 33, Vec3::x(), -Vec3::y());
            let held = pins(&sheet, [0, 32]);
            let mut builder = one_cloth(sheet, LINKS);
            let from = -0.25;
            let ball = sphere(0.15, Vec3::new(0.5, -0.5, from));
            builder.collider(Collider { surface: ball.clone() }).expect("a good mesh");
            let mut solver = Solver::<f32>::new(builder, 1);
            let mut watch = Wrong { from, speed, steps: 0, points: 33 * 33, wrong: 0, passed_plane: false };
            // It reaches the sheet in the first frame; after the fourth it has pulled it out by 1.4 m.
            for step in 0..4 {
                let at = |frame: f64| {
                    ball.positions.iter().map(|p| p + Vec3::z() * (speed * frame / 24.0)).collect()
                };
                let start: Vec<Vec3> = at(f64::from(step));
                let end = at(f64::from(step + 1));
                let moving = ColliderFrame {
                    start,
                    end,
                    collide: true,
                    thickness: 0.002,
                    friction: 0.3,
                    ..ColliderFrame::default()
                };
                let cloths = vec![ClothFrame { thickness: 0.003, ..still() }];
                let input = FrameInput {
                    colliders: vec![moving],
                    cloths,
                    pins: held.clone(),
                    ..frame(substeps, resistance)
                };
                let report = solver.step(&input, &mut watch);
                assert!(report.finite);
                assert_eq!(
                    watch.wrong, 0,
                    "{speed} m/s, {resistance:?}, {substeps} substeps, frame {step}: {report:?}"
                );
            }
            assert!(watch.passed_plane);
        }
    }
}

// EVIDENCE: N2.3-4  a collision is the meeting of thickened elements in space and time
#[test]
fn cloth_that_is_stretched_a_thousandfold_still_holds_a_box() {
    // Four small faces are pulled to metres; then a box much smaller than any of them goes down on one.
    let sheet = grid(3, 3, Vec3::x() * 0.01, Vec3::z() * 0.01);
    let held = pins(&sheet, 0..9);
    let mut builder = one_cloth(sheet, LINKS);
    let block = cuboid(Vec3::new(1.9, 0.3, 1.9), Vec3::new(2.1, 0.5, 2.1));
    builder.collider(Collider { surface: block.clone() }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let wide = |pin: &Pin, by: f64| Vec3::new(pin.start.x * by, 0.0, pin.start.z * by);
    for step in 0..24 {
        let [drop, further] = [step, step + 1].map(|k| 0.05 * f64::from(k));
        let lowered = |by: f64| block.positions.iter().map(|p| p - Vec3::y() * by).collect::<Vec<_>>();
        let block = ColliderFrame {
            start: lowered(drop),
            end: lowered(further),
            collide: true,
            ..Default::default()
        };
        // All points are pinned in the first frame; then the inner corner of the face under the box is free.
        let pins = held.iter().map(|pin| {
            let [start, end] = if step == 0 { [1.0, 1000.0] } else { [1000.0; 2] }.map(|by| wide(pin, by));
            Pin { start, end, ..*pin }
        });
        let pins = pins.filter(|pin| step == 0 || pin.point != PointId(4)).collect();
        let cloths = vec![ClothFrame { thickness: 0.003, stretch_resistance: 0.01, ..still() }];
        let input = FrameInput {
            gravity: Vec3::zeros(),
            colliders: vec![block],
            cloths,
            pins,
            ..frame(3, physical(24.0))
        };
        let report = solver.step(&input, &mut ());
        assert!(report.finite && report.pairs_unresolved == 0, "frame {step}: {report:?}");
    }
    // The box has pushed the corner below the sheet.
    let middle = solver.point(CLOTH, 4);
    assert!(middle.y < -0.9, "{middle}");
}

/// A thin post that rises below a sheet of four large faces, off their points and edges. Returns the mean height of the
/// sheet above the height at which it starts, once the post has risen by 0.4 m, and the number of unresolved pairs.
fn lifted_by(post: Surface, place: impl Fn(&Vec3) -> Vec3) -> (f64, u64) {
    let sheet = grid(3, 3, Vec3::x(), Vec3::z());
    let mut builder = one_cloth(sheet, LINKS);
    builder.collider(Collider { surface: post.clone() }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let mut unresolved = 0;
    for step in 0..8 {
        let [start, end] = [step, step + 1].map(|k| {
            let risen = Vec3::y() * (0.05 * f64::from(k));
            post.positions.iter().map(|p| place(p) + risen).collect::<Vec<_>>()
        });
        let post = ColliderFrame { start, end, collide: true, ..ColliderFrame::default() };
        let cloths = vec![ClothFrame { thickness: 0.003, ..still() }];
        let gravity = Vec3::zeros();
        let input = FrameInput { gravity, colliders: vec![post], cloths, ..frame(3, physical(96.0)) };
        unresolved += solver.step(&input, &mut ()).pairs_unresolved;
    }
    ((0..9).map(|point| solver.point(CLOTH, point).y).sum::<f64>() / 9.0, unresolved)
}

// EVIDENCE: N2.3-4  corners of a collider do not pass faces of cloth
#[test]
fn a_closed_collider_lifts_cloth_whichever_way_its_faces_point() {
    let post = cuboid(Vec3::new(0.3, -0.6, 0.35), Vec3::new(0.34, -0.01, 0.39));
    let mut turned = Surface { positions: post.positions.clone(), ..Surface::default() };
    post.faces.iter().for_each(|face| turned.faces.push(&face.iter().rev().copied().collect::<Vec<_>>()));
    let as_is = |p: &Vec3| *p;
    let mirrored = |p: &Vec3| Vec3::new(0.64 - p.x, p.y, p.z);
    let heights = [lifted_by(post.clone(), as_is), lifted_by(turned, as_is), lifted_by(post, mirrored)];
    for (height, unresolved) in heights {
        assert!(height > 0.1 && unresolved == 0, "{heights:?}");
    }
}

// EVIDENCE: N2.3-4  corners of a collider do not pass faces of cloth
#[test]
fn cloth_inside_a_container_is_held_by_corners_that_point_inwards() {
    // A box with a ceiling whose centre hangs down to just above the sheet. The box moves down by 0.4 m.
    let mut room = cuboid(Vec3::new(-1.0, -1.0, -1.0), Vec3::new(2.0, 1.5, 2.0));
    let mut faces = Faces::default();
    room.faces.iter().filter(|face| *face != [2, 6, 7, 3]).for_each(|face| faces.push(face));
    [[2, 6, 8], [6, 7, 8], [7, 3, 8], [3, 2, 8]].iter().for_each(|face| faces.push(face));
    room.positions.push(Vec3::new(0.3, 0.01, 0.35));
    room.faces = faces;
    let sheet = grid(3, 3, Vec3::x(), Vec3::z());
    let mut builder = one_cloth(sheet, LINKS);
    builder.collider(Collider { surface: room.clone() }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    for step in 0..8 {
        let [start, end] = [step, step + 1].map(|k| {
            let lowered = Vec3::y() * (0.05 * f64::from(k));
            room.positions.iter().map(|p| p - lowered).collect::<Vec<_>>()
        });
        let room = ColliderFrame { start, end, collide: true, trapped_check: false, ..Default::default() };
        let cloths = vec![ClothFrame { thickness: 0.003, ..still() }];
        let gravity = Vec3::zeros();
        let input = FrameInput { gravity, colliders: vec![room], cloths, ..frame(3, physical(96.0)) };
        assert_eq!(solver.step(&input, &mut ()).pairs_unresolved, 0);
    }
    let height = (0..9).map(|point| solver.point(CLOTH, point).y).sum::<f64>() / 9.0;
    assert!(height < -0.1, "{height}");
}

// EVIDENCE: N2.3-4  corners of a collider do not pass faces of cloth
#[test]
fn a_corner_that_was_on_the_far_side_of_a_post_is_not_forgotten() {
    // A large triangle leans against the right edge of a post's top and tilts to the left within one substep. Seen from the
    // left corners it starts on the far side of the post.
    let post = cuboid(Vec3::new(-0.1, -2.0, -0.05), Vec3::new(0.1, 0.5, 0.05));
    let height = |x: f64, [slope, middle]: [f64; 2]| middle + slope * x;
    let lines = [[-2.5, 0.77], [0.6, 0.5]];
    let places = [[0.6, -0.6], [0.6, 0.6], [-0.6, 0.0]];
    let at = |line: [f64; 2]| places.map(|[x, z]| Vec3::new(x, height(x, line), z)).to_vec();
    let mut triangle = Surface { positions: at(lines[0]), ..Surface::default() };
    triangle.faces.push(&[0, 1, 2]);
    let velocities = at(lines[1]).iter().zip(at(lines[0])).map(|(to, from)| (to - from) * 24.0).collect();
    let start = Start { velocities, ..Start::default() };
    let cloth = Cloth { start, ..Cloth::new(triangle, Mass::PerPoint(0.01), ClothLists::NONE) };
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth).expect("a good mesh");
    builder.collider(Collider { surface: post }).expect("a good mesh");
    let mut solver = Solver::<f64>::new(builder, 1);
    let colliders = vec![ColliderFrame { collide: true, ..ColliderFrame::default() }];
    let cloths = vec![ClothFrame { thickness: 0.003, ..still() }];
    let input = FrameInput {
        gravity: Vec3::zeros(),
        air_density: 0.0,
        colliders,
        cloths,
        ..frame(1, physical(96.0))
    };
    let report = solver.step(&input, &mut ());
    let [a, b, c] = [0, 1, 2].map(|point| solver.point(CLOTH, point));
    let normal = (b - a).cross(&(c - a));
    let above = |x: f64, z: f64| {
        let corner = Vec3::new(x, 0.5, z);
        a.y - corner.y - (normal.x * (corner.x - a.x) + normal.z * (corner.z - a.z)) / normal.y
    };
    let heights = [above(-0.1, -0.05), above(-0.1, 0.05), above(0.1, -0.05), above(0.1, 0.05)];
    assert!(heights.iter().all(|&height| height > 0.0), "{heights:?}");
    assert_eq!(report.pairs_unresolved, 0);
}

// EVIDENCE: N2.2-4  the last pass of a step is collision: nothing is left inside
#[test]
fn a_sheet_draped_on_a_sphere_is_almost_unstretched_and_not_inside() {
    let (builder, input) = drape(41, 384.0);
    let mut solver = Solver::<f32>::new(builder, 2);
    let mut last = None;
    for _ in 0..60 {
        last = Some(solver.step(&input, &mut ()));
    }
    let report = last.expect("sixty frames");
    assert!(report.strain_99 < 0.01, "{report:?}");
    assert!(report.pairs_unresolved == 0 && report.pairs_reverted == 0, "{report:?}");
    // A constraint sweep after the last contact pass would press it in.
    assert!(report.min_gap > 0.999, "{report:?}");
    assert!((0..1681).all(|k| solver.point(CLOTH, k).norm() > 0.31 * INSCRIBED), "a point is inside");
    println!("draped at 384 evaluations: {report:?}");
}

// EVIDENCE: N2.2-5  each evaluation has a collision pass, and more of them leave less stretch
#[test]
fn more_evaluations_leave_less_stretch_on_a_sphere() {
    let strain = [24.0, 96.0].map(|evaluations| {
        let (builder, input) = drape(33, evaluations);
        let mut solver = Solver::<f32>::new(builder, 1);
        (0..48).map(|_| solver.step(&input, &mut ()).strain_99).last().expect("frames")
    });
    assert!(strain[1] < 0.6 * strain[0], "{strain:?}");
}

#[test]
fn friction_holds_on_a_slope_up_to_its_angle_and_not_beyond() {
    // mu = 0.5 holds up to atan 0.5 = 26.57 degrees.
    let slid = |degrees: f64| {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let mut patch: Surface = grid(5, 5, Vec3::x() * 0.2, Vec3::z() * 0.2);
        patch.positions.iter_mut().for_each(|p| p.y = 0.0101);
        let mut builder = one_cloth(patch, LINKS);
        let mut slope = grid(2, 2, Vec3::x() * 40.0, Vec3::z() * 4.0);
        slope.positions.iter_mut().for_each(|p| *p -= Vec3::new(20.0, 0.0, 2.0));
        builder.collider(Collider { surface: slope }).expect("a good mesh");
        // Gravity is tilted instead of the slope.
        let gravity = Vec3::new(9.81 * sin, -9.81 * cos, 0.0);
        let colliders = vec![ColliderFrame { collide: true, friction: 0.25, ..Default::default() }];
        let cloths = vec![ClothFrame { thickness: 0.01, friction: 0.25, ..still() }];
        let input = FrameInput { gravity, colliders, cloths, ..frame(3, physical(96.0)) };
        let mut solver = Solver::<f32>::new(builder, 1);
        (0..24).for_each(|_| {
            solver.step(&input, &mut ());
        });
        solver.point(CLOTH, 12).x - 0.1
    };
    assert!(slid(26.3).abs() < 1e-3, "held: {}", slid(26.3));
    let steep = f64::to_radians(35.0);
    let exact = 9.81 / 2.0 * (steep.sin() - 0.5 * steep.cos());
    assert!((slid(35.0) / exact - 1.0).abs() < 0.02, "slid {} for {exact}", slid(35.0));
}

#[test]
fn a_bounce_rises_to_the_square_of_the_restitution() {
    for on_mesh in [false, true] {
        let mut patch = grid(3, 3, Vec3::x() * 0.2, Vec3::z() * 0.2);
        patch.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.1, 1.01, -0.1));
        let mut builder = one_cloth(patch, LINKS);
        let mut input = FrameInput { plane: Some(ground(0.0)), ..frame(3, physical(384.0)) };
        input.cloths = vec![ClothFrame { thickness: 0.01, bounce: 0.7, ..still() }];
        if on_mesh {
            let mut table = grid(2, 2, Vec3::x() * 2.0, Vec3::z() * 2.0);
            table.positions.iter_mut().for_each(|p| *p -= Vec3::new(1.0, 0.0, 1.0));
            builder.collider(Collider { surface: table }).expect("a good mesh");
            input.colliders = vec![ColliderFrame { collide: true, ..Default::default() }];
            input.plane = None;
        }
        let mut solver = Solver::<f32>::new(builder, 1);
        // Released 1 m above the thickness, it falls again after the second half of a second.
        let fall = (2.0f64 / 9.81).sqrt();
        let frames = (24.0 * fall * (1.0 + 2.0 * 0.7)) as usize;
        let heights: Vec<f64> = (0..frames)
            .map(|_| {
                solver.step(&input, &mut ());
                solver.point(CLOTH, 4).y - 0.01
            })
            .collect();
        let apex = heights[(24.0 * fall) as usize + 1..].iter().copied().fold(0.0, f64::max);
        // A frame may miss the very top by 2 mm.
        assert!((apex - 0.49).abs() < 0.006, "on a mesh: {on_mesh}: {apex}");
    }
}

#[test]
fn cloth_that_starts_too_close_separates_without_a_jump() {
    let mut sheet = grid(9, 9, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| p.y = 0.002);
    let mut solver = Solver::<f32>::new(one_cloth(sheet, LINKS), 1);
    let cloths = vec![ClothFrame { thickness: 0.05, ..still() }];
    let input = FrameInput { plane: Some(ground(0.1)), cloths, ..frame(3, physical(96.0)) };
    let highest = (0..24).map(|_| {
        solver.step(&input, &mut ());
        solver.point(CLOTH, 40).y
    });
    assert!(highest.fold(0.0, f64::max) < 0.0501);
    assert!((solver.point(CLOTH, 40).y - 0.05).abs() < 1e-5);
}

// EVIDENCE: N2.4-14  a substep fits the bounding volumes once, and searches with them
#[test]
fn cloth_that_a_table_lifts_is_searched_once_in_each_substep() {
    for substeps in [1, 2, 3, 5, 8] {
        let mut sheet = grid(9, 9, Vec3::x() * 0.5, Vec3::z() * 0.5);
        sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.25, 0.03, -0.25));
        let mut builder = one_cloth(sheet, LINKS);
        let mut table = grid(4, 4, Vec3::x() * 2.0, Vec3::z() * 2.0);
        table.positions.iter_mut().for_each(|p| *p -= Vec3::new(1.0, 0.0, 1.0));
        builder.collider(Collider { surface: table.clone() }).expect("a good mesh");
        let mut solver = Solver::<f32>::new(builder, 1);
        for step in 0..4 {
            let [start, end] = [step, step + 1].map(|frames| {
                let lift = Vec3::y() * (0.01 * f64::from(frames));
                table.positions.iter().map(|place| place + lift).collect()
            });
            let thickness = 0.01;
            let lifted = ColliderFrame { start, end, collide: true, thickness, ..ColliderFrame::default() };
            let cloths = vec![ClothFrame { thickness: 0.02, ..still() }];
            let input = FrameInput { cloths, colliders: vec![lifted], ..frame(substeps, physical(96.0)) };
            let report = solver.step(&input, &mut ());
            // The table starts with a jump in speed, and leaves some points' motion bounds.
            if step > 0 {
                assert_eq!(report.broad_phases, substeps, "{substeps} substeps, frame {step}");
            }
        }
    }
}

#[test]
fn a_cloth_that_does_not_collide_has_no_collider_contact_pass() {
    let (builder, mut input) = drape(9, 24.0);
    input.cloths[0].collide = false;
    let mut solver = Solver::<f32>::new(builder, 1);
    assert!(solver.passes(&input).iter().all(|pass| pass.name != "collider contact"));
    assert_eq!(solver.step(&input, &mut ()).broad_phases, 0);
    let lists = ClothLists { bend: false, ..LINKS };
    let bare = Solver::<f32>::new(one_cloth(grid(5, 5, Vec3::x(), Vec3::z()), lists), 1);
    let names: Vec<_> = bare.passes(&frame(3, physical(24.0))).iter().map(|pass| pass.name).collect();
    assert_eq!(names, ["predict", "stretch", "angular momentum"]);
}

/// Runs a sheet at rest on the ground for `frames` frames, with the plane of `plane_at` at a share of them. Returns the
/// smallest height of any point above the plane over the thickness, and the largest vertical speed in m/s.
fn carried_by_a_plane(frames: u32, plane_at: impl Fn(f64) -> GroundPlane) -> (f64, f64) {
    let thickness = 0.005;
    let mut sheet = grid(9, 9, Vec3::x() * 0.4, Vec3::z() * 0.4);
    sheet.positions.iter_mut().for_each(|p| p.y = thickness);
    let builder = one_cloth(sheet, ClothLists { cross_links: false, ..ClothLists::DEFAULT });
    let mut solver: Solver = Solver::new(builder, 1);
    let cloths = vec![ClothFrame { thickness, friction: 0.5, ..still() }];
    let (mut least, mut max_speed) = (f64::INFINITY, 0.0f64);
    for frame_number in 0..=frames {
        let plane = plane_at(f64::from(frame_number) / f64::from(frames));
        let input = FrameInput { plane: Some(plane), cloths: cloths.clone(), ..frame(3, physical(48.0)) };
        solver.step(&input, &mut ());
        let up = plane.normal.normalize();
        for point in 0..81 {
            let place = solver.point(ClothId(0), point);
            least = least.min((place - plane.origin).dot(&up) / thickness);
        }
        let mut velocities = Vec::new();
        solver.velocities(ClothId(0), 1.0, &mut velocities);
        max_speed = velocities.iter().map(|v| f64::from(v[1].abs())).fold(max_speed, f64::max);
    }
    (least, max_speed)
}

#[test]
fn a_ground_plane_that_rises_at_2_4_m_per_second_carries_a_sheet_along() {
    let rise = |share: f64| GroundPlane { origin: Vec3::y() * share, ..ground(0.5) };
    let (least, max_speed) = carried_by_a_plane(10, rise);
    assert!(least > 0.999, "the sheet comes to {least} of its thickness above the plane");
    assert!((2.3..2.6).contains(&max_speed), "it moves at {max_speed} m/s where the plane rises at 2.4");
}

#[test]
fn a_ground_plane_that_tilts_by_20_degrees_stays_below_a_sheet() {
    let tilt = |share: f64| {
        let angle = 20f64.to_radians() * share;
        GroundPlane { normal: Vec3::new(angle.sin(), angle.cos(), 0.0), ..ground(0.5) }
    };
    let (least, _) = carried_by_a_plane(10, tilt);
    assert!(least > 0.999, "the sheet comes to {least} of its thickness above the plane");
}
