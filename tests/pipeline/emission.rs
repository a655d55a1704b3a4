//! Emitters, lifespans and fields, from a scene to its solved particles.

use nucleus_cache::Detail;
use nucleus_core::{ClothId, Particle};
use nucleus_graph::Simulation;
use nucleus_graph::scene::Scene;
use nucleus_tests::gallery::program_of;
use nucleus_tests::record;

const DROPS: ClothId = ClothId(0);

/// Particles at the end of a run: positions and ages.
type Found = (Vec<[f32; 3]>, Vec<Particle>);

fn found(simulation: &Simulation<f32>) -> Found {
    let (mut places, mut ages) = (Vec::new(), Vec::new());
    simulation.state().positions(DROPS, 1.0, &mut places);
    simulation.state().particles(DROPS, &mut ages);
    (places, ages)
}

/// Runs a scene of an emitter with these attributes for some frames.
fn run(particles: &str, emitter: &str, frames: usize, threads: usize) -> Found {
    let program = program_of(&nodes(particles, emitter));
    let mut simulation = Simulation::<f32>::new(&program, threads);
    for _ in 0..frames {
        let report = simulation.advance(&mut ()).report;
        assert!(report.finite && report.births_refused == 0, "{report:?}");
    }
    found(&simulation)
}

fn nodes(particles: &str, emitter: &str) -> String {
    format!(
        r#""n": nucleus(subSteps: 2, evaluations: 48, gravity: 0), "p": nParticle(drag: 0, selfCollide: false, {particles}),
           "e": pointEmitter(target: "p", {emitter})"#
    )
}

// EVIDENCE: N3.1-8  emitters, lifespans and fields come with the classic particle
#[test]
fn an_omni_emitter_emits_at_its_rate_on_spheres_that_grow_with_age() {
    let (places, ages) = run("", "emitterType: omni, rate: 240, speed: 3, translate: (1, 2, 3)", 24, 1);
    assert_eq!(places.len(), 240);
    for (place, age) in places.iter().zip(&ages) {
        let away = [place[0] - 1.0, place[1] - 2.0, place[2] - 3.0].map(f64::from);
        let distance = away.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((distance - 3.0 * age.age).abs() < 1e-4, "{distance} after {} s", age.age);
    }
    // Births are evenly spaced: a 240th of a second.
    assert!(ages.windows(2).all(|pair| (pair[0].age - pair[1].age - 1.0 / 240.0).abs() < 1e-9));
}

#[test]
fn a_cache_has_the_number_and_age_of_each_particle_though_their_order_changes() {
    let lives = "lifespanMode: randomRange, lifespan: 0.4, lifespanRandom: 0.3";
    let program = program_of(&nodes(lives, "emitterType: omni, rate: 120, speed: 3"));
    let recording = record(&program, 24, 1, Detail::Frames);
    let mut cache = recording.play();
    let (last, [before, after]) = (cache.time_samples().len() - 1, [1, 0]);
    let [then, now] = [before, after].map(|back| cache.particles(0, last - back).unwrap().unwrap());
    let [from, to] = [before, after].map(|back| cache.positions(0, last - back).unwrap());
    assert_eq!(now.len(), to.len());
    for (particle, expected) in now.iter().zip(found(&recording.simulation).1) {
        assert_eq!((particle.id, particle.mass as f32), (expected.id, expected.mass as f32));
        assert_eq!(
            [particle.age, particle.lifespan].map(|x| x as f32),
            [expected.age, expected.lifespan].map(|x| x as f32)
        );
    }
    // A particle is found again by its number: it flies at 3 m/s.
    let place = |id| then.iter().position(|one| one.id == id);
    let flights = now.iter().zip(&to).filter_map(|(one, to)| Some((to, &from[place(one.id)?])));
    let distances: Vec<f32> = flights
        .map(|(to, from)| (0..3).map(|axis| (to[axis] - from[axis]).powi(2)).sum::<f32>().sqrt())
        .collect();
    assert!(distances.len() > 30 && now.iter().enumerate().any(|(at, one)| place(one.id) != Some(at)));
    assert!(distances.iter().all(|distance| (distance - 0.125).abs() < 1e-4), "{distances:?}");
}

#[test]
fn a_particle_that_is_due_at_the_end_of_a_frame_is_born_in_it() {
    for rate in [1, 7, 100, 1000] {
        let emitter = format!("emitterType: omni, rate: {rate}");
        assert_eq!(run("", &emitter, 24, 1).0.len(), rate, "a rate of {rate}");
    }
}

