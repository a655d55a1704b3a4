//! Objects: from nodes to what the model is built of.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{BuildError, Cloth, ClothId, Collider, Faces, Mass, ModelBuilder, Surface};

use crate::attributes::{Choice, Key, Plugged, n_base, n_cloth, nucleus};
use crate::graph::NodeId;
use crate::scene::{Findings, Scene, TimeSpan};

use super::geometry::Geometry;
use super::lists::lists;
use super::program::{Object, ObjectKind, Program};
use super::thickness::{CLOTH_SHARE, COLLIDER_SHARE, default_thickness, is_dense};
use super::units::Units;

/// `resistanceModel: classic`.
pub(super) const CLASSIC: Choice = Choice(0);

/// Where the frames of a cloth come from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClothSource {
    pub(super) node: NodeId,
    /// In scene units.
    pub(super) default_thickness: f64,
    /// Whether its edges limit that.
    pub(super) is_dense: bool,
    /// In metres, world space.
    pub(super) start: Vec<Vector3<f64>>,
}

/// Where the frames of a collider come from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColliderSource {
    pub(super) node: NodeId,
    pub(super) mesh: NodeId,
    /// In scene units.
    pub(super) default_thickness: f64,
    /// Its points in the space of the mesh, in scene units; empty if it never moves.
    pub(super) local: Vec<Vector3<f64>>,
}

/// Compiles one scene.
pub(super) struct Compiler<'a> {
    pub(super) scene: &'a Scene,
    broken: &'a BTreeSet<NodeId>,
    pub(super) findings: &'a mut Findings,
    nucleus: Option<NodeId>,
    pub(super) units: Units,
    /// Frames that are solved.
    pub(super) time: TimeSpan,
    geometry: Geometry,
    model: ModelBuilder,
    pub(super) cloths: Vec<ClothSource>,
    colliders: Vec<ColliderSource>,
    objects: Vec<Object>,
    mass: f64,
}

impl<'a> Compiler<'a> {
    /// `broken` are nodes of which not everything is known; nothing is said about them.
    pub(super) fn new(scene: &'a Scene, broken: &'a BTreeSet<NodeId>, findings: &'a mut Findings) -> Self {
        let nucleus = scene.graph.of_type(&nucleus::NUCLEUS).next();
        let units = Units::new(nucleus.map_or(1.0, |(_, node)| node.get(&nucleus::SPACE_SCALE)));
        Self {
            scene,
            broken,
            findings,
            nucleus: nucleus.map(|(id, _)| id),
            units,
            time: scene.time,
            geometry: Geometry::default(),
            model: ModelBuilder::new(),
            cloths: Vec::new(),
            colliders: Vec::new(),
            objects: Vec::new(),
            mass: 0.0,
        }
    }

    /// The program, if there is a nucleus. It is only whole if no errors were found.
    pub(super) fn program(mut self) -> Option<Program> {
        let Some(nucleus) = self.nucleus else {
            let error = self.findings.error(&(0..0), "there is nothing to solve: the scene has no nucleus");
            error.help("add `\"nucleus1\": nucleus()`");
            return None;
        };
        self.objects();
        let pins = self.pins();
        Some(Program {
            graph: self.scene.graph.clone(),
            nucleus,
            units: self.units,
            time: self.time,
            record: self.scene.record,
            checks: self.scene.checks.clone(),
            model: self.model,
            cloths: self.cloths,
            colliders: self.colliders,
            pins,
            objects: self.objects,
            mass: self.mass,
            warnings: Vec::new(),
        })
    }

    /// All objects of the nucleus; those that are broken, or made from something broken, are left out.
    pub(super) fn objects(&mut self) {
        self.start();
        for cloth in self.members(&nucleus::INPUT_ACTIVE) {
            self.cloth(cloth);
        }
        for collider in self.members(&nucleus::INPUT_PASSIVE) {
            self.collider(collider);
        }
        self.check_pinned_points();
    }

    /// The run begins where the scene's time and, if it says so, the nucleus have begun.
    fn start(&mut self) {
        let Some(node) = self.nucleus.map(|id| self.scene.graph.node(id)) else { return };
        if node.setting(&nucleus::START_FRAME).is_none() {
            return;
        }
        let start_frame = node.get(&nucleus::START_FRAME);
        let place = self.scene.source.place(&format!("{}.startFrame", node.name()));
        let TimeSpan { start, end, .. } = self.scene.time;
        if start_frame > end as f64 {
            let message = format!("`startFrame` of `{}` comes after the last frame, {end}", node.name());
            self.findings.error(&place, message);
        } else if start_frame > start as f64 {
            self.time.start = start_frame.ceil() as i64;
        } else if start_frame < start as f64 {
            let message = format!("frames before {start}, where the scene's time begins, are not solved");
            self.findings.warning(&place, message);
        }
    }

