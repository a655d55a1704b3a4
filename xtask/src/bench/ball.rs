//! The ball of a workload, where it is at each frame: errors are measured against the one that is there.

use nalgebra::Vector3;

/// A ball that rests, or flies on evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its radius in metres.
    pub radius: f64,
    /// Its centre when the run begins, in metres.
    pub start: [f64; 3],
    /// How far it flies in a frame, in metres.
    pub flight: [f64; 3],
}

impl Ball {
    /// Its centre after so many frames, in metres.
    pub fn centre(&self, frames: f64) -> Vector3<f64> {
        Vector3::from(self.start) + Vector3::from(self.flight) * frames
    }

    /// How deep a point is in it after so many frames, in metres; below nought outside.
    pub fn depth(&self, frames: f64, point: &Vector3<f64>) -> f64 {
        self.radius - (point - self.centre(frames)).norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_takes_its_inside_along() {
        let ball = Ball { radius: 0.5, start: [1.0, 0.0, -2.0], flight: [0.0, 0.0, 0.25] };
        let place = Vector3::new(1.0, 0.0, 0.0);
        assert_eq!([0.0, 7.0, 8.0].map(|frames| ball.depth(frames, &place)), [-1.5, 0.25, 0.5]);
    }
}
