//! The exported part of a cache: objects, time samples and unit of length.

use std::io::{Read, Seek};

use nucleus_cache::{
    Camera, CameraView, FaceSets, LiquidSurface, ObjectInfo, ObjectKind, Playback, RunInfo,
    TextureCoordinates,
};
use nucleus_core::{Particle, ParticleLook};

use crate::error::ExportError;

/// Which part of a cache to export.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Names of objects; all objects if empty.
    pub objects: Vec<String>,
    /// First and last frame, inclusive; all recorded frames if not given.
    pub frames: Option<(i32, i32)>,
    /// Step in frames: 1 takes every frame, 2 every second one.
    pub every: u32,
    /// Whether recorded substeps become samples too.
    pub substeps: bool,
    /// Factor on all lengths: the file has another unit of length, and the size in metres is kept.
    pub scale: f64,
    /// Whether particles become a mesh of their surface, in formats of a file per sample.
    pub surface: bool,
}

impl Default for Selection {
    fn default() -> Self {
        Self { objects: Vec::new(), frames: None, every: 1, substeps: false, scale: 1.0, surface: false }
    }
}

/// A time sample: a recorded time that is exported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The frame it belongs to.
    pub frame: i32,
    /// Its number among the samples of its frame, from 1; equal to `substeps` at the end of the frame.
    pub substep: u32,
    /// How many samples the frame has.
    pub substeps: u32,
    /// Its time in frames; a whole number at the end of a frame.
    pub frame_time: f64,
    moment: usize,
}

impl Sample {
    #[cfg(test)]
    pub(crate) fn new(frame: i32, [substep, substeps]: [u32; 2], frame_time: f64) -> Self {
        Self { frame, substep, substeps, frame_time, moment: 0 }
    }

    /// Whether it is the end of its frame.
    pub fn ends_frame(&self) -> bool {
        self.substep == self.substeps
    }
}

/// The surface of particles, with the velocities of its points if they are known.
pub(crate) type MovingSurface = (LiquidSurface, Option<Vec<[f32; 3]>>);

/// The objects and samples of a cache that are exported.
pub struct Clip<'a, R> {
    cache: &'a mut Playback<R>,
    objects: Vec<usize>,
    samples: Vec<Sample>,
    scale: f64,
    /// By object, the spacing in scene units of the particles whose surface is exported.
    spacings: Vec<Option<f32>>,
}

impl<'a, R: Read + Seek> Clip<'a, R> {
    /// Selects a part of a cache.
    ///
    /// # Errors
    /// When the cache lacks a requested object, or every requested frame.
    pub fn of(cache: &'a mut Playback<R>, selection: &Selection) -> Result<Self, ExportError> {
        let objects = objects(cache, &selection.objects)?;
        let samples = samples(cache, selection)?;
        let spacings = vec![None; objects.len()];
        let mut clip = Self { cache, objects, samples, scale: selection.scale, spacings };
        for object in (0..clip.objects.len()).filter(|_| selection.surface) {
            clip.spacings[object] = clip.cache.particle_spacing(clip.objects[object])?;
        }
        Ok(clip)
    }

    /// The surface of an object's particles at a sample in exported units, and the velocities of its points if those of the
    /// particles were recorded; `None` for all other objects.
    ///
    /// # Errors
    /// When the frame is damaged, or a coordinate is not finite.
    pub(crate) fn surface(
        &mut self,
        object: usize,
        sample: usize,
    ) -> Result<Option<MovingSurface>, ExportError> {
        let Some(spacing) = self.spacings[object] else { return Ok(None) };
        let spacing = (f64::from(spacing) * self.scale) as f32;
        let shape = self.cache.surface_shape(self.objects[object])?;
        let particles = self.positions(object, sample)?;
        let surface = LiquidSurface::of(&particles, spacing, shape);
        let scale = (spacing, shape.radius_scale);
        let velocities = self.velocities(object, sample)?;
        let velocities = velocities.map(|values| surface.values_of(&particles, scale, &values));
        Ok(Some((surface, velocities)))
    }

    /// The objects with their first mesh, in the order of the cache.
    pub fn objects(&self) -> impl ExactSizeIterator<Item = &ObjectInfo> {
        self.objects.iter().map(|&object| &self.cache.objects()[object])
    }

    /// An object with its mesh at a sample.
    ///
    /// # Errors
    /// When the frame that holds the mesh is damaged.
    pub fn object_at(&mut self, object: usize, sample: usize) -> Result<&ObjectInfo, ExportError> {
        Ok(self.cache.object_at(self.objects[object], self.samples[sample].moment)?)
    }

