//! Results of a bench: runs, tables, and targets.

use super::run::RunResult;
use super::table::Table;

/// A target and its result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TargetResult {
    /// The target.
    pub target: String,
    /// The figure.
    pub found: String,
    /// Whether it is met.
    pub is_met: bool,
}

impl TargetResult {
    /// `met` or `missed`.
    pub fn word(&self) -> &'static str {
        if self.is_met { "met" } else { "missed" }
    }
}

/// All results.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Description of the machine, by line.
    pub machine: Vec<String>,
    /// Every run.
    pub runs: Vec<RunResult>,
    /// All printed tables.
    pub tables: Vec<Table>,
    /// All checked targets.
    pub targets: Vec<TargetResult>,
}

impl Report {
    /// An empty report of this machine.
    pub fn new(machine: Vec<String>) -> Self {
        machine.iter().for_each(|line| println!("{line}"));
        Self { machine, ..Self::default() }
    }

    /// Adds a run, and prints a line.
    pub fn keep(&mut self, run: &RunResult) {
        let spec = run.spec;
        eprintln!(
            "{} {}², {}, threads {}: {:.3} ms per frame, {:016x}",
            spec.workload,
            spec.size,
            spec.setting,
            spec.threads,
            run.ms(),
            run.hash
        );
        self.runs.push(run.clone());
    }

    /// Prints and adds a table, unless it is empty.
    pub fn show(&mut self, table: Table) {
        if !table.rows.is_empty() {
            print!("\n{table}");
            self.tables.push(table);
        }
    }

    /// Adds the result of a target.
    pub fn check_target(&mut self, target: impl Into<String>, found: String, is_met: bool) {
        self.targets.push(TargetResult { target: target.into(), found, is_met });
    }

    /// Table of all targets.
    pub fn target_table(&self) -> Table {
        let mut table = Table::new("Targets", &["target", "", "found"]);
        for target in &self.targets {
            table.row([target.target.clone(), target.word().to_owned(), target.found.clone()]);
        }
        table
    }
}
