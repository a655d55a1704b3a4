//! Audits a run state by state.

use std::collections::HashSet;
use std::fmt;

use nalgebra::Vector3;

use crate::candidate_interval::CandidateIntervals;
use crate::collision_filter::CollisionFilter;
use crate::collision_mesh::{CollisionMesh, EdgeId, FaceId};
use crate::finding::{Described, Finding, FindingKind, StateIndex};
use crate::ground::{Ground, Plane};
use crate::initial_intersections::InitialIntersections;
use crate::intersections::{Intersection, IntersectionKind, intersections};
use crate::motion::Motion;
use crate::pair::{CcdResult, Collision};

/// Findings that are kept in full; all are counted.
const KEPT: usize = 100;

/// Counts of an audit so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct AuditCounts {
    /// Checked motions.
    pub motions: u64,
    /// Pairs that passed through each other.
    pub crossings: u64,
    /// Pairs that touched without passing through each other.
    pub touches: u64,
    /// Degenerate pairs, and pairs with a coordinate that is not finite.
    pub undecided: u64,
    /// Edge-face intersections in a state, without a collision that led to them.
    pub intersections: u64,
    /// Vertices that went from above the ground plane to below it.
    pub below_ground: u64,
    /// Edge-face pairs that intersected in the start state.
    pub initial_intersections: u64,
    /// Initial intersections, and those they propagated to, that remained in the last checked state.
    pub remaining_initial_intersections: u64,
    /// Collisions attributed to initial intersections; no other counter includes them.
    pub excluded_collisions: u64,
    /// Edge-face pairs that intersected in the last checked state.
    pub current_intersections: u64,
}

impl AuditCounts {
    /// Sum of all findings.
    pub fn found(&self) -> u64 {
        self.crossings + self.touches + self.undecided + self.intersections + self.below_ground
    }

    /// Whether there is no finding.
    pub fn is_clean(&self) -> bool {
        self.found() == 0
    }
}

/// Continuous collision audit of a run: takes one state after the other from the start state on, and lists every pair
/// that passes through each other between them.
#[derive(Debug)]
pub struct Auditor {
    mesh: CollisionMesh,
    filter: CollisionFilter,
    state: Vec<Vector3<f64>>,
    /// Certificates for the motions to come.
    intervals: CandidateIntervals,
    initial: InitialIntersections,
    ground: Ground,
    /// Reported intersections that have not separated yet.
    reported: HashSet<(EdgeId, FaceId)>,
    counts: AuditCounts,
    findings: Vec<Finding>,
}

impl Auditor {
    /// Begins at a start state: the positions of all bodies, one body after the other. An intersection in it is no
    /// finding until it has separated.
    ///
    /// # Panics
    /// When the number of positions differs from the number of points.
    pub fn new(mesh: CollisionMesh, filter: CollisionFilter, start: &[Vector3<f64>]) -> Self {
        let inside = intersections(&mesh, &filter, start);
        let count = inside.len() as u64;
        let counts = AuditCounts {
            initial_intersections: count,
            remaining_initial_intersections: count,
            current_intersections: count,
            ..AuditCounts::default()
        };
        let (initial, state) = (InitialIntersections::new(&inside), start.to_vec());
        Self {
            mesh,
            filter,
            state,
            intervals: CandidateIntervals::default(),
            initial,
            ground: Ground::default(),
            reported: HashSet::new(),
            counts,
            findings: Vec::new(),
        }
    }

    /// Replaces the collision filter from the next motion on. Intersections that only the new filter includes count as
    /// initial intersections.
    pub fn set_filter(&mut self, filter: CollisionFilter) {
        if filter == self.filter {
            return;
        }
        self.filter = filter;
        self.intervals.reset();
        let inside = intersections(&self.mesh, &self.filter, &self.state);
        let new: Vec<Intersection> = inside
            .iter()
            .filter(|found| !self.initial.has(found) && !self.reported.contains(&(found.edge, found.face)))
            .copied()
            .collect();
        self.counts.initial_intersections += new.len() as u64;
        self.initial.add(&new);
        self.count_state(&inside);
    }

