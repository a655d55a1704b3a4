//! Objects: from nodes to what the model is built of.

use std::collections::BTreeSet;
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::{BuildError, Cloth, ClothId, Collider, ColliderId, Faces, Mass, ModelBuilder, Surface};

use crate::attributes::{
    Choice, Key, NodeType, Plugged, n_base, n_cloth, n_particle, n_rigid, nucleus, particle, surface_shape,
};
use crate::files;
use crate::graph::{EvalContext, NodeId};
use crate::memory::{Cost, Size};
use crate::scene::{Findings, Scene};

use super::geometry::Geometry;
use super::lists::lists;
use super::maps::{Maps, Scales};
use super::program::{Object, ObjectKind, Universe};
use super::shape::Shape;
use super::shaped::Shaped;
use super::thickness::{CLOTH_SHARE, COLLIDER_SHARE, default_thickness, is_dense};
use super::time;
use super::units::Units;

/// `resistanceModel: classic`.
pub(super) const CLASSIC: Choice = Choice(0);

/// Where the frames of a cloth, or of particles, come from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClothSource {
    pub(super) node: NodeId,
    /// Whether they are particles: cloth of points alone (N1.1-4).
    pub(super) is_particles: bool,
    /// In scene units.
    pub(super) default_thickness: f64,
    /// Whether its edges limit that.
    pub(super) is_dense: bool,
    /// What maps that are the same everywhere make of its attributes.
    pub(super) scales: Scales,
}

/// Where the frames of a collider come from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColliderSource {
    pub(super) node: NodeId,
    pub(super) mesh: NodeId,
    /// In scene units.
    pub(super) default_thickness: f64,
    /// Its points in the space of the mesh, in scene units; nothing if it never moves.
    pub(super) shape: Option<Shape>,
}

/// Compiles one nucleus with all that belongs to it.
pub(super) struct Compiler<'a> {
    pub(super) scene: &'a Scene,
    broken: &'a BTreeSet<NodeId>,
    pub(super) findings: &'a mut Findings,
    pub(super) geometry: &'a mut Geometry,
    /// The graph at the start.
    pub(super) start: EvalContext<'a>,
    pub(super) whole: Universe,
    pub(super) objects: Vec<Object>,
    mass: f64,
    /// The corners of the box that holds all objects at the start, in scene units.
    pub(super) bounds: Option<[Vector3<f64>; 2]>,
}

/// A nucleus that has been compiled, its objects, and the mass of its cloth in kilograms.
pub(super) type Compiled = (Universe, Vec<Object>, f64);

impl<'a> Compiler<'a> {
    /// `broken` are nodes of which not everything is known; nothing is said about them. `before` has been
    /// compiled before.
    pub(super) fn new(
        scene: &'a Scene,
        nucleus: NodeId,
        broken: &'a BTreeSet<NodeId>,
        geometry: &'a mut Geometry,
        before: Option<&Universe>,
        findings: &'a mut Findings,
    ) -> Self {
        let first = time::start(scene, nucleus, findings);
        let start = scene.graph.at(first as f64);
        let whole = Universe {
            nucleus,
            units: Units::new(start.get(nucleus, &nucleus::SPACE_SCALE)),
            model: ModelBuilder::new(),
            cloths: Vec::new(),
            colliders: Vec::new(),
            pins: Vec::new(),
            start: first,
            first_cloth: before.map_or(0, |before| before.cloths().end),
            first_collider: before.map_or(0, |before| before.colliders().end),
        };
        Self { scene, broken, findings, geometry, start, whole, objects: Vec::new(), mass: 0.0, bounds: None }
    }

