//! A run as bytes, to be gone on with: the solvers of all nuclei, what their constraints hold, and where time stands.

use nalgebra::Vector3;
use nucleus_core::{Item, Reader, Real, RestoreError, Solver, sealed, unsealed};

use crate::compile::{Grips, Program};

use super::{Run, Simulation};

/// What the bytes are; counted up whenever their layout changes.
const KIND: [u8; 8] = *b"nuclei 1";

impl<R: Real> Simulation<R> {
    /// All that the frames to come depend on, besides the program. An audit is no part of it.
    pub fn save(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.frame.put(&mut bytes);
        (self.runs.len() as u64).put(&mut bytes);
        self.runs.iter().for_each(|run| run.save(&mut bytes));
        sealed(KIND, &bytes)
    }

    /// A run that goes on from where one was saved, with the same bits. `threads` is the number of cores to use; it may
    /// be another.
    ///
    /// # Errors
    /// When the bytes are damaged, of another version, or of a program of other objects.
    pub fn restored(program: &Program, threads: usize, bytes: &[u8]) -> Result<Self, RestoreError> {
        let mut from = Reader::new(unsealed(KIND, bytes)?);
        let (frame, count) = <(i64, u64)>::take(&mut from).ok_or(RestoreError::Damaged)?;
        if count != program.universes().len() as u64 {
            return Err(RestoreError::OtherModel);
        }
        let runs = (0..program.universes().len()).map(|k| Run::restored(program, k, threads, &mut from));
        let runs: Vec<Run<R>> = runs.collect::<Result<_, _>>()?;
        let is_whole = from.is_at_end();
        is_whole
            .then(|| Self { runs, frame, threads, program: program.clone(), audit: None })
            .ok_or(RestoreError::Damaged)
    }
}

impl<R: Real> Run<R> {
    fn save(&self, out: &mut Vec<u8>) {
        let Self { solver, grips: Grips { held }, now, evaluated, left_out } = self;
        solver.save().put(out);
        held.put(out);
        (*now, (*evaluated, *left_out)).put(out);
    }

    fn restored(
        program: &Program,
        universe: usize,
        threads: usize,
        from: &mut Reader<'_>,
    ) -> Result<Self, RestoreError> {
        let universe = &program.universes()[universe];
        let solver = Vec::take(from).ok_or(RestoreError::Damaged)?;
        let held: Vec<Option<Vec<Vector3<f64>>>> = Item::take(from).ok_or(RestoreError::Damaged)?;
        let (now, (evaluated, left_out)) = Item::take(from).ok_or(RestoreError::Damaged)?;
        if !universe.holds(&held) {
            return Err(RestoreError::OtherModel);
        }
        let solver = Solver::restored(universe.model().clone(), threads, &solver)?;
        Ok(Self { solver, grips: Grips { held }, now, evaluated, left_out })
    }
}
