use std::path::Path;

use super::*;
use crate::attributes::{
    Choice, Component, Selection, dynamic_constraint, n_base, n_cloth, node_types, nucleus, poly_plane,
};
use crate::graph::{Channel, Graph, Setting};

mod comments;
mod files_and_limits;
mod mistakes;
mod round_trip;

/// A cloth, a collider and a pin.
const SHEET: &str = r#"Scene(
    time: (start: 1, end: 24, fps: 24),
    nodes: {
        "nucleus1": nucleus(spaceScale: 0.01, windSpeed: keys([(1, 0), (12, 3, spline), (24, 0)])),
        "sheet": polyPlane(width: 150, height: 150, subdivisions: (4, 4), translate: (0, 90, 0)),
        "cloth1": nCloth(inputMesh: "sheet", bendResistance: 0.4, fron: 0.3),
        "ball": polySphere(radius: 20, translateY: keys([(1, 0), (24, 10)])),
        "rigid1": nRigid(inputMesh: "ball", friction: 0.4),
        "pin": dynamicConstraint(type: transform, components: ["cloth1.vtx[0]", "cloth1.vtx[3:4]"]),
    },
    checks: [noPenetration, maxStretch(0.02), atRestBy(frame: 20, speed: 0.5)],
)
"#;

fn scene(text: &str) -> Scene {
    match read_scene_text(text, Path::new("test.ron")) {
        Ok((scene, _)) => scene,
        Err(diagnostics) => panic!("{diagnostics:#?}"),
    }
}

/// A scene of one nucleus and these nodes.
fn with_nodes(nodes: &str) -> String {
    format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{\"nucleus1\": nucleus(), {nodes}}})")
}

#[test]
fn everything_in_a_scene_is_read() {
    let scene = scene(SHEET);
    assert_eq!(scene.time, TimeSpan { start: 1, end: 24, fps: 24.0 });
    assert_eq!(scene.record, Record::Frames);
    let checks: Vec<String> = scene.checks.iter().map(ToString::to_string).collect();
    assert_eq!(checks, ["noPenetration", "maxStretch(0.02)", "atRestBy(frame: 20, speed: 0.5)"]);
    let node = |name| scene.graph.node(scene.graph.find(name).expect(name));
    assert_eq!(node("cloth1").get(&n_cloth::BEND_RESISTANCE), 0.4);
    assert_eq!(node("cloth1").get(&n_base::FRICTION), 0.3);
    assert_eq!(node("nucleus1").at(&nucleus::WIND_SPEED, 12.0), 3.0);
    assert_eq!(node("sheet").get(&poly_plane::SUBDIVISIONS_HEIGHT), 4);
    let part = |first, last| Component { object: "cloth1".into(), selection: Selection::points(first, last) };
    assert_eq!(node("pin").get(&dynamic_constraint::COMPONENTS), [part(0, 0), part(3, 4)]);
}

#[test]
fn the_short_form_makes_the_connections() {
    let scene = scene(SHEET);
    let wires: Vec<String> = scene.graph.connections().map(|c| scene.graph.describe(c.to)).collect();
    for input in
        ["cloth1.inputMesh", "nucleus1.inputActive[0]", "nucleus1.inputPassive[0]", "nucleus1.inputStart[0]"]
    {
        assert!(wires.iter().any(|wire| wire == input), "{input}: {wires:?}");
    }
}

#[test]
fn vectors_can_be_keyed_as_a_whole_or_by_component() {
    let keyed = with_nodes(
        r#""a": transform(translate: keys([(1, (0, 1, 2)), (3, (2, 1, 0), stepped)])),
           "b": transform(ty: 1, tx: keys([(1, 0), (3, 2, stepped)]), translateZ: keys([(1, 2), (3, 0, stepped)]))"#,
    );
    let scene = scene(&keyed);
    let [a, b] = ["a", "b"].map(|name| scene.graph.find(name).expect(name));
    assert_eq!(scene.graph.placement(a, 2.0).offset.as_slice(), [1.0, 1.0, 1.0]);
    assert_eq!(scene.graph.placement(a, 2.0), scene.graph.placement(b, 2.0));
    let parts = scene.graph.node(b).settings().get("translate");
    assert!(matches!(
        parts,
        Some(Setting::Parts([Channel::Keyed(_), Channel::Fixed(1.0), Channel::Keyed(_)]))
    ));
}

#[test]
fn enums_are_set_by_word_or_mayas_label_in_any_case_or_index() {
    for written in [
        "objectSpace",
        "\"Object Space\"",
        "\"objectSpace\"",
        "1",
        "\"object space\"",
        "OBJECTSPACE",
        "object_space",
    ] {
        let text = with_nodes(&format!(
            "\"p\": polyPlane(), \"c\": nCloth(inputMesh: \"p\", scalingRelation: {written})"
        ));
        let scene = scene(&text);
        let cloth = scene.graph.node(scene.graph.find("c").expect("it is there"));
        assert_eq!(cloth.get(&n_cloth::SCALING_RELATION), Choice(1), "{written}");
    }
}

