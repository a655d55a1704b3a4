//! Woven cloth (`weave`): the direction of its warp in each face, from texture coordinates.

use std::ops::Range;

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::animation::sin_cos_degrees;
use crate::attributes::{n_cloth, nucleus};
use crate::graph::NodeId;

use super::compiler::Compiler;
use super::map_values::MapOfCloth;
use super::texture_coordinates::{MeshCoordinates, of_mesh};
use super::units::CLASSIC;
use super::vertex_maps::WEAVE_ANGLE;

impl Compiler<'_> {
    /// The direction of the warp in each face of a cloth at rest: that of rising u, turned by `weaveAngle`. Empty for cloth
    /// that is not woven, `None` after an error, which is reported.
    pub(super) fn warp(&mut self, cloth: NodeId, mesh: NodeId, rest: &Surface) -> Option<Vec<Vector3<f64>>> {
        let is_classic = self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL) == CLASSIC;
        if is_classic {
            self.warn_of_classic_weave(cloth);
        }
        if is_classic || !self.start.get(cloth, &n_cloth::WEAVE) {
            return Some(Vec::new());
        }
        self.warn_of_free_shear(cloth);
        let uvs = self.weave_uvs(cloth, mesh, rest)?;
        let angles = self.weave_angles(cloth, mesh, rest.positions.len())?;
        let (warp, flat) = warp_of_faces(rest, &uvs, &angles);
        if flat > 0 {
            let message =
                format!("{flat} faces of `{}` have no area in texture coordinates", self.weave_name(cloth));
            let help = "the warp of these is taken along their first edge";
            let place = self.weave_place(cloth);
            self.findings.warning(&place, message).help(help);
        }
        Some(warp)
    }

    fn weave_name(&self, cloth: NodeId) -> &str {
        self.scene.graph.node(cloth).name()
    }

    fn weave_place(&self, cloth: NodeId) -> Range<usize> {
        self.place(cloth, &n_cloth::WEAVE.row)
    }

    fn warn_of_classic_weave(&mut self, cloth: NodeId) {
        for key in [&n_cloth::WEAVE, &n_cloth::BUCKLING] {
            if self.scene.graph.is_ever_nonzero(cloth, key) {
                let (word, name) = (key.row.name, self.weave_name(cloth));
                let message = format!("`{word}` of `{name}` has no effect: `resistanceModel` is classic");
                let help = "its law is one of stiffnesses: write `resistanceModel: physical`";
                let place = self.place(cloth, &key.row);
                self.findings.warning(&place, message).help(help);
            }
        }
    }

    fn warn_of_free_shear(&mut self, cloth: NodeId) {
        let graph = &self.scene.graph;
        let is_ever_stiff = graph.is_ever_nonzero(cloth, &n_cloth::SHEAR_RESISTANCE)
            || graph.changes(cloth, &n_cloth::SHEAR_STIFFNESS)
            || self.start.get(cloth, &n_cloth::SHEAR_STIFFNESS) > 0.0;
        if !is_ever_stiff {
            let message = format!("`{}` is woven, and nothing resists its shear", self.weave_name(cloth));
            let help = "give `shearStiffness`: 10 to 200 N/m in common cloth";
            let place = self.weave_place(cloth);
            self.findings.warning(&place, message).help(help);
        }
    }

    /// The texture coordinates of each corner; reports why if there are none.
    fn weave_uvs(&mut self, cloth: NodeId, mesh: NodeId, rest: &Surface) -> Option<Vec<[f64; 2]>> {
        let mesh = self.scene.graph.node(mesh);
        let uvs =
            of_mesh(self.scene, mesh, &rest.faces).and_then(|coordinates| corner_uvs(coordinates, rest));
        if uvs.is_none() {
            let (name, mesh) = (self.weave_name(cloth), mesh.name());
            let message = format!("`weave` of `{name}` asks for texture coordinates: `{mesh}` has none");
            let help = "a primitive has them, and an OBJ file with `vt` lines and faces like `7/2`; the warp follows u";
            let place = self.weave_place(cloth);
            self.findings.error(&place, message).help(help);
        }
        uvs
    }

    /// The angle of the warp to u at each point, in degrees: `weaveAngle` times its map.
    fn weave_angles(&mut self, cloth: NodeId, mesh: NodeId, points: usize) -> Option<Vec<f64>> {
        let errors = self.findings.errors();
        let factors = self.map_values(&MapOfCloth { cloth, mesh, points, map: &WEAVE_ANGLE });
        let angle = self.start.get(cloth, &n_cloth::WEAVE_ANGLE);
        let angles = factors.map_or_else(
            || vec![angle; points],
            |factors| factors.into_iter().map(|factor| angle * factor).collect(),
        );
        (self.findings.errors() == errors).then_some(angles)
    }
}

