//! The ground plane: a contact source that keeps every point of a cloth above it by its thickness, with friction.
//!
//! The half-space below it has no far side and no edges, so a point needs no broad phase: its height is the gap. The plane
//! moves within a frame from where the last one left it, as colliders do (§2.4).

pub mod carried;
mod fours;
pub mod pass;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;

use crate::bytes::{checkpoint_struct, encode_struct};
use crate::contact::clearance::NearSurface;
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::contact::pair_filter::PairFilter;
use crate::contact::response::{Adhesion, Push, Restitution, coulomb_correction};
use crate::contact::time_step::PositionWriter;
use crate::input::frame::GroundPlane;
use crate::math::{Real, Row4, add, dot, scale, sub};
use crate::schedule::StepInterval;

/// Height in metres of points that do not collide with the plane.
const FAR_ABOVE: f64 = 1e12;

/// Depth below the thickness, as a share of it, from which on a point is pressed: above rounding.
const PRESSED_DEPTH: f64 = 1e-3;

/// A point of a plane in metres, and its unit normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    origin: [f64; 3],
    normal: [f64; 3],
}

encode_struct!([] Plane { origin: [f64; 3], normal: [f64; 3] });

impl Plane {
    /// A plane through a point, given its normal of any length.
    fn new(origin: Vector3<f64>, normal: Vector3<f64>) -> Self {
        let normal = normal.try_normalize(0.0).unwrap_or_else(Vector3::y);
        Self { origin: origin.into(), normal: normal.into() }
    }

    /// Height of a position above it, in metres.
    fn height(&self, place: [f64; 3]) -> f64 {
        dot(self.normal, sub(place, self.origin))
    }
}

/// The ground plane in a frame.
#[derive(Debug, Clone)]
pub struct Ground<R> {
    /// Where it ends the frame.
    end: Option<Plane>,
    /// Where it starts the frame.
    start: Option<Plane>,
    /// Height of each anchor above the plane at the start and at the end of the frame, in metres; empty without a plane.
    heights: [Vec<R>; 2],
    /// The time that [`height`](Self::height) refers to, as a share of the frame.
    pub now: f64,
}

checkpoint_struct!([R: Real] Ground<R> { columns: [], values: [end], parts: [], rebuilt: [start, heights, now] });

impl<R: Real> Default for Ground<R> {
    fn default() -> Self {
        Self { end: None, start: None, heights: [Vec::new(), Vec::new()], now: 1.0 }
    }
}

impl<R: Real> Ground<R> {
    /// Takes up the plane of a frame. Unless a start is given, it starts where the last frame left it; a plane that appears or
    /// turns over at once does not move. Points that do not collide with it are far above it.
    /// Without anchors it is a plane for [`GroundStep::over`] alone.
    pub fn begin_frame(&mut self, ground: Option<&GroundPlane>, anchors: &[[f64; 3]], filter: &PairFilter) {
        let now = ground.map(|ground| Plane::new(ground.origin, ground.normal));
        let given = ground.and_then(|ground| ground.start).map(|[origin, normal]| Plane::new(origin, normal));
        let turns_over = |last: &Plane| now.is_some_and(|now| dot(last.normal, now.normal) <= 0.0);
        self.start = now.map(|now| given.or(self.end).filter(|last| !turns_over(last)).unwrap_or(now));
        self.end = now;
        let rests = self.start == self.end;
        let [at_start, at_end] = &mut self.heights;
        for (heights, plane) in [(&mut *at_start, self.start), (&mut *at_end, self.end.filter(|_| !rests))] {
            heights.clear();
            let of = |plane: Plane| anchors.iter().map(move |&anchor| R::from_f64(plane.height(anchor)));
            heights.extend(plane.into_iter().flat_map(of));
            if !filter.is_empty() {
                let excluded = (0..).zip(heights.iter_mut()).filter(|(row, _)| filter.excludes_ground(*row));
                excluded.for_each(|(_, height)| *height = R::from_f64(FAR_ABOVE));
            }
        }
        if rests {
            at_end.clone_from(at_start);
        }
    }

    /// Takes up points whose anchors were set within the frame.
    pub fn set_anchors(&mut self, points: Range<u32>, anchors: &[[f64; 3]], filter: &PairFilter) {
        for (heights, plane) in self.heights.iter_mut().zip([self.start, self.end]) {
            let Some(plane) = plane else { continue };
            for point in points.clone() {
                let height = match filter.excludes_ground(point) {
                    true => FAR_ABOVE,
                    false => plane.height(anchors[point as usize]),
                };
                heights
                    .get_mut(point as usize)
                    .into_iter()
                    .for_each(|of_point| *of_point = R::from_f64(height));
            }
        }
    }

    /// Whether the frame has a plane.
    pub fn is_there(&self) -> bool {
        self.end.is_some()
    }

