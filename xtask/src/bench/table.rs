//! Markdown tables with aligned columns, readable on a terminal; and the table of milliseconds by stage.

use std::fmt;

use nucleus_measure::clock::STAGES;

/// A table with a heading and notes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    /// Heading.
    pub title: String,
    /// Column heads.
    pub head: Vec<String>,
    /// Rows, each as long as the head.
    pub rows: Vec<Vec<String>>,
    /// Sentences below it.
    pub notes: Vec<String>,
}

impl Table {
    /// A table without rows.
    pub fn new(title: &str, head: &[&str]) -> Self {
        let head = head.iter().map(|&name| name.to_owned()).collect();
        Self { title: title.to_owned(), head, ..Self::default() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Adds a sentence below.
    pub fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }
}

/// A number with three significant digits, or a word if it is not finite.
pub fn figure(number: f64) -> String {
    match number.abs() {
        _ if number.is_nan() => "-".to_owned(),
        size if size.is_infinite() => "lost".to_owned(),
        0.0 => "0".to_owned(),
        size if size < 0.01 => format!("{number:.5}"),
        size if size < 1.0 => format!("{number:.3}"),
        size if size < 10.0 => format!("{number:.2}"),
        size if size < 100.0 => format!("{number:.1}"),
        _ => format!("{number:.0}"),
    }
}

/// Whether a cell is numeric; numeric columns are right-aligned.
fn is_number(cell: &str) -> bool {
    cell == "lost" || cell.chars().all(|c| c.is_ascii_digit() || ".-²".contains(c))
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = 0..self.head.len();
        let cells = |column: usize| self.rows.iter().filter_map(move |row| row.get(column));
        let width = |column: usize| {
            let widths = cells(column).chain([&self.head[column]]).map(|cell| cell.chars().count());
            widths.max().unwrap_or_default().max(2)
        };
        let right = |column: usize| cells(column).all(|cell| is_number(cell));
        let columns: Vec<(usize, bool)> = columns.map(|column| (width(column), right(column))).collect();
        let line = |f: &mut fmt::Formatter<'_>, row: &[String]| {
            for (cell, &(width, right)) in row.iter().zip(&columns) {
                if right { write!(f, "| {cell:>width$} ")? } else { write!(f, "| {cell:<width$} ")? }
            }
            writeln!(f, "|")
        };
        writeln!(f, "### {}\n", self.title)?;
        line(f, &self.head)?;
        for &(width, right) in &columns {
            write!(f, "|{:-<1$}{2}", "", width + 1, if right { ":" } else { "-" })?;
        }
        writeln!(f, "|")?;
        self.rows.iter().try_for_each(|row| line(f, row))?;
        if !self.notes.is_empty() {
            writeln!(f)?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "{note}"))
    }
}

/// Stages below this share in all rows have no column.
const LEAST: f64 = 0.002;

/// A run: its first cells, milliseconds per frame, and the share of each of [`STAGES`].
pub type StageRow = (Vec<String>, f64, [f64; STAGES.len()]);

impl Table {
    /// Table of milliseconds by stage; `first` are the heads of the first cells.
    pub fn by_stage(title: &str, first: &[&str], runs: &[StageRow]) -> Self {
        let is_used = |k: &usize| runs.iter().any(|(_, _, shares)| shares[*k] > LEAST);
        let used: Vec<usize> = (0..STAGES.len()).filter(is_used).collect();
        let names = used.iter().map(|&k| STAGES[k].1);
        let head: Vec<&str> = first.iter().copied().chain(["ms"]).chain(names).collect();
        let mut table = Self::new(title, &head);
        for (cells, ms, shares) in runs {
            let stages = used.iter().map(|&k| figure(ms * shares[k]));
            table.row(cells.iter().cloned().chain([figure(*ms)]).chain(stages));
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_fit_their_widest_cell_and_numbers_are_right_aligned() {
        let mut table = Table::new("Times", &["solver", "ms"]);
        table.row(["2nd one".to_owned(), figure(1.234)]);
        table.row(["another".to_owned(), figure(1234.5)]);
        table.note("Less is better.");
        let text = "### Times\n\n| solver  |   ms |\n|---------|-----:|\n| 2nd one | 1.23 |\n| another | 1234 |\n\n\
            Less is better.\n";
        assert_eq!(table.to_string(), text);
    }

    #[test]
    fn values_that_are_not_finite_are_words() {
        assert_eq!([f64::NAN, f64::INFINITY, 0.0].map(figure), ["-", "lost", "0"]);
    }

    #[test]
    fn stages_without_time_have_no_column() {
        let mut shares = [0.0; STAGES.len()];
        (shares[0], shares[3], shares[8]) = (0.25, 0.749, 0.001);
        let table = Table::by_stage("by stage", &["points"], &[(vec!["33²".to_owned()], 8.0, shares)]);
        assert_eq!(table.head, ["points", "ms", STAGES[0].1, STAGES[3].1]);
        assert_eq!(table.rows, [["33²", "8.00", "2.00", "5.99"]]);
    }
}
