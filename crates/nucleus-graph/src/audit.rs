//! A run under audit: whether anything passes through anything, found apart from the solver.

use nalgebra::Vector3;
use nucleus_audit::{Account, Auditor, Body, Moment, Rules, World};
use nucleus_core::{self as core, Stage, StateView, StepObserver};

use crate::compile::{Object, ObjectKind};

/// How closely a run is audited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Closeness {
    /// The state at the end of every frame.
    Frames,
    /// Every substep: the straight way there of every point, and the state at the end of the frame.
    Substeps,
}

/// Watches a run, and follows it with an [`Auditor`].
#[derive(Debug)]
pub struct Audit {
    auditor: Auditor,
    objects: Vec<ObjectKind>,
    closeness: Closeness,
    frame: i64,
    positions: Vec<Vector3<f64>>,
}

impl Audit {
    /// Begins with the state as it is. Nothing that is inside anything else there is held against the run.
    pub(crate) fn new(
        objects: &[Object],
        closeness: Closeness,
        state: &dyn StateView,
        rules: impl Fn(&World) -> Rules,
    ) -> Self {
        let body = |object: &Object| Body::mesh(object.name.clone(), object.points, object.faces.iter());
        let world = World::new(objects.iter().map(body).collect());
        let objects: Vec<ObjectKind> = objects.iter().map(|object| object.kind).collect();
        let mut positions = Vec::new();
        read(&objects, &world, state, &mut positions);
        let rules = rules(&world);
        let auditor = Auditor::new(world, rules, &positions);
        Self { auditor, objects, closeness, frame: 0, positions }
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self, frame: i64, rules: impl Fn(&World) -> Rules) {
        self.frame = frame;
        self.auditor.set_rules(rules(self.auditor.world()));
    }

    /// What has been found so far.
    pub fn account(&self) -> Account {
        self.auditor.account()
    }

    /// The first findings in words, in order of time.
    pub fn findings(&self) -> impl Iterator<Item = String> + '_ {
        self.auditor.findings().iter().map(|finding| self.auditor.describe(finding).to_string())
    }

    fn see(&mut self, moment: core::Moment, state: &dyn StateView) {
        let now = Moment { frame: self.frame, substep: moment.substep };
        if self.closeness == Closeness::Frames && !moment.ends_frame() {
            return;
        }
        read(&self.objects, self.auditor.world(), state, &mut self.positions);
        match self.closeness {
            Closeness::Frames => self.auditor.follow(now, &self.positions),
            Closeness::Substeps => self.auditor.see(now, &self.positions),
        }
        if self.closeness == Closeness::Substeps && moment.ends_frame() {
            self.auditor.look(now);
        }
    }
}

/// Replaces `out` by the positions of all objects, in metres.
fn read(objects: &[ObjectKind], world: &World, state: &dyn StateView, out: &mut Vec<Vector3<f64>>) {
    let mut points = Vec::new();
    out.clear();
    for (body, object) in objects.iter().enumerate() {
        match *object {
            ObjectKind::Cloth(cloth) => {
                out.extend((0..world.points_of(body).len()).map(|point| state.point(cloth, point)));
            }
            ObjectKind::Collider(collider) => {
                state.collider_points(collider, &mut points);
                out.extend_from_slice(&points);
            }
        }
    }
}

/// Shows each state to an audit first, then to another observer.
pub(crate) struct Audited<'a> {
    pub(crate) audit: &'a mut Audit,
    pub(crate) watch: &'a mut dyn StepObserver,
}

impl StepObserver for Audited<'_> {
    fn substep(&mut self, moment: core::Moment, state: &dyn StateView) {
        self.audit.see(moment, state);
        self.watch.substep(moment, state);
    }

    fn enter(&mut self, stage: Stage) {
        self.watch.enter(stage);
    }
}

#[cfg(test)]
mod tests;
