//! The animation of one property of a glTF node.

use gltf::animation::Interpolation;
use nalgebra::{Quaternion, UnitQuaternion};

/// Keys of a property.
pub(super) struct Track {
    /// Seconds, ascending.
    times: Vec<f64>,
    /// Numbers of each key; with cubic interpolation the tangent before, the value, and the tangent after.
    values: Vec<f64>,
    /// Numbers of a value.
    width: usize,
    interpolation: Interpolation,
}

impl Track {
    /// `None` if there are no keys, or their times and values do not fit.
    pub(super) fn new(times: Vec<f64>, values: Vec<f64>, interpolation: Interpolation) -> Option<Self> {
        let rows = times.len() * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let fits = rows > 0 && values.len() >= rows && values.len().is_multiple_of(rows);
        fits.then(|| Self { width: values.len() / rows, times, values, interpolation })
    }

    /// The value at a time; constant before the first and after the last key.
    pub(super) fn at(&self, time: f64) -> Vec<f64> {
        let (before, after, share) = self.place(time);
        let length = self.times[after] - self.times[before];
        let [a, b] = [before, after].map(|key| self.value(key));
        let s = match self.interpolation {
            Interpolation::Step => 0.0,
            _ => share,
        };
        if self.interpolation != Interpolation::CubicSpline {
            return a.iter().zip(b).map(|(a, b)| a + (b - a) * s).collect();
        }
        // The Hermite spline of the glTF 2.0 specification, appendix C.
        let (s2, s3) = (s * s, s * s * s);
        let weights = [2.0 * s3 - 3.0 * s2 + 1.0, s3 - 2.0 * s2 + s, 3.0 * s2 - 2.0 * s3, s3 - s2];
        let [out, into] = [self.row(3 * before + 2), self.row(3 * after)];
        let mixed = |k: usize| {
            weights[0] * a[k]
                + weights[1] * length * out[k]
                + weights[2] * b[k]
                + weights[3] * length * into[k]
        };
        (0..self.width).map(mixed).collect()
    }

    /// A rotation at a time: along the shorter great arc, or the spline, normalised.
    pub(super) fn rotation_at(&self, time: f64) -> Option<[f64; 4]> {
        let (before, after, share) = self.place(time);
        let key = |values: &[f64]| values.first_chunk::<4>().copied();
        if self.interpolation != Interpolation::Linear {
            let turn = unit(key(&self.at(time))?);
            return Some([turn.i, turn.j, turn.k, turn.w]);
        }
        let (a, b) = (unit(key(self.value(before))?), unit(key(self.value(after))?));
        let turn = a.try_slerp(&b, share, 1e-9).unwrap_or(b);
        Some([turn.i, turn.j, turn.k, turn.w])
    }

    /// The keys before and after a time, and its share of the way between them. A key holds from its own time on; files
    /// store times as `f32`, so that a key at a frame may lie a rounding error behind it.
    fn place(&self, time: f64) -> (usize, usize, f64) {
        let last = self.times.len() - 1;
        let reached = time + 4.0 * f64::from(f32::EPSILON) * time.abs().max(1.0);
        let after = self.times.partition_point(|key| *key <= reached).min(last);
        let before = if self.times[after] <= reached { after } else { after.saturating_sub(1) };
        let length = self.times[after] - self.times[before];
        let share = if length > 0.0 { ((time - self.times[before]) / length).clamp(0.0, 1.0) } else { 0.0 };
        (before, after, share)
    }

    fn value(&self, key: usize) -> &[f64] {
        self.row(if self.interpolation == Interpolation::CubicSpline { 3 * key + 1 } else { key })
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.width..(row + 1) * self.width]
    }
}

pub(super) fn unit([x, y, z, w]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_track_passes_through_its_keys_with_their_tangents() {
        // x³ has the tangents 0 at 0 and 12 at 2; a cubic is its own Hermite spline.
        let values = vec![0.0, 0.0, 0.0, 12.0, 8.0, 12.0];
        let track = Track::new(vec![0.0, 2.0], values, Interpolation::CubicSpline).unwrap();
        for time in [0.0, 0.5, 1.0, 1.7, 2.0] {
            assert!((track.at(time)[0] - time * time * time).abs() < 1e-12);
        }
    }

    #[test]
    fn a_stepped_key_takes_effect_at_its_frame() {
        for fps in [24.0, 25.0, 30.0] {
            let times = (0..200).map(|frame| f64::from(frame as f32 / fps as f32)).collect();
            let track = Track::new(times, (0..200).map(f64::from).collect(), Interpolation::Step).unwrap();
            for frame in 0..200 {
                assert_eq!(track.at(f64::from(frame) / fps), [f64::from(frame)]);
                assert_eq!(track.at((f64::from(frame) + 0.99) / fps), [f64::from(frame)]);
            }
        }
    }

    #[test]
    fn a_rotation_turns_at_constant_speed_and_holds_outside_its_keys() {
        let half = 0.5_f64.sqrt();
        let values = vec![0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half];
        let track = Track::new(vec![1.0, 2.0], values, Interpolation::Linear).unwrap();
        let angle = |time: f64| 2.0 * track.rotation_at(time).unwrap()[1].asin().to_degrees();
        for (time, expected) in [(0.0, 0.0), (1.0, 0.0), (1.5, 45.0), (2.0, 90.0), (9.0, 90.0)] {
            assert!((angle(time) - expected).abs() < 1e-6);
        }
    }
}
