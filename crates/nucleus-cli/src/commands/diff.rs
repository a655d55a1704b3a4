//! `nucleus diff`: the first difference between two caches, and its size.

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use nucleus_cache::{Comparison, Difference, PointDifference, compare};
use serde_json::{Value, json};

use crate::process::Outcome;
use crate::{figures, files, options, output};

/// Compares two caches: reports the first frame, substep, object and point that differ, and the largest distance.
///
/// Exits with 0 if the caches are equal and with 1 if they differ. Only times that both caches hold are compared.
#[derive(Debug, Args)]
pub struct Diff {
    /// A cache (.mcap).
    first: PathBuf,
    /// The other cache (.mcap).
    second: PathBuf,
    /// Largest distance, in scene units, that counts as equal; 0 compares bits.
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
        let mut second = files::open_cache_and_warn(&self.second)?;
        let comparison = compare(&mut first, &mut second, self.tolerance)?;
        match self.json {
            true => output::print_json(&as_json(&comparison))?,
            false => output::print(&self.as_text(&comparison)?)?,
        }
        Ok(if comparison.differences.is_empty() { Outcome::Success } else { Outcome::Problem })
    }

    fn as_text(&self, comparison: &Comparison) -> Result<String, std::fmt::Error> {
        let moments = figures::count(comparison.time_samples, "moment");
        if comparison.differences.is_empty() {
            let how = if self.tolerance > 0.0 { "within the tolerance" } else { "in every bit" };
            return Ok(format!("equal {how}, {moments} compared\n"));
        }
        let mut text = String::new();
        for difference in &comparison.differences {
            writeln!(text, "{}", self.line(difference))?;
        }
        if let Some(largest) = &comparison.largest {
            let (point, distance) = largest.farthest;
            writeln!(
                text,
                "largest: {} at {}, `{}` point {point}; root mean square {} over {moments}",
                figures::number(distance),
                place(largest),
                largest.object,
                figures::number(comparison.rms),
            )?;
        }
        Ok(text)
    }

    fn line(&self, difference: &Difference) -> String {
        let name = |in_first: &bool| if *in_first { self.first.display() } else { self.second.display() };
        match difference {
            Difference::Object { name: object, in_first } => {
                format!("object `{object}` is in `{}` only", name(in_first))
            }
            Difference::Mesh { name, frame, substep } => {
                format!(
                    "the meshes of object `{name}` differ in faces or points at frame {frame} substep {substep}"
                )
            }
            Difference::TimeSample { frame, in_first, .. } => {
                format!("frames from {frame} on are in `{}` only", name(in_first))
            }
            Difference::Points(found) => format!(
                "first in `{}`: {}, point {} by {}; {} differ there, point {} most, by {}",
                found.object,
                place(found),
                found.point,
                figures::number(found.distance),
                figures::count(found.points, "point"),
                found.farthest.0,
                figures::number(found.farthest.1),
            ),
            _ => "something else differs".to_owned(),
        }
    }
}

/// `frame 12`, `frame 12 substep 3`.
fn place(found: &PointDifference) -> String {
    format!("frame {} substep {}", found.frame, found.substep)
}

fn as_json(comparison: &Comparison) -> Value {
    let points = |found: &PointDifference| {
        json!({
            "object": found.object, "frame": found.frame, "substep": found.substep, "point": found.point,
            "distance": found.distance, "points": found.points,
            "farthest": { "point": found.farthest.0, "distance": found.farthest.1 },
        })
    };
    let differences = comparison.differences.iter().map(|difference| match difference {
        Difference::Object { name, in_first } => {
            json!({ "object": name, "only_in": 1 + u8::from(!in_first) })
        }
        Difference::Mesh { name, frame, substep } => {
            json!({ "mesh": name, "frame": frame, "substep": substep })
        }
        Difference::TimeSample { frame, substep, in_first } => {
            json!({ "moment": { "frame": frame, "substep": substep }, "only_in": 1 + u8::from(!in_first) })
        }
        Difference::Points(found) => json!({ "points": points(found) }),
        _ => Value::Null,
    });
    json!({
        "same": comparison.differences.is_empty(),
        "moments": comparison.time_samples,
        "differences": differences.collect::<Vec<_>>(),
        "rms": comparison.rms,
        "largest": comparison.largest.as_ref().map(points),
    })
}
