//! Falls and swings, and conserved quantities.

use nucleus_core::{BuildError, COUNT_PERIOD, ClothLists, StateView, Stiffness};

use super::case::{Case, Comparison, Fixture, Tolerance};
use crate::fixture::{CLOTH, DENSITY, GRAVITY, STRIP, Vec3, membrane, sheet, vertex_areas};

pub const CASES: &[Case] = &[
    Case {
        name: "pendulum",
        description: "A rod of 1 m swings about a hinge. Its period over that of small swings is 1 / agm(1, cos(α / 2)).",
        known_failure: None,
        run: pendulum,
    },
    Case {
        name: "pendulum-loss",
        description: "The same rod swings undamped from 90° for 1,250 frames, 52 s: how far the highest point of its swing is \
            then below the start. A time step h moves a point by its velocity and by gravity, and projects it back onto the \
            circle: an angle δ of the step before becomes δ - δ³ - δ h² g cos θ / L, besides what gravity adds along the circle. \
            The energy per mass falls by h ω² (ω² L + g cos θ) L in a second, h ω² L times the tension. This is of first order \
            in the time step, as with implicit Euler; the reference integrates it over the swings.",
        known_failure: None,
        run: pendulum_loss,
    },
    Case {
        name: "terminal-velocity",
        description: "A sheet falls flat through air whose drag is linear: v = g τ (1 - exp(-t / τ)), in m/s.",
        known_failure: None,
        run: terminal_velocity,
    },
    Case {
        name: "momentum",
        description: "A free sheet is pushed and rotated, then isolated for a second: relative change of linear and of angular \
            momentum. A link acts along its direction at the end of a step, not at its start; what that takes of the \
            angular momentum is given back after the sweeps.",
        known_failure: None,
        run: momentum,
    },
    Case {
        name: "energy",
        description: "A sheet swings down from two corners, undamped, 1 m wide, 0.2 kg: maximum of kinetic plus potential \
            energy over the initial value, in J.",
        known_failure: None,
        run: energy,
    },
];

fn pendulum() -> Result<Vec<Comparison>, BuildError> {
    [30.0, 60.0, 90.0, 120.0, 150.0].into_iter().map(swing).collect()
}

fn swing(degrees: f64) -> Result<Comparison, BuildError> {
    let (sin, cos) = f64::to_radians(degrees).sin_cos();
    // Two parallel rods and a bar: a pendulum in the plane across the bar.
    let rods = sheet([2, 2], Vec3::zeros(), Vec3::z() * 0.5, Vec3::new(sin, -cos, 0.0));
    let mut fixture = Fixture::new(rods, ClothLists { stretch: true, ..ClothLists::NONE }, 4000.0)?;
    fixture.cloth().stiffness = membrane(1e5);
    fixture.pin([0, 1]);
    fixture.frame.duration /= 4.0;
    let (mut crossings, mut before) = (Vec::new(), sin);
    for step in 1..4 * 24 * 8 {
        fixture.step();
        let now = fixture.point(2).x;
        if before > 0.0 && now <= 0.0 {
            crossings.push((f64::from(step) - now / (now - before)) * fixture.frame.duration);
        }
        before = now;
    }
    let small = std::f64::consts::TAU / GRAVITY.sqrt();
    let found = crossings.get(1).map_or(f64::NAN, |second| (second - crossings[0]) / small);
    let exact = 1.0 / agm(1.0, (degrees.to_radians() / 2.0).cos());
    Ok(Comparison::new(
        format!("period at {degrees}°, over that of small swings"),
        exact,
        found,
        Tolerance::Relative(0.005),
    ))
}

fn pendulum_loss() -> Result<Vec<Comparison>, BuildError> {
    [96.0, 400.0, 1600.0].into_iter().map(loss).collect()
}

/// The loss of height at so many evaluations in 1/24 s.
fn loss(evaluations: f64) -> Result<Comparison, BuildError> {
    let frames = 1250;
    let rods = sheet([2, 2], Vec3::zeros(), Vec3::z() * 0.5, Vec3::x());
    let mut fixture = Fixture::new(rods, ClothLists { stretch: true, ..ClothLists::NONE }, evaluations)?;
    fixture.cloth().stiffness = membrane(1e5);
    fixture.pin([0, 1]);
    let mass: f64 = vertex_areas(&fixture.surface)[2..].iter().sum::<f64>() * DENSITY;
    let mut kinetic = 0.0;
    for _ in 0..frames {
        kinetic = fixture.step().kinetic_energy;
    }
    // Where its kinetic energy is used up.
    let highest = fixture.point(2).y + kinetic / (mass * GRAVITY);
    let seconds = f64::from(frames) * COUNT_PERIOD;
    Ok(Comparison::new(
        format!("loss of height, {evaluations} evaluations, m"),
        lost_height(COUNT_PERIOD / evaluations, seconds),
        -highest,
        Tolerance::Relative(0.03),
    ))
}

/// The height in metres that a rod of 1 m loses from 90° in time steps of `h` seconds: the cosine c of its largest angle grows by
/// h ω² (ω² + g cos θ) / g in a second, in the mean over a swing, where ω² = 2 g (cos θ - c).
fn lost_height(h: f64, seconds: f64) -> f64 {
    let intervals = 2000;
    (0..intervals).fold(0.0f64, |c, _| {
        let largest = c.acos();
        // With θ = α sin(u) the period's integrand is smooth at the turning point.
        let samples = (0..200).map(|k| (f64::from(k) + 0.5) / 200.0 * std::f64::consts::FRAC_PI_2);
        let [mut time, mut lost] = [0.0; 2];
        for (sin, cos) in samples.map(f64::sin_cos) {
            let down = (largest * sin).cos();
            let square = 2.0 * GRAVITY * (down - c);
            let passed = largest * cos / square.sqrt();
            (time, lost) = (time + passed, lost + passed * square * (square + GRAVITY * down));
        }
        c + h / GRAVITY * lost / time * seconds / f64::from(intervals)
    })
}

