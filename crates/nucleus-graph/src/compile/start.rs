//! How a cloth starts: as its mesh, at rest, unless `startPositions` or `startVelocities` say otherwise. They are in
//! world space, in scene units. What it is at rest is the mesh's to say: cloth that starts stretched pulls back.

use nalgebra::Vector3;
use nucleus_core::{MAX_COORDINATE, Start};

use crate::attributes::{Key, Painting, Value, n_base};
use crate::graph::NodeId;
use crate::memory;
use crate::mesh::read_obj;
use crate::paint::read_vectors;

use super::objects::Compiler;

impl Compiler<'_> {
    /// Its start; nothing if something about it is wrong, which has been said then.
    pub(super) fn start_of(&mut self, cloth: NodeId, mesh: NodeId, points: usize) -> Option<Start> {
        let [positions, velocities] = [&n_base::START_POSITIONS, &n_base::START_VELOCITIES]
            .map(|key| self.start_column(cloth, mesh, points, key));
        Some(Start { positions: positions?, velocities: velocities? })
    }

    /// What a list of vectors holds, wherever it is written; why that cannot be read.
    pub(super) fn vectors(&self, node: NodeId, key: &Key<Vec<[f64; 3]>>) -> Result<Vec<[f64; 3]>, String> {
        match self.start.held(node, key) {
            Some(Value::Vectors(vectors)) => Ok(vectors),
            Some(Value::Painting(Painting::File(file))) => {
                let path = self.scene.source.path(&file);
                self.check_file(&path, memory::NUMBER_BYTE)?;
                if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("obj")) {
                    let points = read_obj(path).map_err(|error| error.to_string())?.positions;
                    return Ok(points.into_iter().map(Into::into).collect());
                }
                read_vectors(&path).map_err(|error| error.to_string())
            }
            _ => Ok(Vec::new()),
        }
    }

    pub(super) fn start_column(
        &mut self,
        cloth: NodeId,
        mesh: NodeId,
        points: usize,
        key: &Key<Vec<[f64; 3]>>,
    ) -> Option<Vec<Vector3<f64>>> {
        let vectors = self.vectors(cloth, key);
        let [name, mesh] = [cloth, mesh].map(|node| self.scene.graph.node(node).name());
        let label = format!("`{}` of `{name}`", key.row.name);
        let metres = |vectors: Vec<[f64; 3]>| -> Vec<Vector3<f64>> {
            vectors.into_iter().map(|vector| self.whole.units.point(vector.into())).collect()
        };
        let is_far = |metres: &Vector3<f64>| metres.amax() > MAX_COORDINATE;
        let found = vectors.map(metres).and_then(|column| match column.iter().position(is_far) {
            _ if !column.is_empty() && column.len() != points => {
                Err(format!("{label} has {} vectors, but `{mesh}` has {points} points", column.len()))
            }
            Some(point) => Err(format!("{label} is more than {MAX_COORDINATE:e} m at point {point}")),
            None => Ok(column),
        });
        found
            .map_err(|message| {
                let place = self.scene.source.place(&format!("{name}.{}", key.row.name));
                self.findings.error(&place, message);
            })
            .ok()
    }
}
