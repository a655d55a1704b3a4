//! `nucleus extremes`: stress tests of the solver with extreme values, meshes and motions.

use std::fs;
use std::io::{self, IsTerminal, Write, stdout};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use codespan_reporting::term::termcolor::{Buffer, BufferWriter, Color, ColorChoice, ColorSpec, WriteColor};
use nucleus_measure::extremes::{
    Baselines, Evaluation, Findings, Kind, Measurement, StressCase, TimeBudget, evaluate, evaluate_all,
    failure_text, named, page, rows,
};
use serde_json::{Value, json};

use crate::output::say;
use crate::process::Outcome;
use crate::runs::{PartOptions, part_report};
use crate::{figures, options, output};

/// Runs the stress tests: scenes with extreme values, meshes and motions, each with the conditions that it must meet.
///
/// Exits with 1 if a row fails. Cost is the ratio of processor time to that of the same scene without the extreme, so other
/// work on the machine has little influence.
#[derive(Debug, Args)]
pub struct Extremes {
    /// Run this row, or all rows whose names start with this; may be given several times.
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// List the rows and run none.
    #[arg(long, conflicts_with_all = ["write", "save", "json"])]
    list: bool,
    /// Print one JSON object per row.
    #[arg(long)]
    json: bool,
    /// Write the table as a Markdown page.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Write the scenes of the rows into this folder and run none.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["write", "json"])]
    save: Option<PathBuf>,
    /// Rows to run in parallel; default: one per core.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Run every row to its end and do not measure its cost.
    #[arg(long)]
    untimed: bool,
    #[command(flatten)]
    parts: PartOptions,
}

impl Extremes {
    /// Runs the rows and prints the figures of each.
    pub fn run(self) -> Result<Outcome> {
        let rows = self.rows()?;
        if self.list {
            let lines = rows.iter().map(|row| format!("{:<36} {}\n", row.name, row.summary));
            output::print(&lines.collect::<String>())?;
            return Ok(Outcome::Success);
        }
        if let Some(folder) = &self.save {
            return save(&rows, folder);
        }
        let mut outcomes = Vec::new();
        // The page is the result if one is written, else the table.
        let is_result = self.write.is_none();
        let mut take = |outcome: Evaluation| -> Result<()> {
            match self.json {
                true => output::check(output::write(&format!("{}\n", as_json(&outcome))), is_result)?,
                false => output::check(print(&outcome, outcomes.last())?, is_result)?,
            }
            outcomes.push(outcome);
            Ok(())
        };
        if self.parts.is_planned() {
            let Some(found) = self.planned(&rows)? else { return Ok(Outcome::Interrupted) };
            found.into_iter().try_for_each(&mut take)?;
        } else {
            evaluate_all(&rows, options::thread_count(self.jobs), self.budget(), &mut take)?;
        }
        if !self.json {
            output::report(&total(&outcomes));
        }
        if let Some(file) = &self.write {
            fs::write(file, page(&outcomes)).with_context(|| format!("cannot write `{}`", file.display()))?;
        }
        Ok(if outcomes.iter().all(Evaluation::holds) { Outcome::Success } else { Outcome::Problem })
    }

    fn budget(&self) -> TimeBudget {
        if self.untimed { TimeBudget::Untimed } else { TimeBudget::Long }
    }

