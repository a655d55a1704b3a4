//! Friction and restitution, on the ground plane and on a cylinder.

use nucleus_core::{
    BuildError, Cloth, ClothLists, Collider, ColliderFrame, Faces, GroundPlane, Mass, ModelBuilder, Surface,
};

use super::case::{Case, Comparison, Fixture, Tolerance};
use crate::fixture::{DENSITY, GRAVITY, Vec3, membrane, sheet};

pub const CASES: &[Case] = &[
    Case {
        name: "incline",
        description: "A sheet of 10 cm lies on a plane with a slope of 1 in 2, so that a friction of 0.5 or more holds it. \
            Where it slides, its displacement after a second is (g / 2)(sin θ - μ cos θ).",
        known_failure: None,
        run: incline,
    },
    Case {
        name: "restitution",
        description: "A sheet is dropped from 1 m on a plane with a coefficient of restitution e: it rises to e².",
        known_failure: None,
        run: restitution,
    },
    Case {
        name: "capstan",
        description: "A ribbon lies over half a cylinder, with ends of different length. It slips when the tension of one end \
            exceeds exp(μ π) times that of the other (capstan equation), including the weight on the cylinder. The error \
            is that of the ribbon's elements, here of 2.4 mm: elements of 29 mm hold 31 % less, of 15 mm 8 %, of 7 mm 4 %.",
        known_failure: None,
        run: capstan,
    },
];

const THICKNESS: f64 = 0.001;
const LINKS: ClothLists = ClothLists { stretch: true, cross_links: true, ..ClothLists::NONE };

/// A sheet of 10 cm on a plane through the origin.
fn on_plane(normal: Vec3, friction: f64, height: f64) -> Result<Fixture, BuildError> {
    let along = Vec3::new(normal.y, -normal.x, 0.0);
    let origin = normal * (THICKNESS + height) - along * 0.05 - Vec3::z() * 0.05;
    let mut fixture = Fixture::new(sheet([5, 5], origin, Vec3::z() * 0.1, along * 0.1), LINKS, 480.0)?;
    fixture.cloth().stiffness = membrane(1e3);
    fixture.cloth().thickness = THICKNESS;
    fixture.cloth().friction = 0.0;
    fixture.frame.plane = Some(GroundPlane { friction, ..GroundPlane::new(Vec3::zeros(), normal) });
    Ok(fixture)
}

fn incline() -> Result<Vec<Comparison>, BuildError> {
    let normal = Vec3::new(1.0, 2.0, 0.0).normalize();
    let (sin, cos) = (normal.x, normal.y);
    let along = Vec3::new(normal.y, -normal.x, 0.0);
    let slid = |friction: f64| -> Result<f64, BuildError> {
        let mut fixture = on_plane(normal, friction, 0.0)?;
        let start = fixture.point(12);
        fixture.run(24);
        Ok((fixture.point(12) - start).dot(&along))
    };
    let way = |friction: f64| GRAVITY / 2.0 * (sin - friction * cos);
    let mut comparisons = vec![
        Comparison::new(
            "displacement at μ = 0.505 in a second, over the length",
            1e-4,
            slid(0.505)? / 0.1,
            Tolerance::AtMost,
        ),
        Comparison::new(
            "displacement at μ = 0.495 in a second, m",
            way(0.495),
            slid(0.495)?,
            Tolerance::Relative(0.01),
        ),
    ];
    for friction in [0.0, 0.2, 0.4] {
        let quantity = format!("displacement at μ = {friction} in a second, m");
        comparisons.push(Comparison::new(
            quantity,
            way(friction),
            slid(friction)?,
            Tolerance::Relative(0.01),
        ));
    }
    Ok(comparisons)
}

fn restitution() -> Result<Vec<Comparison>, BuildError> {
    let mut comparisons = Vec::new();
    for bounce in [0.3, 0.6, 0.9] {
        let mut fixture = on_plane(Vec3::y(), 0.0, 1.0)?;
        if let Some(plane) = &mut fixture.frame.plane {
            plane.bounce = bounce;
        }
        fixture.frame.duration /= 8.0;
        // It reaches the plane after 0.45 s and its apex e times that later.
        let first = (2.0 / GRAVITY).sqrt();
        let frames = |seconds: f64| (seconds / fixture.frame.duration) as u32;
        let (before, after) = (frames(first * 1.05), frames(first * bounce * 1.6));
        fixture.run(before);
        let mut highest = 0.0f64;
        for _ in 0..after {
            fixture.step();
            highest = highest.max(fixture.point(12).y - THICKNESS);
        }
        let quantity = format!("height after a bounce of {bounce}, m");
        comparisons.push(Comparison::new(quantity, bounce * bounce, highest, Tolerance::Relative(0.01)));
    }
    Ok(comparisons)
}

