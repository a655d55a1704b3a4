//! Response of one contact with a collider: push, friction, adhesion, and the surface for restitution.

use crate::contact::collider::contact::{
    ColliderContact, Outcome, Point, closest, cross_direction, interpolate,
};
use crate::contact::collider::separation::{best_plane, separated};
use crate::contact::material::{ContactMaterial, ContactPoints};
use crate::contact::narrow_phase::shortest_line;
use crate::contact::response::{
    Adhesion, Mobility, Push, Restitution, TOUCH_TOLERANCE, TouchingPoint, coulomb_correction,
};
use crate::contact::time_step::ColliderStep;
use crate::math::{Real, add, dot, scale};

impl<R: Real> ColliderStep<'_, R> {
    /// The gap below which a contact may push, in metres.
    #[inline(always)]
    fn pushing_gap(&self) -> R {
        self.thickness * R::from_f64(1.0 - TOUCH_TOLERANCE)
    }

    /// The gap below which a contact may push or, if its material grips, hold, in metres.
    #[inline(always)]
    pub(super) fn active_gap(&self) -> R {
        let tolerance =
            if self.material.grips { Restitution::<R>::MAX_TOUCHING_GAP } else { 1.0 - TOUCH_TOLERANCE };
        self.thickness * R::from_f64(tolerance)
    }
}

impl<R: Real, const N: usize, const M: usize> ColliderContact<R, N, M> {
    /// Pushes the contact to its thickness. The caller passes points that no other task of the phase touches.
    #[inline]
    pub fn resolve(&mut self, step: &ColliderStep<'_, R>) -> Outcome {
        let moved = step.displacements(self.points);
        let touching = R::from_f64(1.0 - TOUCH_TOLERANCE);
        let (above_plane, least) = self.gaps(moved, step.shares[1]);
        let gap = above_plane + self.excess_at(step.shares[1]);
        if least >= step.pushing_gap() {
            return self.leave(step, gap);
        }
        if least < R::ZERO || !self.plane_is_valid(moved, step) {
            return self.resolve_exact(step, least);
        }
        let rest_gap = self.rest_gap(step, self.weights);
        if gap >= rest_gap * touching {
            return self.leave(step, gap);
        }
        self.push(step, rest_gap, [self.gap_at_start(step), gap]);
        Outcome::Pushed
    }

    /// Leaves a contact that keeps its thickness where it is. If its material grips, its sliding is reversed while the two
    /// touch: constraint sweeps drag its points in between.
    #[inline]
    fn leave(&self, step: &ColliderStep<'_, R>, gap: R) -> Outcome {
        if step.material.grips {
            let rest_gap = self.rest_gap(step, self.weights);
            if Restitution::touches(gap, rest_gap) {
                self.push(step, rest_gap, [rest_gap; 2]);
            }
        }
        Outcome::Separated
    }

    /// Repeats the test with exact closest points, and sets the plane that belongs to them. `least` is the
    /// smallest gap along the old plane.
    #[cold]
    fn resolve_exact(&mut self, step: &ColliderStep<'_, R>, least: R) -> Outcome {
        let [x0, x1] = step.cloth_positions(self.points);
        let [q0, q1] = step.collider_positions(self.collider_points);
        let at_start = closest(x0, q0);
        let start_line = interpolate(x0, at_start.0) - interpolate(q0, at_start.1);
        let at_end = closest(x1, q1);
        let thickness = self.rest_gap(step, at_end.0.map(R::from_f64)).to_f64();
        let line = interpolate(x1, at_end.0) - interpolate(q1, at_end.1);
        let distance = line.norm();
        let mut proof = None;
        if least < R::ZERO {
            let directions = [start_line, cross_direction(x1, q1), cross_direction(x0, q0), line];
            let Some((gap, normal)) = best_plane(directions, [x0, x1], [q0, q1]) else {
                return Outcome::Inseparable;
            };
            let passes = gap < 0.0 && !separated([x0, x1], [q0, q1], step.of_free_points);
            if passes && self.may_interpenetrate(step) {
                return Outcome::Separated; // It is on the other side from now on.
            }
            if passes {
                self.set_plane(normal, at_start, step);
                let rest_gap = R::from_f64(thickness);
                // Both gaps are those above the plane, which the element has to clear.
                let [at_start, _] = self.gaps_above_plane(step);
                let gaps = [at_start, R::from_f64(gap)];
                let depenetration = dot(self.normal, self.depenetration(step));
                self.push_rigidly(step, Push::new(rest_gap, gaps, depenetration, step.h));
                return Outcome::Reverted;
            }
            proof = (gap >= 0.0).then_some(normal);
        }
        let old = Point::new(self.normal[0].to_f64(), self.normal[1].to_f64(), self.normal[2].to_f64());
        let normal = line.try_normalize(1e-9).or(proof).unwrap_or(old);
        self.set_plane(normal, at_end, step);
        if distance >= thickness * (1.0 - TOUCH_TOLERANCE) {
            return Outcome::Separated;
        }
        self.push(step, R::from_f64(thickness), [start_line.norm(), distance].map(R::from_f64));
        Outcome::Pushed
    }