    /// Height of a position above the plane at the time of the last step, in metres; `None` without a plane.
    pub fn height(&self, place: [f64; 3]) -> Option<f64> {
        match self.at(place, self.now) {
            Some((_, height)) if self.now < 1.0 => Some(height),
            _ => self.end.map(|plane| plane.height(place)),
        }
    }

    /// The normal of the plane at a time, given as a share of the frame, and the height of a position above it in metres.
    pub fn at(&self, place: [f64; 3], time: f64) -> Option<([f64; 3], f64)> {
        let (from, to) = (self.start?, self.end?);
        let mix = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * time);
        let normal: [f64; 3] = mix(from.normal, to.normal);
        let normal = scale(normal, 1.0 / dot(normal, normal).sqrt());
        Some((normal, dot(normal, sub(place, mix(from.origin, to.origin)))))
    }

    /// The velocity of its origin in m/s, in a frame of `duration` seconds.
    pub fn velocity(&self, duration: f64) -> [f64; 3] {
        match (self.start, self.end) {
            (Some(from), Some(to)) => sub(to.origin, from.origin).map(|x| x / duration),
            _ => [0.0; 3],
        }
    }

    /// The plane in a time step.
    pub fn in_step(&self, now: StepInterval) -> Option<GroundStep<'_, R>> {
        let (from, to) = (self.start?, self.end?);
        let ends = [now.from, now.to].map(|time| {
            let normal: [f64; 3] =
                std::array::from_fn(|k| from.normal[k] * (1.0 - time) + to.normal[k] * time);
            let length = dot(normal, normal).sqrt();
            // At rest the height is exact to the last bit.
            let share = if from == to { [1.0, 0.0] } else { [(1.0 - time) / length, time / length] };
            let share = share.map(R::from_f64);
            End { normal: normal.map(|x| R::from_f64(x / length)), share }
        });
        let travel = sub(to.origin, from.origin).map(|x| R::from_f64(x * (now.to - now.from)));
        Some(GroundStep { heights: [&self.heights[0], &self.heights[1]], first: 0, ends, travel })
    }

    /// Heights of some anchors above the plane at the start and at the end of the frame, in metres.
    pub fn heights_of(&self, anchors: &[[f64; 3]], [at_start, at_end]: [&mut [R]; 2]) {
        let (Some(start), Some(end)) = (self.start, self.end) else { return };
        for (height, &anchor) in at_start.iter_mut().zip(anchors) {
            *height = R::from_f64(start.height(anchor));
        }
        if start == end {
            return at_end.copy_from_slice(at_start);
        }
        for (height, &anchor) in at_end.iter_mut().zip(anchors) {
            *height = R::from_f64(end.height(anchor));
        }
    }
}

/// The plane at a time: its normal, and the weights of the heights at both ends of the frame.
#[derive(Debug, Clone, Copy)]
struct End<R> {
    normal: [R; 3],
    share: [R; 2],
}

/// The plane in one time step.
#[derive(Debug, Clone, Copy)]
pub struct GroundStep<'a, R> {
    heights: [&'a [R]; 2],
    /// The row of the first height.
    first: u32,
    ends: [End<R>; 2],
    /// Motion of its origin in the step, in metres.
    travel: [R; 3],
}

impl<'a, R: Real> GroundStep<'a, R> {
    /// The same plane for a run of points from the row `first` on, given their [`Ground::heights_of`].
    pub fn over(self, heights: [&'a [R]; 2], first: u32) -> Self {
        Self { heights, first, ..self }
    }

    #[inline(always)]
    fn height(&self, end: usize, point: u32, displacement: [R; 3]) -> R {
        let End { normal, share } = self.ends[end];
        let point = (point - self.first) as usize;
        self.heights[0][point] * share[0] + self.heights[1][point] * share[1] + dot(normal, displacement)
    }

    /// Height of a point above the plane when the step is over, in metres, given its displacement then.
    #[inline(always)]
    pub fn height_now(&self, point: u32, displacement: [R; 3]) -> R {
        self.height(1, point, displacement)
    }

    /// The plane's normal when the step is over.
    pub fn normal(&self) -> [R; 3] {
        self.ends[1].normal
    }

    /// The velocity with which the plane rises at a point in a step of length `h`, in m/s, given the point's displacement.
    pub fn velocity(&self, point: u32, displacement: [R; 3], h: R) -> [R; 3] {
        let rise = self.height(0, point, displacement) - self.height(1, point, displacement);
        scale(self.normal(), rise / h)
    }
}

/// Contact of one cloth with the plane in one time step.
pub struct GroundContact<'a, R> {
    /// Positions of the points.
    pub writer: PositionWriter<'a, R>,
    /// Displacements at the start of the step, at [`PositionWriter::place_of`] a point.
    pub start: &'a [Row4<R>],
    /// The plane.
    pub plane: GroundStep<'a, R>,
    /// Factor on every thickness.
    pub thickness_scale: R,
    /// The contact material of the two.
    pub material: ContactMaterial<R>,
    /// Vertex maps of contact attributes.
    pub material_maps: &'a MaterialMaps<R>,
    /// Length of the step in seconds.
    pub h: R,
    /// Written: whether the cloth has had a contact in this frame.
    pub has_touched: &'a AtomicBool,
}

