//! Neighbour search: particles sorted into the cells of a uniform grid by a counting sort.
//!
//! A cell is as wide as the reach of a query, so the neighbours of a particle are in 27 cells. Cells that follow each other
//! along x follow each other in the table, so that these are nine runs. The number of a cell is `x + A y + B z`, modulo the
//! length of the table. While the liquid is compact, A and B are the sizes of its bounding box, and no two cells share an
//! entry; a spray that is scattered widely shares entries, and the distance test leaves foreign particles out.

use std::ops::Range;

/// Entries of the table per particle, at least.
const ENTRIES: usize = 2;
/// Least number of entries.
const MIN_ENTRIES: usize = 128;

/// Particles by cell.
#[derive(Debug, Default)]
pub struct CellGrid {
    /// First particle of each entry in the sorted order, and the end of the last.
    starts: Vec<u32>,
    /// The particles in the order of cells.
    order: Vec<u32>,
    cells: Vec<u32>,
    low: [f32; 3],
    per_cell: f32,
    factors: [u32; 2],
    mask: u32,
}

impl CellGrid {
    /// Sorts particles into cells of this width.
    pub fn sort(&mut self, positions: &[[f32; 3]], width: f32) {
        let [low, high] = bounds(positions);
        self.low = low;
        self.per_cell = 1.0 / width;
        let entries = (ENTRIES * positions.len()).max(MIN_ENTRIES).next_power_of_two();
        self.mask = entries as u32 - 1;
        self.factors = factors(std::array::from_fn(|axis| (high[axis] - low[axis]) / width), self.mask);
        let mut cells = std::mem::take(&mut self.cells);
        cells.clear();
        cells.extend(positions.iter().map(|&place| {
            let [x, y, z] = self.cell(place);
            self.entry(x, y, z)
        }));
        self.cells = cells;
        self.starts.clear();
        self.starts.resize(entries + 1, 0);
        self.cells.iter().for_each(|&cell| self.starts[cell as usize + 1] += 1);
        for entry in 1..=entries {
            self.starts[entry] += self.starts[entry - 1];
        }
        self.order.clear();
        self.order.resize(positions.len(), 0);
        for (particle, &cell) in self.cells.iter().enumerate() {
            let next = &mut self.starts[cell as usize];
            self.order[*next as usize] = particle as u32;
            *next += 1;
        }
        // Each start has moved to the start of the next entry.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// The particles in the order of cells.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Visits the runs of the sorted order that hold what is in a cell and in those about it.
    #[inline(always)]
    pub fn visit_runs(&self, [x, y, z]: [u32; 3], mut visit: impl FnMut(Range<usize>)) {
        let mut run = |first: u32, last: u32| {
            let [start, end] = [first, last + 1].map(|entry| self.starts[entry as usize] as usize);
            if start < end {
                visit(start..end);
            }
        };
        for k in 0..9 {
            let row = self.entry(
                x.wrapping_sub(1),
                y.wrapping_add(k % 3).wrapping_sub(1),
                z.wrapping_add(k / 3).wrapping_sub(1),
            );
            let last = row + 2;
            run(row, last.min(self.mask));
            // A row of three cells may pass the end of the table.
            if last > self.mask {
                run(0, last - self.mask - 1);
            }
        }
    }

    /// The cell of a place.
    #[inline]
    pub fn cell(&self, place: [f32; 3]) -> [u32; 3] {
        std::array::from_fn(|axis| {
            let cells = (place[axis] - self.low[axis]) * self.per_cell;
            // Rounded down; beyond 2³¹ cells a spray shares them.
            let cell = cells as i32;
            cell.wrapping_sub(i32::from(cells < cell as f32)) as u32
        })
    }

    #[inline]
    fn entry(&self, x: u32, y: u32, z: u32) -> u32 {
        let [a, b] = self.factors;
        x.wrapping_add(a.wrapping_mul(y)).wrapping_add(b.wrapping_mul(z)) & self.mask
    }
}

/// The low and the high corner of the bounding box of some places.
pub fn bounds(positions: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let first = positions.first().copied().unwrap_or_default();
    positions.iter().fold([first, first], |[low, high], place| {
        [
            std::array::from_fn(|axis| low[axis].min(place[axis])),
            std::array::from_fn(|axis| high[axis].max(place[axis])),
        ]
    })
}

/// Factors such that the nine rows about a cell have no entry in common.
fn factors(cells: [f32; 3], mask: u32) -> [u32; 2] {
    let width = |cells: f32| (cells.clamp(0.0, 1e6) as u32).saturating_add(4);
    let mut a = width(cells[0]) & mask;
    let mut b = a.wrapping_mul(width(cells[1])) & mask;
    let apart = |a: u32, b: u32| {
        let row = |k: u32| a.wrapping_mul(k % 3).wrapping_add(b.wrapping_mul(k / 3)) & mask;
        (0..9).all(|k| {
            (0..k).all(|other| {
                let gap = row(k).wrapping_sub(row(other)) & mask;
                gap.min((mask + 1) - gap) >= 3
            })
        })
    };
    while !apart(a, b) {
        b = b.wrapping_add(3) & mask;
        if b < 3 {
            a = a.wrapping_add(1) & mask;
        }
    }
    [a, b]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A spread of places without a pattern.
    pub fn spread(count: usize, size: f32) -> Vec<[f32; 3]> {
        let mut seed = 1u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 * size
        };
        (0..count).map(|_| [next(), next(), next()]).collect()
    }

    #[test]
    fn every_neighbour_is_found_once_however_far_particles_are_scattered() {
        for (count, size) in [(1, 0.1), (500, 3.0), (500, 40.0), (300, 1e5)] {
            let positions = spread(count, size);
            let mut grid = CellGrid::default();
            grid.sort(&positions, 1.0);
            for (at, place) in positions.iter().enumerate() {
                let near =
                    |other: &[f32; 3]| (0..3).map(|k| (place[k] - other[k]).powi(2)).sum::<f32>() < 1.0;
                let mut found = Vec::new();
                grid.visit_runs(grid.cell(*place), |run| found.extend_from_slice(&grid.order()[run]));
                found.retain(|&k| near(&positions[k as usize]));
                found.sort_unstable();
                let expected: Vec<u32> =
                    (0..count as u32).filter(|&k| near(&positions[k as usize])).collect();
                assert_eq!(found, expected, "particle {at} of {count} in {size}");
            }
        }
    }
}
