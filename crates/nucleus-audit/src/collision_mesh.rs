//! The collision mesh: all bodies with their edges and triangles.

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
