//! Fields, emitters, constraints and events: from node to motion, and warnings of those that act on nothing.

use std::path::Path;

use nucleus_graph::compile::{Program, compile};
use nucleus_graph::first_frame_warnings;
use nucleus_graph::scene::read_scene_text;

use super::scenes::{after, of_nodes, png, program};

/// Where the points of an object are after some frames, in scene units.
fn places(program: &Program, frames: usize, object: &str) -> Vec<[f32; 3]> {
    after(program, frames, object).into_iter().map(|place| place.map(f32::from_bits)).collect()
}

/// Where the points of `q` are after some frames.
fn moved(nodes: &str, frames: usize) -> Vec<[f32; 3]> {
    places(&program(&of_nodes(nodes, "")), frames, "q")
}

/// All warnings of some nodes.
fn warnings(nodes: &str, connections: &str) -> Vec<String> {
    let text = of_nodes(nodes, connections);
    let (scene, mut diagnostics) = read_scene_text(&text, Path::new("test.ron")).expect("it can be read");
    diagnostics.extend(compile(&scene).expect("it runs").warnings().iter().cloned());
    diagnostics.into_iter().map(|diagnostic| diagnostic.message).collect()
}

#[test]
fn cloth_moves_alike_in_a_field_at_any_resolution() {
    let height = |field: &str, cells: u32, mass: f64| {
        let nodes = format!(
            r#""n": nucleus(gravity: 0, airDensity: 0), "m": polyPlane(subdivisions: ({cells}, {cells})),
            "q": nCloth(inputMesh: "m", selfCollide: false, pointMass: {mass}), "f": {field}"#
        );
        let places = moved(&nodes, 6);
        places.iter().map(|place| place[1]).sum::<f32>() / places.len() as f32
    };
    let uniform = r#"uniformField(target: "q", magnitude: 3, direction: (0, 1, 0))"#;
    let gravity = r#"gravityField(target: "q", magnitude: 6, direction: (0, 1, 0))"#;
    let expected = height(gravity, 4, 0.5);
    assert!(expected > 0.1, "{expected}");
    for cells in [4, 12, 24] {
        let found = height(uniform, cells, 0.5);
        assert!(
            (found / expected - 1.0).abs() < 1e-3,
            "force over mass, with {cells}²: {found} for {expected}"
        );
    }
    assert!((height(uniform, 12, 1.0) / expected - 0.5).abs() < 1e-3, "and half with twice the mass");
}

#[test]
fn a_particle_collides_in_the_frame_in_which_it_bounces() {
    for model in ["classic", "physical"] {
        let last = |bounce: f64| {
            let nodes = format!(
                r#""n": nucleus(usePlane: true, resistanceModel: {model}, planeFriction: 0), "q": nParticle(position:
                [(0, 1, 0)], radius: 0.05, bounce: {bounce}, eventCount: [1], eventDie: [1])"#
            );
            let program = program(&of_nodes(&nodes, ""));
            (1..24).find(|&frames| places(&program, frames, "q").is_empty())
        };
        let at_rest = last(0.0);
        assert!(at_rest.is_some_and(|frame| (10..13).contains(&frame)), "{model}: {at_rest:?}");
        for bounce in [0.1, 0.5, 0.8, 1.0] {
            assert_eq!(last(bounce), at_rest, "{model}, bounce {bounce}");
        }
    }
}

#[test]
fn a_particle_that_bounces_off_another_and_off_cloth_collides() {
    let other = r#""r": nParticle(position: [(0, 0, 0)], radius: 0.05, pointMass: 100, bounce: 0.8)"#;
    let cloth = r#""m": polyPlane(subdivisions: (4, 4)), "r": nCloth(inputMesh: "m", thickness: 0.05, bounce: 0.8),
        "k": dynamicConstraint(components: ["r"])"#;
    for obstacle in [other, cloth] {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0.01, 1, 0.02)], velocity: [(0, -4, 0)], radius: 0.05,
            bounce: 0.8, eventCount: [1], eventDie: [1]), {obstacle}"#
        );
        assert_eq!([moved(&nodes, 4).len(), moved(&nodes, 12).len()], [1, 0], "{obstacle}");
    }
}

