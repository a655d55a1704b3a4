//! The start of a frame for links, and one pass over the links of a constraint.

use crate::constraints::link::combined::LinkFrame;
use crate::constraints::link::ends::{Ends, Prescribed, vector};
use crate::constraints::link::lists::{ConstraintLinks, Layout, Links};
use crate::constraints::link::rows::LinkPass;
use crate::constraints::link::sweep::LinkSweep;
use crate::constraints::stretch::LinkStrength;
use crate::contact::collider::ColliderState;
use crate::input::frame::{FrameInput, ResistanceModel};
use crate::input::links::{Link, LinkMethod};
use crate::math::Real;
use crate::model::Model;
use crate::model::blocks::Partition;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Forms and heals links, and updates their rows. Whether any link is new, or whole again.
pub fn begin_links<R: Real>(
    links: &mut Links<R>,
    model: &Model<R>,
    state: &State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
) -> bool {
    let is_physical = matches!(frame.resistance, ResistanceModel::Physical { .. });
    let mut changed = links.constraints.len() > frame.constraints.len();
    links.constraints.truncate(frame.constraints.len());
    for (at, settings) in frame.constraints.iter().enumerate() {
        let layout = Layout {
            can_break: settings.can_break,
            is_physical,
            is_weld: settings.method == LinkMethod::Weld,
            drops_off: settings.dropoff.is_some(),
        };
        if links.constraints.len() == at {
            links.constraints.push(ConstraintLinks::empty(layout));
        }
        let own = &mut links.constraints[at];
        if let Some(formed) = &settings.formed {
            changed |= !(formed.is_empty() && own.links.is_empty());
            let models = (&model.cloths[..], &model.colliders[..]);
            let before =
                std::mem::replace(own, ConstraintLinks::new(formed.clone(), layout, models, &links.blocks));
            if settings.glue_strength < 1.0 {
                own.keep_broken(&before);
            }
        } else if own.layout != layout {
            own.lay_out_again(layout, (&model.cloths, &model.colliders), &links.blocks);
        }
        let heals = settings.glue_strength >= 1.0 && own.glue_strength < 1.0;
        if heals && own.broken.contains(&true) {
            own.broken.fill(false);
            changed = true;
        }
        own.glue_strength = settings.glue_strength;
        let prescribed = Prescribed { colliders, frame: settings };
        own.begin_frame(&LinkFrame { prescribed, state, cloths: &model.cloths });
    }
    changed
}

/// The largest error of a weld at the end of the frame, in metres.
pub fn max_weld_gap<R: Real>(
    links: &Links<R>,
    model: &Model<R>,
    state: &State<R>,
    colliders: &[ColliderState],
    frame: &FrameInput,
) -> f64 {
    let mut most = 0.0f64;
    for (own, settings) in
        links.constraints.iter().zip(&frame.constraints).filter(|(own, _)| own.layout.is_weld)
    {
        let prescribed = Prescribed { colliders, frame: settings };
        let holds = |link: &Link| !link.on_surface && link.fold.is_none();
        let whole = own.links.iter().zip(&own.broken).filter(|(link, broken)| !**broken && holds(link));
        for (link, _) in whole {
            let ends = Ends::new(link, &model.cloths);
            let length = vector(link, &ends, state, prescribed, 1.0).norm();
            most = most.max((length - link.rest * settings.rest_scale[1]).abs());
        }
    }
    most
}

/// One pass over the links of a constraint.
pub fn relax_links<R: Real>(
    links: &mut Links<R>,
    sweep: &LinkSweep<R>,
    (model, colliders, frame): (&Model<R>, &[ColliderState], &FrameInput),
    state: &mut State<R>,
    [time, h]: [f64; 2],
    pool: &ThreadPool,
) {
    let Links { constraints, blocks } = links;
    let Some(own) = constraints.get_mut(sweep.constraint) else { return };
    let settings = &frame.constraints[sweep.constraint];
    let pass = |strength: LinkStrength<R>| LinkPass {
        strength,
        is_physical: own.layout.is_physical,
        time: R::from_f64(time),
        per_step: R::from_f64(1.0 / h),
    };
    let rest_scale = R::from_f64(settings.rest_scale_at(time));
    let passes = [pass(LinkStrength { rest_scale, ..sweep.normal }), pass(sweep.bend)];
    own.sweep(&mut state.displacement, [&passes[0], &passes[1]], blocks.len(), pool);
    if !own.surface.is_empty() {
        let prescribed = Prescribed { colliders, frame: settings };
        own.relax_surface(sweep, settings, prescribed, (&model.cloths, &model.colliders), state, [time, h]);
    }
}
