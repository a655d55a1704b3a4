//! glTF 2.0 files, binary (`.glb`) or text with buffers beside it: triangle meshes, moved by their nodes, skins and
//! morph targets. Second 0 of the first animation is the first frame of the scene.

use std::path::Path;

use gltf::animation::Property;
use gltf::json::validation::Checked;
use gltf::mesh::Mode;
use gltf::{Document, Gltf, Node, Primitive, Semantic, buffer};
use nalgebra::{Matrix4, Vector3};
use nucleus_core::Faces;

use super::accessor::Buffers;
use super::deform::{Influences, transform};
use super::error::Fault;
use super::source::{Frames, Source};
use super::track::{Track, unit};
use crate::files;
use crate::memory::Size;
use crate::mesh::obj::CornerUvs;

/// An opened file.
pub(super) struct GltfFile {
    document: Document,
    buffers: Buffers,
    frames: Frames,
    /// All nodes of the scene with their parents, parents first.
    order: Vec<(usize, Option<usize>)>,
    /// Indices of the nodes whose meshes are read.
    chosen: Vec<usize>,
    tracks: Vec<(usize, Property, Track)>,
}

/// What animations have set of a node.
#[derive(Default, Clone)]
struct Pose {
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
    weights: Option<Vec<f64>>,
}

impl GltfFile {
    pub(super) fn open(path: &Path, object: &str, frames: Frames) -> Result<Self, Fault> {
        let bytes = files::read_all(path).map_err(Fault::Io)?;
        let Gltf { document, blob } = Gltf::from_slice(&bytes).map_err(|error| refusal(&error))?;
        let buffers = Buffers(read_buffers(path, &document, blob)?);
        let (order, chosen) = order(&document, object)?;
        let mut file = Self { document, buffers, frames, order, chosen, tracks: Vec::new() };
        if file.primitives().next().is_none() {
            return Err(match object {
                "" => "it has no triangle mesh".into(),
                _ => Fault::Malformed(format!("it has no node or mesh `{object}` with triangles")),
            });
        }
        file.tracks = file.read_tracks()?;
        Ok(file)
    }

    fn node(&self, index: usize) -> Node<'_> {
        self.document.nodes().nth(index).expect("nodes are numbered in order")
    }

    /// The triangle meshes with their nodes.
    fn primitives(&self) -> impl Iterator<Item = (Node<'_>, Primitive<'_>)> {
        let of = |index: &usize| {
            let node = self.node(*index);
            let primitives: Vec<_> = node.mesh().map(|mesh| mesh.primitives().collect()).unwrap_or_default();
            primitives.into_iter().map(move |primitive| (node.clone(), primitive))
        };
        self.chosen.iter().flat_map(of).filter(|(_, primitive)| primitive.mode() == Mode::Triangles)
    }

    fn read_tracks(&self) -> Result<Vec<(usize, Property, Track)>, Fault> {
        // The crate does not validate which property a channel animates.
        let animations = &self.document.as_json().animations;
        let mut channels = animations.iter().take(1).flat_map(|animation| &animation.channels);
        if channels.any(|channel| channel.target.path == Checked::Invalid) {
            return Err("an animation changes an unknown property".into());
        }
        let mut tracks = Vec::new();
        for channel in self.document.animations().take(1).flat_map(|animation| animation.channels()) {
            let sampler = channel.sampler();
            let times = self.buffers.numbers(&sampler.input())?;
            let values = self.buffers.numbers(&sampler.output())?;
            let track = Track::new(times, values, sampler.interpolation())
                .ok_or("the keys of an animation do not fit their times")?;
            tracks.push((channel.target().node().index(), channel.target().property(), track));
        }
        Ok(tracks)
    }

    fn vectors(&self, accessor: Option<gltf::Accessor>, fault: &str) -> Result<Vec<Vector3<f64>>, Fault> {
        let numbers = self.buffers.numbers(&accessor.ok_or_else(|| Fault::from(fault))?)?;
        Ok(numbers.chunks_exact(3).map(|p| Vector3::new(p[0], p[1], p[2])).collect())
    }

    /// The pose of each node at a time, by its index.
    fn poses(&self, time: f64) -> Vec<Pose> {
        let mut poses = vec![Pose::default(); self.document.nodes().len()];
        for (node, property, track) in &self.tracks {
            let pose = &mut poses[*node];
            let three = || track.at(time).first_chunk::<3>().copied();
            match property {
                Property::Translation => pose.translation = three(),
                Property::Scale => pose.scale = three(),
                Property::Rotation => pose.rotation = track.rotation_at(time),
                Property::MorphTargetWeights => pose.weights = Some(track.at(time)),
            }
        }
        poses
    }

    /// The matrix of each node to the world, by its index.
    fn worlds(&self, poses: &[Pose]) -> Vec<Matrix4<f64>> {
        let mut worlds = vec![Matrix4::identity(); poses.len()];
        for &(index, parent) in &self.order {
            let above = parent.map_or(Matrix4::identity(), |parent| worlds[parent]);
            worlds[index] = above * local(&self.node(index), &poses[index]);
        }
        worlds
    }

    /// The points of a primitive in the space of its mesh, with its morph targets.
    fn morphed(&self, node: &Node, primitive: &Primitive, pose: &Pose) -> Result<Vec<Vector3<f64>>, Fault> {
        let mut points = self.vectors(primitive.get(&Semantic::Positions), "a mesh has no positions")?;
        let given = |weights: &[f32]| weights.iter().copied().map(f64::from).collect();
        let own = || node.weights().or_else(|| node.mesh()?.weights()).map(given);
        let weights: Vec<f64> = pose.weights.clone().or_else(own).unwrap_or_default();
        for (target, weight) in primitive.morph_targets().zip(weights) {
            let Some(accessor) = target.positions().filter(|_| weight != 0.0) else { continue };
            let moved = self.vectors(Some(accessor), "")?;
            points.iter_mut().zip(moved).for_each(|(point, by)| *point += by * weight);
        }
        Ok(points)
    }

    fn influences(&self, primitive: &Primitive, points: usize, bones: usize) -> Result<Influences, Fault> {
        let read = |semantic: Semantic| match primitive.get(&semantic) {
            Some(accessor) => self.buffers.numbers(&accessor),
            None => Err(Fault::from("a skinned mesh has no joints or no weights")),
        };
        let joints = read(Semantic::Joints(0))?.into_iter().map(|joint| joint as u32).collect();
        Influences::new(joints, read(Semantic::Weights(0))?, points, bones)
            .ok_or_else(|| "the joints of a skinned mesh do not fit its points".into())
    }

    /// The matrix of each joint, from the mesh at rest to the world.
    fn bones(&self, skin: &gltf::Skin, worlds: &[Matrix4<f64>]) -> Result<Vec<Matrix4<f64>>, Fault> {
        let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
        let rest = match skin.inverse_bind_matrices() {
            Some(accessor) => self.buffers.numbers(&accessor)?,
            None => Matrix4::<f64>::identity().as_slice().repeat(joints.len()),
        };
        if rest.len() < 16 * joints.len() {
            return Err("a skin has fewer matrices than joints".into());
        }
        let bone = |(joint, rest): (&usize, &[f64])| worlds[*joint] * Matrix4::from_column_slice(rest);
        Ok(joints.iter().zip(rest.chunks_exact(16)).map(bone).collect())
    }
}

