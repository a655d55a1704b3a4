//! Initial state of objects: positions and velocities at the start frame, and the order in which objects are solved.
//!
//! Cloth starts as its mesh, at rest, unless `startPositions` or `startVelocities` are given. Both are in world space, in
//! scene units. Rest lengths always come from the mesh, so cloth that starts stretched contracts.
//!
//! Objects are solved in the order of height at the start frame, lowest first, so that names do not influence the
//! result. Contacts are solved one after another (Gauss-Seidel), so the order shows in the last bits, and in larger
//! differences where cloth is compressed. Objects at identical positions are ordered by their settings; objects with
//! identical settings are interchangeable.

use std::cmp::Ordering;

use nalgebra::Vector3;
use nucleus_core::{Faces, MAX_COORDINATE, Start, Surface};

use crate::attributes::{Key, Painting, Value, n_base, n_cloth, n_particle, surface_shape};
use crate::graph::{Graph, NodeId};
use crate::memory::{Cost, Size};

use super::compiler::Compiler;
use super::constraints::split_mesh::Tearing;
use super::emission::emitter_nodes;
use super::geometry::placed_faces;
use super::particle_ramps::is_event_target;

/// An object with its mesh at the start frame, in world space; lengths in scene units. Particles are their own mesh.
pub(super) struct PlacedObject {
    pub(super) id: NodeId,
    pub(super) mesh: NodeId,
    pub(super) surface: Surface,
}

