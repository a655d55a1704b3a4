//! A run as bytes, to be gone on with: the solvers of all nuclei, what their constraints hold, and where time stands.

use nalgebra::Vector3;
use nucleus_core::{Encode, Reader, Real, RestoreError, Solver, add_checksum, verify_checksum};

use crate::compile::{Grips, Program};

use super::{Run, Simulation};

/// What the bytes are; counted up whenever their layout changes.
const KIND: [u8; 8] = *b"nuclei 1";

impl<R: Real> Simulation<R> {
    /// All that the frames to come depend on, besides the program. An audit is no part of it.
    pub fn save(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.frame.encode(&mut bytes);
        (self.runs.len() as u64).encode(&mut bytes);
        self.runs.iter().for_each(|run| run.save(&mut bytes));
        add_checksum(KIND, &bytes)
    }

    /// A run that goes on from where one was saved, with the same bits. `threads` is the number of cores to use; it may
    /// be another.
    ///
    /// # Errors
    /// When the bytes are damaged, of another version, or of a program of other objects.
    pub fn restored(program: &Program, threads: usize, bytes: &[u8]) -> Result<Self, RestoreError> {
        let mut from = Reader::new(verify_checksum(KIND, bytes)?);
        let (frame, count) = <(i64, u64)>::decode(&mut from).ok_or(RestoreError::Damaged)?;
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
        solver.save().encode(out);
        held.encode(out);
        (*now, (*evaluated, *left_out)).encode(out);
    }

    fn restored(
        program: &Program,
        universe: usize,
        threads: usize,
        from: &mut Reader<'_>,
    ) -> Result<Self, RestoreError> {
        let universe = &program.universes()[universe];
        let solver = Vec::decode(from).ok_or(RestoreError::Damaged)?;
        let held: Vec<Option<Vec<Vector3<f64>>>> = Encode::decode(from).ok_or(RestoreError::Damaged)?;
        let (now, (evaluated, left_out)) = Encode::decode(from).ok_or(RestoreError::Damaged)?;
        if !universe.holds(&held) {
            return Err(RestoreError::OtherModel);
        }
        let solver = Solver::restored(universe.model().clone(), threads, &solver)?;
        Ok(Self { solver, grips: Grips { held }, now, evaluated, left_out })
    }
}
