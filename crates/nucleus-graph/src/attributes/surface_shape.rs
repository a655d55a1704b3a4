//! What all meshes share, whatever they are made from.

use super::key::plug;
use super::table::node_table;
use super::transform::TRANSFORM;
use super::{Data, Plugged};

node_table! {
    /// Anything that has a surface in the scene. Such a node stands for its transform and its shape.
    SURFACE_SHAPE = "surfaceShape", inherits Some(&TRANSFORM), hides [];
    "Connections" {
        /// The surface in world space.
        WORLD_MESH: Plugged = plug("worldMesh", "wm", Data::Mesh).multi().output();
        /// The surface that this node shows.
        IN_MESH: Plugged = plug("inMesh", "i", Data::Mesh);
    }
}
