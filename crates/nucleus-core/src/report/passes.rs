//! The passes of a frame: how long their lists are, and how often each is swept. A pass that a scene does not use is
//! absent.

use crate::constraints::angular_momentum::keeps_angular_momentum;
use crate::constraints::damp::Damping;
use crate::constraints::link::pass::rows_of_pass;
use crate::constraints::link::sweep::LinkSweep;
use crate::constraints::liquid::time_step::LiquidMotion;
use crate::contact::cloth::pass::cloth_materials_of;
use crate::contact::material::ContactMaterial;
use crate::input::fields::Field;
use crate::input::frame::{
    BendSolver, Bending, ClothFrame, ColliderFrame, ForceField, FrameInput, PushOut, ResistanceModel,
};
use crate::input::object_fields::PointField;
use crate::input::validation::sanitize;
use crate::integrate::aerodynamics::AirForces;
use crate::integrate::gusts::is_gusty;
use crate::integrate::local_wind::feels_wind;
use crate::math::Real;
use crate::model::ClothModel;
use crate::output::PassCost;
use crate::particles::population::Population;
use crate::particles::slowing::conserved_share;
use crate::schedule::sweep_direction::alternating_cloths;
use crate::schedule::{Effect, Pass, Schedule, WholeEffect};
use crate::solver::Solver;

/// The cost of every pass of a frame; see [`Solver::passes`].
pub fn passes<R: Real>(solver: &Solver<R>, frame: &FrameInput) -> Vec<PassCost> {
    let frame = &*sanitize(frame, solver).0;
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
    let is_free = alternating_cloths(&solver.model.cloths, &solver.contact, &solver.links, frame);
    let kept = schedule.passes.iter().filter_map(|pass| match pass {
        Pass::AngularMomentum(cloth) => Some(*cloth),
        _ => None,
    });
    let cloth = |index: usize| &solver.model.cloths[index];
    let kept = kept.filter(|&at| keeps_angular_momentum(cloth(at), &frame.cloths[at].pressure, is_free[at]));
    let kept = kept.map(|at| cloth(at).points().len()).sum();
    passes.push(PassCost { name: "angular momentum", rows: kept, sweeps: f64::from(steps) });
    let tethered = schedule.passes.iter().filter_map(|pass| match pass {
        Pass::Tethers(cloth) => Some(*cloth).zip(solver.tethers.get(*cloth)),
        _ => None,
    });
    let pinned =
        |of: usize| frame.pins.iter().filter(move |pin| pin.cloth.index() == of).map(|pin| pin.point);
    let tethers = tethered.map(|(of, tethers)| tethers.count(&solver.model.cloths[of], pinned(of))).sum();
    passes.push(PassCost { name: "tethers", rows: tethers, sweeps: f64::from(steps) });
    passes.push(liquid_pass(solver, frame, &schedule));
    passes.extend(whole_passes(solver, frame, &schedule));
    let pass = |sweep: &LinkSweep<R>| {
        let own = |pass: &&Pass| matches!(pass, Pass::Links(at) if schedule.links[*at].constraint == sweep.constraint);
        let sweeps = schedule.passes.iter().filter(own).count() as f64 * f64::from(steps);
        let [rows, times] = rows_of_pass(&solver.links, &solver.model, frame, sweep.constraint);
        PassCost { name: "links", rows, sweeps: sweeps * times as f64 }
    };
    passes.extend(schedule.links.iter().map(pass));
    passes.push(damping_pass(solver, frame, &schedule));
    passes.extend(contact_passes(solver, frame, &schedule));
    let of_field = |field: &Field| -> usize {
        field.targets.iter().map(|(cloth, _)| solver.model.cloths[cloth.index()].points().len()).sum()
    };
    passes.push(PassCost {
        name: "fields",
        rows: frame.fields.iter().map(of_field).sum(),
        sweeps: if frame.fields_per_substep { f64::from(schedule.substeps) } else { 1.0 },
    });
    let slowed = |(cloth, settings): &(&ClothModel<R>, &ClothFrame)| {
        !cloth.has_faces && conserved_share(settings, 1.0, 1.0) < 1.0
    };
    let slowed = solver.model.cloths.iter().zip(&frame.cloths).filter(slowed);
    let slowed: usize = slowed.map(|(cloth, _)| cloth.points().len()).sum();
    passes.push(PassCost { name: "slowing", rows: slowed, sweeps: f64::from(schedule.substeps) });
    let of_ramps = |population: &Population| population.len() * population.ramps().len();
    let ramps = solver.state.populations.iter().map(of_ramps).sum();
    passes.push(PassCost { name: "ramps", rows: ramps, sweeps: f64::from(schedule.substeps) });
    let factors: usize = solver.model.cloths.iter().map(ClothModel::factors).sum::<usize>()
        + solver.contact.material_maps.len();
    let weave = |cloth: &ClothModel<R>| cloth.strength_maps.woven();
    let woven = solver.model.cloths.iter().map(weave).sum();
    let is_physical = matches!(frame.resistance, ResistanceModel::Physical { .. });
    let sweeps = if is_physical { f64::from(steps) } else { 0.0 };
    passes.push(PassCost { name: "weave", rows: woven, sweeps });
    passes.push(PassCost { name: "maps", rows: factors, sweeps: f64::from(steps) });
    passes.retain(|pass| pass.rows > 0 && pass.sweeps > 0.0);
    passes
}

