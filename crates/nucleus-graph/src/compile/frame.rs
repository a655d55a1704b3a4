//! What a frame brings: every attribute as it is at the end of the frame, and where things move.
//!
//! Animation is evaluated here, once per frame or evaluation (N2.4-6). The solver interpolates positions
//! linearly inside it (N2.4-7). Colliders are pulled first, then cloth, then constraints; what none of them
//! needs is not evaluated at all.

use nalgebra::Vector3;
use nucleus_core::{
    ClothFrame, ClothId, ColliderFrame, FrameInput, GroundPlane, PointId, PushOut, ResistanceModel, Stiffness,
};

use crate::animation::Affine;
use crate::attributes::{Key, n_base, n_cloth, n_rigid, nucleus};
use crate::graph::{EvalContext, Graph, NodeId};

use super::objects::{CLASSIC, ClothSource, ColliderSource};
use super::pins::Grips;
use super::program::{Program, Universe};
use super::self_collision::elements;
use super::shape::Points;

/// Thicknesses to which Maya sets `pushOutRadius` when it makes an object.
const CREATED_PUSH_OUT_RADIUS: f64 = 4.0;

/// A stretch of time that is solved in one go: from one evaluation to the next.
pub(crate) struct Stretch<'p> {
    pub(super) universe: &'p Universe,
    pub(super) graph: &'p Graph,
    pub(super) from: EvalContext<'p>,
    pub(super) to: EvalContext<'p>,
    /// Seconds of the animation.
    pub(super) seconds: f64,
    /// It begins at the start frame: everything is where it was made.
    pub(super) is_first: bool,
    /// What was evaluated last is not where this begins.
    pub(super) leaps: bool,
}

impl Program {
    /// The input of the first frame of the first nucleus, as an example of what a frame costs.
    pub fn first_input(&self) -> FrameInput {
        self.first_input_of(0)
    }

    /// The input of the first frame of each nucleus, in the order of the program.
    pub fn first_inputs(&self) -> impl Iterator<Item = FrameInput> {
        (0..self.universes().len()).map(|universe| self.first_input_of(universe))
    }

    fn first_input_of(&self, universe: usize) -> FrameInput {
        let start = self.universes()[universe].start as f64;
        self.stretch(universe, [start, start + 1.0], 1.0, false)
            .input(&mut Grips::default(), &|_, _| Vector3::zeros())
    }

    /// The nodes whose values the first nucleus needs for a frame, in the order in which it asks for them.
    pub fn pulled(&self, frame: i64) -> Vec<NodeId> {
        let stretch = self.stretch(0, [frame as f64 - 1.0, frame as f64], 1.0, false);
        stretch.input(&mut Grips::default(), &|_, _| Vector3::zeros());
        stretch.to.pulled()
    }

    /// What moves a nucleus from one frame to another, which may be broken; `elapsed` is how many frames that
    /// is to the nucleus.
    pub(crate) fn stretch(
        &self,
        universe: usize,
        frames: [f64; 2],
        elapsed: f64,
        leaps: bool,
    ) -> Stretch<'_> {
        let universe = &self.whole.universes[universe];
        let graph = &self.whole.graph;
        let [from, to] = frames.map(|frame| graph.at(frame));
        let seconds = elapsed / self.whole.time.fps;
        Stretch { universe, graph, from, to, seconds, is_first: frames[0] <= universe.start as f64, leaps }
    }
}

