//! How each mesh of a Maya scene is imported.

use nucleus_graph::attributes::NodeType;

use crate::mesh::{Built, Poly};
use crate::scene::{MayaScene, NodeId};

/// How a mesh is imported.
pub(super) enum Plan {
    /// A Nucleus primitive, by its creation node.
    Primitive(NodeId, &'static NodeType),
    /// The file that a Nucleus scene names.
    File(String),
    /// The mesh in the Maya scene, since the file that a Nucleus scene names is not there.
    Embedded(Poly, String),
    /// The text of an OBJ file that the artist gives.
    Given(String),
    /// The mesh at the first frame, which may change over time.
    Built(Built),
    /// It cannot be built, and why.
    Missing(String),
}

impl Plan {
    /// How many points the mesh has, as far as it is known.
    pub(super) fn points(&self, scene: &MayaScene) -> Option<usize> {
        match self {
            Self::Primitive(source, _) => {
                usize::try_from(crate::mesh::own_primitive(scene, *source)?.size().points).ok()
            }
            Self::Embedded(mesh, _) => Some(mesh.points.len()),
            Self::Built(built) => Some(built.mesh.points.len()),
            Self::Given(text) => Some(text.lines().filter(|line| line.starts_with("v ")).count()),
            Self::File(_) | Self::Missing(_) => None,
        }
    }
}
