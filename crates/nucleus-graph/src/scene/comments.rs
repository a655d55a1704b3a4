//! Comments of a scene file, each with the item of the written scene that it belongs to, so that formatting keeps them.
//!
//! The text that was read and the text that is written are compared as trees. An item is a field, a node, an attribute,
//! a check, a connection, or an entry of a list within one of them. A comment belongs to the same item in both texts.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::attributes::{Attribute, Kind, NodeType, node_type};
use crate::graph::Graph;

use super::syntax::{Node, Value};

/// The comments of a scene, by places in the text that is written.
#[derive(Debug, Default)]
pub(super) struct Comments {
    /// Lines before the scene.
    pub(super) head: Vec<String>,
    /// Lines after the scene.
    pub(super) foot: Vec<String>,
    /// By the start of an item: lines before it.
    pub(super) before: BTreeMap<usize, Vec<String>>,
    /// By the start of an item: the comment on its last line.
    pub(super) after: BTreeMap<usize, String>,
    /// By the start of a container: the comment behind its opening bracket.
    pub(super) opening: BTreeMap<usize, String>,
    /// By the start of a container: lines before its closing bracket.
    pub(super) closing: BTreeMap<usize, Vec<String>>,
}

impl Comments {
    /// The comments of a text with the tree `source`, placed in a text with the tree `written`. Both are of a scene
    /// with this graph.
    pub(super) fn of(text: &str, source: &Node, written: &Node, graph: &Graph) -> Self {
        let mut placed = Self::default();
        let mut within = Vec::new();
        for comment in find_comments(text, source) {
            if comment.span.start < source.span.start {
                placed.head.extend(comment.lines);
            } else if comment.span.start >= source.span.end {
                placed.foot.extend(comment.lines);
            } else {
                within.push(comment);
            }
        }
        Placing { text, graph, all: within, placed: &mut placed }.place(source, written, Level::Scene);
        placed
    }

    /// Whether an item of a container has a comment before it, on its last line or inside it.
    pub(super) fn are_at(&self, container: &Node, key: &str) -> bool {
        let items = items(container).unwrap_or_default();
        let has_one = |item: &Item| {
            let start = item.span.start;
            self.before.contains_key(&start) || self.after.contains_key(&start) || self.are_inside(item.value)
        };
        items.iter().any(|item| item.key == key && has_one(item))
    }

    /// Whether a container holds comments, in itself or in its items.
    pub(super) fn are_inside(&self, container: &Node) -> bool {
        let Range { start, end } = container.span;
        // An item of a list starts where its own container does, and its comments are outside of that.
        let items = start + 1..end;
        self.opening.range(start..end).next().is_some()
            || self.closing.range(start..end).next().is_some()
            || self.before.range(items.clone()).next().is_some()
            || self.after.range(items).next().is_some()
    }
}

/// An item of a container.
pub(super) struct Item<'a> {
    /// The name of a field or a node, or the index of an entry.
    pub(super) key: String,
    /// From its name to the end of its value.
    pub(super) span: Range<usize>,
    pub(super) value: &'a Node,
}

/// The items of a container. `None` for a value without brackets.
pub(super) fn items(node: &Node) -> Option<Vec<Item<'_>>> {
    match &node.value {
        Value::Record { fields, .. } => {
            Some(fields.iter().map(|(word, value)| named(&word.text, word.span.start, value)).collect())
        }
        Value::Map(entries) => Some(
            entries
                .iter()
                .map(|(key, value)| match &key.value {
                    Value::Text(name) => named(name, key.span.start, value),
                    _ => named("", key.span.start, value),
                })
                .collect(),
        ),
        // `keys([...])` and `keys(at: [...])` are the same.
        Value::Tuple { name: Some(name), items } if name.text == "keys" => {
            Some(items.iter().map(|value| named("at", value.span.start, value)).collect())
        }
        Value::Tuple { items, .. } | Value::List(items) => {
            let items = items.iter().enumerate();
            Some(items.map(|(k, value)| named(&k.to_string(), value.span.start, value)).collect())
        }
        Value::Number(_) | Value::Text(_) | Value::Bool(_) | Value::Word(_) => None,
    }
}

fn named<'a>(key: &str, start: usize, value: &'a Node) -> Item<'a> {
    Item { key: key.to_owned(), span: start..value.span.end, value }
}

