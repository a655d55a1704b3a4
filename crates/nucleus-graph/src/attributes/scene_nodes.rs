//! Nodes of a scene that are not dynamics: transforms, cameras, meshes, primitives, and the time.

use super::key::{Plugged, choice, float, int, node, plug, text, together, toggle, vector};
use super::kind::Data;
use super::node_type::node_table;
use super::value::Choice;

use surface_shape::SURFACE_SHAPE;
use transform::TRANSFORM;

/// Attributes of every node with a transform.
pub mod transform {
    use super::*;

    node_table! {
        /// A transform, which can be the parent of other nodes.
        TRANSFORM = "transform", inherits None, hides [];
        "Transform" {
            /// Translation.
            TRANSLATE: [f64; 3] = vector("translate", "t", [0.0, 0.0, 0.0], ["tx", "ty", "tz"]).min(-1e12).max(1e12).unit("scene units").solved("nucleus_graph::animation");
            /// Rotation about x, y and z, in the order of `rotateOrder`.
            ROTATE: [f64; 3] = vector("rotate", "r", [0.0, 0.0, 0.0], ["rx", "ry", "rz"]).min(-1e9).max(1e9).unit("degrees").solved("nucleus_graph::animation");
            /// Scale along the local axes.
            SCALE: [f64; 3] = vector("scale", "s", [1.0, 1.0, 1.0], ["sx", "sy", "sz"]).min(-1e9).max(1e9).solved("nucleus_graph::animation");
            /// The order of the three rotations.
            ROTATE_ORDER: Choice = choice("rotateOrder", "ro", 0, &[(0, "xyz"), (1, "yzx"), (2, "zxy"), (3, "xzy"), (4, "yxz"), (5, "zyx")]).solved("nucleus_graph::animation").fixed();
            /// Whether Maya draws it.
            VISIBILITY: bool = toggle("visibility", "v", true).elsewhere("only Maya's viewport and renderers read it");
        }
        "Nucleus (open)" {
            /// The parent transform.
            PARENT: Plugged = node("parent", "parent", None).solved("nucleus_graph::graph").extension();
        }
    }
}

/// Cameras.
pub mod camera {
    use super::*;

    node_table! {
        /// A camera that looks along its -z axis, with its y axis up. The node combines Maya's transform and shape.
        CAMERA = "camera", inherits Some(&TRANSFORM), hides [];
        "Camera Attributes" {
            /// Focal length. A longer one narrows the view.
            FOCAL_LENGTH: f64 = float("focalLength", "fl", 35.0).min(2.5).max(100000.0).unit("mm").solved("nucleus_graph::compile");
            /// Distance from the eye to the centre of interest, about which the player orbits.
            CENTER_OF_INTEREST: f64 = float("centerOfInterest", "coi", 5.0).min(1e-6).max(1e12).unit("scene units").solved("nucleus_graph::compile");
        }
        "Film Back" {
            /// Width of the film.
            HORIZONTAL_FILM_APERTURE: f64 = float("horizontalFilmAperture", "hfa", 1.41732).min(0.001).max(1e6).unit("inches").solved("nucleus_graph::compile");
            /// Height of the film.
            VERTICAL_FILM_APERTURE: f64 = float("verticalFilmAperture", "vfa", 0.94488).min(0.001).max(1e6).unit("inches").solved("nucleus_graph::compile");
            /// Fit of an image whose aspect ratio differs from the film's: inside the film, by width, by height, or around the film.
            FILM_FIT: Choice = choice("filmFit", "ff", 0, &[(0, "Fill"), (1, "Horizontal"), (2, "Vertical"), (3, "Overscan")]).solved("nucleus_graph::compile").fixed();
        }
    }
}

/// Attributes shared by all meshes.
pub mod surface_shape {
    use super::*;

    node_table! {
        /// A surface. The node combines Maya's transform and shape.
        SURFACE_SHAPE = "surfaceShape", inherits Some(&TRANSFORM), hides [];
        "Nucleus (open)" {
            /// The blend target: a mesh with the same number of points.
            BLEND_TARGET: Plugged = node("blendTarget", "blendTarget", None).solved("nucleus_graph::graph").extension();
            /// Weight of the blend target: 0 is this mesh, 1 the target. Points are blended in mesh space.
            BLEND: f64 = float("blend", "blend", 0.0).min(-1e6).max(1e6).soft(0.0, 1.0).solved("nucleus_graph::mesh").extension();
        }
        "Connections" {
            /// The surface in world space.
            WORLD_MESH: Plugged = plug("worldMesh", "w", Data::Mesh).multi().output();
            /// The surface that this node displays.
            IN_MESH: Plugged = plug("inMesh", "i", Data::Mesh);
        }
    }
}

/// Meshes from files.
pub mod mesh {
    use super::*;

    node_table! {
        /// A mesh from a file, with points in the order of the file.
        MESH = "mesh", inherits Some(&SURFACE_SHAPE), hides [];
        "Nucleus (open)" {
            /// An OBJ, PLY, glTF or USD file, relative to the scene file. `####` in its name stands for the frame number: one file per frame. A glTF or USD file plays its animation: transforms, point caches, blend shapes and skins.
            FILE: String = text("file", "file").solved("nucleus_graph::mesh").extension();
            /// The object of a glTF or USD file: the meshes at and below the nodes or prims of this name. All meshes if it is empty.
            OBJECT: String = text("object", "object").solved("nucleus_graph::mesh").extension();
        }
    }
}

