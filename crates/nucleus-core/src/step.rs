//! One frame of the solver, stage by stage.
//!
//! A frame has substeps, and a substep has time steps (small steps: Macklin et al. 2019). A time step is one of
//! position-based dynamics (Müller et al. 2007, §3.1), with the interleaved passes of the Nucleus paper (§2.2):
//!
//! 1. **predict**: external forces change velocities, and velocities move points;
//! 2. **passes**: Gauss-Seidel sweeps of the constraints alternate with contact passes, as the [`Schedule`] says;
//! 3. **safeguard**: certifies that no pair of elements passed through each other, else applies fallbacks;
//! 4. **velocities** follow the position corrections;
//! 5. **restitution** adds the rebound of contacts; **collision events** of particles follow.
//!
//! Free points take all of these stages at once ([`crate::particles::free`]).
//!
//! Normals and `pushOut` come once at the start of a substep, the observer once at its end; damping at the end of some time
//! steps, the last of a substep among them.

use std::ops::{ControlFlow, Range};

use crate::constraints::angular_momentum::{keep_angular_momentum, keeps_angular_momentum};
use crate::constraints::damp::damp;
use crate::constraints::link::glue::{break_links, find_pieces, tear_chambers};
use crate::constraints::link::pass::{begin_links, form_links, relax_links};
use crate::constraints::link::surface::slide_links;
use crate::constraints::link::velocity::{apply_link_forces, damp_links, drag_links};
use crate::constraints::liquid::LiquidSolver;
use crate::constraints::liquid::coincident::separate;
use crate::constraints::liquid::step::LiquidScene;
use crate::constraints::sweep::sweep;
use crate::constraints::whole;
use crate::contact::cloth::pass::{
    apply_cloth_adhesion, balance_joined_cloths, begin_cloth_contact, resolve_cloth_contacts,
};
use crate::contact::collider::frame_start::{begin_after_jump, begin_collider_contact, find_near_colliders};
use crate::contact::collider::pass::{apply_collider_adhesion, resolve_collider_contacts};
use crate::contact::collider::start_gaps::record_start_gaps;
use crate::contact::exclusion::update_pair_filter;
use crate::contact::force_field::apply_force_fields;
use crate::contact::ground::carried::count_carried_points;
use crate::contact::point_field::apply_point_fields;
use crate::contact::push_out::{end_push_out, push_out};
use crate::contact::restitution::apply_restitution;
use crate::contact::safeguard::safeguard;
use crate::contact::time_step::ContactCounters;
use crate::fields::update_fields;
use crate::input::frame::{ClothFrame, FrameInput, StartVelocity};
use crate::input::validation::{InvalidInput, sanitize};
use crate::integrate::aerodynamics::update_normals;
use crate::integrate::local_wind::{Objects, update_local_wind};
use crate::integrate::predict::{max_speeds, predict, update_velocities};
use crate::output::StepReport;
use crate::output::{Stage, StepObserver, SubstepIndex};
use crate::particles::events::find_collisions;
use crate::particles::free::{advance_free_points, find_free_objects};
use crate::particles::lifecycle::{age_particles, begin_particles};
use crate::particles::population::Population;
use crate::particles::rotation::turn_particles;
use crate::particles::slowing::conserve_velocities;
use crate::report::diagnostics::report;
use crate::schedule::adaptive::splits;
use crate::schedule::sweep_direction::alternating_cloths;
use crate::schedule::{Pass, PassTime, Schedule, SplitPlans, TimeStep};
use crate::solver::{CompiledReal, Solver};
use crate::state::kinematics::update_anchors;

/// Advances the solver by one frame; see [`Solver::step`].
pub fn step<R: CompiledReal>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    observer: &mut dyn StepObserver,
) -> StepReport {
    let given = frame.births.len();
    let (frame, sanitized) = sanitize(frame, solver);
    let report = match sanitized.first {
        Some(InvalidInput::Duration) => skip_frame(solver, &frame, observer),
        _ => solve_frame(solver, &frame, observer),
    };
    let births_refused = report.births_refused + (given - frame.births.len()) as u64;
    StepReport { sanitized, births_refused, ..report }
}

/// A frame without a valid duration changes nothing, and nothing is born in it.
fn skip_frame<R: CompiledReal>(
    solver: &Solver<R>,
    frame: &FrameInput,
    observer: &mut dyn StepObserver,
) -> StepReport {
    observer.substep(SubstepIndex { substep: 1, substeps: 1 }, solver);
    StepReport { births_refused: frame.births.len() as u64, ..StepReport::default() }
}

