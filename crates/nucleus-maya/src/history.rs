//! The mesh of a shape at a frame: stored in the file, or built by its history and its deformers.

use crate::animation::{Evaluator, Matrix};
use crate::deform;
use crate::mesh::{Built, Poly, embedded, operators, primitives};
use crate::omissions::Cause;
use crate::scene::{NodeId, PlugRef};

/// Longest history that is followed.
const MAX_DEPTH: usize = 500;

/// Inputs of history nodes.
const INPUTS: [&[&str]; 3] = [&["ip", "inputPolymesh"], &["ig", "inputGeometry"], &["i", "inMesh"]];

impl Evaluator<'_> {
    /// The mesh of a shape at a frame.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub fn mesh(&self, shape: NodeId, frame: f64) -> Result<Built, String> {
        let mut built = Built::default();
        built.mesh = self.shape(shape, frame, 0, &mut built)?;
        Ok(built)
    }

    /// The mesh that flows from a plug: a shape, or a node of a history.
    ///
    /// # Errors
    /// Why it cannot be built.
    pub fn mesh_from(&self, plug: PlugRef, frame: f64) -> Result<Built, String> {
        let mut built = Built::default();
        built.mesh = self.made_by(plug, frame, 0, &mut built)?;
        Ok(built)
    }

    fn shape(&self, shape: NodeId, frame: f64, depth: usize, built: &mut Built) -> Result<Poly, String> {
        let stored = || embedded::stored(self.scene, shape);
        let mut mesh = match self.scene.source(shape, &["i", "inMesh"], None) {
            None => stored()?.ok_or("the shape stores no points, and no history makes any")?,
            Some(wire) => match self.made_by(wire.from, frame, depth + 1, built) {
                Ok(mesh) => mesh,
                // The file may hold the result of the history, too.
                Err(why) => match stored()? {
                    Some(mesh) => {
                        let how = format!(
                            "its history is not built ({why}); the mesh that the file stores is taken"
                        );
                        built.omitted.push((self.scene.name(shape).to_owned(), Cause::Approximate(how)));
                        mesh
                    }
                    None => return Err(why),
                },
            },
        };
        embedded::add_tweaks(self.scene, shape, &mut mesh);
        Ok(mesh)
    }

    fn made_by(&self, plug: PlugRef, frame: f64, depth: usize, built: &mut Built) -> Result<Poly, String> {
        if depth > MAX_DEPTH {
            return Err("its history is a cycle, or too long".to_owned());
        }
        let (id, scene) = (plug.node, self.scene);
        let kind = scene.kind(id);
        if kind == "mesh" {
            return self.shape(id, frame, depth + 1, built);
        }
        if let Some(primitive) = primitives::primitive(scene, id) {
            return primitive;
        }
        if matches!(kind, "polyUnite" | "polyBoolOp" | "polyCBoolOp") {
            if kind != "polyUnite" {
                return Err(format!("{kind} is not carried out"));
            }
            return self.unite(id, frame, depth, built);
        }
        if kind == "nCloth" {
            built.omitted.push((
                scene.name(id).to_owned(),
                Cause::Operator("nCloth as the source of a mesh".to_owned()),
            ));
            let wire = scene.source(id, &["imsh", "inputMesh"], None).ok_or("its cloth has no mesh")?;
            return self.made_by(wire.from, frame, depth + 1, built);
        }
        let input = INPUTS.iter().find_map(|names| scene.source(id, names, None));
        let Some(input) = input else { return Err(format!("{kind} `{}` is not built", scene.name(id))) };
        let mesh = self.made_by(input.from, frame, depth + 1, built)?;
        if deform::is_deformer(kind) {
            built.is_deformed = true;
            let input = |plug, built: &mut Built| self.made_by(plug, frame, depth + 1, built);
            return deform::deformed(self, id, frame, mesh, &input, built);
        }
        Ok(match operators::apply(scene, id, mesh) {
            operators::Operation::Done(mesh) => mesh,
            operators::Operation::Unknown(mesh) => {
                built.omitted.push((scene.name(id).to_owned(), Cause::Operator(kind.to_owned())));
                mesh
            }
        })
    }

    fn unite(&self, id: NodeId, frame: f64, depth: usize, built: &mut Built) -> Result<Poly, String> {
        let matrices = self.scene.sources(id, &["im", "inputMat"]);
        let mut parts = Vec::new();
        for (index, wire) in self.scene.sources(id, &["ip", "inputPoly"]) {
            let part = self.made_by(wire.from, frame, depth + 1, built)?;
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
