//! Constraints and their components.

use nucleus_graph::attributes::{
    Component, ElementKind, Selection, Value, Which, dynamic_constraint, n_component, read_component,
};
use nucleus_graph::graph::{Creation, NodeId as OwnId, Setting};

use crate::omissions::Cause;
use crate::scene::{ANY, NodeId};

use super::importer::Importer;
use super::kept::nucleus_of;
use super::plan::Elements;

/// Maya's numbers of `componentType`.
const POINT: u32 = 2;
const EDGE: u32 = 3;
const FACE: u32 = 4;
const WHOLE: u32 = 6;
/// Maya's numbers of `elements`.
const LISTED: u32 = 0;
const BORDERS: u32 = 1;

/// A component node of a constraint.
pub(super) struct Part {
    node: NodeId,
    index: u32,
    pub(super) object: OwnId,
    name: String,
    kind: u32,
    elements: u32,
    list: Vec<u32>,
    /// Whether the short form of a scene says all of it.
    is_plain: bool,
}

impl Part {
    /// Whether it stands for the borders of its object.
    pub(super) fn is_border(&self) -> bool {
        self.kind == EDGE && self.elements == BORDERS
    }

    /// Whether points can be joined to the nearest place of it.
    pub(super) fn is_surface(&self) -> bool {
        matches!(self.kind, FACE | WHOLE)
    }

    /// The points that it joins one by one.
    pub(super) fn points(&self) -> PointsOfPart {
        match (self.kind, self.elements) {
            (POINT, LISTED) => PointsOfPart::Listed(self.list.len()),
            (POINT | WHOLE, _) => PointsOfPart::All,
            _ => PointsOfPart::None,
        }
    }
}

/// The points of a component.
pub(super) enum PointsOfPart {
    /// A number of them.
    Listed(usize),
    /// Those of its object.
    All,
    /// It has other elements.
    None,
}

/// How a constraint is connected.
enum Form {
    /// By the creation command, from its components.
    Short(Vec<Component>),
    /// By component nodes with values of their own.
    Explicit,
}

impl Importer<'_> {
    /// Connects constraints to their components and to their nuclei.
    ///
    /// Creation commands take the first free name and index. Component nodes are therefore added before them, as a
    /// scene is read, and the other constraints are connected to their nuclei after them.
    pub(super) fn connect_constraints(&mut self, all: &[(NodeId, OwnId)]) {
        let mut forms = Vec::new();
        for &(from, to) in all {
            let Some(nucleus) = nucleus_of(self.scene, from).and_then(|id| self.own_of(id)) else { continue };
            forms.push((to, nucleus, self.form_of(from, to)));
        }
        for (to, nucleus, form) in &forms {
            if let Form::Short(components) = form {
                self.set_components(*to, components);
                let creation = Creation::Constraint { components: components.clone(), nucleus: *nucleus };
                self.create(*to, &creation);
            }
        }
        for (to, nucleus, form) in &forms {
            if let (Form::Explicit, Err(error)) = (form, self.graph.join_constraint(*to, *nucleus)) {
                self.omissions.add(self.graph.node(*to).name(), Cause::Connection(error.to_string()));
            }
        }
    }

    /// How a constraint is connected. Adds its component nodes if no creation command makes them.
    fn form_of(&mut self, from: NodeId, to: OwnId) -> Form {
        let parts = self.parts_of(from);
        if !self.is_own {
            self.set_constraint_type(from, to, &parts);
        }
        let key = |part: &Part| (part.object, part.kind);
        let repeated = (1..parts.len()).any(|k| parts[..k].iter().any(|other| key(other) == key(&parts[k])));
        let listed = self.scene.string(from, &[dynamic_constraint::COMPONENTS.row.name]).is_some();
        let is_short = if self.is_own { listed } else { !repeated && !parts.is_empty() };
        if is_short && parts.iter().all(|part| part.is_plain) {
            return Form::Short(self.listed(from, &parts));
        }
        for part in parts {
            self.add_part(to, &part);
        }
        Form::Explicit
    }

    fn set_components(&mut self, to: OwnId, components: &[Component]) {
        let setting = Setting::Fixed(Value::Components(components.to_vec()));
        self.set(to, &dynamic_constraint::COMPONENTS.row, setting);
    }

    /// The components in the short form: as a Nucleus scene lists them, else runs of points.
    fn listed(&self, from: NodeId, parts: &[Part]) -> Vec<Component> {
        let stored = self.scene.string(from, &[dynamic_constraint::COMPONENTS.row.name]);
        if let Some(text) = stored.filter(|_| self.is_own) {
            return texts(&text).into_iter().filter_map(|text| read_component(text).ok()).collect();
        }
        parts.iter().flat_map(components).collect()
    }

    /// The component nodes of a constraint, in the order of their indices.
    fn parts_of(&mut self, from: NodeId) -> Vec<Part> {
        let scene = self.scene;
        let mut parts = Vec::new();
        for (index, wire) in scene.sources(from, &["cid", "componentIds"]) {
            let node = wire.from.node;
            if scene.kind(node) != "nComponent" {
                self.omissions.add(
                    scene.name(node),
                    Cause::Component(format!("a {} is no component", scene.kind(node))),
                );
                continue;
            }
            let object = scene.source(node, &["obid", "objectId"], None).map(|wire| wire.from.node);
            let Some(own) = object.and_then(|object| self.own_of(object)) else {
                let why = "its object is left out".to_owned();
                self.omissions.add(scene.name(node), Cause::Component(why));
                continue;
            };
            let kind = scene.count_or(node, &["ct", "componentType"], 0);
            let elements = scene.count_or(node, &["el", "elements"], LISTED);
            let list = self.known_elements(node, own, kind);
            let said = [
                "ct",
                "componentType",
                "el",
                "elements",
                "ci",
                "componentIndices",
                "cid",
                "componentGroupId",
                n_component::SELECT.row.name,
            ];
            let says_more = scene.assigned(node, ANY).any(|set| {
                let row = n_component::N_COMPONENT.attribute(set.segment.name);
                !set.values.is_empty() && row.is_some() && !said.contains(&set.segment.name)
            });
            // The list of a Nucleus scene says what its component nodes hold.
            let is_known = match kind {
                POINT | EDGE | FACE => elements != LISTED || !list.is_empty() || self.is_own,
                kind => kind == WHOLE,
            };
            let is_plain = is_known && !says_more;
            let name = self.graph.node(own).name().to_owned();
            parts.push(Part { node, index, object: own, name, kind, elements, list, is_plain });
        }
        parts
    }

    /// The elements that a component lists, by our numbers. Those that the mesh does not have are left from an older one.
    fn known_elements(&mut self, node: NodeId, object: OwnId, kind: u32) -> Vec<u32> {
        let list = self.scene.listed(node, &["ci", "componentIndices"]);
        let (element, name) = match kind {
            POINT => (ElementKind::Point, "points"),
            EDGE => (ElementKind::Edge, "edges"),
            FACE => (ElementKind::Face, "faces"),
            _ => return list,
        };
        let particles = self.points_of(object).map(Elements::of_points);
        let Some(elements) = self.mesh_elements(object).or(particles.as_ref()).filter(|_| !self.is_own)
        else {
            return list;
        };
        let known: Vec<u32> = list.iter().filter_map(|index| elements.number(element, *index)).collect();
        if known.len() < list.len() {
            let why = format!("{} of its {name} are not in the mesh", list.len() - known.len());
            self.omissions.add(self.scene.name(node), Cause::Component(why));
        }
        known
    }

    /// A component node with all its values.
    fn add_part(&mut self, constraint: OwnId, part: &Part) {
        let name = self.kept.free_name(self.scene.name(part.node));
        let Ok(own) = self.graph.add(&name, &n_component::N_COMPONENT) else { return };
        self.set_values(part.node, own, &n_component::N_COMPONENT);
        if part.elements == LISTED {
            let row = &n_component::COMPONENT_INDICES.row;
            self.set(own, row, Setting::Fixed(Value::Ints(part.list.clone())));
        }
        use nucleus_graph::attributes::n_base;
        use nucleus_graph::graph::Plug;
        let id = Plug::new(part.object, &n_base::NUCLEUS_ID);
        self.join(id, Plug::new(own, &n_component::OBJECT_ID));
        let input = Plug::element(constraint, &dynamic_constraint::COMPONENT_IDS, part.index);
        self.join(Plug::new(own, &n_component::OUT_COMPONENT), input);
    }
}

