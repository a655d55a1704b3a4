//! Continuous collision detection over a window of several steps: what is certified apart for all of it is not looked
//! at again.
//!
//! ```text
//! window begins: motion bounds ─▶ element bounds ─BVH─▶ candidates ─separating plane─▶ uncertified pairs
//! every step:    uncertified pairs, and elements that left their bounds ─▶ passage()
//! ```
//!
//! The motion bounds of a point are a straight trajectory and a radius about it, in steps of the run.

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::crossings::Motion;
use crate::event::{Event, Pair};
use crate::passage::are_kept_apart;
use crate::threads::in_chunks;
use crate::tree::Tree;
use crate::world::{EdgeId, FaceId, Rules, World};

/// Rounding of a trajectory and of what is compared with it, in units of the last place of the largest coordinate.
const ROUNDINGS: f64 = 8.0;

/// Uncertified pairs that cost as much as one query of a tree.
const PAIRS_PER_QUERY: usize = 8;

/// Where each point may be in each step of a window.
struct Trajectories {
    origin: Vec<Vector3<f64>>,
    /// Displacement in one step.
    travel: Vec<Vector3<f64>>,
    /// How far along an axis a point may be from its place.
    radius: f64,
    /// What the radius loses to rounding.
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

    /// Whether a point is within its bounds; never where a coordinate is not finite.
    fn holds(&self, point: usize, step: u32, place: &Vector3<f64>) -> bool {
        let off = place - self.at(point, step);
        let most = self.radius + self.rounding;
        off.x.abs() <= most && off.y.abs() <= most && off.z.abs() <= most
    }

    /// A radius that contains all that [`holds`](Self::holds) lets pass.
    fn reach(&self) -> f64 {
        self.radius + 4.0 * self.rounding
    }

    fn bounds<const N: usize>(&self, points: &[u32; N], steps: u32) -> Bounds {
        let ends = points.map(|point| [0, steps].map(|step| self.at(point as usize, step)));
        Bounds::of(ends.as_flattened()).grown(self.reach())
    }
}

/// Elements of one kind: their bounds over the window, and those that have left them.
#[derive(Default)]
struct Layer {
    tree: Tree,
    boxes: Vec<Bounds>,
    is_loose: Vec<bool>,
    loose: Vec<u32>,
}

impl Layer {
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
            Some(items) => self.tree = Tree::new(items, &self.boxes),
            None => self.tree.refit(&self.boxes),
        }
        self.loose.clear();
        self.is_loose.clear();
        self.is_loose.resize(all.len(), false);
    }

    /// What `take` makes of all pairs of elements, one from here and one from another layer, whose bounds meet.
    fn pairs_with(&self, other: &Self, take: impl Fn([u32; 2], &mut Vec<Pair>) + Sync) -> Vec<Pair> {
        in_chunks(&self.tree.leaves(), |leaves| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &leaf in leaves {
                let others = (&other.tree, other.boxes.as_slice());
                let visit = |one, other| take([one, other], &mut pairs);
                self.tree.meeting_leaf(&self.boxes, leaf, others, &mut stack, visit);
            }
            pairs
        })
    }

    /// The same within the layer, each pair once.
    fn own_pairs(&self, take: impl Fn([u32; 2], &mut Vec<Pair>) + Sync) -> Vec<Pair> {
        in_chunks(&self.tree.leaves(), |leaves| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &leaf in leaves {
                let visit = |one, other| take([one, other], &mut pairs);
                self.tree.meeting_itself(&self.boxes, leaf, &mut stack, visit);
            }
            pairs
        })
    }

    /// Takes out what a point belongs to that has left its bounds.
    fn loosen<const N: usize>(&mut self, all: &[[u32; N]], is_loose: impl Fn(u32) -> bool) {
        self.loose.clear();
        for (index, points) in (0..).zip(all) {
            if points.iter().any(|&point| is_loose(point)) {
                self.is_loose[index as usize] = true;
                self.loose.push(index);
            }
        }
    }

    /// A tree of what has left its bounds, over one motion.
    fn loose_tree<const N: usize>(&mut self, all: &[[u32; N]], motion: &Motion<'_>) -> Tree {
        for &item in &self.loose {
            self.boxes[item as usize] = motion.swept(&all[item as usize]);
        }
        Tree::new(self.loose.clone(), &self.boxes)
    }
}

