//! Keyed values: `keys([(1, 0), (24, 12.5, spline), (48, 0)])`, or with infinities, `keys(at: [...], post: cycle)`.

use crate::animation::{Curve, Infinity, Key, Tangent};
use crate::attributes::{Attribute, Kind, Value as AttrValue};
use crate::diagnostic::{Findings, listed, nearest, value_of};
use crate::graph::{Channel, Setting};
use crate::scene::syntax::{Node, Value, Word};

use super::value::{expected, found, number, single, triple};

/// The parts of `keys(...)`, not read yet.
pub(super) struct Keyed<'a> {
    /// The keys.
    list: &'a Node,
    /// The values of `pre` and `post`.
    infinities: [Option<&'a Node>; 2],
    /// Fields other than `at`, `pre` and `post`.
    unknown: Vec<&'a Word>,
}

/// The parts of `keys([...])` or `keys(at: [...], pre: cycle, post: linear)`. `None` for other values.
pub(super) fn keyed(node: &Node) -> Option<Keyed<'_>> {
    match &node.value {
        Value::Tuple { name: Some(name), items } if name.text == "keys" && items.len() == 1 => {
            Some(Keyed { list: items.first()?, infinities: [None, None], unknown: Vec::new() })
        }
        Value::Record { name: Some(name), fields } if name.text == "keys" => {
            let field = |name: &str| fields.iter().find(|(word, _)| word.text == name).map(|(_, node)| node);
            let unknown = fields.iter().map(|(word, _)| word);
            let unknown = unknown.filter(|word| !["at", "pre", "post"].contains(&word.text.as_str()));
            Some(Keyed {
                list: field("at").unwrap_or(node),
                infinities: [field("pre"), field("post")],
                unknown: unknown.collect(),
            })
        }
        _ => None,
    }
}

impl Keyed<'_> {
    /// Reads the infinities. Refuses unknown fields.
    fn infinities(&self, label: &str, findings: &mut Findings) -> Option<[Infinity; 2]> {
        let names: Vec<&str> = Infinity::WORDS.iter().map(|(name, _)| *name).collect();
        for word in &self.unknown {
            let error = findings.error(&word.span, format!("the keys of {label} have no `{}`", word.text));
            error.help("keys take `at`, `pre` and `post`");
        }
        let [pre, post] = self.infinities.map(|node| {
            let Some(node) = node else { return Some(Infinity::Constant) };
            let Value::Word(word) = &node.value else {
                return expected(label, "the word of an infinity, like `cycle`", node, findings);
            };
            let known = value_of(word, Infinity::WORDS);
            if known.is_none() {
                let error = findings.error(&node.span, format!("there is no infinity `{word}`"));
                match nearest(word, names.iter().copied()) {
                    Some(near) => error.did_you_mean(Some(near)),
                    None => error.help(format!("there are {}", listed(&names))),
                };
            }
            known
        });
        if self.unknown.is_empty() { Some([pre?, post?]) } else { None }
    }
}

/// Reads the keys of an attribute. Keys of a vector have three numbers each.
pub(super) fn read(
    label: &str,
    row: &'static Attribute,
    keyed: Keyed,
    findings: &mut Findings,
) -> Option<Setting> {
    let list = keyed.list;
    let infinities = keyed.infinities(label, findings)?;
    if !may_be_keyed(label, row, list, findings) {
        return None;
    }
    if let Kind::Vector(_) = row.kind {
        let keys =
            read_keys(label, row, list, findings, |node, findings| triple(label, row, node, findings))?;
        let curves = [0, 1, 2].map(|part| {
            let part = keys.iter().map(|&(frame, value, tangent)| Key { frame, value: value[part], tangent });
            curve(label, part.collect(), infinities, list, findings).map(Channel::Keyed)
        });
        let [x, y, z] = curves;
        return Some(Setting::Parts([x?, y?, z?]));
    }
    let value = |node: &Node, findings: &mut Findings| {
        single(label, row, node, findings).map(|held| as_number(&held))
    };
    let keys = read_keys(label, row, list, findings, value)?;
    let keys = keys.into_iter().map(|(frame, value, tangent)| Key { frame, value, tangent });
    curve(label, keys.collect(), infinities, list, findings).map(Setting::Keyed)
}

