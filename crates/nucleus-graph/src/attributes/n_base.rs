//! What all objects of a nucleus share.

use std::borrow::Cow;

use super::key::{
    Plugged, choice, float, floats, int, node, plug, ramp, text, texture, toggle, vector, vectors,
};
use super::kind::Data;
use super::node_type::node_table;
use super::particle::PARTICLE;
use super::value::{Choice, RampPoint};

/// What a map is taken from.
pub(super) const MAP_TYPES: &[(i32, &str)] = &[(0, "None"), (1, "Per-vertex"), (2, "Texture")];

/// From 1 down to 0.
const FALLING: &[RampPoint] = &[
    RampPoint { position: 0.0, value: 1.0, interpolation: Choice(1) },
    RampPoint { position: 1.0, value: 0.0, interpolation: Choice(1) },
];

/// What objects made of a mesh have no use for: most of what the classic particles had.
#[rustfmt::skip] // a name per line would be a page of its own
pub(super) const NO_USE_TO_MESHES: &[&str] = &[
    "rampPosition", "lastPosition", "rampVelocity", "lastVelocity", "rampAcceleration", "lastWorldPosition",
    "worldVelocityInObjectSpace", "lastWorldVelocity", "acceleration0", "emitterId0", "useStartupCache",
    "startupCachePath", "startupCacheFrame", "cachedPosition", "lastCachedPosition", "cachedWorldPosition",
    "cachedWorldCentroid", "cachedVelocity", "cachedWorldVelocity", "computingCount", "mass0", "massCache",
    "particleId", "particleId0", "idCache", "idMapping", "sortedId", "idIndex", "nextId", "nextId0", "birthTime",
    "birthTime0", "birthTimeCache", "age", "age0", "ageCache", "emission", "emitterId",
    "dieOnEmissionVolumeExit", "isFull", "newParticles", "collisionEvents", "death", "lifespanMode",
    "lifespanRandom", "lifespan", "finalLifespanPP", "generalSeed", "randState", "expressionsAfterDynamics",
    "executeCreationExpression", "executeRuntimeBeforeDynamicsExpression",
    "executeRuntimeAfterDynamicsExpression", "input", "output", "time", "frame", "internalRuntimeExpression",
    "internalRuntimeBeforeDynamicsExpression", "internalRuntimeAfterDynamicsExpression",
    "internalCreationExpression", "currentParticle", "diedLastTime", "netEmittedLastTime", "startEmittedIndex",
    "dynamicsWeight", "forcesInWorld", "conserve", "emissionInWorld", "maxCount", "levelOfDetail",
    "inheritFactor", "seed", "fieldDataPosition", "fieldDataVelocity", "fieldDataMass", "fieldDataDeltaTime",
    "emitterData", "emitterDataPosition", "emitterDataVelocity", "emitterDataDeltaTime", "currentTime",
    "currentTimeSave", "evaluationTime", "currentSceneTime", "lastTimeEvaluated", "lastSceneTime", "cachedTime",
    "sceneTimeStepSize", "startFrame", "inputGeometry", "inputGeometryPoints", "inputGeometrySpace",
    "enforceCountFromHistory", "targetGeometry", "targetGeometryWorldMatrix", "targetGeometrySpace",
    "goalSmoothness", "goalGeometry", "goalWeight", "goalActive", "goalUvSetName", "cacheData", "cacheWidth",
    "collisions", "traceDepth", "collisionData", "collisionGeometry", "collisionResilience", "collisionFriction",
    "collisionOffset", "collisionRecords", "totalEventCount", "eventTest", "lastTotalEventCount", "eventSeed",
    "eventRandState", "eventTarget", "eventName", "eventValid", "eventCount", "eventEmit", "eventSplit",
    "eventDie", "eventRandom", "eventSpread", "eventProc", "instanceData", "debugDraw", "numberOfEvents",
    "eventNameCount", "collisionConnections", "connectionsToMe", "auxiliariesOwned", "emitterConnections",
    "inheritColor", "shapeNameMsg", "doDynamics", "doEmission", "forceEmission", "doAge", "agesLastDone",
    "timeLastComputed", "parentMatrixDirty", "newFileFormat", "depthSort", "particleRenderType",
    "disableCloudAxis", "normalizeVelocity", "samplerPerParticleData", "ownerPPFieldData", "deformedPosition",
    "useCustomCache",
];

