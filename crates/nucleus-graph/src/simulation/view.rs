//! The states of several nuclei, seen as one.

use std::ops::ControlFlow;

use nalgebra::Vector3;
use nucleus_core::{ClothId, ColliderId, ContactState, Real, Stage, StateView, StepObserver, SubstepIndex};

use crate::compile::{Program, Universe};

use super::Simulation;

/// The states of all nuclei, by the ids of the program.
pub(super) struct View<'a> {
    pub(super) program: &'a Program,
    /// One per nucleus.
    pub(super) parts: Vec<&'a dyn StateView>,
}

impl View<'_> {
    fn cloth(&self, cloth: ClothId) -> (&dyn StateView, ClothId, &Universe) {
        let universes = self.program.universes();
        let k =
            universes.iter().position(|universe| universe.cloths().contains(&cloth.0)).unwrap_or_default();
        (self.parts[k], ClothId(cloth.0 - universes[k].cloths().start), &universes[k])
    }

    fn collider(&self, collider: ColliderId) -> (&dyn StateView, ColliderId, &Universe) {
        let universes = self.program.universes();
        let k = universes.iter().position(|universe| universe.colliders().contains(&collider.0));
        let k = k.unwrap_or_default();
        (self.parts[k], ColliderId(collider.0 - universes[k].colliders().start), &universes[k])
    }

    /// Units are asked for as those of the first nucleus; others may have another scale.
    fn units(&self, asked: f64, universe: &Universe) -> f64 {
        let (own, first) = (universe.units_per_metre(), self.program.units_per_metre());
        if own == first { asked } else { asked * (own / first) }
    }
}

impl StateView for View<'_> {
    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let (part, id, universe) = self.cloth(cloth);
        part.positions(id, self.units(units_per_metre, universe), out);
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let (part, id, universe) = self.cloth(cloth);
        part.velocities(id, self.units(units_per_metre, universe), out);
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        out.clear();
        let mut own = Vec::new();
        for (part, universe) in self.parts.iter().zip(self.program.universes()) {
            part.contacts(&mut own);
            // Each has its place, also behind one that knows nothing.
            out.resize(universe.cloths().start as usize, Vec::new());
            out.append(&mut own);
        }
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let (part, id, universe) = self.collider(collider);
        part.collider_positions(id, self.units(units_per_metre, universe), out);
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        let (part, id, _) = self.collider(collider);
        part.collider_moved(id)
    }

    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        let (part, id, _) = self.collider(collider);
        part.collider_points(id, share, out);
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        let (part, id, _) = self.cloth(cloth);
        part.point(id, point)
    }
}

impl<R: Real> StateView for Simulation<R> {
    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.view().positions(cloth, units_per_metre, out);
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.view().velocities(cloth, units_per_metre, out);
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        self.view().contacts(out);
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.view().collider_positions(collider, units_per_metre, out);
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.view().collider_moved(collider)
    }

    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        self.view().collider_points(collider, share, out);
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        self.view().point(cloth, point)
    }
}

/// Shows the substeps of one nucleus as part of a frame in which there are more. Nuclei that are still to be
/// solved are shown as they were.
pub(super) struct Merge<'a> {
    pub(super) watch: &'a mut dyn StepObserver,
    /// Substeps of the frame that are over.
    pub(super) done: u32,
    /// Substeps of the nucleus that is solved.
    pub(super) own: u32,
    /// All substeps of the frame.
    pub(super) total: u32,
    /// The nucleus that is solved.
    pub(super) universe: usize,
    /// The others.
    pub(super) others: Vec<&'a dyn StateView>,
    pub(super) program: &'a Program,
}

impl<'a> Merge<'a> {
    /// The states of all nuclei, with that of the one that is solved.
    fn parts<'b>(&self, state: &'b dyn StateView) -> Vec<&'b dyn StateView>
    where
        'a: 'b,
    {
        let mut parts: Vec<&'b dyn StateView> =
            self.others.iter().map(|other| *other as &'b dyn StateView).collect();
        parts.insert(self.universe, state);
        parts
    }
}

impl StepObserver for Merge<'_> {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        let parts = self.parts(state);
        let moment = SubstepIndex { substep: self.done + moment.substep, substeps: self.total };
        self.watch.substep(moment, &View { program: self.program, parts });
    }

    fn step(&mut self, share: f64, state: &dyn StateView) {
        let parts = self.parts(state);
        let share = (f64::from(self.done) + share * f64::from(self.own)) / f64::from(self.total);
        self.watch.step(share, &View { program: self.program, parts });
    }

    fn should_continue(&self) -> ControlFlow<()> {
        self.watch.should_continue()
    }

    fn enter(&mut self, stage: Stage) {
        self.watch.enter(stage);
    }
}
