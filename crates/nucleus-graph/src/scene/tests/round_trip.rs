//! Scenes written and read back, and damaged scenes.

use std::borrow::Cow;

use proptest::prelude::*;

use super::*;
use crate::Simulation;
use crate::animation::{Curve, Infinity, Key, Tangent};
use crate::attributes::{
    Attribute, ColorPoint, Kind, Painting, RampPoint, Range, Value, dynamic_constraint, nucleus,
};
use crate::compile::{Program, compile};
use crate::graph::Plug;

/// Any finite number of a range.
fn numbers(range: Range) -> BoxedStrategy<f64> {
    let any =
        prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite() && x.abs() < 1e300), -10.0..10.0];
    any.prop_map(move |x| range.clamp(x)).boxed()
}

/// Any value that fits a row.
fn values(row: &'static Attribute) -> BoxedStrategy<Value> {
    let number = || numbers(row.range);
    let list = |len| prop::collection::vec(number(), len);
    match row.kind {
        Kind::Bool => any::<bool>().prop_map(Value::Bool).boxed(),
        Kind::Int => {
            (-1000..1000).prop_map(move |x| Value::Int(row.range.clamp(f64::from(x)) as i64)).boxed()
        }
        Kind::Float => number().prop_map(Value::Float).boxed(),
        Kind::Texture => prop_oneof![
            number().prop_map(Value::Float),
            any::<String>().prop_map(|file| Value::Painting(Painting::Texture(file))),
        ]
        .boxed(),
        Kind::Vector(_) => [number(), number(), number()].prop_map(Value::Vector).boxed(),
        Kind::Choice(words) => (0..words.len()).prop_map(|k| Value::Choice(Choice(words[k].0))).boxed(),
        Kind::Text => any::<String>().prop_map(Value::Text).boxed(),
        Kind::Texts => prop::collection::vec(any::<String>(), 0..3).prop_map(Value::Texts).boxed(),
        Kind::Floats => prop_oneof![
            list(0..4).prop_map(Value::Floats),
            any::<String>().prop_map(|file| Value::Painting(Painting::File(file))),
            "[1-9]( [-+*/] [xyzuvin]){0,3}".prop_map(|text| Value::Painting(Painting::Expression(text))),
            "(border|corners|where\\(x > 0\\))( \\? [1-9] : [0-9])?"
                .prop_map(|text| Value::Painting(Painting::Selection(text))),
        ]
        .boxed(),
        Kind::Vectors => prop_oneof![
            list(3..4).prop_map(|v| Value::Vectors(vec![[v[0], v[1], v[2]]; 2])),
            any::<String>().prop_map(|file| Value::Painting(Painting::File(file))),
        ]
        .boxed(),
        Kind::Ramp => (number(), number(), 0..4)
            .prop_map(|(position, value, k)| RampPoint { position, value, interpolation: Choice(k) })
            .prop_map(|point| Value::Ramp(Cow::Owned(vec![point; 2])))
            .boxed(),
        Kind::ColorRamp => (number(), number(), 0..4)
            .prop_map(|(position, x, k)| ColorPoint {
                position,
                color: [x, 0.0, x],
                interpolation: Choice(k),
            })
            .prop_map(|point| Value::ColorRamp(Cow::Owned(vec![point; 2])))
            .boxed(),
        Kind::Ints => prop::collection::vec(any::<u32>(), 0..4).prop_map(Value::Ints).boxed(),
        _ => Just(Value::Components(Vec::new())).boxed(),
    }
}

/// Any curve that fits a row.
fn curves(row: &'static Attribute) -> BoxedStrategy<Curve> {
    let tangent = prop::sample::select(Tangent::WORDS.map(|(_, tangent)| tangent).to_vec());
    let infinity = || prop::sample::select(Infinity::WORDS.map(|(_, infinity)| infinity).to_vec());
    let value = values(row).prop_map(|value| match value {
        Value::Bool(on) => f64::from(u8::from(on)),
        Value::Int(x) => x as f64,
        Value::Choice(choice) => f64::from(choice.0),
        Value::Float(x) | Value::Vector([x, ..]) => x,
        _ => 0.0,
    });
    let keys = prop::collection::vec((0.01..9.0, value, tangent), 1..4);
    (keys, infinity(), infinity())
        .prop_map(|(keys, before, after)| {
            let mut frame = 0.0;
            let key = |(step, value, tangent)| {
                frame += step;
                Key { frame, value, tangent }
            };
            Curve::new(keys.into_iter().map(key).collect())
                .expect("in order and finite")
                .with_infinity(before, after)
        })
        .boxed()
}

