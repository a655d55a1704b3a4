//! Candidates: two elements that can touch while their points keep to what is foreseen for them.

use super::paths::Paths;
use crate::checkpoint::kept;
use crate::collision::narrow::{between_middles, gap_along, shortest};
use crate::collision::tree::Aabb;
use crate::scalar::{Real, dot};

/// What the points of a candidate are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Two points.
    PointPoint,
    /// A point, and the two of an edge.
    PointEdge,
    /// A point, and the three of a face.
    PointFace,
    /// The two points of an edge, and of another.
    EdgeEdge,
}

/// Two elements that can touch.
#[derive(Debug, Clone, Copy)]
pub struct Candidate {
    /// What they are.
    pub kind: Kind,
    /// Their points, first one element's, then the other's; what is left over repeats the first.
    pub points: [u32; 4],
    /// The distance to keep, in metres.
    pub thickness: f32,
    /// Whether that is less than the cloth's, because the two are neighbours at rest.
    pub limited: bool,
}

impl Candidate {
    /// A point of the one element, and one of the other.
    pub fn ends(&self) -> [u32; 2] {
        [self.points[0], self.points[if self.kind == Kind::EdgeEdge { 2 } else { 1 }]]
    }
}

/// Share of their distance at rest that neighbours keep: a cloth thicker than its faces must still bend.
const OF_REST_DISTANCE: f32 = 0.5;

/// Where all points are foreseen to be from a time of the frame to its end, in single precision: good for
/// finding, not for proving.
#[derive(Debug, Default)]
pub struct Seen {
    /// At the start of that, in metres from some origin, and how far each may be from there.
    start: Vec<[f32; 4]>,
    /// At the end.
    end: Vec<[f32; 4]>,
    /// Boxes round the balls at both.
    balls: Vec<[Aabb; 2]>,
    /// From which time of the frame on, if that was looked at.
    from: Option<f64>,
    /// What places are from: the same for all of a run, so that boxes stay good.
    origin: Option<[f64; 3]>,
}

kept!([] Seen { columns: [], values: [origin], parts: [], anew: [start, end, balls, from] });

impl Seen {
    /// Looks ahead from a time of the frame to its end: at all points where that time is a new one, else at those that
    /// `strayed`. Whether it was at all.
    pub fn look<R: Real>(
        &mut self,
        anchors: &[[f64; 3]],
        far: &Paths<R>,
        strayed: &[bool],
        now: f64,
    ) -> bool {
        let origin = *self.origin.get_or_insert_with(|| anchors.first().copied().unwrap_or_default());
        let is_all = self.from != Some(now);
        self.from = Some(now);
        self.start.resize(anchors.len(), [0.0; 4]);
        self.end.resize(anchors.len(), [0.0; 4]);
        self.balls.resize(anchors.len(), [Aabb::EMPTY; 2]);
        for (point, anchor) in anchors.iter().enumerate().filter(|&(point, _)| is_all || strayed[point]) {
            let path = far.of(point as u32);
            let anchor: [f64; 3] = std::array::from_fn(|axis| anchor[axis] - origin[axis]);
            let place = |share: R| {
                let moved = path.at(share);
                std::array::from_fn::<f32, 3, _>(|axis| (anchor[axis] + moved[axis].to_f64()) as f32)
            };
            let (start, end) = (place(R::from_f64(now)), place(R::ONE));
            let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
            let stray = path.ball.to_f64() as f32 + (size(start) + size(end)) * 1e-6;
            let row = |[x, y, z]: [f32; 3]| [x, y, z, stray];
            self.start[point] = row(start);
            self.end[point] = row(end);
            self.balls[point] = [Aabb::ball(start, stray), Aabb::ball(end, stray)];
        }
        is_all
    }

    /// Forgets what was foreseen: anchors move.
    pub fn forget(&mut self) {
        self.from = None;
    }

    /// The boxes round some points, with a margin, at both ends of what is foreseen.
    #[inline(always)]
    pub fn bound(&self, points: impl Iterator<Item = u32>, margin: f32) -> [Aabb; 2] {
        let [mut start, mut end] = [Aabb::EMPTY; 2];
        for point in points {
            let [here, there] = &self.balls[point as usize];
            (start, end) = (start.union(*here), end.union(*there));
        }
        [start.inflate(margin), end.inflate(margin)]
    }

    /// A candidate, if the two can come nearer than what is kept of the thickness, times `reach`. `rest` is the shape at
    /// rest, for elements of one cloth.
    #[inline]
    pub fn candidate(
        &self,
        kind: Kind,
        points: [u32; 4],
        [thickness, reach]: [f32; 2],
        rest: Option<&[[f32; 3]]>,
    ) -> Option<Candidate> {
        let [a, b, c, d] = points;
        let terms = ([thickness, reach], rest);
        let kept = match kind {
            Kind::PointPoint => self.kept(([a], [b]), terms),
            Kind::PointEdge => self.kept(([a], [b, c]), terms),
            Kind::PointFace => self.kept(([a], [b, c, d]), terms),
            Kind::EdgeEdge => self.kept(([a, b], [c, d]), terms),
        };
        kept.map(|kept| Candidate { kind, points, thickness: kept, limited: kept < thickness })
    }

    /// The distance that two elements are to keep; nothing if they cannot come that near.
    #[inline(always)]
    fn kept<const N: usize, const M: usize>(
        &self,
        (ours, theirs): ([u32; N], [u32; M]),
        ([thickness, reach], rest): ([f32; 2], Option<&[[f32; 3]]>),
    ) -> Option<f32> {
        let xyz = |[x, y, z, _]: [f32; 4]| [x, y, z];
        let at = |places: &[[f32; 4]]| {
            (ours.map(|p| xyz(places[p as usize])), theirs.map(|p| xyz(places[p as usize])))
        };
        let most = |points: &[u32]| points.iter().map(|&p| self.start[p as usize][3]).fold(0.0, f32::max);
        let stray = most(&ours) + most(&theirs);
        let [start, end] = [at(&self.start), at(&self.end)];
        let line = between_middles(&start);
        let far = (thickness * reach + stray) * dot(line, line).sqrt();
        if gap_along(line, &start) >= far && gap_along(line, &end) >= far {
            return None;
        }
        let (normal, _, distance) = shortest(start);
        let least = distance.min(gap_along(normal, &end)) - stray;
        if least >= thickness * reach {
            return None;
        }
        let resting = |rest: &[[f32; 3]]| {
            (ours.map(|point| rest[point as usize]), theirs.map(|point| rest[point as usize]))
        };
        let at_rest = rest.map_or(f32::INFINITY, |rest| shortest(resting(rest)).2);
        let kept = thickness.min(at_rest * OF_REST_DISTANCE);
        (least < kept * reach).then_some(kept)
    }
}
