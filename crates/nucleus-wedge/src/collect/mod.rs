//! Collects the results of a wedge: a table as CSV, and a page with a contact sheet.

mod csv;
mod page;
mod row;

use crate::error::{WedgeError, at};
use crate::folder::WedgeFolder;
use crate::pictures;
use crate::plan::{Plan, PlannedRun};
use crate::result::RunResult;
use nucleus_cache::atomic_file;

pub use row::Counts;
use row::Row;

/// The collected results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Collected {
    /// Counts by outcome.
    pub counts: Counts,
    /// Names of runs whose picture could not be drawn, with the reasons.
    pub without_picture: Vec<(String, String)>,
    /// Finished runs whose cache is missing or cut off, with the reasons. They have no picture either.
    pub without_cache: Vec<(u32, String)>,
}

/// Writes the table and the page of a wedge, with the pictures of its finished caches drawn on `threads` threads.
///
/// # Errors
/// When a result cannot be read, or a file cannot be written.
pub fn collect(folder: &WedgeFolder, plan: &Plan, threads: usize) -> Result<Collected, WedgeError> {
    let results = folder.results(plan)?;
    let fault = |(run, result): (&PlannedRun, &Option<RunResult>)| {
        result.as_ref().and_then(|result| folder.cache_fault(&run.name, result))
    };
    let faults: Vec<Option<String>> = plan.runs.iter().zip(&results).map(fault).collect();
    let with_faults = plan.runs.iter().zip(&results).zip(&faults);
    let rows: Vec<Row> = with_faults
        .map(|((run, result), fault)| Row { run, result: result.as_ref(), fault: fault.as_deref() })
        .collect();
    let counts = Counts::of(rows.iter().map(|row| row.result));
    let is_drawable =
        |row: &&Row| row.fault.is_none() && row.result.is_some_and(|result| result.outcome.is_final());
    let drawable = rows.iter().filter(is_drawable);
    let names: Vec<&str> =
        drawable.map(|row| row.run.name.as_str()).filter(|name| folder.cache(name).is_file()).collect();
    let without_picture = pictures::draw(folder, &names, threads)?;
    let write = |path: std::path::PathBuf, text: String| {
        atomic_file::write(&path, text.as_bytes()).map_err(|source| at(&path, source))
    };
    write(folder.table(), csv::table(plan, &rows))?;
    let pictured =
        |name: &str| names.contains(&name) && without_picture.iter().all(|(other, _)| other != name);
    write(folder.page(), page::html(plan, &rows, counts, &pictured))?;
    let without_cache = rows.iter().filter_map(|row| Some((row.run.run, row.fault?.to_owned()))).collect();
    Ok(Collected { counts, without_picture, without_cache })
}
