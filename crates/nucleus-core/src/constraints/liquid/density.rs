//! Incompressibility: no particle is denser than at rest (position-based fluids: Macklin & Müller 2013, §3).
//!
//! The density of a particle is the kernel's sum over its neighbours and walls, and C is its excess over 1. Like a contact,
//! the constraint only pushes: 0 ≤ λ. Displacements are Δx = -w Jᵀ λ with the gradients J of the predicted positions, and
//! λ solves the linear complementarity problem
//!
//! ```text
//! 0 ≤ λ   perpendicular to   C + J Δx - α λ ≤ 0
//! ```
//!
//! by accelerated projected gradient descent (Mazhar et al. 2015), preconditioned by the diagonal and restarted where it
//! would climb. It starts from the pressure of the time step before and ends when the mean excess is small, so the volume
//! depends neither on substeps nor on a number of iterations ([`Accept`]). Gradients are symmetric, so momentum is kept to
//! rounding.

use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::neighbours::{CHUNK, Neighbours, chunk_range};
use super::pair::Pair;
use super::walls::Walls;

/// Most iterations in a time step.
const MAX_ITERATIONS: u32 = 100;
/// Mean error of density at which the solution is accepted.
const TOLERANCE: f32 = 2e-4;
/// Least diagonal; that of a particle in a cubic grid is 0.43. What a particle lacks is compliance, as ε in Macklin & Müller
/// (eq. 11): particles in one place have no gradient, and a pressure without bound threw them off at the first wall.
const LEAST_DIAGONAL: f32 = 0.05;
/// Largest eigenvalue of the preconditioned system that is taken for granted. It grows where a step shows a larger one.
const START_EIGENVALUE: f32 = 2.0;

/// The pressure solver of one liquid; lengths in rest distances.
#[derive(Debug, Default)]
pub struct Density {
    /// Multiplier of each particle, in the sorted order.
    pub lambda: Vec<f32>,
    /// Displacement of each particle.
    pub moved: Vec<[f32; 4]>,
    ahead: Vec<f32>,
    next: Vec<f32>,
    diagonal: Vec<f32>,
    /// α of each particle.
    compliances: Vec<f32>,
    /// Where the last gradient was taken, and the gradient.
    last: Vec<[f32; 2]>,
    sums: Vec<Sums>,
}

/// Inputs of the pressure solver, per particle.
#[derive(Debug, Clone, Copy, Default)]
pub struct Load {
    /// Excess of density that must go.
    pub excess: f32,
    /// Inverse mass in inverse masses of a free particle: 0 or 1.
    pub inverse_mass: f32,
    /// Displacement by viscosity and surface tension.
    pub moved: [f32; 3],
}

/// The error of density by which a solution is accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accept {
    /// The excess alone. A pressure that is too high passes, and goes in the next time steps.
    Excess,
    /// Also what pressure holds below the density at rest: the residual of the complementarity problem. Surface tension keeps
    /// a drop under a pressure that its motion hardly changes; with too much of that left, a drop of 7,176 particles gained
    /// four times its kinetic energy within a tenth of its period.
    Residual,
}

impl Density {
    /// Solves for the displacements. `compliance` is α in units of the diagonal of a particle at rest. Returns the number
    /// of iterations and the mean error that is left.
    pub fn solve(
        &mut self,
        neighbours: &Neighbours,
        loads: &[Load],
        walls: &mut Walls,
        (compliance, accept): (f32, Accept),
        pool: &ThreadPool,
    ) -> (u32, f32) {
        self.resize(loads.len(), loads.len().div_ceil(CHUNK as usize));
        self.find_diagonal(neighbours, loads, walls, compliance, pool);
        self.ahead.copy_from_slice(&self.lambda);
        let (mut momentum, mut largest, mut iterations) = (1.0f32, START_EIGENVALUE, 0);
        loop {
            self.displace(neighbours, loads, pool);
            walls.displace(neighbours.pushes(&self.ahead));
            let next = (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt()) / 2.0;
            let step = Step { length: 1.0 / largest, look: (momentum - 1.0) / next, accept };
            let sums = self.descend(neighbours, loads, walls, step, pool);
            let mean = sums.error / loads.len().max(1) as f32;
            iterations += 1;
            let eigenvalue = if iterations > 1 { sums.curvature / sums.travel.max(1e-30) } else { 0.0 };
            if eigenvalue > largest {
                // The last step was too long: it is taken back.
                largest = 1.1 * eigenvalue;
                self.ahead.copy_from_slice(&self.lambda);
                momentum = 1.0;
            } else {
                std::mem::swap(&mut self.lambda, &mut self.next);
                if sums.climb > 0.0 {
                    // From here on it goes downhill again.
                    self.ahead.copy_from_slice(&self.lambda);
                    momentum = 1.0;
                } else {
                    momentum = next;
                }
            }
            if mean <= TOLERANCE || iterations >= MAX_ITERATIONS {
                self.ahead.copy_from_slice(&self.lambda);
                self.displace(neighbours, loads, pool);
                walls.displace(neighbours.pushes(&self.ahead));
                return (iterations, mean);
            }
        }
    }

