//! What one far light sees.

use super::mesh::Mesh;
use super::raster::{self, Budget};
use super::{Vec3, normals};

/// The nearest surface to a far light, in a square grid of cells.
pub(super) struct DepthMap {
    /// Toward the light.
    pub toward: Vec3,
    right: Vec3,
    up: Vec3,
    centre: Vec3,
    reach: f32,
    side: u32,
    /// Height of the highest surface toward the light, per cell.
    highest: Vec<f32>,
    /// The lowest and the highest of each tile of cells: most points need ask no more.
    tiles: Vec<[f32; 2]>,
}

/// Cells along a side of a tile.
const TILE: u32 = 8;

impl DepthMap {
    /// A light from this direction that has seen all of a mesh, `reach` to each side of `centre`.
    pub fn of(mesh: &Mesh, toward: Vec3, centre: Vec3, reach: f32, side: u32) -> Self {
        let aside = if toward.y.abs() > 0.9 { Vec3::x() } else { Vec3::y() };
        let right = normals::unit(&aside.cross(&toward));
        let highest = vec![f32::NEG_INFINITY; (side * side) as usize];
        let up = toward.cross(&right);
        let mut map = Self { toward, right, up, centre, reach, side, highest, tiles: Vec::new() };
        map.see(mesh);
        map.tiles = map.tile_heights();
        map
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
            self.see_ball(&ball.centre, ball.radius);
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
    pub fn lit(&self, position: &Vec3, normal: &Vec3, soft: i32) -> f32 {
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
        if let Some(lit) = self.lit_by_tiles([left as i32, top as i32], soft, at.z) {
            return lit;
        }
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

    /// The answer of [`lit`](Self::lit) where all cells in question lie above a height, or all below.
    fn lit_by_tiles(&self, [left, top]: [i32; 2], soft: i32, height: f32) -> Option<f32> {
        let last = |first: i32| (first + 2 * soft + 1) as u32;
        let (left, top) = (left - soft, top - soft);
        // Four cells are sooner asked than their tiles.
        if soft == 0 || left < 0 || top < 0 || last(left) >= self.side || last(top) >= self.side {
            return None;
        }
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for row in top as u32 / TILE..=last(top) / TILE {
            for column in left as u32 / TILE..=last(left) / TILE {
                let [lowest, highest] = self.tiles[(row * self.side.div_ceil(TILE) + column) as usize];
                (low, high) = (low.min(lowest), high.max(highest));
            }
        }
        if high <= height {
            Some(1.0)
        } else if low > height {
            Some(0.0)
        } else {
            None
        }
    }

    fn tile_heights(&self) -> Vec<[f32; 2]> {
        let across = self.side.div_ceil(TILE);
        let mut tiles = vec![[f32::INFINITY, f32::NEG_INFINITY]; (across * across) as usize];
        for (cell, height) in self.highest.iter().enumerate() {
            let (row, column) = (cell as u32 / self.side, cell as u32 % self.side);
            let tile = &mut tiles[(row / TILE * across + column / TILE) as usize];
            *tile = [tile[0].min(*height), tile[1].max(*height)];
        }
        tiles
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
    use proptest::prelude::*;

    use super::super::{Kind, Object, Style};
    use super::*;
    use crate::picture::camera::{Camera, Lens};

    /// A map of a slanted square that hangs over the origin.
    fn map() -> DepthMap {
        let faces = nucleus_core::Faces::from_iter([&[0u32, 1, 2, 3][..]]);
        let positions = [[-1.0, 1.0, 1.0], [1.0, 1.5, 1.0], [1.0, 1.5, -1.0], [-1.0, 1.0, -1.0]];
        let object = Object {
            name: "square",
            kind: Kind::Cloth,
            faces: &faces,
            positions: &positions,
            rest: None,
            radius: None,
        };
        let camera =
            Camera { eye: [0.0, 0.0, 5.0], target: [0.0; 3], field_of_view: 30.0, ..Camera::default() };
        let mesh = Mesh::gather(&[object], &Style::default(), &Lens::new(&camera, [64, 64]));
        DepthMap::of(&mesh, Vec3::new(0.0, 1.0, 0.0), Vec3::zeros(), 2.0, 100)
    }

    #[test]
    fn a_light_from_above_does_not_reach_below_a_sheet() {
        let map = map();
        let lit = |x: f32, y: f32| map.lit(&Vec3::new(x, y, 0.0), &Vec3::y(), 2);
        assert_eq!([lit(0.0, 0.0), lit(0.0, 3.0), lit(1.8, 0.0), lit(9.0, 0.0)], [0.0, 1.0, 1.0, 1.0]);
        let edge = lit(1.0, 0.0);
        assert!(edge > 0.2 && edge < 0.8, "half at the edge of the shadow: {edge}");
    }

    proptest! {
        #[test]
        fn tiles_say_what_their_cells_say(x in -2.5f32..2.5, y in -1.0f32..3.0, z in -2.5f32..2.5) {
            let (fast, mut slow) = (map(), map());
            slow.tiles.fill([f32::NEG_INFINITY, f32::INFINITY]); // never sure
            let lit = |map: &DepthMap| map.lit(&Vec3::new(x, y, z), &Vec3::y(), 2);
            prop_assert!((lit(&fast) - lit(&slow)).abs() < 1e-5);
        }
    }
}
