//! The ball of a workload and its motion; depths are measured against its position at each frame.

use nalgebra::Vector3;

/// A ball at rest or in uniform motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its radius in metres.
    pub radius: f64,
    /// Initial centre in metres.
    pub start: [f64; 3],
    /// Displacement per frame in metres.
    pub flight: [f64; 3],
}

impl Ball {
    /// Centre after a number of frames, in metres.
    pub fn centre(&self, frames: f64) -> Vector3<f64> {
        Vector3::from(self.start) + Vector3::from(self.flight) * frames
    }

    /// Depth of a point inside the ball after a number of frames, in metres; negative outside.
    pub fn depth(&self, frames: f64, point: &Vector3<f64>) -> f64 {
        self.radius - (point - self.centre(frames)).norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_follows_the_motion_of_the_ball() {
        let ball = Ball { radius: 0.5, start: [1.0, 0.0, -2.0], flight: [0.0, 0.0, 0.25] };
        let place = Vector3::new(1.0, 0.0, 0.0);
        assert_eq!([0.0, 7.0, 8.0].map(|frames| ball.depth(frames, &place)), [-1.5, 0.25, 0.5]);
    }
}
