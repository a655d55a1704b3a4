//! The range of a field: distance, falloff and volume.

use nalgebra::Vector3;

use crate::input::fields::{Reach, Volume, VolumeShape};
use crate::input::samples::sample_at;

impl Reach {
    /// The share of the field at a point, given from the centre; 0 where it does not reach. Without a largest distance the
    /// field falls off as (1 + d)^-attenuation, d in scene units; with one, as (1 - d / largest)^attenuation, times the
    /// falloff curve; in a volume d / largest is the way to its edge. Newton's own law has the distance in it (`has_own_law`).
    pub(crate) fn share(&self, from_center: Vector3<f64>, has_own_law: bool) -> f64 {
        if self.volume.is_some_and(|volume| !volume.acts_at(from_center)) {
            return 0.0;
        }
        let relative = self.relative_distance(from_center);
        if relative.is_none() && (has_own_law || self.attenuation == 0.0) {
            return 1.0;
        }
        if relative.is_some_and(|relative| relative > 1.0) {
            return 0.0;
        }
        let curve = relative.map_or(1.0, |relative| sample_at(&self.falloff, relative));
        let base =
            relative.map_or_else(|| 1.0 / (1.0 + from_center.norm() / self.unit), |relative| 1.0 - relative);
        match self.attenuation {
            _ if has_own_law => curve,
            0.0 => curve,
            1.0 => curve * base,
            exponent => curve * libm::pow(base, exponent),
        }
    }

    /// The distance relative to the largest, or to that of the volume's edge; `None` where the field has no end. A field of no
    /// reach does not act at its centre either.
    fn relative_distance(&self, from_center: Vector3<f64>) -> Option<f64> {
        if self.max_distance <= 0.0 {
            return Some(f64::INFINITY);
        }
        if self.max_distance < f64::INFINITY {
            return Some(from_center.norm() / self.max_distance);
        }
        self.volume.filter(|_| self.falls_off_in_volume).map(|volume| volume.depth(from_center).min(1.0))
    }
}

impl Volume {
    fn acts_at(&self, from_center: Vector3<f64>) -> bool {
        self.contains(self.to_local * from_center - self.offset) != self.is_excluded
    }

    /// How far a point is from the centre of a cube or a sphere, from the axis of a cylinder or a cone, or from the ring of a
    /// torus: 0 there, 1 at the edge.
    fn depth(&self, from_center: Vector3<f64>) -> f64 {
        let at = self.to_local * from_center - self.offset;
        let across = (at.x * at.x + at.z * at.z).sqrt();
        match self.shape {
            VolumeShape::Cube => at.amax(),
            VolumeShape::Sphere => at.norm(),
            VolumeShape::Cylinder => across,
            VolumeShape::Cone => across / ((at.y + 1.0) / 2.0).max(f64::MIN_POSITIVE),
            VolumeShape::Torus => {
                let from_ring = across - 1.0;
                (from_ring * from_ring + at.y * at.y).sqrt() / self.section.max(f64::MIN_POSITIVE)
            }
        }
    }

    /// Whether a point in its own space is inside.
    fn contains(&self, at: Vector3<f64>) -> bool {
        let across = (at.x * at.x + at.z * at.z).sqrt();
        let is_in_sweep = self.sweep.is_none_or(|[sin, cos]| is_within(at.x, at.z, [sin, cos]));
        match self.shape {
            VolumeShape::Cube => at.amax() <= 1.0,
            VolumeShape::Sphere => is_in_sweep && at.norm_squared() <= 1.0,
            VolumeShape::Cylinder => is_in_sweep && across <= 1.0 && at.y.abs() <= 1.0,
            VolumeShape::Cone => is_in_sweep && at.y.abs() <= 1.0 && across <= (at.y + 1.0) / 2.0,
            VolumeShape::Torus => {
                let from_ring = across - 1.0;
                is_in_sweep && from_ring * from_ring + at.y * at.y <= self.section * self.section
            }
        }
    }
}

