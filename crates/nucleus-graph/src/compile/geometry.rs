//! Surfaces of mesh nodes: primitives and files. Each is made once, within the memory limit.

use std::collections::BTreeMap;

use nucleus_core::{Faces, Surface};

use crate::animation::Affine;
use crate::attributes::{
    Painting, Value, mesh, n_base, n_particle, poly_cube, poly_cylinder, poly_plane, poly_sphere,
};
use crate::diagnostic::Findings;
use crate::files;
use crate::graph::{Graph, Node, NodeId};
use crate::memory::{Budget, Cost, Size};
use crate::mesh::{
    FileMesh, MeshFormat, ObjError, Primitive, PrimitiveError, drop_degenerate_faces, poly_plane_uvs,
    read_obj_uvs, rotation_to_axis,
};
use crate::scene::document::{Scene, Source};

use super::animated_mesh::{AnimatedMesh, NumberedFile};
use super::mesh_files::{Mesh, read_files, report_too_large};

/// The minimum bytes of a point in a file: `v 0 0 0` and the end of the line, or `0 0 0`.
const MIN_POINT_BYTES: u64 = 6;

/// Meshes by node, each made once. Positions in mesh space, in scene units.
pub(super) struct Geometry {
    made: BTreeMap<NodeId, Option<Mesh>>,
    /// The memory that the scene may take.
    pub(super) budget: Budget,
}

impl Geometry {
    pub(super) fn new(scene: &Scene) -> Self {
        Self { made: BTreeMap::new(), budget: scene.source.budget() }
    }

