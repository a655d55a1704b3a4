//! What is kept of a bench: every run, every table, and which targets were met.

use super::table::Table;
use super::trial::Outcome;

/// A target, and whether it was met.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// What was to be shown.
    pub target: String,
    /// The figure.
    pub found: String,
    /// Whether that is good enough.
    pub is_met: bool,
}

impl Verdict {
    /// `met` or `missed`.
    pub fn word(&self) -> &'static str {
        if self.is_met { "met" } else { "missed" }
    }
}

/// Everything that was found.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// The machine, a line a fact.
    pub machine: Vec<String>,
    /// Every run.
    pub runs: Vec<Outcome>,
    /// Every table that was shown.
    pub tables: Vec<Table>,
    /// Every target that was looked at.
    pub verdicts: Vec<Verdict>,
}

impl Report {
    /// Nothing found yet on this machine.
    pub fn new(machine: Vec<String>) -> Self {
        machine.iter().for_each(|line| println!("{line}"));
        Self { machine, ..Self::default() }
    }

    /// Keeps a run, and says that it is done.
    pub fn keep(&mut self, run: &Outcome) {
        let trial = run.trial;
        eprintln!(
            "{} {}², {}, threads {}: {:.3} ms a frame, {:016x}",
            trial.workload,
            trial.size,
            trial.setting,
            trial.threads,
            run.ms(),
            run.hash
        );
        self.runs.push(run.clone());
    }

    /// Prints a table and keeps it; one without rows is passed over.
    pub fn show(&mut self, table: Table) {
        if !table.rows.is_empty() {
            print!("\n{table}");
            self.tables.push(table);
        }
    }

    /// Notes whether a target was met.
    pub fn judge(&mut self, target: impl Into<String>, found: String, is_met: bool) {
        self.verdicts.push(Verdict { target: target.into(), found, is_met });
    }

    /// Which targets were met.
    pub fn verdict_table(&self) -> Table {
        let mut table = Table::new("Targets", &["target", "", "found"]);
        for verdict in &self.verdicts {
            table.row([verdict.target.clone(), verdict.word().to_owned(), verdict.found.clone()]);
        }
        table
    }
}
