//! A small random perturbation of a cloth at the start (`initialPerturbation`).
//!
//! A flat sheet under a load in its plane is in balance, however unstable: no force pushes it out of its plane, and it
//! buckles only when rounding has grown large enough. A perturbation of a thousandth of the edge length makes the choice,
//! in the same way in every run.

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::attributes::n_cloth;
use crate::graph::NodeId;

use super::compiler::Compiler;
use super::input_mesh::normals;

impl Compiler<'_> {
    /// Moves the points of a cloth along their normals; `positions` and `surface` in metres.
    pub(super) fn perturb(&self, cloth: NodeId, surface: &Surface, positions: &mut Vec<Vector3<f64>>) {
        let given = self.start.get(cloth, &n_cloth::INITIAL_PERTURBATION);
        let length = self.program.units.length(given);
        if length <= 0.0 {
            return;
        }
        let seed = self.start.get(cloth, &n_cloth::INITIAL_PERTURBATION_SEED) as u64;
        if positions.is_empty() {
            positions.clone_from(&surface.positions);
        }
        let placed = Surface { positions: positions.clone(), faces: surface.faces.clone() };
        for ((point, position), normal) in (0..).zip(positions).zip(normals(&placed)) {
            *position += normal * (length * signed_unit(seed, point));
        }
    }
}

/// A random number between -1 and 1 for a point (SplitMix64: Steele et al. 2014).
fn signed_unit(seed: u64, point: u64) -> f64 {
    let mut x = seed
        .wrapping_mul(0xd134_2543_de82_ef95)
        .wrapping_add(point.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    let bits = (x ^ x >> 31) >> 11;
    bits as f64 / (1u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_numbers_are_even_and_differ_by_seed() {
        let all: Vec<f64> = (0..10_000).map(|point| signed_unit(7, point)).collect();
        assert!(all.iter().all(|x| (-1.0..1.0).contains(x)));
        let mean = all.iter().sum::<f64>() / 1e4;
        let square = all.iter().map(|x| x * x).sum::<f64>() / 1e4;
        assert!(mean.abs() < 0.02 && (square - 1.0 / 3.0).abs() < 0.01, "{mean} {square}");
        assert_ne!(signed_unit(7, 3), signed_unit(8, 3));
    }
}