    /// Evaluates the rows as runs of a plan. Their cost is measured only where they are alone on a machine.
    fn planned(&self, rows: &[&'static StressCase]) -> Result<Option<Vec<Evaluation>>> {
        let is_untimed = self.untimed || !self.parts.is_alone(self.jobs);
        if is_untimed && !self.untimed {
            say!("the cost of rows is not measured, because they share a machine; `--jobs 1` measures it");
        }
        let part = |row: &&StressCase| {
            let untimed = is_untimed.then(|| "--untimed".to_owned());
            let only = ["--only".to_owned(), row.name.to_owned()];
            (row.name.to_owned(), only.into_iter().chain(untimed).collect())
        };
        let found = self.parts.execute::<Findings>("extremes", rows.iter().map(part).collect(), self.jobs)?;
        let evaluation = |(row, found): (&&'static StressCase, Findings)| Evaluation::of(row, found);
        Ok(found.map(|found| rows.iter().zip(found).map(evaluation).collect()))
    }

    /// Evaluates one row and returns its report, for the result of a run of a plan.
    pub fn part(&self) -> Result<Value> {
        let rows = self.rows()?;
        let [row] = rows[..] else { bail!("a run of a plan evaluates one row, not {}", rows.len()) };
        let evaluation = evaluate(row, &Baselines::default(), self.budget())?;
        let failures: Vec<String> = evaluation.failures().map(failure_text).collect();
        part_report(&evaluation.findings(), &failures)
    }

    /// The requested rows.
    fn rows(&self) -> Result<Vec<&'static StressCase>> {
        let known = |name: &str| rows().any(|row| row.name.starts_with(name));
        if let Some(unknown) = self.only.iter().find(|name| !known(name)) {
            bail!("there is no row `{unknown}`; `nucleus extremes --list` lists them");
        }
        let wanted = |row: &&StressCase| {
            let asked = |name: &String| match named(name) {
                Some(exact) => exact.name == row.name,
                None => row.name.starts_with(name.as_str()),
            };
            self.only.is_empty() || self.only.iter().any(asked)
        };
        Ok(rows().filter(wanted).collect())
    }
}

/// Writes each scene with its meshes into a folder per row.
fn save(rows: &[&StressCase], folder: &Path) -> Result<Outcome> {
    for row in rows {
        let folder = folder.join(row.name);
        let written = fs::create_dir_all(&folder).and_then(|()| row.scene().write(&folder, row.name));
        written.with_context(|| format!("cannot write to `{}`", folder.display()))?;
    }
    let scenes = figures::count(rows.len(), "scene");
    output::report(&format!("wrote {scenes} to `{}`; run them with `nucleus run`\n", folder.display()));
    Ok(Outcome::Success)
}

/// `71 of 80 rows hold, 9 fail`.
fn total(outcomes: &[Evaluation]) -> String {
    let failing = outcomes.iter().filter(|outcome| !outcome.holds()).count();
    let all = figures::count(outcomes.len(), "row");
    match failing {
        0 => format!("\n{all}: all hold\n"),
        failing => format!("\n{} of {all} hold, {failing} fail\n", outcomes.len() - failing),
    }
}

/// Prints a row of the table, after a heading if it is the first of its group.
fn print(outcome: &Evaluation, before: Option<&Evaluation>) -> Result<io::Result<()>> {
    let choice = if stdout().is_terminal() { ColorChoice::Auto } else { ColorChoice::Never };
    let writer = BufferWriter::stdout(choice);
    let mut buffer = writer.buffer();
    if before.is_none_or(|before| before.stress_case.group != outcome.stress_case.group) {
        heading(&mut buffer, outcome.stress_case.group)?;
    }
    line(&mut buffer, outcome)?;
    for figure in outcome.failures() {
        writeln!(buffer, "        {}", failure_text(figure))?;
    }
    if let Some(reason) = outcome.stress_case.known_failure.filter(|_| !outcome.holds()) {
        writeln!(buffer, "        known: {reason}")?;
    }
    Ok(writer.print(&buffer))
}

fn heading(buffer: &mut Buffer, group: &str) -> Result<()> {
    buffer.set_color(ColorSpec::new().set_bold(true))?;
    writeln!(buffer, "\n{group:<40} {:>8} {:>10} {:>9} {:>6}", "energy", "speed", "strain", "cost")?;
    Ok(buffer.reset()?)
}

fn line(buffer: &mut Buffer, outcome: &Evaluation) -> Result<()> {
    let (verdict, colour) = if outcome.holds() { ("ok", Color::Green) } else { ("FAIL", Color::Red) };
    buffer.set_color(ColorSpec::new().set_fg(Some(colour)))?;
    write!(buffer, "  {verdict:<4} ")?;
    buffer.reset()?;
    let cell = |kind: Kind, show: &dyn Fn(f64) -> String| {
        outcome.figure(kind).map_or_else(String::new, |figure| show(figure.value))
    };
    let energy = cell(Kind::Energy, &|share| format!("{share:.3}"));
    let speed = cell(Kind::Speed, &|speed| format!("{speed:.4} m/s"));
    let strain = cell(Kind::Strain, &|strain| format!("{:.2} %", 100.0 * strain));
    let cost = cell(Kind::Cost, &|cost| format!("{cost:.1}×"));
    let name = outcome.stress_case.name;
    Ok(writeln!(buffer, "{name:<33} {energy:>8} {speed:>10} {strain:>9} {cost:>6}")?)
}

/// A row as JSON. Figures that are not finite become null.
fn as_json(outcome: &Evaluation) -> Value {
    let figure = |figure: &Measurement| {
        json!({
            "what": figure.what.trim(),
            "value": figure.value,
            "side": figure.side.words(),
            "limit": figure.limit,
            "holds": figure.holds(),
        })
    };
    let StressCase { name, group, summary, expected, known_failure, .. } = outcome.stress_case;
    json!({
        "name": name,
        "group": group,
        "what": summary,
        "expect": expected,
        "holds": outcome.holds(),
        "known_to_fail": known_failure,
        "figures": outcome.figures.iter().map(figure).collect::<Vec<_>>(),
        "reported": outcome.reported,
    })
}
