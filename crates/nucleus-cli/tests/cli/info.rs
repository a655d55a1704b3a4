//! `nucleus info`.

use std::fs;

use crate::sample::{END, assert_refused, cache, folder, nucleus, scene, stderr, stdout};

#[test]
fn a_cache_shows_its_run_and_its_objects() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["info", "fall.mcap", "--verify"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(said.contains("a run of fall.ron"), "{said}");
    assert!(said.contains("1 to 6 at 24 per second"), "{said}");
    assert!(said.contains("object sheet: cloth, 4 points, 1 face, 1 x 0 x 1 m"), "{said}");
    assert!(said.contains("nothing is lost"), "{said}");
}

#[test]
fn json_has_the_same_facts() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["info", "fall.mcap", "--json"]);
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(said["frames"]["last"], END);
    assert_eq!(said["moments"], END);
    assert_eq!(said["objects"][0]["size_metres"][2], 1.0);
    assert_eq!(said["loss"]["none"], true);
}

#[test]
fn a_cache_that_has_lost_frames_exits_with_1() {
    let folder = folder();
    let path = cache(folder.path());
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let output = nucleus(folder.path(), &["info", "fall.mcap"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("the file was cut off"), "{}", stdout(&output));
}

#[test]
fn a_file_that_cannot_be_opened_is_named_with_the_reason() {
    let folder = folder();
    fs::write(folder.path().join("empty.mcap"), "").unwrap();
    fs::write(folder.path().join("text.mcap"), "not a cache at all").unwrap();
    fs::create_dir(folder.path().join("folder.mcap")).unwrap();
    let info = |name: &str| nucleus(folder.path(), &["info", name]);
    assert_refused(&info("none.mcap"), "cannot read `none.mcap`: No such file");
    assert_refused(&info("empty.mcap"), "cannot open `empty.mcap`: the file is empty");
    assert_refused(&info("text.mcap"), "cannot open `text.mcap`: this is not an MCAP file");
    assert_refused(&info("folder.mcap"), "`folder.mcap` is a folder");
}

#[test]
fn a_scene_shows_its_nodes_and_the_cost_of_its_passes() {
    let folder = folder();
    scene(folder.path(), 5, "");
    let said = stdout(&nucleus(folder.path(), &["info", "drape.ron"]));
    assert!(said.contains("node cloth1: nCloth"), "{said}");
    // Seven by seven points: 2 * 6 * 7 edges, 6 * 6 faces.
    assert!(said.contains("object cloth1: cloth, 49 points, 84 edges, 36 faces, 0.5 x 0 x 0.5 m"), "{said}");
    let output = nucleus(folder.path(), &["info", "drape.ron", "--json"]);
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let passes = said["nuclei"][0]["passes"].as_array().unwrap();
    let stretch = passes.iter().find(|pass| pass["name"] == "stretch").expect("cloth has links");
    // Two cross links in each face take part in stretch.
    assert_eq!(stretch["rows"], 84 + 2 * 36);
}

#[test]
fn a_scene_of_two_nuclei_shows_the_cost_and_the_stiffness_of_each() {
    let folder = folder();
    let text = r#"Scene(
    time: (start: 1, end: 2, fps: 24),
    nodes: {
        "n1": nucleus(subSteps: 2, evaluations: 24),
        "n2": nucleus(subSteps: 5, evaluations: 24),
        "p1": polyPlane(subdivisions: (6, 6)),
        "p2": polyPlane(subdivisions: (3, 3)),
        "c1": nCloth(inputMesh: "p1", nucleus: "n1", stretchResistance: 20),
        "c2": nCloth(inputMesh: "p2", nucleus: "n2", stretchResistance: 80),
    },
)
"#;
    fs::write(folder.path().join("two.ron"), text).unwrap();
    let output = nucleus(folder.path(), &["info", "two.ron"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(said.contains("n1: 2 substeps per frame") && said.contains("n2: 5 substeps per frame"), "{said}");
    assert!(said.contains("n1: pass stretch") && said.contains("n2: pass stretch"), "{said}");
    let output = nucleus(folder.path(), &["info", "two.ron", "--json"]);
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // Edges and two cross links in each face.
    for (k, name, substeps, rows) in [(0, "n1", 2, 84 + 2 * 36), (1, "n2", 5, 24 + 2 * 9)] {
        let nucleus = &said["nuclei"][k];
        assert_eq!((nucleus["name"].as_str(), nucleus["substeps"].as_u64()), (Some(name), Some(substeps)));
        let passes = nucleus["passes"].as_array().unwrap();
        let stretch = passes.iter().find(|pass| pass["name"] == "stretch").expect("cloth has links");
        assert_eq!(stretch["rows"], rows, "{name}");
    }
    let stiffness = |k: usize| said["objects"][k]["stretch_stiffness"].as_f64().unwrap();
    assert!(stiffness(1) > stiffness(0), "{said}");
}
