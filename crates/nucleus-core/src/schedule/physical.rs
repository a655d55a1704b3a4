//! Physical: resistances are stiffnesses, and a time step has one sweep of every effect (Macklin et al. 2019).

use crate::constraints::angle::AngleStrength;
use crate::constraints::bend::BendStrength;
use crate::constraints::shape::{DEFORM_RATE, RIGID_RATE, ShapeStrength};
use crate::constraints::strength_map::Sides;
use crate::constraints::stretch::LinkStrength;
use crate::constraints::weave::WeaveStrength;
use crate::input::frame::{ClothFrame, FrameInput};
use crate::math::Real;
use crate::schedule::pass::{Effect, Pass, Sweep, WholeEffect, WholeSweep};
use crate::schedule::resistance::PhysicalStiffness;

/// The passes of a Physical time step: one sweep of every effect, then contact.
///
/// Bending is swept in every step too, although it is soft. Swept in every fourth step with four times the strength, it
/// removes a bend at once, the velocity continues for three steps more, and fine meshes of triangles become noisy.
pub fn physical<R: Real>(
    frame: &FrameInput,
    h: f64,
    sweeps: &mut Vec<Sweep<R>>,
    wholes: &mut Vec<WholeSweep>,
) -> Vec<Pass> {
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        let mut add = |stiffness: f64, effect: Effect<R>| {
            if stiffness > 0.0 {
                sweeps.push(Sweep { cloth, effect });
            }
        };
        let stiffness = PhysicalStiffness::of(settings);
        let PhysicalStiffness { stretch, compression, shear, bend, warp, weft } = stiffness;
        let weave = WeaveStrength::new(&stiffness, settings.buckles, h);
        let links = |above: f64, below: f64| physical_links(settings, above, below, h);
        let above = stretch.max(warp).max(weft);
        add(above.max(compression), Effect::Stretch(links(stretch, compression), weave));
        add(shear, Effect::Shear(links(shear, shear), weave));
        let compliance = compliance(bend, h);
        add(
            bend,
            Effect::Bend(BendStrength { share: R::ONE, compliance }, AngleStrength::of(&settings.bending)),
        );
    }
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        let share = |rate: f64, resistance: f64| {
            let stiff = rate * rate * resistance.max(0.0) * h * h;
            stiff / (1.0 + stiff)
        };
        let rigid = share(RIGID_RATE, settings.rigidity);
        let deform = share(DEFORM_RATE, settings.deform_resistance);
        if rigid > 0.0 || deform > 0.0 {
            wholes.push(WholeSweep { cloth, effect: WholeEffect::Shape(ShapeStrength { rigid, deform }) });
        }
        if settings.input_attract.strength > 0.0 {
            wholes.push(WholeSweep { cloth, effect: WholeEffect::Attract(None) });
        }
    }
    let mut passes = vec![Pass::Constraints(0..sweeps.len())];
    // What acts within a cloth comes before its torque is taken away, and what draws it to a mesh comes after.
    let (within, from_outside): (Vec<usize>, Vec<usize>) =
        (0..wholes.len()).partition(|&at| matches!(wholes[at].effect, WholeEffect::Shape(_)));
    passes.extend(within.iter().copied().map(Pass::Whole));
    let is_swept = |cloth: &usize| {
        sweeps.iter().any(|sweep| sweep.cloth == *cloth)
            || within.iter().any(|&at| wholes[at].cloth == *cloth)
    };
    passes.extend((0..frame.cloths.len()).filter(is_swept).map(Pass::AngularMomentum));
    passes.extend(from_outside.into_iter().map(Pass::Whole));
    passes.extend([Pass::ClothContact, Pass::ColliderContact]);
    passes
}

/// The strength of links with these stiffnesses in N/m; a side without stiffness is not corrected.
fn physical_links<R: Real>(cloth: &ClothFrame, above: f64, below: f64, h: f64) -> LinkStrength<R> {
    let side = |stiffness: f64| match stiffness > 0.0 {
        true => (R::ONE, compliance(stiffness, h)),
        false => (R::ZERO, R::ZERO),
    };
    let (above, below) = (side(above), side(below));
    LinkStrength {
        share: Sides { above: above.0, below: below.0 },
        compliance: Sides { above: above.1, below: below.1 },
        rest_scale: R::from_f64(cloth.rest_length_scale),
    }
}

/// 1 / (stiffness h²), bounded so that it is finite in `f32`: a resistance that is keyed down to zero passes through
/// all sizes.
fn compliance<R: Real>(stiffness: f64, h: f64) -> R {
    const MAX_COMPLIANCE: f64 = 1e30;
    R::from_f64((1.0 / (stiffness * h * h)).min(MAX_COMPLIANCE))
}
