//! A scene of ours as Maya ASCII, wired as Maya's creation commands do.
//!
//! | You want to know...                                     | Read           |
//! |---------------------------------------------------------|----------------|
//! | the order of the file                                   | [`maya_ascii`] |
//! | a node of ours as a transform and a shape               | `nodes.rs`     |
//! | settings and curves as `setAttr` and `animCurve`        | `values.rs`    |
//! | values that Maya computes when it makes an object       | `creation.rs`  |
//! | embedded meshes                                         | `meshes.rs`    |
//!
//! What Maya has no attribute for is an added attribute, which Maya keeps: a scene that is written and imported again is
//! the same scene.

mod creation;
mod meshes;
mod nodes;
mod values;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use nucleus_graph::graph::{Graph, NodeId, Plug};
use nucleus_graph::scene::{Scene, write_scene};

use crate::nucleus_nodes::OWN_FILE;
use crate::omissions::Omissions;
use crate::scene::Units;

/// A scene as the text of a `.ma` file, and what Maya will not know.
///
/// # Errors
/// When a mesh that the scene names cannot be read.
pub fn maya_ascii(scene: &Scene, name: &str) -> Result<(String, Omissions), String> {
    let mut writer = Writer::new(scene);
    writer.head(name);
    for id in by_depth(&scene.graph) {
        writer.node(id)?;
    }
    writer.playback();
    writer.connections();
    let Writer { text, tail, omissions, .. } = writer;
    Ok((format!("{text}{tail}// End of {name}.ma\n"), omissions))
}

/// The state of writing a scene.
struct Writer<'s> {
    scene: &'s Scene,
    /// Nodes and their values.
    text: String,
    /// Connections, which follow all nodes.
    tail: String,
    /// The names of the transform and of the shape of each node; equal for nodes that are only one.
    names: BTreeMap<NodeId, [String; 2]>,
    taken: BTreeSet<String>,
    omissions: Omissions,
}

impl<'s> Writer<'s> {
    fn new(scene: &'s Scene) -> Self {
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

    fn graph(&self) -> &'s Graph {
        &self.scene.graph
    }

    /// A name that Maya allows, and that is not taken.
    fn free_name(&mut self, wanted: &str) -> String {
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

    fn head(&mut self, name: &str) {
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

    fn playback(&mut self) {
        let (start, end) = (self.scene.time.start, self.scene.time.end);
        let _ = write!(
            self.text,
            "createNode script -n \"sceneConfigurationScriptNode\";\n\tsetAttr \".b\" -type \"string\" \
             \"playbackOptions -min {start} -max {end} -ast {start} -aet {end} \";\n\tsetAttr \".st\" 6;\n"
        );
    }

    /// All connections, in the order of the nodes that they arrive at.
    fn connections(&mut self) {
        let mut lines: Vec<String> = self
            .graph()
            .connections()
            .map(|wire| format!("connectAttr \"{}\" \"{}\";\n", self.plug(wire.from), self.plug(wire.to)))
            .collect();
        lines.sort();
        self.tail.extend(lines);
    }

    /// A plug with short names, on the transform or the shape that has it in Maya.
    fn plug(&self, plug: Plug) -> String {
        if plug.node == self.graph().clock() {
            return ":time1.o".to_owned();
        }
        let row = plug.attribute;
        let node = &self.names[&plug.node][usize::from(!nodes::is_of_transform(row))];
        let part = plug.part.and_then(|part| row.parts().map(|parts| parts[part].1));
        let name = part.unwrap_or(if row.extension { row.name } else { row.short });
        let index = plug.index.map(|index| format!("[{index}]")).unwrap_or_default();
        format!("{node}.{name}{index}")
    }
}

/// All nodes but the clock, parents before their children, by name.
fn by_depth(graph: &Graph) -> Vec<NodeId> {
    let depth = |id: NodeId| {
        let mut depth = 0;
        let mut at = graph.node(id).parent();
        while let Some(parent) = at {
            depth += 1;
            at = graph.node(parent).parent();
        }
        depth
    };
    let mut all: Vec<NodeId> = graph.iter().map(|(id, _)| id).filter(|id| *id != graph.clock()).collect();
    all.sort_by_key(|id| (depth(*id), graph.node(*id).name()));
    all
}

/// A text in quotes, with escapes.
fn quoted(text: &str) -> String {
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
