//! On which terms two objects meet in a frame: thickness, friction, stickiness, bounce, strength, layers and elements.

use super::maps::{Maps, at};
use super::stick;
use crate::input::frame::{ClothFrame, ColliderFrame, Elements, GroundPlane};
use crate::math::Real;

/// Thickness in metres below which none is kept: contact needs some room to prove that nothing passed.
pub const LEAST_THICKNESS: f64 = 1e-5;

/// How two objects meet, or a cloth itself; of a cloth and a collider the cloth comes first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms<R> {
    /// The distance kept between the two, in metres; the most that maps make of it.
    pub thickness: f64,
    /// Share of the thickness up to which anything acts between the two.
    pub reach: f64,
    /// The thickness of each side, in metres.
    pub sides: [R; 2],
    /// The friction of each side.
    pub friction: [R; 2],
    /// The stickiness of each side.
    pub stickiness: [R; 2],
    /// The bounce of each side.
    pub bounce: [R; 2],
    /// How much of a collision is carried out, as a factor of each side.
    pub strength: [R; 2],
    /// Factor on the pace at which they are worked apart where they pass through each other.
    pub untangling: f64,
    /// Whether what is inside the other is led out of it.
    pub traps: bool,
    /// Factor on the mobility of each side: the lower layer is the heavier.
    pub mobility: [R; 2],
    /// Which elements of each side meet the points of the other.
    pub elements: [Elements; 2],
    /// Whether edges meet edges.
    pub edges: bool,
}

/// The points of the two elements of a contact, and how near each of them is.
pub type Sides<'a, R, const N: usize, const M: usize> = ([u32; N], [u32; M], &'a ([R; N], [R; M]));

impl<R: Real> Terms<R> {
    /// How a cloth meets itself; nothing where it does not. `thickest` is the most that its map makes of its thickness.
    pub fn with_itself(cloth: &ClothFrame, thickest: f64) -> Option<Self> {
        let own = &cloth.self_collision;
        let both = |x: f64| [R::from_f64(x); 2];
        (own.on && cloth.collide_strength > 0.0).then(|| Self {
            thickness: (2.0 * own.thickness * thickest).max(LEAST_THICKNESS),
            reach: reach(2.0 * cloth.stickiness),
            sides: both(own.thickness),
            friction: both(cloth.friction),
            stickiness: both(cloth.stickiness),
            bounce: both(cloth.bounce),
            strength: [R::from_f64(cloth.collide_strength.min(1.0)), R::ONE],
            untangling: untangling(cloth.self_crossover_push),
            traps: false,
            mobility: [R::ONE; 2],
            elements: [own.elements; 2],
            edges: own.edges,
        })
    }

    /// How two cloths meet; nothing where they do not. `range` is the difference of layers from which on
    /// they pass through each other, `thickest` the most that maps make of their thicknesses.
    pub fn between([a, b]: [&ClothFrame; 2], thickest: [f64; 2], range: f64) -> Option<Self> {
        let above = a.layer - b.layer;
        let strength = [a, b].map(|side| side.collide_strength.min(1.0));
        if !a.collide || !b.collide || above.abs() >= range || strength.iter().any(|&side| side <= 0.0) {
            return None;
        }
        // At a difference of one the lower layer is not moved at all.
        let heavier = (1.0 - above.abs()).max(0.0);
        let mobility = if above < 0.0 { [heavier, 1.0] } else { [1.0, heavier] };
        let flat = |side: &ClothFrame| side.elements != Elements::Points;
        let each = |of: fn(&ClothFrame) -> f64| [a, b].map(|side| R::from_f64(of(side)));
        let thickness = a.thickness * thickest[0] + b.thickness * thickest[1];
        Some(Self {
            thickness: thickness.max(LEAST_THICKNESS),
            reach: reach(a.stickiness + b.stickiness),
            sides: each(|side| side.thickness),
            friction: each(|side| side.friction),
            stickiness: each(|side| side.stickiness),
            bounce: each(|side| side.bounce),
            strength: strength.map(R::from_f64),
            untangling: untangling(a.crossover_push + b.crossover_push),
            traps: false,
            mobility: mobility.map(R::from_f64),
            elements: [a.elements, b.elements],
            edges: flat(a) && flat(b),
        })
    }

