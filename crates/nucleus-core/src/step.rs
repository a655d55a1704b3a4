//! One frame, told as a story.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::Ordering;

use crate::constraints::damp::{self, Damping};
use crate::constraints::sweep;
use crate::contact::time_step::ContactCounters;
use crate::input::frame::FrameInput;
use crate::input::validation::InvalidInput;
use crate::integrate::aerodynamics::{self, AirForces};
use crate::integrate::predict::{self, Columns, Drive, gravity_kick};
use crate::integrate::velocities;
use crate::math::{Real, Row4};
use crate::output::observer::{Stage, StepObserver, SubstepIndex};
use crate::output::report::StepReport;
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Direction, Pass, Schedule, Span};
use crate::solver::Solver;
use crate::state::State;

/// A time step: what is done in it, which it is, and when.
struct Step<'a, R> {
    schedule: &'a Schedule<R>,
    index: u32,
    span: Span,
    direction: Direction,
}

impl<R: Real> Solver<R> {
    /// Advances by one frame. Cannot fail: what could not be satisfied, or is no number, is counted in the report.
    ///
    /// `frame` has one entry per cloth and per collider.
    pub fn step(&mut self, frame: &FrameInput, watch: &mut dyn StepObserver) -> StepReport {
        R::step(self, frame, watch)
    }

    pub(crate) fn take_step(&mut self, frame: &FrameInput, watch: &mut dyn StepObserver) -> StepReport {
        let (frame, sanitized) = self.usable(frame);
        let report = match sanitized.first {
            Some(InvalidInput::Duration) => self.pass_over(watch),
            _ => self.solve(&frame, watch),
        };
        StepReport { sanitized, ..report }
    }

    /// A frame in which no time passes: all stays as it is.
    fn pass_over(&mut self, watch: &mut dyn StepObserver) -> StepReport {
        watch.substep(SubstepIndex { substep: 1, substeps: 1 }, self);
        StepReport::default()
    }

    /// One frame of finite numbers.
    fn solve(&mut self, frame: &FrameInput, watch: &mut dyn StepObserver) -> StepReport {
        let schedule = Schedule::new(frame);
        let mut counters = ContactCounters::default();
        if self.substeps(frame, &schedule, &mut counters, watch).is_break() {
            return StepReport { stopped: true, ..StepReport::default() };
        }
        watch.enter(Stage::Report);
        self.touches = counters.contacts.load(Ordering::Relaxed) > 0;
        self.report(frame, &schedule, &counters)
    }

    /// All substeps of a frame, unless the observer ends it before.
    fn substeps(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        counters: &mut ContactCounters,
        watch: &mut dyn StepObserver,
    ) -> ControlFlow<()> {
        watch.enter(Stage::FrameStart);
        self.begin_frame(frame); // animation is taken up once per frame, and interpolated inside (§2.4)
        let max_speed = self.max_speed(frame);
        // What is held or lies on something would tremble under sweeps that turn: not converged, each way has a
        // balance of its own. Only what flies freely can be stirred for long.
        let is_free = frame.pins.is_empty() && !self.touches;
        for substep in 1..=schedule.substeps {
            watch.enter(Stage::Normals);
            self.find_normals();
            self.push_out(frame, f64::from(substep - 1) / f64::from(schedule.substeps));
            for step in (substep - 1) * schedule.steps..substep * schedule.steps {
                let span = schedule.span(step);
                let direction = if is_free { schedule.direction(step) } else { Direction::Forward };
                let splits = self.splits(frame, schedule, span, &max_speed);
                if splits == 1 {
                    let now = Step { schedule, index: step, span, direction };
                    self.advance(frame, &now, &max_speed, counters, watch)?;
                    continue;
                }
                let split = schedule.split(frame, splits);
                for split_index in 0..splits {
                    let (index, span) = (step * splits + split_index, span.part(split_index, splits));
                    let now = Step { schedule: &split, index, span, direction };
                    self.advance(frame, &now, &max_speed, counters, watch)?;
                }
            }
            self.damp(frame, schedule);
            self.set_time(f64::from(substep) / f64::from(schedule.substeps));
            watch.enter(Stage::Observe);
            watch.substep(SubstepIndex { substep, substeps: schedule.substeps }, self);
        }
        ControlFlow::Continue(())
    }

    /// One time step, unless the observer ends the frame.
    fn advance(
        &mut self,
        frame: &FrameInput,
        now: &Step<'_, R>,
        max_speed: &[f64],
        counters: &mut ContactCounters,
        watch: &mut dyn StepObserver,
    ) -> ControlFlow<()> {
        let Step { schedule, index, span, direction } = *now;
        watch.enter(Stage::Predict);
        self.store_step_start(frame, schedule.h);
        self.predict(frame, schedule, max_speed, index); // gravity, wind, drag; inertia
        for round in &schedule.passes {
            watch.should_continue()?;
            match round {
                Pass::Constraints(sweeps) => {
                    watch.enter(Stage::Constraints);
                    sweep::sweep(self, &schedule.sweeps[sweeps.clone()], direction);
                }
                Pass::ClothContact => {
                    self.apply_cloth_adhesion(frame, schedule, span, counters);
                    self.resolve_cloth_contacts(1.0, frame, schedule, span, counters, watch);
                }
                Pass::ColliderContact => {
                    self.apply_collider_adhesion(frame, schedule, span, counters);
                    self.resolve_collider_contacts(1.0, frame, schedule, span, counters, watch);
                }
                Pass::Safeguard => self.safeguard(frame, schedule, span, counters, watch), // the last word
            }
        }
        watch.enter(Stage::Velocity);
        self.update_velocities(schedule);
        self.apply_restitution(frame, schedule, span);
        watch.step(span.to, self);
        ControlFlow::Continue(())
    }

