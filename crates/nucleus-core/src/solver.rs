//! The solver: its data in five groups (model, state, contact, links, threads), and its public methods.

use nalgebra::Vector3;

use crate::bytes::RestoreError;
use crate::constraints::link::lists::Links;
use crate::constraints::link::sizes::ModelSizes;
use crate::constraints::liquid::LiquidSolver;
use crate::constraints::tether::Tethers;
use crate::constraints::whole;
use crate::contact::placed_surface::ObjectSurfaces;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::ContactCounters;
use crate::input::frame::{ClothFrame, ColliderFrame, FrameInput, ResistanceModel};
use crate::input::links::Link;
use crate::input::validation::{InvalidInput, LastPositions, first_out_of_range, sanitize};
use crate::input::{ClothId, ColliderId, PointId};
use crate::math::Real;
use crate::model::builder::ModelBuilder;
use crate::model::cloth_lists::compile_cloth;
use crate::model::vertex_maps::VertexMaps;
use crate::model::{ClothModel, ColliderModel, Model};
use crate::output::{ContactState, Particle, ParticleLook, StateView, StepObserver};
use crate::output::{PassCost, StepReport};
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::looks::looks;
use crate::particles::population::Population;

use crate::schedule::{Schedule, StepInterval};
use crate::state::State;
use crate::state::kinematics::update_anchors;

/// Everything needed to advance a scene by a frame; [`Solver::step`] does it.
pub struct Solver<R: Real = f32> {
    /// Fixed once the scene is compiled, except for the anchors in the rows, and for how many rows of particles are in
    /// use.
    pub(crate) model: Model<R>,
    /// The columns that a frame changes.
    pub(crate) state: State<R>,
    /// Colliders in motion, contacts, and their candidates.
    pub(crate) contact: ContactSystem<R>,
    /// The links of dynamic constraints.
    pub(crate) links: Links<R>,
    /// By cloth: the state of its liquid within a frame.
    pub(crate) liquids: Vec<LiquidSolver>,
    /// By cloth: its tethers; empty where none has any.
    pub(crate) tethers: Vec<Tethers<R>>,
    /// Surfaces of objects that act on others at a distance.
    pub(crate) surfaces: ObjectSurfaces,
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

    /// [`Solver::memory`].
    fn memory(solver: &Solver<Self>) -> usize;

    /// [`Solver::elastic_energy`].
    fn elastic_energy(solver: &Solver<Self>, frame: &FrameInput) -> f64;
}

impl<R: CompiledReal> Solver<R> {
    /// Builds lists, bounding volumes and state. `threads` is the number of cores to use, 1024 at most; the result has the
    /// same bits for any.
    pub fn new(builder: ModelBuilder, threads: usize) -> Self {
        R::build(builder, threads)
    }

    /// A solver that continues, with the same bits, from where one of the same model was saved. `threads` is the number
    /// of cores to use; it may differ from the saved one's.
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

    /// Advances by one frame. A step cannot fail: the report counts what could not be satisfied, and every invalid
    /// value of the input, which is replaced. [`check_frame`](Self::check_frame) refuses such a frame beforehand.
    ///
    /// `frame` has one entry per cloth and per collider, as [`default_frame`](Self::default_frame) has.
    pub fn step(&mut self, frame: &FrameInput, observer: &mut dyn StepObserver) -> StepReport {
        R::step(self, frame, observer)
    }

    /// The passes of a frame and their cost. A pass that the scene does not use is absent. Invalid values of the input are
    /// replaced as in [`step`](Self::step).
    pub fn passes(&self, frame: &FrameInput) -> Vec<PassCost> {
        R::passes(self, frame)
    }

    /// The pairs of points that the whole welds of a constraint join, by the index of the constraint.
    pub fn welds(&self, constraint: usize) -> Vec<[(ClothId, PointId); 2]> {
        self.links.welds(constraint)
    }

    /// Bytes of the columns of points and the lists of rows, without those of contact.
    pub fn memory(&self) -> usize {
        R::memory(self)
    }

