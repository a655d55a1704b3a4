//! Attributes that differ by particle: ramps, collision events, and lists of the initial state.

use std::borrow::Cow;

use nalgebra::Vector3;
use nucleus_core::{ClothId, CollisionEvent, ParticleRamp, RampInput, RampTarget};

use crate::attributes::{Choice, ColorPoint, Key, Painting, Ramp, RampPoint, Value, n_particle, particle};
use crate::diagnostic::nearest;
use crate::graph::{Graph, NodeId};
use crate::memory;
use crate::paint::{Expression, Point, read_numbers};

use super::compiler::Compiler;
use super::emission::Lifespan;

/// Samples of a ramp.
const SAMPLES: usize = 129;
/// The largest factor of a ramp.
const MAX_FACTOR: f64 = 1e6;
/// Room for the particles of collision events where `maxCount` gives none.
pub(super) const EVENT_ROOM: u64 = 10_000;

/// The attributes of one ramp of numbers.
struct RampKeys {
    target: RampTarget,
    ramp: &'static Key<Cow<'static, [RampPoint]>>,
    input: &'static Key<Choice>,
    input_max: &'static Key<f64>,
    randomize: Option<&'static Key<f64>>,
}

/// All ramps of numbers. Collide strength, point field, viscosity and surface tension do not vary at random in Maya.
static RAMPS: [RampKeys; 10] = {
    use n_particle::*;
    const fn keys(
        target: RampTarget,
        ramp: &'static Key<Cow<'static, [RampPoint]>>,
        input: &'static Key<Choice>,
        input_max: &'static Key<f64>,
        randomize: Option<&'static Key<f64>>,
    ) -> RampKeys {
        RampKeys { target, ramp, input, input_max, randomize }
    }
    [
        keys(
            RampTarget::Radius,
            &RADIUS_SCALE,
            &RADIUS_SCALE_INPUT,
            &RADIUS_SCALE_INPUT_MAX,
            Some(&RADIUS_SCALE_RANDOMIZE),
        ),
        keys(
            RampTarget::Mass,
            &MASS_SCALE,
            &MASS_SCALE_INPUT,
            &MASS_SCALE_INPUT_MAX,
            Some(&MASS_SCALE_RANDOMIZE),
        ),
        keys(
            RampTarget::Friction,
            &FRICTION_SCALE,
            &FRICTION_SCALE_INPUT,
            &FRICTION_SCALE_INPUT_MAX,
            Some(&FRICTION_RANDOMIZE),
        ),
        keys(
            RampTarget::Stickiness,
            &STICKINESS_SCALE,
            &STICKINESS_SCALE_INPUT,
            &STICKINESS_SCALE_INPUT_MAX,
            Some(&STICKINESS_RANDOMIZE),
        ),
        keys(
            RampTarget::Bounce,
            &BOUNCE_SCALE,
            &BOUNCE_SCALE_INPUT,
            &BOUNCE_SCALE_INPUT_MAX,
            Some(&BOUNCE_RANDOMIZE),
        ),
        keys(
            RampTarget::CollideStrength,
            &COLLIDE_STRENGTH_SCALE,
            &COLLIDE_STRENGTH_SCALE_INPUT,
            &COLLIDE_STRENGTH_SCALE_INPUT_MAX,
            None,
        ),
        keys(
            RampTarget::PointField,
            &POINT_FIELD_SCALE,
            &POINT_FIELD_SCALE_INPUT,
            &POINT_FIELD_SCALE_INPUT_MAX,
            None,
        ),
        keys(
            RampTarget::Viscosity,
            &VISCOSITY_SCALE,
            &VISCOSITY_SCALE_INPUT,
            &VISCOSITY_SCALE_INPUT_MAX,
            None,
        ),
        keys(
            RampTarget::SurfaceTension,
            &SURFACE_TENSION_SCALE,
            &SURFACE_TENSION_SCALE_INPUT,
            &SURFACE_TENSION_SCALE_INPUT_MAX,
            None,
        ),
        keys(
            RampTarget::Opacity,
            &OPACITY_SCALE,
            &OPACITY_SCALE_INPUT,
            &OPACITY_SCALE_INPUT_MAX,
            Some(&OPACITY_SCALE_RANDOMIZE),
        ),
    ]
};

