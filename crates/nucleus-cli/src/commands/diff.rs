//! `nucleus diff`: the first difference between two caches, and its size.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use nucleus_cache::{Comparison, Detail, Difference, Playback, PointDifference, compare, frame_ranges};
use nucleus_maya::ncache::NCache;
use serde_json::{Value, json};

use crate::process::Outcome;
use crate::{figures, files, options, output};

/// Compares two caches: reports the first frame, substep, object and point that differ, and the largest distance.
///
/// The second may be an nCache of Maya (.xml, .mc, .mcx): objects go together by name (`nCloth1` and `nClothShape1`), or
/// if each side has only one; distances are also given as shares of the distance travelled. A frame that only one of them
/// has is a difference.
///
/// Exits with 0 if the caches are equal and with 1 if they differ. Frames of the same number are compared, with all values
/// that both caches record: positions, velocities, contacts, strain, and radius, opacity, colours and orientation of
/// particles. With --tolerance only positions are compared.
#[derive(Debug, Args)]
pub struct Diff {
    /// A cache (.mcap).
    first: PathBuf,
    /// The other cache (.mcap), or an nCache (.xml).
    second: PathBuf,
    /// Largest distance of positions, in scene units, that counts as equal; 0 compares the bits of all values.
    #[arg(long, default_value_t = 0.0, value_parser = options::not_negative)]
    tolerance: f64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

impl Diff {
    /// Compares the caches. A difference is a problem.
    pub fn run(self) -> Result<Outcome> {
        let mut first = files::open_cache_and_warn(&self.first)?;
        if is_ncache(&self.second) {
            return self.against_ncache(&mut first, &NCache::read(&self.second)?);
        }
        let mut second = files::open_cache_and_warn(&self.second)?;
        let comparison = compare(&mut first, &mut second, self.tolerance)?;
        let moments = Moments { have_substeps: first.run().detail == Detail::Substeps };
        match self.json {
            true => output::print_json(&as_json(&comparison, moments))?,
            false => output::print(&self.as_text(&comparison, moments)?)?,
        }
        Ok(if comparison.differences.is_empty() { Outcome::Success } else { Outcome::Problem })
    }

    /// Compares whole frames of all objects that both have.
    fn against_ncache(&self, first: &mut Playback, second: &NCache) -> Result<Outcome> {
        let own: Vec<String> = first.objects().iter().map(|object| object.name.clone()).collect();
        let pairs = pairs(&own, &second.objects());
        if pairs.is_empty() {
            bail!("no object is in both: {} and {}", own.join(", "), second.objects().join(", "));
        }
        let (mut within, mut reports) = (true, Vec::new());
        for (object, name) in pairs {
            let found = deviation(first, object, second, name)?;
            within &= found.is_complete() && found.largest.0 <= self.tolerance;
            match self.json {
                true => reports.push(found.as_json(&own[object], name)),
                false => {
                    output::print(&found.as_text(&own[object], name))?;
                    for (frames, file) in
                        [(&found.only_first, &self.first), (&found.only_second, &self.second)]
                    {
                        if !frames.is_empty() {
                            output::print(&only_in(frames, &own[object], file))?;
                        }
                    }
                }
            }
        }
        if self.json {
            output::print_json(&json!({ "same": within, "objects": reports }))?;
        }
        Ok(if within { Outcome::Success } else { Outcome::Problem })
    }

    fn as_text(&self, comparison: &Comparison, moments: Moments) -> Result<String, std::fmt::Error> {
        let compared = figures::count(comparison.time_samples, "moment");
        if comparison.differences.is_empty() {
            return Ok(match self.tolerance > 0.0 {
                true => format!("positions equal within the tolerance, {compared} compared\n"),
                false => format!("equal in every bit, {compared} compared\n"),
            });
        }
        let mut text = String::new();
        for difference in &comparison.differences {
            writeln!(text, "{}", self.line(difference, moments))?;
        }
        if let Some(largest) = &comparison.largest {
            let (point, distance) = largest.farthest;
            writeln!(
                text,
                "largest: {} at {}, `{}` point {point}; root mean square {} over {compared}",
                figures::number(distance),
                moments.text(largest.frame, largest.substep),
                largest.object,
                figures::number(comparison.rms),
            )?;
        }
        Ok(text)
    }

