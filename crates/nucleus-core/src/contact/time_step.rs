//! A time step as contacts read and write it: positions, collider motion, and counters.

use std::sync::atomic::{AtomicU64, Ordering};

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::collider::turning::Turning;
use crate::contact::collider_maps::ColliderMaps;
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::math::{Real, Row4, add};
use crate::parallel::disjoint::DisjointSlice;
use crate::schedule::TimeInterval;
use crate::state::State;

type Point = Vector3<f64>;

/// Counters of a frame. Whole numbers, so that the order of addition does not matter.
#[derive(Debug, Default)]
pub struct ContactCounters {
    /// Contacts that pushed, over all passes.
    pub contacts: AtomicU64,
    /// Pairs whose motion was undone or truncated, once for each time.
    pub pairs_reverted: AtomicU64,
    /// Pairs without a certificate at the end of a time step, once for each time step.
    pub pairs_unresolved: AtomicU64,
    /// Candidate pairs found by the broad phase, over all its runs.
    pub candidate_pairs: AtomicU64,
    /// Runs of the broad phase.
    pub broad_phases: AtomicU64,
    /// Particles born, that died, that were refused, and that were left out because they would overlap others.
    pub births: u64,
    pub deaths: u64,
    pub births_refused: u64,
    pub births_pruned: u64,
}

impl ContactCounters {
    /// Adds those of a task.
    pub fn add(&mut self, of_task: &Self) {
        for (all, own) in [
            (&mut self.contacts, &of_task.contacts),
            (&mut self.pairs_reverted, &of_task.pairs_reverted),
            (&mut self.pairs_unresolved, &of_task.pairs_unresolved),
            (&mut self.candidate_pairs, &of_task.candidate_pairs),
        ] {
            *all.get_mut() += own.load(Ordering::Relaxed);
        }
    }
}

/// Writes positions, and records depenetration: the part of a push that does not become velocity.
#[derive(Clone, Copy)]
pub struct PositionWriter<'a, R> {
    displacement: DisjointSlice<'a, Row4<R>>,
    depenetration: DisjointSlice<'a, Row4<R>>,
    bearing: DisjointSlice<'a, Row4<R>>,
    predicted: &'a [Row4<R>],
    /// The row of the first entry of all columns but the displacements.
    first: u32,
}

#[allow(unsafe_code)]
impl<'a, R: Real> PositionWriter<'a, R> {
    /// Borrows the columns that contact writes; returns beside it the displacements at the start of the step and the
    /// anchors.
    pub fn of(state: &'a mut State<R>) -> (Self, &'a [Row4<R>], &'a [[f64; 3]]) {
        let State { displacement, predicted, depenetration, bearing_depenetration, start, anchor, .. } =
            state;
        let [displacement, depenetration, bearing] =
            [displacement, depenetration, bearing_depenetration].map(|column| DisjointSlice::new(column));
        (Self { displacement, depenetration, bearing, predicted, first: 0 }, start, anchor)
    }