    /// Keeps the places that points have before a time step moves them, where they can meet anything.
    fn store_step_start(&mut self, frame: &FrameInput, h: f64) {
        // Of the last step, and of what may be no more: a plane that is keyed off.
        self.state.depenetration_by_collider.clear();
        self.state.depenetration_by_cloth.clear();
        self.state.step_length = h;
        if frame.plane.is_some() || !self.colliders.is_empty() || self.cloth_contacts.is_some() {
            let State { start, depenetration_by_collider, depenetration_by_cloth, displacement, .. } =
                &mut self.state;
            start.clone_from(displacement);
            depenetration_by_collider.resize(start.len(), Row4::ZERO);
            depenetration_by_cloth.resize(start.len(), Row4::ZERO);
        }
    }

    /// The largest speed that each cloth can have in this frame, about: the grain that gravity is given in.
    fn max_speed(&self, frame: &FrameInput) -> Vec<f64> {
        let of_cloth = |points: Range<u32>| {
            let rows = &self.state.velocity[points.start as usize..points.end as usize];
            let speeds = rows.iter().map(|row| row.xyz().map(R::to_f64));
            let most = speeds.flatten().fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most });
            most + frame.gravity.amax() * frame.duration
        };
        self.cloths.iter().map(|cloth| of_cloth(cloth.points())).collect()
    }

    /// Normals for the air, once per substep.
    fn find_normals(&mut self) {
        let Self { cloths, state, pool, .. } = self;
        let (anchor, displacement) = (&state.anchor, &state.displacement);
        let position = |row: u32| {
            let (anchor, moved) = (anchor[row as usize], displacement[row as usize].0);
            [0, 1, 2].map(|axis| anchor[axis] + moved[axis].to_f64())
        };
        let normals = DisjointSlice::new(&mut state.normal);
        for cloth in cloths.iter() {
            pool.parallel_for(cloth.triangles.len(), |block| {
                // SAFETY: blocks do not overlap.
                #[allow(unsafe_code)]
                unsafe {
                    aerodynamics::find_normals(
                        normals,
                        cloth.blocks.range(block),
                        &cloth.triangles[block],
                        position,
                    );
                }
            });
        }
    }

    fn predict(&mut self, frame: &FrameInput, schedule: &Schedule<R>, max_speed: &[f64], step: u32) {
        let Self { cloths, state, pool, .. } = self;
        let columns = Columns {
            displacement: DisjointSlice::new(&mut state.displacement),
            velocity: DisjointSlice::new(&mut state.velocity),
            predicted: DisjointSlice::new(&mut state.predicted),
            normal: &state.normal,
        };
        for ((cloth, settings), &max_speed) in cloths.iter().zip(&frame.cloths).zip(max_speed) {
            let gravity = gravity_kick(frame.gravity.into(), schedule.h, step, max_speed);
            let air_forces = AirForces::new(frame, settings, cloth.weight, schedule.h);
            let drive = Drive {
                gravity: if settings.feels_gravity { gravity } else { [R::ZERO; 3] },
                impulse: <[f64; 3]>::from(settings.local_force * schedule.h).map(R::from_f64),
                air_forces: air_forces.filter(|_| !cloth.triangles.is_empty()),
                factors: &[],
                h: R::from_f64(schedule.h),
            };
            pool.parallel_for(cloth.blocks.len(), |block| {
                let points = cloth.blocks.range(block);
                let drive = Drive { factors: cloth.air_factors(&points), ..drive };
                // SAFETY: blocks do not overlap.
                #[allow(unsafe_code)]
                unsafe {
                    predict::move_points(&columns, points, &drive);
                }
            });
        }
    }

    fn update_velocities(&mut self, schedule: &Schedule<R>) {
        let Self { cloths, state, pool, .. } = self;
        let (displacement, predicted) =
            (DisjointSlice::new(&mut state.displacement), DisjointSlice::new(&mut state.predicted));
        let (depenetration_by_collider, velocity) = (
            [&state.depenetration_by_collider[..], &state.depenetration_by_cloth[..]],
            DisjointSlice::new(&mut state.velocity),
        );
        let h = R::from_f64(schedule.h);
        for cloth in cloths.iter() {
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            pool.parallel_for(cloth.blocks.len(), |block| unsafe {
                velocities::update_velocities(
                    [displacement, predicted, velocity],
                    depenetration_by_collider,
                    cloth.blocks.range(block),
                    h,
                );
            });
        }
    }

    fn damp(&mut self, frame: &FrameInput, schedule: &Schedule<R>) {
        let Self { cloths, state, pool, .. } = self;
        let substep = schedule.h * f64::from(schedule.steps);
        let velocity = DisjointSlice::new(&mut state.velocity);
        for (cloth, settings) in cloths.iter().zip(&frame.cloths).filter(|(cloth, _)| cloth.damps) {
            let damping = Damping { stretch_damp: settings.stretch_damp, damp: settings.damp, substep };
            if !damping.is_felt() {
                continue;
            }
            sweep::over_list(pool, &cloth.blocks, &cloth.stretch, |part| {
                let (links, factors) = (cloth.stretch.part(part), cloth.shares.damp.part(part));
                // SAFETY: inner rows of two blocks, and cross rows of one colour, share no point.
                #[allow(unsafe_code)]
                unsafe {
                    damp::relax(velocity, &state.displacement, links, factors, &damping);
                }
            });
        }
    }
}