fn solve_frame<R: CompiledReal>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    observer: &mut dyn StepObserver,
) -> StepReport {
    let schedule = Schedule::new(frame);
    let mut counters = ContactCounters::default();
    observer.enter(Stage::FrameStart);
    begin_frame(solver, frame, schedule.h);
    *counters.pairs_unresolved.get_mut() +=
        count_carried_points(&solver.contact, &solver.model.cloths, frame);
    if solve_substeps(solver, frame, &schedule, &mut counters, observer).is_break() {
        return StepReport { stopped: true, ..StepReport::default() };
    }
    observer.enter(Stage::Report);
    solver.contact.end_frame();
    solver.state.frames += 1;
    report(solver, frame, &schedule, &counters)
}

/// Moves the anchors to the current positions and reads the motion of pins, colliders and the ground plane: animation
/// is evaluated once per frame and interpolated inside it (§2.4). `h` is the length of a time step in seconds.
fn begin_frame<R: CompiledReal>(solver: &mut Solver<R>, frame: &FrameInput, h: f64) {
    solver.contact.has_touched.iter_mut().for_each(|mark| *mark.get_mut() = false);
    solver.contact.restored_states = None;
    begin_collider_contact(&solver.model, &solver.state, &mut solver.contact, frame);
    begin_cloth_contact(&solver.state, &mut solver.contact, frame);
    find_free_objects(&solver.model, &mut solver.state, &mut solver.contact, &solver.links, frame);
    solver.state.move_anchors();
    solver.state.carry_air(frame);
    solver.state.populations.iter_mut().for_each(Population::begin_frame);
    begin_particles(solver, frame);
    for pin in &frame.pins {
        let cloth = &solver.model.cloths[pin.cloth.index()];
        if pin.point.index() >= cloth.points().len() {
            continue; // a particle that is not alive
        }
        let row = cloth.place(pin.point.index());
        let is_moved_elsewhere = solver.state.pin(row, pin, frame.duration);
        if is_moved_elsewhere {
            solver.contact.invalidate_bounds(row as usize);
        }
    }
    for &StartVelocity { cloth, point, velocity, acceleration } in &frame.velocities {
        let cloth = &solver.model.cloths[cloth.index()];
        if point.index() < cloth.points().len() {
            // A time step moves points by their velocity at its end: over the step, that is the one at its middle.
            let of_step = velocity - acceleration * (h / 2.0);
            solver.state.set_free_velocity(cloth.place(point.index()), of_step);
        }
    }
    for (cloth, settings) in solver.model.cloths.iter().zip(&frame.cloths) {
        if settings.is_driven {
            cloth.points().for_each(|row| solver.state.hold(row));
        }
    }
    separate(&solver.model, &mut solver.state, &mut solver.contact, frame);
    record_start_gaps(&solver.model, &mut solver.state, &mut solver.contact, frame);
    update_anchors(&mut solver.model.cloths, &solver.state.anchor, &solver.pool);
    for (at, motion) in frame.colliders.iter().enumerate() {
        if solver.contact.collider_states[at].begin_frame(&motion.start, &motion.end) {
            begin_after_jump(&mut solver.contact, at);
        }
    }
    find_near_colliders(&solver.model, &solver.state, &mut solver.contact, frame);
    let Solver { model, state, contact, links, .. } = solver;
    let links_changed = form_links(links, model, frame);
    if links_changed {
        find_pieces(&mut model.cloths, links);
    }
    update_pair_filter(contact, (model, state), links, frame, links_changed);
    balance_joined_cloths(contact, links);
    begin_links(links, model, state, contact, frame);
    let anchors = if contact.is_free.contains(&false) { &state.anchor[..] } else { &[] };
    contact.ground.begin_frame(frame.plane.as_ref(), anchors, &contact.pair_filter);
    solver.liquids.iter_mut().for_each(LiquidSolver::begin_frame);
    for (tethers, cloth) in solver.tethers.iter_mut().zip(&solver.model.cloths) {
        tethers.begin_frame(cloth, &solver.state, frame.duration);
    }
}

/// All substeps of a frame, unless the observer ends it before.
fn solve_substeps<R: CompiledReal>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    counters: &mut ContactCounters,
    observer: &mut dyn StepObserver,
) -> ControlFlow<()> {
    let max_speeds = max_speeds(&solver.model.cloths, &solver.state, frame);
    let alternates = alternating_cloths(&solver.model.cloths, &solver.contact, &solver.links, frame);
    let mut plans = SplitPlans::new(schedule);
    for substep in 1..=schedule.substeps {
        observer.enter(Stage::Normals);
        begin_substep(solver, frame, schedule, substep);
        for step in (substep - 1) * schedule.steps..substep * schedule.steps {
            let Solver { model, state, contact, .. } = solver;
            let splits = splits(model, state, contact, frame, schedule, schedule.span(step), &max_speeds);
            let direction = schedule.direction(step, solver.state.frames);
            let split = plans.get(frame, splits);
            for (index, span) in split.time_steps(step) {
                let now = TimeStep {
                    frame,
                    schedule: split,
                    index,
                    span,
                    direction,
                    alternates: &alternates,
                    max_speeds: &max_speeds,
                };
                solve_time_step(solver, &now, counters, observer)?;
            }
            damp_velocities(solver, frame, schedule, step, &alternates);
        }
        end_substep(solver, frame, schedule, substep, counters);
        observer.enter(Stage::Observe);
        observer.substep(SubstepIndex { substep, substeps: schedule.substeps }, solver);
    }
    ControlFlow::Continue(())
}

