//! `nucleus validate`: compares the solver with analytic solutions.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use nucleus_measure::validation::{Case, Comparison, cases, page};
use serde_json::json;

use crate::output::say;
use crate::process::Outcome;
use crate::runs::{PartOptions, part_report};
use crate::{options, output};

/// Compares the solver with analytic solutions: bending and buckling strips, hanging sheets, friction, pendulums, drape.
///
/// Exits with 1 if a figure is outside its tolerance.
#[derive(Debug, Args)]
pub struct Validate {
    /// Run these cases, or all cases whose names start with these; default: all.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// List the cases and run none.
    #[arg(long)]
    list: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write the tables as a Markdown page.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Cases to run in parallel; default: one per core.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    #[command(flatten)]
    parts: PartOptions,
}

/// A case and its findings.
type CaseResult = (Case, Vec<Comparison>);

impl Validate {
    /// Runs the cases and prints their tables.
    pub fn run(self) -> Result<Outcome> {
        let cases = self.cases()?;
        if self.list {
            cases
                .iter()
                .try_for_each(|case| output::print(&format!("{:<18} {}\n", case.name, case.description)))?;
            return Ok(Outcome::Success);
        }
        let results = match self.parts.is_planned() {
            true => self.planned(&cases)?,
            false => Some(self.run_all(&cases)?),
        };
        let Some(results) = results else { return Ok(Outcome::Interrupted) };
        if let Some(path) = &self.write {
            let text = page(&results)?;
            std::fs::write(path, text).with_context(|| format!("cannot write `{}`", path.display()))?;
        }
        match self.json {
            true => output::report_json(&as_json(&results)),
            false => output::report(&as_text(&results)),
        }
        let right = results.iter().all(|(_, findings)| findings.iter().all(Comparison::holds));
        Ok(if right { Outcome::Success } else { Outcome::Problem })
    }

    /// Runs the cases as runs of a plan.
    fn planned(&self, cases: &[Case]) -> Result<Option<Vec<CaseResult>>> {
        let part = |case: &Case| (case.name.to_owned(), vec!["--only".to_owned(), case.name.to_owned()]);
        let parts = cases.iter().map(part).collect();
        let found = self.parts.execute::<Vec<Comparison>>("validate", parts, self.jobs)?;
        Ok(found.map(|found| cases.iter().copied().zip(found).collect()))
    }

    /// Runs one case and returns its report, for the result of a run of a plan.
    pub fn part(&self) -> Result<serde_json::Value> {
        let cases = self.cases()?;
        // Names of other cases may begin with the name of this one.
        let exact = cases.iter().find(|case| self.only.iter().any(|name| name == case.name));
        let case = exact.context("a run of a plan runs one case")?;
        let found = case.run().with_context(|| format!("case `{}`", case.name))?;
        let failures = found.iter().filter(|one| !one.holds()).map(|one| one.cells()[..4].join(" "));
        part_report(&found, &failures.collect::<Vec<_>>())
    }

    fn cases(&self) -> Result<Vec<Case>> {
        for name in &self.only {
            if !cases().any(|case| case.name.starts_with(name.as_str())) {
                let names: Vec<String> = cases().map(|case| format!("`{}`", case.name)).collect();
                bail!("there is no case `{name}`; there are {}", names.join(", "));
            }
        }
        let is_requested = |case: &Case| self.only.iter().any(|name| case.name.starts_with(name.as_str()));
        Ok(cases().filter(|case| self.only.is_empty() || is_requested(case)).collect())
    }

    /// Runs the cases in parallel and reports each on standard error when it is done.
    fn run_all(&self, cases: &[Case]) -> Result<Vec<CaseResult>> {
        let jobs = options::thread_count(self.jobs).clamp(1, cases.len().max(1));
        let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = || -> Result<Vec<(usize, CaseResult)>> {
            let mut results = Vec::new();
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(case) = cases.get(index) else { return Ok(results) };
                let start = Instant::now();
                let findings = case.run().with_context(|| format!("case `{}`", case.name))?;
                let count = done.fetch_add(1, Ordering::Relaxed) + 1;
                let wrong = findings.iter().filter(|finding| !finding.holds()).count();
                let word =
                    if wrong == 0 { "ok".to_owned() } else { format!("{wrong} of {} fail", findings.len()) };
                let seconds = start.elapsed().as_secs_f64();
                say!("[{count}/{}] {}: {word}, {seconds:.1} s", cases.len(), case.name);
                results.push((index, (*case, findings)));
            }
        };
        let parts: Result<Vec<_>> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
            workers
                .into_iter()
                .map(|worker| worker.join().unwrap_or_else(|_| bail!("a case panicked")))
                .collect()
        });
        let mut results: Vec<_> = parts?.into_iter().flatten().collect();
        results.sort_by_key(|(index, _)| *index);
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }
}

fn as_text(results: &[CaseResult]) -> String {
    let mut text = String::new();
    for (case, findings) in results {
        text += &format!("{}\n", case.name);
        for finding in findings {
            let [quantity, exact, found, error, allowed, word] = finding.cells();
            let word = word.trim_matches('*');
            text += &format!("  {quantity:<58} {exact:>10} {found:>10} {error:>10} {allowed:>10}  {word}\n");
        }
    }
    let all = results.iter().flat_map(|(_, findings)| findings);
    let right = all.clone().filter(|finding| finding.holds()).count();
    text + &format!("{right} of {} figures are within their tolerance\n", all.count())
}

fn as_json(results: &[CaseResult]) -> serde_json::Value {
    let finding = |finding: &Comparison| {
        json!({
            "quantity": finding.quantity, "exact": finding.exact, "found": finding.found,
            "error": finding.error(), "holds": finding.holds(),
        })
    };
    let case = |(case, findings): &CaseResult| {
        json!({
            "name": case.name, "about": case.description, "findings": findings.iter().map(finding).collect::<Vec<_>>(),
        })
    };
    json!({ "cases": results.iter().map(case).collect::<Vec<_>>() })
}
