//! The value of an attribute, as its row wants it.

use std::borrow::Cow;
use std::ops::Range;

use crate::attributes::{Attribute, Choice, ColorPoint, Kind, Painting, RampPoint, Value as Held};
use crate::graph::{Channel, Setting};
use crate::paint::Expression;
use crate::scene::findings::Findings;
use crate::scene::nearest;
use crate::scene::syntax::{Node, Value};

use super::fields::listed;
use super::keys;

/// Integers up to here are exact in a 64-bit float.
const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;

/// Reads what an attribute is set to. `label` names attribute and node in messages.
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
        return painting.map(|painting| Setting::Fixed(Held::Painting(painting)));
    }
    let value = match row.kind {
        Kind::Text => Held::Text(text(label, node, findings)?.to_owned()),
        Kind::Ints => Held::Ints(list(label, row, node, findings, |node, findings| {
            let number = whole_number(label, node, findings)?;
            Some(number.clamp(0.0, f64::from(u32::MAX)) as u32)
        })?),
        Kind::Floats => {
            Held::Floats(list(label, row, node, findings, |node, findings| number(label, node, findings))?)
        }
        Kind::Vectors => Held::Vectors(list(label, row, node, findings, |node, findings| {
            triple(label, row, node, findings)
        })?),
        Kind::Ramp => Held::Ramp(Cow::Owned(list(label, row, node, findings, |node, findings| {
            ramp_point(label, node, findings)
        })?)),
        Kind::ColorRamp => {
            Held::ColorRamp(Cow::Owned(list(label, row, node, findings, |node, findings| {
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

/// What makes the values of points, if that is what stands there: `file("...")`, `expression("...")` or
/// `texture("...")`. Inside is nothing if it is wrong.
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
        let said = findings.error(&place, format!("{label}: {}", error.message));
        said.help = error.help;
        return Some(None);
    }
    Some(Some(make(text.to_owned())))
}

/// A place within a text in quotes; all of it where the text is not written as it stands.
fn within_text(text: &str, node: &Node, at: Range<usize>) -> Range<usize> {
    let is_plain = node.span.len() == text.len() + 2;
    if is_plain { node.span.start + 1 + at.start..node.span.start + 1 + at.end } else { node.span.clone() }
}

/// One part of a vector, keyed or not.
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

/// A number, a switch or a word.
pub(super) fn single(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<Held> {
    match (row.kind, &node.value) {
        (Kind::Bool, Value::Bool(on)) => Some(Held::Bool(*on)),
        (Kind::Int, _) => {
            let number = whole_number(label, node, findings)?;
            within(label, row, number, &node.span, findings).map(|number| Held::Int(number as i64))
        }
        (Kind::Texture, value) if !matches!(value, Value::Number(_)) => {
            expected(label, row.kind.expects(), node, findings)
        }
        (Kind::Float | Kind::Texture, _) => number_within(label, row, node, findings).map(Held::Float),
        (Kind::Choice(_), _) => choice(label, row, node, findings).map(Held::Choice),
        _ => expected(label, row.kind.expects(), node, findings),
    }
}

/// Three numbers, in a tuple or a list.
pub(super) fn triple(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<[f64; 3]> {
    match &node.value {
        Value::Tuple { name: None, items } | Value::List(items) if items.len() == 3 => {
            let parts = [0, 1, 2].map(|part| number_within(label, row, &items[part], findings));
            Some([parts[0]?, parts[1]?, parts[2]?])
        }
        Value::Tuple { name: None, items } | Value::List(items) => {
            let message = format!("{label} takes three numbers, found {}", items.len());
            findings.error(&node.span, message);
            None
        }
        _ => expected(label, "three numbers, like (0, 1, 0)", node, findings),
    }
}

/// Any finite number.
pub(super) fn number(label: &str, node: &Node, findings: &mut Findings) -> Option<f64> {
    match node.value {
        Value::Number(number) => Some(number),
        _ => expected(label, "a number", node, findings),
    }
}

/// A number without a fraction.
pub(super) fn whole_number(label: &str, node: &Node, findings: &mut Findings) -> Option<f64> {
    match node.value {
        Value::Number(number) if number.fract() == 0.0 && number.abs() <= LARGEST_EXACT => Some(number),
        Value::Number(number) => {
            findings.error(&node.span, format!("{label} takes a whole number, found {number}"));
            None
        }
        _ => expected(label, "a whole number", node, findings),
    }
}

/// Text in quotes.
pub(super) fn text<'a>(label: &str, node: &'a Node, findings: &mut Findings) -> Option<&'a str> {
    match &node.value {
        Value::Text(text) => Some(text),
        _ => expected(label, "text in quotes", node, findings),
    }
}

/// What a value is, for `found ...`.
pub(super) fn found(value: &Value) -> String {
    match value {
        Value::Word(word) => format!("the word `{word}`"),
        Value::Tuple { name: Some(name), .. } | Value::Record { name: Some(name), .. } => {
            format!("`{}(...)`", name.text)
        }
        other => other.kind().to_owned(),
    }
}

/// Says what should have been there.
pub(super) fn expected<T>(label: &str, what: &str, node: &Node, findings: &mut Findings) -> Option<T> {
    findings.error(&node.span, format!("{label} takes {what}, found {}", found(&node.value)));
    None
}

fn number_within(label: &str, row: &'static Attribute, node: &Node, findings: &mut Findings) -> Option<f64> {
    let number = number(label, node, findings)?;
    within(label, row, number, &node.span, findings)
}

/// The number, if it is in the hard range.
fn within(
    label: &str,
    row: &'static Attribute,
    number: f64,
    span: &Range<usize>,
    findings: &mut Findings,
) -> Option<f64> {
    if row.range.contains(number) {
        return Some(number);
    }
    let bounds = match (row.range.min, row.range.max) {
        (Some(min), Some(max)) => format!("between {} and {}", written(min), written(max)),
        (Some(min), None) => format!("at least {}", written(min)),
        (None, Some(max)) => format!("at most {}", written(max)),
        (None, None) => "a number".to_owned(),
    };
    findings.error(span, format!("{label} must be {bounds}, found {}", written(number)));
    None
}

/// A number as one would write it: `100000`, `1e300`.
fn written(x: f64) -> String {
    if x.abs() < 1e7 && (x == 0.0 || x.abs() >= 1e-5) { format!("{x}") } else { format!("{x:e}") }
}

/// A word of an enum: ours, Maya's own name of it, or Maya's index.
fn choice(label: &str, row: &'static Attribute, node: &Node, findings: &mut Findings) -> Option<Choice> {
    let Kind::Choice(mayas) = row.kind else { return None };
    let words = row.words();
    let found = match &node.value {
        Value::Word(name) | Value::Text(name) => {
            let ours = words.iter().find(|(_, word)| word == name).map(|(index, _)| *index);
            let theirs = || mayas.iter().find(|(_, word)| word == name).map(|(index, _)| Choice(*index));
            ours.or_else(theirs).ok_or(name.as_str())
        }
        Value::Number(number) => {
            let index = words.iter().map(|(index, _)| *index).find(|index| f64::from(index.0) == *number);
            index.ok_or("")
        }
        _ => Err(""),
    };
    let wrong = match found {
        Ok(index) => return Some(index),
        Err(wrong) => wrong,
    };
    let all: Vec<&str> = words.iter().map(|(_, word)| word.as_str()).collect();
    let message = match &node.value {
        Value::Word(_) | Value::Text(_) => format!("{label} has no word `{wrong}`"),
        other => format!("{label} takes one of its words, found {}", super::value::found(other)),
    };
    let error = findings.error(&node.span, message);
    match nearest(wrong, all.iter().copied()) {
        Some(near) => error.did_you_mean(Some(near)),
        None => error.help(format!("it takes {}", listed(&all))),
    };
    None
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

/// How Maya goes from one point of a ramp to the next, by its index.
pub(in crate::scene) const INTERPOLATIONS: [&str; 4] = ["none", "linear", "smooth", "spline"];

/// `(0.5, 1)` or `(0.5, 1, smooth)`: a point of a ramp, straight on to the next unless a word says how.
fn ramp_point(label: &str, node: &Node, findings: &mut Findings) -> Option<RampPoint> {
    let (position, value, interpolation) = point_parts(label, "points of (position, value)", node, findings)?;
    let [position, value] = [position, value].map(|item| number(label, item, findings));
    Some(RampPoint { position: position?, value: value?, interpolation })
}

/// `(0.5, (1, 0, 0))` or `(0.5, (1, 0, 0), smooth)`.
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

/// Position, value, and the word for the way to the next point.
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
    let Some(index) = INTERPOLATIONS.iter().position(|name| *name == word) else {
        let error = findings.error(&node.span, format!("{label} has no interpolation `{word}`"));
        error.help(format!("it takes {}", listed(&INTERPOLATIONS)));
        return None;
    };
    Some((position, value, Choice(index as i32)))
}
