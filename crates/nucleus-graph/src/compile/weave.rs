//! Woven cloth (`weave`): the direction of its warp in each face, from texture coordinates.

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::animation::sin_cos_degrees;
use crate::attributes::{n_cloth, nucleus};
use crate::graph::NodeId;

use super::compiler::Compiler;
use super::texture_coordinates::{MeshCoordinates, of_mesh};
use super::units::CLASSIC;

impl Compiler<'_> {
    /// The direction of the warp in each face of a cloth at rest: that of rising u, turned by `weaveAngle`. Empty for cloth
    /// that is not woven, `None` after an error, which is reported.
    pub(super) fn warp(&mut self, cloth: NodeId, mesh: NodeId, rest: &Surface) -> Option<Vec<Vector3<f64>>> {
        let graph = &self.scene.graph;
        let name = graph.node(cloth).name();
        let is_classic = self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL) == CLASSIC;
        for key in [&n_cloth::WEAVE, &n_cloth::BUCKLING] {
            if is_classic && graph.is_ever_nonzero(cloth, key) {
                let place = self.scene.source.place(&format!("{name}.{}", key.row.name));
                let message =
                    format!("`{}` of `{name}` has no effect: `resistanceModel` is classic", key.row.name);
                self.findings
                    .warning(&place, message)
                    .help("its law is one of stiffnesses: write `resistanceModel: physical`");
            }
        }
        if is_classic || !self.start.get(cloth, &n_cloth::WEAVE) {
            return Some(Vec::new());
        }
        let place = self.scene.source.place(&format!("{name}.{}", n_cloth::WEAVE.row.name));
        let sheared = [
            graph.is_ever_nonzero(cloth, &n_cloth::SHEAR_RESISTANCE),
            graph.changes(cloth, &n_cloth::SHEAR_STIFFNESS),
        ];
        if sheared == [false; 2] && self.start.get(cloth, &n_cloth::SHEAR_STIFFNESS) <= 0.0 {
            let message = format!("`{name}` is woven, and nothing resists its shear");
            self.findings
                .warning(&place, message)
                .help("give `shearStiffness`: 10 to 200 N/m in common cloth");
        }
        let coordinates = of_mesh(self.scene, graph.node(mesh));
        let Some(uvs) = coordinates.and_then(|coordinates| corner_uvs(coordinates, rest)) else {
            let mesh = graph.node(mesh).name();
            let message = format!("`weave` of `{name}` asks for texture coordinates: `{mesh}` has none");
            let help = "a polyPlane has them, and an OBJ file with `vt` lines and faces like `7/2`; the warp follows u";
            self.findings.error(&place, message).help(help);
            return None;
        };
        let angle = self.start.get(cloth, &n_cloth::WEAVE_ANGLE);
        let mut flat = 0;
        let mut first = 0;
        let warp = rest.faces.iter().map(|face| {
            let (uvs, places) =
                (&uvs[first..first + face.len()], face.iter().map(|&k| rest.positions[k as usize]));
            let places: Vec<_> = places.collect();
            first += face.len();
            warp_of(&places, uvs).map_or_else(
                || {
                    flat += 1;
                    places[1] - places[0]
                },
                |warp| turned(warp, &places, angle),
            )
        });
        let warp = warp.collect();
        if flat > 0 {
            let message = format!("{flat} faces of `{name}` have no area in texture coordinates");
            let help = "the warp of these is taken along their first edge";
            self.findings.warning(&place, message).help(help);
        }
        Some(warp)
    }
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
}
