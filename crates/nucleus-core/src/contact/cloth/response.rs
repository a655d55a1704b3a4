//! Response of one contact among cloths: push, friction with a persistent anchor, adhesion, restitution.
//!
//! A Gauss-Seidel sweep leaves some layers of a stack slightly displaced: each push moves points over those
//! pushed before. The friction anchor accumulates that slip, and the next step reverses it without velocity, as
//! it does for depth. Without it, resting layers creep downhill by about g h² in each step.

use crate::contact::ccd::{first_contact_normal, passing_direction};
use crate::contact::cloth::certify::{START_TOLERANCE, rounding_error};
use crate::contact::cloth::contact::{ClothContact, ClothStep, ContactKind, OVERLAP};
use crate::contact::material::ContactMaterial;
use crate::contact::narrow_phase::{ElementPositions, gap_along, interpolate, shortest_line};
use crate::contact::response::{Adhesion, Impact, Mobility, Push, Restitution, TOUCH_TOLERANCE};
use crate::math::{Real, Row4, add, clamp_length, dot, max, scale, sub};
use crate::parallel::disjoint::DisjointSlice;

/// A motion of one side of a contact relative to the other, in metres.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Correction<R> {
    /// All of it.
    moved: [R; 3],
    /// The part of it without velocity.
    depenetration: [R; 3],
    /// Whether that part becomes velocity where another contact reverses it: cloth between the two bears a load then.
    bears_load: bool,
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Pushes the two apart if they are nearer than their thickness. Returns whether they were.
    #[inline]
    pub fn resolve(&mut self, step: &ClothStep<'_, R>) -> bool {
        if self.certainly_exceeds(step, self.params.thickness * step.thickness_scale) {
            return false;
        }
        let now = self.end_positions(step);
        let touching = R::from_f64(1.0 - TOUCH_TOLERANCE);
        let gap = self.gap(&now);
        if gap >= self.params.thickness * step.thickness_scale * touching {
            return false;
        }
        let before = self.start_positions(step);
        if self.has_free_point()
            && let Some(normal) = first_contact_normal(&before, &now, self.rest_gap_at(step, &before))
        {
            self.normal = normal;
            self.push_to_start_side(step, &before, &now);
            return true;
        }
        let (normal, weights, distance) = shortest_line(now);
        if distance > R::ZERO
            && gap_along(normal, &before) > rounding_error(&now) * R::from_f64(START_TOLERANCE)
        {
            // Separated along this line at both ends of the step.
            self.normal = normal;
            let rest_gap = self.rest_gap(step, &weights);
            if distance >= rest_gap * touching {
                return false;
            }
            self.push(step, &weights, &before, [rest_gap, rest_gap - distance]);
            return true;
        }
        if self.has_free_point()
            && let Some(normal) = passing_direction(&before, &now, self.rest_gap_at(step, &before))
        {
            self.normal = normal;
            return false;
        }
        if self.separated_throughout(&before, &now) {
            self.normal = normal;
            let rest_gap = self.rest_gap(step, &weights);
            if distance < rest_gap * touching {
                self.push(step, &weights, &before, [rest_gap, rest_gap - distance]);
            }
            self.clear_normal();
            return distance < rest_gap * touching;
        }
        if self.may_interpenetrate(step) {
            // They may pass through each other, and are on the other side from now on.
            self.normal = normal;
            let rest_gap = self.rest_gap(step, &weights);
            self.push(step, &weights, &before, [rest_gap, max(rest_gap - distance, R::ZERO)]);
            return true;
        }
        // Not separated: back to the side of the start of the step.
        self.push_to_start_side(step, &before, &now);
        true
    }

    /// Pushes the two apart along the contact normal, at the closest points of the start of the step.
    fn push_to_start_side(
        &mut self,
        step: &ClothStep<'_, R>,
        before: &ElementPositions<R, N, M>,
        now: &ElementPositions<R, N, M>,
    ) {
        let (first, weights, _) = shortest_line(*before);
        if self.normal == [R::ZERO; 3] {
            self.normal = first;
        }
        let rest_gap = self.rest_gap(step, &weights);
        let depth = rest_gap - dot(self.normal, self.contact_line(now, &weights));
        if depth > R::ZERO {
            self.push(step, &weights, before, [rest_gap, depth]);
        }
    }

    /// Moves the two sides apart by `depth` in total, each by its mobility, with friction. `rest_gap` is the
    /// distance to keep.
    fn push(
        &mut self,
        step: &ClothStep<'_, R>,
        weights: &([R; N], [R; M]),
        before: &ElementPositions<R, N, M>,
        [rest_gap, depth]: [R; 2],
    ) {
        let Some(material) = self.material(step) else { return };
        let line_before = self.contact_line(before, weights);
        let gap_before = dot(self.normal, line_before);
        if self.overlaps() && gap_before >= rest_gap * R::from_f64(OVERLAP) {
            self.params.kind = self.params.kind.without(ContactKind::OVERLAPS);
        }
        let separated = dot(self.normal, self.relative(weights, |point| step.writer.depenetration(point)));
        let mut push = Push::new(rest_gap, [gap_before, rest_gap - depth], separated, step.h);
        if material.is_partial(step.material_maps) {
            push = push.scaled(material.strength_at(step.material_maps, self.contact_points(weights)));
        }
        let along = [push.length(), push.depenetration].map(|length| scale(self.normal, length));
        let friction = material.friction_at(step.material_maps, self.contact_points(weights));
        let friction_part = if friction > R::ZERO {
            self.friction_correction(
                step,
                weights,
                line_before,
                along[0],
                [push.pressed, push.depenetration].map(|most| most * friction),
            )
        } else {
            [[R::ZERO; 3]; 2]
        };
        let correction = Correction {
            moved: add(along[0], friction_part[0]),
            depenetration: add(along[1], friction_part[1]),
            bears_load: !self.overlaps() && separated >= R::ZERO,
        };
        self.push_apart(step, material, weights, &correction);
    }

    /// Moves the two apart, each side by its mobility.
    pub(super) fn push_apart(
        &self,
        step: &ClothStep<'_, R>,
        material: &ContactMaterial<R>,
        (b, c): &([R; N], [R; M]),
        correction: &Correction<R>,
    ) {
        let Some((ours, theirs, all)) = self.inverse_masses(step, material, (b, c)) else { return };
        let part = R::ONE / all;
        for k in 0..N {
            self.move_point(step, self.ours[k], ours[k] * b[k] * part, correction);
        }
        for k in 0..M {
            self.move_point(step, self.theirs[k], -(theirs[k] * c[k] * part), correction);
        }
    }

    /// The inverse masses of our points and of theirs in 1/kg, as they count in this contact, and its mobility; `None` where
    /// all are pinned. The lower layer moves only where the higher one is pinned.
    #[inline(always)]
    fn inverse_masses(
        &self,
        step: &ClothStep<'_, R>,
        material: &ContactMaterial<R>,
        (b, c): (&[R; N], &[R; M]),
    ) -> Option<([R; N], [R; M], R)> {
        let with = |share: [R; 2]| {
            let ours = self.ours.map(|point| step.row(point).0[3] * share[0]);
            let theirs = self.theirs.map(|point| step.row(point).0[3] * share[1]);
            let all = Mobility::of(ours, *b).and(Mobility::of(theirs, *c)).total();
            (all > R::MIN_DENOMINATOR).then_some((ours, theirs, all))
        };
        with(material.mobility).or_else(|| with([R::ONE; 2]))
    }

    #[inline(always)]
    fn move_point(&self, step: &ClothStep<'_, R>, point: u32, part: R, correction: &Correction<R>) {
        let mut row = step.row(point);
        for axis in 0..3 {
            row.0[axis] += correction.moved[axis] * part;
        }
        let depenetration = scale(correction.depenetration, part);
        if correction.bears_load {
            step.writer.push_bearing(point, row, depenetration);
        } else {
            step.writer.push(point, row, depenetration);
        }
    }

    /// The line from the contact point on theirs to that on ours.
    #[inline(always)]
    pub(super) fn contact_line(&self, at: &ElementPositions<R, N, M>, (b, c): &([R; N], [R; M])) -> [R; 3] {
        sub(interpolate(at.0, *b), interpolate(at.1, *c))
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// The correction along the surfaces in metres, and the part of it without velocity: against the relative
    /// motion of this step, and against the offset from the anchor. Coulomb's law bounds both: `most` holds
    /// friction times the pressed part of the push, and friction times its depenetration. `along` is the push
    /// itself.
    pub(super) fn friction_correction(
        &mut self,
        step: &ClothStep<'_, R>,
        weights: &([R; N], [R; M]),
        line_before: [R; 3],
        along: [R; 3],
        most: [R; 2],
    ) -> [[R; 3]; 2] {
        let normal = self.normal;
        let flat = |x: [R; 3]| sub(x, scale(normal, dot(x, normal)));
        let motion =
            flat(add(sub(self.contact_line(&self.end_positions(step), weights), line_before), along));
        let offset = self.anchor_offset(step, weights, line_before, most[1]);
        let total = add(motion, offset);
        let depenetration = part_along(offset, total);
        let pressed = clamp_length(sub(total, depenetration), most[0]);
        [add(pressed, depenetration), depenetration].map(|x| scale(x, -R::ONE))
    }

    /// The offset from the friction anchor at the start of the step, `most` at most: the anchor moves by the
    /// rest.
    #[inline(always)]
    fn anchor_offset(
        &mut self,
        step: &ClothStep<'_, R>,
        weights: &([R; N], [R; M]),
        line_before: [R; 3],
        most: R,
    ) -> [R; 3] {
        let Some(anchors) = step.anchors else { return [R::ZERO; 3] };
        let start = self.positions(step.origins, |point| anchors.interval_start[point as usize].xyz());
        let in_interval = sub(line_before, self.contact_line(&start, weights));
        let is_valid = self.has_anchor() && !anchors.are_intersecting(|| self.cloths(step.materials));
        let offset = if is_valid { add(self.friction_anchor, in_interval) } else { [R::ZERO; 3] };
        let offset = clamp_length(sub(offset, scale(self.normal, dot(offset, self.normal))), most);
        self.friction_anchor = sub(offset, in_interval);
        self.params.kind = self.params.kind.with(ContactKind::HAS_ANCHOR, true);
        offset
    }

    /// Carries the friction anchor over into a candidate interval that begins at `start`; the last one began at
    /// `interval_start`.
    pub(super) fn carry_anchor(
        &mut self,
        origins: &[[f64; 3]],
        start: &[Row4<R>],
        interval_start: &[Row4<R>],
    ) {
        if !self.has_anchor() {
            return;
        }
        let now = self.positions(origins, |point| start[point as usize].xyz());
        let weights = shortest_line(now).1;
        let line = |at: &ElementPositions<R, N, M>| self.contact_line(at, &weights);
        let in_interval =
            sub(line(&now), line(&self.positions(origins, |point| interval_start[point as usize].xyz())));
        self.friction_anchor = add(self.friction_anchor, in_interval);
    }
}

