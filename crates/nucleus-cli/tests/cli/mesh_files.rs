//! Meshes of a scene from the files of other tools; here from exports of a run.

use std::fs;
use std::path::Path;

use nucleus_cache::{FaceSet, Playback};

use crate::sample::{folder, nucleus, scene, stderr, stdout};

/// Frames of the run that is exported.
const FRAMES: u32 = 5;

fn read_scene(file: &str, more: &str) -> String {
    format!(
        r#"Scene(
            time: (start: 1, end: {FRAMES}, fps: 24),
            nodes: {{
                "nucleus1": nucleus(spaceScale: 0.01),
                "shape": mesh(file: "{file}"{more}), "rigid": nRigid(inputMesh: "shape"),
                "speck": nParticle(position0: [(0, 900, 0)], radius: 0.1),
            }},
        )"#
    )
}

/// The positions of a collider that is made from a file, at each frame in centimetres.
fn collider(folder: &Path, file: &str, more: &str) -> Vec<Vec<[f32; 3]>> {
    fs::write(folder.join("read.ron"), read_scene(file, more)).unwrap();
    let run = nucleus(folder, &["run", "read.ron", "--force"]);
    assert!(folder.join("read.mcap").exists(), "{}", stderr(&run));
    positions(&folder.join("read.mcap"), "rigid")
}

fn positions(cache: &Path, name: &str) -> Vec<Vec<[f32; 3]>> {
    let mut cache = Playback::open(cache).unwrap();
    let object = cache.objects().iter().position(|object| object.name == name).unwrap();
    (0..cache.time_samples().len()).map(|sample| cache.positions(object, sample).unwrap()).collect()
}

/// A run of a sheet that falls on a ball; the positions of the sheet at each frame in centimetres.
fn run(folder: &Path) -> Vec<Vec<[f32; 3]>> {
    scene(folder, FRAMES, "finite");
    assert!(nucleus(folder, &["run", "drape.ron", "--force"]).status.success());
    let sheet = positions(&folder.join("drape.mcap"), "cloth1");
    assert!(sheet[0] != sheet[4], "it falls");
    sheet
}

fn export(folder: &Path, arguments: &[&str]) {
    let output = nucleus(folder, &[&["export", "drape.mcap"], arguments].concat());
    assert!(output.status.success(), "{}", stderr(&output));
}

fn assert_close(found: &[Vec<[f32; 3]>], expected: &[Vec<[f32; 3]>]) {
    assert_eq!(found.len(), expected.len());
    for (frame, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(expected) {
            let error = (0..3).map(|axis| (a[axis] - b[axis]).abs()).fold(0.0, f32::max);
            assert!(error < 1e-3, "frame {frame}: {a:?} instead of {b:?}");
        }
    }
}

