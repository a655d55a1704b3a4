//! Milliseconds by stage, as a table.

use super::table::{Table, figure};
use nucleus_measure::clock::STAGES;

/// Stages below this share in all rows have no column.
const LEAST: f64 = 0.002;

/// A run: its first cells, milliseconds per frame, and the share of each of [`STAGES`].
pub type Row = (Vec<String>, f64, [f64; STAGES.len()]);

/// Table of runs; `first` are the heads of the first cells.
pub fn table(title: &str, first: &[&str], runs: &[Row]) -> Table {
    let is_used = |k: &usize| runs.iter().any(|(_, _, shares)| shares[*k] > LEAST);
    let used: Vec<usize> = (0..STAGES.len()).filter(is_used).collect();
    let names = used.iter().map(|&k| STAGES[k].1);
    let head: Vec<&str> = first.iter().copied().chain(["ms"]).chain(names).collect();
    let mut table = Table::new(title, &head);
    for (cells, ms, shares) in runs {
        let stages = used.iter().map(|&k| figure(ms * shares[k]));
        table.row(cells.iter().cloned().chain([figure(*ms)]).chain(stages));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_without_time_have_no_column() {
        let mut shares = [0.0; STAGES.len()];
        (shares[0], shares[3], shares[8]) = (0.25, 0.749, 0.001);
        let table = table("by stage", &["points"], &[(vec!["33²".to_owned()], 8.0, shares)]);
        assert_eq!(table.head, ["points", "ms", STAGES[0].1, STAGES[3].1]);
        assert_eq!(table.rows, [["33²", "8.00", "2.00", "5.99"]]);
    }
}
