//! The state of contact, and the inputs and outputs of its passes.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use crate::contact::cloth::cache::ContactCache;
use crate::contact::cloth::contact::ClothStep;
use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::collider::ColliderState;
use crate::contact::collider::affine_motion::AffineMotion;
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::motion_bounds::MotionBox;
use crate::contact::collider::near_points::NearPoints;
use crate::contact::depenetration::Obstacle;
use crate::contact::ground::Ground;
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::contact::pair_filter::PairFilter;
use crate::contact::pair_table::{ContactMaterials, PairTable};
use crate::contact::response::TouchingPoint;
use crate::contact::time_step::ContactCounters;
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4};
use crate::model::objects::Cloth;
use crate::model::vertex_maps::VertexMaps;
use crate::model::{ClothModel, ColliderModel, Model};
use crate::output::ContactState;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::{Schedule, StepInterval, TimeInterval};
use crate::state::State;

/// The state of contact that lasts from time step to time step.
pub struct ContactSystem<R: Real> {
    /// By collider.
    pub collider_states: Vec<ColliderState>,
    /// Candidate pairs, per cloth and collider.
    pub collider_contacts: Vec<ColliderContacts<R>>,
    /// By cloth: the candidate interval of its pairs, and that of its active pairs, as shares of the frame.
    pub candidate_intervals: Vec<TimeInterval>,
    pub active_windows: Vec<TimeInterval>,
    /// By cloth: displacement per frame of the moving frame of its motion bounds, in metres.
    pub frame_travel: Vec<[R; 3]>,
    /// Motion bounds of each point in the interval of active pairs, and in the candidate interval; empty where the
    /// scene has no collider, or nothing but free points.
    pub window_bounds: Vec<MotionBox<R>>,
    pub interval_bounds: Vec<MotionBox<R>>,
    /// How far the window bounds of each point have grown in this frame, in metres.
    pub bound_growth: Vec<R>,
    /// Points with new motion bounds, whose pairs are to be found again.
    pub bounds_violated: Vec<bool>,
    /// Contact material of each cloth with each collider in this frame, by cloth and collider.
    pub collider_materials: ContactMaterials<R>,
    /// Contact material of each cloth with the ground plane.
    pub ground_materials: Vec<Option<ContactMaterial<R>>>,
    /// Vertex maps of contact.
    pub material_maps: MaterialMaps<R>,
    /// Contact of cloth with itself and with other cloth; none where no two elements can ever touch.
    pub cloth_contacts: Option<ClothContacts<R>>,
    /// The cloths whose contacts a pass resolves; all where it is empty.
    pub contact_mask: Vec<bool>,
    /// By cloth: the mean motion of its island in a time step in which motion is truncated, in metres, if nothing else may touch
    /// it; empty before.
    pub drift: Vec<Option<[R; 3]>>,
    /// Whether each cloth has a contact without certificate: among cloths, and with colliders.
    pub has_unproven: [Vec<AtomicBool>; 2],
    /// Elements that do not collide with each other.
    pub pair_filter: PairFilter,
    /// What touches at the end of a time step where it bounces: a buffer.
    pub bouncing: Vec<TouchingPoint<R>>,
    /// Whether each cloth had a contact in the last frame.
    pub touches: Vec<bool>,
    /// Whether each cloth has had a contact in this frame.
    pub has_touched: Vec<AtomicBool>,
    /// The motions of the colliders in a time step in which the safeguard freezes points; `None` for one that deforms.
    pub carriers: Vec<Option<AffineMotion>>,
    /// What is in the way of the points of a cloth that leave a collider.
    pub obstacles: Vec<Obstacle>,
    /// The ground plane.
    pub ground: Ground<R>,
    /// Whether each cloth is an object of free points in this frame, without lists of contacts.
    pub is_free: Vec<bool>,
    /// The smallest gap of a free point to a collider at the end of the frame, over its thickness.
    pub free_gap: f64,
    /// The results of tasks over free points.
    pub free_tasks: Vec<Mutex<NearPoints<R>>>,
    /// The contact state of each row, where particles have collision events.
    pub row_states: Vec<ContactState>,
    /// The contact state of each row as a checkpoint holds it, until the next frame; `None` in a solver that was not restored.
    pub restored_states: Option<Vec<ContactState>>,
}

impl<R: Real> ContactSystem<R> {
    /// Without contacts yet; all bounds are invalid. `self_collides` says whether two elements of cloth can ever touch.
    pub fn new(
        cloths: &[Cloth],
        models: &[ClothModel<R>],
        colliders: (&[ColliderModel], &[VertexMaps]),
        state: &State<R>,
        self_collides: bool,
    ) -> Self {
        let (colliders, collider_maps) = colliders;
        let with_each =
            |cloth| (0..colliders.len()).map(move |collider| ColliderContacts::new(cloth, collider));
        Self {
            collider_states: colliders.iter().map(ColliderState::new).collect(),
            collider_contacts: (0..models.len()).flat_map(with_each).collect(),
            candidate_intervals: vec![TimeInterval::EXPIRED; models.len()],
            active_windows: vec![TimeInterval::EXPIRED; models.len()],
            frame_travel: vec![[R::ZERO; 3]; models.len()],
            window_bounds: Vec::new(),
            interval_bounds: Vec::new(),
            bound_growth: Vec::new(),
            bounds_violated: Vec::new(),
            collider_materials: PairTable::EMPTY,
            ground_materials: Vec::new(),
            material_maps: MaterialMaps::new(cloths, models, state.anchor.len(), collider_maps),
            cloth_contacts: self_collides.then(|| ClothContacts::new(models, &state.anchor)),
            contact_mask: Vec::with_capacity(models.len()),
            drift: Vec::new(),
            has_unproven: [(); 2].map(|()| models.iter().map(|_| AtomicBool::new(false)).collect()),
            pair_filter: PairFilter::default(),
            bouncing: Vec::new(),
            // Cloth that starts from a saved state may be in contact; the first frame finds out.
            touches: cloths.iter().map(|cloth| !cloth.start.positions.is_empty()).collect(),
            has_touched: models.iter().map(|_| AtomicBool::new(false)).collect(),
            carriers: Vec::new(),
            obstacles: Vec::new(),
            ground: Ground::default(),
            is_free: vec![false; models.len()],
            free_gap: f64::INFINITY,
            free_tasks: Vec::new(),
            row_states: Vec::new(),
            restored_states: None,
        }
    }