    /// Excess of a particle at the end, in the sorted order, as far as it was to go.
    pub fn left(&self, at: usize) -> f32 {
        self.last[at][1]
    }

    /// Excess of a particle, in the sorted order, that stays because the liquid yields.
    pub fn yielded(&self, at: usize) -> f32 {
        self.compliances[at] * self.lambda[at]
    }

    fn resize(&mut self, count: usize, chunks: usize) {
        for column in [&mut self.ahead, &mut self.next, &mut self.diagonal, &mut self.compliances] {
            column.clear();
            column.resize(count, 0.0);
        }
        self.last.clear();
        self.last.resize(count, [0.0; 2]);
        self.moved.clear();
        self.moved.resize(count, [0.0; 4]);
        self.sums.clear();
        self.sums.resize(chunks, Sums::default());
    }

    /// The diagonal of J w Jᵀ + α; and the multipliers, as far as they have a gradient.
    fn find_diagonal(
        &mut self,
        neighbours: &Neighbours,
        loads: &[Load],
        walls: &Walls,
        compliance: f32,
        pool: &ThreadPool,
    ) {
        let [diagonal, compliances, lambda] = [&mut self.diagonal, &mut self.compliances, &mut self.lambda]
            .map(|column| DisjointSlice::new(column));
        let all_free = loads.iter().all(|load| load.inverse_mass == 1.0);
        let mobility = |pair: &Pair| {
            let [x, y, z] = pair.gradient();
            loads[pair.other()].inverse_mass * (x * x + y * y + z * z)
        };
        pool.parallel_for(loads.len().div_ceil(CHUNK as usize), |chunk| {
            let range = chunk_range(chunk, loads.len());
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let (out, compliances, lambda) = unsafe {
                (diagonal.run(range.clone()), compliances.run(range.clone()), lambda.run(range.clone()))
            };
            for (k, ((out, yields), lambda)) in out.iter_mut().zip(compliances).zip(lambda).enumerate() {
                let at = range.start as usize + k;
                let own = neighbours.sum(at);
                let own = loads[at].inverse_mass * (own[0] * own[0] + own[1] * own[1] + own[2] * own[2]);
                let others = match all_free {
                    true => neighbours.squares[at],
                    false => neighbours.of(chunk, k).iter().map(mobility).sum(),
                };
                let mobility = own + others + walls.mobility(neighbours.walls_of(chunk, k));
                let lack = (LEAST_DIAGONAL - mobility).max(0.0);
                *yields = compliance + lack;
                // The pressure of the time step before grew against compliance, as far as there was no gradient. Once there
                // is one it would throw the particles off.
                *lambda *= 1.0 - lack / LEAST_DIAGONAL;
                *out = mobility + *yields;
            }
        });
    }

