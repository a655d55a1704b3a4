//! The mesh of a shape at a frame: stored in the file, or built by its history and its deformers.

use crate::animation::{Evaluator, Matrix};
use crate::deform;
use crate::mesh::{Built, History, Poly, embedded, operators, primitives};
use crate::omissions::Cause;
use crate::scene::{NodeId, PlugRef, Wire};

/// Longest history that is followed.
const MAX_DEPTH: usize = 500;

/// Inputs of history nodes.
const INPUTS: [&[&str]; 3] = [&["ip", "inputPolymesh"], &["ig", "inputGeometry"], &["i", "inMesh"]];

/// Further inputs of meshes: of a union, of a blend shape, of a cloth.
const MORE_INPUTS: [&str; 5] = ["inputPoly", "igt", "inputGeomTarget", "imsh", "inputMesh"];

impl Evaluator<'_> {
    /// The mesh of a shape at a frame.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub fn mesh(&self, shape: NodeId, frame: f64) -> Result<Built, String> {
        let mut history = History::default();
        let mesh = self.shape(shape, frame, 0, &mut history);
        history.finish(mesh)
    }

    /// The mesh that flows from a plug: a shape, or a node of a history.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub fn mesh_from(&self, plug: PlugRef, frame: f64) -> Result<Built, String> {
        let mut history = History::default();
        let mesh = self.made_by(plug, frame, 0, &mut history);
        history.finish(mesh)
    }

    fn shape(&self, shape: NodeId, frame: f64, depth: usize, history: &mut History) -> Result<Poly, String> {
        let stored = || embedded::stored(self.scene, shape);
        let mut mesh = match self.scene.source(shape, &["i", "inMesh"], None) {
            None => stored()?.ok_or("the shape stores no points, and no history makes any")?,
            Some(wire) => match self.made_by(wire.from, frame, depth + 1, history) {
                Ok(mesh) => mesh,
                // The file may hold the result of the history, too.
                Err(why) => match stored()? {
                    Some(mesh) => {
                        let how = format!(
                            "its history is not built ({why}); the mesh that the file stores is taken"
                        );
                        history.omitted.push((self.scene.name(shape).to_owned(), Cause::Approximate(how)));
                        mesh
                    }
                    None => return Err(why),
                },
            },
        };
        embedded::add_tweaks(self.scene, shape, &mut mesh);
        Ok(mesh)
    }

    fn made_by(
        &self,
        plug: PlugRef,
        frame: f64,
        depth: usize,
        history: &mut History,
    ) -> Result<Poly, String> {
        if depth > MAX_DEPTH {
            return Err("its history is a cycle, or too long".to_owned());
        }
        let id = plug.node;
        if !self.feeds_several(id) {
            return self.made_anew(id, frame, depth, history);
        }
        if let Some(known) = history.known.get(&id) {
            // A copy has points, too.
            known.iter().try_for_each(|mesh| history.budget.take(mesh.weight()))?;
            return known.clone();
        }
        // A history that leads back to this node finds this.
        history.known.insert(id, Err("its history is a cycle".to_owned()));
        let mut made = self.made_anew(id, frame, depth, history);
        if let Ok(mesh) = &made
            && let Err(why) = history.budget.take(mesh.weight())
        {
            made = Err(why);
        }
        history.known.insert(id, made.clone());
        made
    }

    /// Whether the mesh of a node flows into several inputs.
    fn feeds_several(&self, id: NodeId) -> bool {
        let is_mesh = |wire: &Wire| {
            let name = self.scene.path(wire.to).last().name;
            INPUTS.iter().any(|names| names.contains(&name)) || MORE_INPUTS.contains(&name)
        };
        self.scene.leaving(id).filter(is_mesh).nth(1).is_some()
    }

    fn made_anew(&self, id: NodeId, frame: f64, depth: usize, history: &mut History) -> Result<Poly, String> {
        let scene = self.scene;
        let kind = scene.kind(id);
        if kind == "mesh" {
            return self.shape(id, frame, depth + 1, history);
        }
        let number = |names: &[&str], default| self.number_or(id, names, frame, default);
        if let Some(primitive) = primitives::primitive(scene, id, &number, &mut history.budget) {
            self.note_driven(id, frame, &primitives::is_length, history);
            return primitive;
        }
        if matches!(kind, "polyUnite" | "polyBoolOp" | "polyCBoolOp") {
            if kind != "polyUnite" {
                return Err(format!("{kind} is not carried out"));
            }
            return self.unite(id, frame, depth, history);
        }
        if kind == "nCloth" {
            history.omitted.push((
                scene.name(id).to_owned(),
                Cause::Operator("nCloth as the source of a mesh".to_owned()),
            ));
            let wire = scene.source(id, &["imsh", "inputMesh"], None).ok_or("its cloth has no mesh")?;
            return self.made_by(wire.from, frame, depth + 1, history);
        }
        let input = INPUTS.iter().find_map(|names| scene.source(id, names, None));
        let Some(input) = input else { return Err(format!("{kind} `{}` is not built", scene.name(id))) };
        let mesh = self.made_by(input.from, frame, depth + 1, history)?;
        if deform::is_deformer(kind) {
            history.is_deformed = true;
            let input = |plug, history: &mut History| self.made_by(plug, frame, depth + 1, history);
            return deform::deformed(self, id, frame, mesh, &input, history);
        }
        if !operators::is_passed_over(kind) {
            self.note_driven(id, frame, &|_| false, history);
        }
        Ok(match operators::apply(scene, id, mesh, &mut history.budget)? {
            operators::Operation::Done(mesh) => mesh,
            operators::Operation::Unknown(mesh) => {
                history.omitted.push((scene.name(id).to_owned(), Cause::Operator(kind.to_owned())));
                mesh
            }
        })
    }

    /// Notes the driven numbers of a node of a history: the mesh moves with those that are read at each frame, and the others
    /// are listed.
    fn note_driven(&self, id: NodeId, frame: f64, is_read: &dyn Fn(&str) -> bool, history: &mut History) {
        for wire in self.scene.arriving(id).filter(|wire| self.output(wire.from, frame).is_some()) {
            let name = self.scene.path(wire.to).last().name;
            if is_read(name) {
                history.is_deformed = true;
            } else {
                let what = format!("{}.{name}", self.scene.name(id));
                history.omitted.push((what, Cause::Driven(self.scene.kind(wire.from.node).to_owned())));
            }
        }
    }

    fn unite(&self, id: NodeId, frame: f64, depth: usize, history: &mut History) -> Result<Poly, String> {
        let matrices = self.scene.sources(id, &["im", "inputMat"]);
        let mut parts = Vec::new();
        for (index, wire) in self.scene.sources(id, &["ip", "inputPoly"]) {
            let part = self.made_by(wire.from, frame, depth + 1, history)?;
            history.budget.take(part.weight())?;
            let own = matrices.iter().find(|(k, _)| *k == index);
            let matrix = own.map_or(Matrix::IDENTITY, |(_, wire)| self.world(wire.from.node, frame));
            parts.push((part, matrix));
        }
        if parts.is_empty() {
            Err("polyUnite has no input".to_owned())
        } else {
            Ok(operators::united(&parts))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::ascii::SourceText;
    use crate::mesh::Budget;
    use crate::scene::MayaScene;

    /// The mesh of the node `end`, of a plane of 9 points and 4 faces `n0`, with a budget of points.
    fn built(nodes: &str, points: u64) -> Result<Poly, String> {
        let plane = "createNode polyPlane -n \"n0\"; setAttr \".sw\" 2; setAttr \".sh\" 2;\n";
        let text = format!("//Maya ASCII 2022 scene\n{plane}{nodes}connectAttr \"end.out\" \"shape.i\";\n");
        let scene = MayaScene::of_text(SourceText::from_bytes(Path::new("a.ma"), text.into_bytes()).unwrap())
            .unwrap();
        let mut history = History { budget: Budget::of(points), ..History::default() };
        Evaluator::new(&scene).shape(scene.find("shape").unwrap(), 1.0, 0, &mut history)
    }

    fn operator(kind: &str, values: &str, picked: &str) -> String {
        format!(
            "createNode {kind} -n \"end\"; {values} setAttr \".ics\" -type \"componentList\" 1 \"{picked}[*]\";\n\
             createNode mesh -n \"shape\"; connectAttr \"n0.out\" \"end.ip\";\n"
        )
    }

    #[test]
    fn an_operator_makes_no_more_points_than_are_left() {
        // The plane has 9 points, 12 edges and 4 faces.
        for (kind, values, points) in [
            ("polySubdFace", "setAttr \".dv\" 1;", 12 + 4),
            ("polySmoothFace", "setAttr \".dv\" 1;", 12 + 4),
            ("polyExtrudeFace", "setAttr \".d\" 100;", 9 * 100),
            ("polyExtrudeFace", "setAttr \".d\" 100; setAttr \".kft\" no;", 4 * 4 * 100),
            ("polyBevel", "", 4 * 4),
            ("polySplitVert", "", 4 * 4 - 9),
        ] {
            let nodes = operator(kind, values, if kind == "polySplitVert" { "vtx" } else { "f" });
            assert!(built(&nodes, 9 + points).is_ok(), "{kind}");
            let why = built(&nodes, 8 + points).unwrap_err();
            assert!(why.contains("20 million points"), "{kind}: {why}");
        }
    }

    #[test]
    fn unions_of_a_mesh_with_itself_are_refused_when_they_grow_too_large() {
        // Points merge, but faces double.
        for between in ["polyNormal", "polyMergeVert"] {
            let mut nodes = String::from("createNode mesh -n \"shape\";\n");
            for k in 1..=40 {
                let (before, name) = (k - 1, if k == 40 { "end".to_owned() } else { format!("n{k}") });
                nodes += &format!(
                    "createNode polyUnite -n \"u{k}\"; connectAttr \"n{before}.out\" \"u{k}.ip[0]\";\n\
                     connectAttr \"n{before}.out\" \"u{k}.ip[1]\"; createNode {between} -n \"{name}\";\n\
                     connectAttr \"u{k}.out\" \"{name}.ip\";\n"
                );
            }
            let why = built(&nodes, 10_000).unwrap_err();
            assert!(why.contains("20 million points"), "{between}: {why}");
        }
    }
}