/// The warp of each face, and the number of faces without area in texture coordinates. The angle of a face is the mean
/// over its corners.
fn warp_of_faces(rest: &Surface, uvs: &[[f64; 2]], angles: &[f64]) -> (Vec<Vector3<f64>>, usize) {
    let (mut first, mut flat) = (0, 0);
    let mut warp = Vec::with_capacity(rest.faces.len());
    for face in rest.faces.iter() {
        let uvs = &uvs[first..first + face.len()];
        first += face.len();
        let places: Vec<_> = face.iter().map(|&k| rest.positions[k as usize]).collect();
        let angle = angles[face[0] as usize]
            + face.iter().map(|&k| angles[k as usize] - angles[face[0] as usize]).sum::<f64>()
                / face.len() as f64;
        warp.push(match warp_of(&places, uvs) {
            Some(warp) => turned(warp, &places, angle),
            None => {
                flat += 1;
                places[1] - places[0]
            }
        });
    }
    (warp, flat)
}

/// The texture coordinates of each corner of each face; `None` if they are not those of this mesh.
fn corner_uvs((values, corners): MeshCoordinates, mesh: &Surface) -> Option<Vec<[f64; 2]>> {
    let of_mesh = mesh.faces.corners();
    let index = if corners.is_empty() { of_mesh } else { &corners };
    if index.len() != of_mesh.len() {
        return None;
    }
    index.iter().map(|&k| values.get(k as usize).copied()).collect()
}

/// The direction of rising u in a face: the mean over its triangles by their areas in u and v.
fn warp_of(places: &[Vector3<f64>], uvs: &[[f64; 2]]) -> Option<Vector3<f64>> {
    let mut sum = Vector3::zeros();
    for k in 2..places.len() {
        let [e, f] = [places[k - 1] - places[0], places[k] - places[0]];
        let [[eu, ev], [fu, fv]] = [k - 1, k].map(|k| [uvs[k][0] - uvs[0][0], uvs[k][1] - uvs[0][1]]);
        let area = eu * fv - fu * ev;
        // The gradient times the size of the area; its sign is that of a mirrored face.
        sum += (e * fv - f * ev) * area.signum();
    }
    sum.try_normalize(0.0).filter(|warp| warp.iter().all(|x| x.is_finite()))
}

/// The direction turned about the normal of the face, by degrees counterclockwise.
fn turned(warp: Vector3<f64>, places: &[Vector3<f64>], degrees: f64) -> Vector3<f64> {
    let cross = |k: usize| (places[k - 1] - places[0]).cross(&(places[k] - places[0]));
    let normal: Vector3<f64> = (2..places.len()).map(cross).sum();
    let Some(normal) = normal.try_normalize(0.0) else { return warp };
    let (sin, cos) = sin_cos_degrees(degrees);
    warp * cos + normal.cross(&warp) * sin
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Vector3<f64>; 4] = [
        Vector3::new(0.0, 0.0, 0.0),
        Vector3::new(2.0, 0.0, 0.0),
        Vector3::new(2.0, 1.0, 0.0),
        Vector3::new(0.0, 1.0, 0.0),
    ];

    #[test]
    fn the_warp_follows_u_whatever_the_scale_and_the_side_of_the_map() {
        let along_x = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!((warp_of(&SQUARE, &along_x).unwrap() - Vector3::x()).norm() < 1e-12);
        let along_y = along_x.map(|[u, v]| [v, u]);
        assert!((warp_of(&SQUARE, &along_y).unwrap() - Vector3::y()).norm() < 1e-12);
        let mirrored = along_x.map(|[u, v]| [-3.0 * u, v]);
        assert!((warp_of(&SQUARE, &mirrored).unwrap() + Vector3::x()).norm() < 1e-12);
        // u rises by 2 along x and by 1 along y.
        let oblique = SQUARE.map(|p| [p.x + p.y, p.y]);
        assert!((warp_of(&SQUARE, &oblique).unwrap() - Vector3::x()).norm() < 1e-12);
        assert_eq!(warp_of(&SQUARE, &[[0.5, 0.5]; 4]), None);
    }

    #[test]
    fn the_angle_turns_the_warp_counterclockwise_about_the_normal() {
        let bias = turned(Vector3::x(), &SQUARE, 45.0);
        assert!((bias - Vector3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0)).norm() < 1e-12, "{bias}");
        assert!((turned(Vector3::x(), &SQUARE, 90.0) - Vector3::y()).norm() < 1e-12);
    }
    #[test]
    fn the_warp_of_a_face_is_turned_by_the_mean_of_its_corners() {
        let [corner, x, y] = [Vector3::zeros(), Vector3::x(), Vector3::y()];
        let rest = Surface::sheet(corner, [y, x], [1, 1]);
        let uvs: Vec<_> = rest.faces.corners().iter().map(|&k| rest.positions[k as usize]).collect();
        let uvs: Vec<_> = uvs.iter().map(|place| [place.x, place.y]).collect();
        let (warp, flat) = warp_of_faces(&rest, &uvs, &[0.0, 90.0, 30.0, 60.0]);
        let bias = Vector3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0);
        assert!((warp[0] - bias).norm() < 1e-12, "{}", warp[0]);
        assert_eq!((warp.len(), flat), (1, 0));
    }
}
