//! One contact between two elements that can both be moved.
//!
//! It carries a direction along which the two were apart at the start of the time step. As long as they are
//! apart along it at the end too, they have not passed; otherwise another direction is looked for.

use super::friction::Memory;
use super::ways::Points;
use crate::bytes::{Encode, Reader, encode_struct};
use crate::contact::maps::Maps;
use crate::contact::mover::Mover;
use crate::contact::narrow::{Places, gap_along, shortest};
use crate::contact::terms::{Sides, Terms};
use crate::math::{Real, Row4, add};

/// What a contact needs of the time step.
#[derive(Clone, Copy)]
pub struct Motion<'a, R> {
    /// Places of the points.
    pub mover: Mover<'a, R>,
    /// Displacements at the start of the step.
    pub start: &'a [Row4<R>],
    /// What friction remembers by; nothing where it does not act.
    pub memory: Option<Memory<'a, R>>,
    /// How cloths meet, by cloth and cloth.
    pub terms: &'a [Option<Terms<R>>],
    /// What points bring into a contact beyond their cloth.
    pub maps: &'a Maps<R>,
    /// Length of the step in seconds.
    pub h: R,
    /// The share of every thickness that is kept: less than one where there is no room for all of it.
    pub squeeze: R,
}

impl<R: Real> Motion<'_, R> {
    #[inline(always)]
    pub(super) fn row(&self, point: u32) -> Row4<R> {
        self.mover.row(point) // tasks of a phase share no block, and a contact's points are in its task's blocks
    }

    #[inline(always)]
    pub(super) fn start(&self, point: u32) -> [R; 3] {
        self.start[point as usize].xyz()
    }
}

/// On which terms two elements meet.
#[derive(Debug, Clone, Copy)]
pub struct Meeting<R> {
    /// The distance to keep, in metres; the most that maps make of it.
    pub thickness: R,
    /// The terms of the two cloths, by their place among all.
    pub terms: u32,
    /// Whether the distance is less than the cloth's, because the two are neighbours at rest.
    pub rest_limited: bool,
    /// Whether motion bounds certify that the two keep a gap.
    pub certified: bool,
    /// Whether one side is a free point, which can go farther in a step than anything is large.
    pub is_swept: bool,
    /// Whether they have been pushed apart with friction.
    pub rubs: bool,
}

/// A contact: `N` points of one element, `M` of the other.
#[derive(Debug, Clone, Copy)]
pub struct Near<R, const N: usize, const M: usize> {
    /// Points of the one element, in the solver's places.
    pub ours: [u32; N],
    /// Points of the other.
    pub theirs: [u32; M],
    /// Their anchors, in metres from the first of ours.
    places: ([[R; 3]; N], [[R; 3]; M]),
    /// Points from theirs to ours; the two were apart along it at the start of the step. Nought if no direction held all
    /// through the last one.
    pub(super) normal: [R; 3],
    /// How far ours had slipped along theirs as the span began, of what friction is still to take back. It counts only where
    /// the two rub.
    pub(super) slip: [R; 3],
    pub(super) meeting: Meeting<R>,
}

encode_struct!([R: Real] Meeting<R> { thickness: R, terms: u32, rest_limited: bool, certified: bool, is_swept: bool, rubs: bool });