    /// How a cloth meets a collider; nothing where it does not. `thickest` is the most that maps make of its thickness.
    pub fn with_collider(cloth: &ClothFrame, collider: &ColliderFrame, thickest: f64) -> Option<Self> {
        let strength = [cloth.collide_strength, collider.collide_strength].map(|side| side.min(1.0));
        if !cloth.collide || !collider.collide || strength.iter().any(|&side| side <= 0.0) {
            return None;
        }
        let each = |sides: [f64; 2]| sides.map(R::from_f64);
        let thickness = cloth.thickness * thickest + collider.thickness;
        Some(Self {
            thickness: thickness.max(LEAST_THICKNESS),
            reach: reach(cloth.stickiness + collider.stickiness),
            sides: each([cloth.thickness, collider.thickness]),
            friction: each([cloth.friction, collider.friction]),
            stickiness: each([cloth.stickiness, collider.stickiness]),
            bounce: each([cloth.bounce, collider.bounce]),
            strength: each(strength),
            untangling: 1.0,
            traps: collider.trapped_check,
            mobility: [R::ONE, R::ZERO],
            elements: [cloth.elements, Elements::Faces],
            edges: true,
        })
    }

    /// How a cloth meets the ground plane, which has no thickness; nothing where it does not.
    pub fn with_ground(cloth: &ClothFrame, ground: &GroundPlane, thickest: f64) -> Option<Self> {
        let plane = ColliderFrame {
            collide: true,
            friction: ground.friction,
            stickiness: ground.stickiness,
            bounce: ground.bounce,
            ..ColliderFrame::default()
        };
        let terms = Self::with_collider(cloth, &plane, thickest)?;
        Some(Self { thickness: cloth.thickness * thickest, ..terms })
    }

    /// Whether pairs are found under some terms as they were under those before.
    pub fn find_alike(now: &[Option<Self>], before: &[Option<Self>]) -> bool {
        let of = |terms: &Self| (terms.thickness, terms.reach, terms.traps, terms.elements, terms.edges);
        let found =
            |terms: &[Option<Self>]| terms.iter().map(|terms| terms.as_ref().map(of)).collect::<Vec<_>>();
        found(now) == found(before)
    }

    /// Whether anything of the two sticks.
    pub fn sticks(&self) -> bool {
        self.reach > 1.0
    }

    /// Whether anything of the two can bounce.
    pub fn bounces(&self) -> bool {
        self.bounce.iter().any(|&side| side > R::ZERO)
    }

    /// Whether collisions are carried out in part only: then the two may pass through each other.
    #[inline(always)]
    pub fn is_weak(&self, maps: &Maps<R>) -> bool {
        !maps.strength.is_empty() || self.strength[0] < R::ONE || self.strength[1] < R::ONE
    }

    /// The distance to keep where a contact is, in metres; `most` at the most.
    #[inline(always)]
    pub fn thickness_at<const N: usize, const M: usize>(
        &self,
        maps: &Maps<R>,
        sides: Sides<'_, R, N, M>,
        most: R,
    ) -> R {
        if maps.thickness.is_empty() {
            return most;
        }
        let [ours, theirs] = each(&maps.thickness, self.sides, sides);
        let (there, least) = (ours + theirs, R::from_f64(LEAST_THICKNESS));
        let there = if there < least { least } else { there };
        if there < most { there } else { most }
    }

    /// The sum of both frictions where a contact is.
    #[inline(always)]
    pub fn friction_at<const N: usize, const M: usize>(
        &self,
        maps: &Maps<R>,
        sides: Sides<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = each(&maps.friction, self.friction, sides);
        ours + theirs
    }

    /// The sum of both stickinesses where a contact is.
    #[inline(always)]
    pub fn stickiness_at<const N: usize, const M: usize>(
        &self,
        maps: &Maps<R>,
        sides: Sides<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = each(&maps.stickiness, self.stickiness, sides);
        ours + theirs
    }

    /// The max bounce of the two where a contact is.
    #[inline(always)]
    pub fn bounce_at<const N: usize, const M: usize>(&self, maps: &Maps<R>, sides: Sides<'_, R, N, M>) -> R {
        let [ours, theirs] = each(&maps.bounce, self.bounce, sides);
        if ours > theirs { ours } else { theirs }
    }

    /// How much of a collision is carried out where a contact is.
    #[inline(always)]
    pub fn strength_at<const N: usize, const M: usize>(
        &self,
        maps: &Maps<R>,
        sides: Sides<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = each(&maps.strength, self.strength, sides);
        let strength = ours * theirs;
        if strength > R::ONE { R::ONE } else { strength }
    }
}

/// An attribute of both sides where a contact is.
#[inline(always)]
fn each<R: Real, const N: usize, const M: usize>(
    map: &[R],
    [ours, theirs]: [R; 2],
    (points, others, (b, c)): Sides<'_, R, N, M>,
) -> [R; 2] {
    [ours * at(map, points, *b), theirs * at(map, others, *c)]
}

/// Factor on the pace of working apart: ten times as fast for a push of 1.
fn untangling(push: f64) -> f64 {
    1.0 + 9.0 * push.max(0.0)
}

/// Share of the thickness up to which anything acts.
fn reach(stickiness: f64) -> f64 {
    if stickiness > 0.0 { stick::REACH } else { 1.0 }
}
