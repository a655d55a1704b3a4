//! Compares two caches: where they differ first, and by how much.

use std::io::{Read, Seek};

use crate::error::ReadError;
use crate::read::playback::Playback;
use crate::read::time_index::TimeSample;

/// One difference between two caches.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Difference {
    /// Only one cache has the object.
    Object {
        /// Its name.
        name: String,
        /// Whether the first cache has it.
        in_first: bool,
    },
    /// An object has other faces or another number of points; the first such time sample.
    Mesh {
        /// Its name.
        name: String,
        /// The frame.
        frame: i32,
        /// The substep, counted from 1; 0 is the initial state.
        substep: u32,
    },
    /// Only one cache has the time sample.
    TimeSample {
        /// Its frame.
        frame: i32,
        /// Substep of the sample.
        substep: u32,
        /// Whether the first cache has it.
        in_first: bool,
    },
    /// Positions differ.
    Points(PointDifference),
}

/// The first time sample at which an object's positions differ.
#[derive(Debug, Clone, PartialEq)]
pub struct PointDifference {
    /// The object.
    pub object: String,
    /// The frame.
    pub frame: i32,
    /// The substep, counted from 1; 0 is the initial state.
    pub substep: u32,
    /// The first point that differs.
    pub point: usize,
    /// Distance of that point between the caches, in scene units.
    pub distance: f64,
    /// The point that differs most at this sample, and its distance in scene units.
    pub farthest: (usize, f64),
    /// Number of points that differ at this sample.
    pub points: usize,
}

/// The result of [`compare`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Comparison {
    /// Number of compared time samples: those that both caches have.
    pub time_samples: usize,
    /// Differences: first of objects, then of time samples, then the first mesh and position difference of each object.
    pub differences: Vec<Difference>,
    /// Root mean square distance over all compared points and time samples, in scene units.
    pub rms: f64,
    /// The sample with the largest distance.
    pub largest: Option<PointDifference>,
}

/// Compares what two caches show. Distances up to `tolerance`, in scene units, are no difference; at 0 every bit
/// counts, save that all not-a-numbers are alike.
///
/// Only what is shown counts, not how it is packed: caches of substeps and of frames are compared where both
/// have time_samples.
///
/// # Errors
/// When a frame of either cannot be read.
pub fn compare<A: Read + Seek, B: Read + Seek>(
    a: &mut Playback<A>,
    b: &mut Playback<B>,
    tolerance: f64,
) -> Result<Comparison, ReadError> {
    let mut comparison = Comparison::default();
    let objects = common_objects(a, b, &mut comparison.differences);
    let time_samples = common_moments(a, b, &mut comparison.differences);
    comparison.time_samples = time_samples.len();
    let mut sum = SquaredError::default();
    let (mut seen, mut seen_mesh) = (vec![false; objects.len()], vec![false; objects.len()]);
    for &(moment_a, moment_b) in &time_samples {
        for (place, &(object_a, object_b)) in objects.iter().enumerate() {
            let (one, two) = (a.object_at(object_a, moment_a)?, b.object_at(object_b, moment_b)?);
            let is_comparable = one.rest.len() == two.rest.len();
            let is_same = is_comparable && one.faces == two.faces;
            if !is_same && !std::mem::replace(&mut seen_mesh[place], true) {
                let (name, TimeSample { frame, substep, .. }) =
                    (one.name.clone(), a.time_samples()[moment_a]);
                comparison.differences.push(Difference::Mesh { name, frame, substep });
            }
            if !is_comparable {
                continue;
            }
            let (one, two) = (a.positions(object_a, moment_a)?, b.positions(object_b, moment_b)?);
            let Some(mut found) = first_difference(&one, &two, tolerance, &mut sum) else { continue };
            let sample = a.time_samples()[moment_a];
            found.object.clone_from(&a.objects()[object_a].name);
            (found.frame, found.substep) = (sample.frame, sample.substep);
            let most = comparison.largest.as_ref().map_or(0.0, |largest| largest.farthest.1);
            if comparison.largest.is_none() || found.farthest.1 > most {
                comparison.largest = Some(found.clone());
            }
            if !std::mem::replace(&mut seen[place], true) {
                comparison.differences.push(Difference::Points(found));
            }
        }
    }
    comparison.rms = sum.rms();
    Ok(comparison)
}

/// Sum of squared distances.
#[derive(Default)]
struct SquaredError {
    squares: f64,
    points: u64,
}