    /// Moves the cloth's points along the normal until the contact keeps `rest_gap`, with friction. `gaps` are
    /// those at the start of the step and now.
    pub(super) fn push(&self, step: &ColliderStep<'_, R>, rest_gap: R, gaps: [R; 2]) {
        let rows = self.points.map(|point| step.row(point));
        let mobility = Mobility::of(rows.map(|row| row.0[3]), self.weights).total();
        if mobility <= R::ZERO {
            return;
        }
        let depenetration = self.depenetration(step);
        let mut push = Push::new(rest_gap, gaps, dot(self.normal, depenetration), step.h);
        let mut mapped = None;
        let material = self.material(step, &mut mapped);
        if step.is_partial() {
            push = push
                .scaled(material.strength_at(step.material_maps, self.contact_points(&(self.weights, []))));
        }
        let (along, depenetration_along) =
            (scale(self.normal, push.length()), scale(self.normal, push.depenetration));
        let [friction_part, given_back] = self.friction(step, material, depenetration, along, push.length());
        let (moved, depenetration) = (add(along, friction_part), add(depenetration_along, given_back));
        for k in 0..N {
            let mobile = rows[k].0[3] * self.weights[k] / mobility;
            let mut row = rows[k];
            for axis in 0..3 {
                row.0[axis] += mobile * moved[axis];
            }
            step.writer.push(self.points[k], row, scale(depenetration, mobile));
        }
    }

    /// The points of the cloth's element and their weights. The collider's vertex maps are in its material at the
    /// contact.
    pub(super) fn contact_points<'a>(&self, weights: &'a ([R; N], [R; 0])) -> ContactPoints<'a, R, N, 0> {
        (self.points, [], weights)
    }

    /// Moves all points of the cloth's element along the normal, so that none of them is behind the plane.
    pub(super) fn push_rigidly(&self, step: &ColliderStep<'_, R>, push: Push<R>) {
        for point in self.points {
            let mut row = step.row(point);
            if row.0[3] > R::ZERO {
                for axis in 0..3 {
                    row.0[axis] += self.normal[axis] * push.length();
                }
                step.writer.push(point, row, self.normal.map(|n| n * push.depenetration));
            }
        }
    }

    /// Moves the cloth's element with the surface, from its position at the start of the step.
    pub fn move_with_surface(&self, step: &ColliderStep<'_, R>) {
        let elapsed = R::from_f64(step.time.length());
        for point in self.points {
            let mut row = step.row(point);
            if row.0[3] > R::ZERO {
                let start = step.start(point);
                for axis in 0..3 {
                    row.0[axis] = start[axis] + self.surface_motion[axis] * elapsed;
                }
                step.writer.place(point, row);
            }
        }
    }

    /// The correction along the surface, and the part of it without velocity.
    fn friction(
        &self,
        step: &ColliderStep<'_, R>,
        material: &ContactMaterial<R>,
        depenetration: [R; 3],
        along: [R; 3],
        pushed: R,
    ) -> [[R; 3]; 2] {
        let limit = match material.grips {
            true => R::from_f64(f64::from(f32::MAX)),
            false => {
                material.friction_at(step.material_maps, self.contact_points(&(self.weights, []))) * pushed
            }
        };
        if limit <= R::ZERO {
            return [[R::ZERO; 3]; 2];
        }
        let start = self.contact_displacement(step.start_displacements(self.points));
        let now = self.contact_displacement(step.displacements(self.points));
        let elapsed = R::from_f64(step.time.length());
        let motion: [R; 3] = std::array::from_fn(|axis| {
            now[axis] + along[axis] - start[axis] - self.surface_motion[axis] * elapsed
        });
        coulomb_correction([motion, depenetration], self.normal, limit)
    }
}

