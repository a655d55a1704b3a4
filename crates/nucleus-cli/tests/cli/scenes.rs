//! `nucleus new`, `fmt`, `graph` and `presets`.

use std::fs;

use crate::sample::{assert_refused, folder, nucleus, stdout};

#[test]
fn a_new_scene_can_run_and_replaces_nothing() {
    let folder = folder();
    for template in ["drape", "hang"] {
        let file = format!("{template}.ron");
        assert!(nucleus(folder.path(), &["new", &file, "--template", template]).status.success());
        let said = stdout(&nucleus(folder.path(), &["check", &file]));
        assert!(said.contains("can run"), "{said}");
        let run = nucleus(folder.path(), &["run", &file, "--frames", "3", "--record", "none"]);
        assert!(run.status.success(), "{run:?}");
    }
    let again = nucleus(folder.path(), &["new", "drape.ron"]);
    assert_refused(&again, "`drape.ron` is there already; give another name");
}

#[test]
fn a_formatted_scene_is_left_as_it_is_and_keeps_its_comments() {
    let folder = folder();
    nucleus(folder.path(), &["new", "a.ron"]);
    let before = nucleus(folder.path(), &["fmt", "--check", "a.ron"]);
    assert_eq!(before.status.code(), Some(1));
    assert!(nucleus(folder.path(), &["fmt", "a.ron"]).status.success());
    let text = fs::read_to_string(folder.path().join("a.ron")).expect("it is there");
    assert!(text.contains("// What is set here counts more than the preset."), "{text}");
    assert!(nucleus(folder.path(), &["fmt", "--check", "a.ron"]).status.success());
}

#[test]
fn a_scene_with_mistakes_is_not_formatted() {
    let folder = folder();
    fs::write(folder.path().join("a.ron"), "Scene(nodes: {})").expect("written");
    let output = nucleus(folder.path(), &["fmt", "a.ron"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(folder.path().join("a.ron")).expect("it is there"), "Scene(nodes: {})");
}

#[test]
fn a_graph_is_drawn_with_all_its_connections() {
    let folder = folder();
    nucleus(folder.path(), &["new", "a.ron"]);
    let dot = stdout(&nucleus(folder.path(), &["graph", "a.ron"]));
    assert!(dot.starts_with("digraph scene {"), "{dot}");
    assert!(dot.contains("\"cloth\" -> \"nucleus1\""), "{dot}");
    assert!(dot.contains("currentState → inputActive[0]"), "{dot}");
    let mermaid = stdout(&nucleus(folder.path(), &["graph", "a.ron", "--format", "mermaid"]));
    assert!(mermaid.starts_with("flowchart LR") && mermaid.contains("nCloth"), "{mermaid}");
}

#[test]
fn presets_are_listed_with_what_they_set() {
    let folder = folder();
    let all = stdout(&nucleus(folder.path(), &["presets"]));
    let eight =
        ["silk", "chiffon", "tShirt", "looseThickKnit", "heavyDenim", "burlap", "thickLeather", "chainmail"];
    assert!(eight.iter().all(|name| all.contains(name)), "{all}");
    let silk = stdout(&nucleus(folder.path(), &["presets", "silk"]));
    assert!(silk.contains("stretchResistance: 60"), "{silk}");
    assert_refused(&nucleus(folder.path(), &["presets", "silc"]), "there is no preset `silc`");
}
