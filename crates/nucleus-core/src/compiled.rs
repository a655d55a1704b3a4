//! The work of the solver for one scalar, compiled here and nowhere else.
//!
//! Rust compiles a generic function anew in every crate and every test that uses it, and with [`Solver`] that would be
//! nearly all of this crate each time. What [`Compiled`] holds is of `f32` or of `f64` and not generic; what is public
//! of the solver hands its work on to it.

use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::model::builder::ModelBuilder;
use crate::output::observer::{ContactState, StepObserver};
use crate::output::passes::PassCost;
use crate::output::report::StepReport;
use crate::solver::Solver;
use crate::state::checkpoint::RestoreError;

/// All of the solver's work that takes long to compile.
pub trait Compiled: Sized {
    /// [`Solver::new`].
    fn build(builder: ModelBuilder, threads: usize) -> Solver<Self>
    where
        Self: Real;

    /// [`Solver::restored`].
    fn restore(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Solver<Self>, RestoreError>
    where
        Self: Real;

    /// [`Solver::save`].
    fn save(solver: &Solver<Self>) -> Vec<u8>
    where
        Self: Real;

    /// [`Solver::step`].
    fn step(solver: &mut Solver<Self>, frame: &FrameInput, observer: &mut dyn StepObserver) -> StepReport
    where
        Self: Real;

    /// How contact stands at the points of each cloth.
    fn contact_states(solver: &Solver<Self>, out: &mut Vec<Vec<ContactState>>)
    where
        Self: Real;

    /// [`Solver::passes`].
    fn passes(solver: &Solver<Self>, frame: &FrameInput) -> Vec<PassCost>
    where
        Self: Real;

    /// [`Solver::elastic_energy`].
    fn elastic_energy(solver: &Solver<Self>, frame: &FrameInput) -> f64
    where
        Self: Real;
}

macro_rules! compiled {
    ($($scalar:ty)*) => {$(
        impl Compiled for $scalar {
            fn build(builder: ModelBuilder, threads: usize) -> Solver<Self> {
                Solver::build(builder, threads)
            }

            fn restore(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Solver<Self>, RestoreError> {
                Solver::restore(builder, threads, bytes)
            }

            fn save(solver: &Solver<Self>) -> Vec<u8> {
                solver.bytes()
            }

            fn step(solver: &mut Solver<Self>, frame: &FrameInput, observer: &mut dyn StepObserver) -> StepReport {
                crate::step::step(solver, frame, observer)
            }

            fn contact_states(solver: &Solver<Self>, out: &mut Vec<Vec<ContactState>>) {
                solver.list_contact_states(out);
            }

            fn passes(solver: &Solver<Self>, frame: &FrameInput) -> Vec<PassCost> {
                solver.list_passes(frame)
            }

            fn elastic_energy(solver: &Solver<Self>, frame: &FrameInput) -> f64 {
                solver.held_energy(frame)
            }
        }
    )*};
}

compiled!(f32 f64);
