//! The range of a field: distance, falloff and volume.

use nalgebra::Vector3;

use crate::input::fields::{Reach, Volume, VolumeShape};

impl Reach {
    /// The share of the field at a point, given from the centre; 0 where it does not reach. Without a largest distance the
    /// field falls off as (1 + d)^-attenuation, d in scene units; with one, as (1 - d / largest)^attenuation, times the
    /// falloff curve. Newton's own law has the distance in it (`has_own_law`).
    pub(crate) fn share(&self, from_center: Vector3<f64>, has_own_law: bool) -> f64 {
        if self.volume.is_some_and(|volume| !volume.acts_at(from_center)) {
            return 0.0;
        }
        let bounded = self.max_distance < f64::INFINITY;
        if !bounded && (has_own_law || self.attenuation == 0.0) {
            return 1.0;
        }
        let distance = from_center.norm();
        if distance > self.max_distance {
            return 0.0;
        }
        let curve = if bounded { self.falloff_at(distance / self.max_distance) } else { 1.0 };
        let base =
            if bounded { 1.0 - distance / self.max_distance } else { 1.0 / (1.0 + distance / self.unit) };
        match self.attenuation {
            _ if has_own_law => curve,
            0.0 => curve,
            1.0 => curve * base,
            exponent => curve * libm::pow(base, exponent),
        }
    }

    /// The falloff curve at a share of the largest distance.
    fn falloff_at(&self, share: f64) -> f64 {
        let place = share.clamp(0.0, 1.0) * (Self::SAMPLES - 1) as f64;
        let at = (place as usize).min(Self::SAMPLES - 2);
        let [a, b] = [self.falloff[at], self.falloff[at + 1]];
        a + (b - a) * (place - at as f64)
    }
}

impl Volume {
    fn acts_at(&self, from_center: Vector3<f64>) -> bool {
        self.contains(self.to_local * from_center - self.offset) != self.is_excluded
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
        let mut curved = Reach { max_distance: 4.0, ..Reach::everywhere() };
        curved.falloff = std::array::from_fn(|k| k as f64 / (Reach::SAMPLES - 1) as f64);
        assert!((curved.share(Vector3::x() * 3.0, false) - 0.75).abs() < 1e-12);
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
