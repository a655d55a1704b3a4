//! Colliders. Rows of its base are repeated where creation in Maya sets another value.

use super::Choice;
use super::key::{choice, toggle};
use super::n_base::N_BASE;
use super::table::node_table;

node_table! {
    /// A mesh that cloth collides with. It is moved by its transform and by nothing else.
    N_RIGID = "nRigid", inherits Some(&N_BASE), hides [
    "rampPosition", "lastPosition", "rampVelocity", "lastVelocity", "acceleration", "rampAcceleration",
    "lastWorldPosition", "worldVelocityInObjectSpace", "lastWorldVelocity", "position0", "velocity0", "acceleration0",
    "emitterId0", "useStartupCache", "startupCachePath", "startupCacheFrame", "cachedPosition", "lastCachedPosition",
    "cachedWorldPosition", "cachedWorldCentroid", "cachedVelocity", "cachedWorldVelocity", "computingCount", "mass",
    "mass0", "massCache", "particleId", "particleId0", "idCache", "idMapping", "sortedId", "idIndex", "nextId",
    "nextId0", "birthTime", "birthTime0", "birthTimeCache", "age", "age0", "ageCache", "emission", "emitterId",
    "dieOnEmissionVolumeExit", "isFull", "newParticles", "collisionEvents", "death", "lifespanMode", "lifespanRandom",
    "finalLifespanPP", "generalSeed", "randState", "expressionsAfterDynamics", "executeCreationExpression",
    "executeRuntimeBeforeDynamicsExpression", "executeRuntimeAfterDynamicsExpression", "input", "output", "time",
    "frame", "internalRuntimeExpression", "internalRuntimeBeforeDynamicsExpression",
    "internalRuntimeAfterDynamicsExpression", "internalCreationExpression", "currentParticle", "diedLastTime",
    "netEmittedLastTime", "startEmittedIndex", "dynamicsWeight", "forcesInWorld", "conserve", "emissionInWorld",
    "maxCount", "levelOfDetail", "inheritFactor", "seed", "fieldDataPosition", "fieldDataVelocity", "fieldDataMass",
    "fieldDataDeltaTime", "emitterData", "emitterDataPosition", "emitterDataVelocity", "emitterDataDeltaTime",
    "currentTime", "currentTimeSave", "evaluationTime", "currentSceneTime", "lastTimeEvaluated", "lastSceneTime",
    "cachedTime", "sceneTimeStepSize", "startFrame", "inputGeometry", "inputGeometryPoints", "inputGeometrySpace",
    "enforceCountFromHistory", "targetGeometry", "targetGeometryWorldMatrix", "targetGeometrySpace", "goalSmoothness",
    "goalGeometry", "goalWeight", "goalActive", "goalUvSetName", "cacheData", "cacheWidth", "collisions",
    "traceDepth", "collisionData", "collisionGeometry", "collisionResilience", "collisionFriction", "collisionOffset",
    "collisionRecords", "totalEventCount", "eventTest", "lastTotalEventCount", "eventSeed", "eventRandState",
    "eventTarget", "eventName", "eventValid", "eventCount", "eventEmit", "eventSplit", "eventDie", "eventRandom",
    "eventSpread", "eventProc", "instanceData", "debugDraw", "numberOfEvents", "eventNameCount",
    "collisionConnections", "connectionsToMe", "auxiliariesOwned", "emitterConnections", "inheritColor",
    "shapeNameMsg", "doDynamics", "doEmission", "forceEmission", "doAge", "agesLastDone", "timeLastComputed",
    "parentMatrixDirty", "newFileFormat", "depthSort", "particleRenderType", "disableCloudAxis", "normalizeVelocity",
    "samplerPerParticleData", "ownerPPFieldData", "deformedPosition", "useCustomCache", "startVelocities", "damp",
    "dampMap", "dampPerVertex", "selfCollisionFlag", "maxSelfCollisionIterations", "maxIterations", "pointMass",
    "massMap", "massPerVertex", "restLengthScale", "localForce", "localWind", "selfCollide", "selfAttract",
    "dampMapType", "massMapType", "nextState",
];
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
