//! Colliders. Rows of its base are repeated where creation in Maya sets another value.

use super::key::{choice, float, toggle};
use super::n_base::{N_BASE, NO_USE_TO_MESHES};
use super::node_type::node_table;
use super::value::Choice;

/// Attributes without effect on an object that the solver does not move.
#[rustfmt::skip] // a name per line would be a page of its own
const NO_USE_TO_COLLIDERS: &[&str] = &[
    "acceleration", "position0", "velocity0", "mass", "startPositions", "startVelocities", "damp", "dampMap", "dampPerVertex",
    "selfCollisionFlag", "maxSelfCollisionIterations", "maxIterations", "pointMass", "massMap", "massPerVertex",
    "restLengthScale", "localForce", "localWind", "selfCollide", "selfAttract", "dampMapType", "massMapType",
    "nextState", "cacheFile",
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
        /// Speed at which cloth that intersects the collider separates.
        CROSSOVER_PUSH: f64 = float("crossoverPush", "cop", 0.0).min(0.0).soft(0.0, 1.0).elsewhere("a collider has no intersection contours; `trappedCheck` pushes cloth out of it");
    }
}
