//! Air: drag, lift and wind, by which way the surface faces.
//!
//! Wind has no force of its own; it is the air that drag and lift are reckoned against, so cloth that faces
//! it catches more than cloth on edge (§3.1). Drag is linear in velocity and per 1/24 s, acts along the
//! normal, and along the surface by the share `tangentialDrag`, as recorded output of the original shows.
//! Its discrete form, two implicit half-steps, is also the one measured there.
//!
//! Lift acts at right angles to the motion through the air, in the plane of motion and normal, and does no
//! work. Its strength is reckoned in time, not length, so it needs no scaling by hand in large scenes.

use std::ops::Range;

use nalgebra::Vector3;

use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput};
use crate::math::{Real, Row4, dot};
use crate::model::{AirFactors, ClothModel};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// What the air does to a point in one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air<R> {
    wind: [R; 3],
    /// What is left of the velocity along the normal, and along the surface.
    along_normal: R,
    along_surface: R,
    lift: R,
}

/// The air that a cloth feels, before it is told where on the cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirForces {
    wind: Vector3<f64>,
    /// Drag and lift over the mass, per second.
    drag: f64,
    lift: f64,
    tangential_drag: f64,
    h: f64,
}

impl AirForces {
    /// What a cloth of `weight` (its `pointMass`) feels in steps of `h` seconds; nothing in a vacuum.
    pub fn new(frame: &FrameInput, cloth: &ClothFrame, weight: f64, h: f64) -> Option<Self> {
        let rate = |attribute: f64| attribute * frame.air_density / (COUNT_PERIOD * weight);
        let (drag, lift) = (rate(cloth.drag), rate(cloth.lift));
        if drag <= 0.0 && lift <= 0.0 {
            return None;
        }
        let wind = if cloth.feels_wind { frame.wind } else { Vector3::zeros() } + cloth.local_wind;
        Some(Self { wind, drag, lift, tangential_drag: cloth.tangential_drag, h })
    }

    /// What a point feels.
    pub fn at<R: Real>(&self, factors: &AirFactors) -> Air<R> {
        let left = |rate: f64| {
            let half = 1.0 + rate * self.h / 2.0;
            R::from_f64(1.0 / (half * half))
        };
        let drag = self.drag * factors.drag;
        Air {
            wind: [self.wind.x, self.wind.y, self.wind.z].map(R::from_f64),
            along_normal: left(drag),
            along_surface: left(drag * (self.tangential_drag * factors.tangential_drag)),
            lift: R::from_f64((self.lift * factors.lift * self.h).min(1.0)),
        }
    }
}

impl<R: Real> Air<R> {
    /// The same with a gust on top of the wind, in m/s.
    #[inline(always)]
    pub fn gusting(&self, gust: [R; 3]) -> Self {
        Self { wind: std::array::from_fn(|axis| self.wind[axis] + gust[axis]), ..*self }
    }

    /// A velocity after the step.
    #[inline(always)]
    pub fn slow(&self, velocity: [R; 4], normal: [R; 3]) -> [R; 4] {
        let through: [R; 3] = std::array::from_fn(|axis| velocity[axis] - self.wind[axis]);
        let facing = dot(normal, through);
        let speed_squared = dot(through, through);
        let turned = self.turn(through, normal, facing, speed_squared);
        let facing = dot(normal, turned);
        let slowed = |axis: usize| {
            let across = normal[axis] * facing;
            self.wind[axis] + across * self.along_normal + (turned[axis] - across) * self.along_surface
        };
        [slowed(0), slowed(1), slowed(2), velocity[3]]
    }

    /// Lift turns the velocity without changing its length.
    #[inline(always)]
    fn turn(&self, through: [R; 3], normal: [R; 3], facing: R, speed_squared: R) -> [R; 3] {
        if self.lift == R::ZERO || speed_squared <= R::MIN_DENOMINATOR {
            return through;
        }
        let share = facing / speed_squared;
        let lifted: [R; 3] = std::array::from_fn(|axis| {
            through[axis] - self.lift * facing * (normal[axis] - through[axis] * share)
        });
        let scale = (speed_squared / dot(lifted, lifted)).sqrt();
        lifted.map(|x| x * scale)
    }
}

/// Writes the normals of all points that feel air, weighted by area. Reads positions.
pub fn update_normals<R: Real>(cloths: &[ClothModel<R>], state: &mut State<R>, pool: &ThreadPool) {
    let State { anchor, displacement, normal, .. } = state;
    let position = |row: u32| {
        let (anchor, moved) = (anchor[row as usize], displacement[row as usize].0);
        [0, 1, 2].map(|axis| anchor[axis] + moved[axis].to_f64())
    };
    let normals = DisjointSlice::new(normal);
    for cloth in cloths {
        pool.parallel_for(cloth.triangles.len(), |block| {
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            unsafe {
                normals_of_block(normals, cloth.blocks.range(block), &cloth.triangles[block], position);
            }
        });
    }
}

/// Sets the normals of a block of points, weighted by area, from the triangles that touch it.
///
/// # Safety
/// No other task of the phase touches these normals.
#[allow(unsafe_code)]
unsafe fn normals_of_block<R: Real>(
    normals: DisjointSlice<'_, Row4<R>>,
    points: Range<u32>,
    triangles: &[[u32; 3]],
    position: impl Fn(u32) -> [f64; 3],
) {
    // SAFETY: the caller's promise.
    let normals = unsafe { normals.run(points.clone()) };
    normals.fill(Row4::ZERO);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|point| Vector3::from(position(point)));
        let area = (b - a).cross(&(c - a));
        for point in triangle.iter().filter(|point| points.contains(point)) {
            let normal = &mut normals[(point - points.start) as usize];
            for axis in 0..3 {
                normal.0[axis] += R::from_f64(area[axis]);
            }
        }
    }
    for normal in normals {
        let length = dot(normal.xyz(), normal.xyz()).sqrt();
        if length > R::ZERO {
            normal.0 = normal.0.map(|x| x / length);
        }
    }
}
