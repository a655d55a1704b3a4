//! The schedule of a frame, as data: substeps, time steps, and the passes of each.
//!
//! A resistance has two readings, chosen by [`ResistanceModel`]:
//!
//! * **Classic** (§2.2, §2.4 of the Nucleus paper): a count of evaluations in 1/24 s, shared among the substeps. A
//!   substep is one time step. Its sweeps of all effects are interleaved, not run one effect after the other: the k-th
//!   of n sweeps of an effect is due in the middle of the k-th of n equal parts of the substep.
//! * **Physical** (small steps: Macklin et al. 2019): a stiffness. A substep has many time steps, each with one sweep
//!   of every effect, which converges faster than as many sweeps of one step.
//!
//! A time step ends with the contact passes and the safeguard. All time steps of a frame have the same passes, because
//! passes that change from step to step feed energy in. Adaptive substepping splits single time steps
//! ([`Schedule::split`]): `adaptive.rs` finds how often, and the schedule says which passes and intervals that gives.
//!
//! | You want to know… | Read |
//! |---|---|
//! | what a resistance means, how counts are shared among substeps | [`resistance`] |
//! | when a time step is split | `adaptive.rs` |

pub mod adaptive;
pub mod resistance;

use std::borrow::Cow;

use crate::constraints::angle::AngleStrength;
use crate::constraints::bend::BendStrength;
use crate::constraints::link::sweep::LinkSweep;
use crate::constraints::shape::{DEFORM_RATE, RIGID_RATE, ShapeStrength};
use crate::constraints::strength_map::Sides;
use crate::constraints::stretch::LinkStrength;
use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput, Pressure, ResistanceModel};
use crate::input::links::LinkMethod;
use crate::math::Real;
use crate::schedule::resistance::{
    BENDING_PER_RESISTANCE, PhysicalStiffness, STIFFNESS_PER_RESISTANCE, Share, share, steps,
};

/// One sweep of one effect over one cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep<R> {
    /// The cloth, by its index.
    pub cloth: usize,
    /// The effect and its strength.
    pub effect: Effect<R>,
}

/// An effect, with the strength of its sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effect<R> {
    /// Links along edges: stretch, compression or both.
    Stretch(LinkStrength<R>),
    /// Cross links of quads.
    Shear(LinkStrength<R>),
    /// Hinges between faces, and twists of quads.
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

/// One pass of a time step.
#[derive(Debug, Clone, PartialEq)]
pub enum Pass {
    /// A run of [`Schedule::sweeps`], swept together.
    Constraints(std::ops::Range<usize>),
    /// An effect on a whole cloth, of [`Schedule::wholes`].
    Whole(usize),
    /// One pass over the links of a constraint, of [`Schedule::links`].
    Links(usize),
    /// Density, viscosity and surface tension of a liquid, by the index of its cloth.
    Liquid(usize),
    /// One pass over the contacts of cloth with itself and with other cloth.
    ClothContact,
    /// One pass over the contacts with colliders and the ground plane.
    ColliderContact,
    /// The penetration safeguard.
    Safeguard,
}

/// The order of the rows in a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the first to the last.
    Forward,
    /// From the last to the first.
    Backward,
}

