//! Comments of a scene that is formatted.

use proptest::prelude::*;

use super::*;

/// The text of a formatted scene, which reads back to the same scene and is not formatted again.
fn formatted(text: &str) -> String {
    let read = scene(text);
    let written = format_scene(&read, text);
    let again = scene(&written);
    assert_eq!(again, read, "{written}");
    assert_eq!(format_scene(&again, &written), written);
    written
}

/// The line after a comment.
fn after<'a>(written: &'a str, comment: &str) -> &'a str {
    let mut lines = written.lines().map(str::trim).skip_while(|line| *line != comment);
    lines.nth(1).unwrap_or_else(|| panic!("`{comment}` is not on a line of its own in {written}"))
}

/// A scene with an item of every kind, as it is written.
const EVERYTHING: &str = r#"Scene(
    time: (start: 1, end: 10, fps: 24),
    record: every(2),
    nodes: {
        "arm": transform(
            translateX: 1,
            translateY: keys([(1, 0), (10, 2)]),
            translateZ: 0,
        ),
        "c": nCloth(
            friction: 0.1,
            inputMesh: "m",
        ),
        "m": polyPlane(
            subdivisionsWidth: 4,
            subdivisionsHeight: 4,
        ),
        "n": nucleus(),
        "pin": dynamicConstraint(
            type: transform,
            components: ["c.vtx[0]", "c.vtx[4]"],
        ),
    },
    connections: [
        ("arm.translateX", "c.stretchResistance"),
        ("arm.translateY", "c.friction"),
    ],
    checks: [
        finite, // always
        maxStretch(0.5),
    ],
)
"#;

#[test]
fn a_comment_on_any_line_stays_before_the_same_item() {
    let plain = formatted(EVERYTHING);
    let lines: Vec<&str> = plain.lines().collect();
    for at in 0..=lines.len() {
        let mut commented = lines.clone();
        commented.insert(at, "/* here */");
        let written = formatted(&commented.join("\n"));
        let found: Vec<&str> = written.lines().map(str::trim).collect();
        let mut expected: Vec<&str> = lines.iter().map(|line| line.trim()).collect();
        expected.insert(at, "// here");
        assert_eq!(found, expected, "line {at}");
    }
}

#[test]
fn a_comment_at_the_end_of_any_line_stays_on_it() {
    let plain = formatted(EVERYTHING).replace(" // always", "");
    for (at, _) in plain.match_indices('\n').filter(|(at, _)| at + 1 < plain.len()) {
        let commented = format!("{} // here{}", &plain[..at], &plain[at..]);
        assert_eq!(without_layout(&formatted(&commented)), without_layout(&commented));
    }
}

/// A text without blanks, line ends and commas before brackets.
fn without_layout(text: &str) -> String {
    let text = text.split_whitespace().collect::<String>();
    text.replace(",)", ")").replace(",]", "]").replace(",}", "}")
}

#[test]
fn comments_stay_with_fields_of_the_scene() {
    let written = formatted(
        r#"// Scene 12 of the film
// Lengths in centimetres
Scene(
    // frames of the edit
    time: (start: 1, end: 10, fps: 24),
    record: frames, // light
    // the set
    nodes: {
        "shirt": polyPlane(), "body": polySphere(), "n": nucleus(),
        // last
    },
    // conditions
    checks: [
        // every frame
        finite,
        noPenetration, // audited
        // none more
    ],
    // bye
)
// end of file
"#,
    );
    assert!(written.starts_with("// Scene 12 of the film\n// Lengths in centimetres\nScene(\n"), "{written}");
    assert!(written.ends_with("    // bye\n)\n// end of file\n"), "{written}");
    assert!(written.contains("\n    record: frames, // light\n"), "{written}");
    assert!(
        written.contains("\n        noPenetration, // audited\n        // none more\n    ],\n"),
        "{written}"
    );
    for (comment, next) in [
        ("// frames of the edit", "time: (start: 1, end: 10, fps: 24),"),
        ("// the set", "nodes: {"),
        ("// last", "},"),
        ("// conditions", "checks: ["),
        ("// every frame", "finite,"),
    ] {
        assert_eq!(after(&written, comment), next, "{written}");
    }
}

