//! Scenes of Maya: `nucleus import`, `nucleus run scene.ma`, `nucleus export --as ma`.

use std::fs;
use std::path::Path;

use crate::sample::{assert_refused, folder, nucleus, stderr, stdout};

/// Puts a scene of `tests/maya` into a folder.
fn bring(folder: &Path, name: &str) {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/maya").join(name);
    fs::copy(from, folder.join(name)).unwrap();
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// A scene without its comments, which name the file that it is from.
fn scene_of(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.starts_with("//")).collect()
}

#[test]
fn an_imported_scene_is_written_with_its_omissions_at_the_head() {
    let folder = folder();
    bring(folder.path(), "constraint.ma");
    let output = nucleus(folder.path(), &["import", "constraint.ma", "-o", "out.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = read(folder.path(), "out.ron");
    assert!(text.starts_with("// Imported from `constraint.ma`."), "{text}");
    let listed = text.lines().filter(|line| line.starts_with("// - ")).count();
    let said = stdout(&output) + &stderr(&output);
    assert!(listed > 0 && said.contains(&format!("{listed} omission")), "{listed}: {said}");
    let checked = nucleus(folder.path(), &["check", "out.ron"]);
    assert_eq!(checked.status.code(), Some(0), "{}", stderr(&checked));
}

#[test]
fn a_maya_scene_runs_and_its_cache_holds_its_objects() {
    let folder = folder();
    bring(folder.path(), "drape.ma");
    let output = nucleus(folder.path(), &["run", "drape.ma", "--frames", "2"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let cache = nucleus_cache::Playback::open(folder.path().join("drape.mcap")).unwrap();
    let names: Vec<_> = cache.objects().iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["nCloth1", "nRigid1"]);
    assert_eq!(cache.run().scene_text, read(folder.path(), "drape.ron"));
}

#[test]
fn a_scene_exported_to_maya_and_imported_again_is_the_same() {
    let folder = folder();
    bring(folder.path(), "drape.ma");
    for arguments in [
        ["import", "drape.ma", "-o", "first.ron", ""],
        ["export", "first.ron", "--as=ma", "-o", "back.ma"],
        ["import", "back.ma", "-o", "again.ron", ""],
    ] {
        let arguments: Vec<&str> = arguments.into_iter().filter(|argument| !argument.is_empty()).collect();
        let output = nucleus(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    }
    let [first, again] = ["first.ron", "again.ron"].map(|name| read(folder.path(), name));
    assert_eq!(scene_of(&first), scene_of(&again));
}

#[test]
fn a_binary_scene_is_refused_with_the_way_out() {
    let folder = folder();
    fs::write(folder.path().join("scene.mb"), "FOR4\0\0\0\u{10}Maya").unwrap();
    for command in ["import", "run"] {
        let output = nucleus(folder.path(), &[command, "scene.mb"]);
        assert_refused(&output, "save it as Maya ASCII");
    }
}

#[test]
fn a_scene_that_is_cut_off_says_where_and_keeps_what_it_has() {
    let folder = folder();
    bring(folder.path(), "drape.ma");
    let text = read(folder.path(), "drape.ma");
    fs::write(folder.path().join("cut.ma"), &text[..2000]).unwrap();
    let output = nucleus(folder.path(), &["import", "cut.ma", "-o", "cut.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output) + &stderr(&output);
    assert!(said.contains("`cut.ma:62:2`: the file ends inside this statement"), "{said}");
}

#[test]
fn a_maya_scene_where_a_scene_or_a_cache_belongs_points_to_import() {
    let folder = folder();
    bring(folder.path(), "drape.ma");
    for command in ["check", "info", "graph", "trade", "fmt", "export", "render"] {
        let output = nucleus(folder.path(), &[command, "drape.ma"]);
        assert_refused(
            &output,
            "`drape.ma` is a Maya scene: `nucleus import drape.ma` makes a scene (.ron) of it",
        );
    }
    let missing = nucleus(folder.path(), &["import", "no.ma"]);
    assert_eq!(stderr(&missing).matches("os error 2").count(), 1, "{}", stderr(&missing));
}

#[test]
fn a_mesh_whose_name_nothing_has_is_refused() {
    let folder = folder();
    bring(folder.path(), "drape.ma");
    fs::write(folder.path().join("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n").unwrap();
    let output = nucleus(folder.path(), &["import", "drape.ma", "--mesh", "pPlane=m.obj"]);
    assert_refused(&output, "`--mesh pPlane=...` names no mesh that is needed; there is `pPlane1`");
    assert!(!folder.path().join("drape.ron").exists());
}

#[test]
fn files_of_values_are_found_from_the_folder_of_an_exported_and_of_an_imported_scene() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    for name in ["scenes", "meshes", "out/maya", "elsewhere"] {
        fs::create_dir_all(at(name)).unwrap();
    }
    fs::write(at("meshes/beads.obj"), "v 0 1 0\nv 0 3 0\n").unwrap();
    let scene = r#"Scene(time: (start: 1, end: 3, fps: 24), nodes: {"n": nucleus(),
        "p": nParticle(position0: file("../meshes/beads.obj"), velocity0: file("../meshes/beads.obj"))})"#;
    fs::write(at("scenes/beads.ron"), scene).unwrap();
    let run = |arguments: &[&str]| {
        let output = nucleus(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    };
    run(&["export", "scenes/beads.ron", "--as", "ma", "-o", "out/maya/beads.ma"]);
    assert!(read(folder.path(), "out/maya/beads.ma").contains("file:../../meshes/beads.obj"));
    run(&["import", "out/maya/beads.ma", "-o", "elsewhere/beads.ron"]);
    let text = read(folder.path(), "elsewhere/beads.ron");
    assert_eq!(text.matches("file(\"../meshes/beads.obj\")").count(), 2, "{text}");
    run(&["import", "out/maya/beads.ma", "-o", "beads.ron"]);
    assert!(read(folder.path(), "beads.ron").contains("file(\"meshes/beads.obj\")"));
    // A file that is in no place is named, with its effect.
    fs::remove_file(at("meshes/beads.obj")).unwrap();
    let lost = nucleus(folder.path(), &["import", "out/maya/beads.ma", "-o", "lost/beads.ron"]);
    let said = stdout(&lost);
    assert!(said.contains("`p.position0`: `../../meshes/beads.obj` is neither beside"), "{said}");
}

#[test]
fn the_recorded_positions_of_a_scene_are_found_from_the_folder_of_its_maya_scene() {
    let folder = folder();
    for part in ["scene/points", "maya"] {
        fs::create_dir_all(folder.path().join(part)).unwrap();
    }
    for frame in 1..=3 {
        let file = folder.path().join(format!("scene/points/p.{frame:04}.obj"));
        fs::write(file, format!("v {frame} 0 0\n")).unwrap();
    }
    let text = r#"Scene(time: (start: 1, end: 3, fps: 24), nodes: { "n": nucleus(),
        "p": nParticle(position0: [(1, 0, 0)], playFromCache: true, cacheFile: "points/p.####.obj")})"#;
    fs::write(folder.path().join("scene/p.ron"), text).unwrap();
    let output = nucleus(folder.path(), &["export", "scene/p.ron", "--as=ma", "-o", "maya/p.ma"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let written = read(folder.path(), "maya/p.ma");
    assert!(written.contains("../scene/points/p.####.obj"), "{written}");
    let output = nucleus(folder.path(), &["run", "maya/p.ma", "-o", "again.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
