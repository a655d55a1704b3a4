//! Contact materials: thickness, friction, stickiness, bounce, strength, layers and element types of a pair of
//! objects in a frame; and vertex maps of them.

use crate::contact::clearance::Clearance;
use crate::contact::collider_maps::{ColliderFactors, ColliderMaps, max_factor};
use crate::contact::kept_gaps::KeptGaps;
use crate::contact::response::ADHESION_RANGE;
use crate::input::frame::{ClothFrame, ColliderFrame, Elements, GroundPlane, ResistanceModel};
use crate::input::particles::{ParticleRamp, RampTarget};
use crate::math::Real;
use crate::model::ClothModel;
use crate::model::objects::Cloth;
use crate::model::vertex_maps::VertexMaps;

/// Contact distance of the particles of two liquids in rest distances, at most: at larger ones they could not mix.
const LIQUID_DISTANCE: f64 = 0.8;
/// Smallest contact thickness in metres: certificates need a gap above rounding error.
pub const MIN_THICKNESS: f64 = 1e-5;

/// The contact material of two objects, or of a cloth with itself. Of a cloth and a collider the cloth comes
/// first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactMaterial<R> {
    /// The contact thickness of the pair in metres: the largest value under its vertex maps.
    pub thickness: f64,
    /// Interaction range of the pair, in thicknesses: 1 without adhesion.
    pub adhesion_range: f64,
    /// The thickness of each side, in metres.
    pub thicknesses: [R; 2],
    /// The friction of each side.
    pub friction: [R; 2],
    /// The stickiness of each side.
    pub stickiness: [R; 2],
    /// The coefficient of restitution of each side.
    pub bounce: [R; 2],
    /// The share of a collision that is carried out, as a factor of each side (`collideStrength`).
    pub strength: [R; 2],
    /// Factor on the speed of untangling where the two intersect.
    pub untangling_rate: f64,
    /// Whether points inside the other object are pushed out of it.
    pub depenetrates: bool,
    /// Factor on the mobility of each side: the lower layer is heavier.
    pub mobility: [R; 2],
    /// The element type of each side that collides with points of the other.
    pub elements: [Elements; 2],
    /// Whether edges collide with edges.
    pub edges: bool,
    /// Whether points in contact with a collider do not slide, whatever pushes them (Classic).
    pub grips: bool,
}

/// The points of the two elements of a contact, and the weight of each of them.
pub type ContactPoints<'a, R, const N: usize, const M: usize> = ([u32; N], [u32; M], &'a ([R; N], [R; M]));

impl<R: Real> ContactMaterial<R> {
    /// A cloth with itself; `None` without self-collision. `max_thickness_factor` is the largest factor of its
    /// thickness map.
    pub fn for_self_collision(cloth: &ClothFrame, max_thickness_factor: f64) -> Option<Self> {
        let own = &cloth.self_collision;
        let both = |x: f64| [R::from_f64(x); 2];
        (own.on && !cloth.is_driven && cloth.collide_strength > 0.0).then(|| Self {
            thickness: (2.0 * own.thickness * max_thickness_factor).max(MIN_THICKNESS),
            adhesion_range: adhesion_range(2.0 * cloth.stickiness),
            thicknesses: both(own.thickness),
            friction: both(cloth.friction),
            stickiness: both(cloth.stickiness),
            bounce: both(cloth.bounce),
            strength: [R::from_f64(cloth.collide_strength.min(1.0)), R::ONE],
            untangling_rate: untangling_rate(cloth.self_crossover_push),
            depenetrates: false,
            mobility: [R::ONE; 2],
            elements: [own.elements; 2],
            edges: own.edges,
            grips: false,
        })
    }

