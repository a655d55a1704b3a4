//! The contacts that passes go through, of all kinds.

use std::sync::{Mutex, RwLock};

use super::contacts::{Blocks, Contacts};
use super::near::{Motion, Near};
use super::search::Task;
use crate::bytes::checkpoint_struct;
use crate::contact::bounce::Bounce;
use crate::math::{Real, Row4};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// All that can touch in a span.
#[derive(Debug)]
pub struct Active<R> {
    /// Faces near points.
    pub point_face: Contacts<R, 1, 3>,
    /// Edges near edges.
    pub edge_edge: Contacts<R, 2, 2>,
    /// Edges near points.
    pub point_edge: Contacts<R, 1, 2>,
    /// Points near points.
    pub point_point: Contacts<R, 1, 1>,
}

/// What one task of a search finds.
#[derive(Debug)]
pub struct Found<R> {
    /// Faces near points.
    pub point_face: Vec<Near<R, 1, 3>>,
    /// Edges near edges.
    pub edge_edge: Vec<Near<R, 2, 2>>,
    /// Edges near points.
    pub point_edge: Vec<Near<R, 1, 2>>,
    /// Points near points.
    pub point_point: Vec<Near<R, 1, 1>>,
}

checkpoint_struct!([R: Real] Active<R> {
    columns: [], values: [], parts: [point_face, edge_edge, point_edge, point_point], rebuilt: [],
});

impl<R> Default for Active<R> {
    fn default() -> Self {
        Self {
            point_face: Contacts::default(),
            edge_edge: Contacts::default(),
            point_edge: Contacts::default(),
            point_point: Contacts::default(),
        }
    }
}

impl<R> Default for Found<R> {
    fn default() -> Self {
        Self {
            point_face: Vec::new(),
            edge_edge: Vec::new(),
            point_edge: Vec::new(),
            point_point: Vec::new(),
        }
    }
}

impl<R> Found<R> {
    /// Forgets it, keeps the room.
    pub fn clear(&mut self) {
        self.point_face.clear();
        self.edge_edge.clear();
        self.point_edge.clear();
        self.point_point.clear();
    }
}

/// What a search found, and whose contacts it replaces.
struct Renewal<'a, R> {
    tasks: &'a [RwLock<Task<R>>],
    strayed: &'a [bool],
    is_late: bool,
    blocks: Blocks<'a>,
}

impl<R: Real> Renewal<'_, R> {
    /// Renews the contacts of a kind, in the order of the tasks.
    fn renew<const N: usize, const M: usize>(
        &self,
        contacts: &mut Contacts<R, N, M>,
        of: impl Fn(&Found<R>) -> &[Near<R, N, M>],
    ) {
        contacts.begin(self.strayed, self.is_late);
        for task in self.tasks.iter().filter_map(|task| task.read().ok()) {
            contacts.take(of(&task.found));
        }
        contacts.lay_out(self.is_late, self.blocks);
    }
}

impl<R: Real> Active<R> {
    /// Reckons from anchors where they are now.
    pub fn follow(&mut self, anchors: &[[f64; 3]]) {
        self.point_face.follow(anchors);
        self.edge_edge.follow(anchors);
        self.point_edge.follow(anchors);
        self.point_point.follow(anchors);
    }

    /// Takes up what tasks found, in their order, and lets go of what points had that `strayed`: as a span begins, or later.
    pub(super) fn renew(
        &mut self,
        tasks: &[RwLock<Task<R>>],
        strayed: &[bool],
        is_late: bool,
        blocks: Blocks<'_>,
        pool: &ThreadPool,
    ) {
        let Self { point_face, edge_edge, point_edge, point_point } = self;
        // Two tasks of about the same length; nobody else has what is theirs.
        let of_points = Mutex::new((point_face, point_point));
        let of_edges = Mutex::new((edge_edge, point_edge));
        let renewal = Renewal { tasks, strayed, is_late, blocks };
        pool.parallel_for(2, |half| match half {
            0 => {
                let Ok(mut lists) = of_points.lock() else { return };
                renewal.renew(lists.0, |found| &found.point_face);
                renewal.renew(lists.1, |found| &found.point_point);
            }
            _ => {
                let Ok(mut lists) = of_edges.lock() else { return };
                renewal.renew(lists.0, |found| &found.edge_edge);
                renewal.renew(lists.1, |found| &found.point_edge);
            }
        });
    }

    /// How many contacts there are.
    pub fn len(&self) -> u64 {
        let lists = [self.point_face.iter().count(), self.edge_edge.iter().count()];
        let lesser = [self.point_edge.iter().count(), self.point_point.iter().count()];
        lists.iter().chain(&lesser).sum::<usize>() as u64
    }

