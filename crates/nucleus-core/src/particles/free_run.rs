//! A time step of a run of free points: all stages, in buffers that fit into the nearest cache.
//!
//! 1. The points **move** by their velocity and external forces.
//! 2. The **ground** pushes them, then **colliders** push those near them. A point that a collider pushes into the ground is
//!    pushed by the two in turn, by the ground last.
//! 3. The **safeguard** certifies that no point has passed a collider, and applies fallbacks to those without certificate.
//! 4. **Velocities** follow the corrections, and points **rebound**.

use std::ops::Range;
use std::sync::atomic::Ordering;

use crate::contact::collider::near_collider::NearCollider;
use crate::contact::collider::near_points::NearPoints;
use crate::contact::fallbacks::{Attempt, Fallback, TRUNCATIONS, attempts_for_free_points};
use crate::contact::ground::GroundContact;
use crate::contact::response::{Impact, Restitution};
use crate::contact::time_step::{ColliderStep, PositionWriter};
use crate::math::{Lanes, Real, Row4, add, sub};
use crate::particles::free_pass::FreePass;

/// Turns of colliders and the ground at a point that they push into each other.
const TURNS: usize = 8;

/// Points of a run: their buffers fit into the nearest cache.
const RUN: usize = 128;

/// The buffers of a run of points.
struct Buffers<R> {
    start: [Row4<R>; RUN],
    predicted: [Row4<R>; RUN],
    depenetration: [Row4<R>; RUN],
    bearing: [Row4<R>; RUN],
    heights: [[R; RUN]; 2],
}

impl<R: Real> Buffers<R> {
    fn new() -> Self {
        let rows = [Row4::ZERO; RUN];
        let heights = [[R::ZERO; RUN]; 2];
        Self { start: rows, predicted: rows, depenetration: rows, bearing: rows, heights }
    }
}

impl<R: Real> FreePass<'_, R> {
    /// All stages of the time step for the points of a task.
    pub fn advance(&self, points: Range<u32>, near: &mut NearPoints<R>) {
        let mut buffers = Buffers::new();
        near.begin();
        for first in points.clone().step_by(RUN) {
            self.advance_run(first..points.end.min(first + RUN as u32), &mut buffers, near);
        }
        if near.counters.contacts.load(Ordering::Relaxed) > 0 {
            self.contact.has_touched[self.cloth].store(true, Ordering::Relaxed);
        }
    }

    fn advance_run(&self, rows: Range<u32>, buffers: &mut Buffers<R>, near: &mut NearPoints<R>) {
        let Buffers { start, predicted, depenetration, bearing, heights: [at_start, at_end] } = buffers;
        let (count, displacement) = (rows.len(), self.prediction.columns.displacement);
        // SAFETY: tasks do not overlap, nor do their runs.
        #[allow(unsafe_code)]
        unsafe {
            start[..count].copy_from_slice(displacement.run(rows.clone()));
            self.prediction.move_points(rows.clone(), &mut predicted[..count]);
        }
        if self.plane.is_none() && !self.has_colliders {
            return;
        }
        depenetration[..count].fill(Row4::ZERO);
        bearing[..count].fill(Row4::ZERO);
        let anchors = &self.anchors[rows.start as usize..rows.end as usize];
        self.contact.ground.heights_of(anchors, [&mut at_start[..count], &mut at_end[..count]]);
        let writer =
            PositionWriter::of_run(displacement, [depenetration, bearing], &predicted[..count], rows.start);
        let heights = [&at_start[..count], &at_end[..count]];
        Run { pass: self, writer, rows, start: &start[..count], heights }.advance(near);
    }
}

/// A run of points within a task.
struct Run<'a, R: Real> {
    pass: &'a FreePass<'a, R>,
    rows: Range<u32>,
    writer: PositionWriter<'a, R>,
    start: &'a [Row4<R>],
    heights: [&'a [R]; 2],
}