    /// The samples at which the topology of an object differs from the sample before.
    pub fn mesh_changes(&self, object: usize) -> Vec<usize> {
        let first = self.samples[0].moment;
        let changes = self.cache.mesh_changes(self.objects[object]);
        let sample = |moment: usize| self.samples.iter().position(|sample| sample.moment >= moment);
        let mut samples: Vec<usize> =
            changes.into_iter().filter(|&moment| moment > first).filter_map(sample).collect();
        samples.dedup();
        samples
    }

    /// Checks an object for a format with constant topology.
    ///
    /// # Errors
    /// When the topology changes after the first sample.
    pub(crate) fn require_constant_topology(
        &mut self,
        object: usize,
        format: &'static str,
    ) -> Result<(), ExportError> {
        let change = match self.mesh_changes(object).first() {
            Some(&sample) => Some(sample),
            None => self.count_change(object)?,
        };
        match change {
            None => Ok(()),
            Some(sample) => Err(ExportError::MeshChanges {
                object: self.object(object).name.clone(),
                frame: self.samples[sample].frame,
                format,
            }),
        }
    }

    /// The first sample at which an object has another number of particles than at the first one. Reads every sample.
    pub(crate) fn count_change(&mut self, object: usize) -> Result<Option<usize>, ExportError> {
        if self.object(object).kind != ObjectKind::Particles {
            return Ok(None);
        }
        let first = self.positions(object, 0)?.len();
        for sample in 1..self.samples.len() {
            if self.positions(object, sample)?.len() != first {
                return Ok(Some(sample));
            }
        }
        Ok(None)
    }

    /// An object with its first mesh, by its index in [`objects`](Self::objects).
    pub fn object(&self, object: usize) -> &ObjectInfo {
        &self.cache.objects()[self.objects[object]]
    }

    /// The radius of an object's particles in exported units; `None` for other objects.
    pub fn radius(&self, object: usize) -> Option<f64> {
        self.cache.run().radii.get(&self.object(object).name).map(|radius| radius * self.scale)
    }

    /// The looks of an object's particles at a sample; `None` where they all look the same.
    ///
    /// # Errors
    /// When the frame is damaged.
    pub fn looks(&mut self, object: usize, sample: usize) -> Result<Option<Vec<ParticleLook>>, ExportError> {
        Ok(self.cache.looks(self.objects[object], self.samples[sample].moment)?)
    }

    /// The particles of an object at a sample; `None` where they have no numbers of their own, or none lives.
    ///
    /// # Errors
    /// When the frame is damaged.
    pub fn particles(&mut self, object: usize, sample: usize) -> Result<Option<Vec<Particle>>, ExportError> {
        Ok(self.cache.particles(self.objects[object], self.samples[sample].moment)?)
    }

    /// The texture coordinates of an object; they fit its first mesh.
    pub fn texture_coordinates(&self, object: usize) -> Option<&TextureCoordinates> {
        let info = self.object(object);
        let found = self.cache.run().texture_coordinates.get(&info.name)?;
        found.fit(info.rest.len(), info.faces.corners().len()).then_some(found)
    }

    /// The texture coordinates of an object at a sample, where they fit its mesh.
    ///
    /// # Errors
    /// When the frame that holds the mesh is damaged.
    pub(crate) fn texture_coordinates_at(
        &mut self,
        object: usize,
        sample: usize,
    ) -> Result<Option<TextureCoordinates>, ExportError> {
        let uvs = self.texture_coordinates(object).cloned();
        let object = self.object_at(object, sample)?;
        Ok(uvs.filter(|uvs| uvs.fit(object.rest.len(), object.faces.corners().len())))
    }

    /// The groups and materials of an object's faces; they fit its first mesh.
    pub fn face_sets(&self, object: usize) -> Option<&FaceSets> {
        let info = self.object(object);
        let found = self.cache.run().face_sets.get(&info.name)?;
        found.fit(info.faces.len()).then_some(found)
    }

    /// The groups and materials of an object's faces at a sample. Faces keep their numbers in a mesh that changes; none where
    /// there is another number of faces.
    ///
    /// # Errors
    /// When the frame that holds the mesh is damaged.
    pub(crate) fn face_sets_at(
        &mut self,
        object: usize,
        sample: usize,
    ) -> Result<Option<FaceSets>, ExportError> {
        let sets = self.face_sets(object).cloned();
        let first = self.object(object).faces.len();
        let now = self.object_at(object, sample)?.faces.len();
        Ok(sets.filter(|_| now == first))
    }

