//! Settings that have no effect because another setting switches them off, or that count as less than they say: a warning
//! says which.

use crate::attributes::{Attribute, Choice, Key, n_base, n_cloth, nucleus};
use crate::graph::{NodeId, Setting};

use super::compiler::Compiler;
use super::units::CLASSIC;

/// A condition for an attribute to have an effect.
enum Need {
    /// Another attribute that is ever above zero.
    Number(&'static Key<f64>),
    /// Another attribute with one of these values, or with any but the first where there is none.
    Choice(&'static Key<Choice>, Option<Choice>),
    /// A switch that is ever on.
    On(&'static Key<bool>),
    /// The Classic resistance model.
    Classic,
}

/// An attribute that has no effect without another.
struct Dependency {
    row: &'static Attribute,
    need: Need,
    help: &'static str,
}

const fn needs(row: &'static Attribute, need: Need, help: &'static str) -> Dependency {
    Dependency { row, need, help }
}

/// `pressureMethod`.
const MANUAL: Choice = Choice(0);
const BY_VOLUME: Choice = Choice(1);
const BY_VOLUME_HELP: &str = "write `pressureMethod: volumeTrackingModel`";

const WOVEN_HELP: &str = "write `weave: true`";

static DEPENDENCIES: [Dependency; 24] = [
    needs(
        &n_cloth::PRESSURE.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(MANUAL)),
        "the gas inside sets the pressure: leave out `pressureMethod`, or give `startPressure`",
    ),
    needs(
        &n_cloth::START_PRESSURE.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)),
        BY_VOLUME_HELP,
    ),
    needs(&n_cloth::PUMP_RATE.row, Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)), BY_VOLUME_HELP),
    needs(
        &n_cloth::AIR_TIGHTNESS.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)),
        BY_VOLUME_HELP,
    ),
    needs(
        &n_cloth::INCOMPRESSIBILITY.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)),
        BY_VOLUME_HELP,
    ),
    needs(&n_cloth::SEAL_HOLES.row, Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)), BY_VOLUME_HELP),
    needs(
        &n_base::WIND_SHADOW_DIFFUSION.row,
        Need::Number(&n_base::WIND_SHADOW_DISTANCE),
        "give `windShadowDistance`",
    ),
    needs(
        &n_cloth::WIND_SELF_SHADOW.row,
        Need::Number(&n_base::WIND_SHADOW_DISTANCE),
        "give `windShadowDistance`",
    ),
    needs(
        &n_base::AIR_PUSH_VORTICITY.row,
        Need::Number(&n_base::AIR_PUSH_DISTANCE),
        "give `airPushDistance`",
    ),
    needs(
        &n_base::FIELD_MAGNITUDE.row,
        Need::Choice(&n_base::FORCE_FIELD, None),
        "write `forceField: singleSided`, `doubleSided` or `alongNormal`",
    ),
    needs(
        &n_base::POINT_FIELD_MAGNITUDE.row,
        Need::Choice(&n_base::POINT_FORCE_FIELD, None),
        "write `pointForceField: worldspace` or `thicknessRelative`",
    ),
    needs(
        &n_base::SELF_ATTRACT.row,
        Need::Choice(&n_base::POINT_FORCE_FIELD, None),
        "write `pointForceField: worldspace` or `thicknessRelative`",
    ),
    needs(
        &n_cloth::INPUT_ATTRACT_METHOD.row,
        Need::Number(&n_cloth::INPUT_MESH_ATTRACT),
        "give `inputMeshAttract`",
    ),
    needs(
        &n_cloth::INPUT_ATTRACT_DAMP.row,
        Need::Number(&n_cloth::INPUT_MESH_ATTRACT),
        "give `inputMeshAttract`",
    ),
    needs(
        &n_cloth::INITIAL_PERTURBATION_SEED.row,
        Need::Number(&n_cloth::INITIAL_PERTURBATION),
        "give `initialPerturbation`",
    ),
    needs(&n_cloth::WEAVE_ANGLE.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEAVE_ANGLE_MAP.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEAVE_ANGLE_MAP.row, Need::Number(&n_cloth::WEAVE_ANGLE), "give `weaveAngle`"),
    needs(&n_cloth::WEAVE_ANGLE_PER_VERTEX.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEAVE_ANGLE_PER_VERTEX.row, Need::Number(&n_cloth::WEAVE_ANGLE), "give `weaveAngle`"),
    needs(&n_cloth::WARP_STIFFNESS.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEFT_STIFFNESS.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::MINIMAL_STRETCH.row, Need::Classic, "it limits counts: write `resistanceModel: classic`"),
    needs(&n_cloth::MINIMAL_BEND.row, Need::Classic, "it limits counts: write `resistanceModel: classic`"),
];

impl Compiler<'_> {
    /// Warns of settings of an object that another setting of it switches off.
    pub(super) fn warn_of_contradictions(&mut self, object: NodeId) {
        let graph = &self.scene.graph;
        let (node, nucleus) = (graph.node(object), self.program.node);
        for Dependency { row, need, help } in &DEPENDENCIES {
            let is_own = node.node_type().attribute(row.name).is_some_and(|own| own == *row);
            if !is_own || !node.settings().contains_key(row.name) {
                continue;
            }
            let because = match need {
                Need::Number(key) if !graph.is_ever_nonzero(object, key) => {
                    format!("`{}` is 0", key.row.name)
                }
                Need::Choice(key, wanted)
                    if !graph.changes(object, key) && !is_one(node.get(key), *wanted) =>
                {
                    let word = key.row.words().into_iter().find(|(value, _)| *value == node.get(key));
                    format!("`{}` is {}", key.row.name, word.map_or_else(String::new, |(_, word)| word))
                }
                Need::On(key) if !graph.is_ever_nonzero(object, key) => {
                    format!("`{}` is false", key.row.name)
                }
                Need::Classic if self.start.get(nucleus, &nucleus::RESISTANCE_MODEL) != CLASSIC => {
                    "`resistanceModel` is physical".to_owned()
                }
                _ => continue,
            };
            let place = self.scene.source.place(&format!("{}.{}", node.name(), row.name));
            let message = format!("`{}` of `{}` has no effect: {because}", row.name, node.name());
            self.findings.warning(&place, message).help(*help);
        }
        self.warn_of_bounce(object, &n_base::BOUNCE);
    }

    /// Warns of a bounce above 1, which counts as 1.
    pub(super) fn warn_of_bounce(&mut self, object: NodeId, key: &Key<f64>) {
        let node = self.scene.graph.node(object);
        let largest = node.settings().get(key.row.name).map_or(0.0, Setting::largest);
        if largest > 1.0 {
            let place = self.scene.source.place(&format!("{}.{}", node.name(), key.row.name));
            let message = format!("`{}` of `{}` is {largest}, and counts as 1", key.row.name, node.name());
            let warning = self.findings.warning(&place, message);
            warning
                .help("above 1 every contact would add energy; a field or `localForce` drives objects apart");
        }
    }
}

fn is_one(value: Choice, wanted: Option<Choice>) -> bool {
    wanted.map_or(value != Choice(0), |wanted| value == wanted)
}
