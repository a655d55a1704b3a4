//! Spheres.

use super::Plugged;
use super::key::{float, int, together, vector};
use super::surface_shape::SURFACE_SHAPE;
use super::table::node_table;

node_table! {
    /// A sphere of quads, with triangles at the poles.
    POLY_SPHERE = "polySphere", inherits Some(&SURFACE_SHAPE), hides [];
    "Shape" {
        /// Radius.
        RADIUS: f64 = float("radius", "r", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
        /// Faces round the axis.
        SUBDIVISIONS_AXIS: i64 = int("subdivisionsAxis", "sa", 20).min(3.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
        /// Faces from pole to pole.
        SUBDIVISIONS_HEIGHT: i64 = int("subdivisionsHeight", "sh", 20).min(2.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
        /// Which way it stands.
        AXIS: [f64; 3] = vector("axis", "ax", [0.0, 1.0, 0.0], ["axx", "axy", "axz"]).fixed();
    }
    "Nucleus (open)" {
        /// All numbers of subdivisions in one go.
        SUBDIVISIONS: Plugged = together("subdivisions", &["subdivisionsAxis", "subdivisionsHeight"]).solved("nucleus_graph::mesh").extension();
    }
}
