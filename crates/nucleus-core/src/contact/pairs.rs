//! The pairs that passes go through: all that can touch within a substep, and of these the active ones, which
//! can touch within the next few time steps.

use std::ops::Range;
use std::sync::Mutex;

use super::collider_contact::Pair;
use super::foresee::Foreseen;
use super::search::Found;
use super::trapped::Trapped;
use crate::math::{Real, Row4};
use crate::model::Blocks;
use crate::parallel::thread_pool::ThreadPool;

/// The pairs of one cloth and one collider, and the span they hold for.
#[derive(Debug)]
pub struct PairList<R> {
    /// The cloth, by its index.
    pub cloth: usize,
    /// The collider, by its index.
    pub collider: usize,
    /// The span, as shares of the frame.
    pub span: [f64; 2],
    /// Points of the cloth near faces of the collider.
    pub point_face: Vec<Pair<R, 1, 3>>,
    /// Edges near edges.
    pub edge_edge: Vec<Pair<R, 2, 2>>,
    /// Faces of the cloth near points of the collider.
    pub face_point: Vec<Pair<R, 3, 1>>,
    /// `point_face` in the order of points: the point in the upper half, the index in the lower.
    pub by_point: Vec<u64>,
    /// Those of the pairs that can touch within the next few time steps.
    pub active: Active,
    /// Which groups the last search went through.
    pub searched: Vec<bool>,
    /// The same, by their index.
    pub again: Vec<u32>,
    /// What the tasks of a search find.
    pub tasks: Vec<Mutex<Found<R>>>,
    /// Points of the cloth that are inside the collider.
    pub trapped: Trapped,
}

/// Indices into the columns of a [`PairList`].
#[derive(Debug, Clone, Default)]
pub struct Active {
    /// Of `point_face`, sorted by point.
    pub point_face: Vec<u32>,
    /// The run of them that belongs to each block of the cloth.
    pub runs: Vec<Range<u32>>,
    /// Of `edge_edge`.
    pub edge_edge: Vec<u32>,
    /// Of `face_point`.
    pub face_point: Vec<u32>,
    /// Those of `point_face`, `edge_edge` and `face_point` that the motion bounds of the window do not certify: at the end of
    /// a time step each of them needs a proof.
    pub uncertified: [Vec<u32>; 3],
}

/// Share of the thickness above which a gap that holds through the window is a certificate: far above rounding error.
const CERTIFIED: f64 = 0.02;

impl<R: Real> PairList<R> {
    /// No pairs yet.
    pub fn new(cloth: usize, collider: usize) -> Self {
        let span = [0.0, 0.0];
        Self {
            cloth,
            collider,
            span,
            point_face: Vec::new(),
            edge_edge: Vec::new(),
            face_point: Vec::new(),
            by_point: Vec::new(),
            active: Active::default(),
            searched: Vec::new(),
            again: Vec::new(),
            tasks: Vec::new(),
            trapped: Trapped::default(),
        }
    }

    /// Pairs in all.
    pub fn len(&self) -> usize {
        self.point_face.len() + self.edge_edge.len() + self.face_point.len()
    }

    /// Forgets the pairs, keeps the room.
    pub fn clear(&mut self) {
        self.point_face.clear();
        self.by_point.clear();
        self.edge_edge.clear();
        self.face_point.clear();
        self.active.point_face.clear();
        self.active.runs.clear();
        self.active.edge_edge.clear();
        self.active.face_point.clear();
        self.active.uncertified.iter_mut().for_each(Vec::clear);
    }

    /// Follows anchors that move to where the points are.
    pub fn move_anchors(&mut self, moved: &[Row4<R>]) {
        self.point_face.iter_mut().for_each(|pair| pair.move_anchors(moved));
        self.edge_edge.iter_mut().for_each(|pair| pair.move_anchors(moved));
        self.face_point.iter_mut().for_each(|pair| pair.move_anchors(moved));
    }

    /// Picks the pairs whose gap along their plane can fall below `reach` times the thickness within a window of the span, by
    /// the motion bounds of the points. Marks those that the bounds do not certify.
    pub fn activate(
        &mut self,
        foreseen: &Foreseen<'_, R>,
        window: [f64; 2],
        thickness: R,
        reach: f64,
        blocks: &Blocks,
        pool: &ThreadPool,
    ) {
        let Self { span, point_face, edge_edge, face_point, by_point, active, trapped, .. } = self;
        let share = |time: f64| if span[1] > span[0] { (time - span[0]) / (span[1] - span[0]) } else { 0.0 };
        let window = window.map(|time| (R::from_f64(share(time)), foreseen.gone(time)));
        let all = |pairs: usize| 0..pairs as u32;
        // Two tasks of about the same length; nobody else has what is theirs.
        let Active { point_face: of_points, edge_edge: of_edges, face_point: of_faces, runs, uncertified } =
            active;
        let [points_open, edges_open, faces_open] = uncertified;
        let points = Mutex::new((&mut *of_points, points_open));
        let elements = Mutex::new(((of_edges, edges_open), (of_faces, faces_open)));
        let reach = [thickness * R::from_f64(reach), thickness * R::from_f64(CERTIFIED)];
        pool.parallel_for(2, |task| match task {
            0 => {
                let Ok(mut found) = points.lock() else { return };
                let order = by_point.iter().map(|&key| key as u32);
                let (found, open) = &mut *found;
                pick(point_face, order, [found, open], foreseen, window, reach, trapped);
            }
            _ => {
                let Ok(mut found) = elements.lock() else { return };
                let ((edges, edges_open), (faces, faces_open)) = &mut *found;
                let (edges, faces) = ([&mut **edges, &mut **edges_open], [&mut **faces, &mut **faces_open]);
                pick(edge_edge, all(edge_edge.len()), edges, foreseen, window, reach, trapped);
                pick(face_point, all(face_point.len()), faces, foreseen, window, reach, trapped);
            }
        });
        let place =
            |end: u32| of_points.partition_point(|&pair| point_face[pair as usize].points[0] < end) as u32;
        let run = |block: usize| place(blocks.range(block).start)..place(blocks.range(block).end);
        runs.clear();
        runs.extend((0..blocks.len()).map(run));
    }
}

fn pick<R: Real, const N: usize, const M: usize>(
    pairs: &[Pair<R, N, M>],
    order: impl Iterator<Item = u32>,
    [active, uncertified]: [&mut Vec<u32>; 2],
    foreseen: &Foreseen<'_, R>,
    window: [(R, [R; 3]); 2],
    [reach, certified]: [R; 2],
    trapped: &Trapped,
) {
    active.clear();
    uncertified.clear();
    let is_held = |pair: &Pair<R, N, M>| {
        trapped.points.is_empty() || !pair.points.iter().any(|&point| trapped.holds(point))
    };
    for index in order {
        let pair = &pairs[index as usize];
        let gap = pair.least_gap(window, foreseen);
        if gap < reach && is_held(pair) {
            active.push(index);
            if gap <= certified {
                uncertified.push(index);
            }
        }
    }
}
