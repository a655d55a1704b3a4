//! The plan of a wedge: `plan.json`, with one line for each run.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use nucleus_cache::atomic_file::AtomicFile;
use serde::{Deserialize, Serialize};

use crate::error::WedgeError;

/// A plan: facts about all runs, and the runs.
///
/// The file is one JSON object whose first line holds the facts, followed by one line per run: run `k` is on line `k + 2`.
/// Schedulers need only the number of runs; `nucleus wedge --out FOLDER --run K` does run `K`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plan {
    /// Facts about all runs.
    #[serde(flatten)]
    pub header: PlanHeader,
    /// The runs, in the order of their numbers.
    pub runs: Vec<PlannedRun>,
}

/// Facts about all runs of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanHeader {
    /// Version of the format.
    pub plan: u32,
    /// The version of Nucleus that wrote it.
    pub nucleus: String,
    /// The path of the scene, or the name of the command.
    pub title: String,
    /// The folder in which the runs are started, so that relative paths hold.
    pub directory: PathBuf,
    /// Fingerprint of the scene with its meshes and maps; empty if there is no scene.
    pub fingerprint: String,
    /// The headings of the values.
    pub columns: Vec<String>,
    /// The estimated memory of one run in bytes; 0 if unknown.
    pub memory: u64,
}

/// One run of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedRun {
    /// Its number, from 0.
    pub run: u32,
    /// The name of its files.
    pub name: String,
    /// Its values, in the syntax of scenes, in the order of the columns.
    pub values: Vec<String>,
    /// Its seed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u32>,
    /// The arguments of the `nucleus` command, without the output.
    pub arguments: Vec<String>,
}

/// The version of the format.
const VERSION: u32 = 1;

/// The end of the first line, and of the file.
const OPEN: &str = ",\"runs\":[";
const CLOSE: &str = "]}";

impl PlanHeader {
    /// The header of a plan that this version writes.
    pub fn new(title: String, directory: PathBuf, columns: Vec<String>) -> Self {
        let nucleus = env!("CARGO_PKG_VERSION").to_owned();
        Self { plan: VERSION, nucleus, title, directory, fingerprint: String::new(), columns, memory: 0 }
    }
}

/// The name of a run, with as many digits as the last one needs and at least four.
pub fn run_name(run: u32, count: usize) -> String {
    let digits = count.saturating_sub(1).to_string().len().max(4);
    format!("{run:0digits$}")
}

impl Plan {
    /// Writes the plan atomically.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut file = io::BufWriter::new(AtomicFile::create(path)?);
        let header = serde_json::to_string(&self.header)?;
        writeln!(file, "{}{OPEN}", header.strip_suffix('}').unwrap_or(&header))?;
        for (index, run) in self.runs.iter().enumerate() {
            let end = if index + 1 < self.runs.len() { "," } else { "" };
            serde_json::to_writer(&mut file, run)?;
            writeln!(file, "{end}")?;
        }
        writeln!(file, "{CLOSE}")?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.handle()?.sync_all()?;
        file.commit()
    }

    /// Reads a plan.
    ///
    /// # Errors
    /// When the file cannot be read, is not a plan, or is a plan of another version.
    pub fn read(path: &Path) -> Result<Self, WedgeError> {
        let bytes = std::fs::read(path).map_err(|source| unreadable(path, source))?;
        let plan: Self = serde_json::from_slice(&bytes)
            .map_err(|error| WedgeError::NotAPlan { path: path.to_owned(), message: error.to_string() })?;
        plan.check(path)?;
        Ok(plan)
    }

    /// The facts and one run, without reading the runs after it.
    ///
    /// # Errors
    /// As [`read`](Self::read), and when there is no such run.
    pub fn read_run(path: &Path, run: u32) -> Result<(PlanHeader, PlannedRun), WedgeError> {
        if let Some(found) = line_of(path, run).map_err(|source| unreadable(path, source))? {
            check_header(&found.0, path)?;
            check_run(&found.1, path)?;
            return Ok(found);
        }
        // The file has been written by another program, in another layout.
        let plan = Self::read(path)?;
        let (count, header) = (plan.runs.len(), plan.header);
        let found = plan.runs.into_iter().nth(run as usize);
        found.map(|found| (header, found)).ok_or(WedgeError::NoRun { run, count })
    }

    fn check(&self, path: &Path) -> Result<(), WedgeError> {
        check_header(&self.header, path)?;
        let mut names = BTreeSet::new();
        for (index, run) in self.runs.iter().enumerate() {
            check_run(run, path)?;
            let message = if run.run as usize != index {
                format!("run {} is at place {index}", run.run)
            } else if !names.insert(&run.name) {
                format!("two runs are named `{}`", run.name)
            } else if run.values.len() != self.header.columns.len() {
                format!(
                    "run {} has {} values for {} columns",
                    run.run,
                    run.values.len(),
                    self.header.columns.len()
                )
            } else {
                continue;
            };
            return Err(WedgeError::NotAPlan { path: path.to_owned(), message });
        }
        Ok(())
    }
}

fn unreadable(path: &Path, source: io::Error) -> WedgeError {
    WedgeError::Io { path: path.to_owned(), source }
}