/// Rectangles.
pub mod poly_plane {
    use super::*;

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
            /// Direction of the y axis of the primitive, of any length.
            AXIS: [f64; 3] = vector("axis", "ax", [0.0, 1.0, 0.0], ["axx", "axy", "axz"]).solved("nucleus_graph::mesh").fixed();
        }
        "Nucleus (open)" {
            /// All counts of subdivisions at once.
            SUBDIVISIONS: Plugged = together("subdivisions", &["subdivisionsWidth", "subdivisionsHeight"]).solved("nucleus_graph::mesh").extension();
        }
    }
}

/// Spheres.
pub mod poly_sphere {
    use super::*;

    node_table! {
        /// A sphere of quads, with triangles at the poles.
        POLY_SPHERE = "polySphere", inherits Some(&SURFACE_SHAPE), hides [];
        "Shape" {
            /// Radius.
            RADIUS: f64 = float("radius", "r", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
            /// Faces around the axis.
            SUBDIVISIONS_AXIS: i64 = int("subdivisionsAxis", "sa", 20).min(3.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Faces from pole to pole.
            SUBDIVISIONS_HEIGHT: i64 = int("subdivisionsHeight", "sh", 20).min(2.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Direction of the y axis of the primitive, of any length.
            AXIS: [f64; 3] = vector("axis", "ax", [0.0, 1.0, 0.0], ["axx", "axy", "axz"]).solved("nucleus_graph::mesh").fixed();
        }
        "Nucleus (open)" {
            /// All counts of subdivisions at once.
            SUBDIVISIONS: Plugged = together("subdivisions", &["subdivisionsAxis", "subdivisionsHeight"]).solved("nucleus_graph::mesh").extension();
        }
    }
}

/// Boxes.
pub mod poly_cube {
    use super::*;

    node_table! {
        /// A box of quads.
        POLY_CUBE = "polyCube", inherits Some(&SURFACE_SHAPE), hides [];
        "Shape" {
            /// Length along x.
            WIDTH: f64 = float("width", "w", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
            /// Length along y.
            HEIGHT: f64 = float("height", "h", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
            /// Length along z.
            DEPTH: f64 = float("depth", "d", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
            /// Quads along x.
            SUBDIVISIONS_WIDTH: i64 = int("subdivisionsWidth", "sw", 1).min(1.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Quads along y.
            SUBDIVISIONS_HEIGHT: i64 = int("subdivisionsHeight", "sh", 1).min(1.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Quads along z.
            SUBDIVISIONS_DEPTH: i64 = int("subdivisionsDepth", "sd", 1).min(1.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Direction of the y axis of the primitive, of any length.
            AXIS: [f64; 3] = vector("axis", "ax", [0.0, 1.0, 0.0], ["axx", "axy", "axz"]).solved("nucleus_graph::mesh").fixed();
        }
        "Nucleus (open)" {
            /// All counts of subdivisions at once.
            SUBDIVISIONS: Plugged = together("subdivisions", &["subdivisionsWidth", "subdivisionsHeight", "subdivisionsDepth"]).solved("nucleus_graph::mesh").extension();
        }
    }
}

/// Cylinders.
pub mod poly_cylinder {
    use super::*;

    node_table! {
        /// A cylinder with caps.
        POLY_CYLINDER = "polyCylinder", inherits Some(&SURFACE_SHAPE), hides [];
        "Shape" {
            /// Radius.
            RADIUS: f64 = float("radius", "r", 1.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
            /// Length along y.
            HEIGHT: f64 = float("height", "h", 2.0).min(1e-6).max(1e9).unit("scene units").solved("nucleus_graph::mesh").fixed();
            /// Quads around the axis.
            SUBDIVISIONS_AXIS: i64 = int("subdivisionsAxis", "sa", 20).min(3.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Quads along the height.
            SUBDIVISIONS_HEIGHT: i64 = int("subdivisionsHeight", "sh", 1).min(1.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Rings of a cap from rim to centre; 0 makes each cap one polygon.
            SUBDIVISIONS_CAPS: i64 = int("subdivisionsCaps", "sc", 0).min(0.0).max(4096.0).solved("nucleus_graph::mesh").fixed();
            /// Direction of the y axis of the primitive, of any length.
            AXIS: [f64; 3] = vector("axis", "ax", [0.0, 1.0, 0.0], ["axx", "axy", "axz"]).solved("nucleus_graph::mesh").fixed();
        }
        "Nucleus (open)" {
            /// All counts of subdivisions at once.
            SUBDIVISIONS: Plugged = together("subdivisions", &["subdivisionsAxis", "subdivisionsHeight", "subdivisionsCaps"]).solved("nucleus_graph::mesh").extension();
        }
    }
}

/// The scene time.
pub mod time {
    use super::*;

    node_table! {
        /// The time of the scene.
        TIME = "time", inherits None, hides [];
        "Connections" {
            /// The current time.
            OUT_TIME: Plugged = plug("outTime", "o", Data::Number).output();
        }
    }
}