    /// All objects and constraints; those that are broken, or made from something broken, are left out. What
    /// comes out is only whole if no errors were found.
    pub(super) fn compile(mut self) -> Compiled {
        let scene = self.scene;
        let active = self.members(&nucleus::INPUT_ACTIVE, &[&n_cloth::N_CLOTH, &n_particle::N_PARTICLE]);
        let is_cloth = |id: &NodeId| scene.graph.node(*id).node_type().is_a(&n_cloth::N_CLOTH);
        let (cloths, particles): (Vec<NodeId>, Vec<NodeId>) = active.into_iter().partition(is_cloth);
        for shaped in self.shaped(cloths) {
            self.cloth(shaped);
        }
        for shaped in self.placed(particles) {
            self.particles(shaped);
        }
        let passive = self.members(&nucleus::INPUT_PASSIVE, &[&n_rigid::N_RIGID]);
        for shaped in self.shaped(passive) {
            self.collider(shaped);
        }
        self.whole.pins = self.pins();
        let cloths = self.whole.cloths.iter().map(|cloth| cloth.node);
        let objects: Vec<NodeId> =
            cloths.chain(self.whole.colliders.iter().map(|collider| collider.node)).collect();
        self.check_widths(&objects);
        if !self.objects.is_empty() {
            time::check_driven(self.scene, self.whole.nucleus, self.findings);
        }
        (self.whole, self.objects, self.mass)
    }