fn check_header(header: &PlanHeader, path: &Path) -> Result<(), WedgeError> {
    match header.plan {
        VERSION => Ok(()),
        version => Err(WedgeError::NotAPlan {
            path: path.to_owned(),
            message: format!("it has version {version}; this version of nucleus reads version {VERSION}"),
        }),
    }
}

/// Names become parts of paths.
fn check_run(run: &PlannedRun, path: &Path) -> Result<(), WedgeError> {
    let is_safe = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    if !run.name.is_empty() && run.name.chars().all(is_safe) {
        return Ok(());
    }
    let message = format!("`{}` is not a name of files: use letters, digits, `-` and `_`", run.name);
    Err(WedgeError::NotAPlan { path: path.to_owned(), message })
}

/// Header and run by their lines; `None` if the file has another layout.
fn line_of(path: &Path, run: u32) -> io::Result<Option<(PlanHeader, PlannedRun)>> {
    let mut file = BufReader::with_capacity(1 << 16, File::open(path)?);
    let mut line = String::new();
    file.read_line(&mut line)?;
    let Some(header) = line.trim_end().strip_suffix(OPEN) else { return Ok(None) };
    let Ok(header) = serde_json::from_str(&format!("{header}}}")) else { return Ok(None) };
    for _ in 0..run {
        file.skip_until(b'\n')?;
    }
    line.clear();
    file.read_line(&mut line)?;
    let found = serde_json::from_str(line.trim_end().trim_end_matches(','));
    Ok(found.ok().filter(|found: &PlannedRun| found.run == run).map(|found| (header, found)))
}

/// The runs that a text selects: `7`, `0..19` (both included), `1,4,10..12`. In order, each once.
///
/// # Errors
/// A message when the text is no selection, or selects a run that does not exist.
pub fn parse_selection(text: &str, count: usize) -> Result<Vec<u32>, String> {
    let mut all = BTreeSet::new();
    for part in text.split(',') {
        let Range { start, end } = range(part.trim()).ok_or_else(|| {
            format!("`{part}` selects no runs; write a number, `0..19`, or several separated by commas")
        })?;
        if end as usize > count {
            return Err(format!(
                "there is no run {}; the plan has runs 0 to {}",
                end - 1,
                count.saturating_sub(1)
            ));
        }
        all.extend(start..end);
    }
    Ok(all.into_iter().collect())
}

fn range(text: &str) -> Option<Range<u32>> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let (first, last): (u32, u32) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
    (first <= last).then(|| first..last.saturating_add(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(count: u32) -> Plan {
        let columns = vec!["cloth1.bendResistance".to_owned(), "nucleus1.windSpeed".to_owned()];
        let header = PlanHeader::new("scene.ron".to_owned(), "/shots".into(), columns);
        let run = |run: u32| PlannedRun {
            run,
            name: run_name(run, count as usize),
            values: vec![format!("{}", f64::from(run) / 7.0), "5".to_owned()],
            seed: run.is_multiple_of(2).then_some(run),
            arguments: ["run", "scene.ron", "--set", "cloth1.bendResistance=0.1"].map(str::to_owned).to_vec(),
        };
        Plan { header, runs: (0..count).map(run).collect() }
    }

    #[test]
    fn a_plan_is_json_with_one_line_for_each_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.json");
        let plan = plan(3);
        plan.write(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text.lines().count(), 5);
        let line: PlannedRun = serde_json::from_str(text.lines().nth(3).unwrap()).unwrap();
        assert_eq!(line, plan.runs[2]);
        assert_eq!(Plan::read(&path).unwrap(), plan);
        assert_eq!(Plan::read_run(&path, 1).unwrap(), (plan.header.clone(), plan.runs[1].clone()));
        assert!(matches!(Plan::read_run(&path, 3), Err(WedgeError::NoRun { run: 3, count: 3 })));
    }

    #[test]
    fn a_plan_that_another_program_has_laid_out_is_read_too() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.json");
        let plan = plan(2);
        std::fs::write(&path, serde_json::to_string_pretty(&plan).unwrap()).unwrap();
        assert_eq!(Plan::read_run(&path, 1).unwrap().1, plan.runs[1]);
    }

    #[test]
    fn a_name_that_leaves_the_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.json");
        let mut plan = plan(1);
        plan.runs[0].name = "../../etc".to_owned();
        plan.write(&path).unwrap();
        for refused in [Plan::read(&path).err(), Plan::read_run(&path, 0).err()] {
            assert!(refused.unwrap().to_string().contains("is not a name of files"));
        }
    }

    #[test]
    fn a_plan_of_a_hundred_thousand_runs_is_written_and_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plan.json");
        let plan = plan(100_000);
        plan.write(&path).unwrap();
        assert!(Plan::read(&path).unwrap() == plan);
        let last = Plan::read_run(&path, 99_999).unwrap().1;
        assert_eq!(last.name, "99999");
    }

    #[test]
    fn runs_are_selected_by_numbers_and_ranges() {
        assert_eq!(parse_selection("7", 10), Ok(vec![7]));
        assert_eq!(parse_selection("3..4, 0,4", 10), Ok(vec![0, 3, 4]));
        assert!(parse_selection("10", 10).unwrap_err().contains("runs 0 to 9"));
        assert!(parse_selection("4..3", 10).is_err() && parse_selection("", 10).is_err());
    }
}
