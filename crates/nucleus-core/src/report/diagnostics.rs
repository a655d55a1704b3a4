//! The report of a frame: counters of its contacts, and strain, gaps and energy at its end. A step cannot fail;
//! whatever it could not satisfy is counted here.

use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;

use nalgebra::Vector3;

use crate::constraints::bend::RestingHinges;
use crate::constraints::hinge::{HingeGroup, energy_of_length};
use crate::constraints::link::pass::max_weld_gap;
use crate::constraints::liquid::LiquidSolver;
use crate::constraints::strength_map::StrengthGroup;
use crate::constraints::stretch::LinkGroup;
use crate::constraints::weave::{self, WeaveGroup};
use crate::contact::cloth::contact::ClothStep;
use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::pair_filter::PairFilter;
use crate::contact::system::ContactSystem;
use crate::contact::time_step::{ColliderStepArgs, ContactCounters};
use crate::input::frame::{ClothFrame, FrameInput, ResistanceModel};
use crate::math::{Real, dot};
use crate::model::ClothModel;
use crate::model::rows::RowList;
use crate::output::StepReport;
use crate::schedule::resistance::PhysicalStiffness;
use crate::schedule::{Schedule, TimeInterval};
use crate::solver::Solver;
use crate::state::State;

/// Strains are counted in `BINS` bins of this width; the last one also counts everything above.
const BIN: f64 = 1e-4;
const BINS: usize = 10_000;

/// The report of the frame that has just ended.
pub fn report<R: Real>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    counters: &ContactCounters,
) -> StepReport {
    let (max_strain, strain_99) = strains(&solver.model.cloths, &solver.state, frame);
    let points = PointFigures::of(&solver.model.cloths, &solver.state, &solver.contact.pair_filter, frame);
    StepReport {
        max_strain,
        strain_99,
        min_gap: smallest_gap(solver, points.ground_gap, schedule),
        min_cloth_gap: smallest_cloth_gap(solver),
        rest_limited: solver
            .contact
            .cloth_contacts
            .as_ref()
            .map_or(0, |contacts| contacts.cache.count_rest_limited()),
        contacts: counters.contacts.load(Relaxed),
        candidate_pairs: counters.candidate_pairs.load(Relaxed),
        broad_phases: counters.broad_phases.load(Relaxed) as u32,
        pairs_reverted: counters.pairs_reverted.load(Relaxed),
        pairs_unresolved: counters.pairs_unresolved.load(Relaxed),
        depenetrating: solver
            .contact
            .collider_contacts
            .iter()
            .map(|list| list.depenetration.points.len() as u64)
            .sum(),
        intersections: solver
            .contact
            .cloth_contacts
            .as_ref()
            .map_or(0, |contacts| contacts.untangling.intersections.len() as u64),
        broken_links: solver.links.broken(),
        max_weld_gap: max_weld_gap(&solver.links, &solver.model, &solver.state, &solver.contact, frame),
        particles: solver.state.populations.iter().map(|population| population.len() as u64).sum(),
        births: counters.births,
        deaths: counters.deaths,
        births_refused: counters.births_refused,
        births_pruned: counters.births_pruned,
        density_error: solver.liquids.iter().map(LiquidSolver::density_error).fold(0.0, f64::max),
        kinetic_energy: points.kinetic_energy,
        finite: points.finite,
        ..StepReport::default()
    }
}

/// The largest strain, and the 99th percentile (to 1e-4; exact above 1).
fn strains<R: Real>(cloths: &[ClothModel<R>], state: &State<R>, frame: &FrameInput) -> (f64, f64) {
    let mut max = 0.0f64;
    let mut bins = vec![0u64; BINS];
    let mut links = 0u64;
    for_each_strain(cloths, state, frame, |strain| {
        max = max.max(strain);
        bins[((strain.max(0.0) / BIN) as usize).min(BINS - 1)] += 1;
        links += 1;
    });
    let mut below = 0;
    let bin = bins.iter().position(|&count| {
        below += count;
        below * 100 >= links * 99
    });
    let upper = match bin {
        Some(bin) if bin == BINS - 1 => {
            // What the last bin does not tell apart.
            let mut largest = Vec::new();
            for_each_strain(cloths, state, frame, |strain| {
                largest.extend((strain >= 1.0 - BIN).then_some(strain))
            });
            largest.sort_unstable_by(f64::total_cmp);
            largest.iter().rev().nth((links / 100) as usize).copied().unwrap_or(max)
        }
        bin => bin.map_or(0.0, |bin| (bin + 1) as f64 * BIN),
    };
    (max, if links == 0 { 0.0 } else { upper.min(max) })
}

fn for_each_strain<R: Real>(
    cloths: &[ClothModel<R>],
    state: &State<R>,
    frame: &FrameInput,
    mut each: impl FnMut(f64),
) {
    for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
        let scale = R::from_f64(settings.rest_length_scale);
        for group in cloth.stretch.groups() {
            let strains = group.strain(&state.displacement, scale);
            let rows = group.rest_length.iter().zip(strains).filter(|(rest, _)| **rest > R::ZERO);
            rows.for_each(|(_, strain)| each(strain.to_f64()));
        }
    }
}

