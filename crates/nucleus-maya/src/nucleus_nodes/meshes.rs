//! Meshes as Nucleus nodes: a primitive where it is one, else an OBJ file, or one for each frame.

use nucleus_graph::attributes::{self, Attribute, Value, mesh};
use nucleus_graph::graph::{NodeId as OwnId, Setting};

use crate::mesh::{Built, obj_text};
use crate::omissions::Cause;
use crate::scene::NodeId;

use super::importer::Importer;
use super::kept::Kept;
use super::plan::Plan;

impl Importer<'_> {
    /// Refuses a mesh of the artist that no node takes.
    ///
    /// # Errors
    /// With the names that there are.
    pub(crate) fn check_given(&self) -> Result<(), String> {
        let meshes: Vec<&Kept> = self.kept.all.iter().filter(|kept| self.is_mesh(kept)).collect();
        let is_taken =
            |name: &str| meshes.iter().any(|kept| self.mesh_names(kept.node, &kept.name).contains(&name));
        match self.options.meshes.iter().find(|(name, _)| !is_taken(name)) {
            None => Ok(()),
            Some((name, _)) => Err(unknown_mesh(name, meshes.iter().map(|kept| kept.name.as_str()))),
        }
    }

    /// The names by which an artist gives a mesh: that of our node, and that of the shape.
    fn mesh_names<'a>(&'a self, id: NodeId, name: &'a str) -> [&'a str; 2] {
        [name, self.scene.name(id)]
    }

    /// Decides how a mesh is imported; `name` is that of our node.
    pub(super) fn plan(&self, id: NodeId, name: &str) -> Plan {
        let scene = self.scene;
        let names = self.mesh_names(id, name);
        if let Some((_, path)) = self.options.meshes.iter().find(|(given, _)| names.contains(&given.as_str()))
        {
            return match std::fs::read_to_string(path) {
                Ok(text) => Plan::Given(text, path.clone()),
                Err(error) => Plan::Missing(format!("`{}` cannot be read: {error}", path.display())),
            };
        }
        if self.is_own
            && let Some(file) = scene.string(id, &[mesh::FILE.row.name])
            && scene.node(id).added.iter().any(|(long, _)| **long == *mesh::FILE.row.name)
        {
            return self.own_mesh(id, file);
        }
        if let Some(plan) = self.own_primitive(id) {
            return plan;
        }
        let start = self.frames[0] as f64;
        let built = match scene.kind(id) {
            "mesh" => self.values.mesh(id, start),
            // The history flows into the object without a shape between.
            _ => match self.history_output(id) {
                Some(plug) => self.values.mesh_from(plug, start),
                None => Err(format!("{} is not built", scene.kind(id))),
            },
        };
        match built {
            Ok(built) if built.mesh.face_count() == 0 => Plan::Missing("it has no face".to_owned()),
            Ok(built) => Plan::Built(built),
            Err(why) => Plan::Missing(why),
        }
    }

    /// The mesh file of a Nucleus scene; where it is not beside the new scene, the mesh in the Maya scene.
    fn own_mesh(&self, id: NodeId, file: String) -> Plan {
        // Of files for each frame, the first that is needed.
        let first = match file.matches('#').count() {
            0 => file.clone(),
            digits => file.replacen(&"#".repeat(digits), &format!("{:0digits$}", self.frames[0]), 1),
        };
        if self.options.target.join(first).is_file() {
            return Plan::File(file);
        }
        match crate::mesh::embedded::stored(self.scene, id) {
            Ok(Some(mesh)) if mesh.face_count() > 0 => Plan::Embedded(mesh, file),
            _ => Plan::File(file),
        }
    }

    /// The Nucleus primitive that a shape shows unchanged.
    fn own_primitive(&self, id: NodeId) -> Option<Plan> {
        let scene = self.scene;
        if scene.units_of(id).centimetres != 1.0 || scene.kind(id) != "mesh" {
            return None;
        }
        let source = scene.source(id, &["i", "inMesh"], None)?.from.node;
        let is_moved = scene.arriving(source).next().is_some();
        let tweaks = scene.array(id, &["pt", "pnts"], 3, &[&["px"], &["py"], &["pz"]]).unwrap_or_default();
        let is_tweaked = tweaks.iter().any(|x| *x != 0.0);
        let upright = crate::mesh::is_own_primitive(scene, source, self.is_own);
        let node_type = attributes::node_type(scene.kind(source))?;
        (upright && !is_moved && !is_tweaked).then_some(Plan::Primitive(source, node_type))
    }

    fn history_output(&self, id: NodeId) -> Option<crate::scene::PlugRef> {
        let inputs = ["imsh", "inputMesh", "rsmh", "restShapeMesh"];
        let feeds = |wire: &crate::scene::Wire| inputs.contains(&self.scene.path(wire.to).last().name);
        self.scene.leaving(id).find(feeds).map(|wire| wire.from)
    }

    /// Gives a mesh node its values, and writes the files that it names.
    pub(super) fn fill(&mut self, id: NodeId, to: OwnId, plan: Plan) -> Result<(), String> {
        let file = |text: String| Setting::Fixed(Value::Text(text));
        let row: &'static Attribute = &mesh::FILE.row;
        let stem = self.file_stem(to);
        match plan {
            Plan::Primitive(source, node_type) => self.set_given(source, to, node_type),
            Plan::File(name) => self.set(to, row, file(name)),
            Plan::Given(text, _) => {
                let name = format!("{stem}.obj");
                (self.options.write)(&name, text)?;
                self.set(to, row, file(name));
            }
            Plan::Built(built) => {
                let name = match built
                    .is_deformed
                    .then(|| self.sequence(id, &stem, &built))
                    .transpose()?
                    .flatten()
                {
                    Some(name) => name,
                    None => {
                        let name = format!("{stem}.obj");
                        (self.options.write)(&name, obj_text(&built.mesh))?;
                        name
                    }
                };
                for (what, cause) in built.omitted {
                    self.omissions.add(what, cause);
                }
                self.set(to, row, file(name));
            }
            Plan::Embedded(mesh, missing) => {
                let name = format!("{stem}.obj");
                (self.options.write)(&name, obj_text(&mesh))?;
                self.omissions.add(self.graph.node(to).name(), Cause::NoMeshFile(missing));
                self.set(to, row, file(name));
            }
            Plan::Missing(_) => {}
        }
        Ok(())
    }

    /// A file for each frame, if the mesh changes; its name with `####` for the frame.
    fn sequence(&mut self, id: NodeId, stem: &str, first: &Built) -> Result<Option<String>, String> {
        let frames: Vec<i64> = crate::animation::Evaluator::sampled(self.frames).collect();
        let at = |importer: &Self, frame: i64| importer.values.mesh(id, frame as f64).map(|built| built.mesh);
        let same_points = |mesh: &crate::mesh::Poly| mesh.points == first.mesh.points;
        if frames.iter().all(|frame| at(self, *frame).is_ok_and(|mesh| same_points(&mesh))) {
            return Ok(None);
        }
        for frame in frames {
            let mesh = at(self, frame)?;
            (self.options.write)(&format!("{stem}.{frame:04}.obj"), obj_text(&mesh))?;
        }
        Ok(Some(format!("{stem}.####.obj")))
    }

    /// The folder and name of the files of a mesh.
    pub(super) fn file_stem(&self, to: OwnId) -> String {
        let name: String = self
            .graph
            .node(to)
            .name()
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        // Names that differ in other characters must not share a file.
        let number = self.graph.iter().take_while(|(id, _)| *id != to).filter(|(_, node)| {
            let other: String =
                node.name().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            other.eq_ignore_ascii_case(&name)
        });
        match number.count() {
            0 => format!("{}/{name}", self.options.folder),
            k => format!("{}/{name}_{}", self.options.folder, k + 1),
        }
    }

    /// Notes that a mesh is missing, and with it an object.
    pub(super) fn report_missing(&mut self, object: &str, why: &str) {
        self.omissions.add(object, Cause::Mesh(why.to_owned()));
    }
}

/// The message for a `--mesh` whose name nothing has.
pub fn unknown_mesh<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<String> = known.map(|name| format!("`{name}`")).collect();
    let hint = match known.is_empty() {
        true => "no mesh is needed".to_owned(),
        false => format!("there is {}", known.join(", ")),
    };
    format!("`--mesh {name}=...` names no mesh that is needed; {hint}")
}