impl<R: Real> Run<'_, R> {
    /// The stages behind the move.
    fn advance(&self, near: &mut NearPoints<R>) {
        let contacts = near.counters.contacts.load(Ordering::Relaxed);
        near.begin_run();
        self.touch(near);
        let is_pressed = near.counters.contacts.load(Ordering::Relaxed) > contacts;
        if near.is_empty() && !is_pressed && !self.ground_holds() {
            return;
        }
        self.safeguard(near);
        self.update_velocities();
        self.rebound(near);
        self.list_displaced(near);
    }

    /// Whether the ground may correct points that it does not push.
    fn ground_holds(&self) -> bool {
        self.pass.plane.as_ref().is_some_and(|(_, material)| material.has_adhesion() || material.grips)
    }

    /// Sweeps over contact with the ground and with colliders.
    fn touch(&self, near: &mut NearPoints<R>) {
        for sweep in 0..self.pass.sweeps {
            self.push_by_ground(sweep == 0, near);
            // A ground that holds points moves those that are not near as well.
            if sweep == 0 || self.ground_holds() {
                near.begin_search();
                self.find_near_points(near);
            }
            if near.is_empty() {
                continue;
            }
            for (at, collider) in self.pass.colliders() {
                near.adhere(at, &collider, &self.step(&collider));
            }
            self.push_by_colliders(None, 1.0, near);
            for k in 0..near.len() {
                self.take_turns(near.point(k), near);
            }
        }
    }

    /// Finds the points that come near colliders in this step, by the bound of the run first.
    fn find_near_points(&self, near: &mut NearPoints<R>) {
        if !self.pass.has_colliders {
            return;
        }
        let bound = self.bound();
        for (at, collider) in self.pass.colliders().filter(|(_, collider)| collider.reaches(bound)) {
            near.find(at, &collider, &self.step(&collider), self.rows.clone());
        }
        if !near.is_empty() && self.pass.colliders().nth(1).is_some() {
            near.begin_following();
            for (at, collider) in self.pass.colliders() {
                near.follow(at, &collider, &self.step(&collider));
            }
        }
    }

    /// A box around the motion of all points in this step, in metres: around their anchors, and around their displacements.
    fn bound(&self) -> [[f64; 3]; 2] {
        let anchors = &self.pass.anchors[self.rows.start as usize..self.rows.end as usize];
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for anchor in anchors {
            for axis in 0..3 {
                low[axis] = if anchor[axis] < low[axis] { anchor[axis] } else { low[axis] };
                high[axis] = if anchor[axis] > high[axis] { anchor[axis] } else { high[axis] };
            }
        }
        let mut moved = [self.start[0].lanes(); 2];
        for (start, point) in self.start.iter().zip(self.rows.clone()) {
            let (start, end) = (start.lanes(), self.writer.row(point).lanes());
            moved = [moved[0].least(start).least(end), moved[1].most(start).most(end)];
        }
        let moved = moved.map(|lanes| Row4(lanes.to_array()).xyz().map(R::to_f64));
        [add(low, moved[0]), add(high, moved[1])]
    }

    /// Pushes the points above the ground, after adhesion. Without adhesion one sweep is exact.
    fn push_by_ground(&self, is_first: bool, near: &mut NearPoints<R>) {
        let Some(ground) = self.ground(1.0) else { return };
        let has_adhesion = ground.material.has_adhesion();
        if has_adhesion {
            ground.adhere(self.rows.clone());
        }
        if is_first || self.ground_holds() {
            *near.counters.contacts.get_mut() += ground.resolve(self.rows.clone());
        }
    }

    /// One sweep over the contacts with colliders, with a factor on their thickness; of one point only, if it is given.
    fn push_by_colliders(&self, only: Option<u32>, thickness_scale: f64, near: &mut NearPoints<R>) {
        for (at, collider) in self.pass.colliders() {
            let step = self.step(&collider).with_thickness_scale(thickness_scale);
            near.resolve(at, only, &collider, &step);
        }
    }

    /// The ground and colliders push a point in turn, if colliders have pushed it into the ground.
    fn take_turns(&self, point: u32, near: &mut NearPoints<R>) {
        let Some(ground) = self.ground(1.0) else { return };
        for _ in 0..TURNS {
            if !ground.is_pressed(point) {
                return;
            }
            self.push_by_colliders(Some(point), 1.0, near);
            *near.counters.contacts.get_mut() += ground.resolve(point..point + 1);
        }
    }

    /// Certifies the contacts of all points near colliders, and applies the fallbacks to those without certificate.
    fn safeguard(&self, near: &mut NearPoints<R>) {
        for (at, collider) in self.pass.colliders() {
            let [_, inseparable] = near.certify(at, None, &collider, &self.step(&collider));
            *near.counters.pairs_unresolved.get_mut() += inseparable;
        }
        near.begin_fallbacks();
        while let Some(point) = near.next_unproven() {
            let unresolved = self.apply_fallbacks(point, near);
            *near.counters.pairs_unresolved.get_mut() += unresolved;
        }
        if self.pass.now.span.to >= 1.0 {
            for (at, collider) in self.pass.colliders() {
                near.measure(at, &self.step(&collider));
            }
        }
    }

    /// Applies the fallbacks to a point until it has its certificates and is above the ground. Returns the number of contacts
    /// of which that fails.
    fn apply_fallbacks(&self, point: u32, near: &mut NearPoints<R>) -> u64 {
        let mut unproven = 0;
        for Attempt { fallback, number, thickness_scale } in attempts_for_free_points() {
            match fallback {
                Fallback::Push => self.push_by_colliders(Some(point), thickness_scale, near),
                Fallback::Truncate | Fallback::Freeze => self.revert(point, near),
            }
            // In the last attempts the ground does not push any more, and only the surface moves the point.
            let ground_pushes = fallback == Fallback::Push || number < TRUNCATIONS / 2;
            let has_passed_ground = match self.ground(thickness_scale) {
                Some(ground) if ground_pushes => {
                    ground.resolve(point..point + 1);
                    false
                }
                ground => ground.is_some_and(|ground| ground.has_passed(point)),
            };
            unproven = self.certify(point, near) + u64::from(has_passed_ground);
            if unproven == 0 {
                break;
            }
        }
        unproven
    }

    /// Moves a point with the surfaces of its contacts without certificate.
    fn revert(&self, point: u32, near: &mut NearPoints<R>) {
        for (at, collider) in self.pass.colliders() {
            near.revert(at, point, &self.step(&collider));
        }
    }

    /// The number of contacts of a point without certificate.
    fn certify(&self, point: u32, near: &mut NearPoints<R>) -> u64 {
        let of = |(at, collider): (usize, NearCollider<'_, R>)| {
            near.certify(at, Some(point), &collider, &self.step(&collider))[0]
        };
        self.pass.colliders().map(of).sum()
    }

    /// Velocities follow the corrections.
    fn update_velocities(&self) {
        let columns = &self.pass.prediction.columns;
        let per_h = R::Lanes::splat(R::ONE / self.pass.restitution.h);
        for point in self.rows.clone() {
            let corrected = self.writer.correction(point);
            // SAFETY: the point belongs to this task.
            #[allow(unsafe_code)]
            unsafe {
                let velocity = columns.velocity.get(point).lanes() + corrected * per_h;
                columns.velocity.set(point, Row4(velocity.to_array()));
            }
        }
    }

    /// Lists the points that contact has displaced without velocity, with their motion in this step in m/s.
    fn list_displaced(&self, near: &mut NearPoints<R>) {
        let per_h = R::ONE / self.pass.restitution.h;
        for (point, start) in self.rows.clone().zip(self.start) {
            if self.writer.depenetration(point) != [R::ZERO; 3] {
                let moved = sub(self.writer.row(point).xyz(), start.xyz());
                near.displaced.push((point, moved.map(|x| x * per_h)));
            }
        }
    }

    /// Restitution at the ground and at colliders.
    fn rebound(&self, near: &NearPoints<R>) {
        let velocity = self.pass.prediction.columns.velocity;
        if let Some(ground) = self.ground(1.0).filter(|ground| ground.material.has_restitution()) {
            for point in self.rows.clone() {
                self.rebound_from_ground(point, &ground);
            }
        }
        let is_elastic = |(_, collider): &(_, NearCollider<'_, R>)| collider.args.material.has_restitution();
        for (at, collider) in self.pass.colliders().filter(is_elastic) {
            near.rebound(at, &self.step(&collider), self.pass.restitution, velocity, self.pass.frame);
        }
    }

    fn rebound_from_ground(&self, point: u32, ground: &GroundContact<'_, R>) {
        let (columns, row) = (&self.pass.prediction.columns, self.writer.row(point));
        let (of_point, material) = (([point], [], &([R::ONE], [])), &ground.material);
        let thickness = material.thickness_at(
            &self.pass.contact.material_maps,
            of_point,
            R::from_f64(material.thickness),
        );
        let coefficient = material.bounce_at(&self.pass.contact.material_maps, of_point);
        let touches = Restitution::touches(ground.plane.height_now(point, row.xyz()), thickness);
        if !touches || coefficient <= R::ZERO || row.0[3] <= R::ZERO {
            return;
        }
        let friction = material.impact_friction_at(&self.pass.contact.material_maps, of_point);
        let restitution = Restitution { coefficient, friction, ..self.pass.restitution };
        let surface = ground.plane.velocity(point, row.xyz(), restitution.h);
        // SAFETY: the point belongs to this task.
        #[allow(unsafe_code)]
        unsafe {
            let velocity = columns.velocity.get(point).xyz();
            let impact =
                Impact { predicted: self.writer.predicted(point), displacement: row.xyz(), velocity };
            let [x, y, z] = restitution.velocity_after(&impact, ground.plane.normal(), surface);
            columns.velocity.set(point, Row4([x, y, z, R::ZERO]));
        }
    }

    /// The time step of the run and a collider.
    fn step<'s>(&'s self, collider: &'s NearCollider<'_, R>) -> ColliderStep<'s, R> {
        let columns = (self.writer, self.start, self.pass.anchors);
        ColliderStep { of_free_points: true, ..collider.args.with_columns(columns, collider.state()) }
    }

    /// The contact of the run with the ground, with a factor on every thickness.
    fn ground(&self, thickness_scale: f64) -> Option<GroundContact<'_, R>> {
        let (plane, material) = self.pass.plane?;
        Some(GroundContact {
            writer: self.writer,
            start: self.start,
            plane: plane.over(self.heights, self.rows.start),
            thickness_scale: R::from_f64(thickness_scale),
            material,
            material_maps: &self.pass.contact.material_maps,
            h: self.pass.restitution.h,
            has_touched: &self.pass.contact.has_touched[self.pass.cloth],
        })
    }
}