/// What the items of a container are.
#[derive(Clone, Copy)]
enum Level {
    /// Fields of the scene.
    Scene,
    /// Nodes by name.
    Nodes,
    /// Attributes of a node of this type.
    Attributes(&'static NodeType),
    /// Pairs of plugs.
    Connections,
    /// Parts of a value.
    Value,
}

impl Level {
    /// The level of the container that is the value of an item.
    fn of(self, item: &Item) -> Self {
        match (self, item.key.as_str(), &item.value.value) {
            (Self::Scene, "nodes", _) => Self::Nodes,
            (Self::Scene, "connections", _) => Self::Connections,
            (Self::Nodes, _, Value::Record { name: Some(name), .. }) => {
                node_type(&name.text).map_or(Self::Value, Self::Attributes)
            }
            _ => Self::Value,
        }
    }

    /// The names under which an item may be written, the likeliest first.
    fn keys(self, item: &Item, graph: &Graph) -> Vec<String> {
        match self {
            Self::Attributes(node_type) => attribute_keys(node_type, &item.key),
            Self::Connections => vec![connection_key(item.value, graph)],
            Self::Scene | Self::Nodes | Self::Value => vec![item.key.clone()],
        }
    }
}

/// An attribute by its long name; then a vector for its component; then the components or attributes that are set
/// together.
fn attribute_keys(node_type: &'static NodeType, word: &str) -> Vec<String> {
    let components =
        |row: &Attribute| row.parts().into_iter().flatten().map(|(long, _)| long).collect::<Vec<_>>();
    if let Some(row) = node_type.attribute(word) {
        let together = if let Kind::Together(parts) = row.kind { parts } else { &[] };
        let parts = components(row).into_iter().chain(together.iter().map(|&part| part.to_owned()));
        return [row.name.to_owned()].into_iter().chain(parts).collect();
    }
    match node_type.part(word) {
        Some((row, part)) => components(row).drain(part..=part).chain([row.name.to_owned()]).collect(),
        None => vec![word.to_owned()],
    }
}

/// The plugs of a connection, with the names that they are written with.
fn connection_key(pair: &Node, graph: &Graph) -> String {
    let plug = |item: &Item| match &item.value.value {
        Value::Text(text) => graph.plug(text).map_or_else(|_| text.clone(), |plug| graph.describe(plug)),
        _ => String::new(),
    };
    items(pair).unwrap_or_default().iter().map(plug).collect::<Vec<_>>().join(" ")
}

/// Places comments of a text, container by container.
struct Placing<'a> {
    text: &'a str,
    graph: &'a Graph,
    /// The comments within the scene, in the order of the text.
    all: Vec<Comment>,
    placed: &'a mut Comments,
}

impl Placing<'_> {
    /// Places the comments of a container.
    fn place(&mut self, source: &Node, written: &Node, level: Level) {
        let inside = |span: &Range<usize>| {
            let before = |at: usize| self.all.partition_point(|comment| comment.span.start < at);
            before(span.start)..before(span.end)
        };
        let own = inside(&source.span);
        let (Some(sources), Some(targets)) = (items(source), items(written)) else { return };
        if own.is_empty() {
            return;
        }
        let known: BTreeMap<String, usize> =
            targets.iter().enumerate().map(|(k, item)| (level.keys(item, self.graph).remove(0), k)).collect();
        let same = |item: &Item| level.keys(item, self.graph).iter().find_map(|key| known.get(key).copied());
        let same: Vec<Option<&Item>> = sources.iter().map(|item| same(item).map(|k| &targets[k])).collect();
        let mut deeper = Vec::new();
        for k in own {
            let Comment { span, lines } = self.all[k].clone();
            let next = sources.partition_point(|item| item.span.start <= span.start);
            let last = next.checked_sub(1);
            match last.filter(|&last| span.start < sources[last].span.end) {
                Some(around) => {
                    let value = sources[around].value;
                    let target = same[around].filter(|item| items(item.value).is_some());
                    if span.start > value.span.start && items(value).is_some() && target.is_some() {
                        deeper.push(around);
                    } else {
                        self.put_before(&same[around..], written, lines);
                    }
                }
                None if self.is_on_line(&sources, source, next, &span) => {
                    let line = on_one_line(&lines);
                    match last.map(|last| same[last]) {
                        None => append(&mut self.placed.opening, written.span.start, line),
                        Some(Some(item)) => append(&mut self.placed.after, item.span.start, line),
                        // The item is not written.
                        Some(None) => self.put_before(&same[next..], written, lines),
                    }
                }
                None => self.put_before(&same[next..], written, lines),
            }
        }
        deeper.dedup();
        for k in deeper {
            if let Some(item) = same[k] {
                self.place(sources[k].value, item.value, level.of(&sources[k]));
            }
        }
    }

    /// Whether a comment belongs to the line before it: that of the item before `next`, or of the opening bracket. A
    /// comment between a comma and an item on the same line belongs to that item.
    fn is_on_line(&self, sources: &[Item], source: &Node, next: usize, comment: &Range<usize>) -> bool {
        let start = next.checked_sub(1).map_or(source.span.start, |last| sources[last].span.end);
        let before = &self.text[start..comment.start];
        let after = sources.get(next).map(|next| &self.text[comment.end..next.span.start]);
        let leads = after.is_some_and(|after| !after.contains(['\n', ',']));
        !before.contains('\n') && !leads
    }

    /// Puts lines before the first of these items that is written, or before the closing bracket.
    fn put_before(&mut self, items: &[Option<&Item>], container: &Node, lines: Vec<String>) {
        let placed = match items.iter().flatten().next() {
            Some(item) => self.placed.before.entry(item.span.start),
            None => self.placed.closing.entry(container.span.start),
        };
        placed.or_default().extend(lines);
    }
}

