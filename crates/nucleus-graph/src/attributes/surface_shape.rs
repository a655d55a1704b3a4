//! What all meshes share, whatever they are made from.

use super::key::{float, node, plug};
use super::table::node_table;
use super::transform::TRANSFORM;
use super::{Data, Plugged};

node_table! {
    /// Anything that has a surface in the scene. Such a node stands for its transform and its shape.
    SURFACE_SHAPE = "surfaceShape", inherits Some(&TRANSFORM), hides [];
    "Nucleus (open)" {
        /// A mesh of as many points that this one can be blended into.
        BLEND_TARGET: Plugged = node("blendTarget", "blendTarget", None).solved("nucleus_graph::graph").extension();
        /// How far it is blended: 0 is this mesh, 1 the target. Points are blended in the space of the mesh.
        BLEND: f64 = float("blend", "blend", 0.0).min(-1e6).max(1e6).soft(0.0, 1.0).solved("nucleus_graph::mesh").extension();
    }
    "Connections" {
        /// The surface in world space.
        WORLD_MESH: Plugged = plug("worldMesh", "wm", Data::Mesh).multi().output();
        /// The surface that this node shows.
        IN_MESH: Plugged = plug("inMesh", "i", Data::Mesh);
    }
}
