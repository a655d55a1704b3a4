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
//! | the Markdown page                                        | [`page`]        |

mod draped;
mod hanging;
mod order;
mod page;
mod precision;

use nucleus_core::{BuildError, Real, ResistanceModel, Stiffness};

use crate::clock::{Clock, Timing};
use crate::fixture::{Fixture, membrane};

pub use page::page;

/// An experiment.
#[derive(Debug, Clone, Copy)]
pub struct Experiment {
    /// Name, for `--only`.
    pub name: &'static str,
    /// The set-up.
    pub description: &'static str,
    /// Differences from the prototype's set-up, and their effect.
    pub differences: &'static str,
    run: fn() -> Result<Vec<Table>, BuildError>,
}

/// A table of figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Heading.
    pub title: &'static str,
    /// Column heads.
    pub head: Vec<&'static str>,
    /// Rows, each as long as the head.
    pub rows: Vec<Vec<String>>,
}

impl Experiment {
    /// Runs it.
    ///
    /// # Errors
    /// When the solver rejects the mesh.
    pub fn run(&self) -> Result<Vec<Table>, BuildError> {
        (self.run)()
    }
}

/// All experiments, in the order of the page.
pub fn experiments() -> [Experiment; 4] {
    [hanging::HANGING, draped::DRAPED, order::ORDER, precision::PRECISION]
}

/// Stiffness of all cloth in N/m: a typical woven cloth.
const STIFFNESS: f64 = 10_000.0;

/// How a budget of evaluations per 1/24 s is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scheme {
    /// Small time steps with one sweep each.
    SmallSteps,
    /// Several sweeps in each of some substeps: Maya's reading.
    Passes(u32),
}

impl Scheme {
    fn words(self) -> String {
        match self {
            Self::SmallSteps => "small steps, one sweep each (Physical)".to_owned(),
            Self::Passes(1) => "passes over 1 substep (Classic)".to_owned(),
            Self::Passes(substeps) => format!("passes over {substeps} substeps (Classic)"),
        }
    }

    /// Applies the scheme to a fixture. A Classic pass removes the whole error, independent of stiffness.
    fn set<R: Real>(self, fixture: &mut Fixture<R>, evaluations: u32) {
        let count = f64::from(evaluations);
        match self {
            Self::SmallSteps => {
                fixture.frame.substeps = 1;
                fixture.frame.resistance = ResistanceModel::Physical { evaluations: count };
                fixture.cloth().stiffness = membrane(STIFFNESS);
            }
            Self::Passes(substeps) => {
                fixture.frame.substeps = substeps;
                fixture.frame.resistance = ResistanceModel::Classic;
                let cloth = fixture.cloth();
                cloth.stiffness = Stiffness::default();
                (cloth.stretch_resistance, cloth.compression_resistance) = (count, count);
                (cloth.shear_resistance, cloth.bend_resistance) = (0.0, 0.0);
            }
        }
        fixture.frame.collision_iterations = count;
    }
}

/// Runs frames; milliseconds of processor time per frame.
fn timed(frames: u32, mut frame: impl FnMut()) -> f64 {
    let (timing, ()) = Timing::measure(Clock::Thread, || (0..frames).for_each(|_| frame()));
    1e3 * timing.processor / f64::from(frames)
}

/// A figure of the prototype, or a dash.
fn or_dash(figure: Option<f64>) -> String {
    figure.map_or("–".to_owned(), crate::report::figure)
}
