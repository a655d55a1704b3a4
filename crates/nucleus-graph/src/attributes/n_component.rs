//! Components of objects, for constraints. The short form of a constraint creates them.

use super::key::{Plugged, choice, float, floats, int, ints, plug, text, texture};
use super::kind::Data;
use super::n_base::MAP_TYPES;
use super::node_type::node_table;
use super::value::Choice;

/// `componentType: point`.
pub const POINT: Choice = Choice(2);
/// `componentType: edge`.
pub const EDGE: Choice = Choice(3);
/// `componentType: face`.
pub const FACE: Choice = Choice(4);
/// `componentType: object`.
pub const OBJECT: Choice = Choice(6);
/// `elements: fromIndiceList`.
pub const LISTED: Choice = Choice(0);
/// `elements: borders`.
pub const BORDERS: Choice = Choice(1);
/// `elements: all`.
pub const ALL: Choice = Choice(2);

node_table! {
    /// A component of an object that a constraint acts on.
    N_COMPONENT = "nComponent", inherits None, hides [];
    "Nucleus (open)" {
        /// Elements selected by meaning, separated by semicolons: `border`, `corners`, `where(y > 1.49)`, `group(collar)`, `mask(tear.png)`.
        SELECT: String = text("select", "select").solved("nucleus_graph::compile::select").extension();
    }
    "Component" {
        /// Kind of elements: points, edges, faces, or the object as a whole.
        COMPONENT_TYPE: Choice = choice("componentType", "ct", 0, &[(0, "None"), (2, "Point"), (3, "Edge"), (4, "Face"), (6, "Object")]).solved("nucleus_graph::compile::constraints").fixed();
        /// Selected elements: those listed, those on borders, or all.
        ELEMENTS: Choice = choice("elements", "el", 0, &[(0, "From Indice List"), (1, "Borders"), (2, "All")]).solved("nucleus_graph::compile::constraints").fixed();
        /// Factor on the strength of the constraint.
        STRENGTH: f64 = float("strength", "stn", 1.0).soft(0.0, 1.0).solved("nucleus_graph::compile::constraints").fixed();
        /// Factor on the glue strength of the constraint.
        GLUE_STRENGTH: f64 = float("glueStrength", "gst", 1.0).soft(0.0, 1.0).solved("nucleus_graph::compile::constraints").fixed();
        /// Weight of this side of the links relative to the other.
        WEIGHT: f64 = float("weight", "wgh", 1.0).soft(0.0, 1.0).solved("nucleus_graph::compile::constraints").fixed();
        /// Factor on the tangent strength of the constraint.
        TANGENT_STRENGTH: f64 = float("tangentStrength", "tst", 0.5).soft(0.0, 1.0).solved("nucleus_graph::compile::constraints").fixed();
        /// The elements listed.
        COMPONENT_INDICES: Vec<u32> = ints("componentIndices", "ci").solved("nucleus_graph::compile::constraints").multi();
    }
    "Connections" {
        /// The object of the component.
        OBJECT_ID: Plugged = plug("objectId", "obid", Data::ObjectId).solved("nucleus_graph::compile::constraints");
        /// The component, as the input of a constraint.
        OUT_COMPONENT: Plugged = plug("outComponent", "ocp", Data::Component).output().solved("nucleus_graph::compile::constraints");
        /// A mesh that elements are taken from.
        SURFACE: Plugged = plug("surface", "srf", Data::Mesh).wiring("elements are those of the object at `objectId`");
    }
    "Internal" {
        /// Number of the set that elements come from.
        COMPONENT_GROUP_ID: i64 = int("componentGroupId", "cid", 0).hidden().elsewhere("`componentIndices` and `select` name the elements of a set");
    }
    "Component Maps" {
        /// Texture of the map of strength.
        STRENGTH_MAP: f64 = texture("strengthMap", "stnm", 1.0).solved("nucleus_graph::compile::constraints");
        /// Factor on strength, per point.
        STRENGTH_PER_VERTEX: Vec<f64> = floats("strengthPerVertex", "spv").solved("nucleus_graph::compile::constraints");
        /// Texture of the map of glue strength.
        GLUE_STRENGTH_MAP: f64 = texture("glueStrengthMap", "gstm", 1.0).solved("nucleus_graph::compile::constraints");
        /// Factor on glue strength, per point.
        GLUE_STRENGTH_PER_VERTEX: Vec<f64> = floats("glueStrengthPerVertex", "gspv").solved("nucleus_graph::compile::constraints");
        /// Texture of the map of weight.
        WEIGHT_MAP: f64 = texture("weightMap", "wemp", 1.0).solved("nucleus_graph::compile::constraints");
        /// Factor on weight, per point.
        WEIGHT_PER_VERTEX: Vec<f64> = floats("weightPerVertex", "wpv").solved("nucleus_graph::compile::constraints");
        /// Source of the map of strength: none, a value per point, or a texture. Default: what is given.
        STRENGTH_MAP_TYPE: Choice = choice("strengthMapType", "smt", 2, MAP_TYPES).solved("nucleus_graph::compile::constraints");
        /// Source of the map of glue strength: none, a value per point, or a texture. Default: what is given.
        GLUE_STRENGTH_MAP_TYPE: Choice = choice("glueStrengthMapType", "gsmt", 2, MAP_TYPES).solved("nucleus_graph::compile::constraints");
        /// Source of the map of weight: none, a value per point, or a texture. Default: what is given.
        WEIGHT_MAP_TYPE: Choice = choice("weightMapType", "wmt", 2, MAP_TYPES).solved("nucleus_graph::compile::constraints");
    }
}
