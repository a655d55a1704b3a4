//! Links of two single points that can break, or whose strength varies: rows of [`stretch`](crate::constraints::stretch)
//! with a factor each, and with their loads.

use crate::constraints::projection::{LinkLaw, LinkProjection};
use crate::constraints::side_by_side::{group_starts, load, store};
use crate::constraints::strength_map::StrengthMap;
use crate::constraints::stretch::{LinkGroup, LinkRow};
use crate::input::links::Link;
use crate::math::kernel::{self, Kernel};
use crate::math::{Lanes, Real, Row4};
use crate::model::blocks::AllBlocks;
use crate::model::rows::{Row, RowList};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::batches::{Loads, for_batches};
use super::ends::Ends;
use super::rows::{LinkPass, NO_LINK, VectorGroup, broken_lanes};

/// Four pairs side by side.
#[derive(Debug, Clone, Copy)]
pub struct PairGroup<R> {
    /// Their points, spans and rest lengths.
    pub(super) row: LinkGroup<R>,
    /// Factors on share and compliance, by frame. A broken link has the share 0.
    factor: Factors<R>,
    /// The link of each lane, or [`NO_LINK`].
    pub(super) link: [u32; 4],
}

impl<R> PairGroup<R> {
    /// Its links and their points.
    pub(super) fn pairs(&self) -> impl Iterator<Item = (u32, [u32; 2])> {
        let pair = |lane: usize| (self.link[lane], self.row.ends.map(|ends| ends[lane]));
        (0..4).map(pair).filter(|(link, _)| *link != NO_LINK)
    }
}

#[derive(Debug, Clone, Copy)]
struct Factors<R> {
    share: [R; 4],
    compliance: [R; 4],
}

impl<R: Real> StrengthMap<R> for &[PairGroup<R>] {
    #[inline(always)]
    fn scale<L: Lanes<R>>(self, at: usize, _c: L, share: L, compliance: L) -> (L, L) {
        let own = L::of_groups(|k| self[at + k].factor.share);
        (share * own, compliance * L::of_groups(|k| self[at + k].factor.compliance))
    }
}

impl<R: Real> LinkLaw<R> for &[PairGroup<R>] {}

/// A pair before it is laid out.
#[derive(Debug, Clone, Copy)]
struct PairRow<R> {
    row: LinkRow<R>,
    link: u32,
}

impl<R: Real> Row for PairRow<R> {
    type Group = PairGroup<R>;
    const POINTS: usize = 2;
    const GROUPS: usize = 2;

    fn point(&self, k: usize) -> u32 {
        self.row.ends[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { row: LinkRow::idle(padding_point), link: NO_LINK }
    }

    fn group(rows: [Self; 4]) -> PairGroup<R> {
        let factor = Factors { share: [R::ZERO; 4], compliance: [R::ONE; 4] };
        PairGroup { row: LinkRow::group(rows.map(|pair| pair.row)), factor, link: rows.map(|pair| pair.link) }
    }
}

/// The pairs of a constraint.
pub(super) struct PairList<R> {
    pub(super) rows: RowList<PairGroup<R>>,
    pub(super) loads: Loads<R>,
}

impl<R> Default for PairList<R> {
    fn default() -> Self {
        Self { rows: RowList::default(), loads: Loads::default() }
    }
}

impl<R: Real> PairList<R> {
    pub(super) fn new(all: &[(u32, Ends)], links: &[Link], can_break: bool, blocks: &AllBlocks) -> Self {
        let row = |(at, ends): &(u32, Ends)| {
            let rest_length = R::from_f64(links[*at as usize].rest);
            let row = LinkRow {
                ends: [ends.rows[0], ends.rows[1]],
                rest_length,
                slenderness: R::ONE,
                warp: R::ONE,
            };
            PairRow { row, link: *at }
        };
        let rows: Vec<PairRow<R>> = all.iter().map(row).collect();
        let rows = RowList::new(&rows, blocks);
        Self { loads: Loads::new(can_break, rows.groups().len()), rows }
    }

    /// Takes up anchors and the factors of the links on the strength.
    pub(super) fn begin_frame(&mut self, anchors: &[[f64; 3]], factors: &[f64], is_physical: bool) {
        for group in self.rows.groups_mut() {
            group.row.anchor(anchors);
            for lane in (0..4).filter(|&lane| group.link[lane] != NO_LINK) {
                let factor = factors[group.link[lane] as usize];
                let [share, softness] = match is_physical && factor > 0.0 {
                    true => [1.0, 1.0 / factor],
                    false => [factor, 1.0],
                };
                group.factor.share[lane] = R::from_f64(share);
                group.factor.compliance[lane] = R::from_f64(softness.min(1e30));
            }
        }
    }

    pub(super) fn sweep(
        &mut self,
        points: DisjointSlice<'_, Row4<R>>,
        pass: &LinkPass<R>,
        blocks: usize,
        pool: &ThreadPool,
    ) {
        let Self { rows, loads } = self;
        if rows.len() == 0 {
            return;
        }
        let loads = loads.share();
        for_batches(rows, blocks, pass.backward, pool, |batch| {
            // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point; batches share no
            // group.
            #[allow(unsafe_code)]
            unsafe {
                let groups = rows.batch(batch);
                let loads = loads.of(rows.first_group(batch), groups.len());
                kernel::run(PairSweep { points, groups, loads, pass });
            }
        });
    }

    /// Takes broken links out of the sweeps.
    pub(super) fn release(&mut self, broken: &[bool]) {
        for group in self.rows.groups_mut() {
            for lane in broken_lanes(group.link, broken) {
                group.factor.share[lane] = R::ZERO;
            }
        }
    }
}

/// A sweep over pairs, which adds the impulses that pull their first points to `loads`, an entry per group.
///
/// Safety: the groups come in twos whose rows share no point, and no other task of the loop touches their points.
struct PairSweep<'a, R> {
    points: DisjointSlice<'a, Row4<R>>,
    groups: &'a [PairGroup<R>],
    loads: Option<&'a mut [VectorGroup<R>]>,
    pass: &'a LinkPass<R>,
}

#[allow(unsafe_code)]
impl<R: Real> Kernel<R> for PairSweep<'_, R> {
    /// # Safety
    /// See [`PairSweep`].
    #[inline(always)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { points, groups: all, mut loads, pass } = self;
        let projection = LinkProjection::<L>::new(&pass.strength);
        let per_step = L::splat(pass.per_step);
        for at in group_starts::<R, L>(all.len(), pass.backward) {
            let groups = &all[at..at + L::GROUPS];
            // SAFETY: the caller's promise.
            let ends =
                unsafe { [load(points, |k| groups[k].row.ends[0]), load(points, |k| groups[k].row.ends[1])] };
            let correction = projection.correction(|k| &groups[k].row, (all, at), ends);
            if let Some(loads) = &mut loads {
                let loads = &mut loads[at..at + L::GROUPS];
                for (axis, own) in correction.push.into_iter().enumerate() {
                    let sum = L::of_groups(|k| loads[k][axis]) + own * per_step;
                    sum.for_groups(|k, sum| loads[k][axis] = sum);
                }
            }
            for (end, moved) in correction.moved().into_iter().enumerate() {
                // SAFETY: the caller's promise.
                unsafe { store(points, |k| groups[k].row.ends[end], moved) };
            }
        }
    }
}