    fn line(&self, difference: &Difference, moments: Moments) -> String {
        let name = |in_first: &bool| if *in_first { self.first.display() } else { self.second.display() };
        match difference {
            Difference::Object { name: object, in_first } => {
                format!("object `{object}` is in `{}` only", name(in_first))
            }
            Difference::Mesh { name, frame, substep } => {
                let place = moments.text(*frame, *substep);
                format!("the meshes of object `{name}` differ in faces or points at {place}")
            }
            Difference::TimeSample { frame, in_first, .. } => {
                format!("frame {frame} is the first that is in `{}` only", name(in_first))
            }
            Difference::Values { name, values, frame, substep, point, points } => format!(
                "{values} differ first in `{name}`: {}, point {point}; {}",
                moments.text(*frame, *substep),
                differing(*points)
            ),
            Difference::Points(found) => format!(
                "first in `{}`: {}, point {} by {}; {}, point {} most, by {}",
                found.object,
                moments.text(found.frame, found.substep),
                found.point,
                figures::number(found.distance),
                differing(found.points),
                found.farthest.0,
                figures::number(found.farthest.1),
            ),
            Difference::Damaged { frame, in_first } => {
                format!("frame {frame} of `{}` is damaged and was not compared", name(in_first))
            }
            _ => "something else differs".to_owned(),
        }
    }
}

fn is_ncache(path: &Path) -> bool {
    let end = path.extension().unwrap_or_default().to_ascii_lowercase();
    matches!(end.to_str(), Some("xml" | "mc" | "mcx"))
}

/// Objects that go together: by name without `Shape`, else the only one of each side.
fn pairs<'a>(own: &[String], others: &[&'a str]) -> Vec<(usize, &'a str)> {
    let plain = |name: &str| name.replacen("Shape", "", 1).replace(':', "_");
    let same = |name: &String| others.iter().find(|other| plain(name) == plain(other)).copied();
    let found: Vec<(usize, &str)> =
        own.iter().enumerate().filter_map(|(k, name)| Some((k, same(name)?))).collect();
    match (found.is_empty(), own, others) {
        (true, [_], [other]) => vec![(0, other)],
        _ => found,
    }
}

/// How far an object of a run is from an nCache, in scene units.
#[derive(Debug, Default)]
struct Deviation {
    frames: usize,
    /// Frames at which the numbers of points differ.
    other_counts: usize,
    /// Frames that only the run has, and those that only the nCache has.
    only_first: Vec<i32>,
    only_second: Vec<i32>,
    /// Distance, frame and point.
    largest: (f64, i32, usize),
    squares: f64,
    points: usize,
    /// The farthest that a point of the nCache is from where it was first.
    travelled: f64,
}

fn deviation(first: &mut Playback, object: usize, second: &NCache, name: &str) -> Result<Deviation> {
    let samples: Vec<(usize, i32)> = (0..)
        .zip(first.time_samples())
        .filter(|(_, sample)| sample.ends_frame())
        .map(|(k, sample)| (k, sample.frame))
        .collect();
    let mut found = Deviation::default();
    let has = |frame: i32| samples.iter().any(|&(_, own)| own == frame);
    found.only_second = second.whole_frames(name).into_iter().filter(|&frame| !has(frame)).collect();
    let mut start: Option<&[[f64; 3]]> = None;
    for &(sample, frame) in &samples {
        let Some(points) = second.positions(name, f64::from(frame)) else {
            found.only_first.push(frame);
            continue;
        };
        let own = first.positions(object, sample)?;
        if own.len() != points.len() {
            found.other_counts += 1;
            continue;
        }
        found.frames += 1;
        let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        let start = start.get_or_insert(points);
        for (point, (a, b)) in own.iter().zip(points).enumerate() {
            let apart = distance(a.map(f64::from), *b);
            if apart > found.largest.0 {
                found.largest = (apart, frame, point);
            }
            found.squares += apart * apart;
            found.points += 1;
            found.travelled =
                start.get(point).map_or(found.travelled, |from| found.travelled.max(distance(*from, *b)));
        }
    }
    Ok(found)
}

impl Deviation {
    /// Whether every frame of both is compared.
    fn is_complete(&self) -> bool {
        self.frames > 0 && self.other_counts == 0 && self.only_first.is_empty() && self.only_second.is_empty()
    }