/// The elastic energy of stretch, shear and bending in joules; see [`Solver::elastic_energy`].
pub fn elastic_energy<R: Real>(cloths: &[ClothModel<R>], state: &State<R>, frame: &FrameInput) -> f64 {
    let ResistanceModel::Physical { .. } = frame.resistance else { return 0.0 };
    let of_cloth = |(cloth, settings): (&ClothModel<R>, &ClothFrame)| {
        let stiffness = PhysicalStiffness::of(settings);
        let PhysicalStiffness { stretch, compression, shear, bend, .. } = stiffness;
        let scale = settings.rest_length_scale;
        let maps = &cloth.strength_maps;
        let both = [stretch, compression];
        let woven = |links: &RowList<LinkGroup<R>>, weave: &RowList<WeaveGroup<R>>, maps| {
            let law = (&stiffness, settings.buckles);
            woven_energy(state, (links.groups(), weave.groups()), maps, scale, law)
        };
        let stretch = match maps.stretch_weave.len() {
            0 => link_energy(state, cloth.stretch.groups(), maps.stretch.groups(), scale, both),
            _ => woven(&cloth.stretch, &maps.stretch_weave, maps.stretch.groups()),
        };
        let shear = match maps.shear_weave.len() {
            0 => link_energy(state, cloth.shear.groups(), &[], scale, [shear; 2]),
            _ => woven(&cloth.shear, &maps.shear_weave, &[]),
        };
        stretch
            + shear
            + hinge_energy(state, (cloth.bend.groups(), cloth.bend_rest.groups()), maps.bend.groups(), bend)
            + hinge_energy(
                state,
                (cloth.bend_six.groups(), cloth.bend_six_rest.groups()),
                maps.bend_six.groups(),
                bend,
            )
    };
    cloths.iter().zip(&frame.cloths).map(of_cloth).sum()
}

/// The energy of links, by the stiffness of the cloth in N/m above and below their rest length.
fn link_energy<R: Real>(
    state: &State<R>,
    groups: &[LinkGroup<R>],
    maps: &[StrengthGroup<R>],
    rest_scale: f64,
    [above, below]: [f64; 2],
) -> f64 {
    let energy = |(k, lane): (usize, usize)| {
        let group = &groups[k];
        let rest = group.rest_length[lane].to_f64() * rest_scale;
        let stretch = length(state, group, lane) - rest;
        let own = |share: fn(&StrengthGroup<R>) -> &[R; 4]| share_of(maps.get(k).map(share), lane);
        let of_cloth =
            if stretch > 0.0 { above * own(|share| &share.above) } else { below * own(|share| &share.below) };
        let stiffness = of_cloth / group.slenderness[lane].to_f64();
        stiffness * stretch * stretch / 2.0
    };
    (0..groups.len()).flat_map(|k| (0..4).map(move |lane| (k, lane))).map(energy).sum()
}

/// The energy of the links of cloth that is woven or buckles.
fn woven_energy<R: Real>(
    state: &State<R>,
    (links, weave): (&[LinkGroup<R>], &[WeaveGroup<R>]),
    maps: &[StrengthGroup<R>],
    rest_scale: f64,
    (stiffness, buckles): (&PhysicalStiffness, bool),
) -> f64 {
    let energy = |(k, lane): (usize, usize)| {
        let group = &links[k];
        let rest = group.rest_length[lane].to_f64() * rest_scale;
        let c = length(state, group, lane) - rest;
        let own = |share: fn(&StrengthGroup<R>) -> &[R; 4]| share_of(maps.get(k).map(share), lane);
        let share = if c > 0.0 { own(|share| &share.above) } else { own(|share| &share.below) };
        let along = weave[k].warp[lane].to_f64();
        weave::energy(stiffness, buckles, along, share, [c, rest, group.slenderness[lane].to_f64()])
    };
    (0..links.len()).flat_map(|k| (0..4).map(move |lane| (k, lane))).map(energy).sum()
}

/// The length of a link in metres.
fn length<R: Real>(state: &State<R>, group: &LinkGroup<R>, lane: usize) -> f64 {
    let [a, b] = group.ends.map(|end| state.displacement[end[lane] as usize].0);
    let d: [R; 3] = std::array::from_fn(|axis| group.span[axis][lane] + (b[axis] - a[axis]));
    dot(d, d).sqrt().to_f64()
}

