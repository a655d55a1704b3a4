//! Swept bounds of points, elements and groups over a candidate interval, in single precision: conservative for
//! the search, not for certificates.

use crate::contact::bvh::{Aabb, SweptBox};
use crate::contact::cloth::motion_bounds::{Trajectories, Trajectory};
use crate::contact::narrow_phase::{ElementPositions, between_centroids, gap_along, shortest_line};
use crate::math::{Real, add, dot, scale, sub};

/// The points of two elements.
pub type ElementPoints<const N: usize, const M: usize> = ([u32; N], [u32; M]);

/// The swept position of each point.
#[derive(Debug, Default)]
pub struct SweptPoints {
    /// Position at the start and at the end in metres from a common origin, and the radius around both.
    ends: Vec<[[f32; 4]; 2]>,
}

/// Relative rounding error of a position.
pub const ROUNDING: f32 = 1e-6;

impl SweptPoints {
    /// Resizes to `points` points.
    pub fn resize(&mut self, points: usize) {
        self.ends.resize(points, [[0.0; 4]; 2]);
    }

    /// Sets a point from its trajectory. `anchor` is in metres from the origin. Returns the balls at the start
    /// and at the end.
    #[inline]
    pub fn set<R: Real>(
        &mut self,
        point: usize,
        trajectory: &Trajectory<R>,
        anchor: [f64; 3],
    ) -> [([f32; 3], f32); 2] {
        let [start, end] = [R::ZERO, R::ONE].map(|share| {
            let moved = trajectory.at(share);
            std::array::from_fn::<f32, 3, _>(|axis| (anchor[axis] + moved[axis].to_f64()) as f32)
        });
        let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
        let radius = trajectory.radius.to_f64() as f32 + (size(start) + size(end)) * ROUNDING;
        let row = |[x, y, z]: [f32; 3]| [x, y, z, radius];
        self.ends[point] = [row(start), row(end)];
        [(start, radius), (end, radius)]
    }

    /// A lower bound on the distance of two elements in metres, from a share of the candidate interval on. It is
    /// only as sharp as needed to exceed `enough`.
    #[inline(always)]
    pub fn min_distance<const N: usize, const M: usize>(
        &self,
        (ours, theirs): ElementPoints<N, M>,
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
        let (mut end, mut radii) = (start, [0.0f32; 2]);
        // Loops, because maps over these arrays are not inlined.
        for k in 0..N {
            let radius;
            (start.0[k], end.0[k], radius) = both(ours[k]);
            radii[0] = radii[0].max(radius);
        }
        for k in 0..M {
            let radius;
            (start.1[k], end.1[k], radius) = both(theirs[k]);
            radii[1] = radii[1].max(radius);
        }
        let radius = radii[0] + radii[1];
        // Most pairs are separated along the line between their centroids, which is cheaper.
        let line = between_centroids(&start);
        let gap = gap_along(line, &start).min(gap_along(line, &end));
        let length = dot(line, line).sqrt();
        if gap >= (enough + radius) * length && length > 0.0 {
            return gap / length - radius;
        }
        let (normal, _, distance) = shortest_line(start);
        distance.min(gap_along(normal, &end)) - radius
    }
}

/// Share of the distance at rest that neighbours keep: a cloth thicker than its faces must still bend.
const REST_GAP_SHARE: f32 = 0.5;

/// The swept positions of all points, and their boxes.
#[derive(Debug, Default)]
pub struct ElementBounds {
    swept_points: SweptPoints,
    /// Boxes around the balls at both ends.
    boxes: Vec<SweptBox>,
}

/// The contact distance of two elements.
pub struct ContactDistance {
    /// Contact thickness in metres.
    pub thickness: f32,
    /// Whether it is less than the cloth's thickness, because the two are neighbours at rest.
    pub rest_limited: bool,
    /// Whether motion bounds certify a gap for the whole candidate interval.
    pub certified: bool,
}

/// Share of the thickness above which a gap over the whole candidate interval is a certificate: far above
/// rounding error.
const CERTIFIED_GAP: f32 = 0.02;

impl ElementBounds {
    /// Updates some points. Lists those whose boxes have changed.
    pub fn update<R: Real>(
        &mut self,
        anchors: &[[f64; 3]],
        trajectories: &Trajectories<R>,
        points: impl Iterator<Item = u32>,
        changed: &mut Vec<u32>,
    ) {
        changed.clear();
        let Some(origin) = anchors.first() else { return };
        self.swept_points.resize(anchors.len());
        self.boxes.resize(anchors.len(), [Aabb::EMPTY; 2]);
        for point in points {
            let at = point as usize;
            let anchor = std::array::from_fn(|axis| anchors[at][axis] - origin[axis]);
            let [start, end] = self.swept_points.set(at, &trajectories.of(point), anchor);
            let boxes = [Aabb::ball(start.0, start.1), Aabb::ball(end.0, end.1)];
            if self.boxes[at] != boxes {
                self.boxes[at] = boxes;
                changed.push(point);
            }
        }
    }

    /// Empties the boxes of particles that no longer exist.
    pub fn forget(&mut self, points: std::ops::Range<u32>) {
        let rows = points.start as usize..points.end as usize;
        self.boxes.get_mut(rows).unwrap_or_default().fill([Aabb::EMPTY; 2]);
    }

    /// The swept box of some points, inflated by a margin.
    #[inline(always)]
    pub fn bound(&self, points: &[u32], margin: f32) -> SweptBox {
        let [mut start, mut end] = [Aabb::EMPTY; 2];
        for &point in points {
            let [here, there] = &self.boxes[point as usize];
            (start, end) = (start.union(*here), end.union(*there));
        }
        [start.inflate(margin), end.inflate(margin)]
    }

    /// The contact distance of two elements, if they can come closer than `range` times the thickness from a
    /// share of the candidate interval on. `rest` holds positions at rest, for elements of one cloth.
    #[inline(always)]
    pub fn contact_distance<const N: usize, const M: usize>(
        &self,
        points: ElementPoints<N, M>,
        share: f32,
        [thickness, range]: [f32; 2],
        rest: Option<&[[f32; 3]]>,
    ) -> Option<ContactDistance> {
        let least = self.swept_points.min_distance(points, share, thickness * range);
        if least >= thickness * range {
            return None;
        }
        let (ours, theirs) = points;
        let resting = |rest: &[[f32; 3]]| {
            (ours.map(|point| rest[point as usize]), theirs.map(|point| rest[point as usize]))
        };
        let at_rest = rest.map_or(f32::INFINITY, |rest| rest_distance(resting(rest)));
        if at_rest <= 0.0 {
            return None;
        }
        let contact_distance = thickness.min(at_rest * REST_GAP_SHARE);
        let certified = least > contact_distance * CERTIFIED_GAP;
        (least < contact_distance * range).then_some(ContactDistance {
            thickness: contact_distance,
            rest_limited: contact_distance < thickness,
            certified,
        })
    }
}

/// The distance of two elements at rest; zero within rounding error, as for the diagonals of a doubled face.
/// Elements that coincide at rest are excluded: they have no separating direction.
fn rest_distance<const N: usize, const M: usize>(places: ElementPositions<f32, N, M>) -> f32 {
    let size = |[x, y, z]: [f32; 3]| x.abs() + y.abs() + z.abs();
    let (_, _, distance) = shortest_line(places);
    if distance > (size(places.0[0]) + size(places.1[0])) * ROUNDING { distance } else { 0.0 }
}