/// The texts of components that are separated by spaces; those inside of brackets belong to an expression.
fn texts(list: &str) -> Vec<&str> {
    let (mut depth, mut texts, mut from) = (0i32, Vec::new(), 0);
    for (at, c) in list.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ' ' if depth == 0 => {
                texts.push(&list[from..at]);
                from = at + 1;
            }
            _ => {}
        }
    }
    texts.push(&list[from..]);
    texts.retain(|text| !text.is_empty());
    texts
}

/// The components of a plain part: the object, all its elements of a kind, those on borders, or runs of them.
fn components(part: &Part) -> Vec<Component> {
    let of = |selection| Component { object: part.name.clone(), selection };
    let kind = match part.kind {
        EDGE => ElementKind::Edge,
        FACE => ElementKind::Face,
        _ => ElementKind::Point,
    };
    match (part.kind, part.elements) {
        (WHOLE, _) => vec![of(Selection::Object)],
        (_, LISTED) => {
            let run = |(first, last)| of(Selection::Elements(kind, Which::Range(first, last)));
            runs(&part.list).into_iter().map(run).collect()
        }
        (_, BORDERS) => vec![of(Selection::Elements(kind, Which::Border))],
        _ => vec![of(Selection::Elements(kind, Which::All))],
    }
}

/// Runs of numbers that follow each other, in the order of the list.
fn runs(list: &[u32]) -> Vec<(u32, u32)> {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for &number in list {
        match runs.last_mut() {
            Some((_, last)) if last.checked_add(1) == Some(number) => *last = number,
            _ => runs.push((number, number)),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_points_becomes_runs() {
        assert_eq!(runs(&[0, 1, 2, 7, 9, 10, 3]), [(0, 2), (7, 7), (9, 10), (3, 3)]);
        assert_eq!(runs(&[u32::MAX, 0]), [(u32::MAX, u32::MAX), (0, 0)]);
    }

    #[test]
    fn a_component_is_read_as_it_is_written() {
        for text in ["cloth", "cloth.vtx[*]", "cloth.vtx[3]", "a:b.vtx[0:8]"] {
            assert_eq!(read_component(text).unwrap().to_string(), text);
        }
        assert!(read_component("cloth.vtx[x]").is_err());
        assert_eq!(texts("a.vtx[where(y > 1)] b"), ["a.vtx[where(y > 1)]", "b"]);
    }
}
