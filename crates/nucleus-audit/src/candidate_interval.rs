//! Broad phase over candidate intervals: pairs that are certified to stay apart for several steps are not tested again.
//!
//! ```text
//! interval begins: motion bounds ─▶ element bounds ─BVH─▶ candidates ─separating plane─▶ uncertified pairs
//! every step:      uncertified pairs, and elements that violate their bounds ─▶ ccd()
//! ```
//!
//! The motion bounds of a point are a linear trajectory and a radius about it. Time is counted in steps of the run.

use nalgebra::Vector3;

use crate::bvh::{Aabb, Bvh};
use crate::ccd::separated_throughout;
use crate::collision_filter::CollisionFilter;
use crate::collision_mesh::{CollisionMesh, EdgeId, FaceId};
use crate::motion::Motion;
use crate::pair::{Collision, Pair};
use crate::parallel::parallel_chunks;

/// Rounding error of a trajectory and of a comparison with it, in units in the last place of the largest coordinate.
const ROUNDINGS: f64 = 8.0;

/// Number of uncertified pairs that cost as much as one BVH query.
const PAIRS_PER_QUERY: usize = 8;

/// The pairs that collide while all points move linearly from `before` to `after`, in order. Positions are those of all
/// bodies, one body after the other.
///
/// # Panics
/// When the number of positions differs from the number of points.
pub fn collisions(
    mesh: &CollisionMesh,
    filter: &CollisionFilter,
    before: &[Vector3<f64>],
    after: &[Vector3<f64>],
) -> Vec<Collision> {
    CandidateIntervals::default().collisions(&Motion::new(mesh, filter, [before, after]))
}

/// Motion bounds of all points over a candidate interval.
struct Trajectories {
    origin: Vec<Vector3<f64>>,
    /// Displacement per step.
    travel: Vec<Vector3<f64>>,
    /// Largest distance along an axis between a point and its trajectory.
    radius: f64,
    /// Rounding error that the radius must absorb.
    rounding: f64,
}

impl Trajectories {
    fn new(motion: &Motion<'_>, steps: u32, radius: f64) -> Self {
        let travel: Vec<Vector3<f64>> =
            motion.after.iter().zip(motion.before).map(|(after, before)| after - before).collect();
        let mut bounds = Self { origin: motion.before.to_vec(), travel, radius, rounding: 0.0 };
        let ends = (0..bounds.origin.len()).flat_map(|k| [bounds.at(k, 0), bounds.at(k, steps)]);
        let sizes = ends.map(|place| place.amax()).filter(|size| size.is_finite());
        bounds.rounding = ROUNDINGS * f64::EPSILON * sizes.fold(f64::MIN_POSITIVE, f64::max);
        bounds
    }

    fn at(&self, point: usize, step: u32) -> Vector3<f64> {
        self.origin[point] + self.travel[point] * f64::from(step)
    }

    /// Whether a point is within its motion bounds; `false` where a coordinate is not finite.
    fn contains(&self, point: usize, step: u32, place: &Vector3<f64>) -> bool {
        let off = place - self.at(point, step);
        let most = self.radius + self.rounding;
        off.x.abs() <= most && off.y.abs() <= most && off.z.abs() <= most
    }

    /// A radius that bounds all positions accepted by [`contains`](Self::contains).
    fn margin(&self) -> f64 {
        self.radius + 4.0 * self.rounding
    }

    fn bounds<const N: usize>(&self, points: &[u32; N], steps: u32) -> Aabb {
        let ends = points.map(|point| [0, steps].map(|step| self.at(point as usize, step)));
        Aabb::of(ends.as_flattened()).inflated(self.margin())
    }
}

/// Elements of one kind: their boxes over the interval, and the elements that violate them.
#[derive(Default)]
struct ElementBounds {
    tree: Bvh,
    boxes: Vec<Aabb>,
    bounds_violated: Vec<bool>,
    violating: Vec<u32>,
}

impl ElementBounds {
    fn begin<const N: usize>(
        &mut self,
        all: &[[u32; N]],
        rebuild: Option<Vec<u32>>,
        at: &Trajectories,
        steps: u32,
    ) {
        self.boxes.clear();
        self.boxes.extend(all.iter().map(|points| at.bounds(points, steps)));
        match rebuild {
            Some(items) => self.tree = Bvh::new(items, &self.boxes),
            None => self.tree.refit(&self.boxes),
        }
        self.violating.clear();
        self.bounds_violated.clear();
        self.bounds_violated.resize(all.len(), false);
    }

