//! Aerodynamic forces: drag, lift and wind, by the orientation of the surface.
//!
//! Wind is the velocity of the air, relative to which drag and lift act; cloth that faces it therefore catches more
//! than cloth on edge (§3.1). Drag is linear in velocity and per 1/24 s. It acts along the normal, and along the
//! surface with the share `tangentialDrag`, as recorded output of the original shows. [`DragStep`] has its discrete forms.
//!
//! Lift acts at right angles to the motion through the air, in the plane of motion and normal, and does no work. Its
//! acceleration is `lift` times density over mass times v² sin α cos α at an angle of attack α, with v in m/s: the lift
//! of a thin plate (Hoerner, Fluid-Dynamic Lift, 1985, ch. 3), and a force that grows with v² as in recorded output of
//! the original. There v is in scene units per second, so that lift grows with the size of a scene (a known fault,
//! N1.3-4); in metres it does not.

use std::ops::Range;

use nalgebra::Vector3;

use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput, ResistanceModel};
use crate::math::{Lanes, Real, by_axis, dot, sub};
use crate::model::ClothModel;
use crate::model::strength_maps::AirFactors;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// The aerodynamic forces on a point in one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air<R> {
    wind: [R; 3],
    /// Factors on the relative velocity along the normal, and along the surface.
    along_normal: R,
    along_surface: R,
    /// How much larger the factors on the change of velocity by forces are, along the normal and along the surface.
    of_kick: [R; 2],
    /// Lift over the mass times the length of the step, in s/m.
    lift: R,
}

/// The aerodynamic forces on a cloth, before vertex maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirForces {
    wind: Vector3<f64>,
    /// Drag over the mass, per second.
    drag: f64,
    /// Lift over the mass, per metre.
    lift: f64,
    tangential_drag: f64,
    h: f64,
    step: DragStep,
}

/// The discrete form of drag in a time step, which acts on the velocity that gravity has changed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum DragStep {
    /// An implicit step, in the Physical reading: the terminal speed is exact at any length of the step.
    Implicit,
    /// Two implicit half-steps, on cloth in the Classic reading, as recorded falls of the original show.
    HalfSteps,
    /// An exponential, on particles in the Classic reading, which matches recorded output of the original to 1e-6.
    Exponential,
}

/// What drag in a time step leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remaining {
    /// Of the velocity through the air at the start of the step, as a share.
    pub velocity: f64,
    /// Of the change of velocity by forces in the step, as a share.
    pub kick: f64,
}

impl DragStep {
    /// What remains after a step in which drag takes the share `decay` to first order.
    ///
    /// Forces and drag act together, so that the share of their kick is that of an implicit step in every form. It equals
    /// the share of the velocity up to the square of `decay`, as recorded falls show. Where drag takes most of the velocity,
    /// it leaves the terminal speed, of which an exponential would leave nothing.
    fn remaining(self, decay: f64) -> Remaining {
        let kick = 1.0 / (1.0 + decay);
        let velocity = match self {
            Self::Implicit => kick,
            Self::HalfSteps => 1.0 / ((1.0 + decay / 2.0) * (1.0 + decay / 2.0)),
            Self::Exponential => libm::exp(-PARTICLE_DRAG * decay),
        };
        Remaining { velocity, kick }
    }
}

/// Share of the rate of drag that particles feel in the Classic reading: recorded falls give 0.99913 at steps of 1/72 s
/// and of 1/144 s. Its reason is not known.
const PARTICLE_DRAG: f64 = 0.999_13;

