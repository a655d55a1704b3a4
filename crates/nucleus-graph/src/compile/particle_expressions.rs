//! Expressions per particle: statements that run when a particle is born, and at the start of each frame.
//!
//! They have no loops, read the particle alone and write its velocity, its lifespan and, at birth, its place. A result that is
//! not a finite number changes nothing, and is counted; an infinite lifespan never ends.

use nalgebra::Vector3;
use nucleus_core::{
    Birth, ClothId, InvalidInput, Particle, ParticleChange, Sanitized, StateView, unit_random,
};

use crate::attributes::{Key, n_particle, particle};
use crate::graph::NodeId;
use crate::paint::Statements;

use super::compiler::Compiler;
use super::program::EvaluationInterval;
use super::sources::Emitter;

/// The variables and their meaning: those that may be assigned at birth come first, of them those at run time.
const VARIABLES: [(&str, &str); 13] = [
    ("vx", "X component of its velocity in scene units per second; may be assigned"),
    ("vy", "Y component of its velocity; may be assigned"),
    ("vz", "Z component of its velocity; may be assigned"),
    ("lifespan", "the age in seconds at which it dies; may be assigned"),
    ("x", "X coordinate of its place in scene units; may be assigned at birth"),
    ("y", "Y coordinate of its place; may be assigned at birth"),
    ("z", "Z coordinate of its place; may be assigned at birth"),
    ("age", "seconds since its birth"),
    ("id", "its number; at birth, that among those of its emitter"),
    ("time", "seconds since the start"),
    ("rand", "a random number from 0 to 1, new for each particle in each frame"),
    ("rand2", "a second one"),
    ("rand3", "a third one"),
];
/// Their names.
pub(super) const NAMES: [&str; VARIABLES.len()] = {
    let (mut names, mut at) = ([""; VARIABLES.len()], 0);
    while at < names.len() {
        names[at] = VARIABLES[at].0;
        at += 1;
    }
    names
};
/// How many of them may be assigned at run time, and at birth.
const WRITABLE: [usize; 2] = [4, 7];

impl Compiler<'_> {
    /// Checks the expressions of an object; `None` after an error, which is reported.
    pub(super) fn check_expressions(&mut self, node: NodeId) -> Option<()> {
        for (key, writable) in
            [(&n_particle::RUNTIME_EXPRESSION, WRITABLE[0]), (&n_particle::CREATION_EXPRESSION, WRITABLE[1])]
        {
            let Err(error) = Statements::parse(&self.start.get(node, key), &NAMES, writable) else {
                continue;
            };
            let name = self.scene.graph.node(node).name();
            let message = format!("`{}` of `{name}`: {}", key.row.name, error.message);
            let place = self.place(node, &key.row);
            let found = self.findings.error(&place, message);
            if let Some(help) = error.help {
                found.help(help);
            }
            return None;
        }
        Some(())
    }

    /// Whether expressions of an object run in each frame.
    pub(super) fn has_runtime_expression(&self, node: NodeId) -> bool {
        !self.start.get(node, &n_particle::RUNTIME_EXPRESSION).is_empty()
    }
}

/// The variables of expressions of particles, each with its meaning.
pub fn particle_variables() -> impl Iterator<Item = (&'static str, &'static str)> {
    VARIABLES.into_iter()
}

/// Adds particles for which an expression gave no valid result.
pub(super) fn add_invalid(sanitized: &mut Sanitized, count: u64, input: InvalidInput) {
    if count > 0 {
        sanitized.count += count;
        sanitized.first = sanitized.first.or(Some(input));
    }
}

/// Random numbers of a particle in a frame; the seed is that of the object.
fn randoms(id: u64, frame: f64, seed: u64) -> [f64; 3] {
    [0, 1, 2].map(|k| unit_random([id, frame.to_bits() ^ (seed << 2 | k)]))
}

/// The key of a particle at birth: its number among those of the emitter at a place among those of its object.
fn key_at_birth(place: u64, number: u64) -> u64 {
    // Numbers of one emitter stay far below 2^48.
    number ^ place << 48
}