impl Source for GltfFile {
    fn size(&self) -> Size {
        let count = |accessor: Option<gltf::Accessor>| accessor.map_or(0, |accessor| accessor.count() as u64);
        self.primitives().fold(Size::default(), |size, (_, primitive)| {
            let points = count(primitive.get(&Semantic::Positions));
            let corners = primitive.indices().map_or(points, |indices| count(Some(indices)));
            Size { points: size.points.saturating_add(points), corners: size.corners.saturating_add(corners) }
        })
    }

    fn moves(&self) -> bool {
        !self.tracks.is_empty()
    }

    fn metres_per_unit(&self) -> Option<f64> {
        Some(1.0)
    }

    fn faces(&self, _frame: i64) -> Result<(Faces, Option<CornerUvs>), Fault> {
        let (mut faces, mut first) = (Faces::default(), 0);
        let mut uvs: Option<CornerUvs> = Some(CornerUvs::default());
        let worlds = self.worlds(&self.poses(0.0));
        for (node, primitive) in self.primitives() {
            let count = primitive.get(&Semantic::Positions).map_or(0, |accessor| accessor.count());
            let mut indices: Vec<u32> = match primitive.indices() {
                Some(accessor) => {
                    self.buffers.numbers(&accessor)?.into_iter().map(|index| index as u32).collect()
                }
                None => (0..count as u32).collect(),
            };
            if indices.iter().any(|index| *index as usize >= count) {
                return Err("a triangle refers to a vertex that does not exist".into());
            }
            // A mirror turns the winding of triangles (glTF 2.0, §3.7.4).
            if node.skin().is_none() && worlds[node.index()].determinant() < 0.0 {
                indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
            }
            for corners in indices.chunks_exact(3) {
                faces.push(&[first + corners[0], first + corners[1], first + corners[2]]);
            }
            // All primitives have texture coordinates, or none has.
            uvs = uvs.zip(primitive.get(&Semantic::TexCoords(0))).and_then(
                |((mut values, mut at), accessor)| {
                    let numbers = self.buffers.numbers(&accessor).ok()?;
                    // The first row of a picture is its top in glTF.
                    values.extend(numbers.chunks_exact(2).map(|uv| [uv[0], 1.0 - uv[1]]));
                    at.extend(indices.chunks_exact(3).flatten().map(|index| first + index));
                    Some((values, at))
                },
            );
            first = u32::try_from(first as usize + count).map_err(|_| "it has too many vertices")?;
        }
        Ok((faces, uvs))
    }

