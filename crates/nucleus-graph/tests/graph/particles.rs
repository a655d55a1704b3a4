//! Particles: from node to solver.

use std::fs;
use std::path::Path;

use nucleus_core::{ClothId, Elements, InvalidInput, RampInput, RampTarget, Sanitized};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;

use super::scenes::{after, of_nodes, program};

/// Where the particles of `q` are after some frames, in scene units.
pub fn places(program: &Program, frames: usize) -> Vec<[f32; 3]> {
    after(program, frames, "q").into_iter().map(|place| place.map(f32::from_bits)).collect()
}

/// All warnings of a scene.
pub fn warnings(text: &str) -> Vec<String> {
    let (scene, mut diagnostics) = read_scene_text(text, Path::new("test.ron")).expect("it can be read");
    diagnostics.extend(compile(&scene).expect("it runs").warnings().iter().cloned());
    diagnostics.into_iter().map(|diagnostic| diagnostic.message).collect()
}

// EVIDENCE: N1.1-4  a particle is an object of the solver like cloth, without a face and without a link
#[test]
fn particles_start_where_their_node_says_and_fall() {
    let nodes = r#""n": nucleus(spaceScale: 0.01),
        "q": nParticle(position: [(1, 2, 3), (4, 5, 6)], velocity: [(0, 0, 24), (0, 0, 0)], drag: 0)"#;
    let program = program(&of_nodes(nodes, ""));
    assert_eq!(places(&program, 0), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let moved = places(&program, 1);
    assert!((moved[0][2] - 4.0).abs() < 1e-4 && moved[1][2] == 6.0, "{moved:?}");
    assert!(moved.iter().zip([2.0, 5.0]).all(|(place, start)| place[1] < start), "{moved:?}");
    let cloth = &program.model().cloths()[0];
    assert!(cloth.surface.faces.is_empty() && !cloth.lists.stretch && !cloth.lists.bend);
}

#[test]
fn one_velocity_counts_for_all_particles() {
    let moved = |velocities: &str| {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "q": nParticle(position: [(1, 2, 3), (4, 5, 6)], velocity0: {velocities}, drag: 0)"#
        );
        places(&program(&of_nodes(&nodes, "")), 1)
    };
    let both = moved("[(0, 0, 24)]");
    assert!(both.iter().zip([4.0, 7.0]).all(|(place, z)| (place[2] - z).abs() < 1e-4), "{both:?}");
    assert_eq!(both, moved("[(0, 0, 24), (0, 0, 24)]"));
    assert_eq!(both, moved("(0, 0, 24)"));
}

#[test]
fn particles_that_are_not_dynamic_stay_where_they_are_and_none_are_emitted() {
    let nodes = |dynamic: &str| {
        format!(
            r#""n": nucleus(), "e": pointEmitter(target: "q", rate: 240),
            "q": nParticle(position: [(1, 2, 3)], velocity: [(0, 0, 24)], isDynamic: {dynamic})"#
        )
    };
    let at_rest = program(&of_nodes(&nodes("false"), ""));
    assert_eq!(places(&at_rest, 8), [[1.0, 2.0, 3.0]]);
    // Released at frame 3, they fall in the interval that ends there.
    let released = program(&of_nodes(&nodes("keys([(0, false), (3, true)])"), ""));
    assert_eq!(places(&released, 1), [[1.0, 2.0, 3.0]]);
    let fallen = places(&released, 6);
    assert!(fallen.len() > 10 && fallen[0][1] < 2.0, "{fallen:?}");
}

