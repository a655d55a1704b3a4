//! The steps of an import: choose nodes, build meshes, set values, place, connect.

use std::collections::BTreeMap;
use std::path::Path;

use nucleus_graph::attributes::{
    self, Attribute, Choice, NodeType, Value, dyn_base, dynamic_constraint, n_base, n_particle, n_rigid,
    nucleus, transform,
};
use nucleus_graph::graph::{Graph, NodeId as OwnId, Setting};

use crate::animation::Evaluator;
use crate::omissions::{Cause, Omissions};
use crate::scene::{ANY, MayaScene, NodeId};

use super::kept::{Kept, KeptNodes, MARK_AUTOMATIC};
use super::options::BorrowedOptions;
use super::plan::{Elements, Plan};

/// Carries the nodes of a Maya scene over into a graph.
pub(crate) struct Importer<'s> {
    pub(super) scene: &'s MayaScene,
    pub(super) values: Evaluator<'s>,
    pub(super) options: BorrowedOptions<'s>,
    pub(super) graph: Graph,
    pub(super) kept: KeptNodes,
    own: BTreeMap<usize, OwnId>,
    /// The elements of our mesh nodes, as far as they are known.
    elements: BTreeMap<OwnId, Elements>,
    /// First and last frame of the scene.
    pub(super) frames: [i64; 2],
    /// Whether this crate has written the file.
    pub(super) is_own: bool,
    pub(super) omissions: Omissions,
}

/// The result of an import.
pub(crate) struct Carried {
    pub(crate) graph: Graph,
    pub(crate) frames: [i64; 2],
    pub(crate) omissions: Omissions,
}

impl<'s> Importer<'s> {
    pub(crate) fn new(scene: &'s MayaScene, is_own: bool, options: BorrowedOptions<'s>) -> Self {
        let mut omissions = Omissions::default();
        let kept = KeptNodes::of(scene, is_own, &mut omissions);
        let frames = frames(scene, &kept, is_own);
        Self {
            scene,
            values: Evaluator::new(scene),
            options,
            graph: Graph::new(),
            kept,
            own: BTreeMap::new(),
            elements: BTreeMap::new(),
            frames,
            is_own,
            omissions,
        }
    }

    /// Carries everything over.
    ///
    /// # Errors
    /// When a file of a mesh or a cache cannot be written.
    pub(crate) fn run(mut self) -> Result<Carried, String> {
        let all = self.kept.all.clone();
        let mut plans: BTreeMap<usize, Plan> = BTreeMap::new();
        for (index, kept) in all.iter().enumerate().filter(|(_, kept)| self.is_mesh(kept)) {
            plans.insert(index, self.plan(kept.node, &kept.name));
        }
        let missing = self.without_mesh(&all, &plans);
        for (index, kept) in all.iter().enumerate().filter(|(index, _)| !missing.contains(index)) {
            let node_type = match plans.get(&index) {
                Some(Plan::Primitive(_, node_type)) => *node_type,
                Some(_) => &attributes::mesh::MESH,
                None => kept.node_type.unwrap_or(&transform::TRANSFORM),
            };
            match self.graph.add(&kept.name, node_type) {
                Ok(id) => {
                    self.own.insert(index, id);
                }
                Err(error) => self.omissions.add(&*kept.name, Cause::Connection(error.to_string())),
            }
        }
        let present: Vec<(usize, OwnId)> = self.own.iter().map(|(index, id)| (*index, *id)).collect();
        for (index, id) in &present {
            if self.graph.node(*id).node_type().is_a(&transform::TRANSFORM) {
                self.place(all[*index].transform.unwrap_or(all[*index].node), *id);
            }
        }
        for (index, id) in &present {
            let plan = plans.remove(index);
            if let Some(elements) = plan.as_ref().and_then(|plan| plan.elements(self.scene)) {
                self.elements.insert(*id, elements);
            }
            self.fill_node(&all[*index], *id, plan)?;
        }
        self.connect(&all, &present)?;
        Ok(Carried { graph: self.graph, frames: self.frames, omissions: self.omissions })
    }

