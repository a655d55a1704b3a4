//! All runs as comma-separated values.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::Context;

use super::run::RunResult;
use nucleus_measure::clock::STAGES;

/// Writes all runs; times in milliseconds per frame, strains as fractions, lengths in metres.
///
/// # Errors
/// When the file cannot be written.
pub fn write(path: &Path, runs: &[RunResult]) -> anyhow::Result<()> {
    fs::write(path, text(runs)).with_context(|| format!("`{}` cannot be written", path.display()))
}

fn text(runs: &[RunResult]) -> String {
    let mut text = String::from("workload,points,threads,frames,resistance,bend,evaluations,processor,wall");
    STAGES.iter().for_each(|(_, name)| text.extend([",", name]));
    text.push_str(
        ",link_evaluations,searches,pairs_unresolved,build,strain,stretch,max,sag,energy,depth,worst_depth,lower_edge,hash\n",
    );
    for run in runs {
        let (spec, setting, found) = (run.spec, run.spec.setting, run.accuracy);
        let named = format!("{},{},{},{}", spec.workload, spec.size, spec.threads, spec.frames);
        let set = format!("{},{},{}", setting.resistance, setting.bend, setting.evaluations);
        let times = [1e3 * run.timing.processor, 1e3 * run.timing.wall];
        let stages = run.shares.map(|share| run.ms() * share);
        let errors = [
            run.evaluations,
            run.queries,
            run.pairs_unresolved as f64,
            run.build,
            found.strain,
            found.stretch,
            found.max,
            found.sag,
            found.energy,
            found.depth,
            found.worst_depth,
            found.lower_edge,
        ];
        text.extend([named, ",".to_owned(), set]);
        for number in times.iter().chain(&stages).chain(&errors) {
            // Writing to a string does not fail.
            let _ = write!(text, ",{number}");
        }
        let _ = writeln!(text, ",{:016x}", run.hash);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::run::RunSpec;
    use crate::bench::workload::{Setting, Workload};

    #[test]
    fn every_line_has_as_many_values_as_the_head() {
        let setting = Setting { resistance: 20.0, bend: 0.1, evaluations: 3 };
        let spec = RunSpec { workload: Workload::Drape, size: 5, setting, threads: 1, frames: 1 };
        let text = text(&[spec.run(1).unwrap()]);
        let values: Vec<usize> = text.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(values.len(), 2);
        assert_eq!(values[0], values[1], "{text}");
    }
}
