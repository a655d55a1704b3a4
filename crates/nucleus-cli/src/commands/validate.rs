//! `nucleus validate`: the solver against exact physics.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use nucleus_measure::validation::{Case, Comparison, cases, page};
use serde_json::json;

use crate::outcome::Outcome;
use crate::output::say;
use crate::{output, threads};

/// Holds the solver against exact physics: strips that bend and buckle, sheets that hang, friction, swings, drape.
#[derive(Debug, Args)]
pub struct Validate {
    /// Cases to run, or the beginnings of their names [default: all].
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// List the cases and what they are, without running them.
    #[arg(long)]
    list: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write the page of the book to this file.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Cases to run at a time [default: one per core].
    #[arg(long)]
    threads: Option<usize>,
}

/// A case with what it found.
type CaseResult = (Case, Vec<Comparison>);

impl Validate {
    /// Runs the cases and prints their tables. A figure outside what is allowed is trouble.
    pub fn run(self) -> Result<Outcome> {
        let cases = self.cases()?;
        if self.list {
            cases
                .iter()
                .try_for_each(|case| output::print(&format!("{:<18} {}\n", case.name, case.description)))?;
            return Ok(Outcome::Fine);
        }
        let results = self.run_all(&cases)?;
        if let Some(path) = &self.write {
            let text = page(&results)?;
            std::fs::write(path, text).with_context(|| format!("cannot write `{}`", path.display()))?;
        }
        match self.json {
            true => output::tell_json(&as_json(&results)),
            false => output::tell(&as_text(&results)),
        }
        let right = results.iter().all(|(_, findings)| findings.iter().all(Comparison::holds));
        Ok(if right { Outcome::Fine } else { Outcome::Trouble })
    }

    fn cases(&self) -> Result<Vec<Case>> {
        for name in &self.only {
            if !cases().any(|case| case.name.starts_with(name.as_str())) {
                let names: Vec<String> = cases().map(|case| format!("`{}`", case.name)).collect();
                bail!("there is no case `{name}`; there are {}", names.join(", "));
            }
        }
        let asked_for = |case: &Case| self.only.iter().any(|name| case.name.starts_with(name.as_str()));
        Ok(cases().filter(|case| self.only.is_empty() || asked_for(case)).collect())
    }

    /// Runs the cases, some at a time, and says on standard error when one is done.
    fn run_all(&self, cases: &[Case]) -> Result<Vec<CaseResult>> {
        let threads = self.threads.unwrap_or_else(|| threads::count(None)).clamp(1, cases.len().max(1));
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
            let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            workers
                .into_iter()
                .map(|worker| worker.join().unwrap_or_else(|_| bail!("a case has panicked")))
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
    text + &format!("{right} of {} figures are within what is allowed\n", all.count())
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