#[test]
fn words_of_keys_ramps_and_records_may_be_in_any_case() {
    let nodes = r#""p": polyPlane(), "c": nCloth(inputMesh: "p", drag: keys(at: [(1, 0, SPLINE), (3, 1)], post: CycleOffset)),
        "b": nParticle(radiusScale: [(0, 1, Smooth), (1, 0)])"#;
    let any_case = scene(&with_nodes(nodes));
    assert_eq!(
        any_case,
        scene(&with_nodes(
            &nodes
                .replace("SPLINE", "spline")
                .replace("CycleOffset", "cycleOffset")
                .replace("Smooth", "smooth")
        ))
    );
    let record = |word: &str| {
        scene(&with_nodes(nodes).replacen("nodes:", &format!("record: {word}, nodes:"), 1)).record
    };
    assert_eq!(record("SubSteps"), record("substeps"));
    assert_ne!(record("SubSteps"), any_case.record);
}

#[test]
fn no_enum_has_two_words_that_differ_in_case_or_gaps_only() {
    for node_type in node_types() {
        for row in node_type.attributes() {
            let words: Vec<String> = row.words().iter().map(|(_, word)| word.to_lowercase()).collect();
            let all: std::collections::BTreeSet<&String> = words.iter().collect();
            assert_eq!(all.len(), words.len(), "{}.{}", node_type.name, row.name);
        }
    }
}

#[test]
fn switches_and_words_are_stepped_by_default_and_numbers_linear() {
    let text = with_nodes(
        r#""p": polyPlane(), "c": nCloth(inputMesh: "p", drag: keys([(1, 0), (3, 1)]),
           collide: keys([(1, false), (3, true)]))"#,
    );
    let scene = scene(&text);
    let cloth = scene.graph.node(scene.graph.find("c").expect("it is there"));
    assert_eq!(cloth.at(&n_cloth::DRAG, 2.0), 0.5);
    assert_eq!([2.9, 3.0].map(|frame| cloth.at(&n_base::COLLIDE, frame)), [false, true]);
}

#[test]
fn soft_ranges_may_be_exceeded() {
    let text =
        with_nodes(r#""p": polyPlane(), "c": nCloth(inputMesh: "p", stretchResistance: 3000, friction: 2)"#);
    let (_, warnings) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
    assert_eq!(warnings, []);
}

// EVIDENCE: N3.1-10  a setting that is not supported gives a warning, also if it is inherited
#[test]
fn a_setting_without_effect_is_a_warning_with_the_reason_at_its_place() {
    let text =
        with_nodes(r#""p": polyPlane(), "c": nCloth(inputMesh: "p", cacheableAttributes: dynamicState)"#);
    let (_, warnings) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
    let [warning] = warnings.as_slice() else { panic!("{warnings:#?}") };
    assert_eq!(warning.severity, Severity::Warning);
    let reason = "a run records every frame in its own cache, which `--from` starts from";
    assert_eq!(warning.message, format!("`cacheableAttributes` of `c` has no effect: {reason}"));
    assert_eq!(&text[warning.span.clone()], "cacheableAttributes");
    let inherited = with_nodes(r#""p": polyPlane(), "c": nCloth(inputMesh: "p", lifespanRandom: 1)"#);
    let (_, warnings) = read_scene_text(&inherited, Path::new("test.ron")).expect("a valid scene");
    assert_eq!(warnings[0].message, "`lifespanRandom` of `c` has no effect on such a node");
}

// EVIDENCE: N3.1-10  a connection that is not supported gives a warning too
#[test]
fn a_connection_without_effect_is_a_warning_and_one_of_maya_s_wiring_is_none() {
    let nodes = r#""p": nParticle(position0: [(1, 0, 0)]), "q": nParticle(position0: [(0, 1, 0)]),
        "f": radialField(target: "q", magnitude: 5)"#;
    let of_wire = |from: &str, to: &str| {
        let text = with_nodes(nodes);
        let end = text.rfind(')').expect("a scene");
        let text = format!(
            r#"{}, connections: [("{from}", "{to}")])"#,
            text[..end].trim_end().trim_end_matches(',')
        );
        let (_, warnings) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
        warnings.into_iter().map(|warning| warning.message).collect::<Vec<_>>()
    };
    let reason = "fields stand for themselves: none comes from the points of another object";
    let expected = format!("`f.ownerPosData` has no effect: {reason}");
    assert_eq!(of_wire("p.worldPosition", "f.ownerPosData"), [expected]);
    assert_eq!(of_wire("p.worldPosition", "f.inputPositions"), Vec::<String>::new());
}

#[test]
fn a_byte_order_mark_is_ignored() {
    let plain = scene(SHEET);
    assert_eq!(scene(&format!("\u{feff}{}", SHEET)), plain);
}

#[test]
fn a_node_follows_its_parent() {
    let text = with_nodes(
        r#""arm": transform(translate: (0, 5, 0)), "hand": polyCube(parent: "arm", translate: (1, 0, 0))"#,
    );
    let scene = scene(&text);
    let hand = scene.graph.find("hand").expect("it is there");
    assert_eq!(scene.graph.placement(hand, 1.0).offset.as_slice(), [1.0, 5.0, 0.0]);
}
