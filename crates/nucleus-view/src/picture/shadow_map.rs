//! Shadow maps of directional lights, filtered by percentage-closer filtering (Reeves et al. 1987).

use super::mesh::Mesh;
use super::raster::{Budget, rasterise};
use super::scene::{Vec3, unit};

/// The surfaces nearest to a directional light, in a square grid of cells.
pub(super) struct ShadowMap {
    /// Direction to the light.
    pub to_light: Vec3,
    right: Vec3,
    up: Vec3,
    centre: Vec3,
    half_extent: f32,
    side: u32,
    /// Height of the surface nearest to the light, per cell, along the direction to the light.
    heights: Vec<f32>,
    /// The lowest and the highest value of each tile of cells, which decide most queries.
    tiles: Vec<[f32; 2]>,
}

/// Side of a tile, in cells.
const TILE: u32 = 8;

impl ShadowMap {
    /// The map of a mesh for a light in this direction, of `side` cells, over `half_extent` to each side of `centre`.
    pub fn of(mesh: &Mesh, to_light: Vec3, centre: Vec3, half_extent: f32, side: u32) -> Self {
        let aside = if to_light.y.abs() > 0.9 { Vec3::x() } else { Vec3::y() };
        let right = unit(&aside.cross(&to_light));
        let heights = vec![f32::NEG_INFINITY; (side * side) as usize];
        let up = to_light.cross(&right);
        let mut map = Self { to_light, right, up, centre, half_extent, side, heights, tiles: Vec::new() };
        map.render(mesh);
        map.tiles = map.tile_ranges();
        map
    }

    /// Column, row and height of a point, in cells and scene units.
    fn at(&self, position: &Vec3) -> Vec3 {
        let offset = position - self.centre;
        let cells = 0.5 * self.side as f32;
        let cell = |axis: &Vec3| cells + offset.dot(axis) / self.half_extent * cells;
        Vec3::new(cell(&self.right), cell(&self.up), offset.dot(&self.to_light))
    }

    fn render(&mut self, mesh: &Mesh) {
        let mut budget = Budget::of([self.side; 2]);
        let vertices: Vec<Vec3> = mesh.vertices.iter().map(|vertex| self.at(&vertex.position)).collect();
        for triangle in &mesh.triangles {
            let corners = triangle.corners.map(|corner| vertices[corner as usize]);
            let flat = corners.map(|corner| [corner.x, corner.y]);
            rasterise(flat, [self.side; 2], &mut budget, |cell, weights| {
                let height = (0..3).map(|k| corners[k].z * weights[k]).sum::<f32>();
                self.heights[cell] = self.heights[cell].max(height);
            });
        }
        for sphere in &mesh.spheres {
            self.render_sphere(&sphere.centre, sphere.radius);
        }
    }

    /// Draws a sphere as a disc through its centre, of one cell at least.
    fn render_sphere(&mut self, centre: &Vec3, radius: f32) {
        let at = self.at(centre);
        let cells = (radius / self.half_extent * 0.5 * self.side as f32).max(std::f32::consts::FRAC_1_SQRT_2);
        let range = |middle: f32| {
            let low = (middle - cells).floor().max(0.0) as u32;
            low..((middle + cells).ceil().max(0.0) as u32).min(self.side)
        };
        for row in range(at.y) {
            for column in range(at.x) {
                let [across, up] = [column as f32 + 0.5 - at.x, row as f32 + 0.5 - at.y];
                if across * across + up * up <= cells * cells {
                    let cell = &mut self.heights[(row * self.side + column) as usize];
                    *cell = cell.max(at.z);
                }
            }
        }
    }

    /// The fraction of this light that reaches a point, 0 to 1, filtered over `radius` cells to each side.
    pub fn visibility(&self, position: &Vec3, normal: &Vec3, radius: i32) -> f32 {
        let cell = 2.0 * self.half_extent / self.side as f32;
        // An offset along the normal keeps a surface from shading itself. On a slope the cells at the rim of the filter are
        // higher than the point, by `radius + 1` cells at most along both axes.
        let slope = normal.dot(&self.right).abs() + normal.dot(&self.up).abs();
        let lift = cell * (0.75 + 0.5 * radius as f32).max((radius + 1) as f32 * slope);
        let at = self.at(&(position + normal * lift));
        let (column, row) = (at.x - 0.5, at.y - 0.5);
        let near = -(radius as f32) - 2.0..self.side as f32 + radius as f32 + 1.0;
        if !near.contains(&column) || !near.contains(&row) {
            return 1.0; // outside the map nothing casts a shadow
        }
        let (left, top) = (column.floor(), row.floor());
        if let Some(visibility) = self.visibility_by_tiles([left as i32, top as i32], radius, at.z) {
            return visibility;
        }
        let (to_right, to_bottom) = (column - left, row - top);
        let mut sum = 0.0;
        for down in -radius..=radius + 1 {
            let row_weight = filter_weight(down, radius, to_bottom);
            for across in -radius..=radius + 1 {
                let weight = row_weight * filter_weight(across, radius, to_right);
                if self.height(left as i32 + across, top as i32 + down) <= at.z {
                    sum += weight;
                }
            }
        }
        sum / ((2 * radius + 1) * (2 * radius + 1)) as f32
    }

