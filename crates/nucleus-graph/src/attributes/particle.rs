//! Attributes that all dynamic objects inherit from Maya's classic particles.

use super::key::{Plugged, choice, float, floats, int, ints, plug, text, toggle, vector, vectors};
use super::kind::Data;
use super::node_type::node_table;
use super::value::Choice;

node_table! {
    /// Maya's classic particle shape, the ancestor of all objects of a nucleus.
    PARTICLE = "particle", inherits None, hides [];
    "General" {
        /// Number of particles.
        COUNT: i64 = int("count", "cnt", 0).output().elsewhere("the cache of a run holds it for every frame");
        /// Includes the object in the simulation; Enable in Maya's attribute editor. Cloth that is not included follows its input mesh.
        IS_DYNAMIC: bool = toggle("isDynamic", "isd", true).solved("nucleus_graph::compile::soft_body");
    }
    "Time Attributes" {
        /// Time of the evaluation; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0);
        /// Frame of the initial state; driven by the nucleus.
        START_FRAME: f64 = float("startFrame", "stf", 1.0);
    }
    "Dynamic Properties" {
        /// Factor on the forces of fields.
        DYNAMICS_WEIGHT: f64 = float("dynamicsWeight", "dw", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::fields");
        /// Evaluates fields in world space.
        FORCES_IN_WORLD: bool = toggle("forcesInWorld", "fiw", true);
        /// Share of the velocity that is kept from frame to frame.
        CONSERVE: f64 = float("conserve", "con", 1.0).min(0.0).max(1.0);
    }
    "Per Particle (Array) Attributes" {
        /// Positions of the particles.
        POSITION: Vec<[f64; 3]> = vectors("position", "pos").elsewhere("the cache of a run holds it for every frame");
        /// Velocities of the particles.
        VELOCITY: Vec<[f64; 3]> = vectors("velocity", "vel").elsewhere("the cache of a run holds it for every frame");
        /// Accelerations of the particles.
        ACCELERATION: Vec<[f64; 3]> = vectors("acceleration", "acc").elsewhere("the cache of a run holds it for every frame");
        /// Positions of the particles in world space.
        WORLD_POSITION: Vec<[f64; 3]> = vectors("worldPosition", "wps").output().elsewhere("the cache of a run holds it for every frame");
        /// Velocities of the particles in world space.
        WORLD_VELOCITY: Vec<[f64; 3]> = vectors("worldVelocity", "wvl").output().elsewhere("the cache of a run holds it for every frame");
        /// Mass of each particle.
        MASS: Vec<f64> = floats("mass", "mas").elsewhere("`pointMass` and its map give the masses of cloth");
        /// Identifier of each particle.
        PARTICLE_ID: Vec<f64> = floats("particleId", "id").output();
        /// Time of birth of each particle.
        BIRTH_TIME: Vec<f64> = floats("birthTime", "bt").output();
        /// Age of each particle.
        AGE: Vec<f64> = floats("age", "ag").output();
    }
    "Emission Attributes" {
        /// Particles die when they leave the volume that they were emitted from.
        DIE_ON_EMISSION_VOLUME_EXIT: bool = toggle("dieOnEmissionVolumeExit", "dve", false);
        /// Emits in world space.
        EMISSION_IN_WORLD: bool = toggle("emissionInWorld", "eiw", true);
        /// Largest number of particles; -1 for no limit.
        MAX_COUNT: i64 = int("maxCount", "mxc", -1).solved("nucleus_graph::compile::emission");
        /// Share of the particles that are emitted.
        LEVEL_OF_DETAIL: f64 = float("levelOfDetail", "lod", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::emission");
        /// Share of the emitter's velocity that particles inherit.
        INHERIT_FACTOR: f64 = float("inheritFactor", "inh", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_graph::compile::emission");
        /// Seed of random emission.
        SEED: i64 = int("seed", "sd", 1).multi().solved("nucleus_graph::compile::emission");
    }
    "Lifespan" {
        /// Source of the lifespans: forever, constant, or random.
        LIFESPAN_MODE: Choice = choice("lifespanMode", "lfm", 0, &[(0, "Live forever"), (1, "Constant"), (2, "Random range"), (3, "lifespanPP only")]).solved("nucleus_graph::compile::emission");
        /// Range of random lifespans.
        LIFESPAN_RANDOM: f64 = float("lifespanRandom", "lfr", 0.0).unit("s").solved("nucleus_graph::compile::emission");
        /// Lifespan of the particles: constant, or the mean of random ones. Maya adds the attribute when it creates particles.
        LIFESPAN: f64 = float("lifespan", "lifespan", 1.0).min(0.0).unit("s").solved("nucleus_graph::compile::emission").extension();
        /// Lifespan of each particle.
        FINAL_LIFESPAN_PP: Vec<f64> = floats("finalLifespanPP", "flp").output();
        /// Seed of random lifespans.
        GENERAL_SEED: i64 = int("generalSeed", "gsd", 0).solved("nucleus_graph::compile::emission");
    }
    "Time/General" {
        /// Runs expressions after the solver.
        EXPRESSIONS_AFTER_DYNAMICS: bool = toggle("expressionsAfterDynamics", "ead", false);
    }
    "Goal Weights and Objects" {
        /// Method by which the weight of goals acts.
        GOAL_SMOOTHNESS: f64 = float("goalSmoothness", "gsm", 3.0).min(0.0).soft(0.0, 10.0);
        /// Goals of the particles.
        GOAL_GEOMETRY: Plugged = plug("goalGeometry", "ggeo", Data::Mesh).multi();
        /// Weights of the goals.
        GOAL_WEIGHT: f64 = float("goalWeight", "gw", 0.0).min(0.0).max(1.0).multi();
        /// Whether the goals are active.
        GOAL_ACTIVE: bool = toggle("goalActive", "ga", true).multi();
    }
    "Classic memory caching" {
        /// Keeps frames in memory.
        CACHE_DATA: bool = toggle("cacheData", "chd", false);
        /// Number of frames in memory.
        CACHE_WIDTH: i64 = int("cacheWidth", "chw", 1);
    }
    "Classic collisions" {
        /// Largest number of collisions of a particle in a frame.
        TRACE_DEPTH: i64 = int("traceDepth", "trd", 10).min(0.0);
    }
    "Shading" {
        /// Render type of the particles.
        PARTICLE_RENDER_TYPE: Choice = choice("particleRenderType", "prt", 3, &[(0, "MultiPoint"), (1, "MultiStreak"), (2, "Numeric"), (3, "Points"), (4, "Spheres"), (5, "Sprites"), (6, "Streak"), (7, "Blobby Surface (s/w)"), (8, "Cloud (s/w)"), (9, "Tube (s/w)")]);
    }
    "Initial State" {
        /// Initial positions.
        POSITION0: Vec<[f64; 3]> = vectors("position0", "pos0").elsewhere("the initial state of cloth is in `startPositions` and `startVelocities`");
        /// Initial velocities.
        VELOCITY0: Vec<[f64; 3]> = vectors("velocity0", "vel0").elsewhere("the initial state of cloth is in `startPositions` and `startVelocities`");
        /// Initial accelerations.
        ACCELERATION0: Vec<[f64; 3]> = vectors("acceleration0", "acc0");
        /// Initial masses.
        MASS0: Vec<f64> = floats("mass0", "mas0");
        /// Initial identifiers.
        PARTICLE_ID0: Vec<f64> = floats("particleId0", "id0");
    }
    "Classic Particle" {
        /// Positions, as the input of ramps.
        RAMP_POSITION: Vec<[f64; 3]> = vectors("rampPosition", "rps");
        /// Centroid of the particles.
        CENTROID: [f64; 3] = vector("centroid", "ctd", [0.0, 0.0, 0.0], ["ctdx", "ctdy", "ctdz"]).output().elsewhere("the cache of a run holds it for every frame");
        /// Positions at the previous evaluation.
        LAST_POSITION: Vec<[f64; 3]> = vectors("lastPosition", "lpos").output();
        /// Velocities, as the input of ramps.
        RAMP_VELOCITY: Vec<[f64; 3]> = vectors("rampVelocity", "rvl");
        /// Velocities at the previous evaluation.
        LAST_VELOCITY: Vec<[f64; 3]> = vectors("lastVelocity", "lvel").output();
        /// Accelerations, as the input of ramps.
        RAMP_ACCELERATION: Vec<[f64; 3]> = vectors("rampAcceleration", "rac");
        /// Centroid of the particles in world space.
        WORLD_CENTROID: [f64; 3] = vector("worldCentroid", "wctn", [0.0, 0.0, 0.0], ["wctx", "wcty", "wctz"]).output().elsewhere("the cache of a run holds it for every frame");
        /// World positions at the previous evaluation.
        LAST_WORLD_POSITION: Vec<[f64; 3]> = vectors("lastWorldPosition", "lwps").output();
        /// World velocities in object space.
        WORLD_VELOCITY_IN_OBJECT_SPACE: Vec<[f64; 3]> = vectors("worldVelocityInObjectSpace", "wvo");
        /// World velocities at the previous evaluation.
        LAST_WORLD_VELOCITY: Vec<[f64; 3]> = vectors("lastWorldVelocity", "lwvl").output();
        /// Initial emitter identifiers of the particles.
        EMITTER_ID0: Vec<f64> = floats("emitterId0", "eid0").output();
        /// Starts from a frame of a cache of classic particles.
        USE_STARTUP_CACHE: bool = toggle("useStartupCache", "usc", false);
        /// Path of that cache.
        STARTUP_CACHE_PATH: String = text("startupCachePath", "scp");
        /// Frame of that cache.
        STARTUP_CACHE_FRAME: i64 = int("startupCacheFrame", "scf", 0);
        /// Positions kept in memory.
        CACHED_POSITION: Vec<[f64; 3]> = vectors("cachedPosition", "cpos").output();
        /// Positions kept in memory, of the previous evaluation.
        LAST_CACHED_POSITION: Vec<[f64; 3]> = vectors("lastCachedPosition", "lcps").output();
        /// World positions kept in memory.
        CACHED_WORLD_POSITION: Vec<[f64; 3]> = vectors("cachedWorldPosition", "cwps").output();
        /// Centroid kept in memory, in world space.
        CACHED_WORLD_CENTROID: [f64; 3] = vector("cachedWorldCentroid", "cwcn", [0.0, 0.0, 0.0], ["cwcx", "cwcy", "cwcz"]).output();
        /// Velocities kept in memory.
        CACHED_VELOCITY: Vec<[f64; 3]> = vectors("cachedVelocity", "cvel").output();
        /// World velocities kept in memory.
        CACHED_WORLD_VELOCITY: Vec<[f64; 3]> = vectors("cachedWorldVelocity", "cwvl").output();
        /// Whether the count is being computed.
        COMPUTING_COUNT: bool = toggle("computingCount", "cmp", false).hidden();
        /// Masses kept in memory.
        MASS_CACHE: Vec<f64> = floats("massCache", "masc").output();
        /// Identifiers kept in memory.
        ID_CACHE: Vec<f64> = floats("idCache", "idc").output();
        /// Identifiers in ascending order.
        SORTED_ID: Vec<u32> = ints("sortedId", "sid").output();
        /// Index of each sorted identifier.
        ID_INDEX: Vec<u32> = ints("idIndex", "idix").output();
        /// The same at the start frame.
        NEXT_ID0: i64 = int("nextId0", "nid0", 0);
        /// Initial times of birth.
        BIRTH_TIME0: Vec<f64> = floats("birthTime0", "bt0");
        /// Times of birth kept in memory.
        BIRTH_TIME_CACHE: Vec<f64> = floats("birthTimeCache", "btc");
        /// Initial ages.
        AGE0: Vec<f64> = floats("age0", "ag0");
        /// Ages kept in memory.
        AGE_CACHE: Vec<f64> = floats("ageCache", "agc").output();
        /// Emitter of each particle.
        EMITTER_ID: Vec<f64> = floats("emitterId", "eid").output();
        /// Whether collisions create events.
        COLLISION_EVENTS: bool = toggle("collisionEvents", "cev", false).hidden();
        /// Whether particles die.
        DEATH: bool = toggle("death", "dth", false).hidden();
        /// State of the random number generator.
        RAND_STATE: [f64; 3] = vector("randState", "rnst", [0.0, 0.0, 0.0], ["rstx", "rsty", "rstz"]).hidden();
        /// Whether the creation expression runs.
        EXECUTE_CREATION_EXPRESSION: bool = toggle("executeCreationExpression", "ece", false).hidden();
        /// Whether the expression before dynamics runs.
        EXECUTE_RUNTIME_BEFORE_DYNAMICS_EXPRESSION: bool = toggle("executeRuntimeBeforeDynamicsExpression", "erbe", false).hidden();
        /// Whether the expression after dynamics runs.
        EXECUTE_RUNTIME_AFTER_DYNAMICS_EXPRESSION: bool = toggle("executeRuntimeAfterDynamicsExpression", "erae", false).hidden();
        /// Time, for expressions.
        TIME: f64 = float("time", "tim", 0.0).sink();
        /// Frame, for expressions.
        FRAME: f64 = float("frame", "frm", 0.0).sink();
        /// Text of the expression run in every frame.
        INTERNAL_RUNTIME_EXPRESSION: String = text("internalRuntimeExpression", "irx");
        /// Text of the expression run before dynamics.
        INTERNAL_RUNTIME_BEFORE_DYNAMICS_EXPRESSION: String = text("internalRuntimeBeforeDynamicsExpression", "irbx");
        /// Text of the expression run after dynamics.
        INTERNAL_RUNTIME_AFTER_DYNAMICS_EXPRESSION: String = text("internalRuntimeAfterDynamicsExpression", "irax");
        /// Text of the expression run for new particles.
        INTERNAL_CREATION_EXPRESSION: String = text("internalCreationExpression", "icx");
        /// Index of the particle that an expression runs for.
        CURRENT_PARTICLE: i64 = int("currentParticle", "xcp", 0).hidden();
        /// Number of particles that died in the previous evaluation.
        DIED_LAST_TIME: i64 = int("diedLastTime", "dlt", 0).hidden();
        /// Change of the count in the previous evaluation.
        NET_EMITTED_LAST_TIME: i64 = int("netEmittedLastTime", "nlt", 0).hidden();
        /// Index of the first newly emitted particle.
        START_EMITTED_INDEX: i64 = int("startEmittedIndex", "sei", -1).hidden();
        /// Positions, for fields.
        FIELD_DATA_POSITION: Vec<[f64; 3]> = vectors("fieldDataPosition", "fdp").output();
        /// Velocities, for fields.
        FIELD_DATA_VELOCITY: Vec<[f64; 3]> = vectors("fieldDataVelocity", "fdv").output();
        /// Masses, for fields.
        FIELD_DATA_MASS: Vec<f64> = floats("fieldDataMass", "fdm").output();
        /// Length of the time step, for fields.
        FIELD_DATA_DELTA_TIME: f64 = float("fieldDataDeltaTime", "fdt", 0.0).output();
        /// Positions, for emitters.
        EMITTER_DATA_POSITION: Vec<[f64; 3]> = vectors("emitterDataPosition", "edp").output();
        /// Velocities, for emitters.
        EMITTER_DATA_VELOCITY: Vec<[f64; 3]> = vectors("emitterDataVelocity", "edv").output();
        /// Length of the time step, for emitters.
        EMITTER_DATA_DELTA_TIME: f64 = float("emitterDataDeltaTime", "edt", 0.0).output();
        /// Reading it evaluates the node.
        FORCE_DYNAMICS: bool = toggle("forceDynamics", "fdn", false).sink().hidden().elsewhere("Maya's own bookkeeping between evaluations");
        /// The saved current time.
        CURRENT_TIME_SAVE: f64 = float("currentTimeSave", "cts", 0.0).hidden();
        /// Time of this evaluation.
        EVALUATION_TIME: f64 = float("evaluationTime", "eti", 0.0);
        /// Time of the scene.
        CURRENT_SCENE_TIME: f64 = float("currentSceneTime", "cst", 1.0);
        /// Time of the previous evaluation.
        LAST_TIME_EVALUATED: f64 = float("lastTimeEvaluated", "lti", 0.0).output();
        /// Time of the scene at the previous evaluation.
        LAST_SCENE_TIME: f64 = float("lastSceneTime", "lst", 0.0);
        /// Time of the data kept in memory.
        CACHED_TIME: f64 = float("cachedTime", "chti", 0.0).output();
        /// Interval of scene time of this evaluation.
        SCENE_TIME_STEP_SIZE: f64 = float("sceneTimeStepSize", "sts", 0.0).output();
        /// Points of that geometry.
        INPUT_GEOMETRY_POINTS: Vec<[f64; 3]> = vectors("inputGeometryPoints", "igpt").output();
        /// Space in which that geometry is read.
        INPUT_GEOMETRY_SPACE: Choice = choice("inputGeometrySpace", "igs", 0, &[(0, "Geometry Local"), (1, "World"), (2, "Particle Local")]);
        /// Keeps the number of particles equal to the number of points of that geometry.
        ENFORCE_COUNT_FROM_HISTORY: bool = toggle("enforceCountFromHistory", "ecfh", true);
        /// Space in which that geometry is moved.
        TARGET_GEOMETRY_SPACE: Choice = choice("targetGeometrySpace", "tgs", 2, &[(0, "Geometry Local"), (1, "World"), (2, "Particle Local")]);
        /// Whether collisions have been computed.
        COLLISIONS: bool = toggle("collisions", "col", false).hidden();
        /// Bounce of a classic collider.
        COLLISION_RESILIENCE: f64 = float("collisionResilience", "crs", 0.0);
        /// Friction of a classic collider.
        COLLISION_FRICTION: f64 = float("collisionFriction", "cfr", 0.0);
        /// Offset from a classic collider.
        COLLISION_OFFSET: f64 = float("collisionOffset", "cof", 0.0);
        /// Number of events so far.
        TOTAL_EVENT_COUNT: i64 = int("totalEventCount", "tec", 0).output();
        /// Whether an event has happened.
        EVENT_TEST: bool = toggle("eventTest", "evt", false).output();
        /// Number of events up to the previous evaluation.
        LAST_TOTAL_EVENT_COUNT: i64 = int("lastTotalEventCount", "ltec", 0);
        /// Seed of the random numbers of events.
        EVENT_SEED: i64 = int("eventSeed", "esd", 0);
        /// State of the random number generator of events.
        EVENT_RAND_STATE: [f64; 3] = vector("eventRandState", "erst", [0.0, 0.0, 0.0], ["ersx", "ersy", "ersz"]).hidden();
        /// Debug drawing, for Maya's developers.
        DEBUG_DRAW: i64 = int("debugDraw", "dbd", 0).hidden();
        /// Number of events.
        NUMBER_OF_EVENTS: i64 = int("numberOfEvents", "nev", 0);
        /// Number of event names ever assigned.
        EVENT_NAME_COUNT: i64 = int("eventNameCount", "enc", 0);
        /// Inherits the colour of the emitter.
        INHERIT_COLOR: bool = toggle("inheritColor", "inc", false);
        /// Whether dynamics are evaluated.
        DO_DYNAMICS: bool = toggle("doDynamics", "ddy", false).hidden();
        /// Whether emission is evaluated.
        DO_EMISSION: bool = toggle("doEmission", "dem", false).hidden();
        /// Whether emission is always evaluated.
        FORCE_EMISSION: bool = toggle("forceEmission", "fem", false).hidden();
        /// Whether ages are updated.
        DO_AGE: bool = toggle("doAge", "dag", false).hidden();
        /// Time of the last update.
        AGES_LAST_DONE: f64 = float("agesLastDone", "agld", 0.0).hidden();
        /// Time of the last evaluation.
        TIME_LAST_COMPUTED: f64 = float("timeLastComputed", "tlc", 0.0).hidden();
        /// Whether its parent has moved.
        PARENT_MATRIX_DIRTY: bool = toggle("parentMatrixDirty", "pmd", false).hidden();
        /// Version of the saved node.
        NEW_FILE_FORMAT: i64 = int("newFileFormat", "nff", 0).hidden();
        /// Draws particles from back to front.
        DEPTH_SORT: bool = toggle("depthSort", "ds", false);
        /// Whether clouds are drawn without an axis.
        DISABLE_CLOUD_AXIS: bool = toggle("disableCloudAxis", "dca", false);
        /// Whether only the direction of velocities is used.
        NORMALIZE_VELOCITY: bool = toggle("normalizeVelocity", "nvl", false);
        /// Whether a cache of another type is read.
        USE_CUSTOM_CACHE: bool = toggle("useCustomCache", "ucc", false);
    }
    "Internal" {
        /// Sum of the forces of all fields, per particle.
        FORCE: Vec<[f64; 3]> = vectors("force", "frc").output().hidden().elsewhere("the cache of a run holds it for every frame");
        /// Identifier of the next particle.
        NEXT_ID: i64 = int("nextId", "nid", 0).hidden();
        /// Whether the largest number of particles is reached, which stops emitters.
        IS_FULL: bool = toggle("isFull", "ifl", false).output().hidden();
        /// Interval of this evaluation, for emitters.
        TIME_STEP_SIZE: f64 = float("timeStepSize", "tss", 0.0).output().hidden().elsewhere("Maya's own bookkeeping between evaluations");
        /// The start frame as a time, for emitters.
        START_TIME: f64 = float("startTime", "stt", 0.0).output().hidden().elsewhere("Maya's own bookkeeping between evaluations");
    }
    "Connections" {
        /// Forces of the fields, one list per field.
        INPUT_FORCE: Plugged = plug("inputForce", "ifc", Data::Vectors).multi().solved("nucleus_graph::compile::fields");
        /// Transform at the previous evaluation.
        LAST_WORLD_MATRIX: Plugged = plug("lastWorldMatrix", "lwm", Data::Matrix).output().elsewhere("Maya's own bookkeeping between evaluations");
        /// Map from identifiers to indices.
        ID_MAPPING: Plugged = plug("idMapping", "idm", Data::Bundle).output();
        /// Particles that this object emits.
        EMISSION: Plugged = plug("emission", "emt", Data::NewParticles).output();
        /// Particles from emitters.
        NEW_PARTICLES: Plugged = plug("newParticles", "npt", Data::NewParticles).multi().sink();
        /// Inputs of expressions.
        INPUT: Plugged = plug("input", "xi", Data::Bundle).multi();
        /// Outputs of expressions.
        OUTPUT: Plugged = plug("output", "xo", Data::Bundle).multi().output();
        /// Data of the particles for fields.
        FIELD_DATA: Plugged = plug("fieldData", "fd", Data::FieldData).output().elsewhere("the connection of `inputForce` says which fields it feels");
        /// Data of the particles for emitters.
        EMITTER_DATA: Plugged = plug("emitterData", "ed", Data::Bundle).output();
        /// Geometry that a soft body is made from.
        INPUT_GEOMETRY: Plugged = plug("inputGeometry", "igeo", Data::Mesh);
        /// Geometry that a soft body moves.
        TARGET_GEOMETRY: Plugged = plug("targetGeometry", "tgeo", Data::Mesh).output();
        /// Transform of that geometry.
        TARGET_GEOMETRY_WORLD_MATRIX: Plugged = plug("targetGeometryWorldMatrix", "tgm", Data::Matrix);
        /// Names of the UV sets of goals.
        GOAL_UV_SET_NAME: Plugged = plug("goalUvSetName", "guv", Data::Text).multi();
        /// Classic colliders, one bundle each.
        COLLISION_DATA: Plugged = plug("collisionData", "cda", Data::Bundle);
        /// Surface of a classic collider.
        COLLISION_GEOMETRY: Plugged = plug("collisionGeometry", "cge", Data::Mesh);
        /// Collisions of this evaluation.
        COLLISION_RECORDS: Plugged = plug("collisionRecords", "crc", Data::Bundle).output();
        /// Particles that an event emits into.
        EVENT_TARGET: Plugged = plug("eventTarget", "etg", Data::Message).multi();
        /// Names of events.
        EVENT_NAME: Plugged = plug("eventName", "evn", Data::Text).multi();
        /// Whether each event is active.
        EVENT_VALID: Plugged = plug("eventValid", "evv", Data::Number).multi();
        /// Number of the collision at which each event happens.
        EVENT_COUNT: Plugged = plug("eventCount", "ecp", Data::Number).multi();
        /// Number of particles that each event emits.
        EVENT_EMIT: Plugged = plug("eventEmit", "eve", Data::Number).multi();
        /// Number of particles that each event splits one into.
        EVENT_SPLIT: Plugged = plug("eventSplit", "evs", Data::Number).multi();
        /// Whether the particle dies with each event.
        EVENT_DIE: Plugged = plug("eventDie", "evd", Data::Number).multi();
        /// Whether those numbers are random.
        EVENT_RANDOM: Plugged = plug("eventRandom", "evr", Data::Number).multi();
        /// Spread of the new particles of each event.
        EVENT_SPREAD: Plugged = plug("eventSpread", "esp", Data::Number).multi();
        /// Procedure called by each event.
        EVENT_PROC: Plugged = plug("eventProc", "epr", Data::Text).multi();
        /// Data for instanced geometry.
        INSTANCE_DATA: Plugged = plug("instanceData", "idt", Data::Bundle).multi();
        /// Fields that belong to it.
        FIELD_CONNECTIONS: Plugged = plug("fieldConnections", "fc", Data::Message).multi().elsewhere("Maya's note of the fields made on it; `inputForce` says which it feels");
        /// Colliders that belong to it.
        COLLISION_CONNECTIONS: Plugged = plug("collisionConnections", "cc", Data::Message).multi();
        /// Nodes that refer to it.
        CONNECTIONS_TO_ME: Plugged = plug("connectionsToMe", "ct", Data::Message).multi();
        /// Helper nodes that it owns.
        AUXILIARIES_OWNED: Plugged = plug("auxiliariesOwned", "ao", Data::Message);
        /// Emitters that belong to it.
        EMITTER_CONNECTIONS: Plugged = plug("emitterConnections", "ec", Data::Message).multi();
        /// Stands for the node itself.
        SHAPE_NAME_MSG: Plugged = plug("shapeNameMsg", "snmg", Data::Message);
        /// Values that shaders read for each particle.
        SAMPLER_PER_PARTICLE_DATA: Plugged = plug("samplerPerParticleData", "spd", Data::Bundle).output();
        /// Settings of fields per particle.
        PP_FIELD_DATA: Plugged = plug("ppFieldData", "ppfd", Data::FieldSettings).multi().output().elsewhere("the connection of `inputForce` says which fields it feels");
        /// The same, for fields that the particles own.
        OWNER_PP_FIELD_DATA: Plugged = plug("ownerPPFieldData", "opfd", Data::FieldSettings).multi().output();
        /// Positions after deformers.
        DEFORMED_POSITION: Plugged = plug("deformedPosition", "dpos", Data::Mesh);
    }
}
