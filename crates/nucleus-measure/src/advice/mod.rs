//! The paper's advice on settings, tested on this solver for both readings of resistances.
//!
//! | Question                                                 | Read            |
//! |----------------------------------------------------------|-----------------|
//! | the experiments, one for each claim                      | [`experiments`] |
//! | their scenes                                             | `scenes.rs`     |
//! | the Markdown page                                        | [`page`]        |

mod collisions;
mod counts;
mod page;
mod scenes;

pub use page::page;

/// An experiment on a claim of the paper.
pub struct Experiment {
    /// Number of the claim.
    pub claim: &'static str,
    /// The claim.
    pub says: &'static str,
    /// The scene, in words.
    pub scene: &'static str,
    /// Runs it.
    pub run: fn() -> Vec<ClaimResult>,
}

/// Result for one reading of resistances.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimResult {
    /// `Classic`, `Physical`.
    pub reading: &'static str,
    /// Whether the claim holds.
    pub status: Status,
    /// The reason, with the decisive figures.
    pub reason: String,
    /// Column heads, and rows.
    pub table: (Vec<&'static str>, Vec<Vec<String>>),
}

/// Whether a claim holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It holds.
    Holds,
    /// It does not hold.
    DoesNotHold,
    /// The reading has nothing that the claim is about.
    DoesNotApply,
}

impl Status {
    /// `Holds` or `DoesNotHold`.
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
        counts::FASTER,
        collisions::SLIGHTLY_ABOVE,
        collisions::A_TENTH,
        counts::ONE_IS_ENOUGH,
        counts::STEEP,
    ]
}
