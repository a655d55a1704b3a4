//! A graph as text: plugs as Maya writes them (`nucleus1.inputActive[0]`, `ball.translateY`, `cloth1.stch`), DOT
//! for Graphviz, and Mermaid.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::attributes::NodeType;

use super::node::{Node, NodeId, Plug};
use super::nodes::Graph;

/// Reasons why a text names no plug of a graph.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlugError {
    /// The text has not the form `node.attribute` or `node.attribute[3]`.
    #[error("`{text}` is not a plug")]
    Form {
        /// The text.
        text: String,
    },
    /// No node has this name.
    #[error("there is no node `{name}`")]
    NoNode {
        /// The name.
        name: String,
    },
    /// The node has no such attribute.
    #[error("`{node}` is of type {}, which has no attribute `{attribute}`", node_type.name)]
    NoAttribute {
        /// The node.
        node: String,
        /// The type of the node.
        node_type: &'static NodeType,
        /// The name.
        attribute: String,
    },
}

impl Graph {
    /// The plug that a text names, by long or short attribute name.
    ///
    /// # Errors
    /// When the text has another form, or its node or attribute does not exist.
    pub fn plug(&self, text: &str) -> Result<Plug, PlugError> {
        let form = || PlugError::Form { text: text.to_owned() };
        let (name, rest) = text.split_once('.').ok_or_else(form)?;
        let (attribute, index) = match rest.split_once('[') {
            None => (rest, None),
            Some((attribute, index)) => (attribute, Some(index.strip_suffix(']').ok_or_else(form)?)),
        };
        let plain = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit());
        let index = match index {
            None => None,
            Some(digits) if plain(digits) => Some(digits.parse::<u32>().map_err(|_| form())?),
            Some(_) => return Err(form()),
        };
        if name.is_empty() || attribute.is_empty() {
            return Err(form());
        }
        let node = self.find(name).ok_or_else(|| PlugError::NoNode { name: name.to_owned() })?;
        let node_type = self.node(node).node_type();
        if let Some(row) = node_type.attribute(attribute) {
            return Ok(Plug { node, attribute: row, index, part: None });
        }
        match node_type.part(attribute) {
            Some((row, part)) => Ok(Plug { node, attribute: row, index, part: Some(part) }),
            None => {
                let (node, attribute) = (name.to_owned(), attribute.to_owned());
                Err(PlugError::NoAttribute { node, node_type, attribute })
            }
        }
    }

    /// The text of a plug, by long attribute name: `nucleus1.inputActive[0]`.
    pub fn describe(&self, plug: Plug) -> String {
        let name = self.node(plug.node).name();
        let parts = plug.attribute.parts();
        let part = plug.part.and_then(|part| parts.map(|parts| parts[part].0.clone()));
        let attribute = part.unwrap_or_else(|| plug.attribute.name.to_owned());
        let index = plug.index.map(|index| format!("[{index}]")).unwrap_or_default();
        format!("{name}.{attribute}{index}")
    }
}

impl Graph {
    /// The graph in DOT, the language of Graphviz: nodes with their types, connections with their plugs, and
    /// dashed lines from parents to children.
    pub fn dot(&self) -> String {
        let mut text = String::from("digraph scene {\n    rankdir=LR;\n    node [shape=box];\n");
        for (_, node) in self.by_name() {
            let _ = writeln!(
                text,
                "    {0:?} [label=\"{1}\\n{2}\"];",
                node.name(),
                node.name(),
                node.node_type().name
            );
        }
        for ([from, to], plugs) in self.bundles() {
            let label = plugs.join("\\n");
            let _ = writeln!(text, "    {from:?} -> {to:?} [label=\"{label}\"];");
        }
        for (parent, child) in self.families() {
            let _ = writeln!(text, "    {parent:?} -> {child:?} [style=dashed, arrowhead=none];");
        }
        text + "}\n"
    }

    /// The same in the language of Mermaid.
    pub fn mermaid(&self) -> String {
        let mut text = String::from("flowchart LR\n");
        let places: BTreeMap<&str, usize> =
            self.by_name().into_iter().enumerate().map(|(k, (_, node))| (node.name(), k)).collect();
        for (_, node) in self.by_name() {
            let (name, node_type) = (node.name(), node.node_type().name);
            let _ = writeln!(text, "    n{}[\"{name}<br/>{node_type}\"]", places[name]);
        }
        for ([from, to], plugs) in self.bundles() {
            let (from, to) = (places[from.as_str()], places[to.as_str()]);
            let _ = writeln!(text, "    n{from} -- \"{}\" --> n{to}", plugs.join("<br/>"));
        }
        for (parent, child) in self.families() {
            let _ = writeln!(text, "    n{} -.- n{}", places[parent], places[child]);
        }
        text
    }

    fn by_name(&self) -> Vec<(NodeId, &Node)> {
        let mut nodes: Vec<_> = self.iter().collect();
        nodes.sort_by_key(|(_, node)| node.name());
        nodes
    }

    /// Connections grouped by the names of the two nodes that they join.
    fn bundles(&self) -> BTreeMap<[String; 2], Vec<String>> {
        let mut bundles: BTreeMap<[String; 2], Vec<String>> = BTreeMap::new();
        let name = |plug: Plug| self.node(plug.node).name().to_owned();
        let plug = |plug: Plug| {
            let whole = self.describe(plug);
            whole.split_once('.').map_or(String::new(), |(_, plug)| plug.to_owned())
        };
        for wire in self.connections() {
            let line = format!("{} → {}", plug(wire.from), plug(wire.to));
            bundles.entry([name(wire.from), name(wire.to)]).or_default().push(line);
        }
        bundles.values_mut().for_each(|lines| lines.sort());
        bundles
    }

    /// Names of all parents, each with a child.
    fn families(&self) -> Vec<(&str, &str)> {
        let pair = |node: &'_ Node| node.parent().map(|parent| self.node(parent).name());
        let mut families: Vec<(&str, &str)> =
            self.iter().filter_map(|(_, node)| Some((pair(node)?, node.name()))).collect();
        families.sort_unstable();
        families
    }
}