    /// The cameras of the run.
    pub fn cameras(&self) -> &[Camera] {
        &self.cache.run().cameras
    }

    /// A camera at a sample, with lengths in exported units.
    pub fn camera_view(&self, camera: usize, sample: usize) -> CameraView {
        let camera = &self.cameras()[camera];
        let place = self.samples[sample].frame_time - f64::from(self.cache.run().start);
        let last = camera.views.len() - 1;
        let before = (place.max(0.0) as usize).min(last);
        let after = (before + 1).min(last);
        let share = (place - before as f64).clamp(0.0, 1.0) as f32;
        let view = CameraView::between(&camera.views[before], &camera.views[after], share);
        let eye = view.eye.map(|x| (f64::from(x) * self.scale) as f32);
        CameraView { eye, ..view }
    }

    /// The samples in order of time; at least one.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The first sample that does not follow the one before at the distance of the first two; `None` if all do.
    pub(crate) fn uneven_sample(&self) -> Option<&Sample> {
        let step = |pair: &[Sample]| pair[1].frame_time - pair[0].frame_time;
        let first = self.samples.windows(2).next().map(step)?;
        let uneven = self.samples.windows(2).find(|pair| (step(pair) - first).abs() > 1e-6)?;
        Some(&uneven[1])
    }

    /// Frames per second.
    pub fn fps(&self) -> f64 {
        self.cache.run().frames_per_second
    }

    /// Exported units per metre.
    pub fn units_per_metre(&self) -> f64 {
        self.cache.run().units_per_metre * self.scale
    }

    /// Metres per exported unit. The reciprocal of a rounded reciprocal may be off in its last digit, so the shorter number is
    /// taken if both have the same reciprocal.
    pub fn metres_per_unit(&self) -> f64 {
        let units = self.units_per_metre();
        let short: f64 = format!("{:.12e}", 1.0 / units).parse().unwrap_or(1.0 / units);
        if 1.0 / short == units { short } else { 1.0 / units }
    }

    /// A title that names the scene.
    pub fn title(&self) -> String {
        let path = &self.cache.run().scene_path;
        if path.is_empty() { "a Nucleus run".to_owned() } else { format!("a Nucleus run of {path}") }
    }

    /// Converts all lengths from scene units to metres, the only unit of a format.
    ///
    /// # Errors
    /// When another unit is wanted.
    pub(crate) fn in_metres(&mut self, format: &'static str) -> Result<(), ExportError> {
        if self.scale != 1.0 {
            return Err(ExportError::FixedUnit { format });
        }
        self.scale = 1.0 / self.units_per_metre();
        Ok(())
    }