/// What a ramp is read by, by Maya's index.
fn ramp_input(choice: Choice) -> RampInput {
    match choice.0 {
        1 => RampInput::Age,
        2 => RampInput::NormalizedAge,
        3 => RampInput::Speed,
        4 => RampInput::Acceleration,
        5 => RampInput::Id,
        6 => RampInput::RandomizedId,
        7 => RampInput::Radius,
        _ => RampInput::Off,
    }
}

/// Largest number of a particle: `particleId0` is a list of floating-point numbers, which hold no larger whole numbers.
const MAX_ID: f64 = 9_007_199_254_740_992.0;

impl Compiler<'_> {
    /// The ramps of an object that differ from 1 anywhere.
    pub(super) fn particle_ramps(&mut self, node: NodeId) -> Vec<ParticleRamp> {
        let mut ramps: Vec<ParticleRamp> =
            RAMPS.iter().filter_map(|keys| self.number_ramp(node, keys)).collect();
        ramps.extend(self.color_ramp(
            node,
            RampTarget::Color,
            (&n_particle::COLOR, &n_particle::COLOR_INPUT),
            [&n_particle::COLOR_INPUT_MAX, &n_particle::COLOR_RANDOMIZE],
        ));
        ramps.extend(self.color_ramp(
            node,
            RampTarget::Incandescence,
            (&n_particle::INCANDESCENCE, &n_particle::INCANDESCENCE_INPUT),
            [&n_particle::INCANDESCENCE_INPUT_MAX, &n_particle::INCANDESCENCE_RANDOMIZE],
        ));
        ramps
    }

    fn number_ramp(&mut self, node: NodeId, keys: &RampKeys) -> Option<ParticleRamp> {
        let base = match keys.target {
            RampTarget::Opacity => self.start.get(node, &n_particle::OPACITY),
            _ => 1.0,
        };
        let input = ramp_input(self.start.get(node, keys.input));
        let randomize = keys.randomize.map_or(0.0, |key| self.start.get(node, key));
        let ramp = Ramp::new(&self.start.get(node, keys.ramp));
        let at = |k: usize| base * ramp.value_at(k as f64 / (SAMPLES - 1) as f64);
        // Without an input a factor other than 1 is a ramp of one sample.
        let (input, samples) = match input {
            RampInput::Off if base == 1.0 => (input, vec![1.0]),
            RampInput::Off => (RampInput::Age, vec![base]),
            input => (input, (0..SAMPLES).map(at).collect()),
        };
        let is_one = samples.iter().all(|&sample| sample == 1.0);
        if is_one && randomize <= 0.0 {
            return None;
        }
        self.check_factors(node, keys, &samples)?;
        let input_max = self.input_max(input, self.start.get(node, keys.input_max));
        Some(ParticleRamp { target: keys.target, input, input_max, samples, randomize })
    }

    /// Refuses factors below zero; `None` after an error, which is reported.
    fn check_factors(&mut self, node: NodeId, keys: &RampKeys, samples: &[f64]) -> Option<()> {
        let Some(bad) = samples.iter().find(|&&sample| !(0.0..=MAX_FACTOR).contains(&sample)) else {
            return Some(());
        };
        let name = self.scene.graph.node(node).name();
        let message = format!(
            "`{}` of `{name}` must be between 0 and {MAX_FACTOR}, but is {bad} somewhere",
            keys.ramp.row.name
        );
        let error = self.findings.error(&self.place(node, &keys.ramp.row), message);
        error.help("a ramp is a factor: 1 leaves the attribute as it is");
        None
    }

    /// The input at the right end of a ramp, in metres and seconds.
    fn input_max(&self, input: RampInput, given: f64) -> f64 {
        match input {
            RampInput::Speed | RampInput::Acceleration | RampInput::Radius => {
                self.program.units.length(given.max(0.0))
            }
            _ => given.max(0.0),
        }
    }

    /// The three channels of a ramp of colours; none where it has no colours.
    fn color_ramp(
        &self,
        node: NodeId,
        target: fn(u8) -> RampTarget,
        (ramp, input): (&Key<Cow<'static, [ColorPoint]>>, &Key<Choice>),
        [input_max, randomize]: [&Key<f64>; 2],
    ) -> Vec<ParticleRamp> {
        let points = self.start.get(node, ramp);
        if points.is_empty() {
            return Vec::new();
        }
        let input = ramp_input(self.start.get(node, input));
        let input_max = self.input_max(input, self.start.get(node, input_max));
        let randomize = self.start.get(node, randomize).clamp(0.0, MAX_FACTOR);
        let channel = |channel: u8| {
            let own: Vec<RampPoint> = points
                .iter()
                .map(|point| RampPoint {
                    position: point.position,
                    value: point.color[usize::from(channel)].clamp(0.0, MAX_FACTOR),
                    interpolation: point.interpolation,
                })
                .collect();
            let samples = Ramp::new(&own).samples::<SAMPLES>().to_vec();
            ParticleRamp { target: target(channel), input, input_max, samples, randomize }
        };
        (0..3).map(channel).collect()
    }

    /// One number per initial particle from a list, a file or an expression of the place, or none; `None` after an error,
    /// which is reported.
    pub(super) fn particle_numbers(
        &mut self,
        node: NodeId,
        key: &'static Key<Vec<f64>>,
        places: &[Vector3<f64>],
    ) -> Option<Vec<f64>> {
        let found = match self.start.held(node, key) {
            Some(Value::Floats(values)) => Ok(values),
            Some(Value::Painting(Painting::File(file))) => {
                let path = self.scene.source.path(&file);
                let checked = self.check_file(&path, memory::NUMBER_BYTE);
                checked.and_then(|()| read_numbers(&path).map_err(|error| error.to_string()))
            }
            Some(Value::Painting(Painting::Expression(text))) => {
                evaluated(&text, places).map_err(|error| error.to_string())
            }
            _ => return Some(Vec::new()),
        };
        let name = self.scene.graph.node(node).name();
        let label = format!("`{}` of `{name}`", key.row.name);
        let checked = found.and_then(|values| {
            if !values.is_empty() && values.len() != places.len() {
                return Err(format!("{label} has {} values for {} particles", values.len(), places.len()));
            }
            match values.iter().position(|value| !value.is_finite()) {
                Some(at) => Err(format!("{label} is not a finite number at particle {at}")),
                None => Ok(values),
            }
        });
        match checked {
            Ok(values) => Some(values),
            Err(message) => {
                let place = self.place(node, &key.row);
                self.findings.error(&place, message);
                None
            }
        }
    }

    /// The numbers of the first particles, of which each has its own; `None` after an error, which is reported.
    pub(super) fn particle_ids(&mut self, node: NodeId, places: &[Vector3<f64>]) -> Option<Vec<u64>> {
        let given = self.particle_numbers(node, &particle::PARTICLE_ID0, places)?;
        let is_number = |number: &f64| number.fract() == 0.0 && (0.0..=MAX_ID).contains(number);
        let mut ids: Vec<u64> =
            given.iter().filter(|number| is_number(number)).map(|&id| id as u64).collect();
        let as_given = ids.clone();
        ids.sort_unstable();
        ids.dedup();
        if ids.len() < given.len() {
            let name = self.scene.graph.node(node).name();
            let message = format!(
                "the numbers of `{name}` in `particleId0` are not each its own, whole and at least 0"
            );
            self.findings.error(&self.place(node, &particle::PARTICLE_ID0.row), message);
            return None;
        }
        Some(as_given)
    }

    /// The collision events of an object; `None` after an error, which is reported.
    pub(super) fn collision_events(&mut self, node: NodeId) -> Option<Vec<CollisionEvent>> {
        let graph = &self.scene.graph;
        let numbers = |key: &Key<Vec<f64>>| self.start.get(node, key);
        let lists = [
            &particle::EVENT_COUNT,
            &particle::EVENT_EMIT,
            &particle::EVENT_SPLIT,
            &particle::EVENT_DIE,
            &particle::EVENT_RANDOM,
            &particle::EVENT_SPREAD,
            &n_particle::EVENT_PROBABILITY,
        ]
        .map(numbers);
        let events = lists.iter().map(Vec::len).max().unwrap_or(0);
        if events == 0 {
            return Some(Vec::new());
        }
        let name = graph.node(node).name();
        for (list, (row, most)) in lists.iter().zip(EVENT_ROWS) {
            let is_valid = |x: &f64| (0.0..=most).contains(x);
            let message = match list.iter().find(|x| !is_valid(x)) {
                Some(bad) => format!("`{row}` of `{name}` must be between 0 and {most}, but is {bad}"),
                None if list.len() == events || list.is_empty() => continue,
                None => format!("`{row}` of `{name}` has {} values for {events} events", list.len()),
            };
            let error = self.findings.error(&self.scene.source.place(&format!("{name}.{row}")), message);
            error.help("each list has one number per event, or is left out");
            return None;
        }
        let targets = self.event_targets(node, events)?;
        let number = |list: usize, at: usize, default: f64| lists[list].get(at).copied().unwrap_or(default);
        let event = |at: usize| CollisionEvent {
            count: number(0, at, 0.0) as u32,
            emit: number(1, at, 0.0) as u32,
            split: number(2, at, 0.0) as u32,
            die: number(3, at, 0.0) != 0.0,
            random: number(4, at, 0.0) != 0.0,
            spread: number(5, at, 0.5),
            probability: number(6, at, 1.0),
            target: targets[at].1,
            lifespan: Lifespan::new(targets[at].0, &self.start).range(),
        };
        Some((0..events).map(event).collect())
    }

    /// The object that each event of a node emits into; `None` after an error, which is reported.
    fn event_targets(&mut self, node: NodeId, events: usize) -> Option<Vec<(NodeId, ClothId)>> {
        let names = self.start.get(node, &n_particle::EVENT_PARTICLES);
        if names.len() > 1 && names.len() != events {
            let (name, given) = (self.scene.graph.node(node).name(), names.len());
            let message = format!("`eventParticles` of `{name}` has {given} values for {events} events");
            let error = self.findings.error(&self.place(node, &n_particle::EVENT_PARTICLES.row), message);
            error.help("give one name for all events, or one per event; \"\" is the node itself");
            return None;
        }
        let one = names.first().map_or("", String::as_str);
        (0..events).map(|at| self.event_target(node, names.get(at).map_or(one, String::as_str))).collect()
    }

    /// The object of this name, or the node itself for an empty one.
    fn event_target(&mut self, node: NodeId, name: &str) -> Option<(NodeId, ClothId)> {
        let of = |wanted: NodeId| self.particle_ids.iter().copied().find(|(id, _)| *id == wanted);
        let target = if name.is_empty() { Some(node) } else { self.scene.graph.find(name) };
        let found = target.and_then(of);
        if found.is_none() {
            let row = &n_particle::EVENT_PARTICLES.row;
            let message = format!("there are no particles `{name}` in this nucleus to emit into");
            let names = self.particle_ids.iter().map(|(id, _)| self.scene.graph.node(*id).name());
            let guess = nearest(name, names);
            self.findings.error(&self.place(node, row), message).did_you_mean(guess);
        }
        found
    }
}

