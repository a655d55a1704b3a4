//! Attributes that all dynamic objects inherit from Maya's classic particles.

use super::key::{Plugged, choice, float, floats, int, ints, plug, text, toggle, vector, vectors};
use super::kind::Data;
use super::node_type::node_table;
use super::value::Choice;

/// `lifespanMode: live forever`.
pub const LIVE_FOREVER: Choice = Choice(0);
/// `lifespanMode: constant`.
pub const CONSTANT_LIFESPAN: Choice = Choice(1);
/// `lifespanMode: random range`.
pub const RANDOM_RANGE: Choice = Choice(2);
/// `lifespanMode: lifespanPP only`.
pub const LIFESPAN_PP_ONLY: Choice = Choice(3);

node_table! {
    /// Maya's classic particle shape, the ancestor of all objects of a nucleus.
    PARTICLE = "particle", inherits None, hides [];
    "General" {
        /// Number of particles.
        COUNT: i64 = int("count", "cnt", 0).output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Includes the object in the simulation; Enable in Maya's attribute editor. Cloth that is not included follows its input mesh. Particles that are not included stay where they are, lose their velocity, age and die, and none are emitted. Other cloth collides with both. `enable` of the nucleus stops time, and keeps velocities and ages.
        IS_DYNAMIC: bool = toggle("isDynamic", "isd", true).solved("nucleus_graph::compile::input_mesh");
    }
    "Time Attributes" {
        /// Time of the evaluation; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0).wiring("the clock of the nucleus counts");
        /// Frame of the initial state; driven by the nucleus.
        START_FRAME: f64 = float("startFrame", "stf", 1.0).wiring("the clock of the nucleus counts");
    }
    "Dynamic Properties" {
        /// Factor on the forces of fields.
        DYNAMICS_WEIGHT: f64 = float("dynamicsWeight", "dw", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::fields");
        /// Evaluates fields in world space.
        FORCES_IN_WORLD: bool = toggle("forcesInWorld", "fiw", true).elsewhere("fields always act in world space");
        /// Share of the velocity that is kept from frame to frame.
        CONSERVE: f64 = float("conserve", "con", 1.0).min(0.0).max(1.0).solved("nucleus_core::particles::slowing");
    }
    "Per Particle (Array) Attributes" {
        /// Positions of the particles.
        POSITION: Vec<[f64; 3]> = vectors("position", "pos").elsewhere("only particles have initial places of their own; cloth has `startPositions`");
        /// Velocities of the particles.
        VELOCITY: Vec<[f64; 3]> = vectors("velocity", "vel").elsewhere("only particles have initial places of their own; cloth has `startPositions`");
        /// Accelerations of the particles.
        ACCELERATION: Vec<[f64; 3]> = vectors("acceleration", "acc").elsewhere("an output that only Maya's expressions and shaders read");
        /// Positions of the particles in world space.
        WORLD_POSITION: Vec<[f64; 3]> = vectors("worldPosition", "wps").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Velocities of the particles in world space.
        WORLD_VELOCITY: Vec<[f64; 3]> = vectors("worldVelocity", "wvl").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Mass of each particle.
        MASS: Vec<f64> = floats("mass", "mas").elsewhere("an output that only Maya's expressions and shaders read");
        /// Identifier of each particle.
        PARTICLE_ID: Vec<f64> = floats("particleId", "id").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Time of birth of each particle.
        BIRTH_TIME: Vec<f64> = floats("birthTime", "bt").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Age of each particle.
        AGE: Vec<f64> = floats("age", "ag").output().elsewhere("an output that only Maya's expressions and shaders read");
    }
    "Emission Attributes" {
        /// Particles die when they leave the volume that they were emitted from.
        DIE_ON_EMISSION_VOLUME_EXIT: bool = toggle("dieOnEmissionVolumeExit", "dve", false).elsewhere("particles outlive the volume they come from; give them a lifespan");
        /// Emits in world space.
        EMISSION_IN_WORLD: bool = toggle("emissionInWorld", "eiw", true).elsewhere("particles are always emitted in world space");
        /// Largest number of particles; -1 for no limit.
        MAX_COUNT: i64 = int("maxCount", "mxc", -1).solved("nucleus_graph::compile::emission").fixed();
        /// Share of the particles that are emitted.
        LEVEL_OF_DETAIL: f64 = float("levelOfDetail", "lod", 1.0).min(0.0).max(1.0).solved("nucleus_graph::compile::emission");
        /// Share of the emitter's velocity that particles inherit.
        INHERIT_FACTOR: f64 = float("inheritFactor", "inh", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_graph::compile::emission");
        /// Seed of random emission.
        SEED: i64 = int("seed", "sd", 1).multi().solved("nucleus_graph::compile::emission");
    }
    "Lifespan" {
        /// Source of the lifespans: forever, constant, random, or one per particle.
        LIFESPAN_MODE: Choice = choice("lifespanMode", "lfm", 0, &[(0, "Live forever"), (1, "Constant"), (2, "Random range"), (3, "lifespanPP only")]).solved("nucleus_graph::compile::emission");
        /// Range of random lifespans.
        LIFESPAN_RANDOM: f64 = float("lifespanRandom", "lfr", 0.0).unit("s").solved("nucleus_graph::compile::emission");
        /// Lifespan of the particles: constant, or the mean of random ones. Maya adds the attribute when it creates particles.
        LIFESPAN: f64 = float("lifespan", "lifespan", 1.0).min(0.0).unit("s").solved("nucleus_graph::compile::emission").extension();
        /// Lifespan of each particle.
        FINAL_LIFESPAN_PP: Vec<f64> = floats("finalLifespanPP", "flp").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Seed of random lifespans.
        GENERAL_SEED: i64 = int("generalSeed", "gsd", 0).solved("nucleus_graph::compile::emission");
    }
    "Time/General" {
        /// Runs expressions after the solver.
        EXPRESSIONS_AFTER_DYNAMICS: bool = toggle("expressionsAfterDynamics", "ead", false).elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
    }
    "Goal Weights and Objects" {
        /// Method by which the weight of goals acts.
        GOAL_SMOOTHNESS: f64 = float("goalSmoothness", "gsm", 3.0).min(0.0).soft(0.0, 10.0).elsewhere("only classic goals use it; a dynamicConstraint or a field stands for them");
        /// Goals of the particles.
        GOAL_GEOMETRY: Plugged = plug("goalGeometry", "ggeo", Data::Mesh).multi().elsewhere("only classic goals use it; a dynamicConstraint or a field stands for them");
        /// Weights of the goals.
        GOAL_WEIGHT: f64 = float("goalWeight", "gw", 0.0).min(0.0).max(1.0).multi().elsewhere("only classic goals use it; a dynamicConstraint or a field stands for them");
        /// Whether the goals are active.
        GOAL_ACTIVE: bool = toggle("goalActive", "ga", true).multi().elsewhere("only classic goals use it; a dynamicConstraint or a field stands for them");
    }
    "Classic memory caching" {
        /// Keeps frames in memory.
        CACHE_DATA: bool = toggle("cacheData", "chd", false).wiring("only Maya's playback from memory uses it");
        /// Number of frames in memory.
        CACHE_WIDTH: i64 = int("cacheWidth", "chw", 1).wiring("only Maya's playback from memory uses it");
    }
    "Classic collisions" {
        /// Largest number of collisions of a particle in a frame.
        TRACE_DEPTH: i64 = int("traceDepth", "trd", 10).min(0.0).elsewhere("only classic collisions use it; here objects of a nucleus collide");
    }
    "Shading" {
        /// Render type of the particles.
        PARTICLE_RENDER_TYPE: Choice = choice("particleRenderType", "prt", 3, &[(0, "MultiPoint"), (1, "MultiStreak"), (2, "Numeric"), (3, "Points"), (4, "Spheres"), (5, "Sprites"), (6, "Streak"), (7, "Blobby Surface (s/w)"), (8, "Cloud (s/w)"), (9, "Tube (s/w)")]).elsewhere("only Maya draws particles so");
    }
    "Initial State" {
        /// Initial positions.
        POSITION0: Vec<[f64; 3]> = vectors("position0", "pos0").elsewhere("only particles have initial places of their own; cloth has `startPositions`");
        /// Initial velocities.
        VELOCITY0: Vec<[f64; 3]> = vectors("velocity0", "vel0").elsewhere("only particles have initial places of their own; cloth has `startPositions`");
        /// Initial accelerations.
        ACCELERATION0: Vec<[f64; 3]> = vectors("acceleration0", "acc0").elsewhere("forces give the acceleration at the start as at any time");
        /// Initial masses in kilograms; particles that are emitted later have `pointMass`.
        MASS0: Vec<f64> = floats("mass0", "mas0").solved("nucleus_graph::compile::particle_ramps");
        /// Initial identifiers.
        PARTICLE_ID0: Vec<f64> = floats("particleId0", "id0").solved("nucleus_graph::compile::particle_ramps");
    }
    "Classic Particle" {
        /// Positions, as the input of ramps.
        RAMP_POSITION: Vec<[f64; 3]> = vectors("rampPosition", "rps").wiring("Maya's evaluation keeps its state in it");
        /// Centroid of the particles.
        CENTROID: [f64; 3] = vector("centroid", "ctd", [0.0, 0.0, 0.0], ["ctdx", "ctdy", "ctdz"]).output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Positions at the previous evaluation.
        LAST_POSITION: Vec<[f64; 3]> = vectors("lastPosition", "lpos").output().wiring("Maya's evaluation keeps its state in it");
        /// Velocities, as the input of ramps.
        RAMP_VELOCITY: Vec<[f64; 3]> = vectors("rampVelocity", "rvl").wiring("Maya's evaluation keeps its state in it");
        /// Velocities at the previous evaluation.
        LAST_VELOCITY: Vec<[f64; 3]> = vectors("lastVelocity", "lvel").output().wiring("Maya's evaluation keeps its state in it");
        /// Accelerations, as the input of ramps.
        RAMP_ACCELERATION: Vec<[f64; 3]> = vectors("rampAcceleration", "rac").wiring("Maya's evaluation keeps its state in it");
        /// Centroid of the particles in world space.
        WORLD_CENTROID: [f64; 3] = vector("worldCentroid", "wctn", [0.0, 0.0, 0.0], ["wctx", "wcty", "wctz"]).output().elsewhere("an output that only Maya's expressions and shaders read");
        /// World positions at the previous evaluation.
        LAST_WORLD_POSITION: Vec<[f64; 3]> = vectors("lastWorldPosition", "lwps").output().wiring("Maya's evaluation keeps its state in it");
        /// World velocities in object space.
        WORLD_VELOCITY_IN_OBJECT_SPACE: Vec<[f64; 3]> = vectors("worldVelocityInObjectSpace", "wvo").wiring("Maya's evaluation keeps its state in it");
        /// World velocities at the previous evaluation.
        LAST_WORLD_VELOCITY: Vec<[f64; 3]> = vectors("lastWorldVelocity", "lwvl").output().wiring("Maya's evaluation keeps its state in it");
        /// Initial emitter identifiers of the particles.
        EMITTER_ID0: Vec<f64> = floats("emitterId0", "eid0").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Starts from a frame of a cache of classic particles.
        USE_STARTUP_CACHE: bool = toggle("useStartupCache", "usc", false).wiring("only Maya's playback from memory uses it");
        /// Path of that cache.
        STARTUP_CACHE_PATH: String = text("startupCachePath", "scp").wiring("only Maya's playback from memory uses it");
        /// Frame of that cache.
        STARTUP_CACHE_FRAME: i64 = int("startupCacheFrame", "scf", 0).wiring("only Maya's playback from memory uses it");
        /// Positions kept in memory.
        CACHED_POSITION: Vec<[f64; 3]> = vectors("cachedPosition", "cpos").output().wiring("only Maya's playback from memory uses it");
        /// Positions kept in memory, of the previous evaluation.
        LAST_CACHED_POSITION: Vec<[f64; 3]> = vectors("lastCachedPosition", "lcps").output().wiring("only Maya's playback from memory uses it");
        /// World positions kept in memory.
        CACHED_WORLD_POSITION: Vec<[f64; 3]> = vectors("cachedWorldPosition", "cwps").output().wiring("only Maya's playback from memory uses it");
        /// Centroid kept in memory, in world space.
        CACHED_WORLD_CENTROID: [f64; 3] = vector("cachedWorldCentroid", "cwcn", [0.0, 0.0, 0.0], ["cwcx", "cwcy", "cwcz"]).output().wiring("only Maya's playback from memory uses it");
        /// Velocities kept in memory.
        CACHED_VELOCITY: Vec<[f64; 3]> = vectors("cachedVelocity", "cvel").output().wiring("only Maya's playback from memory uses it");
        /// World velocities kept in memory.
        CACHED_WORLD_VELOCITY: Vec<[f64; 3]> = vectors("cachedWorldVelocity", "cwvl").output().wiring("only Maya's playback from memory uses it");
        /// Whether the count is being computed.
        COMPUTING_COUNT: bool = toggle("computingCount", "cmp", false).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Masses kept in memory.
        MASS_CACHE: Vec<f64> = floats("massCache", "masc").output().wiring("only Maya's playback from memory uses it");
        /// Identifiers kept in memory.
        ID_CACHE: Vec<f64> = floats("idCache", "idc").output().wiring("only Maya's playback from memory uses it");
        /// Identifiers in ascending order.
        SORTED_ID: Vec<u32> = ints("sortedId", "sid").output().wiring("Maya's evaluation keeps its state in it");
        /// Index of each sorted identifier.
        ID_INDEX: Vec<u32> = ints("idIndex", "idix").output().wiring("Maya's evaluation keeps its state in it");
        /// The same at the start frame.
        NEXT_ID0: i64 = int("nextId0", "nid0", 0).elsewhere("numbers go on after the largest of `particleId0`");
        /// Initial times of birth.
        BIRTH_TIME0: Vec<f64> = floats("birthTime0", "bt0").elsewhere("`age0` says how old particles are at the start");
        /// Times of birth kept in memory.
        BIRTH_TIME_CACHE: Vec<f64> = floats("birthTimeCache", "btc").wiring("only Maya's playback from memory uses it");
        /// Initial ages.
        AGE0: Vec<f64> = floats("age0", "ag0").solved("nucleus_graph::compile::particle_ramps");
        /// Ages kept in memory.
        AGE_CACHE: Vec<f64> = floats("ageCache", "agc").output().wiring("only Maya's playback from memory uses it");
        /// Emitter of each particle.
        EMITTER_ID: Vec<f64> = floats("emitterId", "eid").output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Whether collisions create events.
        COLLISION_EVENTS: bool = toggle("collisionEvents", "cev", false).hidden().elsewhere("Maya sets it where there are events; the lists of events count");
        /// Whether particles die.
        DEATH: bool = toggle("death", "dth", false).hidden().elsewhere("Maya sets it where there are events; the lists of events count");
        /// State of the random number generator.
        RAND_STATE: [f64; 3] = vector("randState", "rnst", [0.0, 0.0, 0.0], ["rstx", "rsty", "rstz"]).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Whether the creation expression runs.
        EXECUTE_CREATION_EXPRESSION: bool = toggle("executeCreationExpression", "ece", false).hidden().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Whether the expression before dynamics runs.
        EXECUTE_RUNTIME_BEFORE_DYNAMICS_EXPRESSION: bool = toggle("executeRuntimeBeforeDynamicsExpression", "erbe", false).hidden().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Whether the expression after dynamics runs.
        EXECUTE_RUNTIME_AFTER_DYNAMICS_EXPRESSION: bool = toggle("executeRuntimeAfterDynamicsExpression", "erae", false).hidden().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Time, for expressions.
        TIME: f64 = float("time", "tim", 0.0).sink().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Frame, for expressions.
        FRAME: f64 = float("frame", "frm", 0.0).sink().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Text of the expression run in every frame.
        INTERNAL_RUNTIME_EXPRESSION: String = text("internalRuntimeExpression", "irx").elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Text of the expression run before dynamics.
        INTERNAL_RUNTIME_BEFORE_DYNAMICS_EXPRESSION: String = text("internalRuntimeBeforeDynamicsExpression", "irbx").elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Text of the expression run after dynamics.
        INTERNAL_RUNTIME_AFTER_DYNAMICS_EXPRESSION: String = text("internalRuntimeAfterDynamicsExpression", "irax").elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Text of the expression run for new particles.
        INTERNAL_CREATION_EXPRESSION: String = text("internalCreationExpression", "icx").elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Index of the particle that an expression runs for.
        CURRENT_PARTICLE: i64 = int("currentParticle", "xcp", 0).hidden().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Number of particles that died in the previous evaluation.
        DIED_LAST_TIME: i64 = int("diedLastTime", "dlt", 0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Change of the count in the previous evaluation.
        NET_EMITTED_LAST_TIME: i64 = int("netEmittedLastTime", "nlt", 0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Index of the first newly emitted particle.
        START_EMITTED_INDEX: i64 = int("startEmittedIndex", "sei", -1).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Positions, for fields.
        FIELD_DATA_POSITION: Vec<[f64; 3]> = vectors("fieldDataPosition", "fdp").output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Velocities, for fields.
        FIELD_DATA_VELOCITY: Vec<[f64; 3]> = vectors("fieldDataVelocity", "fdv").output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Masses, for fields.
        FIELD_DATA_MASS: Vec<f64> = floats("fieldDataMass", "fdm").output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Length of the time step, for fields.
        FIELD_DATA_DELTA_TIME: f64 = float("fieldDataDeltaTime", "fdt", 0.0).output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Positions, for emitters.
        EMITTER_DATA_POSITION: Vec<[f64; 3]> = vectors("emitterDataPosition", "edp").output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Velocities, for emitters.
        EMITTER_DATA_VELOCITY: Vec<[f64; 3]> = vectors("emitterDataVelocity", "edv").output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Length of the time step, for emitters.
        EMITTER_DATA_DELTA_TIME: f64 = float("emitterDataDeltaTime", "edt", 0.0).output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Reading it evaluates the node.
        FORCE_DYNAMICS: bool = toggle("forceDynamics", "fdn", false).sink().hidden().wiring("Maya's evaluation keeps its state in it");
        /// The saved current time.
        CURRENT_TIME_SAVE: f64 = float("currentTimeSave", "cts", 0.0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Time of this evaluation.
        EVALUATION_TIME: f64 = float("evaluationTime", "eti", 0.0).wiring("Maya's evaluation keeps its state in it");
        /// Time of the scene.
        CURRENT_SCENE_TIME: f64 = float("currentSceneTime", "cst", 1.0).wiring("Maya's evaluation keeps its state in it");
        /// Time of the previous evaluation.
        LAST_TIME_EVALUATED: f64 = float("lastTimeEvaluated", "lti", 0.0).output().wiring("Maya's evaluation keeps its state in it");
        /// Time of the scene at the previous evaluation.
        LAST_SCENE_TIME: f64 = float("lastSceneTime", "lst", 0.0).wiring("Maya's evaluation keeps its state in it");
        /// Time of the data kept in memory.
        CACHED_TIME: f64 = float("cachedTime", "chti", 0.0).output().wiring("only Maya's playback from memory uses it");
        /// Interval of scene time of this evaluation.
        SCENE_TIME_STEP_SIZE: f64 = float("sceneTimeStepSize", "sts", 0.0).output().wiring("Maya's evaluation keeps its state in it");
        /// Points of that geometry.
        INPUT_GEOMETRY_POINTS: Vec<[f64; 3]> = vectors("inputGeometryPoints", "igpt").output().elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Space in which that geometry is read.
        INPUT_GEOMETRY_SPACE: Choice = choice("inputGeometrySpace", "igs", 0, &[(0, "Geometry Local"), (1, "World"), (2, "Particle Local")]).elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Keeps the number of particles equal to the number of points of that geometry.
        ENFORCE_COUNT_FROM_HISTORY: bool = toggle("enforceCountFromHistory", "ecfh", true).elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Space in which that geometry is moved.
        TARGET_GEOMETRY_SPACE: Choice = choice("targetGeometrySpace", "tgs", 2, &[(0, "Geometry Local"), (1, "World"), (2, "Particle Local")]).elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Whether collisions have been computed.
        COLLISIONS: bool = toggle("collisions", "col", false).hidden().elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Bounce of a classic collider.
        COLLISION_RESILIENCE: f64 = float("collisionResilience", "crs", 0.0).elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Friction of a classic collider.
        COLLISION_FRICTION: f64 = float("collisionFriction", "cfr", 0.0).elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Offset from a classic collider.
        COLLISION_OFFSET: f64 = float("collisionOffset", "cof", 0.0).elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Number of events so far.
        TOTAL_EVENT_COUNT: i64 = int("totalEventCount", "tec", 0).output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Whether an event has happened.
        EVENT_TEST: bool = toggle("eventTest", "evt", false).output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Number of events up to the previous evaluation.
        LAST_TOTAL_EVENT_COUNT: i64 = int("lastTotalEventCount", "ltec", 0).wiring("Maya's evaluation keeps its state in it");
        /// Seed of the random numbers of events.
        EVENT_SEED: i64 = int("eventSeed", "esd", 0).elsewhere("`particleId0` and the numbers of particles give the random draws of events");
        /// State of the random number generator of events.
        EVENT_RAND_STATE: [f64; 3] = vector("eventRandState", "erst", [0.0, 0.0, 0.0], ["ersx", "ersy", "ersz"]).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Debug drawing, for Maya's developers.
        DEBUG_DRAW: i64 = int("debugDraw", "dbd", 0).hidden().elsewhere("only Maya draws particles so");
        /// Number of events.
        NUMBER_OF_EVENTS: i64 = int("numberOfEvents", "nev", 0).wiring("Maya's evaluation keeps its state in it");
        /// Number of event names ever assigned.
        EVENT_NAME_COUNT: i64 = int("eventNameCount", "enc", 0).wiring("Maya's evaluation keeps its state in it");
        /// Inherits the colour of the emitter.
        INHERIT_COLOR: bool = toggle("inheritColor", "inc", false).elsewhere("only Maya draws particles so");
        /// Whether dynamics are evaluated.
        DO_DYNAMICS: bool = toggle("doDynamics", "ddy", false).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Whether emission is evaluated.
        DO_EMISSION: bool = toggle("doEmission", "dem", false).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Whether emission is always evaluated.
        FORCE_EMISSION: bool = toggle("forceEmission", "fem", false).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Whether ages are updated.
        DO_AGE: bool = toggle("doAge", "dag", false).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Time of the last update.
        AGES_LAST_DONE: f64 = float("agesLastDone", "agld", 0.0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Time of the last evaluation.
        TIME_LAST_COMPUTED: f64 = float("timeLastComputed", "tlc", 0.0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Whether its parent has moved.
        PARENT_MATRIX_DIRTY: bool = toggle("parentMatrixDirty", "pmd", false).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Version of the saved node.
        NEW_FILE_FORMAT: i64 = int("newFileFormat", "nff", 0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Draws particles from back to front.
        DEPTH_SORT: bool = toggle("depthSort", "ds", false).elsewhere("only Maya draws particles so");
        /// Whether clouds are drawn without an axis.
        DISABLE_CLOUD_AXIS: bool = toggle("disableCloudAxis", "dca", false).elsewhere("only Maya draws particles so");
        /// Whether only the direction of velocities is used.
        NORMALIZE_VELOCITY: bool = toggle("normalizeVelocity", "nvl", false).elsewhere("only Maya draws particles so");
        /// Whether a cache of another type is read.
        USE_CUSTOM_CACHE: bool = toggle("useCustomCache", "ucc", false).wiring("only Maya's playback from memory uses it");
    }
    "Internal" {
        /// Sum of the forces of all fields, per particle.
        FORCE: Vec<[f64; 3]> = vectors("force", "frc").output().hidden().elsewhere("an output that only Maya's expressions and shaders read");
        /// Identifier of the next particle.
        NEXT_ID: i64 = int("nextId", "nid", 0).hidden().wiring("Maya's evaluation keeps its state in it");
        /// Whether the largest number of particles is reached, which stops emitters.
        IS_FULL: bool = toggle("isFull", "ifl", false).output().hidden().wiring("Maya's evaluation keeps its state in it");
        /// Interval of this evaluation, for emitters.
        TIME_STEP_SIZE: f64 = float("timeStepSize", "tss", 0.0).output().hidden().wiring("Maya's evaluation keeps its state in it");
        /// The start frame as a time, for emitters.
        START_TIME: f64 = float("startTime", "stt", 0.0).output().hidden().wiring("Maya's evaluation keeps its state in it");
    }
    "Connections" {
        /// Forces of the fields, one list per field.
        INPUT_FORCE: Plugged = plug("inputForce", "ifc", Data::Vectors).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Transform at the previous evaluation.
        LAST_WORLD_MATRIX: Plugged = plug("lastWorldMatrix", "lwm", Data::Matrix).output().wiring("Maya's evaluation keeps its state in it");
        /// Map from identifiers to indices.
        ID_MAPPING: Plugged = plug("idMapping", "idm", Data::Bundle).output().wiring("Maya's evaluation keeps its state in it");
        /// Particles that this object emits.
        EMISSION: Plugged = plug("emission", "emt", Data::NewParticles).output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Particles from emitters.
        NEW_PARTICLES: Plugged = plug("newParticles", "npt", Data::NewParticles).multi().sink().solved("nucleus_graph::compile::emission");
        /// Inputs of expressions.
        INPUT: Plugged = plug("input", "xi", Data::Bundle).multi().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Outputs of expressions.
        OUTPUT: Plugged = plug("output", "xo", Data::Bundle).multi().output().elsewhere("Maya's expressions are not run; `creationExpression` and `runtimeExpression` of a nParticle are");
        /// Data of the particles for fields.
        FIELD_DATA: Plugged = plug("fieldData", "fd", Data::FieldData).output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Data of the particles for emitters.
        EMITTER_DATA: Plugged = plug("emitterData", "ed", Data::Bundle).output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Geometry that a soft body is made from.
        INPUT_GEOMETRY: Plugged = plug("inputGeometry", "igeo", Data::Mesh).elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Geometry that a soft body moves.
        TARGET_GEOMETRY: Plugged = plug("targetGeometry", "tgeo", Data::Mesh).output().elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Transform of that geometry.
        TARGET_GEOMETRY_WORLD_MATRIX: Plugged = plug("targetGeometryWorldMatrix", "tgm", Data::Matrix).elsewhere("only classic soft bodies use it; a nCloth stands for them");
        /// Names of the UV sets of goals.
        GOAL_UV_SET_NAME: Plugged = plug("goalUvSetName", "guv", Data::Text).multi().elsewhere("only classic goals use it; a dynamicConstraint or a field stands for them");
        /// Classic colliders, one bundle each.
        COLLISION_DATA: Plugged = plug("collisionData", "cda", Data::Bundle).elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Surface of a classic collider.
        COLLISION_GEOMETRY: Plugged = plug("collisionGeometry", "cge", Data::Mesh).elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Collisions of this evaluation.
        COLLISION_RECORDS: Plugged = plug("collisionRecords", "crc", Data::Bundle).output().elsewhere("an output that only Maya's expressions and shaders read");
        /// Particles that an event emits into.
        EVENT_TARGET: Plugged = plug("eventTarget", "etg", Data::Message).multi().elsewhere("events are counted through, and `eventParticles` names what they emit into");
        /// Names of events.
        EVENT_NAME: Plugged = plug("eventName", "evn", Data::Text).multi().elsewhere("events are counted through, and `eventParticles` names what they emit into");
        /// Whether each event is active.
        EVENT_VALID: Plugged = plug("eventValid", "evv", Data::Number).multi().elsewhere("events are counted through, and `eventParticles` names what they emit into");
        /// Number of the collision at which each event happens, from 1; 0 is every one.
        EVENT_COUNT: Vec<f64> = floats("eventCount", "ecp").multi().solved("nucleus_core::particles::events");
        /// Number of particles that each event emits; the colliding one lives on.
        EVENT_EMIT: Vec<f64> = floats("eventEmit", "eve").multi().solved("nucleus_core::particles::events");
        /// Number of particles that each event splits the colliding one into, with its age.
        EVENT_SPLIT: Vec<f64> = floats("eventSplit", "evs").multi().solved("nucleus_core::particles::events");
        /// Whether the particle dies with each event: 1 or 0.
        EVENT_DIE: Vec<f64> = floats("eventDie", "evd").multi().solved("nucleus_core::particles::events");
        /// Whether the number of particles of each event is drawn from 1 up to it: 1 or 0.
        EVENT_RANDOM: Vec<f64> = floats("eventRandom", "evr").multi().solved("nucleus_core::particles::events");
        /// Spread of the new particles of each event about the rebound, as a share of 90°; 0.5 when left out.
        EVENT_SPREAD: Vec<f64> = floats("eventSpread", "esp").multi().solved("nucleus_core::particles::events");
        /// Procedure called by each event.
        EVENT_PROC: Plugged = plug("eventProc", "epr", Data::Text).multi().elsewhere("events are counted through, and `eventParticles` names what they emit into");
        /// Data for instanced geometry.
        INSTANCE_DATA: Plugged = plug("instanceData", "idt", Data::Bundle).multi().elsewhere("only Maya draws particles so");
        /// Fields that belong to it.
        FIELD_CONNECTIONS: Plugged = plug("fieldConnections", "fc", Data::Message).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Colliders that belong to it.
        COLLISION_CONNECTIONS: Plugged = plug("collisionConnections", "cc", Data::Message).multi().elsewhere("only classic collisions use it; here objects of a nucleus collide");
        /// Nodes that refer to it.
        CONNECTIONS_TO_ME: Plugged = plug("connectionsToMe", "ct", Data::Message).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Helper nodes that it owns.
        AUXILIARIES_OWNED: Plugged = plug("auxiliariesOwned", "ao", Data::Message).wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Emitters that belong to it.
        EMITTER_CONNECTIONS: Plugged = plug("emitterConnections", "ec", Data::Message).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Stands for the node itself.
        SHAPE_NAME_MSG: Plugged = plug("shapeNameMsg", "snmg", Data::Message).wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Values that shaders read for each particle.
        SAMPLER_PER_PARTICLE_DATA: Plugged = plug("samplerPerParticleData", "spd", Data::Bundle).output().elsewhere("only Maya draws particles so");
        /// Settings of fields per particle.
        PP_FIELD_DATA: Plugged = plug("ppFieldData", "ppfd", Data::FieldSettings).multi().output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// The same, for fields that the particles own.
        OWNER_PP_FIELD_DATA: Plugged = plug("ownerPPFieldData", "opfd", Data::FieldSettings).multi().output().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Positions after deformers.
        DEFORMED_POSITION: Plugged = plug("deformedPosition", "dpos", Data::Mesh).elsewhere("only classic soft bodies use it; a nCloth stands for them");
    }
}
