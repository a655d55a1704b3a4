//! The files of a report: the tables of a page, between two markers, and all runs as comma-separated values.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};
use nucleus_measure::clock::STAGES;

use super::report::Report;
use super::run::RunResult;

const BEGIN: &str = "<!-- figures: written by `cargo xtask bench --write` -->\n";
const END: &str = "<!-- end of figures -->\n";

/// Checks that the page exists and has both markers.
///
/// # Errors
/// When it cannot be read, or lacks a marker.
pub fn check_page(path: &Path) -> anyhow::Result<()> {
    put(&read(path)?, "").map(drop).with_context(|| format!("`{}`", path.display()))
}

/// Replaces the figures of a page by those of a report.
///
/// # Errors
/// As [`check_page`], and when the page cannot be written.
pub fn write_page(path: &Path, report: &Report) -> anyhow::Result<()> {
    let page = put(&read(path)?, &figures(report)).with_context(|| format!("`{}`", path.display()))?;
    fs::write(path, page).with_context(|| format!("`{}` cannot be written", path.display()))
}

/// All tables, targets first.
fn figures(report: &Report) -> String {
    let mut text = report.machine.join("\n") + "\n";
    let targets = report.target_table();
    for table in [&targets].into_iter().filter(|table| !table.rows.is_empty()).chain(&report.tables) {
        text.extend(["\n", &table.to_string()]);
    }
    text
}

fn put(page: &str, figures: &str) -> anyhow::Result<String> {
    let marks = page.split_once(BEGIN).and_then(|(head, rest)| Some((head, rest.split_once(END)?.1)));
    ensure!(
        marks.is_some(),
        "has no place for figures: it wants the lines `{}` and `{}`",
        BEGIN.trim(),
        END.trim()
    );
    let (head, tail) = marks.unwrap_or_default();
    Ok([head, BEGIN, "\n", figures, "\n", END, tail].concat())
}

fn read(path: &Path) -> anyhow::Result<String> {
    fs::read_to_string(path).with_context(|| format!("`{}` cannot be read", path.display()))
}

/// Writes all runs as comma-separated values: times in milliseconds per frame, strains as fractions, lengths in metres.
///
/// # Errors
/// When the file cannot be written.
pub fn write_csv(path: &Path, runs: &[RunResult]) -> anyhow::Result<()> {
    fs::write(path, csv_text(runs)).with_context(|| format!("`{}` cannot be written", path.display()))
}

fn csv_text(runs: &[RunResult]) -> String {
    let mut text =
        String::from("workload,points,threads,frames,resistance,bend,evaluations,variant,processor,wall");
    STAGES.iter().for_each(|(_, name)| text.extend([",", name]));
    text.push_str(
        ",link_evaluations,searches,pairs_unresolved,build,strain,stretch,max,sag,energy,depth,worst_depth,lower_edge,hash\n",
    );
    for run in runs {
        let (spec, setting, found) = (run.spec, run.spec.setting, run.accuracy);
        let named = format!("{},{},{},{}", spec.workload, spec.size, spec.threads, spec.frames);
        let set =
            format!("{},{},{},{}", setting.resistance, setting.bend, setting.evaluations, setting.variant);
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
    use crate::bench::workload::{Setting, Variant, Workload};

    #[test]
    fn figures_are_replaced_and_the_rest_of_the_page_is_unchanged() {
        let page = format!("above\n{BEGIN}old\n{END}below\n");
        let once = put(&page, "new\n").unwrap();
        assert_eq!(once, format!("above\n{BEGIN}\nnew\n\n{END}below\n"));
        assert_eq!(put(&once, "new\n").unwrap(), once);
    }

    #[test]
    fn targets_are_shown_where_there_are_any() {
        let mut report = Report::default();
        assert!(!figures(&report).contains("Targets"));
        report.check_target("more", "less".to_owned(), false);
        assert!(figures(&report).contains("Targets"));
    }

    #[test]
    fn a_page_without_markers_is_rejected() {
        for page in ["", BEGIN, END, &format!("{END}{BEGIN}")] {
            assert!(put(page, "").unwrap_err().to_string().contains("no place for figures"));
        }
    }

    #[test]
    fn every_line_has_as_many_values_as_the_head() {
        let setting = Setting { resistance: 20.0, bend: 0.1, evaluations: 3, variant: Variant::Plain };
        let spec = RunSpec { workload: Workload::Drape, size: 5, setting, threads: 1, frames: 1 };
        let text = csv_text(&[spec.run(1).unwrap()]);
        let values: Vec<usize> = text.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(values.len(), 2);
        assert_eq!(values[0], values[1], "{text}");
    }
}
