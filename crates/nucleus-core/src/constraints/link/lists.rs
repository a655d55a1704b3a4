//! The links of all constraints: their state, and their rows by the number of free points.

use crate::bytes::{Checkpoint, Encode, Reader, encode_struct};
use crate::constraints::strength_map::Uniform;
use crate::constraints::stretch::{self, LinkGroup, LinkRow};
use crate::input::links::{Link, LinkSide};
use crate::math::{Real, Row4};
use crate::model::rows::{AllBlocks, Partition, RowBatch, RowList};
use crate::model::{ClothModel, ColliderModel};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

use super::ends::{Ends, Prescribed, vector};
use super::rows::{self, CombinedGroup, CombinedRow, LinkPass, NO_LINK, VectorGroup};
use super::sizes::ModelSizes;
use super::topology::{SurfaceRow, Topology};

/// The cloths and colliders of a scene.
pub type Models<'a, R> = (&'a [ClothModel<R>], &'a [ColliderModel]);

/// The links of all constraints.
pub struct Links<R: Real> {
    /// By constraint.
    pub constraints: Vec<ConstraintLinks<R>>,
    pub(super) blocks: AllBlocks,
}

/// The links of one constraint.
pub struct ConstraintLinks<R> {
    /// As formed; sliding moves their second sides.
    pub links: Vec<Link>,
    /// Whether each is broken.
    pub broken: Vec<bool>,
    /// `glueStrength` of the last frame: where it becomes 1, links heal.
    pub(super) glue_strength: f64,
    pub(super) layout: Layout,
    /// Pairs of single points, all of the same strength.
    pairs: RowList<LinkGroup<R>>,
    pub(super) one: CombinedList<R, 1>,
    pub(super) two: CombinedList<R, 2>,
    pub(super) three: CombinedList<R, 3>,
    pub(super) four: CombinedList<R, 4>,
    pub(super) five: CombinedList<R, 5>,
    pub(super) six: CombinedList<R, 6>,
    /// Links on surfaces.
    pub(super) surface: Vec<SurfaceRow>,
    pub(super) topology: Topology,
}

/// What decides which list a link belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) can_break: bool,
    pub(super) is_physical: bool,
    pub(super) is_weld: bool,
}

encode_struct!([] Layout { can_break: bool, is_physical: bool, is_weld: bool });

/// Links of `N` free points.
pub(super) struct CombinedList<R, const N: usize> {
    pub(super) rows: RowList<CombinedGroup<R, N>>,
    /// Impulses since the start of the substep, one entry per lane group; empty where nothing can break.
    pub(super) impulses: Vec<VectorGroup<R>>,
}

impl<R, const N: usize> Default for CombinedList<R, N> {
    fn default() -> Self {
        Self { rows: RowList::default(), impulses: Vec::new() }
    }
}

impl<R: Real, const N: usize> CombinedList<R, N> {
    fn new(all: &[(u32, Ends)], links: &[Link], layout: Layout, blocks: &AllBlocks) -> Self {
        let row = |(at, ends): &(u32, Ends)| CombinedRow {
            points: std::array::from_fn(|k| ends.rows[k]),
            weights: std::array::from_fn(|k| R::from_f64(ends.weights[k])),
            push: std::array::from_fn(|k| R::from_f64(ends.push[k])),
            rest: R::from_f64(links[*at as usize].rest),
            link: *at,
        };
        let rows: Vec<CombinedRow<R, N>> = all.iter().filter(|(_, ends)| ends.count == N).map(row).collect();
        let rows = RowList::new(&rows, blocks);
        let loads = if layout.can_break { rows.groups().len() } else { 0 };
        Self { impulses: vec![[[R::ZERO; 4]; 3]; loads], rows }
    }

    fn sweep(
        &mut self,
        points: DisjointSlice<'_, Row4<R>>,
        pass: &LinkPass<R>,
        blocks: usize,
        pool: &ThreadPool,
    ) {
        let Self { rows, impulses } = self;
        if rows.len() == 0 {
            return;
        }
        let has_loads = !impulses.is_empty();
        let loads = DisjointSlice::new(impulses);
        for_batches(rows, blocks, pool, |batch| {
            let (groups, first) = (rows.batch(batch), rows.first_group(batch) as u32);
            // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point; batches share no
            // group.
            #[allow(unsafe_code)]
            unsafe {
                let loads = if has_loads { loads.run(first..first + groups.len() as u32) } else { &mut [] };
                rows::relax(points, groups, loads, pass);
            }
        });
    }

    /// Updates all that depends on the anchors, on prescribed places and on the strength of the frame.
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
            }
        }
    }
}

/// What a frame gives to the rows of a constraint.
pub(super) struct LinkFrame<'a, R> {
    pub(super) prescribed: Prescribed<'a>,
    pub(super) state: &'a State<R>,
    pub(super) cloths: &'a [ClothModel<R>],
}

