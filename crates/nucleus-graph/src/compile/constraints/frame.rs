//! The attributes of constraints in a frame, and the links that are formed at its start.
//!
//! Links are formed when a constraint becomes enabled, from positions then (N2.4-5), and in every frame where
//! `connectionUpdate` says so. Sliding links are formed once: the solver moves them in every time step.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use nucleus_core::{
    ClothId, ConstraintFrame, Exclusion, Falloff, Link, LinkForce, LinkMethod, PointId, Surface,
};

use crate::animation::Affine;
use crate::attributes::dynamic_constraint as con;
use crate::compile::force_fields::FIELD_ACCELERATION;
use crate::compile::program::{EvaluationInterval, NucleusProgram};
use crate::graph::{EvalContext, NodeId};

use super::forming::Forming;
use super::kinds::Values;
use super::member::{ConstraintSource, MemberObject, Part, Places};

/// `bendBreakAngle` of a tearable surface that keeps the bend resistance of its cloth, in degrees.
const TEARABLE_BREAK_ANGLE: f64 = 5.0;

impl ConstraintSource {
    /// Whether joined edges resist folding.
    fn bends(&self, values: &Values<'_>) -> bool {
        self.kept_bend.is_some() || values.toggle(&con::BEND)
    }

    fn bend_strength(&self, values: &Values<'_>) -> f64 {
        let given = values.at.graph().is_given(self.node, &con::BEND_STRENGTH);
        match self.kept_bend.filter(|_| !given) {
            Some(resistance) => resistance,
            None if self.bends(values) => values.number(&con::BEND_STRENGTH),
            None => 0.0,
        }
    }

    /// Sine of half the angle at which folds break; 1 for never.
    fn break_half_sine(&self, values: &Values<'_>) -> f64 {
        let given = values.at.graph().is_given(self.node, &con::BEND_BREAK_ANGLE);
        let angle = match self.kept_bend.is_some() && !given {
            true => TEARABLE_BREAK_ANGLE,
            false => values.number(&con::BEND_BREAK_ANGLE),
        };
        if angle >= 180.0 { 1.0 } else { (angle.max(0.0).to_radians() / 2.0).sin() }
    }
}

impl NucleusProgram {
    /// The constraints with links, in the order of [`FrameInput::constraints`](nucleus_core::FrameInput).
    pub(crate) fn linking_constraints(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.constraints.iter().filter(|source| source.part.is_some()).map(|source| source.node)
    }

    /// Whether a restored state of constraints fits.
    pub(crate) fn accepts_constraints(&self, formed: &[bool]) -> bool {
        formed.is_empty() || formed.len() == self.constraints.len()
    }
}

