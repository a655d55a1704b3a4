//! The passes of a time step over contacts among cloths: predict motion bounds, search, push.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::cloth::ClothContacts;
use crate::contact::cloth::broad_phase::{RefreshKind, SearchInput, find_candidates};
use crate::contact::cloth::cache::ContactCache;
use crate::contact::cloth::contact::ClothStep;
use crate::contact::cloth::motion_bounds::{BoundPredictor, Trajectory, mean_motion};
use crate::contact::cloth::response::FrictionAnchors;
use crate::contact::cloth::untangling::UNTANGLING_SPEED;
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::contact::time_step::{ContactCounters, PositionWriter};
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4, scale, sub};
use crate::output::{Stage, StepObserver};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::{ContactSystem, Model, Solver};
use crate::state::State;

/// Length of a candidate interval in seconds, and its smallest length in time steps. Longer intervals find more
/// contacts, shorter ones are searched more often: a drape takes a seventh longer with twice the length, at 24
/// and at 96 evaluations.
const CANDIDATE_INTERVAL: f64 = 0.01;
const MIN_INTERVAL_STEPS: f64 = 4.0;
/// Radius of a motion bound, in thicknesses and in edge lengths: the larger counts.
const BOUND_RADIUS: [f64; 2] = [0.4, 0.08];
/// Smallest radius of a motion bound, in metres.
const MIN_BOUND_RADIUS: f64 = 1e-6;
/// Predicted motion relative to the mean, at most, in edge lengths: longer boxes would overlap too much.
const MAX_TRAVEL: f64 = 2.0;
/// In metres: more than any motion in a frame, and finite in single precision.
const UNLIMITED_TRAVEL: f64 = 1e9;

impl<R: Real> Solver<R> {
    /// Sets the contact materials of this frame, and carries motion bounds over to it. Before anchors move.
    pub(crate) fn begin_contact(&mut self, frame: &FrameInput) {
        let Some(cloth_contacts) = &mut self.contact.cloth_contacts else { return };
        let (cloths, max_thickness_factor) =
            (&frame.cloths, &self.contact.material_maps.max_thickness_factor);
        let materials: Vec<Option<ContactMaterial<R>>> =
            (0..cloths.len()).flat_map(|cloth| materials_of(cloth, frame, max_thickness_factor)).collect();
        let collides_fully = |materials: &[Option<ContactMaterial<R>>]| -> Vec<bool> {
            materials
                .iter()
                .map(|material| {
                    material
                        .as_ref()
                        .is_some_and(|material| !material.is_partial(&self.contact.material_maps))
                })
                .collect()
        };
        if collides_fully(&materials) != collides_fully(&cloth_contacts.materials) {
            cloth_contacts.untangling.is_search_due = true; // pairs that could pass may intersect now
        }
        if !ContactMaterial::same_candidates(&materials, &cloth_contacts.materials) {
            cloth_contacts.bounds_violated.fill(true);
        }
        cloth_contacts.materials = materials;
        if !cloth_contacts.is_enabled() {
            cloth_contacts.bounds_violated.fill(true);
            cloth_contacts.cache = ContactCache::default(); // its bounds would not be checked
        }
        cloth_contacts.trajectories.shift_anchors(&self.state.displacement);
        for (interval_start, moved) in cloth_contacts.interval_start.iter_mut().zip(&self.state.displacement)
        {
            let [x, y, z] = sub(interval_start.xyz(), moved.xyz());
            *interval_start = Row4([x, y, z, R::ZERO]);
        }
        cloth_contacts.interval = [cloth_contacts.interval[0] - 1.0, 0.0];
    }

    /// Invalidates the motion bounds of a point whose position was set, among cloths and colliders.
    pub(crate) fn invalidate_bounds(&mut self, row: usize) {
        let Self { contact: ContactSystem { cloth_contacts, bounds_violated, .. }, .. } = self;
        let among_cloths = cloth_contacts.as_mut().and_then(|contacts| contacts.bounds_violated.get_mut(row));
        bounds_violated
            .get_mut(row)
            .into_iter()
            .chain(among_cloths)
            .for_each(|is_violated| *is_violated = true);
    }

    /// The contact materials of a cloth with itself and with every other cloth.
    pub(crate) fn cloth_materials_of(&self, frame: &FrameInput, cloth: usize) -> Vec<ContactMaterial<R>> {
        materials_of(cloth, frame, &self.contact.material_maps.max_thickness_factor).flatten().collect()
    }

