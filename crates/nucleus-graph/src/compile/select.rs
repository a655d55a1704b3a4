//! Selections of elements: by number, by border, and by meaning.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Vector3;
use nucleus_core::Faces;

use crate::attributes::{ElementKind, Which, n_component, read_which};
use crate::graph::NodeId;
use crate::paint::{Expression, Point, Texture};

use super::compiler::Compiler;
use super::face_sets;
use super::geometry::file_of;

/// The elements of a mesh that can be selected.
pub(super) struct Elements<'a> {
    pub(super) faces: &'a Faces,
    pub(super) points: usize,
    /// Each edge once, in the order in which faces name them, with the number of its faces.
    edges: Vec<([u32; 2], u32)>,
    /// The corners of its first face behind the ends of each edge.
    behind: Vec<[u32; 2]>,
}

impl<'a> Elements<'a> {
    pub(super) fn new(faces: &'a Faces, points: usize) -> Self {
        let mut found: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let mut edges: Vec<([u32; 2], u32)> = Vec::new();
        let mut behind = Vec::new();
        for face in faces.iter() {
            for (k, &a) in face.iter().enumerate() {
                let b = face[(k + 1) % face.len()];
                let at = *found.entry([a.min(b), a.max(b)]).or_insert(edges.len());
                if at == edges.len() {
                    edges.push(([a, b], 0));
                    behind.push([face[(k + face.len() - 1) % face.len()], face[(k + 2) % face.len()]]);
                }
                edges[at].1 += 1;
            }
        }
        Self { faces, points, edges, behind }
    }

    pub(super) fn count(&self, kind: ElementKind) -> usize {
        match kind {
            ElementKind::Point => self.points,
            ElementKind::Edge => self.edges.len(),
            ElementKind::Face => self.faces.len(),
        }
    }

    /// The points of an element.
    pub(super) fn corners(&self, kind: ElementKind, at: u32) -> Vec<u32> {
        match kind {
            ElementKind::Point => vec![at],
            ElementKind::Edge => self.edges[at as usize].0.to_vec(),
            ElementKind::Face => self.faces.face(at as usize).to_vec(),
        }
    }

    /// The corners of a face behind the ends of an edge; `None` where they are the ends themselves.
    pub(super) fn behind(&self, edge: u32) -> Option<[u32; 2]> {
        let (ends, corners) = (self.edges[edge as usize].0, self.behind[edge as usize]);
        (!corners.iter().any(|corner| ends.contains(corner))).then_some(corners)
    }

    /// The elements for which all points are selected.
    fn all_of(&self, kind: ElementKind, points: &[bool]) -> Vec<u32> {
        let is_in = |at: &u32| self.corners(kind, *at).iter().all(|&point| points[point as usize]);
        (0..self.count(kind) as u32).filter(is_in).collect()
    }

    pub(super) fn border(&self, kind: ElementKind) -> Vec<u32> {
        let is_border = |edge: &&([u32; 2], u32)| edge.1 == 1;
        if kind == ElementKind::Edge {
            let edges = (0..).zip(&self.edges).filter(|(_, edge)| is_border(edge));
            return edges.map(|(at, _)| at).collect();
        }
        let mut points = vec![false; self.points];
        let ends = self.edges.iter().filter(is_border).flat_map(|(edge, _)| edge);
        ends.for_each(|&point| points[point as usize] = true);
        match kind {
            ElementKind::Face => self.any_of(kind, &points),
            _ => self.all_of(kind, &points),
        }
    }

    /// Each point with the other ends of the border edges at it, or of all edges where it is on no border; sorted.
    pub(super) fn spans(&self) -> Vec<[u32; 2]> {
        let mut is_on_border = vec![false; self.points];
        let border = self.edges.iter().filter(|edge| edge.1 == 1);
        border.for_each(|(ends, _)| ends.iter().for_each(|&end| is_on_border[end as usize] = true));
        let both = |&([a, b], faces): &([u32; 2], u32)| [([a, b], faces), ([b, a], faces)];
        let counts = |&([point, _], faces): &([u32; 2], u32)| faces == 1 || !is_on_border[point as usize];
        let mut spans: Vec<[u32; 2]> =
            self.edges.iter().flat_map(both).filter(counts).map(|(span, _)| span).collect();
        spans.sort_unstable();
        spans
    }