    fn rms(&self) -> f64 {
        (self.squares / self.points.max(1) as f64).sqrt()
    }

    /// The largest distance over the distance travelled.
    fn share(&self) -> Option<f64> {
        (self.travelled > 0.0).then(|| self.largest.0 / self.travelled)
    }

    fn as_text(&self, own: &str, other: &str) -> String {
        let (largest, frame, point) = self.largest;
        let share = self
            .share()
            .map(|share| format!(", {} % of the distance travelled", figures::number(100.0 * share)));
        let counts = match self.other_counts {
            0 => String::new(),
            count => format!("; {} with another number of points", figures::count(count, "frame")),
        };
        format!(
            "`{own}` and `{other}`: {} compared, largest distance {} at frame {frame}, point {point}{}; root mean square {}{counts}\n",
            figures::count(self.frames, "frame"),
            figures::number(largest),
            share.unwrap_or_default(),
            figures::number(self.rms()),
        )
    }

    fn as_json(&self, own: &str, other: &str) -> Value {
        let (largest, frame, point) = self.largest;
        json!({
            "object": own, "channel": other, "frames": self.frames, "other_counts": self.other_counts,
            "largest": { "distance": largest, "frame": frame, "point": point }, "rms": self.rms(),
            "travelled": self.travelled, "share": self.share(), "only_in_1": self.only_first, "only_in_2": self.only_second,
        })
    }
}

/// `` frames 7 to 40 of `cloth1` are in `run.mcap` only ``, at the end a line feed.
fn only_in(frames: &[i32], object: &str, file: &Path) -> String {
    let verb = if frames.len() == 1 { "is" } else { "are" };
    format!("{} of `{object}` {verb} in `{}` only\n", frame_ranges(frames), file.display())
}

/// How moments are named: a substep only where the first cache holds all of them, else its number is not known.
#[derive(Clone, Copy)]
struct Moments {
    have_substeps: bool,
}

impl Moments {
    /// `frame 12`, `frame 12 substep 3`.
    fn text(self, frame: i32, substep: u32) -> String {
        match self.have_substeps {
            true => format!("frame {frame} substep {substep}"),
            false => format!("frame {frame}"),
        }
    }

    fn substep(self, substep: u32) -> Option<u32> {
        self.have_substeps.then_some(substep)
    }
}

/// `1 point differs there`.
fn differing(points: usize) -> String {
    let verb = if points == 1 { "differs" } else { "differ" };
    format!("{} {verb} there", figures::count(points, "point"))
}

fn as_json(comparison: &Comparison, moments: Moments) -> Value {
    let points = |found: &PointDifference| {
        json!({
            "object": found.object, "frame": found.frame, "substep": moments.substep(found.substep),
            "point": found.point, "distance": found.distance, "points": found.points,
            "farthest": { "point": found.farthest.0, "distance": found.farthest.1 },
        })
    };
    let largest = |found: &PointDifference| {
        let (point, distance) = found.farthest;
        json!({
            "object": found.object, "frame": found.frame, "substep": moments.substep(found.substep),
            "point": point, "distance": distance, "points": found.points,
        })
    };
    let side = |in_first: &bool| 1 + u8::from(!in_first);
    let differences = comparison.differences.iter().map(|difference| match difference {
        Difference::Object { name, in_first } => json!({ "object": name, "only_in": side(in_first) }),
        Difference::Mesh { name, frame, substep } => {
            json!({ "mesh": name, "frame": frame, "substep": moments.substep(*substep) })
        }
        Difference::TimeSample { frame, substep, in_first } => {
            let moment = json!({ "frame": frame, "substep": moments.substep(*substep) });
            json!({ "moment": moment, "only_in": side(in_first) })
        }
        Difference::Points(found) => json!({ "points": points(found) }),
        Difference::Values { name, values, frame, substep, point, points } => json!({
            "values": values, "object": name, "frame": frame, "substep": moments.substep(*substep), "point": point,
            "points": points,
        }),
        Difference::Damaged { frame, in_first } => {
            json!({ "damaged": { "frame": frame, "in": side(in_first) } })
        }
        _ => Value::Null,
    });
    json!({
        "same": comparison.differences.is_empty(),
        "moments": comparison.time_samples,
        "differences": differences.collect::<Vec<_>>(),
        "rms": comparison.rms,
        "largest": comparison.largest.as_ref().map(largest),
    })
}
