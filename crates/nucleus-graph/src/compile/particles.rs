//! Particles: a cloth of points alone (N1.1-4), each a ball of `radius`.

use nalgebra::Vector3;
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Elements, Faces, Mass, Particles, SelfCollision, Start,
    VertexMaps,
};

use crate::attributes::{Key, n_base, n_particle, nucleus, particle};
use crate::graph::NodeId;
use crate::memory::{Cost, Size};

use super::compiler::Compiler;
use super::emission::{Lifespan, dies};
use super::initial_state::PlacedObject;
use super::liquids::{contact_radius, ever_self_collides, is_liquid, rest_distance, self_collides};
use super::particle_ramps::{EVENT_ROOM, is_event_target};
use super::program::{EvaluationInterval, ObjectKind};
use super::sources::{ClothSource, Emitter, MapScales, RecordedPoints};

impl Compiler<'_> {
    /// Compiles the particles of a node.
    pub(super) fn particles(&mut self, PlacedObject { id, surface, .. }: PlacedObject) -> Option<()> {
        self.check_inputs(id, &[particle::CURRENT_TIME.row.name, n_base::NEXT_STATE.row.name]);
        let points = surface.positions.len();
        let places = surface.positions.clone();
        let surface = self.program.units.surface(surface);
        let recorded = self.recorded(id, None)?;
        self.check_liquid(id)?;
        self.warn_of_contradictions(id);
        let velocities = self.first_given(id, &n_particle::VELOCITY0, &n_particle::VELOCITY);
        let velocities = match self.plays_from_start(id) {
            true => Vec::new(),
            false => self.start_velocities(id, id, points, velocities)?,
        };
        let lists = self.particle_lists(id);
        let mass = self.start.get(id, &n_particle::POINT_MASS);
        let start = Start { velocities, ..Start::default() };
        let emitters = self.emitters(id, ClothId(self.program.model.cloths().len() as u32));
        let most = recorded.as_ref().map_or(0, RecordedPoints::most);
        let particles = self.births_and_deaths(id, (&places, most), &emitters)?;
        let varies = particles.is_some();
        let masses = self.particle_masses(id, &places)?;
        let vertex_maps = VertexMaps {
            mass: masses.iter().map(|kilograms| kilograms / mass).collect(),
            ..VertexMaps::default()
        };
        let kilograms = match masses.is_empty() {
            true => mass * points as f64,
            false => masses.iter().sum(),
        };
        let of_each = if points > 0 { kilograms / points as f64 } else { mass };
        self.warn_of_drag(id, &places, of_each);
        self.warn_of_mass(id, of_each);
        let warp = Vec::new();
        let mass_of_each = Mass::PerPoint(mass);
        let split_off = Vec::new();
        let cloth =
            Cloth { surface, mass: mass_of_each, lists, warp, vertex_maps, start, particles, split_off };
        match self.program.model.cloth(cloth) {
            Ok(cloth) => {
                let kind = ObjectKind::Cloth(ClothId(self.program.first_cloth + cloth.0));
                self.add_object(id, kind, points, Faces::default(), kilograms);
                self.describe_particles(id, varies);
            }
            Err(error) => return self.report_refused(id, id, &error),
        }
        self.program.emitters.extend(emitters);
        let (default_thickness, is_dense, scales) = (0.0, false, MapScales::ONE);
        let source = ClothSource {
            node: id,
            is_particles: true,
            default_thickness,
            is_dense,
            scales,
            faces: 0,
            area: 0.0,
            followed: None,
            tearing: None,
            recorded,
        };
        self.program.cloths.push(source);
        Some(())
    }

    /// The lists that particles need.
    fn particle_lists(&self, id: NodeId) -> ClothLists {
        let graph = &self.scene.graph;
        ClothLists {
            air: graph.is_ever_nonzero(id, &n_particle::DRAG)
                && graph.is_ever_nonzero(self.program.node, &nucleus::AIR_DENSITY),
            self_collision: ever_self_collides(graph, id),
            ..ClothLists::NONE
        }
    }

    /// The masses of particles at these places in kilograms, if they have any of their own; `None` after an error, which is
    /// reported.
    fn particle_masses(&mut self, id: NodeId, places: &[Vector3<f64>]) -> Option<Vec<f64>> {
        let masses = self.particle_numbers(id, &particle::MASS0, places)?;
        let Some(bad) = masses.iter().find(|kilograms| **kilograms <= 0.0) else { return Some(masses) };
        let name = self.scene.graph.node(id).name();
        let message = format!("`mass0` of `{name}` must be above 0, but is {bad}");
        self.findings.error(&self.place(id, &particle::MASS0.row), message).help("in kilograms");
        None
    }

    /// Sets how the object that was added last is drawn and its surface computed.
    fn describe_particles(&mut self, id: NodeId, varies: bool) {
        let radius = self.start.get(id, &n_particle::RADIUS);
        let surface = [&n_particle::THRESHOLD, &n_particle::BLOBBY_RADIUS_SCALE];
        let surface = surface.map(|key| self.start.get(id, key));
        let rest_distance = is_liquid(&self.start, id).then(|| rest_distance(&self.start, id));
        if let Some(object) = self.objects.last_mut() {
            (object.radius, object.surface, object.varies) = (Some(radius), surface, varies);
            object.rest_distance = rest_distance;
        }
    }

    /// What particles need that are born, die or differ from each other, where there are any; `None` after an error, which
    /// is reported. `recorded` is the largest number that a recording of them has.
    fn births_and_deaths(
        &mut self,
        id: NodeId,
        (places, recorded): (&[Vector3<f64>], usize),
        emitters: &[Emitter],
    ) -> Option<Option<Particles>> {
        let points = places.len();
        self.check_expressions(id)?;
        let ramps = self.particle_ramps(id);
        let events = self.collision_events(id)?;
        let ids = self.particle_ids(id, places)?;
        let ages = self.particle_numbers(id, &particle::AGE0, places)?;
        let listed = self.particle_numbers(id, &n_particle::LIFESPAN_PP, places)?;
        let runs = self.has_runtime_expression(id);
        let graph = &self.scene.graph;
        let is_target = is_event_target(graph, id);
        let differs = !ramps.is_empty() || !events.is_empty() || is_target || runs;
        let varies = dies(graph, id) || differs || recorded > points;
        let rotates = self.start.get(id, &n_particle::COMPUTE_ROTATION);
        if emitters.is_empty() && !varies && !rotates && ids.is_empty() && ages.is_empty() {
            return Some(None);
        }
        let mut room = self.room_for_particles(id, points, emitters).max(recorded as u64);
        if is_target {
            // A limit below zero is none.
            let limit = u64::try_from(self.start.get(id, &particle::MAX_COUNT));
            room = limit.map_or(room.saturating_add(EVENT_ROOM), |limit| room.max(limit));
        }
        let claimed = self.geometry.budget.claim(Cost::CLOTH.of(Size { points: room, corners: 0 }));
        if let Err(refused) = claimed {
            if refused.is_first {
                let name = graph.node(id).name();
                let message = format!("`{name}`, of up to {room} particles, takes {refused}");
                let place = emitters.first().map_or(name, |emitter| graph.node(emitter.node).name());
                let error = self.findings.error(&self.scene.source.place(place), message);
                error.help(refused.help("lower `rate`, shorten the lifespan, or set `maxCount`"));
            }
            return None;
        }
        let seed = self.start.get(id, &particle::GENERAL_SEED) as u64;
        let lifespan = Lifespan::new(id, &self.start);
        let lifespans = match lifespan.is_listed() {
            // A recording has no deaths.
            _ if self.plays_from_start(id) => Vec::new(),
            true => listed.into_iter().map(|seconds| seconds.max(0.0)).collect(),
            false => lifespan.of_first(points, seed),
        };
        let radius = self.program.units.length(self.start.get(id, &n_particle::RADIUS));
        Some(Some(Particles {
            capacity: (room as usize).max(1),
            lifespans,
            ages,
            ids,
            radius,
            ramps,
            events,
            rotates,
        }))
    }
}

