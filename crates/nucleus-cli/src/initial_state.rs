//! `--from drape.mcap@80`: initial positions and velocities of cloth from a frame of a cache.
//!
//! The graph crate knows no caches: this module sets `startPositions` and `startVelocities`, as a scene could.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, bail, ensure};
use nucleus_cache::{ObjectKind, Playback};
use nucleus_core::Particle;
use nucleus_graph::Simulation;
use nucleus_graph::attributes::{Attribute, Value, n_base, n_particle, particle};
use nucleus_graph::compile::{self, Object, Program};
use nucleus_graph::graph::{NodeId, Setting};
use nucleus_graph::scene::Scene;

use crate::output::say;
use crate::{diagnostics, figures, files};

mod reset;

/// A frame of a cache.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InitialState {
    cache: PathBuf,
    /// `None`: the last frame.
    frame: Option<i32>,
}

impl FromStr for InitialState {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.rsplit_once('@') {
            None => Ok(Self { cache: text.into(), frame: None }),
            Some((cache, frame)) => match frame.parse() {
                Ok(frame) if !cache.is_empty() => Ok(Self { cache: cache.into(), frame: Some(frame) }),
                _ => Err("write a cache and a frame of it as `drape.mcap@80`".to_owned()),
            },
        }
    }
}

/// The file name and the frame, as a cache states the initial state of its run.
impl fmt::Display for InitialState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Path::new(self.cache.file_name().unwrap_or_default()).display())?;
        self.frame.map_or(Ok(()), |frame| write!(f, "@{frame}"))
    }
}

impl InitialState {
    /// The scene with this initial state for all of its cloth, and its program. `text` is that of the scene.
    pub fn applied(&self, mut scene: Scene, program: &Program, text: &str) -> Result<(Scene, Program)> {
        let is_cloth = |object: &&Object| matches!(object.kind, compile::ObjectKind::Cloth(_));
        let cloths: Vec<&Object> = program.objects().iter().filter(is_cloth).collect();
        ensure!(!cloths.is_empty(), "the scene has no cloth that could start from a cache");
        let mut cache = files::open_cache(&self.cache)?;
        let moment = files::moment(&cache, self.frame)
            .with_context(|| format!("cannot start from `{}`", self.cache.display()))?;
        let scale = program.units_per_metre() / cache.run().units_per_metre;
        let recorded = if cache.run().scene_text == text { None } else { self.recorded_program(&cache)? };
        let (mut has_velocities, mut unknown) = (true, Vec::new());
        let at = cache.time_samples()[moment].frame;
        let from_start = at <= cache.run().start;
        let simulation: Option<Simulation> = (scale != 1.0).then(|| Simulation::new(program, 1));
        for cloth in cloths {
            let object = self.matching(&mut cache, moment, cloth)?;
            if let Some(simulation) = &simulation {
                self.refuse_same_numbers(&cache, object, simulation, cloth)?;
            }
            let positions = cache.positions(object, moment)?;
            let velocities = match cache.velocities(object, moment)? {
                Some(velocities) => velocities,
                None => {
                    has_velocities = false;
                    estimated_velocities(&mut cache, object, moment)?
                }
            };
            // Recorded velocities are per second of the scene, and those of a start state per second of the solver.
            let per_second =
                scale / time_rate(recorded.as_ref().unwrap_or(program), &cloth.name, at, from_start);
            match cloth.radius {
                None => {
                    set_column(&mut scene, cloth, &n_base::START_POSITIONS.row, &positions, scale)?;
                    set_column(&mut scene, cloth, &n_base::START_VELOCITIES.row, &velocities, per_second)?;
                }
                Some(_) => {
                    let node = node_of(&scene, cloth)?;
                    scene.set_particle_positions(node, in_scene_units(&positions, scale))?;
                    set_column(&mut scene, cloth, &n_particle::VELOCITY0.row, &velocities, per_second)?;
                }
            }
            if cloth.varies && !positions.is_empty() && !has_ages(&scene, cloth) {
                let particles = cache.particles(object, moment)?.unwrap_or_default();
                set_ages(&mut scene, cloth, &particles)?;
                let node = scene.graph.node(node_of(&scene, cloth)?);
                let mode = node.get(&particle::LIFESPAN_MODE);
                if mode == particle::RANDOM_RANGE || (particles.is_empty() && mode != particle::LIVE_FOREVER)
                {
                    unknown.push(format!("`{}`", cloth.name));
                }
            }
        }
        if !unknown.is_empty() {
            say!(
                "warning: the lifespans of the particles of {} at the start are drawn anew; give them with \
                 `lifespanMode: lifespanPPOnly` and `lifespanPP`",
                unknown.join(", ")
            );
        }
        let reset = reset::lost_state(&scene.graph, scene.time.fps);
        if !reset.is_empty() {
            say!(
                "warning: a cache holds positions and velocities alone, so these begin anew: {}",
                reset.join("; ")
            );
        }
        if !has_velocities {
            say!(
                "warning: `{}` has no velocities, so they are estimated from the previous recorded positions; record them \
                 with `nucleus run --velocities`",
                self.cache.display()
            );
        }
        let program =
            diagnostics::compile_changed(&scene, "the scene does not compile with this initial state")?;
        Ok((scene, program))
    }

