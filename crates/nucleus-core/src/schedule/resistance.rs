//! The meaning of a resistance, in its two readings.
//!
//! *Classic* (§2.2, §2.4): a count of evaluations in 1/24 s, shared among the substeps. A substep whose share is below
//! one gets one evaluation of less strength. The stiffness of the cloth follows from mesh and substeps: see
//! [`classic_stiffness`].
//!
//! *Physical*: a stiffness. The cloth is the same on every mesh and at every setting; a setting changes only the error.

use crate::input::frame::{COUNT_PERIOD, ClothFrame};

/// Membrane stiffness in N/m of a stretch, compression or shear resistance of 1. The default of 20 is then 10 kN/m, a
/// usual woven cloth.
pub const STIFFNESS_PER_RESISTANCE: f64 = 500.0;

/// Bending stiffness in N·m of a bend resistance of 1. The presets for T-shirt (0.1), denim (0.4) and leather (10) are
/// then 1e-5, 4e-5 and 1e-3 N·m, the magnitudes of such cloths.
pub const BENDING_PER_RESISTANCE: f64 = 1e-4;

/// The stiffnesses of a cloth in the Physical reading, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhysicalStiffness {
    /// In N/m, of links longer than at rest.
    pub stretch: f64,
    /// In N/m, of links shorter than at rest.
    pub compression: f64,
    /// In N/m, against shear, in addition to that of cross links.
    pub shear: f64,
    /// In N·m, against bending.
    pub bend: f64,
    /// In N/m, of links along the warp of woven cloth that are longer than at rest.
    pub warp: f64,
    /// The same along the weft.
    pub weft: f64,
}

impl PhysicalStiffness {
    /// A stiffness that is given counts; otherwise it is the resistance times its unit.
    pub fn of(cloth: &ClothFrame) -> Self {
        let given = &cloth.stiffness;
        let or = |given: Option<f64>, resistance: f64, unit: f64| given.unwrap_or(resistance * unit).max(0.0);
        let stretch = or(given.stretch, cloth.stretch_resistance, STIFFNESS_PER_RESISTANCE);
        Self {
            stretch,
            warp: given.warp.map_or(stretch, |own| own.max(0.0)),
            weft: given.weft.map_or(stretch, |own| own.max(0.0)),
            compression: or(given.compression, cloth.compression_resistance, STIFFNESS_PER_RESISTANCE),
            shear: or(given.shear, cloth.shear_resistance, STIFFNESS_PER_RESISTANCE),
            bend: or(given.bend, cloth.bend_resistance, BENDING_PER_RESISTANCE),
        }
    }
}

/// Upper limit of the evaluations of one effect in a substep (`maxIterations`).
const MAX_SWEEPS: f64 = 10_000.0;

/// An effect's share of one substep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Number of evaluations.
    pub sweeps: u32,
    /// Strength of each evaluation, at most 1.
    pub strength: f64,
}

/// The share of its error that one Classic evaluation of a link or a hinge removes.
///
/// Two recorded falls of the original on a table fix it: with one half, the heights and the volumes of both spheres agree
/// within 5 % over the first ten frames of contact (`docs/maya.md`); with the whole error they are two to three times too
/// stiff.
pub const CLASSIC_SHARE: f64 = 0.5;

/// Shares a count per 1/24 s among substeps of `substep` seconds (§2.4): 10 is 10 evaluations at 1 substep, 5 at 2, 1
/// at 10, and 1 of half the strength at 20. Every substep gets the same: sweeps that change from one to the next feed
/// energy in.
pub fn share(count: f64, substep: f64) -> Share {
    let wanted = (count * substep / COUNT_PERIOD).clamp(0.0, MAX_SWEEPS);
    if wanted <= 0.0 {
        return Share { sweeps: 0, strength: 0.0 };
    }
    // A number that misses a whole one by rounding counts as whole.
    let sweeps = (wanted - 1e-9).ceil().max(1.0);
    Share { sweeps: sweeps as u32, strength: (wanted / sweeps).min(1.0) }
}

/// Time steps in a substep for a budget of evaluations per 1/24 s (Physical).
pub fn steps(evaluations: f64, substep: f64) -> u32 {
    share(evaluations, substep).sweeps.max(1)
}

/// Approximate membrane stiffness in N/m of a Classic resistance: K = 3.5 n ρ d² / h², where n evaluations in a substep
/// of h seconds act on points of ρ d² kilograms. The factor is measured for sweeps that remove the whole error (3.4 to
/// 4.5); one that removes the share s transmits s / (2 - s) of their force.
pub fn classic_stiffness(resistance: f64, substep: f64, point_mass: f64) -> f64 {
    let Share { sweeps, strength } = share(resistance, substep);
    let share = CLASSIC_SHARE * strength;
    3.5 * f64::from(sweeps) * share / (2.0 - share) * point_mass / (substep * substep)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn per_frame(count: f64, substeps: u32) -> Share {
        share(count, COUNT_PERIOD / f64::from(substeps))
    }

    // EVIDENCE: N2.4-11  10 is 10 at one substep, 5 each at 2, 1 each at 10, 1 weakened each at 20
    // EVIDENCE: N2.2-8  a count is per 1/24 s
    #[test]
    fn a_resistance_of_ten_is_shared_among_substeps_as_in_the_paper() {
        assert_eq!(per_frame(10.0, 1), Share { sweeps: 10, strength: 1.0 });
        assert_eq!(per_frame(10.0, 2), Share { sweeps: 5, strength: 1.0 });
        assert_eq!(per_frame(10.0, 10), Share { sweeps: 1, strength: 1.0 });
        let weakened = per_frame(10.0, 20);
        assert_eq!(weakened.sweeps, 1);
        assert!((weakened.strength - 0.5).abs() < 1e-12);
    }

    #[test]
    fn sweeps_times_strength_per_frame_do_not_depend_on_the_substeps() {
        for count in [0.1, 2.5, 10.0, 20.0, 333.0] {
            for substeps in 1..60 {
                let Share { sweeps, strength } = per_frame(count, substeps);
                let overall = f64::from(sweeps * substeps) * strength;
                assert!((overall / count - 1.0).abs() < 1e-9, "{count} over {substeps}: {overall}");
                assert!(strength <= 1.0);
            }
        }
    }

    #[test]
    fn a_count_is_per_film_frame_at_any_frame_rate() {
        assert_eq!(share(10.0, 1.0 / 48.0).sweeps, 5);
        assert_eq!(share(10.0, 1.0 / 12.0).sweeps, 20);
    }

    #[test]
    fn a_resistance_of_zero_is_never_evaluated() {
        assert_eq!(per_frame(0.0, 3), Share { sweeps: 0, strength: 0.0 });
        assert_eq!(per_frame(-1.0, 3), Share { sweeps: 0, strength: 0.0 });
    }
}
