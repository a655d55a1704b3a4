//! New particles that would overlap others of their object are left out (`emissionOverlapPruning`).

use std::collections::BTreeMap;

use nalgebra::Vector3;

/// The places of all particles of an object, by cells whose edge is the least distance.
#[derive(Debug)]
pub struct Crowd {
    distance: f64,
    cells: BTreeMap<[i64; 3], Vec<Vector3<f64>>>,
}

impl Crowd {
    /// Of particles that keep a distance in metres from new ones.
    pub fn new(distance: f64, places: impl Iterator<Item = Vector3<f64>>) -> Self {
        let mut crowd = Self { distance, cells: BTreeMap::new() };
        places.for_each(|place| crowd.add(place));
        crowd
    }

    /// Adds a particle.
    pub fn add(&mut self, place: Vector3<f64>) {
        self.cells.entry(self.cell(place)).or_default().push(place);
    }

    /// Whether a particle at this place would be nearer than the distance to another.
    pub fn overlaps(&self, place: Vector3<f64>) -> bool {
        let [x, y, z] = self.cell(place);
        let is_near = |other: &Vector3<f64>| (other - place).norm_squared() < self.distance * self.distance;
        (0..27).any(|k| {
            let cell = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
            self.cells.get(&cell).is_some_and(|others| others.iter().any(is_near))
        })
    }

    /// Coordinates are bounded, so that their cells are whole numbers.
    fn cell(&self, place: Vector3<f64>) -> [i64; 3] {
        (place / self.distance).map(|x| x.floor().clamp(-1e18, 1e18) as i64).into()
    }
}