    /// The result of [`visibility`](Self::visibility) where all cells of the filter lie above a height, or all below.
    fn visibility_by_tiles(&self, [left, top]: [i32; 2], radius: i32, height: f32) -> Option<f32> {
        let last = |first: i32| (first + 2 * radius + 1) as u32;
        let (left, top) = (left - radius, top - radius);
        // Reading four cells is faster than reading their tiles.
        if radius == 0 || left < 0 || top < 0 || last(left) >= self.side || last(top) >= self.side {
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

    fn tile_ranges(&self) -> Vec<[f32; 2]> {
        let across = self.side.div_ceil(TILE);
        let mut tiles = vec![[f32::INFINITY, f32::NEG_INFINITY]; (across * across) as usize];
        for (cell, height) in self.heights.iter().enumerate() {
            let (row, column) = (cell as u32 / self.side, cell as u32 % self.side);
            let tile = &mut tiles[(row / TILE * across + column / TILE) as usize];
            *tile = [tile[0].min(*height), tile[1].max(*height)];
        }
        tiles
    }

    /// The height in a cell; negative infinity outside the map.
    fn height(&self, column: i32, row: i32) -> f32 {
        let inside = |cell: i32| (0..self.side as i32).contains(&cell);
        if inside(column) && inside(row) {
            self.heights[(row * self.side as i32 + column) as usize]
        } else {
            f32::NEG_INFINITY
        }
    }
}

/// Weight of a cell in a box filter of `2 radius + 1` cells, shifted by the fraction `shift` of a cell.
fn filter_weight(cell: i32, radius: i32, shift: f32) -> f32 {
    if cell == -radius {
        1.0 - shift
    } else if cell == radius + 1 {
        shift
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::camera::{Camera, View};
    use super::super::scene::{Kind, Object, Style};
    use super::*;

    /// The map of a slanted square above the origin.
    fn map() -> ShadowMap {
        let positions = [[-1.0, 1.0, 1.0], [1.0, 1.5, 1.0], [1.0, 1.5, -1.0], [-1.0, 1.0, -1.0]];
        map_of(Kind::Cloth, &nucleus_core::Faces::from_iter([&[0u32, 1, 2, 3][..]]), &positions)
    }

    /// The map of an object under a light from above.
    fn map_of(kind: Kind, faces: &nucleus_core::Faces, positions: &[[f32; 3]]) -> ShadowMap {
        let radius = Some(1.0);
        let object = Object { name: "it", kind, faces, positions, rest: None, radius, looks: None };
        let camera =
            Camera { eye: [0.0, 0.0, 5.0], target: [0.0; 3], field_of_view: 30.0, ..Camera::default() };
        let mesh = Mesh::gather(&[object], &Style::default(), &View::new(&camera, [64, 64]));
        ShadowMap::of(&mesh, Vec3::new(0.0, 1.0, 0.0), Vec3::zeros(), 2.0, 100)
    }

    #[test]
    fn a_light_from_above_does_not_reach_below_a_sheet() {
        let map = map();
        let visibility = |x: f32, y: f32| map.visibility(&Vec3::new(x, y, 0.0), &Vec3::y(), 2);
        let found = [[0.0, 0.0], [0.0, 3.0], [1.8, 0.0], [9.0, 0.0]].map(|[x, y]| visibility(x, y));
        assert_eq!(found, [0.0, 1.0, 1.0, 1.0]);
        let edge = visibility(1.0, 0.0);
        assert!(edge > 0.2 && edge < 0.8, "a soft edge of the shadow: {edge}");
    }

    #[test]
    fn the_shadow_of_a_particle_is_round() {
        let map = map_of(Kind::Particles, &nucleus_core::Faces::default(), &[[0.0, 1.0, 0.0]]);
        let visibility = |x: f32, z: f32| map.visibility(&Vec3::new(x, 0.0, z), &Vec3::y(), 0);
        for angle in [0.0f32, 0.4, 0.8, 2.0, 4.0] {
            let (z, x) = angle.sin_cos();
            assert_eq!(visibility(0.9 * x, 0.9 * z), 0.0, "{angle}");
            assert_eq!(visibility(1.1 * x, 1.1 * z), 1.0, "{angle}");
        }
    }

    #[test]
    fn a_large_plane_does_not_shade_itself_at_any_slope() {
        for degrees in [0.0f32, 20.0, 40.0, 60.0, 75.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (across, normal) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0));
            let corner = |[x, z]: [f32; 2]| (across * x + Vec3::z() * z).into();
            let positions = [[-400.0, -500.0], [600.0, -500.0], [600.0, 500.0], [-400.0, 500.0]].map(corner);
            let faces = nucleus_core::Faces::from_iter([&[0u32, 3, 2, 1][..]]);
            let map = map_of(Kind::Collider, &faces, &positions);
            for radius in [1, 2] {
                for k in 0..2000 {
                    let place =
                        across * (0.0007 * k as f32 - 0.7) * cos + Vec3::z() * (0.31 * k as f32).sin();
                    let visible = map.visibility(&place, &normal, radius);
                    assert!(visible > 0.999, "{degrees} degrees, radius {radius}, {place}: {visible}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn tiles_agree_with_their_cells(x in -2.5f32..2.5, y in -1.0f32..3.0, z in -2.5f32..2.5) {
            let (fast, mut slow) = (map(), map());
            slow.tiles.fill([f32::NEG_INFINITY, f32::INFINITY]); // never decisive
            let visibility = |map: &ShadowMap| map.visibility(&Vec3::new(x, y, z), &Vec3::y(), 2);
            prop_assert!((visibility(&fast) - visibility(&slow)).abs() < 1e-5);
        }
    }
}