    /// The columns of a run of points from the row `first` on, of which a task keeps all but the displacements. The second
    /// argument holds the depenetration, and that which bears a load.
    pub fn of_run(
        displacement: DisjointSlice<'a, Row4<R>>,
        [depenetration, bearing]: [&'a mut [Row4<R>]; 2],
        predicted: &'a [Row4<R>],
        first: u32,
    ) -> Self {
        let [depenetration, bearing] = [depenetration, bearing].map(DisjointSlice::new);
        Self { displacement, depenetration, bearing, predicted, first }
    }

    /// The place of a point in all columns but the displacements.
    #[inline(always)]
    pub fn place_of(&self, point: u32) -> usize {
        (point - self.first) as usize
    }

    /// The displacement of a point without constraints and contacts, but with its depenetration.
    #[inline(always)]
    pub fn predicted(&self, point: u32) -> [R; 3] {
        // SAFETY: as below.
        let bearing = unsafe { self.bearing.get(point - self.first) }.xyz();
        add(self.predicted[self.place_of(point)].xyz(), add(self.depenetration(point), bearing))
    }

    /// How far constraints and contacts have moved a point that touches no cloth, without its depenetration, in metres.
    #[inline(always)]
    pub fn correction(&self, point: u32) -> R::Lanes {
        // SAFETY: as below.
        let depenetration = unsafe { self.depenetration.get(point - self.first) };
        self.row(point).lanes() - self.predicted[self.place_of(point)].lanes() - depenetration.lanes()
    }

    /// A point's displacement in metres, and its inverse mass in 1/kg.
    #[inline(always)]
    pub fn row(&self, point: u32) -> Row4<R> {
        // SAFETY: the tasks of a phase share no point.
        unsafe { self.displacement.get(point) }
    }

    /// How far contacts have depenetrated a point in this step, in metres, but for those that bear a load.
    #[inline(always)]
    pub fn depenetration(&self, point: u32) -> [R; 3] {
        // SAFETY: as above.
        unsafe { self.depenetration.get(point - self.first) }.xyz()
    }

    /// Moves a point; `depenetration` is the part of the push without velocity.
    #[inline(always)]
    pub fn push(&self, point: u32, row: Row4<R>, depenetration: [R; 3]) {
        let [x, y, z] = add(self.depenetration(point), depenetration);
        // SAFETY: as above.
        unsafe {
            self.displacement.set(point, row);
            self.depenetration.set(point - self.first, Row4([x, y, z, R::ZERO]));
        }
    }

    /// Moves a point that bears a load: where another contact reverses the part of the push without velocity, that becomes
    /// velocity.
    #[inline(always)]
    pub fn push_bearing(&self, point: u32, row: Row4<R>, depenetration: [R; 3]) {
        // SAFETY: as above.
        unsafe {
            let mut bearing = self.bearing.get(point - self.first);
            (0..3).for_each(|axis| bearing.0[axis] += depenetration[axis]);
            self.displacement.set(point, row);
            self.bearing.set(point - self.first, bearing);
        }
    }

    /// Sets a point's displacement to one that has a share of its motion, and so of its depenetration.
    #[inline(always)]
    pub fn truncate(&self, point: u32, row: Row4<R>, share: R) {
        let scaled = |row: Row4<R>| Row4(row.0.map(|x| x * share));
        // SAFETY: as above.
        unsafe {
            self.displacement.set(point, row);
            self.depenetration.set(point - self.first, scaled(self.depenetration.get(point - self.first)));
            self.bearing.set(point - self.first, scaled(self.bearing.get(point - self.first)));
        }
    }

    /// Sets a point's displacement, and clears its depenetration.
    #[inline(always)]
    pub fn place(&self, point: u32, row: Row4<R>) {
        // SAFETY: as above.
        unsafe {
            self.displacement.set(point, row);
            self.depenetration.set(point - self.first, Row4::ZERO);
            self.bearing.set(point - self.first, Row4::ZERO);
        }
    }
}

/// A time step of one cloth and one collider.
pub struct ColliderStep<'a, R> {
    /// The cloth's positions.
    pub writer: PositionWriter<'a, R>,
    /// Displacements at the start of the step, in metres, at [`PositionWriter::place_of`] a point.
    pub start: &'a [Row4<R>],
    /// Anchors in metres.
    pub anchors: &'a [[f64; 3]],
    /// The collider's points at the start and at the end of the frame.
    pub collider: [&'a [Point]; 2],
    /// How the collider turns in the frame; `None` where it does not.
    pub turning: Option<&'a Turning>,
    /// Start and end of the step, as shares of the frame.
    pub time: TimeInterval,
    /// The candidate interval, as shares of the frame.
    pub interval: TimeInterval,
    /// Start and end of the step, as shares of the candidate interval.
    pub shares: [R; 2],
    /// Length of the step in seconds.
    pub h: R,
    /// Contact thickness in metres: the largest value under the vertex maps.
    pub thickness: R,
    /// Factor on every thickness: below one where there is too little clearance.
    pub thickness_scale: R,
    /// The contact material of the two.
    pub material: ContactMaterial<R>,
    /// Vertex maps of contact attributes.
    pub material_maps: &'a MaterialMaps<R>,
    /// Those of the collider, if it has any.
    pub collider_maps: Option<&'a ColliderMaps>,
    /// Whether the points are free: a plane along the path of one then certifies that it misses a face.
    pub of_free_points: bool,
}

impl<R: Real> ColliderStep<'_, R> {
    /// The same step at a share of every thickness.
    pub fn with_thickness_scale(self, share: f64) -> Self {
        let share = R::from_f64(share);
        Self { thickness: self.thickness * share, thickness_scale: self.thickness_scale * share, ..self }
    }

