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
//! gradients solve it until the residual is small. A block preconditioner would need fewer iterations, but its iterates
//! would keep the angular momentum only to their tolerance.

use crate::math::{Lanes, Real};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::neighbours::{CHUNK, Neighbours, chunk_range};
use super::pair::Pair;

/// Four numbers, computed with at once.
type FourLanes = <f32 as Real>::Lanes;

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
        self.direction.copy_from_slice(&self.residual);
        let first = dot(&self.residual, &self.residual);
        let mut square = first;
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
        let out = unsafe { out.run(range.clone()) };
        for (k, out) in out.iter_mut().enumerate() {
            let own = x[range.start as usize + k];
            let pull = sum_lines(own, &lines[chunk][neighbours.range(chunk, k)], x);
            *out = [own[0] + pull[0], own[1] + pull[1], own[2] + pull[2], 0.0];
        }
    });
}

/// The sum of s sᵀ (own - other) over the pairs of a particle.
fn sum_lines(own: [f32; 4], lines: &[Pair], x: &[[f32; 4]]) -> [f32; 3] {
    let zero = FourLanes::splat(0.0);
    let own = [own[0], own[1], own[2]].map(FourLanes::splat);
    let mut sums = [zero; 3];
    let (fours, _) = lines.as_chunks::<4>();
    for four in fours {
        let [a, b, c, _] =
            FourLanes::transpose(four.each_ref().map(|line| FourLanes::from_array(line.row())));
        let others = four.each_ref().map(|line| FourLanes::from_array(x[line.other()]));
        let [u, v, w, _] = FourLanes::transpose(others);
        let along = a * (own[0] - u) + b * (own[1] - v) + c * (own[2] - w);
        sums = [sums[0] + a * along, sums[1] + b * along, sums[2] + c * along];
    }
    sums.map(|sum| {
        let [a, b, c, d] = sum.to_array();
        (a + b) + (c + d)
    })
}

/// The mean of the factors of two particles, so that both feel the same force.
pub fn pair_factor(factors: &[f32], [a, b]: [usize; 2]) -> f32 {
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
    fn a_shear_wave_decays_at_the_kinematic_viscosity_on_the_mean_of_all_directions() {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let along = decay([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        let diagonal = decay([half, half, 0.0], [half, -half, 0.0]);
        // A cubic grid has these two shear viscosities: of five shears, three are of the first and two of the second kind.
        let mean = (3.0 * along + 2.0 * diagonal) / 5.0;
        assert!((mean - 1.0).abs() < 0.05, "{mean}: {along} along the grid, {diagonal} across it");
    }
}
