//! The collision mesh: all bodies with their edges and triangles, and the filter of pairs.

use std::collections::HashMap;
use std::ops::Range;

/// An edge of a [`CollisionMesh`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeId(pub u32);

/// A triangle of a [`CollisionMesh`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId(pub u32);

/// A body of points, edges and faces.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Body {
    /// Name in reports.
    pub name: String,
    /// Number of points.
    pub points: usize,
    /// Triangles, by their points.
    pub triangles: Vec<[u32; 3]>,
    /// Edges that belong to no triangle, by their points.
    pub edges: Vec<[u32; 2]>,
}

impl Body {
    /// A mesh of polygons, each triangulated as a fan about its first corner.
    pub fn mesh<'a>(
        name: impl Into<String>,
        points: usize,
        faces: impl IntoIterator<Item = &'a [u32]>,
    ) -> Self {
        let fan = |face: &'a [u32]| (2..face.len()).map(move |k| [face[0], face[k - 1], face[k]]);
        let triangles = faces.into_iter().flat_map(fan).collect();
        Self { name: name.into(), points, triangles, edges: Vec::new() }
    }
}

/// All bodies, with elements numbered across bodies.
#[derive(Debug, Clone, Default)]
pub struct CollisionMesh {
    bodies: Vec<Body>,
    /// First point of each body, and one past the last point.
    first: Vec<u32>,
    body_of: Vec<u32>,
    edges: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
    /// The edges of each triangle.
    sides: Vec<[EdgeId; 3]>,
    /// Edges at each point, and triangles at each edge.
    edges_at: Lists,
    faces_at: Lists,
}

/// Lists in compressed sparse row form.
#[derive(Debug, Clone, Default)]
struct Lists {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Lists {
    /// Builds `count` lists from items, each given with the lists that contain it.
    fn new<const N: usize>(count: usize, items: impl Iterator<Item = [u32; N]> + Clone) -> Self {
        let mut starts = vec![0_u32; count + 1];
        items.clone().flatten().for_each(|list| starts[list as usize + 1] += 1);
        (0..count).for_each(|list| starts[list + 1] += starts[list]);
        let mut next = starts.clone();
        let mut all = vec![0; starts[count] as usize];
        for (item, lists) in items.enumerate() {
            for list in lists {
                all[next[list as usize] as usize] = item as u32;
                next[list as usize] += 1;
            }
        }
        Self { starts, items: all }
    }

    fn list(&self, index: u32) -> &[u32] {
        let [from, to] = [index, index + 1].map(|at| self.starts[at as usize] as usize);
        &self.items[from..to]
    }
}

impl CollisionMesh {
    /// Numbers the elements of all bodies. Leaves out triangles and edges that repeat a point or refer to a missing
    /// one.
    pub fn new(bodies: Vec<Body>) -> Self {
        let mut mesh = Self { first: vec![0], ..Self::default() };
        for (index, body) in bodies.iter().enumerate() {
            mesh.add(index as u32, body);
        }
        mesh.bodies = bodies;
        mesh.edges_at = Lists::new(mesh.body_of.len(), mesh.edges.iter().copied());
        mesh.faces_at = Lists::new(mesh.edges.len(), mesh.sides.iter().map(|sides| sides.map(|edge| edge.0)));
        mesh
    }

    fn add(&mut self, index: u32, body: &Body) {
        let first = self.body_of.len() as u32;
        let end = first + body.points as u32;
        self.body_of.resize(end as usize, index);
        self.first.push(end);
        let mut known: HashMap<[u32; 2], EdgeId> = HashMap::new();
        for triangle in &body.triangles {
            let [a, b, c] = triangle.map(|point| point + first);
            let whole = a != b && b != c && c != a;
            if whole && [a, b, c].iter().all(|&point| point < end) {
                self.triangles.push([a, b, c]);
                let sides = [[a, b], [b, c], [c, a]].map(|ends| self.edge(ends, &mut known));
                self.sides.push(sides);
            }
        }
        for [a, b] in body.edges.iter().map(|ends| ends.map(|point| point + first)) {
            if a != b && a.max(b) < end {
                self.edge([a, b], &mut known);
            }
        }
    }