    /// One sweep over contacts among cloths. `thickness_scale` is a factor on every thickness.
    pub(crate) fn resolve_cloth_contacts(
        &mut self,
        thickness_scale: f64,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
        watch: &mut dyn StepObserver,
    ) {
        if !self.contact.cloth_contacts.as_ref().is_some_and(ClothContacts::is_enabled) {
            return;
        }
        watch.enter(Stage::BroadPhase);
        self.update_cloth_candidates(frame, span, counters);
        watch.enter(Stage::Contact);
        let Self {
            state,
            pool,
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, contact_mask, .. },
            ..
        } = self
        else {
            return;
        };
        let mask = &contact_mask[..];
        let ClothContacts { elements, materials, cache, interval_start, untangling, .. } = cloth_contacts;
        if untangling.any() {
            let most = elements.edge_length * UNTANGLING_SPEED * schedule.h;
            let anchors = std::mem::take(&mut state.anchor);
            untangling.untangle(
                &anchors,
                &ClothStep { mask, ..cloth_step(state, materials, material_maps, schedule.h) },
                &elements.cloth,
                most,
            );
            state.anchor = anchors;
        }
        let anchors = Some(FrictionAnchors { interval_start, intersecting: untangling.cloth_pairs() });
        let thickness_scale = R::from_f64(thickness_scale);
        let step = ClothStep {
            thickness_scale,
            anchors,
            mask,
            ..cloth_step(state, materials, material_maps, schedule.h)
        };
        *counters.contacts.get_mut() += cache.sweep(&step, pool);
    }

    /// Applies adhesion of cloth with itself and with other cloth.
    pub(crate) fn apply_cloth_adhesion(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        counters: &mut ContactCounters,
    ) {
        let has_adhesion = |contacts: &ClothContacts<R>| {
            contacts.materials.iter().flatten().any(ContactMaterial::has_adhesion)
        };
        if self.contact.cloth_contacts.as_ref().is_some_and(has_adhesion) {
            self.update_cloth_candidates(frame, span, counters);
            let Self {
                state,
                pool,
                contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. },
                ..
            } = self
            else {
                return;
            };
            cloth_contacts
                .cache
                .adhere(&cloth_step(state, &cloth_contacts.materials, material_maps, schedule.h), pool);
        }
    }

    /// Ensures that the contact cache includes all that can touch in this step. Does nothing while every point
    /// keeps its motion bound.
    pub(crate) fn update_cloth_candidates(
        &mut self,
        frame: &FrameInput,
        now: StepInterval,
        counters: &mut ContactCounters,
    ) {
        let Some(cloth_contacts) = &mut self.contact.cloth_contacts else { return };
        let is_within = now.to <= cloth_contacts.interval[1] + 1e-9;
        let refresh = if is_within { RefreshKind::Incremental } else { RefreshKind::Full };
        let previous_start = cloth_contacts.interval[0];
        if refresh.is_incremental() {
            if !self.find_violations(now) {
                return;
            }
        } else {
            let least = (now.to - now.from) * MIN_INTERVAL_STEPS;
            // The nearest whole number of intervals of equal length in a frame.
            let length = least.max(1.0 / (frame.duration / CANDIDATE_INTERVAL).round().max(1.0));
            let end = (now.from + length).min(1.0);
            cloth_contacts.interval = [now.from, end.max(now.to)];
            if cloth_contacts.untangling.may_exist() {
                cloth_contacts.bounds_violated.fill(true);
            }
        }
        self.predict_trajectories(frame, now, previous_start, refresh);
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. },
            ..
        } = self
        else {
            return;
        };
        let interval_share = (now.from - cloth_contacts.interval[0])
            / (cloth_contacts.interval[1] - cloth_contacts.interval[0]);
        let displacement = [&state.start[..], &state.displacement[..]];
        find_candidates(
            cloth_contacts,
            SearchInput {
                cloths,
                anchors: &state.anchor,
                displacement,
                interval_share,
                strength: &material_maps.strength,
            },
            refresh,
            pool,
        );
        *counters.candidate_pairs.get_mut() += cloth_contacts.cache.len();
        *counters.broad_phases.get_mut() += 1;
    }

    /// Marks the points that violate their bounds at the end of the step. Returns whether there are any.
    fn find_violations(&mut self, now: StepInterval) -> bool {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), .. },
            ..
        } = self
        else {
            return false;
        };
        let ClothContacts { interval: [from, to], bounds_violated, trajectories, .. } = cloth_contacts;
        let share = R::from_f64((now.to - *from) / (*to - *from));
        let any = AtomicBool::new(false);
        let bounds_violated = DisjointSlice::new(bounds_violated);
        for cloth in cloths.iter() {
            pool.parallel_for(cloth.blocks.len(), |block| {
                let mut any_here = false;
                for row in cloth.blocks.range(block) {
                    let is_inside =
                        trajectories.of(row).contains(share, state.displacement[row as usize].xyz());
                    any_here |= !is_inside;
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        bounds_violated.set(row, !is_inside);
                    }
                }
                any.fetch_or(any_here, Ordering::Relaxed);
            });
        }
        any.into_inner()
    }

    /// Predicts trajectories for the points that violate theirs. In a full refresh, points that stay near the end
    /// of their last trajectory get a trajectory at rest there, without a search. `previous_start` is the start
    /// of the last interval.
    fn predict_trajectories(
        &mut self,
        frame: &FrameInput,
        now: StepInterval,
        previous_start: f64,
        refresh: RefreshKind,
    ) {
        let Self {
            state,
            pool,
            model: Model { cloths, .. },
            contact: ContactSystem { cloth_contacts: Some(cloth_contacts), .. },
            ..
        } = self
        else {
            return;
        };
        let ClothContacts { trajectories, interval_start, interval, bounds_violated, cache, .. } =
            cloth_contacts;
        let of_last = R::from_f64((now.to - now.from) / (now.from - previous_start).max(now.to - now.from));
        let (trajectories, bounds_violated) = (trajectories.shared(), DisjointSlice::new(bounds_violated));
        for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
            let rows = cloth.points().start as usize..cloth.points().end as usize;
            let common = mean_motion(&state.start[rows.clone()], &state.displacement[rows]);
            let predictor = BoundPredictor::new(now, *interval, common);
            let thickness = settings.thickness.max(settings.self_collision.thickness);
            let [of_thickness, of_edge] = BOUND_RADIUS;
            let radius = (of_thickness * thickness).max(of_edge * cloth.edge_length).max(MIN_BOUND_RADIUS);
            // A free point has a small box at any speed, so its line needs no limit.
            let is_free = cloth.boundary.triangles.is_empty();
            let farthest = if is_free { UNLIMITED_TRAVEL } else { MAX_TRAVEL * cloth.edge_length };
            let (radius, farthest) = (R::from_f64(radius), R::from_f64(farthest));
            pool.parallel_for(cloth.blocks.len(), |block| {
                for row in cloth.blocks.range(block) {
                    let before = state.start[row as usize].xyz();
                    let motion = sub(state.displacement[row as usize].xyz(), before);
                    // The motion of a trembling point over one step does not extrapolate; its motion over the
                    // last interval does.
                    let last_motion = (!refresh.is_incremental() && now.from > previous_start)
                        .then(|| sub(before, interval_start[row as usize].xyz()));
                    let rate = last_motion.map_or(motion, |last_motion| scale(last_motion, of_last));
                    // SAFETY: blocks do not overlap.
                    #[allow(unsafe_code)]
                    unsafe {
                        if !bounds_violated.get(row) {
                            if refresh.is_incremental() {
                                continue;
                            }
                            let last = trajectories.of(row);
                            let rest = Trajectory {
                                origin: last.at(R::ONE),
                                travel: [R::ZERO; 3],
                                radius: last.radius,
                            };
                            if predictor.stays_within(&rest, before, motion)
                                || predictor.stays_within(&rest, before, rate)
                            {
                                trajectories.set(row, rest);
                                continue;
                            }
                            bounds_violated.set(row, true);
                        }
                        trajectories
                            .set(row, predictor.extrapolate(before, [motion, rate], radius, farthest));
                    }
                }
            });
        }
        if !refresh.is_incremental() {
            cache.carry_anchors(&state.start, interval_start);
            interval_start.clone_from(&state.start);
        }
    }
}

