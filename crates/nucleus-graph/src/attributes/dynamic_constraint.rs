//! Constraints between parts of objects, or between them and a transform.

use std::borrow::Cow;

use super::key::{Plugged, choice, components, float, int, node, plug, ramp, toggle};
use super::kind::Data;
use super::node_type::node_table;
use super::scene_nodes::transform::TRANSFORM;
use super::value::{Choice, Component, RampPoint};

/// 1 everywhere.
const FULL: &[RampPoint] = &[RampPoint { position: 0.0, value: 1.0, interpolation: Choice(1) }];

/// The constraints of Maya's menu.
const CONSTRAINT_TYPES: &[(i32, &str)] = &[
    (0, "transform"),
    (1, "pointToPoint"),
    (2, "pointToSurface"),
    (3, "slideOnSurface"),
    (4, "weldBorders"),
    (5, "force"),
    (6, "match"),
    (7, "tearableSurface"),
    (8, "disableCollision"),
    (9, "collisionExclusion"),
];

/// `restLengthMethod: constant`.
pub const CONSTANT_REST_LENGTH: Choice = Choice(1);

node_table! {
    /// A dynamic constraint between components of objects, or between components and its own transform.
    DYNAMIC_CONSTRAINT = "dynamicConstraint", inherits Some(&TRANSFORM), hides [];
    "Nucleus (open)" {
        /// Constraint of Maya's menu, which sets the defaults of the other attributes. `transform` alone pins points to its transform; with a strength or another attribute of springs it holds them by springs.
        CONSTRAINT_TYPE: Choice = choice("constraintType", "type", 0, CONSTRAINT_TYPES).solved("nucleus_graph::compile::constraints").fixed().extension();
        /// The constrained components: `["cloth1.vtx[8:16]", "cloth1.e[border]", "cloth1.where(y > 1.49)", "ball"]`. `where` compares places in the space of the mesh, before its transform. A whole object or border stands for its border edges in `weldBorders`.
        COMPONENTS: Vec<Component> = components("components", "components").solved("nucleus_graph::compile::constraints").extension();
        /// Its nucleus. Default: the only one of the scene.
        NUCLEUS: Plugged = node("nucleus", "nucleus", None).solved("nucleus_graph::graph").extension();
    }
    "General" {
        /// Enables the constraint. When it is switched on it attaches components at their current positions.
        ENABLE: bool = toggle("enable", "ena", true).solved("nucleus_graph::compile::constraints");
    }
    "Dynamic Constraint" {
        /// Type of its links: welds, springs, or rubber bands, which only pull.
        CONSTRAINT_METHOD: Choice = choice("constraintMethod", "cm", 1, &[(0, "Weld"), (1, "Spring"), (2, "Rubber Band")]).solved("nucleus_graph::compile::constraints");
        /// Whether components are linked to the constraint's transform or to each other.
        CONSTRAINT_RELATION: Choice = choice("constraintRelation", "crr", 1, &[(0, "Object to Constraint"), (1, "Object to Object")]).solved("nucleus_graph::compile::constraints");
        /// Whether Maya draws the links.
        DISPLAY_CONNECTIONS: bool = toggle("displayConnections", "dcn", true).elsewhere("only Maya's viewport draws it");
    }
    "Connection" {
        /// Method by which elements are paired.
        CONNECTION_METHOD: Choice = choice("connectionMethod", "cnm", 0, &[(0, "Component Order"), (1, "Within Max Distance"), (2, "Nearest Pairs")]).solved("nucleus_graph::compile::constraints");
        /// Members between which links are made.
        COMPONENT_RELATION: Choice = choice("componentRelation", "cmr", 0, &[(0, "All to First"), (1, "All to All"), (2, "Chain")]).solved("nucleus_graph::compile::constraints");
        /// Whether pairs are made once or again in each frame.
        CONNECTION_UPDATE: Choice = choice("connectionUpdate", "cu", 0, &[(0, "At Start"), (1, "Per Frame")]).solved("nucleus_graph::compile::constraints");
        /// Also links elements of the same member.
        CONNECT_WITHIN_COMPONENT: bool = toggle("connectWithinComponent", "cwc", false).solved("nucleus_graph::compile::constraints");
        /// Share of the possible links that are made.
        CONNECTION_DENSITY: f64 = float("connectionDensity", "cdn", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::constraints");
        /// Factor on that share, over the length of a link.
        CONNECTION_DENSITY_RANGE: Cow<'static, [RampPoint]> = ramp("connectionDensityRange", "cdnr", FULL).solved("nucleus_graph::compile::constraints");
        /// Largest distance of linked elements, for methods that use it.
        MAX_DISTANCE: f64 = float("maxDistance", "mds", 0.1).soft(0.0, 1.0).unit("scene units").solved("nucleus_graph::compile::constraints");
    }
    "Strength" {
        /// Strength of its links. Physical: a stiffness of 500 N/m per link for 1. Classic: iterations in 1/24 s.
        STRENGTH: f64 = float("strength", "str", 20.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::link");
        /// Strength along the surface, tangential to the link.
        TANGENT_STRENGTH: f64 = float("tangentStrength", "tst", 10.0).soft(0.0, 200.0).solved("nucleus_core::constraints::link::surface");
        /// Whether linked edges also resist bending about each other.
        BEND: bool = toggle("bend", "bnd", false).solved("nucleus_core::constraints::link::fold");
        /// Strength of that resistance.
        BEND_STRENGTH: f64 = float("bendStrength", "bns", 20.0).soft(0.0, 200.0).solved("nucleus_core::constraints::link::fold");
        /// Angle at which it breaks.
        BEND_BREAK_ANGLE: f64 = float("bendBreakAngle", "bba", 360.0).soft(0.0, 360.0).unit("degrees").solved("nucleus_core::constraints::link::fold");
        /// Load at which links break: 0 at once, 0.5 at 100 N per metre of edge or 100 N per point, 1 never.
        GLUE_STRENGTH: f64 = float("glueStrength", "gls", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::glue");
        /// Factor on the load at which links break.
        GLUE_STRENGTH_SCALE: f64 = float("glueStrengthScale", "glss", 1.0).soft(0.0, 10.0).solved("nucleus_core::constraints::link::glue");
        /// Attraction (above 0) or repulsion of the linked elements; 1 is 10 m/s².
        FORCE: f64 = float("force", "for", 0.0).soft(-10.0, 10.0).solved("nucleus_core::constraints::link::velocity");
        /// Share of the relative velocity of members that is removed; 1 locks their motion.
        MOTION_DRAG: f64 = float("motionDrag", "mdg", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::velocity");
    }
    "Rest Length" {
        /// Whether rest lengths are measured at the start or set.
        REST_LENGTH_METHOD: Choice = choice("restLengthMethod", "rlm", 0, &[(0, "From Start Distance"), (1, "Constant")]).solved("nucleus_graph::compile::constraints");
        /// The rest length, if it is set.
        REST_LENGTH: f64 = float("restLength", "rl", 0.0).soft(0.0, 10.0).unit("scene units").solved("nucleus_core::constraints::link");
        /// Factor on the rest lengths.
        REST_LENGTH_SCALE: f64 = float("restLengthScale", "rls", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link");
    }
    "Dropoff" {
        /// Factor on `dropoffDistance`.
        DROPOFF: f64 = float("dropoff", "drp", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link");
        /// Distance over which `strengthDropoff` acts; beyond it, the right end of the ramp goes on.
        DROPOFF_DISTANCE: f64 = float("dropoffDistance", "ddd", 50.0).soft(0.0, 100.0).unit("scene units").solved("nucleus_core::constraints::link");
        /// Falloff of the strength over that distance.
        STRENGTH_DROPOFF: Cow<'static, [RampPoint]> = ramp("strengthDropoff", "sdp", FULL).solved("nucleus_core::constraints::link");
    }
    "Collisions / Damp" {
        /// Damping of the velocities along its links.
        DAMP: f64 = float("damp", "dmp", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::velocity");
        /// Friction of sliding; at 1 nothing slides.
        FRICTION: f64 = float("friction", "frc", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::surface");
        /// Keeps a linked point on its side of the surface that it is linked to, at the contact thickness or where it started nearer.
        LOCAL_COLLIDE: bool = toggle("localCollide", "lcl", false).solved("nucleus_core::constraints::link::surface");
        /// Thickness for that, as a multiple of the contact thickness.
        COLLIDE_WIDTH_SCALE: f64 = float("collideWidthScale", "cws", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::surface");
        /// Excludes collisions between linked elements.
        EXCLUDE_COLLISIONS: bool = toggle("excludeCollisions", "excs", false).solved("nucleus_graph::compile::constraints");
        /// Sliding points stay on their initial side.
        SINGLE_SIDED: bool = toggle("singleSided", "ssd", true).solved("nucleus_graph::compile::constraints");
    }
    "Solver" {
        /// Largest number of iterations.
        MAX_ITERATIONS: i64 = int("maxIterations", "mitr", 5000).soft(0.0, 10000.0).solved("nucleus_core::constraints::link");
        /// Smallest number of iterations.
        MIN_ITERATIONS: i64 = int("minIterations", "mini", 0).soft(0.0, 100.0).solved("nucleus_core::constraints::link");
    }
    "Out of use" {
        /// Obsolete in Maya.
        ITERATIONS: i64 = int("iterations", "itr", 20).hidden().unused();
        /// Obsolete in Maya.
        COLLIDE: bool = toggle("collide", "cld", true).hidden().unused();
    }
    "Connections" {
        /// Time of the evaluation; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0).hidden().wiring("the frame that is evaluated counts");
        /// Its members.
        COMPONENT_IDS: Plugged = plug("componentIds", "cid", Data::Component).multi().solved("nucleus_graph::compile::constraints");
        /// Its initial state.
        EVAL_START: Plugged = plug("evalStart", "evs", Data::Constraint).multi().output().wiring("`evalCurrent` stands for both");
        /// Its current state.
        EVAL_CURRENT: Plugged = plug("evalCurrent", "evc", Data::Constraint).multi().output().solved("nucleus_graph::compile::constraints");
    }
    "Internal" {
        /// Includes the constraint in the simulation.
        IS_DYNAMIC: bool = toggle("isDynamic", "isd", true).hidden().solved("nucleus_graph::compile::constraints");
    }
}