impl<R: Real, const N: usize, const M: usize> Encode for Near<R, N, M> {
    const SIZE: usize = <Points<N, M>>::SIZE + <[[R; 3]; 2]>::SIZE + Meeting::<R>::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        // Places are those of the next frame's anchors.
        let Self { ours, theirs, places: _, normal, slip, meeting } = self;
        (*ours, *theirs).encode(out);
        [*normal, *slip].encode(out);
        meeting.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let (ours, theirs) = Encode::decode(from)?;
        let places = ([[R::ZERO; 3]; N], [[R::ZERO; 3]; M]);
        let [normal, slip] = Encode::decode(from)?;
        Some(Self { ours, theirs, places, normal, slip, meeting: Encode::decode(from)? })
    }
}

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// A contact along the shortest line between the two at the start of a time step, of which `start` has the
    /// displacements.
    #[inline]
    pub fn new(
        (ours, theirs): Points<N, M>,
        meeting: Meeting<R>,
        anchors: &[[f64; 3]],
        start: &[Row4<R>],
    ) -> Self {
        let places = places((ours, theirs), anchors);
        let [normal, slip] = [[R::ZERO; 3]; 2];
        let mut near = Self { ours, theirs, places, normal, slip, meeting };
        near.normal = shortest(near.at(|point| start[point as usize].xyz())).0;
        near
    }

    #[inline(always)]
    pub(super) fn at(&self, displacement: impl Fn(u32) -> [R; 3]) -> Places<R, N, M> {
        let ours = std::array::from_fn(|k| add(self.places.0[k], displacement(self.ours[k])));
        (ours, std::array::from_fn(|k| add(self.places.1[k], displacement(self.theirs[k]))))
    }

    #[inline(always)]
    pub(super) fn now(&self, step: &Motion<'_, R>) -> Places<R, N, M> {
        self.at(|point| step.row(point).xyz())
    }

    #[inline(always)]
    pub(super) fn before(&self, step: &Motion<'_, R>) -> Places<R, N, M> {
        self.at(|point| step.start(point))
    }

    /// The terms of the two cloths.
    #[inline(always)]
    pub(super) fn terms<'a>(&self, step: &Motion<'a, R>) -> Option<&'a Terms<R>> {
        step.terms.get(self.meeting.terms as usize)?.as_ref()
    }

    /// The points of the two, with how near each of them is.
    #[inline(always)]
    pub(super) fn sides<'a>(&self, weights: &'a ([R; N], [R; M])) -> Sides<'a, R, N, M> {
        (self.ours, self.theirs, weights)
    }

    /// The distance to keep where the contact is.
    #[inline(always)]
    pub(super) fn kept(&self, step: &Motion<'_, R>, weights: &([R; N], [R; M])) -> R {
        self.thickness_at(step.terms, step.maps, weights) * step.squeeze
    }

    /// The distance to keep where the two are nearest to each other.
    pub(super) fn kept_at(&self, step: &Motion<'_, R>, at: &Places<R, N, M>) -> R {
        self.kept(step, &shortest(*at).1)
    }

    /// The thickness of both where the contact is, in metres.
    #[inline(always)]
    pub fn thickness_at(&self, terms: &[Option<Terms<R>>], maps: &Maps<R>, weights: &([R; N], [R; M])) -> R {
        let most = self.meeting.thickness;
        let there = |terms: &Terms<R>| terms.thickness_at(maps, self.sides(weights), most);
        if maps.thickness.is_empty() {
            return most;
        }
        terms[self.meeting.terms as usize].as_ref().map_or(most, there)
    }

    /// The gap along the contact's direction.
    #[inline(always)]
    pub(super) fn gap(&self, at: &Places<R, N, M>) -> R {
        gap_along(self.normal, at)
    }
    /// Whether one side is a free point.
    pub fn is_swept(&self) -> bool {
        self.meeting.is_swept
    }

    /// Its points, first ours, then theirs; what is left over repeats the first.
    pub fn points(&self) -> [u32; 4] {
        let mut points = [self.ours[0]; 4];
        points.iter_mut().zip(self.ours.iter().chain(&self.theirs)).for_each(|(at, point)| *at = *point);
        points
    }

    /// Reckons from anchors where they are now.
    pub fn follow(&mut self, anchors: &[[f64; 3]]) {
        self.places = places((self.ours, self.theirs), anchors);
    }

    /// Whether the distance that is kept is less than the cloth's, because the two are neighbours at rest.
    pub fn is_rest_limited(&self) -> bool {
        self.meeting.rest_limited
    }

    /// Lets it act no more.
    pub fn switch_off(&mut self) {
        // Nothing is that near, and there are no terms on which to meet.
        self.meeting.thickness = -R::ONE / R::MIN_DENOMINATOR;
        self.meeting.terms = u32::MAX;
    }

    /// Whether it is between points that there are, on terms that there are.
    pub fn fits(&self, are_points: impl Fn(&[u32]) -> bool, terms: usize) -> bool {
        are_points(&self.ours)
            && are_points(&self.theirs)
            && (self.is_off() || (self.meeting.terms as usize) < terms)
    }

    /// Whether it acts no more.
    pub fn is_off(&self) -> bool {
        self.meeting.terms == u32::MAX
    }

    /// The distance between the two, over the thickness kept between them.
    pub fn closeness(&self, step: &Motion<'_, R>) -> R {
        let (_, weights, distance) = shortest(self.now(step));
        distance / self.kept(step, &weights)
    }
}

/// Where the anchors of some points are, in metres from the first of ours.
#[inline(always)]
fn places<R: Real, const N: usize, const M: usize>(
    (ours, theirs): Points<N, M>,
    anchors: &[[f64; 3]],
) -> Places<R, N, M> {
    let origin = anchors[ours[0] as usize];
    let place = |point: u32| {
        let anchor = anchors[point as usize];
        std::array::from_fn(|axis| R::from_f64(anchor[axis] - origin[axis]))
    };
    (ours.map(place), theirs.map(place))
}
