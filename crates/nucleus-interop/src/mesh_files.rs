//! Mesh files, one for each object and time sample: Wavefront OBJ as text, PLY as binary.

use std::collections::HashSet;
use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{FaceSets, LiquidSurface, ObjectInfo, TextureCoordinates};
use nucleus_core::{Faces, Particle};

use crate::clip::{Clip, PARTICLE_FACTS, Sample};
use crate::error::ExportError;
use crate::materials::{Material, Materials};
use crate::output::{OutFile, Output, file_names};

/// Writes `<object>.<frame>.obj` into a folder.
pub(crate) fn write_obj<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    write_obj_materials(clip, folder, output)?;
    each_file(clip, folder, "obj", output, progress, |file, mesh| {
        file.text(format!("mtllib {OBJ_MATERIALS}\n"));
        write_obj_mesh(file, mesh.object, &mesh.positions, mesh.uvs.as_ref(), mesh.sets.as_ref());
    })
}

/// The file of the materials beside the meshes.
const OBJ_MATERIALS: &str = "materials.mtl";

/// Writes the materials, each name once.
fn write_obj_materials<R: Read + Seek>(
    clip: &Clip<R>,
    folder: &Path,
    output: &mut Output,
) -> Result<(), ExportError> {
    let mut file = output.file(folder.join(OBJ_MATERIALS))?;
    let mut written = HashSet::new();
    for Material { name, colour: [red, green, blue] } in Materials::of(clip).all {
        let name = obj_name(&name);
        if written.insert(name.clone()) {
            file.text(format!("newmtl {name}\nKd {red} {green} {blue}\nillum 1\n"));
        }
    }
    output.finish(file)
}

/// A line break in a name would begin a statement.
fn obj_name(name: &str) -> String {
    name.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect()
}

/// An object at a sample.
struct MeshSample<'a> {
    object: &'a ObjectInfo,
    positions: Vec<[f32; 3]>,
    uvs: Option<TextureCoordinates>,
    sets: Option<FaceSets>,
    velocities: Option<Vec<[f32; 3]>>,
    particles: Option<Vec<Particle>>,
}

/// Writes a file per object and sample.
fn each_file<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    end: &str,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
    mut write: impl FnMut(&mut OutFile, &MeshSample),
) -> Result<(), ExportError> {
    let names = file_names(clip.objects().map(|object| object.name.as_str()));
    for sample in 0..clip.samples().len() {
        let frame = numbered(clip.samples(), sample);
        for (object, name) in names.iter().enumerate() {
            let mut file = output.file(folder.join(format!("{name}.{frame}.{end}")))?;
            if let Some((LiquidSurface { positions, quads }, velocities)) = clip.surface(object, sample)? {
                let mut faces = Faces::default();
                quads.iter().for_each(|quad| faces.push(quad));
                let object = ObjectInfo { faces, ..clip.object(object).clone() };
                let object = &object;
                let (uvs, sets, particles) = (None, None, None);
                let mesh = MeshSample { object, positions, uvs, sets, velocities, particles };
                write(&mut file, &mesh);
                output.finish(file)?;
                continue;
            }
            let positions = clip.positions(object, sample)?;
            let uvs = clip.texture_coordinates_at(object, sample)?;
            let sets = clip.face_sets_at(object, sample)?;
            let (velocities, particles) = (clip.velocities(object, sample)?, clip.particles(object, sample)?);
            let object = clip.object_at(object, sample)?;
            write(&mut file, &MeshSample { object, positions, uvs, sets, velocities, particles });
            output.finish(file)?;
        }
        progress((sample + 1) as f64 / clip.samples().len() as f64);
    }
    Ok(())
}

/// `0012` for the end of frame 12, `0012_02of10` for 2/10 of a frame after it: from frame 0 on, file names sort in order of
/// time.
pub(crate) fn numbered(samples: &[Sample], index: usize) -> String {
    let sample = &samples[index];
    if sample.ends_frame() {
        return format!("{:04}", sample.frame);
    }
    let parts = i64::from(parts_of_frame(samples, index));
    let time = (sample.frame_time * parts as f64).round() as i64;
    let (frame, part, digits) = (time.div_euclid(parts), time.rem_euclid(parts), parts.to_string().len());
    if part == 0 { format!("{frame:04}") } else { format!("{frame:04}_{part:0digits$}of{parts}") }
}