impl Stretch<'_> {
    /// The input of the solver. `position` is where points are when it begins, in metres.
    pub(crate) fn input(
        &self,
        grips: &mut Grips,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> FrameInput {
        let (nucleus, to) = (self.universe.nucleus, &self.to);
        let space = self.nucleus_space();
        let along = |direction: &Key<[f64; 3]>, size: &Key<f64>| {
            unit(space.linear * Vector3::from(to.get(nucleus, direction))) * to.get(nucleus, size)
        };
        FrameInput {
            duration: to.get(nucleus, &nucleus::TIME_SCALE) * self.seconds,
            substeps: to.get(nucleus, &nucleus::SUB_STEPS) as u32,
            collision_iterations: to.get(nucleus, &nucleus::MAX_COLLISION_ITERATIONS) as f64,
            resistance: match to.get(nucleus, &nucleus::RESISTANCE_MODEL) {
                CLASSIC => ResistanceModel::Classic,
                _ => ResistanceModel::Physical { evaluations: to.get(nucleus, &nucleus::EVALUATIONS) },
            },
            gravity: along(&nucleus::GRAVITY_DIRECTION, &nucleus::GRAVITY),
            wind: along(&nucleus::WIND_DIRECTION, &nucleus::WIND_SPEED),
            air_density: to.get(nucleus, &nucleus::AIR_DENSITY),
            plane: self.ground_plane(&space),
            layer_range: to.get(nucleus, &nucleus::COLLISION_LAYER_RANGE),
            colliders: self.universe.colliders.iter().map(|collider| self.collider_frame(collider)).collect(),
            cloths: self.universe.cloths.iter().map(|cloth| self.active_frame(cloth)).collect(),
            self_collision_iterations: self.self_collision_iterations(),
            pins: self.pins(grips, position),
        }
    }

    /// The space that directions and the ground plane are given in.
    fn nucleus_space(&self) -> Affine {
        let own = self.to.get(self.universe.nucleus, &nucleus::USE_TRANSFORM);
        if own { self.to.placement(self.universe.nucleus) } else { Affine::identity() }
    }

    fn ground_plane(&self, space: &Affine) -> Option<GroundPlane> {
        let (nucleus, to) = (self.universe.nucleus, &self.to);
        if !to.get(nucleus, &nucleus::USE_PLANE) {
            return None;
        }
        // Normals go with the inverse transpose, or a scaled plane would tilt.
        let turn = space.linear.try_inverse().unwrap_or_default().transpose();
        let normal = turn * Vector3::from(to.get(nucleus, &nucleus::PLANE_NORMAL));
        let origin = space.point(Vector3::from(to.get(nucleus, &nucleus::PLANE_ORIGIN)));
        // A plane without a direction is nowhere.
        (normal != Vector3::zeros()).then(|| GroundPlane {
            origin: self.universe.units.point(origin),
            normal,
            bounce: to.get(nucleus, &nucleus::PLANE_BOUNCE),
            friction: to.get(nucleus, &nucleus::PLANE_FRICTION),
            stickiness: to.get(nucleus, &nucleus::PLANE_STICKINESS),
        })
    }

    fn active_frame(&self, cloth: &ClothSource) -> ClothFrame {
        if cloth.is_particles { self.particle_frame(cloth.node) } else { self.cloth_frame(cloth) }
    }

    fn cloth_frame(&self, cloth: &ClothSource) -> ClothFrame {
        let (node, to, scales) = (cloth.node, &self.to, &cloth.scales);
        let number = |key: &Key<f64>| to.get(node, key);
        // Below nought there is none: the resistance counts.
        let stiffness = |key: &Key<f64>, scale: f64| Some(number(key) * scale).filter(|_| number(key) >= 0.0);
        ClothFrame {
            stretch_resistance: number(&n_cloth::STRETCH_RESISTANCE) * scales.stretch,
            compression_resistance: number(&n_cloth::COMPRESSION_RESISTANCE) * scales.compression,
            shear_resistance: number(&n_cloth::SHEAR_RESISTANCE),
            bend_resistance: number(&n_cloth::BEND_RESISTANCE) * scales.bend,
            stiffness: Stiffness {
                stretch: stiffness(&n_cloth::STRETCH_STIFFNESS, scales.stretch),
                compression: stiffness(&n_cloth::COMPRESSION_STIFFNESS, scales.compression),
                shear: stiffness(&n_cloth::SHEAR_STIFFNESS, 1.0),
                bend: stiffness(&n_cloth::BEND_STIFFNESS, scales.bend),
            },
            rest_length_scale: number(&n_base::REST_LENGTH_SCALE) * scales.rest_length,
            stretch_damp: number(&n_cloth::STRETCH_DAMP),
            damp: number(&n_base::DAMP) * scales.damp,
            drag: number(&n_cloth::DRAG) * scales.drag,
            tangential_drag: number(&n_cloth::TANGENTIAL_DRAG) * scales.tangential_drag,
            lift: number(&n_cloth::LIFT) * scales.lift,
            feels_gravity: !to.get(node, &n_cloth::IGNORE_SOLVER_GRAVITY),
            feels_wind: !to.get(node, &n_cloth::IGNORE_SOLVER_WIND),
            local_force: Vector3::from(to.get(node, &n_base::LOCAL_FORCE)),
            local_wind: Vector3::from(to.get(node, &n_base::LOCAL_WIND)),
            collide: to.get(node, &n_base::COLLIDE),
            thickness: self.thickness(node, cloth.default_thickness) * scales.thickness,
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
        }
    }

    fn collider_frame(&self, collider: &ColliderSource) -> ColliderFrame {
        let (node, to) = (collider.node, &self.to);
        let (start, end) = self.collider_way(collider);
        ColliderFrame {
            start,
            end,
            collide: to.get(node, &n_base::COLLIDE),
            thickness: self.thickness(node, collider.default_thickness),
            friction: to.get(node, &n_base::FRICTION),
            stickiness: to.get(node, &n_base::STICKINESS),
            bounce: to.get(node, &n_base::BOUNCE),
            collide_strength: to.get(node, &n_base::COLLIDE_STRENGTH),
            push_out: self.push_out(node, collider.default_thickness),
            trapped_check: to.get(node, &n_rigid::TRAPPED_CHECK),
        }
    }

    /// Where the points of a collider are at both ends, in metres; nothing for where they were, or if they
    /// stay.
    fn collider_way(&self, collider: &ColliderSource) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let Some(shape) = &collider.shape else { return (Vec::new(), Vec::new()) };
        let [before, now] =
            [&self.from, &self.to].map(|moment| (moment.placement(collider.mesh), shape.at(moment)));
        let points = |(placement, points): &(Affine, Points)| -> Vec<Vector3<f64>> {
            points.iter().map(|point| self.universe.units.point(placement.point(*point))).collect()
        };
        let start = if self.leaps { points(&before) } else { Vec::new() };
        let stays = before == now && !self.leaps;
        (start, if stays { Vec::new() } else { points(&now) })
    }

    /// How an object pushes points of others out. Left out, the radius is what Maya sets when it makes the object.
    fn push_out(&self, node: NodeId, default_thickness: f64) -> PushOut {
        let share = self.to.get(node, &n_base::PUSH_OUT);
        if share == 0.0 {
            return PushOut::OFF;
        }
        let radius = match self.graph.is_given(node, &n_base::PUSH_OUT_RADIUS) {
            true => self.universe.units.length(self.to.get(node, &n_base::PUSH_OUT_RADIUS)),
            false => CREATED_PUSH_OUT_RADIUS * self.thickness(node, default_thickness),
        };
        PushOut { share, radius }
    }

    /// In metres.
    pub(super) fn thickness(&self, node: NodeId, default: f64) -> f64 {
        let given = self.graph.is_given(node, &n_base::THICKNESS);
        let units = if given { self.to.get(node, &n_base::THICKNESS) } else { default };
        self.universe.units.length(units)
    }
}

/// The direction of a vector; zero has none.
fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    vector.try_normalize(0.0).unwrap_or_default()
}
