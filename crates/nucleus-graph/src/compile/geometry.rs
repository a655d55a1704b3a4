//! The surfaces that mesh nodes stand for.

use std::collections::BTreeMap;

use nucleus_core::Surface;

use crate::attributes::{mesh, poly_cube, poly_cylinder, poly_plane, poly_sphere};
use crate::files;
use crate::graph::{Node, NodeId};
use crate::memory::{self, Budget, Cost, Size, TooLarge};
use crate::mesh::{ObjError, Primitive, drop_degenerate_faces, poly_plane_uvs, read_obj, read_obj_uvs};
use crate::scene::{Findings, Scene};

use super::shape::{Points, Shape};

/// Meshes by node, each made once. In the space of the node, lengths in scene units.
pub(super) struct Geometry {
    made: BTreeMap<NodeId, Option<Mesh>>,
    /// What is left of the memory that the scene may take.
    pub(super) budget: Budget,
}

/// A mesh as it is made.
struct Mesh {
    /// At the first frame, before any blend.
    surface: Surface,
    /// Its points from the first frame of the run on, where there is a file for each; else none.
    frames: Vec<Points>,
}

impl Geometry {
    pub(super) fn new(scene: &Scene) -> Self {
        Self { made: BTreeMap::new(), budget: scene.source.budget() }
    }

    /// How large the mesh of a node is: of a primitive without making it.
    pub(super) fn size(&mut self, scene: &Scene, node: NodeId, findings: &mut Findings) -> Option<Size> {
        if let Some(primitive) = primitive(scene.graph.node(node)) {
            return Some(primitive.size());
        }
        let surface = self.surface(scene, node, findings)?;
        let [points, corners] = [surface.positions.len(), surface.faces.corners().len()];
        Some(Size { points: points as u64, corners: corners as u64 })
    }

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
        let Self { made, budget } = self;
        let make = || make(scene, scene.graph.node(node), budget, findings);
        made.entry(node).or_insert_with(make).as_ref()
    }
}

fn make(scene: &Scene, node: &Node, budget: &mut Budget, findings: &mut Findings) -> Option<Mesh> {
    let mut mesh = if node.node_type() == &mesh::MESH {
        read_files(scene, node, budget, findings)?
    } else {
        let primitive = primitive(node)?;
        if let Err(refused) = budget.claim(Cost::MESH.of(primitive.size())) {
            refuse(scene, node, &refused, findings);
            return None;
        }
        match primitive.surface() {
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

/// The primitive that a node makes, if it is one.
pub(super) fn primitive(node: &Node) -> Option<Primitive> {
    let node_type = node.node_type();
    Some(if node_type == &poly_plane::POLY_PLANE {
        use poly_plane::{HEIGHT, SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH, WIDTH};
        let steps = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT];
        Primitive::Plane([&WIDTH, &HEIGHT].map(|key| node.get(key)), steps.map(|key| count(node.get(key))))
    } else if node_type == &poly_sphere::POLY_SPHERE {
        use poly_sphere::{RADIUS, SUBDIVISIONS_AXIS, SUBDIVISIONS_HEIGHT};
        let steps = [&SUBDIVISIONS_AXIS, &SUBDIVISIONS_HEIGHT];
        Primitive::Sphere(node.get(&RADIUS), steps.map(|key| count(node.get(key))))
    } else if node_type == &poly_cube::POLY_CUBE {
        use poly_cube::{DEPTH, HEIGHT, SUBDIVISIONS_DEPTH, SUBDIVISIONS_HEIGHT, SUBDIVISIONS_WIDTH, WIDTH};
        let lengths = [&WIDTH, &HEIGHT, &DEPTH].map(|key| node.get(key));
        let steps = [&SUBDIVISIONS_WIDTH, &SUBDIVISIONS_HEIGHT, &SUBDIVISIONS_DEPTH];
        Primitive::Cube(lengths, steps.map(|key| count(node.get(key))))
    } else if node_type == &poly_cylinder::POLY_CYLINDER {
        use poly_cylinder::{HEIGHT, RADIUS, SUBDIVISIONS_AXIS, SUBDIVISIONS_CAPS, SUBDIVISIONS_HEIGHT};
        let steps = [&SUBDIVISIONS_AXIS, &SUBDIVISIONS_HEIGHT, &SUBDIVISIONS_CAPS];
        let lengths = [&RADIUS, &HEIGHT].map(|key| node.get(key));
        Primitive::Cylinder(lengths, steps.map(|key| count(node.get(key))))
    } else {
        return None;
    })
}

/// The hard ranges of the tables keep it within what fits.
fn count(number: i64) -> u32 {
    u32::try_from(number).unwrap_or_default()
}

/// Says that a mesh takes too much memory.
fn refuse(scene: &Scene, node: &Node, refused: &TooLarge, findings: &mut Findings) {
    if !refused.is_first {
        return;
    }
    let name = node.name();
    let error = findings.error(&scene.source.place(name), format!("the mesh `{name}` takes {refused}"));
    error.help(refused.help("make it coarser"));
}

/// The file of a mesh, or its files if there is one for each frame.
fn read_files(scene: &Scene, node: &Node, budget: &mut Budget, findings: &mut Findings) -> Option<Mesh> {
    let file = node.get(&mesh::FILE);
    let name = node.name();
    if file.is_empty() {
        let error = findings.error(&scene.source.place(name), format!("`{name}` has no `file`"));
        error.help("add `file: \"...\"`, an OBJ file");
        return None;
    }
    let place = scene.source.place(&format!("{name}.file"));
    let read = |file: &str, budget: &Budget, findings: &mut Findings| {
        let path = scene.source.path(file);
        if let Err(refused) = budget.check(files::length(&path).saturating_mul(memory::MESH_BYTE)) {
            let error = findings.error(&place, format!("to read `{}` takes {refused}", path.display()));
            error.help(refused.help("take a smaller file"));
            return None;
        }
        match read_obj(path) {
            Ok(surface) => Some(surface),
            Err(error) => {
                findings.error(&place, error.to_string());
                None
            }
        }
    };
    let points = |surface: &Surface| surface.positions.len() as u64;
    let Some(numbered) = Numbered::new(&file) else {
        let surface = read(&file, budget, findings)?;
        let size = Size { points: points(&surface), corners: surface.faces.corners().len() as u64 };
        let claimed = budget.claim(Cost::MESH.of(size));
        return match claimed {
            Ok(()) => Some(Mesh { surface, frames: Vec::new() }),
            Err(refused) => {
                refuse(scene, node, &refused, findings);
                None
            }
        };
    };
    let surface = read(&numbered.file(scene.time.start), budget, findings)?;
    let mut frames: Vec<Points> = vec![surface.positions.as_slice().into()];
    for frame in scene.time.start + 1..=scene.time.end {
        let file = numbered.file(frame);
        if let Err(refused) = budget.claim(points(&surface) * memory::SHAPE_POINT) {
            refuse(scene, node, &refused, findings);
            return None;
        }
        let points = read(&file, budget, findings)?.positions;
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