#[test]
fn particles_with_a_connected_attribute_belong_to_their_nucleus_all_the_same() {
    let nodes = r#""n": nucleus(), "a": transform(tx: 0.5), "q": nParticle(position: [(1, 2, 3)])"#;
    let text = of_nodes(nodes, r#"("a.tx", "q.friction")"#);
    assert!(places(&program(&text), 4)[0][1] < 2.0, "they fall");
    let (read, _) = read_scene_text(&text, Path::new("test.ron")).expect("it can be read");
    let written = nucleus_graph::scene::write_scene(&read);
    assert_eq!(places(&program(&written), 4), places(&program(&text), 4), "{written}");
}

#[test]
fn a_field_that_is_connected_to_nothing_is_warned_of() {
    let nodes = r#""n": nucleus(), "idle": airField(), "down": gravityField(target: "q"), "q": nParticle(position: [(1, 2, 3)])"#;
    assert_eq!(warnings(&of_nodes(nodes, "")), ["`idle` acts on nothing"]);
}

#[test]
fn a_bounce_above_one_is_warned_of() {
    let nodes = r#""n": nucleus(usePlane: true, planeBounce: keys([(1, 0), (9, 4)])), "q": nParticle(bounce: 1),
        "m": polyPlane(), "c": nCloth(inputMesh: "m", bounce: 2.5), "r": nRigid(inputMesh: "m", bounce: 3)"#;
    let mut found = warnings(&of_nodes(nodes, ""));
    found.retain(|warning| warning.contains("counts as 1"));
    found.sort();
    let expected = [("bounce", "c", "2.5"), ("bounce", "r", "3"), ("planeBounce", "n", "4")]
        .map(|(attribute, node, value)| format!("`{attribute}` of `{node}` is {value}, and counts as 1"));
    assert_eq!(found, expected);
}

#[test]
fn an_initial_position_has_precedence_over_a_position() {
    let nodes =
        r#""n": nucleus(), "q": nParticle(position: [(1, 2, 3)], pos0: [(7, 8, 9)], vel0: [(0, 0, 0)])"#;
    assert_eq!(places(&program(&of_nodes(nodes, "")), 0), [[7.0, 8.0, 9.0]]);
}

#[test]
fn particles_can_be_the_points_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.obj"), "v 1 2 3\nv 4 5 6\n").expect("written");
    fs::write(folder.path().join("a.txt"), "1 2 3 # one\n4, 5, 6").expect("written");
    for file in ["a.obj", "a.txt"] {
        let text = of_nodes(&format!(r#""n": nucleus(), "q": nParticle(position: file("{file}"))"#), "");
        let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it can be read");
        let program = compile(&scene).unwrap_or_else(|found| panic!("{found:?}"));
        assert_eq!(places(&program, 0), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{file}");
    }
}

#[test]
fn the_attenuations_of_a_drag_field_are_speeds_in_scene_units() {
    let nodes = r#""n": nucleus(spaceScale: 0.01), "q": nParticle(position: [(0, 0, 0)]),
        "f": dragField(target: "q", magnitude: 8, speedAttenuation: 200, motionAttenuation: 24,
            translateX: keys([(1, 0), (25, 24)]))"#;
    let field = program(&of_nodes(nodes, "")).first_input().fields[0].kind;
    let nucleus_core::FieldKind::Drag { magnitude, half_speed, .. } = field else { panic!("{field:?}") };
    assert!((half_speed - 2.0).abs() < 1e-12, "200 cm/s: {half_speed}");
    assert!((magnitude - 4.0).abs() < 1e-6, "the field moves at 24 cm/s: {magnitude}");
}

#[test]
fn a_liquid_at_rest_overlaps_as_often_as_its_rest_density_says() {
    let nodes = r#""n": nucleus(spaceScale: 0.01), "q": nParticle(enableSPH: true, radius: 2, radiusScaleSPH: 0.5,
        restDensity: 1.5, viscosity: 0.5, surfaceTension: 0.1, maximumCorner: (4, 4, 4))"#;
    let program = program(&of_nodes(nodes, ""));
    let liquid = program.first_input().cloths[0].liquid.expect("a liquid");
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.01f64.powi(3);
    assert!((ball / liquid.spacing.powi(3) - 1.5).abs() < 1e-9, "{liquid:?}");
    assert!((liquid.viscosity - 0.0025).abs() < 1e-12 && (liquid.surface_tension - 1e-4).abs() < 1e-12);
    // Its grid has the distance at rest: 4 cm hold two cubes of 1.41 cm.
    assert_eq!(places(&program, 0).len(), 8);
    let dry = of_nodes(r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)])"#, "");
    assert_eq!(self::program(&dry).first_input().cloths[0].liquid, None);
}

