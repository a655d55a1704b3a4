//! Particles. Rows of its base are repeated where they mean something else, or take effect for particles alone, or
//! for cloth alone.

use std::borrow::Cow;

use super::key::{
    Plugged, choice, color_ramp, float, floats, int, plug, ramp, text, texts, toggle, vector, vectors,
};
use super::kind::Data;
use super::n_base::N_BASE;
use super::node_type::node_table;
use super::value::{Choice, ColorPoint, RampPoint};

/// Inputs of a ramp.
const INPUTS: &[(i32, &str)] = &[
    (0, "Off"),
    (1, "Age"),
    (2, "Normalized Age"),
    (3, "Speed"),
    (4, "Acceleration"),
    (5, "Particle ID"),
    (6, "Randomized ID"),
    (7, "Radius"),
];

/// Inputs of a ramp of colours.
const COLOUR_INPUTS: &[(i32, &str)] = &[
    (0, "Constant"),
    (1, "Age"),
    (2, "Normalized Age"),
    (3, "Speed"),
    (4, "Acceleration"),
    (5, "Particle ID"),
    (6, "Randomized ID"),
    (7, "Radius"),
];

/// 1 everywhere.
const FULL: &[RampPoint] = &[RampPoint { position: 0.0, value: 1.0, interpolation: Choice(1) }];

/// Attributes without effect on points without a mesh.
#[rustfmt::skip] // a name per line would be a page of its own
const NO_USE_TO_PARTICLES: &[&str] = &[
    "useStartupCache", "startupCachePath", "startupCacheFrame", "inputGeometry", "inputGeometryPoints",
    "inputGeometrySpace", "enforceCountFromHistory", "targetGeometry", "targetGeometryWorldMatrix",
    "targetGeometrySpace", "cacheData", "cacheWidth", "traceDepth", "collisionData", "collisionGeometry",
    "collisionResilience", "collisionFriction", "collisionOffset", "collisionConnections", "deformedPosition",
    "inputMesh", "positions", "startPositions", "startVelocities", "thickness", "thicknessMap",
    "thicknessPerVertex", "bounceMap", "bouncePerVertex", "frictionMap", "frictionPerVertex", "dampMap",
    "dampPerVertex", "stickinessMap", "stickinessPerVertex", "collideStrengthMap", "collideStrengthPerVertex",
    "selfCollisionFlag", "massMap", "massPerVertex", "restLengthScale", "airPushVorticity", "pushOut",
    "pushOutRadius", "crossoverPush", "trappedCheck", "forceField", "fieldMagnitude", "fieldMagnitudeMap",
    "fieldMagnitudePerVertex", "fieldDistance", "fieldScale", "thicknessMapType", "bounceMapType",
    "frictionMapType", "stickinessMapType", "collideStrengthMapType", "dampMapType", "massMapType",
    "fieldMagnitudeMapType", "localSpaceOutput",
];

