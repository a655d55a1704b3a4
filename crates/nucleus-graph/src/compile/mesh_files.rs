//! Meshes of mesh nodes from their files, within the memory limit and in scene units.

use std::path::{Path, PathBuf};

use nucleus_core::Surface;

use crate::attributes::{mesh, nucleus};
use crate::diagnostic::{Diagnostic, Findings};
use crate::files;
use crate::graph::{Graph, Node, NodeId};
use crate::memory::{self, Budget, Cost, Size, TooLarge};
use crate::mesh::{FileMesh, Frames, MeshFile, MeshFormat, read_obj};
use crate::scene::document::Scene;

use super::animated_mesh::{NumberedFile, Points};

/// A mesh before any blend.
pub(super) struct Mesh {
    /// At the first frame.
    pub(super) surface: Surface,
    /// Points of each frame from the first frame of the scene on, where its file or files hold motion; else empty.
    pub(super) frames: Vec<Points>,
    /// Texture coordinates of each point from a file other than OBJ.
    pub(super) uvs: Option<Vec<Option<[f64; 2]>>>,
}

/// The mesh that a mesh node reads from its file: its surface at the first frame in scene units, and whether the file, or
/// a file per frame, moves it.
///
/// # Errors
/// When the file cannot be read, or exceeds the memory limit of the scene.
pub fn file_mesh(scene: &Scene, node: NodeId) -> Result<(Surface, bool), Vec<Diagnostic>> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    let read = read_files(scene, scene.graph.node(node), &mut scene.source.budget(), &mut findings);
    read.map(|mesh| (mesh.surface, !mesh.frames.is_empty())).ok_or_else(|| findings.in_order())
}

/// A mesh node whose file is being read.
struct Reading<'a> {
    scene: &'a Scene,
    node: &'a Node,
    budget: &'a mut Budget,
    findings: &'a mut Findings,
}

/// Reads the file of a mesh node, or one file per frame. `None` after an error, which is reported.
pub(super) fn read_files(
    scene: &Scene,
    node: &Node,
    budget: &mut Budget,
    findings: &mut Findings,
) -> Option<Mesh> {
    let file = node.get(&mesh::FILE);
    let mut reading = Reading { scene, node, budget, findings };
    let format = MeshFormat::of(&file);
    if file.is_empty() {
        let name = node.name();
        let error = reading.findings.error(&scene.source.place(name), format!("`{name}` has no `file`"));
        error.help("add `file: \"...\"`, an OBJ, PLY, glTF or USD file");
        return None;
    }
    if !format.holds_a_scene() && !node.get(&mesh::OBJECT).is_empty() {
        let message = format!("`object` of `{}` has no meaning for `{file}`, which is one mesh", node.name());
        reading.error(message, "remove `object`; a glTF or USD file holds several objects");
        return None;
    }
    match NumberedFile::new(&file) {
        None if format.holds_a_scene() => reading.animated(&file),
        None => {
            let read = reading.still(&file, scene.time.start)?;
            reading.claim(&read.surface)?;
            Some(Mesh { uvs: read.uvs_of_points(), surface: read.surface, frames: Vec::new() })
        }
        Some(_) if format == MeshFormat::Gltf => {
            let message = format!("`{}` names a glTF file for each frame", node.name());
            reading.error(message, "name one file: a glTF file holds its own animation");
            None
        }
        Some(numbered) => reading.sequence(&numbered),
    }
}

