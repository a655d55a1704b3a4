//! Colliders. Rows of its base are repeated where creation in Maya sets another value.

use super::key::{choice, float, floats, texture, toggle};
use super::n_base::{MAP_TYPES, N_BASE, NO_USE_TO_MESHES};
use super::node_type::node_table;
use super::value::Choice;

/// Attributes without effect on an object that the solver does not move.
#[rustfmt::skip] // a name per line would be a page of its own
const NO_USE_TO_COLLIDERS: &[&str] = &[
    "acceleration", "position0", "velocity0", "mass", "startVelocities", "damp", "dampMap", "dampPerVertex",
    "selfCollisionFlag", "maxSelfCollisionIterations", "maxIterations", "pointMass", "massMap", "massPerVertex",
    "restLengthScale", "localForce", "localWind", "selfCollide", "selfAttract", "dampMapType", "massMapType",
    "nextState",
];

node_table! {
    /// A collider: a mesh that cloth and particles collide with. Its transform and its input mesh move it; the solver does not.
    N_RIGID = "nRigid", inherits Some(&N_BASE), hides [NO_USE_TO_MESHES, NO_USE_TO_COLLIDERS];
    "Collisions" {
        /// Solver data that Maya draws.
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off")]).elsewhere("only Maya's viewport draws it");
        /// Self-collision; colliders have none.
        SELF_COLLIDE: bool = toggle("selfCollide", "scld", false);
    }
    "Quality Settings" {
        /// Moves points inside a closed collider to the nearest surface. Off: they stay inside.
        TRAPPED_CHECK: bool = toggle("trappedCheck", "tpc", true).solved("nucleus_core::contact::depenetration");
        /// Without effect: cloth that starts inside a collider is depenetrated point by point.
        CROSSOVER_PUSH: f64 = float("crossoverPush", "cop", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Collision Properties Maps" {
        /// Texture of the map of thickness.
        THICKNESS_MAP: f64 = texture("thicknessMap", "thmp", 0.1);
        /// Factor on thickness, per point.
        THICKNESS_PER_VERTEX: Vec<f64> = floats("thicknessPerVertex", "thpv");
        /// Texture of the map of bounce.
        BOUNCE_MAP: f64 = texture("bounceMap", "bomp", 0.0);
        /// Factor on bounce, per point.
        BOUNCE_PER_VERTEX: Vec<f64> = floats("bouncePerVertex", "bpv");
        /// Texture of the map of stickiness.
        STICKINESS_MAP: f64 = texture("stickinessMap", "skmp", 0.0);
        /// Factor on stickiness, per point.
        STICKINESS_PER_VERTEX: Vec<f64> = floats("stickinessPerVertex", "skpv");
        /// Texture of the map of collide strength.
        COLLIDE_STRENGTH_MAP: f64 = texture("collideStrengthMap", "csmp", 0.0);
        /// Factor on collide strength, per point.
        COLLIDE_STRENGTH_PER_VERTEX: Vec<f64> = floats("collideStrengthPerVertex", "cspv");
        /// Source of the map of thickness: none, a value per point, or a texture.
        THICKNESS_MAP_TYPE: Choice = choice("thicknessMapType", "tmt", 2, MAP_TYPES);
        /// Source of the map of bounce: none, a value per point, or a texture.
        BOUNCE_MAP_TYPE: Choice = choice("bounceMapType", "bmt", 2, MAP_TYPES);
        /// Source of the map of stickiness: none, a value per point, or a texture.
        STICKINESS_MAP_TYPE: Choice = choice("stickinessMapType", "skmt", 2, MAP_TYPES);
        /// Source of the map of collide strength: none, a value per point, or a texture.
        COLLIDE_STRENGTH_MAP_TYPE: Choice = choice("collideStrengthMapType", "csmt", 2, MAP_TYPES);
        /// Texture of the map of friction.
        FRICTION_MAP: f64 = texture("frictionMap", "frmp", 0.0);
        /// Factor on friction, per point.
        FRICTION_PER_VERTEX: Vec<f64> = floats("frictionPerVertex", "fpv");
        /// Source of the map of friction: none, a value per point, or a texture.
        FRICTION_MAP_TYPE: Choice = choice("frictionMapType", "fmt", 2, MAP_TYPES);
    }
}
