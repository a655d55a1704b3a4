//! Viscosity: implicit forces between pairs at the rate of the kinematic viscosity, stable at any value.
//!
//! A pair resists the change of its distance only (Weiler et al. 2018, "A physically consistent implicit viscosity solver
//! for SPH fluids", eq. 8 and 9): with the velocity u* of the prediction, and the direction e from one particle to the other,
//!
//! ```text
//! u_i - h nu sum_j 10 |W'(r)| / r e (e · (u_j - u_i)) = u*_i
//! ```
//!
//! The factor 10 is 2 (d + 2) in three dimensions. The forces are along the lines of centres, so they keep momentum and
//! angular momentum, and a rigid motion has none, at the surface too. The matrix is symmetric and positive. Conjugate
//! gradients solve it until the residual is small. They start from the solution of the last time step, less what would move
//! a connected body of particles as if it were rigid: so every iterate keeps momentum and angular momentum. A block
//! preconditioner would need fewer iterations too, but its iterates would keep them only to their tolerance.

use crate::math::Lanes;
use crate::math::kernel::{self, KernelOfEight};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::connected_bodies::ConnectedBodies;
use super::near::total;
use super::neighbours::{CHUNK, Neighbours, chunk_range};
use super::pair::Pair;

/// 2 (d + 2) in d = 3 dimensions: the mean of e eᵀ over all directions gives the Laplacian then.
const FACTOR: f32 = 10.0;
/// Residual at which the solution is accepted, as a share of the right-hand side.
const TOLERANCE: f64 = 1e-3;
/// Most iterations in a time step.
const MAX_ITERATIONS: u32 = 60;

/// The solver of one liquid. Vectors have three entries and a zero.
#[derive(Debug, Default)]
pub struct Viscosity {
    /// Change of velocity of each particle, in the sorted order.
    pub change: Vec<[f32; 4]>,
    residual: Vec<[f32; 4]>,
    direction: Vec<[f32; 4]>,
    product: Vec<[f32; 4]>,
    /// By chunk, the pairs with a vector s: the entry of the matrix off the diagonal is -s sᵀ.
    lines: Vec<Vec<Pair>>,
    /// The change of velocity in the last time step, by particle, and its rate; empty before the first.
    last: Vec<[f32; 4]>,
    last_rate: f32,
    bodies: ConnectedBodies,
}

impl Viscosity {
    /// Solves for the change of velocity. The rate is the viscosity times the time step, in squared rest distances; its
    /// factors are by particle, and empty where they are 1.
    pub fn solve(
        &mut self,
        neighbours: &Neighbours,
        velocity: &[[f32; 4]],
        rate: (&[f32], f32),
        pool: &ThreadPool,
    ) {
        let count = velocity.len();
        for column in [&mut self.change, &mut self.residual, &mut self.direction, &mut self.product] {
            column.clear();
            column.resize(count, [0.0; 4]);
        }
        self.find_lines(neighbours, rate, pool);
        // The change x solves A x = u* - A u*.
        multiply((neighbours, &self.lines), velocity, &mut self.product, pool);
        for (residual, (own, product)) in self.residual.iter_mut().zip(velocity.iter().zip(&self.product)) {
            *residual = std::array::from_fn(|axis| own[axis] - product[axis]);
        }
        let first = dot(&self.residual, &self.residual);
        if self.last.len() == count {
            self.take_last(neighbours, rate.1);
            multiply((neighbours, &self.lines), &self.change, &mut self.product, pool);
            add(&mut self.residual, &self.product, -1.0);
        }
        self.direction.copy_from_slice(&self.residual);
        let mut square = dot(&self.residual, &self.residual);
        for _ in 0..MAX_ITERATIONS {
            if square <= first * TOLERANCE * TOLERANCE || square <= 0.0 {
                break;
            }
            multiply((neighbours, &self.lines), &self.direction, &mut self.product, pool);
            let step = (square / dot(&self.direction, &self.product)) as f32;
            add(&mut self.change, &self.direction, step);
            add(&mut self.residual, &self.product, -step);
            let next = dot(&self.residual, &self.residual);
            let back = (next / square) as f32;
            for (direction, residual) in self.direction.iter_mut().zip(&self.residual) {
                *direction = std::array::from_fn(|axis| residual[axis] + back * direction[axis]);
            }
            square = next;
        }
        self.last_rate = rate.1;
        self.last.resize(count, [0.0; 4]);
        for (&particle, change) in neighbours.grid.order().iter().zip(&self.change) {
            self.last[particle as usize] = *change;
        }
    }

    /// Forgets the last time step: particles are born or die.
    pub fn forget(&mut self) {
        self.last.clear();
    }

    /// Takes up the change of velocity in the last time step, for this rate.
    fn take_last(&mut self, neighbours: &Neighbours, rate: f32) {
        let scale = rate / self.last_rate;
        for (&particle, change) in neighbours.grid.order().iter().zip(&mut self.change) {
            *change = self.last[particle as usize].map(|x| x * scale);
        }
        self.bodies.find(neighbours);
        self.bodies.remove_rigid_motion(&neighbours.positions, &mut self.change);
    }

