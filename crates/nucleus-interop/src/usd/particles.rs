//! Particles in USD: widths, colours and opacities, orientations, numbers and ages, and the
//! extent of the balls.

use std::io::{Read, Seek};

use nucleus_core::ParticleLook;

use crate::clip::{Clip, Extent, PARTICLE_FACTS, extent};
use crate::error::ExportError;
use crate::materials;

use super::stage::{Attribute, Stage, Value};

/// A particle that looks like its object.
const PLAIN: ParticleLook = ParticleLook { radius: 1.0, opacity: 1.0, color: None, incandescence: [0.0; 3] };

/// Whether the looks of an object's particles are recorded at any sample.
pub(super) fn have_looks<R: Read + Seek>(clip: &mut Clip<R>, object: usize) -> Result<bool, ExportError> {
    for sample in 0..clip.samples().len() {
        if clip.looks(object, sample)?.is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The look of each particle at a sample.
fn looks_at<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    sample: usize,
) -> Result<Vec<ParticleLook>, ExportError> {
    match clip.looks(object, sample)? {
        Some(looks) => Ok(looks),
        None => Ok(vec![PLAIN; clip.positions(object, sample)?.len()]),
    }
}

/// Writes the diameters, which USD calls widths: one for all, or one for each particle and sample.
pub(super) fn write_widths<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    have_looks: bool,
    stage: &mut impl Stage,
) -> Result<(), ExportError> {
    let Some(radius) = clip.radius(object) else { return Ok(()) };
    let widths = Attribute::of("float[]", "widths");
    if !have_looks {
        stage.attribute(&widths.interpolated("constant"), &Value::Floats(&[(2.0 * radius) as f32]));
        return Ok(());
    }
    stage.begin_samples(&widths.interpolated("vertex"));
    for sample in 0..clip.samples().len() {
        let width = |look: &ParticleLook| (2.0 * radius * f64::from(look.radius)) as f32;
        let widths: Vec<f32> = looks_at(clip, object, sample)?.iter().map(width).collect();
        stage.sample(clip.samples()[sample].frame_time, &Value::Floats(&widths));
    }
    stage.end_samples();
    Ok(())
}

/// Writes the colours and opacities. Particles without colours of their own have that of their object.
pub(super) fn write_looks<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
) -> Result<(), ExportError> {
    let colour = materials::colours(clip.objects().map(|object| object.kind))[object];
    stage.begin_samples(&Attribute::of("color3f[]", "primvars:displayColor").interpolated("vertex"));
    for sample in 0..clip.samples().len() {
        let looks = looks_at(clip, object, sample)?;
        let colours: Vec<[f32; 3]> = looks.iter().map(|look| look.color.unwrap_or(colour)).collect();
        stage.sample(clip.samples()[sample].frame_time, &Value::Vec3s(&colours));
    }
    stage.end_samples();
    stage.begin_samples(&Attribute::of("float[]", "primvars:displayOpacity").interpolated("vertex"));
    for sample in 0..clip.samples().len() {
        let opacities: Vec<f32> = looks_at(clip, object, sample)?.iter().map(|look| look.opacity).collect();
        stage.sample(clip.samples()[sample].frame_time, &Value::Floats(&opacities));
    }
    stage.end_samples();
    Ok(())
}

/// The box around the balls of the particles at a sample.
pub(super) fn extent_of_particles<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    sample: usize,
    positions: &[[f32; 3]],
) -> Result<Extent, ExportError> {
    let Some(radius) = clip.radius(object) else { return Ok(extent(positions)) };
    let looks = clip.looks(object, sample)?;
    let corners = positions.iter().enumerate().flat_map(|(at, point)| {
        let factor = looks.as_ref().and_then(|looks| looks.get(at)).map_or(1.0, |look| look.radius);
        let radius = radius as f32 * factor;
        [point.map(|x| x - radius), point.map(|x| x + radius)]
    });
    Ok(extent(&corners.collect::<Vec<_>>()))
}

/// Writes the orientations of particles that rotate, as the primvar that instancers read.
pub(super) fn write_orientations<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
) -> Result<(), ExportError> {
    let orient = Attribute::of("quatf[]", "primvars:orient").interpolated("vertex");
    write_recorded(
        clip,
        stage,
        &orient,
        |clip, at| clip.orientations(object, at),
        |values, write| {
            write(&Value::Quaternions(values));
        },
    )?;
    Ok(())
}

/// Writes the numbers of particles, so that other tools can identify each over time, and their ages, lifespans and masses.
/// Returns whether any are recorded.
pub(super) fn write_particles<R: Read + Seek>(
    clip: &mut Clip<R>,
    object: usize,
    stage: &mut impl Stage,
) -> Result<bool, ExportError> {
    let ids = Attribute::of("int64[]", "ids");
    let is_recorded = write_recorded(
        clip,
        stage,
        &ids,
        |clip, at| clip.particles(object, at),
        |particles, write| {
            let ids: Vec<u64> = particles.iter().map(|particle| particle.id).collect();
            write(&Value::Int64s(&ids));
        },
    )?;
    for (name, fact) in PARTICLE_FACTS {
        let name = format!("primvars:{name}");
        let primvar = Attribute::of("float[]", &name).interpolated("vertex");
        write_recorded(
            clip,
            stage,
            &primvar,
            |clip, at| clip.particles(object, at),
            |particles, write| {
                let values: Vec<f32> = particles.iter().map(|particle| fact(particle) as f32).collect();
                write(&Value::Floats(&values));
            },
        )?;
    }
    Ok(is_recorded)
}

/// Writes an attribute of particles at each sample, empty where nothing is recorded; no attribute where nothing ever is.
/// Returns whether there is one.
fn write_recorded<R: Read + Seek, T>(
    clip: &mut Clip<R>,
    stage: &mut impl Stage,
    attribute: &Attribute,
    read: impl Fn(&mut Clip<R>, usize) -> Result<Option<Vec<T>>, ExportError>,
    with_value: impl Fn(&[T], &mut dyn FnMut(&Value)),
) -> Result<bool, ExportError> {
    let mut first = None;
    for sample in 0..clip.samples().len() {
        let Some(values) = read(clip, sample)? else { continue };
        if !values.is_empty() {
            first = Some(sample);
            break;
        }
    }
    let Some(first) = first else { return Ok(false) };
    stage.begin_samples(attribute);
    for sample in 0..clip.samples().len() {
        let values = if sample < first { None } else { read(clip, sample)? };
        let time = clip.samples()[sample].frame_time;
        with_value(&values.unwrap_or_default(), &mut |value| stage.sample(time, value));
    }
    stage.end_samples();
    Ok(true)
}
