//! Compares two caches: where they differ first, and by how much.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::io::{Read, Seek};
use std::mem::replace;

use crate::error::ReadError;
use crate::messages::attribute::{self, Attribute};
use crate::read::playback::Playback;
use crate::read::time_index::TimeSample;
use crate::run::{ObjectInfo, RunInfo};

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
    /// A frame of one cache is damaged or missing and is not compared.
    Damaged {
        /// The frame.
        frame: i32,
        /// Whether it is in the first cache.
        in_first: bool,
    },
    /// Positions differ.
    Points(PointDifference),
    /// Other recorded values of points differ; the first such time sample.
    Values {
        /// The object.
        name: String,
        /// The values: `velocities`, `contacts`, `strain`, `looks` (radius, opacity, colours), `rotation` or
        /// `particles` (number, age, lifespan, mass).
        values: &'static str,
        /// The frame.
        frame: i32,
        /// The substep, counted from 1; 0 is the initial state.
        substep: u32,
        /// The first point that differs.
        point: usize,
        /// Number of points that differ at this sample.
        points: usize,
    },
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
    /// Number of compared time samples: those that both caches have, undamaged.
    pub time_samples: usize,
    /// Differences: first of objects, then of time samples, then damaged frames and the first mesh and position difference
    /// of each object, in order of time.
    pub differences: Vec<Difference>,
    /// Root mean square distance over all compared points and time samples, in scene units.
    pub rms: f64,
    /// The sample with the largest distance.
    pub largest: Option<PointDifference>,
}

/// Compares the time samples that two caches share: those at the same time of the scene, wherever each run starts.
/// Distances up to `tolerance`, in scene units, are no difference; at 0 every bit counts, except that all NaNs of
/// positions are equal, and all values that both caches record are compared, not only positions.
///
/// Neither compression, the recorded sample rate nor a channel of one cache only is a difference. A damaged frame is one;
/// the other frames are still compared.
///
/// # Errors
/// When the system fails to read.
pub fn compare<A: Read + Seek, B: Read + Seek>(
    a: &mut Playback<A>,
    b: &mut Playback<B>,
    tolerance: f64,
) -> Result<Comparison, ReadError> {
    let mut differences = Vec::new();
    let mut damaged = BTreeSet::new();
    let objects = common_objects(a, b, &mut differences);
    let samples = common_samples(a, b, &mut differences, &mut damaged);
    let mut comparer = Comparer {
        tolerance,
        comparison: Comparison { differences, ..Comparison::default() },
        error: SquaredError::default(),
        damaged,
        mesh_differs: vec![false; objects.len()],
        points_differ: vec![false; objects.len()],
        values_differ: BTreeSet::new(),
    };
    for (sample_a, sample_b) in samples {
        let (sample, mut is_readable) = (a.time_samples()[sample_a], true);
        for (place, &(object_a, object_b)) in objects.iter().enumerate() {
            let one = comparer.readable(true, object_at(a, object_a, sample_a))?;
            let two = comparer.readable(false, object_at(b, object_b, sample_b))?;
            match one.zip(two) {
                Some((one, two)) => comparer.compare(place, sample, one, two),
                None => {
                    is_readable = false;
                    continue;
                }
            }
            // An initial state has positions only; contacts and velocities begin with the first step.
            let is_initial = |sample: TimeSample| sample.substep == 0;
            if tolerance > 0.0 || is_initial(sample) != is_initial(b.time_samples()[sample_b]) {
                continue;
            }
            for values in VALUES {
                let one = comparer.readable(true, values.of(a, object_a, sample_a))?;
                let two = comparer.readable(false, values.of(b, object_b, sample_b))?;
                match one.zip(two) {
                    Some((Some(one), Some(two))) => {
                        let name = &a.objects()[object_a].name;
                        comparer.compare_values((place, name), sample, values, (&one, &two));
                    }
                    Some(_) => {}
                    None => is_readable = false,
                }
            }
        }
        comparer.comparison.time_samples += usize::from(is_readable);
    }
    Ok(comparer.finish())
}

/// An object at one time sample: its mesh and its positions.
type Shown<'a> = (&'a ObjectInfo, Vec<[f32; 3]>);

fn object_at<R: Read + Seek>(
    cache: &mut Playback<R>,
    object: usize,
    sample: usize,
) -> Result<Shown<'_>, ReadError> {
    let positions = cache.positions(object, sample)?;
    Ok((cache.object_at(object, sample)?, positions))
}

/// Recorded values of points besides their positions.
#[derive(Clone, Copy)]
enum Values {
    Velocities,
    Attribute(&'static Attribute),
}

/// All of them.
const VALUES: [Values; 1 + attribute::ALL.len()] = {
    let mut all = [Values::Velocities; 1 + attribute::ALL.len()];
    let mut k = 0;
    while k < attribute::ALL.len() {
        all[k + 1] = Values::Attribute(attribute::ALL[k]);
        k += 1;
    }
    all
};

impl Values {
    fn name(self) -> &'static str {
        match self {
            Self::Velocities => "velocities",
            Self::Attribute(attribute) => attribute.topic,
        }
    }

    /// Bytes of the value of a point.
    fn width(self) -> usize {
        match self {
            Self::Velocities => size_of::<[f32; 3]>(),
            Self::Attribute(attribute) => attribute.width,
        }
    }

    /// The bytes of all values, point by point; `None` where they are not recorded.
    fn of<R: Read + Seek>(
        self,
        cache: &mut Playback<R>,
        object: usize,
        sample: usize,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        match self {
            Self::Velocities => {
                let bytes = |all: Vec<[f32; 3]>| all.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
                Ok(cache.velocities(object, sample)?.map(bytes))
            }
            Self::Attribute(attribute) => {
                Ok(cache.attribute(object, sample, attribute)?.map(|bytes| attribute.by_point(bytes)))
            }
        }
    }
}

