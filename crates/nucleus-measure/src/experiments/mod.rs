//! Four experiments that the solver's design rests on, made on the solver itself.
//!
//! They were first made on a prototype of springs, before there was a solver (solver dossier, F.2 and G). What the
//! prototype found stands beside what is found here, so that a choice whose reason has gone is seen.
//!
//! | You want to know...                                      | Read            |
//! |----------------------------------------------------------|-----------------|
//! | how far stiff cloth sags for a budget, and swings        | `hanging.rs`    |
//! | how far it is stretched over a ball                      | `draped.rs`     |
//! | whether the order of sweeps makes energy                 | `order.rs`      |
//! | what single precision costs                              | `precision.rs`  |
//! | how they become a page                                   | [`page`]        |

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
    /// A word to ask for it by.
    pub name: &'static str,
    /// What is run.
    pub description: &'static str,
    /// Where the solver differs from the prototype in what is run, and what that does.
    pub differences: &'static str,
    run: fn() -> Result<Vec<Table>, BuildError>,
}

/// Figures of an experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What is in it.
    pub title: &'static str,
    /// The heads of its columns.
    pub head: Vec<&'static str>,
    /// Its rows, each as long as the head.
    pub rows: Vec<Vec<String>>,
}

impl Experiment {
    /// Makes it.
    ///
    /// # Errors
    /// When the solver refuses what is built.
    pub fn run(&self) -> Result<Vec<Table>, BuildError> {
        (self.run)()
    }
}

/// All experiments, in the order of the page.
pub fn experiments() -> [Experiment; 4] {
    [hanging::HANGING, draped::DRAPED, order::ORDER, precision::PRECISION]
}

/// N/m of all cloth here: a usual woven cloth.
const STIFFNESS: f64 = 10_000.0;

/// How a budget of evaluations in 1/24 s is spent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scheme {
    /// Small steps, each with one sweep.
    SmallSteps,
    /// Passes over so many substeps: Maya's reading.
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

    /// Sets a rig to it. A pass takes the whole error away: links are as stiff as the passes make them.
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

/// Runs frames and gives milliseconds of the processor for each.
fn timed(frames: u32, mut frame: impl FnMut()) -> f64 {
    let (timing, ()) = Timing::measure(Clock::Thread, || (0..frames).for_each(|_| frame()));
    1e3 * timing.processor / f64::from(frames)
}

/// A figure that the prototype has, or a dash.
fn or_dash(figure: Option<f64>) -> String {
    figure.map_or("–".to_owned(), crate::report::figure)
}
