//! Conserved quantities: energy, momentum, and the volume inside a closed surface.

use nalgebra::Vector3;
use nucleus_core::Faces;

use super::max_or_nan;

/// Potential energy in joules: Σ -m g·x, with `gravity` as an acceleration in m/s².
pub fn potential(masses: &[f64], points: &[Vector3<f64>], gravity: Vector3<f64>) -> f64 {
    masses.iter().zip(points).map(|(mass, point)| -mass * gravity.dot(point)).sum()
}

/// Kinetic energy in joules: Σ m v²/2.
pub fn kinetic(masses: &[f64], velocities: &[Vector3<f64>]) -> f64 {
    masses.iter().zip(velocities).map(|(mass, v)| 0.5 * mass * v.norm_squared()).sum()
}

/// Largest rise of kinetic plus potential energy above its initial value, in joules.
///
/// In a closed system (no wind, no animated collider or constraint) that starts at rest and unstrained, elastic energy
/// is never negative, so any such rise is created by the solver. Dissipation is not an error. (Solver dossier, F.2:
/// sweeps in index order created 46 kJ.)
pub fn created(start: f64, sums: impl IntoIterator<Item = f64>) -> f64 {
    sums.into_iter().map(|sum| sum - start).fold(0.0, max_or_nan)
}

/// Linear momentum in kg·m/s: Σ m v. Conserved without external forces.
pub fn linear(masses: &[f64], velocities: &[Vector3<f64>]) -> Vector3<f64> {
    masses.iter().zip(velocities).map(|(mass, v)| *mass * v).sum()
}

/// Angular momentum about the centre of mass in kg·m²/s: Σ m (x - c) × v. Conserved without external forces,
/// independent of the position of the cloth.
pub fn angular(masses: &[f64], points: &[Vector3<f64>], velocities: &[Vector3<f64>]) -> Vector3<f64> {
    let centre = centre(masses, points);
    let each = masses.iter().zip(points).zip(velocities);
    each.map(|((mass, point), v)| *mass * (point - centre).cross(v)).sum()
}

/// Centre of mass, in the unit of the points; the origin if the total mass is zero.
pub fn centre(masses: &[f64], points: &[Vector3<f64>]) -> Vector3<f64> {
    let mass: f64 = masses.iter().sum();
    let sum: Vector3<f64> = masses.iter().zip(points).map(|(mass, point)| *mass * point).sum();
    if mass > 0.0 { sum / mass } else { Vector3::zeros() }
}

/// Volume enclosed by a closed surface, in the cube of its unit (divergence theorem). Negative for inverted
/// orientation; meaningless for an open surface.
pub fn volume(faces: &Faces, points: &[Vector3<f64>]) -> f64 {
    let corner = |point: u32| points[point as usize];
    faces.triangles().map(|[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_fall_creates_no_energy() {
        let gravity = Vector3::new(0.0, -9.8, 0.0);
        let sum = |t: f64| {
            let point = Vector3::new(0.0, 10.0 - 0.5 * 9.8 * t * t, 0.0);
            potential(&[2.0], &[point], gravity) + kinetic(&[2.0], &[gravity * t])
        };
        let gain = created(sum(0.0), (0..10).map(|k| sum(0.1 * f64::from(k))));
        assert!((sum(0.0) - 196.0).abs() < 1e-12 && gain < 1e-12, "{gain}");
    }

    #[test]
    fn only_a_rise_above_the_initial_energy_counts_as_created() {
        assert_eq!(created(5.0, [4.0, 7.5, 3.0]), 2.5);
        assert_eq!(created(5.0, [4.0, 3.0]), 0.0);
        assert!(created(5.0, [f64::NAN, 3.0]).is_nan());
    }

    fn wheel() -> ([f64; 2], [Vector3<f64>; 2], [Vector3<f64>; 2]) {
        ([1.0, 1.0], [Vector3::x(), -Vector3::x()], [Vector3::y(), -Vector3::y()])
    }

    #[test]
    fn a_spinning_wheel_has_angular_but_no_linear_momentum() {
        let (masses, points, velocities) = wheel();
        assert_eq!(linear(&masses, &velocities), Vector3::zeros());
        assert_eq!(angular(&masses, &points, &velocities), Vector3::z() * 2.0);
    }

    #[test]
    fn angular_momentum_is_independent_of_position_and_of_rigid_translation() {
        let (masses, points, velocities) = wheel();
        let far = points.map(|point| point + Vector3::new(7.0, -3.0, 2.0));
        let fast = velocities.map(|v| v + Vector3::new(5.0, 1.0, -4.0));
        let change = angular(&masses, &far, &fast) - Vector3::z() * 2.0;
        assert!(change.norm() < 1e-12, "{change}");
    }

    #[test]
    fn a_corner_tetrahedron_has_a_sixth_of_the_cube_wherever_it_is() {
        let faces: Faces =
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].iter().map(|face| &face[..]).collect();
        let corners = [Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z()];
        for shift in [Vector3::zeros(), Vector3::new(3.0, -8.0, 5.0)] {
            let found = volume(&faces, &corners.map(|corner| corner + shift));
            assert!((found - 1.0 / 6.0).abs() < 1e-12, "{found}");
        }
    }
}
