//! How many points an object has at most, told before it is made: what names its points is checked by that.

use crate::attributes::{Painting, Value, mesh, n_base, n_particle};
use crate::files;
use crate::graph::{Graph, NodeId};
use crate::scene::Source;

use super::geometry::primitive;

/// The fewest bytes of a point in a file: `v 0 0 0` and the end of its line, or `0 0 0`.
const BYTES: u64 = 6;

/// Of cloth and colliders by `mesh`, of particles by their own lists; nothing where neither is known.
pub(crate) fn most_points(
    graph: &Graph,
    source: &Source,
    object: NodeId,
    mesh: Option<NodeId>,
) -> Option<u64> {
    let of_file = |file: &str| files::length(&source.path(file)) / BYTES + 1;
    let Some(mesh) = mesh.or_else(|| graph.source(object, &n_base::INPUT_MESH)) else {
        let node = graph.node(object);
        let given = [&n_particle::POSITION0, &n_particle::POSITION];
        let setting = node
            .node_type()
            .is_a(&n_particle::N_PARTICLE)
            .then(|| given.iter().find_map(|key| node.setting(key)));
        return match setting.flatten()?.at(0.0, &n_particle::POSITION.row) {
            Value::Vectors(vectors) => Some(vectors.len() as u64),
            Value::Painting(Painting::File(file)) => Some(of_file(&file)),
            _ => None,
        };
    };
    let mesh = graph.node(mesh);
    if mesh.node_type() == &mesh::MESH {
        // A name that stands for several files is left to be told of by who reads them.
        let file = mesh.get(&mesh::FILE);
        return (!file.contains('#')).then(|| of_file(&file));
    }
    primitive(mesh).map(|primitive| primitive.size().points)
}
