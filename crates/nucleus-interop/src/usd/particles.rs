//! Particles in USD: widths, colours and opacities, orientations, and the extent of the balls.

use std::io::{Read, Seek};

use nucleus_core::ParticleLook;

use crate::clip::{Clip, Extent, extent};
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
    // Samples before the first particle is born.
    let mut empty = 0;
    let mut begins = true;
    for index in 0..clip.samples().len() {
        let time = clip.samples()[index].frame_time;
        match clip.orientations(object, index)? {
            None if begins => empty += 1,
            found => {
                if std::mem::take(&mut begins) {
                    stage.begin_samples(&Attribute::of("quatf[]", "primvars:orient").interpolated("vertex"));
                    let before = &clip.samples()[..empty];
                    before
                        .iter()
                        .for_each(|sample| stage.sample(sample.frame_time, &Value::Quaternions(&[])));
                }
                stage.sample(time, &Value::Quaternions(&found.unwrap_or_default()));
            }
        }
    }
    if !begins {
        stage.end_samples();
    }
    Ok(())
}