/// Normals, wind, `pushOut` and force fields, once per substep.
fn begin_substep<R: CompiledReal>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    substep: u32,
) {
    update_normals(&solver.model.cloths, &mut solver.state, frame.resistance, &solver.pool);
    let time = f64::from(substep - 1) / f64::from(schedule.substeps);
    let start = PassTime { at: time, length: frame.duration / f64::from(schedule.substeps) };
    let Solver { model, state, contact, links, surfaces, pool, .. } = solver;
    let objects =
        Objects { cloths: &model.cloths, colliders: (&model.colliders, &contact.collider_states), time };
    update_local_wind(&objects, state, surfaces, frame, pool);
    push_out(model, state, contact, frame, time);
    let scene = (&*model, &contact.collider_states[..]);
    apply_force_fields(scene, state, surfaces, frame, start, pool);
    apply_point_fields(scene, state, frame, start, pool);
    apply_link_forces(links, (model, &contact.collider_states), state, frame, start);
    if substep == 1 || frame.fields_per_substep {
        let interval = if frame.fields_per_substep { start.length } else { frame.duration };
        update_fields(model, state, frame, interval, pool);
    }
}

/// Damps the cloths and links that are due at the end of a time step.
fn damp_velocities<R: CompiledReal>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    step: u32,
    alternates: &[bool],
) {
    let Solver { model, state, contact, links, pool, .. } = solver;
    damp(&model.cloths, state, frame, (schedule, step), alternates, pool);
    damp_links(links, (model, &contact.collider_states), state, frame, (schedule, step));
}

/// Births, deaths, and broken links, once per substep.
fn end_substep<R: CompiledReal>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    substep: u32,
    counters: &mut ContactCounters,
) {
    let substep_length = schedule.h * f64::from(schedule.steps);
    end_push_out(&mut solver.state);
    let end = PassTime { at: f64::from(substep) / f64::from(schedule.substeps), length: substep_length };
    turn_particles(solver, frame, end);
    // Deaths lay links out anew, which forgets their loads.
    let has_broken = {
        let Solver { model, state, contact, links, .. } = &mut *solver;
        break_links(links, (model, &contact.collider_states), state, frame, end)
    };
    if has_broken {
        let Solver { model, state, links, .. } = &mut *solver;
        tear_chambers(&model.cloths, &mut state.chambers, links);
        find_pieces(&mut model.cloths, links);
    }
    let has_lost_links = age_particles(solver, frame, schedule, substep, counters);
    conserve_velocities(&solver.model.cloths, &mut solver.state, frame, substep_length);
    let Solver { model, state, contact, links, .. } = solver;
    if has_broken || has_lost_links {
        update_pair_filter(contact, (model, state), links, frame, true);
    }
    solver.contact.set_time(f64::from(substep) / f64::from(schedule.substeps));
}

/// One time step, unless the observer ends the frame.
fn solve_time_step<R: CompiledReal>(
    solver: &mut Solver<R>,
    now: &TimeStep<'_, R>,
    counters: &mut ContactCounters,
    observer: &mut dyn StepObserver,
) -> ControlFlow<()> {
    let TimeStep { frame, schedule, span, .. } = *now;
    observer.enter(Stage::Predict);
    let is_touchable = frame.plane.is_some()
        || !solver.model.colliders.is_empty()
        || solver.contact.cloth_contacts.is_some();
    let can_touch = is_touchable && solver.contact.is_free.contains(&false);
    solver.state.store_step_start(schedule.h, can_touch, &solver.pool);
    whole::drag_to_input_meshes(&solver.model.cloths, &mut solver.state, frame, schedule.h, &solver.pool);
    let Solver { model, state, contact, links, liquids, pool, .. } = solver;
    for (cloth, liquid) in liquids.iter_mut().enumerate() {
        liquid.begin_step(cloth, model, state, now);
    }
    let seconds_of_forces = |cloth: usize| liquids[cloth].seconds_of_forces(schedule.h);
    predict(&model.cloths, state, now, &contact.is_free, seconds_of_forces, pool);
    drag_links(links, (model, &contact.collider_states), state, frame, schedule.h);
    let models = (&model.cloths[..], &model.colliders[..]);
    slide_links(links, models, state, &contact.collider_states, frame, span.to);
    for pass in &schedule.passes {
        observer.should_continue()?;
        apply_pass(pass, solver, now, counters, observer);
    }
    observer.enter(Stage::Contact);
    let Solver { model, state, contact, pool, .. } = solver;
    advance_free_points((model, state, contact), now, counters, pool);
    whole::remember_deformation(&mut solver.model.cloths, &solver.state, frame, &solver.pool);
    observer.enter(Stage::Velocity);
    let is_free = &solver.contact.is_free;
    update_velocities(&solver.model.cloths, &mut solver.state, schedule.h, is_free, &solver.pool);
    apply_restitution(&mut solver.contact_pass(frame, schedule, span, counters));
    find_collisions(solver, span.to);
    observer.step(span.to, solver);
    ControlFlow::Continue(())
}