    /// The elastic energy of stretch, shear and bending in joules, with the stiffness of `frame` and the current
    /// positions. Zero in Classic, where a resistance is no stiffness.
    pub fn elastic_energy(&self, frame: &FrameInput) -> f64 {
        R::elastic_energy(self, frame)
    }
}

impl<R: Real> Solver<R> {
    pub(crate) fn build(builder: ModelBuilder, threads: usize) -> Self {
        let ModelBuilder { cloths, colliders, link_orders, collider_maps } = builder;
        let self_collides = cloths.len() > 1 || cloths.iter().any(|cloth| cloth.lists.self_collision);
        let mut models: Vec<ClothModel<R>> = Vec::with_capacity(cloths.len());
        for (cloth, order) in cloths.iter().zip(&link_orders) {
            let first = models.last().map_or(0, |last| last.blocks.end());
            models.push(compile_cloth(cloth, order, first, !colliders.is_empty() || self_collides));
        }
        let mut state = State::new(&cloths, &models);
        let pool = ThreadPool::new(threads);
        whole::prepare(&mut models, &mut state, &pool);
        let colliders = colliders.into_iter().zip(&collider_maps);
        let with_map =
            |(collider, maps): (_, &VertexMaps)| ColliderModel::new(collider, maps.field_magnitude.clone());
        let colliders: Vec<_> = colliders.map(with_map).collect();
        let contact =
            ContactSystem::new(&cloths, &models, (&colliders, &collider_maps), &state, self_collides);
        let tethers = match cloths.iter().any(|cloth| cloth.lists.tethers) {
            true => cloths.iter().zip(&models).map(|(cloth, model)| Tethers::new(cloth, model)).collect(),
            false => Vec::new(),
        };
        drop(cloths);
        let liquids = models.iter().map(|_| LiquidSolver::default()).collect();
        for population in &state.populations {
            models[population.cloth()].resize(population.len());
        }
        let model = Model { cloths: models, colliders };
        let links = Links::new(&model.cloths);
        let surfaces = ObjectSurfaces::default();
        let mut solver = Self { model, state, contact, links, liquids, tethers, surfaces, pool };
        update_anchors(&mut solver.model.cloths, &solver.state.anchor, &solver.pool);
        solver
    }

    /// Inputs and outputs of the contact passes of a time step.
    pub(crate) fn contact_pass<'a>(
        &'a mut self,
        frame: &'a FrameInput,
        schedule: &'a Schedule<R>,
        span: StepInterval,
        counters: &'a mut ContactCounters,
    ) -> ContactPass<'a, R> {
        let Self { model, state, contact, pool, .. } = self;
        ContactPass { model, frame, schedule, span, pool, state, contact, counters }
    }

    /// The input of a usual frame, to start from: 1/24 s of three substeps, gravity and air of the Earth, the
    /// resistances stiffnesses, and default attributes for each cloth and each collider. The thicknesses are zero.
    pub fn default_frame(&self) -> FrameInput {
        let [cloths, colliders] = self.objects();
        FrameInput {
            substeps: 3,
            resistance: ResistanceModel::Physical { evaluations: 96.0 },
            gravity: Vector3::new(0.0, -9.8, 0.0),
            air_density: 1.0,
            cloths: vec![ClothFrame::default(); cloths],
            colliders: vec![ColliderFrame::default(); colliders],
            ..FrameInput::default()
        }
    }

    /// Checks the input of a frame.
    ///
    /// # Errors
    /// The first number outside of the range that its documentation states, by object, field, value and range; the first value
    /// that [`step`](Self::step) would replace; or the first attribute that has no effect because the cloth was built without its
    /// list. It takes time for each number of the frame, and a step does not call it.
    pub fn check_frame(&self, frame: &FrameInput) -> Result<(), InvalidInput> {
        let without_list = || {
            let mut cloths = (0..).map(ClothId).zip(self.model.cloths.iter().zip(&frame.cloths));
            cloths.find_map(|(id, (model, cloth))| {
                let [attribute, list] = model.lists.missing_for(cloth)?;
                Some(InvalidInput::NoList { cloth: id, attribute, list })
            })
        };
        // A frame of another number of objects names others than the model has.
        let is_whole = [frame.cloths.len(), frame.colliders.len()] == self.objects();
        let named = is_whole.then(|| first_out_of_range(frame)).flatten();
        named.or_else(|| sanitize(frame, self).1.first).or_else(without_list).map_or(Ok(()), Err)
    }

    /// The mass of a point in kilograms, when it is not pinned.
    ///
    /// # Panics
    /// When there is no such cloth or point.
    pub fn mass(&self, cloth: ClothId, point: PointId) -> f64 {
        let row = self.model.cloths[cloth.index()].place(point.index());
        1.0 / self.state.inverse_mass[row as usize].to_f64()
    }

    /// A hash of all positions and velocities: equal bits give equal hashes.
    pub fn state_hash(&self) -> u64 {
        self.state.hash()
    }

    /// Replaces `out` by a column of a cloth, point by point in the mesh's order.
    fn column(&self, cloth: ClothId, out: &mut Vec<[f32; 3]>, value: impl Fn(u32) -> [f64; 3]) {
        let model = &self.model.cloths[cloth.index()];
        let first = model.points().start;
        out.clear();
        out.extend(model.places().iter().map(|&place| value(first + place).map(|x| x as f32)));
    }
}