/// Collects the differences of two caches.
struct Comparer {
    tolerance: f64,
    comparison: Comparison,
    error: SquaredError,
    /// Damaged frames, and whether they are in the first cache.
    damaged: BTreeSet<(i32, bool)>,
    /// By common object, whether a difference of its mesh or of its positions was found.
    mesh_differs: Vec<bool>,
    points_differ: Vec<bool>,
    /// Common objects and values of which a difference was found.
    values_differ: BTreeSet<(usize, &'static str)>,
}

impl Comparer {
    /// The result of reading, or `None` and a difference where the frame is damaged.
    fn readable<T>(&mut self, in_first: bool, read: Result<T, ReadError>) -> Result<Option<T>, ReadError> {
        match read {
            Ok(value) => Ok(Some(value)),
            Err(
                ReadError::Damaged { frame }
                | ReadError::MeshLost { frame, .. }
                | ReadError::Nothing { frame, .. },
            ) => {
                note_damage(frame, in_first, &mut self.damaged, &mut self.comparison.differences);
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Compares the common object number `place` at a time sample.
    fn compare(
        &mut self,
        place: usize,
        sample: TimeSample,
        (one, at_one): Shown<'_>,
        (two, at_two): Shown<'_>,
    ) {
        let TimeSample { frame, substep, .. } = sample;
        let is_comparable = at_one.len() == at_two.len();
        let is_same = is_comparable && one.faces == two.faces;
        if !is_same && !replace(&mut self.mesh_differs[place], true) {
            self.comparison.differences.push(Difference::Mesh { name: one.name.clone(), frame, substep });
        }
        if !is_comparable {
            return;
        }
        let found = first_difference(&at_one, &at_two, self.tolerance, &mut self.error);
        let Some(found) = found else { return };
        let found = PointDifference { object: one.name.clone(), frame, substep, ..found };
        let largest = &mut self.comparison.largest;
        if largest.as_ref().is_none_or(|largest| found.farthest.1 > largest.farthest.1) {
            *largest = Some(found.clone());
        }
        if !replace(&mut self.points_differ[place], true) {
            self.comparison.differences.push(Difference::Points(found));
        }
    }

    /// Compares other values of the common object number `place` at a time sample.
    fn compare_values(
        &mut self,
        (place, name): (usize, &str),
        TimeSample { frame, substep, .. }: TimeSample,
        values: Values,
        (one, two): (&[u8], &[u8]),
    ) {
        let points = one.chunks_exact(values.width()).zip(two.chunks_exact(values.width()));
        let mut differing = (0..).zip(points).filter(|(_, (one, two))| one != two);
        let Some((point, _)) = differing.next() else { return };
        if self.values_differ.insert((place, values.name())) {
            let (name, points) = (name.to_owned(), 1 + differing.count());
            let values = values.name();
            let found = Difference::Values { name, values, frame, substep, point, points };
            self.comparison.differences.push(found);
        }
    }

    fn finish(self) -> Comparison {
        Comparison { rms: self.error.rms(), ..self.comparison }
    }
}

/// Adds a damaged frame to the differences, once.
fn note_damage(
    frame: i32,
    in_first: bool,
    damaged: &mut BTreeSet<(i32, bool)>,
    differences: &mut Vec<Difference>,
) {
    if damaged.insert((frame, in_first)) {
        differences.push(Difference::Damaged { frame, in_first });
    }
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

/// Nanoseconds that two times may differ by rounding: a start and a sample on each side.
const TIME_ROUNDING: i128 = 2;

/// The time of a sample in nanoseconds from frame 0.
fn scene_time(run: &RunInfo, sample: &TimeSample) -> i128 {
    let start = f64::from(run.start) * 1e9 / run.frames_per_second;
    start.round() as i128 + i128::from(sample.log_time)
}

/// Indices in both caches of the time samples that both have. Of the other samples, only the first of each cache at a
/// frame end is a difference: the recorded sample rate does not matter. A frame that the other cache has lost is damaged.
fn common_samples<A: Read + Seek, B: Read + Seek>(
    a: &Playback<A>,
    b: &Playback<B>,
    differences: &mut Vec<Difference>,
    damaged: &mut BTreeSet<(i32, bool)>,
) -> Vec<(usize, usize)> {
    let (mut i, mut j) = (0, 0);
    let mut common = Vec::new();
    let (one, two) = (a.time_samples(), b.time_samples());
    let mut is_reported = [false; 2];
    while i < one.len() || j < two.len() {
        let order = match (one.get(i), two.get(j)) {
            (Some(x), Some(y)) => match scene_time(a.run(), x) - scene_time(b.run(), y) {
                apart if apart.abs() <= TIME_ROUNDING => Ordering::Equal,
                apart => apart.cmp(&0),
            },
            (Some(_), None) => Ordering::Less,
            _ => Ordering::Greater,
        };
        let (sample, in_first) = match order {
            Ordering::Equal => {
                common.push((i, j));
                (i, j) = (i + 1, j + 1);
                continue;
            }
            Ordering::Less => {
                i += 1;
                (one[i - 1], true)
            }
            Ordering::Greater => {
                j += 1;
                (two[j - 1], false)
            }
        };
        let other = if in_first { b.corruption() } else { a.corruption() };
        let (frame, substep) = (sample.frame, sample.substep);
        if other.frames.contains(&frame) {
            note_damage(frame, !in_first, damaged, differences);
        } else if sample.ends_frame() && !replace(&mut is_reported[usize::from(in_first)], true) {
            differences.push(Difference::TimeSample { frame, substep, in_first });
        }
    }
    common
}
