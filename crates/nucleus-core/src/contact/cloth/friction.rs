//! Friction between two elements that can both be moved.
//!
//! In a stack of cloth no pass leaves every layer at rest: whoever is pushed later slips over whom was pushed before. What is
//! left of that is taken back by the next step, without velocity, as what is left of a depth is. Otherwise layers that hold
//! creep downhill, by about g h² in each step.

use super::near::{Motion, Near};
use crate::contact::narrow::{Places, shortest};
use crate::math::{Real, Row4, add, clamp_length, dot, scale, sub};

/// What friction remembers slips by.
#[derive(Clone, Copy)]
pub struct Memory<'a, R> {
    /// Displacements as the span began.
    pub began_at: &'a [Row4<R>],
    /// Cloths that pass through each other, the lower index first: they are to come apart, so that no slip of theirs is held
    /// for longer than a step.
    pub tangled: &'a [[u32; 2]],
}

impl<R> Memory<'_, R> {
    /// Whether two cloths pass through each other, given by the place of their terms among so many.
    #[inline(always)]
    fn are_tangled(&self, place: u32, terms: usize) -> bool {
        if self.tangled.is_empty() {
            return false;
        }
        let cloths = terms.isqrt() as u32;
        let [a, b] = [place / cloths, place % cloths];
        self.tangled.contains(&[a.min(b), a.max(b)])
    }
}

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// The correction along the surfaces, in metres, and the part of it that is not to become velocity: against the motion
    /// of one over the other since the step began, and against what is left of slips before. Each is bounded by Coulomb's
    /// law: `most` are friction times how far the two were pressed apart, and led. `along` is that push, which is on its way.
    pub(super) fn rub(
        &mut self,
        step: &Motion<'_, R>,
        weights: &([R; N], [R; M]),
        line_before: [R; 3],
        along: [R; 3],
        most: [R; 2],
    ) -> [[R; 3]; 2] {
        let normal = self.normal;
        let flat = |way: [R; 3]| sub(way, scale(normal, dot(way, normal)));
        let motion = flat(add(sub(self.line(&self.now(step), weights), line_before), along));
        let slip = self.slip_left(step, weights, line_before, most[1]);
        let way = add(motion, slip);
        let led = along_of(slip, way);
        let held = clamp_length(sub(way, led), most[0]);
        [add(held, led), led].map(|way| scale(way, -R::ONE))
    }

    /// What is left of slips before the step, `most` at most: more than that is given up.
    #[inline(always)]
    fn slip_left(
        &mut self,
        step: &Motion<'_, R>,
        weights: &([R; N], [R; M]),
        line_before: [R; 3],
        most: R,
    ) -> [R; 3] {
        let Some(memory) = step.memory else { return [R::ZERO; 3] };
        let began = self.at(|point| memory.began_at[point as usize].xyz());
        let in_span = sub(line_before, self.line(&began, weights));
        let holds = self.meeting.rubs && !memory.are_tangled(self.meeting.terms, step.terms.len());
        let slip = if holds { add(self.slip, in_span) } else { [R::ZERO; 3] };
        let slip = clamp_length(sub(slip, scale(self.normal, dot(slip, self.normal))), most);
        self.slip = sub(slip, in_span);
        self.meeting.rubs = true;
        slip
    }

    /// Carries slips over into a span that begins at `start`; the last one `began_at`.
    pub(super) fn carry_slip(&mut self, start: &[Row4<R>], began_at: &[Row4<R>]) {
        if !self.meeting.rubs {
            return;
        }
        let now = self.at(|point| start[point as usize].xyz());
        let weights = shortest(now).1;
        let line = |at: &Places<R, N, M>| self.line(at, &weights);
        let in_span = sub(line(&now), line(&self.at(|point| began_at[point as usize].xyz())));
        self.slip = add(self.slip, in_span);
    }
}

/// How much of `slip` a way goes back over.
fn along_of<R: Real>(slip: [R; 3], way: [R; 3]) -> [R; 3] {
    let square = dot(slip, slip);
    if square <= R::MIN_DENOMINATOR {
        return [R::ZERO; 3];
    }
    let share = dot(way, slip) / square;
    match share {
        share if share <= R::ZERO => [R::ZERO; 3],
        share if share < R::ONE => scale(slip, share),
        _ => slip,
    }
}
