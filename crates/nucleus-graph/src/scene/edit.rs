//! Changes of attributes in the text of a scene. Comments and layout stay unchanged.

use std::ops::Range;

use super::syntax::{self, Node, Value};
use crate::attributes::{Attribute, NodeType, node_type};

/// A change of one attribute.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// The name of the node.
    pub node: String,
    /// The long name of the attribute, or of a component of a vector (`translateX`).
    pub attribute: String,
    /// The new value.
    pub to: NewValue,
}

/// The new value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum NewValue {
    /// This text replaces the value.
    Text(String),
    /// The number, or each value of the keys, times a factor and at least `least`.
    Scaled {
        /// The factor.
        factor: f64,
        /// The lower bound of the results.
        least: f64,
        /// The number to scale if the attribute is not set.
        default: f64,
    },
}

/// Reasons why a text cannot be edited.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The text is not RON.
    #[error("the text is not a scene: {message}")]
    NotAScene {
        /// The first mistake.
        message: String,
    },
    /// The scene has no such node.
    #[error("the scene has no node `{node}`")]
    NoNode {
        /// Its name.
        node: String,
    },
}

/// The text with these changes. An attribute that is not set is added after those that are.
///
/// ```
/// use nucleus_graph::scene::edit::{Edit, NewValue, edit};
///
/// let text = "Scene(time: (start: 1, end: 9, fps: 24), nodes: {\"n\": nucleus(subSteps: 3 /* Maya's */)})";
/// let five = Edit { node: "n".into(), attribute: "subSteps".into(), to: NewValue::Text("5".into()) };
/// assert_eq!(edit(text, &[five]).unwrap(), text.replace("subSteps: 3", "subSteps: 5"));
/// ```
///
/// # Errors
/// When the text is not a scene, or a node is not in it.
pub fn edit(text: &str, edits: &[Edit]) -> Result<String, EditError> {
    let root = syntax::parse(text).map_err(|errors| EditError::NotAScene {
        message: errors.into_iter().next().map(|error| error.message).unwrap_or_default(),
    })?;
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    for edit in edits {
        let body = node(&root, &edit.node).ok_or_else(|| EditError::NoNode { node: edit.node.clone() })?;
        change(text, body, edit, &mut changes);
    }
    // From the back, so that earlier offsets stay valid. The stable sort keeps the order of additions at one place.
    changes.sort_by_key(|(place, _)| place.start);
    let mut text = text.to_owned();
    for (place, new) in changes.into_iter().rev() {
        text.replace_range(place, &new);
    }
    Ok(text)
}

/// The body of a node: `nucleus(...)`.
fn node<'a>(root: &'a Node, name: &str) -> Option<&'a Node> {
    let Value::Record { fields, .. } = &root.value else { return None };
    let (_, nodes) = fields.iter().find(|(word, _)| word.text == "nodes")?;
    let Value::Map(entries) = &nodes.value else { return None };
    let is_named = |key: &Node| matches!(&key.value, Value::Text(text) if text == name);
    entries.iter().find(|(key, _)| is_named(key)).map(|(_, body)| body)
}

fn change(text: &str, body: &Node, edit: &Edit, changes: &mut Vec<(Range<usize>, String)>) {
    let Value::Record { name, fields } = &body.value else { return };
    let node_type = name.as_ref().and_then(|name| node_type(&name.text));
    let row = node_type.and_then(|of| of.attribute(&edit.attribute));
    let is_named = |word: &str| word == edit.attribute || row.is_some_and(|row| row.short == word);
    let own = fields.iter().find(|(word, _)| is_named(&word.text)).map(|(_, value)| value);
    if let (None, Some(row), NewValue::Text(new)) = (own, row, &edit.to)
        && replace_components(text, row, fields, &format!("{}: {new}", edit.attribute), changes)
    {
        return;
    }
    match own.or_else(|| component(node_type?, fields, &edit.attribute)) {
        Some(value) => match &edit.to {
            NewValue::Text(new) => changes.push((value.span.clone(), new.clone())),
            NewValue::Scaled { factor, least, .. } => {
                let scaled = numbers(value).into_iter();
                changes.extend(scaled.map(|(place, x)| (place.clone(), written((x * factor).max(*least)))));
            }
        },
        None => {
            let new = match &edit.to {
                NewValue::Text(new) => new.clone(),
                NewValue::Scaled { factor, least, default } => written((default * factor).max(*least)),
            };
            let (place, new) = added(text, body, fields.last(), &edit.attribute, &new);
            // A node without attributes has no last one to write a comma after.
            let is_second = fields.is_empty() && changes.iter().any(|(other, _)| *other == place);
            changes.push((place, if is_second { format!(", {new}") } else { new }));
        }
    }
}

