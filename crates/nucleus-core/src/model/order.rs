//! The solver's order of points: along a Morton curve, so that points near in space are near in memory. [`Order`] maps
//! between it and the order of the mesh.

use nalgebra::Vector3;

/// A permutation of the points of one object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Order {
    /// The mesh's point at each place of the solver's order.
    user: Vec<u32>,
    /// The place of each point of the mesh in the solver's order.
    place: Vec<u32>,
}

impl Order {
    /// The order along a Morton curve through the bounding box; points in the same cell keep the order of the mesh.
    pub fn morton(positions: &[Vector3<f64>]) -> Self {
        let zero = positions.first().copied().unwrap_or_default();
        let (low, high) = positions.iter().fold((zero, zero), |(low, high), p| (low.inf(p), high.sup(p)));
        let size = (high - low).max().max(f64::MIN_POSITIVE);
        let key = |p: &Vector3<f64>| {
            let cell = (p - low) * (f64::from(CELLS) / size);
            interleave(cell.x) | interleave(cell.y) << 1 | interleave(cell.z) << 2
        };
        let mut keyed: Vec<(u64, u32)> = positions.iter().map(key).zip(0..).collect();
        keyed.sort_unstable();
        let user: Vec<u32> = keyed.into_iter().map(|(_, point)| point).collect();
        let mut place = vec![0; user.len()];
        (0..).zip(&user).for_each(|(at, &point)| place[point as usize] = at);
        Self { user, place }
    }

    /// The order of the mesh.
    pub fn identity(points: usize) -> Self {
        let order: Vec<u32> = (0..points as u32).collect();
        Self { user: order.clone(), place: order }
    }

    /// The mesh's point at a place of the solver's order.
    pub fn user(&self, place: usize) -> usize {
        self.user[place] as usize
    }

    /// The place of a point of the mesh in the solver's order.
    pub fn place(&self, point: usize) -> u32 {
        self.place[point]
    }

    /// The places of all points, in the order of the mesh.
    pub fn places(&self) -> &[u32] {
        &self.place
    }
}

/// An order of positions for a tree with leaves of `leaf` elements: halved across the longest side recursively, so that
/// the elements of each subtree are close together. The lower half is as large as a full tree of leaves; the upper half
/// has the remainder.
pub fn by_halves(centres: &[Vector3<f64>], leaf: usize) -> Vec<u32> {
    let zero = centres.first().copied().unwrap_or_default();
    let (low, high) = centres.iter().fold((zero, zero), |(low, high), p| (low.inf(p), high.sup(p)));
    let scale = HALVING_CELLS / (high - low).max().max(f64::MIN_POSITIVE);
    // Rounded to a grid, so that positions a rounding error apart have the same key wherever the object is.
    let cells: Vec<[i64; 3]> =
        centres.iter().map(|p| ((p - low) * scale).map(|x| x.round() as i64).into()).collect();
    let mut order: Vec<u32> = (0..centres.len() as u32).collect();
    halve(&mut order, &cells, leaf);
    order
}

/// Grid cells along the longest side of the bounding box, for halving.
const HALVING_CELLS: f64 = 1e6;

fn halve(order: &mut [u32], cells: &[[i64; 3]], leaf: usize) {
    if order.len() <= leaf {
        return order.sort_unstable();
    }
    let half = leaf * order.len().div_ceil(leaf).next_power_of_two() / 2;
    let cell = |at: u32| cells[at as usize];
    let side = |axis: usize| {
        let along = || order.iter().map(|&at| cell(at)[axis]);
        along().max().unwrap_or(0) - along().min().unwrap_or(0)
    };
    let axis = (1..3).fold(0, |longest, axis| if side(axis) > side(longest) { axis } else { longest });
    order.select_nth_unstable_by_key(half, |&at| (cell(at)[axis], at));
    let (lower, upper) = order.split_at_mut(half);
    halve(lower, cells, leaf);
    halve(upper, cells, leaf);
}

/// Cells of the Morton curve along the longest side of the bounding box.
const CELLS: u32 = (1 << 21) - 1;

/// The low 21 bits of a number, two zeros after each.
fn interleave(x: f64) -> u64 {
    let mut x = u64::from((x as u32).min(CELLS));
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn user_is_the_inverse_of_place(
            points in proptest::collection::vec(proptest::array::uniform3(-1e3..1e3f64), 1..200)
        ) {
            let order = Order::morton(&points.iter().map(|&p| p.into()).collect::<Vec<_>>());
            prop_assert!((0..points.len()).all(|point| order.user(order.place(point) as usize) == point));
        }
    }

    #[test]
    fn halving_a_grid_gives_square_leaves() {
        let grid: Vec<_> =
            (0..32 * 32).map(|k| Vector3::new(f64::from(k % 32), 0.0, f64::from(k / 32))).collect();
        let order = by_halves(&grid, 16);
        let mut all = order.clone();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..32 * 32), "each element occurs once");
        for leaf in order.chunks(16) {
            let places = || leaf.iter().map(|&at| grid[at as usize]);
            let (low, high) = (places().reduce(|a, b| a.inf(&b)), places().reduce(|a, b| a.sup(&b)));
            assert_eq!(high.zip(low).map(|(high, low)| high - low), Some(Vector3::new(3.0, 0.0, 3.0)));
        }
    }

    #[test]
    fn points_near_in_space_are_near_in_memory() {
        let grid: Vec<_> =
            (0..64 * 64).map(|k| Vector3::new(f64::from(k % 64), 0.0, f64::from(k / 64))).collect();
        let order = Order::morton(&grid);
        let mean_jump =
            (1..grid.len()).map(|at| (grid[order.user(at)] - grid[order.user(at - 1)]).norm()).sum::<f64>()
                / grid.len() as f64;
        assert!(mean_jump < 2.0, "{mean_jump}");
    }
}