    /// Two cloths; `None` where they do not collide. From a difference of `range` layers on they pass through
    /// each other. `max_thickness_factor` holds the largest factor of each thickness map.
    pub fn for_cloths([a, b]: [&ClothFrame; 2], max_thickness_factor: [f64; 2], range: f64) -> Option<Self> {
        let above = a.layer - b.layer;
        let strength = [a, b].map(|side| side.collide_strength.min(1.0));
        let is_off = !a.collide || !b.collide || (a.is_driven && b.is_driven);
        if is_off || above.abs() >= range || strength.iter().any(|&side| side <= 0.0) {
            return None;
        }
        // At a difference of one layer the lower layer does not move.
        let heavier = (1.0 - above.abs()).max(0.0);
        let mobility = if above < 0.0 { [heavier, 1.0] } else { [1.0, heavier] };
        let per_side = |of: fn(&ClothFrame) -> f64| [a, b].map(|side| R::from_f64(of(side)));
        let thickness = a.thickness * max_thickness_factor[0] + b.thickness * max_thickness_factor[1];
        let thickness = match [&a.liquid, &b.liquid] {
            [Some(own), Some(other)] => thickness.min(LIQUID_DISTANCE * (own.spacing + other.spacing) / 2.0),
            _ => thickness,
        };
        Some(Self {
            thickness: thickness.max(MIN_THICKNESS),
            adhesion_range: adhesion_range(a.stickiness + b.stickiness),
            thicknesses: per_side(|side| side.thickness),
            friction: per_side(|side| side.friction),
            stickiness: per_side(|side| side.stickiness),
            bounce: per_side(|side| side.bounce),
            strength: strength.map(R::from_f64),
            untangling_rate: untangling_rate(a.crossover_push + b.crossover_push),
            depenetrates: false,
            mobility: mobility.map(R::from_f64),
            elements: [a.elements, b.elements],
            edges: a.elements.has_edges() && b.elements.has_edges(),
            grips: false,
        })
    }

    /// A cloth with a collider; `None` where they do not collide: a collider has effect on the same layer and on higher ones,
    /// less than `range` away. `max_thickness_factor` holds the largest factor of each thickness map.
    pub fn for_collider(
        cloth: &ClothFrame,
        collider: &ColliderFrame,
        max_thickness_factor: [f64; 2],
        range: f64,
    ) -> Option<Self> {
        let strength = [cloth.collide_strength, collider.collide_strength].map(|side| side.min(1.0));
        let is_in_range = (0.0..range).contains(&(cloth.layer - collider.layer));
        let is_off = !cloth.collide || cloth.is_driven || !collider.collide || !is_in_range;
        if is_off || strength.iter().any(|&side| side <= 0.0) {
            return None;
        }
        let per_side = |sides: [f64; 2]| sides.map(R::from_f64);
        let thickness =
            cloth.thickness * max_thickness_factor[0] + collider.thickness * max_thickness_factor[1];
        Some(Self {
            thickness: thickness.max(MIN_THICKNESS),
            adhesion_range: adhesion_range(cloth.stickiness + collider.stickiness),
            thicknesses: per_side([cloth.thickness, collider.thickness]),
            friction: per_side([cloth.friction, collider.friction]),
            stickiness: per_side([cloth.stickiness, collider.stickiness]),
            bounce: per_side([cloth.bounce, collider.bounce]),
            strength: per_side(strength),
            untangling_rate: 1.0,
            depenetrates: collider.trapped_check && collider.elements == Elements::Faces,
            mobility: [R::ONE, R::ZERO],
            elements: [cloth.elements, collider.elements],
            edges: cloth.elements.has_edges() && collider.elements.has_edges(),
            grips: false,
        })
    }

    /// A cloth with the ground plane, which has no thickness; `None` where they do not collide.
    pub fn for_ground(cloth: &ClothFrame, ground: &GroundPlane, max_thickness_factor: f64) -> Option<Self> {
        let plane = ColliderFrame {
            collide: true,
            friction: ground.friction,
            stickiness: ground.stickiness,
            bounce: ground.bounce,
            layer: cloth.layer,
            ..ColliderFrame::default()
        };
        let material = Self::for_collider(cloth, &plane, [max_thickness_factor, 1.0], f64::INFINITY)?;
        Some(Self { thickness: cloth.thickness * max_thickness_factor, ..material })
    }

    /// The material where the attributes of the collider, its second side, have these factors.
    pub fn scaled(&self, factors: ColliderFactors) -> Self {
        let scaled = |[ours, theirs]: [R; 2], factor: f64| [ours, theirs * R::from_f64(factor)];
        Self {
            thicknesses: scaled(self.thicknesses, factors.thickness),
            friction: scaled(self.friction, factors.friction),
            stickiness: scaled(self.stickiness, factors.stickiness),
            bounce: scaled(self.bounce, factors.bounce),
            strength: scaled(self.strength, factors.strength),
            ..*self
        }
    }

    /// Whether the materials of a pair in two frames give the same candidates.
    pub fn same_candidates(now: &Option<Self>, before: &Option<Self>) -> bool {
        let of = |material: &Self| {
            (
                material.thickness,
                material.adhesion_range,
                material.depenetrates && material.has_full_strength(),
                material.elements,
                material.edges,
            )
        };
        now.as_ref().map(of) == before.as_ref().map(of)
    }

