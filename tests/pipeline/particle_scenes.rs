//! What the scenes of particles and liquids show, measured.

use nalgebra::Vector3;
use nucleus_core::{ClothId, Particle, ParticleLook};
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;
use nucleus_tests::gallery::{changed, program_of};

type Vec3 = Vector3<f64>;

const FIRST: ClothId = ClothId(0);

/// Particles at the end of a frame, in scene units.
struct Particles {
    places: Vec<Vec3>,
    ages: Vec<Particle>,
    looks: Vec<ParticleLook>,
}

impl Particles {
    /// The first object after `frames` frames.
    fn of(program: &Program, frames: usize) -> Self {
        let mut run = Simulation::<f32>::new(program, 1);
        (0..frames).for_each(|_| _ = run.advance(&mut ()));
        let (mut places, mut ages, mut looks) = (Vec::new(), Vec::new(), Vec::new());
        run.state().positions(FIRST, run.units_per_metre(), &mut places);
        run.state().particles(FIRST, &mut ages);
        run.state().looks(FIRST, &mut looks);
        Self { places: places.iter().map(|&place| Vec3::from(place.map(f64::from))).collect(), ages, looks }
    }

    /// Mean height, and mean distance from the vertical axis, of the particles of such ages.
    fn plume(&self, ages: std::ops::Range<f64>) -> [f64; 2] {
        let all = self.places.iter().zip(&self.ages).filter(|(_, one)| ages.contains(&one.age));
        let found: Vec<_> = all.map(|(place, _)| *place).collect();
        assert!(found.len() > 50, "{ages:?}: {}", found.len());
        let mean = |of: fn(&Vec3) -> f64| found.iter().map(of).sum::<f64>() / found.len() as f64;
        [mean(|place| place.y), mean(|place| place.x.hypot(place.z))]
    }
}

// EVIDENCE: N1.2-9  smoke rises, widens and is as much as its source and lifespan say; without an updraught it stays low
#[test]
fn smoke_rises_and_widens_with_its_age() {
    let smoke = Particles::of(&changed("particles/smoke", &[]), 84);
    // 500 a second, of which each lives 2 s on average.
    assert!((smoke.places.len() as f64 / 1000.0 - 1.0).abs() < 0.1, "{}", smoke.places.len());
    let [[low, narrow], [high, wide]] = [0.0..0.3, 1.2..1.6].map(|ages| smoke.plume(ages));
    assert!(high > low + 20.0 && wide > 1.3 * narrow, "{low} to {high}, {narrow} to {wide}");
    let [still, _] =
        Particles::of(&changed("particles/smoke", &[("magnitude: 150", "magnitude: 0")]), 84).plume(1.2..1.6);
    assert!(still < 0.5 * high, "{still}, not {high}");
}

#[test]
fn the_water_of_the_splash_closes_over_the_ball() {
    let splash = Particles::of(&changed("liquids/splash", &[]), 29);
    // The ball stops at a height of 2.6 and has a radius of 1.6; a layer of particles over it has 14.
    let above = splash.places.iter().filter(|place| place.x.hypot(place.z) < 1.6 && place.y > 4.2);
    let count = above.count();
    assert!(count >= 14, "{count} particles are above the ball");
}

// EVIDENCE: N1.2-10  the opacity of fire is that of its ramp at the age of each particle, and ends at nothing
#[test]
fn fire_fades_as_it_ages() {
    let fire = Particles::of(&changed("particles/fire", &[]), 48);
    assert!(fire.looks.len() > 500 && fire.looks.len() == fire.ages.len());
    for (look, one) in fire.looks.iter().zip(&fire.ages) {
        let age = one.age / one.lifespan;
        let ramp = if age < 0.5 { 0.5 + 0.2 * age } else { 1.2 * (1.0 - age) };
        assert!((f64::from(look.opacity) - ramp).abs() < 0.01, "{} at {age}", look.opacity);
    }
    let glow = |ages: std::ops::Range<f64>| {
        let young =
            fire.looks.iter().zip(&fire.ages).filter(|(_, one)| ages.contains(&(one.age / one.lifespan)));
        young.map(|(look, _)| look.incandescence[0]).fold(0.0f32, f32::max)
    };
    assert!(glow(0.0..0.2) > 0.9 && glow(0.9..1.0) == 0.0, "{} {}", glow(0.0..0.2), glow(0.9..1.0));
}