/// One pass of a time step.
fn apply_pass<R: CompiledReal>(
    pass: &Pass,
    solver: &mut Solver<R>,
    now: &TimeStep<'_, R>,
    counters: &mut ContactCounters,
    observer: &mut dyn StepObserver,
) {
    let TimeStep { frame, schedule, span, .. } = *now;
    let end = PassTime { at: span.to, length: schedule.h };
    if !matches!(pass, Pass::ClothContact | Pass::ColliderContact | Pass::Safeguard) {
        observer.enter(Stage::Constraints);
    }
    match pass {
        Pass::Constraints(sweeps) => sweep_constraints(solver, now, sweeps.clone()),
        Pass::AngularMomentum(cloth) => restore_angular_momentum(solver, now, *cloth),
        Pass::Whole(at) => {
            let Solver { model, state, pool, .. } = solver;
            whole::relax(&schedule.wholes[*at], &model.cloths, state, frame, end, pool);
        }
        Pass::Tethers(cloth) => relax_tethers(solver, &frame.cloths[*cloth], *cloth),
        Pass::Links(at) => {
            let Solver { model, state, contact, links, pool, .. } = solver;
            let read = (&*model, &contact.collider_states[..], frame);
            relax_links(links, &schedule.links[*at], read, state, end, pool);
        }
        Pass::Liquid(cloth) => {
            let scene = LiquidScene { model: &solver.model, contact: &solver.contact, frame };
            solver.liquids[*cloth].relax(*cloth, scene, &mut solver.state, schedule.h, span, &solver.pool);
        }
        Pass::ClothContact => {
            let pass = &mut solver.contact_pass(frame, schedule, span, counters);
            apply_cloth_adhesion(pass);
            resolve_cloth_contacts(pass, 1.0, observer);
        }
        Pass::ColliderContact => {
            let pass = &mut solver.contact_pass(frame, schedule, span, counters);
            apply_collider_adhesion(pass);
            resolve_collider_contacts(pass, 1.0, observer);
        }
        Pass::Safeguard => safeguard(&mut solver.contact_pass(frame, schedule, span, counters), observer),
    }
}

/// Some sweeps of the constraints of cloth, one after the other.
fn sweep_constraints<R: CompiledReal>(solver: &mut Solver<R>, now: &TimeStep<'_, R>, sweeps: Range<usize>) {
    let Solver { model, state, pool, .. } = solver;
    let columns = [&mut state.displacement[..], &mut state.corrections[..]];
    sweep(&model.cloths, columns, &now.schedule.sweeps[sweeps], (now.direction, now.alternates), pool);
}

/// Gives a cloth the angular momentum back that its sweeps have changed.
fn restore_angular_momentum<R: CompiledReal>(solver: &mut Solver<R>, now: &TimeStep<'_, R>, cloth: usize) {
    let (own, settings) = (&solver.model.cloths[cloth], &now.frame.cloths[cloth]);
    if keeps_angular_momentum(own, &settings.pressure, now.alternates[cloth]) {
        keep_angular_momentum(own, &mut solver.state, now.schedule.h);
    }
}

/// Pulls the points of a cloth back within the reach of their pins.
fn relax_tethers<R: CompiledReal>(solver: &mut Solver<R>, settings: &ClothFrame, cloth: usize) {
    if let (Some(tethers), Some(scale)) = (solver.tethers.get(cloth), settings.tethers) {
        let scale = scale.max(0.0) * settings.rest_length_scale.max(0.0);
        let Solver { model, state, pool, .. } = solver;
        tethers.relax(&model.cloths[cloth], &mut state.displacement, scale, pool);
    }
}
