//! The solver: the lists of a scene, its state, and the threads that work on them.

use nalgebra::Vector3;

use crate::contact::cloth::ClothContacts;
use crate::contact::collider::ColliderState;
use crate::contact::collider::broad_phase::MotionBox;
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::ground::Ground;
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::input::ids::{ClothId, ColliderId, PointId};
use crate::math::{Real, Row4};
use crate::model::builder::ModelBuilder;
use crate::model::{ClothModel, ColliderModel};
use crate::output::observer::{ContactState, StateView};
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Everything needed to advance a scene by a frame; [`Solver::step`] does it.
pub struct Solver<R: Real = f32> {
    pub(crate) cloths: Vec<ClothModel<R>>,
    pub(crate) colliders: Vec<ColliderModel>,
    pub(crate) state: State<R>,
    pub(crate) collider_states: Vec<ColliderState>,
    /// Pairs that can touch, per cloth and collider.
    pub(crate) collider_contacts: Vec<ColliderContacts<R>>,
    /// The span that the pairs of each cloth hold for, and the window that the active ones do, as shares of
    /// the frame.
    pub(crate) candidate_intervals: Vec<[f64; 2]>,
    pub(crate) active_windows: Vec<[f64; 2]>,
    /// How far one goes in a frame to whom what is foreseen for each cloth is said, in metres.
    pub(crate) frame_travel: Vec<[R; 3]>,
    /// What is foreseen for each point in the window and in the span; empty where the scene has no collider.
    pub(crate) window_bounds: Vec<MotionBox<R>>,
    pub(crate) interval_bounds: Vec<MotionBox<R>>,
    /// Points for which something new is foreseen, so that their pairs are to be found again.
    pub(crate) bounds_violated: Vec<bool>,
    /// How each cloth meets each collider in this frame, by cloth and collider.
    pub(crate) collider_materials: Vec<Option<ContactMaterial<R>>>,
    /// How each cloth meets the ground plane.
    pub(crate) ground_materials: Vec<Option<ContactMaterial<R>>>,
    /// What points bring into a contact beyond their cloth.
    pub(crate) material_maps: MaterialMaps<R>,
    /// ContactState among cloths; none where no two can ever meet.
    pub(crate) cloth_contacts: Option<ClothContacts<R>>,
    /// Whether anything touched anything in the last frame.
    pub(crate) touches: bool,
    /// The ground plane.
    pub(crate) ground: Ground<R>,
    pub(crate) pool: ThreadPool,
}

impl<R: Real> Solver<R> {
    /// Builds lists, trees and state. `threads` is the number of cores to use; it never changes a bit of
    /// the result.
    pub fn new(builder: ModelBuilder, threads: usize) -> Self {
        R::build(builder, threads)
    }

    pub(crate) fn build(builder: ModelBuilder, threads: usize) -> Self {
        let ModelBuilder { cloths, colliders } = builder;
        let collides = !colliders.is_empty();
        let meets = cloths.len() > 1 || cloths.iter().any(|cloth| cloth.lists.self_collision);
        let mut models: Vec<ClothModel<R>> = Vec::with_capacity(cloths.len());
        for cloth in &cloths {
            let first = models.last().map_or(0, |last| last.points().start + last.blocks.columns());
            models.push(ClothModel::new(cloth, first, collides || meets));
        }
        let state = State::new(&cloths, &models);
        // What goes on from a state may lie on something; whether it does is only known after a frame.
        let touches = cloths.iter().any(|cloth| !cloth.start.positions.is_empty());
        let material_maps = MaterialMaps::new(&cloths, &models, state.anchor.len());
        let cloth_contacts = meets.then(|| ClothContacts::new(&models, &state.anchor));
        drop(cloths);
        let colliders: Vec<ColliderModel> = colliders.into_iter().map(ColliderModel::new).collect();
        let covered = if collides { state.anchor.len() } else { 0 };
        let both = |cloth| (0..colliders.len()).map(move |collider| ColliderContacts::new(cloth, collider));
        let mut solver = Self {
            candidate_intervals: vec![[0.0; 2]; models.len()],
            active_windows: vec![[0.0; 2]; models.len()],
            frame_travel: vec![[R::ZERO; 3]; models.len()],
            window_bounds: vec![[Row4::ZERO; 2]; covered],
            interval_bounds: vec![[Row4::ZERO; 2]; covered],
            bounds_violated: vec![true; covered],
            collider_materials: Vec::new(),
            ground_materials: Vec::new(),
            collider_contacts: (0..models.len()).flat_map(both).collect(),
            collider_states: colliders.iter().map(ColliderState::new).collect(),
            material_maps,
            cloth_contacts,
            touches,
            cloths: models,
            colliders,
            state,
            ground: Ground::default(),
            pool: ThreadPool::new(threads),
        };
        solver.anchor_rows();
        solver
    }

    /// How far into the frame the solver has come, as a share of it.
    pub(crate) fn set_time(&mut self, now: f64) {
        self.collider_states.iter_mut().for_each(|collider| collider.now = now);
    }

    /// The mass of a point in kilograms, as it is when nothing holds it.
    pub fn mass(&self, cloth: ClothId, point: PointId) -> f64 {
        let row = self.cloths[cloth.index()].place(point.index());
        1.0 / self.state.inverse_mass[row as usize].to_f64()
    }

    /// A fingerprint of all positions and velocities: equal bits, equal hash.
    pub fn state_hash(&self) -> u64 {
        self.state.hash()
    }

    /// Replaces `out` by a column of a cloth, point by point in the user's order.
    fn column(&self, cloth: ClothId, out: &mut Vec<[f32; 3]>, value: impl Fn(u32) -> [f64; 3]) {
        let model = &self.cloths[cloth.index()];
        let first = model.points().start;
        out.clear();
        out.extend(model.order.places().iter().map(|&place| value(first + place).map(|x| x as f32)));
    }
}

impl<R: Real> StateView for Solver<R> {
    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.column(cloth, out, |row| self.state.position(row).map(|x| x * units_per_metre));
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.column(cloth, out, |row| self.state.seen_velocity(row).map(|x| x * units_per_metre));
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        R::contact_states(self, out);
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let state = &self.collider_states[collider.index()];
        out.clear();
        let scaled =
            (0..state.start.len() as u32).map(|point| state.point(point, state.now) * units_per_metre);
        out.extend(scaled.map(|p| [p.x as f32, p.y as f32, p.z as f32]));
    }

    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        let state = &self.collider_states[collider.index()];
        out.clear();
        out.extend((0..state.start.len() as u32).map(|point| state.point(point, share)));
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.collider_states[collider.index()].moves
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        self.state.position(self.cloths[cloth.index()].place(point)).into()
    }
}
