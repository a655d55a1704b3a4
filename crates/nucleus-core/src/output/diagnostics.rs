//! What a frame is reported to have done.

use std::sync::atomic::Ordering::Relaxed;

use crate::constraints::hinge::{HingeGroup, held};
use crate::constraints::row_map::ShareGroup;
use crate::constraints::stretch::LinkGroup;
use crate::contact::cloth::ClothContacts;
use crate::contact::cloth::pass::cloth_step;
use crate::contact::collider::pass::ColliderStepArgs;
use crate::contact::time_step::ContactCounters;
use crate::input::frame::{ClothFrame, FrameInput, ResistanceModel};
use crate::math::{Real, dot};
use crate::model::ClothModel;
use crate::output::report::StepReport;
use crate::schedule::Schedule;
use crate::schedule::resistance::PhysicalStiffness;
use crate::solver::Solver;

/// Strains are counted in bins of this width up to `BINS` of them; what is above is in the last.
const BIN: f64 = 1e-4;
const BINS: usize = 10_000;

impl<R: Real> Solver<R> {
    /// The account of the frame that has just ended.
    pub(crate) fn report(
        &mut self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        counters: &ContactCounters,
    ) -> StepReport {
        let (max_strain, strain_99) = self.strains(frame);
        let (kinetic_energy, finite) = self.kinetic_energy();
        StepReport {
            max_strain,
            strain_99,
            min_gap: self.smallest_gap(frame, schedule),
            min_cloth_gap: self.smallest_cloth_gap(),
            rest_limited: self.count_rest_limited(),
            contacts: counters.contacts.load(Relaxed),
            candidate_pairs: counters.candidate_pairs.load(Relaxed),
            broad_phases: counters.broad_phases.load(Relaxed) as u32,
            pairs_reverted: counters.pairs_reverted.load(Relaxed),
            pairs_unresolved: counters.pairs_unresolved.load(Relaxed),
            depenetrating: self
                .collider_contacts
                .iter()
                .map(|list| list.depenetration.points.len() as u64)
                .sum(),
            intersections: self
                .cloth_contacts
                .as_ref()
                .map_or(0, |contacts| contacts.untangling.intersections.len() as u64),
            kinetic_energy,
            finite,
            ..StepReport::default()
        }
    }

    /// The largest strain, and the strain that 99 % of the links stay below (to 1e-4).
    fn strains(&self, frame: &FrameInput) -> (f64, f64) {
        let mut most = 0.0f64;
        let mut bins = vec![0u64; BINS];
        let mut links = 0u64;
        for (cloth, settings) in self.cloths.iter().zip(&frame.cloths) {
            let scale = R::from_f64(settings.rest_length_scale);
            for group in cloth.stretch.groups() {
                let strains = group.strain(&self.state.displacement, scale);
                for (_, strain) in group.rest_length.iter().zip(strains).filter(|(rest, _)| **rest > R::ZERO)
                {
                    let strain = strain.to_f64();
                    most = most.max(strain);
                    bins[((strain.max(0.0) / BIN) as usize).min(BINS - 1)] += 1;
                    links += 1;
                }
            }
        }
        let mut below = 0;
        let bin = bins.iter().position(|&count| {
            below += count;
            below * 100 >= links * 99
        });
        let upper = bin.map_or(0.0, |bin| (bin + 1) as f64 * BIN);
        (most, if links == 0 { 0.0 } else { upper.min(most) })
    }

    /// The energy in joules that stretch, shear and bending hold, were they as stiff as `frame` says and the cloth as
    /// it is now; nothing in Classic, where a resistance is no stiffness.
    pub fn elastic_energy(&self, frame: &FrameInput) -> f64 {
        R::elastic_energy(self, frame)
    }

    pub(crate) fn held_energy(&self, frame: &FrameInput) -> f64 {
        let ResistanceModel::Physical { .. } = frame.resistance else { return 0.0 };
        let of_cloth = |(cloth, settings): (&ClothModel<R>, &ClothFrame)| {
            let PhysicalStiffness { stretch, compression, shear, bend } = PhysicalStiffness::of(settings);
            let scale = settings.rest_length_scale;
            let shares = &cloth.shares;
            self.links_hold(cloth.stretch.groups(), shares.stretch.groups(), scale, [stretch, compression])
                + self.links_hold(cloth.shear.groups(), &[], scale, [shear; 2])
                + self.hinges_hold(cloth.bend.groups(), shares.bend.groups(), bend)
                + self.hinges_hold(cloth.fold.groups(), shares.fold.groups(), bend)
        };
        self.cloths.iter().zip(&frame.cloths).map(of_cloth).sum()
    }

    /// What links hold, by the stiffness of the cloth in N/m above and below their rest length.
    fn links_hold(
        &self,
        groups: &[LinkGroup<R>],
        shares: &[ShareGroup<R>],
        rest_scale: f64,
        [above, below]: [f64; 2],
    ) -> f64 {
        let hold = |(k, lane): (usize, usize)| {
            let group = &groups[k];
            let rest = group.rest_length[lane].to_f64() * rest_scale;
            let stretch = self.length(group, lane) - rest;
            let own = |share: fn(&ShareGroup<R>) -> &[R; 4]| share_of(shares.get(k).map(share), lane);
            let of_cloth = if stretch > 0.0 {
                above * own(|share| &share.above)
            } else {
                below * own(|share| &share.below)
            };
            let stiffness = of_cloth / group.slenderness[lane].to_f64();
            stiffness * stretch * stretch / 2.0
        };
        (0..groups.len()).flat_map(|k| (0..4).map(move |lane| (k, lane))).map(hold).sum()
    }

