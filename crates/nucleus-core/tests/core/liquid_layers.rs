//! Two liquids of different densities in one tank.

use crate::liquids::{block, built, frictionless, liquid, walls, water};
use crate::scenes::{Vec3, frame, ground, physical};
use nucleus_core::{Cloth, ClothId, FrameInput, Mass, Solver, StateView};

/// Water above a liquid of another density in a tank, each 4 layers deep.
struct Layers {
    solver: Solver<f32>,
    input: FrameInput,
    count: usize,
    spacing: f64,
}

impl Layers {
    /// `density` is that of the liquid below, in kg/m³.
    fn new(density: f64) -> Self {
        let (spacing, side, layers) = (0.02, 6, 4);
        let across = side as f64 * spacing;
        let heavy = block(Vec3::y() * (layers as f64 * spacing), [side, layers, side], spacing);
        let light = block(Vec3::zeros(), [side, layers, side], spacing);
        let count = heavy.len();
        let mass = Mass::PerPoint(density * spacing.powi(3));
        let oil = Cloth { mass, ..water(light, Vec::new(), spacing) };
        let tank = walls([[0.0; 2], [across; 2]], 4.0 * layers as f64 * spacing);
        let solver = Solver::<f32>::new(built([water(heavy, Vec::new(), spacing), oil], tank), 1);
        let input = FrameInput {
            plane: Some(ground(0.0)),
            cloths: vec![liquid(spacing); 2],
            colliders: frictionless(4),
            ..frame(1, physical(32.0))
        };
        Self { solver, input, count, spacing }
    }

    /// All particles after so many frames more, the heavy ones first.
    fn after(&mut self, frames: u32) -> Vec<Vec3> {
        for _ in 0..frames {
            self.solver.step(&self.input, &mut ());
        }
        let of = |cloth: u32| (0..self.count).map(move |point| (cloth, point));
        of(0).chain(of(1)).map(|(cloth, point)| self.solver.point(ClothId(cloth), point)).collect()
    }
}

fn mean_height(places: &[Vec3]) -> f64 {
    places.iter().map(|place| place.y).sum::<f64>() / places.len() as f64
}

#[test]
#[ignore = "prints a measurement"]
fn measure_how_far_liquids_separate() {
    for ratio in [1.0, 1.4, 2.0, 3.0, 5.0, 14.0] {
        let mut layers = Layers::new(1000.0 / ratio);
        print!("mass ratio {ratio}: ");
        for _ in 0..5 {
            let places = layers.after(48);
            let [heavy, light] = [mean_height(&places[..layers.count]), mean_height(&places[layers.count..])];
            // -1 at the start, 1 where all of the heavy liquid is below.
            print!(" {:.2}", (light - heavy) / (4.0 * layers.spacing));
        }
        println!();
    }
}

#[test]
fn two_liquids_in_one_tank_share_the_room_and_the_heavier_one_sinks() {
    let mut layers = Layers::new(400.0);
    let places = layers.after(72);
    let (count, spacing) = (layers.count, layers.spacing);
    let [heavy, light] = [mean_height(&places[..count]), mean_height(&places[count..])];
    // Each by itself was as dense as at rest, and both were in one place: the level sank by a third.
    let expected = 4.0 * spacing;
    let mean = mean_height(&places);
    assert!((mean / expected - 1.0).abs() < 0.08, "{mean} and {expected}");
    assert!(light > heavy + 0.5 * spacing, "{light} above {heavy}");
    let is_close = |(at, place): (usize, &Vec3)| {
        places.iter().enumerate().any(|(other, near)| other != at && (near - place).norm() < 0.3 * spacing)
    };
    let close = places.iter().enumerate().filter(|&particle| is_close(particle)).count();
    assert!(close * 20 < places.len(), "{close} of {} are within another", places.len());
}
