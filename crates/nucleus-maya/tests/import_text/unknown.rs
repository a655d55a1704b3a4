//! Units, attributes and expressions that an import cannot take over, and attributes of shapes.

use nucleus_graph::attributes::n_particle;

use super::{Read, near, read};

/// Particles below a transform, with values of the shape.
fn particles(head: &str, values: &str) -> Read {
    read(&format!(
        "{head}\ncreateNode nucleus -n \"n\";\ncreateNode transform -n \"p\";\n\
         createNode nParticle -n \"pShape\" -p \"p\";\n\
         setAttr \".pos0\" -type \"vectorArray\" 2 0 10 0 0 0 10;\n{values}\n\
         connectAttr \"pShape.cust\" \"n.niao[0]\";\nconnectAttr \"pShape.stst\" \"n.nias[0]\";\n"
    ))
}

#[test]
fn a_radius_of_particles_turns_nothing() {
    let read = particles("", "setAttr \".ra\" 5;");
    let graph = &read.imported.scene.graph;
    let node = graph.node(graph.find("p").unwrap());
    assert_eq!(node.get(&n_particle::RADIUS), 5.0);
    let places = node.get(&n_particle::POSITION0);
    near(places[0], [0.0, 10.0, 0.0]);
    near(places[1], [0.0, 0.0, 10.0]);
}
