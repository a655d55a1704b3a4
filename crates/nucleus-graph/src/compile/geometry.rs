//! The surfaces that mesh nodes stand for.

use std::collections::BTreeMap;

use nucleus_core::Surface;

use crate::attributes::{mesh, poly_cube, poly_cylinder, poly_plane, poly_sphere};
use crate::graph::{Node, NodeId};
use crate::mesh::{
    ObjError, PrimitiveError, drop_degenerate_faces, poly_cube as cube, poly_cylinder as cylinder,
    poly_plane as plane, poly_plane_uvs, poly_sphere as sphere, read_obj, read_obj_uvs,
};
use crate::scene::{Findings, Scene};

use super::shape::{Points, Shape};

/// Meshes by node, each made once. In the space of the node, lengths in scene units.
#[derive(Default)]
pub(super) struct Geometry {
    made: BTreeMap<NodeId, Option<Mesh>>,
}

/// A mesh as it is made.
struct Mesh {
    /// At the first frame, before any blend.
    surface: Surface,
    /// Its points from the first frame of the run on, where there is a file for each; else none.
    frames: Vec<Points>,
}

impl Geometry {
    /// The surface of a node, or nothing if there is none; why not has been said then.
    pub(super) fn surface(
        &mut self,
        scene: &Scene,
        node: NodeId,
        findings: &mut Findings,
    ) -> Option<&Surface> {
        self.mesh(scene, node, findings).map(|mesh| &mesh.surface)
    }

