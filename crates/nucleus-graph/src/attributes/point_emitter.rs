//! Emitters.

use super::fields::dyn_base::DYN_BASE;
use super::key::{Plugged, choice, float, floats, int, plug, texture, toggle, vector, vectors};
use super::kind::Data;
use super::node_type::node_table;
use super::value::Choice;

node_table! {
    /// Emits particles from a point, a volume or the surface of a mesh.
    POINT_EMITTER = "pointEmitter", inherits Some(&DYN_BASE), hides [];
    "Emitter" {
        /// Source of the particles: a point, a surface, a curve or a volume.
        EMITTER_TYPE: Choice = choice("emitterType", "emt", 1, &[(0, "Directional"), (1, "Omni"), (2, "Surface"), (3, "Curve"), (4, "Volume")]).solved("nucleus_graph::compile::emission");
        /// Particles emitted per second.
        RATE: f64 = float("rate", "rat", 100.0).min(0.0).soft(0.0, 500.0).solved("nucleus_graph::compile::emission");
        /// Scales the rate by the length of a curve or the area of a surface.
        SCALE_RATE_BY_OBJECT_SIZE: bool = toggle("scaleRateByObjectSize", "sro", true).solved("nucleus_graph::compile::emission");
        /// Scales the rate by the speed of the emitter.
        SCALE_RATE_BY_SPEED: bool = toggle("scaleRateBySpeed", "srs", false).solved("nucleus_graph::compile::emission");
        /// Reads a rate for each point of the owner.
        USE_RATE_PP: bool = toggle("useRatePP", "urpp", false).elsewhere("no emitter emits from the points of another object");
        /// Passes texture coordinates to the particles.
        NEED_PARENT_UV: bool = toggle("needParentUV", "npuv", false).elsewhere("only Maya's expressions and shaders read where a particle comes from");
        /// Restarts the random numbers periodically.
        CYCLE_EMISSION: Choice = choice("cycleEmission", "cye", 0, &[(0, "None (timeRandom off)"), (1, "Frame (timeRandom on)")]).solved("nucleus_graph::compile::emission");
        /// Period of that restart in frames.
        CYCLE_INTERVAL: i64 = int("cycleInterval", "cyi", 1).min(1.0).soft(1.0, 100.0).solved("nucleus_graph::compile::emission");
        /// Largest distance from the emitter at which particles start.
        MAX_DISTANCE: f64 = float("maxDistance", "max", 0.0).soft(0.0, 10.0).unit("scene units").solved("nucleus_graph::compile::emission");
        /// Smallest distance from the emitter at which particles start.
        MIN_DISTANCE: f64 = float("minDistance", "min", 0.0).soft(0.0, 10.0).unit("scene units").solved("nucleus_graph::compile::emission");
        /// Direction of emission, for directional emitters.
        DIRECTION: [f64; 3] = vector("direction", "d", [1.0, 0.0, 0.0], ["dx", "dy", "dz"]).soft(-10.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Spread of the directions: 1 is a half space, and 0 still 0.005 degrees.
        SPREAD: f64 = float("spread", "spr", 0.0).min(0.0).max(1.0).solved("nucleus_graph::compile::emission");
        /// Factor on the initial speed.
        SPEED: f64 = float("speed", "spd", 1.0).soft(0.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Random variation of the initial speed.
        SPEED_RANDOM: f64 = float("speedRandom", "srnd", 0.0).min(0.0).soft(0.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Initial speed tangential to the surface.
        TANGENT_SPEED: f64 = float("tangentSpeed", "tspd", 0.0).soft(0.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Initial speed along the normal of a surface or curve.
        NORMAL_SPEED: f64 = float("normalSpeed", "nspd", 1.0).soft(0.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Time of the evaluation; driven by `time1.outTime`.
        CURRENT_TIME: f64 = float("currentTime", "ct", 0.0).wiring("the clock of the nucleus counts");
        /// Rate at each point of the owner.
        RATE_PP: Vec<f64> = floats("ratePP", "rpp").sink().elsewhere("no emitter emits from the points of another object");
        /// Identifiers of the owner's particles.
        PARENT_ID: Vec<f64> = floats("parentId", "paid").sink().elsewhere("only Maya's expressions and shaders read where a particle comes from");
        /// Scales the rate by a texture.
        ENABLE_TEXTURE_RATE: bool = toggle("enableTextureRate", "etr", false).solved("nucleus_graph::compile::emission").fixed();
        /// Texture of the rate of a surface emitter: white emits with the full rate, black not at all.
        RATE_MAP: f64 = texture("rateMap", "rateMap", 1.0).solved("nucleus_graph::compile::emission").extension();
        /// Points of the curve of a curve emitter, in its own space.
        CURVE_POINTS: Vec<[f64; 3]> = vectors("curvePoints", "curvePoints").unit("scene units").solved("nucleus_graph::compile::emission").extension();
        /// Texture of the rate.
        TEXTURE_RATE: [f64; 3] = vector("textureRate", "txr", [0.0, 0.0, 0.0], ["txrr", "txrg", "txrb"]).min(0.0).max(1.0).elsewhere("`rateMap` is the texture");
        /// Inverts that texture.
        EMIT_FROM_DARK: bool = toggle("emitFromDark", "efd", false).solved("nucleus_graph::compile::emission").fixed();
        /// Sets the colour of new particles.
        INHERIT_COLOR: bool = toggle("inheritColor", "inhc", false).elsewhere("the ramps of the nParticle give its colour and opacity");
        /// Sets the opacity of new particles.
        INHERIT_OPACITY: bool = toggle("inheritOpacity", "inho", false).elsewhere("the ramps of the nParticle give its colour and opacity");
        /// Inverts that opacity.
        INVERT_OPACITY: bool = toggle("invertOpacity", "invo", false).elsewhere("the ramps of the nParticle give its colour and opacity");
        /// Uses luminance as opacity.
        USE_LUMINANCE: bool = toggle("useLuminance", "usel", false).elsewhere("the ramps of the nParticle give its colour and opacity");
        /// Colour of new particles.
        PARTICLE_COLOR: [f64; 3] = vector("particleColor", "pc", [0.5, 0.5, 0.5], ["pcr", "pcg", "pcb"]).min(0.0).max(1.0).elsewhere("the ramps of the nParticle give its colour and opacity");
        /// Shape of the emission volume.
        VOLUME_SHAPE: Choice = choice("volumeShape", "vol", 0, &[(0, "Cube"), (1, "Sphere"), (2, "Cylinder"), (3, "Cone"), (4, "Torus")]).solved("nucleus_graph::compile::emission");
        /// Offset of the volume from the emitter.
        VOLUME_OFFSET: [f64; 3] = vector("volumeOffset", "vof", [0.0, 0.0, 0.0], ["vfx", "vfy", "vfz"]).solved("nucleus_graph::compile::emission");
        /// Sampling quality of points in the volume.
        VOLUME_EFFICIENCY: f64 = float("volumeEfficiency", "vef", 0.0).output().elsewhere("places in a volume are found however small its share of the box");
        /// Sweep angle of a round volume.
        VOLUME_SWEEP: f64 = float("volumeSweep", "vsw", 360.0).min(0.0).max(360.0).unit("degrees").solved("nucleus_graph::compile::emission");
        /// Section radius of a torus.
        SECTION_RADIUS: f64 = float("sectionRadius", "vsr", 0.5).min(0.0).soft(0.0, 1.0).unit("scene units").solved("nucleus_graph::compile::emission");
        /// Speed away from the centre of a cube or sphere.
        AWAY_FROM_CENTER: f64 = float("awayFromCenter", "afc", 1.0).soft(-10.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Speed away from the axis of a cylinder, cone or torus.
        AWAY_FROM_AXIS: f64 = float("awayFromAxis", "afa", 1.0).soft(-10.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Speed along the axis.
        ALONG_AXIS: f64 = float("alongAxis", "alx", 0.0).soft(-10.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Speed around the axis.
        AROUND_AXIS: f64 = float("aroundAxis", "arx", 0.0).soft(-10.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Speed in random directions.
        RANDOM_DIRECTION: f64 = float("randomDirection", "rnd", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_graph::compile::emission");
        /// Speed along `direction`.
        DIRECTIONAL_SPEED: f64 = float("directionalSpeed", "drs", 0.0).min(0.0).soft(0.0, 10.0).solved("nucleus_graph::compile::emission");
        /// Scales speeds by the size of the volume.
        SCALE_SPEED_BY_SIZE: bool = toggle("scaleSpeedBySize", "ssz", false).solved("nucleus_graph::compile::emission");
        /// Whether Maya draws arrows.
        DISPLAY_SPEED: bool = toggle("displaySpeed", "dss", true).elsewhere("only Maya's viewport draws it");
    }
    "Connections" {
        /// Time since the last evaluation.
        DELTA_TIME_CYCLE: Plugged = plug("deltaTimeCycle", "dtc", Data::Number).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Share of the emitter's velocity that particles inherit; driven by the particles.
        INHERIT_FACTOR: Plugged = plug("inheritFactor", "inh", Data::Number).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Whether the largest number of particles is reached; driven by the particles.
        IS_FULL: Plugged = plug("isFull", "full", Data::Number).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Start time; driven by the particles.
        START_TIME: Plugged = plug("startTime", "stt", Data::Number).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Length of the time step; driven by the particles.
        DELTA_TIME: Plugged = plug("deltaTime", "dt", Data::Number).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Fraction of a particle carried over to the next step.
        EMIT_COUNT_REMAINDER: Plugged = plug("emitCountRemainder", "ecr", Data::Numbers).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// Surface or curve over the step.
        SWEPT_GEOMETRY: Plugged = plug("sweptGeometry", "swge", Data::Bundle).wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// New particles.
        OUTPUT: Plugged = plug("output", "ot", Data::NewParticles).multi().output().solved("nucleus_graph::compile::emission");
        /// Seed of the random numbers; driven by the particles.
        SEED: Plugged = plug("seed", "sd", Data::Number).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
        /// State of the random number generator.
        RAND_STATE: Plugged = plug("randState", "rst", Data::Vector).multi().wiring("Maya's wiring: what it carries is read from the nodes directly");
    }
}
