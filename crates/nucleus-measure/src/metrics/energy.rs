//! Whether energy came from nowhere.

use nalgebra::Vector3;

/// The energy of height in joules: Σ -m g·x, with gravity as an acceleration in m/s². What falls loses it.
pub fn potential(masses: &[f64], points: &[Vector3<f64>], gravity: Vector3<f64>) -> f64 {
    masses.iter().zip(points).map(|(mass, point)| -mass * gravity.dot(point)).sum()
}

/// The energy of motion in joules: Σ m v²/2.
pub fn kinetic(masses: &[f64], velocities: &[Vector3<f64>]) -> f64 {
    masses.iter().zip(velocities).map(|(mass, v)| 0.5 * mass * v.norm_squared()).sum()
}

/// How far kinetic and potential energy together ever rose above where they began, in joules.
///
/// Where nothing drives the cloth (no wind, no collider or constraint that moves), it starts at rest and unstrained
/// and the energy of strain is never negative: whatever is above the beginning came from nowhere. Energy lost is no
/// error. (Solver dossier, F.2: passes in index order made 46 kJ out of nothing.)
pub fn created(start: f64, sums: impl IntoIterator<Item = f64>) -> f64 {
    sums.into_iter().map(|sum| sum - start).fold(0.0, super::worse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fall_turns_height_into_motion_and_makes_nothing() {
        let gravity = Vector3::new(0.0, -9.8, 0.0);
        let sum = |t: f64| {
            let point = Vector3::new(0.0, 10.0 - 0.5 * 9.8 * t * t, 0.0);
            potential(&[2.0], &[point], gravity) + kinetic(&[2.0], &[gravity * t])
        };
        let made = created(sum(0.0), (0..10).map(|k| sum(0.1 * f64::from(k))));
        assert!((sum(0.0) - 196.0).abs() < 1e-12 && made < 1e-12, "{made}");
    }

    #[test]
    fn what_rises_above_the_start_was_made_and_what_falls_below_is_none() {
        assert_eq!(created(5.0, [4.0, 7.5, 3.0]), 2.5);
        assert_eq!(created(5.0, [4.0, 3.0]), 0.0);
        assert!(created(5.0, [f64::NAN, 3.0]).is_nan());
    }
}