/// The contact materials of a cloth with each cloth, itself among them.
fn materials_of<'a, R: Real>(
    cloth: usize,
    frame: &'a FrameInput,
    max_thickness_factor: &'a [f64],
) -> impl Iterator<Item = Option<ContactMaterial<R>>> + 'a {
    let own = &frame.cloths[cloth];
    frame.cloths.iter().enumerate().map(move |(at, other)| match at == cloth {
        true => ContactMaterial::for_self_collision(other, max_thickness_factor[cloth]),
        false => ContactMaterial::for_cloths(
            [own, other],
            [max_thickness_factor[cloth], max_thickness_factor[at]],
            frame.layer_range,
        ),
    })
}

/// A time step of all cloths.
pub(crate) fn cloth_step<'a, R: Real>(
    state: &'a mut State<R>,
    materials: &'a [Option<ContactMaterial<R>>],
    material_maps: &'a MaterialMaps<R>,
    h: f64,
) -> ClothStep<'a, R> {
    let State { displacement, predicted, depenetration_by_collider, depenetration_by_cloth, start, .. } =
        state;
    ClothStep {
        writer: PositionWriter::new(
            [displacement, depenetration_by_collider, depenetration_by_cloth],
            predicted,
        ),
        start,
        anchors: None,
        mask: &[],
        materials,
        material_maps,
        h: R::from_f64(h),
        thickness_scale: R::ONE,
    }
}
