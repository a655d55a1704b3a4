//! The contacts that passes go through: the candidates that can touch within the next few time steps, laid
//! out in tasks.

use std::sync::{Mutex, RwLock};

use super::candidate::{Candidate, Kind};
use super::near::{Meeting, Motion, Near};
use super::paths::Paths;
use super::tangle::Tangle;
use super::tasks::Tasks;
use super::{Mutual, bodies::Bodies};
use crate::collision::bounce::Bounce;
use crate::collision::terms::Terms;
use crate::columns::Shared;
use crate::scalar::{Real, Row4, add};
use crate::team::Team;

/// Time steps for which contacts are picked.
pub const WINDOW: f64 = 16.0;
/// Candidates per task of picking.
const PER_TASK: usize = 2048;

/// Contacts of one kind, in the order of their tasks.
#[derive(Debug, Clone)]
pub struct Contacts<R, const N: usize, const M: usize> {
    /// The contacts.
    pub list: Vec<Near<R, N, M>>,
    /// Which may be worked on side by side.
    pub tasks: Tasks,
    found: Vec<Near<R, N, M>>,
}

impl<R, const N: usize, const M: usize> Default for Contacts<R, N, M> {
    fn default() -> Self {
        Self { list: Vec::new(), tasks: Tasks::default(), found: Vec::new() }
    }
}

/// All contacts of a window.
#[derive(Debug, Default)]
pub struct Active<R> {
    /// Faces near points.
    pub point_face: Contacts<R, 1, 3>,
    /// Edges near edges.
    pub edge_edge: Contacts<R, 2, 2>,
    /// Edges near points.
    pub point_edge: Contacts<R, 1, 2>,
    /// Points near points.
    pub point_point: Contacts<R, 1, 1>,
    picked: Vec<RwLock<Picked<R>>>,
}

impl<R: Real> Clone for Active<R> {
    /// Nothing: contacts are picked anew for every window.
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// What one task picks.
#[derive(Debug, Default)]
struct Picked<R> {
    point_face: Vec<Near<R, 1, 3>>,
    edge_edge: Vec<Near<R, 2, 2>>,
    point_edge: Vec<Near<R, 1, 2>>,
    point_point: Vec<Near<R, 1, 1>>,
}

/// What picking looks at.
struct View<'a, R> {
    bodies: &'a Bodies,
    terms: &'a [Option<Terms<R>>],
    cloths: usize,
    near: &'a Paths<R>,
    /// Displacements at the start of the time step.
    start: &'a [Row4<R>],
    anchors: &'a [[f64; 3]],
    tangle: &'a Tangle,
    left: &'a [bool],
}

/// Picks the contacts of the window that `near` foresees, for points of which something new is foreseen.
pub fn pick<R: Real>(
    mutual: &mut Mutual<R>,
    cloths: usize,
    anchors: &[[f64; 3]],
    start: &[Row4<R>],
    team: &Team,
) {
    let Mutual { bodies, terms, near, candidates, active, tangle, left, .. } = mutual;
    let view = View { bodies, terms, cloths, near, start, anchors, tangle, left };
    let chunks = candidates.list.len().div_ceil(PER_TASK);
    active.picked.resize_with(active.picked.len().max(chunks), RwLock::default);
    let (picked, list) = (&active.picked, &candidates.list);
    team.phase(chunks, |task| {
        // Nobody else has it: a task is done once.
        let Ok(mut picked) = picked[task].write() else { return };
        picked.clear();
        let end = ((task + 1) * PER_TASK).min(list.len());
        list[task * PER_TASK..end].iter().for_each(|candidate| view.pick(candidate, &mut picked));
    });
    let Active { point_face, edge_edge, point_edge, point_point, picked } = active;
    let picked = &picked[..chunks];
    // Two tasks of about the same length; nobody else has what is theirs.
    let (to_points, to_edges) = (Mutex::new((point_face, point_point)), Mutex::new((edge_edge, point_edge)));
    team.phase(2, |task| match task {
        0 => {
            let Ok(mut lists) = to_points.lock() else { return };
            let (point_face, point_point) = &mut *lists;
            point_face.renew(bodies, left, picked, |picked| &picked.point_face);
            point_point.renew(bodies, left, picked, |picked| &picked.point_point);
        }
        _ => {
            let Ok(mut lists) = to_edges.lock() else { return };
            let (edge_edge, point_edge) = &mut *lists;
            edge_edge.renew(bodies, left, picked, |picked| &picked.edge_edge);
            point_edge.renew(bodies, left, picked, |picked| &picked.point_edge);
        }
    });
}