    fn find_lines(&mut self, neighbours: &Neighbours, (factors, rate): (&[f32], f32), pool: &ThreadPool) {
        let count = neighbours.len();
        self.lines.resize_with(count.div_ceil(CHUNK as usize), Vec::new);
        pool.for_each_mut(&mut self.lines, |chunk, out| {
            out.clear();
            for (k, at) in chunk_range(chunk, count).enumerate() {
                let place = neighbours.positions[at as usize];
                out.extend(neighbours.of(chunk, k).iter().map(|pair| {
                    let rate = rate * pair_factor(factors, [at as usize, pair.other()]);
                    line(pair, place, neighbours.positions[pair.other()], rate)
                }));
            }
        });
    }
}

/// A pair with the vector whose square is its entry of the matrix.
fn line(pair: &Pair, place: [f32; 4], other: [f32; 4], rate: f32) -> Pair {
    let [a, b, c] = pair.gradient();
    let apart = [place[0] - other[0], place[1] - other[1], place[2] - other[2]];
    let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
    // The gradient is W' times the direction: its product with `apart` is W' times the distance.
    let slope = (a * apart[0] + b * apart[1] + c * apart[2]).min(0.0);
    let scale = (-FACTOR * rate * slope).sqrt() / square.max(1e-8);
    Pair::new(apart.map(|x| x * scale), pair.other() as u32)
}

/// `out` = (1 + rate L) x, with the operator L of the pairs.
fn multiply(
    (neighbours, lines): (&Neighbours, &[Vec<Pair>]),
    x: &[[f32; 4]],
    out: &mut [[f32; 4]],
    pool: &ThreadPool,
) {
    let count = x.len();
    let out = DisjointSlice::new(out);
    pool.parallel_for(count.div_ceil(CHUNK as usize), |chunk| {
        let range = chunk_range(chunk, count);
        // SAFETY: chunks do not overlap.
        #[allow(unsafe_code)]
        unsafe {
            let out = out.run(range.clone());
            let (lines, ends) = (&lines[chunk][..], neighbours.ends(chunk));
            kernel::run(MultiplyRows { lines, ends, first: range.start as usize, x, out });
        }
    });
}

/// Lines that add nothing.
const NO_LINES: [Pair; 4] = [Pair::new([0.0; 3], 0); 4];

/// The product of a vector with the rows of the matrix of particles that follow each other.
struct MultiplyRows<'a> {
    lines: &'a [Pair],
    /// End of each particle's lines.
    ends: &'a [u32],
    /// The first particle.
    first: usize,
    x: &'a [[f32; 4]],
    out: &'a mut [[f32; 4]],
}

impl KernelOfEight<f32> for MultiplyRows<'_> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run_eight<W: Lanes<f32, Array = [[f32; 4]; 2]>>(self) {
        let Self { lines, ends, first: first_row, x, out } = self;
        let mut first = 0;
        for (k, (&end, out)) in ends.iter().zip(out).enumerate() {
            let own = x[first_row + k];
            let (fours, rest) = lines[first..end as usize].as_chunks::<4>();
            debug_assert!(rest.is_empty(), "lines are a multiple of four");
            first = end as usize;
            let at = [W::splat(own[0]), W::splat(own[1]), W::splat(own[2])];
            let mut sums = [W::splat(0.0); 3];
            let (twos, rest) = fours.as_chunks::<2>();
            for [low, high] in twos {
                add_pull(&mut sums, at, [low, high], x);
            }
            if let [last] = rest {
                add_pull(&mut sums, at, [last, &NO_LINES], x);
            }
            *out = [own[0] + total(sums[0]), own[1] + total(sums[1]), own[2] + total(sums[2]), 0.0];
        }
    }
}

/// Adds s sᵀ (own - other) of eight lines to sums over lanes.
#[inline(always)]
fn add_pull<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
    sums: &mut [W; 3],
    own: [W; 3],
    [low, high]: [&[Pair; 4]; 2],
    x: &[[f32; 4]],
) {
    // Loops, because maps over arrays are not inlined.
    let (mut lines, mut others) = ([W::splat(0.0); 4], [W::splat(0.0); 4]);
    for k in 0..4 {
        lines[k] = W::from_array([low[k].row(), high[k].row()]);
        others[k] = W::from_array([x[low[k].other()], x[high[k].other()]]);
    }
    let ([a, b, c, _], [u, v, w, _]) = (W::transpose(lines), W::transpose(others));
    let along = a * (own[0] - u) + b * (own[1] - v) + c * (own[2] - w);
    *sums = [sums[0] + a * along, sums[1] + b * along, sums[2] + c * along];
}

/// The mean of the factors of two particles, so that both feel the same force.
fn pair_factor(factors: &[f32], [a, b]: [usize; 2]) -> f32 {
    if factors.is_empty() { 1.0 } else { (factors[a] + factors[b]) * 0.5 }
}

