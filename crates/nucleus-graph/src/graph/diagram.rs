//! Pictures of a graph: DOT for Graphviz, Mermaid for pages.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::node::{Node, NodeId};
use super::nodes::Graph;
use super::plug::Plug;

impl Graph {
    /// The graph in Graphviz' language: nodes with their types, connections with their plugs, and dashed lines
    /// from parents to children.
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

    /// The graph in Mermaid's language.
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

    /// All connections between the same two nodes together, by the names of those.
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

    /// Parents and their children, by name.
    fn families(&self) -> Vec<(&str, &str)> {
        let pair = |node: &'_ Node| node.parent().map(|parent| self.node(parent).name());
        let mut families: Vec<(&str, &str)> =
            self.iter().filter_map(|(_, node)| Some((pair(node)?, node.name()))).collect();
        families.sort_unstable();
        families
    }
}
