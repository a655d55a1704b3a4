//! The links of all constraints: their state, and their rows by the number of free points.

use crate::bytes::{Checkpoint, Encode, Reader, encode_struct};
use crate::constraints::projection::relax;
use crate::constraints::strength_map::Uniform;
use crate::constraints::stretch::{LinkGroup, LinkRow};
use crate::input::links::{Link, LinkSide};
use crate::input::{ClothId, PointId};
use crate::math::{Real, Row4};
use crate::model::blocks::{AllBlocks, Partition};
use crate::model::rows::RowList;
use crate::model::{ClothModel, ColliderModel};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::union_find::UnionFind;

use super::batches::for_batches;
use super::combined::{CombinedLists, LinkFrame};
use super::ends::Ends;
use super::pairs::PairList;
use super::rows::LinkPass;
use super::sizes::ModelSizes;
use super::tear::Nodes;
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
    plain: RowList<LinkGroup<R>>,
    /// Other pairs of single points.
    pub(super) pairs: PairList<R>,
    /// Where the welds among these tear; empty where nothing can break.
    pub(super) nodes: Nodes,
    /// All other links between places.
    pub(super) combined: CombinedLists<R>,
    /// Links that resist folding.
    pub(super) folds: CombinedLists<R>,
    /// Links on surfaces.
    pub(super) surface: Vec<SurfaceRow>,
    /// Whether a pass goes over the links in order and backward: where more than two meet at a point.
    pub(super) is_swept_both_ways: bool,
    pub(super) topology: Topology,
}

/// What decides which list a link belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) can_break: bool,
    pub(super) is_physical: bool,
    pub(super) is_weld: bool,
    /// Whether their strength depends on their length.
    pub(super) drops_off: bool,
}

encode_struct!([] Layout { can_break: bool, is_physical: bool, is_weld: bool, drops_off: bool });

