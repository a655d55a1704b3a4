//! Where all points are foreseen to be in a span of time, as a search sees it.

use super::paths::Paths;
use super::ways::{GRAIN, Points, Ways};
use crate::contact::aabb::{Aabb, SweptBox};
use crate::contact::narrow::{Places, shortest};
use crate::math::Real;

/// Share of their distance at rest that neighbours keep: a cloth thicker than its faces must still bend.
const OF_REST_DISTANCE: f32 = 0.5;

/// Ways of all points, and what is round them.
#[derive(Debug, Default)]
pub struct Seen {
    ways: Ways,
    /// Boxes round the balls at both ends.
    balls: Vec<SweptBox>,
}

/// A distance to keep, in metres.
pub struct Kept {
    /// The distance.
    pub thickness: f32,
    /// Whether that is less than the cloth's, because the two are neighbours at rest.
    pub rest_limited: bool,
    /// Whether the motion bounds certify that the two keep a gap while they hold.
    pub certified: bool,
}

/// Share of the thickness above which a gap that holds through the span is a certificate: far above rounding error.
const CERTIFIED: f32 = 0.02;

impl Seen {
    /// Looks at some points.
    pub fn look<R: Real>(
        &mut self,
        anchors: &[[f64; 3]],
        paths: &Paths<R>,
        points: impl Iterator<Item = u32>,
    ) {
        let Some(origin) = anchors.first() else { return };
        self.ways.resize(anchors.len());
        self.balls.resize(anchors.len(), [Aabb::EMPTY; 2]);
        for point in points {
            let at = point as usize;
            let anchor = std::array::from_fn(|axis| anchors[at][axis] - origin[axis]);
            let balls = self.ways.set(at, &paths.of(point), anchor);
            self.balls[at] = balls.map(|(centre, radius)| Aabb::ball(centre, radius));
        }
    }

    /// The boxes round some points, with a margin, at both ends of what is foreseen.
    #[inline(always)]
    pub fn bound(&self, points: &[u32], margin: f32) -> SweptBox {
        let [mut start, mut end] = [Aabb::EMPTY; 2];
        for &point in points {
            let [here, there] = &self.balls[point as usize];
            (start, end) = (start.union(*here), end.union(*there));
        }
        [start.inflate(margin), end.inflate(margin)]
    }

    /// What two elements are to keep of a thickness, if they can come nearer to each other than `reach` times that, from a
    /// share of the span on. `rest` is the shape at rest, for elements of one cloth.
    #[inline(always)]
    pub fn kept<const N: usize, const M: usize>(
        &self,
        points: Points<N, M>,
        share: f32,
        [thickness, reach]: [f32; 2],
        rest: Option<&[[f32; 3]]>,
    ) -> Option<Kept> {
        let least = self.ways.least_distance(points, share, thickness * reach);
        if least >= thickness * reach {
            return None;
        }
        let (ours, theirs) = points;
        let resting = |rest: &[[f32; 3]]| {
            (ours.map(|point| rest[point as usize]), theirs.map(|point| rest[point as usize]))
        };
        let at_rest = rest.map_or(f32::INFINITY, |rest| distance_at_rest(resting(rest)));
        if at_rest <= 0.0 {
            return None;
        }
        let kept = thickness.min(at_rest * OF_REST_DISTANCE);
        let certified = least > kept * CERTIFIED;
        (least < kept * reach).then_some(Kept { thickness: kept, rest_limited: kept < thickness, certified })
    }
}

/// The distance of two elements in the shape at rest; nought if it is none but for rounding, as of the diagonals of a face
/// that is there twice: what lies in one place has no sides to be kept on.
fn distance_at_rest<const N: usize, const M: usize>(places: Places<f32, N, M>) -> f32 {
    let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
    let (_, _, distance) = shortest(places);
    if distance > (size(places.0[0]) + size(places.1[0])) * GRAIN { distance } else { 0.0 }
}