const RADIUS: f64 = 0.1;
const ROPE_FRICTION: f64 = 0.3;
/// Hanging length of the lighter side, in metres.
const SHORT: f64 = 0.1;

/// Creep below slipping, in metres per half second.
const MOST_CREEP: f64 = 5e-3;

/// Length of ribbon, in metres, in equilibrium with [`SHORT`]: dT/dφ = μ (T - w R cos φ) + w R sin φ over the upper half, φ from
/// the horizontal on the lighter side; the tension and the radial part of the weight press on the cylinder. w = 1.
fn long_side(radius: f64) -> f64 {
    let steps = 100_000;
    let h = std::f64::consts::PI / f64::from(steps);
    let slope = |phi: f64, pull: f64| {
        // The ribbon's weight adds to the tension on the way up and subtracts on the way down; the normal force is the
        // tension and the radial part of the weight.
        radius * phi.cos() + ROPE_FRICTION * (pull + radius * phi.sin())
    };
    (0..steps).fold(SHORT, |pull, step| {
        let phi = f64::from(step) * h;
        let middle = pull + h / 2.0 * slope(phi, pull);
        pull + h * slope(phi + h / 2.0, middle)
    })
}

fn capstan() -> Result<Vec<Comparison>, BuildError> {
    let radius = RADIUS + THICKNESS;
    let exact = long_side(radius);
    let held = |evaluations: f64| -> Result<Comparison, BuildError> {
        let (mut low, mut high) = (SHORT, 2.0 * exact);
        for _ in 0..10 {
            let middle = (low + high) / 2.0;
            if ribbon_slip(radius, middle, evaluations)? > MOST_CREEP { high = middle } else { low = middle }
        }
        let quantity = format!("longest end that is held at {evaluations} evaluations, m");
        Ok(Comparison::new(quantity, exact, (low + high) / 2.0, Tolerance::Relative(0.02)))
    };
    [480.0, 960.0].into_iter().map(held).collect()
}

fn ribbon_slip(radius: f64, long: f64, evaluations: f64) -> Result<f64, BuildError> {
    let length = SHORT + std::f64::consts::PI * radius + long;
    let columns = 361u32;
    // Laid out straight, then wound: so it is longer than its links by the difference of arc and chord, 1e-5.
    let mut ribbon = sheet([columns, 2], Vec3::zeros(), Vec3::x() * length, Vec3::z() * 0.01);
    for p in &mut ribbon.positions {
        let on = p.x - SHORT;
        let turned = (on / radius).clamp(0.0, std::f64::consts::PI);
        let below = on.min(0.0) - (on - std::f64::consts::PI * radius).max(0.0);
        *p = Vec3::new(-radius * turned.cos(), radius * turned.sin() + below, p.z);
        if on > std::f64::consts::PI * radius {
            p.y = -(on - std::f64::consts::PI * radius);
        }
    }
    let mut builder = ModelBuilder::new();
    let lists = ClothLists { damp: true, ..LINKS };
    builder.cloth(Cloth::new(ribbon.clone(), Mass::PerArea(DENSITY), lists))?;
    builder.collider(Collider { surface: cylinder() })?;
    let mut fixture = Fixture::from_builder(builder, ribbon, evaluations);
    fixture.cloth().stiffness = membrane(500.0);
    fixture.cloth().thickness = THICKNESS / 2.0;
    fixture.cloth().friction = ROPE_FRICTION;
    let thickness = THICKNESS / 2.0;
    fixture.frame.colliders =
        vec![ColliderFrame { collide: true, thickness, friction: 0.0, ..ColliderFrame::default() }];
    // Gravity ramps up over a second and the ribbon damps stretch, because a sudden load would bounce to twice the
    // weight.
    fixture.cloth().stretch_damp = 1.0;
    for frame in 1..=24 {
        fixture.frame.gravity = -Vec3::y() * GRAVITY * f64::from(frame) / 24.0;
        fixture.step();
    }
    fixture.run(6);
    let end = columns as usize - 1;
    let start = fixture.point(end).y;
    fixture.run(12);
    Ok(start - fixture.point(end).y)
}

/// A cylinder along z with 96 facets.
fn cylinder() -> Surface {
    let round = 96u32;
    let mut surface = Surface { positions: Vec::new(), faces: Faces::default() };
    for z in [-0.05, 0.06] {
        for k in 0..round {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(round)).sin_cos();
            surface.positions.push(Vec3::new(RADIUS * cos, RADIUS * sin, z));
        }
    }
    for k in 0..round {
        let next = (k + 1) % round;
        surface.faces.push(&[k, next, next + round, k + round]);
    }
    surface
}
