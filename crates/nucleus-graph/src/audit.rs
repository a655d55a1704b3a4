//! Audit of a run: finds penetrations independently of the solver.

use std::cell::RefCell;
use std::ops::ControlFlow;

use nalgebra::Vector3;
use nucleus_audit::{AuditCounts, Auditor, Body, CollisionFilter, CollisionMesh, StateIndex};
use nucleus_core::{self as core, Stage, StateView, StepObserver};

use crate::compile::{Object, ObjectKind};

pub(crate) use scope::{AuditScope, GroundPlanes, collision_rules};

mod scope;

/// Which states of a run are audited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Closeness {
    /// The state at the end of every frame.
    Frames,
    /// Every state that the solver reports, the linear motion of each point to it, and the state at the end of the frame.
    /// If the solver reports substeps only, a point that moves around an obstacle within a substep counts as a
    /// penetration.
    Steps,
}

/// Passes the states of a run to an [`Auditor`].
#[derive(Debug)]
pub struct Audit {
    auditor: Auditor,
    objects: Vec<ObjectKind>,
    closeness: Closeness,
    frame: i64,
    /// Whether a state of the current substep has been audited.
    stepped: bool,
    positions: Vec<Vector3<f64>>,
    /// The ground planes at the end of the last frame.
    planes: GroundPlanes,
}

impl Audit {
    /// Begins with the current state. Objects that intersect in it are excluded.
    pub(crate) fn new(
        objects: &[Object],
        closeness: Closeness,
        state: &dyn StateView,
        rules: impl Fn(&CollisionMesh) -> CollisionFilter,
    ) -> Self {
        // Particles that are born and die have no rows of their own to follow.
        let points = |object: &Object| if object.varies { 0 } else { object.points };
        let body = |object: &Object| Body::mesh(object.name.clone(), points(object), object.faces.iter());
        let world = CollisionMesh::new(objects.iter().map(body).collect());
        let objects: Vec<ObjectKind> = objects.iter().map(|object| object.kind).collect();
        let mut positions = Vec::new();
        read(&objects, &world, (state, 1.0), &mut positions);
        let rules = rules(&world);
        let auditor = Auditor::new(world, rules, &positions);
        let planes = GroundPlanes::default();
        Self { auditor, objects, closeness, frame: 0, stepped: false, positions, planes }
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self, frame: i64, rules: impl Fn(&CollisionMesh) -> CollisionFilter) {
        self.frame = frame;
        self.auditor.set_filter(rules(self.auditor.collision_mesh()));
    }

    /// Takes the ground planes out, for the simulation to move while it solves the frame.
    pub(crate) fn take_planes(&mut self) -> GroundPlanes {
        let mut planes = std::mem::take(&mut self.planes);
        planes.begin_frame();
        planes
    }

    /// Puts the ground planes back at the end of the frame.
    pub(crate) fn keep_planes(&mut self, planes: GroundPlanes) {
        self.planes = planes;
    }

    /// The counts of penetrations found so far.
    pub fn account(&self) -> AuditCounts {
        self.auditor.counts()
    }

    /// Descriptions of the first findings, in order of time.
    pub fn findings(&self) -> impl Iterator<Item = String> + '_ {
        self.auditor.findings().iter().map(|finding| self.auditor.describe(finding).to_string())
    }

    /// Audits a state within a substep. `share` is the share of the frame that has passed.
    fn step(&mut self, share: f64, substep: u32, state: &dyn StateView, planes: &GroundPlanes) {
        if self.closeness == Closeness::Steps {
            self.stepped = true;
            read(&self.objects, self.auditor.collision_mesh(), (state, share), &mut self.positions);
            let now = StateIndex { frame: self.frame, substep };
            self.audit_ground(now, share, planes);
            self.auditor.check_motion(now, &self.positions);
        }
    }

    fn audit_ground(&mut self, now: StateIndex, share: f64, planes: &GroundPlanes) {
        for (body, object) in self.objects.iter().enumerate() {
            if let ObjectKind::Cloth(cloth) = *object {
                self.auditor.check_ground(now, body, planes.of(cloth, share), &self.positions);
            }
        }
    }

    /// Audits the end of a substep.
    fn substep(&mut self, moment: core::SubstepIndex, state: &dyn StateView, planes: &GroundPlanes) {
        let now = StateIndex { frame: self.frame, substep: moment.substep };
        let share = f64::from(moment.substep) / f64::from(moment.substeps);
        if !std::mem::take(&mut self.stepped) {
            self.step(share, moment.substep, state, planes);
            self.stepped = false;
        }
        match self.closeness {
            _ if !moment.ends_frame() => {}
            Closeness::Steps => self.auditor.check_intersections(now),
            Closeness::Frames => {
                read(&self.objects, self.auditor.collision_mesh(), (state, share), &mut self.positions);
                self.audit_ground(now, share, planes);
                self.auditor.check_state(now, &self.positions);
            }
        }
    }
}

/// Replaces `out` by the positions of all objects in metres. `share` is the share of the frame that has passed.
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

/// Passes each state to an audit, then to another observer.
pub(crate) struct Audited<'a> {
    audit: &'a mut Audit,
    planes: &'a RefCell<GroundPlanes>,
    watch: &'a mut dyn StepObserver,
    /// The current substep.
    substep: u32,
}

impl<'a> Audited<'a> {
    pub(crate) fn new(
        audit: &'a mut Audit,
        planes: &'a RefCell<GroundPlanes>,
        watch: &'a mut dyn StepObserver,
    ) -> Self {
        Self { audit, planes, watch, substep: 1 }
    }
}

impl StepObserver for Audited<'_> {
    fn substep(&mut self, moment: core::SubstepIndex, state: &dyn StateView) {
        self.audit.substep(moment, state, &self.planes.borrow());
        self.watch.substep(moment, state);
        self.substep = moment.substep + 1;
    }

    fn step(&mut self, share: f64, state: &dyn StateView) {
        self.audit.step(share, self.substep, state, &self.planes.borrow());
        self.watch.step(share, state);
    }

    fn observes_substeps(&self) -> bool {
        self.watch.observes_substeps()
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
