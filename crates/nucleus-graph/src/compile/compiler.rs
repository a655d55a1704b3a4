//! State of compiling one nucleus, and the checks and messages that all kinds of objects share.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::{BuildError, ClothId, Faces, ModelBuilder};

use crate::attributes::{Attribute, Key, NodeType, Plugged, nucleus};
use crate::diagnostic::Findings;
use crate::files;
use crate::graph::{EvalContext, NodeId};
use crate::memory::{self, Cost, Size};
use crate::mesh::read_obj_points;
use crate::paint::read_vectors;
use crate::scene::document::Scene;

use super::geometry::Geometry;
use super::program::{NucleusProgram, Object, ObjectKind};
use super::units::{self, Units};

/// Compiles one nucleus with its objects and constraints.
pub(super) struct Compiler<'a> {
    pub(super) scene: &'a Scene,
    pub(super) broken: &'a BTreeSet<NodeId>,
    pub(super) findings: &'a mut Findings,
    pub(super) geometry: &'a mut Geometry,
    /// The graph at the start frame.
    pub(super) start: EvalContext<'a>,
    pub(super) program: NucleusProgram,
    pub(super) objects: Vec<Object>,
    /// Total mass of the cloths in kilograms.
    pub(super) mass: f64,
    /// Lower and upper corner of the bounding box of all objects at the start frame, in scene units.
    pub(super) bounds: Option<[Vector3<f64>; 2]>,
    /// The objects of particles, each with its node.
    pub(super) particle_ids: Vec<(NodeId, ClothId)>,
}

/// A compiled nucleus.
pub(super) struct CompiledNucleus {
    pub(super) program: NucleusProgram,
    pub(super) objects: Vec<Object>,
    /// Total mass of the cloths in kilograms.
    pub(super) mass: f64,
}

impl<'a> Compiler<'a> {
    /// `broken` nodes could not be read completely: nothing is reported about them. `previous` is the nucleus that
    /// was compiled before this one; object ids are numbered on from it.
    pub(super) fn new(
        scene: &'a Scene,
        nucleus: NodeId,
        broken: &'a BTreeSet<NodeId>,
        geometry: &'a mut Geometry,
        previous: Option<&NucleusProgram>,
        findings: &'a mut Findings,
    ) -> Self {
        let first = units::start_frame(scene, nucleus, findings);
        let start = scene.graph.at(first as f64);
        let program = NucleusProgram {
            node: nucleus,
            units: Units::new(start.get(nucleus, &nucleus::SPACE_SCALE)),
            model: ModelBuilder::new(),
            cloths: Vec::new(),
            colliders: Vec::new(),
            attachments: Vec::new(),
            constraints: Vec::new(),
            selections: Vec::new(),
            emitters: Vec::new(),
            fields: Vec::new(),
            start: first,
            start_time: units::start_time(scene, nucleus, first),
            first_cloth: previous.map_or(0, |previous| previous.cloths().end),
            first_collider: previous.map_or(0, |previous| previous.colliders().end),
        };
        Self {
            scene,
            broken,
            findings,
            geometry,
            start,
            program,
            objects: Vec::new(),
            mass: 0.0,
            bounds: None,
            particle_ids: Vec::new(),
        }
    }

