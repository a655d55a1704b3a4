//! A time step as data: its passes, the direction of its sweeps, and its interval in the frame.

use crate::bytes::encode_struct;
use crate::constraints::angle::AngleStrength;
use crate::constraints::bend::BendStrength;
use crate::constraints::shape::ShapeStrength;
use crate::constraints::stretch::LinkStrength;
use crate::constraints::weave::WeaveStrength;

/// One sweep of one effect over one cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep<R> {
    /// The cloth, by its index.
    pub cloth: usize,
    /// The effect and its strength.
    pub effect: Effect<R>,
}

/// An effect, with the strength of its sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effect<R> {
    /// Links along edges: stretch, compression or both. The strength of woven links replaces the compliances of others.
    Stretch(LinkStrength<R>, WeaveStrength<R>),
    /// Cross links of quads.
    Shear(LinkStrength<R>, WeaveStrength<R>),
    /// Hinges between faces, and twists of quads.
    Bend(BendStrength<R>, AngleStrength<R>),
}

/// One pass of an effect that takes a cloth as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WholeSweep {
    /// The cloth, by its index.
    pub cloth: usize,
    /// The effect.
    pub effect: WholeEffect,
}

/// Effects that take a cloth as a whole, not row by row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WholeEffect {
    /// Pressure on the faces.
    Pressure,
    /// Attraction to the rest shape.
    Shape(ShapeStrength),
    /// Attraction to the input mesh: by this share of the distance, or by a spring if `None`.
    Attract(Option<f64>),
}

/// One pass of a time step.
#[derive(Debug, Clone, PartialEq)]
pub enum Pass {
    /// A run of [`Schedule::sweeps`], swept together.
    Constraints(std::ops::Range<usize>),
    /// Takes from a cloth, by its index, the torque that its sweeps had.
    AngularMomentum(usize),
    /// An effect on a whole cloth, of [`Schedule::wholes`].
    Whole(usize),
    /// The tethers of a cloth, by its index.
    Tethers(usize),
    /// One pass over the links of a constraint, of [`Schedule::links`].
    Links(usize),
    /// Density, viscosity and surface tension of a liquid, by the index of its cloth.
    Liquid(usize),
    /// One pass over the contacts of cloth with itself and with other cloth.
    ClothContact,
    /// One pass over the contacts with colliders and the ground plane.
    ColliderContact,
    /// The penetration safeguard.
    Safeguard,
}

/// The interval of a time step, in shares of the frame (0 to 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepInterval {
    /// Its start.
    pub from: f64,
    /// Its end.
    pub to: f64,
    /// The end of the substep it is part of.
    pub end_of_substep: f64,
}

impl StepInterval {
    /// The interval alone.
    pub fn times(self) -> TimeInterval {
        TimeInterval { start: self.from, end: self.to }
    }

    /// The `part`th of so many equal parts.
    pub fn part(self, part: u32, parts: u32) -> Self {
        let cut = |part: u32| self.from + (self.to - self.from) * f64::from(part) / f64::from(parts);
        let to = if part + 1 == parts { self.to } else { cut(part + 1) };
        Self { from: cut(part), to, ..self }
    }
}

/// An interval of time, in shares of the frame (0 to 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeInterval {
    /// Its start.
    pub start: f64,
    /// Its end.
    pub end: f64,
}

impl TimeInterval {
    /// Nothing but the start of the frame: every time step ends later.
    pub const EXPIRED: Self = Self::at(0.0);

    /// An interval without length.
    pub const fn at(time: f64) -> Self {
        Self { start: time, end: time }
    }

    /// Its start and its end.
    #[inline(always)]
    pub fn ends(self) -> [f64; 2] {
        [self.start, self.end]
    }

    /// Its length as a share of the frame.
    #[inline(always)]
    pub fn length(self) -> f64 {
        self.end - self.start
    }

    /// A time as a share of the interval; 0 in one without length.
    #[inline(always)]
    pub fn share_of(self, time: f64) -> f64 {
        if self.end > self.start { (time - self.start) / (self.end - self.start) } else { 0.0 }
    }

    /// Whether it lasts until a time, but for rounding.
    #[inline(always)]
    pub fn lasts_until(self, time: f64) -> bool {
        time <= self.end + 1e-9
    }
}

encode_struct!([] TimeInterval { start: f64, end: f64 });

/// When a pass acts, and over which time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassTime {
    /// The time, as a share of the frame.
    pub at: f64,
    /// The length of the time step or substep in seconds.
    pub length: f64,
}

/// The order of the rows in a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the first to the last.
    Forward,
    /// From the last to the first.
    Backward,
}
