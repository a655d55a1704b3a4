//! `nodes: {"cloth1": nCloth(inputMesh: "sheet", friction: 0.4)}`.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use crate::attributes::{
    Attribute, Effect, Kind, Value as AttrValue, dyn_base, n_base, point_emitter, read_component, time,
};
use crate::diagnostic::{Findings, Severity, listed, nearest};
use crate::graph::{CLOCK, Channel, Graph, NodeId, Setting};
use crate::memory::NODE;
use crate::scene::document::Source;
use crate::scene::preset::Preset;
use crate::scene::syntax::{Node, Value, Word};

use super::connections::Connections;
use super::creation;
use super::declaration::{Declaration, read_declarations};
use super::references::{Reference, References};
use super::setting::{read, read_part};
use super::value::{expected, single, text};

/// Finds a preset by its name or file; names of files are relative to the folder of the file that is read. The error is
/// a message and a help.
type FindPreset<'a> = &'a dyn Fn(&str, &Source) -> Result<Preset, (String, String)>;

/// Reads all nodes and connects them. Also returns the nodes with mistakes.
pub(super) fn read_nodes(
    node: &Node,
    connections: &Connections,
    source: &mut Source,
    presets: FindPreset,
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
    let (mut declarations, names) = read_declarations(entries, findings);
    // A run must not depend on the order of nodes in the file.
    declarations.sort_by_key(|declaration| declaration.name);
    let mut references = References { names, all: Vec::new() };
    for declaration in &declarations {
        let id = match graph.add(declaration.name, declaration.node_type) {
            Ok(id) => id,
            // Every graph has the clock.
            Err(_) if declaration.name == CLOCK && declaration.node_type == &time::TIME => graph.clock(),
            Err(error) => {
                findings.error(declaration.span, error.to_string()).help("give it another name");
                continue;
            }
        };
        source.note(declaration.name.to_owned(), declaration.span);
        references.names.insert(declaration.name.to_owned(), Some(id));
        let before = findings.errors();
        NodeReader {
            graph: &mut graph,
            id,
            declaration,
            source,
            presets,
            findings,
            references: &mut references,
            set: Vec::new(),
        }
        .fields();
        if findings.errors() > before {
            broken.insert(id);
        }
    }
    references.names.entry(CLOCK.to_owned()).or_insert(Some(graph.clock()));
    broken.extend(creation::connect(&mut graph, &references, connections, source, findings));
    let is_broken = |name: &str| references.names.get(name).is_some_and(Option::is_none);
    connections.connect(&mut graph, &is_broken, findings);
    (graph, broken)
}

/// Reads the node of a preset in a file. References to other nodes are refused.
pub(super) fn read_lone(
    declaration: &Declaration,
    file: &Path,
    presets: FindPreset,
    findings: &mut Findings,
) -> Graph {
    let mut graph = Graph::new();
    let Ok(id) = graph.add(declaration.name, declaration.node_type) else { return graph };
    let mut references = References { names: Default::default(), all: Vec::new() };
    let mut source = Source::new(file);
    let mut reported = Findings::default();
    NodeReader {
        graph: &mut graph,
        id,
        declaration,
        source: &mut source,
        presets,
        findings: &mut reported,
        references: &mut references,
        set: Vec::new(),
    }
    .fields();
    // Warnings of settings without effect are given where the preset is used.
    let errors = reported.in_order().into_iter().filter(|reported| reported.severity == Severity::Error);
    findings.extend(errors.collect());
    for reference in &references.all {
        findings.error(
            &reference.span,
            format!("a preset cannot set `{}`, which names a node", reference.row.name),
        );
    }
    graph
}

/// Reads the fields of one node.
struct NodeReader<'a, 'b> {
    graph: &'a mut Graph,
    id: NodeId,
    declaration: &'a Declaration<'b>,
    source: &'a mut Source,
    presets: FindPreset<'a>,
    findings: &'a mut Findings,
    references: &'a mut References,
    /// The settings so far: attribute, component of a vector, place.
    set: Vec<(&'static str, Option<usize>, &'a Range<usize>)>,
}