impl EvaluationInterval<'_> {
    /// The statements of an object, if it has any. They were checked when the scene was compiled.
    fn statements(&self, node: NodeId, key: &Key<String>, writable: usize) -> Option<Statements> {
        let text = self.to.get(node, key);
        if text.is_empty() { None } else { Statements::parse(&text, &NAMES, writable).ok() }
    }

    /// Runs the expression at birth for births of an emitter; `numbers` are their numbers among all of it. Returns the
    /// number of particles for which it gave an invalid result.
    pub(super) fn create(&self, emitter: &Emitter, numbers: &[u64], births: &mut [Birth]) -> u64 {
        let node = emitter.particles;
        let Some(statements) = self.statements(node, &n_particle::CREATION_EXPRESSION, WRITABLE[1]) else {
            return 0;
        };
        let mut invalid = 0;
        let seed = self.to.get(node, &particle::SEED) as u64;
        for (birth, &number) in births.iter_mut().zip(numbers) {
            let frame = self.from.frame() + (self.to.frame() - self.from.frame()) * birth.time;
            let randoms = randoms(key_at_birth(emitter.place, number), frame, seed);
            let motion = [birth.velocity, birth.position];
            let mut values = self.values(motion, birth.lifespan, (0.0, number, frame), randoms);
            statements.run(&mut values);
            let [velocity, place] = [0, 4].map(|at| self.in_metres(&values[at..at + 3]));
            invalid += u64::from(velocity.is_none() || place.is_none() || values[3].is_nan());
            birth.velocity = velocity.unwrap_or(birth.velocity);
            birth.position = place.unwrap_or(birth.position);
            birth.lifespan = Some(values[3]).filter(|x| !x.is_nan()).unwrap_or(birth.lifespan);
        }
        invalid
    }

    /// What expressions at run time change about living particles. Invalid results are counted in `sanitized`.
    pub(crate) fn particle_changes(
        &self,
        view: &dyn StateView,
        sanitized: &mut Sanitized,
    ) -> Vec<ParticleChange> {
        let mut changes = Vec::new();
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            if !source.is_particles {
                continue;
            }
            let statements = self.statements(source.node, &n_particle::RUNTIME_EXPRESSION, WRITABLE[0]);
            if let Some(statements) = statements {
                let invalid = self.run_on(&statements, (cloth, source.node), view, &mut changes);
                add_invalid(sanitized, invalid, InvalidInput::RuntimeExpression(cloth));
            }
        }
        changes
    }

    /// Runs statements on the particles of an object. Returns the number of those with an invalid result.
    fn run_on(
        &self,
        statements: &Statements,
        (cloth, node): (ClothId, NodeId),
        view: &dyn StateView,
        changes: &mut Vec<ParticleChange>,
    ) -> u64 {
        let mut invalid = 0;
        let (mut ages, mut fast, mut places) = (Vec::new(), Vec::new(), Vec::new());
        view.particles(cloth, &mut ages);
        view.velocities(cloth, 1.0, &mut fast);
        view.positions(cloth, 1.0, &mut places);
        let seed = self.to.get(node, &particle::SEED) as u64;
        for (place, &Particle { id, age, lifespan, .. }) in ages.iter().enumerate() {
            let motion = [fast[place], places[place]].map(|v| Vector3::from(v.map(f64::from)));
            let frame = self.from.frame();
            let before = self.values(motion, lifespan, (age, id, frame), randoms(id, frame, seed));
            let mut values = before;
            statements.run(&mut values);
            let changed = values[..3] != before[..3];
            let velocity = changed.then(|| self.in_metres(&values[..3])).flatten();
            invalid += u64::from((changed && velocity.is_none()) || values[3].is_nan());
            let lifespan = Some(values[3]).filter(|x| *x != before[3] && !x.is_nan());
            if velocity.is_some() || lifespan.is_some() {
                changes.push(ParticleChange { cloth, place, velocity, lifespan });
            }
        }
        invalid
    }

    /// The values of the variables, in scene units.
    fn values(
        &self,
        motion: [Vector3<f64>; 2],
        lifespan: f64,
        (age, id, frame): (f64, u64, f64),
        [a, b, c]: [f64; 3],
    ) -> [f64; NAMES.len()] {
        let [v, x] = motion.map(|v| v * self.nucleus.units.per_metre());
        let frames = self.to.frame() - self.from.frame();
        let per_frame = if frames > 0.0 { self.seconds / frames } else { 0.0 };
        let time = (frame - self.nucleus.start() as f64) * per_frame;
        [v.x, v.y, v.z, lifespan, x.x, x.y, x.z, age, id as f64, time, a, b, c]
    }

    /// Three values in metres; `None` where one is not a finite number.
    fn in_metres(&self, values: &[f64]) -> Option<Vector3<f64>> {
        let vector = Vector3::new(values[0], values[1], values[2]);
        vector.iter().all(|x| x.is_finite()).then(|| self.nucleus.units.point(vector))
    }
}
