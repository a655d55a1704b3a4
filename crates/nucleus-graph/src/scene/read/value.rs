//! Single values: numbers, vectors, words and texts, checked against the row of their attribute.

use std::ops::Range;

use crate::attributes::{Attribute, Choice, Kind, Value as AttrValue};
use crate::diagnostic::{Findings, listed, nearest, value_of};
use crate::scene::syntax::{Node, Value};

/// Integers up to here are exact in a 64-bit float.
const MAX_EXACT_INTEGER: f64 = 9_007_199_254_740_992.0;

/// A number, a switch or the word of an enum.
pub(super) fn single(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<AttrValue> {
    match (row.kind, &node.value) {
        (Kind::Bool, Value::Bool(on)) => Some(AttrValue::Bool(*on)),
        (Kind::Int, _) => {
            let number = whole_number(label, node, findings)?;
            within(label, row, number, &node.span, findings).map(|number| AttrValue::Int(number as i64))
        }
        (Kind::Texture, value) if !matches!(value, Value::Number(_)) => {
            expected(label, row.kind.expects(), node, findings)
        }
        (Kind::Float | Kind::Texture, _) => number_within(label, row, node, findings).map(AttrValue::Float),
        (Kind::Choice(_), _) => choice(label, row, node, findings).map(AttrValue::Choice),
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
        Value::Number(number) if number.fract() == 0.0 && number.abs() <= MAX_EXACT_INTEGER => Some(number),
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

/// Describes a value for messages: `found ...`.
pub(super) fn found(value: &Value) -> String {
    match value {
        Value::Word(word) => format!("the word `{word}`"),
        Value::Tuple { name: Some(name), .. } | Value::Record { name: Some(name), .. } => {
            format!("`{}(...)`", name.text)
        }
        other => other.kind().to_owned(),
    }
}

/// Reports that a value has the wrong form.
pub(super) fn expected<T>(label: &str, what: &str, node: &Node, findings: &mut Findings) -> Option<T> {
    findings.error(&node.span, format!("{label} takes {what}, found {}", found(&node.value)));
    None
}

pub(super) fn number_within(
    label: &str,
    row: &'static Attribute,
    node: &Node,
    findings: &mut Findings,
) -> Option<f64> {
    let number = number(label, node, findings)?;
    within(label, row, number, &node.span, findings)
}

/// The number, if it is in the hard range of the attribute.
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

/// A number in its shorter notation: `100000`, `1e300`.
fn written(x: f64) -> String {
    if x.abs() < 1e7 && (x == 0.0 || x.abs() >= 1e-5) { format!("{x}") } else { format!("{x:e}") }
}

/// A word of an enum, or Maya's index.
fn choice(label: &str, row: &'static Attribute, node: &Node, findings: &mut Findings) -> Option<Choice> {
    let words = row.words();
    let found = match &node.value {
        Value::Word(name) | Value::Text(name) => {
            value_of(name, words.iter().map(|(index, word)| (word.as_str(), *index))).ok_or(name.as_str())
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
        other => format!("{label} takes one of its words, found {}", self::found(other)),
    };
    let error = findings.error(&node.span, message);
    match nearest(wrong, all.iter().copied()) {
        Some(near) => error.did_you_mean(Some(near)),
        None => error.help(format!("it takes {}", listed(&all))),
    };
    None
}
