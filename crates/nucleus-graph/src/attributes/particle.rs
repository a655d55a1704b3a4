//! What all dynamic objects inherit from classic particles. None of it takes effect yet.

use super::key::{Plugged, choice, float, floats, int, ints, plug, text, toggle, vector, vectors};
use super::kind::Data;
use super::node_type::node_table;
use super::value::Choice;

node_table! {
    /// The classic particle shape, which every object of a nucleus descends from.
    PARTICLE = "particle", inherits None, hides [];
    "General" {
        /// How many particles there are.
        COUNT: i64 = int("count", "cnt", 0).output();
        /// Takes part in the simulation; cloth that does not follows its input mesh. Maya shows it as Enable.
        IS_DYNAMIC: bool = toggle("isDynamic", "isd", true).solved("nucleus_graph::compile::soft_body");
    }
    "Time Attributes" {
        /// The time it is evaluated for; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0);
        /// The frame of its initial state; driven by its nucleus.
        START_FRAME: f64 = float("startFrame", "stf", 1.0);
    }
    "Dynamic Properties" {
        /// How much of the fields' forces is felt.
        DYNAMICS_WEIGHT: f64 = float("dynamicsWeight", "dw", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::fields");
        /// Feels fields in world space.
        FORCES_IN_WORLD: bool = toggle("forcesInWorld", "fiw", true);
        /// How much of the velocity is kept from frame to frame.
        CONSERVE: f64 = float("conserve", "con", 1.0).min(0.0).max(1.0);
    }
    "Per Particle (Array) Attributes" {
        /// Where the particles are.
        POSITION: Vec<[f64; 3]> = vectors("position", "pos");
        /// How fast the particles are.
        VELOCITY: Vec<[f64; 3]> = vectors("velocity", "vel");
        /// How the velocity of the particles changes.
        ACCELERATION: Vec<[f64; 3]> = vectors("acceleration", "acc");
        /// Where the particles are in world space.
        WORLD_POSITION: Vec<[f64; 3]> = vectors("worldPosition", "wps").output();
        /// How fast the particles are in world space.
        WORLD_VELOCITY: Vec<[f64; 3]> = vectors("worldVelocity", "wvl").output();
        /// Mass of each particle.
        MASS: Vec<f64> = floats("mass", "mas");
        /// Number of each particle.
        PARTICLE_ID: Vec<f64> = floats("particleId", "id").output();
        /// When each particle came to be.
        BIRTH_TIME: Vec<f64> = floats("birthTime", "bt").output();
        /// How old each particle is.
        AGE: Vec<f64> = floats("age", "ag").output();
    }
    "Emission Attributes" {
        /// Particles die when they leave the volume they came from.
        DIE_ON_EMISSION_VOLUME_EXIT: bool = toggle("dieOnEmissionVolumeExit", "dve", false);
        /// Emits in world space.
        EMISSION_IN_WORLD: bool = toggle("emissionInWorld", "eiw", true);
        /// No more particles than this; -1 is no bound.
        MAX_COUNT: i64 = int("maxCount", "mxc", -1).solved("nucleus_graph::compile::emission");
        /// Share of the particles that is emitted.
        LEVEL_OF_DETAIL: f64 = float("levelOfDetail", "lod", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::emission");
        /// How much velocity particles take from their emitter.
        INHERIT_FACTOR: f64 = float("inheritFactor", "inh", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_graph::compile::emission");
        /// Where random emission begins.
        SEED: i64 = int("seed", "sd", 1).multi().solved("nucleus_graph::compile::emission");
    }
    "Lifespan" {
        /// How it is decided how long particles live.
        LIFESPAN_MODE: Choice = choice("lifespanMode", "lfm", 0, &[(0, "Live forever"), (1, "Constant"), (2, "Random range"), (3, "lifespanPP only")]).solved("nucleus_graph::compile::emission");
        /// By how much the time they live varies.
        LIFESPAN_RANDOM: f64 = float("lifespanRandom", "lfr", 0.0).unit("s").solved("nucleus_graph::compile::emission");
        /// How long particles live: each of them, or in the mean. Maya adds it to a node when it creates particles.
        LIFESPAN: f64 = float("lifespan", "lifespan", 1.0).min(0.0).unit("s").solved("nucleus_graph::compile::emission").extension();
        /// How long each particle lives in the end.
        FINAL_LIFESPAN_PP: Vec<f64> = floats("finalLifespanPP", "flp").output();
        /// Where random lifespans begin.
        GENERAL_SEED: i64 = int("generalSeed", "gsd", 0).solved("nucleus_graph::compile::emission");
    }
    "Time/General" {
        /// Runs expressions after the solver.
        EXPRESSIONS_AFTER_DYNAMICS: bool = toggle("expressionsAfterDynamics", "ead", false);
    }
    "Goal Weights and Objects" {
        /// How the pull of goals changes with their weight.
        GOAL_SMOOTHNESS: f64 = float("goalSmoothness", "gsm", 3.0).min(0.0).soft(0.0, 10.0);
        /// What particles are drawn to.
        GOAL_GEOMETRY: Plugged = plug("goalGeometry", "ggeo", Data::Mesh).multi();
        /// How strongly they are drawn.
        GOAL_WEIGHT: f64 = float("goalWeight", "gw", 0.0).min(0.0).max(1.0).multi();
        /// Whether they are drawn.
        GOAL_ACTIVE: bool = toggle("goalActive", "ga", true).multi();
    }
    "Classic memory caching" {
        /// Keeps frames in memory.
        CACHE_DATA: bool = toggle("cacheData", "chd", false);
        /// How many frames it keeps.
        CACHE_WIDTH: i64 = int("cacheWidth", "chw", 1);
    }
    "Classic collisions" {
        /// How often a particle can collide in a frame.
        TRACE_DEPTH: i64 = int("traceDepth", "trd", 10).min(0.0);
    }
    "Shading" {
        /// How particles are drawn.
        PARTICLE_RENDER_TYPE: Choice = choice("particleRenderType", "prt", 3, &[(0, "MultiPoint"), (1, "MultiStreak"), (2, "Numeric"), (3, "Points"), (4, "Spheres"), (5, "Sprites"), (6, "Streak"), (7, "Blobby Surface (s/w)"), (8, "Cloud (s/w)"), (9, "Tube (s/w)")]);
    }
    "Initial State" {
        /// Initial positions.
        POSITION0: Vec<[f64; 3]> = vectors("position0", "pos0");
        /// Initial velocities.
        VELOCITY0: Vec<[f64; 3]> = vectors("velocity0", "vel0");
        /// Initial accelerations.
        ACCELERATION0: Vec<[f64; 3]> = vectors("acceleration0", "acc0");
        /// Initial masses.
        MASS0: Vec<f64> = floats("mass0", "mas0");
        /// Initial numbers.
        PARTICLE_ID0: Vec<f64> = floats("particleId0", "id0");
    }
    "Classic Particle" {
        /// Positions that ramps work on.
        RAMP_POSITION: Vec<[f64; 3]> = vectors("rampPosition", "rps");
        /// Middle of all particles.
        CENTROID: [f64; 3] = vector("centroid", "ctd", [0.0, 0.0, 0.0], ["ctdx", "ctdy", "ctdz"]).output();
        /// Positions at the evaluation before.
        LAST_POSITION: Vec<[f64; 3]> = vectors("lastPosition", "lpos").output();
        /// Velocities that ramps work on.
        RAMP_VELOCITY: Vec<[f64; 3]> = vectors("rampVelocity", "rvl");
        /// Velocities at the evaluation before.
        LAST_VELOCITY: Vec<[f64; 3]> = vectors("lastVelocity", "lvel").output();
        /// Accelerations that ramps work on.
        RAMP_ACCELERATION: Vec<[f64; 3]> = vectors("rampAcceleration", "rac");
        /// Middle of all particles in world space.
        WORLD_CENTROID: [f64; 3] = vector("worldCentroid", "wctn", [0.0, 0.0, 0.0], ["wctx", "wcty", "wctz"]).output();
        /// World positions at the evaluation before.
        LAST_WORLD_POSITION: Vec<[f64; 3]> = vectors("lastWorldPosition", "lwps").output();
        /// World velocities, seen from the object.
        WORLD_VELOCITY_IN_OBJECT_SPACE: Vec<[f64; 3]> = vectors("worldVelocityInObjectSpace", "wvo");
        /// World velocities at the evaluation before.
        LAST_WORLD_VELOCITY: Vec<[f64; 3]> = vectors("lastWorldVelocity", "lwvl").output();
        /// Initial numbers of the emitters that particles come from.
        EMITTER_ID0: Vec<f64> = floats("emitterId0", "eid0").output();
        /// Begins with a frame of a cache of classic particles.
        USE_STARTUP_CACHE: bool = toggle("useStartupCache", "usc", false);
        /// Where that cache is.
        STARTUP_CACHE_PATH: String = text("startupCachePath", "scp");
        /// Which of its frames is taken.
        STARTUP_CACHE_FRAME: i64 = int("startupCacheFrame", "scf", 0);
        /// Positions kept in memory.
        CACHED_POSITION: Vec<[f64; 3]> = vectors("cachedPosition", "cpos").output();
        /// Positions kept in memory, one evaluation back.
        LAST_CACHED_POSITION: Vec<[f64; 3]> = vectors("lastCachedPosition", "lcps").output();
        /// World positions kept in memory.
        CACHED_WORLD_POSITION: Vec<[f64; 3]> = vectors("cachedWorldPosition", "cwps").output();
        /// Middle of the particles kept in memory, in world space.
        CACHED_WORLD_CENTROID: [f64; 3] = vector("cachedWorldCentroid", "cwcn", [0.0, 0.0, 0.0], ["cwcx", "cwcy", "cwcz"]).output();
        /// Velocities kept in memory.
        CACHED_VELOCITY: Vec<[f64; 3]> = vectors("cachedVelocity", "cvel").output();
        /// World velocities kept in memory.
        CACHED_WORLD_VELOCITY: Vec<[f64; 3]> = vectors("cachedWorldVelocity", "cwvl").output();
        /// The count is being worked out.
        COMPUTING_COUNT: bool = toggle("computingCount", "cmp", false).hidden();
        /// Masses kept in memory.
        MASS_CACHE: Vec<f64> = floats("massCache", "masc").output();
        /// Numbers of particles kept in memory.
        ID_CACHE: Vec<f64> = floats("idCache", "idc").output();
        /// Numbers of particles in rising order.
        SORTED_ID: Vec<u32> = ints("sortedId", "sid").output();
        /// Place of each of the sorted numbers.
        ID_INDEX: Vec<u32> = ints("idIndex", "idix").output();
        /// The same at the start.
        NEXT_ID0: i64 = int("nextId0", "nid0", 0);
        /// Initial times of birth.
        BIRTH_TIME0: Vec<f64> = floats("birthTime0", "bt0");
        /// Times of birth kept in memory.
        BIRTH_TIME_CACHE: Vec<f64> = floats("birthTimeCache", "btc");
        /// Initial ages.
        AGE0: Vec<f64> = floats("age0", "ag0");
        /// Ages kept in memory.
        AGE_CACHE: Vec<f64> = floats("ageCache", "agc").output();
        /// Emitter that each particle comes from.
        EMITTER_ID: Vec<f64> = floats("emitterId", "eid").output();
        /// Collisions are to be noticed as events.
        COLLISION_EVENTS: bool = toggle("collisionEvents", "cev", false).hidden();
        /// Particles are to die.
        DEATH: bool = toggle("death", "dth", false).hidden();
        /// State of the random numbers.
        RAND_STATE: [f64; 3] = vector("randState", "rnst", [0.0, 0.0, 0.0], ["rstx", "rsty", "rstz"]).hidden();
        /// Runs the expression for new particles.
        EXECUTE_CREATION_EXPRESSION: bool = toggle("executeCreationExpression", "ece", false).hidden();
        /// Runs the expression that comes before dynamics.
        EXECUTE_RUNTIME_BEFORE_DYNAMICS_EXPRESSION: bool = toggle("executeRuntimeBeforeDynamicsExpression", "erbe", false).hidden();
        /// Runs the expression that comes after dynamics.
        EXECUTE_RUNTIME_AFTER_DYNAMICS_EXPRESSION: bool = toggle("executeRuntimeAfterDynamicsExpression", "erae", false).hidden();
        /// Time as expressions see it.
        TIME: f64 = float("time", "tim", 0.0).sink();
        /// Frame as expressions see it.
        FRAME: f64 = float("frame", "frm", 0.0).sink();
        /// Text of the expression run in every frame.
        INTERNAL_RUNTIME_EXPRESSION: String = text("internalRuntimeExpression", "irx");
        /// Text of the expression run before dynamics.
        INTERNAL_RUNTIME_BEFORE_DYNAMICS_EXPRESSION: String = text("internalRuntimeBeforeDynamicsExpression", "irbx");
        /// Text of the expression run after dynamics.
        INTERNAL_RUNTIME_AFTER_DYNAMICS_EXPRESSION: String = text("internalRuntimeAfterDynamicsExpression", "irax");
        /// Text of the expression run for new particles.
        INTERNAL_CREATION_EXPRESSION: String = text("internalCreationExpression", "icx");
        /// Particle that an expression is run for.
        CURRENT_PARTICLE: i64 = int("currentParticle", "xcp", 0).hidden();
        /// How many died in the evaluation before.
        DIED_LAST_TIME: i64 = int("diedLastTime", "dlt", 0).hidden();
        /// How many more there were after the evaluation before.
        NET_EMITTED_LAST_TIME: i64 = int("netEmittedLastTime", "nlt", 0).hidden();
        /// The first particle that has just been emitted.
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
        /// Reading it makes the node evaluate.
        FORCE_DYNAMICS: bool = toggle("forceDynamics", "fdn", false).sink().hidden();
        /// The current time as it was saved.
        CURRENT_TIME_SAVE: f64 = float("currentTimeSave", "cts", 0.0).hidden();
        /// Time of this evaluation.
        EVALUATION_TIME: f64 = float("evaluationTime", "eti", 0.0);
        /// Time of the scene.
        CURRENT_SCENE_TIME: f64 = float("currentSceneTime", "cst", 1.0);
        /// Time of the evaluation before.
        LAST_TIME_EVALUATED: f64 = float("lastTimeEvaluated", "lti", 0.0).output();
        /// Time of the scene at the evaluation before.
        LAST_SCENE_TIME: f64 = float("lastSceneTime", "lst", 0.0);
        /// Time of what is kept in memory.
        CACHED_TIME: f64 = float("cachedTime", "chti", 0.0).output();
        /// Time of the scene that this evaluation spans.
        SCENE_TIME_STEP_SIZE: f64 = float("sceneTimeStepSize", "sts", 0.0).output();
        /// Points of that geometry.
        INPUT_GEOMETRY_POINTS: Vec<[f64; 3]> = vectors("inputGeometryPoints", "igpt").output();
        /// Space in which that geometry is taken.
        INPUT_GEOMETRY_SPACE: Choice = choice("inputGeometrySpace", "igs", 0, &[(0, "Geometry Local"), (1, "World"), (2, "Particle Local")]);
        /// Keeps as many particles as that geometry has points.
        ENFORCE_COUNT_FROM_HISTORY: bool = toggle("enforceCountFromHistory", "ecfh", true);
        /// Space in which that geometry is moved.
        TARGET_GEOMETRY_SPACE: Choice = choice("targetGeometrySpace", "tgs", 2, &[(0, "Geometry Local"), (1, "World"), (2, "Particle Local")]);
        /// Collisions have been worked out.
        COLLISIONS: bool = toggle("collisions", "col", false).hidden();
        /// How much speed a classic collider gives back.
        COLLISION_RESILIENCE: f64 = float("collisionResilience", "crs", 0.0);
        /// Friction of a classic collider.
        COLLISION_FRICTION: f64 = float("collisionFriction", "cfr", 0.0);
        /// Distance kept from a classic collider.
        COLLISION_OFFSET: f64 = float("collisionOffset", "cof", 0.0);
        /// Events so far.
        TOTAL_EVENT_COUNT: i64 = int("totalEventCount", "tec", 0).output();
        /// An event has happened.
        EVENT_TEST: bool = toggle("eventTest", "evt", false).output();
        /// Events up to the evaluation before.
        LAST_TOTAL_EVENT_COUNT: i64 = int("lastTotalEventCount", "ltec", 0);
        /// Where the random numbers of events begin.
        EVENT_SEED: i64 = int("eventSeed", "esd", 0);
        /// State of the random numbers of events.
        EVENT_RAND_STATE: [f64; 3] = vector("eventRandState", "erst", [0.0, 0.0, 0.0], ["ersx", "ersy", "ersz"]).hidden();
        /// Draws more than usual, for Maya's developers.
        DEBUG_DRAW: i64 = int("debugDraw", "dbd", 0).hidden();
        /// How many events there are.
        NUMBER_OF_EVENTS: i64 = int("numberOfEvents", "nev", 0);
        /// How many names of events were ever given.
        EVENT_NAME_COUNT: i64 = int("eventNameCount", "enc", 0);
        /// Takes its colour from the emitter.
        INHERIT_COLOR: bool = toggle("inheritColor", "inc", false);
        /// Dynamics is to be done.
        DO_DYNAMICS: bool = toggle("doDynamics", "ddy", false).hidden();
        /// Emission is to be done.
        DO_EMISSION: bool = toggle("doEmission", "dem", false).hidden();
        /// Emission is done in any case.
        FORCE_EMISSION: bool = toggle("forceEmission", "fem", false).hidden();
        /// Ages are to be brought up to date.
        DO_AGE: bool = toggle("doAge", "dag", false).hidden();
        /// When that was done last.
        AGES_LAST_DONE: f64 = float("agesLastDone", "agld", 0.0).hidden();
        /// When the node was evaluated last.
        TIME_LAST_COMPUTED: f64 = float("timeLastComputed", "tlc", 0.0).hidden();
        /// What it hangs from has moved.
        PARENT_MATRIX_DIRTY: bool = toggle("parentMatrixDirty", "pmd", false).hidden();
        /// Version of the saved node.
        NEW_FILE_FORMAT: i64 = int("newFileFormat", "nff", 0).hidden();
        /// Draws particles from back to front.
        DEPTH_SORT: bool = toggle("depthSort", "ds", false);
        /// Clouds are drawn without an axis.
        DISABLE_CLOUD_AXIS: bool = toggle("disableCloudAxis", "dca", false);
        /// Uses the direction of velocities only.
        NORMALIZE_VELOCITY: bool = toggle("normalizeVelocity", "nvl", false);
        /// Reads a cache of another kind.
        USE_CUSTOM_CACHE: bool = toggle("useCustomCache", "ucc", false);
    }
    "Internal" {
        /// What all fields together do to each particle.
        FORCE: Vec<[f64; 3]> = vectors("force", "frc").output().hidden();
        /// Number that the next particle will get.
        NEXT_ID: i64 = int("nextId", "nid", 0).hidden();
        /// There are as many particles as there may be: emitters stop.
        IS_FULL: bool = toggle("isFull", "ifl", false).output().hidden();
        /// Time that this evaluation spans; emitters read it.
        TIME_STEP_SIZE: f64 = float("timeStepSize", "tss", 0.0).output().hidden();
        /// The start frame as a time; emitters read it.
        START_TIME: f64 = float("startTime", "stt", 0.0).output().hidden();
    }
    "Connections" {
        /// Forces of the fields, one list per field.
        INPUT_FORCE: Plugged = plug("inputForce", "ifc", Data::Vectors).multi();
        /// Where the object stood at the evaluation before.
        LAST_WORLD_MATRIX: Plugged = plug("lastWorldMatrix", "lwm", Data::Matrix).output();
        /// From the number of a particle to its place.
        ID_MAPPING: Plugged = plug("idMapping", "idm", Data::Bundle).output();
        /// What particles emit in turn.
        EMISSION: Plugged = plug("emission", "emt", Data::NewParticles).output();
        /// Particles that come in from emitters.
        NEW_PARTICLES: Plugged = plug("newParticles", "npt", Data::NewParticles).multi().sink();
        /// What expressions read.
        INPUT: Plugged = plug("input", "xi", Data::Bundle).multi();
        /// What expressions write.
        OUTPUT: Plugged = plug("output", "xo", Data::Bundle).multi().output();
        /// What fields are told about the particles.
        FIELD_DATA: Plugged = plug("fieldData", "fd", Data::FieldData).output();
        /// What emitters are told about the particles.
        EMITTER_DATA: Plugged = plug("emitterData", "ed", Data::Bundle).output();
        /// Geometry that a soft body is made from.
        INPUT_GEOMETRY: Plugged = plug("inputGeometry", "igeo", Data::Mesh);
        /// Geometry that a soft body moves.
        TARGET_GEOMETRY: Plugged = plug("targetGeometry", "tgeo", Data::Mesh).output();
        /// Where that geometry stands.
        TARGET_GEOMETRY_WORLD_MATRIX: Plugged = plug("targetGeometryWorldMatrix", "tgm", Data::Matrix);
        /// Names of the UV sets of goals.
        GOAL_UV_SET_NAME: Plugged = plug("goalUvSetName", "guv", Data::Text).multi();
        /// Classic colliders, one bundle each.
        COLLISION_DATA: Plugged = plug("collisionData", "cda", Data::Bundle);
        /// Surface of a classic collider.
        COLLISION_GEOMETRY: Plugged = plug("collisionGeometry", "cge", Data::Mesh);
        /// Collisions that have happened.
        COLLISION_RECORDS: Plugged = plug("collisionRecords", "crc", Data::Bundle).output();
        /// Particles that an event emits into.
        EVENT_TARGET: Plugged = plug("eventTarget", "etg", Data::Message).multi();
        /// Names of events.
        EVENT_NAME: Plugged = plug("eventName", "evn", Data::Text).multi();
        /// Whether each event is in use.
        EVENT_VALID: Plugged = plug("eventValid", "evv", Data::Number).multi();
        /// At which collision each event happens.
        EVENT_COUNT: Plugged = plug("eventCount", "ecp", Data::Number).multi();
        /// How many particles each event emits.
        EVENT_EMIT: Plugged = plug("eventEmit", "eve", Data::Number).multi();
        /// How many particles each event splits one into.
        EVENT_SPLIT: Plugged = plug("eventSplit", "evs", Data::Number).multi();
        /// Whether the particle dies with each event.
        EVENT_DIE: Plugged = plug("eventDie", "evd", Data::Number).multi();
        /// Whether those numbers vary.
        EVENT_RANDOM: Plugged = plug("eventRandom", "evr", Data::Number).multi();
        /// How far new particles of each event fan out.
        EVENT_SPREAD: Plugged = plug("eventSpread", "esp", Data::Number).multi();
        /// Procedure called by each event.
        EVENT_PROC: Plugged = plug("eventProc", "epr", Data::Text).multi();
        /// What is needed to put geometry on particles.
        INSTANCE_DATA: Plugged = plug("instanceData", "idt", Data::Bundle).multi();
        /// Fields that belong to it.
        FIELD_CONNECTIONS: Plugged = plug("fieldConnections", "fc", Data::Message).multi();
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
        /// Settings of fields that differ by particle.
        PP_FIELD_DATA: Plugged = plug("ppFieldData", "ppfd", Data::FieldSettings).multi().output();
        /// The same for fields that the particles own.
        OWNER_PP_FIELD_DATA: Plugged = plug("ownerPPFieldData", "opfd", Data::FieldSettings).multi().output();
        /// Positions after deformers.
        DEFORMED_POSITION: Plugged = plug("deformedPosition", "dpos", Data::Mesh);
    }
}