fn settings(row: &'static Attribute) -> BoxedStrategy<Setting> {
    let fixed = values(row).prop_map(Setting::from).boxed();
    if !row.can_be_keyed() {
        return fixed;
    }
    if let Kind::Vector(_) = row.kind {
        let channel = move || {
            prop_oneof![numbers(row.range).prop_map(Channel::Fixed), curves(row).prop_map(Channel::Keyed)]
        };
        let parts = [channel(), channel(), channel()].prop_map(Setting::Parts);
        let together =
            curves(row).prop_map(|curve| Setting::Parts([0, 1, 2].map(|_| Channel::Keyed(curve.clone()))));
        return prop_oneof![fixed, parts, together].boxed();
    }
    prop_oneof![fixed, curves(row).prop_map(Setting::Keyed)].boxed()
}

/// The scene of the other tests with random settings on its nodes.
fn scenes() -> impl Strategy<Value = Scene> {
    let plain = scene(SHEET);
    let nodes: Vec<_> = plain.graph.iter().filter(|(_, node)| node.created_by().is_none()).collect();
    let rows =
        nodes.iter().flat_map(|(id, node)| node.node_type().attributes().into_iter().map(|row| (*id, row)));
    let settable = |row: &&Attribute| {
        !matches!(row.kind, Kind::Plug(_) | Kind::Node(_) | Kind::Together(_) | Kind::Components)
            && !["startFrame", "preset"].contains(&row.name)
    };
    let rows: Vec<_> = rows.filter(|(_, row)| settable(row)).collect();
    let change =
        prop::sample::select(rows).prop_flat_map(|(id, row)| settings(row).prop_map(move |s| (id, row, s)));
    prop::collection::vec(change, 1..8).prop_map(move |changes| {
        let mut scene = plain.clone();
        for (id, row, setting) in changes {
            scene.graph.set(id, row, setting).expect("it fits");
        }
        scene
    })
}

/// The settings of all nodes, in every bit.
fn all_settings(graph: &Graph) -> String {
    let mut nodes: Vec<_> = graph.iter().map(|(_, node)| (node.name(), node.settings())).collect();
    nodes.sort_by_key(|(name, _)| *name);
    format!("{nodes:?}")
}

/// The model and the input of the first frame, in every bit.
fn start(scene: &Scene) -> Option<String> {
    let program = compile(scene).ok()?;
    Some(format!("{:?} {:?}", program.model(), program.first_input()))
}

proptest! {
    #[test]
    fn a_written_scene_reads_back_to_the_same_graph_and_model(scene in scenes()) {
        let text = write_scene(&scene);
        let read = read_scene_text(&text, Path::new("test.ron"));
        prop_assert!(read.is_ok(), "{text}\n{read:#?}");
        let (read, _) = read.expect("just seen");
        prop_assert_eq!(&read, &scene);
        prop_assert_eq!(all_settings(&read.graph), all_settings(&scene.graph), "zeros have signs");
        prop_assert_eq!(start(&read), start(&scene));
        prop_assert_eq!(write_scene(&read), text);
    }

    #[test]
    fn a_damaged_scene_is_refused_at_a_place_or_runs(
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..5, any::<prop::sample::Index>()), 1..4),
    ) {
        let mut tokens: Vec<String> = tokens(SHEET);
        for (at, change, other) in changes {
            damage(&mut tokens, at, change, other);
        }
        let text = tokens.concat();
        match read_scene_text(&text, Path::new("test.ron")) {
            Ok((scene, _)) => match compile(&scene) {
                Ok(program) => run_a_little(&program),
                Err(diagnostics) => check_places(&diagnostics, &text)?,
            },
            Err(diagnostics) => check_places(&diagnostics, &text)?,
        }
    }
}

/// Words, numbers, quoted texts, single other characters, and the space between them.
fn tokens(text: &str) -> Vec<String> {
    let class = |c: char| match c {
        c if c.is_alphanumeric() || matches!(c, '.' | '_' | '-') => 1,
        c if c.is_whitespace() => 2,
        _ => 0,
    };
    let mut tokens: Vec<String> = Vec::new();
    for c in text.chars() {
        match tokens.last_mut() {
            Some(last) if class(c) != 0 && last.chars().all(|d| class(d) == class(c)) => last.push(c),
            _ => tokens.push(c.into()),
        }
    }
    tokens
}

/// Removes, doubles, misspells, retypes or replaces a token.
fn damage(tokens: &mut Vec<String>, at: prop::sample::Index, change: i32, other: prop::sample::Index) {
    if tokens.is_empty() {
        return;
    }
    let at = at.index(tokens.len());
    let strange = ["3", "true", "\"x\"", "foo", "(1, 2)", "[]", "-1", "1e999", "{}", "keys([(1, 2)])", "0"];
    match change {
        0 => drop(tokens.remove(at)),
        1 => tokens.insert(at, tokens[at].clone()),
        2 => drop(tokens[at].pop()),
        3 => tokens[at] = strange[other.index(strange.len())].to_owned(),
        _ => tokens[at] = tokens[other.index(tokens.len())].clone(),
    }
}

fn run_a_little(program: &Program) {
    let mut run = Simulation::<f32>::new(program, 1);
    run.advance(&mut ());
    run.advance(&mut ());
}

