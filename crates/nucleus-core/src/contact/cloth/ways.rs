//! Where points are foreseen to be at both ends of a span of time, in single precision: good for finding, not for proving.

use super::paths::Path;
use crate::contact::narrow::{between_middles, gap_along, shortest};
use crate::math::{Real, add, dot, scale, sub};

/// The points of two elements.
pub type Points<const N: usize, const M: usize> = ([u32; N], [u32; M]);

/// A way per point.
#[derive(Debug, Default)]
pub struct Ways {
    /// At the start and at the end, in metres from some origin, and how far each may be from its way.
    ends: Vec<[[f32; 4]; 2]>,
}

/// Shares of the length of a place that it may be off by, by rounding.
pub const GRAIN: f32 = 1e-6;

impl Ways {
    /// Ways of so many points.
    pub fn resize(&mut self, points: usize) {
        self.ends.resize(points, [[0.0; 4]; 2]);
    }

    /// Sets the way of a point from what is foreseen for it in the span. `anchor` is in metres from the origin. The ball at
    /// the start and the ball at the end.
    #[inline]
    pub fn set<R: Real>(&mut self, point: usize, path: &Path<R>, anchor: [f64; 3]) -> [([f32; 3], f32); 2] {
        let [start, end] = [R::ZERO, R::ONE].map(|share| {
            let moved = path.at(share);
            std::array::from_fn::<f32, 3, _>(|axis| (anchor[axis] + moved[axis].to_f64()) as f32)
        });
        let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
        let stray = path.ball.to_f64() as f32 + (size(start) + size(end)) * GRAIN;
        let row = |[x, y, z]: [f32; 3]| [x, y, z, stray];
        self.ends[point] = [row(start), row(end)];
        [(start, stray), (end, stray)]
    }

    /// A distance that two elements keep from each other at least, from a share of the span on; reckoned no more sharply
    /// than it takes to see that it is `enough`.
    #[inline(always)]
    pub fn least_distance<const N: usize, const M: usize>(
        &self,
        (ours, theirs): Points<N, M>,
        share: f32,
        enough: f32,
    ) -> f32 {
        let xyz = |[x, y, z, _]: [f32; 4]| [x, y, z];
        let both = |point: u32| {
            let [start, end] = self.ends[point as usize];
            let (first, last) = (xyz(start), xyz(end));
            let first = if share > 0.0 { add(first, scale(sub(last, first), share)) } else { first };
            (first, last, start[3])
        };
        let mut start = ([[0.0; 3]; N], [[0.0; 3]; M]);
        let (mut end, mut strays) = (start, [0.0f32; 2]);
        // Loops, because maps over these arrays are not inlined.
        for k in 0..N {
            let stray;
            (start.0[k], end.0[k], stray) = both(ours[k]);
            strays[0] = strays[0].max(stray);
        }
        for k in 0..M {
            let stray;
            (start.1[k], end.1[k], stray) = both(theirs[k]);
            strays[1] = strays[1].max(stray);
        }
        let stray = strays[0] + strays[1];
        // Most are far apart along the line between their middles, which costs less to see.
        let line = between_middles(&start);
        let gap = gap_along(line, &start).min(gap_along(line, &end));
        let length = dot(line, line).sqrt();
        if gap >= (enough + stray) * length && length > 0.0 {
            return gap / length - stray;
        }
        let (normal, _, distance) = shortest(start);
        distance.min(gap_along(normal, &end)) - stray
    }
}
