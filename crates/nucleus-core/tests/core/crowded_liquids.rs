//! Liquids whose particles begin closer to each other than they can be.

use crate::liquids::{built, liquid, places as places_of, water};
use crate::scenes::{Vec3, frame, ground, physical};
use nucleus_core::{FrameInput, Solver};

// Particles in one place have no gradient: their pressure grew without bound, until the ground gave it one.
#[test]
fn particles_in_one_place_are_not_thrown_off_by_the_ground() {
    let (spacing, height) = (0.0064, 0.02);
    for (gap, count) in [(0.0, 4), (0.0, 12), (1e-9, 4), (1e-9, 12)] {
        let places = (0..count).map(|k| Vec3::new(0.0, height, gap * k as f64)).collect();
        let mut solver = Solver::<f32>::new(built([water(places, Vec::new(), spacing)], Vec::new()), 1);
        let input = FrameInput {
            cloths: vec![liquid(spacing)],
            plane: Some(ground(0.0)),
            ..frame(1, physical(96.0))
        };
        // The speed of the fall, which the ground turns sideways.
        let fastest = (2.0 * 9.81 * height).sqrt();
        for frame in 1..=12 {
            solver.step(&input, &mut ());
            let farthest = places_of(&solver, count).iter().map(|place| place.norm()).fold(0.0, f64::max);
            let bound = height + fastest * f64::from(frame) / 24.0;
            assert!(farthest < bound, "{count} particles {gap} m apart, frame {frame}: {farthest} m away");
        }
    }
}

/// How far particles that start at these places come in 12 frames on the ground, and their mean at the start and after the
/// first frame.
fn fallen(places: &[Vec3]) -> (f64, [Vec3; 2]) {
    let (spacing, count) = (0.0064, places.len());
    let mut solver = Solver::<f32>::new(built([water(places.to_vec(), Vec::new(), spacing)], Vec::new()), 1);
    let input =
        FrameInput { cloths: vec![liquid(spacing)], gravity: Vec3::zeros(), ..frame(1, physical(96.0)) };
    let mean = |places: &[Vec3]| places.iter().sum::<Vec3>() / count as f64;
    let start = mean(places);
    let (mut farthest, mut after) = (0.0f64, start);
    for frame in 0..12 {
        solver.step(&input, &mut ());
        let now = places_of(&solver, count);
        farthest = now.iter().map(|place| (place - start).norm()).fold(farthest, f64::max);
        if frame == 0 {
            after = mean(&now);
        }
    }
    (farthest, [start, after])
}

#[test]
fn particles_that_are_nearly_in_one_place_part_about_their_centre_and_are_not_thrown_off() {
    let at = Vec3::y() * 0.02;
    for gap in [0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
        for count in [2, 4, 12] {
            let sides = [Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::x()];
            let places: Vec<Vec3> =
                (0..count).map(|k| at + sides[k % 4] * (gap * (1 + k / 4) as f64)).collect();
            let (farthest, [start, after]) = fallen(&places);
            // They part at 0.6 m/s at most, for half a second, and nothing stops them.
            assert!(farthest < 0.3, "{count} particles {gap} m apart: {farthest} m away");
            assert!((after - start).norm() < 1e-3 * 0.0064, "{count} particles {gap} m apart");
            if count > 3 {
                assert!(farthest > 0.2 * 0.0064, "{count} particles {gap} m apart stay in one place");
            }
        }
    }
}
