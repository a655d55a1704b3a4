//! A polygon mesh: points, faces, edges in Maya's order, and texture coordinates.

use std::collections::HashMap;

use crate::ascii::Values;
use crate::omissions::Cause;

/// A polygon mesh. Lengths in centimetres.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Poly {
    /// The points.
    pub points: Vec<[f64; 3]>,
    /// One after the last corner of each face.
    pub ends: Vec<u32>,
    /// The points of the corners of all faces.
    pub corners: Vec<u32>,
    /// Edges in Maya's order where that is known; else empty.
    pub stored_edges: Vec<[u32; 2]>,
    /// Texture coordinates.
    pub uvs: Vec<[f64; 2]>,
    /// The texture coordinate of each corner; empty if there are none.
    pub uv_corners: Vec<u32>,
}

/// A mesh, and what its history left out.
#[derive(Debug, Clone, Default)]
pub struct Built {
    /// The mesh in the space of the shape, in centimetres.
    pub mesh: Poly,
    /// Nodes that were passed over, and why.
    pub omitted: Vec<(String, Cause)>,
    /// Whether a deformer or a driven number acts on it, so that it may change from frame to frame.
    pub is_deformed: bool,
}

impl Poly {
    /// Adds a face.
    pub fn face(&mut self, points: &[u32]) {
        self.corners.extend_from_slice(points);
        self.ends.push(self.corners.len() as u32);
    }

    /// How many faces it has.
    pub fn face_count(&self) -> usize {
        self.ends.len()
    }

    /// The points that it counts for in a budget: a face of four corners weighs as much as a point, since a mesh of quads
    /// has about as many.
    pub(crate) fn weight(&self) -> u64 {
        self.points.len().max(self.corners.len() / 4) as u64
    }

    /// The points of a face.
    pub fn points_of(&self, face: usize) -> &[u32] {
        let start = if face == 0 { 0 } else { self.ends[face - 1] as usize };
        &self.corners[start..self.ends[face] as usize]
    }

    /// All faces.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.face_count()).map(|face| self.points_of(face))
    }

    /// The edges: as stored, else in the order in which the faces name them.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        if !self.stored_edges.is_empty() {
            return self.stored_edges.clone();
        }
        let mut seen = HashMap::new();
        let mut edges = Vec::new();
        for face in self.faces() {
            for (a, b) in sides(face) {
                seen.entry((a.min(b), a.max(b))).or_insert_with(|| edges.push([a, b]));
            }
        }
        edges
    }

    /// The same mesh without what only holds for its present topology.
    pub fn reshaped(points: Vec<[f64; 3]>) -> Self {
        Self { points, ..Self::default() }
    }

    /// The normal of a face, not of unit length (Newell's method).
    pub fn normal(&self, face: usize) -> [f64; 3] {
        let mut normal = [0.0; 3];
        for (a, b) in sides(self.points_of(face)) {
            let [a, b] = [a, b].map(|point| self.points[point as usize]);
            for k in 0..3 {
                let [i, j] = [(k + 1) % 3, (k + 2) % 3];
                normal[k] += (a[i] - b[i]) * (a[j] + b[j]);
            }
        }
        normal
    }

    /// Drops points that no face has, and numbers the rest anew.
    pub fn without_unused_points(&mut self) {
        let mut used = vec![false; self.points.len()];
        self.corners.iter().for_each(|point| used[*point as usize] = true);
        let mut number = vec![0; self.points.len()];
        let mut kept = 0;
        for (point, used) in used.iter().enumerate() {
            number[point] = kept;
            kept += u32::from(*used);
        }
        let mut keep = used.iter();
        self.points.retain(|_| *keep.next().unwrap_or(&false));
        self.corners.iter_mut().for_each(|point| *point = number[*point as usize]);
        self.stored_edges.clear();
    }
}

/// The sides of a face, from each corner to the next.
pub(super) fn sides(face: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    face.iter().copied().zip(face.iter().copied().cycle().skip(1)).take(face.len())
}

/// A list of components: `-type "componentList" 2 "f[0:3]" "f[7]"`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Components {
    /// Kinds (`f`, `vtx`, `e`) with their first and last number; `None` means all.
    ranges: Vec<(String, Option<(u32, u32)>)>,
}

impl Components {
    /// The list of a value.
    pub fn of(values: &Values) -> Self {
        let range = |text: String| {
            let (kind, index) = text.split_once('[')?;
            let index = index.strip_suffix(']')?;
            if index == "*" || index == ":" {
                return Some((kind.to_owned(), None));
            }
            let (first, last) = index.split_once(':').unwrap_or((index, index));
            Some((kind.to_owned(), Some((first.parse().ok()?, last.parse().ok()?))))
        };
        Self { ranges: values.strings().filter_map(range).collect() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// Whether it has components of other kinds than this one.
    pub fn has_other_than(&self, kind: &str) -> bool {
        self.ranges.iter().any(|(own, _)| own != kind)
    }

    /// Which of `count` elements of a kind it has.
    pub fn flags(&self, kind: &str, count: usize) -> Vec<bool> {
        let mut flags = vec![false; count];
        for (_, range) in self.ranges.iter().filter(|(own, _)| own == kind) {
            let (first, last) = range.map_or((0, count), |(first, last)| (first as usize, last as usize + 1));
            if let Some(part) = flags.get_mut(first.min(count)..last.min(count)) {
                part.fill(true);
            }
        }
        flags
    }

    /// The numbers of a kind in the order of the list, of elements below `count`.
    pub fn numbers(&self, kind: &str, count: usize) -> impl Iterator<Item = u32> {
        let own = self.ranges.iter().filter(move |(own, _)| own == kind);
        let range = move |range: Option<(u32, u32)>| range.unwrap_or((0, count.saturating_sub(1) as u32));
        own.flat_map(move |(_, r)| {
            let (first, last) = range(*r);
            first..last.saturating_add(1).min(count as u32)
        })
    }
}
