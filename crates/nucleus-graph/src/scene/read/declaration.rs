//! Declarations of nodes: a name, a type, and fields that are not read yet.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::attributes::{NodeType, node_type, node_types};
use crate::diagnostic::{Findings, nearest};
use crate::graph::{NodeId, is_a_name};
use crate::scene::syntax::{Node, Value, Word};

use super::value::{found, text};

/// A node as declared in the file.
pub(super) struct Declaration<'a> {
    pub(super) name: &'a str,
    pub(super) span: &'a Range<usize>,
    pub(super) node_type: &'static NodeType,
    pub(super) fields: &'a [(Word, Node)],
}

/// The declarations that have a valid name and type. Also the names of all declared nodes, without ids.
pub(super) fn read_declarations<'a>(
    entries: &'a [(Node, Node)],
    findings: &mut Findings,
) -> (Vec<Declaration<'a>>, BTreeMap<String, Option<NodeId>>) {
    let mut seen: BTreeMap<&str, &Range<usize>> = BTreeMap::new();
    let mut declarations = Vec::new();
    let mut names = BTreeMap::new();
    for (key, body) in entries {
        let Some(name) = text("the name of a node", key, findings) else { continue };
        names.insert(name.to_owned(), None);
        if let Some(first) = seen.insert(name, &key.span) {
            let error = findings.error(&key.span, format!("there are two nodes `{name}`"));
            error.note_at(first, "the other one is here").help("give one of them another name");
            continue;
        }
        if !is_a_name(name) {
            let error = findings.error(&key.span, format!("`{name}` is not a name"));
            error.help("names are made of letters, digits, `_`, `-` and `:`");
            continue;
        }
        let Some((node_type, fields)) = typed(name, body, findings) else { continue };
        declarations.push(Declaration { name, span: &key.span, node_type, fields });
    }
    (declarations, names)
}

/// The only declaration of a preset file, which has no name.
pub(super) fn unnamed<'a>(root: &'a Node, findings: &mut Findings) -> Option<Declaration<'a>> {
    let (node_type, fields) = typed("preset", root, findings)?;
    Some(Declaration { name: "preset", span: &root.span, node_type, fields })
}

fn typed<'a>(
    name: &str,
    body: &'a Node,
    findings: &mut Findings,
) -> Option<(&'static NodeType, &'a [(Word, Node)])> {
    let (word, span, fields): (&str, _, &[_]) = match &body.value {
        Value::Record { name: Some(word), fields } => (&word.text, &word.span, fields),
        Value::Tuple { name: Some(word), .. } => {
            let error = findings.error(&body.span, format!("the attributes of `{name}` need names"));
            error.help(format!("write `{}(attribute: value)`", word.text));
            return None;
        }
        Value::Word(word) => {
            let error = findings.error(&body.span, format!("`{name}` needs brackets after its type"));
            error.help(format!("write `{word}()`"));
            return None;
        }
        other => {
            let error =
                findings.error(&body.span, format!("`{name}` needs a type of node, found {}", found(other)));
            error.help(format!("write `\"{name}\": nCloth(...)`"));
            return None;
        }
    };
    let node_type = node_type(word);
    if node_type.is_none() {
        let near = nearest(word, node_types().iter().map(|node_type| node_type.name));
        findings.error(span, format!("there is no type of node `{word}`")).did_you_mean(near);
    }
    Some((node_type?, fields))
}
