//! Nuclei presented as one, in the time of the scene: their states, the observer of their substeps, and their reports.

use std::cell::RefCell;
use std::ops::ControlFlow;

use nalgebra::Vector3;
use nucleus_core::{
    ClothId, ColliderId, ContactState, Particle, ParticleLook, Sanitized, Stage, StateView, StepObserver,
    StepReport, SubstepIndex,
};

use crate::compile::{NucleusProgram, Program};

use super::idle_colliders::{IdleColliders, WithIdle};
use super::substep_merge::SubstepMerge;

/// The states of all nuclei, by the ids of the program. Velocities are per second of the scene.
pub(super) struct CombinedState<'a> {
    pub(super) program: &'a Program,
    /// One per nucleus.
    pub(super) parts: Vec<WithIdle<'a>>,
    /// Solver seconds per second of the scene, one per nucleus.
    pub(super) rates: Vec<f64>,
    /// The nucleus that is being solved, and the share of its evaluation interval that has passed. All others are at the
    /// end of theirs.
    pub(super) solving: Option<(usize, f64)>,
}

impl CombinedState<'_> {
    fn cloth(&self, cloth: ClothId) -> (&dyn StateView, ClothId, &NucleusProgram) {
        let (k, own) = self.program.locate_cloth(cloth);
        (&self.parts[k], own, &self.program.nuclei()[k])
    }

    fn collider(&self, collider: ColliderId) -> (&dyn StateView, ColliderId, &NucleusProgram) {
        let (k, own) = self.program.locate_collider(collider);
        (&self.parts[k], own, &self.program.nuclei()[k])
    }

    /// Converts scene units per metre from the first nucleus to another.
    fn units(&self, asked: f64, nucleus: &NucleusProgram) -> f64 {
        let (own, first) = (nucleus.units_per_metre(), self.program.units_per_metre());
        if own == first { asked } else { asked * (own / first) }
    }
}

impl StateView for CombinedState<'_> {
    fn object_counts(&self) -> Option<[usize; 2]> {
        let counts = self.parts.iter().map(|part| part.object_counts());
        counts.reduce(|all, own| all.zip(own).map(|([a, b], [c, d])| [a + c, b + d])).flatten()
    }

    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let (part, id, nucleus) = self.cloth(cloth);
        part.positions(id, self.units(units_per_metre, nucleus), out);
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let (part, id, nucleus) = self.cloth(cloth);
        let (nucleus_index, _) = self.program.locate_cloth(cloth);
        part.velocities(id, self.units(units_per_metre, nucleus) * self.rates[nucleus_index], out);
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        out.clear();
        let mut own = Vec::new();
        for (part, nucleus) in self.parts.iter().zip(self.program.nuclei()) {
            part.contacts(&mut own);
            // A nucleus without contact states leaves its cloths empty.
            out.resize(nucleus.cloths().start as usize, Vec::new());
            out.append(&mut own);
        }
    }

    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        let (part, id, _) = self.cloth(cloth);
        part.looks(id, out);
    }

    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        let (part, id, _) = self.cloth(cloth);
        part.orientations(id, out);
    }

    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        let (part, id, _) = self.cloth(cloth);
        part.particles(id, out);
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let (part, id, nucleus) = self.collider(collider);
        part.collider_positions(id, self.units(units_per_metre, nucleus), out);
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        let (part, id, _) = self.collider(collider);
        part.collider_moved(id)
    }

    /// `share` is that of the frame; a solver moves its colliders over the evaluation interval.
    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        let (k, id) = self.program.locate_collider(collider);
        let own = self.solving.map_or(share, |(solving, own)| if solving == k { own } else { 1.0 });
        self.parts[k].collider_points(id, own, out);
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        let (part, id, _) = self.cloth(cloth);
        part.point(id, point)
    }
}

/// Presents the substeps of one nucleus as substeps of the whole frame. Nuclei that are solved later in the frame keep
/// their previous state.
pub(super) struct CombinedObserver<'a> {
    pub(super) watch: &'a mut dyn StepObserver,
    /// Completed substeps of the frame.
    pub(super) done: u32,
    /// Substeps of this nucleus.
    pub(super) own: u32,
    /// All substeps of the frame.
    pub(super) total: u32,
    /// Index of this nucleus.
    pub(super) nucleus: usize,
    /// Its colliders in the evaluations of the frame that are not solved.
    pub(super) idle: &'a IdleColliders,
    /// The states of the other nuclei, in order.
    pub(super) others: Vec<WithIdle<'a>>,
    /// Solver seconds per second of the scene, of all nuclei.
    pub(super) rates: Vec<f64>,
    /// The substeps of the frame, where they are merged by time.
    pub(super) merge: Option<&'a RefCell<SubstepMerge>>,
    pub(super) program: &'a Program,
}

