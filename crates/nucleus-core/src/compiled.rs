//! The solver for `f32` and for `f64`, compiled here and nowhere else.
//!
//! Rust compiles a generic function anew in every crate and every test that uses it; for [`Solver`] that would be
//! nearly all of this crate each time. The public methods of the solver therefore call [`CompiledReal`], whose
//! functions are not generic.

use crate::bytes::RestoreError;
use crate::checkpoint;
use crate::contact::contact_state::list_contact_states;
use crate::input::frame::FrameInput;
use crate::model::builder::ModelBuilder;
use crate::output::{ContactState, PassCost, StepObserver, StepReport};
use crate::report::{diagnostics, memory, passes};
use crate::solver::{CompiledReal, Solver};
use crate::step;

macro_rules! compiled {
    ($($scalar:ty)*) => {$(
        impl CompiledReal for $scalar {
            fn build(builder: ModelBuilder, threads: usize) -> Solver<Self> {
                Solver::build(builder, threads)
            }

            fn restore(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Solver<Self>, RestoreError> {
                checkpoint::restore(builder, threads, bytes)
            }

            fn save(solver: &Solver<Self>) -> Vec<u8> {
                checkpoint::save(solver)
            }

            fn step(solver: &mut Solver<Self>, frame: &FrameInput, observer: &mut dyn StepObserver) -> StepReport {
                step::step(solver, frame, observer)
            }

            fn contact_states(solver: &Solver<Self>, out: &mut Vec<Vec<ContactState>>) {
                list_contact_states(&solver.model, &solver.state, &solver.contact, out);
            }

            fn passes(solver: &Solver<Self>, frame: &FrameInput) -> Vec<PassCost> {
                passes::passes(solver, frame)
            }

            fn memory(solver: &Solver<Self>) -> usize {
                memory::bytes(solver)
            }

            fn elastic_energy(solver: &Solver<Self>, frame: &FrameInput) -> f64 {
                diagnostics::elastic_energy(&solver.model.cloths, &solver.state, frame)
            }
        }
    )*};
}

compiled!(f32 f64);
