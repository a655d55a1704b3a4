//! The order of things within a frame: substeps, time steps, and the sweeps of each, as data.
//!
//! Effects are interleaved, not run one after the other, each as often as its resistance says (§2.2), and
//! the last pass of a step is always collision. Classic: a substep is one time step with many sweeps.
//! Physical: a substep is many time steps with one sweep of each effect.

mod adaptive;
pub mod resistance;

use std::borrow::Cow;

use crate::constraints::angle::AngleStrength;
use crate::constraints::bend::BendStrength;
use crate::constraints::shape::{DEFORM_RATE, RIGID_RATE, ShapeStrength};
use crate::constraints::strength_map::Sides;
use crate::constraints::stretch::LinkStrength;
use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput, Pressure, ResistanceModel};
use crate::math::Real;
use crate::schedule::resistance::{PhysicalStiffness, Share, share, steps};

/// One pass of one effect over one cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep<R> {
    /// The cloth, by its index.
    pub cloth: usize,
    /// What is swept.
    pub effect: Effect<R>,
}

/// What a sweep does, and how strongly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effect<R> {
    /// Links along edges: stretch, compression or both.
    Stretch(LinkStrength<R>),
    /// Cross links of quads.
    Shear(LinkStrength<R>),
    /// Hinges between faces.
    Bend(BendStrength<R>, AngleStrength<R>),
}

/// One pass of an effect that takes a cloth as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WholeSweep {
    /// The cloth, by its index.
    pub cloth: usize,
    /// What is done.
    pub effect: WholeEffect,
}

/// Effects that take a cloth as a whole, not row by row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WholeEffect {
    /// Gas inside pushes the faces.
    Pressure,
    /// The mesh is pulled back to its shape.
    Shape(ShapeStrength),
    /// Points are drawn to the input mesh, by this share of the way; by a spring where there is none.
    Attract(Option<f64>),
}

/// What comes next in a time step.
#[derive(Debug, Clone, PartialEq)]
pub enum Pass {
    /// These sweeps together, a run of [`Schedule::sweeps`].
    Constraints(std::ops::Range<usize>),
    /// An effect on a whole cloth, of [`Schedule::wholes`].
    Whole(usize),
    /// A pass over contacts of cloth with itself and other cloth.
    ClothContact,
    /// A pass over contacts with colliders and the plane.
    ColliderContact,
    /// The proof that nothing passed anything.
    Safeguard,
}

/// Which way the rows of a list are swept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the first to the last.
    Forward,
    /// From the last to the first.
    Backward,
}

/// Time steps that are swept one way before the direction turns, at least.
const RUN: u32 = 16;

