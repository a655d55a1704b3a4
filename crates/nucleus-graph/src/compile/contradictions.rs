//! Settings that have no effect because another setting switches them off, or that count as less than they say: a warning
//! says which.

use crate::attributes::{Choice, Key, Value, n_base, nucleus, particle};
use crate::graph::{Graph, NodeId, Setting};

use super::compiler::Compiler;
use super::dependencies::{DEPENDENCIES, Dependency, Need};
use super::particle_ramps::is_event_target;
use super::units::CLASSIC;

/// Evaluations that are searched for jumps of time.
const MAX_EVALUATIONS: u32 = 100_000;

impl Compiler<'_> {
    /// Warns of settings of an object that another setting of it switches off.
    pub(super) fn warn_of_contradictions(&mut self, object: NodeId) {
        let graph = &self.scene.graph;
        let node = graph.node(object);
        let is_classic = self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL) == CLASSIC;
        let dependencies = DEPENDENCIES
            .iter()
            .flat_map(|Dependency { rows, need, help }| rows.iter().map(move |&row| (row, need, *help)));
        let mut told = Vec::new();
        for (row, need, help) in dependencies {
            let is_own = node.node_type().attribute(row.name).is_some_and(|own| own == row);
            // A switch, a choice or a number that is off by default needs nothing to be off.
            let is_off = |setting: &Setting| {
                let off = [Value::Bool(false), Value::Choice(Choice(0)), Value::Float(0.0)];
                off.into_iter()
                    .any(|off| row.default.as_ref() == Some(&off) && *setting == Setting::Fixed(off))
            };
            if !is_own || told.contains(&row.name) || node.settings().get(row.name).is_none_or(is_off) {
                continue;
            }
            let because = match need {
                Need::Number(key) if !graph.is_ever_nonzero(object, key) => {
                    format!("`{}` is 0", key.row.name)
                }
                Need::Choice(key, wanted)
                    if !graph.changes(object, key) && !is_one(node.get(key), wanted) =>
                {
                    let word = key.row.words().into_iter().find(|(value, _)| *value == node.get(key));
                    format!("`{}` is {}", key.row.name, word.map_or_else(String::new, |(_, word)| word))
                }
                Need::Positive(keys) if !keys.iter().any(|key| is_ever_positive(graph, object, key)) => {
                    format!("`{}` is 0", keys[0].row.name)
                }
                Need::On(keys) if !keys.iter().any(|key| is_ever_on(graph, object, key)) => {
                    format!("`{}` is false", keys[0].row.name)
                }
                Need::Given(rows) if !rows.iter().any(|row| graph.is_given_by_name(object, row.name)) => {
                    let names: Vec<String> = rows.iter().map(|row| format!("`{}`", row.name)).collect();
                    format!("it needs {}", names.join(" or "))
                }
                Need::Births if !is_born(graph, object) => "no particles are born".to_owned(),
                Need::Classic if !is_classic => "`resistanceModel` is physical".to_owned(),
                Need::Physical if is_classic => "`resistanceModel` is classic".to_owned(),
                _ => continue,
            };
            let place = self.scene.source.place(&format!("{}.{}", node.name(), row.name));
            let message = format!("`{}` of `{}` has no effect: {because}", row.name, node.name());
            self.findings.warning(&place, message).help(help);
            told.push(row.name);
        }
        self.warn_of_bounce(object, &n_base::BOUNCE);
    }

    /// Warns of directions of the nucleus that are zero and switch off what has them.
    pub(super) fn warn_of_zero_directions(&mut self) {
        let graph = &self.scene.graph;
        let (id, node) = (self.program.node, graph.node(self.program.node));
        let number = |key| graph.is_ever_nonzero(id, key);
        let directions = [
            (&nucleus::GRAVITY_DIRECTION, number(&nucleus::GRAVITY), "gravity", "(0, -1, 0)", "gravity: 0"),
            (&nucleus::WIND_DIRECTION, number(&nucleus::WIND_SPEED), "wind", "(1, 0, 0)", "windSpeed: 0"),
            (
                &nucleus::PLANE_NORMAL,
                graph.is_ever_nonzero(id, &nucleus::USE_PLANE),
                "ground plane",
                "(0, 1, 0)",
                "usePlane: false",
            ),
        ];
        for (key, is_on, what, usual, off) in directions {
            if is_on && !graph.is_ever_nonzero(id, key) {
                let (name, row) = (node.name(), key.row.name);
                let place = self.scene.source.place(&format!("{name}.{row}"));
                let message = format!("`{name}` has no {what}: its `{row}` is zero");
                let help = format!("give it a direction, `{row}: {usual}`, or write `{off}`");
                self.findings.warning(&place, message).help(&help);
            }
        }
    }

    /// Warns of a time that keys or a connection advance by more than `frameJumpLimit`: the nucleus skips such intervals.
    pub(super) fn warn_of_frame_jumps(&mut self) {
        let (scene, id) = (self.scene, self.program.node);
        let graph = &scene.graph;
        if graph.source(id, &nucleus::CURRENT_TIME) == Some(graph.clock()) {
            return;
        }
        let time_at = |frame: f64| graph.at(frame).get(id, &nucleus::CURRENT_TIME);
        let first = self.start.frame();
        let ends = (1..=MAX_EVALUATIONS).map(|k| first + scene.every * f64::from(k));
        let ends: Vec<f64> = ends.take_while(|end| *end <= scene.time.end as f64).collect();
        let jump_at = |&end: &f64| {
            let limit = graph.at(end).get(id, &nucleus::FRAME_JUMP_LIMIT) as f64;
            let jump = time_at(end) - time_at(end - scene.every);
            (jump > limit.max(scene.every) * (1.0 + 1e-9)).then_some((end, jump, limit))
        };
        let skipped: Vec<(f64, f64, f64)> = ends.iter().filter_map(jump_at).collect();
        let Some((end, jump, limit)) = skipped.first() else { return };
        let name = graph.node(id).name();
        let message = format!(
            "`{name}` stands still in {} of {} evaluations: its `currentTime` advances by {:.3} to frame {end}, \
            and `frameJumpLimit` is {limit}",
            skipped.len(),
            ends.len(),
            jump
        );
        let place = scene.source.place(&format!("{name}.{}", nucleus::CURRENT_TIME.row.name));
        let help = format!("write `frameJumpLimit: {}`, or key a slower time", jump.ceil());
        self.findings.warning(&place, message).help(&help);
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

/// Whether an emitter or an event may add particles to an object.
fn is_born(graph: &Graph, object: NodeId) -> bool {
    !graph.elements(object, &particle::NEW_PARTICLES).is_empty() || is_event_target(graph, object)
}

/// Whether a number is ever above zero.
fn is_ever_positive(graph: &Graph, object: NodeId, key: &Key<f64>) -> bool {
    graph.changes(object, key) && graph.is_ever_nonzero(object, key) || graph.node(object).get(key) > 0.0
}

/// Whether a switch that an object may lack is ever on.
fn is_ever_on(graph: &Graph, object: NodeId, key: &Key<bool>) -> bool {
    graph.node(object).node_type().attribute(key.row.name).is_some() && graph.is_ever_nonzero(object, key)
}

fn is_one(value: Choice, wanted: &[Choice]) -> bool {
    if wanted.is_empty() { value != Choice(0) } else { wanted.contains(&value) }
}