    /// Displacements by the multipliers that are looked ahead to.
    fn displace(&mut self, neighbours: &Neighbours, loads: &[Load], pool: &ThreadPool) {
        let (moved, ahead) = (DisjointSlice::new(&mut self.moved), &self.ahead);
        pool.parallel_for(loads.len().div_ceil(CHUNK as usize), |chunk| {
            let range = chunk_range(chunk, loads.len());
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let out = unsafe { moved.run(range.clone()) };
            let rows = range.start as usize..range.end as usize;
            let (own, sums, loads) = (&ahead[rows.clone()], &neighbours.sums[rows.clone()], &loads[rows]);
            neighbours.chunks[chunk].sum_pairs(|other| [ahead[other]; 4], out);
            for (k, out) in out.iter_mut().enumerate() {
                let ([_, a, b, c], weight, [x, y, z]) = (sums[k], -loads[k].inverse_mass, loads[k].moved);
                let push = |sum: f32, others: f32| (own[k] * sum + others) * weight;
                *out = [x + push(a, out[0]), y + push(b, out[1]), z + push(c, out[2]), 0.0];
            }
        });
    }

    /// One step of the descent.
    fn descend(
        &mut self,
        neighbours: &Neighbours,
        loads: &[Load],
        walls: &Walls,
        step: Step,
        pool: &ThreadPool,
    ) -> Sums {
        let Self { lambda, moved, ahead, next, diagonal, compliances, sums, last } = self;
        let [next, ahead] = [next, ahead].map(|column| DisjointSlice::new(column));
        let (last, sums_of) = (DisjointSlice::new(last), DisjointSlice::new(sums));
        pool.parallel_for(loads.len().div_ceil(CHUNK as usize), |chunk| {
            let range = chunk_range(chunk, loads.len());
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let (next, ahead, last, total) = unsafe {
                let total = sums_of.run(chunk as u32..chunk as u32 + 1);
                (next.run(range.clone()), ahead.run(range.clone()), last.run(range.clone()), total)
            };
            let mut sums = Sums::default();
            let rows = range.start as usize..range.end as usize;
            let (own_moved, own_sums) = (&moved[rows.clone()], &neighbours.sums[rows.clone()]);
            let (loads, diagonal) = (&loads[rows.clone()], &diagonal[rows.clone()]);
            let (compliances, lambda) = (&compliances[rows.clone()], &lambda[rows]);
            let walls_move = !walls.corners().is_empty();
            let mut others = [[0.0; 4]; CHUNK as usize];
            neighbours.chunks[chunk].sum_pairs(|other| moved[other], &mut others);
            for k in 0..next.len() {
                let (own, [_, x, y, z]) = (own_moved[k], own_sums[k]);
                let mut change = own[0] * x + own[1] * y + own[2] * z;
                change -= others[k][0] + others[k][1] + others[k][2];
                if walls_move {
                    change -= walls.change(neighbours.walls_of(chunk, k));
                }
                let excess = loads[k].excess + change - compliances[k] * ahead[k];
                let weight = diagonal[k];
                let stepped = (ahead[k] + step.length * excess / weight).max(0.0);
                let travel = ahead[k] - last[k][0];
                sums.error += match step.accept {
                    Accept::Excess => excess.max(0.0),
                    Accept::Residual => ((ahead[k] + excess / weight).max(0.0) - ahead[k]).abs() * weight,
                };
                sums.climb -= excess * (stepped - lambda[k]);
                sums.curvature += travel * (last[k][1] - excess);
                sums.travel += travel * travel * weight;
                last[k] = [ahead[k], excess];
                next[k] = stepped;
                ahead[k] = stepped + step.look * (stepped - lambda[k]);
            }
            total[0] = sums;
        });
        self.sums.iter().fold(Sums::default(), Sums::plus)
    }
}

/// A step of the descent.
#[derive(Debug, Clone, Copy)]
struct Step {
    length: f32,
    /// Share of the step that the next one looks ahead.
    look: f32,
    accept: Accept,
}

/// Sums over all particles.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Error of density.
    error: f32,
    /// How far the step climbs.
    climb: f32,
    /// Change of the gradient along the last step, and the length of that step in the metric of the diagonal.
    curvature: f32,
    travel: f32,
}

impl Sums {
    fn plus(self, other: &Self) -> Self {
        Self {
            error: self.error + other.error,
            climb: self.climb + other.climb,
            curvature: self.curvature + other.curvature,
            travel: self.travel + other.travel,
        }
    }
}