    /// The size of a node's mesh. A primitive is not made for this.
    pub(super) fn size(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> Option<Size> {
        if let Some((primitive, _)) = primitive(scene.graph.node(node)) {
            return Some(primitive.size());
        }
        let surface = self.surface(scene, node, findings)?;
        let [points, corners] = [surface.positions.len(), surface.faces.corners().len()];
        Some(Size { points: points as u64, corners: corners as u64 })
    }

    /// The surface of a node; `None` after an error, which is reported.
    pub(super) fn surface(
        &mut self,
        scene: &Scene,
        node: NodeId,
        findings: &mut Findings,
    ) -> Option<&Surface> {
        self.mesh(scene, node, findings).map(|mesh| &mesh.surface)
    }

    /// The points of a node over time, including its blend.
    pub(super) fn animated(
        &mut self,
        scene: &Scene,
        node: NodeId,
        findings: &mut Findings,
    ) -> Option<AnimatedMesh> {
        let mesh = self.mesh(scene, node, findings)?;
        let points = mesh.surface.positions.len();
        let own = match mesh.frames.as_slice() {
            [] => AnimatedMesh::fixed(mesh.surface.positions.as_slice().into()),
            frames => AnimatedMesh::sequence(frames.to_vec(), scene.time.start),
        };
        let Some(target) = scene.graph.blend_target(node) else { return Some(own) };
        let others = self.surface(scene, target, findings)?.positions.len();
        if others != points {
            let [name, target] = [node, target].map(|id| scene.graph.node(id).name());
            let place = scene.source.place(&format!("{name}.blendTarget"));
            let message = format!(
                "`{name}` cannot be blended into `{target}`: one has {points} points, the other {others}"
            );
            findings.error(&place, message);
            return None;
        }
        let target = self.animated(scene, target, findings)?;
        Some(own.blended(node, target))
    }

    /// The texture coordinates of a node's points; `None` if it has none. Reads an OBJ file on each call.
    pub(super) fn uvs(&self, scene: &Scene, node: NodeId) -> Result<Option<Vec<Option<[f64; 2]>>>, ObjError> {
        let own = scene.graph.node(node);
        if let Some(uvs) = plane_uvs(own) {
            return Ok(Some(uvs.into_iter().map(Some).collect()));
        }
        if let Some((primitive, _)) = primitive(own) {
            let mesh = primitive.surface().map(|surface| FileMesh { surface, uvs: primitive.corner_uvs() });
            return Ok(mesh.ok().and_then(|mesh| mesh.uvs_of_points()));
        }
        if own.node_type() != &mesh::MESH {
            return Ok(None);
        }
        let file = file_of(scene, own).unwrap_or_default();
        if MeshFormat::of(&file) != MeshFormat::Obj {
            return Ok(self.made.get(&node).and_then(|mesh| mesh.as_ref()?.uvs.clone()));
        }
        let uvs = read_obj_uvs(scene.source.path(&file))?;
        Ok(Some(uvs).filter(|uvs| uvs.iter().any(Option::is_some)))
    }

    /// Whether the points of a node are constant in mesh space.
    pub(super) fn is_fixed(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> bool {
        let single = self.mesh(scene, node, findings).is_none_or(|mesh| mesh.frames.is_empty());
        single && scene.graph.blend_target(node).is_none()
    }

    fn mesh(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> Option<&Mesh> {
        let Self { made, budget } = self;
        let make = || make(scene, scene.graph.node(node), budget, findings);
        made.entry(node).or_insert_with(make).as_ref()
    }
}

/// The faces of a mesh that is placed in the world: turned where it is mirrored, so that its outside stays outside.
pub(super) fn placed_faces(faces: &Faces, placement: &Affine) -> Faces {
    if placement.mirrors() { faces.reversed() } else { faces.clone() }
}

/// The file that a mesh node is read from, at the first frame of the scene; `None` for other nodes.
pub(super) fn file_of(scene: &Scene, node: &Node) -> Option<String> {
    let file = (node.node_type() == &mesh::MESH).then(|| node.get(&mesh::FILE))?;
    Some(NumberedFile::new(&file).map_or(file.clone(), |numbered| numbered.at(scene.time.start)))
}

/// The texture coordinates of the points of a polyPlane; `None` for other nodes.
pub(super) fn plane_uvs(node: &Node) -> Option<Vec<[f64; 2]>> {
    use poly_plane::{SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH};
    let [width, height] = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT];
    let is_plane = node.node_type() == &poly_plane::POLY_PLANE;
    is_plane.then(|| poly_plane_uvs((count(node.get(width)), count(node.get(height)))))
}

fn make(scene: &Scene, node: &Node, budget: &mut Budget, findings: &mut Findings) -> Option<Mesh> {
    let mut mesh = if node.node_type() == &mesh::MESH {
        read_files(scene, node, budget, findings)?
    } else {
        let (primitive, _) = primitive(node)?;
        if let Err(refused) = budget.claim(Cost::MESH.of(primitive.size())) {
            report_too_large(scene, node, &refused, findings);
            return None;
        }
        match primitive_surface(node)? {
            Ok(surface) => Mesh { surface, frames: Vec::new(), uvs: None },
            Err(error) => {
                findings.error(&scene.source.place(node.name()), format!("`{}`: {error}", node.name()));
                return None;
            }
        }
    };
    let dropped = drop_degenerate_faces(&mut mesh.surface);
    let place = scene.source.place(&format!("{}.file", node.name()));
    if dropped > 0 && mesh.surface.faces.is_empty() {
        findings.error(&place, format!("`{}` has no face with an area", node.name()));
        return None;
    }
    if dropped > 0 {
        let message = format!("`{}` has {dropped} faces without area, which are left out", node.name());
        findings.warning(&place, message);
    }
    Some(mesh)
}

/// The primitive of a node and the direction of its y axis, if it is one.
pub(super) fn primitive(node: &Node) -> Option<(Primitive, [f64; 3])> {
    let node_type = node.node_type();
    Some(if node_type == &poly_plane::POLY_PLANE {
        use poly_plane::{AXIS, HEIGHT, SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH, WIDTH};
        let steps = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT];
        let lengths = [&WIDTH, &HEIGHT].map(|key| node.get(key));
        (Primitive::Plane(lengths, steps.map(|key| count(node.get(key)))), node.get(&AXIS))
    } else if node_type == &poly_sphere::POLY_SPHERE {
        use poly_sphere::{AXIS, RADIUS, SUBDIVISIONS_AXIS, SUBDIVISIONS_HEIGHT};
        let steps = [&SUBDIVISIONS_AXIS, &SUBDIVISIONS_HEIGHT];
        (Primitive::Sphere(node.get(&RADIUS), steps.map(|key| count(node.get(key)))), node.get(&AXIS))
    } else if node_type == &poly_cube::POLY_CUBE {
        use poly_cube::{
            AXIS, DEPTH, HEIGHT, SUBDIVISIONS_DEPTH, SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH, WIDTH,
        };
        let lengths = [&WIDTH, &HEIGHT, &DEPTH].map(|key| node.get(key));
        let steps = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT, &SUBDIVISIONS_DEPTH];
        (Primitive::Cube(lengths, steps.map(|key| count(node.get(key)))), node.get(&AXIS))
    } else if node_type == &poly_cylinder::POLY_CYLINDER {
        use poly_cylinder::{
            AXIS, HEIGHT, RADIUS, SUBDIVISIONS_AXIS, SUBDIVISIONS_CAPS, SUBDIVISIONS_HEIGHT,
        };
        let steps = [&SUBDIVISIONS_AXIS, &SUBDIVISIONS_HEIGHT, &SUBDIVISIONS_CAPS];
        let lengths = [&RADIUS, &HEIGHT].map(|key| node.get(key));
        (Primitive::Cylinder(lengths, steps.map(|key| count(node.get(key)))), node.get(&AXIS))
    } else {
        return None;
    })
}