    /// The length of a link in metres.
    fn length(&self, group: &LinkGroup<R>, lane: usize) -> f64 {
        let [a, b] = group.ends.map(|end| self.state.displacement[end[lane] as usize].0);
        let d: [R; 3] = std::array::from_fn(|axis| group.span[axis][lane] + (b[axis] - a[axis]));
        dot(d, d).sqrt().to_f64()
    }

    fn hinges_hold<const N: usize>(
        &self,
        groups: &[HingeGroup<R, N>],
        shares: &[ShareGroup<R>],
        stiffness: f64,
    ) -> f64 {
        let hold = |(k, lane): (usize, usize)| {
            let group = &groups[k];
            let stiffness = stiffness * share_of(shares.get(k).map(|share| &share.above), lane);
            let [rest, fold] = [group.rest, group.fold].map(|column| column[lane].to_f64());
            stiffness * held(self.bending(group, lane), rest, fold)
        };
        (0..groups.len()).flat_map(|k| (0..4).map(move |lane| (k, lane))).map(hold).sum()
    }

    /// The length of a hinge's bending vector.
    fn bending<const N: usize>(&self, group: &HingeGroup<R, N>, lane: usize) -> f64 {
        let weights = group.weights.map(|weight| weight[lane]);
        let points = group.points.map(|point| self.state.displacement[point[lane] as usize].0);
        let c: [R; 3] = std::array::from_fn(|axis| {
            group.anchored[axis][lane] + weights.iter().zip(points).map(|(&k, x)| k * x[axis]).sum()
        });
        dot(c, c).sqrt().to_f64()
    }

    /// The energy of motion in joules, and whether all is finite.
    fn kinetic_energy(&self) -> (f64, bool) {
        let mut energy = 0.0;
        let mut finite = true;
        for cloth in &self.cloths {
            for row in cloth.points() {
                let v = self.state.seen_velocity(row);
                let row = row as usize;
                let inverse_mass = self.state.inverse_mass[row].to_f64();
                energy += dot(v, v) / (2.0 * inverse_mass);
                finite &= self.state.displacement[row].xyz().iter().all(|x| x.to_f64().is_finite());
            }
        }
        (energy, finite && energy.is_finite())
    }

    /// The smallest distance between two elements of cloth, over the thickness kept there.
    fn smallest_cloth_gap(&mut self) -> f64 {
        let Self { cloth_contacts: Some(cloth_contacts), state, material_maps, .. } = self else {
            return f64::INFINITY;
        };
        let ClothContacts { cache, materials, .. } = cloth_contacts;
        let gap_ratio = cache.min_gap_ratio(&cloth_step(state, materials, material_maps, 0.0));
        gap_ratio.map_or(f64::INFINITY, R::to_f64)
    }

    fn count_rest_limited(&self) -> u64 {
        let Some(cloth_contacts) = &self.cloth_contacts else { return 0 };
        cloth_contacts.cache.count_rest_limited()
    }

    /// The smallest distance to a collider or the plane, over the thickness.
    fn smallest_gap(&mut self, frame: &FrameInput, schedule: &Schedule<R>) -> f64 {
        let mut least = f64::INFINITY;
        if let Some(ground) = &frame.plane {
            let normal = ground.normal.try_normalize(0.0).unwrap_or_else(nalgebra::Vector3::y);
            for (cloth, settings) in self.cloths.iter().zip(&frame.cloths) {
                if settings.collide && settings.thickness > 0.0 {
                    let height = |row| {
                        (nalgebra::Vector3::from(self.state.position(row)) - ground.origin).dot(&normal)
                    };
                    let free =
                        cloth.points().filter(|&row| self.state.displacement[row as usize].0[3] > R::ZERO);
                    least = free.map(|row| height(row) / settings.thickness).fold(least, f64::min);
                }
            }
        }
        let Self { state, collider_states, collider_contacts, collider_materials, material_maps, .. } = self;
        for list in collider_contacts.iter() {
            let Some(material) = collider_materials[list.cloth * collider_states.len() + list.collider]
            else {
                continue;
            };
            let view = ColliderStepArgs {
                material,
                material_maps,
                h: schedule.h,
                time: [1.0; 2],
                interval: list.interval,
            };
            let step = view.of(state, &collider_states[list.collider]);
            let distances = list.point_face.iter().map(|pair| pair.gap_ratio(&step));
            least = distances.fold(least, f64::min);
        }
        least
    }
}

/// A row's share of the stiffness of its cloth.
fn share_of<R: Real>(shares: Option<&[R; 4]>, lane: usize) -> f64 {
    shares.map_or(1.0, |shares| shares[lane].to_f64())
}
