//! Gusts: the wind varies smoothly in space and time by `windNoise` times its speed.
//!
//! Noise on a lattice that the wind carries along (frozen turbulence, Taylor 1938), in two octaves. Its value at a lattice
//! point is a hash of its coordinates, so the same scene has the same gusts on every machine.

use nalgebra::Vector3;

use crate::input::frame::FrameInput;

/// Size in metres of the largest gusts, and of those of half their strength.
const SIZES: [(f64, f64); 2] = [(2.0, 2.0 / 3.0), (0.5, 1.0 / 3.0)];

/// Whether the wind of a frame varies.
pub fn is_gusty(frame: &FrameInput) -> bool {
    frame.wind_noise != 0.0 && frame.wind != Vector3::zeros()
}

/// The gusts at one time.
pub struct GustField {
    /// How far the wind has carried the air since the start, in metres.
    travel: Vector3<f64>,
    /// In m/s.
    strength: f64,
}

impl GustField {
    /// The gusts at a share `time` of a frame, at whose end the wind has travelled `travel` metres.
    pub fn new(travel: [f64; 3], frame: &FrameInput, time: f64) -> Self {
        // The frame's own travel is counted from its start on.
        let travel = Vector3::from(travel) + frame.wind * (frame.duration * time - frame.duration);
        Self { travel, strength: frame.wind.norm() * frame.wind_noise }
    }

    /// Velocity that gusts add to the wind, in m/s, at a `place` in metres.
    pub fn at(&self, place: Vector3<f64>) -> Vector3<f64> {
        noise(place - self.travel) * self.strength
    }
}

/// A smooth field of vectors, each component between -1 and 1 and of mean zero; `place` in metres.
fn noise(place: Vector3<f64>) -> Vector3<f64> {
    SIZES.iter().map(|&(size, share)| lattice_noise(place / size) * share).sum()
}

/// Smooth noise of mean zero, a lattice point per unit: each component between -1 and 1.
pub fn lattice_noise(place: Vector3<f64>) -> Vector3<f64> {
    // Farther out places have no fraction.
    let low = place.map(|x| x.floor().clamp(-1e18, 1e18));
    let share = (place - low).map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let cell = low.map(|x| x as i64);
    let mut sum = Vector3::zeros();
    for corner in 0..8i64 {
        let offset = Vector3::new(corner & 1, corner >> 1 & 1, corner >> 2);
        let weight: f64 =
            (0..3).map(|axis| if offset[axis] == 1 { share[axis] } else { 1.0 - share[axis] }).product();
        sum += value(cell + offset) * weight;
    }
    sum
}

/// The value at a lattice point: three components between -1 and 1.
fn value(cell: Vector3<i64>) -> Vector3<f64> {
    let mixed = |hash: u64, x: i64| {
        let hash = (hash ^ x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (hash ^ hash >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93)
    };
    let hash = cell.iter().fold(0x2545_f491_4f6c_dd1d, |hash, &x| mixed(hash, x));
    let component = |k: i64| {
        let bits = mixed(hash, k) >> 40;
        bits as f64 / f64::from(1u32 << 23) - 1.0
    };
    Vector3::new(component(1), component(2), component(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_are_smooth_bounded_and_of_mean_zero() {
        let line = (0..40_000).map(|k| noise(Vector3::new(f64::from(k) * 0.01, 3.3, -7.1)));
        let all: Vec<_> = line.collect();
        assert!(all.iter().all(|v| v.amax() <= 1.0));
        assert!(all.windows(2).all(|pair| (pair[1] - pair[0]).amax() < 0.06), "no jump in a centimetre");
        let mean = all.iter().sum::<Vector3<f64>>() / all.len() as f64;
        assert!(mean.amax() < 0.1, "{mean}");
        let spread = all.iter().map(|v| v.norm_squared() / 3.0).sum::<f64>() / all.len() as f64;
        assert!(spread.sqrt() > 0.15, "{spread}");
    }
}
