//! Every scene of the gallery, without running it to its end, which `cargo xtask ci` does.

use std::fs;

use nucleus_graph::scene::write_scene;
use nucleus_tests::gallery::{program, scene, scenes};

#[test]
fn every_scene_reads_and_compiles_without_a_warning() {
    let scenes = scenes();
    assert!(scenes.len() >= 5, "{scenes:?}");
    for file in scenes {
        program(&scene(&fs::read_to_string(&file).expect("it is text"), &file));
    }
}

#[test]
fn every_scene_has_checks() {
    for file in scenes() {
        let scene = scene(&fs::read_to_string(&file).expect("it is text"), &file);
        let names: Vec<&str> = scene.checks.iter().map(|check| check.form().name).collect();
        assert!(names.contains(&"finite") && names.len() > 1, "{}: {names:?}", file.display());
    }
}

#[test]
fn a_scene_compiles_to_the_same_program_after_it_was_written_and_read_back() {
    for file in scenes() {
        let read = scene(&fs::read_to_string(&file).expect("it is text"), &file);
        let again = scene(&write_scene(&read), &file);
        assert_eq!(read, again, "{}", file.display());
        let [first, second] = [&read, &again].map(|scene| format!("{:?}", program(scene)));
        assert!(first == second, "{}", file.display());
    }
}
