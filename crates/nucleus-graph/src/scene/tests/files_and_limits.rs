//! Files that a scene names, the memory limit, and widths beyond the extent of a scene.

use std::fs;

use super::mistakes::reported_in;
use super::*;

#[test]
fn missing_and_broken_files_are_named_with_their_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    fs::write(folder.path().join("broken.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").expect("written");
    fs::write(folder.path().join("flat.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").expect("written");
    let text = with_nodes(
        r#""a": mesh(file: "missing.obj"), "b": mesh(file: "broken.obj"), "f": mesh(file: "flat.obj"), "m": mesh(),
           "c1": nCloth(inputMesh: "a"), "c2": nCloth(inputMesh: "b"), "c3": nCloth(inputMesh: "f"),
           "c4": nCloth(inputMesh: "m", damp: oops)"#,
    );
    let found = reported_in(&text, &file);
    assert!(found[0].1.contains("missing.obj") && found[0].0 == "\"missing.obj\"", "{found:?}");
    assert!(found[1].1.contains("broken.obj") && found[1].1.contains("line 4"), "{found:?}");
    assert_eq!(found[2].1, "`f` has no face with an area");
    assert_eq!(found[3].1, "`damp` of `c4` takes a number, found the word `oops`");
    assert_eq!(found.len(), 4);
    let only = with_nodes(r#""m": mesh(), "c": nCloth(inputMesh: "m")"#);
    let (scene, _) = read_scene_text(&only, &file).expect("it reads");
    let errors = crate::compile::compile(&scene).map(|_| ()).expect_err("there is no file");
    assert_eq!(errors[0].message, "`m` has no `file`");
}

#[test]
fn a_missing_file_and_a_file_that_is_not_utf8_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = read_scene(folder.path().join("none.ron")).map(|_| ()).expect_err("it is missing");
    assert!(missing[0].message.starts_with("cannot read `"), "{missing:?}");
    let binary = folder.path().join("binary.ron");
    fs::write(&binary, [b'S', 0xff, 0xfe]).expect("written");
    let binary = read_scene(binary).map(|_| ()).expect_err("it is not text");
    assert_eq!(
        (binary[0].span.clone(), binary[0].message.as_str()),
        (1..1, "this is not text: scenes are UTF-8")
    );
}

/// Message and help of all diagnostics, with a memory limit in bytes.
fn diagnostics_within(text: &str, bytes: u64) -> Vec<(String, Option<String>)> {
    let memory = crate::memory::Memory(bytes);
    let read = read_scene_within(text, Path::new("test.ron"), memory);
    let found = match read {
        Ok((scene, _)) => crate::compile::compile(&scene).map(|_| ()).expect_err("it is too large"),
        Err(found) => found,
    };
    found.into_iter().map(|one| (one.message, one.help)).collect()
}

#[test]
fn nodes_that_take_too_much_memory_are_refused_with_both_figures() {
    let scene = |nodes: &str| with_nodes(nodes);
    let cloth = |mesh: &str| scene(&format!(r#""p": {mesh}, "c1": nCloth(inputMesh: "p")"#));
    let all = 4096;
    for mesh in [
        format!("polyPlane(subdivisions: ({all}, {all}))"),
        format!("polyCube(subdivisionsWidth: {all}, subdivisionsHeight: {all}, subdivisionsDepth: {all})"),
        format!("polyCylinder(subdivisionsAxis: {all}, subdivisionsHeight: {all}, subdivisionsCaps: {all})"),
        format!("polySphere(subdivisionsAxis: {all}, subdivisionsHeight: {all})"),
    ] {
        let found = diagnostics_within(&cloth(&mesh), 1_000_000_000);
        assert_eq!(found.len(), 1, "{mesh}: {found:?}");
        assert!(
            found[0].0.starts_with("`c1`, of ") && found[0].0.ends_with("the limit is 1.0 GB"),
            "{found:?}"
        );
        let help = found[0].1.as_deref().unwrap_or_default();
        assert!(help.starts_with("make `p` coarser, or allow more: `--memory "), "{help}");
    }
    // Each alone would fit.
    let two = r#""p": polyPlane(subdivisions: (100, 100)), "q": polyPlane(subdivisions: (100, 100)),
        "c1": nCloth(inputMesh: "p"), "c2": nCloth(inputMesh: "q")"#;
    let found = diagnostics_within(&scene(two), 40_000_000);
    assert!(found.len() == 1 && found[0].0.contains(" with all before it; the limit is 40 MB"), "{found:?}");
    // Nodes and the text itself count too.
    let nodes: String = (0..100).map(|k| format!("\"t{k}\": transform(), ")).collect();
    assert!(diagnostics_within(&scene(&nodes), 200_000)[0].0.contains(" nodes take about "));
    assert!(diagnostics_within(&scene(&nodes), 1_000)[0].0.contains("reading it takes about "));
    let pinned = r#""p": polyPlane(subdivisions: (100, 100)), "c1": nCloth(inputMesh: "p"),
        "pin": dynamicConstraint(components: ["c1.vtx[0:9999]"])"#;
    assert!(
        diagnostics_within(&scene(pinned), 500_000)[0]
            .0
            .starts_with("to constrain 10000 points takes about 1.0 MB")
    );
}

#[test]
fn the_cross_links_of_a_face_of_many_corners_are_warned_of_and_count_as_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let polygon = |name: &str, corners: usize| {
        let points = (0..corners).map(|k| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / corners as f64).sin_cos();
            format!("v {cosine} 0 {}\n", -sine)
        });
        let face = (1..=corners).map(|k| format!(" {k}"));
        let text: String = points.chain(["f".to_owned()]).chain(face).collect();
        fs::write(folder.path().join(name), text + "\n").expect("written");
    };
    polygon("many.obj", 100);
    polygon("few.obj", 64);
    let compiled = |mesh: &str, cloth: &str, bytes: u64| {
        let text =
            with_nodes(&format!(r#""m": mesh(file: "{mesh}"), "c1": nCloth(inputMesh: "m", {cloth})"#));
        let memory = crate::memory::Memory(bytes);
        let file = folder.path().join("scene.ron");
        let (scene, _) = read_scene_within(&text, &file, memory).expect("it reads");
        let program = crate::compile::compile(&scene).map(|program| program.warnings().to_vec());
        let found = program.unwrap_or_else(|errors| errors);
        found.into_iter().map(|one| one.message).collect::<Vec<_>>()
    };
    let warning = "`c1` has a face of 100 corners, which takes 4850 cross links";
    assert_eq!(compiled("many.obj", "", 1_000_000), [warning]);
    assert_eq!(compiled("many.obj", "addCrossLinks: false", 1_000_000), Vec::<String>::new());
    assert_eq!(compiled("few.obj", "", 1_000_000), Vec::<String>::new());
    // The cloth alone takes 110 kB, and its cross links 364 kB.
    let refused = compiled("many.obj", "", 300_000);
    assert!(refused[0].starts_with("`c1`, with 4850 cross links, takes about 364 kB"), "{refused:?}");
    assert_eq!(compiled("many.obj", "addCrossLinks: false", 300_000), Vec::<String>::new());
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    let made = std::process::Command::new("mkfifo").arg(folder.path().join("pipe")).status();
    assert!(made.expect("there is a mkfifo").success());
    for named in ["pipe", "/dev/zero"] {
        for nodes in [
            format!(r#""m": mesh(file: "{named}"), "c1": nCloth(inputMesh: "m")"#),
            format!(r#""p": polyPlane(), "c1": nCloth(inputMesh: "p", massPerVertex: file("{named}"))"#),
            format!(r#""p": polyPlane(), "c1": nCloth(inputMesh: "p", massMap: texture("{named}"))"#),
            format!(r#""p": polyPlane(), "c1": nCloth(inputMesh: "p", startPositions: file("{named}"))"#),
        ] {
            let (scene, _) = read_scene_text(&with_nodes(&nodes), &file).expect("it reads");
            let found = crate::compile::compile(&scene).map(|_| ()).expect_err("it is no file");
            assert!(found[0].message.ends_with("it is a device or a pipe, not a file"), "{found:?}");
        }
    }
    let found = read_scene(folder.path().join("pipe")).map(|_| ()).expect_err("it is no file");
    assert!(found[0].message.contains("it is a device or a pipe"), "{found:?}");
}

/// A scene may name any file, so a message must not reveal its content.
#[test]
fn no_message_quotes_the_content_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    for (text, name) in [("users:secret:1\n", "a.txt"), ("1 secret\n", "b.txt"), ("v 1 secret 2\n", "c.obj")]
    {
        fs::write(folder.path().join(name), text).expect("written");
    }
    fs::write(folder.path().join("d.ron"), "secret:x:0\n").expect("written");
    fs::write(folder.path().join("e.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 secret\n").expect("written");
    let of = |rest: &str| with_nodes(&format!(r#""p": polyPlane(), "c1": nCloth({rest})"#));
    let in_file = |name: &str| of(&format!(r#"inputMesh: "p", massPerVertex: file("{name}")"#));
    let mesh =
        |name: &str| with_nodes(&format!(r#""m": mesh(file: "{name}"), "c1": nCloth(inputMesh: "m")"#));
    for text in [
        in_file("a.txt"),
        in_file("b.txt"),
        of(r#"inputMesh: "p", startPositions: file("c.obj")"#),
        of(r#"inputMesh: "p", startPositions: file("a.txt")"#),
        of(r#"inputMesh: "p", massMap: texture("a.txt")"#),
        of(r#"inputMesh: "p", preset: "d.ron""#),
        mesh("c.obj"),
        mesh("e.obj"),
    ] {
        let found = match read_scene_text(&text, &file) {
            Ok((scene, _)) => crate::compile::compile(&scene).map(|_| ()).expect_err("no such file"),
            Err(found) => found,
        };
        assert!(!found.is_empty() && !format!("{found:?}").contains("secret"), "{found:?}");
    }
}

#[test]
fn widths_beyond_the_extent_of_the_scene_are_reported_with_node_attribute_and_place() {
    let found = |fields: &str| {
        let text = with_nodes(&format!(
            r#""p": polyPlane(width: 3, height: 4), "c1": nCloth(inputMesh: "p", {fields})"#
        ));
        let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it reads");
        let found = match crate::compile::compile(&scene) {
            Ok(program) => program.warnings().to_vec(),
            Err(found) => found,
        };
        let place = |one: &Diagnostic| text[one.span.clone()].to_owned();
        found.iter().map(|one| (one.severity, one.message.clone(), place(one))).collect::<Vec<_>>()
    };
    let wide = "which makes it wider than all objects together, which take 5.000 from corner to corner";
    let far = "which makes it wider than";
    assert_eq!(found("thickness: 5"), []);
    let warned = |message: String, place: &str| vec![(Severity::Warning, message, place.to_owned())];
    assert_eq!(found("thickness: 6"), warned(format!("`thickness` of `c1` is 6, {wide}"), "6"));
    assert_eq!(
        found("thickness: 1, selfCollideWidthScale: 7"),
        warned(format!("`selfCollideWidthScale` of `c1` is 7, {wide}"), "7")
    );
    for field in ["thickness", "pushOutRadius"] {
        let found = found(&format!("{field}: 1e30"));
        assert_eq!((found[0].0, found[0].2.as_str()), (Severity::Error, "1e30"));
        assert!(found[0].1.starts_with(&format!("`{field}` of `c1` is 1e30, {far}")), "{found:?}");
    }
}
