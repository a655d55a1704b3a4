//! What the lights see: a key light with a shadow, and a dome of many weak ones for soft shade.

use super::camera::Lens;
use super::mesh::Mesh;
use super::raster::{self, Budget};
use super::{Vec3, normals};

/// Directions of the dome; each is a depth map of its own.
const DOME: usize = 40;
const DOME_SIDE: u32 = 192;
const KEY_SIDE: u32 = 1536;

/// The lights of a picture. The dome is why folds read: a crease sees little of the sky.
pub(super) struct Light {
    key: DepthMap,
    dome: Vec<DepthMap>,
}

impl Light {
    /// Toward the key light, from over the left shoulder of the eye.
    pub fn key_direction(lens: &Lens) -> Vec3 {
        // Turned with the camera sideways only, so that light always falls from above.
        let level = normals::unit(&lens.right.cross(&Vec3::y()));
        normals::unit(&(Vec3::y() * 1.0 - lens.right * 0.62 + level * 0.38))
    }

    /// Lights what is seen round the camera's target.
    pub fn around(mesh: &Mesh, lens: &Lens) -> Self {
        let reach = lens.reach();
        let map = |toward: Vec3, side: u32, reach: f32| {
            let mut map = DepthMap::new(toward, lens.target, reach, side);
            map.see(mesh);
            map
        };
        Self {
            key: map(Self::key_direction(lens), KEY_SIDE, reach * 1.3),
            dome: dome_directions().map(|toward| map(toward, DOME_SIDE, reach * 1.3)).collect(),
        }
    }

    /// The share of the key light that reaches a point of a surface with this normal, 0 to 1.
    pub fn key_reaches(&self, position: &Vec3, normal: &Vec3) -> f32 {
        self.key.lit(position, normal, 2)
    }

    /// The share of the sky that is seen from a point of a surface with this normal, 0 to 1.
    pub fn openness(&self, position: &Vec3, normal: &Vec3) -> f32 {
        let (mut seen, mut all) = (0.0, 0.0);
        for map in &self.dome {
            let weight = map.toward.dot(normal);
            if weight > 0.0 {
                all += weight;
                seen += weight * map.lit(position, normal, 0);
            }
        }
        // Facing straight down: no light of the dome is on that side.
        if all > 0.0 { seen / all } else { 1.0 }
    }
}

/// Evenly spread directions on the upper half sphere: equal steps of height, and the golden angle
/// between neighbours, turned by a constant rotation because sine and cosine differ between machines.
fn dome_directions() -> impl Iterator<Item = Vec3> {
    const TURN: [f32; 2] = [-0.737_368_9, 0.675_490_3];
    let mut around = [1.0f32, 0.0];
    (0..DOME).map(move |k| {
        let height = (k as f32 + 0.5) / DOME as f32;
        let flat = (1.0 - height * height).sqrt();
        let direction = Vec3::new(around[0] * flat, height, around[1] * flat);
        around = [around[0] * TURN[0] - around[1] * TURN[1], around[0] * TURN[1] + around[1] * TURN[0]];
        direction
    })
}

/// The nearest surface to a far light, in a square grid of cells.
struct DepthMap {
    toward: Vec3,
    right: Vec3,
    up: Vec3,
    centre: Vec3,
    reach: f32,
    side: u32,
    /// Height of the highest surface toward the light, per cell.
    highest: Vec<f32>,
}

impl DepthMap {
    fn new(toward: Vec3, centre: Vec3, reach: f32, side: u32) -> Self {
        let aside = if toward.y.abs() > 0.9 { Vec3::x() } else { Vec3::y() };
        let right = normals::unit(&aside.cross(&toward));
        let highest = vec![f32::NEG_INFINITY; (side * side) as usize];
        Self { toward, right, up: toward.cross(&right), centre, reach, side, highest }
    }

