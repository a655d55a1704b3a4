//! New particles among others of their object: those that would overlap one are left out (`emissionOverlapPruning`), and
//! those that would touch too many are refused.
//!
//! All particles in one place touch each other, so contact among them takes memory with the square of their number.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::input::frame::ClothFrame;

/// Others of its object that a particle may touch at its birth, at most.
pub const MAX_TOUCHING: usize = 64;

/// The places of particles of an object, by cells whose edge is the larger distance.
#[derive(Debug)]
pub struct OccupancyGrid {
    /// Distance in metres that new particles keep from others; 0 where they may overlap.
    pruned: f64,
    /// Distance in metres at which particles touch; 0 where they do not collide.
    touching: f64,
    cells: BTreeMap<[i64; 3], Vec<Vector3<f64>>>,
}

impl OccupancyGrid {
    /// That of an object, of its particles at `places` that are near new ones between two corners; `None` where new particles
    /// need not know of others.
    pub fn of(
        cloth: &ClothFrame,
        places: impl Iterator<Item = Vector3<f64>>,
        [low, high]: [Vector3<f64>; 2],
    ) -> Option<Self> {
        let own = &cloth.self_collision;
        let pruned = 2.0 * own.thickness * cloth.overlap_pruning;
        let touching = if own.on { 2.0 * own.thickness } else { 0.0 };
        let [pruned, touching] = [pruned, touching].map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 });
        let mut grid = Self { pruned, touching, cells: BTreeMap::new() };
        if grid.edge() <= 0.0 {
            return None;
        }
        let (low, high) = (low.add_scalar(-grid.edge()), high.add_scalar(grid.edge()));
        let is_near =
            |place: &Vector3<f64>| (0..3).all(|axis| low[axis] <= place[axis] && place[axis] <= high[axis]);
        places.filter(is_near).for_each(|place| grid.add(place));
        Some(grid)
    }

    fn edge(&self) -> f64 {
        self.pruned.max(self.touching)
    }

    /// Adds a particle.
    pub fn add(&mut self, place: Vector3<f64>) {
        self.cells.entry(self.cell(place)).or_default().push(place);
    }

    /// Whether a particle at this place is left out, because it would overlap another.
    pub fn prunes(&self, place: Vector3<f64>) -> bool {
        self.has_within(self.pruned, place, 1)
    }

    /// Whether a particle at this place is refused, because it would touch more than [`MAX_TOUCHING`] others.
    pub fn refuses(&self, place: Vector3<f64>) -> bool {
        self.has_within(self.touching, place, MAX_TOUCHING + 1)
    }

    /// Whether so many particles are nearer to a place than a distance, which is no larger than the edge of a cell.
    fn has_within(&self, distance: f64, place: Vector3<f64>, count: usize) -> bool {
        let [x, y, z] = self.cell(place);
        let is_near = |other: &&Vector3<f64>| (*other - place).norm_squared() < distance * distance;
        let cells = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let others = cells.filter_map(|cell| self.cells.get(&cell)).flatten();
        others.filter(is_near).take(count).count() == count
    }

    /// Coordinates are bounded, so that their cells are whole numbers.
    fn cell(&self, place: Vector3<f64>) -> [i64; 3] {
        (place / self.edge()).map(|x| x.floor().clamp(-1e18, 1e18) as i64).into()
    }
}
