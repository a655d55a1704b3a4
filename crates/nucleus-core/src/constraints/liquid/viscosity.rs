//! Viscosity: implicit diffusion of velocity at the rate of the kinematic viscosity, stable at any value.
//!
//! As in Takahashi et al. 2015, in the simpler form of a Laplacian: with the velocity u* of
//! the prediction,
//!
//! ```text
//! u_i - h nu sum_j 2 |W'(r)| / r (u_j - u_i) = u*_i
//! ```
//!
//! The matrix is symmetric and positive, and keeps momentum. Conjugate gradients solve it until the residual is small.

use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::neighbours::{CHUNK, Neighbours, chunk_range};

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
    /// By chunk, the entries of the matrix off the diagonal, without their sign.
    weights: Vec<Vec<f32>>,
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
        self.find_weights(neighbours, rate, pool);
        // The change x solves A x = u* - A u*.
        multiply((neighbours, &self.weights), velocity, &mut self.product, pool);
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
            multiply((neighbours, &self.weights), &self.direction, &mut self.product, pool);
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

    fn find_weights(&mut self, neighbours: &Neighbours, (factors, rate): (&[f32], f32), pool: &ThreadPool) {
        let count = neighbours.len();
        self.weights.resize_with(count.div_ceil(CHUNK as usize), Vec::new);
        let weights = DisjointSlice::new(&mut self.weights);
        pool.parallel_for(count.div_ceil(CHUNK as usize), |chunk| {
            // SAFETY: each task has the entry of its chunk.
            #[allow(unsafe_code)]
            let out = unsafe { &mut weights.run(chunk as u32..chunk as u32 + 1)[0] };
            out.clear();
            for (k, at) in chunk_range(chunk, count).enumerate() {
                let place = neighbours.positions[at as usize];
                out.extend(neighbours.of(chunk, k).iter().map(|pair| {
                    let (other, [a, b, c]) = (neighbours.positions[pair.other()], pair.gradient());
                    let apart = [place[0] - other[0], place[1] - other[1], place[2] - other[2]];
                    let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
                    // The gradient is W' times the direction: divided by the distance, it is along `apart` squared.
                    let weight = -2.0 * (a * apart[0] + b * apart[1] + c * apart[2]) / square.max(1e-4);
                    rate * weight * pair_factor(factors, [at as usize, pair.other()])
                }));
            }
        });
    }
}

/// `out` = (1 + rate L) x, with the Laplacian L of the neighbours.
fn multiply(
    (neighbours, weights): (&Neighbours, &[Vec<f32>]),
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
            let mut sum = own;
            let weights = &weights[chunk][neighbours.range(chunk, k)];
            for (pair, &weight) in neighbours.of(chunk, k).iter().zip(weights) {
                let other = x[pair.other()];
                (0..4).for_each(|lane| sum[lane] += weight * (own[lane] - other[lane]));
            }
            *out = sum;
        }
    });
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