    /// The nodes connected to an input of the nucleus, in the order of its elements. Reports nodes of other types
    /// than `wanted`.
    pub(super) fn members(&mut self, input: &Key<Plugged>, wanted: &[&'static NodeType]) -> Vec<NodeId> {
        let graph = &self.scene.graph;
        let mut members = Vec::new();
        for (index, plug) in graph.elements(self.program.node, input) {
            let (node, node_type) = (graph.node(plug.node), graph.node(plug.node).node_type());
            let is_wanted = wanted.iter().any(|wanted| node_type.is_a(wanted));
            if is_wanted && !members.contains(&plug.node) {
                members.push(plug.node);
            } else if !is_wanted {
                let place = self.scene.source.place(node.name());
                let input = format!("{}.{}[{index}]", graph.node(self.program.node).name(), input.row.name);
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

    /// Warns of inputs without a connection, where Maya would not solve the object.
    pub(super) fn check_inputs(&mut self, object: NodeId, inputs: &[&str]) {
        let graph = &self.scene.graph;
        for input in inputs {
            let is_connected = graph.arriving(object).any(|wire| wire.to.attribute.name == *input);
            if !is_connected {
                let name = graph.node(object).name();
                let message = format!("nothing is connected to `{name}.{input}`");
                self.findings.warning(&self.scene.source.place(name), message);
            }
        }
    }

    /// Reserves the memory of an object; reports an error if the limit is exceeded.
    pub(super) fn claim(&mut self, object: NodeId, mesh: NodeId, size: Size, cost: Cost) -> Option<()> {
        self.claim_bytes([object, mesh], &format!("of {} points", size.points), cost.of(size))
    }

    /// Claims memory for an object from a mesh; `what` describes it. `None` if it would exceed the limit, which is reported.
    pub(super) fn claim_bytes(&mut self, [object, mesh]: [NodeId; 2], what: &str, bytes: u64) -> Option<()> {
        let Err(refused) = self.geometry.budget.claim(bytes) else { return Some(()) };
        if !refused.is_first {
            return None;
        }
        let [object, mesh] = [object, mesh].map(|id| self.scene.graph.node(id).name());
        let message = format!("`{object}`, {what}, takes {refused}");
        let error = self.findings.error(&self.scene.source.place(mesh), message);
        error.help(refused.help(&format!("make `{mesh}` coarser")));
        None
    }

    /// Checks a file's size against the memory limit before it is read. `cost` is bytes of memory per byte of the file.
    pub(super) fn check_file(&self, path: &Path, cost: u64) -> Result<(), String> {
        let bytes = files::length(path).saturating_mul(cost);
        let checked = self.geometry.budget.check(bytes);
        checked.map_err(|refused| format!("to read `{}` takes {refused}", path.display()))
    }

    /// The points of an OBJ file, or the vectors of a file of numbers; else the reason why it cannot be read.
    pub(super) fn vectors_of_file(&self, file: &str) -> Result<Vec<[f64; 3]>, String> {
        let path = self.scene.source.path(file);
        self.check_file(&path, memory::NUMBER_BYTE)?;
        if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("obj")) {
            let points = read_obj_points(path).map_err(|error| error.to_string())?;
            return Ok(points.into_iter().map(Into::into).collect());
        }
        read_vectors(&path).map_err(|error| error.to_string())
    }

    /// Adds an object to the program, and its mass in kilograms to the total.
    pub(super) fn add_object(
        &mut self,
        node: NodeId,
        kind: ObjectKind,
        points: usize,
        faces: Faces,
        mass: f64,
    ) {
        self.mass += mass;
        let name = self.scene.graph.node(node).name().to_owned();
        self.objects.push(Object {
            name,
            kind,
            points,
            mesh_points: points,
            faces,
            radius: None,
            surface: [0.1, 1.0],
            rest_distance: None,
            varies: false,
        });
    }

    /// Reports an object that the model builder refuses, at the attribute or mesh that causes it.
    pub(super) fn report_refused(&mut self, object: NodeId, mesh: NodeId, error: &BuildError) -> Option<()> {
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
            BuildError::NoPoints if object == mesh => {
                format!("`{object}` has no particles, as none of its emitters can be used")
            }
            error => format!("`{object}` cannot be made from `{mesh}`: {error}"),
        };
        self.findings.error(&place, message);
        None
    }

    /// The place of an attribute in the scene file.
    pub(super) fn place(&self, node: NodeId, row: &Attribute) -> Range<usize> {
        self.scene.source.place(&format!("{}.{}", self.scene.graph.node(node).name(), row.name))
    }

    /// The cloth that a node was compiled to.
    pub(super) fn cloth_of(&self, node: NodeId) -> Option<ClothId> {
        let k = self.program.cloths.iter().position(|cloth| cloth.node == node)?;
        Some(ClothId(k as u32))
    }
}