/// Reads the keys of one component of a vector.
pub(super) fn read_part(
    label: &str,
    row: &'static Attribute,
    keyed: Keyed,
    findings: &mut Findings,
) -> Option<Curve> {
    let list = keyed.list;
    let infinities = keyed.infinities(label, findings)?;
    if !may_be_keyed(label, row, list, findings) {
        return None;
    }
    let keys = read_keys(label, row, list, findings, |node, findings| number(label, node, findings))?;
    let keys = keys.into_iter().map(|(frame, value, tangent)| Key { frame, value, tangent });
    curve(label, keys.collect(), infinities, list, findings)
}

fn may_be_keyed(label: &str, row: &'static Attribute, list: &Node, findings: &mut Findings) -> bool {
    if !row.can_be_keyed() {
        findings.error(&list.span, format!("{label} cannot be keyed: it is read once, at the start"));
    }
    row.can_be_keyed()
}

type Keys<T> = Vec<(f64, T, Tangent)>;

fn read_keys<T>(
    label: &str,
    row: &'static Attribute,
    list: &Node,
    findings: &mut Findings,
    mut read_value: impl FnMut(&Node, &mut Findings) -> Option<T>,
) -> Option<Keys<T>> {
    let Value::List(items) = &list.value else {
        return expected(label, "a list of keys, like keys([(1, 0), (24, 1)])", list, findings);
    };
    if items.is_empty() {
        findings.error(&list.span, format!("{label} has no keys")).help("give at least one key, like (1, 0)");
        return None;
    }
    let before = findings.errors();
    let mut keys: Keys<T> = Vec::with_capacity(items.len());
    for item in items {
        let Some((frame, value, tangent)) = parts(label, item, findings) else { continue };
        let (frame, value) = (number("the frame of a key", frame, findings), read_value(value, findings));
        let tangent = tangent.map_or(Some(default_tangent(row)), |word| read_tangent(word, findings));
        let (Some(frame), Some(value), Some(tangent)) = (frame, value, tangent) else { continue };
        match keys.last() {
            Some(&(previous, ..)) if frame <= previous => {
                let message =
                    format!("the keys of {label} are not in order: frame {frame} after frame {previous}");
                findings.error(&item.span, message);
            }
            _ => keys.push((frame, value, tangent)),
        }
    }
    (findings.errors() == before).then_some(keys)
}

/// Frame, value and tangent of a key.
fn parts<'a>(
    label: &str,
    item: &'a Node,
    findings: &mut Findings,
) -> Option<(&'a Node, &'a Node, Option<&'a Node>)> {
    let Value::Tuple { name: None, items } = &item.value else {
        return expected(label, "keys of (frame, value)", item, findings);
    };
    match items.as_slice() {
        [frame, value] => Some((frame, value, None)),
        [frame, value, tangent] => Some((frame, value, Some(tangent))),
        _ => {
            let message =
                format!("a key is (frame, value) or (frame, value, tangent), found {} parts", items.len());
            findings.error(&item.span, message);
            None
        }
    }
}

/// Switches and words are stepped by default, numbers linear.
fn default_tangent(row: &Attribute) -> Tangent {
    match row.kind {
        Kind::Bool | Kind::Choice(_) => Tangent::Stepped,
        _ => Tangent::Linear,
    }
}

const TANGENTS: &str = "a tangent is `stepped`, `linear`, `spline`, `flat` or `auto`";

fn read_tangent(node: &Node, findings: &mut Findings) -> Option<Tangent> {
    let tangents = Tangent::WORDS;
    if let Value::Word(word) = &node.value {
        if let Some(tangent) = value_of(word, tangents) {
            return Some(tangent);
        }
        let error = findings.error(&node.span, format!("there is no tangent `{word}`"));
        match nearest(word, tangents.iter().map(|(name, _)| *name)) {
            Some(near) => error.did_you_mean(Some(near)),
            None => error.help(TANGENTS),
        };
        return None;
    }
    let error = findings.error(&node.span, format!("a tangent is a word, found {}", found(&node.value)));
    error.help(TANGENTS);
    None
}

fn curve(
    label: &str,
    keys: Vec<Key>,
    [before, after]: [Infinity; 2],
    list: &Node,
    findings: &mut Findings,
) -> Option<Curve> {
    let curve = Curve::new(keys);
    if let Err(error) = &curve {
        findings.error(&list.span, format!("the keys of {label} make no curve: {error}"));
    }
    curve.ok().map(|curve| curve.with_infinity(before, after))
}

fn as_number(value: &AttrValue) -> f64 {
    match value {
        AttrValue::Bool(on) => f64::from(u8::from(*on)),
        AttrValue::Int(number) => *number as f64,
        AttrValue::Float(number) => *number,
        AttrValue::Choice(choice) => f64::from(choice.0),
        _ => 0.0,
    }
}