/// Least number of time steps with one direction before it alternates.
const MIN_RUN: u32 = 16;

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
    pub fn split(&self, frame: &FrameInput, splits: u32) -> Cow<'_, Self> {
        if splits == self.splits {
            return Cow::Borrowed(self);
        }
        let h = self.h / f64::from(splits);
        let (sweeps, wholes, links, passes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut split = Self { splits, h, sweeps, wholes, links, passes, ..*self };
        split.plan(frame);
        Cow::Owned(split)
    }

    /// The time steps that a time step of the frame is split into, in order: the index of each, counted from the start
    /// of the frame as if all were split alike, and its interval.
    pub fn time_steps(&self, step: u32) -> impl Iterator<Item = (u32, StepInterval)> + use<R> {
        let (span, splits) = (self.span(step), self.splits);
        (0..splits).map(move |k| (step * splits + k, span.part(k, splits)))
    }

    /// Sets the sweeps and passes of a time step.
    fn plan(&mut self, frame: &FrameInput) {
        self.passes = match frame.resistance {
            ResistanceModel::Classic => classic(frame, self.h, &mut self.sweeps, &mut self.wholes),
            ResistanceModel::Physical { .. } => physical(frame, self.h, &mut self.sweeps, &mut self.wholes),
        };
        self.push_outwards(frame);
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
            let contact = |pass: &Pass| matches!(pass, Pass::ClothContact | Pass::ColliderContact);
            let last = self.passes.iter().rposition(|pass| !contact(pass)).map_or(0, |last| last + 1);
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

    /// The direction of the sweeps of a time step, counted from the start of the frame.
    ///
    /// A sweep in a fixed order is not quite symmetric: beside the stiffness it has a small antisymmetric part, which
    /// couples modes and feeds them energy. Where links form odd rings every order has that part, and an undamped cloth
    /// is stirred, from rounding to 1 % of strain within a second. The backward order has the same part with the
    /// opposite sign. In runs of 4 to 32 steps the two cancel, and nothing grows; alternated in every step or two they
    /// excite the cloth at its highest frequencies, and it explodes. A frame of few steps has no room for runs, and
    /// hardly stirs: all its sweeps are forward.
    pub fn direction(&self, step: u32) -> Direction {
        let steps = self.substeps * self.steps;
        // As many runs forward as backward.
        let runs = steps / (2 * MIN_RUN) * 2;
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
    /// Its interval in the frame.
    pub span: StepInterval,
    /// The direction of its sweeps.
    pub direction: Direction,
    /// Upper estimate of the speed of each cloth in this frame, in m/s.
    pub max_speeds: &'a [f64],
}

/// The interval of a time step, in shares of the frame (0 to 1).
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
    /// The `part`th of so many equal parts.
    pub fn part(self, part: u32, parts: u32) -> Self {
        let cut = |part: u32| self.from + (self.to - self.from) * f64::from(part) / f64::from(parts);
        let to = if part + 1 == parts { self.to } else { cut(part + 1) };
        Self { from: cut(part), to, ..self }
    }
}

/// The passes of a Classic substep in the order of their due times: the k-th of n sweeps is due in the middle of the
/// k-th of n equal parts of the substep, the k-th of n contact passes at its end.
fn classic<R: Real>(
    frame: &FrameInput,
    substep: f64,
    sweeps: &mut Vec<Sweep<R>>,
    wholes: &mut Vec<WholeSweep>,
) -> Vec<Pass> {
    let mut due: Vec<(f64, PassOrSweep<R>)> = Vec::new();
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        for (count, effect) in classic_effects(settings) {
            let Share { sweeps, strength } = share(count, substep);
            let effect = effect(R::from_f64(strength));
            let due_time = |k: u32| (f64::from(k) + 0.5) / f64::from(sweeps);
            due.extend((0..sweeps).map(|k| (due_time(k), PassOrSweep::Sweep(Sweep { cloth, effect }))));
        }
        for (count, effect) in classic_wholes(settings, substep) {
            let moment = |k: u32| (f64::from(k) + 0.5) / f64::from(count);
            due.extend((0..count).map(|k| (moment(k), PassOrSweep::Whole(WholeSweep { cloth, effect }))));
        }
    }
    let mut passes = |count: f64, pass: Pass| {
        let passes = share(count, substep).sweeps.max(1);
        due.extend((1..=passes).map(|k| (f64::from(k) / f64::from(passes), PassOrSweep::Pass(pass.clone()))));
    };
    passes(frame.self_collision_iterations, Pass::ClothContact);
    passes(frame.collision_iterations, Pass::ColliderContact);
    due.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut passes = Vec::new();
    for (_, next) in due {
        match next {
            PassOrSweep::Sweep(sweep) => {
                passes.push(Pass::Constraints(sweeps.len()..sweeps.len() + 1));
                sweeps.push(sweep);
            }
            PassOrSweep::Whole(whole) => {
                passes.push(Pass::Whole(wholes.len()));
                wholes.push(whole);
            }
            PassOrSweep::Pass(pass) => passes.push(pass),
        }
    }
    passes
}

/// An entry of the Classic schedule, before sweeps become passes.
enum PassOrSweep<R> {
    Sweep(Sweep<R>),
    Whole(WholeSweep),
    Pass(Pass),
}

/// Makes an effect from its strength.
type EffectOfStrength<R> = Box<dyn Fn(R) -> Effect<R>>;