    /// Makes the columns of motion bounds, once a cloth has lists of contacts with colliders. Free points have neither.
    pub fn begin_lists(&mut self, model: &Model<R>, rows: usize) {
        let is_listed = !self.collider_states.is_empty() && self.is_free.contains(&false);
        if is_listed && self.bounds_violated.is_empty() {
            self.resize_bounds(rows);
        }
        for list in self.collider_contacts.iter_mut().filter(|list| self.is_free[list.cloth]) {
            list.clear();
            let points = model.cloths[list.cloth].points();
            let rows = points.start as usize..points.end as usize;
            self.bounds_violated.get_mut(rows).unwrap_or_default().fill(true);
        }
    }

    /// Sets the number of motion bounds; new ones are violated.
    pub fn resize_bounds(&mut self, rows: usize) {
        self.window_bounds.resize(rows, [Row4::ZERO; 2]);
        self.interval_bounds.resize(rows, [Row4::ZERO; 2]);
        self.bound_growth.resize(rows, R::ZERO);
        self.bounds_violated.resize(rows, true);
    }

    /// Whether a cloth has lists of contacts with colliders and the ground in this frame, and a pass resolves them.
    pub fn is_listed(&self, cloth: usize) -> bool {
        !self.is_free[cloth] && self.is_resolved(cloth)
    }

    /// The places of a cloth's lists of contacts with each collider.
    pub fn lists_of(&self, cloth: usize) -> Range<usize> {
        let colliders = self.collider_states.len();
        cloth * colliders..(cloth + 1) * colliders
    }

    /// The contact materials of a cloth with each collider.
    pub fn collider_materials_of(&self, cloth: usize) -> &[Option<ContactMaterial<R>>] {
        self.collider_materials.row(cloth)
    }

    /// Whether a cloth collides with any collider in this frame.
    pub fn has_collider_material(&self, cloth: usize) -> bool {
        self.collider_materials_of(cloth).iter().any(Option::is_some)
    }

    /// Notes at the end of a frame which cloths had a contact in it.
    pub fn end_frame(&mut self) {
        let in_frame = self.has_touched.iter_mut().map(|mark| std::mem::take(mark.get_mut()));
        self.touches.iter_mut().zip(in_frame).for_each(|(touches, in_frame)| *touches = in_frame);
    }

    /// Whether a pass resolves the contacts of a cloth.
    pub fn is_resolved(&self, cloth: usize) -> bool {
        self.contact_mask.get(cloth).is_none_or(|&is_resolved| is_resolved)
    }

    /// Moves every collider to a time of the frame, 0 to 1.
    pub fn set_time(&mut self, now: f64) {
        self.collider_states.iter_mut().for_each(|collider| collider.now = now);
        self.ground.now = now;
    }

    /// Invalidates the motion bounds of a point whose position was set, among cloths and colliders.
    pub fn invalidate_bounds(&mut self, row: usize) {
        let Self { cloth_contacts, bounds_violated, .. } = self;
        let among_cloths = cloth_contacts.as_mut().and_then(|contacts| contacts.bounds_violated.get_mut(row));
        bounds_violated
            .get_mut(row)
            .into_iter()
            .chain(among_cloths)
            .for_each(|is_violated| *is_violated = true);
    }
}

/// Inputs and outputs of the contact passes of a time step.
pub struct ContactPass<'a, R: Real> {
    /// Read: the objects.
    pub model: &'a Model<R>,
    /// Read: the input of the frame.
    pub frame: &'a FrameInput,
    /// Read: substeps, time steps and their length.
    pub schedule: &'a Schedule<R>,
    /// Read: the time step, within the frame.
    pub span: StepInterval,
    /// The threads that share a pass.
    pub pool: &'a ThreadPool,
    /// Written: positions.
    pub state: &'a mut State<R>,
    /// Written: contacts, and bounds.
    pub contact: &'a mut ContactSystem<R>,
    /// Written: the counters of the report.
    pub counters: &'a mut ContactCounters,
}

impl<R: Real> ContactPass<'_, R> {
    /// Calls `work` with the contacts among cloths, at their full thickness; `None` without any.
    pub fn with_cloth_contacts<T>(
        &mut self,
        work: impl FnOnce(&mut ContactCache<R>, &ClothStep<'_, R>, &ThreadPool) -> T,
    ) -> Option<T> {
        let ContactSystem { cloth_contacts, material_maps, drift, .. } = &mut *self.contact;
        let ClothContacts { cache, materials, local_anchors, .. } = cloth_contacts.as_mut()?;
        let step = ClothStep {
            local_anchors: Some(&*local_anchors),
            drift,
            ..ClothStep::new(self.state, materials, material_maps, self.schedule.h)
        };
        Some(work(cache, &step, self.pool))
    }
}
