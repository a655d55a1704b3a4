//! One experiment: its schemes, its tables, and the Markdown page of all.

use std::fmt::Write;

use nucleus_core::{BuildError, Real, ResistanceModel, Stiffness};

use crate::clock::{Clock, Timing};
use crate::fixture::{Fixture, membrane};

/// An experiment.
#[derive(Debug, Clone, Copy)]
pub struct Experiment {
    /// Name, for `--only`.
    pub name: &'static str,
    /// The set-up.
    pub description: &'static str,
    /// Differences from the prototype's set-up, and their effect.
    pub differences: &'static str,
    pub(super) run: fn() -> Result<Vec<Table>, BuildError>,
}

/// A table of figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Heading.
    pub title: &'static str,
    /// Column heads.
    pub head: Vec<&'static str>,
    /// Rows, each as long as the head.
    pub rows: Vec<Vec<String>>,
}

impl Experiment {
    /// Runs it.
    ///
    /// # Errors
    /// When the solver rejects the mesh.
    pub fn run(&self) -> Result<Vec<Table>, BuildError> {
        (self.run)()
    }
}

/// Stiffness of all cloth in N/m: a typical woven cloth.
pub(super) const STIFFNESS: f64 = 10_000.0;

/// How a budget of evaluations per 1/24 s is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scheme {
    /// Small time steps with one sweep each.
    SmallSteps,
    /// Several sweeps in each of some substeps: Maya's reading.
    Passes(u32),
}

impl Scheme {
    pub(super) fn words(self) -> String {
        match self {
            Self::SmallSteps => "small steps, one sweep each (Physical)".to_owned(),
            Self::Passes(1) => "passes over 1 substep (Classic)".to_owned(),
            Self::Passes(substeps) => format!("passes over {substeps} substeps (Classic)"),
        }
    }

    /// Applies the scheme to a fixture. A Classic pass removes the whole error, independent of stiffness.
    pub(super) fn set<R: Real>(self, fixture: &mut Fixture<R>, evaluations: u32) {
        let count = f64::from(evaluations);
        match self {
            Self::SmallSteps => {
                fixture.frame.substeps = 1;
                fixture.frame.resistance = ResistanceModel::Physical { evaluations: count };
                fixture.cloth().stiffness = membrane(STIFFNESS);
            }
            Self::Passes(substeps) => {
                fixture.frame.substeps = substeps;
                fixture.frame.resistance = ResistanceModel::Classic;
                let cloth = fixture.cloth();
                cloth.stiffness = Stiffness::default();
                (cloth.stretch_resistance, cloth.compression_resistance) = (count, count);
                (cloth.shear_resistance, cloth.bend_resistance) = (0.0, 0.0);
            }
        }
        fixture.frame.collision_iterations = count;
    }
}

/// Runs frames; milliseconds of processor time per frame.
pub(super) fn timed(frames: u32, mut frame: impl FnMut()) -> f64 {
    let (timing, ()) = Timing::measure(Clock::Thread, || (0..frames).for_each(|_| frame()));
    1e3 * timing.processor / f64::from(frames)
}

/// A figure of the prototype, or a dash.
pub(super) fn or_dash(figure: Option<f64>) -> String {
    figure.map_or("–".to_owned(), crate::report::figure)
}

const HEAD: &str = "# Four design experiments

The solver's design rests on four experiments on a prototype.
This page repeats them on the solver and compares the results.
`cargo xtask book --only experiments` rewrites this page.
Milliseconds are processor time of one core, of the current solver; the prototype's are not comparable and are omitted.
";

/// The page in Markdown; `machine` describes the machine of the times.
pub fn page(results: &[(Experiment, Vec<Table>)], machine: &str) -> String {
    let mut text = format!("{HEAD}\n{machine}\n");
    for (experiment, tables) in results {
        let Experiment { name, description, differences, .. } = experiment;
        put(&mut text, format_args!("\n## {name}\n\n{description}\n\n**Differences.** {differences}"));
        tables.iter().for_each(|found| table(&mut text, found));
    }
    text
}

fn table(text: &mut String, Table { title, head, rows }: &Table) {
    put(text, format_args!("\n### {title}\n\n| {} |\n|{}", head.join(" | "), "---:|".repeat(head.len())));
    for row in rows {
        put(text, format_args!("| {} |", row.join(" | ")));
    }
}

fn put(text: &mut String, line: std::fmt::Arguments) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::experiments;

    #[test]
    fn the_page_has_every_experiment_with_its_tables_and_differences() {
        let table =
            Table { title: "Figures", head: vec!["a", "b"], rows: vec![vec!["1".into(), "2".into()]] };
        let results: Vec<_> = experiments().into_iter().map(|one| (one, vec![table.clone()])).collect();
        let page = page(&results, "a machine");
        for (experiment, _) in &results {
            assert!(
                page.contains(&format!("## {}\n\n{}", experiment.name, experiment.description)),
                "{page}"
            );
            assert!(page.contains(experiment.differences), "{page}");
        }
        assert_eq!(page.matches("| a | b |\n|---:|---:|\n| 1 | 2 |\n").count(), 4);
    }
}