    /// The same for a frame with this resistance model. Classic: frictions that add up to 1 or more grip, as in recorded
    /// output of the original (a sum of 4.1 holds cloth in place while the cloth beside it stretches to twice its length).
    pub fn for_resistance(self, resistance: ResistanceModel) -> Self {
        let is_full = self.friction[0] + self.friction[1] >= R::ONE;
        Self { grips: resistance == ResistanceModel::Classic && is_full, ..self }
    }

    /// Whether the pair has adhesion.
    pub fn has_adhesion(&self) -> bool {
        self.adhesion_range > 1.0
    }

    /// Whether the pair has restitution.
    pub fn has_restitution(&self) -> bool {
        self.bounce.iter().any(|&side| side > R::ZERO)
    }

    /// Whether collisions are carried out in part only: the two may then pass through each other.
    #[inline(always)]
    pub fn is_partial(&self, maps: &MaterialMaps<R>) -> bool {
        !maps.strength.is_empty() || !self.has_full_strength()
    }

    /// Whether collisions are carried out in full, but for vertex maps.
    #[inline(always)]
    pub fn has_full_strength(&self) -> bool {
        self.strength[0] >= R::ONE && self.strength[1] >= R::ONE
    }

    /// The contact thickness at a contact in metres, `max_thickness` at most.
    #[inline(always)]
    pub fn thickness_at<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
        max_thickness: R,
    ) -> R {
        if maps.thickness.is_empty() {
            max_thickness
        } else {
            self.mapped_thickness(maps, points, max_thickness)
        }
    }

    /// The same where either side has a map.
    pub fn mapped_thickness<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
        max_thickness: R,
    ) -> R {
        let [ours, theirs] = per_side(&maps.thickness, self.thicknesses, points);
        let (there, least) = (ours + theirs, R::from_f64(MIN_THICKNESS));
        let there = if there < least { least } else { there };
        if there < max_thickness { there } else { max_thickness }
    }

    /// The contact thickness in metres of a point of an element of cloth with a point of an element of a collider, each with
    /// the weights of its corners.
    pub fn thickness_with_collider<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        (points, shares): ([u32; N], [f64; N]),
        (collider, corners, weights): (usize, [u32; M], [f64; M]),
    ) -> f64 {
        let most = R::from_f64(self.thickness);
        let of_points = (points, [], &(shares.map(R::from_f64), []));
        match maps.of_collider(collider) {
            None => self.thickness_at(maps, of_points, most),
            Some(own) => self.scaled(own.at(corners, weights)).mapped_thickness(maps, of_points, most),
        }
        .to_f64()
    }

    /// The sum of both frictions at a contact.
    #[inline(always)]
    pub fn friction_at<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = per_side(&maps.friction, self.friction, points);
        ours + theirs
    }

    /// The friction that bounds a tangential impulse at a contact: where the material grips, none does.
    pub fn impact_friction_at<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
    ) -> R {
        if self.grips { R::from_f64(f64::from(f32::MAX)) } else { self.friction_at(maps, points) }
    }

    /// The sum of both stickinesses at a contact.
    #[inline(always)]
    pub fn stickiness_at<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = per_side(&maps.stickiness, self.stickiness, points);
        ours + theirs
    }

    /// The larger coefficient of restitution at a contact, at most 1: above it, every contact would add energy, and cloth
    /// in contact with itself would gain speed without bound.
    #[inline(always)]
    pub fn bounce_at<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = per_side(&maps.bounce, self.bounce, points);
        let larger = if ours > theirs { ours } else { theirs };
        if larger > R::ONE { R::ONE } else { larger }
    }

    /// The share of a collision that is carried out at a contact.
    #[inline(always)]
    pub fn strength_at<const N: usize, const M: usize>(
        &self,
        maps: &MaterialMaps<R>,
        points: ContactPoints<'_, R, N, M>,
    ) -> R {
        let [ours, theirs] = per_side(&maps.strength, self.strength, points);
        let strength = ours * theirs;
        if strength > R::ONE { R::ONE } else { strength }
    }
}

/// An attribute of both sides at a contact.
#[inline(always)]
fn per_side<R: Real, const N: usize, const M: usize>(
    map: &[R],
    [ours, theirs]: [R; 2],
    (points, others, (b, c)): ContactPoints<'_, R, N, M>,
) -> [R; 2] {
    [ours * factor_at(map, points, *b), theirs * factor_at(map, others, *c)]
}

