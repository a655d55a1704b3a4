//! Whether motion came from nowhere.

use nalgebra::Vector3;

/// Linear momentum in kg·m/s: Σ m v. In a scene that nothing acts on it stays as it is.
pub fn linear(masses: &[f64], velocities: &[Vector3<f64>]) -> Vector3<f64> {
    masses.iter().zip(velocities).map(|(mass, v)| *mass * v).sum()
}

/// Angular momentum about the centre of mass in kg·m²/s: Σ m (x - c) × v. Stays as it is too, wherever the cloth
/// moves to.
pub fn angular(masses: &[f64], points: &[Vector3<f64>], velocities: &[Vector3<f64>]) -> Vector3<f64> {
    let centre = centre(masses, points);
    let each = masses.iter().zip(points).zip(velocities);
    each.map(|((mass, point), v)| *mass * (point - centre).cross(v)).sum()
}

/// The centre of mass, in the unit of the points; the origin if nothing has mass.
pub fn centre(masses: &[f64], points: &[Vector3<f64>]) -> Vector3<f64> {
    let mass: f64 = masses.iter().sum();
    let sum: Vector3<f64> = masses.iter().zip(points).map(|(mass, point)| *mass * point).sum();
    if mass > 0.0 { sum / mass } else { Vector3::zeros() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wheel() -> ([f64; 2], [Vector3<f64>; 2], [Vector3<f64>; 2]) {
        ([1.0, 1.0], [Vector3::x(), -Vector3::x()], [Vector3::y(), -Vector3::y()])
    }

    #[test]
    fn a_wheel_turns_and_goes_nowhere() {
        let (masses, points, velocities) = wheel();
        assert_eq!(linear(&masses, &velocities), Vector3::zeros());
        assert_eq!(angular(&masses, &points, &velocities), Vector3::z() * 2.0);
    }

    #[test]
    fn turning_does_not_depend_on_where_it_is_or_how_it_moves_as_a_whole() {
        let (masses, points, velocities) = wheel();
        let far = points.map(|point| point + Vector3::new(7.0, -3.0, 2.0));
        let fast = velocities.map(|v| v + Vector3::new(5.0, 1.0, -4.0));
        let change = angular(&masses, &far, &fast) - Vector3::z() * 2.0;
        assert!(change.norm() < 1e-12, "{change}");
    }
}