impl AirForces {
    /// The forces on a cloth with this `pointMass` in steps of `h` seconds; `None` in a vacuum.
    pub fn new(frame: &FrameInput, cloth: &ClothFrame, point_mass: f64, h: f64) -> Option<Self> {
        let per_mass = |attribute: f64| attribute * frame.air_density / point_mass;
        let (drag, lift) = (per_mass(cloth.drag) / COUNT_PERIOD, per_mass(cloth.lift));
        if drag <= 0.0 && lift == 0.0 {
            return None;
        }
        let wind = if cloth.feels_wind { frame.wind } else { Vector3::zeros() } + cloth.local_wind;
        let step = match frame.resistance {
            ResistanceModel::Classic => DragStep::HalfSteps,
            ResistanceModel::Physical { .. } => DragStep::Implicit,
        };
        Some(Self { wind, drag, lift, tangential_drag: cloth.tangential_drag, h, step })
    }

    /// The same forces on particles.
    pub fn on_particles(self) -> Self {
        let step = match self.step {
            DragStep::HalfSteps => DragStep::Exponential,
            step => step,
        };
        Self { step, ..self }
    }

    /// What drag leaves of the velocity of a particle in a step.
    pub fn remaining(&self) -> Remaining {
        self.step.remaining(self.drag * self.h)
    }

    /// The forces on a point with these factors.
    pub fn at<R: Real>(&self, factors: &AirFactors) -> Air<R> {
        let drag = self.drag * factors.drag;
        let rates = [drag, drag * (self.tangential_drag * factors.tangential_drag)];
        let remaining = rates.map(|rate| self.step.remaining(rate * self.h));
        let [along_normal, along_surface] = remaining.map(|share| R::from_f64(share.velocity));
        Air {
            wind: [self.wind.x, self.wind.y, self.wind.z].map(R::from_f64),
            along_normal,
            along_surface,
            of_kick: remaining.map(|share| R::from_f64(share.kick - share.velocity)),
            lift: R::from_f64(self.lift * factors.lift * self.h),
        }
    }
}

/// The aerodynamic forces on points side by side.
#[derive(Debug, Clone, Copy)]
pub struct AirLanes<L> {
    /// In m/s.
    pub wind: [L; 3],
    along_normal: L,
    along_surface: L,
    of_kick: [L; 2],
    lift: L,
    /// Whether any of them has lift; whether forces act on any of them as on a body without air.
    has_lift: bool,
    slows_kick: bool,
}

impl<L> AirLanes<L> {
    /// The forces that `of` gives for the point of each lane.
    #[inline(always)]
    pub fn of_points<R: Real>(of: impl Fn(usize) -> Air<R>) -> Self
    where
        L: Lanes<R>,
    {
        let mut airs = [of(0); 8];
        for lane in 1..4 * L::GROUPS {
            airs[lane] = of(lane);
        }
        Self {
            wind: by_axis(|axis| lanes_of(&airs, |air| air.wind[axis])),
            along_normal: lanes_of(&airs, |air| air.along_normal),
            along_surface: lanes_of(&airs, |air| air.along_surface),
            of_kick: [lanes_of(&airs, |air| air.of_kick[0]), lanes_of(&airs, |air| air.of_kick[1])],
            lift: lanes_of(&airs, |air| air.lift),
            has_lift: airs.iter().any(|air| air.lift != R::ZERO),
            slows_kick: airs.iter().any(|air| air.of_kick != [R::ZERO; 2]),
        }
    }

    /// The velocities after the step, from those `before` it and those with the kick of all other forces.
    #[inline(always)]
    pub fn slow<R: Real>(&self, before: [L; 3], kicked: [L; 3], normal: [L; 3]) -> [L; 3]
    where
        L: Lanes<R>,
    {
        let through = sub(kicked, self.wind);
        let turned = if self.has_lift { self.turn(through, normal) } else { through };
        let slowed = add_scaled(self.wind, [self.along_normal, self.along_surface], turned, normal);
        match self.slows_kick {
            true => add_scaled(slowed, self.of_kick, sub(kicked, before), normal),
            false => slowed,
        }
    }