/// Factor on the speed of untangling: ten for a push of 1.
fn untangling_rate(push: f64) -> f64 {
    1.0 + 9.0 * push.max(0.0)
}

/// Interaction range in thicknesses.
fn adhesion_range(stickiness: f64) -> f64 {
    if stickiness > 0.0 { ADHESION_RANGE } else { 1.0 }
}

/// A factor for each row of the solver. A column that no cloth has a map of is empty, and costs nothing.
#[derive(Debug, Clone, Default)]
pub struct MaterialMaps<R> {
    /// On the thickness.
    pub thickness: Vec<R>,
    /// On the friction.
    pub friction: Vec<R>,
    /// On the stickiness.
    pub stickiness: Vec<R>,
    /// On the bounce.
    pub bounce: Vec<R>,
    /// On the collide strength.
    pub strength: Vec<R>,
    /// The largest factor on the thickness of each cloth.
    pub max_thickness_factor: Vec<f64>,
    /// By collider.
    pub colliders: Vec<ColliderMaps>,
    /// Gaps to colliders that points keep from the start (Classic).
    pub kept_gaps: KeptGaps<R>,
    /// The share of the thickness for which there is clearance between colliders, in a time step that had too little.
    pub clearance: Clearance<R>,
}

impl<R: Real> MaterialMaps<R> {
    /// The number of factors.
    pub fn len(&self) -> usize {
        let columns = [&self.thickness, &self.friction, &self.stickiness, &self.bounce, &self.strength];
        let of_colliders: usize = self.colliders.iter().map(ColliderMaps::len).sum();
        columns.iter().map(|column| column.len()).sum::<usize>() + of_colliders
    }

    /// The maps of the colliders that have any.
    pub fn of_collider(&self, collider: usize) -> Option<&ColliderMaps> {
        self.colliders.get(collider).filter(|maps| maps.len() > 0)
    }

    /// The largest factors on the thickness of a cloth and of a collider.
    pub fn max_thickness_factors(&self, cloth: usize, collider: usize) -> [f64; 2] {
        [self.max_thickness_factor[cloth], self.colliders[collider].max_thickness_factor]
    }

    /// The maps of all cloths, over `places` rows, and of all colliders.
    pub fn new(cloths: &[Cloth], models: &[ClothModel<R>], places: usize, colliders: &[VertexMaps]) -> Self {
        let column = |of: fn(&VertexMaps) -> &Vec<f64>, ramp: RampTarget| {
            if cloths.iter().all(|cloth| of(&cloth.vertex_maps).is_empty() && ramp_of(cloth, ramp).is_none())
            {
                return Vec::new();
            }
            let mut column = vec![R::ONE; places];
            for (cloth, model) in cloths.iter().zip(models) {
                for (point, &factor) in of(&cloth.vertex_maps).iter().enumerate() {
                    column[model.place(point) as usize] = R::from_f64(factor);
                }
            }
            column
        };
        let largest = |cloth: &Cloth| match ramp_of(cloth, RampTarget::Radius) {
            Some(ramp) => ramp.max_factor(),
            None => max_factor(&cloth.vertex_maps.thickness),
        };
        Self {
            thickness: column(|factors| &factors.thickness, RampTarget::Radius),
            friction: column(|factors| &factors.friction, RampTarget::Friction),
            stickiness: column(|factors| &factors.stickiness, RampTarget::Stickiness),
            bounce: column(|factors| &factors.bounce, RampTarget::Bounce),
            strength: column(|factors| &factors.collide_strength, RampTarget::CollideStrength),
            max_thickness_factor: cloths.iter().map(largest).collect(),
            colliders: colliders.iter().map(ColliderMaps::new).collect(),
            kept_gaps: KeptGaps::default(),
            clearance: Clearance::default(),
        }
    }
}

/// The ramp of an attribute of particles, if they have one.
fn ramp_of(cloth: &Cloth, target: RampTarget) -> Option<&ParticleRamp> {
    cloth.particles.as_ref()?.ramps.iter().find(|ramp| ramp.target == target)
}

/// The factor at a contact, interpolated over the element; 1 without a map or points.
#[inline(always)]
pub fn factor_at<R: Real, const N: usize>(map: &[R], points: [u32; N], weights: [R; N]) -> R {
    if map.is_empty() || N == 0 { R::ONE } else { (0..N).map(|k| weights[k] * map[points[k] as usize]).sum() }
}
