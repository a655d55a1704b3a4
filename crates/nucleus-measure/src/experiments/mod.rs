//! Four design experiments, repeated on the solver.
//!
//! They were first done on a prototype of springs (solver dossier, F.2 and G). Results of both are compared, so that a
//! design choice whose reason has vanished is visible.
//!
//! | Question                                                 | Read            |
//! |----------------------------------------------------------|-----------------|
//! | sag and swing of stiff cloth for a budget                | `hanging.rs`    |
//! | its strain over a ball                                   | `draped.rs`     |
//! | energy created by the order of sweeps                    | `order.rs`      |
//! | error of single precision                                | `precision.rs`  |
//! | one experiment, its schemes, and the Markdown page       | `experiment.rs` |

mod draped;
mod experiment;
mod hanging;
mod order;
mod precision;

pub use experiment::{Experiment, Table, page};

/// All experiments, in the order of the page.
pub fn experiments() -> [Experiment; 4] {
    [hanging::HANGING, draped::DRAPED, order::ORDER, precision::PRECISION]
}
