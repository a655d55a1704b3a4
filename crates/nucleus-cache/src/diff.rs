//! Where two caches differ first, and by how much.

use std::io::{Read, Seek};

use crate::moment::RecordedMoment;
use crate::open_error::ReadError;
use crate::playback::Playback;

/// What two caches differ in.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Difference {
    /// An object is in one of them only.
    Object {
        /// Its name.
        name: String,
        /// Whether it is in the first.
        in_first: bool,
    },
    /// An object has other faces or another number of points, first at this moment.
    Mesh {
        /// Its name.
        name: String,
        /// The frame.
        frame: i32,
        /// The substep, counted from 1; 0 is the initial state.
        substep: u32,
    },
    /// A moment was recorded in one of them only.
    Moment {
        /// Its frame.
        frame: i32,
        /// Its place in the frame.
        substep: u32,
        /// Whether it is in the first.
        in_first: bool,
    },
    /// Points are elsewhere.
    Points(PointDifference),
}

/// The first moment at which an object is not where it is in the other cache.
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
    /// How far that point is from its place in the other, in scene units.
    pub distance: f64,
    /// The point that differs most at this moment, and by how much.
    pub farthest: (usize, f64),
    /// Points that differ at this moment.
    pub points: usize,
}

/// Two caches, compared.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Comparison {
    /// Moments that were compared, those that both have.
    pub moments: usize,
    /// What differs: first in objects, then in moments, then the first mesh and the first place of each object.
    pub differences: Vec<Difference>,
    /// Root mean square distance over all points and moments, in scene units.
    pub rms: f64,
    /// The largest distance of all, in scene units, and where it is.
    pub largest: Option<PointDifference>,
}

/// Compares what two caches show. Distances up to `tolerance`, in scene units, are no difference; at 0 every bit
/// counts, save that all not-a-numbers are alike.
///
/// Only what is shown counts, not how it is packed: caches of substeps and of frames are compared where both
/// have moments.
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
    let moments = common_moments(a, b, &mut comparison.differences);
    comparison.moments = moments.len();
    let mut sum = Sum::default();
    let (mut seen, mut seen_mesh) = (vec![false; objects.len()], vec![false; objects.len()]);
    for &(moment_a, moment_b) in &moments {
        for (place, &(object_a, object_b)) in objects.iter().enumerate() {
            let (one, two) = (a.object_at(object_a, moment_a)?, b.object_at(object_b, moment_b)?);
            let is_comparable = one.rest.len() == two.rest.len();
            let is_same = is_comparable && one.faces == two.faces;
            if !is_same && !std::mem::replace(&mut seen_mesh[place], true) {
                let (name, RecordedMoment { frame, substep, .. }) = (one.name.clone(), a.moments()[moment_a]);
                comparison.differences.push(Difference::Mesh { name, frame, substep });
            }
            if !is_comparable {
                continue;
            }
            let (one, two) = (a.positions(object_a, moment_a)?, b.positions(object_b, moment_b)?);
            let Some(mut found) = first_difference(&one, &two, tolerance, &mut sum) else { continue };
            let moment = a.moments()[moment_a];
            found.object.clone_from(&a.objects()[object_a].name);
            (found.frame, found.substep) = (moment.frame, moment.substep);
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

/// Squares of distances, added up.
#[derive(Default)]
struct Sum {
    squares: f64,
    points: u64,
}

impl Sum {
    fn rms(&self) -> f64 {
        (self.squares / self.points.max(1) as f64).sqrt()
    }
}

/// What differs between positions at one moment; names are left to the caller.
fn first_difference(
    a: &[[f32; 3]],
    b: &[[f32; 3]],
    tolerance: f64,
    sum: &mut Sum,
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

/// Infinite where one of them is no number and the other is.
fn distance(a: &[f32; 3], b: &[f32; 3]) -> f64 {
    let squares = (0..3).map(|axis| match (a[axis].is_finite(), b[axis].is_finite()) {
        (true, true) => (f64::from(a[axis]) - f64::from(b[axis])).powi(2),
        (false, false) if a[axis] == b[axis] || a[axis].is_nan() && b[axis].is_nan() => 0.0,
        _ => f64::INFINITY,
    });
    squares.sum::<f64>().sqrt()
}

/// Zero and minus zero, say.
fn differs_in_bits(a: &[f32; 3], b: &[f32; 3]) -> bool {
    (0..3).any(|axis| a[axis].to_bits() != b[axis].to_bits() && !(a[axis].is_nan() && b[axis].is_nan()))
}

/// The places in both of the objects that can be compared.
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

/// The places in both of the moments that both have. Of the others only the first in each is a difference, and
/// only between ends of frames: how finely time was recorded is no difference in the run.
fn common_moments<A: Read + Seek, B: Read + Seek>(
    a: &Playback<A>,
    b: &Playback<B>,
    differences: &mut Vec<Difference>,
) -> Vec<(usize, usize)> {
    let (mut i, mut j) = (0, 0);
    let mut common = Vec::new();
    let (one, two) = (a.moments(), b.moments());
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
        let (moment, in_first) = lonely;
        if moment.ends_frame() && !std::mem::replace(&mut told[usize::from(in_first)], true) {
            let (frame, substep) = (moment.frame, moment.substep);
            differences.push(Difference::Moment { frame, substep, in_first });
        }
    }
    common
}