/// The effects of a cloth with their counts. Stretch and compression sweep the same links, each on its own side of
/// rest.
fn classic_effects<R: Real>(cloth: &ClothFrame) -> [(f64, EffectOfStrength<R>); 4] {
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

/// The passes of a Physical time step: one sweep of every effect, then contact.
///
/// Bending is swept in every step too, although it is soft. Swept in every fourth step with four times the strength, it
/// removes a bend at once, the velocity continues for three steps more, and fine meshes of triangles become noisy.
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

/// One pass over the links of a constraint in a time step of `h` seconds, and the number of such passes.
fn link_sweep<R: Real>(frame: &FrameInput, at: usize, h: f64) -> (LinkSweep<R>, u32) {
    let constraint = &frame.constraints[at];
    let [least, most] = constraint.iterations;
    let is_weld = constraint.method == LinkMethod::Weld;
    let is_classic = frame.resistance == ResistanceModel::Classic;
    let counts = |strength: f64| {
        let own = share(strength.clamp(least, most.max(least)), h);
        if is_weld { Share { sweeps: own.sweeps.max(1), strength: 1.0 } } else { own }
    };
    let sweeps = match is_classic {
        true => {
            counts(constraint.strength.max(constraint.tangent_strength).max(constraint.bend_strength)).sweeps
        }
        false => share(least, h).sweeps,
    };
    let sweeps = sweeps.max(1);
    let soft = |strength: f64, unit: f64| match is_classic {
        // Fewer evaluations than passes are weaker ones.
        true => ((strength * h / COUNT_PERIOD / f64::from(sweeps)).min(1.0), 0.0),
        false if strength > 0.0 => (1.0, 1.0 / (strength * unit * h * h)),
        false => (0.0, 0.0),
    };
    let side = |strength: f64| if is_weld { (1.0, 0.0) } else { soft(strength, STIFFNESS_PER_RESISTANCE) };
    let strength = |(share, compliance): (f64, f64), pulls_only: bool| {
        let both = |x: f64| R::from_f64(x.min(1e30));
        LinkStrength {
            share: Sides { above: both(share), below: if pulls_only { R::ZERO } else { both(share) } },
            compliance: Sides { above: both(compliance), below: both(compliance) },
            rest_scale: R::ONE,
        }
    };
    let pulls_only = constraint.method == LinkMethod::RubberBand;
    let [normal, tangent] =
        [constraint.strength, constraint.tangent_strength].map(|own| strength(side(own), pulls_only));
    let bend = strength(soft(constraint.bend_strength, BENDING_PER_RESISTANCE), false);
    (LinkSweep { constraint: at, normal, tangent, bend }, sweeps)
}

fn angle_strength<R: Real>(cloth: &ClothFrame) -> AngleStrength<R> {
    AngleStrength {
        scale: R::from_f64(cloth.bending.angle_scale),
        dropoff: R::from_f64(cloth.bending.angle_dropoff.clamp(0.0, 1.0)),
    }
}

/// The strength of links with these stiffnesses in N/m; a side without stiffness is not corrected.
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

/// 1 / (stiffness h²), bounded so that it is finite in `f32`: a resistance that is keyed down to zero passes through
/// all sizes.
fn compliance<R: Real>(stiffness: f64, h: f64) -> R {
    const MAX_COMPLIANCE: f64 = 1e30;
    R::from_f64((1.0 / (stiffness * h * h)).min(MAX_COMPLIANCE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::frame::ColliderFrame;

    fn frame(substeps: u32, cloth: ClothFrame) -> FrameInput {
        FrameInput { substeps, cloths: vec![cloth], ..FrameInput::default() }
    }

    /// The passes of a step as letters: stretch (s), compress (c), shear (h), bend (b), collider contact (C), cloth
    /// contact (M), safeguard (S).
    fn letters(schedule: &Schedule<f64>) -> String {
        let letter = |sweep: &Sweep<f64>| match sweep.effect {
            Effect::Stretch(strength) if strength.share.above == 0.0 => 'c',
            Effect::Stretch(_) => 's',
            Effect::Shear(_) => 'h',
            Effect::Bend(..) => 'b',
        };
        let pass = |pass: &Pass| match pass {
            Pass::Constraints(sweeps) => schedule.sweeps[sweeps.clone()].iter().map(letter).collect(),
            Pass::Whole(at) => String::from(match schedule.wholes[*at].effect {
                WholeEffect::Pressure => "P",
                WholeEffect::Shape(_) => "R",
                WholeEffect::Attract(_) => "A",
            }),
            Pass::Links(_) => String::from("L"),
            Pass::Liquid(_) => String::from("Q"),
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
