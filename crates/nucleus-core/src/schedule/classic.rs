//! Classic: resistances are counts of evaluations, whose sweeps are interleaved by their due times (§2.2, §2.4).

use crate::constraints::angle::AngleStrength;
use crate::constraints::bend::BendStrength;
use crate::constraints::shape::ShapeStrength;
use crate::constraints::strength_map::Sides;
use crate::constraints::stretch::LinkStrength;
use crate::constraints::weave::WeaveStrength;
use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput};
use crate::math::Real;
use crate::schedule::pass::{Effect, Pass, Sweep, WholeEffect, WholeSweep};
use crate::schedule::resistance::{CLASSIC_SHARE, Share, share};

/// The passes of a Classic substep in the order of their due times: the k-th of n sweeps is due in the middle of the
/// k-th of n equal parts of the substep, the k-th of n contact passes at its end.
pub fn classic<R: Real>(
    frame: &FrameInput,
    substep: f64,
    sweeps: &mut Vec<Sweep<R>>,
    wholes: &mut Vec<WholeSweep>,
) -> Vec<Pass> {
    let mut due: Vec<(f64, PassOrSweep<R>)> = Vec::new();
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        for (sweeps, effect) in classic_effects(settings, substep) {
            let due_time = |k: u32| (f64::from(k) + 0.5) / f64::from(sweeps);
            due.extend((0..sweeps).map(|k| (due_time(k), PassOrSweep::Sweep(Sweep { cloth, effect }))));
        }
        for (count, effect) in classic_wholes(settings, substep) {
            let moment = |k: u32| (f64::from(k) + 0.5) / f64::from(count);
            due.extend((0..count).map(|k| (moment(k), PassOrSweep::Whole(WholeSweep { cloth, effect }))));
        }
    }
    let mut passes = |count: f64, pass: Pass| {
        let passes = share(count, substep).sweeps.max(1);
        due.extend((1..=passes).map(|k| (f64::from(k) / f64::from(passes), PassOrSweep::Pass(pass.clone()))));
    };
    passes(frame.self_collision_iterations, Pass::ClothContact);
    passes(frame.collision_iterations, Pass::ColliderContact);
    due.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut passes = Vec::new();
    for (_, next) in due {
        match next {
            PassOrSweep::Sweep(sweep) => {
                passes.push(Pass::Constraints(sweeps.len()..sweeps.len() + 1));
                sweeps.push(sweep);
            }
            PassOrSweep::Whole(whole) => {
                passes.push(Pass::Whole(wholes.len()));
                wholes.push(whole);
            }
            PassOrSweep::Pass(pass) => passes.push(pass),
        }
    }
    passes
}

/// An entry of the Classic schedule, before sweeps become passes.
enum PassOrSweep<R> {
    Sweep(Sweep<R>),
    Whole(WholeSweep),
    Pass(Pass),
}

/// The effects of a cloth with their sweeps in a substep. Stretch and compression sweep the same links, each on its own side
/// of rest.
fn classic_effects<R: Real>(cloth: &ClothFrame, substep: f64) -> [(u32, Effect<R>); 4] {
    let share_of = |count: f64| {
        let Share { sweeps, strength } = share(count, substep);
        (sweeps, R::from_f64(strength * CLASSIC_SHARE))
    };
    let links = |above: R, below: R| LinkStrength {
        share: Sides { above, below },
        compliance: Sides { above: R::ZERO, below: R::ZERO },
        rest_scale: R::from_f64(cloth.rest_length_scale),
    };
    let rigid = WeaveStrength::rigid;
    let [stretch, compression, shear, bend] = [
        cloth.stretch_resistance,
        cloth.compression_resistance,
        cloth.shear_resistance,
        cloth.bend_resistance,
    ]
    .map(share_of);
    let bending = BendStrength { share: bend.1, compliance: R::ZERO };
    [
        (stretch.0, Effect::Stretch(links(stretch.1, R::ZERO), rigid())),
        (compression.0, Effect::Stretch(links(R::ZERO, compression.1), rigid())),
        (shear.0, Effect::Shear(links(shear.1, shear.1), rigid())),
        (bend.0, Effect::Bend(bending, AngleStrength::of(&cloth.bending))),
    ]
}

/// The effects on a whole cloth with their counts in a substep.
fn classic_wholes(cloth: &ClothFrame, substep: f64) -> Vec<(u32, WholeEffect)> {
    let mut wholes = Vec::new();
    for (count, rigid) in [(cloth.rigidity, true), (cloth.deform_resistance, false)] {
        let Share { sweeps, strength } = share(count, substep);
        let [rigid, deform] = if rigid { [strength, 0.0] } else { [0.0, strength] };
        wholes.push((sweeps, WholeEffect::Shape(ShapeStrength { rigid, deform })));
    }
    if cloth.input_attract.strength > 0.0 {
        // 1 goes all the way however short the substep; small shares add up to theirs in 1/24 s.
        let (all, part) = (cloth.input_attract.strength.min(1.0), substep / COUNT_PERIOD);
        wholes.push((1, WholeEffect::Attract(Some(all * part / (1.0 - all + all * part)))));
    }
    wholes
}
