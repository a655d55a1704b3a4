//! `nucleus check`, and how every command speaks of a bad scene.

use std::fs;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

#[test]
fn a_good_scene_can_run() {
    let folder = folder();
    scene(folder.path(), 3, "finite");
    let output = nucleus(folder.path(), &["check", "drape.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("`drape.ron` can run"), "{}", stdout(&output));
}

#[test]
fn all_mistakes_are_shown_in_place_and_counted() {
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
    fs::write(&path, fs::read_to_string(&path).unwrap().replace("thickness: 1", "thickness: 1, rigidity: 2"))
        .unwrap();
    let output = nucleus(folder.path(), &["check", "drape.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("`rigidity`") && stderr(&output).ends_with("1 warning\n"));
}

#[test]
fn what_is_no_scene_at_all_is_refused_by_name() {
    let folder = folder();
    fs::write(folder.path().join("bytes.ron"), [0xff, 0xfe, 0x00]).unwrap();
    let check = |name: &str| nucleus(folder.path(), &["check", name]);
    assert_refused(&check("none.ron"), "cannot read `none.ron`: No such file");
    assert_refused(&check("."), "it is a folder, not a file");
    assert_refused(&check("bytes.ron"), "`bytes.ron` is not text");
}