    /// Lift rotates the relative velocity and keeps its length.
    #[inline(always)]
    fn turn<R: Real>(&self, through: [L; 3], normal: [L; 3]) -> [L; 3]
    where
        L: Lanes<R>,
    {
        let (facing, speed_squared) = (dot(normal, through), dot(through, through));
        let share = facing / speed_squared;
        // At most a turn of 45° in a step: lift too strong for the step is bounded, not unstable.
        let turn = (self.lift * speed_squared.sqrt()).least(L::splat(R::ONE)).most(L::splat(-R::ONE));
        let lifted = by_axis(|axis| through[axis] - turn * facing * (normal[axis] - through[axis] * share));
        let scale = (speed_squared / dot(lifted, lifted)).sqrt();
        let moves = speed_squared - L::splat(R::MIN_DENOMINATOR);
        by_axis(|axis| moves.choose_by_sign(lifted[axis] * scale, through[axis]))
    }
}

/// A number of each point, by lane.
#[inline(always)]
fn lanes_of<R: Real, L: Lanes<R>>(airs: &[Air<R>; 8], number: impl Fn(&Air<R>) -> R) -> L {
    L::of_groups(|group| {
        let of = |k: usize| number(&airs[4 * group + k]);
        [of(0), of(1), of(2), of(3)]
    })
}

/// Adds a vector, with a factor along the normal and another along the surface.
#[inline(always)]
fn add_scaled<R: Real, L: Lanes<R>>(
    to: [L; 3],
    [along_normal, along_surface]: [L; 2],
    vector: [L; 3],
    normal: [L; 3],
) -> [L; 3] {
    let facing = dot(normal, vector);
    by_axis(|axis| {
        let across = normal[axis] * facing;
        to[axis] + across * along_normal + (vector[axis] - across) * along_surface
    })
}

/// Writes the normals of all points that air acts on. Reads positions.
///
/// Physical weights faces by area: the force on a point is then that on the surface around it, on any mesh. Classic takes
/// the plain mean of the normals of faces, as the drag of recorded falls shows (0.564 per second for a sphere of 20 by 20
/// faces; 0.566 with the mean, 0.562 with areas).
pub fn update_normals<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    resistance: ResistanceModel,
    pool: &ThreadPool,
) {
    let by_area = resistance != ResistanceModel::Classic;
    let State { anchor, displacement, normal, .. } = state;
    let position = |row: u32| {
        let (anchor, moved) = (anchor[row as usize], displacement[row as usize].0);
        [0, 1, 2].map(|axis| anchor[axis] + moved[axis].to_f64())
    };
    let normals = DisjointSlice::new(normal);
    for cloth in cloths.iter().filter(|cloth| !cloth.triangles.is_empty()) {
        // Particles have a capacity of more blocks than are in use.
        pool.parallel_for(cloth.blocks.len(), |block| {
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            unsafe {
                normals_of_block(
                    normals,
                    cloth.blocks.range(block),
                    &cloth.triangles[block],
                    (by_area, &position),
                );
            }
        });
    }
}

/// Sets the normals of a block of points from the triangles that touch it, weighted by area or all alike.
///
/// # Safety
/// No other task of the loop touches these normals.
#[allow(unsafe_code)]
unsafe fn normals_of_block<R: Real>(
    normals: DisjointSlice<'_, [R; 3]>,
    points: Range<u32>,
    triangles: &[[u32; 3]],
    (by_area, position): (bool, impl Fn(u32) -> [f64; 3]),
) {
    // SAFETY: the caller's promise.
    let normals = unsafe { normals.run(points.clone()) };
    normals.fill([R::ZERO; 3]);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|point| Vector3::from(position(point)));
        let area = (b - a).cross(&(c - a));
        let area = if by_area { area } else { area.try_normalize(0.0).unwrap_or_default() };
        for point in triangle.iter().filter(|point| points.contains(point)) {
            let normal = &mut normals[(point - points.start) as usize];
            for axis in 0..3 {
                normal[axis] += R::from_f64(area[axis]);
            }
        }
    }
    for normal in normals {
        let length = dot(*normal, *normal).sqrt();
        if length > R::ZERO {
            *normal = normal.map(|x| x / length);
        }
    }
}
