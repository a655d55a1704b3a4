//! Shape: `rigidity` and `deformResistance` pull a mesh back to its shape at rest, wherever it is (shape matching, Müller
//! et al. 2005, "Meshless deformations based on shape matching").
//!
//! The best rigid fit of the rest shape has the mesh's centre of mass c and the rotation R of A = Σ m (x - c) qᵀ. The goal
//! of a point is c + R q for `rigidity`; for `deformResistance` it is half way to c + B q, where B is the best linear map,
//! so that the mesh may shear and bend as a whole. The goals have the momentum of the points: a free mesh keeps its
//! momentum and angular momentum.
//!
//! Physical: each point is held by a spring of a stiffness per mass, so the response depends neither on mesh nor on
//! substeps. Classic: a count of evaluations in 1/24 s, each of which takes a point all the way.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::math::Real;
use crate::model::blocks::Blocks;
use crate::model::surface::Surface;
use crate::model::topology::components;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Angular frequency in rad/s of a point about its goal for a `rigidity` of 1: 120 Hz.
pub const RIGID_RATE: f64 = 754.0;
/// The same for a `deformResistance` of 1: 24 Hz.
pub const DEFORM_RATE: f64 = 150.8;
/// Iterations for the rotation; it begins at that of the step before.
const TURNS: usize = 20;
/// Angle in radians below which a rotation has converged.
const CONVERGED: f64 = 1e-9;
/// Mass of a pinned point, in masses of the whole mesh: the shape hangs from it.
const PINNED: f64 = 10.0;
/// Share of the size that makes the linear map of a flat mesh definite.
const FLAT: f64 = 1e-4;

/// The rest shapes of one cloth, fixed once it is compiled.
#[derive(Debug, Clone, Default)]
pub struct ShapeModel {
    /// Points of each shell, in the solver's rows.
    shells: Vec<Vec<u32>>,
    /// Position at rest of each point of each shell, about the shell's centre of mass, in metres.
    rest: Vec<Vec<Vector3<f64>>>,
    /// Shares of the two strengths that each point of each shell gets; empty where all get all of them.
    share: Vec<Vec<[f64; 2]>>,
    /// The row of each point, ascending, and its shell.
    by_row: Vec<(u32, u32)>,
    /// First of the shells in the state.
    pub first: usize,
}

/// How strongly a pass acts: shares of the way to the goals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeStrength {
    /// To the rigid goal.
    pub rigid: f64,
    /// To the goal that may deform.
    pub deform: f64,
}

impl ShapeModel {
    /// Compiles the shells of a mesh: its unconnected parts, or all of it as one. `masses` and the
    /// maps of `rigidity` and `deformResistance` are by the user's points.
    pub fn new(
        surface: &Surface,
        place: impl Fn(u32) -> u32,
        masses: &[f64],
        maps: [&[f64]; 2],
        by_shell: bool,
    ) -> Self {
        let shells = if by_shell { components(surface) } else { vec![(0..masses.len() as u32).collect()] };
        let mut model = Self::default();
        for shell in shells {
            let mass: f64 = shell.iter().map(|&point| masses[point as usize]).sum();
            let weighed = |&point: &u32| surface.positions[point as usize] * masses[point as usize];
            let centre = shell.iter().map(weighed).sum::<Vector3<f64>>() / mass;
            let rest: Vec<_> =
                shell.iter().map(|&point| surface.positions[point as usize] - centre).collect();
            model.shells.push(shell.iter().map(|&point| place(point)).collect());
            model.rest.push(rest);
            let share = |&point: &u32| maps.map(|map| map.get(point as usize).copied().unwrap_or(1.0));
            let is_uniform = maps.iter().all(|map| map.is_empty());
            model.share.push(if is_uniform { Vec::new() } else { shell.iter().map(share).collect() });
        }
        let rows =
            (0..).zip(&model.shells).flat_map(|(shell, rows)| rows.iter().map(move |&row| (row, shell)));
        model.by_row = rows.collect();
        model.by_row.sort_unstable();
        model
    }

    /// How many shells there are.
    pub fn shells(&self) -> usize {
        self.shells.len()
    }

    /// The shell of a row.
    pub fn shell_of(&self, row: u32) -> Option<usize> {
        let at = self.by_row.binary_search_by_key(&row, |&(row, _)| row).ok()?;
        Some(self.by_row[at].1 as usize)
    }

    /// The rows of a shell.
    pub fn rows_of(&self, shell: usize) -> &[u32] {
        &self.shells[shell]
    }

    /// Points that are held.
    pub fn rows(&self) -> usize {
        self.shells.iter().map(Vec::len).sum()
    }

    /// Bytes of its lists.
    pub fn bytes(&self) -> usize {
        let shared: usize = self.share.iter().map(|share| size_of_val(&share[..])).sum();
        self.rows() * (size_of::<u32>() + size_of::<(u32, u32)>() + size_of::<Vector3<f64>>()) + shared
    }