impl<R: Real> LastPositions for Solver<R> {
    fn objects(&self) -> [usize; 2] {
        [self.model.cloths.len(), self.model.colliders.len()]
    }

    fn collider(&self, collider: ColliderId) -> &[Vector3<f64>] {
        &self.contact.collider_states[collider.index()].end
    }

    fn cloth_point(&self, cloth: ClothId, point: PointId) -> Vector3<f64> {
        self.state.position(self.model.cloths[cloth.index()].place(point.index())).into()
    }

    fn cloth_points(&self, cloth: ClothId) -> usize {
        self.model.cloths[cloth.index()].points().len()
    }

    fn capacity(&self, cloth: ClothId) -> usize {
        let living = self.model.cloths[cloth.index()].points().len();
        self.state.population_of(cloth.index()).map_or(living, Population::capacity)
    }

    fn particles(&self, cloth: ClothId) -> Option<usize> {
        self.state.population_of(cloth.index()).map(Population::len)
    }

    fn has_link(&self, link: &Link) -> bool {
        let Model { cloths, colliders } = &self.model;
        let sizes = ModelSizes {
            cloths: &|cloth| cloths.get(cloth).map(|cloth| cloth.points().len()),
            colliders: &|collider| colliders.get(collider).map(|collider| collider.positions.len()),
        };
        sizes.has(link)
    }
}

impl<R: CompiledReal> StateView for Solver<R> {
    fn object_counts(&self) -> Option<[usize; 2]> {
        Some(self.objects())
    }

    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.column(cloth, out, |row| self.state.position(row).map(|x| x * units_per_metre));
    }

    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        self.column(cloth, out, |row| self.state.seen_velocity(row).map(|x| x * units_per_metre));
    }

    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        R::contact_states(self, out);
    }

    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        out.clear();
        out.extend(self.state.population_of(cloth.index()).into_iter().flat_map(Population::particles));
    }

    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        out.clear();
        let population = self.state.population_of(cloth.index());
        if let Some(population) = population.filter(|population| population.has_looks()) {
            let first = self.model.cloths[cloth.index()].blocks.rows().start as usize;
            out.extend(looks(population, &self.state, first));
        }
    }

    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        out.clear();
        out.extend(self.state.population_of(cloth.index()).into_iter().flat_map(Population::orientations));
    }

    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>) {
        let state = &self.contact.collider_states[collider.index()];
        out.clear();
        let scaled =
            (0..state.start.len() as u32).map(|point| state.point(point, state.now) * units_per_metre);
        out.extend(scaled.map(|p| [p.x as f32, p.y as f32, p.z as f32]));
    }

    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        let state = &self.contact.collider_states[collider.index()];
        out.clear();
        out.extend((0..state.start.len() as u32).map(|point| state.point(point, share)));
    }

    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.contact.collider_states[collider.index()].moves
    }

    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        self.state.position(self.model.cloths[cloth.index()].place(point)).into()
    }
}