    /// Whether any position of an object differs from the first sample. Reads every sample.
    pub(crate) fn moves(&mut self, object: usize) -> Result<bool, ExportError> {
        let first = self.positions(object, 0)?;
        for sample in 1..self.samples.len() {
            if self.positions(object, sample)? != first {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Positions of an object at a sample, in exported units.
    ///
    /// # Errors
    /// When the frame is damaged, or a coordinate is not finite: other tools cannot read such a file.
    pub fn positions(&mut self, object: usize, sample: usize) -> Result<Vec<[f32; 3]>, ExportError> {
        let Sample { moment, frame, .. } = self.samples[sample];
        let mut positions = self.cache.positions(self.objects[object], moment)?;
        if self.scale != 1.0 {
            let scale = self.scale;
            positions.as_flattened_mut().iter_mut().for_each(|x| *x = (f64::from(*x) * scale) as f32);
        }
        let lost = positions.iter().filter(|point| !point.iter().all(|x| x.is_finite())).count();
        match lost {
            0 => Ok(positions),
            points => Err(ExportError::NotFinite { object: self.object(object).name.clone(), frame, points }),
        }
    }

    /// Orientations of particles at a sample, as unit quaternions x, y, z, w; `None` if they do not rotate.
    ///
    /// # Errors
    /// When the frame is damaged.
    pub fn orientations(
        &mut self,
        object: usize,
        sample: usize,
    ) -> Result<Option<Vec<[f32; 4]>>, ExportError> {
        match self.cache.run().rotation {
            true => Ok(self.cache.orientations(self.objects[object], self.samples[sample].moment)?),
            false => Ok(None),
        }
    }

    /// Velocities of an object at a sample in exported units per second; `None` if they were not recorded.
    ///
    /// # Errors
    /// When the frame is damaged.
    pub fn velocities(&mut self, object: usize, sample: usize) -> Result<Option<Vec<[f32; 3]>>, ExportError> {
        let moment = self.samples[sample].moment;
        let velocities = self.cache.velocities(self.objects[object], moment)?;
        let scale = self.scale;
        Ok(velocities.map(|mut all| {
            all.as_flattened_mut().iter_mut().for_each(|x| *x = (f64::from(*x) * scale) as f32);
            all
        }))
    }
}

/// A number of a particle.
type ParticleFact = fn(&Particle) -> f64;

/// Numbers of a particle that formats of points name, besides its own number.
pub(crate) const PARTICLE_FACTS: [(&str, ParticleFact); 3] = [
    ("age", |particle| particle.age),
    ("lifespan", |particle| particle.lifespan),
    ("mass", |particle| particle.mass),
];

/// Lowest and highest corner of a bounding box.
pub type Extent = [[f32; 3]; 2];

/// Lowest and highest corner of the bounding box of points.
pub(crate) fn extent(points: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let begin = points.first().copied().unwrap_or_default();
    points.iter().fold([begin; 2], |[low, high], point| {
        [
            std::array::from_fn(|axis| low[axis].min(point[axis])),
            std::array::from_fn(|axis| high[axis].max(point[axis])),
        ]
    })
}

fn objects<R: Read + Seek>(cache: &Playback<R>, names: &[String]) -> Result<Vec<usize>, ExportError> {
    let all = cache.objects();
    if names.is_empty() {
        return Ok((0..all.len()).collect());
    }
    let mut found = Vec::new();
    for name in names {
        match all.iter().position(|object| object.name == *name) {
            Some(object) => found.push(object),
            None => {
                let known = all.iter().map(|object| format!("`{}`", object.name)).collect();
                return Err(ExportError::NoObject { name: name.clone(), known });
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

fn samples<R: Read + Seek>(cache: &Playback<R>, selection: &Selection) -> Result<Vec<Sample>, ExportError> {
    let moments = cache.time_samples();
    let (Some(begin), Some(end)) = (moments.first(), moments.last()) else { return Err(ExportError::Empty) };
    let has = (begin.frame, end.frame);
    let (first, last) = selection.frames.unwrap_or(has);
    let every = i64::from(selection.every.max(1));
    let from = i64::from(first.max(has.0));
    let is_selected =
        |frame: i32| (first..=last).contains(&frame) && (i64::from(frame) - from).rem_euclid(every) == 0;
    let chosen = moments
        .iter()
        .enumerate()
        .filter(|(_, moment)| is_selected(moment.frame) && (selection.substeps || moment.ends_frame()));
    let samples: Vec<Sample> = chosen
        .map(|(index, moment)| {
            let (substep, substeps) = match moment.ends_frame() {
                true => (1, 1),
                false => (moment.substep, moment.substeps),
            };
            let interval = f64::from(cache.run().interval_before(moment.frame));
            let share = match moment.ends_frame() {
                true => 1.0,
                false => share_of_frame(cache.run(), moment.frame, moment.time, [substep, substeps]),
            };
            let frame_time = f64::from(moment.frame) - interval + interval * share;
            Sample { frame: moment.frame, substep, substeps, frame_time, moment: index }
        })
        .collect();
    if samples.is_empty() { Err(ExportError::NoFrame { first, last, has }) } else { Ok(samples) }
}

/// The share of its frame at which a sample within it lies. Times are whole nanoseconds, so it is rounded to the substeps.
fn share_of_frame(run: &RunInfo, frame: i32, time: f64, [substep, substeps]: [u32; 2]) -> f64 {
    let interval = f64::from(run.interval_before(frame));
    let before = f64::from(frame) - interval - f64::from(run.start);
    let share = (time * run.frames_per_second - before) / interval;
    let even = f64::from(substep) / f64::from(substeps);
    let rounding = 2e-9 * run.frames_per_second;
    if (share - even).abs() < rounding { even } else { (share * 1e6).round() / 1e6 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_within_a_frame_have_their_own_times() {
        let run = RunInfo { start: 1, end: 9, frames_per_second: 24.0, ..RunInfo::default() };
        // Three and five substeps in a frame.
        for (substep, share) in (1..).zip([0.2, 1.0 / 3.0, 0.4, 0.6, 2.0 / 3.0, 0.8]) {
            let time = ((1.0 + share) / 24.0 * 1e9_f64).round() * 1e-9;
            assert!((share_of_frame(&run, 3, time, [substep, 7]) - share).abs() < 1e-6);
        }
    }
}