/// A box that is open at its top: 0.4 m wide and deep, 0.5 m high.
const OPEN_BOX: &str =
    "v -0.2 0 -0.2\nv 0.2 0 -0.2\nv 0.2 0 0.2\nv -0.2 0 0.2\nv -0.2 0.5 -0.2\nv 0.2 0.5 -0.2
v 0.2 0.5 0.2\nv -0.2 0.5 0.2\nf 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

// EVIDENCE: N1.2-11  liquid that is poured into a vessel stays in it and stands at the level of its volume
#[test]
fn liquid_poured_into_a_box_stays_in_it_at_the_level_of_its_volume() {
    const WALL: f64 = 0.001;
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("box.obj"), OPEN_BOX).expect("written");
    for (radius, count) in [(0.031, 300), (0.0207, 1000)] {
        // With one ball over each point, a particle at rest has the volume of its ball.
        let nodes = format!(
            r#""n": nucleus(subSteps: 4), "w": mesh(file: "box.obj"), "r": nRigid(inputMesh: "w", thickness: {WALL}),
            "q": nParticle(enableSPH: true, radius: {radius}, restDensity: 1, viscosity: 0.05, maxCount: {count}),
            "e": pointEmitter(target: "q", emitterType: volume, volumeShape: cube, translate: (0, 0.4, 0),
                scale: (0.1, 0.05, 0.1), rate: {})"#,
            0.8 * f64::from(count)
        );
        // There is room for the particles that are emitted up to the end of the scene.
        let text = of_nodes(&nodes, "").replace("end: 24", "end: 97");
        let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it can be read");
        let program = compile(&scene).unwrap_or_else(|found| panic!("{found:?}"));
        let poured = places(&program, 84);
        let inside = |place: &&[f32; 3]| place[0].abs() < 0.2 && place[2].abs() < 0.2 && place[1] > 0.0;
        assert_eq!((poured.len(), poured.iter().filter(inside).count()), (count as usize, count as usize));
        // The mean height of a liquid is half of its level. It has the space within the thickness of the walls.
        let mean = poured.iter().map(|place| f64::from(place[1])).sum::<f64>() / poured.len() as f64;
        let level = 2.0 * (mean - WALL);
        let volume = f64::from(count) * 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
        let expected = volume / (0.4 - 2.0 * WALL).powi(2);
        println!("{count} particles: {level:.4} m, by the volume {expected:.4} m");
        assert!((level / expected - 1.0).abs() < 0.05, "{count}: {level} m, by the volume {expected} m");
    }
}

