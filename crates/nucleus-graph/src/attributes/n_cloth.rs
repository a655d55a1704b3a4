//! Cloth.

use super::key::{Plugged, choice, float, floats, int, node, plug, texture, toggle};
use super::kind::Data;
use super::n_base::{MAP_TYPES, N_BASE, NO_USE_TO_MESHES};
use super::node_type::node_table;
use super::value::Choice;

node_table! {
    /// A mesh that behaves as cloth.
    N_CLOTH = "nCloth", inherits Some(&N_BASE), hides [NO_USE_TO_MESHES];
    "Collisions" {
        /// Thickness towards itself, as a multiple of `thickness`.
        SELF_COLLIDE_WIDTH_SCALE: f64 = float("selfCollideWidthScale", "scws", 1.0).soft(0.001, 2.0).solved("nucleus_graph::compile::thickness");
        /// Out of use in Maya.
        SELF_COLLISION_SOFTNESS: f64 = float("selfCollisionSoftness", "scsf", 0.0).min(0.0).max(1.0).unused();
        /// What Maya draws of the solver's data.
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off"), (1, "Collision Thickness"), (2, "Self Collision Thickness"), (5, "Stretch Links"), (6, "Bend Links"), (7, "Weighting")]).elsewhere("only Maya's viewport draws it");
    }
    "Dynamic Properties" {
        /// A mesh to take rest lengths and angles from, in place of the input mesh; it has the same points and faces.
        REST_SHAPE_MESH: Plugged = node("restShapeMesh", "rsmh", Some(Data::Mesh)).solved("nucleus_graph::compile::soft_body");
        /// Classic: whether a count belongs to a link, to the object however finely it is divided, or to the world whatever its size too. Physical: a stiffness never depends on the mesh.
        SCALING_RELATION: Choice = choice("scalingRelation", "srl", 0, &[(0, "Link"), (1, "Object Space"), (2, "World Space")]).solved("nucleus_graph::compile::soft_body");
        /// Resistance of links that are longer than at rest.
        STRETCH_RESISTANCE: f64 = float("stretchResistance", "stch", 20.0).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::stretch");
        /// Resistance of links that are shorter than at rest; at 0 they are rubber bands.
        COMPRESSION_RESISTANCE: f64 = float("compressionResistance", "comr", 10.0).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::stretch");
        /// How strongly faces keep the angle between them.
        BEND_RESISTANCE: f64 = float("bendResistance", "bnd", 0.1).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::bend");
        /// Share of the bend resistance that grows with the angle: at 1 cloth is free while nearly flat.
        BEND_ANGLE_DROPOFF: f64 = float("bendAngleDropoff", "bnad", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::angle");
        /// Tension, as stretch resistance times strain, above which links lengthen permanently; at 1000 none do.
        RESTITUTION_TENSION: f64 = float("restitutionTension", "retn", 1000.0).soft(0.0, 1000.0).solved("nucleus_core::constraints::plastic");
        /// Hinges bent by more than this keep the excess; at 180 and above none do.
        RESTITUTION_ANGLE: f64 = float("restitutionAngle", "reae", 360.0).soft(0.0, 360.0).unit("degrees").solved("nucleus_core::constraints::angle");
        /// Resistance of the cross links of quads.
        SHEAR_RESISTANCE: f64 = float("shearResistance", "shr", 0.0).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::stretch");
        /// Stiffness with which the mesh moves as one rigid body; Physical: 1 is 120 Hz for every point about its goal.
        RIGIDITY: f64 = float("rigidity", "rity", 0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::shape");
        /// Treats unconnected parts of the mesh each on its own for `rigidity` and `deformResistance`.
        USE_POLYGON_SHELLS: bool = toggle("usePolygonShells", "ussh", false).solved("nucleus_core::constraints::shape");
        /// Stiffness with which the mesh keeps its shape, free to shear and bend as a whole; Physical: 1 is 24 Hz.
        DEFORM_RESISTANCE: f64 = float("deformResistance", "dety", 0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::shape");
        /// How strongly points are drawn to the live input mesh; Physical: 1 is 24 Hz; Classic: the share of the way in 1/24 s.
        INPUT_MESH_ATTRACT: f64 = float("inputMeshAttract", "imat", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::attract");
        /// Whether points whose attraction is 1 or greater are locked to the input mesh.
        INPUT_ATTRACT_METHOD: Choice = choice("inputAttractMethod", "iatm", 0, &[(0, "Non locking"), (1, "Lock values of 1.0 or greater")]).solved("nucleus_graph::compile::soft_body");
        /// Share of critical damping of points about the input mesh: 0 springs, 1 does not overshoot.
        INPUT_ATTRACT_DAMP: f64 = float("inputAttractDamp", "iadm", 0.5).soft(0.0, 1.0).solved("nucleus_core::constraints::attract");
        /// How fast velocities take up those of the input mesh, per 1/24 s.
        INPUT_MOTION_DRAG: f64 = float("inputMotionDrag", "imdr", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::attract");
        /// Factor on rest angles: 0 is flat, 1 as modelled, below 0 the other way.
        BEND_ANGLE_SCALE: f64 = float("bendAngleScale", "basc", 1.0).soft(-2.0, 2.0).solved("nucleus_core::constraints::angle");
        /// Takes speed out of links that grow longer or shorter.
        STRETCH_DAMP: f64 = float("stretchDamp", "sdmp", 0.1).min(0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::damp");
        /// Does not feel the solver's gravity.
        IGNORE_SOLVER_GRAVITY: bool = toggle("ignoreSolverGravity", "igsg", false).solved("nucleus_core::integrate::predict");
        /// Does not feel the solver's wind.
        IGNORE_SOLVER_WIND: bool = toggle("ignoreSolverWind", "igsw", false).solved("nucleus_core::integrate::aerodynamics");
        /// Force of the air at right angles to the motion: v² sin α cos α times this is the acceleration of 1 kg/m² (Classic: of a point of 1 kg) at an angle of attack α. A thin plate has 0.6 for each unit of its lift coefficient's slope.
        LIFT: f64 = float("lift", "lft", 0.05).soft(0.0, 2.0).unit("1/m").solved("nucleus_core::integrate::aerodynamics");
        /// Force of the air against the motion, as far as the surface faces it.
        DRAG: f64 = float("drag", "drg", 0.05).min(0.0).soft(0.0, 2.0).unit("per 1/24 s").solved("nucleus_core::integrate::aerodynamics");
        /// Share of `drag` that also acts along the surface.
        TANGENTIAL_DRAG: f64 = float("tangentialDrag", "tdrg", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::aerodynamics");
    }
    "Wind Field Generation" {
        /// Lets parts of the object keep the wind from other parts, within `windShadowDistance`.
        WIND_SELF_SHADOW: bool = toggle("windSelfShadow", "wssh", false).solved("nucleus_core::integrate::wind_shadow");
    }
    "Pressure" {
        /// Whether pressure is set by hand, or follows from the gas inside.
        PRESSURE_METHOD: Choice = choice("pressureMethod", "pmth", 0, &[(0, "Manual Pressure Setting"), (1, "Volume Tracking Model")]).solved("nucleus_core::constraints::pressure");
        /// Gauge pressure set by hand, along the normals; 1 is 1 kPa.
        PRESSURE: f64 = float("pressure", "pres", 0.0).soft(-1.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Air inside at the start beyond what fills the volume, in volumes.
        START_PRESSURE: f64 = float("startPressure", "stpe", 0.0).soft(-1.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Bulk modulus of the gas; 1 is 1 kPa (air has about 100).
        INCOMPRESSIBILITY: f64 = float("incompressibility", "incm", 5.0).soft(0.0, 200.0).solved("nucleus_core::constraints::pressure");
        /// Damping of changes of the volume.
        PRESSURE_DAMPING: f64 = float("pressureDamping", "prdg", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Air pumped in, in start volumes per second.
        PUMP_RATE: f64 = float("pumpRate", "pure", 0.0).soft(-1.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Share of the air that stays inside; at 0 it equalizes within 1/24 s.
        AIR_TIGHTNESS: f64 = float("airTightness", "aits", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Closes the openings of the mesh; off, air streams through them and drives the mesh.
        SEAL_HOLES: bool = toggle("sealHoles", "shol", true).solved("nucleus_core::constraints::pressure");
    }
    "Quality Settings" {
        /// Simple: the size of the angle. High Quality: the angle with its sign, for cloth that is bent at rest. Flip Tracking: also beyond 180°.
        BEND_SOLVER: Choice = choice("bendSolver", "bnsl", 1, &[(0, "Simple"), (1, "High Quality"), (2, "Flip Tracking")]).solved("nucleus_core::constraints::angle");
        /// Whether contact comes last in a step with shape attraction. It always does here, as at 1 in Maya.
        COLLIDE_LAST_THRESHOLD: f64 = float("collideLastThreshold", "clth", 0.2).soft(0.0, 1.0).solved("nucleus_core::schedule");
        /// Solves links outwards from the points that constraints hold, in each block of points; contacts come after them anyhow.
        SORT_LINKS: bool = toggle("sortLinks", "stlk", false).solved("nucleus_core::model::link_order").fixed();
        /// Whether links are solved one after another, or all from the same state: without bias by their order, but less of the error in one iteration.
        EVALUATION_ORDER: Choice = choice("evaluationOrder", "evo", 0, &[(0, "Sequential"), (1, "Parallel")]).solved("nucleus_core::constraints::parallel").fixed();
        /// Links all corners of faces with more than three.
        ADD_CROSS_LINKS: bool = toggle("addCrossLinks", "aclk", true).solved("nucleus_core::constraints::stretch").fixed();
        /// `crossoverPush` of the object against itself.
        SELF_CROSSOVER_PUSH: f64 = float("selfCrossoverPush", "scpu", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::cloth::untangling");
        /// `trappedCheck` of the object against itself: always done, whatever is set here.
        SELF_TRAPPED_CHECK: bool = toggle("selfTrappedCheck", "stpc", false).solved("nucleus_core::contact::cloth::untangling");
    }
    "Nucleus (open)" {
        /// Physical: stiffness of the cloth against being stretched, Young's modulus times its thickness. Below 0 it comes from `stretchResistance`, 500 N/m for 1.
        STRETCH_STIFFNESS: f64 = float("stretchStiffness", "stretchStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::stretch").extension();
        /// Physical: stiffness against being compressed. Below 0 it comes from `compressionResistance`, 500 N/m for 1.
        COMPRESSION_STIFFNESS: f64 = float("compressionStiffness", "compressionStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::stretch").extension();
        /// Physical: shear modulus times thickness, on top of what cross links resist. Below 0 it comes from `shearResistance`, 500 N/m for 1.
        SHEAR_STIFFNESS: f64 = float("shearStiffness", "shearStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::stretch").extension();
        /// Physical: flexural rigidity of the cloth, the moment on a width of 1 m that bends it to a radius of 1 m. Below 0 it comes from `bendResistance`, 1e-4 N·m for 1.
        BEND_STIFFNESS: f64 = float("bendStiffness", "bendStiffness", -1.0).min(-1.0).soft(-1.0, 0.01).unit("N·m").solved("nucleus_core::constraints::bend").extension();
    }
    "Initial State" {
        /// Moves each point at the start along its normal by a random length of up to this, so that a symmetric sheet folds under load instead of staying flat. The rest shape stays as modelled.
        INITIAL_PERTURBATION: f64 = float("initialPerturbation", "initialPerturbation", 0.0).min(0.0).soft(0.0, 0.1).unit("scene units").solved("nucleus_graph::compile::perturbation").fixed().extension();
        /// Which random lengths: the same seed gives the same ones.
        INITIAL_PERTURBATION_SEED: i64 = int("initialPerturbationSeed", "initialPerturbationSeed", 0).solved("nucleus_graph::compile::perturbation").fixed().extension();
    }
    "Caching" {
        /// What a cache keeps of this object.
        CACHEABLE_ATTRIBUTES: Choice = choice("cacheableAttributes", "caat", 0, &[(0, "Position"), (1, "Position And Velocity"), (2, "Dynamic State")]);
        /// How a cache is used.
        CACHE_USAGE: Choice = choice("cacheUsage", "cu", 0, &[(0, "None"), (1, "Cache/Simulation"), (2, "Cache File Info")]);
    }
    "Dynamic Properties Maps" {
        /// Texture that varies stretch.
        STRETCH_MAP: f64 = texture("stretchMap", "stmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on stretch at each point.
        STRETCH_PER_VERTEX: Vec<f64> = floats("stretchPerVertex", "spv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies compression.
        COMPRESSION_MAP: f64 = texture("compressionMap", "cmmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on compression at each point.
        COMPRESSION_PER_VERTEX: Vec<f64> = floats("compressionPerVertex", "cmpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies bend.
        BEND_MAP: f64 = texture("bendMap", "bemp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on bend at each point.
        BEND_PER_VERTEX: Vec<f64> = floats("bendPerVertex", "bdpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies bend angle dropoff.
        BEND_ANGLE_DROPOFF_MAP: f64 = texture("bendAngleDropoffMap", "badm", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on bend angle dropoff at each point.
        BEND_ANGLE_DROPOFF_PER_VERTEX: Vec<f64> = floats("bendAngleDropoffPerVertex", "badv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies restitution angle.
        RESTITUTION_ANGLE_MAP: f64 = texture("restitutionAngleMap", "ranm", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on restitution angle at each point.
        RESTITUTION_ANGLE_PER_VERTEX: Vec<f64> = floats("restitutionAnglePerVertex", "rapv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies rigidity.
        RIGIDITY_MAP: f64 = texture("rigidityMap", "rimp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on rigidity at each point.
        RIGIDITY_PER_VERTEX: Vec<f64> = floats("rigidityPerVertex", "rpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies deform.
        DEFORM_MAP: f64 = texture("deformMap", "demp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on deform at each point.
        DEFORM_PER_VERTEX: Vec<f64> = floats("deformPerVertex", "dfpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies input attract.
        INPUT_ATTRACT_MAP: f64 = texture("inputAttractMap", "iamp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on input attract at each point.
        INPUT_ATTRACT_PER_VERTEX: Vec<f64> = floats("inputAttractPerVertex", "iapv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies rest length scale.
        REST_LENGTH_SCALE_MAP: f64 = texture("restLengthScaleMap", "rlmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on rest length scale at each point.
        REST_LENGTH_SCALE_PER_VERTEX: Vec<f64> = floats("restLengthScalePerVertex", "rlpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies lift.
        LIFT_MAP: f64 = texture("liftMap", "lfmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on lift at each point.
        LIFT_PER_VERTEX: Vec<f64> = floats("liftPerVertex", "lfpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies drag.
        DRAG_MAP: f64 = texture("dragMap", "drmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on drag at each point.
        DRAG_PER_VERTEX: Vec<f64> = floats("dragPerVertex", "drpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies tangential drag.
        TANGENTIAL_DRAG_MAP: f64 = texture("tangentialDragMap", "tdmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on tangential drag at each point.
        TANGENTIAL_DRAG_PER_VERTEX: Vec<f64> = floats("tangentialDragPerVertex", "tdpv").solved("nucleus_core::model::vertex_maps");
        /// Texture that varies wrinkle.
        WRINKLE_MAP: f64 = texture("wrinkleMap", "wkmp", 0.0).solved("nucleus_graph::compile::soft_body");
        /// Factor on wrinkle at each point.
        WRINKLE_PER_VERTEX: Vec<f64> = floats("wrinklePerVertex", "wpv").solved("nucleus_graph::compile::soft_body");
        /// How high the wrinkles of the wrinkle map stand.
        WRINKLE_MAP_SCALE: f64 = float("wrinkleMapScale", "wms", 1.0).soft(-2.0, 2.0).solved("nucleus_graph::compile::soft_body");
        /// Whether stretch is varied by nothing, by point, or by a texture.
        STRETCH_MAP_TYPE: Choice = choice("stretchMapType", "smt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether compression is varied by nothing, by point, or by a texture.
        COMPRESSION_MAP_TYPE: Choice = choice("compressionMapType", "cmmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether bend is varied by nothing, by point, or by a texture.
        BEND_MAP_TYPE: Choice = choice("bendMapType", "bdmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether bend angle dropoff is varied by nothing, by point, or by a texture.
        BEND_ANGLE_DROPOFF_MAP_TYPE: Choice = choice("bendAngleDropoffMapType", "bamt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether restitution angle is varied by nothing, by point, or by a texture.
        RESTITUTION_ANGLE_MAP_TYPE: Choice = choice("restitutionAngleMapType", "ramt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether rigidity is varied by nothing, by point, or by a texture.
        RIGIDITY_MAP_TYPE: Choice = choice("rigidityMapType", "rmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps");
        /// Whether deform is varied by nothing, by point, or by a texture.
        DEFORM_MAP_TYPE: Choice = choice("deformMapType", "dmmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps");
        /// Whether input attract is varied by nothing, by point, or by a texture.
        INPUT_ATTRACT_MAP_TYPE: Choice = choice("inputAttractMapType", "iamt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps");
        /// Whether rest length scale is varied by nothing, by point, or by a texture.
        REST_LENGTH_SCALE_MAP_TYPE: Choice = choice("restLengthScaleMapType", "rlmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether lift is varied by nothing, by point, or by a texture.
        LIFT_MAP_TYPE: Choice = choice("liftMapType", "lfmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether drag is varied by nothing, by point, or by a texture.
        DRAG_MAP_TYPE: Choice = choice("dragMapType", "drmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether tangential drag is varied by nothing, by point, or by a texture.
        TANGENTIAL_DRAG_MAP_TYPE: Choice = choice("tangentialDragMapType", "tdmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Whether wrinkle is varied by nothing, by point, or by a texture.
        WRINKLE_MAP_TYPE: Choice = choice("wrinkleMapType", "wmt", 2, MAP_TYPES).solved("nucleus_graph::compile::soft_body");
    }
    "Hidden" {
        /// Left over from early versions of Maya.
        NUM_SUBDIVISIONS: i64 = int("numSubdivisions", "nsub", 2).hidden().unused();
        /// Classic: stretch and compression get one iteration in a substep at most. Maya does not document it.
        MINIMAL_STRETCH: bool = toggle("minimalStretch", "msso", false).hidden().solved("nucleus_graph::compile::soft_body");
        /// Classic: bending gets one iteration in a substep at most. Maya does not document it.
        MINIMAL_BEND: bool = toggle("minimalBend", "mbso", false).hidden().solved("nucleus_graph::compile::soft_body");
        /// Classic: shear gets one iteration in a substep at most. Maya does not document it.
        MINIMAL_SHEAR: bool = toggle("minimalShear", "mshs", false).hidden().solved("nucleus_graph::compile::soft_body");
        /// An experiment of Maya's with coarser levels of links.
        STRETCH_HIERARCHY_LEVELS: i64 = int("stretchHierarchyLevels", "shlv", 0).min(0.0).soft(0.0, 10.0).hidden().elsewhere("Maya neither shows nor documents this experiment");
        /// How much of those levels is used.
        STRETCH_HIERARCHY_PERCENT: f64 = float("stretchHierarchyPercent", "shpe", 25.0).soft(0.0, 100.0).hidden().elsewhere("Maya neither shows nor documents this experiment");
    }
    "Connections" {
        /// The solved mesh in world space.
        OUTPUT_MESH: Plugged = plug("outputMesh", "omsh", Data::Mesh).output();
        /// The mesh as it is at the start.
        OUTPUT_START_MESH: Plugged = plug("outputStartMesh", "otms", Data::Mesh).output();
    }
}
