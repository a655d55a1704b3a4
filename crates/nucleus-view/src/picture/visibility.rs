//! The visibility buffer: the nearest triangle or sphere at each sample (Burns and Hunt 2013).

use super::camera::View;
use super::mesh::Mesh;
use super::raster::{Budget, rasterise};
use super::scene::Vec3;

/// The surface that is visible at a sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fragment {
    /// 1 / depth; 0 for the background.
    pub inverse_depth: f32,
    /// Index of the triangle; from `triangles.len()` on, of a sphere.
    pub primitive: u32,
    /// Barycentric weights of the second and third corner; for a sphere the offset from its centre, in radii.
    pub local: [f32; 2],
}

const EMPTY: Fragment = Fragment { inverse_depth: 0.0, primitive: u32::MAX, local: [0.0; 2] };

/// Draws a mesh into a visibility buffer, row by row from the top. The buffer takes the size of the view; it is large, and a
/// film uses one for all its pictures.
pub(super) fn draw(mesh: &Mesh, view: &View, fragments: &mut Vec<Fragment>) {
    fragments.clear();
    fragments.resize(view.size[0] as usize * view.size[1] as usize, EMPTY);
    let vertices: Vec<Vec3> =
        mesh.vertices.iter().map(|vertex| view.to_view_space(&vertex.position)).collect();
    let mut budget = Budget::of(view.size);
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let corners = triangle.corners.map(|corner| vertices[corner as usize]);
        draw_triangle(fragments, index as u32, corners, view, &mut budget);
    }
    for (index, sphere) in mesh.spheres.iter().enumerate() {
        let primitive = (mesh.triangles.len() + index) as u32;
        let disc = Disc {
            primitive,
            centre: view.to_view_space(&sphere.centre),
            radius: sphere.radius,
            opacity: sphere.opacity,
        };
        draw_sphere(fragments, &disc, view);
    }
}

/// Draws a triangle, given in view space; the part nearer than the near plane is clipped.
fn draw_triangle(
    fragments: &mut [Fragment],
    primitive: u32,
    corners: [Vec3; 3],
    view: &View,
    budget: &mut Budget,
) {
    let near = view.distance * 1e-3;
    if corners.iter().all(|corner| corner.z >= near) {
        return draw_clipped(fragments, primitive, corners, WHOLE, view, budget);
    }
    let polygon = clip(corners, near);
    for k in 2..polygon.len() {
        let weights = [0, k - 1, k].map(|corner| polygon[corner]);
        let clipped = weights.map(|[a, b, c]| corners[0] * a + corners[1] * b + corners[2] * c);
        draw_clipped(fragments, primitive, clipped, weights, view, budget);
    }
}

/// The barycentric weights of the corners of a triangle.
const WHOLE: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Clips a triangle at the near plane; returns the barycentric weights of the 0, 3 or 4 corners of the rest.
fn clip(corners: [Vec3; 3], near: f32) -> Vec<[f32; 3]> {
    let mut kept = Vec::with_capacity(4);
    for k in 0..3 {
        let next = (k + 1) % 3;
        let (here, there) = (corners[k].z - near, corners[next].z - near);
        if here >= 0.0 {
            kept.push(WHOLE[k]);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let t = here / (here - there);
            let mut crossing = [0.0; 3];
            crossing[k] = 1.0 - t;
            crossing[next] = t;
            kept.push(crossing);
        }
    }
    kept
}

/// Draws a triangle in front of the near plane; `unclipped` are the weights of its corners in the unclipped triangle.
fn draw_clipped(
    fragments: &mut [Fragment],
    primitive: u32,
    corners: [Vec3; 3],
    unclipped: [[f32; 3]; 3],
    view: &View,
    budget: &mut Budget,
) {
    let inverse_depth = corners.map(|corner| 1.0 / corner.z);
    let corners = corners.map(|corner| view.project(&corner));
    rasterise(corners, view.size, budget, |cell, weights| {
        // Perspective correction: screen weights over depth are weights in space (Heckbert and Moreton 1991).
        let scaled = [0, 1, 2].map(|k| weights[k] * inverse_depth[k]);
        let sum = scaled[0] + scaled[1] + scaled[2];
        if sum > fragments[cell].inverse_depth {
            let local = [1, 2].map(|k| (0..3).map(|part| unclipped[part][k] * scaled[part] / sum).sum());
            fragments[cell] = Fragment { inverse_depth: sum, primitive, local };
        }
    });
}

/// A sphere, its centre in view space.
struct Disc {
    primitive: u32,
    centre: Vec3,
    radius: f32,
    opacity: f32,
}

/// Whether a sphere of this opacity covers a sample: at random, the same for the same sample and sphere, so that the share of
/// covered samples is the opacity and nothing has to be sorted (stochastic transparency: Enderton et al. 2010).
fn covers(opacity: f32, primitive: u32, cell: u32) -> bool {
    let mut x = primitive.wrapping_mul(0x9e37_79b9) ^ cell.wrapping_mul(0x85eb_ca6b);
    x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
    x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
    opacity >= 1.0 || ((x ^ x >> 16) >> 8) as f32 / (1 << 24) as f32 <= opacity && opacity > 0.0
}

/// Draws a sphere as a disc with the depth of its front.
fn draw_sphere(fragments: &mut [Fragment], disc: &Disc, view: &View) {
    let Disc { primitive, centre, radius, opacity } = *disc;
    let [x, y] = view.project(&centre);
    let disc_radius = view.scale / centre.z * radius;
    if centre.z < radius * 2.0 || !(x + y + disc_radius).is_finite() {
        return;
    }
    let span = |middle: f32, size: u32| {
        let low = (middle - disc_radius).max(0.0) as u32;
        low..((middle + disc_radius).ceil().max(0.0) as u32).min(size)
    };
    for row in span(y, view.size[1]) {
        for column in span(x, view.size[0]) {
            let local = [(column as f32 + 0.5 - x) / disc_radius, (y - row as f32 - 0.5) / disc_radius];
            let height = 1.0 - local[0] * local[0] - local[1] * local[1];
            let inverse_depth = 1.0 / (centre.z - radius * height.max(0.0).sqrt());
            let cell = row * view.size[0] + column;
            let fragment = &mut fragments[cell as usize];
            if height >= 0.0 && inverse_depth > fragment.inverse_depth && covers(opacity, primitive, cell) {
                *fragment = Fragment { inverse_depth, primitive, local };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_keeps_the_part_beyond_the_near_plane() {
        let corners = [Vec3::new(0.0, 0.0, 2.0), Vec3::new(1.0, 0.0, -2.0), Vec3::new(0.0, 1.0, -2.0)];
        let kept = clip(corners, 1.0);
        assert_eq!(kept.len(), 3);
        for part in kept {
            let corner = corners[0] * part[0] + corners[1] * part[1] + corners[2] * part[2];
            assert!(corner.z >= 1.0 - 1e-6, "{corner}");
        }
        assert_eq!(clip(corners, -3.0).len(), 3);
        assert!(clip(corners, 3.0).is_empty());
    }
}
