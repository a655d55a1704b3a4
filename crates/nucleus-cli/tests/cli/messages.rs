//! The texts of messages, held against `messages.txt`. After an intended change run the test with `NUCLEUS_BLESS=1`, and
//! read the difference: each message says what is wrong, where, and what to do.

use std::fs;
use std::path::Path;

use crate::sample::{cache, folder, nucleus, stderr, stdout};

/// Scenes of the messages by their names.
fn scenes(folder: &Path) {
    let scene = |name: &str, nodes: &str, checks: &str| {
        let text = format!(
            "Scene(\n    time: (start: 1, end: 2, fps: 24),\n    nodes: {{\n{nodes}\n    }},\n    checks: [{checks}],\n)\n"
        );
        fs::write(folder.join(name), text).unwrap();
    };
    let sheet = |nucleus: &str, plane: &str, cloth: &str| {
        format!(
            "        \"nucleus1\": nucleus({nucleus}),\n        \"plane\": polyPlane({plane}),\n        \"cloth\": nCloth(inputMesh: \"plane\"{cloth}),"
        )
    };
    let metre = "width: 1, height: 1, subdivisions: (10, 10)";
    scene("wide.ron", &sheet("", "width: 100, height: 100, subdivisions: (10, 10)", ""), "");
    scene("small.ron", &sheet("spaceScale: 0.001", metre, ""), "");
    scene("gravity.ron", &sheet("gravity: 980", metre, ""), "");
    scene("thick.ron", &sheet("", metre, ", thickness: 0.2, selfCollisionFlag: \"Full Surface\""), "");
    let inside =
        "\n        \"sphere\": polySphere(radius: 2),\n        \"ball\": nRigid(inputMesh: \"sphere\"),";
    scene("inside.ron", &(sheet("", metre, "") + inside), "");
    let across =
        "\n        \"sphere\": polySphere(radius: 0.3),\n        \"ball\": nRigid(inputMesh: \"sphere\"),";
    scene("across.ron", &(sheet("", metre, "") + across), "");
    let other =
        "\n        \"plane2\": polyPlane(rotateX: 90),\n        \"cloth2\": nCloth(inputMesh: \"plane2\"),";
    scene("crossed.ron", &(sheet("", metre, "") + other), "");
    scene("typo.ron", &sheet("", metre, ", frikcion: 1"), "maxStrech(1)");
    scene("former.ron", &sheet("", metre, ""), "untangledBy(1)");
    scene("idle.ron", &sheet("", metre, ", bendMapType: perVertex"), "");
    let pull =
        "\n        \"pin\": dynamicConstraint(constraintType: transform, components: [\"cloth.border\"]),";
    let stretched = sheet("gravity: 90000", metre, ", stretchResistance: 0.001") + pull;
    scene("stretched.ron", &stretched, "");
    scene(
        "picture.ron",
        "        \"nucleus1\": nucleus(),\n        \"a\": mesh(file: \"no.usd\"),\n        \"b\": nRigid(inputMesh: \"a\"),",
        "",
    );
}

/// The commands whose messages are held.
const COMMANDS: [&str; 24] = [
    "check wide.ron",
    "check small.ron",
    "check gravity.ron",
    "check thick.ron",
    "check inside.ron",
    "check across.ron",
    "check crossed.ron",
    "check typo.ron",
    "check former.ron",
    "check idle.ron",
    "check picture.ron",
    "check no.ron",
    "run stretched.ron --force",
    "new a.ron --template capes",
    "new wide.ron",
    "export fall.mcap -o a.abc",
    "export fall.mcap -o a.fbx",
    "render fall.mcap -o a.jpg",
    "render fall.mcap -o a.gif --background none",
    "render fall.mcap --frame 99",
    "render fall.mcap --camera shot",
    "render fall.mcap --tint a=red",
    "play no.mcap --no-open",
    "checks maxStretch",
];

/// A report of a run names its time; the others have no number that differs from run to run.
fn without_times(text: &str) -> String {
    let is_kept = |line: &&str| {
        !line.starts_with("frames ") && !line.starts_with("frame ") && !line.starts_with("recorded")
    };
    text.lines().filter(is_kept).map(|line| line.trim_end().to_owned() + "\n").collect()
}

#[test]
fn messages_are_those_that_were_read() {
    let folder = folder();
    cache(folder.path());
    scenes(folder.path());
    let mut found = String::new();
    for command in COMMANDS {
        let output = nucleus(folder.path(), &command.split(' ').collect::<Vec<_>>());
        let said = without_times(&(stdout(&output) + &stderr(&output)));
        let code = output.status.code().unwrap_or(-1);
        found += &format!("$ nucleus {command}\n{said}exit {code}\n\n");
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/messages.txt");
    if std::env::var_os("NUCLEUS_BLESS").is_some() {
        fs::write(&path, &found).unwrap();
    }
    let known = fs::read_to_string(&path).unwrap_or_default();
    let differs = known.lines().zip(found.lines()).position(|(known, found)| known != found);
    assert!(known == found, "line {:?} of messages.txt differs:\n{found}", differs.map(|line| line + 1));
}