    fn edge(&mut self, [a, b]: [u32; 2], known: &mut HashMap<[u32; 2], EdgeId>) -> EdgeId {
        let ends = [a.min(b), a.max(b)];
        *known.entry(ends).or_insert_with(|| {
            self.edges.push(ends);
            EdgeId(self.edges.len() as u32 - 1)
        })
    }

    /// The bodies.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Number of points of all bodies.
    pub fn points(&self) -> usize {
        self.body_of.len()
    }

    /// The points of a body.
    pub fn points_of(&self, body: usize) -> Range<usize> {
        self.first[body] as usize..self.first[body + 1] as usize
    }

    /// The body of a point.
    pub fn body_of(&self, point: u32) -> usize {
        self.body_of[point as usize] as usize
    }

    /// All edges, including those of triangles, each once.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// All triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The edges of a triangle.
    pub fn sides(&self, face: FaceId) -> [EdgeId; 3] {
        self.sides[face.0 as usize]
    }

    /// The edges at a point.
    pub fn edges_at(&self, point: u32) -> impl Iterator<Item = EdgeId> + '_ {
        self.edges_at.list(point).iter().map(|&edge| EdgeId(edge))
    }

    /// The triangles at an edge.
    pub fn faces_at(&self, edge: EdgeId) -> impl Iterator<Item = FaceId> + '_ {
        self.faces_at.list(edge.0).iter().map(|&face| FaceId(face))
    }

    /// The body of a point, and its index there.
    pub fn local(&self, point: u32) -> (usize, u32) {
        let body = self.body_of(point);
        (body, point - self.first[body])
    }
}

/// Which pairs of elements are tested. The default tests all.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CollisionFilter {
    ignored: Vec<[usize; 2]>,
    kinematic: Vec<bool>,
    permeable: Vec<bool>,
    /// By point: the point that stands for all that are welded together; empty without welds.
    clusters: Vec<u32>,
    /// By point: the exclusions that have it on their first and on their second side, as bits; empty without exclusions.
    sides: Vec<[u64; 2]>,
    /// The exclusions with everything, and the ground plane, on a side.
    everything: [u64; 2],
}

impl CollisionFilter {
    /// Excludes pairs between two bodies, or within one.
    pub fn ignore(&mut self, a: usize, b: usize) {
        let pair = [a.min(b), a.max(b)];
        if !self.ignored.contains(&pair) {
            self.ignored.push(pair);
        }
    }

    /// Whether pairs between two bodies, or within one, are tested.
    pub fn is_tested(&self, a: usize, b: usize) -> bool {
        !self.ignored.contains(&[a.min(b), a.max(b)])
    }

    /// Marks a point as kinematic: its motion is prescribed. Pairs of elements with kinematic points only are excluded,
    /// since no solver can separate them.
    pub fn set_kinematic(&mut self, point: usize) {
        if self.kinematic.len() <= point {
            self.kinematic.resize(point + 1, false);
        }
        self.kinematic[point] = true;
    }

    /// Marks a point as permeable: elements that have it may pass through others, and are not tested.
    pub fn set_permeable(&mut self, point: usize) {
        if self.permeable.len() <= point {
            self.permeable.resize(point + 1, false);
        }
        self.permeable[point] = true;
    }

    /// Joins two points: elements that have one each are neighbours, as if they shared a point.
    pub fn weld(&mut self, points: usize, a: usize, b: usize) {
        if self.clusters.len() < points {
            self.clusters.extend(self.clusters.len() as u32..points as u32);
        }
        let [a, b] = [self.clusters[a], self.clusters[b]];
        let (kept, lost) = (a.min(b), a.max(b));
        if kept != lost {
            self.clusters.iter_mut().filter(|cluster| **cluster == lost).for_each(|cluster| *cluster = kept);
        }
    }

