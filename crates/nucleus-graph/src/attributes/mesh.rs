//! Meshes from files.

use super::key::text;
use super::surface_shape::SURFACE_SHAPE;
use super::table::node_table;

node_table! {
    /// A mesh that is read from a file, points in the order of the file.
    MESH = "mesh", inherits Some(&SURFACE_SHAPE), hides [];
    "Nucleus (open)" {
        /// An OBJ file, its path relative to the scene's own. `####` in its name stands for the frame: then there is a file for each.
        FILE: String = text("file", "file").solved("nucleus_graph::mesh").extension();
    }
}
