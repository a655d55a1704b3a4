//! The pictures of a cache: one camera, one floor, and a picture per recorded frame.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{CameraView, LiquidSurface, ObjectKind, Playback, SurfaceShape};
use nucleus_core::{Faces, ParticleLook};

use super::animation::AnimationWriter;
use super::camera::Camera;
use super::draw::draw_with;
use super::image::Image;
use super::scene::{Bounds, Ground, Kind, Object, Style};
use super::visibility::Fragment;
use crate::error::ViewError;

/// A run as pictures with one camera and one floor, so that nothing moves but the objects.
///
/// The floor is the ground plane of the scene where the cache has one; it moves with the plane.
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
    /// The recorded times that are shown, as indices into the cache.
    moments: Vec<usize>,
    /// Of how many recorded frames one is shown.
    every: usize,
    camera: Camera,
    /// A camera of the scene that replaces `camera`.
    scene_camera: Option<nucleus_cache::Camera>,
    /// The box around the simulated objects over the run.
    stage: Bounds,
    style: Style,
    /// Whether the floor is the ground plane, which may move.
    is_ground_plane: bool,
    /// By object, the spacing of the particles whose surface is drawn.
    spacings: Vec<Option<f32>>,
    /// The visibility buffer of the last picture.
    fragments: Vec<Fragment>,
}

impl<'a, R: Read + Seek> Film<'a, R> {
    /// The ends of every `every`th frame of a run. The camera frames the cloth, with the colliders near it, over all of them.
    ///
    /// # Errors
    /// If all of these frames are damaged, or the cache has none.
    pub fn of(cache: &'a mut Playback<R>, every: usize, style: Style) -> Result<Self, ViewError> {
        let every = every.max(1);
        let ends =
            (0..cache.time_samples().len()).filter(|moment| cache.time_samples()[*moment].ends_frame());
        let moments: Vec<usize> = ends.step_by(every).collect();
        if moments.is_empty() {
            return Err(ViewError::NoRecordedFrame);
        }
        // The last frame is often that of a still.
        let last = cache.time_samples().len() - 1;
        let surveyed: Vec<usize> =
            moments.iter().copied().filter(|&moment| moment != last).chain([last]).collect();
        let Survey { framed, stage, floor } = survey(cache, &surveyed, &style)?;
        let camera = Camera::framing(&framed, style.size);
        let is_ground_plane = style.ground == Ground::Below;
        let ground = if is_ground_plane { floor } else { style.ground };
        let style = Style { ground, ..style };
        let (scene_camera, fragments) = (None, Vec::new());
        let spacings = spacings(cache, &style).map_err(|source| ViewError::Read { source })?;
        Ok(Self {
            cache,
            moments,
            every,
            camera,
            scene_camera,
            stage,
            style,
            is_ground_plane,
            spacings,
            fragments,
        })
    }

    /// Takes every `every`th of the recorded frames from `first` to `last` instead; the camera stays that of the whole run.
    ///
    /// # Errors
    /// If none of them was recorded.
    pub fn between(mut self, first: i32, last: i32) -> Result<Self, ViewError> {
        let moments = self.cache.time_samples().iter().enumerate();
        let within = moments.filter(|(_, at)| at.ends_frame() && (first..=last).contains(&at.frame));
        self.moments = within.map(|(moment, _)| moment).step_by(self.every).collect();
        if self.moments.is_empty() { Err(ViewError::NoRecordedFrame) } else { Ok(self) }
    }

    /// Keeps at most `fps` pictures per second. Each is shown until the next one that is kept.
    pub fn at_most(mut self, fps: f64) -> Self {
        let frames = (self.cache.run().frames_per_second / fps - 1e-6).ceil() as i64;
        let moments = self.cache.time_samples();
        let mut last = None;
        self.moments.retain(|&moment| {
            let frame = i64::from(moments[moment].frame);
            let is_kept = last.is_none_or(|last| frame - last >= frames);
            last = if is_kept { Some(frame) } else { last };
            is_kept
        });
        self
    }

    /// The lowest constant rate, in ticks per second, at which every picture is shown for a whole number of ticks.
    pub fn fps(&self) -> f64 {
        let frames_per_tick = (0..self.len()).map(|index| self.frames_shown(index)).fold(0, gcd);
        self.cache.run().frames_per_second / frames_per_tick as f64
    }

    /// For how many seconds a picture is shown: until the next one; the last one as long as the one before.
    pub fn duration(&self, index: usize) -> f64 {
        self.frames_shown(index) as f64 / self.cache.run().frames_per_second
    }