impl<R: Real> GroundContact<'_, R> {
    /// Pushes the points of a range to the thickness. Returns the number of pushes.
    pub fn resolve(&self, points: Range<u32>) -> u64 {
        let fours = if self.is_uniform() { (points.end - points.start) / 4 * 4 } else { 0 };
        let mut contacts = self.resolve_fours(points.start..points.start + fours);
        for point in points.start + fours..points.end {
            let row = self.writer.row(point);
            let gap = self.plane.height_now(point, row.xyz());
            let thickness = self.thickness(point);
            if gap < thickness && row.0[3] > R::ZERO {
                contacts += 1;
                self.push(point, row, [thickness, gap]);
            } else if self.material.grips && Restitution::touches(gap, thickness) && row.0[3] > R::ZERO {
                self.push(point, row, [thickness; 2]);
            }
        }
        contacts
    }

    /// Whether something has pressed a point below its thickness, by more than rounding.
    pub fn is_pressed(&self, point: u32) -> bool {
        let row = self.writer.row(point);
        let gap = self.plane.height_now(point, row.xyz());
        gap < self.thickness(point) * R::from_f64(1.0 - PRESSED_DEPTH) && row.0[3] > R::ZERO
    }

    /// The plane as a surface near a point that started within its thickness.
    pub fn near_surface(&self, point: u32) -> Option<NearSurface<R>> {
        let start = self.start[self.writer.place_of(point)].xyz();
        let (gap, thickness) = (self.plane.height_now(point, start), self.thickness(point));
        (gap < thickness).then(|| NearSurface { point, normal: self.plane.normal(), gap, thickness })
    }

    /// How far a point is above its thickness, in metres.
    pub fn clearance(&self, point: u32) -> R {
        self.plane.height_now(point, self.writer.row(point).xyz()) - self.thickness(point)
    }

    /// Whether a point went through the plane: it began the step above and is below now. A contact that is carried out in
    /// part lets it.
    #[inline(always)]
    pub fn has_passed(&self, point: u32) -> bool {
        let row = self.writer.row(point);
        self.plane.height_now(point, row.xyz()) < R::ZERO
            && row.0[3] > R::ZERO
            && self.plane.height(0, point, self.start[self.writer.place_of(point)].xyz()) >= R::ZERO
            && !self.material.is_partial(self.material_maps)
    }

    /// Returns a point to its height above the plane at the start of the step.
    pub fn revert(&self, point: u32) {
        let mut row = self.writer.row(point);
        let start = self.start[self.writer.place_of(point)].xyz();
        let heights = [self.plane.height(0, point, start), self.plane.height_now(point, start)];
        let [x, y, z] = add(start, scale(self.plane.normal(), heights[0] - heights[1]));
        row.0[..3].copy_from_slice(&[x, y, z]);
        self.writer.place(point, row);
    }

    /// Applies adhesion between the points of a range and the plane.
    pub fn adhere(&self, points: Range<u32>) {
        let rows = points.map(|point| (self.writer.row(point), point));
        for (mut row, point) in rows.filter(|(row, _)| row.0[3] > R::ZERO) {
            let start = self.start[self.writer.place_of(point)].xyz();
            let normal = self.plane.normal();
            let material = &self.material;
            let adhesion = Adhesion {
                range: self.thickness(point) * R::from_f64(material.adhesion_range),
                thickness: self.thickness(point),
                stickiness: material.stickiness_at(self.material_maps, ([point], [], &([R::ONE], []))),
                friction: material.friction_at(self.material_maps, ([point], [], &([R::ONE], []))),
            };
            let gaps = [self.plane.height(0, point, start), self.plane.height(1, point, row.xyz())];
            let motion = sub(sub(row.xyz(), start), self.plane.travel);
            let along = sub(motion, scale(normal, dot(normal, motion)));
            let [before, now] = gaps.map(|gap| scale(normal, gap));
            let correction =
                adhesion.correction(before, add(now, along), normal, self.h).unwrap_or([R::ZERO; 3]);
            (0..3).for_each(|axis| row.0[axis] += correction[axis]);
            self.writer.push(point, row, [R::ZERO; 3]);
        }
    }

    /// The contact thickness of a point, in metres.
    #[inline(always)]
    fn thickness(&self, point: u32) -> R {
        let most = R::from_f64(self.material.thickness);
        self.material.thickness_at(self.material_maps, ([point], [], &([R::ONE], [])), most)
            * self.thickness_scale
            * self.material_maps.clearance.share([point], [R::ONE])
    }

    fn push(&self, point: u32, mut row: Row4<R>, [thickness, gap]: [R; 2]) {
        let start = self.start[self.writer.place_of(point)].xyz();
        let normal = self.plane.normal();
        let depenetration = self.writer.depenetration(point);
        let before = self.plane.height(0, point, start);
        let mut push = Push::new(thickness, [before, gap], dot(normal, depenetration), self.h);
        if self.material.is_partial(self.material_maps) {
            push = push.scaled(self.material.strength_at(self.material_maps, ([point], [], &([R::ONE], []))));
        }
        let motion = sub(sub(row.xyz(), start), self.plane.travel);
        let friction = self.material.friction_at(self.material_maps, ([point], [], &([R::ONE], [])));
        let limit = match self.material.grips {
            true => R::from_f64(f64::from(f32::MAX)),
            false => friction * push.length(),
        };
        let [friction_part, given_back] = coulomb_correction([motion, depenetration], normal, limit);
        let moved = add(scale(normal, push.length()), friction_part);
        (0..3).for_each(|axis| row.0[axis] += moved[axis]);
        self.writer.push(point, row, add(scale(normal, push.depenetration), given_back));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(origin: [f64; 3], normal: [f64; 3]) -> GroundPlane {
        GroundPlane::new(origin.into(), normal.into())
    }

    fn half_way() -> StepInterval {
        StepInterval { from: 0.0, to: 0.5, end_of_substep: 1.0 }
    }

    #[test]
    fn a_plane_moves_within_a_frame_from_where_the_last_one_left_it() {
        let mut ground = Ground::<f64>::default();
        let up = [0.0, 1.0, 0.0];
        ground.begin_frame(Some(&plane([0.0; 3], up)), &[[0.0, 1.0, 0.0]], &PairFilter::default());
        let step = ground.in_step(half_way()).expect("a plane");
        assert_eq!(step.height_now(0, [0.0; 3]), 1.0, "one that appears is there from the start");
        ground.begin_frame(Some(&plane([0.0, 0.2, 0.0], up)), &[[0.0, 1.0, 0.0]], &PairFilter::default());
        let step = ground.in_step(half_way()).expect("a plane");
        assert!((step.height_now(0, [0.0; 3]) - 0.9).abs() < 1e-12);
        assert!((step.velocity(0, [0.0; 3], 0.5)[1] - 0.2).abs() < 1e-12, "it rises by 0.1 m in 0.5 s");
    }

    #[test]
    fn a_plane_moves_from_the_given_start_of_a_frame() {
        let mut ground = Ground::<f64>::default();
        let start = Some([Vector3::new(0.0, -0.2, 0.0), Vector3::y()]);
        let moving = GroundPlane { start, ..plane([0.0; 3], [0.0, 1.0, 0.0]) };
        ground.begin_frame(Some(&moving), &[[0.0, 1.0, 0.0]], &PairFilter::default());
        let step = ground.in_step(half_way()).expect("a plane");
        assert!((step.height_now(0, [0.0; 3]) - 1.1).abs() < 1e-12);
    }

    #[test]
    fn a_plane_that_tilts_is_halfway_tilted_in_the_middle_of_the_frame() {
        let mut ground = Ground::<f64>::default();
        let (at, slope) = ([[1.0, 0.0, 0.0]], 0.3f64);
        ground.begin_frame(Some(&plane([0.0; 3], [0.0, 1.0, 0.0])), &at, &PairFilter::default());
        ground.begin_frame(
            Some(&plane([0.0; 3], [-slope.sin(), slope.cos(), 0.0])),
            &at,
            &PairFilter::default(),
        );
        let step = ground.in_step(half_way()).expect("a plane");
        let expected = (slope / 2.0).sin();
        assert!((step.height_now(0, [0.0; 3]) + expected).abs() < 1e-12, "below it by the sine of the angle");
    }

    #[test]
    fn a_plane_that_turns_over_does_not_sweep() {
        let mut ground = Ground::<f64>::default();
        ground.begin_frame(
            Some(&plane([0.0; 3], [0.0, 1.0, 0.0])),
            &[[0.0, 1.0, 0.0]],
            &PairFilter::default(),
        );
        ground.begin_frame(
            Some(&plane([0.0; 3], [0.0, -1.0, 0.0])),
            &[[0.0, 1.0, 0.0]],
            &PairFilter::default(),
        );
        let step = ground.in_step(half_way()).expect("a plane");
        assert_eq!(step.height_now(0, [0.0; 3]), -1.0);
    }
}
