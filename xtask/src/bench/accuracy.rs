//! Errors of a run, measured as for the peers.

use nalgebra::Vector3;
use nucleus_core::{COUNT_PERIOD, ClothId, StateView, Surface};
use nucleus_measure::metrics::deformation::Edges;

use super::workload::{Ball, GRAVITY};

/// The frames of a second.
const SECOND: usize = 24;

/// Errors of a run. Strains are length over rest length, minus 1; after a frame that is not finite, no figure is finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// RMS strain of all edges, averaged over all frames.
    pub strain: f64,
    /// RMS of the positive strains at the last frame.
    pub stretch: f64,
    /// Largest strain at the last frame.
    pub max: f64,
    /// Largest strain at the worst frame.
    pub worst_max: f64,
    /// Maximum depth of the lowest point below height 0, in metres.
    pub sag: f64,
    /// Change of kinetic and potential energy from the first frame to the end of the first second, in J/kg.
    pub energy: f64,
    /// Maximum depth of a point inside the ball at the last frame, in metres; 0 without a ball.
    pub depth: f64,
    /// The same at the worst frame.
    pub worst_depth: f64,
    /// Height of the midpoint of the lower edge, averaged over the last second, in metres.
    pub lower_edge: f64,
}

/// Accumulates errors frame by frame.
pub struct Meter {
    edges: Vec<([u32; 2], f64)>,
    points: Vec<Vector3<f64>>,
    before: Vec<Vector3<f64>>,
    ball: Option<Ball>,
    lower_middle: usize,
    strains: f64,
    frames: usize,
    energies: Vec<f64>,
    lower_edges: Vec<f64>,
    last: Accuracy,
}

impl Meter {
    /// For a sheet of `n` by `n` points that starts at rest, and its ball.
    pub fn new(sheet: &Surface, n: u32, ball: Option<Ball>) -> Self {
        let points = sheet.positions.clone();
        let last = Accuracy {
            strain: 0.0,
            stretch: 0.0,
            max: 0.0,
            worst_max: 0.0,
            sag: 0.0,
            energy: 0.0,
            depth: 0.0,
            worst_depth: 0.0,
            lower_edge: 0.0,
        };
        Self {
            edges: Edges::of(sheet).iter().collect(),
            before: points.clone(),
            lower_middle: (n * n - n / 2 - 1) as usize,
            points,
            ball,
            strains: 0.0,
            frames: 0,
            energies: Vec::new(),
            lower_edges: Vec::new(),
            last,
        }
    }

    /// Adds the state at the end of a frame.
    pub fn frame(&mut self, state: &dyn StateView) {
        std::mem::swap(&mut self.points, &mut self.before);
        for (point, place) in self.points.iter_mut().enumerate() {
            *place = state.point(ClothId(0), point);
        }
        self.measure_strain();
        self.measure_energy();
        let lowest = self.points.iter().fold(0.0, |most, point| f64::max(most, -point.y));
        self.last.sag = self.last.sag.max(lowest);
        self.last.depth = self.depth();
        self.last.worst_depth = self.last.worst_depth.max(self.last.depth);
        self.lower_edges.push(self.points[self.lower_middle].y);
    }

    /// Errors of all frames so far.
    pub fn finish(self) -> Accuracy {
        let tail = &self.lower_edges[self.lower_edges.len().saturating_sub(SECOND)..];
        let energy = self.energies.first().zip(self.energies.get(SECOND - 1));
        Accuracy {
            strain: self.strains / self.frames as f64,
            energy: energy.map_or(f64::NAN, |(start, end)| end - start),
            lower_edge: tail.iter().sum::<f64>() / tail.len() as f64,
            ..self.last
        }
    }

    /// Depth of the deepest point in the ball at its current position.
    fn depth(&self) -> f64 {
        let Some(ball) = self.ball else { return 0.0 };
        self.points.iter().map(|point| ball.depth(self.frames as f64, point)).fold(0.0, f64::max)
    }

    fn measure_strain(&mut self) {
        let (mut squares, mut positive, mut max) = (0.0, 0.0, f64::NEG_INFINITY);
        for &([a, b], rest) in &self.edges {
            let strain = (self.points[b as usize] - self.points[a as usize]).norm() / rest - 1.0;
            squares += strain * strain;
            positive += if strain > 0.0 { strain * strain } else { 0.0 };
            max = f64::max(max, strain);
        }
        let root_mean = |sum: f64| (sum / self.edges.len() as f64).sqrt();
        // NaN propagates through a sum, but not through the comparisons above.
        let lost = if squares.is_finite() { 0.0 } else { f64::INFINITY };
        self.strains += root_mean(squares) + lost;
        self.frames += 1;
        (self.last.stretch, self.last.max) = (root_mean(positive) + lost, max + lost);
        self.last.worst_max = self.last.worst_max.max(self.last.max);
    }