/// The least number of equal parts of a frame of which each sample in it ends one: the substeps, or with solvers of 2 and of 3
/// substeps, 6. Millionths where there is none below 1000.
fn parts_of_frame(samples: &[Sample], index: usize) -> u32 {
    let is_near = |sample: &&Sample| sample.frame == samples[index].frame;
    let (before, after) = samples.split_at(index);
    let own = || before.iter().rev().take_while(is_near).chain(after.iter().take_while(is_near));
    let are_whole = |parts: &u32| {
        let parts = f64::from(*parts);
        // Times in a cache are whole nanoseconds.
        own().map(|sample| sample.frame_time).all(|time| (time - (time * parts).round() / parts).abs() < 1e-6)
    };
    (1..1000).find(are_whole).unwrap_or(1_000_000)
}

/// Writes an object as OBJ with these positions, points without faces included; Blender keeps such points when it imports PLY, and
/// drops them when it imports OBJ. Faces stay in their order, so a group or a material is named as often as it begins anew;
/// faces without a material have that of the object.
pub(crate) fn write_obj_mesh(
    file: &mut OutFile,
    object: &ObjectInfo,
    positions: &[[f32; 3]],
    uvs: Option<&TextureCoordinates>,
    sets: Option<&FaceSets>,
) {
    let name = obj_name(&object.name);
    file.text(format!("o {name}\n"));
    for [x, y, z] in positions {
        file.text(format!("v {x} {y} {z}\n"));
    }
    for [u, v] in uvs.map_or(&[][..], |uvs| &uvs.values) {
        file.text(format!("vt {u} {v}\n"));
    }
    let statements = SetStatements::new(sets, object.faces.len(), &name);
    let mut next = 0;
    for (index, face) in object.faces.iter().enumerate() {
        file.text(statements.before(index));
        let corner = |(k, point): (usize, &u32)| match uvs {
            None => (point + 1).to_string(),
            Some(uvs) => {
                let uv = uvs.corners.get(next + k).unwrap_or(point);
                format!("{}/{}", point + 1, uv + 1)
            }
        };
        let corners: Vec<String> = face.iter().enumerate().map(corner).collect();
        file.text(format!("f {}\n", corners.join(" ")));
        next += face.len();
    }
    if object.faces.is_empty() {
        file.text(format!("usemtl {name}\n"));
        (1..=positions.len()).for_each(|point| file.text(format!("p {point}\n")));
    }
}

/// The `g` and `usemtl` statements before the faces of a mesh.
struct SetStatements<'a> {
    sets: Option<&'a FaceSets>,
    /// The name of the object: the material of faces without one.
    own: &'a str,
    groups: Vec<Vec<usize>>,
    materials: Vec<Option<usize>>,
}

impl<'a> SetStatements<'a> {
    fn new(sets: Option<&'a FaceSets>, faces: usize, own: &'a str) -> Self {
        Self {
            sets,
            own,
            groups: sets.map_or(vec![Vec::new(); faces], |sets| sets.groups_of_faces(faces)),
            materials: sets.map_or(vec![None; faces], |sets| sets.material_of_faces(faces)),
        }
    }

    /// Those before a face, where it differs from the face before it.
    fn before(&self, face: usize) -> String {
        let mut text = String::new();
        let groups = &self.groups[face];
        let before = face.checked_sub(1).map(|before| &self.groups[before]);
        if before.map_or(!groups.is_empty(), |before| before != groups) {
            let names = groups.iter().filter_map(|place| Some(obj_name(&self.sets?.groups[*place].name)));
            let names: Vec<String> = names.collect();
            // The name of the format for faces in no group.
            text += &format!("g {}\n", if names.is_empty() { "default".to_owned() } else { names.join(" ") });
        }
        let material = self.materials[face];
        if face == 0 || self.materials[face - 1] != material {
            let name = material.zip(self.sets).map(|(place, sets)| obj_name(&sets.materials[place].name));
            text += &format!("usemtl {}\n", name.as_deref().unwrap_or(self.own));
        }
        text
    }
}

/// Writes `<object>.<frame>.ply` into a folder.
pub(crate) fn write_ply<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    each_file(clip, folder, "ply", output, progress, write_ply_mesh)
}

/// Values of the vertices of a PLY file.
struct VertexProperty {
    /// `float x`
    declaration: String,
    /// Bytes of a value.
    size: usize,
    bytes: Vec<u8>,
}

impl VertexProperty {
    fn floats(name: &str, values: impl Iterator<Item = f32>) -> Self {
        let bytes = values.flat_map(f32::to_le_bytes).collect();
        Self { declaration: format!("float {name}"), size: 4, bytes }
    }

    /// The numbers of particles; as `double` where 32 bits do not hold them, because PLY has no longer integer.
    fn ids(particles: &[Particle]) -> Self {
        let ids = particles.iter().map(|particle| particle.id);
        match ids.clone().map(u32::try_from).collect::<Result<Vec<u32>, _>>() {
            Ok(ids) => Self {
                declaration: "uint id".to_owned(),
                size: 4,
                bytes: ids.into_iter().flat_map(u32::to_le_bytes).collect(),
            },
            Err(_) => Self {
                declaration: "double id".to_owned(),
                size: 8,
                bytes: ids.flat_map(|id| (id as f64).to_le_bytes()).collect(),
            },
        }
    }
}

