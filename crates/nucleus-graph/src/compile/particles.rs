//! Particles: to the solver they are cloth of points alone (N1.1-4), each a ball of its radius.

use nalgebra::Vector3;
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Elements, Faces, MAX_COORDINATE, Mass, SelfCollision, Start,
    Surface, VertexMaps,
};

use crate::attributes::{Key, n_base, n_particle, nucleus, particle};
use crate::graph::NodeId;
use crate::memory::{Cost, Size};

use super::frame::Stretch;
use super::maps::Scales;
use super::objects::{ClothSource, Compiler};
use super::program::ObjectKind;
use super::shaped::Shaped;

impl Compiler<'_> {
    /// Where the particles of a node start, in scene units; nothing if it has none, or they are wrong, which has been
    /// said then.
    pub(super) fn initial_positions(&mut self, node: NodeId) -> Option<Surface> {
        let key = self.initial(node, &n_particle::POSITION0, &n_particle::POSITION);
        let name = self.scene.graph.node(node).name();
        let place = self.scene.source.place(&format!("{name}.{}", key.row.name));
        let vectors = match self.vectors(node, key) {
            Ok(vectors) => vectors,
            Err(message) => {
                self.findings.error(&place, message);
                return None;
            }
        };
        if vectors.is_empty() {
            let message = format!("`{name}` has no particles, and does nothing");
            let warning = self.findings.warning(&self.scene.source.place(name), message);
            warning.help("say where they are: `position: [(0, 1, 0)]` or `position: file(\"points.obj\")`");
            return None;
        }
        let size = Size { points: vectors.len() as u64, corners: 0 };
        self.claim(node, node, size, Cost::CLOTH)?;
        let positions: Vec<Vector3<f64>> = vectors.into_iter().map(Vector3::from).collect();
        let is_far = |position: &Vector3<f64>| self.whole.units.point(*position).amax() > MAX_COORDINATE;
        if let Some(point) = positions.iter().position(is_far) {
            let message =
                format!("`{}` of `{name}` is more than {MAX_COORDINATE:e} m at point {point}", key.row.name);
            self.findings.error(&place, message);
            return None;
        }
        Some(Surface { positions, faces: Faces::default() })
    }

    /// The first of two lists that is given.
    fn initial(
        &self,
        node: NodeId,
        first: &'static Key<Vec<[f64; 3]>>,
        else_this: &'static Key<Vec<[f64; 3]>>,
    ) -> &'static Key<Vec<[f64; 3]>> {
        if self.scene.graph.is_given(node, first) { first } else { else_this }
    }

    /// Compiles the particles of a node.
    pub(super) fn particles(&mut self, Shaped { id, surface, .. }: Shaped) -> Option<()> {
        self.check_wired(id, &[particle::CURRENT_TIME.row.name, n_base::NEXT_STATE.row.name]);
        let points = surface.positions.len();
        let surface = self.whole.units.surface(surface);
        let velocities = self.initial(id, &n_particle::VELOCITY0, &n_particle::VELOCITY);
        let velocities = self.start_column(id, id, points, velocities)?;
        let graph = &self.scene.graph;
        let lists = ClothLists {
            air: graph.is_ever_nonzero(id, &n_particle::DRAG)
                && graph.is_ever_nonzero(self.whole.nucleus, &nucleus::AIR_DENSITY),
            self_collision: graph.is_ever_nonzero(id, &n_base::SELF_COLLIDE),
            ..ClothLists::NONE
        };
        let mass = self.start.get(id, &n_particle::POINT_MASS);
        let start = Start { velocities, ..Start::default() };
        let cloth =
            Cloth { surface, mass: Mass::PerPoint(mass), lists, factors: VertexMaps::default(), start };
        match self.whole.model.cloth(cloth) {
            Ok(cloth) => {
                let kind = ObjectKind::Cloth(ClothId(self.whole.first_cloth + cloth.0));
                self.mass_and_object(id, kind, points, Faces::default(), mass * points as f64);
                let radius = self.start.get(id, &n_particle::RADIUS);
                self.objects.iter_mut().last().into_iter().for_each(|object| object.radius = Some(radius));
            }
            Err(error) => return self.refuse(id, id, &error),
        }
        let (default_thickness, is_dense, scales) = (0.0, false, Scales::NONE);
        let source = ClothSource { node: id, is_particles: true, default_thickness, is_dense, scales };
        self.whole.cloths.push(source);
        Some(())
    }
}

impl Stretch<'_> {
    /// The attributes of particles in a frame.
    pub(super) fn particle_frame(&self, node: NodeId) -> ClothFrame {
        let number = |key: &Key<f64>| self.to.get(node, key);
        let radius = self.universe.units.length(number(&n_particle::RADIUS));
        let thickness = radius * number(&n_particle::COLLIDE_WIDTH_SCALE).max(0.0);
        ClothFrame {
            stretch_resistance: 0.0,
            compression_resistance: 0.0,
            bend_resistance: 0.0,
            stretch_damp: 0.0,
            drag: number(&n_particle::DRAG),
            // A ball has no side: what is said of the surface holds for all directions.
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
                on: self.to.get(node, &n_base::SELF_COLLIDE),
                thickness: thickness * number(&n_particle::SELF_COLLIDE_WIDTH_SCALE).max(0.0),
                elements: Elements::Points,
                edges: false,
            },
            ..ClothFrame::default()
        }
    }
}
