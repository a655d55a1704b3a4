//! Coulomb friction where the surface turns, and in a rebound.

use crate::scenes::{LINKS, Vec3, built, cuboid, frame, grid, ground, physical, sphere, still};
use nalgebra::Rotation3;
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, ColliderFrame, Faces, FrameInput, Mass, Real, Solver, Start,
    StateView, Surface,
};

const FIRST: ClothId = ClothId(0);
const THICKNESS: f64 = 0.05;

/// A cloth that starts with a velocity.
fn thrown(surface: Surface, lists: ClothLists, velocity: Vec3) -> Cloth {
    let velocities = vec![velocity; surface.positions.len()];
    let start = Start { velocities, ..Start::default() };
    Cloth { start, ..Cloth::new(surface, Mass::PerPoint(0.1), lists) }
}

fn bead(place: Vec3) -> Surface {
    Surface { positions: vec![place], faces: Faces::default() }
}

/// The velocity with which an object that came at (2, -4, 0) m/s leaves a ground or a box with its top at zero.
fn rebound(surface: Surface, lists: ClothLists, on_box: bool) -> Vec3 {
    let floor = cuboid(Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, 0.0, 9.0));
    let cloth = thrown(surface, lists, Vec3::new(2.0, -4.0, 0.0));
    let mut solver = Solver::<f64>::new(built(cloth, on_box.then_some(floor)), 2);
    let settings = ClothFrame { thickness: THICKNESS, friction: 0.1, bounce: 0.6, ..still() };
    let collider = ColliderFrame { collide: true, friction: 0.0, ..ColliderFrame::default() };
    let input = FrameInput {
        gravity: Vec3::zeros(),
        cloths: vec![settings],
        colliders: vec![collider; usize::from(on_box)],
        plane: (!on_box).then(|| ground(0.0)),
        ..frame(3, physical(96.0))
    };
    (0..4).for_each(|_| {
        solver.step(&input, &mut ());
    });
    let mut all = Vec::new();
    solver.velocities(FIRST, 1.0, &mut all);
    Vec3::from(all[0].map(f64::from))
}

#[test]
fn friction_of_a_rebound_is_coulombs_share_of_its_impulse_wherever_in_the_step_it_is() {
    let expected = Vec3::new(2.0 - 0.1 * 1.6 * 4.0, 0.6 * 4.0, 0.0);
    for on_box in [false, true] {
        // It comes down by 1.7 mm in a time step.
        for height in (0..8).map(|k| 0.2 + 0.0004 * f64::from(k)) {
            // Off the diagonal of the box's top, along which two faces meet.
            let place = Vec3::new(0.13, height, -3.0);
            let mut sheet = grid(3, 3, Vec3::x() * 0.4, Vec3::z() * 0.4);
            sheet.positions.iter_mut().for_each(|point| *point += place);
            for found in [rebound(bead(place), ClothLists::NONE, on_box), rebound(sheet, LINKS, on_box)] {
                assert!((found - expected).norm() < 1e-5, "on a box {on_box}, from {height} m: {found}");
            }
        }
    }
}

/// How far a bead that grips a collider is, after it has turned by a radian, from where it would be as a part of it.
fn lag(collider: Surface, start: Vec3) -> f64 {
    let frames = 24;
    let cloth = thrown(bead(start), ClothLists::NONE, Vec3::zeros());
    let mut solver = Solver::<f64>::new(built(cloth, [collider.clone()]), 2);
    let turned = |k: i32| Rotation3::from_axis_angle(&Vec3::z_axis(), f64::from(k) / f64::from(frames));
    let settings = ClothFrame { thickness: THICKNESS, friction: 1.0, stickiness: 1.0, ..still() };
    for k in 1..=frames {
        let at = |k| collider.positions.iter().map(|place| turned(k) * place).collect::<Vec<_>>();
        let moving =
            ColliderFrame { collide: true, start: at(k - 1), end: at(k), ..ColliderFrame::default() };
        let input =
            FrameInput { cloths: vec![settings], colliders: vec![moving], ..frame(3, physical(96.0)) };
        solver.step(&input, &mut ());
    }
    (solver.point(FIRST, 0) - turned(frames) * start).norm()
}

#[test]
fn what_grips_a_turning_collider_turns_with_it() {
    let block = cuboid(Vec3::new(-0.5, -0.5, -0.5), Vec3::new(0.5, 0.5, 0.5));
    let on_block = lag(block, Vec3::new(0.1, 0.5 + THICKNESS, 0.2));
    let on_ball = lag(sphere(0.5, Vec3::zeros()), Vec3::y() * (0.5 + THICKNESS));
    // It would lag by its distance times the angle, 5 cm, if it followed the surface below it.
    assert!(on_block < 1e-3 && on_ball < 1e-3, "{on_block} and {on_ball}");
}

