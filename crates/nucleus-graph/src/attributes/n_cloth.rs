//! Cloth.

use nucleus_core::ClothFrame;

use super::key::{Plugged, choice, float, floats, int, node, plug, texture, toggle};
use super::kind::Data;
use super::n_base::{MAP_TYPES, N_BASE, NO_USE_TO_MESHES};
use super::node_type::node_table;
use super::value::Choice;

/// The solver's defaults, which are Maya's.
const DEFAULT: ClothFrame = ClothFrame::DEFAULT;

node_table! {
    /// A mesh that behaves as cloth.
    N_CLOTH = "nCloth", inherits Some(&N_BASE), hides [NO_USE_TO_MESHES];
    "Collisions" {
        /// Thickness in self-collision, as a multiple of `thickness`.
        SELF_COLLIDE_WIDTH_SCALE: f64 = float("selfCollideWidthScale", "scws", 1.0).soft(0.001, 2.0).solved("nucleus_graph::compile::thickness");
        /// Obsolete in Maya.
        SELF_COLLISION_SOFTNESS: f64 = float("selfCollisionSoftness", "scsf", 0.0).min(0.0).max(1.0).unused();
        /// Solver data that Maya draws.
        SOLVER_DISPLAY: Choice = choice("solverDisplay", "svds", 0, &[(0, "Off"), (1, "Collision Thickness"), (2, "Self Collision Thickness"), (5, "Stretch Links"), (6, "Bend Links"), (7, "Weighting")]).elsewhere("only Maya's viewport draws it");
    }
    "Dynamic Properties" {
        /// Name of a mesh whose lengths and angles are the rest shape, in place of the input mesh. It has the same points and faces.
        REST_SHAPE_MESH: Plugged = node("restShapeMesh", "rsmh", Some(Data::Mesh)).solved("nucleus_graph::compile::input_mesh");
        /// Classic: whether a resistance applies per link, per object independent of its resolution, or also independent of its size. Physical: a stiffness never depends on the mesh.
        SCALING_RELATION: Choice = choice("scalingRelation", "srl", 0, &[(0, "Link"), (1, "Object Space"), (2, "World Space")]).solved("nucleus_graph::compile::soft_body");
        /// Resistance to stretch: of links that are longer than at rest.
        STRETCH_RESISTANCE: f64 = float("stretchResistance", "stch", DEFAULT.stretch_resistance).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::stretch");
        /// Resistance to compression: of links that are shorter than at rest. At 0 links are rubber bands.
        COMPRESSION_RESISTANCE: f64 = float("compressionResistance", "comr", DEFAULT.compression_resistance).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::stretch");
        /// Resistance to bending: of the angle between adjacent faces.
        BEND_RESISTANCE: f64 = float("bendResistance", "bnd", DEFAULT.bend_resistance).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::bend");
        /// Share of the bend resistance that grows with the angle. At 1 nearly flat cloth bends freely.
        BEND_ANGLE_DROPOFF: f64 = float("bendAngleDropoff", "bnad", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::angle");
        /// Tension (stretch resistance times strain) above which links lengthen permanently; 1000 disables it.
        RESTITUTION_TENSION: f64 = float("restitutionTension", "retn", 1000.0).soft(0.0, 1000.0).solved("nucleus_core::constraints::plastic");
        /// Angle beyond which a bend becomes permanent; from 180 on it is disabled.
        RESTITUTION_ANGLE: f64 = float("restitutionAngle", "reae", 360.0).soft(0.0, 360.0).unit("degrees").solved("nucleus_core::constraints::angle");
        /// Resistance to shear: of the cross links of quads.
        SHEAR_RESISTANCE: f64 = float("shearResistance", "shr", DEFAULT.shear_resistance).min(0.0).soft(0.0, 200.0).unit("per 1/24 s").solved("nucleus_core::constraints::stretch");
        /// Stiffness of the attraction to the rigidly moved rest shape. Physical: at 1 each point oscillates about its goal at 120 Hz.
        RIGIDITY: f64 = float("rigidity", "rity", 0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::shape");
        /// Applies `rigidity` and `deformResistance` to each connected part of the mesh separately.
        USE_POLYGON_SHELLS: bool = toggle("usePolygonShells", "ussh", false).solved("nucleus_core::constraints::shape");
        /// Stiffness of the attraction to the rest shape, which may shear and bend as a whole. Physical: 1 is 24 Hz.
        DEFORM_RESISTANCE: f64 = float("deformResistance", "dety", 0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::shape");
        /// Strength of the attraction to the animated input mesh. Physical: 1 is 24 Hz. Classic: the share of the distance in 1/24 s.
        INPUT_MESH_ATTRACT: f64 = float("inputMeshAttract", "imat", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::attract");
        /// Whether points whose attraction is 1 or greater are locked to the input mesh.
        INPUT_ATTRACT_METHOD: Choice = choice("inputAttractMethod", "iatm", 0, &[(0, "Non locking"), (1, "Lock values of 1.0 or greater")]).solved("nucleus_graph::compile::input_mesh");
        /// Damping of the attraction to the input mesh, as a share of critical damping: at 1 cloth does not overshoot a mesh at rest; a mesh that moves gives it speed.
        INPUT_ATTRACT_DAMP: f64 = float("inputAttractDamp", "iadm", 0.5).soft(0.0, 1.0).solved("nucleus_core::constraints::attract");
        /// Rate at which velocities approach those of the input mesh, per 1/24 s.
        INPUT_MOTION_DRAG: f64 = float("inputMotionDrag", "imdr", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::attract");
        /// Factor on rest angles: 0 is flat, 1 is as modelled, negative values bend the other way.
        BEND_ANGLE_SCALE: f64 = float("bendAngleScale", "basc", 1.0).soft(-2.0, 2.0).solved("nucleus_core::constraints::angle");
        /// Damping of the rate of change of link lengths.
        STRETCH_DAMP: f64 = float("stretchDamp", "sdmp", DEFAULT.stretch_damp).min(0.0).soft(0.0, 10.0).solved("nucleus_core::constraints::damp");
        /// Excludes the object from the solver's gravity.
        IGNORE_SOLVER_GRAVITY: bool = toggle("ignoreSolverGravity", "igsg", false).solved("nucleus_core::integrate::predict");
        /// Excludes the object from the solver's wind.
        IGNORE_SOLVER_WIND: bool = toggle("ignoreSolverWind", "igsw", false).solved("nucleus_core::integrate::aerodynamics");
        /// Air lift, perpendicular to the motion: v² sin α cos α times this is the acceleration of cloth of 1 kg/m² (Classic: of a point of 1 kg) at an angle of attack α. A thin plate has 0.6 per unit of the slope of its lift coefficient.
        LIFT: f64 = float("lift", "lft", DEFAULT.lift).soft(0.0, 2.0).unit("1/m").solved("nucleus_core::integrate::aerodynamics");
        /// Air drag against the motion, in proportion to the component of the motion along the normal.
        DRAG: f64 = float("drag", "drg", DEFAULT.drag).min(0.0).soft(0.0, 2.0).unit("per 1/24 s").solved("nucleus_core::integrate::aerodynamics");
        /// Share of `drag` that also acts along the surface.
        TANGENTIAL_DRAG: f64 = float("tangentialDrag", "tdrg", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::aerodynamics");
    }
    "Wind Field Generation" {
        /// Whether the object casts its wind shadow on itself, within `windShadowDistance`.
        WIND_SELF_SHADOW: bool = toggle("windSelfShadow", "wssh", false).solved("nucleus_core::integrate::wind_shadow");
    }
    "Pressure" {
        /// Source of the pressure: set manually, or computed from the enclosed gas.
        PRESSURE_METHOD: Choice = choice("pressureMethod", "pmth", 0, &[(0, "Manual Pressure Setting"), (1, "Volume Tracking Model")]).solved("nucleus_core::constraints::pressure");
        /// Manual gauge pressure along the normals; 1 is 1 kPa. It inflates a mesh to five times its size at most.
        PRESSURE: f64 = float("pressure", "pres", 0.0).soft(-1.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Excess air inside at the start, in start volumes.
        START_PRESSURE: f64 = float("startPressure", "stpe", 0.0).soft(-1.0, 1.0).solved("nucleus_core::constraints::pressure").fixed();
        /// Bulk modulus of the gas; 1 is 1 kPa (air has about 100).
        INCOMPRESSIBILITY: f64 = float("incompressibility", "incm", 5.0).soft(0.0, 200.0).solved("nucleus_core::constraints::pressure");
        /// Damping of the rate of change of the volume.
        PRESSURE_DAMPING: f64 = float("pressureDamping", "prdg", 0.0).soft(0.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Rate of air pumped in, in start volumes per second.
        PUMP_RATE: f64 = float("pumpRate", "pure", 0.0).soft(-1.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Share of the excess air that is retained; at 0 pressure equalizes within 1/24 s.
        AIR_TIGHTNESS: f64 = float("airTightness", "aits", 1.0).soft(0.0, 1.0).solved("nucleus_core::constraints::pressure");
        /// Volume tracking: seals the openings of the mesh. Off: air flows through them, and its thrust acts on the mesh.
        SEAL_HOLES: bool = toggle("sealHoles", "shol", true).solved("nucleus_core::constraints::pressure");
    }
    "Quality Settings" {
        /// Simple: the size of the angle. High Quality: the angle with its sign, for cloth that is bent at rest. Flip Tracking: also beyond 180°.
        BEND_SOLVER: Choice = choice("bendSolver", "bnsl", 1, &[(0, "Simple"), (1, "High Quality"), (2, "Flip Tracking")]).solved("nucleus_core::constraints::angle");
        /// Order of contact and shape attraction in a step.
        COLLIDE_LAST_THRESHOLD: f64 = float("collideLastThreshold", "clth", 0.2).soft(0.0, 1.0).elsewhere("contact is always last, as at 1 in Maya");
        /// Solves links outwards from constrained points, within each block of points. Contacts are solved after links at any value.
        SORT_LINKS: bool = toggle("sortLinks", "stlk", false).solved("nucleus_core::model::link_order").fixed();
        /// Sequential: links are solved one after another (Gauss-Seidel). Parallel: all from the same state (Jacobi), without bias by order but with slower convergence.
        EVALUATION_ORDER: Choice = choice("evaluationOrder", "evo", 0, &[(0, "Sequential"), (1, "Parallel")]).solved("nucleus_core::constraints::parallel").fixed();
        /// Adds links between all corners of faces with more than three corners.
        ADD_CROSS_LINKS: bool = toggle("addCrossLinks", "aclk", true).solved("nucleus_core::constraints::stretch").fixed();
        /// `crossoverPush` where the object intersects itself.
        SELF_CROSSOVER_PUSH: f64 = float("selfCrossoverPush", "scpu", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::cloth::untangling");
        /// `trappedCheck` of the object against itself; always active.
        SELF_TRAPPED_CHECK: bool = toggle("selfTrappedCheck", "stpc", false).solved("nucleus_core::contact::cloth::untangling");
    }
    "Nucleus (open)" {
        /// Physical: membrane stiffness in stretch, Young's modulus times thickness. Below 0: 500 N/m times `stretchResistance`.
        STRETCH_STIFFNESS: f64 = float("stretchStiffness", "stretchStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::stretch").extension();
        /// Physical: membrane stiffness in compression. Below 0: 500 N/m times `compressionResistance`.
        COMPRESSION_STIFFNESS: f64 = float("compressionStiffness", "compressionStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::stretch").extension();
        /// Physical: shear modulus times thickness, in addition to the shear stiffness of cross links. Below 0: 500 N/m times `shearResistance`.
        SHEAR_STIFFNESS: f64 = float("shearStiffness", "shearStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::stretch").extension();
        /// Physical: flexural rigidity, the moment on a width of 1 m that bends the cloth to a radius of 1 m. Below 0: 1e-4 N·m times `bendResistance`.
        BEND_STIFFNESS: f64 = float("bendStiffness", "bendStiffness", -1.0).min(-1.0).soft(-1.0, 0.01).unit("N·m").solved("nucleus_core::constraints::bend").extension();
        /// Physical: woven cloth. Links along u of the texture coordinates have `warpStiffness`, those along v `weftStiffness`, and all others give way in shear, by `shearStiffness` or `shearResistance` alone; `addCrossLinks` has no effect.
        WEAVE: bool = toggle("weave", "weave", false).solved("nucleus_core::constraints::weave").fixed().extension();
        /// Angle of the warp to u, counterclockwise about the normal of the face. At 90 the warp follows v, at 45 the cloth is cut on the bias.
        WEAVE_ANGLE: f64 = float("weaveAngle", "weaveAngle", 0.0).soft(-180.0, 180.0).unit("degrees").solved("nucleus_graph::compile::weave").fixed().extension();
        /// Texture of the map of weave angle.
        WEAVE_ANGLE_MAP: f64 = texture("weaveAngleMap", "weaveAngleMap", 1.0).solved("nucleus_graph::compile::weave").fixed().extension();
        /// Factor on weave angle, per point. The warp of a face has the mean angle of its points.
        WEAVE_ANGLE_PER_VERTEX: Vec<f64> = floats("weaveAnglePerVertex", "weaveAnglePerVertex").solved("nucleus_graph::compile::weave").fixed().extension();
        /// Source of the map of weave angle: none, a value per point, or a texture. Default: what is given.
        WEAVE_ANGLE_MAP_TYPE: Choice = choice("weaveAngleMapType", "weaveAngleMapType", 2, MAP_TYPES).solved("nucleus_graph::compile::weave").fixed().extension();
        /// Membrane stiffness of woven cloth along the warp. Below 0: that of stretch.
        WARP_STIFFNESS: f64 = float("warpStiffness", "warpStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::weave").extension();
        /// Membrane stiffness of woven cloth along the weft. Below 0: that of stretch.
        WEFT_STIFFNESS: f64 = float("weftStiffness", "weftStiffness", -1.0).min(-1.0).soft(-1.0, 20000.0).unit("N/m").solved("nucleus_core::constraints::weave").extension();
        /// Physical: compressed links resist no more than the load at which a piece of cloth of their length buckles, by the bending stiffness. Cloth on a coarse mesh then gives way where it would fold, and drapes as on a fine one.
        BUCKLING: bool = toggle("buckling", "buckling", false).solved("nucleus_core::constraints::weave").extension();
        /// No point is farther from its nearest pins than the mesh reaches: cloth of many edges that hangs by pins stretches far less at the same `evaluations`. For cloth that hardly stretches.
        TETHERS: bool = toggle("tethers", "tethers", false).solved("nucleus_core::constraints::tether").extension();
        /// Whether points that `tethers` hold are linked over 4 and 16 edges towards their pins too. The links act when they
        /// are tight, and hold cloth that moves, as in wind: tethers alone do not limit the distance between two points that are both near enough to a pin.
        LONG_LINKS: bool = toggle("longLinks", "longLinks", false).solved("nucleus_core::constraints::tether").extension();
        /// Factor on the lengths of tethers and long links: 1.02 lets a point go 2 % farther than the mesh reaches at rest.
        TETHER_SCALE: f64 = float("tetherScale", "tetherScale", 1.0).min(0.0).soft(1.0, 1.1).solved("nucleus_core::constraints::tether").extension();
    }
    "Initial State" {
        /// Displaces each start position along its normal by a random length up to this, so that a symmetric sheet folds under load instead of staying flat. The rest shape is unchanged.
        INITIAL_PERTURBATION: f64 = float("initialPerturbation", "initialPerturbation", 0.0).min(0.0).soft(0.0, 0.1).unit("scene units").solved("nucleus_graph::compile::perturbation").fixed().extension();
        /// Seed of the random lengths.
        INITIAL_PERTURBATION_SEED: i64 = int("initialPerturbationSeed", "initialPerturbationSeed", 0).solved("nucleus_graph::compile::perturbation").fixed().extension();
    }
    "Caching" {
        /// Attributes that a cache stores.
        CACHEABLE_ATTRIBUTES: Choice = choice("cacheableAttributes", "caat", 0, &[(0, "Position"), (1, "Position And Velocity"), (2, "Dynamic State")]).elsewhere("a run records every frame in its own cache, which `--from` starts from");
        /// Use of a cache.
        CACHE_USAGE: Choice = choice("cacheUsage", "cu", 0, &[(0, "None"), (1, "Cache/Simulation"), (2, "Cache File Info")]).elsewhere("a run records every frame in its own cache, which `--from` starts from");
    }
    "Dynamic Properties Maps" {
        /// Texture of the map of stretch.
        STRETCH_MAP: f64 = texture("stretchMap", "stmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on stretch, per point.
        STRETCH_PER_VERTEX: Vec<f64> = floats("stretchPerVertex", "spv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of compression.
        COMPRESSION_MAP: f64 = texture("compressionMap", "cmmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on compression, per point.
        COMPRESSION_PER_VERTEX: Vec<f64> = floats("compressionPerVertex", "cmpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of bend.
        BEND_MAP: f64 = texture("bendMap", "bemp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on bend, per point.
        BEND_PER_VERTEX: Vec<f64> = floats("bendPerVertex", "bdpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of bend angle dropoff.
        BEND_ANGLE_DROPOFF_MAP: f64 = texture("bendAngleDropoffMap", "badm", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on bend angle dropoff, per point.
        BEND_ANGLE_DROPOFF_PER_VERTEX: Vec<f64> = floats("bendAngleDropoffPerVertex", "badv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of restitution angle.
        RESTITUTION_ANGLE_MAP: f64 = texture("restitutionAngleMap", "ranm", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on restitution angle, per point.
        RESTITUTION_ANGLE_PER_VERTEX: Vec<f64> = floats("restitutionAnglePerVertex", "rapv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of rigidity.
        RIGIDITY_MAP: f64 = texture("rigidityMap", "rimp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on rigidity, per point.
        RIGIDITY_PER_VERTEX: Vec<f64> = floats("rigidityPerVertex", "rpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of deform.
        DEFORM_MAP: f64 = texture("deformMap", "demp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on deform, per point.
        DEFORM_PER_VERTEX: Vec<f64> = floats("deformPerVertex", "dfpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of input attract.
        INPUT_ATTRACT_MAP: f64 = texture("inputAttractMap", "iamp", 0.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on input attract, per point.
        INPUT_ATTRACT_PER_VERTEX: Vec<f64> = floats("inputAttractPerVertex", "iapv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of rest length scale.
        REST_LENGTH_SCALE_MAP: f64 = texture("restLengthScaleMap", "rlmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on rest length scale, per point.
        REST_LENGTH_SCALE_PER_VERTEX: Vec<f64> = floats("restLengthScalePerVertex", "rlpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of lift.
        LIFT_MAP: f64 = texture("liftMap", "lfmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on lift, per point.
        LIFT_PER_VERTEX: Vec<f64> = floats("liftPerVertex", "lfpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of drag.
        DRAG_MAP: f64 = texture("dragMap", "drmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on drag, per point.
        DRAG_PER_VERTEX: Vec<f64> = floats("dragPerVertex", "drpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of tangential drag.
        TANGENTIAL_DRAG_MAP: f64 = texture("tangentialDragMap", "tdmp", 1.0).solved("nucleus_core::model::vertex_maps");
        /// Factor on tangential drag, per point.
        TANGENTIAL_DRAG_PER_VERTEX: Vec<f64> = floats("tangentialDragPerVertex", "tdpv").solved("nucleus_core::model::vertex_maps");
        /// Texture of the map of wrinkle.
        WRINKLE_MAP: f64 = texture("wrinkleMap", "wkmp", 0.0).solved("nucleus_graph::compile::input_mesh");
        /// Factor on wrinkle, per point.
        WRINKLE_PER_VERTEX: Vec<f64> = floats("wrinklePerVertex", "wpv").solved("nucleus_graph::compile::input_mesh");
        /// Height of the wrinkles of the wrinkle map.
        WRINKLE_MAP_SCALE: f64 = float("wrinkleMapScale", "wms", 1.0).soft(-2.0, 2.0).solved("nucleus_graph::compile::input_mesh").fixed();
        /// Source of the map of stretch: none, a value per point, or a texture. Default: what is given.
        STRETCH_MAP_TYPE: Choice = choice("stretchMapType", "smt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of compression: none, a value per point, or a texture. Default: what is given.
        COMPRESSION_MAP_TYPE: Choice = choice("compressionMapType", "cmmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of bend: none, a value per point, or a texture. Default: what is given.
        BEND_MAP_TYPE: Choice = choice("bendMapType", "bdmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of bend angle dropoff: none, a value per point, or a texture. Default: what is given.
        BEND_ANGLE_DROPOFF_MAP_TYPE: Choice = choice("bendAngleDropoffMapType", "bamt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of restitution angle: none, a value per point, or a texture. Default: what is given.
        RESTITUTION_ANGLE_MAP_TYPE: Choice = choice("restitutionAngleMapType", "ramt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of rigidity: none, a value per point, or a texture. Default: what is given.
        RIGIDITY_MAP_TYPE: Choice = choice("rigidityMapType", "rmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps");
        /// Source of the map of deform: none, a value per point, or a texture. Default: what is given.
        DEFORM_MAP_TYPE: Choice = choice("deformMapType", "dmmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps");
        /// Source of the map of input attract: none, a value per point, or a texture. Default: what is given.
        INPUT_ATTRACT_MAP_TYPE: Choice = choice("inputAttractMapType", "iamt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps");
        /// Source of the map of rest length scale: none, a value per point, or a texture. Default: what is given.
        REST_LENGTH_SCALE_MAP_TYPE: Choice = choice("restLengthScaleMapType", "rlmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of lift: none, a value per point, or a texture. Default: what is given.
        LIFT_MAP_TYPE: Choice = choice("liftMapType", "lfmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of drag: none, a value per point, or a texture. Default: what is given.
        DRAG_MAP_TYPE: Choice = choice("dragMapType", "drmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of tangential drag: none, a value per point, or a texture. Default: what is given.
        TANGENTIAL_DRAG_MAP_TYPE: Choice = choice("tangentialDragMapType", "tdmt", 2, MAP_TYPES).solved("nucleus_core::model::vertex_maps").fixed();
        /// Source of the map of wrinkle: none, a value per point, or a texture. Default: what is given.
        WRINKLE_MAP_TYPE: Choice = choice("wrinkleMapType", "wmt", 2, MAP_TYPES).solved("nucleus_graph::compile::input_mesh");
    }
    "Hidden" {
        /// Obsolete in Maya.
        NUM_SUBDIVISIONS: i64 = int("numSubdivisions", "nsub", 2).hidden().unused();
        /// Classic: limits stretch and compression to one iteration in a substep. Undocumented in Maya.
        MINIMAL_STRETCH: bool = toggle("minimalStretch", "msso", false).hidden().solved("nucleus_graph::compile::soft_body");
        /// Classic: limits bending to one iteration in a substep. Undocumented in Maya.
        MINIMAL_BEND: bool = toggle("minimalBend", "mbso", false).hidden().solved("nucleus_graph::compile::soft_body");
        /// Classic: limits shear to one iteration in a substep. Undocumented in Maya.
        MINIMAL_SHEAR: bool = toggle("minimalShear", "mshs", false).hidden().solved("nucleus_graph::compile::soft_body");
        /// Experimental in Maya: coarser levels of links.
        STRETCH_HIERARCHY_LEVELS: i64 = int("stretchHierarchyLevels", "shlv", 0).min(0.0).soft(0.0, 10.0).hidden().elsewhere("Maya neither shows nor documents this experiment");
        /// Weight of those levels.
        STRETCH_HIERARCHY_PERCENT: f64 = float("stretchHierarchyPercent", "shpe", 25.0).soft(0.0, 100.0).hidden().elsewhere("Maya neither shows nor documents this experiment");
    }
    "Connections" {
        /// The solved mesh in world space.
        OUTPUT_MESH: Plugged = plug("outputMesh", "omsh", Data::Mesh).output().solved("nucleus_graph::graph");
        /// The mesh at the start frame.
        OUTPUT_START_MESH: Plugged = plug("outputStartMesh", "otms", Data::Mesh).output().elsewhere("the first frame of the cache is the mesh at the start");
    }
}
