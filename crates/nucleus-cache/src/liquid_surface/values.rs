//! Values of particles on their surface, such as velocities for motion blur.

use std::collections::BTreeMap;

use super::LiquidSurface;

/// The reach of a particle in spacings, where the surface has no wider radius.
const REACH: f32 = 2.0;

/// Particles by cell.
struct Cells<'a> {
    particles: &'a [[f32; 3]],
    reach: f32,
    by_cell: BTreeMap<[i32; 3], Vec<u32>>,
}

impl LiquidSurface {
    /// The values of the surface's points: the mean of those of the particles within two spacings, or within twice the scale of
    /// their radius if that is above 1, which falls with the distance; else that of the nearest.
    pub fn values_of(
        &self,
        particles: &[[f32; 3]],
        (spacing, radius_scale): (f32, f32),
        values: &[[f32; 3]],
    ) -> Vec<[f32; 3]> {
        let cells = Cells::of(particles, REACH * spacing * radius_scale.max(1.0));
        self.positions.iter().map(|place| cells.value(place, values)).collect()
    }
}

impl<'a> Cells<'a> {
    fn of(particles: &'a [[f32; 3]], reach: f32) -> Self {
        let mut cells = Self { particles, reach, by_cell: BTreeMap::new() };
        for (at, place) in (0..).zip(particles) {
            cells.by_cell.entry(cells.cell(place)).or_default().push(at);
        }
        cells
    }

    /// Coordinates that are not finite are in some cell, and out of reach of all places.
    fn cell(&self, place: &[f32; 3]) -> [i32; 3] {
        place.map(|x| ((x / self.reach).floor() as i32).clamp(-(1 << 30), 1 << 30))
    }

    fn value(&self, place: &[f32; 3], values: &[[f32; 3]]) -> [f32; 3] {
        let [x, y, z] = self.cell(place);
        let (mut sum, mut weights) = ([0.0f32; 3], 0.0f32);
        for k in 0..27 {
            let cell = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
            for &at in self.by_cell.get(&cell).into_iter().flatten() {
                let near = 1.0 - square(place, &self.particles[at as usize]) / (self.reach * self.reach);
                if near > 0.0 {
                    let weight = near * near * near;
                    weights += weight;
                    (0..3).for_each(|axis| sum[axis] += weight * values[at as usize][axis]);
                }
            }
        }
        if weights > 0.0 { sum.map(|x| x / weights) } else { self.nearest(place, values) }
    }

    fn nearest(&self, place: &[f32; 3], values: &[[f32; 3]]) -> [f32; 3] {
        let distances = self.particles.iter().map(|particle| square(place, particle));
        let nearest = distances.zip(values).min_by(|(a, _), (b, _)| a.total_cmp(b));
        nearest.map_or([0.0; 3], |(_, value)| *value)
    }
}

fn square(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::SurfaceShape;

    #[test]
    fn a_surface_takes_the_motion_of_the_particles_about_it() {
        let block: Vec<[f32; 3]> =
            (0..216u16).map(|k| [k % 6, k / 6 % 6, k / 36].map(|x| 0.1 * f32::from(x))).collect();
        // A second body, 2 m away, moves the other way.
        let other = block.iter().map(|[x, y, z]| [x + 2.0, *y, *z]);
        let particles: Vec<_> = block.iter().copied().chain(other).collect();
        let turn = |[x, y, _]: &[f32; 3]| [0.25 - y, x - 0.25, 0.0];
        let values: Vec<_> = particles
            .iter()
            .map(|place| if place[0] < 1.0 { turn(place) } else { [-3.0, 0.0, 1.0] })
            .collect();
        for radius_scale in [1.0, 2.0] {
            let shape = SurfaceShape { radius_scale, ..SurfaceShape::DEFAULT };
            let surface = LiquidSurface::of(&particles, 0.1, shape);
            let found = surface.values_of(&particles, (0.1, radius_scale), &values);
            assert_eq!(found.len(), surface.positions.len());
            for (place, value) in surface.positions.iter().zip(&found) {
                let expected = if place[0] < 1.0 { turn(place) } else { [-3.0, 0.0, 1.0] };
                // The mean is that of a place up to the reach further inside: 0.1 m, and 0.2 m at twice the radius.
                let error = square(value, &expected).sqrt();
                assert!(error < 0.15 * radius_scale, "{place:?}: {value:?} instead of {expected:?}");
            }
        }
    }
}