/// The pass that damps: the mean number of its sweeps.
fn damping_pass<R: Real>(solver: &Solver<R>, frame: &FrameInput, schedule: &Schedule<R>) -> PassCost {
    let (mut rows, mut evaluations) = (0, 0.0);
    for (cloth, settings) in
        solver.model.cloths.iter().zip(&frame.cloths).filter(|(cloth, _)| cloth.lists.damp)
    {
        let damping = Damping::new(settings, schedule, frame.resistance);
        if damping.is_felt() {
            rows += cloth.stretch.len();
            evaluations += cloth.stretch.len() as f64 * f64::from(schedule.substeps * damping.times.sweeps);
        }
    }
    PassCost { name: "damp", rows, sweeps: evaluations / rows.max(1) as f64 }
}

/// The pass over liquids: the mean number of their time steps, as they are now.
fn liquid_pass<R: Real>(solver: &Solver<R>, frame: &FrameInput, schedule: &Schedule<R>) -> PassCost {
    let (model, state) = (&solver.model, &solver.state);
    let (mut rows, mut particle_steps) = (0, 0.0);
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        let Some(settings) = &settings.liquid else { continue };
        let points = model.cloths[cloth].points().len();
        rows += points;
        let motion = LiquidMotion { model, state, frame, cloth, settings };
        particle_steps += points as f64 * motion.steps_in_frame(schedule);
    }
    PassCost { name: "liquid", rows, sweeps: particle_steps / rows.max(1) as f64 }
}

/// The cost of effects on whole cloths, of deformation that stays, and of gusts.
fn whole_passes<R: Real>(solver: &Solver<R>, frame: &FrameInput, schedule: &Schedule<R>) -> [PassCost; 9] {
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
        let links = if cloth.lists.plastic && settings.yield_strain.is_finite() {
            cloth.stretch.len() + cloth.shear.len()
        } else {
            0
        };
        match yield_sine <= 1.0 || solver == BendSolver::FlipTracking {
            true => links + cloth.bend_angles.len() + cloth.bend_six_angles.len(),
            false => links,
        }
    };
    let windy = |cloth: &ClothModel<R>, settings: &ClothFrame| match feels_wind(cloth, settings) {
        true => cloth.points().len(),
        false => 0,
    };
    let gusty = if is_gusty(frame) { sum(&windy) } else { 0 };
    let of_cloths =
        |wanted: fn(&ClothFrame) -> bool| frame.cloths.iter().filter(|cloth| wanted(cloth)).count();
    let of_colliders = |wanted: fn(&ColliderFrame) -> bool| {
        frame.colliders.iter().filter(|collider| wanted(collider)).count()
    };
    let shadows = of_cloths(|cloth| cloth.wind_field.casts_shadow())
        + of_colliders(|collider| collider.wind_field.casts_shadow());
    let pushes = of_cloths(|cloth| cloth.wind_field.pushes_air())
        + of_colliders(|collider| collider.wind_field.pushes_air());
    let point_fields_of_colliders =
        of_colliders(|collider| collider.point_field.as_ref().is_some_and(PointField::is_on));
    let in_point_fields = (0..frame.cloths.len()).map(|cloth| {
        // The points of an object are in its own field only where they attract each other.
        let acts = |(at, other): &(usize, &ClothFrame)| {
            other.point_field.is_some_and(|field| {
                field.is_on() && if *at == cloth { field.self_attract != 0.0 } else { field.magnitude != 0.0 }
            })
        };
        let fields = point_fields_of_colliders + frame.cloths.iter().enumerate().filter(acts).count();
        fields * solver.model.cloths[cloth].points().len()
    });
    let in_point_fields = in_point_fields.sum();
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
        PassCost { name: "gusts", rows: gusty, sweeps: f64::from(schedule.substeps) },
        PassCost { name: "wind shadow", rows: shadows * sum(&windy), sweeps: f64::from(schedule.substeps) },
        PassCost { name: "air push", rows: pushes * sum(&windy), sweeps: f64::from(schedule.substeps) },
        PassCost { name: "point field", rows: in_point_fields, sweeps: f64::from(schedule.substeps) },
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
        let factors = |collider| solver.contact.material_maps.max_thickness_factors(cloth, collider);
        let with = |(at, collider)| {
            ContactMaterial::<R>::for_collider(&cloths[cloth], collider, factors(at), frame.layer_range)
        };
        frame.colliders.iter().enumerate().filter_map(with).collect::<Vec<_>>()
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
    let pushers = cloths.iter().map(|cloth| &cloth.push_out);
    let pushes = pushers.chain(frame.colliders.iter().map(|collider| &collider.push_out)).any(PushOut::is_on);
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
        Effect::Stretch(strength, _) if strength.share.above == R::ZERO => name == "compress",
        Effect::Stretch(..) => name == "stretch",
        Effect::Shear(..) => name == "shear",
        Effect::Bend(..) => name == "bend",
    }
}
