//! What is seen at each sample: the nearest triangle or ball.

use super::Vec3;
use super::camera::Lens;
use super::mesh::Mesh;
use super::raster::{self, Budget};

/// What one sample sees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// 1 / depth; 0 where nothing is seen.
    pub nearness: f32,
    /// Index of the triangle, or, from `triangles.len()` on, of a ball.
    pub thing: u32,
    /// Weights of the second and third corner; for a ball the offset from its middle in radii.
    pub at: [f32; 2],
}

const NOTHING: Sample = Sample { nearness: 0.0, thing: u32::MAX, at: [0.0; 2] };

/// Finds what every sample of the picture sees, row by row from the top.
pub(super) fn find(mesh: &Mesh, lens: &Lens) -> Vec<Sample> {
    let mut samples = vec![NOTHING; lens.size[0] as usize * lens.size[1] as usize];
    let view: Vec<Vec3> = mesh.vertices.iter().map(|vertex| lens.to_view(&vertex.position)).collect();
    let mut budget = Budget::of(lens.size);
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let corners = triangle.corners.map(|corner| view[corner as usize]);
        draw_triangle(&mut samples, index as u32, corners, lens, &mut budget);
    }
    for (index, ball) in mesh.balls.iter().enumerate() {
        let thing = (mesh.triangles.len() + index) as u32;
        draw_ball(&mut samples, thing, lens.to_view(&ball.centre), ball.radius, lens);
    }
    samples
}

fn draw_triangle(samples: &mut [Sample], thing: u32, view: [Vec3; 3], lens: &Lens, budget: &mut Budget) {
    let near = lens.distance * 1e-3;
    if view.iter().all(|corner| corner.z >= near) {
        return draw_part(samples, thing, view, WHOLE, lens, budget);
    }
    let polygon = clip(view, near);
    for k in 2..polygon.len() {
        let parts = [0, k - 1, k].map(|corner| polygon[corner]);
        let corners = parts.map(|part| view[0] * part[0] + view[1] * part[1] + view[2] * part[2]);
        draw_part(samples, thing, corners, parts, lens, budget);
    }
}

/// The weights of a triangle's corners at these corners.
const WHOLE: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The part of a triangle that is not nearer than `near`, as weights of the corners; 0, 3 or 4 of them.
fn clip(view: [Vec3; 3], near: f32) -> Vec<[f32; 3]> {
    let mut kept = Vec::with_capacity(4);
    for k in 0..3 {
        let next = (k + 1) % 3;
        let (here, there) = (view[k].z - near, view[next].z - near);
        if here >= 0.0 {
            kept.push(WHOLE[k]);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let share = here / (here - there);
            let mut crossing = [0.0; 3];
            crossing[k] = 1.0 - share;
            crossing[next] = share;
            kept.push(crossing);
        }
    }
    kept
}

/// Draws a triangle that is all in front of the eye; `parts` are its corners as weights of the whole.
fn draw_part(
    samples: &mut [Sample],
    thing: u32,
    view: [Vec3; 3],
    parts: [[f32; 3]; 3],
    lens: &Lens,
    budget: &mut Budget,
) {
    let nearness = view.map(|corner| 1.0 / corner.z);
    let corners = view.map(|corner| lens.project(&corner));
    raster::cover(corners, lens.size, budget, |cell, weights| {
        // Weights on the picture, divided by depth, are weights in space (Heckbert and Moreton 1991).
        let scaled = [weights[0] * nearness[0], weights[1] * nearness[1], weights[2] * nearness[2]];
        let sum = scaled[0] + scaled[1] + scaled[2];
        if sum > samples[cell].nearness {
            let at = [1, 2].map(|k| (0..3).map(|part| parts[part][k] * scaled[part] / sum).sum());
            samples[cell] = Sample { nearness: sum, thing, at };
        }
    });
}

/// Draws a ball as a disc that bulges toward the eye.
fn draw_ball(samples: &mut [Sample], thing: u32, view: Vec3, radius: f32, lens: &Lens) {
    let [x, y] = lens.project(&view);
    let reach = lens.scale / view.z * radius;
    if view.z < radius * 2.0 || !(x + y + reach).is_finite() {
        return;
    }
    let span = |middle: f32, size: u32| {
        let low = (middle - reach).max(0.0) as u32;
        low..((middle + reach).ceil().max(0.0) as u32).min(size)
    };
    for row in span(y, lens.size[1]) {
        for column in span(x, lens.size[0]) {
            let at = [(column as f32 + 0.5 - x) / reach, (y - row as f32 - 0.5) / reach];
            let bulge = 1.0 - at[0] * at[0] - at[1] * at[1];
            let nearness = 1.0 / (view.z - radius * bulge.max(0.0).sqrt());
            let sample = &mut samples[(row * lens.size[0] + column) as usize];
            if bulge >= 0.0 && nearness > sample.nearness {
                *sample = Sample { nearness, thing, at };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_keeps_only_what_is_in_front() {
        let view = [Vec3::new(0.0, 0.0, 2.0), Vec3::new(1.0, 0.0, -2.0), Vec3::new(0.0, 1.0, -2.0)];
        let kept = clip(view, 1.0);
        assert_eq!(kept.len(), 3);
        for part in kept {
            let corner = view[0] * part[0] + view[1] * part[1] + view[2] * part[2];
            assert!(corner.z >= 1.0 - 1e-6, "{corner}");
        }
        assert_eq!(clip(view, -3.0).len(), 3);
        assert!(clip(view, 3.0).is_empty());
    }
}
