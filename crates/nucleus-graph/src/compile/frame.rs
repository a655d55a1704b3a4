//! The solver's input for a frame: attribute values at its end, and the motion of colliders and attachments.
//!
//! Animation is evaluated here, once per evaluation interval (N2.4-6). The solver interpolates positions linearly
//! inside it (N2.4-7). Colliders are evaluated first, then cloth, then constraints. Nodes that none of them depends
//! on are not evaluated.

use nalgebra::Vector3;
use nucleus_core::{
    ClothFrame, ClothId, ColliderFrame, FrameInput, GroundPlane, Pin, PointId, ResistanceModel, Stiffness,
    WindField,
};

use crate::animation::Affine;
use crate::attributes::{Key, n_base, n_cloth, n_rigid, nucleus, particle};
use crate::graph::{EvalContext, NodeId};
use crate::scene::document::TimeSpan;

use super::animated_mesh::Points;
use super::attachments::AttachmentState;
use super::fields::unit;
use super::program::{EvaluationInterval, Program};
use super::sources::{ClothSource, ColliderSource};
use super::thickness::elements;
use super::units::CLASSIC;

impl Program {
    /// The input of the first frame of the first nucleus.
    pub fn first_input(&self) -> FrameInput {
        self.first_input_of(0)
    }

    /// The points of the colliders of a nucleus where the animation has them at a frame, in metres; `None` where one never
    /// moves.
    pub(crate) fn collider_places(&self, nucleus: usize, frame: f64) -> Vec<Option<Vec<Vector3<f64>>>> {
        let nucleus = &self.nuclei()[nucleus];
        let moment = self.graph().at(frame);
        let place = |collider: &ColliderSource| {
            let points = collider.motion.as_ref()?.at(&moment);
            Some(nucleus.units.placed(&moment.placement(collider.mesh), &points))
        };
        nucleus.colliders.iter().map(place).collect()
    }

    /// The input of the first frame of each nucleus, in the order of the program.
    pub fn first_inputs(&self) -> impl Iterator<Item = FrameInput> {
        (0..self.nuclei().len()).map(|nucleus| self.first_input_of(nucleus))
    }

    fn first_input_of(&self, nucleus: usize) -> FrameInput {
        let start = self.nuclei()[nucleus].start() as f64;
        let model = self.nuclei()[nucleus].model();
        let position =
            |cloth, point: PointId| model.positions(cloth).get(point.index()).copied().unwrap_or_default();
        self.interval(nucleus, [start, start + 1.0], 1.0, false)
            .input(&mut AttachmentState::default(), &position)
    }

    /// The ground plane of the first nucleus at each frame of the run, where it changes; none where it stays. While it is off
    /// it stays where it was last.
    pub fn ground_planes(&self) -> Vec<GroundPlane> {
        let (node, graph) = (self.nuclei()[0].node(), self.graph());
        let changes = graph.moves(node)
            || graph.changes(node, &nucleus::PLANE_ORIGIN)
            || graph.changes(node, &nucleus::PLANE_NORMAL);
        if !changes {
            return Vec::new();
        }
        let TimeSpan { start, end, .. } = self.time();
        let at = |frame: i64| {
            let interval = self.interval(0, [frame as f64 - 1.0, frame as f64], 1.0, false);
            interval.ground_plane()
        };
        let mut last = (start..=end).find_map(at);
        (start..=end).filter_map(|frame| at(frame).inspect(|plane| last = Some(*plane)).or(last)).collect()
    }

    /// The nodes that are evaluated for a frame of the first nucleus, in the order of evaluation.
    pub fn pulled(&self, frame: i64) -> Vec<NodeId> {
        let mut interval = self.interval(0, [frame as f64 - 1.0, frame as f64], 1.0, false);
        interval.to = self.graph().recorded_at(frame as f64);
        interval.input(&mut AttachmentState::default(), &|_, _| Vector3::zeros());
        interval.to.pulled()
    }
}

