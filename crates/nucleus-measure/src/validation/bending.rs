//! Strips that bend under their weight or a load, and that buckle.

use nucleus_core::{BuildError, Stiffness};

use super::case::{Case, Comparison, Fixture, Tolerance};
use super::elastica::{self, Curve};
use crate::fixture::{DENSITY, STRIP, Vec3, membrane, sheet};

pub const CASES: &[Case] = &[
    Case {
        name: "cantilever",
        description: "A strip of 50 elements, clamped horizontally, bends under its own weight, Γ = w L³ / B. Vertical over \
            horizontal displacement of its tip, compared with Euler's elastica by shooting; Romero et al. 2021 use \
            the same curve.",
        known_failure: None,
        run: cantilever,
    },
    Case {
        name: "cantilever-fine",
        description: "The same with 100 elements, at the largest curvatures: the error is proportional to the square of their \
            length.",
        known_failure: None,
        run: cantilever_fine,
    },
    Case {
        name: "elastica",
        description: "The tip of a weightless strip is pinned at its position under a load P L² / B: angle of the tip in \
            degrees.",
        known_failure: None,
        run: elastica,
    },
    Case {
        name: "lateral-buckling",
        description: "A strip on edge, clamped at one end, buckles sideways under its own weight at q L³ / √(EI GJ) = 12.854 \
            (Michell, Prandtl). A plate of Poisson's ratio zero has GJ = 2 EI. After a sideways impulse, while gravity \
            rises for 2 s: maximum out-of-plane displacement of the tip from 6 to 10 s, over that from 2 to 6 s. Under \
            sudden gravity the strip swings in its plane, buckles at once, and has its full amplitude before 6 s.",
        known_failure: None,
        run: lateral,
    },
    Case {
        name: "column",
        description: "A vertical strip, clamped at its lower end, buckles at w L³ / B = 7.8373 (Greenhill). After a sideways \
            impulse: maximum displacement of the tip from 6 to 10 s, over that from 2 to 6 s.",
        known_failure: None,
        run: column,
    },
];

/// Bending stiffness B of all strips in N·m; at L = 1 m the lowest frequency is 3.5 rad/s.
const BEND: f64 = 0.2;

/// Where the free length of one metre begins: at the second of two pinned columns of points for torsion, whose first free
/// cell is beyond it, and midway between them for bending, whose first hinge is at the second.
#[derive(Clone, Copy)]
enum Clamp {
    Bending,
    Torsion,
}

/// A strip with two pinned columns of points.
struct Strip {
    fixture: Fixture,
    /// Columns of points; the first two are pinned.
    columns: usize,
}

impl Strip {
    /// One metre of `elements` along `u`, `width` along `v` in `across` cells.
    fn new(
        clamp: Clamp,
        [elements, across]: [u32; 2],
        width: f64,
        [u, v]: [Vec3; 2],
        evaluations: f64,
    ) -> Result<Self, BuildError> {
        // Cells of the free length that are pinned.
        let pinned = match clamp {
            Clamp::Bending => 0.5,
            Clamp::Torsion => 0.0,
        };
        let cell = 1.0 / (f64::from(elements) + pinned);
        let columns = elements + 2;
        let length = cell * f64::from(columns - 1);
        let origin = -u * cell * (1.0 - pinned) - v * width / 2.0;
        let surface = sheet([columns, across + 1], origin, u * length, v * width);
        let mut fixture = Fixture::new(surface, STRIP, evaluations)?;
        let columns = columns as usize;
        fixture.pin((0..=across as usize).flat_map(|row| [row * columns, row * columns + 1]));
        Ok(Self { fixture, columns })
    }

    /// Centroid of a column, counted from the clamp.
    fn column(&self, column: usize) -> Vec3 {
        let points = self.fixture.points();
        let rows = points.len() / self.columns;
        (0..rows).map(|row| points[row * self.columns + column]).sum::<Vec3>() / rows as f64
    }