    fn positions(&self, frame: i64) -> Result<Vec<Vector3<f64>>, Fault> {
        let poses = self.poses((frame - self.frames.first) as f64 / self.frames.fps);
        let worlds = self.worlds(&poses);
        let mut all = Vec::new();
        for (node, primitive) in self.primitives() {
            let mut points = self.morphed(&node, &primitive, &poses[node.index()])?;
            match node.skin() {
                None => points.iter_mut().for_each(|point| *point = transform(&worlds[node.index()], point)),
                Some(skin) => {
                    let bones = self.bones(&skin, &worlds)?;
                    self.influences(&primitive, points.len(), bones.len())?.skin(&mut points, &bones);
                }
            }
            all.extend(points);
        }
        if all.iter().any(|point| !point.iter().all(|x| x.is_finite())) {
            return Err("a position is not a finite number".into());
        }
        Ok(all)
    }

    fn split_objects(&self) -> Vec<usize> {
        let mut counts: Vec<(usize, usize)> = Vec::new();
        for (node, primitive) in self.primitives() {
            let count = primitive.get(&Semantic::Positions).map_or(0, |accessor| accessor.count());
            match counts.last_mut() {
                Some((index, sum)) if *index == node.index() => *sum += count,
                _ => counts.push((node.index(), count)),
            }
        }
        counts.into_iter().map(|(_, count)| count).collect()
    }
}

/// Why the parser refuses a file. Its own message may hold parts of the file.
fn refusal(error: &gltf::Error) -> Fault {
    let is_extension = matches!(error, gltf::Error::Validation(errors)
        if errors.iter().any(|(_, error)| *error == gltf::json::validation::Error::Unsupported));
    match is_extension {
        true => "it needs an extension that is not read, such as mesh compression; export it without".into(),
        false => "it is no valid glTF file".into(),
    }
}

/// The bytes of each buffer: the binary part of the file, or a file beside it.
fn read_buffers(path: &Path, document: &Document, blob: Option<Vec<u8>>) -> Result<Vec<Vec<u8>>, Fault> {
    let mut blob = blob;
    let read = |buffer: gltf::Buffer| match buffer.source() {
        buffer::Source::Bin => Ok(blob.take().unwrap_or_default()),
        buffer::Source::Uri(uri) if uri.starts_with("data:") => {
            Err("its buffers are written in its text; save it as .glb".into())
        }
        buffer::Source::Uri(uri) => {
            let beside = path.with_file_name(decoded(uri));
            files::read_all(&beside).map_err(|source| Fault::Beside(beside, source))
        }
    };
    document.buffers().map(read).collect()
}

/// A URI without its percent encoding.
fn decoded(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let code =
            after.get(..2).and_then(|code| u8::from_str_radix(std::str::from_utf8(code).ok()?, 16).ok());
        match code.filter(|_| byte == b'%') {
            Some(code) => {
                bytes.push(code);
                rest = &after[2..];
            }
            None => {
                bytes.push(byte);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The nodes of the scene with their parents, parents first, and those with a mesh that belong to the object.
#[expect(clippy::type_complexity, reason = "used once")]
fn order(document: &Document, object: &str) -> Result<(Vec<(usize, Option<usize>)>, Vec<usize>), Fault> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let mut open: Vec<(Node, Option<usize>, bool)> = scene
        .into_iter()
        .flat_map(|scene| scene.nodes())
        .map(|node| (node, None, object.is_empty()))
        .collect();
    open.reverse();
    let mut is_seen = vec![false; document.nodes().len()];
    let (mut order, mut chosen) = (Vec::new(), Vec::new());
    while let Some((node, parent, above)) = open.pop() {
        let index = node.index();
        if std::mem::replace(&mut is_seen[index], true) {
            return Err("a node has two parents".into());
        }
        let names = [node.name(), node.mesh().and_then(|mesh| mesh.name())];
        let is_chosen = above || names.contains(&Some(object));
        let children: Vec<_> = node.children().collect();
        open.extend(children.into_iter().rev().map(|child| (child, Some(index), is_chosen)));
        order.push((index, parent));
        if is_chosen && node.mesh().is_some() {
            chosen.push(index);
        }
    }
    // A joint may stand outside the scene.
    order.extend((0..is_seen.len()).filter(|index| !is_seen[*index]).map(|index| (index, None)));
    Ok((order, chosen))
}

fn local(node: &Node, pose: &Pose) -> Matrix4<f64> {
    if pose.translation.is_none() && pose.rotation.is_none() && pose.scale.is_none() {
        return Matrix4::from_fn(|row, column| f64::from(node.transform().matrix()[column][row]));
    }
    let (translation, rotation, scale) = node.transform().decomposed();
    let translation = Vector3::from(pose.translation.unwrap_or(translation.map(f64::from)));
    let rotation = unit(pose.rotation.unwrap_or(rotation.map(f64::from)));
    let scale = Vector3::from(pose.scale.unwrap_or(scale.map(f64::from)));
    Matrix4::new_translation(&translation)
        * rotation.to_homogeneous()
        * Matrix4::new_nonuniform_scaling(&scale)
}
