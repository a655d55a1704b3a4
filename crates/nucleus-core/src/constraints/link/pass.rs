//! The start of a frame for links, and one pass over the links of a constraint.

use crate::constraints::link::combined::LinkFrame;
use crate::constraints::link::contact_distance::Collisions;
use crate::constraints::link::ends::{Ends, Prescribed, vector};
use crate::constraints::link::lists::{ConstraintLinks, Layout, Links};
use crate::constraints::link::rows::LinkPass;
use crate::constraints::link::surface::SurfacePass;
use crate::constraints::link::sweep::LinkSweep;
use crate::constraints::stretch::LinkStrength;
use crate::contact::collider::ColliderState;
use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, ResistanceModel};
use crate::input::links::{ConstraintFrame, Link, LinkMethod};
use crate::math::Real;
use crate::model::Model;
use crate::model::blocks::Partition;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::PassTime;
use crate::state::State;

/// Forms and heals links. Whether any is new, whole again, or a weld from now on or no longer.
pub fn form_links<R: Real>(links: &mut Links<R>, model: &Model<R>, frame: &FrameInput) -> bool {
    let mut changed = links.constraints.len() > frame.constraints.len();
    links.constraints.truncate(frame.constraints.len());
    for (at, settings) in frame.constraints.iter().enumerate() {
        let layout = layout(settings, frame.resistance);
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
            changed |= own.layout.is_weld != layout.is_weld && !own.links.is_empty();
            own.lay_out_again(layout, (&model.cloths, &model.colliders), &links.blocks);
        }
        let heals = settings.glue_strength >= 1.0 && own.glue_strength < 1.0;
        if heals && own.broken.contains(&true) {
            own.broken.fill(false);
            changed = true;
        }
        changed |= settings.can_break && own.break_unglued(settings);
        own.glue_strength = settings.glue_strength;
    }
    changed
}

/// Updates the rows of all links, once the pair filter knows which of them are new.
pub fn begin_links<R: Real>(
    links: &mut Links<R>,
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    frame: &FrameInput,
) {
    let cloths = &model.cloths[..];
    for (own, settings) in links.constraints.iter_mut().zip(&frame.constraints) {
        let prescribed = Prescribed { colliders: &contact.collider_states, frame: settings };
        let collisions = Collisions { frame, pair_filter: &contact.pair_filter, cloths };
        own.begin_frame(&LinkFrame { prescribed, state, cloths, collisions });
    }
}

fn layout(settings: &ConstraintFrame, resistance: ResistanceModel) -> Layout {
    Layout {
        can_break: settings.can_break,
        is_physical: matches!(resistance, ResistanceModel::Physical { .. }),
        is_weld: settings.method == LinkMethod::Weld,
        drops_off: settings.dropoff.is_some(),
    }
}

/// The number of rows of a constraint in a frame, and how often a pass goes over each.
pub fn rows_of_pass<R: Real>(
    links: &Links<R>,
    model: &Model<R>,
    frame: &FrameInput,
    at: usize,
) -> [usize; 2] {
    let of = |own: &ConstraintLinks<R>| [own.rows(), if own.is_swept_both_ways { 2 } else { 1 }];
    let settings = &frame.constraints[at];
    let models = (&model.cloths[..], &model.colliders[..]);
    match &settings.formed {
        Some(formed) => {
            let layout = layout(settings, frame.resistance);
            of(&ConstraintLinks::new(formed.clone(), layout, models, &links.blocks))
        }
        None => links.constraints.get(at).map_or([0, 1], of),
    }
}

/// The largest error of a weld at the end of the frame in metres, beyond the distance that contact keeps.
pub fn max_weld_gap<R: Real>(
    links: &Links<R>,
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    frame: &FrameInput,
) -> f64 {
    let collisions = Collisions { frame, pair_filter: &contact.pair_filter, cloths: &model.cloths };
    let mut most = 0.0f64;
    for (own, settings) in
        links.constraints.iter().zip(&frame.constraints).filter(|(own, _)| own.layout.is_weld)
    {
        let prescribed = Prescribed { colliders: &contact.collider_states, frame: settings };
        let holds = |link: &Link| !link.is_on_surface() && link.fold().is_none();
        let whole = own.links.iter().zip(&own.broken).filter(|(link, broken)| !**broken && holds(link));
        for (link, _) in whole {
            let ends = Ends::new(link, &model.cloths);
            let length = vector(link, &ends, state, prescribed, 1.0).norm();
            let rest = link.rest * settings.rest_scale[1];
            let longest = rest.max(collisions.distance(link));
            most = most.max(rest - length).max(length - longest);
        }
    }
    most
}

/// One pass over the links of a constraint. Where more than two meet at a point they are swept in order and backward, each
/// time with half the strength (see [`link`](super)).
pub fn relax_links<R: Real>(
    links: &mut Links<R>,
    sweep: &LinkSweep<R>,
    (model, colliders, frame): (&Model<R>, &[ColliderState], &FrameInput),
    state: &mut State<R>,
    now: PassTime,
    pool: &ThreadPool,
) {
    let PassTime { at: time, length: h } = now;
    let Links { constraints, blocks } = links;
    let Some(own) = constraints.get_mut(sweep.constraint) else { return };
    let settings = &frame.constraints[sweep.constraint];
    let (sweep, directions) = match own.is_swept_both_ways {
        true => (&sweep.half(), &[false, true][..]),
        false => (sweep, &[false][..]),
    };
    let rest_scale = R::from_f64(settings.rest_scale_at(time));
    let is_physical = own.layout.is_physical;
    let surface = SurfacePass {
        sweep,
        prescribed: Prescribed { colliders, frame: settings },
        models: (&model.cloths, &model.colliders),
        from: time - h / frame.duration,
        time,
        h,
    };
    for &backward in directions {
        let pass = |strength: LinkStrength<R>| LinkPass {
            strength,
            is_physical,
            time: R::from_f64(time),
            per_step: R::from_f64(1.0 / h),
            backward,
        };
        let passes = [pass(LinkStrength { rest_scale, ..sweep.normal }), pass(sweep.bend)];
        if backward {
            own.relax_surface(&surface, state, backward);
        }
        own.sweep(&mut state.displacement, [&passes[0], &passes[1]], blocks.len(), pool);
        if !backward {
            own.relax_surface(&surface, state, backward);
        }
    }
}
