//! USD as text: per object a Mesh or Points, with time samples.

use std::fmt::Write;
use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{ObjectInfo, ObjectKind};

use crate::clip::{Clip, extent};
use crate::error::ExportError;
use crate::output::{OutFile, Output, node_names};

/// Writes one scene.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let names = node_names(clip.objects().map(|object| object.name.as_str()));
    let mut file = output.file(out.to_owned())?;
    file.text(head(clip));
    for (object, name) in names.iter().enumerate() {
        let done = object as f64 / names.len() as f64;
        let mut progress = |share: f64| progress(done + share / names.len() as f64);
        write_object(clip, object, name, &mut file, &mut progress)?;
        if file.has_failed() {
            break; // `finish` reports the error
        }
    }
    file.text("}\n");
    output.finish(file)
}

fn head<R: Read + Seek>(clip: &Clip<R>) -> String {
    let (first, last) = (clip.samples()[0].frame_time, clip.samples()[clip.samples().len() - 1].frame_time);
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
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    let changes = !clip.mesh_changes(object).is_empty();
    let info = clip.object(object);
    let is_mesh = !info.faces.is_empty() || changes && info.kind != ObjectKind::Particles;
    file.text(format!("    def {} \"{name}\"\n    {{\n", if is_mesh { "Mesh" } else { "Points" }));
    file.text(format!("        custom string nucleus:name = {}\n", quoted(&info.name)));
    // Particles that come and go have no constant list of ids.
    if clip.count_change(object)?.is_none() {
        write_topology(clip, object, is_mesh, file)?;
    }
    if !is_mesh {
        write_widths(clip.radius(object), file);
    }
    let samples = clip.samples().to_vec();
    let mut extents = String::new();
    file.text("        point3f[] points.timeSamples = {\n");
    for (index, sample) in samples.iter().enumerate() {
        let positions = clip.positions(object, index)?;
        file.text(format!("            {}: ", sample.frame_time));
        write_vectors(&positions, file);
        file.text(",\n");
        let [low, high] = extent(&positions);
        // Writing to a string cannot fail.
        let _ =
            writeln!(extents, "            {}: [{}, {}],", sample.frame_time, vector(&low), vector(&high));
        progress((index + 1) as f64 / samples.len() as f64);
    }
    file.text("        }\n        float3[] extent.timeSamples = {\n");
    file.text(extents);
    file.text("        }\n");
    write_velocities(clip, object, file)?;
    file.text("    }\n");
    Ok(())
}

/// Writes the topology: once, or at each sample at which it changes. USD holds such values until the next sample.
fn write_topology<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    is_mesh: bool,
    file: &mut OutFile,
) -> Result<(), ExportError> {
    if is_mesh {
        file.text("        uniform token subdivisionScheme = \"none\"\n");
        file.text(
            "        uniform token orientation = \"rightHanded\"\n        uniform bool doubleSided = 1\n",
        );
    }
    let mut samples = vec![0];
    samples.extend(clip.mesh_changes(object));
    let mut attributes: Vec<(&str, Vec<String>)> = Vec::new();
    for &sample in &samples {
        for (name, values) in topology_attributes(clip.object_at(object, sample)?, is_mesh) {
            match attributes.iter_mut().find(|(known, _)| *known == name) {
                Some((_, all)) => all.push(values),
                None => attributes.push((name, vec![values])),
            }
        }
    }
    for (name, values) in attributes {
        if let [only] = &values[..] {
            file.text(format!("        {name} = [{only}]\n"));
            continue;
        }
        file.text(format!("        {name}.timeSamples = {{\n"));
        for (&sample, values) in samples.iter().zip(values) {
            file.text(format!("            {}: [{values}],\n", clip.samples()[sample].frame_time));
        }
        file.text("        }\n");
    }
    Ok(())
}

/// Type, name and values of the topology attributes. Particles have ids, so that other tools can identify each over time.
fn topology_attributes(object: &ObjectInfo, is_mesh: bool) -> Vec<(&'static str, String)> {
    let list = |numbers: &mut dyn Iterator<Item = u32>| {
        numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(", ")
    };
    if !is_mesh {
        return vec![("int64[] ids", list(&mut (0..object.rest.len() as u32)))];
    }
    let counts = list(&mut object.faces.iter().map(|face| face.len() as u32));
    let corners = list(&mut object.faces.corners().iter().copied());
    vec![("int[] faceVertexCounts", counts), ("int[] faceVertexIndices", corners)]
}

/// USD states the diameter of a particle: twice its radius.
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
    for (index, sample) in samples.iter().enumerate() {
        let Some(velocities) = clip.velocities(object, index)? else { continue };
        if !begun {
            file.text("        vector3f[] velocities.timeSamples = {\n");
            begun = true;
        }
        file.text(format!("            {}: ", sample.frame_time));
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
    for (index, value) in values.iter().enumerate() {
        file.text(if index > 0 { ", " } else { "" });
        file.text(vector(value));
    }
    file.text("]");
}

fn vector([x, y, z]: &[f32; 3]) -> String {
    format!("({x}, {y}, {z})")
}

/// A string of USD: quotes and backslashes are escaped, other control characters than line breaks become spaces.
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
