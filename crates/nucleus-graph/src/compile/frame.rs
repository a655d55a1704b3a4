//! What a frame brings: every attribute as it is at the end of the frame, and where things move.
//!
//! Animation is evaluated here, once per frame (N2.4-6). The solver interpolates positions linearly inside
//! it (N2.4-7).

use nalgebra::Vector3;
use nucleus_core::{
    ClothFrame, ClothId, ColliderFrame, FrameInput, GroundPlane, PointId, ResistanceModel, Stiffness,
};

use crate::animation::Affine;
use crate::attributes::{Key, n_base, n_cloth, nucleus};
use crate::graph::{Node, NodeId};

use super::objects::{CLASSIC, ClothSource, ColliderSource};
use super::pins::Grips;
use super::program::Program;
use super::self_collision::elements;

impl Program {
    /// The input of the first frame, as an example of what a frame costs.
    pub fn first_input(&self) -> FrameInput {
        let start = |cloth: ClothId, point: PointId| self.cloths[cloth.index()].start[point.index()];
        self.input(self.time.start + 1, &mut Grips::default(), &start)
    }

    /// The input of the frame that ends at `frame`. `position` is where points are when it begins, in metres.
    pub(crate) fn input(
        &self,
        frame: i64,
        grips: &mut Grips,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> FrameInput {
        let nucleus = self.graph.node(self.nucleus);
        let at = frame as f64;
        let space = self.nucleus_space(at);
        let along = |direction: &Key<[f64; 3]>, size: &Key<f64>| {
            unit(space.linear * Vector3::from(nucleus.at(direction, at))) * nucleus.at(size, at)
        };
        FrameInput {
            duration: nucleus.at(&nucleus::TIME_SCALE, at) / self.time.fps,
            substeps: nucleus.at(&nucleus::SUB_STEPS, at) as u32,
            collision_iterations: nucleus.at(&nucleus::MAX_COLLISION_ITERATIONS, at) as f64,
            resistance: match nucleus.get(&nucleus::RESISTANCE_MODEL) {
                CLASSIC => ResistanceModel::Classic,
                _ => ResistanceModel::Physical { evaluations: nucleus.at(&nucleus::EVALUATIONS, at) },
            },
            gravity: along(&nucleus::GRAVITY_DIRECTION, &nucleus::GRAVITY),
            wind: along(&nucleus::WIND_DIRECTION, &nucleus::WIND_SPEED),
            air_density: nucleus.at(&nucleus::AIR_DENSITY, at),
            plane: self.ground_plane(nucleus, at, &space),
            layer_range: nucleus.at(&nucleus::COLLISION_LAYER_RANGE, at),
            self_collision_iterations: self.self_collision_iterations(at),
            cloths: self.cloths.iter().map(|cloth| self.cloth_frame(cloth, at)).collect(),
            colliders: self.colliders.iter().map(|collider| self.collider_frame(collider, frame)).collect(),
            pins: self.pins(frame, grips, position),
        }
    }

    /// The space that directions and the ground plane are given in.
    fn nucleus_space(&self, frame: f64) -> Affine {
        let own = self.graph.node(self.nucleus).at(&nucleus::USE_TRANSFORM, frame);
        if own { self.graph.placement(self.nucleus, frame) } else { Affine::identity() }
    }

    fn ground_plane(&self, nucleus: &Node, frame: f64, space: &Affine) -> Option<GroundPlane> {
        // Normals go with the inverse transpose, or a scaled plane would tilt.
        let turn = space.linear.try_inverse().unwrap_or_default().transpose();
        let normal = turn * Vector3::from(nucleus.at(&nucleus::PLANE_NORMAL, frame));
        // A plane without a direction is nowhere.
        (nucleus.at(&nucleus::USE_PLANE, frame) && normal != Vector3::zeros()).then(|| GroundPlane {
            origin: self.units.point(space.point(Vector3::from(nucleus.at(&nucleus::PLANE_ORIGIN, frame)))),
            normal,
            bounce: nucleus.at(&nucleus::PLANE_BOUNCE, frame),
            friction: nucleus.at(&nucleus::PLANE_FRICTION, frame),
        })
    }

    fn cloth_frame(&self, cloth: &ClothSource, frame: f64) -> ClothFrame {
        let node = self.graph.node(cloth.node);
        let number = |key: &Key<f64>| node.at(key, frame);
        // Below nought there is none: the resistance counts.
        let stiffness = |key: &Key<f64>| Some(number(key)).filter(|stiffness| *stiffness >= 0.0);
        ClothFrame {
            stretch_resistance: number(&n_cloth::STRETCH_RESISTANCE),
            compression_resistance: number(&n_cloth::COMPRESSION_RESISTANCE),
            shear_resistance: number(&n_cloth::SHEAR_RESISTANCE),
            bend_resistance: number(&n_cloth::BEND_RESISTANCE),
            stiffness: Stiffness {
                stretch: stiffness(&n_cloth::STRETCH_STIFFNESS),
                compression: stiffness(&n_cloth::COMPRESSION_STIFFNESS),
                shear: stiffness(&n_cloth::SHEAR_STIFFNESS),
                bend: stiffness(&n_cloth::BEND_STIFFNESS),
            },
            rest_length_scale: number(&n_base::REST_LENGTH_SCALE),
            stretch_damp: number(&n_cloth::STRETCH_DAMP),
            damp: number(&n_base::DAMP),
            drag: number(&n_cloth::DRAG),
            tangential_drag: number(&n_cloth::TANGENTIAL_DRAG),
            lift: number(&n_cloth::LIFT),
            feels_gravity: !node.at(&n_cloth::IGNORE_SOLVER_GRAVITY, frame),
            feels_wind: !node.at(&n_cloth::IGNORE_SOLVER_WIND, frame),
            local_force: Vector3::from(node.at(&n_base::LOCAL_FORCE, frame)),
            local_wind: Vector3::from(node.at(&n_base::LOCAL_WIND, frame)),
            collide: node.at(&n_base::COLLIDE, frame),
            thickness: self.thickness(cloth.node, cloth.default_thickness, frame),
            friction: number(&n_base::FRICTION),
            bounce: number(&n_base::BOUNCE),
            elements: elements(node.at(&n_base::COLLISION_FLAG, frame)),
            layer: number(&n_base::COLLISION_LAYER),
            self_collision: self.self_collision(cloth, frame),
        }
    }

    fn collider_frame(&self, collider: &ColliderSource, frame: i64) -> ColliderFrame {
        let (node, at) = (self.graph.node(collider.node), frame as f64);
        ColliderFrame {
            start: Vec::new(),
            end: self.collider_end(collider, frame),
            collide: node.at(&n_base::COLLIDE, at),
            thickness: self.thickness(collider.node, collider.default_thickness, at),
            friction: node.at(&n_base::FRICTION, at),
            bounce: node.at(&n_base::BOUNCE, at),
        }
    }

    /// Where the points of a collider are at a frame, in metres; nothing if they are where they were.
    fn collider_end(&self, collider: &ColliderSource, frame: i64) -> Vec<Vector3<f64>> {
        if collider.local.is_empty() {
            return Vec::new();
        }
        let [before, now] = [frame - 1, frame].map(|frame| self.graph.placement(collider.mesh, frame as f64));
        if before == now {
            return Vec::new();
        }
        collider.local.iter().map(|point| self.units.point(now.point(*point))).collect()
    }

    /// In metres.
    pub(super) fn thickness(&self, node: NodeId, default: f64, frame: f64) -> f64 {
        let node = self.graph.node(node);
        let set = node.setting(&n_base::THICKNESS).is_some();
        self.units.length(if set { node.at(&n_base::THICKNESS, frame) } else { default })
    }
}

/// The direction of a vector; zero has none.
fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    vector.try_normalize(0.0).unwrap_or_default()
}
