//! The loop over frames: evaluates the animation, calls the solver.

use nucleus_audit::World;
use nucleus_core::{FrameInput, PointId, Real, Solver, StateView, StepObserver, StepReport};

use crate::audit::{Audit, Audited, Closeness};
use crate::compile::{Grips, Object, Program};

/// A run of a program, at some frame of it.
///
/// It begins at the start frame with everything in its initial state. Every [`advance`](Self::advance)
/// solves one frame more (N3.1-6).
pub struct Simulation<R: Real = f32> {
    program: Program,
    solver: Solver<R>,
    grips: Grips,
    frame: i64,
    audit: Option<Audit>,
}

/// What the solver says about a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameReport {
    /// The frame that was reached.
    pub frame: i64,
    /// What happened on the way there.
    pub report: StepReport,
    /// How often something passed through something on the way there; nothing where no audit looks.
    pub passed_through: Option<u64>,
}

impl<R: Real> Simulation<R> {
    /// A run at its start frame. `threads` is the number of cores to use; it never changes a bit of the result.
    pub fn new(program: &Program, threads: usize) -> Self {
        Self {
            solver: Solver::new(program.model().clone(), threads),
            grips: Grips::default(),
            frame: program.time().start,
            program: program.clone(),
            audit: None,
        }
    }

    /// Has the run audited from here on.
    pub fn begin_audit(&mut self, closeness: Closeness) {
        let pins = self.next_input(&mut self.grips.clone()).pins;
        let rules = |world: &World| self.program.kept_apart(self.frame + 1, &pins, world);
        self.audit = Some(Audit::new(self.objects(), closeness, &self.solver, rules));
    }

    /// What the audit has come to, if there is one.
    pub fn audit(&self) -> Option<&Audit> {
        self.audit.as_ref()
    }

    pub(crate) fn next_input(&self, grips: &mut Grips) -> FrameInput {
        let position = |cloth, point: PointId| self.solver.point(cloth, point.index());
        self.program.input(self.frame + 1, grips, &position)
    }

    /// Solves the next frame, showing the state to `watch` after each substep. May go on after the last frame.
    pub fn advance(&mut self, watch: &mut dyn StepObserver) -> FrameReport {
        self.advance_with(&mut |_, _| {}, watch)
    }

    /// The same, with a last look at what the frame brings, before the solver sees it: a chance to measure it, or
    /// to bring what no scene can say.
    pub fn advance_with(
        &mut self,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        watch: &mut dyn StepObserver,
    ) -> FrameReport {
        let frame = self.frame + 1;
        let mut grips = std::mem::take(&mut self.grips);
        let mut input = self.next_input(&mut grips);
        self.grips = grips;
        change(&self.solver, &mut input);
        let (report, passed_through) = match &mut self.audit {
            None => (self.solver.step(&input, watch), None),
            Some(audit) => {
                let before = audit.account().found();
                audit.begin_frame(frame, |world| self.program.kept_apart(frame, &input.pins, world));
                let report = self.solver.step(&input, &mut Audited::new(audit, watch));
                (report, Some(audit.account().found() - before))
            }
        };
        self.frame = frame;
        FrameReport { frame, report, passed_through }
    }

    /// The frame it is at.
    pub fn frame(&self) -> i64 {
        self.frame
    }

    /// Whether the last frame has been reached.
    pub fn is_done(&self) -> bool {
        self.frame >= self.program.time().end
    }

    /// All objects: cloths, then colliders, each in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        self.program.objects()
    }

    /// Scene units in a metre.
    pub fn units_per_metre(&self) -> f64 {
        self.program.units_per_metre()
    }

    /// The state as it is, at the start frame too.
    pub fn state(&self) -> &dyn StateView {
        &self.solver
    }

    /// The solver.
    pub fn solver(&self) -> &Solver<R> {
        &self.solver
    }

    /// What it runs.
    pub fn program(&self) -> &Program {
        &self.program
    }
}

#[cfg(test)]
mod tests;