/// The part of `offset` that a motion reverses.
fn part_along<R: Real>(offset: [R; 3], motion: [R; 3]) -> [R; 3] {
    let square = dot(offset, offset);
    if square <= R::MIN_DENOMINATOR {
        return [R::ZERO; 3];
    }
    let share = dot(motion, offset) / square;
    match share {
        share if share <= R::ZERO => [R::ZERO; 3],
        share if share < R::ONE => scale(offset, share),
        _ => offset,
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Applies adhesion between the two. Returns whether it acted.
    pub fn adhere(&self, step: &ClothStep<'_, R>) -> bool {
        let Some(material) = self.material(step).filter(|material| material.has_adhesion()) else {
            return false;
        };
        let (now, before) = (self.end_positions(step), self.start_positions(step));
        let (normal, weights, _) = shortest_line(before);
        let thickness = self.thickness_at(step.materials, step.material_maps, &weights);
        let adhesion = Adhesion {
            range: thickness * R::from_f64(material.adhesion_range),
            thickness,
            stickiness: material.stickiness_at(step.material_maps, self.contact_points(&weights)),
            friction: material.friction_at(step.material_maps, self.contact_points(&weights)),
        };
        let [before, now] = [self.contact_line(&before, &weights), self.contact_line(&now, &weights)];
        let correction = adhesion.correction(before, now, normal, step.h);
        let correction = correction.map(|moved| Correction { moved, ..Correction::default() });
        correction.inspect(|correction| self.push_apart(step, material, &weights, correction)).is_some()
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Applies restitution if the two touch at the end of the step. Momentum is conserved. Returns whether it
    /// acted.
    pub fn apply_restitution(
        &self,
        step: &ClothStep<'_, R>,
        velocities: DisjointSlice<'_, Row4<R>>,
        restitution: Restitution<R>,
    ) -> bool {
        let Some(material) = self.material(step).filter(|material| material.has_restitution()) else {
            return false;
        };
        let (normal, weights, distance) = shortest_line(self.end_positions(step));
        let thickness = self.thickness_at(step.materials, step.material_maps, &weights);
        let bounce = material.bounce_at(step.material_maps, self.contact_points(&weights));
        if bounce <= R::ZERO || !Restitution::touches(distance, thickness) {
            return false;
        }
        #[allow(unsafe_code)]
        // SAFETY: tasks of a colour share no block, and a contact's points are in its task's blocks.
        let velocity = |point: u32| unsafe { velocities.get(point) };
        let predicted = |point: u32| step.writer.predicted(point);
        let impact = Impact {
            predicted: self.relative(&weights, predicted),
            displacement: self.relative(&weights, |point| step.row(point).xyz()),
            velocity: self.relative(&weights, |point| velocity(point).xyz()),
        };
        let friction = material.impact_friction_at(step.material_maps, self.contact_points(&weights));
        let restitution = Restitution { coefficient: bounce, friction, ..restitution };
        let gained = sub(restitution.velocity_after(&impact, normal, [R::ZERO; 3]), impact.velocity);
        if gained == [R::ZERO; 3] {
            return false;
        }
        let (b, c) = weights;
        let Some((ours, theirs, all)) = self.inverse_masses(step, material, (&b, &c)) else { return false };
        let of_ours = (0..N).map(|k| (self.ours[k], ours[k] * b[k]));
        let of_theirs = (0..M).map(|k| (self.theirs[k], -(theirs[k] * c[k])));
        for (point, mobile) in of_ours.chain(of_theirs) {
            let row = velocity(point);
            let [x, y, z] = add(row.xyz(), scale(gained, mobile / all));
            // SAFETY: as above.
            #[allow(unsafe_code)]
            unsafe {
                velocities.set(point, Row4([x, y, z, row.0[3]]));
            }
        }
        true
    }

    /// A column at our contact point minus that at theirs.
    fn relative(&self, (b, c): &([R; N], [R; M]), of: impl Fn(u32) -> [R; 3]) -> [R; 3] {
        let ours = (0..N).map(|k| scale(of(self.ours[k]), b[k])).fold([R::ZERO; 3], add);
        (0..M).map(|k| scale(of(self.theirs[k]), c[k])).fold(ours, sub)
    }
}
