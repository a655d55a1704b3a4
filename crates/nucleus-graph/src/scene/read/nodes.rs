//! `nodes: {"cloth1": nCloth(inputMesh: "sheet", friction: 0.4)}`.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::attributes::{Attribute, Effect, Kind, Value as Held, n_base, time};
use crate::graph::{CLOCK, Channel, Graph, NodeId, Setting};
use crate::memory::NODE;
use crate::scene::diagnostic::Severity;
use crate::scene::findings::Findings;
use crate::scene::nearest;
use crate::scene::preset::preset;
use crate::scene::source::Source;
use crate::scene::syntax::{Node, Value, Word};

use super::component;
use super::drafts::{Draft, drafts};
use super::fields::listed;
use super::links::{self, Links, Reference};
use super::value::{expected, read, read_part, single, text};
use super::wires::Wires;

/// Reads all nodes and connects them. Also returns the nodes on which something could not be read.
pub(super) fn read_nodes(
    node: &Node,
    wires: &Wires,
    source: &mut Source,
    findings: &mut Findings,
) -> (Graph, BTreeSet<NodeId>) {
    let mut graph = Graph::new();
    let mut broken = BTreeSet::new();
    let Value::Map(entries) = &node.value else {
        expected::<()>("`nodes`", "names and nodes, like {\"cloth1\": nCloth()}", node, findings);
        return (graph, broken);
    };
    let claimed = source.budget_mut().claim((entries.len() as u64).saturating_mul(NODE));
    if let Err(refused) = claimed {
        let error = findings.error(&node.span, format!("{} nodes take {refused}", entries.len()));
        error.help(refused.help("take some out"));
        return (graph, broken);
    }
    let (mut drafts, names) = drafts(entries, findings);
    // The order of nodes in a file must not matter to a run.
    drafts.sort_by_key(|draft| draft.name);
    let mut links = Links { names, references: Vec::new() };
    for draft in &drafts {
        let id = match graph.add(draft.name, draft.node_type) {
            Ok(id) => id,
            // The clock is there already.
            Err(_) if draft.name == CLOCK && draft.node_type == &time::TIME => graph.clock(),
            Err(error) => {
                findings.error(draft.span, error.to_string()).help("give it another name");
                continue;
            }
        };
        source.note(draft.name.to_owned(), draft.span);
        links.names.insert(draft.name.to_owned(), Some(id));
        let before = findings.errors();
        NodeReader { graph: &mut graph, id, draft, source, findings, links: &mut links, set: Vec::new() }
            .fields();
        if findings.errors() > before {
            broken.insert(id);
        }
    }
    links.names.entry(CLOCK.to_owned()).or_insert(Some(graph.clock()));
    links::connect(&mut graph, &links, wires, source, findings);
    let is_broken = |name: &str| links.names.get(name).is_some_and(Option::is_none);
    wires.connect(&mut graph, &is_broken, findings);
    (graph, broken)
}

/// Reads a node that is alone. What would join it to others is refused.
pub(super) fn read_lone(draft: &Draft, findings: &mut Findings) -> Graph {
    let mut graph = Graph::new();
    let Ok(id) = graph.add(draft.name, draft.node_type) else { return graph };
    let mut links = Links { names: Default::default(), references: Vec::new() };
    let mut source = Source::default();
    let mut said = Findings::default();
    NodeReader {
        graph: &mut graph,
        id,
        draft,
        source: &mut source,
        findings: &mut said,
        links: &mut links,
        set: Vec::new(),
    }
    .fields();
    // That something has no effect yet is told where the preset is used.
    let errors = said.in_order().into_iter().filter(|said| said.severity == Severity::Error);
    findings.extend(errors.collect());
    for reference in &links.references {
        findings.error(
            &reference.span,
            format!("a preset cannot set `{}`, which names a node", reference.row.name),
        );
    }
    graph
}