#[test]
fn equal_seeds_give_equal_bits_and_other_seeds_others() {
    let emitter = "emitterType: directional, direction: (0, 1, 0), spread: 0.3, rate: 100, speedRandom: 0.5";
    let of = |seed: u32, threads| run(&format!("seed: {seed}"), emitter, 12, threads).0;
    assert_eq!(of(3, 1), of(3, 2));
    assert_ne!(of(3, 1), of(4, 1));
}

#[test]
fn emission_resumes_with_the_same_bits() {
    let program = program_of(&nodes(
        "lifespanMode: constant, lifespan: 0.3",
        "emitterType: volume, volumeShape: torus, rate: keys([(1, 0), (12, 300)]), randomDirection: 1",
    ));
    let mut whole = Simulation::<f32>::new(&program, 1);
    (0..9).for_each(|_| _ = whole.advance(&mut ()));
    let mut resumed = Simulation::<f32>::restored(&program, 2, &whole.save()).expect("its own checkpoint");
    for _ in 0..9 {
        whole.advance(&mut ());
        resumed.advance(&mut ());
        assert_eq!(found(&whole), found(&resumed));
    }
    assert!(!found(&whole).0.is_empty());
}

#[test]
fn lifespans_are_forever_constant_or_in_a_range() {
    let emitter = "emitterType: omni, rate: 480";
    let ages = |mode: &str| run(mode, emitter, 24, 1).1;
    assert_eq!(ages("").len(), 480);
    // A particle dies at the end of the substep in which its time comes.
    let constant = ages("lifespanMode: constant, lifespan: 0.5");
    assert!(constant.iter().all(|one| one.age < 0.5), "{constant:?}");
    assert!((constant.len() as f64 - 240.0).abs() <= 10.0, "{}", constant.len());
    let range = ages(r#"lifespanMode: "Random range", lifespan: 0.5, lifespanRandom: 0.4"#);
    assert!(range.iter().all(|one| (0.3..=0.7).contains(&one.lifespan)));
    let mean = range.iter().map(|one| one.lifespan).sum::<f64>() / range.len() as f64;
    assert!(range.iter().any(|one| one.lifespan < 0.4) && mean > 0.5, "the longer-lived are more: {mean}");
}

#[test]
fn particles_take_a_share_of_the_emitters_motion() {
    for share in [0.0, 1.0] {
        let (places, ages) = run(
            &format!("inheritFactor: {share}"),
            "emitterType: omni, speed: 0, rate: 48, translate: keys([(1, (0, 0, 0)), (25, (24, 0, 0))])",
            24,
            1,
        );
        for (place, age) in places.iter().zip(&ages) {
            let birth = 24.0 * (1.0 - age.age);
            let expected = birth + share * 24.0 * age.age;
            assert!((f64::from(place[0]) - expected).abs() < 1e-3, "{} for {expected}", place[0]);
        }
    }
}

#[test]
fn a_surface_emits_by_its_area_along_its_normals() {
    let program = program_of(
        r#""n": nucleus(gravity: 0), "plane": polyPlane(width: 4, height: 2, translate: (0, 1, 0)),
           "p": nParticle(drag: 0, selfCollide: false),
           "e": pointEmitter(target: "p", parent: "plane", emitterType: surface, rate: 30, normalSpeed: 2)"#,
    );
    let mut simulation = Simulation::<f32>::new(&program, 1);
    (0..24).for_each(|_| _ = simulation.advance(&mut ()));
    let (places, ages) = found(&simulation);
    assert_eq!(places.len(), 240, "30 per second and unit of area");
    for (place, age) in places.iter().zip(&ages) {
        assert!((f64::from(place[1]) - 1.0 - 2.0 * age.age).abs() < 1e-4);
        assert!(place[0].abs() <= 2.0 && place[2].abs() <= 1.0);
    }
    assert!(places.iter().any(|p| p[0] > 1.0) && places.iter().any(|p| p[0] < -1.0));
}

#[test]
fn a_full_object_emits_again_when_particles_die() {
    let program = program_of(&nodes(
        "maxCount: 10, lifespanMode: constant, lifespan: 0.5",
        "emitterType: omni, rate: 100",
    ));
    let mut simulation = Simulation::<f32>::new(&program, 1);
    let mut refused = 0;
    for _ in 0..48 {
        let report = simulation.advance(&mut ()).report;
        assert!(report.particles <= 10);
        refused += report.births_refused;
    }
    assert!(refused > 100, "{refused}");
    let (_, ages) = found(&simulation);
    assert_eq!(ages.len(), 10);
    assert!(ages[0].id >= 30, "the fourth generation: {ages:?}");
}

#[test]
fn a_rotating_emitter_turns_its_direction_within_a_frame() {
    for (kind, direction) in [
        ("emitterType: directional, spread: 0", ""),
        ("emitterType: volume, volumeShape: sphere, awayFromCenter: 0", ", directionalSpeed: 1"),
    ] {
        let turning = "rotateZ: keys([(1, 0), (25, 360)]), direction: (1, 0, 0), rate: 240, speed: 1";
        let program = program_of(&nodes("", &format!("{kind}, {turning}{direction}")));
        let mut simulation = Simulation::<f32>::new(&program, 1);
        (0..24).for_each(|_| _ = simulation.advance(&mut ()));
        let mut velocities = Vec::new();
        simulation.state().velocities(DROPS, 1.0, &mut velocities);
        let ages = found(&simulation).1;
        assert_eq!(velocities.len(), 240);
        for (velocity, particle) in velocities.iter().zip(&ages) {
            let turned = f64::from(velocity[1]).atan2(f64::from(velocity[0])).to_degrees();
            // A whole turn in a second; the chord of 15 degrees deviates by 0.02 from even turning.
            let off = (turned - 360.0 * (1.0 - particle.age) + 540.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 0.03, "{kind}: {off} degrees at an age of {}", particle.age);
        }
    }
}

// Particles that follow each other along one line stayed on it, and stood on each other to far above the emitter.
#[test]
fn what_an_emitter_pours_straight_down_spreads_on_the_ground() {
    for kind in ["enableSPH: true, pointMass: 0.00026", "pointMass: 0.001, friction: 0"] {
        let program = program_of(&format!(
            r#""n": nucleus(spaceScale: 0.01, usePlane: true), "p": nParticle(drag: 0, radius: 0.5, {kind}),
               "e": pointEmitter(target: "p", emitterType: directional, direction: (0, -1, 0), translateY: 10,
                   rate: 200, speed: 50)"#
        ));
        let mut simulation = Simulation::<f32>::new(&program, 1);
        (0..24).for_each(|_| _ = simulation.advance(&mut ()));
        let mut places = Vec::new();
        simulation.state().positions(DROPS, 100.0, &mut places);
        let highest = places.iter().map(|place| place[1]).fold(0.0, f32::max);
        let widest = places.iter().map(|place| place[0].hypot(place[2])).fold(0.0, f32::max);
        assert!(places.len() > 150, "{kind}: {}", places.len());
        assert!(highest < 12.0 && widest > 4.0, "{kind}: {highest} high, {widest} wide");
    }
}

/// The errors of compiling a scene.
fn errors(nodes: &str) -> String {
    let text = format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{ {nodes} }})");
    let read = nucleus_graph::scene::read_scene_text(&text, std::path::Path::new("test.ron"));
    let compiled =
        read.and_then(|(scene, _): (Scene, _)| nucleus_graph::compile::compile(&scene).map(|_| ()));
    compiled.expect_err("an error").iter().map(|error| format!("{}\n", error.message)).collect()
}

