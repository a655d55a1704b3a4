//! What all dynamic objects inherit from classic particles. None of it takes effect yet.

use super::key::{choice, float, floats, int, plug, toggle, vectors};
use super::table::node_table;
use super::{Choice, Plugged};

node_table! {
    /// The classic particle shape, which every object of a nucleus descends from.
    PARTICLE = "particle", inherits None, hides [];
    "General" {
        /// How many particles there are.
        COUNT: i64 = int("count", "cnt", 0);
    }
    "Time Attributes" {
        /// The time it is evaluated for; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0);
        /// The frame of its initial state; driven by its nucleus.
        START_FRAME: f64 = float("startFrame", "stf", 1.0);
    }
    "Dynamic Properties" {
        /// How much of the fields' forces is felt.
        DYNAMICS_WEIGHT: f64 = float("dynamicsWeight", "dw", 1.0).min(0.0).max(1.0);
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
        WORLD_POSITION: Vec<[f64; 3]> = vectors("worldPosition", "wps");
        /// How fast the particles are in world space.
        WORLD_VELOCITY: Vec<[f64; 3]> = vectors("worldVelocity", "wvl");
        /// Mass of each particle.
        MASS: Vec<f64> = floats("mass", "mas");
        /// Number of each particle.
        PARTICLE_ID: Vec<f64> = floats("particleId", "id");
        /// When each particle came to be.
        BIRTH_TIME: Vec<f64> = floats("birthTime", "bt");
        /// How old each particle is.
        AGE: Vec<f64> = floats("age", "ag");
    }
    "Emission Attributes" {
        /// Particles die when they leave the volume they came from.
        DIE_ON_EMISSION_VOLUME_EXIT: bool = toggle("dieOnEmissionVolumeExit", "dve", false);
        /// Emits in world space.
        EMISSION_IN_WORLD: bool = toggle("emissionInWorld", "eiw", true);
        /// No more particles than this; -1 is no bound.
        MAX_COUNT: i64 = int("maxCount", "mxc", -1);
        /// Share of the particles that is emitted.
        LEVEL_OF_DETAIL: f64 = float("levelOfDetail", "lod", 1.0).min(0.0).max(1.0);
        /// How much velocity particles take from their emitter.
        INHERIT_FACTOR: f64 = float("inheritFactor", "inh", 0.0).min(0.0).soft(0.0, 1.0);
        /// Where random emission begins.
        SEED: i64 = int("seed", "sd", 1);
    }
    "Lifespan" {
        /// How it is decided how long particles live.
        LIFESPAN_MODE: Choice = choice("lifespanMode", "lfm", 0, &[(0, "Live forever"), (1, "Constant"), (2, "Random range"), (3, "lifespanPP only")]);
        /// By how much the time they live varies.
        LIFESPAN_RANDOM: f64 = float("lifespanRandom", "lfr", 0.0);
        /// How long each particle lives in the end.
        FINAL_LIFESPAN_PP: Vec<f64> = floats("finalLifespanPP", "flp");
        /// Where random lifespans begin.
        GENERAL_SEED: i64 = int("generalSeed", "gsd", 0);
    }
    "Time/General" {
        /// Runs expressions after the solver.
        EXPRESSIONS_AFTER_DYNAMICS: bool = toggle("expressionsAfterDynamics", "ead", false);
    }
    "Goal Weights and Objects" {
        /// How the pull of goals changes with their weight.
        GOAL_SMOOTHNESS: f64 = float("goalSmoothness", "gsm", 3.0).min(0.0).soft(0.0, 10.0);
        /// What particles are drawn to.
        GOAL_GEOMETRY: Plugged = plug("goalGeometry", "ggeo");
        /// How strongly they are drawn.
        GOAL_WEIGHT: f64 = float("goalWeight", "gw", 0.0).min(0.0).max(1.0);
        /// Whether they are drawn.
        GOAL_ACTIVE: bool = toggle("goalActive", "ga", true);
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
}