    /// The settings of the only node of a scene, which is part of nothing.
    pub(crate) fn lone_node(
        mut self,
        node_type: &'static NodeType,
    ) -> (Vec<(&'static Attribute, Setting)>, Omissions) {
        self.omissions = Omissions::default();
        let node = self.scene.of_kind(node_type.name).next();
        if let (Some(from), Ok(to)) = (node, self.graph.add("preset", node_type)) {
            self.set_values(from, to, node_type);
            let settings = self.graph.node(to).settings().iter();
            let rows =
                settings.filter_map(|(name, setting)| Some((node_type.attribute(name)?, setting.clone())));
            return (rows.collect(), self.omissions);
        }
        (Vec::new(), self.omissions)
    }

    fn fill_node(&mut self, kept: &Kept, id: OwnId, plan: Option<Plan>) -> Result<(), String> {
        let node_type = self.graph.node(id).node_type();
        if let Some(plan) = plan {
            if self.is_own {
                self.set_given(kept.node, id, node_type);
            }
            return self.fill(kept.node, id, plan);
        }
        if node_type == &transform::TRANSFORM {
            return Ok(());
        }
        if node_type == &attributes::camera::CAMERA {
            self.set_given(kept.node, id, node_type);
            self.set_camera(kept.node, id);
            return Ok(());
        }
        self.set_values(kept.node, id, node_type);
        self.apply_preset(id);
        if node_type == &nucleus::NUCLEUS {
            self.set_nucleus(kept.node, id);
        }
        if node_type.is_a(&n_base::N_BASE) {
            self.set_creation_values(kept.node, id, node_type);
        }
        if node_type.is_a(&n_particle::N_PARTICLE) && !self.is_own {
            self.place_particles(kept.node, id);
            self.set_events(kept.node, id);
            self.report_expressions(kept.node, id);
        }
        Ok(())
    }

    /// The preset that a Nucleus scene names.
    fn apply_preset(&mut self, id: OwnId) {
        let node = self.graph.node(id);
        let Some(Setting::Fixed(Value::Text(name))) = node.settings().get(n_base::PRESET.row.name) else {
            return;
        };
        let name = name.clone();
        let preset = nucleus_graph::scene::presets().into_iter().find(|preset| preset.name == name);
        let applied = preset.is_some_and(|preset| self.graph.apply_preset(id, &preset.settings).is_ok());
        if !applied {
            let what = self.graph.node(id).name().to_owned();
            self.omissions.add(what, Cause::Value(format!("there is no preset `{name}`")));
        }
    }

    fn connect(&mut self, all: &[Kept], present: &[(usize, OwnId)]) -> Result<(), String> {
        let of = |importer: &Self, base: &'static NodeType| -> Vec<(NodeId, OwnId)> {
            let is = |id: &OwnId| importer.graph.node(*id).node_type().is_a(base);
            present.iter().filter(|(_, id)| is(id)).map(|(index, id)| (all[*index].node, *id)).collect()
        };
        of(self, &n_base::N_BASE).into_iter().for_each(|(from, to)| self.connect_object(from, to));
        of(self, &n_base::N_BASE).into_iter().for_each(|(_, to)| self.drop_other_lengths(to));
        let constraints = of(self, &dynamic_constraint::DYNAMIC_CONSTRAINT);
        self.connect_constraints(&constraints);
        of(self, &dyn_base::DYN_BASE).into_iter().for_each(|(from, to)| self.connect_effect(from, to));
        self.connect_the_rest();
        let objects = of(self, &n_base::N_BASE);
        self.report_unjoined(&objects);
        self.play_caches(&objects)
    }

    /// The number of points of an object, as far as it is known.
    pub(super) fn points_of(&self, object: OwnId) -> Option<usize> {
        let node = self.graph.node(object);
        if node.node_type().is_a(&n_particle::N_PARTICLE) {
            let lists = [&n_particle::POSITION0, &n_particle::POSITION];
            return lists.iter().find_map(|key| match node.setting(key) {
                Some(Setting::Fixed(Value::Vectors(all))) => Some(all.len()),
                _ => None,
            });
        }
        self.mesh_elements(object).map(|elements| elements.points)
    }