    /// Kinetic energy from the displacement of the frame, potential energy at its midpoint.
    fn measure_energy(&mut self) {
        let energy = |(now, before): (&Vector3<f64>, &Vector3<f64>)| {
            let speed = (now - before).norm() / COUNT_PERIOD;
            0.5 * speed * speed + GRAVITY * 0.5 * (now.y + before.y)
        };
        let all: f64 = self.points.iter().zip(&self.before).map(energy).sum();
        self.energies.push(all / self.points.len() as f64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::mesh::{self, Cells};
    use crate::bench::workload::BALL;

    /// A cloth with points at given positions.
    struct Placed<F>(F);

    impl<F: Fn(usize) -> Vector3<f64>> StateView for Placed<F> {
        fn positions(&self, _: ClothId, _: f64, _: &mut Vec<[f32; 3]>) {}
        fn velocities(&self, _: ClothId, _: f64, _: &mut Vec<[f32; 3]>) {}
        fn collider_positions(&self, _: nucleus_core::ColliderId, _: f64, _: &mut Vec<[f32; 3]>) {}
        fn collider_moved(&self, _: nucleus_core::ColliderId) -> bool {
            false
        }
        fn point(&self, _: ClothId, point: usize) -> Vector3<f64> {
            (self.0)(point)
        }
    }

    fn level(n: u32) -> Surface {
        mesh::sheet(n, Cells::Triangles, Vector3::zeros(), Vector3::x(), Vector3::z())
    }

    #[test]
    fn a_sheet_scaled_by_a_tenth_has_a_uniform_strain_of_a_tenth() {
        let sheet = level(5);
        let mut meter = Meter::new(&sheet, 5, None);
        meter.frame(&Placed(|point| sheet.positions[point] * 1.1));
        let found = meter.finish();
        for strain in [found.strain, found.stretch, found.max] {
            assert!((strain - 0.1).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn free_fall_conserves_energy() {
        let sheet = level(3);
        let mut meter = Meter::new(&sheet, 3, None);
        for frame in 1..=SECOND {
            let time = frame as f64 * COUNT_PERIOD;
            meter.frame(&Placed(|point| {
                sheet.positions[point] - Vector3::y() * (0.5 * GRAVITY * time * time)
            }));
        }
        let found = meter.finish();
        // Over a parabola the mean speed and the middle of a frame agree up to a constant.
        assert!(found.energy.abs() < 1e-9, "{found:?}");
        assert!((found.sag - 0.5 * GRAVITY).abs() < 1e-9);
    }

    #[test]
    fn a_nan_point_makes_every_strain_infinite() {
        let sheet = level(3);
        let mut meter = Meter::new(&sheet, 3, None);
        meter.frame(&Placed(
            |point| if point == 4 { Vector3::repeat(f64::NAN) } else { sheet.positions[point] },
        ));
        let found = meter.finish();
        assert!(!found.strain.is_finite() && !found.stretch.is_finite() && !found.max.is_finite());
    }

    #[test]
    fn the_worst_stretch_is_that_of_the_worst_frame() {
        let sheet = level(3);
        let mut meter = Meter::new(&sheet, 3, None);
        for blown_up in [1.1, 1.5, 1.2] {
            meter.frame(&Placed(|point| sheet.positions[point] * blown_up));
        }
        let found = meter.finish();
        assert!((found.max - 0.2).abs() < 1e-12 && (found.worst_max - 0.5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_point_at_the_centre_of_the_ball_is_a_radius_deep() {
        let sheet = level(3);
        let mut meter = Meter::new(&sheet, 3, Some(BALL));
        meter.frame(&Placed(|_| BALL.start.into()));
        meter.frame(&Placed(|_| Vector3::repeat(5.0)));
        let found = meter.finish();
        assert_eq!((found.depth, found.worst_depth), (0.0, BALL.radius));
    }

    #[test]
    fn depth_uses_the_position_of_the_ball_at_the_end_of_the_frame() {
        let sheet = level(3);
        let ball = Ball { radius: 0.5, start: [0.0, 0.0, -2.0], flight: [0.0, 0.0, 1.0] };
        let mut meter = Meter::new(&sheet, 3, Some(ball));
        let mut depths = Vec::new();
        for _ in 0..3 {
            meter.frame(&Placed(|_| Vector3::zeros()));
            depths.push(meter.last.depth);
        }
        assert_eq!(depths, [0.0, 0.5, 0.0]);
        assert_eq!(meter.finish().worst_depth, 0.5);
    }

    #[test]
    fn without_a_ball_the_depth_is_zero() {
        let sheet = level(3);
        let mut meter = Meter::new(&sheet, 3, None);
        meter.frame(&Placed(|_| BALL.start.into()));
        assert_eq!(meter.finish().worst_depth, 0.0);
    }
}
