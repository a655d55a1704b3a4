//! Drops of liquid that surface tension holds together.

use std::f64::consts::PI;

use crate::liquids::{WATER, built, liquid, places, water};
use crate::scenes::{Vec3, frame, physical};
use nucleus_core::{ClothFrame, FrameInput, Liquid, Solver, StateView};

/// A drop that is an ellipsoid of revolution about x at the start, without gravity or viscosity.
struct Drop {
    solver: Solver<f32>,
    input: FrameInput,
    count: usize,
}

/// Period of the lowest mode in frames (Rayleigh 1879: omega² = 8 sigma / (rho R³)).
const PERIOD: f64 = 24.0;

impl Drop {
    /// A drop of so many rest distances in radius and this ratio of axes.
    fn new(radius: f64, ratio: f64) -> Self {
        let spacing = 0.01;
        let across = radius / ratio.cbrt();
        let half = (across * ratio).ceil() as i32 + 1;
        let along = || (-half..half).map(|k| f64::from(k) + 0.5);
        let all = along().flat_map(|x| along().flat_map(move |y| along().map(move |z| Vec3::new(x, y, z))));
        let is_inside = |place: &Vec3| Vec3::new(place.x / ratio, place.y, place.z).norm() < across;
        let positions: Vec<Vec3> = all.filter(is_inside).map(|place| place * spacing).collect();
        let count = positions.len();
        let solver = Solver::new(built([water(positions, Vec::new(), spacing)], Vec::new()), 2);
        let still = frame(1, physical(96.0));
        let omega = 2.0 * PI / (PERIOD * still.duration);
        // R³ by the volume of the particles.
        let cube = 3.0 * count as f64 / (4.0 * PI) * spacing.powi(3);
        let settings = Liquid {
            spacing,
            incompressibility: 1.0,
            viscosity: 0.0,
            surface_tension: omega * omega * cube / 8.0,
        };
        let cloth = ClothFrame { liquid: Some(settings), ..liquid(spacing) };
        Self { solver, input: FrameInput { gravity: Vec3::zeros(), cloths: vec![cloth], ..still }, count }
    }

    /// The ratio of the axes of the ellipsoid that has the moments of the drop.
    fn ratio(&self) -> f64 {
        let places = places(&self.solver, self.count);
        let centre = places.iter().sum::<Vec3>() / self.count as f64;
        let squares =
            places.iter().map(|place| (place - centre).component_mul(&(place - centre))).sum::<Vec3>();
        (2.0 * squares.x / (squares.y + squares.z)).sqrt()
    }

    /// Root of the mean square of the speeds in m/s.
    fn speed(&self) -> f64 {
        let mut velocities = Vec::new();
        self.solver.velocities(WATER, 1.0, &mut velocities);
        (velocities.iter().flatten().map(|v| f64::from(v * v)).sum::<f64>() / self.count as f64).sqrt()
    }

    fn step(&mut self) {
        let report = self.solver.step(&self.input, &mut ());
        assert!(report.finite);
    }
}

/// The frames at which a curve that is given at each frame passes 1.
fn passes_of_one(curve: &[f64]) -> Vec<f64> {
    let pairs = curve.windows(2).enumerate().filter(|(_, pair)| (pair[0] > 1.0) != (pair[1] > 1.0));
    pairs.map(|(at, pair)| at as f64 + (pair[0] - 1.0) / (pair[0] - pair[1])).collect()
}

#[test]
#[ignore = "prints a measurement"]
fn measure_swinging_drops() {
    for (radius, ratio) in [(3.0, 1.5), (5.0, 1.5), (8.0, 1.5), (8.0, 1.88), (12.0, 1.5), (16.0, 1.5)] {
        let mut drop = Drop::new(radius, ratio);
        let start = std::time::Instant::now();
        println!("radius {radius}, {} particles, period {PERIOD} frames", drop.count);
        let mut ratios = vec![drop.ratio()];
        for _ in 0..96 {
            drop.step();
            ratios.push(drop.ratio());
        }
        println!("  passes {:.1?}", passes_of_one(&ratios));
        println!("  every third {:.3?}", ratios.iter().step_by(3).collect::<Vec<_>>());
        println!("  speed {:.1e}, {:.2} s", drop.speed(), start.elapsed().as_secs_f64());
    }
}

#[test]
fn a_drop_swings_at_rayleighs_period_and_becomes_a_ball() {
    let mut drop = Drop::new(8.0, 1.5);
    let mut ratios = vec![drop.ratio()];
    for _ in 0..96 {
        drop.step();
        ratios.push(drop.ratio());
    }
    let passes = passes_of_one(&ratios);
    assert!(passes.len() >= 5, "{ratios:.3?}");
    let period = (passes[4] - passes[0]) / 2.0;
    assert!((period / PERIOD - 1.0).abs() < 0.15, "{period} frames instead of {PERIOD}: {ratios:.3?}");
    let error = ratios[72..].iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, f64::max);
    assert!(error < 0.05, "{error}: {ratios:.3?}");
}

#[test]
fn a_large_drop_gains_no_energy_while_it_swings() {
    let mut drop = Drop::new(12.0, 1.5);
    let mut speeds = Vec::new();
    for _ in 0..72 {
        drop.step();
        speeds.push(drop.speed());
    }
    let most = |range: std::ops::Range<usize>| speeds[range].iter().copied().fold(0.0, f64::max);
    // Each period has less than the one before.
    let by_period = [most(0..24), most(24..48), most(48..72)];
    assert!(by_period[1] < 0.8 * by_period[0] && by_period[2] < 0.8 * by_period[1], "{by_period:?} m/s");
}
