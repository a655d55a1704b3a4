//! The solver: the lists of a scene, its state, and the threads that work on them.

use nalgebra::Vector3;

use crate::bytes::RestoreError;
use crate::constraints::whole;
use crate::contact::cloth::Mutual;
use crate::contact::collider::ColliderState;
use crate::contact::foresee::Cover;
use crate::contact::ground::Ground;
use crate::contact::maps::Maps;
use crate::contact::pairs::PairList;
use crate::contact::terms::Terms;
use crate::input::frame::FrameInput;
use crate::input::validation::LastPositions;
use crate::input::{ClothId, ColliderId, PointId};
use crate::math::{Real, Row4};
use crate::model::builder::ModelBuilder;
use crate::model::{ClothModel, ColliderModel};
use crate::output::{ContactState, StateView, StepObserver};
use crate::output::{PassCost, StepReport};
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;
use crate::state::kinematics::update_anchors;

/// Everything needed to advance a scene by a frame; [`Solver::step`] does it.
pub struct Solver<R: Real = f32> {
    pub(crate) cloths: Vec<ClothModel<R>>,
    pub(crate) colliders: Vec<ColliderModel>,
    pub(crate) state: State<R>,
    pub(crate) collider_states: Vec<ColliderState>,
    /// Pairs that can touch, per cloth and collider.
    pub(crate) pairs: Vec<PairList<R>>,
    /// The span that the pairs of each cloth hold for, and the window that the active ones do, as shares of
    /// the frame.
    pub(crate) spans: Vec<[f64; 2]>,
    pub(crate) windows: Vec<[f64; 2]>,
    /// How far one goes in a frame to whom what is foreseen for each cloth is said, in metres.
    pub(crate) drifts: Vec<[R; 3]>,
    /// What is foreseen for each point in the window and in the span; empty where the scene has no collider.
    pub(crate) near: Vec<Cover<R>>,
    pub(crate) far: Vec<Cover<R>>,
    /// Points for which something new is foreseen, so that their pairs are to be found again.
    pub(crate) strayed: Vec<bool>,
    /// How each cloth meets each collider in this frame, by cloth and collider.
    pub(crate) terms: Vec<Option<Terms<R>>>,
    /// How each cloth meets the ground plane.
    pub(crate) ground_terms: Vec<Option<Terms<R>>>,
    /// What points bring into a contact beyond their cloth.
    pub(crate) maps: Maps<R>,
    /// ContactState among cloths; none where no two can ever meet.
    pub(crate) mutual: Option<Mutual<R>>,
    /// Whether anything touched anything in the last frame.
    pub(crate) touches: bool,
    /// The ground plane.
    pub(crate) ground: Ground<R>,
    pub(crate) pool: ThreadPool,
}

/// `f32` or `f64`: a scalar for which this crate compiles the whole solver (`compiled.rs`).
///
/// No other crate can implement it, because the traits it extends are private.
pub trait CompiledReal: Real {
    /// [`Solver::new`].
    fn build(builder: ModelBuilder, threads: usize) -> Solver<Self>;

    /// [`Solver::restored`].
    ///
    /// # Errors
    /// See there.
    fn restore(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Solver<Self>, RestoreError>;

    /// [`Solver::save`].
    fn save(solver: &Solver<Self>) -> Vec<u8>;

    /// [`Solver::step`].
    fn step(solver: &mut Solver<Self>, frame: &FrameInput, observer: &mut dyn StepObserver) -> StepReport;

    /// [`StateView::contacts`].
    fn contact_states(solver: &Solver<Self>, out: &mut Vec<Vec<ContactState>>);

    /// [`Solver::passes`].
    fn passes(solver: &Solver<Self>, frame: &FrameInput) -> Vec<PassCost>;

    /// [`Solver::elastic_energy`].
    fn elastic_energy(solver: &Solver<Self>, frame: &FrameInput) -> f64;
}

impl<R: CompiledReal> Solver<R> {
    /// Builds lists, bounding volumes and state. `threads` is the number of cores to use; the result has the same bits for any.
    pub fn new(builder: ModelBuilder, threads: usize) -> Self {
        R::build(builder, threads)
    }

