//! Colliders. Rows of its base are repeated where creation in Maya sets another value.

use super::key::{choice, float, floats, texture, toggle};
use super::n_base::{MAP_TYPES, N_BASE, NO_USE_TO_MESHES};
use super::node_type::node_table;
use super::value::Choice;

/// What an object that nothing moves has no use for.
#[rustfmt::skip] // a name per line would be a page of its own
const NO_USE_TO_COLLIDERS: &[&str] = &[
    "acceleration", "position0", "velocity0", "mass", "startVelocities", "damp", "dampMap", "dampPerVertex",
    "selfCollisionFlag", "maxSelfCollisionIterations", "maxIterations", "pointMass", "massMap", "massPerVertex",
    "restLengthScale", "localForce", "localWind", "selfCollide", "selfAttract", "dampMapType", "massMapType",
    "nextState",
];

node_table! {
    /// A mesh that cloth collides with. It is moved by its transform and by nothing else.
    N_RIGID = "nRigid", inherits Some(&N_BASE), hides [NO_USE_TO_MESHES, NO_USE_TO_COLLIDERS];
    "Collisions" {
        /// What Maya draws of the solver's data.
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off")]).elsewhere("only Maya's viewport draws it");
        /// Takes part in collisions with itself: a collider does not.
        SELF_COLLIDE: bool = toggle("selfCollide", "scld", false);
    }
    "Quality Settings" {
        /// Depenetrates points inside a closed collider, to the nearest surface; off, they stay inside.
        TRAPPED_CHECK: bool = toggle("trappedCheck", "tpc", true).solved("nucleus_core::contact::depenetration");
        /// Cloth that starts inside it is depenetrated point by point, whatever is set here: a collider has no intersection contours.
        CROSSOVER_PUSH: f64 = float("crossoverPush", "cop", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Collision Properties Maps" {
        /// Texture that varies thickness.
        THICKNESS_MAP: f64 = texture("thicknessMap", "thmp", 0.1);
        /// Factor on thickness at each point.
        THICKNESS_PER_VERTEX: Vec<f64> = floats("thicknessPerVertex", "thpv");
        /// Texture that varies bounce.
        BOUNCE_MAP: f64 = texture("bounceMap", "bomp", 0.0);
        /// Factor on bounce at each point.
        BOUNCE_PER_VERTEX: Vec<f64> = floats("bouncePerVertex", "bpv");
        /// Texture that varies stickiness.
        STICKINESS_MAP: f64 = texture("stickinessMap", "skmp", 0.0);
        /// Factor on stickiness at each point.
        STICKINESS_PER_VERTEX: Vec<f64> = floats("stickinessPerVertex", "skpv");
        /// Texture that varies collide strength.
        COLLIDE_STRENGTH_MAP: f64 = texture("collideStrengthMap", "csmp", 0.0);
        /// Factor on collide strength at each point.
        COLLIDE_STRENGTH_PER_VERTEX: Vec<f64> = floats("collideStrengthPerVertex", "cspv");
        /// Whether thickness is varied by nothing, by point, or by a texture.
        THICKNESS_MAP_TYPE: Choice = choice("thicknessMapType", "tmt", 2, MAP_TYPES);
        /// Whether bounce is varied by nothing, by point, or by a texture.
        BOUNCE_MAP_TYPE: Choice = choice("bounceMapType", "bmt", 2, MAP_TYPES);
        /// Whether stickiness is varied by nothing, by point, or by a texture.
        STICKINESS_MAP_TYPE: Choice = choice("stickinessMapType", "skmt", 2, MAP_TYPES);
        /// Whether collide strength is varied by nothing, by point, or by a texture.
        COLLIDE_STRENGTH_MAP_TYPE: Choice = choice("collideStrengthMapType", "csmt", 2, MAP_TYPES);
        /// Texture that varies friction.
        FRICTION_MAP: f64 = texture("frictionMap", "frmp", 0.0);
        /// Factor on friction at each point.
        FRICTION_PER_VERTEX: Vec<f64> = floats("frictionPerVertex", "fpv");
        /// Whether friction is varied by nothing, by point, or by a texture.
        FRICTION_MAP_TYPE: Choice = choice("frictionMapType", "fmt", 2, MAP_TYPES);
    }
}
