//! The paper's advice on settings, tried on this solver: does it hold, on which scene, read in which way?
//!
//! | You want to know...                                      | Read            |
//! |----------------------------------------------------------|-----------------|
//! | the experiments, one for each claim                      | [`experiments`] |
//! | the scenes that they are made on                         | `scenes.rs`     |
//! | how they become a page                                   | [`page`]        |

mod collisions;
mod page;
mod particles;
mod propagation;
mod scenes;
mod substeps;

pub use page::page;

/// A claim of the paper, tried.
pub struct Experiment {
    /// Its number among the claims.
    pub claim: &'static str,
    /// What it says.
    pub says: &'static str,
    /// What is run, in words.
    pub scene: &'static str,
    /// Runs it.
    pub run: fn() -> Vec<ClaimResult>,
}

/// What was found, for one reading of resistances.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimResult {
    /// `Classic`, `Physical`.
    pub reading: &'static str,
    /// Whether the claim holds.
    pub status: Status,
    /// Why, with the figures that decide.
    pub reason: String,
    /// Heads of the columns, and the rows.
    pub table: (Vec<&'static str>, Vec<Vec<String>>),
}

/// Whether a claim holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It does.
    Holds,
    /// It does not.
    DoesNotHold,
    /// There is nothing for it to be about.
    DoesNotApply,
}

impl Status {
    /// From whether it holds.
    pub fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::DoesNotHold }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::DoesNotApply => "does not apply",
        }
    }
}

/// All experiments, in the order of the claims.
pub fn experiments() -> [Experiment; 6] {
    [
        collisions::LEFT_STRETCH,
        substeps::FASTER,
        collisions::SLIGHTLY_ABOVE,
        collisions::A_TENTH,
        particles::ONE_IS_ENOUGH,
        propagation::STEEP,
    ]
}