    fn tip(&self) -> Vec3 {
        self.column(self.columns - 1)
    }
}

/// Equilibrium of a strip under a gravity that makes `gamma`.
///
/// Shorter elements have stiffer hinges and lighter points: the error of one sweep grows with the fourth power of the
/// number of elements, and falls with the square of the evaluations.
fn droop(elements: u32, gamma: f64) -> Result<Curve, BuildError> {
    let evaluations = 4000.0 * (f64::from(elements) / 50.0).powi(2);
    let mut strip = Strip::new(Clamp::Bending, [elements, 1], 0.05, [Vec3::x(), Vec3::z()], evaluations)?;
    let gravity = gamma * BEND / DENSITY;
    let weight = DENSITY * gravity;
    // The axial strain is 1e-4.
    strip.fixture.cloth().stiffness = Stiffness { bend: Some(BEND), ..membrane(1e4 * weight.max(BEND)) };
    strip.fixture.frame.gravity = -Vec3::y() * gravity;
    strip.fixture.damp_velocity(2.0 * 3.5f64.max(gravity.sqrt()));
    strip.fixture.run_to_rest(1e-5 * gravity.sqrt(), 72);
    let (tip, before) = (strip.tip(), strip.column(strip.columns - 2));
    let along = tip - before;
    Ok(Curve { tip_angle: (-along.y).atan2(along.x), out: tip.x, down: -tip.y })
}

fn heavy(elements: u32, gammas: &[f64]) -> Result<Vec<Comparison>, BuildError> {
    let comparison = |&gamma: &f64| {
        let (exact, found) = (elastica::heavy(gamma), droop(elements, gamma)?);
        let ratio = |curve: Curve| curve.down / curve.out;
        Ok(Comparison::new(
            format!("H/W at Γ = {gamma}"),
            ratio(exact),
            ratio(found),
            Tolerance::Relative(0.01),
        ))
    };
    gammas.iter().map(comparison).collect()
}

fn cantilever() -> Result<Vec<Comparison>, BuildError> {
    heavy(50, &[0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0, 200.0, 500.0, 1000.0])
}

fn cantilever_fine() -> Result<Vec<Comparison>, BuildError> {
    heavy(100, &[500.0, 1000.0])
}

fn elastica() -> Result<Vec<Comparison>, BuildError> {
    let mut comparisons = Vec::new();
    for load in [1.0, 3.0, 10.0] {
        let exact = elastica::tip_loaded(load);
        let mut strip = Strip::new(Clamp::Bending, [50, 1], 0.05, [Vec3::x(), Vec3::z()], 4000.0)?;
        strip.fixture.cloth().stiffness = Stiffness { bend: Some(BEND), ..membrane(1e4 * BEND * load) };
        strip.fixture.frame.gravity = Vec3::zeros();
        strip.fixture.damp_velocity(10.0);
        carry_tip(&mut strip, exact, 24);
        strip.fixture.run_to_rest(1e-5, 48);
        let along = strip.tip() - strip.column(strip.columns - 2);
        // The last hinge is half an element before the centre of the last element.
        let degrees = (-along.y).atan2(along.x).to_degrees();
        let quantity = format!("tip angle at P L²/B = {load}, degrees");
        comparisons.push(Comparison::new(
            quantity,
            exact.tip_angle.to_degrees(),
            degrees,
            Tolerance::Relative(0.01),
        ));
    }
    Ok(comparisons)
}

