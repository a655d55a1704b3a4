//! Rectangles.

use super::Plugged;
use super::key::{float, int, together, vector};
use super::surface_shape::SURFACE_SHAPE;
use super::table::node_table;

node_table! {
    /// A rectangle of quads in the xz plane, facing up.
    POLY_PLANE = "polyPlane", inherits Some(&SURFACE_SHAPE), hides [];
    "Shape" {
        /// Length along x.
        WIDTH: f64 = float("width", "w", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
        /// Length along z.
        HEIGHT: f64 = float("height", "h", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
        /// Quads along x.
        SUBDIVISIONS_WIDTH: i64 = int("subdivisionsWidth", "sw", 10).min(1.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
        /// Quads along z.
        SUBDIVISIONS_HEIGHT: i64 = int("subdivisionsHeight", "sh", 10).min(1.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
        /// Which way it stands.
        AXIS: [f64; 3] = vector("axis", "ax", [0.0, 1.0, 0.0], ["axx", "axy", "axz"]).fixed();
    }
    "Nucleus (open)" {
        /// All numbers of subdivisions in one go.
        SUBDIVISIONS: Plugged = together("subdivisions", &["subdivisionsWidth", "subdivisionsHeight"]).solved("nucleus_graph::mesh").extension();
    }
}
