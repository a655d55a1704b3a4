//! Particles. Rows of its base are repeated where they mean something else, or take effect for particles alone, or
//! for cloth alone.

use std::borrow::Cow;

use super::key::{
    Plugged, choice, color_ramp, float, floats, int, plug, ramp, text, toggle, vector, vectors,
};
use super::kind::Data;
use super::n_base::N_BASE;
use super::node_type::node_table;
use super::value::{Choice, ColorPoint, RampPoint};

/// What a ramp can be read by.
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

/// What a ramp of colours can be read by.
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

/// What points without a mesh have no use for.
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
    /// Balls without links: they fall, feel the air, and meet cloth, colliders and each other.
    N_PARTICLE = "nParticle", inherits Some(&N_BASE), hides [NO_USE_TO_PARTICLES];
    "Hidden" {
        /// Left over from early versions of Maya.
        NUM_SUBDIVISIONS: i64 = int("numSubdivisions", "nsub", 2).unused().hidden();
        /// Without meaning for particles: they have no links.
        SCALING_RELATION: Choice = choice("scalingRelation", "srl", 0, &[(0, "Link"), (1, "Object Space"), (2, "World Space")]).unused().hidden();
        /// Lets Maya use threads for liquids.
        PARALLEL_SPH: bool = toggle("parallelSPH", "psph", false).hidden();
        /// Looks for neighbours more often.
        RECOMPUTE_PAIRS_SPH: bool = toggle("recomputePairsSPH", "rpsp", false).hidden();
    }
    "Per Particle (Array) Attributes" {
        /// Where the particles are when the simulation begins, in world space, unless `position0` says it.
        POSITION: Vec<[f64; 3]> = vectors("position", "pos").unit("scene units").solved("nucleus_graph::compile");
        /// How fast they are then, unless `velocity0` says it.
        VELOCITY: Vec<[f64; 3]> = vectors("velocity", "vel").unit("scene units/s").solved("nucleus_graph::compile");
    }
    "Initial State" {
        /// Initial positions in world space; a file may be an OBJ, of which the points are taken.
        POSITION0: Vec<[f64; 3]> = vectors("position0", "pos0").unit("scene units").solved("nucleus_graph::compile");
        /// Initial velocities in world space.
        VELOCITY0: Vec<[f64; 3]> = vectors("velocity0", "vel0").unit("scene units/s").solved("nucleus_graph::compile");
        /// Lower corner of a box that is filled with particles in a grid; the particle tool's Minimum Corner.
        MINIMUM_CORNER: [f64; 3] = vector("minimumCorner", "minimumCorner", [0.0, 0.0, 0.0], ["minimumCornerX", "minimumCornerY", "minimumCornerZ"]).unit("scene units").solved("nucleus_graph::compile").fixed().extension();
        /// Upper corner of that box; the particle tool's Maximum Corner.
        MAXIMUM_CORNER: [f64; 3] = vector("maximumCorner", "maximumCorner", [0.0, 0.0, 0.0], ["maximumCornerX", "maximumCornerY", "maximumCornerZ"]).unit("scene units").solved("nucleus_graph::compile").fixed().extension();
        /// Name of a closed mesh whose volume is filled with particles in a grid, as Maya's Fill Object does.
        FILL_MESH: String = text("fillMesh", "fillMesh").solved("nucleus_graph::compile").extension();
        /// Distance of the particles in a grid; 0 is that of a liquid at rest, or the diameter of a ball.
        PARTICLE_SPACING: f64 = float("particleSpacing", "particleSpacing", 0.0).min(0.0).max(1e9).unit("scene units").solved("nucleus_graph::compile").fixed().extension();
    }
    "Dynamic Properties" {
        /// Kilograms of every particle, however resistances are read.
        POINT_MASS: f64 = float("pointMass", "pmss", 1.0).min(0.0).soft(0.001, 10.0).unit("kg").solved("nucleus_graph::compile").fixed();
        /// Slows the particles down.
        DAMP: f64 = float("damp", "adng", 0.0).min(0.0).soft(0.0, 10.0);
        /// How strongly particles are drawn to an input mesh.
        INPUT_ATTRACT: f64 = float("inputAttract", "iatt", 0.0).soft(0.0, 1.0);
        /// How little they swing about it: 0 freely, 1 not at all.
        INPUT_ATTRACT_DAMP: f64 = float("inputAttractDamp", "iadm", 0.5).soft(0.0, 1.0);
        /// Does not feel the solver's gravity.
        IGNORE_SOLVER_GRAVITY: bool = toggle("ignoreSolverGravity", "igsg", false).solved("nucleus_core::integrate::predict");
        /// Does not feel the solver's wind.
        IGNORE_SOLVER_WIND: bool = toggle("ignoreSolverWind", "igsw", false).solved("nucleus_core::integrate::aerodynamics");
        /// Force of the air against the motion, the same in all directions; on a light particle it does more.
        DRAG: f64 = float("drag", "drg", 0.01).soft(0.0, 2.0).unit("per 1/24 s").solved("nucleus_core::integrate::aerodynamics");
        /// Factor on mass, by particle.
        MASS_SCALE: Cow<'static, [RampPoint]> = ramp("massScale", "mssc", FULL);
        /// What the mass ramp is read by.
        MASS_SCALE_INPUT: Choice = choice("massScaleInput", "msli", 0, INPUTS);
        /// The value that stands at the right end of the mass ramp.
        MASS_SCALE_INPUT_MAX: f64 = float("massScaleInputMax", "msix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much the mass varies at random.
        MASS_SCALE_RANDOMIZE: f64 = float("massScaleRandomize", "msr", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Wind Field Generation" {
        /// Lets particles keep the wind from each other.
        WIND_SELF_SHADOW: bool = toggle("windSelfShadow", "wssh", false);
    }
    "Collisions" {
        /// Up to which elements it collides: particles are points, whatever it says.
        COLLISION_FLAG: Choice = choice("collisionFlag", "cofl", 1, &[(1, "Vertex"), (2, "Edge"), (3, "Face")]).solved("nucleus_graph::compile");
        /// What Maya draws of the solver's data.
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off"), (1, "Collision Thickness"), (2, "Self Collision Thickness")]);
        /// Size in collisions, as a multiple of the radius.
        COLLIDE_WIDTH_SCALE: f64 = float("collideWidthScale", "cwds", 1.0).soft(0.0, 2.0).solved("nucleus_core::contact::material");
        /// Size towards each other, as a multiple of the size in collisions.
        SELF_COLLIDE_WIDTH_SCALE: f64 = float("selfCollideWidthScale", "scws", 1.0).soft(0.001, 2.0).solved("nucleus_graph::compile::thickness");
        /// Factor on friction, by particle.
        FRICTION_SCALE: Cow<'static, [RampPoint]> = ramp("frictionScale", "frsc", FULL);
        /// What the friction ramp is read by.
        FRICTION_SCALE_INPUT: Choice = choice("frictionScaleInput", "fsli", 0, INPUTS);
        /// The value that stands at the right end of the friction ramp.
        FRICTION_SCALE_INPUT_MAX: f64 = float("frictionScaleInputMax", "fsix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much friction varies at random.
        FRICTION_RANDOMIZE: f64 = float("frictionRandomize", "fcr", 0.0).min(0.0).soft(0.0, 1.0);
        /// Factor on stickiness, by particle.
        STICKINESS_SCALE: Cow<'static, [RampPoint]> = ramp("stickinessScale", "stsc", FULL);
        /// What the stickiness ramp is read by.
        STICKINESS_SCALE_INPUT: Choice = choice("stickinessScaleInput", "ssli", 0, INPUTS);
        /// The value that stands at the right end of the stickiness ramp.
        STICKINESS_SCALE_INPUT_MAX: f64 = float("stickinessScaleInputMax", "ssix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much stickiness varies at random.
        STICKINESS_RANDOMIZE: f64 = float("stickinessRandomize", "stra", 0.0).min(0.0).soft(0.0, 1.0);
        /// Factor on collide strength, by particle.
        COLLIDE_STRENGTH_SCALE: Cow<'static, [RampPoint]> = ramp("collideStrengthScale", "clsc", FULL);
        /// What the collide strength ramp is read by.
        COLLIDE_STRENGTH_SCALE_INPUT: Choice = choice("collideStrengthScaleInput", "csli", 0, INPUTS);
        /// The value that stands at the right end of the collide strength ramp.
        COLLIDE_STRENGTH_SCALE_INPUT_MAX: f64 = float("collideStrengthScaleInputMax", "csix", 1.0).min(0.0).soft(0.0, 50.0);
        /// Factor on bounce, by particle.
        BOUNCE_SCALE: Cow<'static, [RampPoint]> = ramp("bounceScale", "bosc", FULL);
        /// What the bounce ramp is read by.
        BOUNCE_SCALE_INPUT: Choice = choice("bounceScaleInput", "bsli", 0, INPUTS);
        /// The value that stands at the right end of the bounce ramp.
        BOUNCE_SCALE_INPUT_MAX: f64 = float("bounceScaleInputMax", "bsix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much bounce varies at random.
        BOUNCE_RANDOMIZE: f64 = float("bounceRandomize", "bora", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Emission Attributes" {
        /// New particles that overlap others by more than this share are left out.
        EMISSION_OVERLAP_PRUNING: f64 = float("emissionOverlapPruning", "eopr", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Rotation" {
        /// Turns particles where they rub against something.
        COMPUTE_ROTATION: bool = toggle("computeRotation", "cprt", false);
        /// How strongly rubbing turns them.
        ROTATION_FRICTION: f64 = float("rotationFriction", "rtfr", 0.9).soft(0.0, 1.0);
        /// How fast they stop turning.
        ROTATION_DAMP: f64 = float("rotationDamp", "rtdp", 0.001).soft(0.0, 1.0);
    }
    "Liquid Simulation" {
        /// Makes the particles a liquid; Maya shows it as Enable Liquid Simulation.
        ENABLE_SPH: bool = toggle("enableSPH", "esph", false).solved("nucleus_core::constraints::liquid");
        /// How strongly the liquid keeps its volume: entirely from 1 on, as a soft body below.
        INCOMPRESSIBILITY: f64 = float("incompressibility", "incp", 1.0).min(0.0).soft(0.0, 50.0).solved("nucleus_core::constraints::liquid::density");
        /// How much particles move like their neighbours: 1 is honey (0.01 m²/s), and it grows with the square.
        VISCOSITY: f64 = float("viscosity", "visc", 0.1).min(0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::liquid::viscosity");
        /// Factor on viscosity, by particle.
        VISCOSITY_SCALE: Cow<'static, [RampPoint]> = ramp("viscosityScale", "vssc", FULL);
        /// What the viscosity ramp is read by.
        VISCOSITY_SCALE_INPUT: Choice = choice("viscosityScaleInput", "vsli", 0, INPUTS);
        /// The value that stands at the right end of the viscosity ramp.
        VISCOSITY_SCALE_INPUT_MAX: f64 = float("viscosityScaleInputMax", "vsix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How strongly the surface draws together: at 1 drops of 1 cm hold together, water has 0.073.
        SURFACE_TENSION: f64 = float("surfaceTension", "suft", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::liquid::surface_tension");
        /// Factor on surface tension, by particle.
        SURFACE_TENSION_SCALE: Cow<'static, [RampPoint]> = ramp("surfaceTensionScale", "stns", FULL);
        /// What the surface tension ramp is read by.
        SURFACE_TENSION_SCALE_INPUT: Choice = choice("surfaceTensionScaleInput", "stli", 0, INPUTS);
        /// The value that stands at the right end of the surface tension ramp.
        SURFACE_TENSION_SCALE_INPUT_MAX: f64 = float("surfaceTensionScaleInputMax", "stix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How many particles overlap a point at rest, as balls of the liquid radius.
        REST_DENSITY: f64 = float("restDensity", "rdns", 2.0).min(1.0).soft(1.0, 2.0).solved("nucleus_core::constraints::liquid").fixed();
        /// Radius of the balls that overlap in a liquid, as a multiple of the radius: 0.5 is usual.
        RADIUS_SCALE_SPH: f64 = float("radiusScaleSPH", "rsph", 1.0).min(0.0).soft(0.0, 2.0).solved("nucleus_core::constraints::liquid").fixed();
    }
    "Shading" {
        /// Density at which the drawn surface stands; it does not act on the motion.
        THRESHOLD: f64 = float("threshold", "thr", 0.1).min(0.0).soft(0.0, 2.0);
        /// How opaque particles are.
        OPACITY: f64 = float("opacity", "op", 1.0).min(0.0).max(1.0);
        /// Factor on opacity, by particle.
        OPACITY_SCALE: Cow<'static, [RampPoint]> = ramp("opacityScale", "opc", FULL);
        /// What the opacity ramp is read by.
        OPACITY_SCALE_INPUT: Choice = choice("opacityScaleInput", "oci", 0, INPUTS);
        /// The value that stands at the right end of the opacity ramp.
        OPACITY_SCALE_INPUT_MAX: f64 = float("opacityScaleInputMax", "osis", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much opacity varies at random.
        OPACITY_SCALE_RANDOMIZE: f64 = float("opacityScaleRandomize", "osr", 0.0).min(0.0).soft(0.0, 1.0);
        /// Colour, by particle.
        COLOR: Cow<'static, [ColorPoint]> = color_ramp("color", "cl");
        /// What the colour ramp is read by.
        COLOR_INPUT: Choice = choice("colorInput", "coi", 0, COLOUR_INPUTS);
        /// The value that stands at the right end of the colour ramp.
        COLOR_INPUT_MAX: f64 = float("colorInputMax", "cimx", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much the place on the colour ramp varies at random.
        COLOR_RANDOMIZE: f64 = float("colorRandomize", "colr", 0.0).min(0.0).soft(0.0, 1.0);
        /// Colour of the light that particles give off.
        INCANDESCENCE: Cow<'static, [ColorPoint]> = color_ramp("incandescence", "inca");
        /// What the incandescence ramp is read by.
        INCANDESCENCE_INPUT: Choice = choice("incandescenceInput", "ini", 0, COLOUR_INPUTS);
        /// The value that stands at the right end of the incandescence ramp.
        INCANDESCENCE_INPUT_MAX: f64 = float("incandescenceInputMax", "iimx", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much the place on the incandescence ramp varies at random.
        INCANDESCENCE_RANDOMIZE: f64 = float("incandescenceRandomize", "icar", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Particle Size" {
        /// Radius of each particle: two touch at the sum of theirs.
        RADIUS: f64 = float("radius", "ra", 0.2).min(0.0).soft(0.0, 20.0).unit("scene units").solved("nucleus_core::contact::material").fixed();
        /// Factor on radius, by particle.
        RADIUS_SCALE: Cow<'static, [RampPoint]> = ramp("radiusScale", "rdc", FULL);
        /// What the radius ramp is read by.
        RADIUS_SCALE_INPUT: Choice = choice("radiusScaleInput", "rci", 0, &[(0, "Off"), (1, "Age"), (2, "Normalized Age"), (3, "Speed"), (4, "Acceleration"), (5, "Particle ID"), (6, "Randomized ID")]);
        /// The value that stands at the right end of the radius ramp.
        RADIUS_SCALE_INPUT_MAX: f64 = float("radiusScaleInputMax", "rcix", 1.0).min(0.0).soft(0.0, 50.0);
        /// How much the radius varies at random.
        RADIUS_SCALE_RANDOMIZE: f64 = float("radiusScaleRandomize", "rsr", 0.0).min(0.0).soft(0.0, 1.0);
    }
    "Force Field Generation" {
        /// Factor on the strength of the points' field, by particle.
        POINT_FIELD_SCALE: Cow<'static, [RampPoint]> = ramp("pointFieldScale", "pfsc", FULL);
        /// What the point field ramp is read by.
        POINT_FIELD_SCALE_INPUT: Choice = choice("pointFieldScaleInput", "psli", 0, INPUTS);
        /// The value that stands at the right end of the point field ramp.
        POINT_FIELD_SCALE_INPUT_MAX: f64 = float("pointFieldScaleInputMax", "psix", 1.0).min(0.0).soft(0.0, 50.0);
    }
    "Internal" {
        /// Red, for shaders.
        COLOR_RED: f64 = float("colorRed", "clr", 0.0).output().hidden();
        /// Green, for shaders.
        COLOR_GREEN: f64 = float("colorGreen", "clg", 0.0).output().hidden();
        /// Blue, for shaders.
        COLOR_BLUE: f64 = float("colorBlue", "clb", 0.0).output().hidden();
        /// What the radius ramp gives for each particle.
        INTERNAL_RADIUS_RAMP: Vec<f64> = floats("internalRadiusRamp", "inrr").output().hidden();
        /// What the mass ramp gives for each particle.
        INTERNAL_MASS_RAMP: Vec<f64> = floats("internalMassRamp", "inmr").output().hidden();
        /// What the point field ramp gives for each particle.
        INTERNAL_FIELD_SCALE_RAMP: Vec<f64> = floats("internalFieldScaleRamp", "infs").output().hidden();
        /// What the friction ramp gives for each particle.
        INTERNAL_FRICTION_RAMP: Vec<f64> = floats("internalFrictionRamp", "infr").output().hidden();
        /// What the stickiness ramp gives for each particle.
        INTERNAL_STICKINESS_RAMP: Vec<f64> = floats("internalStickinessRamp", "insr").output().hidden();
        /// What the collide strength ramp gives for each particle.
        INTERNAL_COLLIDE_STRENGTH_RAMP: Vec<f64> = floats("internalCollideStrengthRamp", "iclr").output().hidden();
        /// What the bounce ramp gives for each particle.
        INTERNAL_BOUNCE_RAMP: Vec<f64> = floats("internalBounceRamp", "inbr").output().hidden();
        /// What the viscosity ramp gives for each particle.
        INTERNAL_VISCOSITY_RAMP: Vec<f64> = floats("internalViscosityRamp", "invr").output().hidden();
        /// What the surface tension ramp gives for each particle.
        INTERNAL_SURFACE_TENSION_RAMP: Vec<f64> = floats("internalSurfaceTensionRamp", "istr").output().hidden();
        /// What the opacity ramp gives for each particle.
        INTERNAL_OPACITY_RAMP: Vec<f64> = floats("internalOpacityRamp", "inor").output().hidden();
        /// What the colour ramp gives for each particle.
        INTERNAL_COLOR_RAMP: Vec<[f64; 3]> = vectors("internalColorRamp", "incr").output().hidden();
        /// What the incandescence ramp gives for each particle.
        INTERNAL_INCANDESCENCE_RAMP: Vec<[f64; 3]> = vectors("internalIncandescenceRamp", "inir").output().hidden();
    }
    "Caching" {
        /// What a cache keeps of this object.
        CACHEABLE_ATTRIBUTES: Choice = choice("cacheableAttributes", "caat", 3, &[(0, "Position"), (1, "Position And Velocity"), (2, "Dynamics and Rendering"), (3, "All")]);
        /// Works ramps out after a cache is read, instead of taking what it holds.
        POST_CACHE_RAMP_EVAL: bool = toggle("postCacheRampEval", "pcre", false);
    }
    "Output Mesh" {
        /// Factor on the radius where a surface is drawn round particles.
        BLOBBY_RADIUS_SCALE: f64 = float("blobbyRadiusScale", "brs", 1.0).min(0.0).soft(0.0, 10.0);
        /// How far that surface is drawn out along the motion.
        MOTION_STREAK: f64 = float("motionStreak", "mstr", 0.0).soft(0.0, 10.0);
        /// Gives the surface colours.
        COLOR_PER_VERTEX: bool = toggle("colorPerVertex", "cpvx", false);
        /// Gives the surface opacity.
        OPACITY_PER_VERTEX: bool = toggle("opacityPerVertex", "opvx", false);
        /// Gives the surface incandescence.
        INCANDESCENCE_PER_VERTEX: bool = toggle("incandescencePerVertex", "ipvx", false);
        /// Gives the surface velocities.
        VELOCITY_PER_VERTEX: bool = toggle("velocityPerVertex", "vpvx", true);
        /// Gives the surface texture coordinates.
        UVW_PER_VERTEX: bool = toggle("uvwPerVertex", "upvx", false);
        /// Takes the normals of the surface from how the density changes.
        USE_GRADIENT_NORMALS: bool = toggle("useGradientNormals", "ugn", false);
        /// Size of the triangles of the surface.
        MESH_TRIANGLE_SIZE: f64 = float("meshTriangleSize", "mts", 0.5).min(0.0).soft(0.0, 10.0);
        /// No more cells than this along an axis.
        MAX_TRIANGLE_RESOLUTION: i64 = int("maxTriangleResolution", "mtrr", 100);
        /// How often the surface is smoothed.
        MESH_SMOOTHING_ITERATIONS: i64 = int("meshSmoothingIterations", "msit", 0).min(0.0).soft(0.0, 10.0);
        /// What the surface is made of.
        MESH_METHOD: Choice = choice("meshMethod", "mmd", 0, &[(0, "Triangle Mesh"), (1, "Tetrahedra"), (2, "Acute Tetrahedra"), (3, "Quad Mesh")]);
    }
    "Connections" {
        /// The surface round the particles.
        OUT_MESH: Plugged = plug("outMesh", "oms", Data::Mesh).output();
    }
}