/// Moves the pinned tip to `goal` in some frames.
fn carry_tip(strip: &mut Strip, goal: Curve, frames: u32) {
    let columns = strip.columns;
    let held = strip.fixture.frame.pins.clone();
    let tips = [columns - 1, 2 * columns - 1];
    for frame in 0..frames {
        let place = |point: usize, at: f64| {
            let from = strip.fixture.surface.positions[point];
            let to = Vec3::new(goal.out, -goal.down, from.z);
            // Along an arc, so that the strip is never stretched.
            let (share, bow) = (at, (std::f64::consts::PI * at).sin() * 0.15);
            from + (to - from) * share - Vec3::new(bow, 0.0, 0.0)
        };
        let shares = [frame, frame + 1].map(|k| f64::from(k) / f64::from(frames));
        let pin = |&point: &usize| nucleus_core::Pin {
            point: nucleus_core::PointId(point as u32),
            start: place(point, shares[0]),
            end: place(point, shares[1]),
            ..held[0]
        };
        let pins = held.iter().copied().chain(tips.iter().map(pin)).collect();
        strip.fixture.frame.pins = pins;
        strip.fixture.step();
    }
    for pin in &mut strip.fixture.frame.pins {
        pin.start = pin.end;
    }
}

/// Impulse: N on every point for a quarter of a second. A buckling strip grows about twentyfold in the four seconds between
/// the windows, so it has to start small to stay in the linear range.
const KICK: f64 = 1e-10;

/// After an impulse along `aside`: maximum displacement of the tip from 6 to 10 s, over that from 2 to 6 s. Near the
/// critical load a stable strip oscillates at about 1 rad/s. Gravity rises for `rise` frames.
fn growth(mut strip: Strip, gravity: f64, aside: Vec3, rise: u32) -> f64 {
    let start = strip.tip().dot(&aside);
    let mut far = Vec::new();
    for frame in 0..240 {
        let share = if frame < rise { f64::from(frame + 1) / f64::from(rise) } else { 1.0 };
        strip.fixture.frame.gravity = -Vec3::y() * gravity * share;
        strip.fixture.cloth().local_force = if frame < 6 { aside * KICK } else { Vec3::zeros() };
        strip.fixture.step();
        far.push((strip.tip().dot(&aside) - start).abs());
    }
    let most = |range: std::ops::Range<usize>| far[range].iter().copied().fold(0.0, f64::max);
    most(144..240) / most(48..144)
}

fn lateral() -> Result<Vec<Comparison>, BuildError> {
    let width = 0.05;
    // q = ρ b g, EI = B b, GJ = 2 B b. Bending enters by the moment over EI alone, so the length is that of torsion.
    let critical = 12.854 * 2f64.sqrt() * BEND / DENSITY;
    let growth_at = |share: f64| -> Result<f64, BuildError> {
        let mut strip = Strip::new(Clamp::Torsion, [40, 2], width, [Vec3::x(), Vec3::y()], 1500.0)?;
        strip.fixture.cloth().stiffness = Stiffness { bend: Some(BEND), ..membrane(2e5) };
        Ok(growth(strip, share * critical, Vec3::z(), 48))
    };
    let mut comparisons = buckling(growth_at)?;
    let beyond = growth_at(1.1)?;
    comparisons.push(Comparison::new("growth at 1.1 of the critical load", 3.0, beyond, Tolerance::AtLeast));
    Ok(comparisons)
}

fn column() -> Result<Vec<Comparison>, BuildError> {
    let critical = 7.8373 * BEND / DENSITY;
    let growth_at = |share: f64| -> Result<f64, BuildError> {
        let mut strip = Strip::new(Clamp::Bending, [50, 1], 0.05, [Vec3::y(), Vec3::z()], 1500.0)?;
        strip.fixture.cloth().stiffness = Stiffness { bend: Some(BEND), ..membrane(5e4) };
        Ok(growth(strip, share * critical, Vec3::x(), 0))
    };
    buckling(growth_at)
}

fn buckling(growth_at: impl Fn(f64) -> Result<f64, BuildError>) -> Result<Vec<Comparison>, BuildError> {
    Ok(vec![
        Comparison::new("growth at 0.95 of the critical load", 1.1, growth_at(0.95)?, Tolerance::AtMost),
        Comparison::new("growth at 1.05 of the critical load", 3.0, growth_at(1.05)?, Tolerance::AtLeast),
    ])
}
