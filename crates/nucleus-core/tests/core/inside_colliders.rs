//! Cloth and particles inside a closed collider leave it once they collide with it, and not before.

use crate::scenes::{LINKS, Vec3, cuboid, frame, grid, physical, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, ExcludedSide, Exclusion,
    FrameInput, Mass, ModelBuilder, PointId, Solver, StateView, Surface,
};

/// A cube of a metre, 0.1 m below whose top a sheet or a particle starts.
fn inside_a_cube(is_sheet: bool) -> (Solver<f32>, FrameInput) {
    let mut surface = match is_sheet {
        true => grid(3, 3, Vec3::x() * 0.2, Vec3::z() * 0.2),
        false => Surface { positions: vec![Vec3::zeros()], ..Surface::default() },
    };
    surface.positions.iter_mut().for_each(|place| place.y = 0.4);
    let (mass, lists) =
        if is_sheet { (Mass::PerArea(0.2), LINKS) } else { (Mass::PerPoint(1.0), ClothLists::NONE) };
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(surface, mass, lists)).expect("a cloth");
    let surface = cuboid(Vec3::repeat(-0.5), Vec3::repeat(0.5));
    builder.collider(Collider { surface }).expect("a cube");
    let elements = if is_sheet { Elements::Faces } else { Elements::Points };
    let input = FrameInput {
        gravity: Vec3::zeros(),
        cloths: vec![ClothFrame { thickness: 0.01, elements, ..still() }],
        colliders: vec![ColliderFrame { collide: true, thickness: 0.01, ..ColliderFrame::default() }],
        ..frame(3, physical(24.0))
    };
    (Solver::new(builder, 1), input)
}

/// The height of the lowest point, after frames whose input `change` sets by the number of the frame.
fn lowest(is_sheet: bool, frames: u32, change: impl Fn(&mut FrameInput, u32)) -> f64 {
    let (mut solver, mut input) = inside_a_cube(is_sheet);
    for number in 0..frames {
        change(&mut input, number);
        solver.step(&input, &mut ());
    }
    let mut places = Vec::new();
    solver.positions(ClothId(0), 1.0, &mut places);
    places.iter().map(|place| f64::from(place[1])).fold(f64::INFINITY, f64::min)
}

fn exclude(input: &mut FrameInput, is_excluded: bool) {
    let own = (0..if input.cloths[0].elements == Elements::Faces { 9 } else { 1 })
        .map(|k| (ClothId(0), PointId(k)));
    let sides = [ExcludedSide::Points(own.collect(), Vec::new()), ExcludedSide::Everything];
    input.exclusions = if is_excluded { vec![Exclusion { sides }.into()] } else { Vec::new() };
}

#[test]
fn what_does_not_collide_with_a_collider_stays_inside() {
    for is_sheet in [true, false] {
        for change in [
            |input: &mut FrameInput| exclude(input, true),
            |input: &mut FrameInput| input.colliders[0].collide = false,
            |input: &mut FrameInput| input.colliders[0].collide_strength = 0.5,
            |input: &mut FrameInput| input.colliders[0].trapped_check = false,
        ] {
            let height = lowest(is_sheet, 12, |input, _| change(input));
            assert!((height - 0.4).abs() < 1e-6, "{is_sheet}: {height}");
        }
    }
}

#[test]
fn what_begins_to_collide_inside_a_collider_leaves_it() {
    let changes: [fn(&mut FrameInput, u32); 5] = [
        |_, _| {},
        |input, number| exclude(input, number < 6),
        // It has collided before.
        |input, number| input.colliders[0].collide = number >= 6 || number == 0,
        |input, number| input.colliders[0].collide_strength = (f64::from(number) / 6.0).min(1.0),
        |input, number| input.colliders[0].trapped_check = number >= 6,
    ];
    for is_sheet in [true, false] {
        for (at, change) in changes.iter().enumerate() {
            let height = lowest(is_sheet, 24, change);
            assert!(height > 0.515, "{is_sheet}, {at}: {height}");
        }
    }
}

#[test]
fn what_enters_a_collider_after_it_has_rested_on_it_leaves_it() {
    // It leaves the cube within 24 frames, rests on it, and is 0.1 m inside when it collides again.
    let (rests_until, enters_until) = (30, 34);
    let falls = |input: &mut FrameInput| input.gravity = Vec3::y() * -9.81;
    let enters = |number: u32| (rests_until..enters_until).contains(&number);
    let without_collisions = |input: &mut FrameInput, number: u32| {
        falls(input);
        input.colliders[0].collide = !enters(number);
    };
    let with_less_strength = |input: &mut FrameInput, number: u32| {
        falls(input);
        input.colliders[0].collide_strength = if enters(number) { 0.0 } else { 1.0 };
    };
    for is_sheet in [true, false] {
        for change in [&without_collisions as &dyn Fn(&mut FrameInput, u32), &with_less_strength] {
            let heights = [rests_until, enters_until, 80].map(|frames| lowest(is_sheet, frames, change));
            assert!(heights[0] > 0.515, "{is_sheet}: {heights:?}");
            assert!(heights[1] < 0.43, "{is_sheet}: {heights:?}");
            assert!(heights[2] > 0.515, "{is_sheet}: {heights:?}");
        }
    }
}

#[test]
fn what_a_collider_jumps_around_between_two_frames_leaves_it() {
    for is_sheet in [true, false] {
        let height = lowest(is_sheet, 80, |input, number| {
            input.gravity = Vec3::y() * -9.81;
            let up: Vec<Vec3> = cuboid(Vec3::repeat(-0.5), Vec3::repeat(0.5)).positions;
            let up: Vec<Vec3> = up.into_iter().map(|place| place + Vec3::y() * 0.15).collect();
            let jumps = number == 30;
            input.colliders[0].start = if jumps { up.clone() } else { Vec::new() };
            input.colliders[0].end = if jumps { up } else { Vec::new() };
        });
        assert!(height > 0.665, "{is_sheet}: {height}");
    }
}
