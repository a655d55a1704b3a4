//! Accepted forms, errors, and agreement with `ron`.

use super::{Node, SyntaxError, Value, parse};

mod agreement;
mod mistakes;

/// The part of `text` that a span names.
fn at<'a>(text: &'a str, error: &SyntaxError) -> &'a str {
    &text[error.span.clone()]
}

fn read(text: &str) -> Node {
    parse(text).unwrap_or_else(|errors| panic!("{text}: {errors:?}"))
}

fn fields(node: &Node) -> Vec<(&str, &Node)> {
    match &node.value {
        Value::Record { fields, .. } => {
            fields.iter().map(|(name, value)| (name.text.as_str(), value)).collect()
        }
        other => panic!("not a record: {other:?}"),
    }
}

const SCENE: &str = r##"// A sheet.
Scene(
    time: (start: 1, end: 120, fps: 24), /* frames /* nested */ */
    nodes: {
        "nucleus1": nucleus(windSpeed: keys([(1, 0), (48, 12)]), subSteps: 0x4),
        "pin": dynamicConstraint(type: transform, components: ["cloth1.vtx[0]"],),
    },
    checks: [noPenetration, maxStretch(0.02)],
    note: r#"a "quoted" word"#,
    empty: (),
)
"##;

#[test]
fn a_scene_is_read_as_written() {
    let root = read(SCENE);
    let [time, nodes, checks, note, empty] = fields(&root)[..] else { panic!("five fields") };
    assert_eq!(
        fields(time.1).iter().map(|f| &f.1.value).collect::<Vec<_>>(),
        [&Value::Number(1.0), &Value::Number(120.0), &Value::Number(24.0)]
    );
    let Value::Map(entries) = &nodes.1.value else { panic!("a map") };
    assert_eq!(entries[0].0.value, Value::Text("nucleus1".into()));
    let Value::Tuple { name: Some(keys), items } = &fields(&entries[0].1)[0].1.value else { panic!("keys") };
    assert_eq!((keys.text.as_str(), items.len()), ("keys", 1));
    assert_eq!(fields(&entries[0].1)[1].1.value, Value::Number(4.0));
    assert_eq!(fields(&entries[1].1)[0].1.value, Value::Word("transform".into()));
    let Value::List(checks) = &checks.1.value else { panic!("a list") };
    assert_eq!(checks[0].value, Value::Word("noPenetration".into()));
    assert_eq!(note.1.value, Value::Text("a \"quoted\" word".into()));
    assert_eq!(empty.1.value, Value::Record { name: None, fields: vec![] });
}

#[test]
fn every_value_has_its_place() {
    let root = read(SCENE);
    let parts = fields(&root);
    assert_eq!(&SCENE[root.span.clone()], SCENE[12..].trim_end());
    assert_eq!(&SCENE[parts[0].1.span.clone()], "(start: 1, end: 120, fps: 24)");
    assert_eq!(&SCENE[parts[2].1.span.clone()], "[noPenetration, maxStretch(0.02)]");
    assert_eq!(&SCENE[parts[3].1.span.clone()], r##"r#"a "quoted" word"#"##);
    let Value::Record { fields, .. } = &root.value else { panic!("a record") };
    assert_eq!(&SCENE[fields[1].0.span.clone()], "nodes");
}

#[test]
fn a_byte_order_mark_is_skipped_and_spans_stay_right() {
    let text = "\u{feff}(width: 1.5)";
    let root = read(text);
    assert_eq!(&text[root.span.clone()], "(width: 1.5)");
    assert_eq!(&text[fields(&root)[0].1.span.clone()], "1.5");
}

#[test]
fn a_word_ends_before_the_blank_that_follows() {
    let root = read("[word , Name ( 1 )]");
    let Value::List(items) = root.value else { panic!("a list") };
    assert_eq!((items[0].span.clone(), items[1].span.clone()), (1..5, 8..18));
}

#[test]
fn escapes_mean_the_same_as_in_rust() {
    let text = r#""a\n\t\r\0\\\"\'\x41\u{e9}\u{1F600}\
          b""#;
    assert_eq!(read(text).value, Value::Text("a\n\t\r\0\\\"'Aé😀b".into()));
}

#[test]
fn equal_keys_and_fields_are_kept() {
    assert_eq!(fields(&read("(a: 1, a: 2)")).len(), 2);
    assert!(matches!(read("{1: 1, 1: 2}").value, Value::Map(entries) if entries.len() == 2));
}
