//! Tethers (`tethers`, `tetherScale`): no point is farther from the nearest pins than the mesh reaches (long range
//! attachments: Kim, Chentanez and Müller-Fischer 2012).
//!
//! A Gauss-Seidel sweep passes the load of a hanging cloth to its pins along one edge, so cloth of many edges stretches.
//! A tether passes it on at once: it is a link from a point straight to a pin, as long as the way along the mesh at rest,
//! that acts only when it is tight. A point has at most two, to the nearest pins of two groups. Where two pins are farther
//! apart than both reach, both grow in proportion, and the sweeps share out the stretch.
//!
//! A wave that runs through cloth stretches it between points of which each is near enough to the pins. Long links
//! ([`ClothLists::long_links`](crate::model::lists::ClothLists::long_links)) hold these: a point has a link to the one
//! [`LONG`] edges nearer to its pin, and one to that at the fourth such distance, which act when they are tight. Every point
//! has such links, so that the corrections of neighbours are alike; links to a few points alone wrinkle the cloth.
//!
//! The lengths follow from the mesh and the pins of a frame, so a checkpoint stores nothing of them.

use crate::input::PointId;
use crate::math::{Real, Row4, dot, sub};
use crate::model::ClothModel;
use crate::model::geodesic::{LABELS, Label, RestDistances};
use crate::model::objects::Cloth;
use crate::model::rows::{Row, RowList};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

use super::projection::relax;
use super::row_loops::for_all_rows;
use super::strength_map::{Sides, Uniform};
use super::stretch::{LinkGroup, LinkRow, LinkStrength};

/// Length of the shorter long links, in mean edges, and how many of them the longer have.
const LONG: f64 = 4.0;
const LONGER: usize = 4;

/// The tethers of one cloth; empty where it has none.
#[derive(Debug, Clone, Default)]
pub struct Tethers<R> {
    mesh: RestDistances,
    /// By row of the cloth: whether it was pinned when the labels were made, and its labels.
    is_pinned: Vec<bool>,
    labels: Vec<Vec<Label>>,
    /// Links from points to pins: block by block, those to the farther pins first.
    groups: Vec<LinkGroup<R>>,
    /// By block: where its groups begin; one more for the end.
    starts: Vec<usize>,
    has_long_links: bool,
    /// The longer, then the shorter; empty without long links.
    long_links: Vec<RowList<LinkGroup<R>>>,
    /// Factor on their lengths: the largest slack of a point in this frame.
    slack: f64,
}

impl<R: Real> Tethers<R> {
    /// For a cloth that can have tethers; empty for others.
    pub fn new(cloth: &Cloth, model: &ClothModel<R>) -> Self {
        if !cloth.lists.tethers || cloth.particles.is_some() {
            return Self::default();
        }
        let place = |point: u32| model.order.place(point as usize);
        let mesh = RestDistances::new(&cloth.surface, &cloth.vertex_maps.rest_length, place);
        Self { mesh, has_long_links: cloth.lists.long_links, ..Self::default() }
    }

    /// The number of tethers of a cloth with these pins.
    pub fn count(&self, cloth: &ClothModel<R>, pins: impl Iterator<Item = PointId>) -> usize {
        let mut is_pinned = vec![false; self.mesh.points()];
        pins.for_each(|pin| is_pinned[cloth.order.place(pin.index()) as usize] = true);
        let of =
            |(point, labels): (u32, Vec<Label>)| labels.iter().filter(|label| label.pin != point).count();
        let labels = self.mesh.labels(&is_pinned);
        let long: usize = self.long_rows(&labels, 0).iter().map(Vec::len).sum();
        (0..).zip(labels).map(of).sum::<usize>() + long
    }

    /// Bytes of its lists.
    pub fn bytes(&self) -> usize {
        let labels: usize = self.labels.iter().map(|labels| size_of_val(&labels[..])).sum();
        let long: usize = self.long_links.iter().map(|list| size_of_val(list.groups())).sum();
        self.mesh.bytes() + labels + size_of_val(&self.is_pinned[..]) + size_of_val(&self.groups[..]) + long
    }

    /// Begins a frame of `duration` seconds: lengths where pins have changed, and spans.
    pub fn begin_frame(&mut self, cloth: &ClothModel<R>, state: &State<R>, duration: f64) {
        if self.mesh.points() == 0 {
            return;
        }
        let rows = cloth.points();
        let is_pinned = |row: &Row4<R>| row.0[3] == R::ZERO;
        let rows = state.displacement[rows.start as usize..rows.end as usize].iter().map(is_pinned);
        if !rows.clone().eq(self.is_pinned.iter().copied()) {
            self.is_pinned = rows.collect();
            self.labels = self.mesh.labels(&self.is_pinned);
            let rows = self.long_rows(&self.labels, cloth.points().start);
            self.long_links = rows.iter().map(|rows| RowList::new(rows, &cloth.blocks)).collect();
        }
        self.lay_out(cloth, state, duration);
        let slack = self.labels.iter().map(|labels| slack(labels, cloth.points().start, state, duration));
        self.slack = if self.long_links.is_empty() { 1.0 } else { slack.fold(1.0, f64::max) };
        for group in self.long_links.iter_mut().flat_map(|list| list.groups_mut()) {
            group.anchor(&state.anchor);
        }
    }