impl Reading<'_> {
    fn error(&mut self, message: String, help: &str) {
        let place = self.scene.source.place(&format!("{}.file", self.node.name()));
        let error = self.findings.error(&place, message);
        if !help.is_empty() {
            error.help(help);
        }
    }

    /// The path of a file, if there is memory to read it.
    fn path(&mut self, file: &str) -> Option<PathBuf> {
        let path = self.scene.source.path(file);
        if let Err(refused) = self.budget.check(files::length(&path).saturating_mul(memory::MESH_BYTE)) {
            let message = format!("to read `{}` takes {refused}", path.display());
            self.error(message, &refused.help("take a smaller file"));
            return None;
        }
        Some(path)
    }

    /// Claims memory for a mesh.
    fn claim(&mut self, surface: &Surface) -> Option<()> {
        let corners = surface.faces.corners().len() as u64;
        self.claim_size(Size { points: surface.positions.len() as u64, corners })
    }

    fn claim_size(&mut self, size: Size) -> Option<()> {
        let claimed = self.budget.claim(Cost::MESH.of(size));
        claimed.map_err(|refused| report_too_large(self.scene, self.node, &refused, self.findings)).ok()
    }

    /// Claims memory for a shape of a mesh with so many points.
    fn claim_shape(&mut self, points: usize) -> Option<()> {
        let claimed = self.budget.claim(points as u64 * memory::SHAPE_POINT);
        claimed.map_err(|refused| report_too_large(self.scene, self.node, &refused, self.findings)).ok()
    }

    fn report<T, E: std::fmt::Display>(&mut self, read: Result<T, E>) -> Option<T> {
        read.map_err(|error| self.error(error.to_string(), "")).ok()
    }

    /// The mesh of a file at a frame.
    fn still(&mut self, file: &str, frame: i64) -> Option<FileMesh> {
        let path = self.path(file)?;
        if MeshFormat::of(&path) == MeshFormat::Obj {
            let surface = self.report(read_obj(path))?;
            return Some(FileMesh { surface, uvs: None });
        }
        let opened = self.open(&path)?;
        let mut mesh = self.report(opened.mesh(frame))?;
        self.apply_scene_units(&opened, |scale| mesh.surface.positions.iter_mut().for_each(|p| *p *= scale))?;
        Some(mesh)
    }

    fn open(&mut self, path: &Path) -> Option<MeshFile> {
        let frames = frames_of(self.scene);
        let opened = MeshFile::open(path, &self.node.get(&mesh::OBJECT), frames);
        self.report(opened)
    }

    /// Passes the scale from units of the file to scene units, if the file states its unit.
    fn apply_scene_units(&mut self, file: &MeshFile, scale: impl FnOnce(f64)) -> Option<()> {
        let Some(metres) = file.metres_per_unit() else { return Some(()) };
        match metres_per_scene_unit(&self.scene.graph) {
            Some(scene) => scale(metres / scene),
            None => {
                let message = format!(
                    "`{}` is read in metres, but the nuclei differ in `spaceScale`",
                    self.node.name()
                );
                self.error(message, "give the mesh as OBJ or PLY, whose numbers are scene units");
                return None;
            }
        }
        Some(())
    }

    /// The mesh of a file that holds its motion.
    fn animated(&mut self, file: &str) -> Option<Mesh> {
        let path = self.path(file)?;
        let opened = self.open(&path)?;
        self.claim_size(opened.size())?;
        let time = self.scene.time;
        let mut mesh = self.report(opened.mesh(time.start))?;
        let points = mesh.surface.positions.len();
        let mut frames = Vec::new();
        for frame in (time.start..=time.end).filter(|_| opened.moves()) {
            self.claim_shape(points)?;
            frames.push(self.report(opened.positions(frame))?);
            self.check_count(points, frames[frames.len() - 1].len(), frame)?;
        }
        opened.merge_split_points(&mut mesh.surface, &mut frames);
        let uvs = mesh.uvs_of_points();
        self.apply_scene_units(&opened, |scale| {
            let all = frames.iter_mut().flatten().chain(&mut mesh.surface.positions);
            all.for_each(|point| *point *= scale);
        })?;
        let frames = frames.into_iter().map(Points::from).collect();
        Some(Mesh { surface: mesh.surface, frames, uvs })
    }

    /// The mesh of a file per frame.
    fn sequence(&mut self, numbered: &NumberedFile<'_>) -> Option<Mesh> {
        let time = self.scene.time;
        let FileMesh { surface, uvs } = self.still(&numbered.at(time.start), time.start)?;
        let points = surface.positions.len();
        let mut frames: Vec<Points> = vec![surface.positions.as_slice().into()];
        for frame in time.start + 1..=time.end {
            self.claim_shape(points)?;
            let now = self.still(&numbered.at(frame), frame)?.surface.positions;
            self.check_count(points, now.len(), frame)?;
            frames.push(now.into());
        }
        let mesh = FileMesh { surface, uvs };
        Some(Mesh { uvs: mesh.uvs_of_points(), surface: mesh.surface, frames })
    }

    fn check_count(&mut self, first: usize, now: usize, frame: i64) -> Option<()> {
        if first == now {
            return Some(());
        }
        let (name, start) = (self.node.name(), self.scene.time.start);
        let message = format!("`{name}` has {first} points at frame {start}, but {now} at frame {frame}");
        self.error(message, "a mesh keeps its points from frame to frame");
        None
    }
}

/// Reports a mesh that exceeds the memory limit.
pub(super) fn report_too_large(scene: &Scene, node: &Node, refused: &TooLarge, findings: &mut Findings) {
    if !refused.is_first {
        return;
    }
    let name = node.name();
    let error = findings.error(&scene.source.place(name), format!("the mesh `{name}` takes {refused}"));
    error.help(refused.help("make it coarser"));
}

/// The frames of a scene, at which files with motion are sampled.
pub(super) fn frames_of(scene: &Scene) -> Frames {
    Frames { first: scene.time.start, fps: scene.time.fps }
}

/// The `spaceScale` of all nuclei; `None` if they differ.
fn metres_per_scene_unit(graph: &Graph) -> Option<f64> {
    let mut scales = graph.of_type(&nucleus::NUCLEUS).map(|(_, node)| node.get(&nucleus::SPACE_SCALE));
    let first = scales.next().unwrap_or(1.0);
    scales.all(|scale| scale == first).then_some(first)
}
