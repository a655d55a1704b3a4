//! The paper's advice on settings, tested on this solver for both readings of resistances.
//!
//! | Question                                                 | Read            |
//! |----------------------------------------------------------|-----------------|
//! | the experiments, one for each claim                      | [`experiments`] |
//! | one experiment, its result, and the Markdown page        | `claim.rs`      |
//! | their scenes                                             | `scenes.rs`     |

mod claim;
mod collisions;
mod counts;
mod scenes;

pub use claim::{ClaimResult, Experiment, Status, page};

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
