//! Colliders. Rows of its base are repeated where creation in Maya sets another value.

use super::Choice;
use super::key::{choice, floats, texture, toggle};
use super::n_base::{MAP_TYPES, N_BASE, NO_USE_TO_MESHES};
use super::table::node_table;

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
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off")]);
        /// Takes part in collisions with itself: a collider does not.
        SELF_COLLIDE: bool = toggle("selfCollide", "scld", false);
    }
    "Quality Settings" {
        /// Remembers on which side points started and brings them back there.
        TRAPPED_CHECK: bool = toggle("trappedCheck", "tpc", true);
    }
    "Collision Properties Maps" {
        /// Texture that varies friction.
        FRICTION_MAP: f64 = texture("frictionMap", "frmp", 0.0);
        /// Factor on friction at each point.
        FRICTION_PER_VERTEX: Vec<f64> = floats("frictionPerVertex", "fpv");
        /// Whether friction is varied by nothing, by point, or by a texture.
        FRICTION_MAP_TYPE: Choice = choice("frictionMapType", "fmt", 2, MAP_TYPES);
    }
}
