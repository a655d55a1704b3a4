//! Presets.

use std::fs;
use std::path::Path;

use nucleus_graph::attributes::{Value, n_base, n_cloth};
use nucleus_graph::graph::Setting;
use nucleus_graph::scene::{presets, read_scene_text, write_scene};

use super::scenes::{of_nodes, scene};

fn cloth(fields: &str) -> String {
    of_nodes(&format!(r#""n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p", {fields})"#), "")
}

#[test]
fn settings_have_precedence_over_the_preset_and_that_over_defaults() {
    let scene = scene(&cloth(r#"preset: "silk", friction: 0.7"#));
    let node = scene.graph.node(scene.graph.find("c").expect("it is there"));
    assert_eq!(node.get(&n_base::FRICTION), 0.7);
    assert_eq!(node.get(&n_cloth::STRETCH_RESISTANCE), 60.0);
    assert_eq!(node.get(&n_cloth::LIFT), 0.05);
    let written = write_scene(&scene);
    assert!(written.contains("preset: \"silk\"") && !written.contains("stretchResistance"), "{written}");
}

/// The eight materials of Maya, with the values of its manual.
#[test]
fn the_eight_materials_of_maya_are_as_in_its_manual() {
    let columns = "friction stretchResistance compressionResistance bendResistance bendAngleDropoff pointMass tangentialDrag damp";
    let table = [
        ("silk", [0.05, 60.0, 10.0, 0.05, 0.3, 0.05, 0.05, 0.2]),
        ("chiffon", [0.9, 40.0, 20.0, 0.2, 0.6, 0.15, 0.4, 2.0]),
        ("tShirt", [0.3, 35.0, 10.0, 0.1, 0.4, 0.6, 0.1, 0.8]),
        ("looseThickKnit", [1.0, 30.0, 5.0, 0.5, 0.603, 0.8, 0.4, 1.0]),
        ("heavyDenim", [0.8, 50.0, 20.0, 0.4, 0.603, 2.0, 0.1, 0.8]),
        ("burlap", [2.0, 40.0, 40.0, 3.0, 0.603, 1.5, 0.4, 4.0]),
        ("thickLeather", [0.6, 50.0, 50.0, 10.0, 0.727, 3.0, 0.2, 8.0]),
        ("chainmail", [0.3, 50.0, 2.0, 0.01, 0.818, 10.0, 0.2, 0.05]),
    ];
    let all = presets();
    for (name, values) in table {
        let preset =
            all.iter().find(|preset| preset.name == name).unwrap_or_else(|| panic!("there is no {name}"));
        for (column, value) in columns.split(' ').zip(values) {
            let set = preset.settings.iter().find(|(row, _)| row.name == column).map(|(_, setting)| setting);
            assert_eq!(set, Some(&Setting::Fixed(Value::Float(value))), "{name}.{column}");
        }
    }
}

#[test]
fn every_preset_can_be_read_and_has_a_description() {
    let all = presets();
    assert_eq!(all.len(), 17);
    for preset in &all {
        assert!(preset.doc.ends_with('.'), "{}", preset.name);
        scene(&cloth(&format!("preset: {:?}", preset.name)));
    }
}

#[test]
fn the_settings_of_a_preset_without_effect_give_at_most_one_warning() {
    let text = cloth(r#"preset: "silk""#);
    let (_, warnings) = read_scene_text(&text, Path::new("test.ron")).expect("it reads");
    let messages: Vec<&str> = warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert!(messages.len() <= 1, "{messages:?}");
    assert!(messages.iter().all(|message| message.starts_with("the preset `silk` sets ")), "{messages:?}");
}

#[test]
fn a_preset_can_be_a_file_and_its_mistakes_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    fs::write(folder.path().join("mine.ron"), "// Mine.\nnCloth(friction: 0.9)").expect("written");
    fs::write(folder.path().join("bad.ron"), "nCloth(frictoin: 0.9)").expect("written");
    fs::write(folder.path().join("rigid.ron"), "nRigid(friction: 0.9)").expect("written");
    let (scene, _) = read_scene_text(&cloth(r#"preset: "mine.ron""#), &file).expect("it reads");
    assert_eq!(scene.graph.node(scene.graph.find("c").expect("there")).get(&n_base::FRICTION), 0.9);
    for (name, message) in [
        ("silc", "there is no preset `silc`"),
        ("none.ron", "cannot read the preset `"),
        (
            "bad.ron",
            "the preset `bad.ron` cannot be read: `preset` is of type nCloth, which has no attribute `frictoin`",
        ),
        ("rigid.ron", "the preset `rigid.ron` is for nRigid, but `c` is of type nCloth"),
    ] {
        let text = cloth(&format!("preset: {name:?}"));
        let mistakes = read_scene_text(&text, &file).map(|_| ()).expect_err(name);
        assert!(mistakes[0].message.starts_with(message), "{mistakes:?}");
        assert_eq!(&text[mistakes[0].span.clone()], format!("{name:?}"));
    }
}

#[test]
fn a_preset_that_is_based_on_itself_is_refused_with_its_cycle() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, text).expect("written");
    };
    write("self.ron", r#"nCloth(preset: "./self.ron", friction: 0.9)"#);
    write("a.ron", r#"nCloth(preset: "sub/b.ron")"#);
    write("sub/b.ron", r#"nCloth(preset: "../a.ron")"#);
    for (name, cycle) in
        [("self.ron", "`self.ron` → `./self.ron`"), ("a.ron", "`a.ron` → `sub/b.ron` → `../a.ron`")]
    {
        let text = cloth(&format!("preset: {name:?}"));
        let mistakes = read_scene_text(&text, &file).map(|_| ()).expect_err(name);
        let message = &mistakes[0].message;
        assert!(message.ends_with(&format!("it is based on itself: {cycle}")), "{message}");
        assert_eq!(mistakes[0].help.as_deref(), Some("take out one `preset`"));
        assert_eq!(&text[mistakes[0].span.clone()], format!("{name:?}"));
    }
}

#[test]
fn a_preset_can_be_based_on_a_file_beside_it_but_not_through_endlessly_many() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    fs::create_dir(folder.path().join("sub")).expect("made");
    let write = |k: usize, text: &str| fs::write(folder.path().join(format!("sub/{k}.ron")), text);
    write(0, "nCloth(friction: 0.9)").expect("written");
    for k in 1..=100 {
        write(k, &format!("nCloth(preset: \"{}.ron\")", k - 1)).expect("written");
    }
    let (scene, _) = read_scene_text(&cloth(r#"preset: "sub/3.ron""#), &file).expect("it reads");
    assert_eq!(scene.graph.node(scene.graph.find("c").expect("there")).get(&n_base::FRICTION), 0.9);
    let mistakes =
        read_scene_text(&cloth(r#"preset: "sub/100.ron""#), &file).map(|_| ()).expect_err("too long");
    assert!(mistakes[0].message.ends_with("more than 64 presets are based on each other"), "{mistakes:?}");
}