impl EvaluationInterval<'_> {
    /// The share of the velocity that particles keep over the interval, by that of a frame.
    fn conserved(&self, of_frame: f64) -> f64 {
        let frames = self.to.frame() - self.from.frame();
        if frames == 1.0 { of_frame } else { of_frame.clamp(0.0, 1.0).powf(frames) }
    }

    /// The attributes of particles in a frame.
    pub(super) fn particle_frame(&self, node: NodeId) -> ClothFrame {
        let number = |key: &Key<f64>| self.to.get(node, key);
        let radius = self.nucleus.units.length(number(&n_particle::RADIUS));
        let liquid = self.liquid(node);
        let thickness = self.nucleus.units.length(contact_radius(&self.to, node));
        ClothFrame {
            stretch_resistance: 0.0,
            compression_resistance: 0.0,
            bend_resistance: 0.0,
            stretch_damp: 0.0,
            drag: number(&n_particle::DRAG),
            // The drag of a ball is the same in all directions.
            tangential_drag: 1.0,
            lift: 0.0,
            feels_gravity: !self.to.get(node, &n_particle::IGNORE_SOLVER_GRAVITY),
            feels_wind: !self.to.get(node, &n_particle::IGNORE_SOLVER_WIND),
            local_force: Vector3::from(self.to.get(node, &n_base::LOCAL_FORCE)),
            local_wind: Vector3::from(self.to.get(node, &n_base::LOCAL_WIND)),
            collide: self.to.get(node, &n_base::COLLIDE),
            thickness,
            friction: number(&n_base::FRICTION),
            stickiness: number(&n_base::STICKINESS),
            bounce: number(&n_base::BOUNCE),
            collide_strength: number(&n_base::COLLIDE_STRENGTH),
            elements: Elements::Points,
            layer: number(&n_base::COLLISION_LAYER),
            self_collision: SelfCollision {
                on: self_collides(&self.to, node),
                thickness: thickness * number(&n_particle::SELF_COLLIDE_WIDTH_SCALE).max(0.0),
                elements: Elements::Points,
                edges: false,
            },
            point_field: self.point_field(node, radius),
            wind_field: self.wind_field(node),
            liquid,
            conserve: self.conserved(number(&particle::CONSERVE)),
            rotation_friction: number(&n_particle::ROTATION_FRICTION),
            rotation_damp: number(&n_particle::ROTATION_DAMP),
            damp: number(&n_particle::DAMP),
            overlap_pruning: number(&n_particle::EMISSION_OVERLAP_PRUNING),
            ..ClothFrame::default()
        }
    }
}