    /// The pairs that `take` accepts among all pairs of an element of this kind and one of another whose boxes overlap.
    fn pairs_with(&self, other: &Self, take: impl Fn([u32; 2], &mut Vec<Pair>) + Sync) -> Vec<Pair> {
        parallel_chunks(&self.tree.leaves(), |leaves| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &leaf in leaves {
                let others = (&other.tree, other.boxes.as_slice());
                let visit = |one, other| take([one, other], &mut pairs);
                self.tree.query_leaf(&self.boxes, leaf, others, &mut stack, visit);
            }
            pairs
        })
    }

    /// As [`pairs_with`](Self::pairs_with), within one kind, each pair once.
    fn own_pairs(&self, take: impl Fn([u32; 2], &mut Vec<Pair>) + Sync) -> Vec<Pair> {
        parallel_chunks(&self.tree.leaves(), |leaves| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &leaf in leaves {
                let visit = |one, other| take([one, other], &mut pairs);
                self.tree.query_self(&self.boxes, leaf, &mut stack, visit);
            }
            pairs
        })
    }

    /// Marks the elements with a point that violates its motion bounds.
    fn mark_violating<const N: usize>(&mut self, all: &[[u32; N]], bounds_violated: impl Fn(u32) -> bool) {
        self.violating.clear();
        for (index, points) in (0..).zip(all) {
            if points.iter().any(|&point| bounds_violated(point)) {
                self.bounds_violated[index as usize] = true;
                self.violating.push(index);
            }
        }
    }

    /// A BVH of the violating elements over one motion.
    fn violating_bvh<const N: usize>(&mut self, all: &[[u32; N]], motion: &Motion<'_>) -> Bvh {
        for &item in &self.violating {
            self.boxes[item as usize] = motion.swept(&all[item as usize]);
        }
        Bvh::new(self.violating.clone(), &self.boxes)
    }
}

/// Candidate intervals of a run: finds collisions step by step and reuses certificates between steps.
#[derive(Default)]
pub struct CandidateIntervals {
    points: ElementBounds,
    edges: ElementBounds,
    faces: ElementBounds,
    /// Points as elements of one vertex.
    singles: Vec<[u32; 1]>,
    trajectories: Option<Trajectories>,
    /// Pairs without a certificate for the whole interval, in order.
    uncertified: Vec<Pair>,
    /// Steps of the interval, and steps that have elapsed.
    steps: u32,
    elapsed: u32,
    /// Work since the interval began, in BVH queries.
    spent: usize,
    /// Intervals since the trees were built.
    age: u32,
}

impl std::fmt::Debug for CandidateIntervals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CandidateIntervals")
            .field("steps", &self.steps)
            .field("elapsed", &self.elapsed)
            .finish_non_exhaustive()
    }
}

/// Maximum number of steps in an interval.
const MAX_STEPS: u32 = 128;

/// Intervals after which the trees are rebuilt, since the shape may have changed.
const MAX_AGE: u32 = 16;

/// Radius of motion bounds, as a fraction of the median edge length.
const RADIUS: f64 = 1.0 / 32.0;

impl CandidateIntervals {
    /// Invalidates all bounds: the next motion begins at another state or uses another collision filter.
    pub fn reset(&mut self) {
        self.trajectories = None;
        self.age = 0;
    }

    /// The pairs that collide in a motion, in order. The motion begins where the last one ended.
    pub fn collisions(&mut self, motion: &Motion<'_>) -> Vec<Collision> {
        if !self.covers(motion) {
            self.begin(motion);
        }
        self.elapsed += 1;
        let mut collisions =
            motion.collisions(self.uncertified.iter().copied().filter(|&pair| !self.is_violating(pair)));
        self.spent += self.uncertified.len() / PAIRS_PER_QUERY;
        if !self.points.violating.is_empty() {
            collisions.extend(self.violating_collisions(motion));
        }
        collisions.sort_by_key(|collision| collision.pair);
        collisions
    }

