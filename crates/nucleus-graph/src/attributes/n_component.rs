//! Parts of objects, as constraints see them. Made by the short form of a constraint.

use super::key::{choice, float, ints, plug};
use super::table::node_table;
use super::{Choice, Plugged};

node_table! {
    /// A part of one object that a constraint takes hold of.
    N_COMPONENT = "nComponent", inherits None, hides [];
    "Component" {
        /// Kind of elements: points, edges, faces, or the object as a whole.
        COMPONENT_TYPE: Choice = choice("componentType", "ct", 0, &[(0, "None"), (2, "Point"), (3, "Edge"), (4, "Face"), (6, "Object")]).solved("pin");
        /// Which elements: those listed, those on borders, or all.
        ELEMENTS: Choice = choice("elements", "el", 0, &[(0, "From Indice List"), (1, "Borders"), (2, "All")]).solved("pin");
        /// Factor on the constraint's strength here.
        STRENGTH: f64 = float("strength", "stn", 1.0).soft(0.0, 1.0);
        /// Factor on the constraint's glue strength here.
        GLUE_STRENGTH: f64 = float("glueStrength", "gst", 1.0).soft(0.0, 1.0);
        /// Weight of this side against the other.
        WEIGHT: f64 = float("weight", "wgh", 1.0).soft(0.0, 1.0);
        /// Factor on the constraint's tangent strength here.
        TANGENT_STRENGTH: f64 = float("tangentStrength", "tst", 0.5).soft(0.0, 1.0);
        /// The elements listed.
        COMPONENT_INDICES: Vec<u32> = ints("componentIndices", "ci").solved("pin");
    }
    "Connections" {
        /// The object it is a part of.
        OBJECT_ID: Plugged = plug("objectId", "obid");
        /// The part, for a constraint.
        OUT_COMPONENT: Plugged = plug("outComponent", "ocp");
    }
}