impl EvaluationInterval<'_> {
    /// The constraints of this interval. `formed` says which of them have links; `position` gives the solved positions at
    /// its start, in metres.
    pub(crate) fn constraint_frames(
        &self,
        formed: &mut Vec<bool>,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Vec<ConstraintFrame> {
        formed.resize(self.nucleus.constraints.len(), false);
        let sources = self.nucleus.constraints.iter().zip(formed.iter_mut());
        let mut frames = Vec::new();
        for (source, formed) in sources.filter(|(source, _)| source.part.is_some()) {
            let values = Values::new(&self.to, source.node);
            let is_enabled = self.is_enabled(source);
            let slides = values.slides();
            let per_frame = values.updates_per_frame() && !slides;
            let links = match is_enabled {
                true if !*formed || per_frame => Some(self.formed_links(source, position)),
                false if *formed => Some(Vec::new()),
                _ => None,
            };
            *formed = is_enabled;
            frames.push(self.constraint_frame(source, &values, slides, links));
        }
        frames
    }

    /// The collision exclusions of this interval.
    pub(crate) fn exclusions(&self) -> Vec<Arc<Exclusion>> {
        let enabled = self.nucleus.constraints.iter().filter(|source| self.is_enabled(source));
        enabled.filter_map(|source| source.exclusion.clone()).collect()
    }

    fn is_enabled(&self, source: &ConstraintSource) -> bool {
        self.to.get(source.node, &con::ENABLE) && self.to.get(source.node, &con::IS_DYNAMIC)
    }

    fn constraint_frame(
        &self,
        source: &ConstraintSource,
        values: &Values<'_>,
        slides: bool,
        formed: Option<Vec<Link>>,
    ) -> ConstraintFrame {
        let units = self.nucleus.units;
        let constant = values.choice(&con::REST_LENGTH_METHOD) == con::CONSTANT_REST_LENGTH.0;
        let is_force = source.part == Some(Part::ForceToOrigin);
        let force = values.number(&con::FORCE);
        let to_space = values.choice(&con::CONSTRAINT_RELATION) == 0;
        let dropoff = values.dropoff(|length| units.length(length));
        let strength = |key| if is_force { 0.0 } else { values.number(key) };
        let flat = Falloff { distance: 1.0, samples: [1.0; Falloff::SAMPLES] };
        let space = [&self.from, &self.to].map(|moment| self.space(source, moment));
        ConstraintFrame {
            formed,
            method: match values.choice(&con::CONSTRAINT_METHOD) {
                0 if !is_force => LinkMethod::Weld,
                2 => LinkMethod::RubberBand,
                _ => LinkMethod::Spring,
            },
            strength: strength(&con::STRENGTH),
            tangent_strength: strength(&con::TANGENT_STRENGTH),
            rest_scale: [&self.from, &self.to].map(|moment| {
                let values = Values::new(moment, source.node);
                match constant {
                    true => units.length(values.number(&con::REST_LENGTH)),
                    false => values.number(&con::REST_LENGTH_SCALE),
                }
            }),
            bend_strength: if is_force { 0.0 } else { source.bend_strength(values) },
            break_half_sine: source.break_half_sine(values),
            iterations: [&con::MIN_ITERATIONS, &con::MAX_ITERATIONS]
                .map(|key| self.to.get(source.node, key).max(0) as f64),
            glue_strength: values.number(&con::GLUE_STRENGTH),
            glue_scale: values.number(&con::GLUE_STRENGTH_SCALE),
            can_break: source.can_break && !is_force,
            slides,
            friction: values.number(&con::FRICTION),
            keep_off: values.toggle(&con::LOCAL_COLLIDE).then(|| self.kept_distance(source, values)),
            single_sided: self.to.get(source.node, &con::SINGLE_SIDED),
            damp: if is_force { 0.0 } else { values.number(&con::DAMP) },
            motion_drag: if is_force { 0.0 } else { values.number(&con::MOTION_DRAG) },
            force: (force != 0.0 && (is_force || !to_space)).then(|| LinkForce {
                acceleration: force * FIELD_ACCELERATION,
                falloff: dropoff.unwrap_or(flat),
            }),
            dropoff: dropoff.filter(|_| !is_force),
            space,
        }
    }

    /// The space of a constraint in metres. A constraint that never moves has its links in world space.
    fn space(&self, source: &ConstraintSource, moment: &EvalContext) -> (Matrix3<f64>, Vector3<f64>) {
        if !source.moves && source.part == Some(Part::Links) {
            return (Matrix3::identity(), Vector3::zeros());
        }
        let placement: Affine = moment.placement(source.node);
        (placement.linear, self.nucleus.units.point(placement.offset))
    }

    /// The distance in metres that points keep from a surface: the thickness of both sides, or a constant rest length below.
    fn kept_distance(&self, source: &ConstraintSource, values: &Values<'_>) -> f64 {
        let of = |object: MemberObject| match object {
            MemberObject::Cloth(cloth) => {
                let cloth = &self.nucleus.cloths[cloth.index()];
                self.thickness(cloth.node, cloth.default_thickness)
            }
            MemberObject::Collider(collider) => {
                let collider = &self.nucleus.colliders[collider.index()];
                self.thickness(collider.node, collider.default_thickness)
            }
        };
        let mut objects: Vec<MemberObject> = source.members.iter().map(|member| member.object).collect();
        objects.dedup();
        let thickness: f64 = objects.into_iter().take(2).map(of).sum();
        let distance = thickness * values.number(&con::COLLIDE_WIDTH_SCALE);
        // Links of a constant length do not say how near they started.
        match values.choice(&con::REST_LENGTH_METHOD) == con::CONSTANT_REST_LENGTH.0 {
            true => distance.min(self.nucleus.units.length(values.number(&con::REST_LENGTH)).abs()),
            false => distance,
        }
    }

    fn formed_links(
        &self,
        source: &ConstraintSource,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Vec<Link> {
        let values = Values::new(&self.from, source.node);
        let places = self.places(source, position);
        let metres = self.nucleus.units.length(1.0);
        let bends = source.bends(&values);
        let forming = Forming { values, source, places: &places, metres, bends };
        let to_space = values.choice(&con::CONSTRAINT_RELATION) == 0;
        match source.part {
            Some(Part::ForceToOrigin) => forming.to_space(|_| Vector3::zeros()),
            _ if to_space => {
                let (linear, offset) = self.space(source, &self.from);
                // With a scale of zero there is no inverse: all points move to the origin of the constraint.
                let inverse = linear.try_inverse().unwrap_or_default();
                forming.to_space(|place| inverse * (place - offset))
            }
            _ => forming.links(),
        }
    }

    /// The positions of all members at the start of the interval, in metres.
    fn places(
        &self,
        source: &ConstraintSource,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Places {
        let (model, units) = (&self.nucleus.model, self.nucleus.units);
        let mut places = Places {
            cloths: vec![Vec::new(); self.nucleus.cloths.len()],
            colliders: vec![Vec::new(); self.nucleus.colliders.len()],
        };
        for member in &source.members {
            match member.object {
                MemberObject::Cloth(cloth) => {
                    let start = model.positions(cloth);
                    let now = |point: usize| position(cloth, PointId(point as u32));
                    places.cloths[cloth.index()] = match self.is_first {
                        true => start.to_vec(),
                        false => (0..start.len()).map(now).collect(),
                    };
                }
                MemberObject::Collider(collider) => {
                    let own = &self.nucleus.colliders[collider.index()];
                    let Surface { positions, .. } = &model.colliders()[collider.index()].surface;
                    places.colliders[collider.index()] = match &own.motion {
                        None => positions.clone(),
                        Some(motion) => {
                            let placement = self.from.placement(own.mesh);
                            let points = motion.at(&self.from);
                            units.placed(&placement, &points)
                        }
                    };
                }
            }
        }
        places
    }
}