impl NodeReader<'_, '_> {
    fn fields(&mut self) {
        for (word, node) in self.declaration.fields {
            let node_type = self.declaration.node_type;
            if let Some(row) = node_type.attribute(&word.text) {
                self.attribute(word, row, node);
            } else if let Some((row, part)) = node_type.part(&word.text) {
                self.part(word, row, part, node);
            } else {
                self.unknown(word);
            }
        }
    }

    /// Refuses several names where an attribute takes one. A field reaches more objects by connections.
    fn list_of_names(&mut self, label: &str, row: &'static Attribute, node: &Node) {
        let own = self.declaration.name;
        let error = self.findings.error(&node.span, format!("{label} takes one name, found a list"));
        if row == &dyn_base::TARGET.row {
            let wire = format!("(\"{own}.outputForce[1]\", \"cloth2.inputForce[0]\")");
            error.help(format!(
                "name the first here, and connect a field to each of the others: `connections: [{wire}]`"
            ));
        }
    }

    /// Refuses a value of what can only be connected; its name may be close to that of an attribute with values.
    fn plug(&mut self, label: &str, word: &Word, node: &Node) {
        let node_type = self.declaration.node_type;
        let takes_values = |row: &&&Attribute| {
            matches!(row.effect, Effect::Solved(_))
                && !matches!(row.kind, Kind::Plug(_))
                && !node_type.has_no_use_for(row)
        };
        let names: Vec<&str> =
            node_type.attributes().iter().filter(takes_values).map(|row| row.name).collect();
        let error = self.findings.error(&node.span, format!("{label} can be connected, but not set"));
        if let Some(name) = nearest(&word.text, names) {
            error.did_you_mean(Some(name));
        }
    }

    fn attribute(&mut self, word: &Word, row: &'static Attribute, node: &Node) {
        if let Kind::Together(parts) = row.kind {
            return self.together(word, row, parts, node);
        }
        if !self.is_first_setting(word, row.name, None) {
            return;
        }
        let label = format!("`{}` of `{}`", row.name, self.declaration.name);
        self.source.note(format!("{}.{}", self.declaration.name, row.name), &node.span);
        match row.kind {
            Kind::Node(_) if matches!(node.value, Value::List(_)) => self.list_of_names(&label, row, node),
            Kind::Node(_) => {
                let Some(name) = text(&label, node, self.findings) else { return };
                let (node_id, name, span) = (self.id, name.to_owned(), node.span.clone());
                self.references.all.push(Reference { node: node_id, row, name, span });
            }
            Kind::Components => self.components(&label, row, node),
            Kind::Plug(_) => self.plug(&label, word, node),
            Kind::Text if row == &n_base::PRESET.row => self.preset(&label, node),
            _ => {
                if let Some(setting) = read(&label, row, node, self.findings) {
                    self.store(word, row, setting);
                }
            }
        }
    }

    /// One component of a vector: `translateY: 3`.
    fn part(&mut self, word: &Word, row: &'static Attribute, part: usize, node: &Node) {
        if !self.is_first_setting(word, row.name, Some(part)) {
            return;
        }
        let label = format!("`{}` of `{}`", word.text, self.declaration.name);
        let Some(channel) = read_part(&label, row, node, self.findings) else { return };
        let mut channels = match (self.graph.node(self.id).settings().get(row.name), &row.default) {
            (Some(Setting::Parts(channels)), _) => channels.clone(),
            (_, Some(AttrValue::Vector(default))) => default.map(Channel::Fixed),
            _ => return,
        };
        channels[part] = channel;
        self.source.note(format!("{}.{}", self.declaration.name, row.name), &node.span);
        self.store(word, row, Setting::Parts(channels));
    }

