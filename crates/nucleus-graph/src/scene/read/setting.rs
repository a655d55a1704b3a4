//! The setting of an attribute: a value, keys, or the source of a map.

use std::borrow::Cow;
use std::ops::Range;

use crate::attributes::{
    Attribute, Choice, ColorPoint, Kind, Painting, RampPoint, SelectedValues, Value as AttrValue,
};
use crate::diagnostic::{Findings, listed, value_of};
use crate::graph::{Channel, Setting};
use crate::paint::Expression;
use crate::scene::syntax::{Node, Value};

use super::keys;
use super::value::{expected, number, number_within, single, text, triple, whole_number};

/// Reads the setting of an attribute. `label` names attribute and node in messages.
pub(super) fn read(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<Setting> {
    if let Some(keyed) = keys::keyed(node) {
        return keys::read(label, row, keyed, findings);
    }
    if let Kind::Vector(_) = row.kind {
        let parts = triple(label, row, node, findings)?;
        return Some(Setting::Parts(parts.map(Channel::Fixed)));
    }
    if let Some(painting) = painting(label, row, node, findings) {
        return painting.map(|painting| Setting::Fixed(AttrValue::Painting(painting)));
    }
    let value = match row.kind {
        Kind::Text => AttrValue::Text(text(label, node, findings)?.to_owned()),
        // A text alone stands for all elements.
        Kind::Texts if matches!(node.value, Value::Text(_)) => {
            AttrValue::Texts(vec![text(label, node, findings)?.to_owned()])
        }
        Kind::Texts => AttrValue::Texts(list(label, row, node, findings, |node, findings| {
            text(label, node, findings).map(str::to_owned)
        })?),
        Kind::Ints => AttrValue::Ints(list(label, row, node, findings, |node, findings| {
            let number = whole_number(label, node, findings)?;
            Some(number.clamp(0.0, f64::from(u32::MAX)) as u32)
        })?),
        Kind::Floats => AttrValue::Floats(list(label, row, node, findings, |node, findings| {
            number(label, node, findings)
        })?),
        // A vector alone counts for all points.
        Kind::Vectors if matches!(node.value, Value::Tuple { name: None, .. }) => {
            AttrValue::Vectors(vec![triple(label, row, node, findings)?])
        }
        Kind::Vectors => AttrValue::Vectors(list(label, row, node, findings, |node, findings| {
            triple(label, row, node, findings)
        })?),
        Kind::Ramp => AttrValue::Ramp(Cow::Owned(list(label, row, node, findings, |node, findings| {
            ramp_point(label, node, findings)
        })?)),
        Kind::ColorRamp => {
            AttrValue::ColorRamp(Cow::Owned(list(label, row, node, findings, |node, findings| {
                color_point(label, row, node, findings)
            })?))
        }
        Kind::Plug(_) => {
            findings.error(&node.span, format!("{label} can be connected, but not set"));
            return None;
        }
        _ => single(label, row, node, findings)?,
    };
    Some(Setting::Fixed(value))
}

/// The source of a map: `file("...")`, `expression("...")`, `selection("...")` or `texture("...")`. `None` for other values, `Some(None)`
/// after a mistake.
fn painting(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<Option<Painting>> {
    let Value::Tuple { name: Some(word), items } = &node.value else { return None };
    let make: fn(String) -> Painting = match (word.text.as_str(), row.kind) {
        ("file", Kind::Floats | Kind::Vectors) => Painting::File,
        ("expression", Kind::Floats) => Painting::Expression,
        ("selection", Kind::Floats) => Painting::Selection,
        ("texture", Kind::Texture) => Painting::Texture,
        _ => return None,
    };
    let [item] = items.as_slice() else {
        findings.error(&node.span, format!("`{}` takes one text, found {} values", word.text, items.len()));
        return Some(None);
    };
    let Some(text) = text(label, item, findings) else { return Some(None) };
    if word.text == "expression"
        && let Err(error) = Expression::parse(text)
    {
        let place = within_text(text, item, error.span);
        let diagnostic = findings.error(&place, format!("{label}: {}", error.message));
        diagnostic.help = error.help;
        return Some(None);
    }
    if word.text == "selection"
        && let Err(message) = SelectedValues::parse(text)
    {
        findings.error(&item.span, format!("{label}: {message}"));
        return Some(None);
    }
    Some(Some(make(text.to_owned())))
}

/// A range of a text in quotes as a place in the file. The whole text if it has escapes.
fn within_text(text: &str, node: &Node, at: Range<usize>) -> Range<usize> {
    let is_plain = node.span.len() == text.len() + 2;
    if is_plain { node.span.start + 1 + at.start..node.span.start + 1 + at.end } else { node.span.clone() }
}

/// One component of a vector, keyed or not.
pub(super) fn read_part(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<Channel> {
    match keys::keyed(node) {
        Some(keyed) => keys::read_part(label, row, keyed, findings).map(Channel::Keyed),
        None => number_within(label, row, node, findings).map(Channel::Fixed),
    }
}

fn list<T>(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
    mut read_item: impl FnMut(&Node, &mut Findings) -> Option<T>,
) -> Option<Vec<T>> {
    let Value::List(items) = &node.value else {
        return expected(label, row.kind.expects(), node, findings);
    };
    let read: Vec<Option<T>> = items.iter().map(|item| read_item(item, findings)).collect();
    read.into_iter().collect()
}

/// A point of a ramp: `(0.5, 1)` or `(0.5, 1, smooth)`. Without a word, the interpolation is linear.
fn ramp_point(label: &str, node: &Node, findings: &mut Findings) -> Option<RampPoint> {
    let (position, value, interpolation) = point_parts(label, "points of (position, value)", node, findings)?;
    let [position, value] = [position, value].map(|item| number(label, item, findings));
    Some(RampPoint { position: position?, value: value?, interpolation })
}

/// A point of a colour ramp: `(0.5, (1, 0, 0))` or `(0.5, (1, 0, 0), smooth)`.
fn color_point(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<ColorPoint> {
    let what = "points of (position, (red, green, blue))";
    let (position, color, interpolation) = point_parts(label, what, node, findings)?;
    let (position, color) = (number(label, position, findings), triple(label, row, color, findings));
    Some(ColorPoint { position: position?, color: color?, interpolation })
}

/// Position, value, and the interpolation to the next point.
fn point_parts<'a>(
    label: &str,
    what: &str,
    node: &'a Node,
    findings: &mut Findings,
) -> Option<(&'a Node, &'a Node, Choice)> {
    let (position, value, word) = match &node.value {
        Value::Tuple { name: None, items } => match items.as_slice() {
            [position, value] => (position, value, "linear"),
            [position, value, Node { value: Value::Word(word), .. }] => (position, value, word.as_str()),
            _ => return expected(label, what, node, findings),
        },
        _ => return expected(label, what, node, findings),
    };
    let known = RampPoint::INTERPOLATIONS.iter().enumerate().map(|(index, name)| (*name, index));
    let Some(index) = value_of(word, known) else {
        let error = findings.error(&node.span, format!("{label} has no interpolation `{word}`"));
        error.help(format!("it takes {}", listed(&RampPoint::INTERPOLATIONS)));
        return None;
    };
    Some((position, value, Choice(index as i32)))
}