#[test]
fn a_liquid_without_a_radius_and_particles_of_a_broken_emitter_are_errors() {
    let errors = |nodes: &str| {
        let text = of_nodes(&format!(r#""n": nucleus(), {nodes}"#), "");
        let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it can be read");
        let found = compile(&scene).expect_err("it is refused");
        found.into_iter().map(|found| found.message).collect::<Vec<_>>()
    };
    let message = "the liquid `q` has no rest distance: `radius` × `radiusScaleSPH` is 0";
    assert_eq!(errors(r#""q": nParticle(enableSPH: true, radius: 0, position: [(0, 1, 0)])"#), [message]);
    let broken = r#""q": nParticle(), "m": mesh(file: "none.obj"),
        "e": pointEmitter(target: "q", emitterType: surface, parent: "m")"#;
    assert_eq!(errors(broken)[0], "`q` has no particles, as none of its emitters can be used");
}

// EVIDENCE: N2.3-2  a particle is as thick as its radius says
#[test]
fn a_particle_is_as_thick_as_its_radius_and_its_scales_say() {
    let nodes = r#""n": nucleus(spaceScale: 0.01), "q": nParticle(position: [(0, 0, 0)], radius: 3, collideWidthScale: 0.5,
        selfCollideWidthScale: 2, collisionFlag: face, pointMass: 0.25)"#;
    let program = program(&of_nodes(nodes, ""));
    let frame = &program.first_input().cloths[0];
    assert!((frame.thickness - 0.015).abs() < 1e-12 && (frame.self_collision.thickness - 0.03).abs() < 1e-12);
    assert_eq!((frame.elements, frame.self_collision.elements), (Elements::Points, Elements::Points));
    assert_eq!((frame.drag, frame.tangential_drag, frame.lift), (0.01, 1.0, 0.0));
    assert_eq!((program.mass(), program.objects()[0].radius), (0.25, Some(3.0)));
}

#[test]
fn a_particle_has_the_same_mass_in_both_resistance_models() {
    for model in ["classic", "physical"] {
        let nodes = format!(
            r#""n": nucleus(resistanceModel: {model}), "q": nParticle(position: [(0, 0, 0), (1, 0, 0)], pointMass: 3)"#
        );
        assert_eq!(program(&of_nodes(&nodes, "")).mass(), 6.0);
    }
}

#[test]
fn settings_without_effect_on_particles_give_a_warning() {
    let of = |fields: &str| warnings(&of_nodes(&format!(r#""n": nucleus(), "q": nParticle({fields})"#), ""));
    assert_eq!(of("position: [(0, 0, 0)]"), Vec::<String>::new());
    assert_eq!(of(""), ["`q` has no particles, and does nothing"]);
    for name in ["parallelSPH: true", "meshMethod: \"Quad Mesh\"", "inputAttract: 1"] {
        let messages = of(&format!("position: [(0, 0, 0)], {name}"));
        assert!(messages.len() == 1 && messages[0].contains("has no effect: "), "{name}: {messages:?}");
    }
    for name in
        ["damp: 1", "computeRotation: true", "conserve: 0.5", "opacity: 0.5", "stickinessRandomize: 1"]
    {
        assert_eq!(of(&format!("position: [(0, 0, 0)], {name}")), Vec::<String>::new(), "{name}");
    }
    for name in ["thickness: 1", "startPositions: [(0, 0, 0)]", "restLengthScale: 2"] {
        let messages = of(&format!("position: [(0, 0, 0)], {name}"));
        assert!(
            messages.len() == 1 && messages[0].ends_with("has no effect on such a node"),
            "{name}: {messages:?}"
        );
    }
}

#[test]
fn the_names_of_nodes_do_not_change_the_motion_of_particles_and_cloth() {
    let run = |[sheet, q, r]: [&str; 3]| {
        let nodes = format!(
            r#""n": nucleus(evaluations: 24), "p": polyPlane(width: 2, height: 2, subdivisions: (6, 6)),
               "{sheet}": nCloth(inputMesh: "p"), "{q}": nParticle(position: [(0.1, 0.3, 0), (0.1, 0.8, 0.1)], pointMass: 0.1),
               "{r}": nParticle(position: [(0.2, 0.5, 0.2)], pointMass: 0.1, radius: 0.1)"#
        );
        let program = program(&of_nodes(&nodes, ""));
        [sheet, q, r].map(|name| after(&program, 12, name))
    };
    assert_eq!(run(["a", "b", "c"]), run(["z", "y", "x"]));
}

// EVIDENCE: N3.1-3  particles can ignore the solver's gravity
#[test]
fn particles_that_ignore_gravity_stay_and_pinned_particles_are_held() {
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)], ignoreSolverGravity: true)"#;
    assert_eq!(places(&program(&of_nodes(nodes, "")), 5), [[0.0; 3]]);
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0), (3, 0, 0)]),
        "h": dynamicConstraint(components: ["q.vtx[0]"])"#;
    let held = places(&program(&of_nodes(nodes, "")), 5);
    assert!(held[0] == [0.0; 3] && held[1][1] < -0.1, "{held:?}");
}