fn check_places(diagnostics: &[Diagnostic], text: &str) -> Result<(), TestCaseError> {
    prop_assert!(diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error));
    for diagnostic in diagnostics {
        let places = diagnostic.notes.iter().filter_map(|note| note.span.clone());
        for place in places.chain([diagnostic.span.clone()]) {
            prop_assert!(text.get(place.clone()).is_some(), "{place:?} of {diagnostic:?}");
        }
        prop_assert!(!diagnostic.message.is_empty() && !diagnostic.message.ends_with('.'));
    }
    Ok(())
}

#[test]
fn comments_stay_with_their_node_or_attribute() {
    let text = r#"// EVIDENCE: N1.2-2  a flag
// In metres.
Scene(
    time: (start: 1, end: 2, fps: 24),
    nodes: {
        // the solver
        "n": nucleus(subSteps: 4), // four
        "p": polyPlane(),
        "c": nCloth(
            // kilograms
            pointMass: 0.1, // nylon: "light"
            inputMesh: "p",
        ),
    },
    // the end
)
"#;
    let written = format_scene(&scene(text), text);
    let lines: Vec<&str> = written.lines().collect();
    let after = |line: &str| lines[lines.iter().position(|l| l.trim() == line).expect(line) + 1].trim();
    assert_eq!(&lines[..3], ["// EVIDENCE: N1.2-2  a flag", "// In metres.", "Scene("]);
    assert_eq!(after("// the solver"), "\"n\": nucleus(subSteps: 4), // four");
    assert_eq!(after("// kilograms"), "pointMass: 0.1, // nylon: \"light\"");
    assert_eq!(after("// the end"), ")");
    assert_eq!(format_scene(&scene(&written), &written), written);
}

#[test]
fn a_scene_is_written_as_a_person_would() {
    let text = r#"Scene(
    time: (start: 1, end: 24, fps: 24),
    record: substeps,
    nodes: {
        "arm": transform(translate: (1, 2, 3)),
        "cloth1": nCloth(
            scalingRelation: objectSpace,
            bendResistance: 0.4,
            collide: keys([(1, false), (3, true)]),
            inputMesh: "sheet",
        ),
        "n": nucleus(),
        "pin": dynamicConstraint(
            components: ["cloth1.vtx[0]", "cloth1.vtx[3:4]"],
            translateX: 1,
            translateY: keys([(1, 0), (2, 1, spline)]),
            translateZ: 0,
        ),
        "sheet": polyPlane(
            width: 1.5,
            subdivisionsWidth: 4,
            translate: keys([(1, (0, 0, 0)), (2, (1, 0, 0), stepped)]),
            parent: "arm",
        ),
    },
    checks: [noPenetration, atRestBy(frame: 3, speed: 0.1)],
)
"#;
    let read = scene(text);
    let mut written: Vec<String> = write_scene(&read).lines().map(str::to_owned).collect();
    let mut expected: Vec<String> = text.lines().map(str::to_owned).collect();
    // The order of attributes follows the tables and is not tested here.
    written.sort();
    expected.sort();
    assert_eq!(written, expected);
    assert_eq!(scene(&write_scene(&read)), read);
}

#[test]
fn the_forms_of_record_are_read_and_written() {
    for (text, expected) in [
        ("frames", Record::Frames),
        ("substeps", Record::Substeps),
        ("every(10)", Record::Every(10)),
        ("none", Record::None),
    ] {
        let scene =
            format!("Scene(time: (start: 1, end: 2, fps: 24), record: {text}, nodes: {{\"n\": nucleus()}})");
        let (scene, _) = read_scene_text(&scene, Path::new("a.ron")).unwrap();
        assert_eq!(scene.record, expected);
        let (again, _) = read_scene_text(&write_scene(&scene), Path::new("a.ron")).unwrap();
        assert_eq!(again.record, expected);
    }
    for text in ["every(0)", "every(1.5)", "every(1, 2)", "every(-1)", "every", "often"] {
        let scene =
            format!("Scene(time: (start: 1, end: 2, fps: 24), record: {text}, nodes: {{\"n\": nucleus()}})");
        assert!(read_scene_text(&scene, Path::new("a.ron")).is_err(), "{text}");
    }
}

#[test]
fn a_constraint_at_another_index_of_its_nucleus_is_written_connection_by_connection() {
    let text = r#"Scene(time: (start: 1, end: 2, fps: 24), nodes: {
        "n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"),
        "k": dynamicConstraint(components: ["c.vtx[0]"]),
    })"#;
    let mut read = scene(text);
    let [n, k] = ["n", "k"].map(|name| read.graph.find(name).unwrap());
    let current = Plug::element(k, &dynamic_constraint::EVAL_CURRENT, 0);
    let input = |index| Plug::element(n, &nucleus::INPUT_CURRENT, index);
    assert!(read.graph.disconnect(current, input(0)));
    read.graph.connect(current, input(3)).unwrap();
    let written = write_scene(&read);
    assert!(
        !written.contains("components"),
        "reading the list would connect the constraint again: {written}"
    );
    assert_eq!(write_scene(&scene(&written)), written);
}
