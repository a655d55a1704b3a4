//! Warnings and failures at the end of a run: unresolved contact and large strain.

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::sample::{folder, nucleus, stderr, stdout};

/// Two boxes that close on a hanging sheet and end inside each other, which leaves no room for the cloth.
fn shut(folder: &Path, checks: &str) {
    let text = format!(
        r#"Scene(
    time: (start: 1, end: 10, fps: 24),
    nodes: {{
        "nucleus1": nucleus(spaceScale: 0.01, subSteps: 4),
        "plane": polyPlane(width: 20, height: 20, subdivisions: (4, 4), translate: (0, 10, 0), rotate: (90, 0, 0)),
        "sheet": nCloth(inputMesh: "plane", thickness: 0.3),
        "rail": dynamicConstraint(constraintType: transform, components: ["sheet.vtx[20:24]"]),
        "frontCube": polyCube(width: 14, height: 10, depth: 6, translate: keys([(1, (0, 8, 4)), (10, (0, 8, 2.5))])),
        "front": nRigid(inputMesh: "frontCube"),
        "backCube": polyCube(width: 14, height: 10, depth: 6, translate: keys([(1, (0, 8, -4)), (10, (0, 8, -2.5))])),
        "back": nRigid(inputMesh: "backCube"),
    }},
    checks: [{checks}],
)
"#
    );
    fs::write(folder.join("shut.ron"), text).unwrap();
}

/// A needle that rises by 100 cm in two frames below a sheet that is held at two sides.
fn needle(folder: &Path, checks: &str) {
    let text = format!(
        r#"Scene(
    time: (start: 1, end: 4, fps: 24),
    nodes: {{
        "nucleus1": nucleus(spaceScale: 0.01, subSteps: 4),
        "plane": polyPlane(width: 40, height: 40, subdivisions: (4, 4)),
        "sheet": nCloth(inputMesh: "plane", thickness: 0.1),
        "rail": dynamicConstraint(constraintType: transform, components: ["sheet.vtx[0:4]", "sheet.vtx[20:24]"]),
        "rod": polyCylinder(
            radius: 0.05, height: 20, subdivisions: (4, 1, 1),
            translate: keys([(1, (0.3, -11, 0.2)), (3, (0.3, 89, 0.2))]),
        ),
        "needle": nRigid(inputMesh: "rod", thickness: 0.02),
    }},
    checks: [{checks}],
)
"#
    );
    fs::write(folder.join("needle.ron"), text).unwrap();
}

fn run(folder: &Path, scene: &str, arguments: &[&str]) -> Output {
    nucleus(folder, &[&["run", scene, "--force"], arguments].concat())
}

fn summary(output: &Output) -> Value {
    let last = stdout(output).lines().last().map(serde_json::from_str::<Value>);
    last.unwrap().expect("a line of JSON")["summary"].take()
}

#[test]
fn colliders_that_leave_cloth_no_room_fail_the_run_with_advice() {
    let folder = folder();
    shut(folder.path(), "finite");
    let output = run(folder.path(), "shut.ron", &[]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}{}", stderr(&output));
    assert!(
        said.contains("UNRESOLVED CONTACT: ") && said.contains(" of elements unresolved, worst at frame "),
        "{said}"
    );
    assert!(said.contains("inside a collider at the last frame"), "{said}");
    assert!(said.contains("try more `subSteps`") && said.contains("`nucleus run --audit` names"), "{said}");
}

#[test]
fn unresolved_contact_is_in_the_json_summary() {
    let folder = folder();
    shut(folder.path(), "");
    let output = run(folder.path(), "shut.ron", &["--json"]);
    let summary = summary(&output);
    assert_eq!(output.status.code(), Some(1), "{summary}");
    let first = summary["unresolved_contact"][0].as_str().expect("there is a first");
    assert!(first.contains("of elements unresolved"), "{first}");
    assert!(
        summary["pairs_unresolved"].as_u64() > Some(0) && summary["depenetrating"]["end"].as_u64() > Some(0)
    );
    assert!(summary["most_unresolved"]["frame"].as_i64().is_some_and(|frame| (2..=10).contains(&frame)));
}

#[test]
fn unresolved_contact_that_the_scene_allows_is_a_success() {
    let folder = folder();
    shut(folder.path(), "maxUnresolved(100000), maxDepenetrating(25)");
    let output = run(folder.path(), "shut.ron", &[]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains(" of elements unresolved, worst at frame ") && !said.contains("UNRESOLVED CONTACT"),
        "{said}"
    );
    shut(folder.path(), "maxUnresolved(100000)");
    let output = run(folder.path(), "shut.ron", &[]);
    assert_eq!(output.status.code(), Some(1), "points inside colliders are not allowed");
}

#[test]
fn a_resumed_run_reports_the_unresolved_contact_of_its_earlier_frames() {
    let folder = folder();
    shut(folder.path(), "maxDepenetrating(25)");
    let first = run(folder.path(), "shut.ron", &["--frames", "8"]);
    let found = summary(&run(folder.path(), "shut.ron", &["--frames", "8", "--json"]))["unresolved_contact"]
        [0]
    .take();
    assert_eq!(first.status.code(), Some(1), "{}", stdout(&first));
    let output = nucleus(folder.path(), &["resume", "shut.mcap", "--to", "10"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}{}", stderr(&output));
    assert!(said.contains(found.as_str().expect("a line")), "{said}\n{found}");
}

#[test]
fn large_strain_without_penetration_is_a_warning() {
    let folder = folder();
    needle(folder.path(), "finite");
    let output = run(folder.path(), "needle.ron", &["--audit"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{said}{}", stderr(&output));
    assert!(
        said.contains("nothing passed through anything") && !said.contains("UNRESOLVED CONTACT"),
        "{said}"
    );
    assert!(said.contains("warning: cloth is stretched by ") && said.contains("`nucleus trade`"), "{said}");
    let json = summary(&run(folder.path(), "needle.ron", &["--json"]));
    assert!(json["warning"].as_str().is_some_and(|said| said.contains(" at frame ")), "{json}");
    assert_eq!(json["unresolved_contact"], Value::Array(vec![]));
}

#[test]
fn strain_that_a_check_allows_is_no_warning() {
    let folder = folder();
    needle(folder.path(), "maxStretch(50)");
    let output = run(folder.path(), "needle.ron", &[]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("check maxStretch(50): passed") && !said.contains("warning"), "{said}");
}