#[test]
fn ramps_and_lists_make_particles_differ() {
    let nodes = r#""n": nucleus(spaceScale: 0.01), "q": nParticle(position: [(0, 0, 0), (9, 0, 0), (0, 9, 0)], radius: 2,
        radiusScale: [(0, 0.5), (1, 1)], radiusScaleInput: "Speed", radiusScaleInputMax: 10, massScaleRandomize: 0.25,
        mass0: expression("1 + x"), particleId0: [4, 5, 9], age0: [0, 0.5, 1], lifespanMode: "lifespanPP only",
        lifespanPP: [1, 2, 3], colorInput: age, color: [(0, (1, 0, 0)), (1, (0, 0, 1))])"#;
    let program = program(&of_nodes(nodes, ""));
    let cloth = &program.model().cloths()[0];
    assert_eq!(cloth.point_masses(), [1.0, 10.0, 1.0]);
    let own = cloth.particles.as_ref().expect("they differ");
    assert_eq!((&own.ids[..], &own.ages[..]), (&[4, 5, 9][..], &[0.0, 0.5, 1.0][..]));
    assert_eq!((&own.lifespans[..], own.radius), (&[1.0, 2.0, 3.0][..], 0.02));
    let ramp = |target| own.ramps.iter().find(|ramp| ramp.target == target).expect("a ramp");
    let radius = ramp(RampTarget::Radius);
    assert_eq!((radius.input, radius.input_max, radius.samples[64]), (RampInput::Speed, 0.1, 0.75));
    let mass = ramp(RampTarget::Mass);
    assert_eq!((mass.input, &mass.samples[..], mass.randomize), (RampInput::Off, &[1.0][..], 0.25));
    let blue = ramp(RampTarget::Color(2));
    assert_eq!((blue.input, blue.samples[0], blue.samples[128]), (RampInput::Age, 0.0, 1.0));
    assert_eq!(own.ramps.len(), 5);
}

#[test]
fn particles_without_ramps_have_no_columns_for_them() {
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)], radiusScaleInput: "Age")"#;
    assert!(program(&of_nodes(nodes, "")).model().cloths()[0].particles.is_none());
}

#[test]
fn collision_events_are_lists_with_a_number_per_event() {
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 1, 0)], eventCount: [1, 0], eventEmit: [5, 0],
        eventDie: [0, 1], eventProbability: [1, 0.5], eventParticles: "r"),
        "r": nParticle(lifespanMode: constant, lifespan: 2)"#;
    let program = program(&of_nodes(nodes, ""));
    let cloths = program.model().cloths();
    let events = cloths.iter().find_map(|cloth| {
        cloth.particles.as_ref().map(|own| own.events.clone()).filter(|events| !events.is_empty())
    });
    let events = events.expect("events");
    let target = cloths[events[0].target.index()].particles.as_ref().expect("room for what is emitted");
    assert!(target.capacity >= 10_000 && target.events.is_empty());
    assert_eq!(
        (events[0].count, events[0].emit, events[0].die, events[0].lifespan),
        (1, 5, false, [2.0, 0.0])
    );
    assert_eq!((events[1].count, events[1].die, events[1].probability), (0, true, 0.5));
}

