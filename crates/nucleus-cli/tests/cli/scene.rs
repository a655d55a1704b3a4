//! `nucleus new`, `check`, `fmt` and `graph`, and the errors of a scene in every command that reads one.

use std::fs;

use nucleus_cache::{ObjectKind, Playback};

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

#[test]
fn a_new_scene_can_run_and_replaces_no_file() {
    let folder = folder();
    let help = stdout(&nucleus(folder.path(), &["new", "--help"]));
    let listed: Vec<&str> = help.lines().filter_map(|line| line.trim_start().strip_prefix("- ")).collect();
    let templates = listed.iter().filter_map(|line| line.split_once(':')).map(|(name, _)| name);
    for template in templates.chain(["hang"]) {
        let file = format!("{template}.ron");
        assert!(nucleus(folder.path(), &["new", &file, "--template", template]).status.success());
        let said = stdout(&nucleus(folder.path(), &["check", &file]));
        assert!(said.contains("can run: no errors, no warnings"), "{said}");
        let run = nucleus(folder.path(), &["run", &file, "--frames", "3", "--record", "none"]);
        assert!(run.status.success(), "{run:?}");
    }
    assert!(listed.len() >= 10 && listed.iter().any(|line| line.starts_with("liquid: ")), "{help}");
    let again = nucleus(folder.path(), &["new", "drape.ron"]);
    assert!(
        folder.path().join("garment_skirt.obj").exists() && folder.path().join("liquid_glass.obj").exists()
    );
    assert_refused(&again, "`drape.ron` exists; give another name");
    let text = nucleus(folder.path(), &["new", "first.txt"]);
    assert_refused(&text, "scenes end in `.ron`: write `first.ron`");
    assert!(!folder.path().join("first.txt").exists());
}

#[test]
fn the_cape_and_the_curtain_of_the_templates_hang_in_folds() {
    let folder = folder();
    for (template, frames, hem) in [("cape", "30", 0..=42), ("curtain", "50", 1886..=1926)] {
        assert!(nucleus(folder.path(), &["new", "--template", template]).status.success());
        let run = nucleus(folder.path(), &["run", &format!("{template}.ron"), "--frames", frames]);
        assert!(run.status.success(), "{}", stderr(&run));
        let mut cache = Playback::open(folder.path().join(template).with_extension("mcap")).unwrap();
        let cloth = cache.objects().iter().position(|object| object.kind == ObjectKind::Cloth).unwrap();
        let points = cache.positions(cloth, cache.time_samples().len() - 1).unwrap();
        let distance = |a: [f32; 3], b: [f32; 3]| {
            [0, 1, 2].map(|axis| (a[axis] - b[axis]).powi(2)).iter().sum::<f32>().sqrt()
        };
        let hem = &points[hem];
        let length: f32 = hem.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
        let width = distance(hem[0], hem[hem.len() - 1]);
        assert!(length > 1.2 * width, "{template}: a hem of {length} across {width}");
    }
}

#[cfg(unix)]
#[test]
fn printed_commands_quote_paths_with_spaces() {
    let folder = folder();
    fs::create_dir(folder.path().join("my dir")).expect("a folder");
    let said = stdout(&nucleus(folder.path(), &["new", "my dir/shot 1.ron", "--template", "flag"]));
    assert!(said.contains("`nucleus play 'my dir/shot 1.ron'`"), "{said}");
    let said = stdout(&nucleus(folder.path(), &["run", "my dir/shot 1.ron", "--frames", "2"]));
    assert!(said.contains("`nucleus play 'shot 1.mcap'`"), "{said}");
    assert!(said.contains("`nucleus render 'shot 1.mcap'`"), "{said}");
    let said = stderr(&nucleus(folder.path(), &["run", "shot 1.mcap"]));
    assert!(said.contains("`nucleus play 'shot 1.mcap'`"), "{said}");
    let said = stderr(&nucleus(folder.path(), &["run", "my dir/shot 1.ron", "--quality", "1%"]));
    assert!(said.contains("`nucleus trade 'my dir/shot 1.ron'`"), "{said}");
}

#[test]
fn a_formatted_scene_keeps_its_comments_and_is_not_formatted_again() {
    let folder = folder();
    nucleus(folder.path(), &["new", "a.ron"]);
    let before = nucleus(folder.path(), &["fmt", "--check", "a.ron"]);
    assert_eq!(before.status.code(), Some(1));
    assert!(nucleus(folder.path(), &["fmt", "a.ron"]).status.success());
    let text = fs::read_to_string(folder.path().join("a.ron")).expect("it is there");
    assert!(text.contains("// An attribute set here overrides the preset."), "{text}");
    assert!(nucleus(folder.path(), &["fmt", "--check", "a.ron"]).status.success());
}

#[test]
fn a_scene_with_errors_is_not_formatted() {
    let folder = folder();
    fs::write(folder.path().join("a.ron"), "Scene(nodes: {})").expect("written");
    let output = nucleus(folder.path(), &["fmt", "a.ron"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(folder.path().join("a.ron")).expect("it is there"), "Scene(nodes: {})");
}

#[test]
fn a_graph_shows_all_connections() {
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
fn a_scene_without_errors_can_run() {
    let folder = folder();
    scene(folder.path(), 3, "finite");
    let output = nucleus(folder.path(), &["check", "drape.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("`drape.ron` can run"), "{}", stdout(&output));
}

#[test]
fn all_errors_are_shown_in_place_and_counted() {
    let folder = folder();
    scene(folder.path(), 3, "finit");
    let path = folder.path().join("drape.ron");
    fs::write(&path, fs::read_to_string(&path).unwrap().replace("subSteps", "subStebs")).unwrap();
    for command in ["check", "run", "info", "play"] {
        let output = nucleus(folder.path(), &[command, "drape.ron"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {said}");
        assert!(said.contains("drape.ron:4:") && said.contains("did you mean `subSteps`?"), "{said}");
        assert!(said.contains("did you mean `finite`?") && said.ends_with("2 errors\n"), "{said}");
        assert!(!said.contains('\u{1b}'), "no colours where there is no terminal: {said}");
    }
}

#[test]
fn warnings_alone_do_not_fail() {
    let folder = folder();
    scene(folder.path(), 3, "finite");
    let path = folder.path().join("drape.ron");
    fs::write(
        &path,
        fs::read_to_string(&path)
            .unwrap()
            .replace("thickness: 1", "thickness: 1, cacheableAttributes: dynamicState"),
    )
    .unwrap();
    let output = nucleus(folder.path(), &["check", "drape.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("`cacheableAttributes`") && stderr(&output).ends_with("1 warning\n"));
}

#[test]
fn a_file_that_is_no_scene_is_refused_by_name() {
    let folder = folder();
    fs::write(folder.path().join("bytes.ron"), [0xff, 0xfe, 0x00]).unwrap();
    let check = |name: &str| nucleus(folder.path(), &["check", name]);
    assert_refused(&check("none.ron"), "cannot read `none.ron`: No such file");
    assert_refused(&check("."), "it is a folder, not a file");
    assert_refused(&check("bytes.ron"), "`bytes.ron` is not text");
}