impl<R: Real> ConstraintLinks<R> {
    pub(super) fn empty(layout: Layout) -> Self {
        Self {
            links: Vec::new(),
            broken: Vec::new(),
            glue_strength: 1.0,
            layout,
            pairs: RowList::default(),
            one: CombinedList::default(),
            two: CombinedList::default(),
            three: CombinedList::default(),
            four: CombinedList::default(),
            five: CombinedList::default(),
            six: CombinedList::default(),
            surface: Vec::new(),
            topology: Topology::default(),
        }
    }

    /// Lays out links.
    pub(super) fn new(
        links: Vec<Link>,
        layout: Layout,
        (cloths, colliders): Models<'_, R>,
        blocks: &AllBlocks,
    ) -> Self {
        let mut own = Self { broken: vec![false; links.len()], ..Self::empty(layout) };
        let (mut pairs, mut combined) = (Vec::new(), Vec::new());
        for (at, link) in (0..).zip(&links) {
            let ends = Ends::new(link, cloths);
            if link.on_surface {
                own.surface.push(SurfaceRow::new(at, ends));
            } else if is_plain_pair(link, &ends, layout) {
                let rest_length = R::from_f64(link.rest);
                let ends = [ends.rows[0], ends.rows[1]];
                pairs.push(LinkRow { ends, rest_length, slenderness: R::from_f64(1.0 / link.strength) });
            } else if ends.count > 0 {
                combined.push((at, ends));
            }
        }
        own.pairs = RowList::new(&pairs, blocks);
        own.one = CombinedList::new(&combined, &links, layout, blocks);
        own.two = CombinedList::new(&combined, &links, layout, blocks);
        own.three = CombinedList::new(&combined, &links, layout, blocks);
        own.four = CombinedList::new(&combined, &links, layout, blocks);
        own.five = CombinedList::new(&combined, &links, layout, blocks);
        own.six = CombinedList::new(&combined, &links, layout, blocks);
        own.topology = Topology::new(&links, cloths, colliders);
        own.links = links;
        own
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        let combined = [self.one.rows.len(), self.two.rows.len(), self.three.rows.len()];
        let more = [self.four.rows.len(), self.five.rows.len(), self.six.rows.len()];
        self.pairs.len() + self.surface.len() + combined.iter().chain(&more).sum::<usize>()
    }

    /// The strength factor of each link in a frame, 0 for broken ones.
    fn factors(&self, frame: &LinkFrame<'_, R>) -> Vec<f64> {
        let dropoff = frame.prescribed.frame.dropoff;
        let factor = |(at, link): (usize, &Link)| {
            let along = dropoff.map_or(1.0, |dropoff| {
                let ends = Ends::new(link, frame.cloths);
                dropoff.at(vector(link, &ends, frame.state, frame.prescribed, 0.0).norm())
            });
            let strength = if self.layout.is_weld { 1.0 } else { link.strength * along };
            if self.broken[at] { 0.0 } else { strength }
        };
        self.links.iter().enumerate().map(factor).collect()
    }

    pub(super) fn begin_frame(&mut self, frame: &LinkFrame<'_, R>) {
        self.pairs.groups_mut().iter_mut().for_each(|group| group.anchor(&frame.state.anchor));
        let combined = self.rows() - self.pairs.len() - self.surface.len();
        if combined > 0 {
            let factors = self.factors(frame);
            let links = &self.links;
            self.one.begin_frame(frame, links, &factors);
            self.two.begin_frame(frame, links, &factors);
            self.three.begin_frame(frame, links, &factors);
            self.four.begin_frame(frame, links, &factors);
            self.five.begin_frame(frame, links, &factors);
            self.six.begin_frame(frame, links, &factors);
        }
    }

    /// One sweep over all links that are not on surfaces.
    pub(super) fn sweep(
        &mut self,
        displacement: &mut [Row4<R>],
        pass: &LinkPass<R>,
        blocks: usize,
        pool: &ThreadPool,
    ) {
        let points = DisjointSlice::new(displacement);
        let pairs = &self.pairs;
        if pairs.len() > 0 {
            for_batches(pairs, blocks, pool, |batch| {
                let groups = pairs.batch(batch).iter().map(|group| (group, Uniform));
                // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point.
                #[allow(unsafe_code)]
                unsafe {
                    stretch::relax(points, groups, &pass.strength);
                }
            });
        }
        self.one.sweep(points, pass, blocks, pool);
        self.two.sweep(points, pass, blocks, pool);
        self.three.sweep(points, pass, blocks, pool);
        self.four.sweep(points, pass, blocks, pool);
        self.five.sweep(points, pass, blocks, pool);
        self.six.sweep(points, pass, blocks, pool);
    }
}

/// Does `work` on all batches of a list that spans several cloths.
fn for_batches<G: Sync>(list: &RowList<G>, blocks: usize, pool: &ThreadPool, work: impl Fn(RowBatch) + Sync) {
    pool.parallel_for(blocks, |block| work(RowBatch::Interior(block)));
    for colour in 0..list.interface_colours() {
        pool.parallel_for(list.interface_tasks(colour), |task| work(RowBatch::Interface(colour, task)));
    }
}