    /// What is connected to an input of the nucleus, in the order of its elements.
    fn members(&self, input: &Key<Plugged>) -> Vec<NodeId> {
        let wired = self.scene.graph.connections().iter();
        let wired =
            wired.filter(|c| Some(c.to.node) == self.nucleus && c.to.attribute.name == input.row.name);
        let mut members: Vec<_> = wired.map(|c| (c.to.index, c.from.node)).collect();
        members.sort_unstable();
        members.into_iter().map(|(_, node)| node).filter(|node| !self.broken.contains(node)).collect()
    }

    fn cloth(&mut self, id: NodeId) -> Option<()> {
        let graph = &self.scene.graph;
        let (node, nucleus) = (graph.node(id), graph.node(self.nucleus?));
        let (mesh, surface) = self.world_surface(id)?;
        let default_thickness = default_thickness(&surface, CLOTH_SHARE);
        let is_dense = is_dense(&surface, CLOTH_SHARE);
        let surface = self.units.surface(surface);
        self.warn_of_stiffness(id);
        let point_mass = node.get(&n_base::POINT_MASS);
        let mass = match nucleus.get(&nucleus::RESISTANCE_MODEL) {
            CLASSIC => Mass::PerPoint(point_mass),
            _ => Mass::PerArea(point_mass),
        };
        self.warn_of_free_points(node.name(), mesh, &surface);
        let start = surface.positions.clone();
        let faces = surface.faces.clone();
        let kilograms = match mass {
            Mass::PerPoint(mass) => mass * start.len() as f64,
            Mass::PerArea(mass) => mass * area(&surface),
        };
        match self.model.cloth(Cloth { surface, mass, lists: lists(node, nucleus) }) {
            Ok(cloth) => {
                self.mass_and_object(node.name(), ObjectKind::Cloth(cloth), start.len(), faces, kilograms)
            }
            Err(error) => return self.refuse(id, mesh, &error),
        }
        self.cloths.push(ClothSource { node: id, default_thickness, is_dense, start });
        Some(())
    }

    /// A stiffness means nothing where resistances are counts.
    fn warn_of_stiffness(&mut self, cloth: NodeId) {
        use n_cloth::{BEND_STIFFNESS, COMPRESSION_STIFFNESS, SHEAR_STIFFNESS, STRETCH_STIFFNESS};
        let node = self.scene.graph.node(cloth);
        let nucleus = self.nucleus.map(|id| self.scene.graph.node(id));
        if nucleus.is_none_or(|nucleus| nucleus.get(&nucleus::RESISTANCE_MODEL) != CLASSIC) {
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

    fn collider(&mut self, id: NodeId) -> Option<()> {
        let (mesh, surface) = self.world_surface(id)?;
        let default_thickness = default_thickness(&surface, COLLIDER_SHARE);
        let moves = self.scene.graph.moves(mesh);
        let local = self.geometry.surface(self.scene, mesh, self.findings)?;
        let local = if moves { local.positions.clone() } else { Vec::new() };
        let surface = self.units.surface(surface);
        let (points, faces) = (surface.positions.len(), surface.faces.clone());
        let name = self.scene.graph.node(id).name();
        match self.model.collider(Collider { surface }) {
            Ok(collider) => self.mass_and_object(name, ObjectKind::Collider(collider), points, faces, 0.0),
            Err(error) => return self.refuse(id, mesh, &error),
        }
        self.colliders.push(ColliderSource { node: id, mesh, default_thickness, local });
        Some(())
    }

    /// The mesh that an object is made from, where it stands at the start; lengths in scene units.
    fn world_surface(&mut self, object: NodeId) -> Option<(NodeId, Surface)> {
        let graph = &self.scene.graph;
        let mesh = graph.source(object, &n_base::INPUT_MESH)?;
        if self.broken.contains(&mesh) {
            return None;
        }
        let placement = graph.placement(mesh, self.time.start as f64);
        let mut surface = self.geometry.surface(self.scene, mesh, self.findings)?.clone();
        for position in &mut surface.positions {
            *position = placement.point(*position);
        }
        Some((mesh, surface))
    }

    fn mass_and_object(&mut self, name: &str, kind: ObjectKind, points: usize, faces: Faces, kilograms: f64) {
        self.mass += kilograms;
        self.objects.push(Object { name: name.to_owned(), kind, points, faces });
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
    fn refuse(&mut self, object: NodeId, mesh: NodeId, error: &BuildError) -> Option<()> {
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

    /// The cloth of this name.
    pub(super) fn cloth_named(&self, name: &str) -> Option<(ClothId, &ClothSource)> {
        let node = self.scene.graph.find(name)?;
        let k = self.cloths.iter().position(|cloth| cloth.node == node)?;
        Some((ClothId(k as u32), &self.cloths[k]))
    }
}

/// Area of a surface in the square of its unit.
fn area(surface: &Surface) -> f64 {
    let point = |corner: u32| surface.positions[corner as usize];
    let double = |[a, b, c]: [u32; 3]| (point(b) - point(a)).cross(&(point(c) - point(a))).norm();
    surface.faces.triangles().map(double).sum::<f64>() / 2.0
}