    /// For how many frames of the run a picture is shown; one if it is the only picture.
    fn frames_shown(&self, index: usize) -> u64 {
        let begin = index.min(self.len().saturating_sub(2));
        (i64::from(self.frame(begin + 1)) - i64::from(self.frame(begin))).max(1) as u64
    }

    /// The camera of all pictures, unless a camera of the scene replaces it.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// The box around the cloth and the colliders near it at one recorded time, by its index in the cache.
    ///
    /// # Errors
    /// If the index is out of range, or the frame is damaged.
    pub fn bounds(&mut self, moment: usize) -> Result<Bounds, ViewError> {
        let states = states(self.cache, moment)?;
        Ok(Bounds::to_frame(&objects(self.cache, moment, &states)?))
    }

    /// The frame of a picture.
    pub fn frame(&self, index: usize) -> i32 {
        self.cache.time_samples()[self.moments[index.min(self.moments.len() - 1)]].frame
    }

    /// Replaces the camera.
    pub fn seen_by(self, camera: Camera) -> Self {
        Self { camera, ..self }
    }

    /// Replaces the camera by a camera of the scene, which may be animated.
    pub fn seen_through(self, camera: nucleus_cache::Camera) -> Self {
        Self { scene_camera: Some(camera), ..self }
    }

    /// The floor at a recorded time: the ground plane, if there is one.
    fn ground_at(&self, moment: usize) -> Ground {
        let (run, moments) = (self.cache.run(), self.cache.time_samples());
        let frame =
            moments.get(moment).map(|moment| f64::from(run.start) + moment.time * run.frames_per_second);
        let plane = frame.filter(|_| self.is_ground_plane).and_then(|frame| run.ground_at(frame));
        plane.map_or(self.style.ground, |plane| Ground::Plane {
            origin: plane.origin.map(|x| x as f32),
            normal: plane.normal.map(|x| x as f32),
        })
    }

    /// The camera at a recorded time. Within a frame, the pose of a camera of the scene is interpolated linearly.
    fn camera_at(&self, moment: usize) -> Camera {
        let (run, moments) = (self.cache.run(), self.cache.time_samples());
        let Some((track, moment)) = self.scene_camera.as_ref().zip(moments.get(moment)) else {
            return self.camera;
        };
        let after_frame = moment.time * run.frames_per_second - f64::from(moment.frame - run.start);
        let at = |frame| track.at(frame, run.start);
        let Some((before, now)) = at(moment.frame - 1).zip(at(moment.frame)) else { return self.camera };
        let view = match after_frame < -1e-6 {
            true => CameraView::between(before, now, (1.0 + after_frame) as f32),
            false => *now,
        };
        Camera::of_scene(&view, track.fit, self.style.size, &self.stage)
    }

    /// The number of pictures, at least one.
    #[expect(clippy::len_without_is_empty, reason = "a film is never empty")]
    pub fn len(&self) -> usize {
        self.moments.len()
    }

    /// The picture at an index of the film; the last one beyond its end.
    ///
    /// # Errors
    /// If its frame is damaged.
    pub fn picture(&mut self, index: usize) -> Result<Image, ViewError> {
        let moment = self.moments[index.min(self.moments.len() - 1)];
        self.moment(moment)
    }

    /// The picture at any recorded time, by its index in the cache.
    ///
    /// # Errors
    /// If the index is out of range, or the frame is damaged.
    pub fn moment(&mut self, moment: usize) -> Result<Image, ViewError> {
        let (mut states, camera) = (states(self.cache, moment)?, self.camera_at(moment));
        for (object, (state, spacing)) in states.iter_mut().zip(&self.spacings).enumerate() {
            let Some(spacing) = spacing else { continue };
            let shape = self.cache.surface_shape(object).map_err(|source| ViewError::Read { source })?;
            state.cover(*spacing, shape);
        }
        let style = Style { ground: self.ground_at(moment), ..self.style.clone() };
        Ok(draw_with(&mut self.fragments, &objects(self.cache, moment, &states)?, &camera, &style))
    }

