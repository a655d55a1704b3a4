//! What caches are to reach, and whether they do.

use super::{Table, figure};

/// A figure that is aimed at.
pub struct Goal {
    what: String,
    aim: f64,
    found: f64,
    is_most: bool,
}

impl Goal {
    /// What is found has to stay below.
    pub fn below(what: &str, aim: f64, found: f64) -> Self {
        Self { what: what.to_owned(), aim, found, is_most: true }
    }

    /// What is found has to be more.
    pub fn above(what: &str, aim: f64, found: f64) -> Self {
        Self { what: what.to_owned(), aim, found, is_most: false }
    }

    fn is_reached(&self) -> bool {
        if self.is_most { self.found < self.aim } else { self.found > self.aim }
    }
}

/// The first table of the page.
pub fn table(goals: &[&Goal]) -> Table {
    let mut table = Table::new("Targets", &["", "target", "measured", "met"]);
    for goal in goals {
        let sign = if goal.is_most { "below" } else { "above" };
        let reached = if goal.is_reached() { "yes" } else { "no" };
        let aim = format!("{sign} {}", figure(goal.aim));
        table.row([goal.what.clone(), aim, figure(goal.found), reached.to_owned()]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_that_is_missing_reaches_nothing() {
        assert!(!Goal::below("", 1.0, f64::NAN).is_reached() && !Goal::above("", 1.0, f64::NAN).is_reached());
        assert!(Goal::below("", 1.0, 0.5).is_reached() && Goal::above("", 1.0, 2.0).is_reached());
    }
}
