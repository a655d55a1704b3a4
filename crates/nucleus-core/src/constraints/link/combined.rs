//! Lists of links by their number of free points.

use nalgebra::Vector3;

use crate::constraints::hinge::MIN_COSINE;
use crate::input::links::{Fold, Link};
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::model::blocks::AllBlocks;
use crate::model::rows::RowList;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

use super::batches::{Loads, for_batches};
use super::contact_distance::Collisions;
use super::ends::{Ends, Prescribed, vector};
use super::rows::{self, CombinedGroup, CombinedRow, LinkPass, NO_LINK, broken_lanes};

/// Links of one to six free points.
pub(super) struct CombinedLists<R> {
    one: CombinedList<R, 1>,
    two: CombinedList<R, 2>,
    three: CombinedList<R, 3>,
    four: CombinedList<R, 4>,
    five: CombinedList<R, 5>,
    six: CombinedList<R, 6>,
}

/// The same for the lists of all lengths.
macro_rules! for_each_list {
    ($lists:expr, $list:ident => $work:expr) => {{
        let Self { one, two, three, four, five, six } = $lists;
        let $list = one;
        $work;
        let $list = two;
        $work;
        let $list = three;
        $work;
        let $list = four;
        $work;
        let $list = five;
        $work;
        let $list = six;
        $work;
    }};
}

impl<R> Default for CombinedLists<R> {
    fn default() -> Self {
        Self {
            one: CombinedList::default(),
            two: CombinedList::default(),
            three: CombinedList::default(),
            four: CombinedList::default(),
            five: CombinedList::default(),
            six: CombinedList::default(),
        }
    }
}

impl<R: Real> CombinedLists<R> {
    pub(super) fn new(all: &[(u32, Ends)], links: &[Link], can_break: bool, blocks: &AllBlocks) -> Self {
        let mut lists = Self::default();
        for_each_list!(&mut lists, list => *list = CombinedList::new(all, links, can_break, blocks));
        lists
    }

    /// The number of rows.
    pub(super) fn len(&self) -> usize {
        let mut sum = 0;
        for_each_list!(self, list => sum += list.rows.len());
        sum
    }

    pub(super) fn sweep(
        &mut self,
        points: DisjointSlice<'_, Row4<R>>,
        pass: &LinkPass<R>,
        blocks: usize,
        pool: &ThreadPool,
    ) {
        for k in 0..6 {
            match if pass.backward { 5 - k } else { k } {
                0 => self.one.sweep(points, pass, blocks, pool),
                1 => self.two.sweep(points, pass, blocks, pool),
                2 => self.three.sweep(points, pass, blocks, pool),
                3 => self.four.sweep(points, pass, blocks, pool),
                4 => self.five.sweep(points, pass, blocks, pool),
                _ => self.six.sweep(points, pass, blocks, pool),
            }
        }
    }

    /// Updates all that depends on the anchors, on prescribed places and on the strength of the frame.
    pub(super) fn begin_frame(&mut self, frame: &LinkFrame<'_, R>, links: &[Link], factors: &[f64]) {
        for_each_list!(self, list => list.begin_frame(frame, links, factors));
    }

    /// Calls `each` with every link and the impulse that it carried in N·s, and starts anew.
    pub(super) fn take_impulses(&mut self, mut each: impl FnMut(u32, Vector3<f64>)) {
        for_each_list!(self, list => {
            let groups = list.rows.groups().iter();
            list.loads.take(groups.map(|group| &group.link), &mut each);
        });
    }

    /// Takes broken links out of the sweeps.
    pub(super) fn release(&mut self, broken: &[bool]) {
        for_each_list!(self, list => list.release(broken));
    }
}

/// What a frame gives to the rows of a constraint.
pub(super) struct LinkFrame<'a, R> {
    pub(super) prescribed: Prescribed<'a>,
    pub(super) state: &'a State<R>,
    pub(super) cloths: &'a [ClothModel<R>],
    pub(super) collisions: Collisions<'a, R>,
}