impl<R: Real> ConstraintLinks<R> {
    pub(super) fn empty(layout: Layout) -> Self {
        Self {
            links: Vec::new(),
            broken: Vec::new(),
            glue_strength: 1.0,
            layout,
            plain: RowList::default(),
            pairs: PairList::default(),
            nodes: Nodes::default(),
            combined: CombinedLists::default(),
            folds: CombinedLists::default(),
            surface: Vec::new(),
            is_swept_both_ways: false,
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
        let (mut plain, mut pairs) = (Vec::new(), Vec::new());
        let (mut combined, mut folds) = (Vec::new(), Vec::new());
        let mut joined = Vec::new();
        for (at, link) in (0..).zip(&links) {
            let ends = Ends::new(link, cloths);
            if link.fold().is_none() {
                joined.extend_from_slice(&ends.rows[..ends.count]);
            }
            if link.is_on_surface() {
                own.surface.push(SurfaceRow::new(at, ends));
            } else if link.fold().is_some() {
                folds.push((at, ends));
            } else if is_plain(link, &ends, layout) {
                let rest_length = R::from_f64(link.rest);
                let ends = [ends.rows[0], ends.rows[1]];
                let slenderness = R::from_f64(if layout.is_weld { 1.0 } else { 1.0 / link.strength });
                plain.push(LinkRow { ends, rest_length, slenderness, warp: R::ONE });
            } else if is_pair(link, &ends, layout) {
                pairs.push((at, ends));
            } else if ends.count > 0 {
                combined.push((at, ends));
            }
        }
        joined.sort_unstable();
        own.is_swept_both_ways = joined.chunk_by(|a, b| a == b).any(|links| links.len() > 2);
        own.plain = RowList::new(&plain, blocks);
        own.pairs = PairList::new(&pairs, &links, layout.can_break, blocks);
        if layout.can_break {
            own.nodes = Nodes::new(&pairs, layout.is_weld);
        }
        own.combined = CombinedLists::new(&combined, &links, layout.can_break, blocks);
        own.folds = CombinedLists::new(&folds, &links, false, blocks);
        own.topology = Topology::new(&links, cloths, colliders);
        own.links = links;
        own
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.plain.len() + self.surface.len() + self.rows_with_factors()
    }

    /// The links that join places and are whole.
    pub fn joining(&self) -> impl Iterator<Item = &Link> {
        let all = self.links.iter().zip(&self.broken);
        all.filter(|(link, broken)| !**broken && link.fold().is_none()).map(|(link, _)| link)
    }

    /// Whether any of its links resist folding.
    pub(super) fn has_folds(&self) -> bool {
        self.folds.len() > 0
    }

    /// The number of rows whose strength has a factor in each frame.
    fn rows_with_factors(&self) -> usize {
        self.pairs.rows.len() + self.combined.len() + self.folds.len()
    }

    /// The strength factor of each link in a frame, 0 for broken ones.
    fn factors(&self, frame: &LinkFrame<'_, R>) -> Vec<f64> {
        let factor = |(at, link): (usize, &Link)| match (self.broken[at], link.fold()) {
            (true, _) => 0.0,
            // Classic shares of the error do not grow with the angle.
            (false, Some(fold)) if self.layout.is_physical => link.strength * frame.stiffening(&fold, link),
            (false, Some(_)) => link.strength,
            _ if self.layout.is_weld => 1.0,
            _ => link.strength * frame.drop(link),
        };
        self.links.iter().enumerate().map(factor).collect()
    }

    pub(super) fn begin_frame(&mut self, frame: &LinkFrame<'_, R>) {
        self.plain.groups_mut().iter_mut().for_each(|group| group.anchor(&frame.state.anchor));
        if self.rows_with_factors() > 0 {
            let factors = self.factors(frame);
            self.pairs.begin_frame(&frame.state.anchor, &factors, self.layout.is_physical);
            self.combined.begin_frame(frame, &self.links, &factors);
            self.folds.begin_frame(frame, &self.links, &factors);
        }
        for row in &mut self.surface {
            row.contact_distance = frame.collisions.distance(&self.links[row.link as usize]);
        }
    }

    /// One sweep over all links that are not on surfaces, and one over those that resist folding.
    pub(super) fn sweep(
        &mut self,
        displacement: &mut [Row4<R>],
        [pass, fold]: [&LinkPass<R>; 2],
        blocks: usize,
        pool: &ThreadPool,
    ) {
        let points = DisjointSlice::new(displacement);
        if pass.backward {
            self.folds.sweep(points, fold, blocks, pool);
            self.combined.sweep(points, pass, blocks, pool);
            self.pairs.sweep(points, pass, blocks, pool);
            self.sweep_plain(points, pass, blocks, pool);
        } else {
            self.sweep_plain(points, pass, blocks, pool);
            self.pairs.sweep(points, pass, blocks, pool);
            self.combined.sweep(points, pass, blocks, pool);
            self.folds.sweep(points, fold, blocks, pool);
        }
    }

    fn sweep_plain(
        &self,
        points: DisjointSlice<'_, Row4<R>>,
        pass: &LinkPass<R>,
        blocks: usize,
        pool: &ThreadPool,
    ) {
        let plain = &self.plain;
        if plain.len() > 0 {
            for_batches(plain, blocks, pass.backward, pool, |batch| {
                let groups = plain.batch(batch);
                // SAFETY: interior rows of two blocks, and interface rows of one colour, share no point.
                #[allow(unsafe_code)]
                unsafe {
                    relax::<R, _, 2>(points, groups, Uniform, pass.backward, &pass.strength);
                }
            });
        }
    }
}

/// Whether a link joins two single points that push each other alike, and whose distance contact does not limit.
fn is_pair(link: &Link, ends: &Ends, layout: Layout) -> bool {
    let is_pair = ends.count == 2 && ends.weights[..2] == [1.0, -1.0] && ends.push[..2] == [1.0, -1.0];
    is_pair && link.sides.iter().all(LinkSide::is_free) && !may_meet_contact(link, layout)
}

/// Whether contact may keep the two points of a link farther apart than it would pull them. Welded points do not collide,
/// and links that break are judged beside their neighbours.
fn may_meet_contact(link: &Link, layout: Layout) -> bool {
    let joins_cloths = link.points().is_some_and(|[(a, _), (b, _)]| a != b);
    joins_cloths && !layout.is_weld && !layout.can_break
}

/// Whether it is a row of stretch: a pair that cannot break, of a strength that does not change.
fn is_plain(link: &Link, ends: &Ends, layout: Layout) -> bool {
    let is_even = layout.is_weld || link.strength == 1.0 || layout.is_physical && link.strength > 0.0;
    is_pair(link, ends, layout) && is_even && !layout.can_break && (layout.is_weld || !layout.drops_off)
}

impl<R: Real> Links<R> {
    /// No links yet.
    pub fn new(cloths: &[ClothModel<R>]) -> Self {
        Self {
            constraints: Vec::new(),
            blocks: AllBlocks::new(cloths.iter().map(|cloth| cloth.blocks.clone())),
        }
    }

    /// The pairs of points that the whole welds of a constraint join.
    pub fn welds(&self, constraint: usize) -> Vec<[(ClothId, PointId); 2]> {
        let own = self.constraints.get(constraint).filter(|own| own.layout.is_weld);
        own.into_iter().flat_map(ConstraintLinks::joining).filter_map(Link::points).collect()
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
        let mut sets: Option<UnionFind> = None;
        for link in links.filter(|(_, broken)| !**broken).map(|(link, _)| link) {
            let ends = Ends::new(link, cloths);
            if ends.count != 2 || ends.weights[..2] != [1.0, -1.0] {
                continue;
            }
            let sets = sets.get_or_insert_with(|| UnionFind::new(self.blocks.span().len()));
            sets.union(ends.rows[0], ends.rows[1]);
        }
        sets.map_or_else(Vec::new, |mut sets| self.blocks.span().map(|row| sets.find(row)).collect())
    }
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