impl<R> Picked<R> {
    fn clear(&mut self) {
        self.point_face.clear();
        self.edge_edge.clear();
        self.point_edge.clear();
        self.point_point.clear();
    }
}

impl<R: Real> View<'_, R> {
    fn pick(&self, candidate: &Candidate, picked: &mut Picked<R>) {
        let is_new = candidate.points.iter().any(|&point| self.left[point as usize]);
        if !is_new {
            return;
        }
        let cloths = candidate.ends().map(|point| self.bodies.cloth[point as usize]);
        if self.tangle.lets_pass(candidate, cloths) {
            return;
        }
        let [ours, theirs] = cloths.map(|cloth| cloth as usize);
        let Some(terms) = &self.terms[ours * self.cloths + theirs] else { return };
        let thickness = f64::from(candidate.thickness);
        let meeting = Meeting {
            thickness: R::from_f64(thickness),
            reach: R::from_f64(thickness * terms.reach),
            terms: (ours * self.cloths + theirs) as u32,
            is_swept: self.is_swept(candidate),
        };
        let [a, b, c, d] = candidate.points;
        match candidate.kind {
            Kind::PointFace => picked.point_face.extend(self.find(([a], [b, c, d]), meeting)),
            Kind::EdgeEdge => picked.edge_edge.extend(self.find(([a, b], [c, d]), meeting)),
            Kind::PointEdge => picked.point_edge.extend(self.find(([a], [b, c]), meeting)),
            Kind::PointPoint => picked.point_point.extend(self.find(([a], [b]), meeting)),
        }
    }

    /// Whether the point of a pair is of no face, or one of two points.
    fn is_swept(&self, candidate: &Candidate) -> bool {
        let is_free = |point: u32| self.bodies.stars.triangles(point).is_empty();
        let [first, second] = [candidate.points[0], candidate.points[1]];
        match candidate.kind {
            Kind::EdgeEdge => false,
            Kind::PointPoint => is_free(first) || is_free(second),
            Kind::PointEdge | Kind::PointFace => is_free(first),
        }
    }

    #[inline(always)]
    fn find<const N: usize, const M: usize>(
        &self,
        points: ([u32; N], [u32; M]),
        meeting: Meeting<R>,
    ) -> Option<Near<R, N, M>> {
        let from = |point: u32| self.near.from[point as usize];
        let to = |point: u32| add(from(point).xyz(), self.near.travel[point as usize].xyz());
        let start = |point: u32| self.start[point as usize].xyz();
        Near::find(points, meeting, self.anchors, start, from, to)
    }
}

impl<R: Real, const N: usize, const M: usize> Contacts<R, N, M> {
    /// Keeps the contacts between points that are where they were foreseen to be.
    fn keep(&mut self, left: &[bool]) {
        let keeps =
            |near: &Near<R, N, M>| near.ours.iter().chain(&near.theirs).all(|&point| !left[point as usize]);
        self.found.clear();
        self.found.extend(self.list.iter().filter(|near| keeps(near)));
    }

    /// Takes up what was picked, in the order in which it was, and lays it out.
    fn renew(
        &mut self,
        bodies: &Bodies,
        left: &[bool],
        picked: &[RwLock<Picked<R>>],
        of: impl Fn(&Picked<R>) -> &Vec<Near<R, N, M>>,
    ) {
        self.keep(left);
        for picked in picked.iter().filter_map(|task| task.read().ok()) {
            self.found.extend_from_slice(of(&picked));
        }
        self.lay_out(bodies);
    }