    /// Distance in metres up to which contact or adhesion acts.
    pub fn interaction_range(&self) -> R {
        R::from_f64(self.material.thickness * self.material.adhesion_range)
    }

    /// The distance to keep at a contact, in metres, given the material there.
    #[inline(always)]
    pub(in crate::contact) fn rest_gap<const N: usize>(
        &self,
        material: &ContactMaterial<R>,
        points: [u32; N],
        weights: [R; N],
    ) -> R {
        let maps = self.material_maps;
        let has_maps = !maps.thickness.is_empty() || self.collider_maps.is_some();
        if !has_maps && maps.kept_gaps.is_empty() && maps.clearance.is_full() {
            return self.thickness;
        }
        let most = R::from_f64(self.material.thickness);
        let thickness = material.mapped_thickness(maps, (points, [], &(weights, [])), most);
        maps.kept_gaps.at(points, weights, thickness)
            * self.thickness_scale
            * maps.clearance.share(points, weights)
    }

    /// Whether collisions with this collider are carried out in part: cloth may then pass through it.
    #[inline(always)]
    pub(in crate::contact) fn is_partial(&self) -> bool {
        self.material.is_partial(self.material_maps) || self.collider_maps.is_some_and(|maps| maps.is_partial)
    }

    /// The cloth's points at the start and at the end of the step.
    #[inline]
    pub(in crate::contact) fn cloth_positions<const N: usize>(&self, points: [u32; N]) -> [[Point; N]; 2] {
        let mut end = [Point::zeros(); N];
        for k in 0..N {
            end[k] = self.position(points[k], self.row(points[k]).xyz());
        }
        [self.cloth_start_positions(points), end]
    }

    #[inline]
    pub(in crate::contact) fn cloth_start_positions<const N: usize>(&self, points: [u32; N]) -> [Point; N] {
        // Loops, because maps over these arrays are not inlined.
        let mut start = [Point::zeros(); N];
        for k in 0..N {
            start[k] = self.position(points[k], self.start(points[k]));
        }
        start
    }

    /// Whether collisions of a point are carried out in full.
    pub fn has_full_strength(&self, point: u32) -> bool {
        self.collider_maps.is_none_or(|maps| !maps.is_partial)
            && self.material.strength_at(self.material_maps, ([point], [], &([R::ONE], []))) >= R::ONE
    }

    /// Position of a point at the start of the step, in metres.
    pub fn start_position(&self, point: u32) -> Point {
        self.position(point, self.start(point))
    }

    /// Position of a point at the end of the step, in metres.
    pub fn end_position(&self, point: u32) -> Point {
        self.position(point, self.row(point).xyz())
    }

    /// Moves a point from its position at the start of the step, unless it is pinned.
    pub fn move_from_start(&self, point: u32, motion: Point) {
        let mut row = self.row(point);
        if row.0[3] > R::ZERO {
            let start = self.start(point);
            (0..3).for_each(|axis| row.0[axis] = start[axis] + R::from_f64(motion[axis]));
            self.writer.place(point, row);
        }
    }

    /// Pushes a point, unless it is pinned; `depenetration` is the part of the push without velocity.
    pub fn push_point(&self, point: u32, push: Point, depenetration: Point) {
        let mut row = self.row(point);
        if row.0[3] > R::ZERO {
            (0..3).for_each(|axis| row.0[axis] += R::from_f64(push[axis]));
            self.writer.push(
                point,
                row,
                [depenetration.x, depenetration.y, depenetration.z].map(R::from_f64),
            );
        }
    }

    #[inline(always)]
    pub(in crate::contact) fn position(&self, point: u32, [x, y, z]: [R; 3]) -> Point {
        Point::from(self.anchors[point as usize]) + Point::new(x.to_f64(), y.to_f64(), z.to_f64())
    }

    #[inline(always)]
    pub(in crate::contact) fn row(&self, point: u32) -> Row4<R> {
        self.writer.row(point)
    }