#[test]
fn absurd_emitters_are_refused_with_the_reason() {
    let rate = errors(&nodes("", "emitterType: omni, rate: 1e12"));
    assert!(rate.contains("particles, takes about") && rate.contains("the limit is"), "{rate}");
    let negative = errors(&nodes("lifespanMode: constant, lifespan: -1", "emitterType: omni"));
    assert!(negative.contains("lifespan"), "{negative}");
    let no_mesh = errors(&nodes("", "emitterType: surface"));
    assert!(no_mesh.contains("no mesh is its parent"), "{no_mesh}");
    let curve = errors(&nodes("", "emitterType: curve"));
    assert!(curve.contains("curve"), "{curve}");
}

#[test]
fn fields_of_a_scene_move_its_particles_and_its_cloth() {
    let program = program_of(
        r#""n": nucleus(spaceScale: 0.01, gravity: 0, airDensity: 0), "plane": polyPlane(),
           "c": nCloth(inputMesh: "plane", collide: false), "p": nParticle(position: [(5, 0, 0)], collide: false),
           "f": gravityField(target: "c", magnitude: 48, direction: (0, 1, 0)),
           "g": gravityField(target: "p", magnitude: 24, direction: (0, 0, 1))"#,
    );
    let mut simulation = Simulation::<f32>::new(&program, 1);
    (0..24).for_each(|_| _ = simulation.advance(&mut ()));
    let of = |cloth: u32| {
        let mut out = Vec::new();
        simulation.state().velocities(ClothId(cloth), 100.0, &mut out);
        out[0]
    };
    // Scene units per second after a second, as in Maya's classic dynamics.
    assert!((of(0)[1] - 48.0).abs() < 0.01, "{:?}", of(0));
    assert!((of(1)[2] - 24.0).abs() < 0.01, "{:?}", of(1));
}
