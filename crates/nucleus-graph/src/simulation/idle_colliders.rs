//! Colliders of a nucleus that is not solved: they follow the animation, as the transform of a mesh does in Maya.
//!
//! Only what observers see of them as recorded positions changes. The solver goes on from its own state, and an audit
//! compares that state, [`StateView::collider_points`].

use nalgebra::Vector3;
use nucleus_core::{ClothId, ColliderId, ContactState, Particle, ParticleLook, StateView};

use crate::compile::Program;

/// The colliders of a nucleus in the evaluations of a frame that are not solved.
#[derive(Debug, Default)]
pub(super) struct IdleColliders {
    /// Positions in metres, by collider, if the last evaluation was not solved; `None` where a collider never moves.
    placed: Option<Vec<Option<Vec<Vector3<f64>>>>>,
    /// Whether each moved in this frame while the nucleus was not solved.
    moved: Vec<bool>,
}

impl IdleColliders {
    /// Colliders of nucleus number `index` that wait at a scene frame.
    pub(super) fn waiting(program: &Program, index: usize, frame: f64) -> Self {
        Self { placed: Some(program.collider_places(index, frame)), moved: Vec::new() }
    }

    /// Begins a frame.
    pub(super) fn begin_frame(&mut self) {
        self.moved.clear();
    }

    /// An evaluation interval that is not solved: the colliders go where the animation has them at its end.
    pub(super) fn follow(&mut self, program: &Program, index: usize, [from, to]: [f64; 2]) {
        let before = self.placed.take().unwrap_or_else(|| program.collider_places(index, from));
        let now = program.collider_places(index, to);
        self.moved.resize(now.len(), false);
        for ((moved, before), now) in self.moved.iter_mut().zip(&before).zip(&now) {
            *moved |= before != now;
        }
        self.placed = Some(now);
    }

    /// An evaluation interval that is solved.
    pub(super) fn resume(&mut self) {
        self.placed = None;
    }

    /// Whether none was moved in this frame.
    pub(super) fn is_empty(&self) -> bool {
        self.placed.is_none() && self.moved.is_empty()
    }
}

/// No collider is idle.
pub(super) static NONE_IDLE: IdleColliders = IdleColliders { placed: None, moved: Vec::new() };

/// The state of a nucleus with its idle colliders in place. Its solver knows all the rest.
#[derive(Clone, Copy)]
pub(super) struct WithIdle<'a> {
    pub(super) state: &'a dyn StateView,
    pub(super) idle: &'a IdleColliders,
    /// Whether it is the end of the frame: before it, colliders that the frame also solves are where the solver has them.
    pub(super) ends_frame: bool,
}

impl StateView for WithIdle<'_> {
    fn object_counts(&self) -> Option<[usize; 2]> {
        self.state.object_counts()
    }

    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.state.positions(cloth, units_per_metre, out);
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.state.velocities(cloth, units_per_metre, out);
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        self.state.contacts(out);
    }

    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        self.state.looks(cloth, out);
    }

    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        self.state.orientations(cloth, out);
    }

    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        self.state.particles(cloth, out);
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let placed = self.idle.placed.as_ref().filter(|_| self.ends_frame);
        match placed.and_then(|placed| placed.get(collider.index())?.as_ref()) {
            Some(points) => {
                out.clear();
                let scaled = points.iter().map(|point| point * units_per_metre);
                out.extend(scaled.map(|p| [p.x as f32, p.y as f32, p.z as f32]));
            }
            None => self.state.collider_positions(collider, units_per_metre, out),
        }
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.idle.moved.get(collider.index()).is_some_and(|moved| *moved)
            || self.state.collider_moved(collider)
    }

    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        self.state.collider_points(collider, share, out);
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        self.state.point(cloth, point)
    }
}