    /// The long links of a mesh with these labels, whose points begin at row `first`: the longer, then the shorter.
    fn long_rows(&self, labels: &[Vec<Label>], first: u32) -> Vec<Vec<LinkRow<R>>> {
        if !self.has_long_links {
            return Vec::new();
        }
        let next = self.mesh.towards_pins(labels, LONG * self.mesh.mean_edge());
        let link = |hops: usize, point: usize| {
            let step = |(at, distance): (usize, f64)| {
                next[at].map(|(next, further): (u32, f64)| (next as usize, distance + further))
            };
            let (end, distance) = (0..hops).try_fold((point, 0.0), |at, _| step(at))?;
            let ends = [first + point as u32, first + end as u32];
            Some(LinkRow { ends, rest_length: R::from_f64(distance), slenderness: R::ONE, warp: R::ONE })
        };
        [LONGER, 1].map(|hops| (0..labels.len()).filter_map(|point| link(hops, point)).collect()).into()
    }

    fn lay_out(&mut self, cloth: &ClothModel<R>, state: &State<R>, duration: f64) {
        self.groups.clear();
        self.starts.clear();
        let first = cloth.points().start;
        for block in 0..cloth.blocks.len() {
            self.starts.push(self.groups.len());
            let idle = LinkRow::idle(cloth.blocks.padding_point(block));
            for label in (0..LABELS).rev() {
                let first_group = self.groups.len();
                let (mut four, mut filled) = ([idle; 4], 0);
                for row in cloth.blocks.range(block) {
                    let labels = &self.labels[(row - first) as usize];
                    let Some(own) = labels.get(label).filter(|own| own.pin != row - first) else { continue };
                    let rest_length = R::from_f64(own.distance * slack(labels, first, state, duration));
                    four[filled] = LinkRow {
                        ends: [row, first + own.pin],
                        rest_length,
                        slenderness: R::ONE,
                        warp: R::ONE,
                    };
                    filled += 1;
                    if filled == 4 {
                        self.groups.push(LinkRow::group(std::mem::replace(&mut four, [idle; 4])));
                        filled = 0;
                    }
                }
                self.groups.extend((filled > 0).then(|| LinkRow::group(four)));
                while !(self.groups.len() - first_group).is_multiple_of(LinkRow::<R>::GROUPS) {
                    self.groups.push(LinkRow::group([idle; 4]));
                }
            }
        }
        self.starts.push(self.groups.len());
        self.groups.iter_mut().for_each(|group| group.anchor(&state.anchor));
    }

    /// Shortens all long links and tethers that are longer than `scale` times their lengths.
    pub fn relax(&self, cloth: &ClothModel<R>, displacement: &mut [Row4<R>], scale: f64, pool: &ThreadPool) {
        let strength = |scale: f64| LinkStrength {
            share: Sides { above: R::ONE, below: R::ZERO },
            compliance: Sides { above: R::ZERO, below: R::ZERO },
            rest_scale: R::from_f64(scale),
        };
        let points = DisjointSlice::new(displacement);
        let of_long_links = strength(scale * self.slack);
        for list in &self.long_links {
            for_all_rows(pool, &cloth.blocks, list, |batch| {
                // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point.
                #[allow(unsafe_code)]
                unsafe {
                    relax::<R, _, 2>(points, list.batch(batch), Uniform, false, &of_long_links);
                }
            });
        }
        let strength = strength(scale);
        pool.parallel_for(self.starts.len().saturating_sub(1), |block| {
            let groups = &self.groups[self.starts[block]..self.starts[block + 1]];
            // SAFETY: the first ends are points of this block, which no other task touches, each once per label; the
            // second ends are pins, which no task writes, or the padding point of this block.
            #[allow(unsafe_code)]
            unsafe {
                relax::<R, _, 1>(points, groups, Uniform, false, &strength);
            }
        });
    }
}

/// The factor on both tethers of a point: above one where their pins are farther apart in this frame than both reach.
fn slack<R: Real>(labels: &[Label], first: u32, state: &State<R>, duration: f64) -> f64 {
    let [a, b] = labels else { return 1.0 };
    let pins = [a, b].map(|label| (first + label.pin) as usize);
    let distance = |time: f64| {
        let [p, q] = pins.map(|pin| {
            let velocity = state.velocity[pin].xyz().map(R::to_f64);
            let anchor = state.anchor[pin];
            [0, 1, 2].map(|axis| anchor[axis] + time * velocity[axis])
        });
        let d = sub(q, p);
        dot(d, d).sqrt()
    };
    let apart = distance(0.0).max(distance(duration));
    let reach = a.distance + b.distance;
    if reach > 0.0 { (apart / reach).max(1.0) } else { 1.0 }
}