#[test]
fn a_field_of_no_reach_acts_on_nothing_and_is_warned_of() {
    for (field, distance) in [("turbulenceField", "0"), ("dragField", "0"), ("uniformField", "-1")] {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0, 0, 0), (1, 0, 0)]), "f": {field}(target: "q",
            magnitude: 5, useMaxDistance: true, maxDistance: {distance})"#
        );
        assert_eq!(moved(&nodes, 3), [[0.0; 3], [1.0, 0.0, 0.0]], "{field}");
    }
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)]), "f": gravityField(target: "q",
        useMaxDistance: true)"#;
    assert_eq!(warnings(nodes, ""), ["`f` acts on nothing: its `maxDistance` is not above zero"]);
}

#[test]
fn emission_keeps_its_rate_on_a_scaled_clock() {
    for scale in [0.5, 1.0, 4.0, 10.0] {
        let nodes = format!(
            r#""n": nucleus(gravity: 0, timeScale: {scale}), "e": pointEmitter(target: "q", rate: 24),
            "q": nParticle(selfCollide: false)"#
        );
        let born = moved(&nodes, 24).len() as f64;
        assert!((born - 24.0 * scale).abs() <= 1.0, "{scale}: {born}");
    }
}

#[test]
fn a_particle_shields_others_from_the_wind() {
    let speed = |distance: f64| {
        let nodes = format!(
            r#""n": nucleus(gravity: 0, windSpeed: 5), "q": nParticle(position: [(2, 0.05, 0.05)], radius: 0.05, drag: 0.5),
            "r": nParticle(position: [(0, 0, 0)], radius: 1, pointMass: 1000, drag: 0, windShadowDistance: {distance})"#
        );
        moved(&nodes, 8)[0][0] - 2.0
    };
    assert!(speed(30.0) < 0.5 * speed(0.0), "{} {}", speed(30.0), speed(0.0));
}

/// How far a point under a held sheet slides along x in 15 frames, pulled with the weight of 10 m/s².
fn slid(model: &str, surface: &str, z: f64, friction: f64) -> f32 {
    let nodes = format!(
        r#""n": nucleus(gravityDirection: (1, 0, 0), resistanceModel: {model}), "m": polyPlane(width: 10, height: 10,
        subdivisions: (10, 10)), {surface}, "q": nParticle(position: [(0.01, -0.1, {z})], radius: 0.01),
        "k": dynamicConstraint(constraintType: slideOnSurface, components: ["c", "q"], strength: 20, friction: {friction})"#
    );
    moved(&nodes, 15)[0][0] - 0.01
}

const HELD_SHEET: &str = r#""c": nCloth(inputMesh: "m"), "p": dynamicConstraint(components: ["c"])"#;