    /// What is connected to an input of the nucleus, in the order of its elements. Only objects of some types can
    /// be solved there.
    fn members(&mut self, input: &Key<Plugged>, wanted: &[&'static NodeType]) -> Vec<NodeId> {
        let graph = &self.scene.graph;
        let mut members = Vec::new();
        for (index, plug) in graph.elements(self.whole.nucleus, input) {
            let (node, node_type) = (graph.node(plug.node), graph.node(plug.node).node_type());
            let is_wanted = wanted.iter().any(|wanted| node_type.is_a(wanted));
            if is_wanted && !members.contains(&plug.node) {
                members.push(plug.node);
            } else if !is_wanted {
                let place = self.scene.source.place(node.name());
                let input = format!("{}.{}[{index}]", graph.node(self.whole.nucleus).name(), input.row.name);
                let message = format!(
                    "`{}` is of type {} and cannot be solved at `{input}`, which takes {}",
                    node.name(),
                    node_type.name,
                    wanted.iter().map(|wanted| wanted.name).collect::<Vec<_>>().join(" and ")
                );
                self.findings.error(&place, message);
            }
        }
        members.retain(|node| !self.broken.contains(node));
        members
    }

    /// Says so if a connection is missing without which an object is not solved as Maya would.
    pub(super) fn check_wired(&mut self, object: NodeId, inputs: &[&str]) {
        let graph = &self.scene.graph;
        for input in inputs {
            let fed = graph.arriving(object).any(|wire| wire.to.attribute.name == *input);
            if !fed {
                let name = graph.node(object).name();
                let message = format!("nothing is connected to `{name}.{input}`");
                self.findings.warning(&self.scene.source.place(name), message);
            }
        }
    }

    fn cloth(&mut self, Shaped { id, mesh, surface }: Shaped) -> Option<()> {
        self.check_wired(id, &[particle::CURRENT_TIME.row.name, n_base::NEXT_STATE.row.name]);
        let default_thickness = default_thickness(&surface, CLOTH_SHARE);
        let is_dense = is_dense(&surface, CLOTH_SHARE);
        let surface = self.whole.units.surface(surface);
        self.warn_of_stiffness(id);
        let maps = self.maps(id, mesh, surface.positions.len());
        let start = self.start_of(id, mesh, surface.positions.len());
        let (Maps { scales, factors }, start) = (maps?, start?);
        let point_mass = self.start.get(id, &n_base::POINT_MASS) * scales.mass;
        let mass = match self.start.get(self.whole.nucleus, &nucleus::RESISTANCE_MODEL) {
            CLASSIC => Mass::PerPoint(point_mass),
            _ => Mass::PerArea(point_mass),
        };
        self.warn_of_free_points(self.scene.graph.node(id).name(), mesh, &surface);
        let points = surface.positions.len();
        let faces = surface.faces.clone();
        let lists = lists(&self.scene.graph, id, self.whole.nucleus, &scales);
        let cloth = Cloth { surface, mass, lists, factors, start };
        let kilograms = match mass {
            _ if !cloth.factors.mass.is_empty() => cloth.point_masses().iter().sum(),
            Mass::PerPoint(mass) => mass * points as f64,
            Mass::PerArea(mass) => mass * area(&cloth.surface),
        };
        match self.whole.model.cloth(cloth) {
            Ok(cloth) => {
                let kind = ObjectKind::Cloth(ClothId(self.whole.first_cloth + cloth.0));
                self.mass_and_object(id, kind, points, faces, kilograms);
            }
            Err(error) => return self.refuse(id, mesh, &error),
        }
        let is_particles = false;
        self.whole.cloths.push(ClothSource { node: id, is_particles, default_thickness, is_dense, scales });
        Some(())
    }

    /// A stiffness means nothing where resistances are counts.
    fn warn_of_stiffness(&mut self, cloth: NodeId) {
        use n_cloth::{BEND_STIFFNESS, COMPRESSION_STIFFNESS, SHEAR_STIFFNESS, STRETCH_STIFFNESS};
        let node = self.scene.graph.node(cloth);
        if self.start.get(self.whole.nucleus, &nucleus::RESISTANCE_MODEL) != CLASSIC {
            return;
        }
        for key in [&STRETCH_STIFFNESS, &COMPRESSION_STIFFNESS, &SHEAR_STIFFNESS, &BEND_STIFFNESS] {
            if node.setting(key).is_some() && (node.changes(key) || node.get(key) >= 0.0) {
                let place = self.scene.source.place(&format!("{}.{}", node.name(), key.row.name));
                let message = format!(
                    "`{}` of `{}` has no effect: with `resistanceModel: classic` stiffness follows from counts",
                    key.row.name,
                    node.name()
                );
                self.findings.warning(&place, message);
            }
        }
    }

    fn collider(&mut self, Shaped { id, mesh, surface }: Shaped) -> Option<()> {
        self.check_wired(id, &[particle::CURRENT_TIME.row.name]);
        let default_thickness = default_thickness(&surface, COLLIDER_SHARE);
        let graph = &self.scene.graph;
        let shape = if graph.moves(mesh) || !self.geometry.is_fixed(self.scene, mesh, self.findings) {
            let shape = self.geometry.shape(self.scene, mesh, self.findings)?;
            let blends = |node| graph.changes(node, &surface_shape::BLEND);
            (graph.moves(mesh) || shape.changes(&blends)).then_some(shape)
        } else {
            None
        };
        let surface = self.whole.units.surface(surface);
        let (points, faces) = (surface.positions.len(), surface.faces.clone());
        match self.whole.model.collider(Collider { surface }) {
            Ok(collider) => {
                let kind = ObjectKind::Collider(ColliderId(self.whole.first_collider + collider.0));
                self.mass_and_object(id, kind, points, faces, 0.0);
            }
            Err(error) => return self.refuse(id, mesh, &error),
        }
        self.whole.colliders.push(ColliderSource { node: id, mesh, default_thickness, shape });
        Some(())
    }

    /// The mesh that an object is made from, where it stands at the start; lengths in scene units.
    pub(super) fn world_surface(&mut self, object: NodeId) -> Option<(NodeId, Surface)> {
        let graph = &self.scene.graph;
        let Some(mesh) = self.mesh_of(object) else {
            let name = graph.node(object).name();
            let error =
                self.findings.error(&self.scene.source.place(name), format!("`{name}` has no `inputMesh`"));
            error.help("connect a mesh's `worldMesh[0]` to it");
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
                self.geometry.shape(self.scene, mesh, self.findings)?.at(&self.start).to_vec();
        }
        for position in &mut surface.positions {
            *position = placement.point(*position);
        }
        Some((mesh, surface))
    }

    /// Takes the memory that an object will need, if there is so much; else says so.
    pub(super) fn claim(&mut self, object: NodeId, mesh: NodeId, size: Size, cost: Cost) -> Option<()> {
        let Err(refused) = self.geometry.budget.claim(cost.of(size)) else { return Some(()) };
        if !refused.is_first {
            return None;
        }
        let [object, mesh] = [object, mesh].map(|id| self.scene.graph.node(id).name());
        let message = format!("`{object}`, of {} points, takes {refused}", size.points);
        let error = self.findings.error(&self.scene.source.place(mesh), message);
        error.help(refused.help(&format!("make `{mesh}` coarser")));
        None
    }

    /// Why a file is too large to be read, if it is. `each` is what a byte of it takes.
    pub(super) fn check_file(&self, path: &Path, each: u64) -> Result<(), String> {
        let bytes = files::length(path).saturating_mul(each);
        let checked = self.geometry.budget.check(bytes);
        checked.map_err(|refused| format!("to read `{}` takes {refused}", path.display()))
    }

    /// The mesh that feeds an object. A mesh that only shows what another node gives out, as the output of a
    /// cloth does, is no source of its own.
    fn mesh_of(&self, object: NodeId) -> Option<NodeId> {
        let graph = &self.scene.graph;
        let mesh = graph.source(object, &n_base::INPUT_MESH)?;
        let shows = graph.node(mesh).node_type().is_a(&surface_shape::SURFACE_SHAPE);
        (shows && graph.source(mesh, &surface_shape::IN_MESH).is_none()).then_some(mesh)
    }

    pub(super) fn mass_and_object(
        &mut self,
        node: NodeId,
        kind: ObjectKind,
        points: usize,
        faces: Faces,
        kilograms: f64,
    ) {
        self.mass += kilograms;
        let name = self.scene.graph.node(node).name().to_owned();
        self.objects.push(Object { name, kind, points, faces, radius: None });
    }

    /// Points of no face are held by nothing: they run, but are seldom meant.
    fn warn_of_free_points(&mut self, cloth: &str, mesh: NodeId, surface: &Surface) {
        let mut in_face = vec![false; surface.positions.len()];
        surface.faces.corners().iter().for_each(|&point| in_face[point as usize] = true);
        let free = in_face.iter().filter(|in_face| !**in_face).count();
        let Some(first) = in_face.iter().position(|in_face| !in_face) else { return };
        let message = match free {
            all if all == in_face.len() => format!("`{cloth}` has no face, only free points"),
            1 => format!("`{cloth}` has 1 point of no face, point {first}: it is free"),
            free => {
                format!("`{cloth}` has {free} points of no face, the first is point {first}: they are free")
            }
        };
        let place = self.scene.source.place(self.scene.graph.node(mesh).name());
        let warning = self.findings.warning(&place, message);
        warning
            .help("take them out of the mesh, or hold them by a constraint, if they are not meant to fall");
    }

    /// Says what the builder has refused, where it can be mended.
    pub(super) fn refuse(&mut self, object: NodeId, mesh: NodeId, error: &BuildError) -> Option<()> {
        let [object, mesh] = [object, mesh].map(|id| self.scene.graph.node(id).name());
        let place = match error {
            BuildError::BadMass { .. } => format!("{object}.pointMass"),
            _ => mesh.to_owned(),
        };
        let place = self.scene.source.place(&place);
        let message = match error {
            BuildError::BadMass { mass } => {
                format!("`pointMass` of `{object}` must be above 0, found {mass}")
            }
            error => format!("`{object}` cannot be made from `{mesh}`: {error}"),
        };
        self.findings.error(&place, message);
        None
    }

    /// The cloth of a node.
    pub(super) fn cloth_of(&self, node: NodeId) -> Option<ClothId> {
        let k = self.whole.cloths.iter().position(|cloth| cloth.node == node)?;
        Some(ClothId(k as u32))
    }
}

/// Area of a surface in the square of its unit.
fn area(surface: &Surface) -> f64 {
    let point = |corner: u32| surface.positions[corner as usize];
    let double = |[a, b, c]: [u32; 3]| (point(b) - point(a)).cross(&(point(c) - point(a))).norm();
    surface.faces.triangles().map(double).sum::<f64>() / 2.0
}