/// The energy of hinges, by the bending stiffness of the cloth in N·m.
fn hinge_energy<R: Real, const N: usize>(
    state: &State<R>,
    (groups, rests): RestingHinges<'_, R, N>,
    maps: &[StrengthGroup<R>],
    stiffness: f64,
) -> f64 {
    let energy = |(k, lane): (usize, usize)| {
        let group = &groups[k];
        let stiffness = stiffness * share_of(maps.get(k).map(|share| &share.above), lane);
        let rest = rests.get(k).map_or(0.0, |group| group.rest[lane].to_f64());
        let inverse_square_max = group.inverse_square_max[lane].to_f64();
        stiffness * energy_of_length(bending(state, group, lane), rest, inverse_square_max)
    };
    (0..groups.len()).flat_map(|k| (0..4).map(move |lane| (k, lane))).map(energy).sum()
}

/// The length of a hinge's bending vector.
fn bending<R: Real, const N: usize>(state: &State<R>, group: &HingeGroup<R, N>, lane: usize) -> f64 {
    let weights = group.weights().map(|weight| weight[lane]);
    let points = group.points.map(|point| state.displacement[point[lane] as usize].0);
    let c: [R; 3] = std::array::from_fn(|axis| {
        group.anchored[axis][lane] + weights.iter().zip(points).map(|(&k, x)| k * x[axis]).sum()
    });
    dot(c, c).sqrt().to_f64()
}

/// What the report says of all points, from one pass over them.
struct PointFigures {
    /// In joules.
    kinetic_energy: f64,
    /// Whether every position and velocity is finite.
    finite: bool,
    /// The smallest height above the ground plane over the thickness.
    ground_gap: f64,
}

impl PointFigures {
    fn of<R: Real>(
        cloths: &[ClothModel<R>],
        state: &State<R>,
        filter: &PairFilter,
        frame: &FrameInput,
    ) -> Self {
        let mut figures = Self { kinetic_energy: 0.0, finite: true, ground_gap: f64::INFINITY };
        let plane = frame.plane.as_ref();
        let plane =
            plane.map(|ground| (ground.origin, ground.normal.try_normalize(0.0).unwrap_or_else(Vector3::y)));
        for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
            let plane = plane.filter(|_| settings.collide && settings.thickness > 0.0);
            let lowest = figures.add(cloth.points(), state, plane, filter);
            figures.ground_gap = figures.ground_gap.min(lowest / settings.thickness);
        }
        figures.finite &= figures.kinetic_energy.is_finite();
        figures
    }

    /// Adds the points of a cloth. Returns the smallest height in metres above a plane, given by its origin and its normal,
    /// of those that are not pinned and collide with it.
    fn add<R: Real>(
        &mut self,
        points: Range<u32>,
        state: &State<R>,
        plane: Option<(Vector3<f64>, Vector3<f64>)>,
        filter: &PairFilter,
    ) -> f64 {
        let mut lowest = f64::INFINITY;
        for (row, v) in points.clone().zip(state.seen_velocities(points)) {
            let displacement = state.displacement[row as usize];
            self.kinetic_energy += dot(v, v) / (2.0 * state.inverse_mass[row as usize].to_f64());
            self.finite &= displacement.xyz().iter().all(|x| x.to_f64().is_finite());
            if let Some((origin, normal)) = plane
                && displacement.0[3] > R::ZERO
                && !filter.excludes_ground(row)
            {
                lowest = lowest.min((Vector3::from(state.position(row)) - origin).dot(&normal));
            }
        }
        lowest
    }
}

/// The smallest gap ratio of two elements of cloth.
fn smallest_cloth_gap<R: Real>(solver: &mut Solver<R>) -> f64 {
    let Solver {
        state,
        pool,
        contact: ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. },
        ..
    } = solver
    else {
        return f64::INFINITY;
    };
    let ClothContacts { cache, materials, .. } = cloth_contacts;
    cache.min_gap_ratio(&ClothStep::new(state, materials, material_maps, 0.0), pool)
}

/// The smallest gap ratio to a collider or the ground plane, given that to the ground.
fn smallest_gap<R: Real>(solver: &mut Solver<R>, ground_gap: f64, schedule: &Schedule<R>) -> f64 {
    let Solver {
        state,
        pool,
        contact:
            ContactSystem {
                collider_states, collider_contacts, collider_materials, material_maps, free_gap, ..
            },
        ..
    } = solver;
    let mut least = ground_gap.min(*free_gap);
    for list in collider_contacts.iter() {
        let Some(material) = collider_materials[[list.cloth, list.collider]] else { continue };
        let view = ColliderStepArgs {
            material,
            material_maps,
            at: list.collider,
            h: schedule.h,
            time: TimeInterval::at(1.0),
            interval: list.interval,
        };
        let step = view.of(state, &collider_states[list.collider]);
        let ratio = |at| list.point_face.at(at).map_or(f64::INFINITY, |contact| contact.gap_ratio(&step));
        least = least.min(pool.least(list.point_face.len(), ratio));
    }
    least
}

/// A row's factor on the stiffness of its cloth.
fn share_of<R: Real>(maps: Option<&[R; 4]>, lane: usize) -> f64 {
    maps.map_or(1.0, |maps| maps[lane].to_f64())
}