/// Whether a link is a row of stretch: two single points that cannot break and push each other alike.
fn is_plain_pair(link: &Link, ends: &Ends, layout: Layout) -> bool {
    let has_strength = layout.is_weld || link.strength == 1.0 || layout.is_physical && link.strength > 0.0;
    let is_pair = ends.count == 2 && ends.weights[..2] == [1.0, -1.0] && ends.push[..2] == [1.0, -1.0];
    is_pair && link.sides.iter().all(LinkSide::is_free) && has_strength && !layout.can_break
}

impl<R: Real> Links<R> {
    /// No links yet.
    pub fn new(cloths: &[ClothModel<R>]) -> Self {
        Self {
            constraints: Vec::new(),
            blocks: AllBlocks::new(cloths.iter().map(|cloth| cloth.blocks.clone())),
        }
    }

    /// The number of broken links.
    pub fn broken(&self) -> u64 {
        let all = self.constraints.iter().flat_map(|constraint| &constraint.broken);
        all.filter(|broken| **broken).count() as u64
    }

    /// Whether welds can break.
    pub fn can_tear(&self) -> bool {
        self.constraints.iter().any(|own| own.layout.is_weld && own.layout.can_break && !own.links.is_empty())
    }

    /// The lowest row of the points that each row is welded to, itself among them; empty where nothing is welded.
    /// Elements that share such a point are neighbours, and do not collide.
    pub fn clusters(&self, cloths: &[ClothModel<R>]) -> Vec<u32> {
        let welds = self.constraints.iter().filter(|constraint| constraint.layout.is_weld);
        let links = welds.flat_map(|constraint| constraint.links.iter().zip(&constraint.broken));
        let mut parents: Vec<u32> = Vec::new();
        for link in links.filter(|(_, broken)| !**broken).map(|(link, _)| link) {
            let ends = Ends::new(link, cloths);
            if ends.count != 2 || ends.weights[..2] != [1.0, -1.0] {
                continue;
            }
            if parents.is_empty() {
                parents = self.blocks.span().collect();
            }
            let [a, b] = [ends.rows[0], ends.rows[1]].map(|row| root(&mut parents, row));
            parents[a.max(b) as usize] = a.min(b);
        }
        (0..parents.len() as u32).map(|row| root(&mut parents, row)).collect()
    }
}

/// The representative of a row, with path halving.
fn root(parents: &mut [u32], mut row: u32) -> u32 {
    while parents[row as usize] != row {
        let above = parents[parents[row as usize] as usize];
        parents[row as usize] = above;
        row = above;
    }
    row
}

impl<R: Real> ConstraintLinks<R> {
    /// Keeps links and what is broken, and lays their rows out anew.
    pub(super) fn lay_out_again(&mut self, layout: Layout, models: Models<'_, R>, blocks: &AllBlocks) {
        let (broken, glue_strength) = (std::mem::take(&mut self.broken), self.glue_strength);
        let rows = Self::new(std::mem::take(&mut self.links), layout, models, blocks);
        *self = Self { broken, glue_strength, ..rows };
    }
}

/// Links, what is broken and how they are laid out; [`Links::rebuild`] makes the rows.
impl<R: Real> Checkpoint for Links<R> {
    fn save(&self, out: &mut Vec<u8>) {
        (self.constraints.len() as u64).encode(out);
        for constraint in &self.constraints {
            constraint.layout.encode(out);
            constraint.glue_strength.encode(out);
            constraint.links.encode(out);
            constraint.broken.encode(out);
        }
    }
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()> {
        let count = u64::decode(from)?;
        self.constraints.clear();
        for _ in 0..count {
            let layout = Layout::decode(from)?;
            let glue_strength = f64::decode(from)?;
            let links: Vec<Link> = Encode::decode(from)?;
            let broken: Vec<bool> = Encode::decode(from)?;
            (links.len() == broken.len()).then_some(())?;
            self.constraints.push(ConstraintLinks {
                links,
                broken,
                glue_strength,
                ..ConstraintLinks::empty(layout)
            });
        }
        Some(())
    }
}

impl<R: Real> Links<R> {
    /// Whether every link refers to points that exist.
    pub fn are_valid(&self, cloths: &[ClothModel<R>], colliders: &[ColliderModel]) -> bool {
        let sizes = ModelSizes {
            cloths: &|cloth| cloths.get(cloth).map(|cloth| cloth.points().len()),
            colliders: &|collider| colliders.get(collider).map(|collider| collider.positions.len()),
        };
        self.constraints.iter().flat_map(|constraint| &constraint.links).all(|link| sizes.has(link))
    }

    /// Makes the rows of links that a checkpoint holds.
    pub fn rebuild(&mut self, models: Models<'_, R>) {
        for constraint in &mut self.constraints {
            let layout = constraint.layout;
            constraint.lay_out_again(layout, models, &self.blocks);
        }
    }
}