/// Replaces the fields of components of a vector by one of the whole. `false` if there are none.
fn replace_components(
    text: &str,
    row: &Attribute,
    fields: &[(syntax::Word, Node)],
    new: &str,
    changes: &mut Vec<(Range<usize>, String)>,
) -> bool {
    let Some(parts) = row.parts() else { return false };
    let is_part = |(word, _): &&(syntax::Word, Node)| {
        parts.iter().any(|(long, short)| *long == word.text || *short == word.text)
    };
    let mut found = fields.iter().filter(is_part);
    let Some((word, value)) = found.next() else { return false };
    changes.push((word.span.start..value.span.end, new.to_owned()));
    for (word, value) in found {
        let after = &text[value.span.end..];
        let comma = after.trim_start().strip_prefix(',').map_or(0, |rest| {
            let rest = rest.strip_prefix(' ').unwrap_or(rest);
            after.len() - rest.len()
        });
        changes.push((word.span.start..value.span.end + comma, String::new()));
    }
    true
}

/// The value of a component of a vector: of its own field, or within the vector.
fn component<'a>(
    node_type: &'static NodeType,
    fields: &'a [(syntax::Word, Node)],
    name: &str,
) -> Option<&'a Node> {
    let (row, part) = node_type.part(name)?;
    let (long, short) = row.parts()?.get(part).cloned()?;
    let of = |words: [&str; 2]| fields.iter().find(|(word, _)| words.contains(&word.text.as_str()));
    if let Some((_, value)) = of([&long, short]) {
        return Some(value);
    }
    match &of([row.name, row.short])?.1.value {
        Value::Tuple { name: None, items } | Value::List(items) => items.get(part),
        _ => None,
    }
}

/// The place and text of a new field. It gets its own line if the last field has one.
fn added(
    text: &str,
    body: &Node,
    last: Option<&(syntax::Word, Node)>,
    attribute: &str,
    new: &str,
) -> (Range<usize>, String) {
    let Some((word, value)) = last else {
        let place = body.span.end - 1;
        return (place..place, format!("{attribute}: {new}"));
    };
    let line = text[..word.span.start].rfind('\n').map_or(0, |at| at + 1);
    let before = &text[line..word.span.start];
    let own_line = line > body.span.start && before.trim().is_empty();
    let separator = if own_line { format!(",\n{before}") } else { ", ".to_owned() };
    (value.span.end..value.span.end, format!("{separator}{attribute}: {new}"))
}

/// The numbers of a value with their places: the number itself, or the values of keys.
fn numbers(value: &Node) -> Vec<(&Range<usize>, f64)> {
    match &value.value {
        Value::Number(x) => vec![(&value.span, *x)],
        Value::Tuple { name: Some(name), items } if name.text == "keys" => {
            let keys = items.iter().filter_map(|list| match &list.value {
                Value::List(keys) => Some(keys),
                _ => None,
            });
            keys.flatten().filter_map(key_value).collect()
        }
        _ => Vec::new(),
    }
}

/// The value of `(12, 96, spline)`.
fn key_value(key: &Node) -> Option<(&Range<usize>, f64)> {
    let Value::Tuple { name: None, items } = &key.value else { return None };
    let value = items.get(1)?;
    if let Value::Number(x) = value.value { Some((&value.span, x)) } else { None }
}