    fn any_of(&self, kind: ElementKind, points: &[bool]) -> Vec<u32> {
        let is_in = |at: &u32| self.corners(kind, *at).iter().any(|&point| points[point as usize]);
        (0..self.count(kind) as u32).filter(is_in).collect()
    }

    fn corners_of_border(&self, kind: ElementKind) -> Vec<u32> {
        let mut faces = vec![0u32; self.points];
        self.faces.corners().iter().for_each(|&point| faces[point as usize] += 1);
        let mut corners = vec![false; self.points];
        self.border(ElementKind::Point)
            .into_iter()
            .filter(|&point| faces[point as usize] == 1)
            .for_each(|point| corners[point as usize] = true);
        self.any_of(kind, &corners)
    }
}

/// The mesh of a selection, for values per point and for messages.
pub(super) struct Selected {
    /// The constraint, or another node that names the elements.
    pub(super) owner: NodeId,
    pub(super) object: NodeId,
    pub(super) mesh: NodeId,
}

impl Compiler<'_> {
    /// The elements of a component node, each once, in the order in which they are named. Reports those that are not
    /// there, and selections without any.
    pub(super) fn selected(
        &mut self,
        of: &Selected,
        component: NodeId,
        elements: &Elements<'_>,
    ) -> (ElementKind, Vec<u32>) {
        let node = self.scene.graph.node(component);
        let kind = match node.get(&n_component::COMPONENT_TYPE) {
            n_component::EDGE => ElementKind::Edge,
            n_component::FACE => ElementKind::Face,
            _ => ElementKind::Point,
        };
        let which = node.get(&n_component::ELEMENTS);
        if which == n_component::ALL || node.get(&n_component::COMPONENT_TYPE) == n_component::OBJECT {
            return (kind, (0..elements.count(kind) as u32).collect());
        }
        let mut found: Vec<u32> = Vec::new();
        if which == n_component::BORDERS {
            found.extend(elements.border(kind));
        }
        let listed = node.get(&n_component::COMPONENT_INDICES);
        let count = elements.count(kind) as u32;
        if let Some(missing) = listed.iter().find(|&&at| at >= count) {
            let help = match count {
                0 => format!("it has no {}s", kind.noun()),
                _ => format!("its {}s are numbered 0 to {}", kind.noun(), count - 1),
            };
            self.refuse_selection(of, &format!("has no {} {missing}", kind.noun()), &help);
        }
        found.extend(listed.into_iter().filter(|&at| at < count));
        let meanings = node.get(&n_component::SELECT);
        for text in meanings.split(';').map(str::trim).filter(|text| !text.is_empty()) {
            let before = found.len();
            let chosen = match read_which(kind, text) {
                Ok(which) => self.chosen(of, kind, &which, elements),
                Err(message) => Err(message),
            };
            match chosen {
                Ok(chosen) => found.extend(chosen),
                Err(message) => self.refuse_selection(of, &format!("cannot select `{text}`: {message}"), ""),
            }
            if found.len() == before && self.findings.errors() == 0 {
                let message = format!("has no {}s in `{text}`", kind.noun());
                let help = match text.contains("where(") {
                    true => {
                        "x, y and z are places in the space of the mesh, before its transform; `nucleus info --points` \
                         lists what is selected"
                    }
                    false => "`nucleus info --points` lists what is selected",
                };
                self.refuse_selection(of, &message, help);
            }
        }
        let mut seen = BTreeSet::new();
        found.retain(|at| seen.insert(*at));
        (kind, found)
    }

    fn refuse_selection(&mut self, of: &Selected, message: &str, help: &str) {
        let graph = &self.scene.graph;
        let [owner, object] = [of.owner, of.object].map(|id| graph.node(id).name());
        let place = self.scene.source.place(&format!("{owner}.components"));
        let error = self.findings.error(&place, format!("`{owner}`: `{object}` {message}"));
        if !help.is_empty() {
            error.help(help);
        }
    }

    /// The elements of one selection, or why there are none.
    pub(super) fn chosen(
        &mut self,
        of: &Selected,
        kind: ElementKind,
        which: &Which,
        elements: &Elements<'_>,
    ) -> Result<Vec<u32>, String> {
        match which {
            Which::All => Ok((0..elements.count(kind) as u32).collect()),
            Which::Range(first, last) => {
                let count = elements.count(kind) as u32;
                if *last >= count {
                    return Err(format!("there is no {} {last}", kind.noun()));
                }
                Ok((*first..=*last).collect())
            }
            Which::Border => Ok(elements.border(kind)),
            Which::Corners => Ok(elements.corners_of_border(kind)),
            Which::Where(text) => {
                let points = self.points_where(of, text, elements.points)?;
                Ok(elements.all_of(kind, &points))
            }
            Which::Mask(file) => {
                let texture =
                    Texture::read(&self.scene.source.path(file)).map_err(|error| error.to_string())?;
                let uvs = self.uvs_of(of)?;
                let points: Vec<bool> = uvs.into_iter().map(|uv| texture.at(uv) > 0.5).collect();
                Ok(elements.all_of(kind, &points))
            }
            Which::Group(name) => self.group(of, name, kind, elements),
        }
    }

    /// Whether each point satisfies an expression, at the start.
    fn points_where(&mut self, of: &Selected, text: &str, count: usize) -> Result<Vec<bool>, String> {
        let expression = Expression::parse(text).map_err(|error| error.to_string())?;
        let uvs = if expression.needs_uv() { Some(self.uvs_of(of)?) } else { None };
        let positions: Vec<Vector3<f64>> = match of.mesh == of.object {
            true => self.start_positions_of(of.object),
            false => {
                let animated = self.geometry.animated(self.scene, of.mesh, self.findings);
                animated.ok_or("its mesh cannot be read")?.at(&self.start).to_vec()
            }
        };
        let point = |(index, position): (usize, &Vector3<f64>)| Point {
            position: (*position).into(),
            uv: uvs.as_ref().and_then(|uvs| uvs.get(index)).copied().unwrap_or_default(),
            index,
            count,
        };
        let value = |each| expression.at(&point(each));
        Ok(positions.iter().take(count).enumerate().map(|each| value(each) != 0.0).collect())
    }

    fn start_positions_of(&self, object: NodeId) -> Vec<Vector3<f64>> {
        let positions = self.cloth_of(object).map(|cloth| self.program.model.positions(cloth));
        positions.unwrap_or_default().iter().map(|point| self.program.units.scene_point(*point)).collect()
    }

    fn uvs_of(&mut self, of: &Selected) -> Result<Vec<[f64; 2]>, String> {
        let mesh = self.scene.graph.node(of.mesh).name();
        let uvs = self.geometry.uvs(self.scene, of.mesh).map_err(|error| error.to_string())?;
        let uvs = uvs.ok_or_else(|| format!("`{mesh}` has no texture coordinates"))?;
        let missing = |point| format!("point {point} of `{mesh}` has no texture coordinates");
        uvs.into_iter().enumerate().map(|(point, uv)| uv.ok_or_else(|| missing(point))).collect()
    }

    /// The elements of a group of the object's OBJ file.
    fn group(
        &mut self,
        of: &Selected,
        name: &str,
        kind: ElementKind,
        elements: &Elements<'_>,
    ) -> Result<Vec<u32>, String> {
        let mesh = self.scene.graph.node(of.mesh);
        let file = file_of(self.scene, self.scene.graph.node(of.mesh));
        let file = file.ok_or_else(|| format!("`{}` is not read from a file", mesh.name()))?;
        let sets =
            face_sets::of_mesh(self.scene, mesh, elements.faces.len()).map_err(|error| error.to_string())?;
        let sets = sets.unwrap_or_default();
        let Some(set) = sets.group(name) else {
            let mut names: Vec<&String> = sets.groups.iter().map(|set| &set.name).collect();
            names.sort_unstable();
            return Err(match names.as_slice() {
                [] => format!("`{file}` has no groups"),
                names => format!("`{file}` has no group `{name}`, but {}", crate::diagnostic::listed(names)),
            });
        };
        let mut points = vec![false; elements.points];
        let corners = set.faces.iter().flat_map(|&face| elements.faces.face(face as usize));
        corners.for_each(|&point| points[point as usize] = true);
        Ok(match kind {
            ElementKind::Face => set.faces.clone(),
            _ => elements.all_of(kind, &points),
        })
    }
}
