//! The surfaces that mesh nodes stand for.

use std::collections::BTreeMap;
use std::path::PathBuf;

use nucleus_core::Surface;

use crate::attributes::{mesh, poly_cube, poly_cylinder, poly_plane, poly_sphere};
use crate::graph::{Node, NodeId};
use crate::mesh::{
    PrimitiveError, drop_degenerate_faces, poly_cube as cube, poly_cylinder as cylinder, poly_plane as plane,
    poly_sphere as sphere, read_obj,
};
use crate::scene::{Findings, Scene};

/// Surfaces by node, each made once. In the space of the node, lengths in scene units.
#[derive(Default)]
pub(super) struct Geometry {
    made: BTreeMap<NodeId, Option<Surface>>,
}

impl Geometry {
    /// The surface of a node, or nothing if there is none; why not has been said then.
    pub(super) fn surface(
        &mut self,
        scene: &Scene,
        node: NodeId,
        findings: &mut Findings,
    ) -> Option<&Surface> {
        self.made.entry(node).or_insert_with(|| make(scene, scene.graph.node(node), findings)).as_ref()
    }
}

fn make(scene: &Scene, node: &Node, findings: &mut Findings) -> Option<Surface> {
    let node_type = node.node_type();
    let mut surface = if node_type == &mesh::MESH {
        read_file(scene, node, findings)?
    } else {
        match primitive(node)? {
            Ok(surface) => surface,
            Err(error) => {
                findings.error(&scene.source.place(node.name()), format!("`{}`: {error}", node.name()));
                return None;
            }
        }
    };
    let dropped = drop_degenerate_faces(&mut surface);
    let place = scene.source.place(&format!("{}.file", node.name()));
    if dropped > 0 && surface.faces.is_empty() {
        findings.error(&place, format!("`{}` has no face with an area", node.name()));
        return None;
    }
    if dropped > 0 {
        let message = format!("`{}` has {dropped} faces without area, which are left out", node.name());
        findings.warning(&place, message);
    }
    Some(surface)
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

fn read_file(scene: &Scene, node: &Node, findings: &mut Findings) -> Option<Surface> {
    let file = node.get(&mesh::FILE);
    let name = node.name();
    if file.is_empty() {
        let error = findings.error(&scene.source.place(name), format!("`{name}` has no `file`"));
        error.help("add `file: \"...\"`, an OBJ file");
        return None;
    }
    let path: PathBuf = scene.source.path(&file);
    match read_obj(&path) {
        Ok(surface) => Some(surface),
        Err(error) => {
            let place = scene.source.place(&format!("{name}.file"));
            findings.error(&place, error.to_string());
            None
        }
    }
}
