//! Links that are all corrected from the same state (`evaluationOrder`: Parallel, a Jacobi sweep).
//!
//! No link sees the correction of another within a sweep, so the result does not depend on the order of links in the
//! mesh. The corrections at a point add up: each is multiplied by 2 / (v_a + v_b), v being the number of links at its
//! ends, so that the sum never overshoots (the bound of Gershgorin on the Jacobi matrix) and momentum is conserved. One
//! such sweep corrects less than a sequential one: it needs higher resistances, or more evaluations.

use crate::math::{Lanes, Real, Row4};
use crate::model::ClothModel;
use crate::model::rows::{RowBatch, RowList};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::projection::{LinkLaw, LinkProjection};
use super::row_loops::for_all_rows;
use super::strength_map::{StrengthGroup, Uniform};
use super::stretch::{LinkGroup, LinkStrength};
use super::weave::{WeaveGroup, WeaveStrength, Woven};

/// The links of one effect of a cloth, and the columns of the same layout.
#[derive(Debug)]
pub struct LinkLists<'a, R> {
    /// The links.
    pub rows: &'a RowList<LinkGroup<R>>,
    /// Their vertex map, if they can have one; empty where there is none.
    maps: Option<&'a RowList<StrengthGroup<R>>>,
    /// Their directions and the strength of the sweep, in cloth that is woven or buckles.
    pub weave: Option<(&'a RowList<WeaveGroup<R>>, &'a WeaveStrength<R>)>,
}

impl<'a, R: Real> LinkLists<'a, R> {
    /// The links along edges.
    pub fn stretch(cloth: &'a ClothModel<R>, strength: &'a WeaveStrength<R>) -> Self {
        let maps = &cloth.strength_maps;
        Self::new(&cloth.stretch, Some(&maps.stretch), (&maps.stretch_weave, strength))
    }

    /// The cross links.
    pub fn shear(cloth: &'a ClothModel<R>, strength: &'a WeaveStrength<R>) -> Self {
        let maps = &cloth.strength_maps;
        Self::new(&cloth.shear, None, (&maps.shear_weave, strength))
    }

    fn new(
        rows: &'a RowList<LinkGroup<R>>,
        maps: Option<&'a RowList<StrengthGroup<R>>>,
        weave: (&'a RowList<WeaveGroup<R>>, &'a WeaveStrength<R>),
    ) -> Self {
        Self { rows, maps, weave: Some(weave).filter(|(rows, _)| rows.len() > 0) }
    }

    /// The vertex map of a batch; empty where there is none.
    pub fn maps(&self, batch: RowBatch) -> &'a [StrengthGroup<R>] {
        self.maps.map_or(&[], |maps| maps.batch(batch))
    }
}

/// Sweeps a list of links of a cloth once. `corrections` has a row for each row of `points`.
pub fn sweep<R: Real>(
    points: &mut [Row4<R>],
    corrections: &mut [Row4<R>],
    cloth: &ClothModel<R>,
    lists: &LinkLists<'_, R>,
    strength: &LinkStrength<R>,
    pool: &ThreadPool,
) {
    let first = cloth.points().start;
    let own = first as usize..first as usize + cloth.valence.len();
    corrections[own.clone()].fill(Row4::ZERO);
    let sums = DisjointSlice::new(corrections);
    let jacobi = Jacobi { points, sums, first, valence: &cloth.valence };
    for_all_rows(pool, &cloth.blocks, lists.rows, |batch| {
        let (groups, map) = (lists.rows.batch(batch), lists.maps(batch));
        let woven = |(weave, strength)| (RowList::batch(weave, batch), strength);
        // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point.
        #[allow(unsafe_code)]
        unsafe {
            match (lists.weave.map(woven), map.is_empty()) {
                (None, true) => jacobi.add(groups, Uniform, strength),
                (None, false) => jacobi.add(groups, map, strength),
                (Some((weave, law)), true) => {
                    jacobi.add(groups, Woven { groups: weave, strength: law, map: Uniform }, strength);
                }
                (Some((weave, law)), false) => {
                    jacobi.add(groups, Woven { groups: weave, strength: law, map }, strength);
                }
            }
        }
    });
    for (point, sum) in points[own.clone()].iter_mut().zip(&corrections[own]) {
        *point = Row4((point.lanes() + sum.lanes()).to_array());
    }
}

/// Positions that a sweep reads, and sums of corrections that it writes.
struct Jacobi<'a, R> {
    points: &'a [Row4<R>],
    sums: DisjointSlice<'a, Row4<R>>,
    first: u32,
    valence: &'a [R],
}

impl<R: Real> Jacobi<'_, R> {
    /// Adds the corrections of some links.
    ///
    /// # Safety
    /// No other task of the loop touches the points of `groups`.
    #[allow(unsafe_code)]
    unsafe fn add<P: LinkLaw<R>>(&self, groups: &[LinkGroup<R>], law: P, strength: &LinkStrength<R>) {
        let projection = LinkProjection::<R::Lanes>::new(strength);
        for (at, group) in groups.iter().enumerate() {
            let rows = group.ends.map(|ends| ends.map(|end| self.points[end as usize].lanes()));
            let [x, y, z] = projection.correction(|_| group, (law, at), rows.map(R::Lanes::transpose)).push;
            let push = R::Lanes::transpose([x, y, z, R::Lanes::splat(R::ZERO)]);
            for lane in 0..4 {
                let [end_a, end_b] = group.ends.map(|ends| ends[lane]);
                let [w_a, w_b] = rows.map(|rows| rows[lane].splat_last());
                let valence = |end: u32| self.valence[(end - self.first) as usize];
                let damped =
                    push[lane] * R::Lanes::splat(R::from_f64(2.0) / (valence(end_a) + valence(end_b)));
                // SAFETY: the caller's promise.
                unsafe {
                    let sum = self.sums.get(end_a).lanes() + w_a * damped;
                    self.sums.set(end_a, Row4(sum.to_array()));
                    let sum = self.sums.get(end_b).lanes() - w_b * damped;
                    self.sums.set(end_b, Row4(sum.to_array()));
                }
            }
        }
    }
}