/// Everything a frame will do.
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
    /// The rounds of a time step: the same in every one, for sweeps that change would feed energy in.
    pub passes: Vec<Pass>,
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
        let (sweeps, wholes, passes) = (Vec::new(), Vec::new(), Vec::new());
        let mut schedule = Self { substeps, steps, splits: 1, h, sweeps, wholes, passes };
        schedule.plan(frame);
        schedule
    }

    /// The plan of a time step that is split into so many (adaptive substepping): the passes of each, at their length.
    pub fn split(&self, frame: &FrameInput, splits: u32) -> Cow<'_, Self> {
        if splits == self.splits {
            return Cow::Borrowed(self);
        }
        let h = self.h / f64::from(splits);
        let (sweeps, wholes, passes) = (Vec::new(), Vec::new(), Vec::new());
        let mut split = Self { splits, h, sweeps, wholes, passes, ..*self };
        split.plan(frame);
        Cow::Owned(split)
    }

    /// The time steps that a time step of the frame is split into, in order: the index of each, counted from the start of
    /// the frame as if all were split alike, and its interval.
    pub fn time_steps(&self, step: u32) -> impl Iterator<Item = (u32, StepInterval)> + use<R> {
        let (span, splits) = (self.span(step), self.splits);
        (0..splits).map(move |k| (step * splits + k, span.part(k, splits)))
    }

    /// Sets the sweeps and rounds of a time step.
    fn plan(&mut self, frame: &FrameInput) {
        self.passes = match frame.resistance {
            ResistanceModel::Classic => classic(frame, self.h, &mut self.sweeps, &mut self.wholes),
            ResistanceModel::Physical { .. } => physical(frame, self.h, &mut self.sweeps, &mut self.wholes),
        };
        self.push_outwards(frame);
        let meets = |cloth: &ClothFrame| cloth.self_collision.on;
        let is_mutual = frame.cloths.len() > 1 || frame.cloths.iter().any(meets);
        if !is_mutual {
            self.passes.retain(|round| *round != Pass::ClothContact);
        }
        if is_mutual || frame.colliders.iter().any(|collider| collider.collide) {
            self.passes.push(Pass::Safeguard);
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

    /// When in the frame a time step is.
    pub fn span(&self, step: u32) -> StepInterval {
        let steps = f64::from(self.substeps * self.steps);
        let end_of_substep = f64::from(step / self.steps + 1) / f64::from(self.substeps);
        StepInterval { from: f64::from(step) / steps, to: f64::from(step + 1) / steps, end_of_substep }
    }

    /// Which way a time step sweeps, counted from the start of the frame.
    ///
    /// A sweep in a fixed order is not quite symmetric: beside the stiffness it has a small part that turns modes
    /// into each other, and feeds them. Where links close odd rings that part is there in every order, and an
    /// undamped cloth is stirred, from rounding to 1 % of strain within a second. The order backward has the same
    /// part with the other sign. Taken in runs of 4 to 32 steps the two cancel, and nothing grows; turned in every
    /// step or two they drive the cloth at its own high tones, and it explodes. A frame of few steps has no room
    /// for runs, and hardly stirs: it is swept one way.
    pub fn direction(&self, step: u32) -> Direction {
        let steps = self.substeps * self.steps;
        // As many runs one way as the other.
        let runs = steps / (2 * RUN) * 2;
        let run = u64::from(step) * u64::from(runs) / u64::from(steps);
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
    /// When in the frame it is.
    pub span: StepInterval,
    /// The direction of its sweeps.
    pub direction: Direction,
    /// Upper estimate of the speed of each cloth in this frame, in m/s.
    pub max_speeds: &'a [f64],
}

/// When a time step is, in shares of the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepInterval {
    /// Its start.
    pub from: f64,
    /// Its end.
    pub to: f64,
    /// The end of the substep it is part of.
    pub end_of_substep: f64,
}

impl StepInterval {
    /// One of so many equal parts.
    pub fn part(self, part: u32, parts: u32) -> Self {
        let cut = |part: u32| self.from + (self.to - self.from) * f64::from(part) / f64::from(parts);
        let to = if part + 1 == parts { self.to } else { cut(part + 1) };
        Self { from: cut(part), to, ..self }
    }
}

/// All passes of a substep in the order of the moments at which they are due: the k-th of n sweeps in the
/// middle of its n-th part, the k-th of n collision passes at the end of its.
fn classic<R: Real>(
    frame: &FrameInput,
    substep: f64,
    sweeps: &mut Vec<Sweep<R>>,
    wholes: &mut Vec<WholeSweep>,
) -> Vec<Pass> {
    let mut due: Vec<(f64, Due<R>)> = Vec::new();
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        for (count, effect) in classic_effects(settings) {
            let Share { sweeps, strength } = share(count, substep);
            let effect = effect(R::from_f64(strength));
            let moment = |k: u32| (f64::from(k) + 0.5) / f64::from(sweeps);
            due.extend((0..sweeps).map(|k| (moment(k), Due::Sweep(Sweep { cloth, effect }))));
        }
        for (count, effect) in classic_wholes(settings, substep) {
            let moment = |k: u32| (f64::from(k) + 0.5) / f64::from(count);
            due.extend((0..count).map(|k| (moment(k), Due::Whole(WholeSweep { cloth, effect }))));
        }
    }
    let mut passes = |count: f64, round: Pass| {
        let passes = share(count, substep).sweeps.max(1);
        due.extend((1..=passes).map(|k| (f64::from(k) / f64::from(passes), Due::Pass(round.clone()))));
    };
    passes(frame.self_collision_iterations, Pass::ClothContact);
    passes(frame.collision_iterations, Pass::ColliderContact);
    due.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut rounds = Vec::new();
    for (_, next) in due {
        match next {
            Due::Sweep(sweep) => {
                rounds.push(Pass::Constraints(sweeps.len()..sweeps.len() + 1));
                sweeps.push(sweep);
            }
            Due::Whole(whole) => {
                rounds.push(Pass::Whole(wholes.len()));
                wholes.push(whole);
            }
            Due::Pass(round) => rounds.push(round),
        }
    }
    rounds
}