    /// The displacements of some points at the end of the step, and at its start.
    #[inline(always)]
    pub(in crate::contact) fn displacements<const N: usize>(&self, points: [u32; N]) -> [[R; 3]; N] {
        // Loops, because maps over arrays are not inlined.
        let mut displacements = [[R::ZERO; 3]; N];
        for k in 0..N {
            displacements[k] = self.row(points[k]).xyz();
        }
        displacements
    }

    #[inline(always)]
    pub(in crate::contact) fn start_displacements<const N: usize>(&self, points: [u32; N]) -> [[R; 3]; N] {
        let mut displacements = [[R::ZERO; 3]; N];
        for k in 0..N {
            displacements[k] = self.start(points[k]);
        }
        displacements
    }

    #[inline(always)]
    pub(in crate::contact) fn start(&self, point: u32) -> [R; 3] {
        self.start[self.writer.place_of(point)].xyz()
    }

    /// The collider's points at the start and at the end of the step.
    #[inline]
    pub fn collider_positions<const M: usize>(&self, points: [u32; M]) -> [[Point; M]; 2] {
        let mut ends = [[Point::zeros(); M]; 2];
        for k in 0..M {
            let [start, end] = [self.collider[0][points[k] as usize], self.collider[1][points[k] as usize]];
            let travel = end - start;
            ends[0][k] = start + travel * self.time.start;
            ends[1][k] = start + travel * self.time.end;
        }
        ends
    }

    /// The largest n·q of some points of the collider, at the start and at the end of the candidate interval.
    #[inline]
    pub(in crate::contact) fn support(&self, normal: Point, points: &[u32]) -> [f64; 2] {
        let (mut support, mut moves) = ([f64::NEG_INFINITY; 2], false);
        for &point in points {
            let [start, end] = [self.collider[0][point as usize], self.collider[1][point as usize]];
            moves |= start != end;
            support[0] = support[0].max(normal.dot(&(start + (end - start) * self.interval.start)));
        }
        support[1] = support[0];
        if moves {
            let at_end = points.iter().map(|&q| normal.dot(&self.collider_position(q, self.interval.end)));
            support[1] = at_end.fold(f64::NEG_INFINITY, f64::max);
        }
        support
    }

    /// A point of the collider at a time of the frame.
    #[inline]
    pub(in crate::contact) fn collider_position(&self, point: u32, time: f64) -> Point {
        let [start, end] = [self.collider[0][point as usize], self.collider[1][point as usize]];
        start + (end - start) * time
    }
}

/// The parameters of a [`ColliderStep`], besides the state.
pub struct ColliderStepArgs<'a, R> {
    /// The contact material of the two.
    pub material: ContactMaterial<R>,
    /// Vertex maps of contact attributes.
    pub material_maps: &'a MaterialMaps<R>,
    /// The collider, by its index.
    pub at: usize,
    /// Length of the step in seconds.
    pub h: f64,
    /// Start and end of the step, as shares of the frame.
    pub time: TimeInterval,
    /// The candidate interval, as shares of the frame.
    pub interval: TimeInterval,
}

impl<R: Real> ColliderStepArgs<'_, R> {
    /// The step of a cloth in `state` and a collider.
    pub fn of<'s>(&'s self, state: &'s mut State<R>, collider: &'s ColliderState) -> ColliderStep<'s, R> {
        self.with_columns(PositionWriter::of(state), collider)
    }

    /// The step of a cloth with these positions, displacements at the start and anchors, and a collider.
    pub fn with_columns<'s>(
        &'s self,
        (writer, start, anchors): (PositionWriter<'s, R>, &'s [Row4<R>], &'s [[f64; 3]]),
        collider: &'s ColliderState,
    ) -> ColliderStep<'s, R> {
        ColliderStep {
            writer,
            start,
            anchors,
            collider: collider.ends(),
            turning: collider.turning.as_ref(),
            time: self.time,
            interval: self.interval,
            shares: self.time.ends().map(|time| R::from_f64(self.interval.share_of(time))),
            h: R::from_f64(self.h),
            thickness: R::from_f64(self.material.thickness),
            thickness_scale: R::ONE,
            material: self.material,
            material_maps: self.material_maps,
            collider_maps: self.material_maps.of_collider(self.at),
            of_free_points: false,
        }
    }
}