impl EvaluationInterval<'_> {
    /// The input of the solver. `position` gives the solved positions at the start of the interval, in metres.
    pub(crate) fn input(
        &self,
        attachments: &mut AttachmentState,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> FrameInput {
        let (nucleus, to) = (self.nucleus.node, &self.to);
        let space = self.nucleus_space(to);
        let along = |direction: &Key<[f64; 3]>, size: &Key<f64>| {
            unit(space.linear * Vector3::from(to.get(nucleus, direction))) * to.get(nucleus, size)
        };
        let duration = to.get(nucleus, &nucleus::TIME_SCALE) * self.seconds;
        FrameInput {
            duration,
            substeps: to.get(nucleus, &nucleus::SUB_STEPS) as u32,
            collision_iterations: to.get(nucleus, &nucleus::MAX_COLLISION_ITERATIONS) as f64,
            resistance: match to.get(nucleus, &nucleus::RESISTANCE_MODEL) {
                CLASSIC => ResistanceModel::Classic,
                _ => ResistanceModel::Physical {
                    evaluations: self.budget.unwrap_or_else(|| to.get(nucleus, &nucleus::EVALUATIONS)),
                },
            },
            gravity: along(&nucleus::GRAVITY_DIRECTION, &nucleus::GRAVITY),
            wind: along(&nucleus::WIND_DIRECTION, &nucleus::WIND_SPEED),
            air_density: to.get(nucleus, &nucleus::AIR_DENSITY),
            plane: self.ground_plane(),
            layer_range: to.get(nucleus, &nucleus::COLLISION_LAYER_RANGE),
            colliders: self.nucleus.colliders.iter().map(|collider| self.collider_frame(collider)).collect(),
            cloths: self.nucleus.cloths.iter().map(|cloth| self.active_frame(cloth)).collect(),
            self_collision_iterations: self.self_collision_iterations(),
            pins: self.locked_and_pinned(attachments, position),
            velocities: self.velocities_after_playback(),
            wind_noise: to.get(nucleus, &nucleus::WIND_NOISE),
            input_meshes: self.input_meshes(),
            constraints: self.constraint_frames(&mut attachments.formed, position),
            exclusions: self.exclusions(),
            fields: self.fields(duration),
            fields_per_substep: to.get(nucleus, &nucleus::FIELDS_PER_SUBSTEP),
            births: self.births(attachments, duration),
            particle_changes: Vec::new(),
        }
    }

    /// Pins of transform constraints, of points that are locked to their input mesh, and of recorded motion.
    fn locked_and_pinned(
        &self,
        attachments: &mut AttachmentState,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Vec<Pin> {
        let mut pins = self.pins(attachments, position);
        self.lock_to_input_meshes(&mut pins);
        self.play_recorded(&mut pins, position);
        pins
    }

    /// The frame of reference of the directions and the ground plane.
    fn nucleus_space(&self, moment: &EvalContext<'_>) -> Affine {
        let own = moment.get(self.nucleus.node, &nucleus::USE_TRANSFORM);
        if own { moment.placement(self.nucleus.node) } else { Affine::identity() }
    }

    /// The ground plane; `None` where it is off, and without a normal.
    fn ground_plane(&self) -> Option<GroundPlane> {
        let (nucleus, to) = (self.nucleus.node, &self.to);
        if !to.get(nucleus, &nucleus::USE_PLANE) {
            return None;
        }
        let [origin, normal] = self.plane_at(to)?;
        // The solver knows where it was if it has solved the interval before.
        let is_unknown = self.is_first || self.is_discontinuous;
        Some(GroundPlane {
            origin,
            normal,
            start: if is_unknown { self.plane_at(&self.from) } else { None },
            bounce: to.get(nucleus, &nucleus::PLANE_BOUNCE),
            friction: to.get(nucleus, &nucleus::PLANE_FRICTION),
            stickiness: to.get(nucleus, &nucleus::PLANE_STICKINESS),
        })
    }

    /// A point of the ground plane in metres, and its normal; `None` without a normal.
    fn plane_at(&self, moment: &EvalContext<'_>) -> Option<[Vector3<f64>; 2]> {
        let (nucleus, space) = (self.nucleus.node, self.nucleus_space(moment));
        // A normal transforms by the inverse transpose, so that it stays normal to a scaled plane.
        let turn = space.linear.try_inverse().unwrap_or_default().transpose();
        let normal = turn * Vector3::from(moment.get(nucleus, &nucleus::PLANE_NORMAL));
        let origin = space.point(Vector3::from(moment.get(nucleus, &nucleus::PLANE_ORIGIN)));
        (normal != Vector3::zeros()).then(|| [self.nucleus.units.point(origin), normal])
    }

    fn active_frame(&self, cloth: &ClothSource) -> ClothFrame {
        let frame =
            if cloth.is_particles { self.particle_frame(cloth.node) } else { self.cloth_frame(cloth) };
        ClothFrame { is_driven: self.plays(cloth) || self.rests(cloth), ..frame }
    }

    fn cloth_frame(&self, cloth: &ClothSource) -> ClothFrame {
        let (node, to, scales) = (cloth.node, &self.to, &cloth.scales);
        let number = |key: &Key<f64>| to.get(node, key);
        // A negative stiffness is unset: the resistance applies.
        let stiffness = |key: &Key<f64>, scale: f64| Some(number(key) * scale).filter(|_| number(key) >= 0.0);
        let resistance = |key: &Key<f64>, scale: f64, minimal: &Key<bool>| {
            self.resistance(cloth, number(key) * scale, minimal)
        };
        let thickness = self.thickness(node, cloth.default_thickness) * scales.thickness;
        ClothFrame {
            stretch_resistance: resistance(
                &n_cloth::STRETCH_RESISTANCE,
                scales.stretch,
                &n_cloth::MINIMAL_STRETCH,
            ),
            compression_resistance: resistance(
                &n_cloth::COMPRESSION_RESISTANCE,
                scales.compression,
                &n_cloth::MINIMAL_STRETCH,
            ),
            shear_resistance: resistance(&n_cloth::SHEAR_RESISTANCE, 1.0, &n_cloth::MINIMAL_SHEAR),
            bend_resistance: resistance(&n_cloth::BEND_RESISTANCE, scales.bend, &n_cloth::MINIMAL_BEND),
            stiffness: Stiffness {
                stretch: stiffness(&n_cloth::STRETCH_STIFFNESS, scales.stretch),
                compression: stiffness(&n_cloth::COMPRESSION_STIFFNESS, scales.compression),
                shear: stiffness(&n_cloth::SHEAR_STIFFNESS, 1.0),
                bend: stiffness(&n_cloth::BEND_STIFFNESS, scales.bend),
                warp: stiffness(&n_cloth::WARP_STIFFNESS, scales.stretch),
                weft: stiffness(&n_cloth::WEFT_STIFFNESS, scales.stretch),
            },
            buckles: to.get(node, &n_cloth::BUCKLING),
            rest_length_scale: number(&n_base::REST_LENGTH_SCALE) * scales.rest_length,
            tethers: to.get(node, &n_cloth::TETHERS).then(|| number(&n_cloth::TETHER_SCALE)),
            stretch_damp: number(&n_cloth::STRETCH_DAMP),
            damp: number(&n_base::DAMP) * scales.damp,
            drag: number(&n_cloth::DRAG) * scales.drag,
            tangential_drag: number(&n_cloth::TANGENTIAL_DRAG) * scales.tangential_drag,
            lift: number(&n_cloth::LIFT) * scales.lift * self.lift_scale(),
            feels_gravity: !to.get(node, &n_cloth::IGNORE_SOLVER_GRAVITY),
            feels_wind: !to.get(node, &n_cloth::IGNORE_SOLVER_WIND),
            local_force: Vector3::from(to.get(node, &n_base::LOCAL_FORCE)),
            local_wind: Vector3::from(to.get(node, &n_base::LOCAL_WIND)),
            collide: to.get(node, &n_base::COLLIDE),
            thickness,
            friction: number(&n_base::FRICTION) * scales.friction,
            stickiness: number(&n_base::STICKINESS) * scales.stickiness,
            bounce: number(&n_base::BOUNCE) * scales.bounce,
            collide_strength: number(&n_base::COLLIDE_STRENGTH) * scales.collide_strength,
            push_out: self.push_out(node, cloth.default_thickness),
            crossover_push: number(&n_base::CROSSOVER_PUSH),
            self_crossover_push: number(&n_cloth::SELF_CROSSOVER_PUSH),
            elements: elements(to.get(node, &n_base::COLLISION_FLAG)),
            layer: number(&n_base::COLLISION_LAYER),
            self_collision: self.self_collision(cloth),
            bending: self.bending(cloth),
            yield_strain: self.yield_strain(node, number(&n_cloth::STRETCH_RESISTANCE) * scales.stretch),
            pressure: self.pressure(node),
            rigidity: number(&n_cloth::RIGIDITY) * scales.rigidity,
            deform_resistance: number(&n_cloth::DEFORM_RESISTANCE) * scales.deform,
            input_attract: self.input_attract(cloth),
            field: self.force_field(node, scales.field_magnitude),
            point_field: self.point_field(node, thickness),
            wind_field: WindField {
                self_shadow: to.get(node, &n_cloth::WIND_SELF_SHADOW),
                ..self.wind_field(node)
            },
            ..ClothFrame::default()
        }
    }

    /// Factor on lift: Maya reads speeds in scene units per second.
    fn lift_scale(&self) -> f64 {
        let as_in_maya = self.to.get(self.nucleus.node, &nucleus::LIFT_IN_SCENE_UNITS);
        if as_in_maya { self.nucleus.units.per_metre() } else { 1.0 }
    }

    fn collider_frame(&self, collider: &ColliderSource) -> ColliderFrame {
        let (node, to) = (collider.node, &self.to);
        let (start, end) = self.collider_motion(collider);
        let thickness = self.thickness(node, collider.default_thickness);
        let motion = ColliderFrame { start, end, ..ColliderFrame::default() };
        if !to.get(node, &particle::IS_DYNAMIC) {
            return ColliderFrame { collide: false, ..motion };
        }
        ColliderFrame {
            collide: to.get(node, &n_base::COLLIDE),
            elements: elements(to.get(node, &n_base::COLLISION_FLAG)),
            layer: to.get(node, &n_base::COLLISION_LAYER),
            thickness,
            friction: to.get(node, &n_base::FRICTION),
            stickiness: to.get(node, &n_base::STICKINESS),
            bounce: to.get(node, &n_base::BOUNCE),
            collide_strength: to.get(node, &n_base::COLLIDE_STRENGTH),
            push_out: self.push_out(node, collider.default_thickness),
            trapped_check: to.get(node, &n_rigid::TRAPPED_CHECK),
            field: self.force_field(node, 1.0),
            point_field: self.point_field(node, thickness),
            wind_field: self.wind_field(node),
            ..motion
        }
    }

    /// The points of a collider at both ends of the interval, in metres. An empty start means the end of the interval
    /// before; an empty end means no motion.
    fn collider_motion(&self, collider: &ColliderSource) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let Some(motion) = &collider.motion else { return (Vec::new(), Vec::new()) };
        let [before, now] =
            [&self.from, &self.to].map(|moment| (moment.placement(collider.mesh), motion.at(moment)));
        let points = |(placement, points): &(Affine, Points)| self.nucleus.units.placed(placement, points);
        let start = if self.is_discontinuous { points(&before) } else { Vec::new() };
        let is_still = before == now && !self.is_discontinuous;
        (start, if is_still { Vec::new() } else { points(&now) })
    }
}