/// A number rounded to six significant digits, so that scaling leaves no rounding error in the text.
fn written(x: f64) -> String {
    let digits = if x == 0.0 { 0 } else { (5.0 - x.abs().log10().floor()).clamp(0.0, 15.0) as usize };
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read_scene_text;

    const TEXT: &str = r#"// A scene of mine.
Scene(
    time: (start: 1, end: 9, fps: 24),
    nodes: {
        "nucleus1": nucleus(
            subSteps: 3, // as Maya has it
            evaluations: keys([(1, 96, stepped), (13, 768), /* slow */ (30, 384)]),
        ),
        "plane": polyPlane(),
        "cloth1": nCloth(inputMesh: "plane", stch: 20),
    },
)
"#;

    fn of(node: &str, attribute: &str, to: NewValue) -> Edit {
        Edit { node: node.to_owned(), attribute: attribute.to_owned(), to }
    }

    fn text(new: &str) -> NewValue {
        NewValue::Text(new.to_owned())
    }

    #[test]
    fn a_change_replaces_only_the_value() {
        let edited = edit(TEXT, &[of("nucleus1", "subSteps", text("8"))]).unwrap();
        assert_eq!(edited, TEXT.replace("subSteps: 3,", "subSteps: 8,"));
    }

    #[test]
    fn values_of_keys_are_scaled_one_by_one() {
        let half = NewValue::Scaled { factor: 0.01, least: 1.0, default: 96.0 };
        let edited = edit(TEXT, &[of("nucleus1", "evaluations", half)]).unwrap();
        assert!(edited.contains("keys([(1, 1, stepped), (13, 7.68), /* slow */ (30, 3.84)])"), "{edited}");
    }

    #[test]
    fn attributes_that_are_not_set_are_added_in_the_layout_of_their_node() {
        let edits = [
            of("nucleus1", "maxCollisionIterations", text("5")),
            of("cloth1", "damp", text("0.1")),
            of("plane", "width", text("2")),
        ];
        let edited = edit(TEXT, &edits).unwrap();
        assert!(edited.contains("(30, 384)]),\n            maxCollisionIterations: 5,\n"), "{edited}");
        assert!(edited.contains("nCloth(inputMesh: \"plane\", stch: 20, damp: 0.1)"), "{edited}");
        assert!(edited.contains("polyPlane(width: 2)"), "{edited}");
        assert!(read_scene_text(&edited, "a.ron".as_ref()).is_ok());
    }

    #[test]
    fn short_names_are_found_by_the_long_name() {
        let double = NewValue::Scaled { factor: 2.0, least: 0.0, default: 20.0 };
        let edited = edit(TEXT, &[of("cloth1", "stretchResistance", double)]).unwrap();
        assert!(edited.contains("stch: 40)"), "{edited}");
    }

    #[test]
    fn a_component_is_replaced_within_its_vector_or_in_its_own_field() {
        let of_plane = |set: &str, attribute: &str| {
            let scene = TEXT.replace("polyPlane()", &format!("polyPlane({set})"));
            edit(&scene, &[of("plane", attribute, text("7"))]).unwrap()
        };
        assert!(of_plane("translate: (1, 2, 3)", "translateY").contains("polyPlane(translate: (1, 7, 3))"));
        assert!(of_plane("ty: 2", "translateY").contains("polyPlane(ty: 7)"));
        assert!(of_plane("width: 2", "translateY").contains("polyPlane(width: 2, translateY: 7)"));
    }

    #[test]
    fn a_vector_replaces_its_components() {
        let of_plane = |set: &str| {
            let scene = TEXT.replace("polyPlane()", &format!("polyPlane({set})"));
            let edited = edit(&scene, &[of("plane", "translate", text("(0, 2, 0)"))]).unwrap();
            assert!(read_scene_text(&edited, "a.ron".as_ref()).is_ok(), "{edited}");
            edited
        };
        assert!(of_plane("translateY: 1").contains("polyPlane(translate: (0, 2, 0))"));
        assert!(
            of_plane("ty: keys([(1, 1), (5, 2)]), width: 2")
                .contains("polyPlane(translate: (0, 2, 0), width: 2)")
        );
        let two = of_plane("translateX: 3, width: 2, translateY: 1, height: 4");
        assert!(two.contains("polyPlane(translate: (0, 2, 0), width: 2, height: 4)"), "{two}");
    }

    #[test]
    fn missing_nodes_and_malformed_texts_are_errors() {
        let missing = edit(TEXT, &[of("n", "subSteps", text("8"))]).unwrap_err();
        assert_eq!(missing, EditError::NoNode { node: "n".to_owned() });
        assert!(matches!(edit("Scene(", &[]), Err(EditError::NotAScene { .. })));
    }

    #[test]
    fn numbers_are_rounded_to_six_significant_digits() {
        assert_eq!([0.1 + 0.2, 192.0, 1e-7 / 3.0, 0.0].map(written), ["0.3", "192", "0.0000000333333", "0"]);
    }
}
