//! What the builder refuses: meshes, starts and particles that the solver cannot handle, with the element at fault.

use nalgebra::Vector3;

use crate::input::particles::{CollisionEvent, ParticleRamp};
use crate::input::validation::{MAX_COORDINATE, is_in_range};
use crate::model::build_error::BuildError;
use crate::model::objects::{Cloth, Particles, Start};
use crate::model::surface::Surface;

/// Refuses woven cloth in which a face has no direction of the warp.
pub fn check_warp(cloth: &Cloth) -> Result<(), BuildError> {
    let faces = cloth.surface.faces.len();
    if !cloth.warp.is_empty() && cloth.warp.len() != faces {
        return Err(BuildError::WarpCount { given: cloth.warp.len(), faces });
    }
    let is_direction = |warp: &Vector3<f64>| is_in_range(warp) && warp.norm() > 0.0;
    match cloth.warp.iter().position(|warp| !is_direction(warp)) {
        Some(face) => Err(BuildError::BadWarp { face }),
        None => Ok(()),
    }
}

/// Refuses points that are split off one that is no original.
pub fn check_split(cloth: &Cloth) -> Result<(), BuildError> {
    let points = cloth.surface.positions.len().saturating_sub(cloth.split_off.len());
    match cloth.split_off.iter().find(|&&point| point as usize >= points) {
        Some(&point) => Err(BuildError::BadSplit { point, points }),
        None => Ok(()),
    }
}

/// Refuses a start that lacks a point, or has an invalid value.
pub fn check_start(start: &Start, points: usize) -> Result<(), BuildError> {
    for (column, [one, what]) in
        [(&start.positions, ["position", "positions"]), (&start.velocities, ["velocity", "velocities"])]
    {
        if !column.is_empty() && column.len() != points {
            return Err(BuildError::StartCount { what, given: column.len(), points });
        }
        if let Some(point) = column.iter().position(|given| !is_in_range(given)) {
            return Err(BuildError::BadStart { what: one, point });
        }
    }
    Ok(())
}

/// Largest capacity for the particles of one object: rows are counted in 32 bits.
const MAX_PARTICLES: usize = 100_000_000;

/// Least length of the longest edge of a mesh in metres. Squares of shorter ones are nothing in `f32`.
const MIN_EDGE: f64 = 1e-9;

/// Refuses particles with faces, more of them than the capacity, lifespans that are no times, and events whose numbers
/// are out of range.
pub fn check_particles(surface: &Surface, particles: &Particles) -> Result<(), BuildError> {
    let (points, capacity) = (surface.positions.len(), particles.capacity);
    if points > capacity || capacity == 0 {
        return Err(BuildError::Capacity { points, capacity });
    }
    if capacity > MAX_PARTICLES {
        return Err(BuildError::TooManyParticles { capacity, most: MAX_PARTICLES });
    }
    let radius = particles.radius;
    if !(0.0..=MAX_COORDINATE).contains(&radius) {
        return Err(BuildError::BadRadius { radius });
    }
    if let Some(event) = particles.events.iter().position(|event| !is_event(event)) {
        return Err(BuildError::BadEvent { event });
    }
    let lifespans = particles.lifespans.len();
    if lifespans > 0 && lifespans != points {
        return Err(BuildError::StartCount { what: "lifespans", given: lifespans, points });
    }
    for (given, what) in [(particles.ages.len(), "ages"), (particles.ids.len(), "numbers")] {
        if given > 0 && given != points {
            return Err(BuildError::StartCount { what, given, points });
        }
    }
    if !particles.ramps.iter().all(ParticleRamp::is_valid)
        || particles.ages.iter().any(|age| !age.is_finite())
        || particles.ids.iter().any(|&id| id >= 1 << 63)
        || !surface.faces.is_empty()
        || particles.lifespans.iter().any(|lifespan| lifespan.is_nan() || *lifespan < 0.0)
    {
        return Err(BuildError::BadParticles);
    }
    if points > 0 { check_surface(surface) } else { Ok(()) }
}

/// Whether the numbers of a collision event are in range. New particles may live forever, but no range is infinite.
fn is_event(event: &CollisionEvent) -> bool {
    let [mean, width] = event.lifespan;
    event.probability.is_finite() && event.spread.is_finite() && !mean.is_nan() && width.is_finite()
}

/// Refuses meshes that the solver cannot handle.
pub fn check_surface(surface: &Surface) -> Result<(), BuildError> {
    let points = surface.positions.len();
    if points == 0 {
        return Err(BuildError::NoPoints);
    }
    if let Some(point) = surface.positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(BuildError::NotFinite { point });
    }
    if let Some(point) = surface.positions.iter().position(|p| !is_in_range(p)) {
        return Err(BuildError::TooFar { point });
    }
    for (face, corners) in surface.faces.iter().enumerate() {
        if let Some(&point) = corners.iter().find(|&&point| point as usize >= points) {
            return Err(BuildError::FaceOutOfRange { face, point, points });
        }
        let repeats = (1..corners.len()).any(|k| corners[..k].contains(&corners[k]));
        if corners.len() < 3 || repeats {
            return Err(BuildError::DegenerateFace { face });
        }
    }
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|point| surface.positions[point as usize]);
        (b - a).cross(&(c - a)).norm()
    };
    if !surface.faces.is_empty() && !surface.faces.triangles().map(area).any(|area| area > 0.0) {
        return Err(BuildError::NoArea);
    }
    let length = longest_edge(surface);
    if !surface.faces.is_empty() && length < MIN_EDGE {
        return Err(BuildError::TooSmall { length, least: MIN_EDGE });
    }
    Ok(())
}

/// The length of the longest edge of a face, in metres.
fn longest_edge(surface: &Surface) -> f64 {
    let place = |point: u32| surface.positions[point as usize];
    let edges = surface.faces.iter().flat_map(|face| {
        (0..face.len()).map(|k| (place(face[k]) - place(face[(k + 1) % face.len()])).norm())
    });
    edges.fold(0.0, f64::max)
}
