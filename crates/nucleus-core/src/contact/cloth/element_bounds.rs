//! Swept bounds of points, elements and groups over a candidate interval, in single precision: conservative for
//! the search, not for certificates.

use std::ops::Range;

use crate::contact::bvh::{Aabb, SweptBox};
use crate::contact::ccd::CERTIFIED_GAP;
use crate::contact::cloth::local_origins::LocalOrigins;
use crate::contact::cloth::motion_bounds::Trajectory;
use crate::contact::cloth::swept_points::{SweptPoints, swept_point};
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;
use crate::particles::population::close_up;

/// Share of the distance at rest that neighbours keep: a cloth thicker than its faces must still bend.
const REST_GAP_SHARE: f32 = 0.5;

/// The swept positions of all points, and their boxes.
#[derive(Debug, Default)]
pub struct ElementBounds {
    /// The origin of each cloth's swept positions.
    pub origins: LocalOrigins,
    swept_points: SweptPoints,
    /// Boxes around the balls at both ends.
    boxes: Vec<SweptBox>,
}

/// All points, to be set in tasks.
pub struct SharedBounds<'a> {
    origins: &'a LocalOrigins,
    swept_points: DisjointSlice<'a, [[f32; 4]; 2]>,
    boxes: DisjointSlice<'a, SweptBox>,
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

impl ElementBounds {
    /// A view of `points` points through which tasks set points of their own.
    pub fn shared(&mut self, points: usize) -> SharedBounds<'_> {
        let Self { origins, swept_points, boxes } = self;
        swept_points.resize(points);
        boxes.resize(points, [Aabb::EMPTY; 2]);
        SharedBounds { origins, swept_points: swept_points.shared(), boxes: DisjointSlice::new(boxes) }
    }

    /// Follows the particles of an object whose rows are closed up; `kept` are the places of those that remain.
    pub fn close_up(&mut self, rows: Range<usize>, kept: &[u32]) {
        let Some(boxes) = self.boxes.get_mut(rows.clone()) else { return };
        close_up(boxes, kept);
        boxes[kept.len()..].fill([Aabb::EMPTY; 2]);
        self.swept_points.close_up(rows, kept);
    }

    /// The swept box of some points of one cloth, inflated by a margin.
    #[inline(always)]
    pub fn bound(&self, points: &[u32], margin: f32) -> SweptBox {
        let [mut start, mut end] = [Aabb::EMPTY; 2];
        for &point in points {
            let [here, there] = &self.boxes[point as usize];
            (start, end) = (start.union(*here), end.union(*there));
        }
        [start.inflate(margin), end.inflate(margin)]
    }

    /// The swept position of each point.
    pub fn swept_points(&self) -> &SweptPoints {
        &self.swept_points
    }
}

impl SharedBounds<'_> {
    /// Sets a point of a cloth from its trajectory. `anchor` is in metres. Returns whether its boxes have changed.
    ///
    /// # Safety
    /// No other task of this loop uses the point.
    #[inline]
    #[allow(unsafe_code)]
    pub unsafe fn set<R: Real>(
        &self,
        [cloth, point]: [u32; 2],
        trajectory: &Trajectory<R>,
        anchor: [f64; 3],
    ) -> bool {
        let ends = swept_point(trajectory, self.origins.relative(cloth as usize, anchor));
        let boxes = ends.map(|[x, y, z, radius]| Aabb::ball([x, y, z], radius));
        // SAFETY: as the caller ensures.
        unsafe {
            let has_changed = self.boxes.get(point) != boxes;
            self.boxes.set(point, boxes);
            self.swept_points.set(point, ends);
            has_changed
        }
    }
}

impl ContactDistance {
    /// That of two elements that stay at least `least` metres apart and are `at_rest` metres apart at rest, if they can come
    /// closer than `range` times the thickness. `released` gives the contact distance in metres of elements that coincide at
    /// rest, and zero where they do not collide.
    #[inline(always)]
    pub fn new(
        [least, at_rest]: [f32; 2],
        [thickness, range]: [f32; 2],
        released: impl FnOnce() -> f32,
    ) -> Option<Self> {
        let contact_distance =
            thickness.min(if at_rest > 0.0 { at_rest * REST_GAP_SHARE } else { released() });
        let certified = least > contact_distance * CERTIFIED_GAP as f32;
        (contact_distance > 0.0 && least < contact_distance * range).then_some(Self {
            thickness: contact_distance,
            rest_limited: contact_distance < thickness,
            certified,
        })
    }
}