    fn is_violating(&self, pair: Pair) -> bool {
        match pair {
            Pair::PointFace(point, face) => {
                self.points.bounds_violated[point as usize] || self.faces.bounds_violated[face.0 as usize]
            }
            Pair::EdgeEdge(a, b) => {
                self.edges.bounds_violated[a.0 as usize] || self.edges.bounds_violated[b.0 as usize]
            }
        }
    }

    /// Whether the interval covers a motion; marks points that violate their bounds.
    fn covers(&mut self, motion: &Motion<'_>) -> bool {
        if self.trajectories.is_none() || self.elapsed == self.steps {
            return false;
        }
        self.find_violating(motion);
        let cost = self.points.boxes.len() + self.edges.boxes.len();
        self.spent += self.points.violating.len() + self.edges.violating.len() + self.faces.violating.len();
        self.spent <= cost
    }

    fn find_violating(&mut self, motion: &Motion<'_>) {
        let Some(trajectories) = &self.trajectories else { return };
        let step = self.elapsed + 1;
        let before = self.points.violating.len();
        for (point, place) in motion.after.iter().enumerate() {
            if !self.points.bounds_violated[point] && !trajectories.contains(point, step, place) {
                self.points.bounds_violated[point] = true;
                self.points.violating.push(point as u32);
            }
        }
        if self.points.violating.len() > before {
            let bounds_violated = |point: u32| self.points.bounds_violated[point as usize];
            self.edges.mark_violating(motion.mesh.edges(), bounds_violated);
            self.faces.mark_violating(motion.mesh.triangles(), bounds_violated);
        }
    }

    fn begin(&mut self, motion: &Motion<'_>) {
        let (mesh, filter) = (motion.mesh, motion.filter);
        let is_first = self.trajectories.is_none();
        self.steps = match () {
            () if is_first => 1,
            () if self.elapsed == self.steps => (2 * self.steps).min(MAX_STEPS),
            () => self.elapsed.max(1),
        };
        let radius = if self.steps == 1 { 0.0 } else { RADIUS * median_length(mesh, motion.before) };
        let at = Trajectories::new(motion, self.steps, radius);
        let rebuild = self.age.is_multiple_of(MAX_AGE);
        if is_first {
            self.singles = (0..mesh.points() as u32).map(|point| [point]).collect();
        }
        let singles = &self.singles;
        self.points.begin(singles, rebuild.then(|| filter.active_elements(mesh, singles)), &at, self.steps);
        self.edges.begin(mesh.edges(), items(rebuild, filter, mesh, mesh.edges()), &at, self.steps);
        self.faces.begin(mesh.triangles(), items(rebuild, filter, mesh, mesh.triangles()), &at, self.steps);
        let uncertified = self.find_uncertified(motion, &at);
        (self.uncertified, self.trajectories) = (uncertified, Some(at));
        (self.elapsed, self.spent, self.age) = (0, 0, self.age + 1);
        self.find_violating(motion);
    }

    /// All pairs whose boxes overlap and that no plane separates throughout the interval.
    fn find_uncertified(&self, motion: &Motion<'_>, at: &Trajectories) -> Vec<Pair> {
        let certify = Certify { motion, at, steps: self.steps };
        let mut pairs = self.points.pairs_with(&self.faces, |[point, face], pairs| {
            certify.take(Pair::PointFace(point, FaceId(face)), pairs);
        });
        pairs.extend(self.edges.own_pairs(|[one, other], pairs| {
            certify.take(Pair::EdgeEdge(EdgeId(one.min(other)), EdgeId(one.max(other))), pairs);
        }));
        pairs
    }