fn append(lines: &mut BTreeMap<usize, String>, place: usize, comment: String) {
    let old = lines.remove(&place).map(|old| old + " ").unwrap_or_default();
    lines.insert(place, old + &comment);
}

/// The lines of a block comment as one line comment.
fn on_one_line(lines: &[String]) -> String {
    let words = lines.iter().skip(1).map(|line| line.trim_start_matches("// "));
    lines.iter().take(1).map(String::as_str).chain(words).collect::<Vec<_>>().join(" ")
}

/// A comment as line comments, and its place.
#[derive(Debug, Clone)]
struct Comment {
    span: Range<usize>,
    lines: Vec<String>,
}

/// All comments of a text. Each line of a block comment becomes a line comment.
fn find_comments(text: &str, root: &Node) -> Vec<Comment> {
    let mut quoted = Vec::new();
    find_quoted(root, &mut quoted);
    let mut quoted = quoted.into_iter().peekable();
    let bytes = text.as_bytes();
    let (mut at, mut all) = (0, Vec::new());
    while at < bytes.len() {
        while quoted.next_if(|span| span.end <= at).is_some() {}
        if let Some(span) = quoted.peek().filter(|span| span.start <= at) {
            at = span.end;
            continue;
        }
        match (bytes[at], bytes.get(at + 1)) {
            (b'/', Some(b'/')) => {
                let end = text[at..].find('\n').map_or(text.len(), |length| at + length);
                all.push(Comment { span: at..end, lines: vec![text[at..end].trim_end().to_owned()] });
                at = end;
            }
            (b'/', Some(b'*')) => {
                let end = block_end(bytes, at);
                let inside = text[at + 2..end].strip_suffix("*/").unwrap_or_default();
                let lines = inside.lines().map(str::trim).filter(|line| !line.is_empty());
                all.push(Comment { span: at..end, lines: lines.map(|line| format!("// {line}")).collect() });
                at = end;
            }
            _ => at += 1,
        }
    }
    all.retain(|comment| !comment.lines.is_empty());
    all
}

/// The end of a block comment, which may hold others.
fn block_end(bytes: &[u8], start: usize) -> usize {
    let (mut at, mut depth) = (start, 0);
    while at < bytes.len() {
        match (bytes[at], bytes.get(at + 1)) {
            (b'/', Some(b'*')) => (at, depth) = (at + 2, depth + 1),
            (b'*', Some(b'/')) => (at, depth) = (at + 2, depth - 1),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}

/// The places of texts in quotes, in their order: `//` in them begins no comment.
fn find_quoted(node: &Node, quoted: &mut Vec<Range<usize>>) {
    match &node.value {
        Value::Text(_) => quoted.push(node.span.clone()),
        Value::List(items) | Value::Tuple { items, .. } => {
            items.iter().for_each(|item| find_quoted(item, quoted));
        }
        Value::Map(entries) => entries.iter().for_each(|(key, value)| {
            find_quoted(key, quoted);
            find_quoted(value, quoted);
        }),
        Value::Record { fields, .. } => fields.iter().for_each(|(_, value)| find_quoted(value, quoted)),
        Value::Number(_) | Value::Bool(_) | Value::Word(_) => {}
    }
}
