//! What all objects of a nucleus share.

use std::borrow::Cow;

use nucleus_core::ClothFrame;

use super::key::{
    Plugged, choice, float, floats, int, node, plug, ramp, text, texture, toggle, vector, vectors,
};
use super::kind::Data;
use super::node_type::node_table;
use super::particle::PARTICLE;
use super::value::{Choice, RampPoint};

/// Sources of a map.
pub(super) const MAP_TYPES: &[(i32, &str)] = &[(0, "None"), (1, "Per-vertex"), (2, "Texture")];

/// From 1 down to 0.
const FALLING: &[RampPoint] = &[
    RampPoint { position: 0.0, value: 1.0, interpolation: Choice(1) },
    RampPoint { position: 1.0, value: 0.0, interpolation: Choice(1) },
];

/// Attributes without effect on objects that are made from a mesh: most of those of classic particles.
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
    /// Attributes shared by all objects of a nucleus: mass, thickness, collisions, fields.
    N_BASE = "nBase", inherits Some(&PARTICLE), hides [];
    "General" {
        /// Name of the mesh node that the object is made from.
        INPUT_MESH: Plugged = node("inputMesh", "imsh", Some(Data::Mesh)).solved("nucleus_graph::graph");
    }
    "Collisions" {
        /// Thickness of each side of the surface. Two objects touch at the sum of theirs. Default: computed from the size of the mesh.
        THICKNESS: f64 = float("thickness", "thss", 0.1).min(0.0).soft(0.0, 1.0).unit("scene units").solved("nucleus_core::contact::material");
        /// Share of the normal speed that a contact returns. The larger value of the two sides counts, and at most 1.
        BOUNCE: f64 = float("bounce", "boce", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::restitution");
        /// Coefficient of friction. The values of both sides are added.
        FRICTION: f64 = float("friction", "fron", ClothFrame::DEFAULT.friction).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::response");
        /// Resistance to separation after a contact. The values of both sides are added; at 1 they never separate, and with a friction of 1 they do not slide either.
        STICKINESS: f64 = float("stickiness", "stck", 0.0).soft(0.0, 2.0).solved("nucleus_core::contact::response");
        /// Strength of contacts. The values of both sides are multiplied. From 1 on nothing passes through; below 1 objects may pass through each other; at 0 there is no contact.
        COLLIDE_STRENGTH: f64 = float("collideStrength", "clst", 1.0).soft(0.0, 1.0).solved("nucleus_core::contact::material");
        /// Elements that collide with other objects: points; points and edges; points, edges and faces. Unless both sides collide by faces, they may pass through each other; particles collide with the faces of a collider at any value.
        COLLISION_FLAG: Choice = choice("collisionFlag", "cofl", 3, &[(1, "Vertex"), (2, "Edge"), (3, "Face")]).solved("nucleus_graph::compile::thickness");
        /// Elements that collide in self-collision. Default: the full surface, which nothing passes through; in Classic, the value that Maya sets at creation.
        SELF_COLLISION_FLAG: Choice = choice("selfCollisionFlag", "scfl", 1, &[(1, "Vertex"), (2, "VertexEdge"), (3, "VertexFace"), (4, "Full Surface")]).solved("nucleus_graph::compile::thickness");
        /// Enables collisions with other objects.
        COLLIDE: bool = toggle("collide", "cold", true).solved("nucleus_core::contact::material");
        /// Enables self-collision. A liquid collides with itself only where it is given.
        SELF_COLLIDE: bool = toggle("selfCollide", "scld", true).solved("nucleus_graph::compile::thickness");
        /// Objects whose layers differ by less than `collisionLayerRange` collide. In a contact, the object in the lower layer is the heavier one, unless a constraint joins the two. A collider acts on objects of its own layer and of higher ones.
        COLLISION_LAYER: f64 = float("collisionLayer", "cll", 0.0).soft(0.0, 10.0).solved("nucleus_core::contact::material");
        /// Colour of the thickness in Maya's viewport.
        DISPLAY_COLOR: [f64; 3] = vector("displayColor", "dcl", [1.0, 0.8, 0.0], ["dcr", "dcg", "dcb"]).elsewhere("only Maya's viewport draws it");
    }
    "Dynamic Properties" {
        /// Averages the velocities of linked points: vibrations decay, free fall is unaffected.
        DAMP: f64 = float("damp", "adng", 0.0).min(0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::damp");
        /// Classic: mass of each point, in kg. Physical: mass per area, in kg/m², independent of the mesh.
        POINT_MASS: f64 = float("pointMass", "pmss", 1.0).min(0.0).soft(0.001, 10.0).unit("kg, or kg/m²").solved("nucleus_graph::compile").fixed();
        /// Factor on the rest length of every link.
        REST_LENGTH_SCALE: f64 = float("restLengthScale", "rlsc", ClothFrame::DEFAULT.rest_length_scale).min(0.0).soft(0.0, 2.0).solved("nucleus_core::constraints::stretch");
        /// Force on each point of this object, in both resistance models: on a mesh of more points it is larger in total.
        LOCAL_FORCE: [f64; 3] = vector("localForce", "lfcr", [0.0, 0.0, 0.0], ["lfcx", "lfcy", "lfcz"]).unit("N").solved("nucleus_core::integrate::predict");
        /// Wind on this object only, added to the solver's wind.
        LOCAL_WIND: [f64; 3] = vector("localWind", "lwnr", [0.0, 0.0, 0.0], ["lwnx", "lwny", "lwnz"]).unit("m/s").solved("nucleus_core::integrate::aerodynamics");
    }
    "Wind Field Generation" {
        /// Diffusion of the wind into the shadow of this object: the tangent of the angle by which the shadow narrows.
        WIND_SHADOW_DIFFUSION: f64 = float("windShadowDiffusion", "wsdi", 0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::wind_shadow");
        /// Length of the wind shadow behind the surface. The solver's wind is blocked entirely at the surface and not at all at this distance.
        WIND_SHADOW_DISTANCE: f64 = float("windShadowDistance", "wsds", 0.0).soft(0.0, 50.0).unit("scene units").solved("nucleus_core::integrate::wind_shadow");
        /// Distance from the surface up to which the air moved by this object acts on others. An object at rest slows the wind.
        AIR_PUSH_DISTANCE: f64 = float("airPushDistance", "apds", 0.0).soft(0.0, 50.0).unit("scene units").solved("nucleus_core::integrate::air_push");
        /// Share of the pushed air that flows back at the sides.
        AIR_PUSH_VORTICITY: f64 = float("airPushVorticity", "apvy", 0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::air_push");
    }
    "Force Field Generation" {
        /// A force field on the surface: along its normals, away from it on the side of its normals, or on both sides.
        FORCE_FIELD: Choice = choice("forceField", "ffd", 0, &[(0, "Off"), (1, "AlongNormal"), (2, "Single Sided"), (3, "Double Sided")]).solved("nucleus_core::contact::force_field");
        /// Strength of the field at the surface; 1 is an acceleration of 10 m/s². Above 0 it repels.
        FIELD_MAGNITUDE: f64 = float("fieldMagnitude", "fma", 1.0).soft(-10.0, 10.0).solved("nucleus_core::contact::force_field");
        /// Range of the surface field.
        FIELD_DISTANCE: f64 = float("fieldDistance", "fdi", 1.0).min(0.0).soft(0.0, 100.0).solved("nucleus_core::contact::force_field");
        /// Falloff of the surface field, from the surface (0) to its range (1).
        FIELD_SCALE: Cow<'static, [RampPoint]> = ramp("fieldScale", "fsc", FALLING).solved("nucleus_core::contact::force_field");
        /// A force field around each point. Strength and range are in m/s² and scene units, or the strength is multiplied by the thickness in metres, and the range by that in scene units.
        POINT_FORCE_FIELD: Choice = choice("pointForceField", "pff", 0, &[(0, "Off"), (1, "ThicknessRelative"), (2, "Worldspace")]).solved("nucleus_core::contact::point_field");
        /// Strength of the point field on other objects; 1 is an acceleration of 10 m/s². Above 0 it repels. The fields of several points add up.
        POINT_FIELD_MAGNITUDE: f64 = float("pointFieldMagnitude", "pfma", 1.0).soft(-10.0, 10.0).solved("nucleus_core::contact::point_field");
        /// Strength of the point field on points of the same object. Above 0 it attracts.
        SELF_ATTRACT: f64 = float("selfAttract", "sfat", 0.0).soft(-10.0, 10.0).solved("nucleus_core::contact::point_field");
        /// Range of the point field beyond the thickness.
        POINT_FIELD_DISTANCE: f64 = float("pointFieldDistance", "pfdi", 2.0).min(0.0).soft(0.0, 100.0).unit("scene units").solved("nucleus_core::contact::point_field");
        /// Falloff of the point field, from the thickness (0) to its range (1).
        POINT_FIELD_DROPOFF: Cow<'static, [RampPoint]> = ramp("pointFieldDropoff", "pfdo", FALLING).solved("nucleus_core::contact::point_field");
    }
    "Quality Settings" {
        /// Passes of self-collision in 1/24 s.
        MAX_SELF_COLLISION_ITERATIONS: i64 = int("maxSelfCollisionIterations", "msci", 4).soft(0.0, 100.0).unit("per 1/24 s").solved("nucleus_core::schedule");
        /// Classic: upper limit of the iterations of each resistance in 1/24 s.
        MAX_ITERATIONS: i64 = int("maxIterations", "mxit", 10000).soft(0.0, 20000.0).solved("nucleus_graph::compile::soft_body");
        /// Share of the distance by which points of other objects move, in a substep, to the outer side of the surface; below 0, to the inner side. For scenes that start with one object inside another.
        PUSH_OUT: f64 = float("pushOut", "pou", 0.0).soft(-1.0, 1.0).solved("nucleus_core::contact::push_out");
        /// Largest distance from the surface at which points are pushed out. Default: four times the thickness.
        PUSH_OUT_RADIUS: f64 = float("pushOutRadius", "por", 10.0).min(0.0).soft(0.0, 100.0).unit("scene units").solved("nucleus_core::contact::push_out");
        /// Additional speed of untangling where cloths intersect: 0 is half an edge length in 1/24 s, 1 is ten times that. The values of both sides are added.
        CROSSOVER_PUSH: f64 = float("crossoverPush", "cop", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::cloth::untangling");
        /// Returns points that are on the wrong side. For cloth the solver does so at any value.
        TRAPPED_CHECK: bool = toggle("trappedCheck", "tpc", false).solved("nucleus_core::contact::cloth::untangling");
    }
    "Initial State" {
        /// Initial positions in world space, in place of those of the input mesh. The rest shape remains that of the mesh.
        START_POSITIONS: Vec<[f64; 3]> = vectors("startPositions", "spns").unit("scene units").solved("nucleus_graph::compile");
        /// Initial velocities in world space: one for each point, or one for all.
        START_VELOCITIES: Vec<[f64; 3]> = vectors("startVelocities", "sves").unit("scene units/s").solved("nucleus_graph::compile");
    }
    "Caching" {
        /// Positions from a cache.
        POSITIONS: Plugged = plug("positions", "poss", Data::Vectors).elsewhere("a cache is a file of its own: `nucleus run --from` starts from one of its frames");
        /// Velocities from a cache.
        VELOCITIES: Plugged = plug("velocities", "vels", Data::Vectors).elsewhere("a cache is a file of its own: `nucleus run --from` starts from one of its frames");
        /// Solver state from a cache.
        INTERNAL_STATE: Plugged = plug("internalState", "inst", Data::Bundle).elsewhere("a cache is a file of its own: `nucleus run --from` starts from one of its frames");
        /// Plays recorded positions, those of `cacheFile`, instead of solving. Others collide with the object; nothing pushes it.
        PLAY_FROM_CACHE: bool = toggle("playFromCache", "pfc", false).solved("nucleus_graph::compile::recorded");
        /// The recorded positions in world space: an OBJ file, or a file of numbers, for each frame, `points/cloth.####.obj`. Maya has a `cacheFile` node for it.
        CACHE_FILE: String = text("cacheFile", "cacheFile").unit("scene units").solved("nucleus_graph::compile::recorded").extension();
        /// All data from a particle cache.
        CACHE_ARRAY_DATA: Plugged = plug("cacheArrayData", "chad", Data::Bundle).elsewhere("a cache is a file of its own: `nucleus run --from` starts from one of its frames");
    }
    "Collision Properties Maps" {
        /// Texture of the map of thickness.
        THICKNESS_MAP: f64 = texture("thicknessMap", "thmp", 0.1).solved("nucleus_core::model::vertex_maps");
        /// Factor on thickness, per point.
        THICKNESS_PER_VERTEX: Vec<f64> = floats("thicknessPerVertex", "thpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of bounce.
        BOUNCE_MAP: f64 = texture("bounceMap", "bomp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on bounce, per point.
        BOUNCE_PER_VERTEX: Vec<f64> = floats("bouncePerVertex", "bpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of friction.
        FRICTION_MAP: f64 = texture("frictionMap", "frmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on friction, per point.
        FRICTION_PER_VERTEX: Vec<f64> = floats("frictionPerVertex", "fpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of stickiness.
        STICKINESS_MAP: f64 = texture("stickinessMap", "skmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on stickiness, per point.
        STICKINESS_PER_VERTEX: Vec<f64> = floats("stickinessPerVertex", "skpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of collide strength.
        COLLIDE_STRENGTH_MAP: f64 = texture("collideStrengthMap", "csmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on collide strength, per point.
        COLLIDE_STRENGTH_PER_VERTEX: Vec<f64> = floats("collideStrengthPerVertex", "cspv").solved("nucleus_core::model::vertex_maps");
        /// Source of the map of thickness: none, a value per point, or a texture. Default: what is given.
        THICKNESS_MAP_TYPE: Choice = choice("thicknessMapType", "tmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of bounce: none, a value per point, or a texture. Default: what is given.
        BOUNCE_MAP_TYPE: Choice = choice("bounceMapType", "bmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of friction: none, a value per point, or a texture. Default: what is given.
        FRICTION_MAP_TYPE: Choice = choice("frictionMapType", "fmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of stickiness: none, a value per point, or a texture. Default: what is given.
        STICKINESS_MAP_TYPE: Choice = choice("stickinessMapType", "skmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of collide strength: none, a value per point, or a texture. Default: what is given.
        COLLIDE_STRENGTH_MAP_TYPE: Choice = choice("collideStrengthMapType", "csmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
    }
    "Dynamic Properties Maps" {
        /// Texture of the map of damp.
        DAMP_MAP: f64 = texture("dampMap", "admp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on damp, per point.
        DAMP_PER_VERTEX: Vec<f64> = floats("dampPerVertex", "dpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of mass.
        MASS_MAP: f64 = texture("massMap", "mamp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on mass, per point.
        MASS_PER_VERTEX: Vec<f64> = floats("massPerVertex", "mpv").solved("nucleus_core::model::vertex_maps");
        /// Source of the map of damp: none, a value per point, or a texture. Default: what is given.
        DAMP_MAP_TYPE: Choice = choice("dampMapType", "dmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of mass: none, a value per point, or a texture. Default: what is given.
        MASS_MAP_TYPE: Choice = choice("massMapType", "mmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
    }
    "Force Field Maps" {
        /// Texture of the map of field magnitude.
        FIELD_MAGNITUDE_MAP: f64 = texture("fieldMagnitudeMap", "fmmp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on field magnitude, per point.
        FIELD_MAGNITUDE_PER_VERTEX: Vec<f64> = floats("fieldMagnitudePerVertex", "fmpv").solved("nucleus_core::model::vertex_maps");
        /// Source of the map of field magnitude: none, a value per point, or a texture. Default: what is given.
        FIELD_MAGNITUDE_MAP_TYPE: Choice = choice("fieldMagnitudeMapType", "fmmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
    }
    "Nucleus (open)" {
        /// A material preset: one of `nucleus presets`, or a file, `"mine.ron"`. Attributes set on the node take precedence.
        PRESET: String = text("preset", "preset").solved("nucleus_graph::graph").extension();
        /// Its nucleus. Default: the only one of the scene.
        NUCLEUS: Plugged = node("nucleus", "nucleus", None).solved("nucleus_graph::graph").extension();
    }
    "Connections" {
        /// Its solved state.
        NEXT_STATE: Plugged = plug("nextState", "nxst", Data::State).sink().solved("nucleus_graph::graph");
        /// Its current state.
        CURRENT_STATE: Plugged = plug("currentState", "cust", Data::State).output().solved("nucleus_graph::graph");
        /// Its initial state.
        START_STATE: Plugged = plug("startState", "stst", Data::State).output().solved("nucleus_graph::graph");
        /// Its index in its nucleus.
        NUCLEUS_ID: Plugged = plug("nucleusId", "nuid", Data::ObjectId).output().solved("nucleus_graph::graph");
    }
    "Internal" {
        /// Whether the object is solved (cloth, particles) or animated (colliders). Set when the node is created.
        ACTIVE: bool = toggle("active", "actv", true).hidden().elsewhere("the type of a node says whether it is solved");
        /// Time of the previous evaluation.
        LAST_N_BASE_TIME: f64 = float("lastNBaseTime", "lnbt", 0.0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Outputs positions in the space of its own transform.
        LOCAL_SPACE_OUTPUT: bool = toggle("localSpaceOutput", "lsou", false).hidden().elsewhere("positions are always in world space");
    }
}
