//! The pictures of a recorded run.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{CameraView, ObjectKind, Playback};

use super::{AnimationWriter, Bounds, Camera, Ground, Image, Kind, Object, Style, draw};
use crate::ViewError;

/// A run as pictures that all have one camera and one floor, so that nothing but the scene moves.
///
/// ```no_run
/// use nucleus_view::{Film, Style};
///
/// let mut cache = nucleus_cache::Playback::open("hang.mcap")?;
/// let mut film = Film::of(&mut cache, 1, Style::default())?;
/// film.picture(film.len() - 1)?.write_png("last.png")?;
/// film.write("hang.png")?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Film<'a, R> {
    cache: &'a mut Playback<R>,
    /// The moments that are shown, by their place in the cache.
    moments: Vec<usize>,
    fps: f64,
    camera: Camera,
    /// A camera of the scene that it is seen through instead.
    through: Option<nucleus_cache::Camera>,
    /// The box of what moves over the run.
    stage: Bounds,
    style: Style,
}

impl<'a, R: Read + Seek> Film<'a, R> {
    /// The ends of every `every`th frame of a run, framed so that the cloth is always in the picture.
    ///
    /// # Errors
    /// If a frame that is needed to find the camera is damaged, or if there is none.
    pub fn of(cache: &'a mut Playback<R>, every: usize, style: Style) -> Result<Self, ViewError> {
        let every = every.max(1);
        let ends =
            (0..cache.time_samples().len()).filter(|moment| cache.time_samples()[*moment].ends_frame());
        let moments: Vec<usize> = ends.step_by(every).collect();
        if moments.is_empty() {
            return Err(ViewError::NoMoment);
        }
        let (stage, floor) = survey(cache, &moments)?;
        let camera = Camera::framing(&stage, style.size);
        // A level plane that the scene rests on is the floor; a slanted one cannot be drawn.
        let plane = cache.run().ground.filter(|plane| plane.normal[1] > 0.999 * norm(plane.normal));
        let floor = plane.map_or(floor, |plane| Ground::At(plane.origin[1] as f32));
        let ground = if style.ground == Ground::Below { floor } else { style.ground };
        let fps = cache.run().frames_per_second / every as f64;
        Ok(Self { cache, moments, fps, camera, through: None, stage, style: Style { ground, ..style } })
    }

    /// The same, of the frames from `first` to `last` only; the framing stays that of the whole run.
    ///
    /// # Errors
    /// If none of them was recorded.
    pub fn between(mut self, first: i32, last: i32) -> Result<Self, ViewError> {
        let moments = self.cache.time_samples();
        self.moments.retain(|&moment| (first..=last).contains(&moments[moment].frame));
        if self.moments.is_empty() { Err(ViewError::NoMoment) } else { Ok(self) }
    }

    /// Pictures per second.
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// The camera that everything is seen by.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// The frame that a picture shows.
    pub fn frame(&self, place: usize) -> i32 {
        self.cache.time_samples()[self.moments[place.min(self.moments.len() - 1)]].frame
    }

    /// The same, seen by another camera.
    pub fn seen_by(self, camera: Camera) -> Self {
        Self { camera, ..self }
    }

    /// The same, seen through a camera of the scene, wherever that is in each frame.
    pub fn seen_through(self, camera: nucleus_cache::Camera) -> Self {
        Self { through: Some(camera), ..self }
    }

    /// The camera at a recorded moment. Within a frame, cameras go straight.
    fn camera_at(&self, moment: usize) -> Camera {
        let (run, moments) = (self.cache.run(), self.cache.time_samples());
        let Some((track, moment)) = self.through.as_ref().zip(moments.get(moment)) else {
            return self.camera;
        };
        let share = moment.time * run.frames_per_second - f64::from(moment.frame - run.start);
        let at = |frame| track.at(frame, run.start);
        let Some((before, now)) = at(moment.frame - 1).zip(at(moment.frame)) else { return self.camera };
        let view = match share < -1e-6 {
            true => CameraView::between(before, now, (1.0 + share) as f32),
            false => *now,
        };
        Camera::of_scene(&view, track.fit, self.style.size, &self.stage)
    }

    /// The number of pictures, at least one.
    #[expect(clippy::len_without_is_empty, reason = "it never is")]
    pub fn len(&self) -> usize {
        self.moments.len()
    }

    /// The picture at a place in the film; the last one past its end.
    ///
    /// # Errors
    /// If its frame is damaged.
    pub fn picture(&mut self, place: usize) -> Result<Image, ViewError> {
        let moment = self.moments[place.min(self.moments.len() - 1)];
        self.moment(moment)
    }

    /// The picture of any recorded moment, by its place in the cache.
    ///
    /// # Errors
    /// If there is no such moment, or its frame is damaged.
    pub fn moment(&mut self, moment: usize) -> Result<Image, ViewError> {
        let (positions, camera) = (positions(self.cache, moment)?, self.camera_at(moment));
        Ok(draw(&objects(self.cache, moment, &positions)?, &camera, &self.style))
    }

    /// Writes all pictures as one animated PNG that plays as fast as the run was.
    ///
    /// # Errors
    /// If a frame is damaged or the file cannot be written.
    pub fn write(&mut self, path: impl AsRef<Path>) -> Result<(), ViewError> {
        let mut file = AnimationWriter::create(path, self.style.size, self.fps)?;
        for place in 0..self.len() {
            file.push(&self.picture(place)?)?;
        }
        file.finish()
    }
}

/// The box of what moves over all these moments, and a floor below everything.
fn survey<R: Read + Seek>(cache: &mut Playback<R>, moments: &[usize]) -> Result<(Bounds, Ground), ViewError> {
    let (mut stage, mut all) = (Bounds::default(), Bounds::default());
    for moment in moments {
        let positions = positions(cache, *moment)?;
        let objects = objects(cache, *moment, &positions)?;
        stage.merge(&Bounds::of_interest(&objects));
        objects.iter().for_each(|object| all.include(object.positions));
    }
    Ok((stage, Ground::At(super::floor_below(&all, &stage))))
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Positions of every object at a moment.
fn positions<R: Read + Seek>(
    cache: &mut Playback<R>,
    moment: usize,
) -> Result<Vec<Vec<[f32; 3]>>, ViewError> {
    let objects = 0..cache.objects().len();
    let read = |object| cache.positions(object, moment).map_err(|source| ViewError::Read { source });
    objects.map(read).collect()
}

/// Every object as it is at a moment.
fn objects<'a, R: Read + Seek>(
    cache: &'a mut Playback<R>,
    moment: usize,
    positions: &'a [Vec<[f32; 3]>],
) -> Result<Vec<Object<'a>>, ViewError> {
    let radii = cache.run().radii.clone();
    let objects = cache.objects_at(moment).map_err(|source| ViewError::Read { source })?;
    let objects = objects.into_iter().zip(positions);
    Ok(objects
        .map(|(object, positions)| Object {
            name: &object.name,
            kind: match object.kind {
                ObjectKind::Cloth => Kind::Cloth,
                ObjectKind::Collider => Kind::Collider,
                ObjectKind::Particles => Kind::Particles,
            },
            faces: &object.faces,
            positions,
            rest: Some(&object.rest),
            radius: radii.get(&object.name).map(|radius| *radius as f32),
        })
        .collect())
}