impl<R: Real, const N: usize, const M: usize> ColliderContact<R, N, M> {
    /// Applies adhesion between the cloth's element and the surface.
    pub fn adhere(&self, step: &ColliderStep<'_, R>) {
        let (weights, mut mapped) = (&(self.weights, []), None);
        let material = self.material(step, &mut mapped);
        let adhesion = Adhesion {
            range: step.interaction_range(),
            thickness: self.rest_gap(step, self.weights),
            stickiness: material.stickiness_at(step.material_maps, self.contact_points(weights)),
            friction: material.friction_at(step.material_maps, self.contact_points(weights)),
        };
        let rows = self.points.map(|point| step.row(point));
        let start = step.start_displacements(self.points);
        let gap = self.gap_at(start, step.shares[0]);
        let (before, elapsed) = (self.normal.map(|n| n * gap), R::from_f64(step.time.length()));
        let [from, to] =
            [self.contact_displacement(start), self.contact_displacement(rows.map(|row| row.xyz()))];
        let now = std::array::from_fn(|axis| {
            before[axis] + to[axis] - from[axis] - self.surface_motion[axis] * elapsed
        });
        let Some(correction) = adhesion.correction(before, now, self.normal, step.h) else { return };
        let mobility = Mobility::of(rows.map(|row| row.0[3]), self.weights).total();
        if mobility > R::ZERO {
            for (k, mut row) in rows.into_iter().enumerate() {
                let part = row.0[3] * self.weights[k] / mobility;
                (0..3).for_each(|axis| row.0[axis] += part * correction[axis]);
                step.writer.push(self.points[k], row, [R::ZERO; 3]);
            }
        }
    }
}

impl<R: Real, const N: usize, const M: usize> ColliderContact<R, N, M> {
    /// The larger coefficient of restitution at the contact.
    pub fn bounce(&self, step: &ColliderStep<'_, R>) -> R {
        self.material(step, &mut None).bounce_at(step.material_maps, self.contact_points(&(self.weights, [])))
    }

    /// The friction that bounds its tangential impulse.
    fn impact_friction(&self, step: &ColliderStep<'_, R>) -> R {
        let (weights, mut mapped) = (&(self.weights, []), None);
        let material = self.material(step, &mut mapped);
        material.impact_friction_at(step.material_maps, self.contact_points(weights))
    }
}

/// Share of a corner of a face up to which a contact is with the rim opposite to it.
const RIM: f64 = 1e-6;

impl<R: Real> ColliderContact<R, 1, 3> {
    /// What the point touches at the end of the step, if the two touch; `frame` is the length of the frame in seconds.
    ///
    /// The plane of the contact only tells that they may touch: it may be from a time at which the point was beside the face.
    pub fn touch(&self, step: &ColliderStep<'_, R>, frame: f64) -> Option<TouchingPoint<R>> {
        let rest_gap = self.rest_gap(step, self.weights);
        if !Restitution::touches(self.gaps_above_plane(step)[1], rest_gap) {
            return None;
        }
        let place: [f64; 3] = step.end_position(self.points[0]).into();
        let [_, corners] = step.collider_positions(self.collider_points);
        let (normal, (_, weights), distance) = shortest_line::<f64, 1, 3>(([place], corners.map(Into::into)));
        let gap = R::from_f64(distance);
        Restitution::touches(gap, rest_gap).then(|| TouchingPoint {
            row: self.points[0],
            normal: normal.map(R::from_f64),
            surface: self.surface_motion.map(|x| x / R::from_f64(frame)),
            coefficient: self.bounce(step),
            friction: self.impact_friction(step),
            gap,
            is_rim: weights.iter().any(|&weight| weight <= RIM),
        })
    }
}