/// How far an object slides in a second down a slope of 20 degrees that consists of quads of this size, over where Coulomb's law
/// takes it.
fn sliding_ratio<R: Real>(surface: Surface, lists: ClothLists, quad: f64, evaluations: f64) -> f64 {
    const FRICTION: f64 = 0.2;
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let (down, across, normal) = (Vec3::new(cos, -sin, 0.0), Vec3::z(), Vec3::new(sin, cos, 0.0));
    let quads = ((4.0 / quad).ceil() as u32).max(1);
    let size = f64::from(quads) * quad;
    let corner = (down + across) * (-0.37 * size);
    let slope = Surface::sheet(corner, [down * size, across * size], [quads; 2]);
    let start = |place: Vec3| down * place.x + across * place.z + normal * THICKNESS;
    let positions = surface.positions.iter().map(|&place| start(place)).collect();
    let cloth = thrown(Surface { positions, ..surface }, lists, Vec3::zeros());
    let mut solver = Solver::<R>::new(built(cloth, [slope]), 2);
    let settings = ClothFrame { thickness: THICKNESS, friction: FRICTION, ..still() };
    let collider = ColliderFrame { collide: true, friction: 0.0, ..ColliderFrame::default() };
    let input =
        FrameInput { cloths: vec![settings], colliders: vec![collider], ..frame(3, physical(evaluations)) };
    let before = solver.point(FIRST, 0);
    (0..24).for_each(|_| {
        solver.step(&input, &mut ());
    });
    let way = (solver.point(FIRST, 0) - before).dot(&down);
    way / (-input.gravity.y * (sin - FRICTION * cos) / 2.0)
}

#[test]
fn a_slope_has_coulombs_friction_in_single_precision_whatever_the_size_of_its_faces() {
    let sheet = grid(3, 3, Vec3::x() * 0.4, Vec3::z() * 0.4);
    for quad in [0.1, 1.0, 10.0, 100.0] {
        for evaluations in [96.0, 400.0] {
            for (surface, lists) in
                [(bead(Vec3::new(0.01, 0.0, 0.02)), ClothLists::NONE), (sheet.clone(), LINKS)]
            {
                let single = sliding_ratio::<f32>(surface.clone(), lists, quad, evaluations);
                let double = sliding_ratio::<f64>(surface, lists, quad, evaluations);
                assert!((double - 1.0).abs() < 1e-3, "{quad} m, {evaluations}: {double}");
                assert!((single - 1.0).abs() < 1e-2, "{quad} m, {evaluations}: {single}");
            }
        }
    }
}

/// The smallest and the largest distance of a sheet from a plate of one quad, over its thickness, while the plate turns. The
/// sheet starts on its upper side (1) or its lower side (-1).
fn distances_from_turning_plate(size: f64, side: f64, stickiness: f64) -> [f64; 2] {
    let plate = grid(2, 2, Vec3::x() * size, Vec3::z() * size);
    let mut sheet = grid(3, 3, Vec3::x() * 0.4, Vec3::z() * 0.4);
    sheet.positions.iter_mut().for_each(|place| *place += Vec3::new(0.3, side * THICKNESS, 0.1));
    let cloth = thrown(sheet, LINKS, Vec3::zeros());
    let mut solver = Solver::<f64>::new(built(cloth, [plate.clone()]), 2);
    let turned = |k: u32| Rotation3::from_axis_angle(&Vec3::z_axis(), 0.1 * f64::from(k) / 24.0);
    let settings = ClothFrame { thickness: THICKNESS, friction: 1.0, stickiness, ..still() };
    let mut range = [f64::MAX, 0.0f64];
    for k in 1..=24 {
        let at = |k| plate.positions.iter().map(|place| turned(k) * place).collect::<Vec<_>>();
        let moving =
            ColliderFrame { collide: true, start: at(k - 1), end: at(k), ..ColliderFrame::default() };
        let input =
            FrameInput { cloths: vec![settings], colliders: vec![moving], ..frame(3, physical(96.0)) };
        solver.step(&input, &mut ());
        for point in 0..9 {
            let distance = (turned(k).inverse() * solver.point(FIRST, point)).y * side / THICKNESS;
            range = [range[0].min(distance), range[1].max(distance)];
        }
    }
    range
}

#[test]
fn a_sheet_on_a_turning_plate_keeps_its_thickness_whatever_the_size_of_the_faces() {
    for size in [2.0, 20.0, 60.0] {
        let [least, most] = distances_from_turning_plate(size, 1.0, 0.0);
        assert!(least > 0.999 && most < 1.001, "{size} m: {least} to {most} thicknesses");
    }
}

#[test]
fn adhesion_holds_a_sheet_under_a_turning_plate_whatever_the_size_of_the_faces() {
    for size in [2.0, 20.0, 60.0] {
        let [least, most] = distances_from_turning_plate(size, -1.0, 1.0);
        assert!(least > 0.999 && most < 1.001, "{size} m: {least} to {most} thicknesses");
    }
}
