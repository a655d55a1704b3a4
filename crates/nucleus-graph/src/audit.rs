//! A run under audit: whether anything passes through anything, found apart from the solver.

use std::cell::RefCell;
use std::ops::ControlFlow;

use nalgebra::Vector3;
use nucleus_audit::{AuditCounts, Auditor, Body, CollisionFilter, CollisionMesh, StateIndex};
use nucleus_core::{self as core, Stage, StateView, StepObserver};

use crate::compile::{Object, ObjectKind};

pub(crate) use ground::Grounds;

mod ground;

/// How closely a run is audited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Closeness {
    /// The state at the end of every frame.
    Frames,
    /// Every state that the solver shows: the straight way to it of every point, and the state at the end of the
    /// frame. Where the solver shows its substeps alone, a point that went round something within one is taken to have
    /// gone through.
    Steps,
}

/// Watches a run, and follows it with an [`Auditor`].
#[derive(Debug)]
pub struct Audit {
    auditor: Auditor,
    objects: Vec<ObjectKind>,
    closeness: Closeness,
    frame: i64,
    /// Whether the state has been looked at in the substep that is running.
    stepped: bool,
    positions: Vec<Vector3<f64>>,
    /// Where the ground plane of each nucleus was left.
    grounds: Grounds,
}

impl Audit {
    /// Begins with the state as it is. Nothing that is inside anything else there is held against the run.
    pub(crate) fn new(
        objects: &[Object],
        closeness: Closeness,
        state: &dyn StateView,
        rules: impl Fn(&CollisionMesh) -> CollisionFilter,
    ) -> Self {
        let body = |object: &Object| Body::mesh(object.name.clone(), object.points, object.faces.iter());
        let world = CollisionMesh::new(objects.iter().map(body).collect());
        let objects: Vec<ObjectKind> = objects.iter().map(|object| object.kind).collect();
        let mut positions = Vec::new();
        read(&objects, &world, (state, 1.0), &mut positions);
        let rules = rules(&world);
        let auditor = Auditor::new(world, rules, &positions);
        let grounds = Grounds::default();
        Self { auditor, objects, closeness, frame: 0, stepped: false, positions, grounds }
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self, frame: i64, rules: impl Fn(&CollisionMesh) -> CollisionFilter) {
        self.frame = frame;
        self.auditor.set_filter(rules(self.auditor.collision_mesh()));
    }

    /// Where the ground planes are, to be told of what the frame brings while it is solved.
    pub(crate) fn take_grounds(&mut self) -> Grounds {
        let mut grounds = std::mem::take(&mut self.grounds);
        grounds.begin_frame();
        grounds
    }

    /// Where the frame has left the ground planes.
    pub(crate) fn keep_grounds(&mut self, grounds: Grounds) {
        self.grounds = grounds;
    }

    /// What has been found so far.
    pub fn account(&self) -> AuditCounts {
        self.auditor.counts()
    }

    /// The first findings in words, in order of time.
    pub fn findings(&self) -> impl Iterator<Item = String> + '_ {
        self.auditor.findings().iter().map(|finding| self.auditor.describe(finding).to_string())
    }

    /// Takes up a state within a substep.
    fn step(&mut self, share: f64, substep: u32, state: &dyn StateView, grounds: &Grounds) {
        if self.closeness == Closeness::Steps {
            self.stepped = true;
            read(&self.objects, self.auditor.collision_mesh(), (state, share), &mut self.positions);
            let now = StateIndex { frame: self.frame, substep };
            self.see_grounds(now, share, grounds);
            self.auditor.check_motion(now, &self.positions);
        }
    }

    fn see_grounds(&mut self, now: StateIndex, share: f64, grounds: &Grounds) {
        for (body, object) in self.objects.iter().enumerate() {
            if let ObjectKind::Cloth(cloth) = *object {
                self.auditor.check_ground(now, body, grounds.of(cloth, share), &self.positions);
            }
        }
    }

    /// Takes up the end of a substep.
    fn substep(&mut self, moment: core::SubstepIndex, state: &dyn StateView, grounds: &Grounds) {
        let now = StateIndex { frame: self.frame, substep: moment.substep };
        let share = f64::from(moment.substep) / f64::from(moment.substeps);
        if !std::mem::take(&mut self.stepped) {
            self.step(share, moment.substep, state, grounds);
            self.stepped = false;
        }
        match self.closeness {
            _ if !moment.ends_frame() => {}
            Closeness::Steps => self.auditor.check_intersections(now),
            Closeness::Frames => {
                read(&self.objects, self.auditor.collision_mesh(), (state, share), &mut self.positions);
                self.see_grounds(now, share, grounds);
                self.auditor.check_state(now, &self.positions);
            }
        }
    }
}

/// Replaces `out` by the positions of all objects, in metres, in a state that a share of the frame has led to.
fn read(
    objects: &[ObjectKind],
    world: &CollisionMesh,
    (state, share): (&dyn StateView, f64),
    out: &mut Vec<Vector3<f64>>,
) {
    let mut points = Vec::new();
    out.clear();
    for (body, object) in objects.iter().enumerate() {
        match *object {
            ObjectKind::Cloth(cloth) => {
                out.extend((0..world.points_of(body).len()).map(|point| state.point(cloth, point)));
            }
            ObjectKind::Collider(collider) => {
                state.collider_points(collider, share, &mut points);
                out.extend_from_slice(&points);
            }
        }
    }
}

/// Shows each state to an audit first, then to another observer.
pub(crate) struct Audited<'a> {
    audit: &'a mut Audit,
    grounds: &'a RefCell<Grounds>,
    watch: &'a mut dyn StepObserver,
    /// The substep that is running.
    substep: u32,
}

impl<'a> Audited<'a> {
    pub(crate) fn new(
        audit: &'a mut Audit,
        grounds: &'a RefCell<Grounds>,
        watch: &'a mut dyn StepObserver,
    ) -> Self {
        Self { audit, grounds, watch, substep: 1 }
    }
}

impl StepObserver for Audited<'_> {
    fn substep(&mut self, moment: core::SubstepIndex, state: &dyn StateView) {
        self.audit.substep(moment, state, &self.grounds.borrow());
        self.watch.substep(moment, state);
        self.substep = moment.substep + 1;
    }

    fn step(&mut self, share: f64, state: &dyn StateView) {
        self.audit.step(share, self.substep, state, &self.grounds.borrow());
        self.watch.step(share, state);
    }

    fn should_continue(&self) -> ControlFlow<()> {
        self.watch.should_continue()
    }

    fn enter(&mut self, stage: Stage) {
        self.watch.enter(stage);
    }
}

#[cfg(test)]
mod tests;