    /// The program of the scene that the cache was recorded from: its velocities are in the time of that scene.
    fn recorded_program(&self, cache: &Playback) -> Result<Option<Program>> {
        let path = files::recorded_scene(cache, &self.cache);
        let read = files::scene_from_text(cache.run().scene_text.clone(), &path, None)?;
        if read.compiled.is_none() {
            say!(
                "warning: the scene in `{}` cannot be compiled, so its time is taken to run as that of this scene",
                self.cache.display()
            );
        }
        Ok(read.compiled.map(|(_, program)| program))
    }

    /// The object of the cache with the name and the mesh of a cloth.
    fn matching(&self, cache: &mut Playback, moment: usize, cloth: &Object) -> Result<usize> {
        let (name, cache_name) = (&cloth.name, self.cache.display());
        let is_solved = |kind: ObjectKind| kind != ObjectKind::Collider;
        let objects = cache.objects();
        let Some(found) = objects.iter().position(|object| object.name == *name && is_solved(object.kind))
        else {
            let solved = objects.iter().filter(|object| is_solved(object.kind));
            let names: Vec<String> = solved.map(|object| format!("`{}`", object.name)).collect();
            bail!(
                "`{cache_name}` has no cloth `{name}`: its cloth is {}, recorded from `{}`",
                if names.is_empty() { "none".to_owned() } else { names.join(", ") },
                cache.run().scene_path
            );
        };
        let mesh = cache.object_at(found, moment)?;
        let (points, recorded) = (cloth.points, mesh.rest.len());
        ensure!(
            points == recorded,
            "the mesh of `{name}` has changed: it has {points} points, but {recorded} in `{cache_name}`"
        );
        ensure!(
            cloth.faces == mesh.faces,
            "the mesh of `{name}` has changed: its faces differ from those in `{cache_name}`"
        );
        Ok(found)
    }

    /// Refuses a mesh that has kept its numbers although the unit of length has changed: a state in metres does not fit it.
    fn refuse_same_numbers(
        &self,
        cache: &Playback,
        recorded: usize,
        simulation: &Simulation,
        cloth: &Object,
    ) -> Result<()> {
        let compile::ObjectKind::Cloth(id) = cloth.kind else { return Ok(()) };
        let (units, mut start) = (simulation.units_per_metre(), Vec::new());
        simulation.state().positions(id, units, &mut start);
        let (name, before) = (self.cache.display(), cache.run().units_per_metre);
        let in_units = diagonal(&cache.objects()[recorded].rest) / diagonal(&start);
        let in_metres = in_units * units / before;
        // The nearer ratio to 1 tells which of both the scene has kept. A single point has no size.
        let is_converted = !in_units.is_finite() || in_metres.ln().abs() < in_units.ln().abs();
        ensure!(
            is_converted,
            "the unit of length has changed, and `{}` has not: `{name}` has {} units per metre, and the scene {}, so in \
             metres the mesh is {} times as large in the scene; give the scene the `spaceScale` {} of the cache, or convert \
             its meshes too",
            cloth.name,
            figures::number(before),
            figures::number(units),
            figures::number(1.0 / in_metres),
            figures::number(1.0 / before)
        );
        Ok(())
    }
}

/// The diagonal of the bounding box of points.
fn diagonal(points: &[[f32; 3]]) -> f64 {
    let along = |axis: usize| {
        let all = points.iter().map(|point| f64::from(point[axis]));
        let [low, high] = [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)];
        (high - low).max(0.0).powi(2)
    };
    (0..3).map(along).sum::<f64>().sqrt()
}

