//! Constraints between parts of objects, or between them and a transform.

use std::borrow::Cow;

use super::key::{Plugged, choice, components, float, int, node, plug, ramp, toggle};
use super::kind::Data;
use super::node_type::node_table;
use super::scene_nodes::transform::TRANSFORM;
use super::value::{Choice, Component, RampPoint};

/// 1 everywhere.
const FULL: &[RampPoint] = &[RampPoint { position: 0.0, value: 1.0, interpolation: Choice(1) }];

/// What Maya's menu calls its constraints.
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

node_table! {
    /// A relation between parts of objects. Its own transform is what points are pinned to.
    DYNAMIC_CONSTRAINT = "dynamicConstraint", inherits Some(&TRANSFORM), hides [];
    "Nucleus (open)" {
        /// Which constraint of Maya's menu it is: its values are the defaults of the other attributes. `transform` alone pins points and carries them with its own transform; with a strength or another attribute of springs it holds them by springs.
        CONSTRAINT_TYPE: Choice = choice("constraintType", "type", 0, CONSTRAINT_TYPES).solved("nucleus_graph::compile::constraints").fixed().extension();
        /// What it takes hold of: `["cloth1.vtx[8:16]", "cloth1.e[border]", "cloth1.where(y > 1.49)", "ball"]`.
        COMPONENTS: Vec<Component> = components("components", "components").solved("nucleus_graph::compile::constraints").extension();
        /// The nucleus it belongs to; the only one of the scene when left out.
        NUCLEUS: Plugged = node("nucleus", "nucleus", None).solved("nucleus_graph::graph").extension();
    }
    "General" {
        /// Acts at all. A constraint that is switched on takes hold of things where they are then.
        ENABLE: bool = toggle("enable", "ena", true).solved("nucleus_graph::compile::constraints");
    }
    "Dynamic Constraint" {
        /// Whether what it joins is welded, sprung, or held by rubber bands.
        CONSTRAINT_METHOD: Choice = choice("constraintMethod", "cm", 1, &[(0, "Weld"), (1, "Spring"), (2, "Rubber Band")]).solved("nucleus_graph::compile::constraints");
        /// Whether it ties things to its own transform or to each other.
        CONSTRAINT_RELATION: Choice = choice("constraintRelation", "crr", 1, &[(0, "Object to Constraint"), (1, "Object to Object")]).solved("nucleus_graph::compile::constraints");
        /// Whether Maya draws the links.
        DISPLAY_CONNECTIONS: bool = toggle("displayConnections", "dcn", true).elsewhere("only Maya's viewport draws it");
    }
    "Connection" {
        /// How the elements to join are paired.
        CONNECTION_METHOD: Choice = choice("connectionMethod", "cnm", 0, &[(0, "Component Order"), (1, "Within Max Distance"), (2, "Nearest Pairs")]).solved("nucleus_graph::compile::constraints");
        /// Which of its members are joined with which.
        COMPONENT_RELATION: Choice = choice("componentRelation", "cmr", 0, &[(0, "All to First"), (1, "All to All"), (2, "Chain")]).solved("nucleus_graph::compile::constraints");
        /// Whether pairs are made once or anew in every frame.
        CONNECTION_UPDATE: Choice = choice("connectionUpdate", "cu", 0, &[(0, "At Start"), (1, "Per Frame")]).solved("nucleus_graph::compile::constraints");
        /// Joins elements of the same member too.
        CONNECT_WITHIN_COMPONENT: bool = toggle("connectWithinComponent", "cwc", false).solved("nucleus_graph::compile::constraints");
        /// Share of the possible links that is made.
        CONNECTION_DENSITY: f64 = float("connectionDensity", "cdn", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::constraints");
        /// That share over the length of a link.
        CONNECTION_DENSITY_RANGE: Cow<'static, [RampPoint]> = ramp("connectionDensityRange", "cdnr", FULL).solved("nucleus_graph::compile::constraints");
        /// How far apart elements may be to be joined, where that decides.
        MAX_DISTANCE: f64 = float("maxDistance", "mds", 0.1).soft(0.0, 1.0).unit("scene units").solved("nucleus_graph::compile::constraints");
    }
    "Strength" {
        /// Strength of its links: a stiffness of 500 N/m each for 1 (Physical), or iterations in 1/24 s (Classic).
        STRENGTH: f64 = float("strength", "str", 20.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::link");
        /// Strength along the surface.
        TANGENT_STRENGTH: f64 = float("tangentStrength", "tst", 10.0).soft(0.0, 200.0).solved("nucleus_core::constraints::link::surface");
        /// Joined edges also resist folding about each other.
        BEND: bool = toggle("bend", "bnd", false).solved("nucleus_core::constraints::link::fold");
        /// How strongly they resist: a bending stiffness, or a count of iterations, like `bendResistance` of a cloth.
        BEND_STRENGTH: f64 = float("bendStrength", "bns", 20.0).soft(0.0, 200.0).solved("nucleus_core::constraints::link::fold");
        /// At which angle from the start they let go; 180 and more never.
        BEND_BREAK_ANGLE: f64 = float("bendBreakAngle", "bba", 360.0).soft(0.0, 360.0).unit("degrees").solved("nucleus_core::constraints::link::fold");
        /// How much it takes to come loose: 1 never does, 0 at once, 0.5 at 100 N per metre of edge, or 100 N per point.
        GLUE_STRENGTH: f64 = float("glueStrength", "gls", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::glue");
        /// Factor on the load at which it comes loose.
        GLUE_STRENGTH_SCALE: f64 = float("glueStrengthScale", "glss", 1.0).soft(0.0, 10.0).solved("nucleus_core::constraints::link::glue");
        /// Pulls together (above 0) or pushes apart: 10 m/s² for 1.
        FORCE: f64 = float("force", "for", 0.0).soft(-10.0, 10.0).solved("nucleus_core::constraints::link::velocity");
        /// How much members drag each other along: 1 locks their motion together.
        MOTION_DRAG: f64 = float("motionDrag", "mdg", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::velocity");
    }
    "Rest Length" {
        /// Whether rest lengths are measured or given.
        REST_LENGTH_METHOD: Choice = choice("restLengthMethod", "rlm", 0, &[(0, "From Start Distance"), (1, "Constant")]).solved("nucleus_graph::compile::constraints");
        /// The rest length, where it is given.
        REST_LENGTH: f64 = float("restLength", "rl", 0.0).soft(0.0, 10.0).unit("scene units").solved("nucleus_core::constraints::link");
        /// Factor on the rest lengths.
        REST_LENGTH_SCALE: f64 = float("restLengthScale", "rls", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link");
    }
    "Dropoff" {
        /// Factor on `dropoffDistance`.
        DROPOFF: f64 = float("dropoff", "drp", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link");
        /// Beyond this distance it does nothing.
        DROPOFF_DISTANCE: f64 = float("dropoffDistance", "ddd", 50.0).soft(0.0, 100.0).unit("scene units").solved("nucleus_core::constraints::link");
        /// Strength over that distance.
        STRENGTH_DROPOFF: Cow<'static, [RampPoint]> = ramp("strengthDropoff", "sdp", FULL).solved("nucleus_core::constraints::link");
    }
    "Collisions / Damp" {
        /// Takes speed out of its motion.
        DAMP: f64 = float("damp", "dmp", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::velocity");
        /// How hard sliding is: at 1 nothing slides.
        FRICTION: f64 = float("friction", "frc", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::surface");
        /// Keeps a joined point on its side of the surface it is joined to.
        LOCAL_COLLIDE: bool = toggle("localCollide", "lcl", false).solved("nucleus_core::constraints::link::surface");
        /// Thickness for that, as a multiple.
        COLLIDE_WIDTH_SCALE: f64 = float("collideWidthScale", "cws", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::link::surface");
        /// What it joins does not collide with each other.
        EXCLUDE_COLLISIONS: bool = toggle("excludeCollisions", "excs", false).solved("nucleus_graph::compile::constraints");
        /// Sliding points stay on the side where they began.
        SINGLE_SIDED: bool = toggle("singleSided", "ssd", true).solved("nucleus_graph::compile::constraints");
    }
    "Solver" {
        /// No more iterations than this.
        MAX_ITERATIONS: i64 = int("maxIterations", "mitr", 5000).soft(0.0, 10000.0).solved("nucleus_core::constraints::link");
        /// No fewer iterations than this.
        MIN_ITERATIONS: i64 = int("minIterations", "mini", 0).soft(0.0, 100.0).solved("nucleus_core::constraints::link");
    }
    "Out of use" {
        /// Out of use in Maya.
        ITERATIONS: i64 = int("iterations", "itr", 20).hidden().unused();
        /// Out of use in Maya.
        COLLIDE: bool = toggle("collide", "cld", true).hidden().unused();
    }
    "Connections" {
        /// The time it is evaluated for; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0).hidden().elsewhere("the frame that is evaluated counts");
        /// Its members.
        COMPONENT_IDS: Plugged = plug("componentIds", "cid", Data::Component).multi().solved("nucleus_graph::compile::constraints");
        /// The constraint at the start.
        EVAL_START: Plugged = plug("evalStart", "evs", Data::Constraint).multi().output().elsewhere("`evalCurrent` stands for both");
        /// The constraint as it is now.
        EVAL_CURRENT: Plugged = plug("evalCurrent", "evc", Data::Constraint).multi().output().solved("nucleus_graph::compile::constraints");
    }
    "Internal" {
        /// Takes part in the simulation at all.
        IS_DYNAMIC: bool = toggle("isDynamic", "isd", true).hidden().solved("nucleus_graph::compile::constraints");
    }
}
