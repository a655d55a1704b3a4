//! The plan of a frame: its substeps and time steps, and the passes of each.

use crate::constraints::link::sweep::LinkSweep;
use crate::input::frame::{ClothFrame, FrameInput, Pressure, ResistanceModel};
use crate::input::links::LinkMethod;
use crate::math::Real;
use crate::schedule::classic::classic;
use crate::schedule::links::link_sweep;
use crate::schedule::pass::{Direction, Pass, StepInterval, Sweep, WholeEffect, WholeSweep};
use crate::schedule::physical::physical;
use crate::schedule::resistance::steps;

/// Least number of time steps with one direction before it alternates.
const MIN_RUN: u64 = 16;

/// The plan of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule<R> {
    /// Substeps in the frame.
    pub substeps: u32,
    /// Time steps in a substep, before any is split.
    pub steps: u32,
    /// Time steps that each of them is split into; 1 in the plan of a frame.
    pub splits: u32,
    /// Length of a time step in seconds.
    pub h: f64,
    /// All sweeps of a time step.
    pub sweeps: Vec<Sweep<R>>,
    /// All effects on whole cloths of a time step.
    pub wholes: Vec<WholeSweep>,
    /// All passes over links of a time step, by their constraints.
    pub links: Vec<LinkSweep<R>>,
    /// The passes of a time step, in order; the same in every one.
    pub passes: Vec<Pass>,
}

/// The plans of the time steps of a frame, by how many each is split into. Each is made once.
pub struct SplitPlans<'a, R> {
    whole: &'a Schedule<R>,
    split: Vec<Schedule<R>>,
}

impl<'a, R: Real> SplitPlans<'a, R> {
    /// None but that of the frame.
    pub fn new(whole: &'a Schedule<R>) -> Self {
        Self { whole, split: Vec::new() }
    }

    /// The plan of a time step that is split into so many.
    pub fn get(&mut self, frame: &FrameInput, splits: u32) -> &Schedule<R> {
        if splits == self.whole.splits {
            return self.whole;
        }
        let known = self.split.iter().position(|plan| plan.splits == splits);
        let at = known.unwrap_or_else(|| {
            self.split.push(self.whole.split(frame, splits));
            self.split.len() - 1
        });
        &self.split[at]
    }
}