node_table! {
    /// What every object of a nucleus has: mass, thickness, collisions, fields.
    N_BASE = "nBase", inherits Some(&PARTICLE), hides [];
    "General" {
        /// The mesh node that it is made from.
        INPUT_MESH: Plugged = node("inputMesh", "imsh", Some(Data::Mesh)).solved("nucleus_graph::graph");
    }
    "Collisions" {
        /// How far the surface reaches out; two objects touch at the sum of theirs. Worked out from the size of the mesh when left out.
        THICKNESS: f64 = float("thickness", "thss", 0.1).min(0.0).soft(0.0, 1.0).unit("scene units").solved("nucleus_core::contact::material");
        /// How much speed is kept in a contact; the larger of the two sides counts.
        BOUNCE: f64 = float("bounce", "boce", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::restitution");
        /// Resistance to sliding; the values of both sides are added.
        FRICTION: f64 = float("friction", "fron", 0.1).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::response");
        /// Resistance to coming apart after a contact; the values of both sides are added, and at 1 they never part. With a friction of 1 they do not slide either.
        STICKINESS: f64 = float("stickiness", "stck", 0.0).soft(0.0, 2.0).solved("nucleus_core::contact::response");
        /// How much of a collision is carried out; the values of both sides are multiplied. 1 and above: all, nothing passes. Below 1 things may pass through each other; at 0 there is no collision.
        COLLIDE_STRENGTH: f64 = float("collideStrength", "clst", 1.0).soft(0.0, 1.0).solved("nucleus_core::contact::material");
        /// Up to which elements it collides: points, edges or faces.
        COLLISION_FLAG: Choice = choice("collisionFlag", "cofl", 3, &[(1, "Vertex"), (2, "Edge"), (3, "Face")]).solved("nucleus_graph::compile::thickness");
        /// Which elements collide when the object meets itself. Left out, it is the full surface, through which nothing passes; in Classic, what Maya sets when it makes the cloth.
        SELF_COLLISION_FLAG: Choice = choice("selfCollisionFlag", "scfl", 1, &[(1, "Vertex"), (2, "VertexEdge"), (3, "VertexFace"), (4, "Full Surface")]).solved("nucleus_graph::compile::thickness");
        /// Takes part in collisions with other objects.
        COLLIDE: bool = toggle("collide", "cold", true).solved("nucleus_core::contact::material");
        /// Takes part in collisions with itself.
        SELF_COLLIDE: bool = toggle("selfCollide", "scld", true).solved("nucleus_graph::compile::thickness");
        /// Which objects it meets, and which of the two gives way.
        COLLISION_LAYER: f64 = float("collisionLayer", "cll", 0.0).soft(0.0, 10.0).solved("nucleus_core::contact::material");
        /// Colour in which Maya draws the thickness.
        DISPLAY_COLOR: [f64; 3] = vector("displayColor", "dcl", [1.0, 0.8, 0.0], ["dcr", "dcg", "dcb"]).elsewhere("only Maya's viewport draws it");
    }
    "Dynamic Properties" {
        /// Evens out the velocities of linked points: vibrations die down, free fall is untouched.
        DAMP: f64 = float("damp", "adng", 0.0).min(0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::damp");
        /// Classic: kilograms of every point. Physical: kilograms per square metre, so that the mesh does not matter.
        POINT_MASS: f64 = float("pointMass", "pmss", 1.0).min(0.0).soft(0.001, 10.0).unit("kg, or kg/m²").solved("nucleus_graph::compile").fixed();
        /// Factor on the rest length of every link.
        REST_LENGTH_SCALE: f64 = float("restLengthScale", "rlsc", 1.0).min(0.0).soft(0.0, 2.0).solved("nucleus_core::constraints::stretch");
        /// A force on every point of this object alone.
        LOCAL_FORCE: [f64; 3] = vector("localForce", "lfcr", [0.0, 0.0, 0.0], ["lfcx", "lfcy", "lfcz"]).unit("N").solved("nucleus_core::integrate::predict");
        /// Wind that only this object feels, added to the solver's.
        LOCAL_WIND: [f64; 3] = vector("localWind", "lwnr", [0.0, 0.0, 0.0], ["lwnx", "lwny", "lwnz"]).unit("m/s").solved("nucleus_core::integrate::aerodynamics");
    }
    "Wind Field Generation" {
        /// How much wind gets in behind this object: the tangent of the angle from which it comes.
        WIND_SHADOW_DIFFUSION: f64 = float("windShadowDiffusion", "wsdi", 0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::wind_shadow");
        /// How far behind its surface this object keeps the solver's wind from others: all of it close by, none at this distance.
        WIND_SHADOW_DISTANCE: f64 = float("windShadowDistance", "wsds", 0.0).soft(0.0, 50.0).unit("scene units").solved("nucleus_core::integrate::wind_shadow");
        /// How far from its surface the air that this object moves is felt by others. At rest it slows the wind.
        AIR_PUSH_DISTANCE: f64 = float("airPushDistance", "apds", 0.0).soft(0.0, 50.0).unit("scene units").solved("nucleus_core::integrate::air_push");
        /// How much of the air that it pushes flows back at its sides.
        AIR_PUSH_VORTICITY: f64 = float("airPushVorticity", "apvy", 0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::air_push");
    }
    "Force Field Generation" {
        /// A force field on the surface: along its normals, away from it on the side of its normals, or on both sides.
        FORCE_FIELD: Choice = choice("forceField", "ffd", 0, &[(0, "Off"), (1, "AlongNormal"), (2, "Single Sided"), (3, "Double Sided")]).solved("nucleus_core::contact::force_field");
        /// Strength of the field at the surface, 1 is an acceleration of 10 m/s²: above 0 it pushes others away.
        FIELD_MAGNITUDE: f64 = float("fieldMagnitude", "fma", 1.0).soft(-10.0, 10.0).solved("nucleus_core::contact::force_field");
        /// How far the surface's field reaches.
        FIELD_DISTANCE: f64 = float("fieldDistance", "fdi", 1.0).min(0.0).soft(0.0, 100.0).solved("nucleus_core::contact::force_field");
        /// The surface's field from the surface (0) to its reach (1).
        FIELD_SCALE: Cow<'static, [RampPoint]> = ramp("fieldScale", "fsc", FALLING).solved("nucleus_core::contact::force_field");
        /// A force field round every point. Its strength and reach are in m/s² and scene units, or both times the thickness.
        POINT_FORCE_FIELD: Choice = choice("pointForceField", "pff", 0, &[(0, "Off"), (1, "ThicknessRelative"), (2, "Worldspace")]).solved("nucleus_core::contact::point_field");
        /// Strength of the points' field on others, 1 is an acceleration of 10 m/s²: above 0 it pushes them away. The fields of several points add up.
        POINT_FIELD_MAGNITUDE: f64 = float("pointFieldMagnitude", "pfma", 1.0).soft(-10.0, 10.0).solved("nucleus_core::contact::point_field");
        /// Strength of the points' field within the object: above 0 it pulls together.
        SELF_ATTRACT: f64 = float("selfAttract", "sfat", 0.0).soft(-10.0, 10.0).solved("nucleus_core::contact::point_field");
        /// How far the points' field reaches beyond the thickness.
        POINT_FIELD_DISTANCE: f64 = float("pointFieldDistance", "pfdi", 2.0).min(0.0).soft(0.0, 100.0).unit("scene units").solved("nucleus_core::contact::point_field");
        /// The points' field from the thickness (0) to its reach (1).
        POINT_FIELD_DROPOFF: Cow<'static, [RampPoint]> = ramp("pointFieldDropoff", "pfdo", FALLING).solved("nucleus_core::contact::point_field");
    }
    "Quality Settings" {
        /// Passes for collisions with itself in 1/24 s.
        MAX_SELF_COLLISION_ITERATIONS: i64 = int("maxSelfCollisionIterations", "msci", 4).soft(0.0, 100.0).unit("per 1/24 s").solved("nucleus_core::schedule");
        /// Classic: no resistance is given more iterations in 1/24 s than this.
        MAX_ITERATIONS: i64 = int("maxIterations", "mxit", 10000).soft(0.0, 20000.0).solved("nucleus_graph::compile::soft_body");
        /// Share of the way by which points of other objects go, in a substep, to the outer side of the surface; below 0 to the inner. For scenes that start with one object in another.
        PUSH_OUT: f64 = float("pushOut", "pou", 0.0).soft(-1.0, 1.0).solved("nucleus_core::contact::depenetration");
        /// Points farther from the surface than this are not pushed out. Left out, it is four times the thickness.
        PUSH_OUT_RADIUS: f64 = float("pushOutRadius", "por", 10.0).min(0.0).soft(0.0, 100.0).unit("scene units").solved("nucleus_core::contact::depenetration");
        /// How much faster cloths are worked apart where they pass through each other: 0 half an edge length in 1/24 s, 1 ten times that. The values of both sides are added.
        CROSSOVER_PUSH: f64 = float("crossoverPush", "cop", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::cloth::untangling");
        /// Brings points that got to the wrong side back. The solver always does so for cloth, whatever is set here.
        TRAPPED_CHECK: bool = toggle("trappedCheck", "tpc", false).solved("nucleus_core::contact::cloth::untangling");
    }
    "Initial State" {
        /// Initial positions in world space, in place of those of the input mesh; how the cloth is at rest is still the mesh's to say.
        START_POSITIONS: Vec<[f64; 3]> = vectors("startPositions", "spns").unit("scene units").solved("nucleus_graph::compile");
        /// Initial velocities in world space.
        START_VELOCITIES: Vec<[f64; 3]> = vectors("startVelocities", "sves").unit("scene units/s").solved("nucleus_graph::compile");
    }
    "Caching" {
        /// Positions that come from a cache.
        POSITIONS: Plugged = plug("positions", "poss", Data::Vectors);
        /// Velocities that come from a cache.
        VELOCITIES: Plugged = plug("velocities", "vels", Data::Vectors);
        /// Solver state that comes from a cache.
        INTERNAL_STATE: Plugged = plug("internalState", "inst", Data::Bundle);
        /// Takes the state from a cache instead of solving.
        PLAY_FROM_CACHE: bool = toggle("playFromCache", "pfc", false);
        /// Everything that comes from a cache of particles.
        CACHE_ARRAY_DATA: Plugged = plug("cacheArrayData", "chad", Data::Bundle);
    }
    "Collision Properties Maps" {
        /// Texture that varies thickness.
        THICKNESS_MAP: f64 = texture("thicknessMap", "thmp", 0.1).solved("nucleus_core::model::vertex_maps");
        /// Factor on thickness at each point.
        THICKNESS_PER_VERTEX: Vec<f64> = floats("thicknessPerVertex", "thpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies bounce.
        BOUNCE_MAP: f64 = texture("bounceMap", "bomp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on bounce at each point.
        BOUNCE_PER_VERTEX: Vec<f64> = floats("bouncePerVertex", "bpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies friction.
        FRICTION_MAP: f64 = texture("frictionMap", "frmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on friction at each point.
        FRICTION_PER_VERTEX: Vec<f64> = floats("frictionPerVertex", "fpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies stickiness.
        STICKINESS_MAP: f64 = texture("stickinessMap", "skmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on stickiness at each point.
        STICKINESS_PER_VERTEX: Vec<f64> = floats("stickinessPerVertex", "skpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies collide strength.
        COLLIDE_STRENGTH_MAP: f64 = texture("collideStrengthMap", "csmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on collide strength at each point.
        COLLIDE_STRENGTH_PER_VERTEX: Vec<f64> = floats("collideStrengthPerVertex", "cspv").solved("nucleus_core::model::vertex_maps");
        /// Whether thickness is varied by nothing, by point, or by a texture.
        THICKNESS_MAP_TYPE: Choice = choice("thicknessMapType", "tmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether bounce is varied by nothing, by point, or by a texture.
        BOUNCE_MAP_TYPE: Choice = choice("bounceMapType", "bmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether friction is varied by nothing, by point, or by a texture.
        FRICTION_MAP_TYPE: Choice = choice("frictionMapType", "fmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether stickiness is varied by nothing, by point, or by a texture.
        STICKINESS_MAP_TYPE: Choice = choice("stickinessMapType", "skmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether collide strength is varied by nothing, by point, or by a texture.
        COLLIDE_STRENGTH_MAP_TYPE: Choice = choice("collideStrengthMapType", "csmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
    }
    "Dynamic Properties Maps" {
        /// Texture that varies damp.
        DAMP_MAP: f64 = texture("dampMap", "admp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on damp at each point.
        DAMP_PER_VERTEX: Vec<f64> = floats("dampPerVertex", "dpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies mass.
        MASS_MAP: f64 = texture("massMap", "mamp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on mass at each point.
        MASS_PER_VERTEX: Vec<f64> = floats("massPerVertex", "mpv").solved("nucleus_core::model::vertex_maps");
        /// Whether damp is varied by nothing, by point, or by a texture.
        DAMP_MAP_TYPE: Choice = choice("dampMapType", "dmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether mass is varied by nothing, by point, or by a texture.
        MASS_MAP_TYPE: Choice = choice("massMapType", "mmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
    }
    "Force Field Maps" {
        /// Texture that varies field magnitude.
        FIELD_MAGNITUDE_MAP: f64 = texture("fieldMagnitudeMap", "fmmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on field magnitude at each point.
        FIELD_MAGNITUDE_PER_VERTEX: Vec<f64> = floats("fieldMagnitudePerVertex", "fmpv").solved("nucleus_core::model::vertex_maps");
        /// Whether field magnitude is varied by nothing, by point, or by a texture.
        FIELD_MAGNITUDE_MAP_TYPE: Choice = choice("fieldMagnitudeMapType", "fmmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
    }
    "Nucleus (open)" {
        /// A material to take values from: one of `nucleus presets`, or a file of your own, `"mine.ron"`. What is set here counts more.
        PRESET: String = text("preset", "preset").solved("nucleus_graph::graph").extension();
        /// The nucleus it belongs to; the only one of the scene when left out.
        NUCLEUS: Plugged = node("nucleus", "nucleus", None).solved("nucleus_graph::graph").extension();
    }
    "Connections" {
        /// Its state as its nucleus has solved it.
        NEXT_STATE: Plugged = plug("nextState", "nxst", Data::State).sink();
        /// Its state as its nucleus is to see it.
        CURRENT_STATE: Plugged = plug("currentState", "cust", Data::State).output();
        /// Its initial state.
        START_STATE: Plugged = plug("startState", "stst", Data::State).output();
        /// Which object of its nucleus it is.
        NUCLEUS_ID: Plugged = plug("nucleusId", "nuid", Data::ObjectId).output();
    }
    "Internal" {
        /// Solved, as cloth and particles are; off for colliders. Set when the node is created.
        ACTIVE: bool = toggle("active", "actv", true).hidden();
        /// Time of the evaluation before.
        LAST_N_BASE_TIME: f64 = float("lastNBaseTime", "lnbt", 0.0).hidden();
        /// Gives positions in the space of its own transform.
        LOCAL_SPACE_OUTPUT: bool = toggle("localSpaceOutput", "lsou", false).hidden();
    }
}
