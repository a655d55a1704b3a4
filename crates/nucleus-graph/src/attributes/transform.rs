//! What everything that has a place has.

use super::Plugged;
use super::key::{choice, node, toggle, vector};
use super::table::node_table;

node_table! {
    /// A place for other nodes to hang from.
    TRANSFORM = "transform", inherits None, hides [];
    "Transform" {
        /// How far it is moved.
        TRANSLATE: [f64; 3] = vector("translate", "t", [0.0, 0.0, 0.0], ["tx", "ty", "tz"]).min(-1e12).max(1e12).unit("scene units").solved("nucleus_graph::animation");
        /// How far it is turned about x, then y, then z.
        ROTATE: [f64; 3] = vector("rotate", "r", [0.0, 0.0, 0.0], ["rx", "ry", "rz"]).min(-1e9).max(1e9).unit("degrees").solved("nucleus_graph::animation");
        /// Factors along its own axes.
        SCALE: [f64; 3] = vector("scale", "s", [1.0, 1.0, 1.0], ["sx", "sy", "sz"]).min(-1e9).max(1e9).solved("nucleus_graph::animation");
        /// The order of the three rotations.
        ROTATE_ORDER: super::Choice = choice("rotateOrder", "ro", 0, &[(0, "xyz"), (1, "yzx"), (2, "zxy"), (3, "xzy"), (4, "yxz"), (5, "zyx")]).solved("nucleus_graph::animation").fixed();
        /// Whether Maya draws it.
        VISIBILITY: bool = toggle("visibility", "v", true);
    }
    "Nucleus (open)" {
        /// The transform it moves along with.
        PARENT: Plugged = node("parent", "parent", None).solved("nucleus_graph::graph").extension();
    }
}