impl<'a> CombinedObserver<'a> {
    /// The states of all nuclei; `own` is that of this one.
    fn parts<'b>(&self, own: WithIdle<'b>) -> Vec<WithIdle<'b>>
    where
        'a: 'b,
    {
        let mut parts: Vec<WithIdle<'b>> = self.others.clone();
        parts.insert(self.nucleus, own);
        parts
    }
}

impl StepObserver for CombinedObserver<'_> {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        let in_frame = SubstepIndex { substep: self.done + moment.substep, substeps: self.total };
        let own = WithIdle { state, idle: self.idle, ends_frame: in_frame.ends_frame() };
        if let Some(merge) = self.merge {
            merge.borrow_mut().capture(self.nucleus, moment, &own, self.rates[self.nucleus]);
        }
        let parts = self.parts(own);
        let solving = Some((self.nucleus, f64::from(moment.substep) / f64::from(moment.substeps)));
        let rates = self.rates.clone();
        self.watch.substep(in_frame, &CombinedState { program: self.program, parts, rates, solving });
    }

    fn step(&mut self, share: f64, state: &dyn StateView) {
        let parts = self.parts(WithIdle { state, idle: self.idle, ends_frame: false });
        let solving = Some((self.nucleus, share));
        let share = (f64::from(self.done) + share * f64::from(self.own)) / f64::from(self.total);
        let rates = self.rates.clone();
        self.watch.step(share, &CombinedState { program: self.program, parts, rates, solving });
    }

    fn should_continue(&self) -> ControlFlow<()> {
        self.watch.should_continue()
    }

    fn observes_substeps(&self) -> bool {
        self.watch.observes_substeps()
    }

    fn enter(&mut self, stage: Stage) {
        self.watch.enter(stage);
    }
}

/// The invalid values of two inputs, of which `a` is the earlier.
fn combined_sanitized(a: Sanitized, b: Sanitized) -> Sanitized {
    Sanitized { count: a.count + b.count, first: a.first.or(b.first) }
}

/// A report with the invalid results of expressions, and the births that emitters did not make.
pub(super) fn with_evaluation(
    report: StepReport,
    invalid_results: Sanitized,
    births_refused: u64,
) -> StepReport {
    StepReport {
        sanitized: combined_sanitized(report.sanitized, invalid_results),
        births_refused: report.births_refused.saturating_add(births_refused),
        ..report
    }
}

/// Combines two reports: of two nuclei over the same time, or of two consecutive times. Gaps and strains are the worst of
/// both, and counts of events are added. Of consecutive times, a quantity of the state is that of the later one.
pub(super) fn combined_report(a: &StepReport, b: &StepReport, are_consecutive: bool) -> StepReport {
    StepReport {
        max_strain: a.max_strain.max(b.max_strain),
        strain_99: a.strain_99.max(b.strain_99),
        min_gap: a.min_gap.min(b.min_gap),
        min_cloth_gap: a.min_cloth_gap.min(b.min_cloth_gap),
        rest_limited: if are_consecutive { b.rest_limited } else { a.rest_limited + b.rest_limited },
        contacts: a.contacts + b.contacts,
        candidate_pairs: a.candidate_pairs + b.candidate_pairs,
        broad_phases: a.broad_phases + b.broad_phases,
        pairs_reverted: a.pairs_reverted + b.pairs_reverted,
        pairs_unresolved: a.pairs_unresolved + b.pairs_unresolved,
        depenetrating: if are_consecutive { b.depenetrating } else { a.depenetrating + b.depenetrating },
        intersections: if are_consecutive { b.intersections } else { a.intersections + b.intersections },
        particles: if are_consecutive { b.particles } else { a.particles + b.particles },
        births: a.births + b.births,
        deaths: a.deaths + b.deaths,
        births_refused: a.births_refused.saturating_add(b.births_refused),
        births_pruned: a.births_pruned + b.births_pruned,
        density_error: if are_consecutive { b.density_error } else { a.density_error.max(b.density_error) },
        kinetic_energy: if are_consecutive { b.kinetic_energy } else { a.kinetic_energy + b.kinetic_energy },
        broken_links: if are_consecutive { b.broken_links } else { a.broken_links + b.broken_links },
        max_weld_gap: a.max_weld_gap.max(b.max_weld_gap),
        finite: a.finite && b.finite,
        sanitized: combined_sanitized(a.sanitized, b.sanitized),
        stopped: a.stopped || b.stopped,
    }
}