impl<R: Real> Schedule<R> {
    /// Plans a frame.
    pub fn new(frame: &FrameInput) -> Self {
        let substeps = frame.substeps.max(1);
        let substep = frame.duration / f64::from(substeps);
        let steps = match frame.resistance {
            ResistanceModel::Classic => 1,
            ResistanceModel::Physical { evaluations } => steps(evaluations, substep),
        };
        let h = substep / f64::from(steps);
        let (sweeps, wholes, links, passes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut schedule = Self { substeps, steps, splits: 1, h, sweeps, wholes, links, passes };
        schedule.plan(frame);
        schedule
    }

    /// The plan of a time step that is split into so many (adaptive substepping): the passes of each, at their length.
    fn split(&self, frame: &FrameInput, splits: u32) -> Self {
        let h = self.h / f64::from(splits);
        let (sweeps, wholes, links, passes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut split = Self { splits, h, sweeps, wholes, links, passes, ..*self };
        split.plan(frame);
        split
    }

    /// The time steps that a time step of the frame is split into, in order: the index of each, counted from the start
    /// of the frame as if all were split alike, and its interval.
    pub fn time_steps(&self, step: u32) -> impl Iterator<Item = (u32, StepInterval)> + use<R> {
        let (span, splits) = (self.span(step), self.splits);
        (0..splits).map(move |k| (step.wrapping_mul(splits).wrapping_add(k), span.part(k, splits)))
    }

    /// Sets the sweeps and passes of a time step.
    fn plan(&mut self, frame: &FrameInput) {
        self.passes = match frame.resistance {
            ResistanceModel::Classic => classic(frame, self.h, &mut self.sweeps, &mut self.wholes),
            ResistanceModel::Physical { .. } => physical(frame, self.h, &mut self.sweeps, &mut self.wholes),
        };
        self.push_outwards(frame);
        self.tether(frame);
        self.join(frame);
        let is_liquid = |cloth: &usize| frame.cloths[*cloth].liquid.is_some();
        let liquids = (0..frame.cloths.len()).filter(is_liquid).map(Pass::Liquid);
        self.passes.splice(0..0, liquids);
        let self_collides = |cloth: &ClothFrame| cloth.self_collision.on;
        let has_cloth_contact = frame.cloths.len() > 1 || frame.cloths.iter().any(self_collides);
        if !has_cloth_contact {
            self.passes.retain(|pass| *pass != Pass::ClothContact);
        }
        if has_cloth_contact || frame.colliders.iter().any(|collider| collider.collide) {
            self.passes.push(Pass::Safeguard);
        }
    }

    /// Adds the passes over tethers before the last contact passes.
    fn tether(&mut self, frame: &FrameInput) {
        let is_tethered = |cloth: &usize| frame.cloths[*cloth].tethers.is_some();
        let tethers = (0..frame.cloths.len()).filter(is_tethered).map(Pass::Tethers);
        let last = self.before_last_contact();
        self.passes.splice(last..last, tethers);
    }

    /// The place in the passes before the last ones of contact.
    fn before_last_contact(&self) -> usize {
        let contact = |pass: &Pass| matches!(pass, Pass::ClothContact | Pass::ColliderContact);
        self.passes.iter().rposition(|pass| !contact(pass)).map_or(0, |last| last + 1)
    }

    /// Adds the passes over links before the last contact passes: springs first, then welds, which are exact.
    ///
    /// Classic passes are due like those of cloth, at equal parts of the substep.
    fn join(&mut self, frame: &FrameInput) {
        let is_weld = |at: &usize| frame.constraints[*at].method == LinkMethod::Weld;
        let (welds, springs): (Vec<usize>, Vec<usize>) =
            (0..frame.constraints.len()).filter(|&at| frame.constraints[at].pulls()).partition(is_weld);
        for at in springs.into_iter().chain(welds) {
            let (sweep, count) = link_sweep(frame, at, self.h);
            let links = self.links.len();
            self.links.push(sweep);
            // Contact comes last; the passes before it are divided into equal parts.
            let last = self.before_last_contact();
            for k in (1..=count as usize).rev() {
                self.passes.insert(last * k / count as usize, Pass::Links(links));
            }
        }
    }

    /// Pressure comes first in a time step: it is a force.
    fn push_outwards(&mut self, frame: &FrameInput) {
        let inflated = |cloth: &usize| frame.cloths[*cloth].pressure != Pressure::Off;
        for cloth in (0..frame.cloths.len()).filter(inflated) {
            self.passes.insert(0, Pass::Whole(self.wholes.len()));
            self.wholes.push(WholeSweep { cloth, effect: WholeEffect::Pressure });
        }
    }

    /// The interval of a time step in the frame.
    pub fn span(&self, step: u32) -> StepInterval {
        let steps = f64::from(self.substeps * self.steps);
        let end_of_substep = f64::from(step / self.steps + 1) / f64::from(self.substeps);
        StepInterval { from: f64::from(step) / steps, to: f64::from(step + 1) / steps, end_of_substep }
    }

    /// The direction of the sweeps of a time step, counted from the start of the frame, after `frames` frames.
    ///
    /// A sweep in a fixed order is not symmetric: in addition to the stiffness it has a small antisymmetric part, which
    /// couples modes and adds energy to them. If links form odd cycles, every order has that part, and vibrations of an
    /// undamped cloth grow from rounding to 1 % of strain within seconds. The backward order has the same part with
    /// the opposite sign. In runs of 4 to 32 steps the two cancel, and nothing grows. Alternated in every step or two
    /// they excite the highest frequencies of the cloth, and it diverges. Where a frame has too few steps for two runs, a run
    /// lasts for one frame or several.
    pub fn direction(&self, step: u32, frames: u64) -> Direction {
        let steps = u64::from(self.substeps * self.steps);
        // As many runs forward as backward.
        let run = match steps / (2 * MIN_RUN) * 2 {
            0 => frames / MIN_RUN.div_ceil(steps),
            runs => u64::from(step) * runs / steps,
        };
        if run % 2 == 1 { Direction::Backward } else { Direction::Forward }
    }
}

/// A time step: the inputs that its stages share.
#[derive(Debug, Clone, Copy)]
pub struct TimeStep<'a, R> {
    /// The input of the frame.
    pub frame: &'a FrameInput,
    /// Passes, sweeps and the length of the step.
    pub schedule: &'a Schedule<R>,
    /// Counted from the start of the frame.
    pub index: u32,
    /// Its interval in the frame.
    pub span: StepInterval,
    /// The direction of its sweeps, in cloths that alternate it.
    pub direction: Direction,
    /// Whether each cloth alternates the direction of its sweeps in this frame.
    pub alternates: &'a [bool],
    /// Upper estimate of the speed of each cloth in this frame, in m/s.
    pub max_speeds: &'a [f64],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::frame::ColliderFrame;
    use crate::schedule::pass::Effect;

    fn frame(substeps: u32, cloth: ClothFrame) -> FrameInput {
        FrameInput { substeps, cloths: vec![cloth], ..FrameInput::default() }
    }

    /// The passes of a step as letters: stretch (s), compress (c), shear (h), bend (b), collider contact (C), cloth
    /// contact (M), angular momentum (J), safeguard (S).
    fn letters(schedule: &Schedule<f64>) -> String {
        let letter = |sweep: &Sweep<f64>| match sweep.effect {
            Effect::Stretch(strength, _) if strength.share.above == 0.0 => 'c',
            Effect::Stretch(..) => 's',
            Effect::Shear(..) => 'h',
            Effect::Bend(..) => 'b',
        };
        let pass = |pass: &Pass| match pass {
            Pass::Constraints(sweeps) => schedule.sweeps[sweeps.clone()].iter().map(letter).collect(),
            Pass::Whole(at) => String::from(match schedule.wholes[*at].effect {
                WholeEffect::Pressure => "P",
                WholeEffect::Shape(_) => "R",
                WholeEffect::Attract(_) => "A",
            }),
            Pass::AngularMomentum(_) => String::from("J"),
            Pass::Links(_) => String::from("L"),
            Pass::Liquid(_) => String::from("Q"),
            Pass::Tethers(_) => String::from("T"),
            Pass::ClothContact => String::from("M"),
            Pass::ColliderContact => String::from("C"),
            Pass::Safeguard => String::from("S"),
        };
        schedule.passes.iter().map(pass).collect()
    }

    // EVIDENCE: N2.2-1  attributes say how often each effect is evaluated
    // EVIDENCE: N2.2-2  effects are interleaved, not run one after the other
    #[test]
    fn effects_are_interleaved_by_their_counts() {
        let cloth = ClothFrame {
            stretch_resistance: 4.0,
            compression_resistance: 2.0,
            shear_resistance: 1.0,
            bend_resistance: 0.0,
            ..ClothFrame::default()
        };
        // Due at 1/8 s, 1/4 c C, 3/8 s, 1/2 h C, 5/8 s, 3/4 c C, 7/8 s, 1 C.
        assert_eq!(letters(&Schedule::new(&frame(1, cloth))), "scCshCscCsC");
    }

    /// A frame of two cloths that collide with each other and with a collider, and have every resistance.
    fn in_contact(substeps: u32, resistance: ResistanceModel) -> FrameInput {
        let cloth = ClothFrame { shear_resistance: 3.0, bend_resistance: 7.0, ..ClothFrame::default() };
        let colliders = vec![ColliderFrame { collide: true, ..ColliderFrame::default() }];
        FrameInput { resistance, cloths: vec![cloth; 2], colliders, ..frame(substeps, cloth) }
    }

    // EVIDENCE: N2.2-4  after the last sweep of a resistance come passes of contact, and the safeguard
    #[test]
    fn a_step_in_contact_ends_with_collision_passes() {
        for substeps in 1..30 {
            for resistance in [ResistanceModel::Classic, ResistanceModel::Physical { evaluations: 50.0 }] {
                let letters = letters(&Schedule::new(&in_contact(substeps, resistance)));
                assert!(letters.contains('b'), "{letters}");
                assert!(letters.ends_with("MCS"), "{substeps} substeps, {resistance:?}: {letters}");
            }
        }
    }

    // EVIDENCE: N2.4-12  10 collision iterations are 5 in each of two substeps, and so are 10 among cloths
    #[test]
    fn collision_iterations_are_shared_among_substeps() {
        for (substeps, passes) in [(1, 10), (2, 5), (5, 2), (10, 1)] {
            let mut input = in_contact(substeps, ResistanceModel::Classic);
            for (own, other, letters) in [(10.0, 1.0, ['C', 'M']), (1.0, 10.0, ['M', 'C'])] {
                (input.collision_iterations, input.self_collision_iterations) = (own, other);
                let schedule = self::letters(&Schedule::new(&input));
                let counts = letters.map(|letter| schedule.chars().filter(|&c| c == letter).count());
                assert_eq!(counts, [passes, 1], "{substeps} substeps: {schedule}");
            }
        }
    }

    #[test]
    fn an_effect_without_resistance_is_never_swept() {
        let cloth = ClothFrame { bend_resistance: 0.0, shear_resistance: 0.0, ..ClothFrame::default() };
        let letters = letters(&Schedule::new(&frame(3, cloth)));
        assert!(!letters.contains(['b', 'h']), "{letters}");
    }
}