/// Velocities in scene units per second, as backward differences of recorded positions. Zero at the first one.
fn estimated_velocities(cache: &mut Playback, object: usize, moment: usize) -> Result<Vec<[f32; 3]>> {
    let now = cache.positions(object, moment)?;
    let Some(before) = moment.checked_sub(1) else { return Ok(vec![[0.0; 3]; now.len()]) };
    let passed = cache.time_samples()[moment].time - cache.time_samples()[before].time;
    let earlier = cache.positions(object, before)?;
    if earlier.len() != now.len() {
        return Ok(vec![[0.0; 3]; now.len()]); // The mesh has changed.
    }
    let speed = |(now, before): (&f32, &f32)| ((f64::from(*now) - f64::from(*before)) / passed) as f32;
    let each = now
        .iter()
        .zip(&earlier)
        .map(|(now, before)| [0, 1, 2].map(|axis| speed((&now[axis], &before[axis]))));
    Ok(each.collect())
}

/// Sets the ages, numbers and listed lifespans of particles, and their masses where they differ.
fn set_ages(scene: &mut Scene, object: &Object, particles: &[Particle]) -> Result<()> {
    let Some(first) = particles.first() else { return Ok(()) };
    let node = node_of(scene, object)?;
    let mut set = |row: &'static Attribute, of: &dyn Fn(&Particle) -> f64| {
        scene.graph.set(node, row, Setting::Fixed(Value::Floats(particles.iter().map(of).collect())))
    };
    set(&particle::AGE0.row, &|particle| particle.age)?;
    set(&particle::PARTICLE_ID0.row, &|particle| particle.id as f64)?;
    if particles.iter().any(|particle| particle.mass != first.mass) {
        set(&particle::MASS0.row, &|particle| particle.mass)?;
    }
    // The largest number stands for the lifespan of a particle that never dies.
    if scene.graph.node(node).get(&particle::LIFESPAN_MODE) == particle::LIFESPAN_PP_ONLY {
        let lifespans = particles.iter().map(|particle| particle.lifespan.min(f64::MAX)).collect();
        scene.graph.set(node, &n_particle::LIFESPAN_PP.row, Setting::Fixed(Value::Floats(lifespans)))?;
    }
    Ok(())
}

/// Solver seconds per second of the scene at a frame, of the nucleus of an object; 1 where its time stands still.
fn time_rate(program: &Program, name: &str, frame: i32, from_start: bool) -> f64 {
    let kind = program.objects().iter().find(|object| object.name == name).map(|object| &object.kind);
    let Some(&compile::ObjectKind::Cloth(id)) = kind else { return 1.0 };
    let (frame, every) = (f64::from(frame), program.every());
    let interval = if from_start { [frame, frame + 1.0] } else { [frame - every, frame] };
    let rate = program.time_rate(program.nucleus_of(id), interval);
    if rate > 0.0 { rate } else { 1.0 }
}

/// Whether the scene gives the ages of the particles at the start.
fn has_ages(scene: &Scene, particles: &Object) -> bool {
    let node = scene.graph.find(&particles.name);
    node.is_some_and(|node| scene.graph.is_given(node, &particle::AGE0))
}

fn node_of(scene: &Scene, object: &Object) -> Result<NodeId> {
    scene.graph.find(&object.name).with_context(|| format!("there is no `{}`", object.name))
}

/// Sets an attribute with a vector per point. `scale` converts units of the cache to units of the scene.
fn set_column(
    scene: &mut Scene,
    cloth: &Object,
    row: &'static Attribute,
    column: &[[f32; 3]],
    scale: f64,
) -> Result<()> {
    let node = node_of(scene, cloth)?;
    scene.graph.set(node, row, Setting::Fixed(Value::Vectors(in_scene_units(column, scale))))?;
    Ok(())
}

/// The vectors of a cache in units of the scene.
pub fn in_scene_units(column: &[[f32; 3]], scale: f64) -> Vec<[f64; 3]> {
    column.iter().map(|vector| vector.map(|x| f64::from(x) * scale)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_follows_the_name_of_the_cache() {
        let read = |text: &str| text.parse::<InitialState>();
        let of = |cache: &str, frame| Ok(InitialState { cache: cache.into(), frame });
        assert_eq!(read("a.mcap@80"), of("a.mcap", Some(80)));
        assert_eq!(read("a@b.mcap@-3"), of("a@b.mcap", Some(-3)));
        assert_eq!(read("a.mcap"), of("a.mcap", None));
        assert!(read("a.mcap@").is_err() && read("a.mcap@1.5").is_err() && read("@5").is_err());
    }
}