#[test]
fn comments_stay_with_attributes_that_are_written_in_another_form() {
    let written = formatted(
        r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(/* in */ subSteps: 4),
        "m": polyPlane( // the sheet
            /* rows
               and columns */ subdivisions: (4, 4), tx: 1, // aside
        ),
        "c": nCloth(inputMesh: "m", fron: 0.1, /* thick */ thickness: 0.01), // of silk
        "k": dynamicConstraint(type: transform, components: [
            "c.vtx[0]", // left
            "c.vtx[4]", // right
        ]),
        "t": transform(translateY: keys(at: [(1, 0), /* up */ (9, 4)])),
    })"#,
    );
    assert!(written.contains("\"m\": polyPlane( // the sheet\n"), "{written}");
    assert!(
        written
            .contains("            // rows\n            // and columns\n            subdivisionsWidth: 4,\n"),
        "{written}"
    );
    assert!(written.contains("translate: (1, 0, 0), // aside\n"), "{written}");
    assert!(written.contains("        ), // of silk\n"), "{written}");
    assert!(
        written.contains("                \"c.vtx[0]\", // left\n                \"c.vtx[4]\", // right\n"),
        "{written}"
    );
    for (comment, next) in [("// in", "subSteps: 4,"), ("// thick", "thickness: 0.01,"), ("// up", "(9, 4),")]
    {
        assert_eq!(after(&written, comment), next, "{written}");
    }
}

#[test]
fn what_is_not_written_leaves_its_comment_to_the_next_item() {
    let written = formatted(
        r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "time1": time(), // the clock
        "n": nucleus(), "m": polyPlane(), "c": nCloth(inputMesh: "m"),
    },
    connections: [
        // implied
        ("time1.outTime", "n.currentTime"),
    ])"#,
    );
    assert_eq!(after(&written, "// the clock"), "\"n\": nucleus(),", "{written}");
    assert_eq!(after(&written, "// implied"), ")", "{written}");
}

#[test]
fn slashes_in_texts_begin_no_comment() {
    let written = formatted(
        r##"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(), /* outer /* inner */ still outer */
        "m": mesh(file: r#"a "//b.obj"#), // a text
    })"##,
    );
    assert!(written.contains("\"n\": nucleus(), // outer /* inner */ still outer\n"), "{written}");
    assert!(written.contains(r#""m": mesh(file: "a \"//b.obj"), // a text"#), "{written}");
}

/// The offsets between the tokens of a text, outside of quotes.
fn gaps(text: &str) -> Vec<usize> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let mut is_quoted = false;
    let mut last = ' ';
    let mut gaps = Vec::new();
    for (at, c) in text.char_indices() {
        let is_inside = is_quoted || is_word(last) && is_word(c);
        if !is_inside {
            gaps.push(at);
        }
        is_quoted ^= c == '"';
        last = c;
    }
    gaps
}

proptest! {
    #[test]
    fn no_comment_is_lost_wherever_it_is(
        places in prop::collection::vec((any::<prop::sample::Index>(), 0..3), 1..6),
    ) {
        let plain = EVERYTHING.replace(" // always", "");
        let gaps = gaps(&plain);
        let mut places: Vec<(usize, i32)> = places.iter().map(|(at, form)| (gaps[at.index(gaps.len())], *form)).collect();
        places.sort_unstable();
        let mut text = plain.clone();
        for (k, (at, form)) in places.iter().enumerate().rev() {
            text.insert_str(*at, &match form {
                0 => format!("/* c{k}. */"),
                1 => format!(" // c{k}.\n"),
                _ => format!("\n// c{k}.\n"),
            });
        }
        let written = formatted(&text);
        for k in 0..places.len() {
            prop_assert_eq!(written.matches(&format!("// c{k}.")).count(), 1, "{}\n{}", text, written);
        }
        let is_plain = written.lines().filter_map(|line| line.split("//").next()).collect::<String>();
        prop_assert_eq!(scene(&is_plain), scene(&plain));
    }
}