    /// Column, row and height of a point.
    fn at(&self, position: &Vec3) -> Vec3 {
        let offset = position - self.centre;
        let cells = 0.5 * self.side as f32;
        let cell = |axis: &Vec3| cells + offset.dot(axis) / self.reach * cells;
        Vec3::new(cell(&self.right), cell(&self.up), offset.dot(&self.toward))
    }

    fn see(&mut self, mesh: &Mesh) {
        let mut budget = Budget::of([self.side; 2]);
        let seen: Vec<Vec3> = mesh.vertices.iter().map(|vertex| self.at(&vertex.position)).collect();
        for triangle in &mesh.triangles {
            let corners = triangle.corners.map(|corner| seen[corner as usize]);
            let flat = corners.map(|corner| [corner.x, corner.y]);
            raster::cover(flat, [self.side; 2], &mut budget, |cell, weights| {
                let height = (0..3).map(|k| corners[k].z * weights[k]).sum::<f32>();
                self.highest[cell] = self.highest[cell].max(height);
            });
        }
        for ball in &mesh.balls {
            self.see_ball(&ball.centre, mesh.ball_radius);
        }
    }

    fn see_ball(&mut self, centre: &Vec3, radius: f32) {
        let at = self.at(centre);
        let cells = radius / self.reach * 0.5 * self.side as f32;
        let range = |middle: f32| {
            let low = (middle - cells).ceil().max(0.0) as u32;
            low..((middle + cells).ceil().max(0.0) as u32).max(low.saturating_add(1)).min(self.side)
        };
        for row in range(at.y) {
            for column in range(at.x) {
                let cell = &mut self.highest[(row * self.side + column) as usize];
                *cell = cell.max(at.z);
            }
        }
    }

    /// The share of this light that reaches a point, smoothed over `soft` cells to each side.
    fn lit(&self, position: &Vec3, normal: &Vec3, soft: i32) -> f32 {
        let cell = 2.0 * self.reach / self.side as f32;
        // A surface must not shade itself: look from a little off it, further where light grazes it.
        let lift = cell * (0.75 + 0.5 * soft as f32);
        let at = self.at(&(position + normal * lift));
        let (column, row) = (at.x - 0.5, at.y - 0.5);
        let near = -(soft as f32) - 2.0..self.side as f32 + soft as f32 + 1.0;
        if !near.contains(&column) || !near.contains(&row) {
            return 1.0; // nothing shades what is outside the map
        }
        let (left, top) = (column.floor(), row.floor());
        let (to_right, to_bottom) = (column - left, row - top);
        let mut sum = 0.0;
        for down in -soft..=soft + 1 {
            let tall = edge_weight(down, soft, to_bottom);
            for across in -soft..=soft + 1 {
                let weight = tall * edge_weight(across, soft, to_right);
                if self.height(left as i32 + across, top as i32 + down) <= at.z {
                    sum += weight;
                }
            }
        }
        sum / ((2 * soft + 1) * (2 * soft + 1)) as f32
    }

    /// The height in a cell; as low as can be outside the map.
    fn height(&self, column: i32, row: i32) -> f32 {
        let inside = |cell: i32| (0..self.side as i32).contains(&cell);
        if inside(column) && inside(row) {
            self.highest[(row * self.side as i32 + column) as usize]
        } else {
            f32::NEG_INFINITY
        }
    }
}

/// Weight of a cell in a box of `2 soft + 1` cells that lies `past` of a cell further on.
fn edge_weight(cell: i32, soft: i32, past: f32) -> f32 {
    if cell == -soft {
        1.0 - past
    } else if cell == soft + 1 {
        past
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dome_is_even_round_the_vertical() {
        let sum = dome_directions().fold(Vec3::zeros(), |sum, direction| sum + direction) / DOME as f32;
        assert!(sum.x.abs() < 0.03 && sum.z.abs() < 0.03, "{sum}");
        assert!((sum.y - 0.5).abs() < 1e-5, "{sum}");
        assert!(dome_directions().all(|direction| (direction.norm() - 1.0).abs() < 1e-4));
    }
}
