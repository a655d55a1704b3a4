//! What is kept of a bench: every run, every table, and which targets were met.

use super::run::RunResult;
use super::table::Table;

/// A target, and whether it was met.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TargetResult {
    /// What was to be shown.
    pub target: String,
    /// The figure.
    pub found: String,
    /// Whether that is good enough.
    pub is_met: bool,
}

impl TargetResult {
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
    pub runs: Vec<RunResult>,
    /// Every table that was shown.
    pub tables: Vec<Table>,
    /// Every target that was looked at.
    pub targets: Vec<TargetResult>,
}

impl Report {
    /// Nothing found yet on this machine.
    pub fn new(machine: Vec<String>) -> Self {
        machine.iter().for_each(|line| println!("{line}"));
        Self { machine, ..Self::default() }
    }

    /// Keeps a run, and says that it is done.
    pub fn keep(&mut self, run: &RunResult) {
        let spec = run.spec;
        eprintln!(
            "{} {}², {}, threads {}: {:.3} ms a frame, {:016x}",
            spec.workload,
            spec.size,
            spec.setting,
            spec.threads,
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
    pub fn check_target(&mut self, target: impl Into<String>, found: String, is_met: bool) {
        self.targets.push(TargetResult { target: target.into(), found, is_met });
    }

    /// Which targets were met.
    pub fn target_table(&self) -> Table {
        let mut table = Table::new("Targets", &["target", "", "found"]);
        for target in &self.targets {
            table.row([target.target.clone(), target.word().to_owned(), target.found.clone()]);
        }
        table
    }
}
