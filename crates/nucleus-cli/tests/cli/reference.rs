//! `nucleus checks`, `functions`, `completions` and `man`; `--quiet`, `--color` and `--version`.

use std::fs;

use crate::sample::{folder, nucleus, scene, stderr, stdout};

#[test]
fn checks_are_listed_with_their_arguments_and_former_names() {
    let said = stdout(&nucleus(folder().path(), &["checks"]));
    for line in ["noPenetration  ", "maxStretch(strain)  ", "atRestBy(frame: ..., speed: ...)  "] {
        assert!(said.contains(line), "{said}");
    }
    assert!(said.contains("`maxTrapped` is now `maxDepenetrating`"), "{said}");
}

#[test]
fn functions_are_listed_with_variables_and_operators() {
    let said = stdout(&nucleus(folder().path(), &["functions"]));
    for line in ["  x  ", "  a ? b : c  ", "  smoothstep(from, to, a)  "] {
        assert!(said.contains(line), "{said}");
    }
}

#[test]
fn every_subcommand_has_completions_and_a_manual_page() {
    let folder = folder();
    for (shell, mark) in
        [("bash", "_nucleus()"), ("zsh", "#compdef nucleus"), ("fish", "complete -c nucleus")]
    {
        let script = stdout(&nucleus(folder.path(), &["completions", shell]));
        assert!(script.contains(mark) && script.contains("diff"), "{shell}");
    }
    assert!(nucleus(folder.path(), &["man", "pages"]).status.success());
    let page = fs::read_to_string(folder.path().join("pages/nucleus-run.1")).expect("it is there");
    assert!(page.contains(".TH") && page.contains("audit"), "{page}");
    assert!(folder.path().join("pages/nucleus.1").exists());
}

#[test]
fn a_quiet_success_prints_nothing_and_a_quiet_failure_prints_its_report() {
    let folder = folder();
    scene(folder.path(), 3, "finite");
    let quiet = nucleus(folder.path(), &["run", "drape.ron", "--quiet"]);
    assert_eq!((stdout(&quiet).as_str(), stderr(&quiet).as_str()), ("", ""));
    assert!(folder.path().join("drape.mcap").exists());
    scene(folder.path(), 3, "maxStretch(0)");
    let failed = nucleus(folder.path(), &["-q", "run", "drape.ron", "--record", "none"]);
    assert_eq!(failed.status.code(), Some(1));
    assert!(stdout(&failed).contains("check maxStretch(0): FAILED"), "{}", stdout(&failed));
}

#[test]
fn a_quiet_success_prints_the_warnings_of_its_result() {
    let folder = folder();
    // At 60 kg/m², 24 evaluations hold the sheet to about 40 % of strain.
    let text = r#"Scene(time: (start: 1, end: 6, fps: 24), nodes: {
        "n": nucleus(evaluations: 24), "m": polyPlane(subdivisions: (4, 60), rotateX: 90),
        "c": nCloth(inputMesh: "m", pointMass: 60), "pin": dynamicConstraint(components: ["c.where(z < -0.49)"])})"#;
    fs::write(folder.path().join("a.ron"), text).expect("written");
    let found = |arguments: &[&str]| stdout(&nucleus(folder.path(), arguments));
    let all = found(&["run", "a.ron", "--record", "none"]);
    let quiet = found(&["run", "a.ron", "--record", "none", "-q"]);
    let warnings: String =
        all.lines().filter(|line| line.starts_with("warning: ")).map(|line| format!("{line}\n")).collect();
    assert!(warnings.contains("stretched"), "{all}");
    assert_eq!(quiet, warnings);
}

#[test]
fn colours_are_printed_where_they_are_wanted() {
    let folder = folder();
    fs::write(folder.path().join("a.ron"), "Scene(nodes: {})").expect("written");
    let escapes = |arguments: &[&str]| stderr(&nucleus(folder.path(), arguments)).contains('\u{1b}');
    assert!(escapes(&["--color", "always", "check", "a.ron"]));
    assert!(escapes(&["check", "--color=always"]), "errors of the arguments too");
    assert!(!escapes(&["check", "a.ron"]), "a pipe is no terminal");
}

#[test]
fn the_version_names_the_commit() {
    let said = stdout(&nucleus(folder().path(), &["--version"]));
    let version = said.trim().strip_prefix("nucleus ").expect("the name");
    let commit = version.strip_prefix(env!("CARGO_PKG_VERSION")).expect("the version").trim();
    let is_checkout = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../.git")).exists();
    assert_eq!(commit.starts_with('(') && commit.ends_with(')'), is_checkout, "{said}");
}

#[test]
fn every_listed_variable_of_a_particle_is_one() {
    let folder = folder();
    let said = stdout(&nucleus(folder.path(), &["functions"]));
    let (_, list) = said.split_once("Variables of a particle").expect("the section");
    let rows = list.lines().skip(1).take_while(|line| !line.is_empty());
    let names: Vec<&str> = rows.flat_map(|row| row[..26].split(',').map(str::trim)).collect();
    assert_eq!(names.len(), 13, "{said}");
    let check = |names: &str| {
        let expression = format!("vx = {names}");
        let scene = format!(
            "Scene(time: (start: 1, end: 9, fps: 24), nodes: {{\"n\": nucleus(), \"p\": nParticle(position0: [(0, 1, 0)], \
             runtimeExpression: \"{expression}\")}})"
        );
        fs::write(folder.path().join("p.ron"), scene).expect("written");
        nucleus(folder.path(), &["check", "p.ron"])
    };
    let output = check(&names.join(" + "));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_ne!(check("weight").status.code(), Some(0), "another name is none");
}