/// Whether the angle of (x, z) from x towards z is at most one whose sine and cosine are given, 0 to 360 degrees.
fn is_within(x: f64, z: f64, [sin, cos]: [f64; 2]) -> bool {
    let turned = x * sin - z * cos; // above 0 within half a turn before the end
    if sin >= 0.0 { z >= 0.0 && turned >= 0.0 } else { z >= 0.0 || turned >= 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn a_field_falls_off_with_the_distance_and_ends_at_the_largest() {
        let near = Reach { attenuation: 2.0, ..Reach::everywhere() };
        assert!((near.share(Vector3::x(), false) - 0.25).abs() < 1e-12);
        assert_eq!(near.share(Vector3::x(), true), 1.0, "a law of its own has no other falloff");
        let bounded = Reach { max_distance: 4.0, ..near };
        assert!((bounded.share(Vector3::x(), false) - 0.5625).abs() < 1e-12);
        assert_eq!(bounded.share(Vector3::x() * 4.1, false), 0.0);
        for max_distance in [0.0, -1.0] {
            let nowhere = Reach { max_distance, ..Reach::everywhere() };
            assert_eq!(nowhere.share(Vector3::zeros(), false), 0.0);
        }
        let mut curved = Reach { max_distance: 4.0, ..Reach::everywhere() };
        curved.falloff = std::array::from_fn(|k| k as f64 / (Reach::SAMPLES - 1) as f64);
        assert!((curved.share(Vector3::x() * 3.0, false) - 0.75).abs() < 1e-12);
    }

    #[test]
    fn a_field_falls_off_in_its_volume_up_to_the_edge() {
        let volume = |shape| Volume {
            shape,
            to_local: Matrix3::identity() / 2.0,
            offset: Vector3::zeros(),
            section: 0.25,
            sweep: None,
            is_excluded: false,
        };
        let places = [
            (VolumeShape::Cube, [0.0, 1.0, 0.5], 0.5),
            (VolumeShape::Sphere, [0.6, 0.0, 0.8], 0.5),
            (VolumeShape::Cylinder, [0.6, 1.9, 0.8], 0.5),
            (VolumeShape::Cone, [0.25, 0.0, 0.0], 0.25),
            (VolumeShape::Torus, [2.25, 0.0, 0.0], 0.5),
        ];
        for (shape, at, depth) in places {
            let volume = Some(volume(shape));
            let linear = Reach { attenuation: 1.0, volume, falls_off_in_volume: true, ..Reach::everywhere() };
            let found = linear.share(at.into(), false);
            assert!((found - (1.0 - depth)).abs() < 1e-12, "{shape:?}: {found}");
            let everywhere = Reach { falls_off_in_volume: false, attenuation: 0.0, ..linear };
            assert_eq!(everywhere.share(at.into(), false), 1.0);
        }
    }

    #[test]
    fn volumes_contain_what_is_inside_and_exclusion_the_rest() {
        let volume = |shape, is_excluded| Volume {
            shape,
            to_local: Matrix3::identity() / 2.0,
            offset: Vector3::zeros(),
            section: 0.25,
            sweep: None,
            is_excluded,
        };
        let inside = [
            (VolumeShape::Cube, [1.9, -1.9, 1.9], [2.1, 0.0, 0.0]),
            (VolumeShape::Sphere, [1.1, 1.1, 1.1], [1.2, 1.2, 1.2]),
            (VolumeShape::Cylinder, [1.3, 1.9, 1.3], [1.5, 0.0, 1.5]),
            (VolumeShape::Cone, [0.9, 0.0, 0.0], [1.1, 0.0, 0.0]),
            (VolumeShape::Torus, [2.0, 0.4, 0.0], [0.0, 0.0, 0.0]),
        ];
        for (shape, within, without) in inside {
            for (is_excluded, at, acts) in
                [(false, within, true), (false, without, false), (true, within, false), (true, without, true)]
            {
                assert_eq!(volume(shape, is_excluded).acts_at(at.into()), acts, "{shape:?} {at:?}");
            }
        }
    }

    #[test]
    fn a_sweep_keeps_the_angles_up_to_its_end() {
        for (degrees, sin, cos) in [(90.0, 1.0, 0.0), (180.0, 0.0, -1.0), (270.0, -1.0, 0.0)] {
            for angle in (5..360).step_by(10).map(f64::from) {
                let (z, x) = f64::sin_cos(angle * std::f64::consts::PI / 180.0);
                assert_eq!(is_within(x, z, [sin, cos]), angle < degrees, "{angle} of {degrees}");
            }
        }
    }
}
