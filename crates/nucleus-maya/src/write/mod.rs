//! A Nucleus scene as Maya ASCII, wired as Maya's creation commands do.
//!
//! | You want to know...                                     | Read           |
//! |---------------------------------------------------------|----------------|
//! | the order of the file                                   | [`maya_ascii`] |
//! | a Nucleus node as a transform and a shape               | `nodes.rs`     |
//! | settings and curves as `setAttr` and `animCurve`        | `values.rs`    |
//! | values that Maya computes when it makes an object       | `creation.rs`  |
//! | embedded meshes                                         | `meshes.rs`    |
//! | names, plugs, and the text so far                       | `writer.rs`    |
//!
//! What Maya has no attribute for is an added attribute, which Maya keeps: a scene that is written and imported again is
//! the same scene.

mod creation;
mod meshes;
mod nodes;
mod values;
mod writer;

use nucleus_graph::graph::{Graph, NodeId};
use nucleus_graph::scene::Scene;

use crate::omissions::Omissions;

use writer::Writer;

/// A scene as the text of a `.ma` file, and the omissions.
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
