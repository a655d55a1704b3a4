//! Ramps: a value over a position from 0 to 1.

use super::value::{Choice, RampPoint};

/// Interpolations of ramps.
const STEP: Choice = Choice(0);
const LINEAR: Choice = Choice(1);

/// A ramp whose points are in order of position.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramp {
    points: Vec<RampPoint>,
}

impl Ramp {
    /// A ramp with these points, in any order.
    pub fn new(points: &[RampPoint]) -> Self {
        let mut points = points.to_vec();
        points.sort_by(|a, b| a.position.total_cmp(&b.position));
        Self { points }
    }

    /// The value at a position: before the first point and behind the last it is constant; 0 without points.
    pub fn value_at(&self, position: f64) -> f64 {
        let next = self.points.partition_point(|point| point.position <= position);
        let before = self.points.get(next.wrapping_sub(1)).or(self.points.first());
        let (Some(a), b) = (before, self.points.get(next)) else { return 0.0 };
        let Some(b) = b.filter(|b| b.position > a.position && position > a.position) else { return a.value };
        let share = (position - a.position) / (b.position - a.position);
        let share = match a.interpolation {
            STEP => 0.0,
            LINEAR => share,
            // Smooth and spline: no overshoot.
            _ => share * share * (3.0 - 2.0 * share),
        };
        a.value + (b.value - a.value) * share
    }

    /// Values at `N` evenly spaced positions from 0 to 1.
    pub fn samples<const N: usize>(&self) -> [f64; N] {
        std::array::from_fn(|k| self.value_at(k as f64 / (N - 1) as f64))
    }

    /// Whether no value is below a limit.
    pub fn is_at_least(&self, limit: f64) -> bool {
        self.points.iter().all(|point| point.value >= limit)
    }

    /// Whether it has the same value at all positions.
    pub fn is_constant(&self) -> bool {
        self.points.windows(2).all(|pair| pair[0].value == pair[1].value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_constant_outside_its_points_and_interpolated_between_them() {
        let point = |position, value, kind| RampPoint { position, value, interpolation: Choice(kind) };
        let ramp = Ramp::new(&[point(0.75, 4.0, 1), point(0.25, 2.0, 1)]);
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(|at| ramp.value_at(at)), [2.0, 2.0, 3.0, 4.0, 4.0]);
        assert_eq!(ramp.samples::<3>(), [2.0, 3.0, 4.0]);
        let step = Ramp::new(&[point(0.25, 2.0, 0), point(0.75, 4.0, 0)]);
        assert_eq!([0.5, 0.75].map(|at| step.value_at(at)), [2.0, 4.0]);
        let smooth = Ramp::new(&[point(0.0, 0.0, 2), point(1.0, 1.0, 2)]);
        assert_eq!([0.25, 0.5].map(|at| smooth.value_at(at)), [0.15625, 0.5]);
        assert_eq!(Ramp::new(&[]).value_at(0.5), 0.0);
    }
}
