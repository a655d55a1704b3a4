//! The loop over frames: evaluates the animation, calls the solvers.

use std::cell::RefCell;

use nucleus_audit::CollisionMesh;
use nucleus_core::{
    ClothId, FrameInput, Pin, PointId, Real, Solver, StateView, StepObserver, StepReport, SubstepIndex,
};

use crate::attributes::nucleus;
use crate::audit::{Audit, Audited, Closeness, Grounds};
use crate::compile::{Grips, Object, Program};

use plan::Leap;
use view::{Merge, View};

mod checkpoint;
mod plan;
mod view;

/// A run of a program, at some frame of it.
///
/// It begins at the start frame with everything in its initial state. Every [`advance`](Self::advance)
/// solves one frame more (N3.1-6), or several where the scene is evaluated only every so many frames.
/// Nuclei are solved one after another, and none knows of the others.
pub struct Simulation<R: Real = f32> {
    program: Program,
    runs: Vec<Run<R>>,
    frame: i64,
    threads: usize,
    audit: Option<Audit>,
}

/// One nucleus while it runs.
struct Run<R: Real> {
    solver: Solver<R>,
    grips: Grips,
    /// Where the time of the nucleus stands, in frames.
    now: f64,
    /// The frame of the scene at which it was evaluated last.
    evaluated: f64,
    /// What was evaluated last has not been solved.
    left_out: bool,
}

/// What the solver says about a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameReport {
    /// The frame that was reached, or was on the way to be.
    pub frame: i64,
    /// What happened on the way there; of several nuclei the worst of each figure.
    pub report: StepReport,
    /// How often something passed through something on the way there; nothing where no audit looks.
    pub passed_through: Option<u64>,
}

impl<R: Real> Simulation<R> {
    /// A run at its start frame. `threads` is the number of cores to use; it never changes a bit of the result.
    pub fn new(program: &Program, threads: usize) -> Self {
        let frame = program.time().start;
        let runs = (0..program.universes().len()).map(|k| Run::new(program, k, threads)).collect();
        Self { runs, frame, threads, program: program.clone(), audit: None }
    }

    /// Has the run audited from here on.
    pub fn begin_audit(&mut self, closeness: Closeness) {
        let pins = self.next_pins();
        let rules = |world: &CollisionMesh| self.program.kept_apart(self.next_frame(), &pins, world);
        self.audit = Some(Audit::new(self.objects(), closeness, self.state(), rules));
    }

    /// What the audit has come to, if there is one.
    pub fn audit(&self) -> Option<&Audit> {
        self.audit.as_ref()
    }

    /// What is held in the next frame, by the ids of the program.
    pub(crate) fn next_pins(&self) -> Vec<Pin> {
        let to = self.next_frame() as f64;
        let pins =
            self.runs.iter().zip(self.program.universes()).enumerate().flat_map(|(k, (run, universe))| {
                let position = |cloth, point: PointId| run.solver.point(cloth, point.index());
                let stretch = self.program.stretch(k, [run.evaluated, to], to - run.evaluated, run.left_out);
                let pins = stretch.input(&mut run.grips.clone(), &position).pins;
                let first = universe.cloths().start;
                pins.into_iter().map(move |pin| Pin { cloth: ClothId(first + pin.cloth.0), ..pin })
            });
        pins.collect()
    }