/// Positions, velocities, texture coordinates and the numbers of particles, as far as an object has them.
fn vertex_properties(mesh: &MeshSample) -> Vec<VertexProperty> {
    let vectors = |names: [&'static str; 3], all: &[[f32; 3]]| {
        let column = |(axis, name)| VertexProperty::floats(name, all.iter().map(|vector| vector[axis]));
        names.into_iter().enumerate().map(column).collect::<Vec<_>>()
    };
    let mut all = vectors(["x", "y", "z"], &mesh.positions);
    all.extend(mesh.velocities.iter().flat_map(|velocities| vectors(["vx", "vy", "vz"], velocities)));
    if let Some(uvs) = mesh.uvs.as_ref().filter(|uvs| uvs.corners.is_empty()) {
        all.extend(
            [("s", 0), ("t", 1)]
                .map(|(name, axis)| VertexProperty::floats(name, uvs.values.iter().map(|uv| uv[axis]))),
        );
    }
    if let Some(particles) = &mesh.particles {
        all.push(VertexProperty::ids(particles));
        all.extend(PARTICLE_FACTS.map(|(name, fact)| {
            VertexProperty::floats(name, particles.iter().map(|particle| fact(particle) as f32))
        }));
    }
    all
}

/// Texture coordinates with seams are lists of the corners of each face, `texcoord`, as in MeshLab.
fn write_ply_mesh(file: &mut OutFile, mesh: &MeshSample) {
    let faces = &mesh.object.faces;
    let seams = mesh.uvs.as_ref().filter(|uvs| !uvs.corners.is_empty());
    // Nearly all readers expect the length of a list as one byte.
    let longest = if seams.is_some() { 127 } else { 255 };
    let is_short = faces.iter().all(|face| face.len() <= longest);
    let length = |file: &mut OutFile, length: usize| match is_short {
        true => file.bytes(&[length as u8]),
        false => file.bytes(&(length as u32).to_le_bytes()),
    };
    let properties = vertex_properties(mesh);
    let list = if is_short { "uchar" } else { "uint" };
    let declared: String =
        properties.iter().map(|property| format!("property {}\n", property.declaration)).collect();
    let of_corners = seams.map(|_| format!("property list {list} float texcoord\n")).unwrap_or_default();
    file.text(format!(
        "ply\nformat binary_little_endian 1.0\ncomment written by Nucleus\nelement vertex {}\n{declared}\
         element face {}\nproperty list {list} uint vertex_indices\n{of_corners}end_header\n",
        mesh.positions.len(),
        faces.len(),
    ));
    for point in 0..mesh.positions.len() {
        for VertexProperty { size, bytes, .. } in &properties {
            file.bytes(&bytes[point * size..(point + 1) * size]);
        }
    }
    let mut next = 0;
    for face in faces.iter() {
        length(file, face.len());
        face.iter().for_each(|point| file.bytes(&point.to_le_bytes()));
        if let Some(uvs) = seams {
            length(file, 2 * face.len());
            let corners = uvs.corners[next..next + face.len()].iter();
            corners
                .flat_map(|&corner| uvs.values[corner as usize])
                .for_each(|x| file.bytes(&x.to_le_bytes()));
        }
        next += face.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(times: &[f64]) -> Vec<String> {
        let substeps = times.len() as u32;
        let sample = |(substep, &frame_time): (u32, &f64)| {
            let frame = times[times.len() - 1] as i32;
            Sample::new(frame, [substep, substeps], frame_time)
        };
        let samples: Vec<Sample> = (1..).zip(times).map(sample).collect();
        (0..samples.len()).map(|index| numbered(&samples, index)).collect()
    }

    #[test]
    fn the_file_names_of_substeps_state_their_times() {
        assert_eq!(names(&[1.25, 1.5, 1.75, 2.0]), ["0001_1of4", "0001_2of4", "0001_3of4", "0002"]);
        // Solvers of two and of three substeps.
        let uneven = names(&[1.0 + 1.0 / 3.0, 1.5, 1.0 + 2.0 / 3.0, 2.0]);
        assert_eq!(uneven, ["0001_2of6", "0001_3of6", "0001_4of6", "0002"]);
        // An interval of two frames.
        assert_eq!(names(&[1.5, 2.0, 2.5, 3.0]), ["0001_1of2", "0002", "0002_1of2", "0003"]);
    }
}