/// What is due at a moment of a substep.
enum Due<R> {
    Sweep(Sweep<R>),
    Whole(WholeSweep),
    Pass(Pass),
}

/// What makes an effect of a strength.
type Strengthen<R> = Box<dyn Fn(R) -> Effect<R>>;

/// The effects of a cloth with their counts. Stretch and compression sweep the same links, each its own side.
fn classic_effects<R: Real>(cloth: &ClothFrame) -> [(f64, Strengthen<R>); 4] {
    let rest_scale = R::from_f64(cloth.rest_length_scale);
    let rigid = Sides { above: R::ZERO, below: R::ZERO };
    let angles = angle_strength(cloth);
    let links = move |above: R, below: R| LinkStrength {
        share: Sides { above, below },
        compliance: rigid,
        rest_scale,
    };
    [
        (cloth.stretch_resistance, Box::new(move |share| Effect::Stretch(links(share, R::ZERO)))),
        (cloth.compression_resistance, Box::new(move |share| Effect::Stretch(links(R::ZERO, share)))),
        (cloth.shear_resistance, Box::new(move |share| Effect::Shear(links(share, share)))),
        (
            cloth.bend_resistance,
            Box::new(move |share| Effect::Bend(BendStrength { share, compliance: R::ZERO }, angles)),
        ),
    ]
}

/// The effects on a whole cloth with their counts in a substep.
fn classic_wholes(cloth: &ClothFrame, substep: f64) -> Vec<(u32, WholeEffect)> {
    let mut wholes = Vec::new();
    for (count, rigid) in [(cloth.rigidity, true), (cloth.deform_resistance, false)] {
        let Share { sweeps, strength } = share(count, substep);
        let [rigid, deform] = if rigid { [strength, 0.0] } else { [0.0, strength] };
        wholes.push((sweeps, WholeEffect::Shape(ShapeStrength { rigid, deform })));
    }
    if cloth.input_attract.strength > 0.0 {
        // 1 goes all the way however short the substep; small shares add up to theirs in 1/24 s.
        let (all, part) = (cloth.input_attract.strength.min(1.0), substep / COUNT_PERIOD);
        wholes.push((1, WholeEffect::Attract(Some(all * part / (1.0 - all + all * part)))));
    }
    wholes
}