fn add(column: &mut [[f32; 4]], other: &[[f32; 4]], factor: f32) {
    for (own, other) in column.iter_mut().zip(other) {
        (0..3).for_each(|axis| own[axis] += factor * other[axis]);
    }
}

fn dot(a: &[[f32; 4]], b: &[[f32; 4]]) -> f64 {
    let of = |(a, b): (&[f32; 4], &[f32; 4])| f64::from(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    a.iter().zip(b).map(of).sum()
}

#[cfg(test)]
mod tests {
    use super::super::grid::tests::spread;
    use super::super::walls::Walls;
    use super::*;

    /// The viscosity that a small wave of velocity along `flow`, with its layers normal to `across`, decays with, relative
    /// to the one that is asked for: in the middle of a cubic grid.
    fn decay(flow: [f32; 3], across: [f32; 3]) -> f64 {
        const SIDE: usize = 25;
        const WAVE: f32 = 0.25;
        let place = |k: usize| [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE].map(|x| x as f32 - 12.0);
        let places: Vec<[f32; 3]> = (0..SIDE.pow(3)).map(place).collect();
        let pool = ThreadPool::new(1);
        let mut neighbours = Neighbours::default();
        neighbours.find(&places, &Walls::default(), &pool);
        let order = neighbours.grid.order();
        let wave = |place: [f32; 3]| (WAVE * (0..3).map(|k| across[k] * place[k]).sum::<f32>()).cos();
        let velocity = |&at: &u32| {
            let speed = wave(places[at as usize]);
            [flow[0] * speed, flow[1] * speed, flow[2] * speed, 0.0]
        };
        let velocities: Vec<[f32; 4]> = order.iter().map(velocity).collect();
        let (rate, mut viscosity) = (1e-2, Viscosity::default());
        viscosity.solve(&neighbours, &velocities, (&[], rate), &pool);
        let centre = order.iter().position(|&at| places[at as usize] == [0.0; 3]).expect("it is there");
        let change: f32 = (0..3).map(|k| viscosity.change[centre][k] * flow[k]).sum();
        -f64::from(change / (rate * WAVE * WAVE * (1.0 + change)))
    }

    #[test]
    fn a_step_that_starts_from_the_last_solution_has_the_same_result_and_keeps_momentum_and_angular_momentum()
    {
        let pool = ThreadPool::new(1);
        // Two bodies that do not touch.
        let mut places = spread(400, 5.0);
        places.extend(spread(300, 4.0).iter().map(|[x, y, z]| [x + 20.0, *y, *z]));
        let velocity = |time: f32| -> Vec<[f32; 4]> {
            let of = |[x, y, z]: &[f32; 3]| [(y + time).sin(), (z * 1.3 - time).cos(), (x * 0.7).sin(), 0.0];
            places.iter().map(of).collect()
        };
        let mut neighbours = Neighbours::default();
        neighbours.find(&places, &Walls::default(), &pool);
        let order = neighbours.grid.order();
        let sorted = |velocity: Vec<[f32; 4]>| -> Vec<[f32; 4]> {
            order.iter().map(|&particle| velocity[particle as usize]).collect()
        };
        let (mut warm, mut cold) = (Viscosity::default(), Viscosity::default());
        warm.solve(&neighbours, &sorted(velocity(0.0)), (&[], 0.2), &pool);
        // As if all had moved since.
        warm.last.iter_mut().zip(&places).for_each(|(last, [x, y, z])| {
            *last = [last[0] + 0.1 - 0.02 * y, last[1] + 0.02 * x, last[2] + 0.05 * (z * x).sin(), 0.0];
        });
        let now = sorted(velocity(0.3));
        warm.solve(&neighbours, &now, (&[], 0.3), &pool);
        cold.solve(&neighbours, &now, (&[], 0.3), &pool);
        let apart = warm
            .change
            .iter()
            .zip(&cold.change)
            .map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>());
        let size = dot(&cold.change, &cold.change) as f32;
        assert!(apart.sum::<f32>() < 1e-5 * size);
        for is_second in [false, true] {
            let mut sums = [0.0f64; 6];
            for (change, place) in warm.change.iter().zip(&neighbours.positions) {
                if (place[0] > 10.0) == is_second {
                    let ([u, v, w, _], [x, y, z, _]) = (change.map(f64::from), place.map(f64::from));
                    let moments = [u, v, w, y * w - z * v, z * u - x * w, x * v - y * u];
                    (0..6).for_each(|k| sums[k] += moments[k]);
                }
            }
            assert!(sums.iter().all(|sum| sum.abs() < 1e-2), "{sums:?}");
        }
    }

    #[test]
    fn a_shear_wave_decays_at_the_kinematic_viscosity_on_the_mean_of_all_directions() {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let along = decay([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        let diagonal = decay([half, half, 0.0], [half, -half, 0.0]);
        // A cubic grid has these two shear viscosities: of five shears, three are of the first and two of the second kind.
        let mean = (3.0 * along + 2.0 * diagonal) / 5.0;
        assert!((mean - 1.0).abs() < 0.05, "{mean}: {along} along the grid, {diagonal} across it");
    }
}