impl SquaredError {
    fn rms(&self) -> f64 {
        (self.squares / self.points.max(1) as f64).sqrt()
    }
}

/// Compares positions at one sample; the caller fills in object and frame.
fn first_difference(
    a: &[[f32; 3]],
    b: &[[f32; 3]],
    tolerance: f64,
    sum: &mut SquaredError,
) -> Option<PointDifference> {
    let mut found: Option<PointDifference> = None;
    for (point, (one, two)) in a.iter().zip(b).enumerate() {
        let distance = distance(one, two);
        if distance.is_finite() {
            sum.squares += distance * distance;
        }
        sum.points += 1;
        if distance <= tolerance && !(tolerance == 0.0 && differs_in_bits(one, two)) {
            continue;
        }
        match &mut found {
            Some(found) => {
                found.points += 1;
                if distance > found.farthest.1 {
                    found.farthest = (point, distance);
                }
            }
            None => {
                let (object, frame, substep) = (String::new(), 0, 0);
                let farthest = (point, distance);
                found =
                    Some(PointDifference { object, frame, substep, point, distance, farthest, points: 1 });
            }
        }
    }
    found
}

/// Euclidean distance; infinite where exactly one of them is not finite.
fn distance(a: &[f32; 3], b: &[f32; 3]) -> f64 {
    let squares = (0..3).map(|axis| match (a[axis].is_finite(), b[axis].is_finite()) {
        (true, true) => (f64::from(a[axis]) - f64::from(b[axis])).powi(2),
        (false, false) if a[axis] == b[axis] || a[axis].is_nan() && b[axis].is_nan() => 0.0,
        _ => f64::INFINITY,
    });
    squares.sum::<f64>().sqrt()
}

/// Whether the bits differ, as for zero and minus zero; all NaNs are equal.
fn differs_in_bits(a: &[f32; 3], b: &[f32; 3]) -> bool {
    (0..3).any(|axis| a[axis].to_bits() != b[axis].to_bits() && !(a[axis].is_nan() && b[axis].is_nan()))
}

/// Indices in both caches of the objects that both have.
fn common_objects<A: Read + Seek, B: Read + Seek>(
    a: &Playback<A>,
    b: &Playback<B>,
    differences: &mut Vec<Difference>,
) -> Vec<(usize, usize)> {
    let mut common = Vec::new();
    for (place, object) in a.objects().iter().enumerate() {
        match b.objects().iter().position(|other| other.name == object.name) {
            None => differences.push(Difference::Object { name: object.name.clone(), in_first: true }),
            Some(other) => common.push((place, other)),
        }
    }
    let only_b =
        b.objects().iter().filter(|object| a.objects().iter().all(|other| other.name != object.name));
    differences
        .extend(only_b.map(|object| Difference::Object { name: object.name.clone(), in_first: false }));
    common
}

/// Indices in both caches of the time samples that both have. Of the other samples, only the first of each cache at a
/// frame end is a difference: the recorded sample rate does not matter.
fn common_moments<A: Read + Seek, B: Read + Seek>(
    a: &Playback<A>,
    b: &Playback<B>,
    differences: &mut Vec<Difference>,
) -> Vec<(usize, usize)> {
    let (mut i, mut j) = (0, 0);
    let mut common = Vec::new();
    let (one, two) = (a.time_samples(), b.time_samples());
    let mut told = [false; 2];
    while i < one.len() || j < two.len() {
        let order = match (one.get(i), two.get(j)) {
            (Some(x), Some(y)) => x.log_time.cmp(&y.log_time),
            (Some(_), None) => std::cmp::Ordering::Less,
            _ => std::cmp::Ordering::Greater,
        };
        let lonely = match order {
            std::cmp::Ordering::Equal => {
                common.push((i, j));
                (i, j) = (i + 1, j + 1);
                continue;
            }
            std::cmp::Ordering::Less => {
                i += 1;
                (one[i - 1], true)
            }
            std::cmp::Ordering::Greater => {
                j += 1;
                (two[j - 1], false)
            }
        };
        let (sample, in_first) = lonely;
        if sample.ends_frame() && !std::mem::replace(&mut told[usize::from(in_first)], true) {
            let (frame, substep) = (sample.frame, sample.substep);
            differences.push(Difference::TimeSample { frame, substep, in_first });
        }
    }
    common
}
