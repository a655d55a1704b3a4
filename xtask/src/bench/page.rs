//! The tables of a page, between two markers, replaced by each bench.

use std::fs;
use std::path::Path;

use anyhow::{Context, ensure};

use super::report::Report;

const BEGIN: &str = "<!-- figures: written by `cargo xtask bench --write` -->\n";
const END: &str = "<!-- end of figures -->\n";

/// Checks that the page exists and has both markers.
///
/// # Errors
/// When it cannot be read, or lacks a marker.
pub fn check(path: &Path) -> anyhow::Result<()> {
    put(&read(path)?, "").map(drop).with_context(|| format!("`{}`", path.display()))
}

/// Replaces the figures of a page by those of a report.
///
/// # Errors
/// As [`check`], and when the page cannot be written.
pub fn write(path: &Path, report: &Report) -> anyhow::Result<()> {
    let page = put(&read(path)?, &figures(report)).with_context(|| format!("`{}`", path.display()))?;
    fs::write(path, page).with_context(|| format!("`{}` cannot be written", path.display()))
}

/// All tables, targets first.
fn figures(report: &Report) -> String {
    let mut text = report.machine.join("\n") + "\n";
    let targets = report.target_table();
    for table in [&targets].into_iter().filter(|table| !table.rows.is_empty()).chain(&report.tables) {
        text.extend(["\n", &table.to_string()]);
    }
    text
}

fn put(page: &str, figures: &str) -> anyhow::Result<String> {
    let marks = page.split_once(BEGIN).and_then(|(head, rest)| Some((head, rest.split_once(END)?.1)));
    ensure!(
        marks.is_some(),
        "has no place for figures: it wants the lines `{}` and `{}`",
        BEGIN.trim(),
        END.trim()
    );
    let (head, tail) = marks.unwrap_or_default();
    Ok([head, BEGIN, "\n", figures, "\n", END, tail].concat())
}

fn read(path: &Path) -> anyhow::Result<String> {
    fs::read_to_string(path).with_context(|| format!("`{}` cannot be read", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_replaced_and_the_rest_of_the_page_is_unchanged() {
        let page = format!("above\n{BEGIN}old\n{END}below\n");
        let once = put(&page, "new\n").unwrap();
        assert_eq!(once, format!("above\n{BEGIN}\nnew\n\n{END}below\n"));
        assert_eq!(put(&once, "new\n").unwrap(), once);
    }

    #[test]
    fn targets_are_shown_where_there_are_any() {
        let mut report = Report::default();
        assert!(!figures(&report).contains("Targets"));
        report.check_target("more", "less".to_owned(), false);
        assert!(figures(&report).contains("Targets"));
    }

    #[test]
    fn a_page_without_markers_is_rejected() {
        for page in ["", BEGIN, END, &format!("{END}{BEGIN}")] {
            assert!(put(page, "").unwrap_err().to_string().contains("no place for figures"));
        }
    }
}
