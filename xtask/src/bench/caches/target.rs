//! Performance targets of caches.

use crate::bench::table::{Table, figure};

/// A figure and its target.
pub struct Target {
    what: String,
    limit: f64,
    value: f64,
    is_upper: bool,
}

impl Target {
    /// An upper limit.
    pub fn below(what: &str, limit: f64, value: f64) -> Self {
        Self { what: what.to_owned(), limit, value, is_upper: true }
    }

    /// A lower limit.
    pub fn above(what: &str, limit: f64, value: f64) -> Self {
        Self { what: what.to_owned(), limit, value, is_upper: false }
    }

    fn is_reached(&self) -> bool {
        if self.is_upper { self.value < self.limit } else { self.value > self.limit }
    }
}

/// Table of all targets.
pub fn table(targets: &[&Target]) -> Table {
    let mut table = Table::new("Targets", &["", "aim", "found", "reached"]);
    for target in targets {
        let sign = if target.is_upper { "below" } else { "above" };
        let reached = if target.is_reached() { "yes" } else { "no" };
        let limit = format!("{sign} {}", figure(target.limit));
        table.row([target.what.clone(), limit, figure(target.value), reached.to_owned()]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_figure_misses_its_target() {
        assert!(
            !Target::below("", 1.0, f64::NAN).is_reached() && !Target::above("", 1.0, f64::NAN).is_reached()
        );
        assert!(Target::below("", 1.0, 0.5).is_reached() && Target::above("", 1.0, 2.0).is_reached());
    }
}