    /// Moves the points of a cloth towards their goals.
    pub fn relax<R: Real>(&self, state: &mut State<R>, strength: ShapeStrength, pool: &ThreadPool) {
        for (index, (shell, rest)) in self.shells.iter().zip(&self.rest).enumerate() {
            let fit = self.fit(index, state);
            let displacement = DisjointSlice::new(&mut state.displacement);
            let (anchor, share) = (&state.anchor, &self.share[index]);
            let chunk = Blocks::new(0, shell.len());
            pool.parallel_for(chunk.len(), |task| {
                for at in chunk.range(task) {
                    let (row, q) = (shell[at as usize], rest[at as usize]);
                    // SAFETY: tasks have points of their own, as no point is in two shells.
                    #[allow(unsafe_code)]
                    let mut point = unsafe { displacement.get(row) };
                    if point.0[3] <= R::ZERO {
                        continue;
                    }
                    let start = Vector3::from(anchor[row as usize]);
                    let x = start + Vector3::from(point.xyz().map(R::to_f64));
                    let [to_rigid, to_deform] = share.get(at as usize).copied().unwrap_or([1.0; 2]);
                    let rigid = fit.centre + fit.rotation * q;
                    let soft = (rigid + fit.centre + fit.linear * q) / 2.0;
                    let moved = (rigid - x) * (strength.rigid * to_rigid);
                    let moved = x + moved + (soft - x - moved) * (strength.deform * to_deform) - start;
                    (0..3).for_each(|axis| point.0[axis] = R::from_f64(moved[axis]));
                    // SAFETY: as above.
                    #[allow(unsafe_code)]
                    unsafe {
                        displacement.set(row, point);
                    }
                }
            });
        }
    }

    /// The best fit of a shell's rest shape to where its points are.
    fn fit<R: Real>(&self, index: usize, state: &mut State<R>) -> Fit {
        let (shell, rest) = (&self.shells[index], &self.rest[index]);
        let mass = |row: u32| 1.0 / state.inverse_mass[row as usize].to_f64();
        let total: f64 = shell.iter().map(|&row| mass(row)).sum();
        let weight = |row: u32| match state.displacement[row as usize].0[3] > R::ZERO {
            true => mass(row),
            false => PINNED * total,
        };
        let place = |row: u32| Vector3::from(state.position(row));
        let (mut sum, mut centre, mut rest_centre) = (0.0, Vector3::zeros(), Vector3::zeros());
        let origin = place(shell[0]);
        for (&row, q) in shell.iter().zip(rest) {
            let weight = weight(row);
            sum += weight;
            centre += (place(row) - origin) * weight;
            rest_centre += q * weight;
        }
        let (centre, rest_centre) = (origin + centre / sum, rest_centre / sum);
        let (mut turned, mut spread) = (Matrix3::zeros(), Matrix3::zeros());
        for (&row, q) in shell.iter().zip(rest) {
            let q = q - rest_centre;
            turned += (place(row) - centre) * q.transpose() * weight(row);
            spread += q * q.transpose() * weight(row);
        }
        let start = state.rotations[self.first + index];
        let rotation = rotation_of(&turned, start);
        state.rotations[self.first + index] = rotation;
        let rotation =
            UnitQuaternion::new_unchecked(Quaternion::from(rotation)).to_rotation_matrix().into_inner();
        let soft = FLAT * spread.trace();
        let linear = (spread + Matrix3::identity() * soft).try_inverse();
        let linear = linear.map_or(rotation, |inverse| (turned + rotation * soft) * inverse);
        // About the weighted centre at rest, which pins shift.
        Fit { centre: centre - rotation * rest_centre, rotation, linear }
    }
}

/// The best fit of a rest shape.
struct Fit {
    centre: Vector3<f64>,
    rotation: Matrix3<f64>,
    linear: Matrix3<f64>,
}

/// The rotation part of a matrix as a quaternion (x, y, z, w), from a guess (Müller et al. 2016, "A robust method to
/// extract the rotational part of deformations"). Sums, products and square roots alone.
fn rotation_of(a: &Matrix3<f64>, guess: [f64; 4]) -> [f64; 4] {
    let mut q = UnitQuaternion::new_normalize(Quaternion::from(guess));
    for _ in 0..TURNS {
        let r = q.to_rotation_matrix().into_inner();
        let (mut turn, mut fit) = (Vector3::zeros(), 0.0);
        for k in 0..3 {
            turn += r.column(k).cross(&a.column(k));
            fit += r.column(k).dot(&a.column(k));
        }
        let turn = turn / (fit.abs() + f64::MIN_POSITIVE.sqrt());
        let angle = turn.norm();
        if angle < CONVERGED || !angle.is_finite() {
            break;
        }
        // Half the tangent of half the angle, at most a quarter turn at once.
        let half = turn * (0.5 / (1.0 + 0.25 * angle));
        q = UnitQuaternion::new_normalize(Quaternion::from_parts(1.0, half) * q.into_inner());
    }
    q.into_inner().coords.into()
}

/// The rotation of a mesh that has not turned.
pub const UNTURNED: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_rotation_of_a_turned_and_stretched_shape_is_found(
            axis in proptest::array::uniform3(-1.0..1.0f64), angle in 0.0..3.0f64,
            stretch in proptest::array::uniform3(0.2..3.0f64),
        ) {
            let axis = Vector3::from(axis);
            prop_assume!(axis.norm() > 0.1);
            let turn = nalgebra::Rotation3::from_scaled_axis(axis.normalize() * angle);
            let a = turn.matrix() * Matrix3::from_diagonal(&Vector3::from(stretch));
            let mut found = UNTURNED;
            // A few time steps.
            for _ in 0..12 {
                found = rotation_of(&a, found);
            }
            let found = UnitQuaternion::new_normalize(Quaternion::from(found)).to_rotation_matrix();
            prop_assert!((found.matrix() - turn.matrix()).norm() < 1e-6);
        }
    }
}