    /// Collisions of the violating elements with all others.
    fn violating_collisions(&mut self, motion: &Motion<'_>) -> Vec<Collision> {
        let (edges, triangles) = (motion.mesh.edges(), motion.mesh.triangles());
        let violating_faces = self.faces.violating_bvh(triangles, motion);
        let violating_edges = self.edges.violating_bvh(edges, motion);
        let mut collisions = parallel_chunks(&self.points.violating, |points| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &point in points {
                let bounds = motion.swept(&[point]);
                let mut found = |face| pairs.push(Pair::PointFace(point, FaceId(face)));
                let within_bounds = |face: &u32| !self.faces.bounds_violated[*face as usize];
                self.faces.tree.query(&bounds, &self.faces.boxes, &mut stack, |face| {
                    Some(face).filter(within_bounds).into_iter().for_each(&mut found);
                });
                violating_faces.query(&bounds, &self.faces.boxes, &mut stack, found);
            }
            motion.collisions(pairs.into_iter())
        });
        collisions.extend(parallel_chunks(&self.faces.violating, |faces| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &face in faces {
                let bounds = &self.faces.boxes[face as usize];
                self.points.tree.query(bounds, &self.points.boxes, &mut stack, |point| {
                    if !self.points.bounds_violated[point as usize] {
                        pairs.push(Pair::PointFace(point, FaceId(face)));
                    }
                });
            }
            motion.collisions(pairs.into_iter())
        }));
        collisions.extend(parallel_chunks(&self.edges.violating, |violating| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &edge in violating {
                let bounds = &self.edges.boxes[edge as usize];
                let pair = |other: u32| Pair::EdgeEdge(EdgeId(edge.min(other)), EdgeId(edge.max(other)));
                self.edges.tree.query(bounds, &self.edges.boxes, &mut stack, |other| {
                    if !self.edges.bounds_violated[other as usize] {
                        pairs.push(pair(other));
                    }
                });
                violating_edges.query(bounds, &self.edges.boxes, &mut stack, |other| {
                    if other > edge {
                        pairs.push(pair(other));
                    }
                });
            }
            motion.collisions(pairs.into_iter())
        }));
        collisions
    }
}

fn items<const N: usize>(
    rebuild: bool,
    filter: &CollisionFilter,
    mesh: &CollisionMesh,
    all: &[[u32; N]],
) -> Option<Vec<u32>> {
    rebuild.then(|| filter.active_elements(mesh, all))
}

/// Median edge length; 0 where no edge has a finite length. A mean would follow the few long edges of a floor, and bounds of
/// that size overlap everywhere.
fn median_length(mesh: &CollisionMesh, places: &[Vector3<f64>]) -> f64 {
    let lengths = mesh.edges().iter().map(|[a, b]| (places[*a as usize] - places[*b as usize]).norm());
    let mut finite: Vec<f64> = lengths.filter(|length| length.is_finite()).collect();
    if finite.is_empty() {
        return 0.0;
    }
    let middle = finite.len() / 2;
    *finite.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Certifies pairs for a whole interval.
struct Certify<'a> {
    motion: &'a Motion<'a>,
    at: &'a Trajectories,
    steps: u32,
}

impl Certify<'_> {
    fn take(&self, pair: Pair, uncertified: &mut Vec<Pair>) {
        let Some((kind, points)) = self.motion.elements(pair) else { return };
        let [start, end] = [0, self.steps].map(|step| points.map(|point| self.at.at(point as usize, step)));
        if !separated_throughout(kind, [&start, &end], 2.0 * self.at.margin()) {
            uncertified.push(pair);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision_mesh::Body;

    /// Uncertified pairs of a level sheet of 9 by 9 points that has fallen for some steps, above a floor of this size.
    fn uncertified_above_floor(size: f64) -> usize {
        let mut places: Vec<Vector3<f64>> =
            (0..81).map(|k| Vector3::new(f64::from(k % 9), 0.0, f64::from(k / 9)) / 8.0).collect();
        let quads: Vec<[u32; 4]> = (0..71).filter(|k| k % 9 < 8).map(|k| [k, k + 9, k + 10, k + 1]).collect();
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        places.extend(corners.map(|[x, z]| Vector3::new(x * size, -1.0, z * size)));
        let floor: [u32; 4] = [0, 3, 2, 1];
        let sheet = Body::mesh("sheet", 81, quads.iter().map(|quad| quad.as_slice()));
        let mesh = CollisionMesh::new(vec![sheet, Body::mesh("floor", 4, [floor.as_slice()])]);
        let (filter, mut intervals) = (CollisionFilter::default(), CandidateIntervals::default());
        for _ in 0..8 {
            let mut next = places.clone();
            next[..81].iter_mut().for_each(|place| place.y -= 1e-3);
            assert!(intervals.collisions(&Motion::new(&mesh, &filter, [&places, &next])).is_empty());
            places = next;
        }
        intervals.uncertified.len()
    }

    #[test]
    fn the_size_of_a_floor_does_not_change_which_pairs_of_a_sheet_are_tested() {
        assert_eq!(uncertified_above_floor(2.0), uncertified_above_floor(1e4));
    }
}