/// Looks for passages step by step, and keeps from one step to the next what it knows.
#[derive(Default)]
pub struct Windows {
    points: Layer,
    edges: Layer,
    faces: Layer,
    /// Points as elements of their own.
    singles: Vec<[u32; 1]>,
    trajectories: Option<Trajectories>,
    /// Pairs that nothing certifies for the whole window, in order.
    uncertified: Vec<Pair>,
    /// Steps that the window may have, and those that are over.
    steps: u32,
    over: u32,
    /// Work since the window began, in queries.
    spent: usize,
    /// Windows since the trees were built.
    age: u32,
}

impl std::fmt::Debug for Windows {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Windows")
            .field("steps", &self.steps)
            .field("over", &self.over)
            .finish_non_exhaustive()
    }
}

/// The most steps in a window.
const LONGEST: u32 = 128;

/// Windows after which trees are built anew, for the shape may have changed.
const OLD: u32 = 16;

/// Radius of motion bounds, as a share of the mean length of an edge.
const RADIUS: f64 = 1.0 / 32.0;

impl Windows {
    /// Forgets everything: the next motion does not begin where the last one ended, or under other rules.
    pub fn reset(&mut self) {
        self.trajectories = None;
        self.age = 0;
    }

    /// The pairs that do not stay apart in a motion, in order. It begins where the last one ended.
    pub fn crossings(&mut self, motion: &Motion<'_>) -> Vec<Event> {
        if !self.goes_on(motion) {
            self.begin(motion);
        }
        self.over += 1;
        let mut events =
            motion.passages(self.uncertified.iter().copied().filter(|&pair| !self.is_loose(pair)));
        self.spent += self.uncertified.len() / PAIRS_PER_QUERY;
        if !self.points.loose.is_empty() {
            events.extend(self.loose_passages(motion));
        }
        events.sort_by_key(|event| event.pair);
        events
    }

    fn is_loose(&self, pair: Pair) -> bool {
        match pair {
            Pair::PointFace(point, face) => {
                self.points.is_loose[point as usize] || self.faces.is_loose[face.0 as usize]
            }
            Pair::EdgeEdge(a, b) => self.edges.is_loose[a.0 as usize] || self.edges.is_loose[b.0 as usize],
        }
    }

    /// Whether the window may take up a motion; marks what leaves its bounds.
    fn goes_on(&mut self, motion: &Motion<'_>) -> bool {
        if self.trajectories.is_none() || self.over == self.steps {
            return false;
        }
        self.find_loose(motion);
        let cost = self.points.boxes.len() + self.edges.boxes.len();
        self.spent += self.points.loose.len() + self.edges.loose.len() + self.faces.loose.len();
        self.spent <= cost
    }

    fn find_loose(&mut self, motion: &Motion<'_>) {
        let Some(trajectories) = &self.trajectories else { return };
        let step = self.over + 1;
        let before = self.points.loose.len();
        for (point, place) in motion.after.iter().enumerate() {
            if !self.points.is_loose[point] && !trajectories.holds(point, step, place) {
                self.points.is_loose[point] = true;
                self.points.loose.push(point as u32);
            }
        }
        if self.points.loose.len() > before {
            let is_loose = |point: u32| self.points.is_loose[point as usize];
            self.edges.loosen(motion.world.edges(), is_loose);
            self.faces.loosen(motion.world.triangles(), is_loose);
        }
    }

    fn begin(&mut self, motion: &Motion<'_>) {
        let (world, rules) = (motion.world, motion.rules);
        let is_first = self.trajectories.is_none();
        self.steps = match () {
            () if is_first => 1,
            () if self.over == self.steps => (2 * self.steps).min(LONGEST),
            () => self.over.max(1),
        };
        let radius = if self.steps == 1 { 0.0 } else { RADIUS * mean_length(world, motion.before) };
        let at = Trajectories::new(motion, self.steps, radius);
        let rebuild = self.age.is_multiple_of(OLD);
        if is_first {
            self.singles = (0..world.points() as u32).map(|point| [point]).collect();
        }
        let singles = &self.singles;
        self.points.begin(singles, rebuild.then(|| rules.concerned(world, singles)), &at, self.steps);
        self.edges.begin(world.edges(), items(rebuild, rules, world, world.edges()), &at, self.steps);
        self.faces.begin(world.triangles(), items(rebuild, rules, world, world.triangles()), &at, self.steps);
        let uncertified = self.search(motion, &at);
        (self.uncertified, self.trajectories) = (uncertified, Some(at));
        (self.over, self.spent, self.age) = (0, 0, self.age + 1);
        self.find_loose(motion);
    }

