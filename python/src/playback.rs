//! Caches: positions, velocities and strain by object and frame, and the reports of frames.

use std::sync::{Arc, Mutex, PoisonError};

use nucleus_cache::{ObjectInfo, ObjectKind, ReadError};
use nucleus_core::Particle;
use pyo3::exceptions::{PyKeyError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;

use crate::array::Rows;

/// An open cache.
#[pyclass(frozen, module = "nucleus._nucleus")]
pub struct Playback(Mutex<nucleus_cache::Playback>);

impl Playback {
    /// Uses the cache without holding the interpreter.
    fn with<T: Send>(&self, py: Python, using: impl FnOnce(&mut nucleus_cache::Playback) -> T + Send) -> T {
        py.detach(|| using(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

/// The indices of an object and of the last state of a frame.
fn place(cache: &nucleus_cache::Playback, name: &str, frame: Option<i32>) -> PyResult<(usize, usize)> {
    let objects = cache.objects();
    let object = objects.iter().position(|object| object.name == name).ok_or_else(|| {
        let names: Vec<String> = objects.iter().map(|object| format!("`{}`", object.name)).collect();
        PyKeyError::new_err(format!("the cache has no object `{name}`; it has {}", names.join(", ")))
    })?;
    let samples = cache.time_samples();
    let sample = frame.map_or_else(|| samples.len().checked_sub(1), |frame| cache.end_of(frame));
    let sample = sample.ok_or_else(|| {
        let range = samples.first().zip(samples.last());
        let has = range.map(|(first, last)| format!("it has {} to {}", first.frame, last.frame));
        let frame = frame.map_or("frame".to_owned(), |frame| format!("frame {frame}"));
        PyKeyError::new_err(format!("the cache has no {frame}; {}", has.unwrap_or("it is empty".to_owned())))
    })?;
    Ok((object, sample))
}

fn unreadable(error: ReadError) -> PyErr {
    PyOSError::new_err(error.to_string())
}

/// Refuses a channel that was not recorded.
fn recorded<T>(found: Option<T>, what: &str) -> PyResult<T> {
    found.ok_or_else(|| {
        PyValueError::new_err(format!(
            "the cache has no {what}; record them with `nucleus run --record {what}`"
        ))
    })
}

#[pymethods]
impl Playback {
    /// Opens a cache, also the unfinished one of a run that is still going.
    #[new]
    fn open(py: Python, path: String) -> PyResult<Self> {
        let opened = py.detach(|| nucleus_cache::Playback::open(&path));
        let cache = opened.map_err(|error| PyOSError::new_err(format!("cannot open `{path}`: {error}")))?;
        Ok(Self(Mutex::new(cache)))
    }

    /// Facts as JSON: frames, units, objects, the scene, further metadata, and what is lost.
    fn facts(&self, py: Python) -> String {
        self.with(py, |cache| {
            let run = cache.run();
            let kind = |object: &ObjectInfo| match object.kind {
                ObjectKind::Cloth => "cloth",
                ObjectKind::Collider => "collider",
                ObjectKind::Particles => "particles",
            };
            let object = |object: &ObjectInfo| {
                json!({ "name": object.name, "kind": kind(object), "points": object.rest.len() })
            };
            let mut frames: Vec<i32> = cache.time_samples().iter().map(|sample| sample.frame).collect();
            frames.dedup();
            json!({
                "frames": frames, "fps": run.frames_per_second, "units_per_metre": run.units_per_metre,
                "objects": cache.objects().iter().map(object).collect::<Vec<_>>(),
                "scene_path": run.scene_path, "scene": run.scene_text, "extra": run.extra,
                "is_intact": cache.corruption().is_intact(), "corruption": cache.corruption().to_string(),
            })
            .to_string()
        })
    }

    /// Positions at the end of a frame in scene units; of the last frame without one.
    fn positions(&self, py: Python, name: &str, frame: Option<i32>) -> PyResult<Rows> {
        self.with(py, |cache| {
            let (object, sample) = place(cache, name, frame)?;
            cache.positions(object, sample).map(|rows| Rows(Arc::new(rows))).map_err(unreadable)
        })
    }

    /// Velocities in scene units per second, where they are recorded.
    fn velocities(&self, py: Python, name: &str, frame: Option<i32>) -> PyResult<Rows> {
        self.with(py, |cache| {
            let (object, sample) = place(cache, name, frame)?;
            let found = cache.velocities(object, sample).map_err(unreadable)?;
            recorded(found, "velocities").map(|rows| Rows(Arc::new(rows)))
        })
    }

    /// Strain at each point as 32-bit floats, where it is recorded.
    fn strain<'py>(&self, py: Python<'py>, name: &str, frame: Option<i32>) -> PyResult<Bound<'py, PyBytes>> {
        let strain: Vec<u8> = self.with(py, |cache| {
            let (object, sample) = place(cache, name, frame)?;
            let found = recorded(cache.strain(object, sample).map_err(unreadable)?, "strain")?;
            Ok::<_, PyErr>(found.iter().flat_map(|x| x.to_ne_bytes()).collect())
        })?;
        Ok(PyBytes::new(py, &strain))
    }

    /// Number (64-bit), age, lifespan and mass (64-bit floats) of each particle of an object whose particles have their own.
    fn particles<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        frame: Option<i32>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let bytes: Vec<u8> = self.with(py, |cache| {
            let (object, sample) = place(cache, name, frame)?;
            let found = cache.particles(object, sample).map_err(unreadable)?.unwrap_or_default();
            let numbers = |one: &Particle| [one.age, one.lifespan, one.mass].map(f64::to_ne_bytes);
            let row = |one: &Particle| [[one.id.to_ne_bytes()].as_slice(), &numbers(one)].concat().concat();
            Ok::<_, PyErr>(found.iter().flat_map(row).collect())
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The faces of an object: corners of each face, and points of all corners, as unsigned 32-bit numbers.
    fn faces<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
        let (counts, corners) = self.with(py, |cache| {
            let (object, _) = place(cache, name, None)?;
            let faces = &cache.objects()[object].faces;
            let bytes = |x: u32| x.to_ne_bytes();
            let counts: Vec<u8> = faces.iter().flat_map(|face| bytes(face.len() as u32)).collect();
            Ok::<_, PyErr>((counts, faces.corners().iter().copied().flat_map(bytes).collect::<Vec<u8>>()))
        })?;
        Ok((PyBytes::new(py, &counts), PyBytes::new(py, &corners)))
    }

    /// The reports of all frames, as JSON.
    fn reports(&self, py: Python) -> PyResult<String> {
        self.with(py, |cache| cache.reports().map(|all| json!(all).to_string()).map_err(unreadable))
    }
}