    /// Checks the ground plane in a motion: which vertices of a body were above it before and are below it after?
    /// `planes` are those at the start and at the end of the motion; `None` where the body has no ground plane. Below
    /// means by more than 1e-6 of the largest coordinate of the body and of the plane's origin, in metres. Call it
    /// before [`check_motion`](Self::check_motion) or [`check_state`](Self::check_state) for the same state.
    ///
    /// # Panics
    /// When the number of positions differs from the number of points.
    pub fn check_ground(
        &mut self,
        index: StateIndex,
        body: usize,
        planes: Option<[Plane; 2]>,
        positions: &[Vector3<f64>],
    ) {
        let states = [self.state.as_slice(), positions];
        let passed = self.ground.passed((&self.mesh, &self.filter), body, planes, states);
        self.counts.below_ground += passed.len() as u64;
        passed
            .into_iter()
            .for_each(|point| self.record(Finding { state: index, kind: FindingKind::Ground(point) }));
    }

    /// Checks the linear motion to the next state, and takes that state up.
    ///
    /// # Panics
    /// When the number of positions differs from the number of points.
    pub fn check_motion(&mut self, index: StateIndex, positions: &[Vector3<f64>]) {
        self.counts.motions += 1;
        let collisions = self.move_to(positions, true);
        for collision in collisions {
            self.count_result(collision.result);
            self.record(Finding { state: index, kind: FindingKind::Collision(collision) });
        }
    }

    /// Takes up the next state without checking the motion to it, and checks the state for new intersections.
    ///
    /// # Panics
    /// When the number of positions differs from the number of points.
    pub fn check_state(&mut self, index: StateIndex, positions: &[Vector3<f64>]) {
        // Initial intersections are propagated along the linear motion, the best available guess.
        if self.initial.is_empty() {
            self.state.copy_from_slice(positions);
            self.intervals.reset();
        } else {
            self.move_to(positions, false);
        }
        self.check_intersections(index);
    }

    /// Takes up a state and returns the collisions that are not attributed to initial intersections. With `is_checked`, the
    /// intersections they lead to count as reported.
    fn move_to(&mut self, positions: &[Vector3<f64>], is_checked: bool) -> Vec<Collision> {
        let motion = Motion::new(&self.mesh, &self.filter, [&self.state, positions]);
        let mut collisions = self.intervals.collisions(&motion);
        self.state.copy_from_slice(positions);
        if collisions.is_empty() && self.initial.is_empty() {
            return collisions;
        }
        let propagation = self.initial.exclude(&self.mesh, &mut collisions);
        self.counts.excluded_collisions += propagation.excluded;
        let inside = intersections(&self.mesh, &self.filter, &self.state);
        self.initial.update(&propagation, &inside);
        if is_checked {
            let new = inside.iter().filter(|found| !self.initial.has(found));
            self.reported = new.map(|found| (found.edge, found.face)).collect();
        }
        self.count_state(&inside);
        collisions
    }

    /// Checks the current state for intersections without a collision that led to them.
    pub fn check_intersections(&mut self, index: StateIndex) {
        let inside = intersections(&self.mesh, &self.filter, &self.state);
        let is_inside: HashSet<_> = inside.iter().map(|found| (found.edge, found.face)).collect();
        self.reported.retain(|pair| is_inside.contains(pair));
        for &found in &inside {
            let pair = (found.edge, found.face);
            if self.initial.has(&found) || !self.reported.insert(pair) {
                continue;
            }
            match found.kind {
                IntersectionKind::Undecided => self.counts.undecided += 1,
                _ => self.counts.intersections += 1,
            }
            self.record(Finding { state: index, kind: FindingKind::Intersection(found) });
        }
        self.count_state(&inside);
    }

    fn count_state(&mut self, inside: &[Intersection]) {
        self.counts.current_intersections = inside.len() as u64;
        self.counts.remaining_initial_intersections = self.initial.len() as u64;
    }

    fn count_result(&mut self, result: CcdResult) {
        let counter = match result {
            CcdResult::Separated => return,
            CcdResult::Crossing { .. } => &mut self.counts.crossings,
            CcdResult::Touching { .. } => &mut self.counts.touches,
            CcdResult::Undecided => &mut self.counts.undecided,
        };
        *counter += 1;
    }

    fn record(&mut self, finding: Finding) {
        if self.findings.len() < KEPT {
            self.findings.push(finding);
        }
    }

    /// The counts so far.
    pub fn counts(&self) -> AuditCounts {
        self.counts
    }

    /// The first findings, in order of time.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The audited bodies.
    pub fn collision_mesh(&self) -> &CollisionMesh {
        &self.mesh
    }

    /// A finding as text: `frame 14, substep 2: point sheet.vtx[12] went through face ball.vtx[3,4,5]`.
    pub fn describe<'a>(&'a self, finding: &'a Finding) -> impl fmt::Display + 'a {
        Described { mesh: &self.mesh, finding }
    }
}