    /// The elements of the mesh of an object.
    pub(super) fn mesh_elements(&self, object: OwnId) -> Option<&Elements> {
        self.elements.get(&self.graph.source(object, &n_base::INPUT_MESH)?)
    }

    /// Drops maps and initial states that have another number of points than the mesh: they are left from an older one.
    fn drop_other_lengths(&mut self, object: OwnId) {
        let Some(points) = self.points_of(object).filter(|_| !self.is_own) else { return };
        let node = self.graph.node(object);
        let has_other_length = |(name, setting): (&&'static str, &Setting)| {
            let length = match setting {
                Setting::Fixed(Value::Floats(all)) if name.ends_with("PerVertex") => all.len(),
                Setting::Fixed(Value::Vectors(all)) if name.starts_with("start") => all.len(),
                _ => return None,
            };
            (length != points).then_some((*name, length))
        };
        let found: Vec<(&'static str, usize)> = node.settings().iter().filter_map(has_other_length).collect();
        let (name, node_type) = (node.name().to_owned(), node.node_type());
        for (row, length) in
            found.into_iter().filter_map(|(row, length)| Some((node_type.attribute(row)?, length)))
        {
            self.graph.unset(object, row);
            let why = format!("it has {length} values, and the mesh {points} points");
            self.omissions.add(format!("{name}.{}", row.name), Cause::Value(why));
        }
    }

    /// Our node for a shape or a transform.
    pub(super) fn own_of(&self, node: NodeId) -> Option<OwnId> {
        self.own.get(self.kept.by_node.get(&node)?).copied()
    }

    pub(super) fn is_mesh(&self, kept: &Kept) -> bool {
        let is_source = |wire: crate::scene::Wire| {
            matches!(self.scene.path(wire.to).last().name, "imsh" | "inputMesh" | "rsmh" | "restShapeMesh")
        };
        self.scene.kind(kept.node) == "mesh" || self.scene.leaving(kept.node).any(is_source)
    }

    /// Meshes that cannot be built, and objects that have none for it.
    fn without_mesh(&mut self, all: &[Kept], plans: &BTreeMap<usize, Plan>) -> Vec<usize> {
        let mut missing = Vec::new();
        for (index, plan) in plans {
            if let Plan::Missing(why) = plan {
                self.report_missing(&all[*index].name, why);
                missing.push(*index);
            }
        }
        for (index, kept) in all.iter().enumerate() {
            if !matches!(self.scene.kind(kept.node), "nCloth" | "nRigid") {
                continue;
            }
            let source = self.scene.source(kept.node, &["imsh", "inputMesh"], None);
            let mesh = source.and_then(|wire| self.kept.by_node.get(&wire.from.node));
            match mesh {
                Some(mesh) if !missing.contains(mesh) => {}
                Some(mesh) => {
                    let why = format!("`{}` cannot be built", all[*mesh].name);
                    self.report_missing(&kept.name, &why);
                    missing.push(index);
                }
                None => {
                    self.report_missing(&kept.name, "no mesh is connected to it");
                    missing.push(index);
                }
            }
        }
        missing
    }

    /// Sets the values of a node of which only some have a row: a primitive, a mesh.
    pub(super) fn set_given(&mut self, from: NodeId, to: OwnId, node_type: &'static NodeType) {
        let before = self.omissions.clone();
        self.set_values(from, to, node_type);
        let noted = std::mem::replace(&mut self.omissions, before);
        noted.iter().filter(|(_, cause)| !matches!(cause, Cause::Unused(_) | Cause::Unknown(_))).for_each(
            |(what, cause)| {
                self.omissions.add(what, cause.clone());
            },
        );
    }

    /// The film back is one attribute of two numbers in a file.
    fn set_camera(&mut self, from: NodeId, to: OwnId) {
        use attributes::camera::{HORIZONTAL_FILM_APERTURE, VERTICAL_FILM_APERTURE};
        let Some(values) = self.scene.value(from, &["cap", "cameraAperture"]) else { return };
        let rows = [&HORIZONTAL_FILM_APERTURE.row, &VERTICAL_FILM_APERTURE.row];
        for (row, x) in rows.into_iter().zip(values.numbers()) {
            self.set(to, row, Setting::Fixed(Value::Float(x)));
        }
    }

    /// The model of resistances, and the start frame. Resistances of Maya are counts of iterations.
    fn set_nucleus(&mut self, from: NodeId, to: OwnId) {
        let row = &nucleus::RESISTANCE_MODEL.row;
        if !self.is_own && !self.options.physical {
            self.set(to, row, Setting::Fixed(Value::Choice(Choice(0))));
            // The original reads speeds for lift in scene units; where a unit is a metre that is the same.
            if self.graph.node(to).get(&nucleus::SPACE_SCALE) != 1.0 {
                let row = &nucleus::LIFT_IN_SCENE_UNITS.row;
                self.set(to, row, Setting::Fixed(Value::Bool(true)));
            }
        }
        let stored = self.scene.stored(from, &["stf", "startFrame"]);
        let is_automatic = self.is_own && {
            let marks = self.scene.string(from, &[MARK_AUTOMATIC]).unwrap_or_default();
            marks.split(' ').any(|mark| mark == nucleus::START_FRAME.row.name)
        };
        let frame = stored.unwrap_or(1.0);
        if !is_automatic && (frame != self.frames[0] as f64 || (self.is_own && stored.is_some())) {
            self.set(to, &nucleus::START_FRAME.row, Setting::Fixed(Value::Float(frame)));
        }
    }

    /// Ours computes these where they are left out; in a file of Maya's, left out means the default of the node.
    fn set_creation_values(&mut self, from: NodeId, to: OwnId, node_type: &'static NodeType) {
        if self.is_own || self.scene.kind(from) == "nParticle" {
            return;
        }
        let rows = ["thickness", "pushOutRadius", "selfCollisionFlag", "selfCollideWidthScale"];
        for row in rows.iter().filter_map(|name| node_type.attribute(name)) {
            let is_used = node_type != &n_rigid::N_RIGID || matches!(row.name, "thickness");
            let is_given =
                self.scene.assigned(from, ANY).any(|set| [row.name, row.short].contains(&set.segment.name));
            if let (true, false, Some(default)) = (is_used, is_given, &row.default) {
                self.set(to, row, Setting::from(default.clone()));
            }
        }
    }

    /// Objects without a nucleus are not simulated, as in Maya.
    fn report_unjoined(&mut self, objects: &[(NodeId, OwnId)]) {
        for (from, to) in objects {
            if !self.is_joined(*to) && !self.is_own {
                self.omissions.add(self.scene.name(*from), Cause::NoNucleus);
            }
        }
    }

    /// A file that a scene names, as an absolute path; `None` if it is not there or is no picture that is read.
    pub(super) fn locate(&self, path: &str) -> Option<String> {
        if self.is_own {
            return Some(path.to_owned());
        }
        if !path.to_ascii_lowercase().ends_with(".png") {
            return None;
        }
        let folder = self.scene.texts.first()?.path.parent().unwrap_or(Path::new(""));
        let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
        let found = [folder.join(path), folder.join(name), folder.join("sourceimages").join(name)];
        let found = found.into_iter().find(|file| file.is_file())?.canonicalize().ok()?;
        Some(found.to_str()?.to_owned())
    }
}

/// The frames of the scene: the playback range, from the first start frame of a nucleus.
fn frames(scene: &MayaScene, kept: &KeptNodes, is_own: bool) -> [i64; 2] {
    let whole = |x: f64| x.clamp(-1e6, 1e6).round() as i64;
    let [first, last] = scene.playback.unwrap_or([1.0, 120.0]).map(whole);
    let nuclei = kept.all.iter().filter(|kept| scene.kind(kept.node) == "nucleus");
    let start = nuclei.map(|kept| whole(scene.stored_or(kept.node, &["stf", "startFrame"], 1.0))).min();
    let start = if is_own { first } else { start.unwrap_or(first) };
    [start, last.max(if is_own { start } else { start + 1 })]
}
