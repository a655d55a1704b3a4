//! Collects the results of a wedge: a table as CSV, and a page with a contact sheet.

mod csv;
mod page;
mod row;

use crate::error::{WedgeError, at};
use crate::folder::WedgeFolder;
use crate::pictures;
use crate::plan::Plan;
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
}

/// Writes the table and the page of a wedge, with the pictures of its finished caches drawn on `threads` threads.
///
/// # Errors
/// When a result cannot be read, or a file cannot be written.
pub fn collect(folder: &WedgeFolder, plan: &Plan, threads: usize) -> Result<Collected, WedgeError> {
    let results = folder.results(plan)?;
    let rows: Vec<Row> =
        plan.runs.iter().zip(&results).map(|(run, result)| Row { run, result: result.as_ref() }).collect();
    let counts = Counts::of(rows.iter().map(|row| row.result));
    let drawable = rows.iter().filter(|row| row.result.is_some_and(|result| result.outcome.is_final()));
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
    Ok(Collected { counts, without_picture })
}