    /// Writes all pictures as one animated PNG that plays in real time.
    ///
    /// # Errors
    /// If a frame is damaged or the file cannot be written.
    pub fn write(&mut self, path: impl AsRef<Path>) -> Result<(), ViewError> {
        let mut file = AnimationWriter::create(path, self.style.size)?;
        for index in 0..self.len() {
            file.push(&self.picture(index)?, self.duration(index))?;
        }
        file.finish()
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The space that a run takes up.
struct Survey {
    /// The box that a camera frames.
    framed: Bounds,
    /// The box around the simulated objects.
    stage: Bounds,
    /// A floor below all objects.
    floor: Ground,
}

/// Surveys a run at these recorded times. Damaged frames are left out, unless all are: others can be drawn without them.
fn survey<R: Read + Seek>(
    cache: &mut Playback<R>,
    moments: &[usize],
    style: &Style,
) -> Result<Survey, ViewError> {
    let [mut framed, mut stage, mut all] = [Bounds::default(); 3];
    let mut damaged = None;
    for moment in moments {
        let states = match states(cache, *moment) {
            Err(error) if error.is_damage() => {
                damaged = Some(error);
                continue;
            }
            states => states?,
        };
        let objects = objects(cache, *moment, &states)?;
        framed.merge(&Bounds::to_frame(&drawn(&objects, style)));
        stage.merge(&Bounds::of_interest(&objects));
        objects.iter().for_each(|object| all.include_object(object));
    }
    if let Some(error) = damaged.filter(|_| framed == Bounds::default()) {
        return Err(error);
    }
    Ok(Survey { framed, stage, floor: Ground::At(all.floor_below(&framed, &stage)) })
}

/// The objects that are drawn; all if none is.
fn drawn<'a>(objects: &[Object<'a>], style: &Style) -> Vec<Object<'a>> {
    let drawn: Vec<Object> = objects.iter().filter(|object| style.shows(object.name)).copied().collect();
    if drawn.is_empty() { objects.to_vec() } else { drawn }
}

/// An object at a recorded time.
struct ObjectState {
    positions: Vec<[f32; 3]>,
    looks: Option<Vec<ParticleLook>>,
    /// The faces of the surface of its particles, where that is drawn.
    surface: Option<Faces>,
}

impl ObjectState {
    /// Replaces particles by their surface.
    fn cover(&mut self, spacing: f32, shape: SurfaceShape) {
        let LiquidSurface { positions, quads } = LiquidSurface::of(&self.positions, spacing, shape);
        let faces = quads.iter().map(|quad| &quad[..]).collect();
        *self = Self { positions, looks: None, surface: Some(faces) };
    }
}

/// The spacing of the particles of each object; `None` for other objects, and where no surface is drawn.
fn spacings<R: Read + Seek>(
    cache: &mut Playback<R>,
    style: &Style,
) -> Result<Vec<Option<f32>>, nucleus_cache::ReadError> {
    let is_drawn: Vec<bool> =
        cache.objects().iter().map(|object| style.surfaces && style.shows(&object.name)).collect();
    let spacing = |(object, is_drawn)| if is_drawn { cache.particle_spacing(object) } else { Ok(None) };
    is_drawn.into_iter().enumerate().map(spacing).collect()
}

/// Every object at a recorded time.
fn states<R: Read + Seek>(cache: &mut Playback<R>, moment: usize) -> Result<Vec<ObjectState>, ViewError> {
    let objects = 0..cache.objects().len();
    let read = |object| {
        let positions = cache.positions(object, moment)?;
        Ok(ObjectState { positions, looks: cache.looks(object, moment)?, surface: None })
    };
    objects.map(read).collect::<Result<_, _>>().map_err(|source| ViewError::Read { source })
}

/// Every object at a recorded time, to draw.
fn objects<'a, R: Read + Seek>(
    cache: &'a mut Playback<R>,
    moment: usize,
    states: &'a [ObjectState],
) -> Result<Vec<Object<'a>>, ViewError> {
    let radii = cache.run().radii.clone();
    let objects = cache.objects_at(moment).map_err(|source| ViewError::Read { source })?;
    let objects = objects.into_iter().zip(states);
    Ok(objects
        .map(|(object, state)| Object {
            name: &object.name,
            kind: match object.kind {
                ObjectKind::Particles if state.surface.is_none() => Kind::Particles,
                ObjectKind::Cloth | ObjectKind::Particles => Kind::Cloth,
                ObjectKind::Collider => Kind::Collider,
            },
            faces: state.surface.as_ref().unwrap_or(&object.faces),
            positions: &state.positions,
            looks: state.looks.as_deref(),
            rest: Some(&object.rest[..]).filter(|_| state.surface.is_none()),
            radius: radii.get(&object.name).map(|radius| *radius as f32),
        })
        .collect())
}
