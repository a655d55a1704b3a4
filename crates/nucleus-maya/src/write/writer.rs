//! The state of writing a scene: its text so far, names of nodes, plugs, and quoted text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use nucleus_graph::attributes::{Attribute, camera, dynamic_constraint, particle, surface_shape, transform};
use nucleus_graph::graph::{Graph, NodeId, Plug};
use nucleus_graph::scene::{Scene, write_scene};

use crate::nucleus_nodes::OWN_FILE;
use crate::omissions::Omissions;
use crate::scene::Units;

/// The state of writing a scene.
pub(super) struct Writer<'s> {
    pub(super) scene: &'s Scene,
    /// Nodes and their values.
    pub(super) text: String,
    /// Connections, which follow all nodes.
    pub(super) tail: String,
    /// The names of the transform and of the shape of each node; equal for nodes that are only one.
    pub(super) names: BTreeMap<NodeId, [String; 2]>,
    pub(super) taken: BTreeSet<String>,
    pub(super) omissions: Omissions,
}

impl<'s> Writer<'s> {
    pub(super) fn new(scene: &'s Scene) -> Self {
        let (text, tail) = (String::new(), String::new());
        let mut writer = Self {
            scene,
            text,
            tail,
            names: BTreeMap::new(),
            taken: BTreeSet::new(),
            omissions: Omissions::default(),
        };
        let mut nodes: Vec<(NodeId, &str)> = scene.graph.iter().map(|(id, node)| (id, node.name())).collect();
        nodes.sort_by_key(|(_, name)| *name);
        // Transforms first: an artist's names go before those of shapes.
        let outer: Vec<(NodeId, String)> =
            nodes.iter().map(|(id, name)| (*id, writer.free_name(name))).collect();
        for (id, outer) in outer {
            let shape =
                if writer.has_shape(id) { writer.free_name(&format!("{outer}Shape")) } else { outer.clone() };
            writer.names.insert(id, [outer, shape]);
        }
        writer
    }

    pub(super) fn graph(&self) -> &'s Graph {
        &self.scene.graph
    }

    /// Whether a node has a shape under a transform in Maya.
    pub(super) fn has_shape(&self, id: NodeId) -> bool {
        let node_type = self.graph().node(id).node_type();
        let shapes = [
            &surface_shape::SURFACE_SHAPE,
            &particle::PARTICLE,
            &dynamic_constraint::DYNAMIC_CONSTRAINT,
            &camera::CAMERA,
        ];
        shapes.iter().any(|shape| node_type.is_a(shape))
    }

    /// A name that Maya allows, and that is not taken.
    pub(super) fn free_name(&mut self, wanted: &str) -> String {
        let plain: String = wanted.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let plain = if plain.starts_with(|c: char| c.is_ascii_digit()) { format!("_{plain}") } else { plain };
        let mut name = plain.clone();
        let mut number = 1;
        while !self.taken.insert(name.clone()) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        name
    }

    pub(super) fn head(&mut self, name: &str) {
        let fps = Units::time_name(self.scene.time.fps);
        let empty = Scene { graph: Graph::new(), ..self.scene.clone() };
        let head = quoted(&write_scene(&empty));
        let _ = write!(
            self.text,
            "//Maya ASCII 2018 scene\n//Name: {name}.ma\n//Codeset: UTF-8\nrequires maya \"2018\";\n\
             currentUnit -l centimeter -a degree -t {fps};\nfileInfo \"application\" \"nucleus\";\n\
             fileInfo \"{OWN_FILE}\" {head};\n"
        );
    }

    pub(super) fn playback(&mut self) {
        let (start, end) = (self.scene.time.start, self.scene.time.end);
        let _ = write!(
            self.text,
            "createNode script -n \"sceneConfigurationScriptNode\";\n\tsetAttr \".b\" -type \"string\" \
             \"playbackOptions -min {start} -max {end} -ast {start} -aet {end} \";\n\tsetAttr \".st\" 6;\n"
        );
    }

    /// All connections, in the order of the nodes that they arrive at.
    pub(super) fn connections(&mut self) {
        let mut lines: Vec<String> = self
            .graph()
            .connections()
            .map(|wire| format!("connectAttr \"{}\" \"{}\";\n", self.plug(wire.from), self.plug(wire.to)))
            .collect();
        lines.sort();
        self.tail.extend(lines);
    }

    /// A plug with short names, on the transform or the shape that has it in Maya.
    pub(super) fn plug(&self, plug: Plug) -> String {
        if plug.node == self.graph().clock() {
            return ":time1.o".to_owned();
        }
        let row = plug.attribute;
        let node = &self.names[&plug.node][usize::from(!is_of_transform(row))];
        let part = plug.part.and_then(|part| row.parts().map(|parts| parts[part].1));
        let name = part.unwrap_or(if row.extension { row.name } else { row.short });
        let index = plug.index.map(|index| format!("[{index}]")).unwrap_or_default();
        format!("{node}.{name}{index}")
    }
}

/// Whether an attribute is one of a transform.
pub(super) fn is_of_transform(row: &Attribute) -> bool {
    let rows = [
        &transform::TRANSLATE.row,
        &transform::ROTATE.row,
        &transform::SCALE.row,
        &transform::ROTATE_ORDER.row,
        &transform::VISIBILITY.row,
    ];
    rows.contains(&row)
}

/// A text in quotes, with escapes.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            '\r' => quoted.push_str("\\r"),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
