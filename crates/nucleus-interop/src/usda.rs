//! USD as text: a mesh or points for each object, with a time sample for each sample.

use std::fmt::Write;
use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::ObjectInfo;

use crate::clip::Clip;
use crate::error::ExportError;
use crate::name;
use crate::output::{OutFile, Output};

/// Writes one scene.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let names = name::for_nodes(clip.objects().map(|object| object.name.as_str()));
    let mut file = output.file(out.to_owned())?;
    file.text(head(clip));
    for (object, name) in names.iter().enumerate() {
        let done = object as f64 / names.len() as f64;
        let mut told = |share: f64| told(done + share / names.len() as f64);
        write_object(clip, object, name, &mut file, &mut told)?;
        if file.has_failed() {
            break; // told by `finish`
        }
    }
    file.text("}\n");
    output.finish(file)
}

fn head<R: Read + Seek>(clip: &Clip<R>) -> String {
    let (first, last) = (clip.samples()[0].at, clip.samples()[clip.samples().len() - 1].at);
    let fps = clip.fps();
    format!(
        "#usda 1.0\n(\n    defaultPrim = \"run\"\n    doc = {}\n    metersPerUnit = {}\n    upAxis = \"Y\"\n    \
         startTimeCode = {first}\n    endTimeCode = {last}\n    timeCodesPerSecond = {fps}\n    \
         framesPerSecond = {fps}\n)\n\ndef Xform \"run\" (\n    kind = \"component\"\n)\n{{\n",
        quoted(&clip.title()),
        1.0 / clip.units_per_metre(),
    )
}

fn write_object<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    name: &str,
    file: &mut OutFile,
    told: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let info = clip.object(object);
    let is_mesh = !info.faces.is_empty();
    file.text(format!("    def {} \"{name}\"\n    {{\n", if is_mesh { "Mesh" } else { "Points" }));
    file.text(format!("        custom string nucleus:name = {}\n", quoted(&info.name)));
    if is_mesh {
        write_faces(info, file);
    } else {
        write_identity(info, file);
        write_widths(clip.radius(object), file);
    }
    let samples = clip.samples().to_vec();
    let mut extents = String::new();
    file.text("        point3f[] points.timeSamples = {\n");
    for (place, sample) in samples.iter().enumerate() {
        let positions = clip.positions(object, place)?;
        file.text(format!("            {}: ", sample.at));
        write_vectors(&positions, file);
        file.text(",\n");
        let [low, high] = extent(&positions);
        // Writing to a string cannot fail.
        let _ = writeln!(extents, "            {}: [{}, {}],", sample.at, vector(&low), vector(&high));
        told((place + 1) as f64 / samples.len() as f64);
    }
    file.text("        }\n        float3[] extent.timeSamples = {\n");
    file.text(extents);
    file.text("        }\n");
    write_velocities(clip, object, file)?;
    file.text("    }\n");
    Ok(())
}

fn write_faces(object: &ObjectInfo, file: &mut OutFile) {
    let list = |numbers: &mut dyn Iterator<Item = u32>| {
        numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(", ")
    };
    file.text("        uniform token subdivisionScheme = \"none\"\n");
    file.text("        uniform token orientation = \"rightHanded\"\n        uniform bool doubleSided = 1\n");
    let counts = list(&mut object.faces.iter().map(|face| face.len() as u32));
    file.text(format!("        int[] faceVertexCounts = [{counts}]\n"));
    let corners = list(&mut object.faces.corners().iter().copied());
    file.text(format!("        int[] faceVertexIndices = [{corners}]\n"));
}

/// Particles keep their numbers, so that other tools can follow each.
fn write_identity(object: &ObjectInfo, file: &mut OutFile) {
    let ids: Vec<String> = (0..object.rest.len()).map(|id| id.to_string()).collect();
    file.text(format!("        int64[] ids = [{}]\n", ids.join(", ")));
}

/// A width is what is seen of a particle: all of it, twice its radius.
fn write_widths(radius: Option<f64>, file: &mut OutFile) {
    if let Some(radius) = radius {
        let width = (2.0 * radius) as f32;
        file.text(format!(
            "        float[] widths = [{width}] (\n            interpolation = \"constant\"\n        )\n"
        ));
    }
}

fn write_velocities<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    file: &mut OutFile,
) -> Result<(), ExportError> {
    let samples = clip.samples().to_vec();
    let mut begun = false;
    for (place, sample) in samples.iter().enumerate() {
        let Some(velocities) = clip.velocities(object, place)? else { continue };
        if !begun {
            file.text("        vector3f[] velocities.timeSamples = {\n");
            begun = true;
        }
        file.text(format!("            {}: ", sample.at));
        write_vectors(&velocities, file);
        file.text(",\n");
    }
    if begun {
        file.text("        }\n");
    }
    Ok(())
}

fn write_vectors(values: &[[f32; 3]], file: &mut OutFile) {
    file.text("[");
    for (place, value) in values.iter().enumerate() {
        file.text(if place > 0 { ", " } else { "" });
        file.text(vector(value));
    }
    file.text("]");
}

fn vector([x, y, z]: &[f32; 3]) -> String {
    format!("({x}, {y}, {z})")
}

/// Lowest and highest corner of the box round points.
pub(crate) fn extent(points: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let begin = points.first().copied().unwrap_or_default();
    points.iter().fold([begin; 2], |[low, high], point| {
        [
            std::array::from_fn(|axis| low[axis].min(point[axis])),
            std::array::from_fn(|axis| high[axis].max(point[axis])),
        ]
    })
}

/// A string of USD: quotes, backslashes and what is not printable are escaped.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted.push_str("\\n"),
            c if c.is_control() => quoted.push(' '),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
