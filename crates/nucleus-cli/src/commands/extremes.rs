//! `nucleus extremes`: what the solver does where scenes leave the ordinary.

use std::fs;
use std::io::{self, IsTerminal, Write, stdout};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use codespan_reporting::term::termcolor::{Buffer, BufferWriter, Color, ColorChoice, ColorSpec, WriteColor};
use nucleus_measure::extremes::{
    Evaluation, Kind, Measurement, StressCase, TimeBudget, evaluate_all, failure_text, named, page, rows,
};
use serde_json::{Value, json};

use crate::outcome::Outcome;
use crate::{figures, output, threads};

/// Runs the table of extremes: scenes that leave the ordinary, each with what has to hold all the same.
///
/// Ends with 1 if a row fails. Cost is processor time over that of the same scene without the extreme, so other work
/// on the machine hardly counts.
#[derive(Debug, Args)]
pub struct Extremes {
    /// Only this row, or all rows whose names begin like this; may be given more than once.
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Only tell which rows there are.
    #[arg(long, conflicts_with_all = ["write", "save", "json"])]
    list: bool,
    /// Print a JSON object for each row.
    #[arg(long)]
    json: bool,
    /// Write the table as a page (.md).
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Write the scenes of the rows into this folder, and run none.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["write", "json"])]
    save: Option<PathBuf>,
    /// Rows to run side by side; as many as there are cores if none is given.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl Extremes {
    /// Runs the rows and prints what came of each.
    pub fn run(self) -> Result<Outcome> {
        let rows = self.rows()?;
        if self.list {
            let lines = rows.iter().map(|row| format!("{:<36} {}\n", row.name, row.summary));
            output::print(&lines.collect::<String>())?;
            return Ok(Outcome::Fine);
        }
        if let Some(folder) = &self.save {
            return save(&rows, folder);
        }
        let mut outcomes = Vec::new();
        // Where a page is written, that is the result.
        let is_result = self.write.is_none();
        let mut take = |outcome: Evaluation| -> Result<()> {
            match self.json {
                true => output::put(output::write(&format!("{}\n", as_json(&outcome))), is_result)?,
                false => output::put(print(&outcome, outcomes.last())?, is_result)?,
            }
            outcomes.push(outcome);
            Ok(())
        };
        evaluate_all(&rows, threads::count(self.threads), TimeBudget::Long, &mut take)?;
        if !self.json {
            output::tell(&total(&outcomes));
        }
        if let Some(file) = &self.write {
            fs::write(file, page(&outcomes)).with_context(|| format!("cannot write `{}`", file.display()))?;
        }
        Ok(if outcomes.iter().all(Evaluation::holds) { Outcome::Fine } else { Outcome::Trouble })
    }

    /// The rows that are asked for.
    fn rows(&self) -> Result<Vec<&'static StressCase>> {
        let known = |name: &str| rows().any(|row| row.name.starts_with(name));
        if let Some(unknown) = self.only.iter().find(|name| !known(name)) {
            bail!("there is no row `{unknown}`; `nucleus extremes --list` tells which there are");
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

/// Writes each scene with its meshes into a folder of its own.
fn save(rows: &[&StressCase], folder: &Path) -> Result<Outcome> {
    for row in rows {
        let folder = folder.join(row.name);
        let written = fs::create_dir_all(&folder).and_then(|()| row.scene().write(&folder, row.name));
        written.with_context(|| format!("cannot write to `{}`", folder.display()))?;
    }
    let scenes = figures::count(rows.len(), "scene");
    output::tell(&format!("{scenes} in `{}`; `nucleus run` runs them\n", folder.display()));
    Ok(Outcome::Fine)
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

/// A row of the table, under a heading if a new part begins with it.
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

/// For machines: figures that are not finite become null.
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