/// The surface of a primitive node round its origin, in scene units; `None` for any other node.
///
/// # Errors
/// When a parameter is invalid.
pub fn primitive_surface(node: &Node) -> Option<Result<Surface, PrimitiveError>> {
    let (primitive, axis) = primitive(node)?;
    Some(primitive.surface().map(|mut surface| {
        if let Some(rotation) = rotation_to_axis(axis) {
            surface.positions.iter_mut().for_each(|point| *point = rotation * *point);
        }
        surface
    }))
}

/// The attribute's hard range fits into 32 bits.
fn count(number: i64) -> u32 {
    u32::try_from(number).unwrap_or_default()
}

/// An upper bound of the points of an object before it is made, which limits the points that a scene may name: from the
/// size of its file. `None` where it is unknown, as for a file per frame.
pub(crate) fn max_points(
    graph: &Graph,
    source: &Source,
    object: NodeId,
    mesh: Option<NodeId>,
) -> Option<u64> {
    // Of a file that is missing or empty nothing is known; the error about it comes when it is read.
    let of_file = |file: &str| match files::length(&source.path(file)) {
        0 => None,
        length => Some(length / MIN_POINT_BYTES + 1),
    };
    let Some(mesh) = mesh.or_else(|| graph.source(object, &n_base::INPUT_MESH)) else {
        return max_particles(graph.node(object), of_file);
    };
    let mesh = graph.node(mesh);
    if mesh.node_type() == &mesh::MESH {
        let file = mesh.get(&mesh::FILE);
        let is_bounded = !file.contains('#') && MeshFormat::of(&file) == MeshFormat::Obj;
        return of_file(&file).filter(|_| is_bounded);
    }
    primitive(mesh).map(|(primitive, _)| primitive.size().points)
}

/// The same for particles, from their list of positions.
fn max_particles(node: &Node, of_file: impl Fn(&str) -> Option<u64>) -> Option<u64> {
    if !node.node_type().is_a(&n_particle::N_PARTICLE) {
        return None;
    }
    let given = [&n_particle::POSITION0, &n_particle::POSITION];
    let setting = given.iter().find_map(|key| node.setting(key))?;
    match setting.at(0.0, &n_particle::POSITION.row) {
        Value::Vectors(vectors) => Some(vectors.len() as u64),
        Value::Painting(Painting::File(file)) => of_file(&file),
        _ => None,
    }
}