/// One sweep of every effect, then collision.
///
/// Bending too is swept in every step, although it is soft: swept in every fourth for four, it takes away a
/// bend at once, the velocity carries on for three steps more, and fine meshes of triangles boil.
fn physical<R: Real>(
    frame: &FrameInput,
    h: f64,
    sweeps: &mut Vec<Sweep<R>>,
    wholes: &mut Vec<WholeSweep>,
) -> Vec<Pass> {
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        let mut add = |stiffness: f64, effect: Effect<R>| {
            if stiffness > 0.0 {
                sweeps.push(Sweep { cloth, effect });
            }
        };
        let PhysicalStiffness { stretch, compression, shear, bend } = PhysicalStiffness::of(settings);
        let links = |above: f64, below: f64| physical_links(settings, above, below, h);
        add(stretch.max(compression), Effect::Stretch(links(stretch, compression)));
        add(shear, Effect::Shear(links(shear, shear)));
        let compliance = compliance(bend, h);
        add(bend, Effect::Bend(BendStrength { share: R::ONE, compliance }, angle_strength(settings)));
    }
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        let share = |rate: f64, resistance: f64| {
            let stiff = rate * rate * resistance.max(0.0) * h * h;
            stiff / (1.0 + stiff)
        };
        let rigid = share(RIGID_RATE, settings.rigidity);
        let deform = share(DEFORM_RATE, settings.deform_resistance);
        if rigid > 0.0 || deform > 0.0 {
            wholes.push(WholeSweep { cloth, effect: WholeEffect::Shape(ShapeStrength { rigid, deform }) });
        }
        if settings.input_attract.strength > 0.0 {
            wholes.push(WholeSweep { cloth, effect: WholeEffect::Attract(None) });
        }
    }
    let mut passes = vec![Pass::Constraints(0..sweeps.len())];
    passes.extend((0..wholes.len()).map(Pass::Whole));
    passes.extend([Pass::ClothContact, Pass::ColliderContact]);
    passes
}

fn angle_strength<R: Real>(cloth: &ClothFrame) -> AngleStrength<R> {
    AngleStrength {
        scale: R::from_f64(cloth.bending.angle_scale),
        dropoff: R::from_f64(cloth.bending.angle_dropoff.clamp(0.0, 1.0)),
    }
}

/// Links as stiff as two numbers in N/m say; a side without stiffness is left alone.
fn physical_links<R: Real>(cloth: &ClothFrame, above: f64, below: f64, h: f64) -> LinkStrength<R> {
    let side = |stiffness: f64| match stiffness > 0.0 {
        true => (R::ONE, compliance(stiffness, h)),
        false => (R::ZERO, R::ZERO),
    };
    let (above, below) = (side(above), side(below));
    LinkStrength {
        share: Sides { above: above.0, below: below.0 },
        compliance: Sides { above: above.1, below: below.1 },
        rest_scale: R::from_f64(cloth.rest_length_scale),
    }
}

/// 1 / (stiffness h²), but never so much that it is no number in `f32`: a resistance that is keyed down to
/// nought passes through all sizes.
fn compliance<R: Real>(stiffness: f64, h: f64) -> R {
    const SOFTEST: f64 = 1e30;
    R::from_f64((1.0 / (stiffness * h * h)).min(SOFTEST))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::frame::ColliderFrame;

    fn frame(substeps: u32, cloth: ClothFrame) -> FrameInput {
        FrameInput { substeps, cloths: vec![cloth], ..FrameInput::default() }
    }

    /// The rounds of a step as letters: stretch, compress, shear, bend, Collide.
    fn letters(schedule: &Schedule<f64>) -> String {
        let letter = |sweep: &Sweep<f64>| match sweep.effect {
            Effect::Stretch(strength) if strength.share.above == 0.0 => 'c',
            Effect::Stretch(_) => 's',
            Effect::Shear(_) => 'h',
            Effect::Bend(..) => 'b',
        };
        let round = |round: &Pass| match round {
            Pass::Constraints(sweeps) => schedule.sweeps[sweeps.clone()].iter().map(letter).collect(),
            Pass::Whole(at) => String::from(match schedule.wholes[*at].effect {
                WholeEffect::Pressure => "P",
                WholeEffect::Shape(_) => "R",
                WholeEffect::Attract(_) => "A",
            }),
            Pass::ClothContact => String::from("M"),
            Pass::ColliderContact => String::from("C"),
            Pass::Safeguard => String::from("S"),
        };
        schedule.passes.iter().map(round).collect()
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

    /// A frame of two cloths that meet each other and a collider, and have every resistance.
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
    fn what_has_no_resistance_is_never_swept() {
        let cloth = ClothFrame { bend_resistance: 0.0, shear_resistance: 0.0, ..ClothFrame::default() };
        let letters = letters(&Schedule::new(&frame(3, cloth)));
        assert!(!letters.contains(['b', 'h']), "{letters}");
    }
}