#[test]
fn each_event_emits_into_its_own_target() {
    let nodes = |targets: &str| {
        format!(
            r#""n": nucleus(), "q": nParticle(position: [(0, 1, 0)], eventCount: [1, 2], eventEmit: [5, 2],
            eventParticles: {targets}), "r": nParticle(lifespanMode: constant, lifespan: 2), "s": nParticle()"#
        )
    };
    let targets = |targets: &str| {
        let program = program(&of_nodes(&nodes(targets), ""));
        let model = program.model();
        let events = model.cloths().iter().filter_map(|cloth| cloth.particles.as_ref());
        let events = events.map(|own| own.events.clone()).find(|events| !events.is_empty()).expect("events");
        let name = |event: &nucleus_core::CollisionEvent| {
            (program.objects()[event.target.index()].name.clone(), event.lifespan[0])
        };
        events.iter().map(name).collect::<Vec<_>>()
    };
    let of = |name: &str, lifespan: f64| (name.to_owned(), lifespan);
    let forever = targets(r#""s""#)[0].1;
    assert_eq!(targets(r#"["r", "s"]"#), [of("r", 2.0), of("s", forever)]);
    assert_eq!(targets(r#"["", "r"]"#), [of("q", forever), of("r", 2.0)]);
    assert_eq!(targets(r#"["r"]"#), targets(r#""r""#));
    // Both have room, so neither is said to do nothing.
    assert_eq!(warnings(&of_nodes(&nodes(r#"["r", "s"]"#), "")), Vec::<String>::new());
}

#[test]
fn events_emit_up_to_the_limit_of_their_target() {
    let left = |limit: u32| {
        let nodes = format!(
            r#""n": nucleus(usePlane: true), "q": nParticle(maxCount: {limit}), "p": nParticle(position: [(0, 1, 0)],
            radius: 0.1, eventCount: [1], eventEmit: [5], eventParticles: "q")"#
        );
        places(&program(&of_nodes(&nodes, "")), 24).len()
    };
    assert_eq!([left(3), left(50)], [3, 5]);
}

#[test]
fn bad_ramps_lists_and_events_are_errors_that_name_them() {
    let errors = |fields: &str| {
        let nodes = format!(r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0), (1, 0, 0)], {fields})"#);
        let (scene, _) =
            read_scene_text(&of_nodes(&nodes, ""), Path::new("test.ron")).expect("it can be read");
        let found = compile(&scene).expect_err("it is refused");
        found.into_iter().map(|found| found.message).collect::<Vec<_>>()
    };
    assert_eq!(errors("mass0: [1]"), ["`mass0` of `q` has 1 values for 2 particles"]);
    assert_eq!(errors("mass0: [1, 0]"), ["`mass0` of `q` must be above 0, but is 0"]);
    for numbers in ["[3, 3]", "[0.5, 1]", "[-1, 0]", "[0, 1e20]"] {
        assert_eq!(
            errors(&format!("particleId0: {numbers}")),
            ["the numbers of `q` in `particleId0` are not each its own, whole and at least 0"]
        );
    }
    assert_eq!(
        errors(r#"age0: expression("1 / x")"#),
        ["`age0` of `q` is not a finite number at particle 0"]
    );
    assert_eq!(
        errors(r#"radiusScale: [(0, -1), (1, 1)], radiusScaleInput: age"#),
        ["`radiusScale` of `q` must be between 0 and 1000000, but is -1 somewhere"]
    );
    assert_eq!(errors("eventEmit: [1, 2], eventDie: [1]"), ["`eventDie` of `q` has 1 values for 2 events"]);
    assert_eq!(
        errors("eventEmit: [1e9]"),
        ["`eventEmit` of `q` must be between 0 and 65535, but is 1000000000"]
    );
    assert_eq!(
        errors(r#"eventEmit: [1], eventParticles: "p""#),
        ["there are no particles `p` in this nucleus to emit into"]
    );
    assert_eq!(
        errors(r#"eventEmit: [1, 2, 3], eventParticles: ["q", "q"]"#),
        ["`eventParticles` of `q` has 2 values for 3 events"]
    );
}

#[test]
fn a_cycle_of_one_frame_repeats_the_random_numbers_in_each() {
    let run = |cycle: &str| {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "q": nParticle(drag: 0, collide: false, selfCollide: false),
            "e": pointEmitter(target: "q", emitterType: volume, rate: 240, speed: 0 {cycle})"#
        );
        let mut all = places(&program(&of_nodes(&nodes, "")), 2);
        let late = all.split_off(10);
        (all, late)
    };
    let (first, second) = run(r#", cycleEmission: "Frame (timeRandom on)""#);
    assert_eq!((first.len(), &first), (10, &second));
    let (first, second) = run("");
    assert_ne!(first, second);
}

#[test]
fn expressions_set_velocities_and_lifespans_at_birth_and_in_each_frame() {
    let born = |expression: &str| {
        let nodes = format!(
            r#""n": nucleus(spaceScale: 0.01), "q": nParticle(creationExpression: "{expression}"),
            "e": pointEmitter(target: "q", emitterType: omni, rate: 240, speed: 0)"#
        );
        program(&of_nodes(&nodes, "")).first_input().births
    };
    let all = born("vy = 100 + 50 * rand; lifespan = 2 + id; x = 7");
    assert_eq!(all.len(), 10);
    for (k, birth) in all.iter().enumerate() {
        assert_eq!((birth.position.x, birth.lifespan), (0.07, 2.0 + k as f64));
        assert!((1.0..1.5).contains(&birth.velocity.y), "{birth:?}");
    }
    assert!(all[0].velocity.y != all[1].velocity.y);
    // A negative lifespan is over at birth.
    assert!(born("lifespan = 0 - 1").iter().all(|birth| birth.lifespan == -1.0));
    // A result that is not a finite number changes nothing.
    assert!(born("vy = 1 / 0; lifespan = 0 / 0").iter().all(|birth| birth.velocity.norm() == 0.0));
    let nodes = r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0, 0, 0), (5, 0, 0)], drag: 0,
        runtimeExpression: "vy = 24 * (1 + id); lifespan = id == 1 && time > 0.05 ? 0 : 99")"#;
    let program = program(&of_nodes(nodes, ""));
    let moved = places(&program, 1);
    assert!((moved[0][1] - 1.0).abs() < 1e-5 && (moved[1][1] - 2.0).abs() < 1e-5, "{moved:?}");
    // In the third frame, which begins 2/24 s after the start, the second one dies.
    assert_eq!([places(&program, 2).len(), places(&program, 3).len()], [2, 1]);
}

/// What a run of some frames reports of each: the invalid values, and the births that were refused.
fn reports(nodes: &str, frames: usize) -> Vec<(Sanitized, u64)> {
    let mut simulation = Simulation::<f32>::new(&program(&of_nodes(nodes, "")), 1);
    let reports = (0..frames).map(|_| simulation.advance(&mut ()).report);
    reports.map(|report| (report.sanitized, report.births_refused)).collect()
}

#[test]
fn an_expression_that_gives_no_finite_number_is_reported_with_its_count() {
    let of = |count, first| Sanitized { count, first: (count > 0).then_some(first) };
    let runtime = |text: &str| {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0, 0, 0), (5, 0, 0), (9, 0, 0)],
            runtimeExpression: "{text}")"#
        );
        reports(&nodes, 2)
    };
    let invalid = |count| (of(count, InvalidInput::RuntimeExpression(ClothId(0))), 0);
    // The particle at the origin, in both frames; all three, at the second frame; none.
    assert_eq!(runtime("vy = 1 / x"), [invalid(1), invalid(1)]);
    assert_eq!(runtime("vx = sqrt(0.01 - time)"), [invalid(0), invalid(3)]);
    assert_eq!(runtime("vx = log(0 - 1 - x); lifespan = 0 / 0"), [invalid(3), invalid(3)]);
    assert_eq!(runtime("vx = 1; lifespan = 1 / 0"), [invalid(0), invalid(0)]);
    let nodes = r#""n": nucleus(), "q": nParticle(creationExpression: "x = 1 / (id - 1)", maxCount: 100),
        "e": pointEmitter(target: "q", emitterType: omni, rate: 48)"#;
    let first = InvalidInput::CreationExpression(ClothId(0));
    assert_eq!(reports(nodes, 2), [(of(1, first), 0), (of(0, first), 0)]);
}

#[test]
fn refused_births_are_all_that_the_emitter_asked_for() {
    let nodes = r#""n": nucleus(), "q": nParticle(maxCount: 10, selfCollide: false),
        "e": pointEmitter(target: "q", emitterType: omni, rate: 2.4e9)"#;
    let refused: Vec<u64> = reports(nodes, 2).into_iter().map(|(_, refused)| refused).collect();
    assert_eq!(refused, [99_999_990, 100_000_000]);
}

#[test]
fn a_mistake_in_an_expression_is_an_error_that_names_it() {
    let error = |text: &str| {
        let nodes =
            format!(r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)], runtimeExpression: "{text}")"#);
        let (scene, _) =
            read_scene_text(&of_nodes(&nodes, ""), Path::new("test.ron")).expect("it can be read");
        compile(&scene).expect_err("it is refused")[0].message.clone()
    };
    assert_eq!(error("x = 1"), "`runtimeExpression` of `q`: `x` cannot be assigned");
    assert_eq!(error("vx = speed"), "`runtimeExpression` of `q`: there is no `speed` in an expression");
    assert_eq!(error("vx"), "`runtimeExpression` of `q`: `vx` is no statement");
}