#[test]
fn friction_of_a_sliding_point_locks_it_in_both_models_over_faces_and_edges() {
    for (model, surface) in [
        ("physical", HELD_SHEET),
        ("physical", r#""c": nRigid(inputMesh: "m")"#),
        ("classic", r#""c": nRigid(inputMesh: "m")"#),
    ] {
        assert!(slid(model, surface, 0.2, 0.0) > 1.5, "{model}: free without friction");
        for z in [0.0, 0.002, 0.2] {
            let found = slid(model, surface, z, 1.0);
            assert!(found.abs() < 0.02, "{model}, {surface}, z {z}: {found}");
        }
    }
}

/// The height of a point 0.3 below a held sheet after 15 frames of free fall.
fn held_by(constraint: &str) -> f32 {
    let nodes = format!(
        r#""n": nucleus(), "m": polyPlane(subdivisions: (6, 6)), {HELD_SHEET}, "q": nParticle(position: [(0.03, -0.3, 0.02)],
        radius: 0.01, selfCollide: false), "k": dynamicConstraint(components: ["c", "q"], {constraint})"#
    );
    moved(&nodes, 15)[0][1]
}

#[test]
fn strength_over_distance_and_the_largest_distance_hold_for_links_to_surfaces() {
    for kind in ["pointToSurface", "slideOnSurface"] {
        let held = |fields: &str| held_by(&format!("constraintType: {kind}, strength: 20, {fields}"));
        assert!(held("") > -0.4, "{kind}: {}", held(""));
        assert!(held("strengthDropoff: [(0, 0), (1, 0)]") < -1.5, "{kind}: without strength it falls");
        assert!(held("connectionMethod: withinMaxDistance, maxDistance: 0.01") < -1.5, "{kind}: too far");
        let near = held("connectionMethod: withinMaxDistance, maxDistance: 0.5");
        assert!(near > -0.4, "{kind}: near enough, {near}");
        assert!(held("connectionDensity: 0") < -1.5, "{kind}: no link is kept");
    }
}

/// How far a volume axis field moves points at some places along an axis in 6 frames.
fn by_volume_axis(fields: &str, places: &str, axis: usize) -> Vec<f32> {
    let nodes = |magnitude: u32| {
        format!(
            r#""n": nucleus(gravity: 0, airDensity: 0), "f": volumeAxisField(target: "q", magnitude: {magnitude}, {fields}),
            "q": nParticle(position: [{places}], radius: 0.01, selfCollide: false)"#
        )
    };
    let (at_rest, pushed) = (moved(&nodes(0), 6), moved(&nodes(2), 6));
    at_rest.iter().zip(pushed).map(|(from, to)| to[axis] - from[axis]).collect()
}

#[test]
fn a_volume_axis_field_pushes_from_the_centre_of_round_volumes_and_from_the_axis_of_long_ones() {
    let across = |shape: &str| by_volume_axis(&format!("volumeShape: {shape}"), "(0.4, 0, 0)", 0)[0];
    let along = |shape: &str| by_volume_axis(&format!("volumeShape: {shape}"), "(0, 0.4, 0)", 1)[0];
    assert!(across("sphere") > 0.01);
    assert!(
        (across("sphere") / along("sphere") - 1.0).abs() < 1e-3,
        "{} {}",
        across("sphere"),
        along("sphere")
    );
    assert!((across("cylinder") / across("sphere") - 1.0).abs() < 1e-3);
    assert_eq!(along("cylinder"), 0.0);
}

#[test]
fn a_volume_axis_field_falls_off_in_its_volume_and_inverted_towards_the_axis() {
    let along = |inverted: bool| {
        let fields = format!(
            "attenuation: 1, volumeShape: cylinder, awayFromAxis: 0, alongAxis: 1, scale: (2, 2, 2), invertAttenuation: {inverted}"
        );
        by_volume_axis(&fields, "(0.5, 0, 0), (1.5, 0, 0)", 1)
    };
    let (plain, inverted) = (along(false), along(true));
    assert!((plain[0] / plain[1] - 3.0).abs() < 0.01, "{plain:?}");
    assert!((inverted[1] / inverted[0] - 3.0).abs() < 0.01, "{inverted:?}");
}

#[test]
fn a_newton_field_does_not_act_within_its_smallest_distance() {
    let nodes = r#""n": nucleus(gravity: 0, airDensity: 0), "f": newtonField(target: "q", magnitude: 5, minDistance: 2),
        "q": nParticle(position: [(1, 0, 0), (3, 0, 0)], radius: 0.01)"#;
    let places = moved(nodes, 4);
    assert!(places[0][0] == 1.0 && places[1][0] < 2.99, "{places:?}");
}

/// Where particles are after a second at a number of frames per second, with an evaluation every so many frames.
fn after_a_second(nodes: &str, fps: u32, every: f64) -> Vec<[f32; 3]> {
    let text = format!("Scene(time: (start: 0, end: {fps}, fps: {fps}, every: {every}), nodes: {{{nodes}}})");
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it can be read");
    let program = compile(&scene).expect("it compiles");
    places(&program, fps as usize, "q")
}

#[test]
fn the_motion_of_a_second_does_not_depend_on_the_number_of_its_frames() {
    let gusts = r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0.3, 0.2, 0.1)], drag: 0, collide: false),
        "f": volumeAxisField(target: "q", volumeShape: sphere, scale: (9, 9, 9), awayFromCenter: 0, turbulence: 1, turbulenceSpeed: 2)"#;
    let at = |fps: u32, every: f64| after_a_second(gusts, fps, every)[0];
    let at_24 = at(24, 1.0);
    for (fps, every) in [(24, 0.5), (48, 1.0), (96, 1.0)] {
        let other = at(fps, every);
        let apart = (0..3).map(|k| (other[k] - at_24[k]).abs()).fold(0.0, f32::max);
        assert!(apart < 0.02, "{fps}, {every}: {other:?}, {at_24:?}");
    }
    let slowed = r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0, 0, 0)], velocity0: [(3, 0, 0)], drag: 0, conserve: 0.95)"#;
    let [whole, half] = [1.0, 0.5].map(|every| after_a_second(slowed, 24, every)[0][0]);
    assert!((whole - half).abs() < 0.03, "{whole}, {half}");
}