    /// All pairs whose bounds meet and that no plane keeps apart throughout the window.
    fn search(&self, motion: &Motion<'_>, at: &Trajectories) -> Vec<Pair> {
        let certify = Certify { motion, at, steps: self.steps };
        let mut pairs = self.points.pairs_with(&self.faces, |[point, face], pairs| {
            certify.take(Pair::PointFace(point, FaceId(face)), pairs);
        });
        pairs.extend(self.edges.own_pairs(|[one, other], pairs| {
            certify.take(Pair::EdgeEdge(EdgeId(one.min(other)), EdgeId(one.max(other))), pairs);
        }));
        pairs
    }

    /// Passages of what has left its bounds, with everything.
    fn loose_passages(&mut self, motion: &Motion<'_>) -> Vec<Event> {
        let (edges, triangles) = (motion.world.edges(), motion.world.triangles());
        let loose_faces = self.faces.loose_tree(triangles, motion);
        let loose_edges = self.edges.loose_tree(edges, motion);
        let mut events = in_chunks(&self.points.loose, |points| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &point in points {
                let bounds = motion.swept(&[point]);
                let mut found = |face| pairs.push(Pair::PointFace(point, FaceId(face)));
                let held = |face: &u32| !self.faces.is_loose[*face as usize];
                self.faces.tree.meeting(&bounds, &self.faces.boxes, &mut stack, |face| {
                    Some(face).filter(held).into_iter().for_each(&mut found);
                });
                loose_faces.meeting(&bounds, &self.faces.boxes, &mut stack, found);
            }
            motion.passages(pairs.into_iter())
        });
        events.extend(in_chunks(&self.faces.loose, |faces| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &face in faces {
                let bounds = &self.faces.boxes[face as usize];
                self.points.tree.meeting(bounds, &self.points.boxes, &mut stack, |point| {
                    if !self.points.is_loose[point as usize] {
                        pairs.push(Pair::PointFace(point, FaceId(face)));
                    }
                });
            }
            motion.passages(pairs.into_iter())
        }));
        events.extend(in_chunks(&self.edges.loose, |loose| {
            let (mut stack, mut pairs) = (Vec::new(), Vec::new());
            for &edge in loose {
                let bounds = &self.edges.boxes[edge as usize];
                let pair = |other: u32| Pair::EdgeEdge(EdgeId(edge.min(other)), EdgeId(edge.max(other)));
                self.edges.tree.meeting(bounds, &self.edges.boxes, &mut stack, |other| {
                    if !self.edges.is_loose[other as usize] {
                        pairs.push(pair(other));
                    }
                });
                loose_edges.meeting(bounds, &self.edges.boxes, &mut stack, |other| {
                    if other > edge {
                        pairs.push(pair(other));
                    }
                });
            }
            motion.passages(pairs.into_iter())
        }));
        events
    }
}

fn items<const N: usize>(rebuild: bool, rules: &Rules, world: &World, all: &[[u32; N]]) -> Option<Vec<u32>> {
    rebuild.then(|| rules.concerned(world, all))
}

/// The mean length of an edge; 0 where there is none of finite length.
fn mean_length(world: &World, places: &[Vector3<f64>]) -> f64 {
    let lengths = world.edges().iter().map(|[a, b]| (places[*a as usize] - places[*b as usize]).norm());
    let finite: Vec<f64> = lengths.filter(|length| length.is_finite()).collect();
    finite.iter().sum::<f64>() / finite.len().max(1) as f64
}

/// Decides which pairs need no look for the whole of a window.
struct Certify<'a> {
    motion: &'a Motion<'a>,
    at: &'a Trajectories,
    steps: u32,
}

impl Certify<'_> {
    fn take(&self, pair: Pair, uncertified: &mut Vec<Pair>) {
        let Some((kind, points)) = self.motion.elements(pair) else { return };
        let [start, end] = [0, self.steps].map(|step| points.map(|point| self.at.at(point as usize, step)));
        if !are_kept_apart(kind, [&start, &end], 2.0 * self.at.reach()) {
            uncertified.push(pair);
        }
    }
}
