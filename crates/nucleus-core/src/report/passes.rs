//! The passes of a frame: how long their lists are, and how often each is swept. A pass that a scene does not use is
//! absent.

use crate::constraints::damp::Damping;
use crate::contact::cloth::pass::cloth_materials_of;
use crate::contact::material::ContactMaterial;
use crate::input::frame::{BendSolver, Bending, ClothFrame, ForceField, FrameInput, PushOut};
use crate::integrate::aerodynamics::AirForces;
use crate::integrate::gusts::is_gusty;
use crate::math::Real;
use crate::model::ClothModel;
use crate::output::PassCost;
use crate::schedule::{Effect, Pass, Schedule, WholeEffect};
use crate::solver::Solver;

/// The cost of every pass of a frame; see [`Solver::passes`].
pub fn passes<R: Real>(solver: &Solver<R>, frame: &FrameInput) -> Vec<PassCost> {
    let schedule = Schedule::<R>::new(frame);
    let steps = schedule.substeps * schedule.steps;
    let points: usize = solver.model.cloths.iter().map(|cloth| cloth.points().len()).sum();
    let mut passes = vec![PassCost { name: "predict", rows: points, sweeps: f64::from(steps) }];
    let breathes = |(cloth, settings)| {
        let cloth: &ClothModel<R> = cloth;
        !cloth.triangles.is_empty() && AirForces::new(frame, settings, cloth.point_mass, schedule.h).is_some()
    };
    let airy = solver.model.cloths.iter().zip(&frame.cloths).filter(|&pair| breathes(pair));
    let in_air: usize = airy.map(|(cloth, _)| cloth.points().len()).sum();
    passes.push(PassCost { name: "air", rows: in_air, sweeps: f64::from(steps) });
    for name in ["stretch", "compress", "shear", "bend"] {
        passes.push(sweeps_of(&solver.model.cloths, name, &schedule));
    }
    let liquid = (0..frame.cloths.len()).filter(|&cloth| frame.cloths[cloth].liquid.is_some());
    let liquid = liquid.map(|cloth| solver.model.cloths[cloth].points().len()).sum();
    passes.push(PassCost { name: "liquid", rows: liquid, sweeps: f64::from(steps) });
    passes.extend(whole_passes(solver, frame, &schedule));
    let damped = |(cloth, settings): &(&ClothModel<R>, &ClothFrame)| {
        let (stretch_damp, damp) = (settings.stretch_damp, settings.damp);
        cloth.damps && Damping { stretch_damp, damp, substep: schedule.h }.is_felt()
    };
    let damped = solver.model.cloths.iter().zip(&frame.cloths).filter(damped);
    let damped_links: usize = damped.map(|(cloth, _)| cloth.stretch.len()).sum();
    passes.push(PassCost { name: "damp", rows: damped_links, sweeps: f64::from(schedule.substeps) });
    passes.extend(contact_passes(solver, frame, &schedule));
    let factors: usize = solver.model.cloths.iter().map(ClothModel::factors).sum::<usize>()
        + solver.contact.material_maps.len();
    passes.push(PassCost { name: "maps", rows: factors, sweeps: f64::from(steps) });
    passes.retain(|pass| pass.rows > 0 && pass.sweeps > 0.0);
    passes
}