/// The arithmetic-geometric mean.
fn agm(a: f64, b: f64) -> f64 {
    (0..40).fold((a, b), |(a, b), _| ((a + b) / 2.0, (a * b).sqrt())).0
}

fn terminal_velocity() -> Result<Vec<Comparison>, BuildError> {
    let flat = sheet([5, 5], Vec3::zeros(), Vec3::x(), Vec3::z());
    let mut fixture = Fixture::new(flat, STRIP, 96.0)?;
    fixture.cloth().stiffness = membrane(1e4);
    let rate = 4.0;
    fixture.damp_velocity(rate);
    fixture.cloth().tangential_drag = 0.0;
    let mut comparisons = Vec::new();
    let mut speeds = Vec::new();
    for (seconds, frames) in [(0.25f64, 6), (0.5, 6), (3.0, 60)] {
        fixture.run(frames);
        fixture.solver.velocities(CLOTH, 1.0, &mut speeds);
        let exact = GRAVITY / rate * (1.0 - (-rate * seconds).exp());
        let found = -f64::from(speeds[12][1]);
        comparisons.push(Comparison::new(
            format!("speed after {seconds} s, m/s"),
            exact,
            found,
            Tolerance::Relative(0.01),
        ));
    }
    Ok(comparisons)
}

/// Momentum in kg m/s and angular momentum in kg m²/s.
fn momenta(fixture: &Fixture) -> (Vec3, Vec3) {
    let mut speeds = Vec::new();
    fixture.solver.velocities(CLOTH, 1.0, &mut speeds);
    let masses = vertex_areas(&fixture.surface).into_iter().map(|area| area * DENSITY);
    let points = fixture.points();
    let pushes = masses.zip(&speeds).map(|(mass, v)| Vec3::from(v.map(f64::from)) * mass);
    pushes
        .zip(&points)
        .fold((Vec3::zeros(), Vec3::zeros()), |(p, l), (push, x)| (p + push, l + x.cross(&push)))
}

fn momentum() -> Result<Vec<Comparison>, BuildError> {
    let mut comparisons = Vec::new();
    for evaluations in [96.0, 768.0, 3072.0] {
        let (push, turn) = drift(evaluations)?;
        let name = |what| format!("change of {what} in a second, {evaluations} evaluations");
        comparisons.push(Comparison::new(name("momentum"), 1e-6, push, Tolerance::AtMost));
        comparisons.push(Comparison::new(name("angular momentum"), 1e-4, turn, Tolerance::AtMost));
    }
    Ok(comparisons)
}

fn drift(evaluations: f64) -> Result<(f64, f64), BuildError> {
    let mut tilted = sheet([17, 17], Vec3::zeros(), Vec3::x(), Vec3::z());
    tilted.positions.iter_mut().for_each(|p| p.y = 0.1 * (5.0 * p.x).sin() * (4.0 * p.z).cos());
    let mut fixture = Fixture::new(tilted, STRIP, evaluations)?;
    fixture.cloth().stiffness = Stiffness { bend: Some(1e-4), ..membrane(1e4) };
    fixture.frame.gravity = Vec3::zeros();
    // Pushed while one corner is pinned, it rotates about that corner, then flies off.
    fixture.cloth().local_force = Vec3::new(0.002, 0.02, 0.004);
    fixture.pin([0]);
    fixture.run(12);
    fixture.cloth().local_force = Vec3::zeros();
    fixture.frame.pins.clear();
    fixture.run(1);
    let (p, l) = momenta(&fixture);
    fixture.run(24);
    let (p1, l1) = momenta(&fixture);
    let change = |before: Vec3, after: Vec3| (after - before).norm() / before.norm();
    Ok((change(p, p1), change(l, l1)))
}

fn energy() -> Result<Vec<Comparison>, BuildError> {
    let mut comparisons = Vec::new();
    for (name, cross_links) in [("squares", false), ("squares with cross links", true)] {
        for evaluations in [24.0, 96.0, 192.0] {
            let cloth = sheet([31, 31], Vec3::zeros(), Vec3::x(), Vec3::z());
            let lists = ClothLists { stretch: true, cross_links, ..ClothLists::NONE };
            let mut fixture = Fixture::new(cloth, lists, evaluations)?;
            fixture.cloth().stiffness = membrane(1e4);
            fixture.pin([0, 30]);
            let masses: Vec<f64> =
                vertex_areas(&fixture.surface).into_iter().map(|area| area * DENSITY).collect();
            let mut most = f64::NEG_INFINITY;
            for _ in 0..36 {
                let kinetic = fixture.step().kinetic_energy;
                let height: f64 = fixture.points().iter().zip(&masses).map(|(p, mass)| p.y * mass).sum();
                most = most.max(kinetic + GRAVITY * height);
            }
            let quantity = format!("{name}, {evaluations} evaluations: energy gained, J");
            comparisons.push(Comparison::new(quantity, 2e-5, most, Tolerance::AtMost));
        }
    }
    Ok(comparisons)
}