    /// Solves the next frame, showing the state to `watch` after each substep. May go on after the last frame.
    ///
    /// Where `watch` stops the frame, its report says so. The run still is at the frame before, but its state is not: only
    /// a run [`restored`](Self::restored) from what was saved there goes on with the same bits.
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
        let frame = self.next_frame();
        let Some(mut audit) = self.audit.take() else {
            let report = self.solve(frame, change, watch, &RefCell::default());
            return FrameReport { frame, report, passed_through: None };
        };
        let pins = self.next_pins();
        audit.begin_frame(frame, |world| self.program.kept_apart(frame, &pins, world));
        let before = audit.account().found();
        let grounds = RefCell::new(audit.take_grounds());
        let report = self.solve(frame, change, &mut Audited::new(&mut audit, &grounds, watch), &grounds);
        audit.keep_grounds(grounds.into_inner());
        let passed_through = Some(audit.account().found() - before);
        self.audit = Some(audit);
        FrameReport { frame, report, passed_through }
    }

    /// Solves everything up to a frame, and tells `grounds` where that puts the ground planes.
    fn solve(
        &mut self,
        frame: i64,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        watch: &mut dyn StepObserver,
        grounds: &RefCell<Grounds>,
    ) -> StepReport {
        let leaps = self.plan(frame);
        let total = leaps.iter().map(|leap| leap.substeps).sum();
        let mut done = 0;
        let mut report: Option<StepReport> = None;
        for leap in leaps {
            let seen = self.leap(&leap, change, &mut Watched { watch: &mut *watch, grounds, done, total });
            if seen.stopped {
                return seen;
            }
            done += leap.substeps;
            report = Some(report.map_or(seen, |before| worst(&before, &seen, leap.is_new_time)));
        }
        if total == 0 {
            watch.substep(SubstepIndex { substep: 1, substeps: 1 }, self.state());
        }
        self.frame = frame;
        report.unwrap_or_default()
    }

    /// Solves a stretch of time of one nucleus.
    fn leap(
        &mut self,
        leap: &Leap,
        change: &mut dyn FnMut(&Solver<R>, &mut FrameInput),
        watched: &mut Watched,
    ) -> StepReport {
        if leap.begins_anew {
            self.runs[leap.universe] = Run::new(&self.program, leap.universe, self.threads);
            watched.grounds.borrow_mut().begin_anew(leap.universe);
        }
        let (before, rest) = self.runs.split_at_mut(leap.universe);
        let Some((run, after)) = rest.split_first_mut() else { return StepReport::default() };
        let stretch = self.program.stretch(leap.universe, leap.frames, leap.elapsed, leap.leaps);
        let solver = &run.solver;
        let position = |cloth, point: PointId| solver.point(cloth, point.index());
        let mut input = stretch.input(&mut run.grips, &position);
        change(&run.solver, &mut input);
        let first_cloth = self.program.universes()[leap.universe].cloths().start;
        let span = [watched.done, watched.done + leap.substeps];
        let span = span.map(|substep| f64::from(substep) / f64::from(watched.total.max(1)));
        watched.grounds.borrow_mut().take(leap.universe, first_cloth, &input, span);
        if before.is_empty() && after.is_empty() && watched.total == leap.substeps {
            return run.solver.step(&input, watched.watch);
        }
        let others = before.iter().map(|run| &run.solver as &dyn StateView);
        let others: Vec<&dyn StateView> = others.chain(after.iter().map(|run| &run.solver as _)).collect();
        let mut merge = Merge {
            watch: &mut *watched.watch,
            done: watched.done,
            own: leap.substeps,
            total: watched.total,
            universe: leap.universe,
            others,
            program: &self.program,
        };
        run.solver.step(&input, &mut merge)
    }

    /// The frame it is at.
    pub fn frame(&self) -> i64 {
        self.frame
    }

    /// The frame that it will be at after the next [`advance`](Self::advance). The last frame is never leapt
    /// over.
    pub fn next_frame(&self) -> i64 {
        let next = self.frame + (self.program.every() as i64).max(1);
        let end = self.program.time().end;
        if self.frame < end { next.min(end) } else { next }
    }

    /// Whether the last frame has been reached.
    pub fn is_done(&self) -> bool {
        self.frame >= self.program.time().end
    }

    /// All objects: cloths, then colliders, each in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        self.program.objects()
    }

    /// Scene units in a metre, for the first nucleus.
    pub fn units_per_metre(&self) -> f64 {
        self.program.units_per_metre()
    }

    /// The state as it is, at the start frame too.
    pub fn state(&self) -> &dyn StateView {
        match self.runs.as_slice() {
            [only] => &only.solver,
            _ => self,
        }
    }

    /// The solver of the first nucleus.
    pub fn solver(&self) -> &Solver<R> {
        &self.runs[0].solver
    }

    /// The solvers of all nuclei, in the order of the program.
    pub fn solvers(&self) -> impl Iterator<Item = &Solver<R>> {
        self.runs.iter().map(|run| &run.solver)
    }

    /// What it runs.
    pub fn program(&self) -> &Program {
        &self.program
    }

    fn view(&self) -> View<'_> {
        let parts = self.runs.iter().map(|run| &run.solver as &dyn StateView).collect();
        View { program: &self.program, parts }
    }
}

impl<R: Real> Run<R> {
    fn new(program: &Program, universe: usize, threads: usize) -> Self {
        let universe = &program.universes()[universe];
        let start = universe.start() as f64;
        let now = program.graph().at(start).get(universe.nucleus(), &nucleus::CURRENT_TIME);
        Self {
            solver: Solver::new(universe.model().clone(), threads),
            grips: Grips::default(),
            now,
            evaluated: start,
            left_out: false,
        }
    }
}

/// Whoever watches a frame, and how much of it is over.
struct Watched<'a> {
    watch: &'a mut dyn StepObserver,
    grounds: &'a RefCell<Grounds>,
    done: u32,
    total: u32,
}

/// The worst of two accounts: of two nuclei at one time, or of a nucleus at two times in a row.
fn worst(a: &StepReport, b: &StepReport, in_a_row: bool) -> StepReport {
    StepReport {
        max_strain: a.max_strain.max(b.max_strain),
        strain_99: a.strain_99.max(b.strain_99),
        min_gap: a.min_gap.min(b.min_gap),
        min_cloth_gap: a.min_cloth_gap.min(b.min_cloth_gap),
        rest_limited: if in_a_row { b.rest_limited } else { a.rest_limited + b.rest_limited },
        contacts: a.contacts + b.contacts,
        candidate_pairs: a.candidate_pairs + b.candidate_pairs,
        broad_phases: a.broad_phases + b.broad_phases,
        pairs_reverted: a.pairs_reverted + b.pairs_reverted,
        pairs_unresolved: a.pairs_unresolved + b.pairs_unresolved,
        depenetrating: if in_a_row { b.depenetrating } else { a.depenetrating + b.depenetrating },
        intersections: if in_a_row { b.intersections } else { a.intersections + b.intersections },
        kinetic_energy: if in_a_row { b.kinetic_energy } else { a.kinetic_energy + b.kinetic_energy },
        finite: a.finite && b.finite,
        sanitized: if a.sanitized.count > 0 { a.sanitized } else { b.sanitized },
        stopped: a.stopped || b.stopped,
    }
}

#[cfg(test)]
mod tests;
