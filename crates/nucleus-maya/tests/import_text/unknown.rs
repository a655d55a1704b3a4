//! Units, attributes and expressions that an import cannot take over, and attributes of shapes.

use nucleus_graph::attributes::n_particle;
use nucleus_graph::scene::read_scene_text;

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

#[test]
fn every_frame_rate_of_maya_is_known() {
    let rates = [
        ("29.97df", 29.97),
        ("29.97fps", 29.97),
        ("23.976fps", 23.976),
        ("47.952fps", 47.952),
        ("59.94fps", 59.94),
        ("119.88fps", 119.88),
        ("44100fps", 44100.0),
        ("48000fps", 48000.0),
        ("min", 1.0 / 60.0),
        ("millisec", 1000.0),
    ];
    for (name, fps) in rates {
        let read = particles(&format!("currentUnit -l centimeter -a degree -t {name};"), "");
        assert_eq!(read.imported.scene.time.fps, fps, "{name}");
        assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
        assert!(read_scene_text(&read.text(), "a.ron".as_ref()).is_ok(), "{name}");
    }
}

#[test]
fn an_hour_as_the_unit_of_time_is_listed_with_its_effect() {
    let read = particles("currentUnit -t hour;", "");
    let text = read.imported.omissions.to_string();
    assert!(text.contains("`hour`") && text.contains("1000 s") && text.contains("refused"), "{text}");
}

#[test]
fn an_unknown_attribute_is_told_from_one_that_a_user_has_added() {
    let added = "addAttr -ci true -sn \"mood\" -ln \"moodOfShot\" -at \"double\";\nsetAttr \".mood\" 3;";
    let read = particles("", &format!("{added}\nsetAttr \".whirl\" 2;"));
    let text = read.imported.omissions.to_string();
    assert!(text.contains("`pShape`: the simulation has no use for mood; effect: none"), "{text}");
    assert!(
        text.contains("`pShape`: these attributes are unknown: whirl; effect: they are left out"),
        "{text}"
    );
}

#[test]
fn expressions_of_particles_are_listed_and_not_copied() {
    let values = "setAttr \".irbx\" -type \"string\" \"\";\n\
                  setAttr \".irax\" -type \"string\" \"pShape.velocity += <<0,1,0>>;\";\n\
                  setAttr \".icx\" -type \"string\" \"pShape.lifespanPP = rand(1,2);\";";
    let read = particles("", values);
    assert!(!read.text().contains("Expression"), "{}", read.text());
    assert!(read.omits("internalCreationExpression", "are not run"));
    assert!(read.omits("internalRuntimeAfterDynamicsExpression", "are not run"));
    assert_eq!(read.imported.omissions.len(), 2, "{}", read.imported.omissions);
}
