//! Colliders. Rows of its base are repeated where creation in Maya sets another value.

use super::Choice;
use super::key::{choice, toggle};
use super::n_base::N_BASE;
use super::table::node_table;

node_table! {
    /// A mesh that cloth collides with. It is moved by its transform and by nothing else.
    N_RIGID = "nRigid", inherits Some(&N_BASE), hides ["dieOnEmissionVolumeExit", "lifespanMode", "lifespanRandom", "expressionsAfterDynamics", "dynamicsWeight", "forcesInWorld", "conserve", "emissionInWorld", "maxCount", "levelOfDetail", "inheritFactor", "currentTime", "startFrame", "inputGeometrySpace", "enforceCountFromHistory", "targetGeometrySpace", "goalSmoothness", "cacheData", "traceDepth", "particleRenderType"];
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
}