node_table! {
    /// Particles: balls without links, which collide with cloth, colliders and each other, or liquids.
    N_PARTICLE = "nParticle", inherits Some(&N_BASE), hides [NO_USE_TO_PARTICLES];
    "Hidden" {
        /// Obsolete in Maya.
        NUM_SUBDIVISIONS: i64 = int("numSubdivisions", "nsub", 2).unused().hidden();
        /// Without effect: particles have no links.
        SCALING_RELATION: Choice = choice("scalingRelation", "srl", 0, &[(0, "Link"), (1, "Object Space"), (2, "World Space")]).unused().hidden();
        /// Whether Maya computes liquids in parallel.
        PARALLEL_SPH: bool = toggle("parallelSPH", "psph", false).hidden().elsewhere("`nucleus run --threads` says how many threads all solvers use");
        /// Whether Maya searches for neighbours more often.
        RECOMPUTE_PAIRS_SPH: bool = toggle("recomputePairsSPH", "rpsp", false).hidden().elsewhere("neighbours are always searched often enough");
    }
    "Per Particle (Array) Attributes" {
        /// Initial positions in world space, if `position0` is not set.
        POSITION: Vec<[f64; 3]> = vectors("position", "pos").unit("scene units").solved("nucleus_graph::compile");
        /// Initial velocities in world space, if `velocity0` is not set: one for each point, or one for all.
        VELOCITY: Vec<[f64; 3]> = vectors("velocity", "vel").unit("scene units/s").solved("nucleus_graph::compile");
    }
    "Initial State" {
        /// Initial positions in world space. Of an OBJ file, the points are taken.
        POSITION0: Vec<[f64; 3]> = vectors("position0", "pos0").unit("scene units").solved("nucleus_graph::compile");
        /// Initial velocities in world space: one for each point, or one for all.
        VELOCITY0: Vec<[f64; 3]> = vectors("velocity0", "vel0").unit("scene units/s").solved("nucleus_graph::compile");
        /// Lower corner of a box that a grid of particles fills; Minimum Corner of Maya's particle tool.
        MINIMUM_CORNER: [f64; 3] = vector("minimumCorner", "minimumCorner", [0.0, 0.0, 0.0], ["minimumCornerX", "minimumCornerY", "minimumCornerZ"]).unit("scene units").solved("nucleus_graph::compile").fixed().extension();
        /// Upper corner of that box; Maximum Corner of Maya's particle tool.
        MAXIMUM_CORNER: [f64; 3] = vector("maximumCorner", "maximumCorner", [0.0, 0.0, 0.0], ["maximumCornerX", "maximumCornerY", "maximumCornerZ"]).unit("scene units").solved("nucleus_graph::compile").fixed().extension();
        /// Name of a closed mesh whose volume a grid of particles fills, as Maya's Fill Object does.
        FILL_MESH: String = text("fillMesh", "fillMesh").solved("nucleus_graph::compile").extension();
        /// Distance between the particles of the grid. 0: the rest distance of a liquid, or the diameter of a ball.
        PARTICLE_SPACING: f64 = float("particleSpacing", "particleSpacing", 0.0).min(0.0).max(1e9).unit("scene units").solved("nucleus_graph::compile").fixed().extension();
    }
    "Lifespan" {
        /// With `lifespanMode: "lifespanPP only"`, lifespan of each initial particle; others live forever.
        LIFESPAN_PP: Vec<f64> = floats("lifespanPP", "lifespanPP").unit("s").solved("nucleus_graph::compile::particle_ramps").extension();
    }
    "Expressions" {
        /// Statements that run when a particle is born from an emitter: `vy = 10 + 5 * rand; lifespan = 1 + rand2`. They set vx, vy, vz, lifespan, x, y and z, and read id, time, rand, rand2 and rand3 too.
        CREATION_EXPRESSION: String = text("creationExpression", "creationExpression").solved("nucleus_graph::compile::particle_expressions").extension();
        /// Statements that run for each particle at the start of each frame: `vx = vx + sin(3 * age)`. They set vx, vy, vz and lifespan, and read x, y, z, age, id, time, rand, rand2 and rand3 too.
        RUNTIME_EXPRESSION: String = text("runtimeExpression", "runtimeExpression").solved("nucleus_graph::compile::particle_expressions").extension();
    }
    "Collision Events" {
        /// The nParticle that collision events emit into: one for all, or a list with one per event; this one when left out or empty.
        EVENT_PARTICLES: Vec<String> = texts("eventParticles", "eventParticles").solved("nucleus_graph::compile::particle_ramps").extension();
        /// Probability of each collision event, 0 to 1; 1 when left out.
        EVENT_PROBABILITY: Vec<f64> = floats("eventProbability", "eventProbability").solved("nucleus_core::particles::events").extension();
    }
    "Dynamic Properties" {
        /// Mass of each particle, in Classic and Physical.
        POINT_MASS: f64 = float("pointMass", "pmss", 1.0).min(0.0).soft(0.001, 10.0).unit("kg").solved("nucleus_graph::compile").fixed();
        /// Damping of velocities, also in a vacuum; for small values the share lost in 1/24 s.
        DAMP: f64 = float("damp", "adng", 0.0).min(0.0).soft(0.0, 10.0).solved("nucleus_core::particles::slowing");
        /// Strength of the attraction to an input mesh.
        INPUT_ATTRACT: f64 = float("inputAttract", "iatt", 0.0).soft(0.0, 1.0).elsewhere("particles are made from no mesh that could draw them; nCloth has `inputMeshAttract`");
        /// Damping of the oscillation about the input mesh: 0 is undamped, 1 is critical.
        INPUT_ATTRACT_DAMP: f64 = float("inputAttractDamp", "iadm", 0.5).soft(0.0, 1.0).elsewhere("particles are made from no mesh that could draw them; nCloth has `inputMeshAttract`");
        /// Excludes the object from the solver's gravity.
        IGNORE_SOLVER_GRAVITY: bool = toggle("ignoreSolverGravity", "igsg", false).solved("nucleus_core::integrate::predict");
        /// Excludes the object from the solver's wind.
        IGNORE_SOLVER_WIND: bool = toggle("ignoreSolverWind", "igsw", false).solved("nucleus_core::integrate::aerodynamics");
        /// Air drag against the motion, equal in all directions. The lighter the particle, the larger the deceleration.
        DRAG: f64 = float("drag", "drg", 0.01).soft(0.0, 2.0).unit("per 1/24 s").solved("nucleus_core::integrate::aerodynamics");
        /// Ramp of factors on mass, per particle.
        MASS_SCALE: Cow<'static, [RampPoint]> = ramp("massScale", "mssc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the mass ramp.
        MASS_SCALE_INPUT: Choice = choice("massScaleInput", "msli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the mass ramp.
        MASS_SCALE_INPUT_MAX: f64 = float("massScaleInputMax", "msix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of mass, as a share.
        MASS_SCALE_RANDOMIZE: f64 = float("massScaleRandomize", "msr", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
    }
    "Wind Field Generation" {
        /// Whether particles shadow each other from the wind.
        WIND_SELF_SHADOW: bool = toggle("windSelfShadow", "wssh", false).elsewhere("balls keep no wind from each other: only surfaces do");
    }
    "Collisions" {
        /// Elements that collide. Particles are points at any value.
        COLLISION_FLAG: Choice = choice("collisionFlag", "cofl", 1, &[(1, "Vertex"), (2, "Edge"), (3, "Face")]).solved("nucleus_graph::compile");
        /// Solver data that Maya draws.
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off"), (1, "Collision Thickness"), (2, "Self Collision Thickness")]).elsewhere("only Maya's viewport draws it");
        /// Collision radius, as a multiple of `radius`. Default of a liquid: half of its rest distance, so that it touches walls.
        COLLIDE_WIDTH_SCALE: f64 = float("collideWidthScale", "cwds", 1.0).soft(0.0, 2.0).solved("nucleus_core::contact::material");
        /// Collision radius among the particles themselves, as a multiple of the collision radius.
        SELF_COLLIDE_WIDTH_SCALE: f64 = float("selfCollideWidthScale", "scws", 1.0).soft(0.001, 2.0).solved("nucleus_graph::compile::thickness");
        /// Ramp of factors on friction, per particle.
        FRICTION_SCALE: Cow<'static, [RampPoint]> = ramp("frictionScale", "frsc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the friction ramp.
        FRICTION_SCALE_INPUT: Choice = choice("frictionScaleInput", "fsli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the friction ramp.
        FRICTION_SCALE_INPUT_MAX: f64 = float("frictionScaleInputMax", "fsix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of friction, as a share.
        FRICTION_RANDOMIZE: f64 = float("frictionRandomize", "fcr", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
        /// Ramp of factors on stickiness, per particle.
        STICKINESS_SCALE: Cow<'static, [RampPoint]> = ramp("stickinessScale", "stsc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the stickiness ramp.
        STICKINESS_SCALE_INPUT: Choice = choice("stickinessScaleInput", "ssli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the stickiness ramp.
        STICKINESS_SCALE_INPUT_MAX: f64 = float("stickinessScaleInputMax", "ssix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of stickiness, as a share.
        STICKINESS_RANDOMIZE: f64 = float("stickinessRandomize", "stra", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
        /// Ramp of factors on collide strength, per particle.
        COLLIDE_STRENGTH_SCALE: Cow<'static, [RampPoint]> = ramp("collideStrengthScale", "clsc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the collide strength ramp.
        COLLIDE_STRENGTH_SCALE_INPUT: Choice = choice("collideStrengthScaleInput", "csli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the collide strength ramp.
        COLLIDE_STRENGTH_SCALE_INPUT_MAX: f64 = float("collideStrengthScaleInputMax", "csix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Ramp of factors on bounce, per particle.
        BOUNCE_SCALE: Cow<'static, [RampPoint]> = ramp("bounceScale", "bosc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the bounce ramp.
        BOUNCE_SCALE_INPUT: Choice = choice("bounceScaleInput", "bsli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the bounce ramp.
        BOUNCE_SCALE_INPUT_MAX: f64 = float("bounceScaleInputMax", "bsix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of bounce, as a share.
        BOUNCE_RANDOMIZE: f64 = float("bounceRandomize", "bora", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
    }
    "Emission Attributes" {
        /// New particles nearer to others than this share of their contact distance are left out; 0 keeps all.
        EMISSION_OVERLAP_PRUNING: f64 = float("emissionOverlapPruning", "eopr", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::occupancy");
    }
    "Rotation" {
        /// Contact turns the particles; their orientation is recorded.
        COMPUTE_ROTATION: bool = toggle("computeRotation", "cprt", false).solved("nucleus_core::particles::rotation").fixed();
        /// Share of its slip that a contact takes from a particle in a default substep; at 1 it rolls.
        ROTATION_FRICTION: f64 = float("rotationFriction", "rtfr", 0.9).min(0.0).max(1.0).soft(0.0, 1.0).solved("nucleus_core::particles::rotation");
        /// Share of the spin that is lost in 1/24 s, as a rate.
        ROTATION_DAMP: f64 = float("rotationDamp", "rtdp", 0.001).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::rotation");
    }
    "Liquid Simulation" {
        /// Simulates the particles as a liquid; Enable Liquid Simulation in Maya's attribute editor.
        ENABLE_SPH: bool = toggle("enableSPH", "esph", false).solved("nucleus_core::constraints::liquid");
        /// Resistance of the liquid to a change of volume: from 1 on it is incompressible, below it is compressible.
        INCOMPRESSIBILITY: f64 = float("incompressibility", "incp", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::constraints::liquid::density");
        /// Viscosity: the kinematic viscosity is its square times 0.01 m²/s. 1 is honey.
        VISCOSITY: f64 = float("viscosity", "visc", 0.1).min(0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::liquid::viscosity");
        /// Ramp of factors on viscosity, per particle.
        VISCOSITY_SCALE: Cow<'static, [RampPoint]> = ramp("viscosityScale", "vssc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the viscosity ramp.
        VISCOSITY_SCALE_INPUT: Choice = choice("viscosityScaleInput", "vsli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the viscosity ramp.
        VISCOSITY_SCALE_INPUT_MAX: f64 = float("viscosityScaleInputMax", "vsix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Surface tension over density, in 0.001 m³/s². Water has 0.073; at 1, drops of 1 cm keep together.
        SURFACE_TENSION: f64 = float("surfaceTension", "suft", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::liquid::surface_tension");
        /// Ramp of factors on surface tension, per particle.
        SURFACE_TENSION_SCALE: Cow<'static, [RampPoint]> = ramp("surfaceTensionScale", "stns", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the surface tension ramp.
        SURFACE_TENSION_SCALE_INPUT: Choice = choice("surfaceTensionScaleInput", "stli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the surface tension ramp.
        SURFACE_TENSION_SCALE_INPUT_MAX: f64 = float("surfaceTensionScaleInputMax", "stix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Number of particles that overlap at a point at rest, as balls of radius `radius` × `radiusScaleSPH`.
        REST_DENSITY: f64 = float("restDensity", "rdns", 2.0).min(1.0).soft(1.0, 2.0).solved("nucleus_core::constraints::liquid").fixed();
        /// Radius of a liquid's overlapping balls, as a multiple of `radius`. Usual: 0.5.
        RADIUS_SCALE_SPH: f64 = float("radiusScaleSPH", "rsph", 1.0).min(0.0).soft(0.0, 2.0).solved("nucleus_core::constraints::liquid").fixed();
    }
    "Shading" {
        /// Density at the surface of a liquid in pictures, the player and exports: a higher one leaves out sparse particles.
        THRESHOLD: f64 = float("threshold", "thr", 0.1).min(0.0).soft(0.0, 2.0).solved("nucleus_cache::liquid_surface").fixed();
        /// Opacity of the particles.
        OPACITY: f64 = float("opacity", "op", 1.0).min(0.0).max(1.0).solved("nucleus_core::particles::ramps").fixed();
        /// Ramp of factors on opacity, per particle.
        OPACITY_SCALE: Cow<'static, [RampPoint]> = ramp("opacityScale", "opc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the opacity ramp.
        OPACITY_SCALE_INPUT: Choice = choice("opacityScaleInput", "oci", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the opacity ramp.
        OPACITY_SCALE_INPUT_MAX: f64 = float("opacityScaleInputMax", "osis", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of opacity, as a share.
        OPACITY_SCALE_RANDOMIZE: f64 = float("opacityScaleRandomize", "osr", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
        /// Ramp of colours, per particle.
        COLOR: Cow<'static, [ColorPoint]> = color_ramp("color", "cl").solved("nucleus_core::particles::ramps").fixed();
        /// Input of the colour ramp.
        COLOR_INPUT: Choice = choice("colorInput", "coi", 0, COLOUR_INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the colour ramp.
        COLOR_INPUT_MAX: f64 = float("colorInputMax", "cimx", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of the position on the colour ramp.
        COLOR_RANDOMIZE: f64 = float("colorRandomize", "colr", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
        /// Ramp of colours of emitted light, per particle.
        INCANDESCENCE: Cow<'static, [ColorPoint]> = color_ramp("incandescence", "inca").solved("nucleus_core::particles::ramps").fixed();
        /// Input of the incandescence ramp.
        INCANDESCENCE_INPUT: Choice = choice("incandescenceInput", "ini", 0, COLOUR_INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the incandescence ramp.
        INCANDESCENCE_INPUT_MAX: f64 = float("incandescenceInputMax", "iimx", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of the position on the incandescence ramp.
        INCANDESCENCE_RANDOMIZE: f64 = float("incandescenceRandomize", "icar", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
    }
    "Particle Size" {
        /// Radius of each particle. Two particles touch at the sum of their radii.
        RADIUS: f64 = float("radius", "ra", 0.2).min(0.0).soft(0.0, 20.0).unit("scene units").solved("nucleus_core::contact::material").fixed();
        /// Ramp of factors on radius, per particle.
        RADIUS_SCALE: Cow<'static, [RampPoint]> = ramp("radiusScale", "rdc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the radius ramp.
        RADIUS_SCALE_INPUT: Choice = choice("radiusScaleInput", "rci", 0, &[(0, "Off"), (1, "Age"), (2, "Normalized Age"), (3, "Speed"), (4, "Acceleration"), (5, "Particle ID"), (6, "Randomized ID")]).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the radius ramp.
        RADIUS_SCALE_INPUT_MAX: f64 = float("radiusScaleInputMax", "rcix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
        /// Random variation of radius, as a share.
        RADIUS_SCALE_RANDOMIZE: f64 = float("radiusScaleRandomize", "rsr", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::particles::ramps").fixed();
    }
    "Force Field Generation" {
        /// Ramp of factors on the strength of the points' field, per particle.
        POINT_FIELD_SCALE: Cow<'static, [RampPoint]> = ramp("pointFieldScale", "pfsc", FULL).solved("nucleus_core::particles::ramps").fixed();
        /// Input of the point field ramp.
        POINT_FIELD_SCALE_INPUT: Choice = choice("pointFieldScaleInput", "psli", 0, INPUTS).solved("nucleus_core::particles::ramps").fixed();
        /// Input at the right end of the point field ramp.
        POINT_FIELD_SCALE_INPUT_MAX: f64 = float("pointFieldScaleInputMax", "psix", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::particles::ramps").fixed();
    }
    "Internal" {
        /// Red, for shaders.
        COLOR_RED: f64 = float("colorRed", "clr", 0.0).output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Green, for shaders.
        COLOR_GREEN: f64 = float("colorGreen", "clg", 0.0).output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Blue, for shaders.
        COLOR_BLUE: f64 = float("colorBlue", "clb", 0.0).output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the radius ramp, per particle.
        INTERNAL_RADIUS_RAMP: Vec<f64> = floats("internalRadiusRamp", "inrr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the mass ramp, per particle.
        INTERNAL_MASS_RAMP: Vec<f64> = floats("internalMassRamp", "inmr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the point field ramp, per particle.
        INTERNAL_FIELD_SCALE_RAMP: Vec<f64> = floats("internalFieldScaleRamp", "infs").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the friction ramp, per particle.
        INTERNAL_FRICTION_RAMP: Vec<f64> = floats("internalFrictionRamp", "infr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the stickiness ramp, per particle.
        INTERNAL_STICKINESS_RAMP: Vec<f64> = floats("internalStickinessRamp", "insr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the collide strength ramp, per particle.
        INTERNAL_COLLIDE_STRENGTH_RAMP: Vec<f64> = floats("internalCollideStrengthRamp", "iclr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the bounce ramp, per particle.
        INTERNAL_BOUNCE_RAMP: Vec<f64> = floats("internalBounceRamp", "inbr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the viscosity ramp, per particle.
        INTERNAL_VISCOSITY_RAMP: Vec<f64> = floats("internalViscosityRamp", "invr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the surface tension ramp, per particle.
        INTERNAL_SURFACE_TENSION_RAMP: Vec<f64> = floats("internalSurfaceTensionRamp", "istr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the opacity ramp, per particle.
        INTERNAL_OPACITY_RAMP: Vec<f64> = floats("internalOpacityRamp", "inor").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the colour ramp, per particle.
        INTERNAL_COLOR_RAMP: Vec<[f64; 3]> = vectors("internalColorRamp", "incr").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
        /// Output of the incandescence ramp, per particle.
        INTERNAL_INCANDESCENCE_RAMP: Vec<[f64; 3]> = vectors("internalIncandescenceRamp", "inir").output().hidden().elsewhere("Maya's shaders read it; the ramp itself is evaluated for each particle");
    }
    "Caching" {
        /// Attributes that a cache stores.
        CACHEABLE_ATTRIBUTES: Choice = choice("cacheableAttributes", "caat", 3, &[(0, "Position"), (1, "Position And Velocity"), (2, "Dynamics and Rendering"), (3, "All")]).elsewhere("`nucleus run --record` says what a cache keeps");
        /// Evaluates ramps after a cache is read, instead of reading their values from it.
        POST_CACHE_RAMP_EVAL: bool = toggle("postCacheRampEval", "pcre", false).elsewhere("a cache holds positions, and ramps are evaluated while it is recorded");
    }
    "Output Mesh" {
        /// Factor on the radius for the surface around the particles.
        BLOBBY_RADIUS_SCALE: f64 = float("blobbyRadiusScale", "brs", 1.0).min(0.0).soft(0.0, 10.0).solved("nucleus_cache::liquid_surface").fixed();
        /// Stretch of the surface along the motion.
        MOTION_STREAK: f64 = float("motionStreak", "mstr", 0.0).soft(0.0, 10.0).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Stores colours on the surface.
        COLOR_PER_VERTEX: bool = toggle("colorPerVertex", "cpvx", false).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Stores opacity on the surface.
        OPACITY_PER_VERTEX: bool = toggle("opacityPerVertex", "opvx", false).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Stores incandescence on the surface.
        INCANDESCENCE_PER_VERTEX: bool = toggle("incandescencePerVertex", "ipvx", false).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Stores velocities on the surface.
        VELOCITY_PER_VERTEX: bool = toggle("velocityPerVertex", "vpvx", true).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Stores texture coordinates on the surface.
        UVW_PER_VERTEX: bool = toggle("uvwPerVertex", "upvx", false).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Computes the normals of the surface from the gradient of the density.
        USE_GRADIENT_NORMALS: bool = toggle("useGradientNormals", "ugn", false).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Size of the triangles of the surface.
        MESH_TRIANGLE_SIZE: f64 = float("meshTriangleSize", "mts", 0.5).min(0.0).soft(0.0, 10.0).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Largest number of cells along an axis.
        MAX_TRIANGLE_RESOLUTION: i64 = int("maxTriangleResolution", "mtrr", 100).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Number of smoothing iterations of the surface.
        MESH_SMOOTHING_ITERATIONS: i64 = int("meshSmoothingIterations", "msit", 0).min(0.0).soft(0.0, 10.0).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
        /// Elements of the surface.
        MESH_METHOD: Choice = choice("meshMethod", "mmd", 0, &[(0, "Triangle Mesh"), (1, "Tetrahedra"), (2, "Acute Tetrahedra"), (3, "Quad Mesh")]).elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
    }
    "Connections" {
        /// The surface around the particles.
        OUT_MESH: Plugged = plug("outMesh", "oms", Data::Mesh).output().elsewhere("a run makes no surface; `--surface` of `nucleus export` and `nucleus render` makes one, which follows from the spacing of the particles");
    }
}