    /// How many keep less than the cloth's thickness, because their elements are neighbours at rest.
    pub fn count_rest_limited(&self) -> u64 {
        let limited = self.point_face.iter().filter(|near| near.is_rest_limited()).count()
            + self.edge_edge.iter().filter(|near| near.is_rest_limited()).count()
            + self.point_edge.iter().filter(|near| near.is_rest_limited()).count();
        limited as u64
    }

    /// The distance of the nearest two, over the thickness kept between them.
    pub fn closeness(&self, step: &Motion<'_, R>) -> Option<R> {
        let pairs = self.point_face.iter().map(|near| near.closeness(step));
        let pairs = pairs.chain(self.edge_edge.iter().map(|near| near.closeness(step)));
        let pairs = pairs.chain(self.point_edge.iter().map(|near| near.closeness(step)));
        let pairs = pairs.chain(self.point_point.iter().map(|near| near.closeness(step)));
        pairs.reduce(|least, x| if x < least { x } else { least })
    }

    /// Pushes apart what is too near, once: points against faces last, for they carry cloth on cloth most
    /// smoothly. How many were.
    pub fn sweep(&mut self, step: &Motion<'_, R>, pool: &ThreadPool) -> u64 {
        self.edge_edge.sweep(step, pool)
            + self.point_point.sweep(step, pool)
            + self.point_edge.sweep(step, pool)
            + self.point_face.sweep(step, pool)
    }

    /// Holds together what sticks: points to what they touch.
    pub fn stick(&mut self, step: &Motion<'_, R>, pool: &ThreadPool) {
        self.point_point.count(pool, |near| near.stick(step));
        self.point_edge.count(pool, |near| near.stick(step));
        self.point_face.count(pool, |near| near.stick(step));
    }

    /// Gives back part of their speed to what came together.
    pub fn bounce(
        &mut self,
        step: &Motion<'_, R>,
        velocities: DisjointSlice<'_, Row4<R>>,
        rebound: Bounce<R>,
        pool: &ThreadPool,
    ) {
        self.edge_edge.count(pool, |near| near.bounce(step, velocities, rebound));
        self.point_point.count(pool, |near| near.bounce(step, velocities, rebound));
        self.point_edge.count(pool, |near| near.bounce(step, velocities, rebound));
        self.point_face.count(pool, |near| near.bounce(step, velocities, rebound));
    }

    /// Carries what slipped over into a span that begins at `start`; the last one `began_at`.
    pub fn carry_slips(&mut self, start: &[Row4<R>], began_at: &[Row4<R>]) {
        self.point_face.iter_mut().for_each(|near| near.carry_slip(start, began_at));
        self.edge_edge.iter_mut().for_each(|near| near.carry_slip(start, began_at));
        self.point_edge.iter_mut().for_each(|near| near.carry_slip(start, began_at));
        self.point_point.iter_mut().for_each(|near| near.carry_slip(start, began_at));
    }

    /// How many contacts are not proven.
    pub fn prove(&mut self, step: &Motion<'_, R>, pool: &ThreadPool) -> u64 {
        self.edge_edge.prove(step, pool) + self.point_face.prove(step, pool)
    }

    /// Clips the motion of every contact that is not proven, one after the other; how many there were.
    pub fn clip(&mut self, step: &Motion<'_, R>) -> u64 {
        self.mend(step, |near| near.clip(step), |near| near.clip(step))
    }

    /// Lets every contact that is not proven go nowhere, one after the other, or along with a point of it that is
    /// `held`; how many there were.
    pub fn stop(&mut self, step: &Motion<'_, R>, held: &mut [bool]) -> u64 {
        let held = std::cell::RefCell::new(held);
        self.mend(
            step,
            |near| near.stop(step, &mut held.borrow_mut()),
            |near| near.stop(step, &mut held.borrow_mut()),
        )
    }

    /// Does something about every contact that is not proven.
    fn mend(
        &mut self,
        step: &Motion<'_, R>,
        edges: impl Fn(&mut Near<R, 2, 2>),
        faces: impl Fn(&mut Near<R, 1, 3>),
    ) -> u64 {
        let mut mended = 0;
        for near in self.edge_edge.iter_mut() {
            if !near.prove(step) {
                edges(near);
                mended += 1;
            }
        }
        for near in self.point_face.iter_mut() {
            if !near.prove(step) {
                faces(near);
                mended += 1;
            }
        }
        mended
    }
}
