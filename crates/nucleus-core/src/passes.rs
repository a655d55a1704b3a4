//! The program that a scene compiles to: its passes, how long their lists are, and how often they run.

use crate::air::Breeze;
use crate::constraints::damp::Damping;
use crate::frame::{ClothFrame, FrameInput};
use crate::model::ClothModel;
use crate::scalar::Real;
use crate::schedule::{Effect, Round, Schedule};
use crate::solver::Solver;

/// One list of rows, or one pass over all points, and what a frame spends on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassCost {
    /// The pass, named after what it does: `predict`, `stretch`, `bend`, `collide` ...
    pub name: &'static str,
    /// Rows in its list; for `collide`, what can touch (pairs are found as they arise).
    pub rows: usize,
    /// Visits of the whole list in a frame.
    pub sweeps: f64,
}

impl PassCost {
    /// Row evaluations in a frame.
    pub fn evaluations(&self) -> f64 {
        self.rows as f64 * self.sweeps
    }
}

impl<R: Real> Solver<R> {
    /// The passes a frame consists of. What a scene does not use is not there.
    pub fn passes(&self, frame: &FrameInput) -> Vec<PassCost> {
        let schedule = Schedule::<R>::new(frame);
        let steps = schedule.substeps * schedule.steps;
        let points: usize = self.cloths.iter().map(|cloth| cloth.points().len()).sum();
        let mut passes = vec![PassCost { name: "predict", rows: points, sweeps: f64::from(steps) }];
        let breathes = |(cloth, settings)| {
            let cloth: &ClothModel<R> = cloth;
            !cloth.triangles.is_empty() && Breeze::new(frame, settings, cloth.weight, schedule.h).is_some()
        };
        let airy = self.cloths.iter().zip(&frame.cloths).filter(|&pair| breathes(pair));
        let in_air: usize = airy.map(|(cloth, _)| cloth.points().len()).sum();
        passes.push(PassCost { name: "air", rows: in_air, sweeps: f64::from(steps) });
        for name in ["stretch", "compress", "shear", "bend"] {
            passes.push(self.sweeps_of(name, &schedule));
        }
        let damped = |(cloth, settings): &(&ClothModel<R>, &ClothFrame)| {
            let (stretch_damp, damp) = (settings.stretch_damp, settings.damp);
            cloth.damps && Damping { stretch_damp, damp, substep: schedule.h }.is_felt()
        };
        let damped = self.cloths.iter().zip(&frame.cloths).filter(damped);
        let damped_links: usize = damped.map(|(cloth, _)| cloth.stretch.len()).sum();
        passes.push(PassCost { name: "damp", rows: damped_links, sweeps: f64::from(schedule.substeps) });
        let collisions = schedule.rounds.iter().filter(|round| **round == Round::Collide);
        let count = (collisions.count() * steps as usize) as f64;
        let touching = self
            .pairs
            .iter()
            .filter(|list| frame.cloths[list.cloth].collide && frame.colliders[list.collider].collide);
        let elements = |cloth: usize| {
            let skin = &self.cloths[cloth].skin;
            skin.points.len() + skin.edges.len() + skin.triangles.len()
        };
        passes.push(PassCost {
            name: "collide",
            rows: touching.map(|list| elements(list.cloth)).sum(),
            sweeps: count,
        });
        let grounded = if frame.plane.is_some() { points } else { 0 };
        passes.push(PassCost { name: "ground", rows: grounded, sweeps: count });
        let factors: usize = self.cloths.iter().map(ClothModel::factors).sum::<usize>() + self.maps.len();
        passes.push(PassCost { name: "maps", rows: factors, sweeps: f64::from(steps) });
        passes.retain(|pass| pass.rows > 0 && pass.sweeps > 0.0);
        passes
    }

    /// All sweeps of one effect. Where cloths differ in their counts, the mean over rows.
    fn sweeps_of(&self, name: &'static str, schedule: &Schedule<R>) -> PassCost {
        let (mut rows, mut evaluations) = (vec![false; self.cloths.len()], 0.0);
        let length = |cloth: usize| match name {
            "shear" => self.cloths[cloth].shear.len(),
            "bend" => self.cloths[cloth].bend.len() + self.cloths[cloth].fold.len(),
            _ => self.cloths[cloth].stretch.len(),
        };
        for sweep in schedule.sweeps.iter().filter(|sweep| named(&sweep.effect, name)) {
            rows[sweep.cloth] = true;
            evaluations += length(sweep.cloth) as f64 * f64::from(schedule.substeps * schedule.steps);
        }
        let rows = (0..self.cloths.len()).filter(|&cloth| rows[cloth]).map(length).sum::<usize>();
        PassCost { name, rows, sweeps: if rows > 0 { evaluations / rows as f64 } else { 0.0 } }
    }
}

/// Whether an effect goes by this name. A Classic sweep of links shorter than at rest is `compress`;
/// a Physical one does both sides and is `stretch`.
fn named<R: Real>(effect: &Effect<R>, name: &str) -> bool {
    match effect {
        Effect::Stretch(strength) if strength.share.above == R::ZERO => name == "compress",
        Effect::Stretch(_) => name == "stretch",
        Effect::Shear(_) => name == "shear",
        Effect::Bend(_) => name == "bend",
    }
}