/// Reads the attributes of one node.
struct NodeReader<'a, 'b> {
    graph: &'a mut Graph,
    id: NodeId,
    draft: &'a Draft<'b>,
    source: &'a mut Source,
    findings: &'a mut Findings,
    links: &'a mut Links,
    /// What has been set so far: attribute, part of it, place.
    set: Vec<(&'static str, Option<usize>, &'a Range<usize>)>,
}

impl NodeReader<'_, '_> {
    fn fields(&mut self) {
        for (word, node) in self.draft.fields {
            let node_type = self.draft.node_type;
            if let Some(row) = node_type.attribute(&word.text) {
                self.attribute(word, row, node);
            } else if let Some((row, part)) = node_type.part(&word.text) {
                self.part(word, row, part, node);
            } else {
                self.unknown(word);
            }
        }
    }

    fn attribute(&mut self, word: &Word, row: &'static Attribute, node: &Node) {
        if let Kind::Together(parts) = row.kind {
            return self.together(word, row, parts, node);
        }
        if !self.first_time(word, row.name, None) {
            return;
        }
        let label = format!("`{}` of `{}`", row.name, self.draft.name);
        self.source.note(format!("{}.{}", self.draft.name, row.name), &node.span);
        match row.kind {
            Kind::Node(_) => {
                let Some(name) = text(&label, node, self.findings) else { return };
                let (node_id, name, span) = (self.id, name.to_owned(), node.span.clone());
                self.links.references.push(Reference { node: node_id, row, name, span });
            }
            Kind::Components => self.components(&label, row, node),
            Kind::Text if row == &n_base::PRESET.row => self.preset(&label, node),
            _ => {
                if let Some(setting) = read(&label, row, node, self.findings) {
                    self.store(word, row, setting);
                }
            }
        }
    }

    /// One part of a vector: `translateY: 3`.
    fn part(&mut self, word: &Word, row: &'static Attribute, part: usize, node: &Node) {
        if !self.first_time(word, row.name, Some(part)) {
            return;
        }
        let label = format!("`{}` of `{}`", word.text, self.draft.name);
        let Some(channel) = read_part(&label, row, node, self.findings) else { return };
        let mut channels = match (self.graph.node(self.id).settings().get(row.name), &row.default) {
            (Some(Setting::Parts(channels)), _) => channels.clone(),
            (_, Some(Held::Vector(default))) => default.map(Channel::Fixed),
            _ => return,
        };
        channels[part] = channel;
        self.source.note(format!("{}.{}", self.draft.name, row.name), &node.span);
        self.store(word, row, Setting::Parts(channels));
    }

