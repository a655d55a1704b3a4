//! The workloads of contact: their sizes, settings and lengths.

use nucleus_graph::audit::Closeness;

use crate::bench::workload::{BALL, Ball};

/// Evaluations per 1/24 s at which costs are compared.
pub const TYPICAL: u32 = 48;

/// A workload.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Workload {
    /// W3: a sheet of 1.5 m falls on a ball and onto itself.
    Folds,
    /// W4: a ball at 10 m/s flies into a sheet that hangs by two corners.
    Shot,
    /// W8: five such sheets on one another.
    Layers,
}

impl Workload {
    /// Its number in the list of workloads.
    pub fn name(self) -> &'static str {
        match self {
            Self::Folds => "W3",
            Self::Shot => "W4",
            Self::Layers => "W8",
        }
    }

    /// Frames of a full run.
    pub fn frames(self) -> u32 {
        match self {
            Self::Folds | Self::Layers => 96,
            Self::Shot => 24,
        }
    }

    /// Evaluations per 1/24 s to run. Five sheets take minutes per run.
    pub fn evaluations(self) -> &'static [u32] {
        if self == Self::Layers { &[48, 96] } else { &[24, 48, 96, 192] }
    }

    /// Maximum points along the side of a sheet: five larger ones take an hour, and no peer has larger ones.
    pub fn largest(self) -> u32 {
        if self == Self::Layers { 33 } else { 129 }
    }

    /// The ball.
    pub fn ball(self) -> Ball {
        match self {
            Self::Folds | Self::Layers => BALL,
            // From 2 m before the sheet to 8 m behind it in a second.
            Self::Shot => Ball { radius: 0.15, start: [0.5, -0.5, -2.0], flight: [0.0, 0.0, 10.0 / 24.0] },
        }
    }

    /// How closely an audit follows its motion.
    pub fn closeness(self) -> Closeness {
        // Only an audit of every step sees a passage within a frame.
        if self == Self::Shot { Closeness::Steps } else { Closeness::Frames }
    }
}