#[test]
fn an_animated_gltf_or_usd_moves_a_collider_as_the_cloth_that_was_exported() {
    let folder = folder();
    let expected = run(folder.path());
    for file in ["run.glb", "run.usda", "run.usdc"] {
        export(folder.path(), &["-o", file]);
        assert_close(&collider(folder.path(), file, r#", object: "cloth1""#), &expected);
    }
}

#[test]
fn a_sequence_of_ply_files_moves_a_collider_as_the_cloth_that_was_exported() {
    let folder = folder();
    let expected = run(folder.path());
    export(folder.path(), &["--as", "ply", "-o", "sheets", "--object", "cloth*", "--object", "cloth1"]);
    assert_close(&collider(folder.path(), "sheets/cloth1.####.ply", ""), &expected);
}

#[test]
fn cloth_from_a_usd_file_has_its_texture_coordinates() {
    let folder = folder();
    run(folder.path());
    export(folder.path(), &["-o", "run.usdc", "--object", "cloth1"]);
    let text = r#"Scene(
        time: (start: 1, end: 2, fps: 24),
        nodes: {
            "nucleus1": nucleus(spaceScale: 0.01),
            "sheet": mesh(file: "run.usdc"),
            "cloth": nCloth(inputMesh: "sheet", bendMapType: perVertex, bendPerVertex: expression("u > 0.5 ? 2 : 1")),
        },
    )"#;
    fs::write(folder.path().join("again.ron"), text).unwrap();
    let output = nucleus(folder.path(), &["run", "again.ron"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let uvs = |cache: &str, name: &str| {
        let cache = Playback::open(folder.path().join(cache)).unwrap();
        cache.run().texture_coordinates[name].clone()
    };
    assert_eq!(uvs("again.mcap", "cloth"), uvs("drape.mcap", "cloth1"));
}

#[test]
fn groups_and_materials_of_an_obj_file_come_back_from_the_cache_and_from_its_export() {
    let folder = folder();
    let mesh = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\nv 2 0 1\nmtllib shop.mtl\n\
                usemtl silk\nf 1 2 3 4\ng hem\nusemtl wool\nf 2 5 6 3\n";
    fs::write(folder.path().join("sheet.obj"), mesh).unwrap();
    let run = |name: &str, file: &str| {
        let text = format!(
            r#"Scene(
                time: (start: 1, end: 2, fps: 24),
                nodes: {{ "n": nucleus(), "m": mesh(file: "{file}"), "cloth": nCloth(inputMesh: "m") }},
            )"#
        );
        fs::write(folder.path().join(format!("{name}.ron")), text).unwrap();
        let output = nucleus(folder.path(), &["run", &format!("{name}.ron")]);
        assert!(output.status.success(), "{}", stderr(&output));
        Playback::open(folder.path().join(format!("{name}.mcap"))).unwrap().run().face_sets["cloth"].clone()
    };
    let sets = run("drape", "sheet.obj");
    let set = |name: &str, faces: &[u32]| FaceSet { name: name.to_owned(), faces: faces.to_vec() };
    assert_eq!(sets.groups, [set("hem", &[1])]);
    assert_eq!(sets.materials, [set("silk", &[0]), set("wool", &[1])]);
    let info = stdout(&nucleus(folder.path(), &["info", "drape.mcap"]));
    assert!(info.contains("materials   silk (1 face), wool (1 face)"), "{info}");
    export(folder.path(), &["--as", "obj", "-o", "out"]);
    let again = run("again", "out/cloth.0002.obj");
    assert_eq!(again.materials, sets.materials);
    assert!(again.groups.contains(&sets.groups[0]), "{again:?}");
}

/// What `nucleus check` says about a mesh of this file, without the excerpt of the scene.
fn refusal(folder: &Path, file: &str, more: &str) -> String {
    fs::write(folder.join("read.ron"), read_scene(file, more)).unwrap();
    let output = nucleus(folder, &["check", "read.ron"]);
    assert_eq!(output.status.code(), Some(2));
    stderr(&output).lines().next().unwrap_or_default().to_owned()
}

#[test]
fn a_mesh_file_that_cannot_be_used_is_an_error_at_its_place() {
    let folder = folder();
    let place = folder.path();
    fs::write(place.join("a.glb"), "secret").unwrap();
    fs::write(place.join("a.ply"), "ply\nformat secret 1.0\nend_header\n").unwrap();
    fs::write(place.join("b.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let refusal = |file, more| refusal(place, file, more);
    assert_eq!(refusal("a.glb", ""), "error: `a.glb`: it is no valid glTF file");
    assert_eq!(refusal("a.ply", ""), "error: `a.ply`: its format is none of PLY's three");
    assert!(refusal("no.usd", "").starts_with("error: cannot read `no.usd`: "));
    assert_eq!(refusal("a.####.glb", ""), "error: `shape` names a glTF file for each frame");
    assert_eq!(
        refusal("b.obj", r#", object: "a""#),
        "error: `object` of `shape` has no meaning for `b.obj`, which is one mesh"
    );
    run(place);
    export(place, &["-o", "run.usda"]);
    assert_eq!(
        refusal("run.usda", r#", object: "hat""#),
        "error: `run.usda`: it has no mesh at or below a prim `hat`"
    );
}

#[test]
fn a_mesh_file_counts_against_the_memory_limit() {
    let folder = folder();
    run(folder.path());
    export(folder.path(), &["-o", "run.glb"]);
    fs::write(folder.path().join("read.ron"), read_scene("run.glb", "")).unwrap();
    let output = nucleus(folder.path(), &["--memory", "20K", "check", "read.ron"]);
    assert!(stderr(&output).contains("to read `run.glb` takes about"), "{}", stderr(&output));
    assert_eq!(output.status.code(), Some(2));
}
