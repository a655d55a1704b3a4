//! Collision events of particles.

use crate::*;

/// The values that Maya writes for an event: valid, number of the collision, emit, split, die, random, spread.
fn event(index: u32, [evv, ecp, eve, evs, evd, evr]: [u32; 6], spread: f64) -> String {
    format!(
        "setAttr \"pShape.evn[{index}]\" -type \"string\" \"event{index}\"; setAttr \"pShape.evv[{index}]\" {evv};\n\
         setAttr \"pShape.ecp[{index}]\" {ecp}; setAttr \"pShape.eve[{index}]\" {eve}; setAttr \"pShape.evs[{index}]\" {evs};\n\
         setAttr \"pShape.evd[{index}]\" {evd}; setAttr \"pShape.evr[{index}]\" {evr}; setAttr \"pShape.esp[{index}]\" {spread};\n\
         setAttr \"pShape.epr[{index}]\" -type \"string\" \"\";\n"
    )
}

/// The particles `p` with events, and further nParticles of the same nucleus.
fn with_events(events: &str) -> Read {
    let others: String = [(1, "drops"), (2, "mist")]
        .map(|(k, name)| {
            format!(
                "createNode transform -n \"{name}\";\ncreateNode nParticle -n \"{name}Shape\" -p \"{name}\";\n\
                 connectAttr \"{name}Shape.cust\" \"n.niao[{k}]\";\nconnectAttr \"{name}Shape.stst\" \"n.nias[{k}]\";\n"
            )
        })
        .concat();
    read(&format!("{PARTICLES}{others}{events}"))
}

#[test]
fn collision_events_emit_into_the_particles_that_maya_names() {
    // The second event was deleted, and the fourth is switched off.
    let events = [
        event(0, [1, 0, 5, 0, 1, 1], 0.25),
        event(2, [1, 2, 0, 3, 0, 0], 0.5),
        event(3, [0, 1, 9, 0, 0, 0], 1.0),
    ]
    .concat();
    let read = with_events(&format!("{events}connectAttr \"dropsShape.msg\" \"pShape.etg[0]\";\n"));
    let graph = &read.imported.scene.graph;
    let particles = graph.node(graph.find("p").unwrap());
    assert_eq!(particles.get(&n_particle::EVENT_PARTICLES), ["drops"]);
    assert_eq!(particles.get(&particle::EVENT_COUNT), [0.0, 2.0]);
    assert_eq!(particles.get(&particle::EVENT_EMIT), [5.0, 0.0]);
    assert_eq!(particles.get(&particle::EVENT_SPLIT), [0.0, 3.0]);
    assert_eq!(particles.get(&particle::EVENT_DIE), [1.0, 0.0]);
    assert_eq!(particles.get(&particle::EVENT_RANDOM), [1.0, 0.0]);
    assert_eq!(particles.get(&particle::EVENT_SPREAD), [0.25, 0.5]);
    assert!(!read.imported.omissions.iter().any(|(what, _)| what == "pShape.eventTarget"));
    assert_round_trip(&read);
}

#[test]
fn collision_events_without_a_target_or_with_their_own_particles_emit_into_these() {
    for target in ["", "connectAttr \"pShape.msg\" \"pShape.etg[0]\";\n"] {
        let read = with_events(&(event(0, [1, 0, 5, 0, 0, 0], 0.0) + target));
        let graph = &read.imported.scene.graph;
        let particles = graph.node(graph.find("p").unwrap());
        assert_eq!(particles.get(&particle::EVENT_EMIT), [5.0]);
        assert!(particles.get(&n_particle::EVENT_PARTICLES).is_empty());
    }
}

#[test]
fn collision_events_into_several_nparticles_have_a_target_each() {
    let events = [
        event(0, [1, 0, 5, 0, 0, 0], 0.0),
        event(1, [1, 0, 0, 2, 0, 0], 0.0),
        event(2, [1, 0, 5, 0, 0, 0], 0.0),
        event(3, [1, 0, 5, 0, 0, 0], 0.0),
    ]
    .concat();
    let wires = "connectAttr \"dropsShape.msg\" \"pShape.etg[0]\";\nconnectAttr \"mistShape.msg\" \"pShape.etg[2]\";\n";
    let read = with_events(&format!("{events}{wires}"));
    let graph = &read.imported.scene.graph;
    let particles = graph.node(graph.find("p").unwrap());
    assert_eq!(particles.get(&n_particle::EVENT_PARTICLES), ["drops", "", "mist", ""]);
    assert_eq!(particles.get(&particle::EVENT_EMIT), [5.0, 0.0, 5.0, 5.0]);
    assert_round_trip(&read);
}

#[test]
fn collision_events_into_an_object_that_is_no_nparticle_are_left_out_and_listed() {
    let classic = "createNode particle -n \"old\";\nconnectAttr \"old.msg\" \"pShape.etg[0]\";\n";
    let read = with_events(&(event(0, [1, 0, 5, 0, 0, 0], 0.0) + classic));
    let graph = &read.imported.scene.graph;
    let particles = graph.node(graph.find("p").unwrap());
    assert!(particles.get(&particle::EVENT_EMIT).is_empty());
    assert!(particles.get(&particle::EVENT_SPREAD).is_empty());
    assert!(read.omits("pShape.eventTarget", "is not carried over"), "{}", read.imported.omissions);
}

#[test]
fn procedures_of_collision_events_are_listed() {
    let read = with_events(&event(0, [1, 0, 0, 0, 1, 0], 0.0).replace("\"\";", "\"splash\";"));
    assert!(read.omits("pShape.eventProc", "`splash` is not called"), "{}", read.imported.omissions);
}