    /// Puts points on a side (0 or 1) of an exclusion, by its number below 64: elements with all points on one side are not
    /// tested with those on the other.
    pub fn exclude(&mut self, points: usize, of_side: impl Iterator<Item = usize>, number: u32, side: usize) {
        self.sides.resize(self.sides.len().max(points), self.everything);
        of_side.for_each(|point| self.sides[point][side] |= 1 << number);
    }

    /// Puts all points and the ground planes on a side of an exclusion.
    pub fn exclude_everything(&mut self, points: usize, number: u32, side: usize) {
        self.sides.resize(self.sides.len().max(points), self.everything);
        self.everything[side] |= 1 << number;
        self.sides.iter_mut().for_each(|sides| sides[side] |= 1 << number);
    }

    /// Whether a point is not tested with the ground plane.
    pub(crate) fn is_free_of_ground(&self, point: usize) -> bool {
        self.is_kinematic(point)
            || self.is_permeable(point)
            || self.sides.get(point).is_some_and(|sides| meet(*sides, self.everything))
    }

    /// The exclusions that have all of these points on a side.
    fn sides_of(&self, points: &[u32]) -> [u64; 2] {
        let both = |all: [u64; 2], own: [u64; 2]| [all[0] & own[0], all[1] & own[1]];
        points.iter().fold([u64::MAX; 2], |all, &point| both(all, self.sides[point as usize]))
    }

    /// Whether elements with these points are not tested because a weld or an exclusion says so.
    pub fn excludes(&self, a: &[u32], b: &[u32]) -> bool {
        let cluster = |point: &u32| self.clusters[*point as usize];
        let are_joined = || a.iter().any(|p| b.iter().any(|q| cluster(p) == cluster(q)));
        !self.clusters.is_empty() && are_joined()
            || !self.sides.is_empty() && meet(self.sides_of(a), self.sides_of(b))
    }

    /// Whether a point is kinematic.
    pub(crate) fn is_kinematic(&self, point: usize) -> bool {
        self.kinematic.get(point).copied().unwrap_or(false)
    }

    fn is_permeable(&self, point: usize) -> bool {
        self.permeable.get(point).copied().unwrap_or(false)
    }

    /// Whether a pair of elements with these points is tested. Elements that share a point always touch there; their
    /// other neighbours show any further collision.
    pub(crate) fn apply<const A: usize, const B: usize>(
        &self,
        mesh: &CollisionMesh,
        a: &[u32; A],
        b: &[u32; B],
    ) -> bool {
        // Most candidates are neighbours in a mesh.
        if a.iter().any(|point| b.contains(point)) {
            return false;
        }
        let bodies = [mesh.body_of(a[0]), mesh.body_of(b[0])];
        let pair = [bodies[0].min(bodies[1]), bodies[0].max(bodies[1])];
        let is_kinematic = |point: &u32| self.is_kinematic(*point as usize);
        let are_permeable = a.iter().chain(b).any(|point| self.is_permeable(*point as usize));
        let are_kinematic = a.iter().all(is_kinematic) && b.iter().all(is_kinematic);
        !(are_kinematic || are_permeable || self.ignored.contains(&pair) || self.excludes(a, b))
    }

    /// The elements of bodies with at least one tested pair.
    pub(crate) fn active_elements<const N: usize>(
        &self,
        mesh: &CollisionMesh,
        elements: &[[u32; N]],
    ) -> Vec<u32> {
        let bodies = 0..mesh.bodies().len();
        let active_elements: Vec<bool> =
            bodies.clone().map(|body| bodies.clone().any(|other| self.is_tested(body, other))).collect();
        let is_concerned = |(_, points): &(u32, &[u32; N])| active_elements[mesh.body_of(points[0])];
        (0..).zip(elements).filter(is_concerned).map(|(index, _)| index).collect()
    }
}
/// Whether one is on the first side of an exclusion and the other on its second.
fn meet(a: [u64; 2], b: [u64; 2]) -> bool {
    (a[0] & b[1]) | (a[1] & b[0]) != 0
}
