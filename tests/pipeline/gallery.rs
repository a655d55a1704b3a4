//! Every scene of the gallery, without running it to its end, which `cargo xtask ci` does.

use std::fs;

use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;
use nucleus_graph::scene::write_scene;
use nucleus_tests::gallery::{program, scene, scenes};

/// A hash of all bits of the state after three frames.
fn hash(program: &Program) -> u64 {
    let mut run = Simulation::<f32>::new(program, 1);
    for _ in 0..3 {
        run.advance(&mut ());
    }
    run.solver().state_hash()
}

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
fn a_scene_gives_the_same_bits_after_it_was_written_and_read_back() {
    for file in scenes() {
        let read = scene(&fs::read_to_string(&file).expect("it is text"), &file);
        let again = scene(&write_scene(&read), &file);
        assert_eq!(read, again, "{}", file.display());
        assert_eq!(hash(&program(&read)), hash(&program(&again)), "{}", file.display());
    }
}