    /// Several attributes by one name: `subdivisions: (64, 64)`.
    fn together(
        &mut self,
        word: &Word,
        row: &'static Attribute,
        parts: &'static [&'static str],
        node: &Node,
    ) {
        let label = format!("`{}` of `{}`", row.name, self.declaration.name);
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
            let Some(row) = self.declaration.node_type.attribute(name) else { continue };
            if !self.is_first_setting(word, row.name, None) {
                continue;
            }
            self.source.note(format!("{}.{}", self.declaration.name, row.name), &item.span);
            if let Some(value) = single(&label, row, item, self.findings) {
                self.store(word, row, Setting::Fixed(value));
            }
        }
    }

    /// Applies a preset.
    fn preset(&mut self, label: &str, node: &Node) {
        let Some(name) = text(label, node, self.findings) else { return };
        if name.is_empty() {
            return;
        }
        let preset = match (self.presets)(name, self.source) {
            Ok(preset) => preset,
            Err((message, help)) => {
                self.findings.error(&node.span, message).help(help);
                return;
            }
        };
        let node_type = self.declaration.node_type;
        if !node_type.is_a(preset.node_type) {
            let message = format!(
                "the preset `{name}` is for {}, but `{}` is of type {}",
                preset.node_type.name, self.declaration.name, node_type.name
            );
            self.findings.error(&node.span, message);
            return;
        }
        let set = self.graph.apply_preset(self.id, &preset.settings);
        let set = set.and_then(|()| {
            self.graph.set(self.id, &n_base::PRESET.row, Setting::Fixed(AttrValue::Text(name.to_owned())))
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
            match read_component(text) {
                Ok(component) => {
                    let place = format!("{}.{}[{}]", self.declaration.name, row.name, components.len());
                    self.source.note(place, &item.span);
                    components.push(component);
                }
                Err(message) => {
                    let error = self.findings.error(&item.span, message);
                    error.help("write `cloth1.vtx[3]`, `cloth1.vtx[0:8]` or `cloth1.vtx[*]`");
                }
            }
        }
        let setting = Setting::Fixed(AttrValue::Components(components));
        if let Err(error) = self.graph.set(self.id, row, setting) {
            self.findings.error(&node.span, error.to_string());
        }
    }

    /// Stores a setting, and warns if it has no effect.
    fn store(&mut self, word: &Word, row: &'static Attribute, setting: Setting) {
        if let Err(error) = self.graph.set(self.id, row, setting) {
            self.findings.error(&word.span, error.to_string());
        }
        let lacks = match row.effect.lack() {
            Some(lack) => lack,
            None if self.declaration.node_type.has_no_use_for(row) => {
                "has no effect on such a node".to_owned()
            }
            None => return,
        };
        self.findings.warning(&word.span, format!("`{}` of `{}` {lacks}", row.name, self.declaration.name));
    }

    /// Records that an attribute is set. Refuses the second time.
    fn is_first_setting(&mut self, word: &Word, name: &'static str, part: Option<usize>) -> bool {
        let again = |(set, set_part, _): &&(&str, Option<usize>, _)| {
            *set == name && (part.is_none() || set_part.is_none() || *set_part == part)
        };
        if let Some((.., first)) = self.set.iter().find(again) {
            let message = format!("`{}` of `{}` is set twice", name, self.declaration.name);
            self.findings.error(&word.span, message).note_at(first, "here for the first time");
            return false;
        }
        let place = self.declaration.fields.iter().find(|(field, _)| field.span == word.span);
        if let Some((field, _)) = place {
            self.set.push((name, part, &field.span));
        }
        true
    }

    fn unknown(&mut self, word: &Word) {
        let Declaration { name, node_type, .. } = self.declaration;
        let rows = node_type.attributes();
        let parts: Vec<String> =
            rows.iter().filter_map(|row| row.parts()).flatten().map(|(long, _)| long).collect();
        let settable = rows.iter().filter(|row| !matches!(row.kind, Kind::Plug(_))).map(|row| row.name);
        let near = nearest(&word.text, settable.chain(parts.iter().map(String::as_str)));
        let message =
            format!("`{name}` is of type {}, which has no attribute `{}`", node_type.name, word.text);
        let error = self.findings.error(&word.span, message);
        if word.text == n_base::INPUT_MESH.row.name && node_type.is_a(&point_emitter::POINT_EMITTER) {
            error.help(
                "a surface emitter names its mesh as its parent: `emitterType: surface, parent: \"plane\"`",
            );
        } else {
            error.did_you_mean(near);
        }
    }
}