    /// Several attributes in one go: `subdivisions: (64, 64)`.
    fn together(
        &mut self,
        word: &Word,
        row: &'static Attribute,
        parts: &'static [&'static str],
        node: &Node,
    ) {
        let label = format!("`{}` of `{}`", row.name, self.draft.name);
        let items: &[Node] = match &node.value {
            Value::Tuple { name: None, items } | Value::List(items) => items,
            _ => {
                expected::<()>(&label, &format!("{} numbers", parts.len()), node, self.findings);
                return;
            }
        };
        if items.len() != parts.len() {
            let message = format!("{label} takes {} numbers, found {}", parts.len(), items.len());
            self.findings.error(&node.span, message);
            return;
        }
        for (name, item) in parts.iter().zip(items) {
            let Some(row) = self.draft.node_type.attribute(name) else { continue };
            if !self.first_time(word, row.name, None) {
                continue;
            }
            self.source.note(format!("{}.{}", self.draft.name, row.name), &item.span);
            if let Some(value) = single(&label, row, item, self.findings) {
                self.store(word, row, Setting::Fixed(value));
            }
        }
    }

    /// Takes a material.
    fn preset(&mut self, label: &str, node: &Node) {
        let Some(name) = text(label, node, self.findings) else { return };
        if name.is_empty() {
            return;
        }
        let preset = match preset(name, &|file| self.source.path(file)) {
            Ok(preset) => preset,
            Err((message, help)) => {
                self.findings.error(&node.span, message).help(help);
                return;
            }
        };
        let node_type = self.draft.node_type;
        if !node_type.is_a(preset.node_type) {
            let message = format!(
                "the preset `{name}` is for {}, but `{}` is of type {}",
                preset.node_type.name, self.draft.name, node_type.name
            );
            self.findings.error(&node.span, message);
            return;
        }
        let set = self.graph.apply_preset(self.id, &preset.settings);
        let set = set.and_then(|()| {
            self.graph.set(self.id, &n_base::PRESET.row, Setting::Fixed(Held::Text(name.to_owned())))
        });
        if let Err(error) = set {
            self.findings.error(&node.span, error.to_string());
        }
        let idle = preset.settings.iter().filter(|(row, _)| !matches!(row.effect, Effect::Solved(_)));
        let idle: Vec<&str> = idle.map(|(row, _)| row.name).collect();
        if !idle.is_empty() {
            let message = format!("the preset `{name}` sets {} too, without effect yet", listed(&idle));
            self.findings.warning(&node.span, message);
        }
    }

    fn components(&mut self, label: &str, row: &'static Attribute, node: &Node) {
        let Value::List(items) = &node.value else {
            let example = format!("a list, like [\"{}\"]", "cloth1.vtx[0]");
            expected::<()>(label, &example, node, self.findings);
            return;
        };
        let mut components = Vec::with_capacity(items.len());
        for item in items {
            let Some(text) = text(label, item, self.findings) else { continue };
            match component::read(text) {
                Ok(component) => {
                    let place = format!("{}.{}[{}]", self.draft.name, row.name, components.len());
                    self.source.note(place, &item.span);
                    components.push(component);
                }
                Err(message) => {
                    let error = self.findings.error(&item.span, message);
                    error.help("write `cloth1.vtx[3]`, `cloth1.vtx[0:8]` or `cloth1.vtx[*]`");
                }
            }
        }
        let setting = Setting::Fixed(Held::Components(components));
        if let Err(error) = self.graph.set(self.id, row, setting) {
            self.findings.error(&node.span, error.to_string());
        }
    }

    /// Keeps what has been read, and says so if it does nothing.
    fn store(&mut self, word: &Word, row: &'static Attribute, setting: Setting) {
        if let Err(error) = self.graph.set(self.id, row, setting) {
            self.findings.error(&word.span, error.to_string());
        }
        let lacks = match row.effect {
            Effect::Solved(_) if self.draft.node_type.has_no_use_for(row) => "has no effect on such a node",
            Effect::Solved(_) => return,
            Effect::NotYet => "has no effect yet",
            Effect::Never => "has no effect: nothing uses it, in Maya neither",
        };
        self.findings.warning(&word.span, format!("`{}` of `{}` {lacks}", row.name, self.draft.name));
    }

    /// Notes that something is set; whether it is the first time.
    fn first_time(&mut self, word: &Word, name: &'static str, part: Option<usize>) -> bool {
        let again = |(set, set_part, _): &&(&str, Option<usize>, _)| {
            *set == name && (part.is_none() || set_part.is_none() || *set_part == part)
        };
        if let Some((.., first)) = self.set.iter().find(again) {
            let message = format!("`{}` of `{}` is set twice", name, self.draft.name);
            self.findings.error(&word.span, message).note_at(first, "here for the first time");
            return false;
        }
        let place = self.draft.fields.iter().find(|(field, _)| field.span == word.span);
        if let Some((field, _)) = place {
            self.set.push((name, part, &field.span));
        }
        true
    }

    fn unknown(&mut self, word: &Word) {
        let Draft { name, node_type, .. } = self.draft;
        let rows = node_type.attributes();
        let parts: Vec<String> =
            rows.iter().filter_map(|row| row.parts()).flatten().map(|(long, _)| long).collect();
        let settable = rows.iter().filter(|row| !matches!(row.kind, Kind::Plug(_))).map(|row| row.name);
        let near = nearest(&word.text, settable.chain(parts.iter().map(String::as_str)));
        let message =
            format!("`{name}` is of type {}, which has no attribute `{}`", node_type.name, word.text);
        self.findings.error(&word.span, message).did_you_mean(near);
    }
}