    /// A solver that continues, with the same bits, from where one of the same model was saved. `threads` is the number of cores
    /// to use; it may differ from the saved one's.
    ///
    /// # Errors
    /// When the bytes are damaged, of another version, or of another model.
    pub fn restored(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Self, RestoreError> {
        R::restore(builder, threads, bytes)
    }

    /// The state that the next frame depends on, besides the model and the input of the frame, as bytes.
    pub fn save(&self) -> Vec<u8> {
        R::save(self)
    }

    /// Advances by one frame. A step cannot fail: the report counts what could not be satisfied, and every invalid value of the
    /// input.
    ///
    /// `frame` has one entry per cloth and per collider.
    pub fn step(&mut self, frame: &FrameInput, observer: &mut dyn StepObserver) -> StepReport {
        R::step(self, frame, observer)
    }

    /// The passes of a frame and their cost. A pass that the scene does not use is absent.
    pub fn passes(&self, frame: &FrameInput) -> Vec<PassCost> {
        R::passes(self, frame)
    }

    /// The elastic energy of stretch, shear and bending in joules, with the stiffness of `frame` and the current positions. Zero in
    /// Classic, where a resistance is no stiffness.
    pub fn elastic_energy(&self, frame: &FrameInput) -> f64 {
        R::elastic_energy(self, frame)
    }
}

impl<R: Real> Solver<R> {
    pub(crate) fn build(builder: ModelBuilder, threads: usize) -> Self {
        let ModelBuilder { cloths, colliders } = builder;
        let collides = !colliders.is_empty();
        let meets = cloths.len() > 1 || cloths.iter().any(|cloth| cloth.lists.self_collision);
        let mut models: Vec<ClothModel<R>> = Vec::with_capacity(cloths.len());
        for cloth in &cloths {
            let first = models.last().map_or(0, |last| last.points().start + last.blocks.columns());
            models.push(ClothModel::new(cloth, first, collides || meets));
        }
        let mut state = State::new(&cloths, &models);
        let pool = ThreadPool::new(threads);
        whole::prepare(&mut models, &mut state, &pool);
        // What goes on from a state may lie on something; whether it does is only known after a frame.
        let touches = cloths.iter().any(|cloth| !cloth.start.positions.is_empty());
        let maps = Maps::new(&cloths, &models, state.anchor.len());
        let mutual = meets.then(|| Mutual::new(&models, &state.anchor));
        drop(cloths);
        let colliders: Vec<ColliderModel> = colliders.into_iter().map(ColliderModel::new).collect();
        let covered = if collides { state.anchor.len() } else { 0 };
        let both = |cloth| (0..colliders.len()).map(move |collider| PairList::new(cloth, collider));
        let mut solver = Self {
            spans: vec![[0.0; 2]; models.len()],
            windows: vec![[0.0; 2]; models.len()],
            drifts: vec![[R::ZERO; 3]; models.len()],
            near: vec![[Row4::ZERO; 2]; covered],
            far: vec![[Row4::ZERO; 2]; covered],
            strayed: vec![true; covered],
            terms: Vec::new(),
            ground_terms: Vec::new(),
            pairs: (0..models.len()).flat_map(both).collect(),
            collider_states: colliders.iter().map(ColliderState::new).collect(),
            maps,
            mutual,
            touches,
            cloths: models,
            colliders,
            state,
            ground: Ground::default(),
            pool,
        };
        update_anchors(&mut solver.cloths, &solver.state.anchor, &solver.pool);
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

impl<R: Real> LastPositions for Solver<R> {
    fn collider(&self, collider: ColliderId) -> &[Vector3<f64>] {
        &self.collider_states[collider.index()].end
    }

    fn cloth_point(&self, cloth: ClothId, point: PointId) -> Vector3<f64> {
        self.state.position(self.cloths[cloth.index()].place(point.index())).into()
    }

    fn cloth_points(&self, cloth: ClothId) -> usize {
        self.cloths[cloth.index()].points().len()
    }
}

impl<R: CompiledReal> StateView for Solver<R> {
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