/// The largest count of an event.
const MAX_COUNT: f64 = u16::MAX as f64;

/// Names of the lists of events and their largest values, in the order in which they are read.
const EVENT_ROWS: [(&str, f64); 7] = [
    ("eventCount", MAX_COUNT),
    ("eventEmit", MAX_COUNT),
    ("eventSplit", MAX_COUNT),
    ("eventDie", 1.0),
    ("eventRandom", 1.0),
    ("eventSpread", 1.0),
    ("eventProbability", 1.0),
];

/// An expression at each initial place, in scene units.
fn evaluated(text: &str, places: &[Vector3<f64>]) -> Result<Vec<f64>, String> {
    let expression = Expression::parse(text).map_err(|error| error.to_string())?;
    let count = places.len();
    let point = |(index, place): (usize, &Vector3<f64>)| Point {
        position: (*place).into(),
        uv: [0.0; 2],
        index,
        count,
    };
    Ok(places.iter().enumerate().map(|each| expression.at(&point(each))).collect())
}

/// Whether collision events of any object emit into this one.
pub(super) fn is_event_target(graph: &Graph, node: NodeId) -> bool {
    let name = graph.node(node).name();
    graph.of_type(&n_particle::N_PARTICLE).any(|(other, _)| {
        let targets = graph.at(0.0).get(other, &n_particle::EVENT_PARTICLES);
        let is_own = |target: &String| *target == name || target.is_empty() && other == node;
        let emits =
            graph.is_given(other, &particle::EVENT_EMIT) || graph.is_given(other, &particle::EVENT_SPLIT);
        emits && (targets.iter().any(is_own) || targets.is_empty() && other == node)
    })
}
