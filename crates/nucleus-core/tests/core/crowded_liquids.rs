//! Liquids whose particles begin closer to each other than they can be.

use crate::liquids::{built, liquid, places as places_of, water};
use crate::scenes::{Vec3, frame, ground, physical};
use nucleus_core::{FrameInput, Solver};

// Particles in one place have no gradient: their pressure grew without bound, until the ground gave it one.
#[test]
fn particles_in_one_place_are_not_thrown_off_by_the_ground() {
    let spacing = 0.0064;
    for count in [4, 12] {
        let places = vec![Vec3::y() * 0.02; count];
        let mut solver = Solver::<f32>::new(built([water(places, Vec::new(), spacing)], Vec::new()), 1);
        let input = FrameInput {
            cloths: vec![liquid(spacing)],
            plane: Some(ground(0.0)),
            ..frame(1, physical(96.0))
        };
        for frame in 0..12 {
            solver.step(&input, &mut ());
            let highest = places_of(&solver, count).iter().map(|place| place.norm()).fold(0.0, f64::max);
            // 16 rest distances from the ground below them, which they start three above.
            assert!(highest < 0.1, "{count} particles, frame {frame}: {highest} m away");
        }
    }
}
