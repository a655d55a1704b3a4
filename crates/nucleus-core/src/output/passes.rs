//! The program that a scene compiles to: its passes, how long their lists are, and how often they run.

use crate::constraints::damp::Damping;
use crate::contact::material::ContactMaterial;
use crate::input::frame::{ClothFrame, FrameInput, PushOut};
use crate::integrate::aerodynamics::AirForces;
use crate::math::Real;
use crate::model::ClothModel;
use crate::schedule::{Effect, Pass, Schedule};
use crate::solver::Solver;

/// One list of rows, or one pass over all points, and what a frame spends on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassCost {
    /// The pass, named after what it does: `predict`, `stretch`, `bend`, `collider contact`, `cloth contact` ...
    pub name: &'static str,
    /// Rows in its list; for `collider contact` and `cloth contact`, what can touch (pairs are found as they arise).
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
        R::passes(self, frame)
    }

    pub(crate) fn list_passes(&self, frame: &FrameInput) -> Vec<PassCost> {
        let schedule = Schedule::<R>::new(frame);
        let steps = schedule.substeps * schedule.steps;
        let points: usize = self.cloths.iter().map(|cloth| cloth.points().len()).sum();
        let mut passes = vec![PassCost { name: "predict", rows: points, sweeps: f64::from(steps) }];
        let breathes = |(cloth, settings)| {
            let cloth: &ClothModel<R> = cloth;
            !cloth.triangles.is_empty() && AirForces::new(frame, settings, cloth.weight, schedule.h).is_some()
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
        passes.extend(self.contact_passes(frame, &schedule));
        let factors: usize =
            self.cloths.iter().map(ClothModel::factors).sum::<usize>() + self.material_maps.len();
        passes.push(PassCost { name: "maps", rows: factors, sweeps: f64::from(steps) });
        passes.retain(|pass| pass.rows > 0 && pass.sweeps > 0.0);
        passes
    }

    /// What is spent on contact: with colliders, among what moves, with the ground, and on what contact does besides.
    fn contact_passes(&self, frame: &FrameInput, schedule: &Schedule<R>) -> [PassCost; 6] {
        let steps = f64::from(schedule.substeps * schedule.steps);
        let rounds =
            |wanted: Pass| schedule.passes.iter().filter(|round| **round == wanted).count() as f64 * steps;
        let (cloths, max_thickness_factor) = (&frame.cloths, &self.material_maps.max_thickness_factor);
        let at_colliders = |cloth: usize| {
            let with = |collider| {
                ContactMaterial::<R>::for_collider(&cloths[cloth], collider, max_thickness_factor[cloth])
            };
            frame.colliders.iter().filter_map(with).collect::<Vec<_>>()
        };
        let on_ground = |cloth: usize| {
            let with = |ground| {
                ContactMaterial::<R>::for_ground(&cloths[cloth], ground, max_thickness_factor[cloth])
            };
            frame.plane.as_ref().and_then(with)
        };
        let each_other = |cloth: usize| match self.cloth_contacts {
            Some(_) => self.cloth_materials_of(frame, cloth),
            None => Vec::new(),
        };
        let elements = |cloth: usize| {
            let boundary = &self.cloths[cloth].boundary;
            boundary.points.len() + boundary.edges.len() + boundary.triangles.len()
        };
        let points = |cloth: usize| self.cloths[cloth].points().len();
        let all = 0..cloths.len();
        let with_any = |does: fn(&ContactMaterial<R>) -> bool| -> usize {
            let of = |cloth: &usize| {
                let mut terms = at_colliders(*cloth);
                terms.extend(on_ground(*cloth));
                terms.extend(each_other(*cloth));
                terms.iter().any(does)
            };
            all.clone().filter(of).map(points).sum()
        };
        let pushed_out = |push_out: &PushOut| push_out.share != 0.0;
        let pushers = cloths.iter().map(|cloth| &cloth.push_out);
        let pushes = pushers.chain(frame.colliders.iter().map(|collider| &collider.push_out)).any(pushed_out);
        let collide = rounds(Pass::ColliderContact);
        [
            PassCost {
                name: "collider contact",
                rows: all.clone().map(|cloth| elements(cloth) * at_colliders(cloth).len()).sum(),
                sweeps: collide,
            },
            PassCost {
                name: "cloth contact",
                rows: all.clone().filter(|&cloth| !each_other(cloth).is_empty()).map(elements).sum(),
                sweeps: rounds(Pass::ClothContact),
            },
            PassCost {
                name: "ground",
                rows: all.clone().filter(|&cloth| on_ground(cloth).is_some()).map(points).sum(),
                sweeps: collide,
            },
            PassCost { name: "stick", rows: with_any(ContactMaterial::has_adhesion), sweeps: collide },
            PassCost { name: "bounce", rows: with_any(ContactMaterial::has_restitution), sweeps: steps },
            PassCost {
                name: "push out",
                rows: if pushes { all.map(points).sum() } else { 0 },
                sweeps: f64::from(schedule.substeps),
            },
        ]
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
