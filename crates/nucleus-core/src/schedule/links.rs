//! The passes over the links of a dynamic constraint.

use crate::constraints::link::sweep::LinkSweep;
use crate::constraints::strength_map::Sides;
use crate::constraints::stretch::LinkStrength;
use crate::input::frame::{COUNT_PERIOD, FrameInput, ResistanceModel};
use crate::input::links::LinkMethod;
use crate::math::Real;
use crate::schedule::resistance::{BENDING_PER_RESISTANCE, STIFFNESS_PER_RESISTANCE, Share, share};

/// One pass over the links of a constraint in a time step of `h` seconds, and the number of such passes.
pub fn link_sweep<R: Real>(frame: &FrameInput, at: usize, h: f64) -> (LinkSweep<R>, u32) {
    let constraint = &frame.constraints[at];
    let [least, most] = constraint.iterations;
    let is_weld = constraint.method == LinkMethod::Weld;
    let is_classic = frame.resistance == ResistanceModel::Classic;
    let counts = |strength: f64| {
        let own = share(strength.clamp(least, most.max(least)), h);
        if is_weld { Share { sweeps: own.sweeps.max(1), strength: 1.0 } } else { own }
    };
    let sweeps = match is_classic {
        true => {
            counts(constraint.strength.max(constraint.tangent_strength).max(constraint.bend_strength)).sweeps
        }
        false => share(least, h).sweeps,
    };
    let sweeps = sweeps.max(1);
    let soft = |strength: f64, unit: f64| match is_classic {
        // Fewer evaluations than passes are weaker ones.
        true => ((strength * h / COUNT_PERIOD / f64::from(sweeps)).min(1.0), 0.0),
        // Several passes are as many springs, each of which has its part of the stiffness.
        false if strength > 0.0 => (1.0, f64::from(sweeps) / (strength * unit * h * h)),
        false => (0.0, 0.0),
    };
    let side = |strength: f64| if is_weld { (1.0, 0.0) } else { soft(strength, STIFFNESS_PER_RESISTANCE) };
    let strength = |(share, compliance): (f64, f64), pulls_only: bool| {
        let both = |x: f64| R::from_f64(x.min(1e30));
        LinkStrength {
            share: Sides { above: both(share), below: if pulls_only { R::ZERO } else { both(share) } },
            compliance: Sides { above: both(compliance), below: both(compliance) },
            rest_scale: R::ONE,
        }
    };
    let pulls_only = constraint.method == LinkMethod::RubberBand;
    let normal = strength(side(constraint.strength), pulls_only);
    let mut tangent = side(constraint.tangent_strength);
    if constraint.slides {
        // Of the motion along the surface in a step, friction keeps a share; the rest loads a spring and a damper in turn.
        let friction = constraint.friction.clamp(0.0, 1.0);
        let kept = (1.0 - friction) * h / ((1.0 - friction) * h + friction * COUNT_PERIOD);
        let taken = 1.0 - libm::pow(kept, 1.0 / f64::from(sweeps));
        // A friction of 1 locks, however weak the link is.
        let share = tangent.0 / (tangent.0 + (1.0 - tangent.0) * kept).max(f64::MIN_POSITIVE);
        tangent = (share * taken, tangent.1 * kept / (1.0 - kept).max(f64::MIN_POSITIVE));
    }
    let tangent = strength(tangent, pulls_only);
    let bend = strength(soft(constraint.bend_strength, BENDING_PER_RESISTANCE), false);
    (LinkSweep { constraint: at, normal, tangent, bend }, sweeps)
}