impl Compiler<'_> {
    /// The objects that have a mesh, in solve order.
    pub(super) fn placed_meshes(&mut self, objects: Vec<NodeId>) -> Vec<PlacedObject> {
        let place = |id| self.world_surface(id).map(|(mesh, surface)| PlacedObject { id, mesh, surface });
        let placed = objects.into_iter().filter_map(place).collect();
        self.in_solve_order(placed)
    }

    /// The particle nodes that have particles, in solve order.
    pub(super) fn placed_particles(&mut self, objects: Vec<NodeId>) -> Vec<PlacedObject> {
        let place = |id| self.particle_positions(id).map(|surface| PlacedObject { id, mesh: id, surface });
        let placed = objects.into_iter().filter_map(place).collect();
        self.in_solve_order(placed)
    }

    /// Sorts objects, and enlarges the bounding box of the nucleus by them.
    fn in_solve_order(&mut self, mut placed: Vec<PlacedObject>) -> Vec<PlacedObject> {
        for point in placed.iter().flat_map(|placed| &placed.surface.positions) {
            let [low, high] = self.bounds.unwrap_or([*point; 2]);
            self.bounds = Some([low.inf(point), high.sup(point)]);
        }
        placed.sort_by(|a, b| a.solve_order(b, &self.scene.graph));
        placed
    }

    /// The mesh of an object, and its surface at the start frame in world space; lengths in scene units.
    fn world_surface(&mut self, object: NodeId) -> Option<(NodeId, Surface)> {
        let graph = &self.scene.graph;
        let Some(mesh) = self.mesh_of(object) else {
            self.report_no_mesh(object);
            return None;
        };
        if self.broken.contains(&mesh) {
            return None;
        }
        let size = self.geometry.size(self.scene, mesh, self.findings)?;
        let is_cloth = graph.node(object).node_type().is_a(&n_cloth::N_CLOTH);
        self.claim(object, mesh, size, if is_cloth { Cost::CLOTH } else { Cost::COLLIDER })?;
        let placement = self.start.placement(mesh);
        let fixed = self.geometry.is_fixed(self.scene, mesh, self.findings);
        let mut surface = self.geometry.surface(self.scene, mesh, self.findings)?.clone();
        if !fixed {
            surface.positions =
                self.geometry.animated(self.scene, mesh, self.findings)?.at(&self.start).to_vec();
        }
        for position in &mut surface.positions {
            *position = placement.point(*position);
        }
        surface.faces = placed_faces(&surface.faces, &placement);
        Some((mesh, surface))
    }

    /// Reports an object without a mesh, or with one that is simulated.
    fn report_no_mesh(&mut self, object: NodeId) {
        let graph = &self.scene.graph;
        let name = graph.node(object).name();
        let place = self.scene.source.place(name);
        match graph.source(object, &n_base::INPUT_MESH).map(|source| graph.node(source).name()) {
            None => {
                let error = self.findings.error(&place, format!("`{name}` has no `inputMesh`"));
                error.help("connect a mesh's `worldMesh[0]` to it");
            }
            Some(source) => {
                let message =
                    format!("`{name}` cannot follow `{source}`: the result of cloth is no input mesh yet");
                let error = self.findings.error(&place, message);
                error.help("run and export the cloth first, and read it as a `mesh` with a file per frame");
            }
        }
    }

    /// The mesh node connected to an object. A mesh that only displays another node's output, as that of a cloth,
    /// is not a source.
    fn mesh_of(&self, object: NodeId) -> Option<NodeId> {
        let graph = &self.scene.graph;
        let mesh = graph.source(object, &n_base::INPUT_MESH)?;
        let is_surface = graph.node(mesh).node_type().is_a(&surface_shape::SURFACE_SHAPE);
        (is_surface && graph.source(mesh, &surface_shape::IN_MESH).is_none()).then_some(mesh)
    }

    /// Initial positions of a node's particles, in scene units. `None` without particles or after an error, which is
    /// reported.
    fn particle_positions(&mut self, node: NodeId) -> Option<Surface> {
        let key = self.first_given(node, &n_particle::POSITION0, &n_particle::POSITION);
        let name = self.scene.graph.node(node).name();
        let place = self.place(node, &key.row);
        let is_recorded = self.plays_from_start(node);
        let vectors = match is_recorded {
            true => self.recorded_file(node, self.program.start),
            false => self.vectors(node, key),
        };
        let vectors = match vectors {
            Ok(vectors) => vectors,
            Err(message) => {
                self.findings.error(&place, message);
                return None;
            }
        };
        // Recorded particles are all of them.
        let filled = match is_recorded {
            true => Vec::new(),
            false => self.filled_positions(node, vectors.len())?,
        };
        let graph = &self.scene.graph;
        let is_filled = is_recorded || !emitter_nodes(graph, node).is_empty() || is_event_target(graph, node);
        if vectors.is_empty() && filled.is_empty() && !is_filled {
            let message = format!("`{name}` has no particles, and does nothing");
            let warning = self.findings.warning(&self.scene.source.place(name), message);
            warning.help(
                "say where they are: `position: [(0, 1, 0)]`, `position: file(\"points.obj\")`, `minimumCorner` and \
                 `maximumCorner` of a box, or a `fillMesh`; or emit some with a pointEmitter",
            );
            return None;
        }
        let size = Size { points: vectors.len() as u64, corners: 0 };
        self.claim(node, node, size, Cost::CLOTH)?;
        let positions: Vec<Vector3<f64>> = vectors.into_iter().map(Vector3::from).chain(filled).collect();
        let is_far = |position: &Vector3<f64>| self.program.units.point(*position).amax() > MAX_COORDINATE;
        if let Some(point) = positions.iter().position(is_far) {
            let message =
                format!("`{}` of `{name}` is more than {MAX_COORDINATE:e} m at point {point}", key.row.name);
            self.findings.error(&place, message);
            return None;
        }
        Some(Surface { positions, faces: Faces::default() })
    }

    /// The first of two attributes that is given, else the second.
    pub(super) fn first_given(
        &self,
        node: NodeId,
        first: &'static Key<Vec<[f64; 3]>>,
        second: &'static Key<Vec<[f64; 3]>>,
    ) -> &'static Key<Vec<[f64; 3]>> {
        if self.scene.graph.is_given(node, first) { first } else { second }
    }

    /// The start state of a cloth; `None` after an error, which is reported. Each list has one vector per point of the mesh, or
    /// one per point of the mesh as it is split to tear.
    pub(super) fn start_state(
        &mut self,
        cloth: NodeId,
        mesh: NodeId,
        points: usize,
        tearing: Option<&Tearing>,
    ) -> Option<Start> {
        let split = points + tearing.map_or(0, |tearing| tearing.twins.len());
        let count = |found: usize| if found == split { split } else { points };
        let positions = self.vectors(cloth, &n_base::START_POSITIONS);
        let found = count(positions.as_ref().map_or(0, Vec::len));
        let positions = self.of_each_point(cloth, mesh, found, &n_base::START_POSITIONS, positions);
        let found = count(self.vectors(cloth, &n_base::START_VELOCITIES).map_or(0, |all| all.len()));
        let velocities = self.start_velocities(cloth, mesh, found, &n_base::START_VELOCITIES);
        Some(Start { positions: positions?, velocities: velocities? })
    }

    /// One velocity per point in metres per second, or none; one that is given counts for all points. `None` after an error,
    /// which is reported.
    pub(super) fn start_velocities(
        &mut self,
        cloth: NodeId,
        mesh: NodeId,
        points: usize,
        key: &Key<Vec<[f64; 3]>>,
    ) -> Option<Vec<Vector3<f64>>> {
        let mut velocities = self.vectors(cloth, key);
        if let Ok(column) = &mut velocities
            && let &[velocity] = &column[..]
        {
            column.resize(points, velocity);
        }
        self.of_each_point(cloth, mesh, points, key, velocities)
    }

    /// The vectors of an attribute in metres or metres per second, if there is one per point or none; `None` after an error,
    /// which is reported.
    fn of_each_point(
        &mut self,
        cloth: NodeId,
        mesh: NodeId,
        points: usize,
        key: &Key<Vec<[f64; 3]>>,
        vectors: Result<Vec<[f64; 3]>, String>,
    ) -> Option<Vec<Vector3<f64>>> {
        let [name, mesh] = [cloth, mesh].map(|node| self.scene.graph.node(node).name());
        let label = format!("`{}` of `{name}`", key.row.name);
        let metres = |vectors: Vec<[f64; 3]>| -> Vec<Vector3<f64>> {
            vectors.into_iter().map(|vector| self.program.units.point(vector.into())).collect()
        };
        let is_far = |metres: &Vector3<f64>| metres.amax() > MAX_COORDINATE;
        let checked = vectors.map(metres).and_then(|column| match column.iter().position(is_far) {
            _ if !column.is_empty() && column.len() != points => {
                let found = column.len();
                Err(format!(
                    "{label} has {found} vectors, but `{mesh}` has {points} points: give one for each"
                ))
            }
            Some(point) => Err(format!("{label} is more than {MAX_COORDINATE:e} m at point {point}")),
            None => Ok(column),
        });
        let report = |message| {
            let place = self.place(cloth, &key.row);
            self.findings.error(&place, message);
        };
        checked.map_err(report).ok()
    }

    /// The value of a list of vectors, from the scene or from a file; else the reason why it cannot be read.
    fn vectors(&self, node: NodeId, key: &Key<Vec<[f64; 3]>>) -> Result<Vec<[f64; 3]>, String> {
        match self.start.held(node, key) {
            Some(Value::Vectors(vectors)) => Ok(vectors),
            Some(Value::Painting(Painting::File(file))) => self.vectors_of_file(&file),
            _ => Ok(Vec::new()),
        }
    }
}

impl PlacedObject {
    /// By y, z and x of the points in turn, then by size, faces and settings.
    fn solve_order(&self, other: &Self, graph: &Graph) -> Ordering {
        let (a, b) = (&self.surface, &other.surface);
        let size = |surface: &Surface| [surface.positions.len(), surface.faces.len()];
        let place = |surface: &'_ Surface, point: usize| {
            let p = surface.positions[point];
            [p.y, p.z, p.x]
        };
        let points = a.positions.len().min(b.positions.len());
        let coordinates = (0..points).flat_map(|k| place(a, k).into_iter().zip(place(b, k)));
        let places = coordinates.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        let settings = |id: NodeId| format!("{:?}", (graph.node(id).preset(), graph.node(id).settings()));
        places
            .unwrap_or(Ordering::Equal)
            .then_with(|| size(a).cmp(&size(b)))
            .then_with(|| a.faces.corners().cmp(b.faces.corners()))
            .then_with(|| settings(self.id).cmp(&settings(other.id)))
    }
}
