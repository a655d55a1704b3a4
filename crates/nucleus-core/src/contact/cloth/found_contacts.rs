//! What a search task finds: candidates by kind, in runs of one contact task each.

use std::ops::Range;

use crate::contact::cloth::contact::{Candidate, ContactKind};
use crate::contact::cloth::new_elements::NewElements;
use crate::contact::cloth::swept_points::ElementPoints;
use crate::contact::colouring::{permute, task_key};

/// The candidates that a search task finds.
#[derive(Debug)]
pub struct FoundContacts<R> {
    /// Points and faces.
    pub point_face: FoundPairs<R, 1, 3>,
    /// Edges and edges.
    pub edge_edge: FoundPairs<R, 2, 2>,
    /// Points and edges.
    pub point_edge: FoundPairs<R, 1, 2>,
    /// Points and points.
    pub point_point: FoundPairs<R, 1, 1>,
    /// The elements with new bounds of the group that is searched; and the same relative to the origin of another cloth.
    pub(super) new_elements: [NewElements; 2],
}

/// Pairs of elements of one kind.
#[derive(Debug)]
pub struct FoundPairs<R, const N: usize, const M: usize> {
    /// Those that can touch.
    pub(super) candidates: Vec<Candidate<R, N, M>>,
    /// Those whose boxes overlap, before the narrow phase.
    pub(super) overlapping: Vec<ElementPoints<N, M>>,
    runs: Vec<CandidateRun>,
    /// The order of the runs: whether a candidate is of a free point, the blocks of its task, and its index.
    order: Vec<((bool, [u32; 2]), u32)>,
}

/// Candidates of one contact task.
#[derive(Debug, Clone)]
pub struct CandidateRun {
    /// Whether they are of free points.
    pub of_free_points: bool,
    /// The blocks of the task.
    pub blocks: [u32; 2],
    /// Their places.
    pub candidates: Range<u32>,
}

impl<R, const N: usize, const M: usize> Default for FoundPairs<R, N, M> {
    fn default() -> Self {
        Self { candidates: Vec::new(), overlapping: Vec::new(), runs: Vec::new(), order: Vec::new() }
    }
}

impl<R> Default for FoundContacts<R> {
    fn default() -> Self {
        Self {
            point_face: FoundPairs::default(),
            edge_edge: FoundPairs::default(),
            point_edge: FoundPairs::default(),
            point_point: FoundPairs::default(),
            new_elements: Default::default(),
        }
    }
}

/// Pairs of one kind from which on the narrow phase is due, so that they stay in the cache of a core.
const MANY_OVERLAPS: usize = 512;

impl<R: Copy> FoundContacts<R> {
    /// Whether the narrow phase is due.
    pub(super) fn has_many_overlaps(&self) -> bool {
        let Self { point_face, edge_edge, point_edge, point_point, .. } = self;
        let of_faces = point_face.overlapping.len().max(edge_edge.overlapping.len());
        of_faces.max(point_edge.overlapping.len()).max(point_point.overlapping.len()) > MANY_OVERLAPS
    }

    /// Removes all, keeps the capacity.
    pub fn clear(&mut self) {
        self.point_face.candidates.clear();
        self.edge_edge.candidates.clear();
        self.point_edge.candidates.clear();
        self.point_point.candidates.clear();
    }

    /// Sorts the candidates by contact task, given the block of each point.
    pub fn sort_by_task(&mut self, block: &[u32]) {
        self.point_face.sort_by_task(block);
        self.edge_edge.sort_by_task(block);
        self.point_edge.sort_by_task(block);
        self.point_point.sort_by_task(block);
    }
}

impl<R, const N: usize, const M: usize> FoundPairs<R, N, M> {
    /// The candidates.
    pub fn candidates(&self) -> &[Candidate<R, N, M>] {
        &self.candidates
    }

    /// The runs of candidates, once they are sorted.
    pub fn runs(&self) -> &[CandidateRun] {
        &self.runs
    }
}

impl<R: Copy, const N: usize, const M: usize> FoundPairs<R, N, M> {
    fn sort_by_task(&mut self, block: &[u32]) {
        let Self { candidates, runs, order, .. } = self;
        let key = |Candidate { points: (ours, theirs), params, .. }: &Candidate<R, N, M>| {
            let mut blocks = [block[ours[0] as usize]; 4];
            let points = ours.iter().chain(theirs);
            blocks.iter_mut().zip(points).for_each(|(own, &point)| *own = block[point as usize]);
            (params.kind.is(ContactKind::HAS_FREE_POINT), task_key(blocks))
        };
        order.clear();
        order.extend(candidates.iter().map(key).zip(0..));
        // Most search tasks find candidates of one contact task alone.
        if !order.is_sorted_by_key(|place| place.0) {
            order.sort_unstable();
            permute(candidates, order);
        }
        runs.clear();
        for of_task in order.chunk_by(|a, b| a.0 == b.0) {
            let from = runs.last().map_or(0, |run: &CandidateRun| run.candidates.end);
            let ((of_free_points, blocks), _) = of_task[0];
            let candidates = from..from + of_task.len() as u32;
            runs.push(CandidateRun { of_free_points, blocks, candidates });
        }
    }
}