    /// Puts what was found in the order of its tasks.
    fn lay_out(&mut self, bodies: &Bodies) {
        // Cloth meets in the order in which it was found. Free points come together in any order, and much comes of it: they
        // meet in the order of their numbers, so that what is far away has no say in it.
        if self.found.iter().any(Near::is_swept) {
            self.found.sort_by_key(Near::rank);
        }
        let block = |point: u32| bodies.block[point as usize];
        let blocks = self.found.iter().map(|near| {
            let mut of_points = [block(near.ours[0]); 4];
            let points = near.ours.iter().chain(&near.theirs);
            of_points.iter_mut().zip(points).for_each(|(place, &point)| *place = block(point));
            of_points
        });
        self.tasks.lay_out(blocks, bodies.blocks);
        self.list.clear();
        self.list.extend(self.tasks.order.iter().map(|&(_, at)| self.found[at as usize]));
    }

    /// Pushes apart what is too near, once; how many were.
    pub fn sweep(&mut self, step: &Motion<'_, R>, team: &Team) -> u64 {
        self.count(team, |near| near.resolve(step))
    }

    /// How many contacts are not proven.
    pub fn prove(&mut self, step: &Motion<'_, R>, team: &Team) -> u64 {
        self.count(team, |near| !near.prove(step))
    }

    /// Calls `work` with each contact, tasks side by side; how often it said yes.
    fn count(&mut self, team: &Team, work: impl Fn(&mut Near<R, N, M>) -> bool + Sync) -> u64 {
        let count = std::sync::atomic::AtomicU64::new(0);
        let Self { list, tasks, .. } = self;
        let list = Shared::new(list);
        for phase in &tasks.phases {
            team.phase(phase.len(), |task| {
                // SAFETY: runs of two tasks do not overlap.
                #[allow(unsafe_code)]
                let run = unsafe { list.run(tasks.run(phase, task)) };
                let mut yes = 0;
                for near in run {
                    yes += u64::from(work(near));
                }
                if yes > 0 {
                    count.fetch_add(yes, std::sync::atomic::Ordering::Relaxed);
                }
            });
        }
        count.into_inner()
    }
}

impl<R: Real> Active<R> {
    /// The distance of the nearest two, over the thickness kept between them.
    pub fn closeness(&self, step: &Motion<'_, R>) -> Option<R> {
        let pairs = self.point_face.list.iter().map(|near| near.closeness(step));
        let pairs = pairs.chain(self.edge_edge.list.iter().map(|near| near.closeness(step)));
        let pairs = pairs.chain(self.point_edge.list.iter().map(|near| near.closeness(step)));
        let pairs = pairs.chain(self.point_point.list.iter().map(|near| near.closeness(step)));
        pairs.reduce(|least, x| if x < least { x } else { least })
    }

    /// Pushes apart what is too near, once: points against faces last, for they carry cloth on cloth most
    /// smoothly. How many were.
    pub fn sweep(&mut self, step: &Motion<'_, R>, team: &Team) -> u64 {
        self.edge_edge.sweep(step, team)
            + self.point_point.sweep(step, team)
            + self.point_edge.sweep(step, team)
            + self.point_face.sweep(step, team)
    }

    /// Holds together what sticks: points to what they touch.
    pub fn stick(&mut self, step: &Motion<'_, R>, team: &Team) {
        self.point_point.count(team, |near| near.stick(step));
        self.point_edge.count(team, |near| near.stick(step));
        self.point_face.count(team, |near| near.stick(step));
    }

    /// Gives back part of their speed to what came together.
    pub fn bounce(
        &mut self,
        step: &Motion<'_, R>,
        velocities: Shared<'_, Row4<R>>,
        rebound: Bounce<R>,
        team: &Team,
    ) {
        self.edge_edge.count(team, |near| near.bounce(step, velocities, rebound));
        self.point_point.count(team, |near| near.bounce(step, velocities, rebound));
        self.point_edge.count(team, |near| near.bounce(step, velocities, rebound));
        self.point_face.count(team, |near| near.bounce(step, velocities, rebound));
    }

    /// How many contacts are not proven.
    pub fn prove(&mut self, step: &Motion<'_, R>, team: &Team) -> u64 {
        self.edge_edge.prove(step, team) + self.point_face.prove(step, team)
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
        for near in &mut self.edge_edge.list {
            if !near.prove(step) {
                edges(near);
                mended += 1;
            }
        }
        for near in &mut self.point_face.list {
            if !near.prove(step) {
                faces(near);
                mended += 1;
            }
        }
        mended
    }
}
