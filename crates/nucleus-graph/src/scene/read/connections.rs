//! Explicit connections, from output to input: `connections: [("ball.translateY", "cloth1.friction")]`.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::attributes::{Kind, NodeType};
use crate::diagnostic::{Findings, nearest};
use crate::graph::{CLOCK, Graph, NodeId, Plug, PlugError};
use crate::scene::syntax::{Node, Value};

use super::value::{found, text};

/// The explicit connections of a scene, as texts.
#[derive(Default)]
pub(super) struct Connections<'a> {
    pairs: Vec<Pair<'a>>,
}

/// An output and an input, as texts.
struct Pair<'a> {
    span: &'a Range<usize>,
    ends: [(&'a str, &'a Range<usize>); 2],
}

/// Reads the list. Its plugs are resolved later, when all nodes exist.
pub(super) fn read<'a>(node: Option<&'a Node>, findings: &mut Findings) -> Connections<'a> {
    let Some(node) = node else { return Connections::default() };
    let Value::List(items) = &node.value else {
        let message = format!("`connections` takes a list, found {}", found(&node.value));
        findings.error(&node.span, message).help(EXAMPLE);
        return Connections::default();
    };
    Connections { pairs: items.iter().filter_map(|item| read_pair(item, findings)).collect() }
}

const EXAMPLE: &str = "write `connections: [(\"ball.translateY\", \"cloth1.friction\")]`, output first";

fn read_pair<'a>(item: &'a Node, findings: &mut Findings) -> Option<Pair<'a>> {
    let items = match &item.value {
        Value::Tuple { name: None, items } if items.len() == 2 => items,
        other => {
            let message = format!("a connection is a pair of plugs, found {}", found(other));
            findings.error(&item.span, message).help(EXAMPLE);
            return None;
        }
    };
    let ends = [0, 1].map(|k| Some((text("a connection", &items[k], findings)?, &items[k].span)));
    Some(Pair { span: &item.span, ends: [ends[0]?, ends[1]?] })
}

impl Connections<'_> {
    /// The attributes at the output ends, and those at the input ends.
    pub(super) fn ends(&self, graph: &Graph) -> [BTreeSet<(NodeId, &'static str)>; 2] {
        [0, 1].map(|end| {
            let plugs = self.pairs.iter().filter_map(|pair| graph.plug(pair.ends[end].0).ok());
            plugs.map(|plug| (plug.node, plug.attribute.name)).collect()
        })
    }

    /// Removes an implicit connection of the short form from an input that is about to be connected explicitly.
    fn replace_implicit(&self, graph: &mut Graph, to: Plug, explicit: &[Plug]) {
        if !IMPLICIT.contains(&to.attribute.name) || explicit.iter().any(|taken| taken.overlaps(&to)) {
            return;
        }
        let old = graph.arriving(to.node).find(|wire| wire.to == to).copied();
        if let Some(old) = old {
            graph.disconnect(old.from, old.to);
        }
    }

    /// Makes the connections. Plugs of nodes with mistakes are skipped.
    pub(super) fn connect(
        &self,
        graph: &mut Graph,
        is_broken: &dyn Fn(&str) -> bool,
        findings: &mut Findings,
    ) {
        let mut explicit: Vec<Plug> = Vec::new();
        for Pair { span, ends } in &self.pairs {
            let plugs = ends.map(|(text, span)| match graph.plug(text) {
                Ok(plug) => Some(plug),
                Err(PlugError::NoNode { name }) if is_broken(&name) => None,
                Err(error) => {
                    refuse(graph, &error, span, findings);
                    None
                }
            });
            let [Some(from), Some(to)] = plugs else { continue };
            // A connection that the short form implies may be repeated.
            if graph.has_connection(from, to) {
                continue;
            }
            self.replace_implicit(graph, to, &explicit);
            match graph.connect(from, to) {
                Ok(()) => {
                    explicit.push(to);
                    if let Some(lack) = to.attribute.effect.lack_of_connection() {
                        findings.warning(span, format!("`{}` {lack}", graph.describe(to)));
                    }
                }
                Err(error) => {
                    findings.error(span, error.to_string());
                }
            }
        }
    }
}

/// Inputs that the short form connects implicitly.
const IMPLICIT: [&str; 2] = ["currentTime", "startFrame"];

fn refuse(graph: &Graph, error: &PlugError, span: &Range<usize>, findings: &mut Findings) {
    let error_diagnostic = findings.error(span, error.to_string());
    match error {
        PlugError::NoNode { name } => {
            let names = graph.iter().map(|(_, node)| node.name());
            error_diagnostic.did_you_mean(nearest(name, names));
        }
        PlugError::NoAttribute { node_type, attribute, .. } => {
            error_diagnostic.did_you_mean(nearest_attribute(node_type, attribute).as_deref());
        }
        _ => {
            error_diagnostic
                .help(format!("a plug is `node.attribute` or `node.attribute[0]`, like `{CLOCK}.outTime`"));
        }
    }
}

/// The attribute with the nearest name, components of vectors included.
pub(super) fn nearest_attribute(node_type: &'static NodeType, word: &str) -> Option<String> {
    let rows = node_type.attributes();
    let parts: Vec<String> =
        rows.iter().filter_map(|row| row.parts()).flatten().map(|(long, _)| long).collect();
    let long = rows.iter().filter(|row| !matches!(row.kind, Kind::Together(_))).map(|row| row.name);
    nearest(word, long.chain(parts.iter().map(String::as_str))).map(str::to_owned)
}
