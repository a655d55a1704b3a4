//! The solver node.

use super::key::{Plugged, choice, float, int, plug, toggle, vector};
use super::kind::Data;
use super::node_type::node_table;
use super::scene_nodes::transform::TRANSFORM;
use super::value::Choice;

node_table! {
    /// A solver. Objects interact only with objects of the same solver. Its attributes are gravity, wind, the ground plane and the solver settings.
    NUCLEUS = "nucleus", inherits Some(&TRANSFORM), hides [];
    "General" {
        /// Enables the solver. Off: all objects keep their state.
        ENABLE: bool = toggle("enable", "ena", true).solved("nucleus_graph::simulation");
    }
    "Gravity and Wind" {
        /// Acceleration of gravity. A scene unit is `spaceScale` metres.
        GRAVITY: f64 = float("gravity", "grty", 9.8).soft(0.0, 100.0).unit("m/s²").solved("nucleus_core::integrate::predict");
        /// Direction of gravity, of any length.
        GRAVITY_DIRECTION: [f64; 3] = vector("gravityDirection", "grdi", [0.0, -1.0, 0.0], ["grdx", "grdy", "grdz"]).solved("nucleus_core::integrate::predict");
        /// Air density for drag and lift, relative to ordinary air: 0 is a vacuum.
        AIR_DENSITY: f64 = float("airDensity", "ady", 1.0).min(0.0).soft(0.0, 10.0).solved("nucleus_core::integrate::aerodynamics");
        /// Speed of the wind.
        WIND_SPEED: f64 = float("windSpeed", "wisp", 0.0).soft(0.0, 50.0).unit("m/s").solved("nucleus_core::integrate::aerodynamics");
        /// Direction of the wind, of any length.
        WIND_DIRECTION: [f64; 3] = vector("windDirection", "widi", [1.0, 0.0, 0.0], ["widx", "widy", "widz"]).solved("nucleus_core::integrate::aerodynamics");
        /// Gusts as a multiple of the wind speed, smooth in space and time.
        WIND_NOISE: f64 = float("windNoise", "wnoi", 0.0).soft(0.0, 1.0).solved("nucleus_core::integrate::gusts");
    }
    "Ground Plane" {
        /// Adds an infinite ground plane that all objects collide with.
        USE_PLANE: bool = toggle("usePlane", "nupl", false).solved("nucleus_core::contact::ground");
        /// A point of the ground plane.
        PLANE_ORIGIN: [f64; 3] = vector("planeOrigin", "npor", [0.0, 0.0, 0.0], ["npox", "npoy", "npoz"]).unit("scene units").solved("nucleus_core::contact::ground");
        /// Normal of the ground plane, of any length. Objects stay on the side that it points to.
        PLANE_NORMAL: [f64; 3] = vector("planeNormal", "npun", [0.0, 1.0, 0.0], ["npnx", "npny", "npnz"]).solved("nucleus_core::contact::ground");
        /// Share of the normal speed that a contact with the ground plane returns, at most 1.
        PLANE_BOUNCE: f64 = float("planeBounce", "npbc", 0.0).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::restitution");
        /// Friction of the ground plane, added to that of the object.
        PLANE_FRICTION: f64 = float("planeFriction", "npfr", 0.1).min(0.0).soft(0.0, 1.0).solved("nucleus_core::contact::response");
        /// Stickiness of the ground plane, added to that of the object.
        PLANE_STICKINESS: f64 = float("planeStickiness", "npst", 0.0).soft(0.0, 2.0).solved("nucleus_core::contact::response");
    }
    "Solver Attributes" {
        /// Directions and the ground plane are in the space of this node's transform.
        USE_TRANSFORM: bool = toggle("useTransform", "ustf", true).solved("nucleus_graph::compile");
        /// Objects whose collision layers differ by this much or more do not collide.
        COLLISION_LAYER_RANGE: f64 = float("collisionLayerRange", "clra", 4.0).soft(1.0, 10.0).solved("nucleus_core::contact::material");
        /// Number of substeps per frame.
        SUB_STEPS: i64 = int("subSteps", "sstp", 3).min(1.0).max(100000.0).soft(1.0, 20.0).unit("per frame").solved("nucleus_core::schedule");
        /// Collision passes in 1/24 s, shared among the substeps.
        MAX_COLLISION_ITERATIONS: i64 = int("maxCollisionIterations", "mcit", 4).min(0.0).max(1000000.0).soft(0.0, 100.0).unit("per 1/24 s").solved("nucleus_core::schedule");
        /// Whether Maya prints the time per frame or substep.
        TIMING_OUTPUT: Choice = choice("timingOutput", "to", 0, &[(0, "None"), (1, "Frame"), (2, "Subframe")]).elsewhere("`nucleus run` says how long it takes");
    }
    "Scale Attributes" {
        /// Evaluates force fields in every substep. Maya evaluates them once per frame.
        FIELDS_PER_SUBSTEP: bool = toggle("fieldsPerSubstep", "fieldsPerSubstep", false).solved("nucleus_core::fields").extension();
        /// Simulated time relative to the time of the animation.
        TIME_SCALE: f64 = float("timeScale", "tisc", 1.0).min(0.0001).max(10000.0).soft(0.01, 10.0).solved("nucleus_graph::compile");
        /// Metres in one scene unit: 1 for a scene in metres, 0.01 for one in centimetres.
        SPACE_SCALE: f64 = float("spaceScale", "spsc", 1.0).min(1e-06).max(1000000.0).soft(0.01, 10.0).unit("m per scene unit").solved("nucleus_graph::compile").fixed();
    }
    "Time Attributes" {
        /// Time of the evaluation in frames; driven by `time1.outTime` unless keys or a connection retime it.
        CURRENT_TIME: f64 = float("currentTime", "cti", 0.0).solved("nucleus_graph::simulation");
        /// The frame of the initial state, at which a run begins. Default: the first frame of the scene.
        START_FRAME: f64 = float("startFrame", "stf", 1.0).unit("frame").solved("nucleus_graph::simulation").fixed();
        /// Largest number of frames that one evaluation may span.
        FRAME_JUMP_LIMIT: i64 = int("frameJumpLimit", "fjlt", 1).min(1.0).soft(1.0, 10.0).solved("nucleus_graph::simulation");
    }
    "Nucleus (open)" {
        /// Meaning of a resistance. Classic: a number of iterations, as in Maya. Physical: a stiffness, independent of mesh and substeps.
        RESISTANCE_MODEL: Choice = choice("resistanceModel", "resistanceModel", 1, &[(0, "Classic"), (1, "Physical")]).solved("nucleus_core::schedule").fixed().extension();
        /// Lift as in Maya, which uses speeds in scene units per second: 1 / `spaceScale` times as strong. For scenes from Maya.
        LIFT_IN_SCENE_UNITS: bool = toggle("liftInSceneUnits", "liftInSceneUnits", false).solved("nucleus_graph::compile::frame").extension();
        /// Physical: evaluations of each constraint in 1/24 s. More evaluations only reduce the error. Where they are not given, `autoEvaluations` may raise them.
        EVALUATIONS: f64 = float("evaluations", "evaluations", 96.0).min(1.0).max(1e6).soft(24.0, 384.0).unit("per 1/24 s").solved("nucleus_core::schedule").extension();
        /// Physical: where `evaluations` are not given, they are as many as leave cloth stretched by about 1 % at rest whatever its size, at least 96: from edge lengths, pins, gravity, mass and stiffness at the first frame, and the largest pressure of the run. `nucleus info` says how many.
        AUTO_EVALUATIONS: bool = toggle("autoEvaluations", "autoEvaluations", true).solved("nucleus_graph::compile::budget").fixed().extension();
    }
    "Hidden" {
        /// Largest depth of a contact within the thickness.
        COLLISION_SOFTNESS: f64 = float("collisionSoftness", "clso", 0.0).min(0.0).max(1.0).hidden().unused();
        /// Kinds of element pairs that are tested between objects.
        COLLISION_FLAG: Choice = choice("collisionFlag", "cofl", 4, &[(0, "None"), (1, "Vertex"), (2, "VertexEdge"), (3, "VertexFace"), (4, "EdgeEdge"), (5, "EdgeFace"), (8, "AllCombinations")]).hidden().elsewhere("the `collisionFlag` of each object counts");
        /// Kinds of element pairs that are tested within an object.
        SELF_COLLISION_FLAG: Choice = choice("selfCollisionFlag", "scfl", 1, &[(0, "None"), (1, "Vertex"), (2, "VertexEdge"), (3, "VertexFace"), (4, "EdgeEdge"), (5, "EdgeFace")]).hidden().elsewhere("the `selfCollisionFlag` of each object counts");
    }
    "Connections" {
        /// Current state of each active object.
        INPUT_ACTIVE: Plugged = plug("inputActive", "niao", Data::State).multi().solved("nucleus_graph::compile::objects");
        /// Initial state of each active object.
        INPUT_ACTIVE_START: Plugged = plug("inputActiveStart", "nias", Data::State).multi().wiring("the connection of `inputActive` stands for both");
        /// Current state of each collider.
        INPUT_PASSIVE: Plugged = plug("inputPassive", "nipo", Data::State).multi().solved("nucleus_graph::compile::objects");
        /// Initial state of each collider.
        INPUT_PASSIVE_START: Plugged = plug("inputPassiveStart", "nips", Data::State).multi().wiring("the connection of `inputPassive` stands for both");
        /// Current state of each constraint.
        INPUT_CURRENT: Plugged = plug("inputCurrent", "ic", Data::Constraint).multi().solved("nucleus_graph::compile::constraints");
        /// Initial state of each constraint.
        INPUT_START: Plugged = plug("inputStart", "is", Data::Constraint).multi().wiring("the connection of `inputCurrent` stands for both");
        /// Solved state of each active object.
        OUTPUT_OBJECTS: Plugged = plug("outputObjects", "noao", Data::State).multi().output().solved("nucleus_graph::graph");
    }
    "Internal" {
        /// Time of the previous solve.
        LAST_TIME: f64 = float("lastTime", "lti", 0.0).hidden().wiring("Maya's own bookkeeping between evaluations");
        /// Number of the evaluation.
        EVAL_ID: f64 = float("evalId", "eid", 0.0).hidden().wiring("Maya's own bookkeeping between evaluations");
        /// Skips the setup of objects.
        SKIP_SETUP: bool = toggle("skipSetup", "sksp", false).hidden().wiring("Maya's own bookkeeping between evaluations");
        /// `startFrame` as a time.
        START_TIME: f64 = float("startTime", "sti", 0.0).output().hidden().wiring("Maya's own bookkeeping between evaluations");
        /// Reading it evaluates the node.
        FORCE_DYNAMICS: bool = toggle("forceDynamics", "fdn", false).sink().hidden().wiring("Maya's own bookkeeping between evaluations");
    }
}