// EVIDENCE: N1.2-15  balls that are welded as they lie at the start stay a rigid body while it tumbles
#[test]
fn cubes_of_balls_tumble_as_rigid_bodies() {
    let cubes = changed("particles/rigid_bodies", &[]);
    let [start, end] = [0, 40].map(|frames| Particles::of(&cubes, frames).places);
    for cube in 0..3 {
        let mut turned = f64::INFINITY;
        for a in 27 * cube..27 * (cube + 1) {
            for b in a + 1..27 * (cube + 1) {
                let [before, after] = [&start, &end].map(|places| places[a] - places[b]);
                assert!((after.norm() / before.norm() - 1.0).abs() < 0.01, "{a} and {b}: {before} {after}");
                turned = turned.min(before.dot(&after) / (before.norm() * after.norm()));
            }
        }
        assert!(turned < 0.98, "cube {cube} has turned by more than eleven degrees: {turned}");
    }
}

/// The period of small swings of a hanging chain of length L is 2 π / (1.2024 √(g / L)) (Bernoulli 1733: half the first
/// zero of the Bessel function J0).
// EVIDENCE: N1.2-16  a string of particles hangs, and swings like a chain
#[test]
fn a_string_of_particles_swings_with_the_period_of_a_hanging_chain() {
    const LINKS: usize = 20;
    let places: String = (0..=LINKS)
        .map(|k| {
            // The first mode of the chain to first order, at 3 cm at its end.
            let down = k as f64 / LINKS as f64;
            format!("({}, {}, 0),", 0.03 * down * (2.0 + down) / 3.0, -down)
        })
        .collect();
    let program = program_of(&format!(
        r#""n": nucleus(subSteps: 8, evaluations: 480, airDensity: 0),
           "string": nParticle(position: [{places}], radius: 0.01, pointMass: 0.01, drag: 0, selfCollide: false),
           "links": dynamicConstraint(constraintType: pointToPoint, constraintMethod: weld, components: ["string.vtx[0:{LINKS}]"],
               connectionMethod: componentOrder, connectWithinComponent: true),
           "nail": dynamicConstraint(constraintType: transform, components: ["string.vtx[0]"])"#
    ));
    let mut run = Simulation::<f32>::new(&program, 1);
    let mut end = |_| {
        run.advance(&mut ());
        let end = run.state().point(FIRST, LINKS);
        assert!((end.norm() - 1.0).abs() < 0.01, "it hangs at its length: {end}");
        end.x
    };
    let film: Vec<f64> = (1..=120).map(&mut end).collect();
    // Times at which its end passes the middle towards negative x.
    let passes: Vec<f64> = (1..film.len())
        .filter(|&k| film[k - 1] > 0.0 && film[k] <= 0.0)
        .map(|k| (k as f64 + film[k - 1] / (film[k - 1] - film[k])) / 24.0)
        .collect();
    let period = (passes[passes.len() - 1] - passes[0]) / (passes.len() - 1) as f64;
    let theory = std::f64::consts::TAU / (1.2024 * 9.8f64.sqrt());
    assert!((period / theory - 1.0).abs() < 0.03, "{period} s, not {theory}");
}

/// A body with a radius of 10 cm, and the part of a place that counts for its distance from the middle.
type Body = (&'static str, fn(&Vec3) -> Vec3);

const BODIES: [Body; 2] = [
    ("polySphere(radius: 10, subdivisions: (48, 32))", |place| *place),
    ("polyCylinder(radius: 10, height: 30, subdivisions: (64, 1, 1), rotate: (90, 0, 0))", |place| {
        Vec3::new(place.x, place.y, 0.0)
    }),
];

// EVIDENCE: N1.2-14  a drop runs down a sphere and a cylinder, along the surface all the way, and holds together
#[test]
fn a_drop_runs_along_curved_surfaces_and_stays_on_them() {
    for (body, outwards) in BODIES {
        let program = program_of(&format!(
            r#""n": nucleus(spaceScale: 0.01, evaluations: 24),
               "ball": polySphere(radius: 0.8, translate: (3.2, 10.7, 0)),
               "drop": nParticle(enableSPH: true, fillMesh: "ball", radius: 0.2, collideWidthScale: 0.6, selfCollide: false,
                   pointMass: 0.00002, surfaceTension: 0.3, friction: 0, drag: 0),
               "mesh": {body}, "body": nRigid(inputMesh: "mesh", friction: 0, thickness: 0.02)"#
        ));
        let mut angles = Vec::new();
        for frames in [0, 2, 4] {
            let places = Particles::of(&program, frames).places;
            let middle = places.iter().sum::<Vec3>() / places.len() as f64;
            angles.push(middle.x.atan2(middle.y));
            for place in &places {
                let height = outwards(place).norm() - 10.0;
                assert!(
                    (-0.05..1.9).contains(&height),
                    "{body}, after {frames} frames: {height} cm above the surface"
                );
                assert!((place - middle).norm() < 2.0, "{body}: {place} has left the drop at {middle}");
            }
        }
        assert!(angles.is_sorted_by(|a, b| *b > a + 0.05), "{body}: it runs down: {angles:?}");
    }
}