/// The cost of effects on whole cloths, of deformation that stays, and of gusts.
fn whole_passes<R: Real>(solver: &Solver<R>, frame: &FrameInput, schedule: &Schedule<R>) -> [PassCost; 6] {
    let steps = f64::from(schedule.substeps * schedule.steps);
    let cost = |name, wanted: fn(&WholeEffect) -> bool, length: fn(&ClothModel<R>) -> usize| {
        let sweeps: Vec<_> = schedule.wholes.iter().filter(|whole| wanted(&whole.effect)).collect();
        let evaluations: usize = sweeps.iter().map(|whole| length(&solver.model.cloths[whole.cloth])).sum();
        let mut cloths: Vec<usize> = sweeps.iter().map(|whole| whole.cloth).collect();
        cloths.sort_unstable();
        cloths.dedup();
        let rows: usize = cloths.iter().map(|&cloth| length(&solver.model.cloths[cloth])).sum();
        PassCost { name, rows, sweeps: evaluations as f64 / rows.max(1) as f64 * steps }
    };
    let sum = |length: &dyn Fn(&ClothModel<R>, &ClothFrame) -> usize| -> usize {
        solver.model.cloths.iter().zip(&frame.cloths).map(|(cloth, settings)| length(cloth, settings)).sum()
    };
    let yields = |cloth: &ClothModel<R>, settings: &ClothFrame| {
        let Bending { yield_sine, solver, .. } = settings.bending;
        let links = if cloth.plastic && settings.yield_strain.is_finite() {
            cloth.stretch.len() + cloth.shear.len()
        } else {
            0
        };
        match yield_sine <= 1.0 || solver == BendSolver::FlipTracking {
            true => links + cloth.bend_angles.len() + cloth.bend_six_angles.len(),
            false => links,
        }
    };
    let gusty = |cloth: &ClothModel<R>, settings: &ClothFrame| match is_gusty(frame) {
        true if settings.feels_wind && !cloth.triangles.is_empty() => cloth.points().len(),
        _ => 0,
    };
    let is_on = |field: Option<ForceField>| field.is_some_and(|field| field.is_on());
    let fields_of_colliders = frame.colliders.iter().filter(|collider| is_on(collider.field)).count();
    let in_fields = (0..frame.cloths.len()).map(|cloth| {
        let others = frame.cloths.iter().enumerate().filter(|(other, _)| *other != cloth);
        let fields = fields_of_colliders + others.filter(|(_, other)| is_on(other.field)).count();
        fields * solver.model.cloths[cloth].points().len()
    });
    let in_fields = in_fields.sum();
    [
        cost("pressure", |effect| *effect == WholeEffect::Pressure, |cloth| cloth.pressure.rows()),
        cost("shape", |effect| matches!(effect, WholeEffect::Shape(_)), |cloth| cloth.shape.rows()),
        cost("attract", |effect| matches!(effect, WholeEffect::Attract(_)), |cloth| cloth.points().len()),
        PassCost { name: "yield", rows: sum(&yields), sweeps: steps },
        PassCost { name: "gusts", rows: sum(&gusty), sweeps: f64::from(schedule.substeps) },
        PassCost { name: "force field", rows: in_fields, sweeps: f64::from(schedule.substeps) },
    ]
}

/// The cost of contact: with colliders, among cloths, with the ground plane; stickiness, restitution and `pushOut`.
fn contact_passes<R: Real>(solver: &Solver<R>, frame: &FrameInput, schedule: &Schedule<R>) -> [PassCost; 6] {
    let steps = f64::from(schedule.substeps * schedule.steps);
    let rounds =
        |wanted: Pass| schedule.passes.iter().filter(|round| **round == wanted).count() as f64 * steps;
    let (cloths, max_thickness_factor) = (&frame.cloths, &solver.contact.material_maps.max_thickness_factor);
    let at_colliders = |cloth: usize| {
        let with = |collider| {
            ContactMaterial::<R>::for_collider(&cloths[cloth], collider, max_thickness_factor[cloth])
        };
        frame.colliders.iter().filter_map(with).collect::<Vec<_>>()
    };
    let on_ground = |cloth: usize| {
        let with =
            |ground| ContactMaterial::<R>::for_ground(&cloths[cloth], ground, max_thickness_factor[cloth]);
        frame.plane.as_ref().and_then(with)
    };
    let each_other = |cloth: usize| match solver.contact.cloth_contacts {
        Some(_) => cloth_materials_of(&solver.contact, frame, cloth),
        None => Vec::new(),
    };
    let elements = |cloth: usize| {
        let boundary = &solver.model.cloths[cloth].boundary;
        boundary.points.len() + boundary.edges.len() + boundary.triangles.len()
    };
    let points = |cloth: usize| solver.model.cloths[cloth].points().len();
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

/// The sweeps of one effect; where cloths differ in their counts, the mean over rows.
fn sweeps_of<R: Real>(cloths: &[ClothModel<R>], name: &'static str, schedule: &Schedule<R>) -> PassCost {
    let (mut rows, mut evaluations) = (vec![false; cloths.len()], 0.0);
    let length = |cloth: usize| match name {
        "shear" => cloths[cloth].shear.len(),
        "bend" => cloths[cloth].bend.len() + cloths[cloth].bend_six.len(),
        _ => cloths[cloth].stretch.len(),
    };
    for sweep in schedule.sweeps.iter().filter(|sweep| named(&sweep.effect, name)) {
        rows[sweep.cloth] = true;
        evaluations += length(sweep.cloth) as f64 * f64::from(schedule.substeps * schedule.steps);
    }
    let rows = (0..cloths.len()).filter(|&cloth| rows[cloth]).map(length).sum::<usize>();
    PassCost { name, rows, sweeps: if rows > 0 { evaluations / rows as f64 } else { 0.0 } }
}

/// Whether an effect has this name. A Classic sweep of links below their rest length is `compress`; a Physical sweep
/// handles both sides and is `stretch`.
fn named<R: Real>(effect: &Effect<R>, name: &str) -> bool {
    match effect {
        Effect::Stretch(strength) if strength.share.above == R::ZERO => name == "compress",
        Effect::Stretch(_) => name == "stretch",
        Effect::Shear(_) => name == "shear",
        Effect::Bend(..) => name == "bend",
    }
}