impl<R: Real> LinkFrame<'_, R> {
    /// The length of a link at the start of the frame, in metres.
    pub(super) fn length(&self, link: &Link) -> f64 {
        vector(link, &Ends::new(link, self.cloths), self.state, self.prescribed, 0.0).norm()
    }

    /// The factor on the strength of a link over its present length.
    pub(super) fn drop(&self, link: &Link) -> f64 {
        self.prescribed.frame.dropoff.map_or(1.0, |dropoff| dropoff.at(self.length(link)))
    }

    /// Factor on the stiffness of a fold: along its bending vector it is divided by the cosine of half the angle, so that
    /// its moment grows with the angle. Taken once per frame.
    pub(super) fn stiffening(&self, fold: &Fold, link: &Link) -> f64 {
        1.0 / (1.0 - fold.half_sine(self.length(link)).powi(2)).sqrt().max(MIN_COSINE)
    }
}

/// Links of `N` free points.
struct CombinedList<R, const N: usize> {
    rows: RowList<CombinedGroup<R, N>>,
    loads: Loads<R>,
}

impl<R, const N: usize> Default for CombinedList<R, N> {
    fn default() -> Self {
        Self { rows: RowList::default(), loads: Loads::default() }
    }
}

impl<R: Real, const N: usize> CombinedList<R, N> {
    fn new(all: &[(u32, Ends)], links: &[Link], can_break: bool, blocks: &AllBlocks) -> Self {
        let of_length = all.iter().filter(|(_, ends)| ends.count == N);
        let rows: Vec<CombinedRow<R, N>> = of_length.map(|(at, ends)| row(*at, ends, links)).collect();
        let rows = RowList::new(&rows, blocks);
        Self { loads: Loads::new(can_break, rows.groups().len()), rows }
    }

    fn sweep(
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
            let groups = rows.batch(batch);
            // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point; batches share no
            // group.
            #[allow(unsafe_code)]
            unsafe {
                let loads = loads.of(rows.first_group(batch), groups.len());
                rows::relax(points, groups, loads.unwrap_or_default(), pass);
            }
        });
    }

    fn begin_frame(&mut self, frame: &LinkFrame<'_, R>, links: &[Link], factors: &[f64]) {
        for group in self.rows.groups_mut() {
            for lane in (0..4).filter(|&lane| group.link[lane] != NO_LINK) {
                let at = group.link[lane] as usize;
                let [start, end] = [0.0, 1.0].map(|time| frame.prescribed.vector(&links[at], time));
                for axis in 0..3 {
                    let of = |k: usize| {
                        group.weights[k][lane].to_f64()
                            * frame.state.anchor[group.points[k][lane] as usize][axis]
                    };
                    let anchors: f64 = (0..N).map(of).sum();
                    group.span[axis][lane] = R::from_f64(anchors + start[axis]);
                    group.travel[axis][lane] = R::from_f64(end[axis] - start[axis]);
                }
                group.factor[lane] = R::from_f64(factors[at]);
                group.contact_distance[lane] = R::from_f64(frame.collisions.distance(&links[at]));
            }
        }
    }

    fn release(&mut self, broken: &[bool]) {
        for group in self.rows.groups_mut() {
            for lane in broken_lanes(group.link, broken) {
                group.factor[lane] = R::ZERO;
            }
        }
    }
}

fn row<R: Real, const N: usize>(at: u32, ends: &Ends, links: &[Link]) -> CombinedRow<R, N> {
    let link = &links[at as usize];
    let mut weights: [R; N] = std::array::from_fn(|k| R::from_f64(ends.weights[k]));
    if link.fold().is_some() && link.sides.iter().all(|side| side.is_free()) {
        // The rounded weights must still add up to zero: else the fold would be attracted to the origin.
        weights[N - 1] = weights[..N - 1].iter().fold(R::ZERO, |sum, &weight| sum - weight);
    }
    CombinedRow {
        points: std::array::from_fn(|k| ends.rows[k]),
        weights,
        push: std::array::from_fn(|k| R::from_f64(ends.push[k])),
        rest: R::from_f64(link.rest),
        link: at,
    }
}
