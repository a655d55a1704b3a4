//! Boxes along the axes. They hold every number exactly, so nothing is rounded.

use nalgebra::Vector3;

/// From `least` to `most`, both included. Empty where nothing was taken in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub least: [f64; 3],
    pub most: [f64; 3],
}

impl Bounds {
    pub const EMPTY: Self = Self { least: [f64::INFINITY; 3], most: [f64::NEG_INFINITY; 3] };

    /// Round points. What is not finite makes the box endless, so that nothing is missed.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.with(point))
    }

    fn with(mut self, point: &Vector3<f64>) -> Self {
        for axis in 0..3 {
            let x = point[axis];
            if x.is_finite() {
                self.least[axis] = self.least[axis].min(x);
                self.most[axis] = self.most[axis].max(x);
            } else {
                (self.least[axis], self.most[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
        }
        self
    }

    /// Larger by a distance along every axis, rounded to nearest.
    pub fn grown(mut self, by: f64) -> Self {
        self.least.iter_mut().for_each(|least| *least -= by);
        self.most.iter_mut().for_each(|most| *most += by);
        self
    }

    /// Round both.
    pub fn and(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            self.least[axis] = self.least[axis].min(other.least[axis]);
            self.most[axis] = self.most[axis].max(other.most[axis]);
        }
        self
    }

    /// Whether they have a point in common, their surfaces included.
    pub fn meets(&self, other: &Self) -> bool {
        let along =
            |axis: usize| (self.least[axis] <= other.most[axis]) & (other.least[axis] <= self.most[axis]);
        // Without branches, which nothing could predict.
        along(0) & along(1) & along(2)
    }

    /// Twice the middle along an axis; nought where the box is endless.
    pub fn middle(&self, axis: usize) -> f64 {
        let sum = self.least[axis] + self.most[axis];
        if sum.is_finite() { sum } else { 0.0 }
    }
}