    /// The points of a node over time, blends included.
    pub(super) fn shape(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> Option<Shape> {
        let mesh = self.mesh(scene, node, findings)?;
        let points = mesh.surface.positions.len();
        let own = match mesh.frames.as_slice() {
            [] => Shape::fixed(mesh.surface.positions.as_slice().into()),
            frames => Shape::sequence(frames.to_vec(), scene.time.start),
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
        let target = self.shape(scene, target, findings)?;
        Some(own.blended(node, target))
    }

    /// The texture coordinates of the points of a node; nothing if it is made without. Read anew each time.
    pub(super) fn uvs(&self, scene: &Scene, node: NodeId) -> Result<Option<Vec<Option<[f64; 2]>>>, ObjError> {
        let own = scene.graph.node(node);
        if own.node_type() == &poly_plane::POLY_PLANE {
            use poly_plane::{SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH};
            let [sx, sy] = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT].map(|key| count(own.get(key)));
            return Ok(Some(poly_plane_uvs((sx, sy)).into_iter().map(Some).collect()));
        }
        if own.node_type() != &mesh::MESH {
            return Ok(None);
        }
        let file = own.get(&mesh::FILE);
        let file = Numbered::new(&file).map_or(file.clone(), |numbered| numbered.file(scene.time.start));
        let uvs = read_obj_uvs(scene.source.path(&file))?;
        Ok(Some(uvs).filter(|uvs| uvs.iter().any(Option::is_some)))
    }

    /// Whether the points of a node stand where they are, seen from the node.
    pub(super) fn is_fixed(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> bool {
        let single = self.mesh(scene, node, findings).is_none_or(|mesh| mesh.frames.is_empty());
        single && scene.graph.blend_target(node).is_none()
    }

    fn mesh(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> Option<&Mesh> {
        self.made.entry(node).or_insert_with(|| make(scene, scene.graph.node(node), findings)).as_ref()
    }
}

fn make(scene: &Scene, node: &Node, findings: &mut Findings) -> Option<Mesh> {
    let node_type = node.node_type();
    let mut mesh = if node_type == &mesh::MESH {
        read_files(scene, node, findings)?
    } else {
        match primitive(node)? {
            Ok(surface) => Mesh { surface, frames: Vec::new() },
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

fn primitive(node: &Node) -> Option<Result<Surface, PrimitiveError>> {
    let node_type = node.node_type();
    Some(if node_type == &poly_plane::POLY_PLANE {
        use poly_plane::{HEIGHT, SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH, WIDTH};
        let [sx, sy] = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT].map(|key| count(node.get(key)));
        plane(node.get(&WIDTH), node.get(&HEIGHT), (sx, sy))
    } else if node_type == &poly_sphere::POLY_SPHERE {
        use poly_sphere::{RADIUS, SUBDIVISIONS_AXIS, SUBDIVISIONS_HEIGHT};
        let [sx, sy] = [&SUBDIVISIONS_AXIS, &SUBDIVISIONS_HEIGHT].map(|key| count(node.get(key)));
        sphere(node.get(&RADIUS), (sx, sy))
    } else if node_type == &poly_cube::POLY_CUBE {
        use poly_cube::{DEPTH, HEIGHT, SUBDIVISIONS_DEPTH, SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH, WIDTH};
        let keys = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT, &SUBDIVISIONS_DEPTH];
        let [sx, sy, sz] = keys.map(|key| count(node.get(key)));
        cube(node.get(&WIDTH), node.get(&HEIGHT), node.get(&DEPTH), (sx, sy, sz))
    } else if node_type == &poly_cylinder::POLY_CYLINDER {
        use poly_cylinder::{HEIGHT, RADIUS, SUBDIVISIONS_AXIS, SUBDIVISIONS_CAPS, SUBDIVISIONS_HEIGHT};
        let keys = [&SUBDIVISIONS_AXIS, &SUBDIVISIONS_HEIGHT, &SUBDIVISIONS_CAPS];
        let [sx, sy, sz] = keys.map(|key| count(node.get(key)));
        cylinder(node.get(&RADIUS), node.get(&HEIGHT), (sx, sy, sz))
    } else {
        return None;
    })
}

/// The hard ranges of the tables keep it within what fits.
fn count(number: i64) -> u32 {
    u32::try_from(number).unwrap_or_default()
}

/// The file of a mesh, or its files if there is one for each frame.
fn read_files(scene: &Scene, node: &Node, findings: &mut Findings) -> Option<Mesh> {
    let file = node.get(&mesh::FILE);
    let name = node.name();
    if file.is_empty() {
        let error = findings.error(&scene.source.place(name), format!("`{name}` has no `file`"));
        error.help("add `file: \"...\"`, an OBJ file");
        return None;
    }
    let place = scene.source.place(&format!("{name}.file"));
    let read = |file: &str, findings: &mut Findings| match read_obj(scene.source.path(file)) {
        Ok(surface) => Some(surface),
        Err(error) => {
            findings.error(&place, error.to_string());
            None
        }
    };
    let Some(numbered) = Numbered::new(&file) else {
        return Some(Mesh { surface: read(&file, findings)?, frames: Vec::new() });
    };
    let surface = read(&numbered.file(scene.time.start), findings)?;
    let mut frames: Vec<Points> = vec![surface.positions.as_slice().into()];
    for frame in scene.time.start + 1..=scene.time.end {
        let file = numbered.file(frame);
        let points = read(&file, findings)?.positions;
        let (first, now) = (surface.positions.len(), points.len());
        if now != first {
            let message =
                format!("`{name}` has {first} points at frame {}, but {now} in `{file}`", scene.time.start);
            findings.error(&place, message).help("a mesh keeps its points from frame to frame");
            return None;
        }
        frames.push(points.into());
    }
    Some(Mesh { surface, frames })
}

/// The name of a file with a run of `#` in it, which stand for the digits of the frame.
struct Numbered<'a> {
    before: &'a str,
    digits: usize,
    after: &'a str,
}

impl<'a> Numbered<'a> {
    fn new(file: &'a str) -> Option<Self> {
        let first = file.find('#')?;
        let digits = file[first..].bytes().take_while(|byte| *byte == b'#').count();
        Some(Self { before: &file[..first], digits, after: &file[first + digits..] })
    }

    fn file(&self, frame: i64) -> String {
        format!("{}{frame:0digits$}{}", self.before, self.after, digits = self.digits)
    }
}