#[test]
fn a_whole_object_is_excluded_with_the_particles_that_are_yet_to_be_born() {
    let lowest = |hold: &str| {
        let nodes = format!(
            r#""n": nucleus(usePlane: true), "e": pointEmitter(target: "q", rate: 96, speed: 0, translateY: 0.5),
            "q": nParticle(selfCollide: false, radius: 0.01){hold}"#
        );
        moved(&nodes, 24).iter().map(|place| place[1]).fold(f32::INFINITY, f32::min)
    };
    let excluded = lowest(r#", "x": dynamicConstraint(type: disableCollision, components: ["q"])"#);
    assert!(lowest("") > 0.0 && excluded < -1.0, "{excluded}");
}

#[test]
fn the_general_seed_draws_the_lifespans_of_emitted_particles() {
    let left = |seed: u32| {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "e": pointEmitter(target: "q", rate: 96), "q": nParticle(selfCollide: false,
            lifespanMode: randomRange, lifespan: 0.5, lifespanRandom: 0.8, generalSeed: {seed})"#
        );
        moved(&nodes, 24)
    };
    assert_eq!(left(5), left(5));
    assert!(left(0) != left(5) && left(5) != left(6));
}

#[test]
fn nodes_that_act_on_nothing_are_warned_of() {
    let base = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)], radius: 0.1)"#;
    let sheet = r#""m": polyPlane(), "c": nCloth(inputMesh: "m")"#;
    let cases = [
        (r#""e": pointEmitter(rate: 100)"#, "`e` emits into no particles"),
        (r#""f": uniformField(target: "q", magnitude: 5)"#, "`f` acts on nothing: its `direction` is zero"),
        (r#""f": vortexField(target: "q", axis: (0, 0, 0))"#, "`f` acts on nothing: its `axis` is zero"),
        (
            r#""f": airField(target: "q", direction: (1, 0, 0), magnitude: 5)"#,
            "`f` acts on nothing: its `speed` is zero",
        ),
        (
            r#""f": airField(target: "q", direction: (1, 0, 0), magnitude: 5, speed: 1, enableSpread: true)"#,
            "`f` acts on nothing: its `spread` is zero",
        ),
        (
            r#""f": dragField(target: "q", useDirection: true)"#,
            "`f` acts on nothing: its `direction` is zero",
        ),
        (
            r#""f": volumeAxisField(target: "q", volumeShape: cylinder, awayFromAxis: 0, awayFromCenter: 5)"#,
            "`f` acts on nothing: none of its speeds has an effect in its volume",
        ),
        (
            r#""f": volumeAxisField(target: "q", volumeShape: sphere, awayFromAxis: 5, awayFromCenter: 0)"#,
            "`f` acts on nothing: none of its speeds has an effect in its volume",
        ),
        (
            r#""b": nRigid(inputMesh: "m2"), "m2": polyCube(), "f": gravityField(target: "b", direction: (0, 1, 0))"#,
            "`f` acts on colliders only, which no force moves",
        ),
        (
            r#""b": nRigid(inputMesh: "m2"), "m2": polyCube(), "k": dynamicConstraint(type: transform, components: ["b"])"#,
            "`k` holds colliders only, which no constraint moves",
        ),
        (
            r#""f": airField(target: "q", direction: (0, 0, 0), inheritVelocity: 0, componentOnly: true)"#,
            "`f` acts on nothing: its `direction` is zero",
        ),
    ];
    for air in ["inheritVelocity: 1, componentOnly: true", "inheritVelocity: 0, componentOnly: false"] {
        let nodes = format!(r#"{base}, "f": airField(target: "q", direction: (0, 0, 0), speed: 1, {air})"#);
        assert!(warnings(&nodes, "").is_empty(), "{air}");
    }
    for (node, expected) in cases {
        assert_eq!(warnings(&format!("{base}, {sheet}, {node}"), ""), [expected]);
    }
    let nodes = r#""n": nucleus(), "a": nParticle(position: [(0, 0, 0)], radius: 0.1), "x": nComponent(componentType: point,
        elements: all), "k": dynamicConstraint(constraintType: pointToPoint)"#;
    let connections = r#"("a.nucleusId", "x.objectId"), ("x.outComponent", "k.componentIds[0]")"#;
    assert_eq!(warnings(nodes, connections), ["`k` constrains nothing: it has no nucleus"]);
}

#[test]
fn a_constraint_that_joins_nothing_is_warned_of() {
    let found = |constraint: &str| {
        let nodes = format!(
            r#""n": nucleus(), "m": polyPlane(width: 1, height: 1, subdivisions: (4, 4)), "c": nCloth(inputMesh: "m", thickness:
            0.01), "q": nParticle(position: [(0, 5, 0)], radius: 0.1), "k": dynamicConstraint({constraint})"#
        );
        let (scene, _) =
            read_scene_text(&of_nodes(&nodes, ""), Path::new("test.ron")).expect("it can be read");
        let found = first_frame_warnings(&scene, &compile(&scene).expect("it runs"));
        found.into_iter().map(|found| found.message).collect::<Vec<_>>()
    };
    let nothing = ["`k` joins nothing at the first frame"];
    let far = r#"components: ["c", "q"], constraintType: pointToPoint, connectionMethod: withinMaxDistance, maxDistance"#;
    assert_eq!(found(&format!("{far}: 0.5")), nothing);
    assert_eq!(found(&format!("{far}: 6")), [""; 0]);
    assert_eq!(found(r#"components: ["c.vtx[0]"], constraintType: pointToPoint"#), nothing);
    assert_eq!(
        found(r#"components: ["c", "q"], constraintType: pointToSurface, connectionDensity: 0"#),
        nothing
    );
}

#[test]
fn a_limit_of_no_particles_emits_none_and_limits_cannot_be_keyed() {
    let nodes = |limit: &str| {
        format!(
            r#""n": nucleus(), "e": pointEmitter(target: "q", rate: 100), "q": nParticle(maxCount: {limit})"#
        )
    };
    assert_eq!([moved(&nodes("0"), 12).len(), moved(&nodes("3"), 12).len()], [0, 3]);
    let text = of_nodes(&nodes("keys([(1, 5), (10, 20)])"), "");
    let found = read_scene_text(&text, Path::new("test.ron")).map(|_| ()).expect_err("it is refused");
    assert!(found[0].message.contains("`maxCount` of `q` cannot be keyed"), "{found:?}");
}

#[test]
fn settings_without_effect_are_warned_of_with_the_setting_that_is_missing() {
    let cases = [
        ("nucleus(planeFriction: 1)", "`planeFriction` of `x` has no effect: `usePlane` is false"),
        ("nucleus(windNoise: 1)", "`windNoise` of `x` has no effect: `windSpeed` is 0"),
        (
            r#"airField(target: "q", direction: (1, 0, 0), speed: 1, spread: 0.2)"#,
            "`spread` of `x` has no effect: `enableSpread` is false",
        ),
        (
            r#"radialField(target: "q", maxDistance: 3)"#,
            "`maxDistance` of `x` has no effect: `useMaxDistance` is false",
        ),
        (
            r#"radialField(target: "q", volumeExclusion: true)"#,
            "`volumeExclusion` of `x` has no effect: `volumeShape` is none",
        ),
        (
            r#"pointEmitter(target: "q", volumeShape: sphere)"#,
            "`volumeShape` of `x` has no effect: `emitterType` is omni",
        ),
        (
            "nParticle(position: [(1, 0, 0)], lifespan: 0.2)",
            "`lifespan` of `x` has no effect: `lifespanMode` is liveForever",
        ),
        (
            "nParticle(position: [(1, 0, 0)], viscosity: 0.2)",
            "`viscosity` of `x` has no effect: `enableSPH` is false",
        ),
        (
            "nParticle(position: [(1, 0, 0)], radiusScaleInputMax: 4)",
            "`radiusScaleInputMax` of `x` has no effect: `radiusScaleInput` is off",
        ),
        (
            "nParticle(position: [(1, 0, 0)], maxCount: 4)",
            "`maxCount` of `x` has no effect: no particles are born",
        ),
        (
            "nParticle(position: [(1, 0, 0)], radiusScale: [(0, 1), (1, 0)])",
            "`radiusScale` of `x` has no effect: `radiusScaleInput` is off",
        ),
    ];
    for (node, expected) in cases {
        let nucleus = if node.starts_with("nucleus") { "" } else { r#""n": nucleus(), "# };
        let nodes = format!(r#"{nucleus}"q": nParticle(position: [(0, 0, 0)], radius: 0.1), "x": {node}"#);
        assert_eq!(warnings(&nodes, ""), [expected]);
    }
}

#[test]
fn attributes_that_another_one_switches_off_are_warned_of() {
    let mesh = r#""m": polyPlane(subdivisions: (2, 2))"#;
    let cloth = |nucleus: &str, cloth: &str| {
        format!(r#""n": nucleus({nucleus}), {mesh}, "q": nCloth(inputMesh: "m", {cloth})"#)
    };
    let beads = |beads: &str| format!(r#""n": nucleus(), "q": nParticle(position: [(0, 1, 0)], {beads})"#);
    for (nodes, name) in [
        (cloth("resistanceModel: classic, evaluations: 48", ""), "evaluations"),
        (cloth("maxCollisionIterations: 8", ""), "maxCollisionIterations"),
        (cloth("", "maxSelfCollisionIterations: 8"), "maxSelfCollisionIterations"),
        (cloth("", "scalingRelation: worldSpace"), "scalingRelation"),
        (cloth("", "tetherScale: 1.1"), "tetherScale"),
        (cloth("", "longLinks: true"), "longLinks"),
        (cloth("", "fieldDistance: 2"), "fieldDistance"),
        (cloth("", "pointFieldDistance: 3"), "pointFieldDistance"),
        (cloth("", "wrinkleMapScale: 2"), "wrinkleMapScale"),
        (cloth("", r#"cacheFile: "none.mcap""#), "cacheFile"),
        (cloth("", "collideLastThreshold: 0.5"), "collideLastThreshold"),
        (beads("particleSpacing: 0.1"), "particleSpacing"),
        (beads("eventProbability: [0.5]"), "eventProbability"),
    ] {
        let found = warnings(&nodes, "");
        let names = |text: &String| text.starts_with(&format!("`{name}`")) && text.contains("has no effect");
        assert!(found.iter().any(names), "{nodes}: {found:?}");
    }
    let classic = cloth("resistanceModel: classic, maxCollisionIterations: 8", "maxIterations: 50");
    assert_eq!(warnings(&classic, ""), Vec::<String>::new());
}

#[test]
fn expressions_at_birth_give_particles_of_two_emitters_different_random_numbers() {
    let nodes = r#""n": nucleus(), "q": nParticle(creationExpression: "vx = rand; lifespan = id"),
        "e": pointEmitter(target: "q", emitterType: omni, rate: 240, speed: 0),
        "f": pointEmitter(target: "q", emitterType: omni, rate: 240, speed: 0)"#;
    let births = program(&of_nodes(nodes, "")).first_input().births;
    assert_eq!(births.len(), 20);
    for pair in births.chunks(2) {
        assert_eq!((pair[0].time, pair[0].lifespan), (pair[1].time, pair[1].lifespan), "both emit at once");
        assert!(pair[0].velocity.x != pair[1].velocity.x, "{pair:?}");
    }
}

#[test]
fn the_number_of_a_particle_at_birth_is_that_of_its_draw_where_a_rate_map_leaves_others_out() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("rate.png"), png(2, &[0, 255])).expect("written");
    let nodes = r#""n": nucleus(), "q": nParticle(creationExpression: "lifespan = id"), "p": polyPlane(),
        "e": pointEmitter(target: "q", emitterType: surface, parent: "p", rate: 2400, enableTextureRate: true,
        rateMap: texture("rate.png"))"#;
    let path = folder.path().join("scene.ron");
    let (scene, _) = read_scene_text(&of_nodes(nodes, ""), &path).expect("it is read");
    let births = compile(&scene).expect("it compiles").first_input().births;
    assert!((20..=80).contains(&births.len()), "about half of a hundred draws: {}", births.len());
    for birth in births {
        // The k-th of a hundred is born after k hundredths of the frame.
        let draw = birth.time * 100.0 - 1.0;
        assert!((draw - birth.lifespan).abs() < 1e-9, "{draw} is number {}", birth.lifespan);
    }
}
