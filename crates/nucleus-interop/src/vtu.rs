//! VTK unstructured grids: XML followed by raw binary data, and a ParaView collection with the time of each file.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{ObjectInfo, TextureCoordinates};
use nucleus_core::Particle;

use crate::clip::{Clip, PARTICLE_FACTS};
use crate::error::ExportError;
use crate::mesh_files::numbered;
use crate::output::{OutFile, Output, file_names};

/// Writes `<object>.<frame>.vtu` and `<object>.pvd` into a folder.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    folder: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let names = file_names(clip.objects().map(|object| object.name.as_str()));
    for sample in 0..clip.samples().len() {
        let frame = numbered(clip.samples(), sample);
        for (object, name) in names.iter().enumerate() {
            let positions = clip.positions(object, sample)?;
            let velocities = clip.velocities(object, sample)?;
            let mut file = output.file(folder.join(format!("{name}.{frame}.vtu")))?;
            let particles = clip.particles(object, sample)?;
            let uvs = clip.texture_coordinates_at(object, sample)?;
            let data = point_data(velocities.as_deref(), uvs.as_ref(), particles.as_deref());
            write_grid(&mut file, clip.object_at(object, sample)?, &positions, data);
            output.finish(file)?;
        }
        progress((sample + 1) as f64 / clip.samples().len() as f64);
    }
    for name in &names {
        let mut file = output.file(folder.join(format!("{name}.pvd")))?;
        file.text("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n");
        for (index, sample) in clip.samples().iter().enumerate() {
            let (time, frame) = (sample.frame_time / clip.fps(), numbered(clip.samples(), index));
            file.text(format!("    <DataSet timestep=\"{time}\" part=\"0\" file=\"{name}.{frame}.vtu\"/>\n"));
        }
        file.text("  </Collection>\n</VTKFile>\n");
        output.finish(file)?;
    }
    Ok(())
}

/// Cell types of VTK.
const VERTEX: u8 = 1;
const TRIANGLE: u8 = 5;
const POLYGON: u8 = 7;
const QUAD: u8 = 9;

/// An array of values per point.
struct PointArray {
    name: &'static str,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

/// The values of points: velocities, texture coordinates, and numbers, ages, lifespans and masses of particles that have
/// their own. VTK has no values of corners, so texture coordinates with seams are left out.
fn point_data(
    velocities: Option<&[[f32; 3]]>,
    uvs: Option<&TextureCoordinates>,
    particles: Option<&[Particle]>,
) -> Vec<PointArray> {
    let mut data = Vec::new();
    data.extend(velocities.map(|all| PointArray {
        name: "velocity",
        kind: "Float32",
        components: 3,
        bytes: floats(all.as_flattened().iter().copied()),
    }));
    data.extend(uvs.filter(|uvs| uvs.corners.is_empty()).map(|uvs| PointArray {
        name: "uv",
        kind: "Float32",
        components: 2,
        bytes: floats(uvs.values.as_flattened().iter().copied()),
    }));
    let Some(particles) = particles else { return data };
    let ids = particles.iter().flat_map(|particle| (particle.id as i64).to_le_bytes()).collect();
    data.push(PointArray { name: "id", kind: "Int64", components: 1, bytes: ids });
    data.extend(PARTICLE_FACTS.map(|(name, fact)| PointArray {
        name,
        kind: "Float32",
        components: 1,
        bytes: floats(particles.iter().map(|particle| fact(particle) as f32)),
    }));
    data
}

fn floats(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}

fn write_grid(file: &mut OutFile, object: &ObjectInfo, positions: &[[f32; 3]], data: Vec<PointArray>) {
    let (corners, ends, kinds) = cells(object, positions.len());
    let numbers = |values: &[i64]| values.iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut blocks: Vec<Vec<u8>> =
        vec![floats(positions.as_flattened().iter().copied()), numbers(&corners), numbers(&ends), kinds];
    let own = blocks.len();
    let heads: Vec<_> = data.iter().map(|array| (array.name, array.kind, array.components)).collect();
    blocks.extend(data.into_iter().map(|array| array.bytes));
    let mut offset = 0;
    let offsets: Vec<usize> = blocks
        .iter()
        .map(|block| {
            let own = offset;
            offset += 8 + block.len();
            own
        })
        .collect();
    let array = |name: &str, kind: &str, components: usize, block: usize| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{}\"/>",
            offsets[block]
        )
    };
    let arrays: String = (own..)
        .zip(&heads)
        .map(|(block, &(name, kind, components))| array(name, kind, components, block))
        .collect();
    let roles: String = [("velocity", "Vectors"), ("uv", "TCoords")]
        .iter()
        .filter(|(name, _)| heads.iter().any(|head| head.0 == *name))
        .map(|(name, role)| format!(" {role}=\"{name}\""))
        .collect();
    let point_data = match heads.is_empty() {
        false => format!("<PointData{roles}>{arrays}</PointData>\n"),
        true => String::new(),
    };
    file.text(format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n{point_data}\
         <Points>{}</Points>\n<Cells>{}{}{}</Cells>\n</Piece>\n</UnstructuredGrid>\n\
         <AppendedData encoding=\"raw\">\n_",
        positions.len(),
        ends.len(),
        array("positions", "Float32", 3, 0),
        array("connectivity", "Int64", 1, 1),
        array("offsets", "Int64", 1, 2),
        array("types", "UInt8", 1, 3),
    ));
    for block in &blocks {
        file.bytes(&(block.len() as u64).to_le_bytes());
        file.bytes(block);
    }
    file.text("\n</AppendedData>\n</VTKFile>\n");
}

/// Connectivity, offsets and types of the cells: the faces, or a vertex per point if there are none.
fn cells(object: &ObjectInfo, points: usize) -> (Vec<i64>, Vec<i64>, Vec<u8>) {
    if object.faces.is_empty() {
        let all = 0..points as i64;
        return (all.clone().collect(), all.map(|point| point + 1).collect(), vec![VERTEX; points]);
    }
    let corners = object.faces.corners().iter().map(|&point| i64::from(point)).collect();
    let mut end = 0;
    let ends = object.faces.iter().map(|face| {
        end += face.len() as i64;
        end
    });
    let ends = ends.collect();
    let kind = |face: &[u32]| match face.len() {
        3 => TRIANGLE,
        4 => QUAD,
        _ => POLYGON,
    };
    (corners, ends, object.faces.iter().map(kind).collect())
}
