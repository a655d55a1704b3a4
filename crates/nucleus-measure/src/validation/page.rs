//! The results as a Markdown page.

use std::fmt::Write;

use super::case::{Case, Comparison, Tolerance};

/// The page: a section per case, with a table of its figures.
///
/// # Errors
/// Never: writing to a string does not fail.
pub fn page(results: &[(Case, Vec<Comparison>)]) -> Result<String, std::fmt::Error> {
    let all: Vec<&Comparison> = results.iter().flat_map(|(_, comparisons)| comparisons).collect();
    let right = all.iter().filter(|comparison| comparison.holds()).count();
    let mut page = String::from(
        "# Validation\n\nThe solver compared with closed-form and tabulated solutions: `nucleus validate` runs the cases, and `--write` writes this page.\nRuns are in double precision and SI units, so that the remaining error is that of the method.\n\n",
    );
    writeln!(page, "{right} of {} figures are within their tolerance.", all.len())?;
    let wrong: Vec<String> =
        results.iter().filter_map(|(case, comparisons)| failures(case, comparisons)).collect();
    if !wrong.is_empty() {
        writeln!(page, "These are not:\n\n{}", wrong.join("\n"))?;
    }
    for (case, comparisons) in results {
        writeln!(page, "\n## {}\n\n{}\n", case.name, case.description)?;
        page.push_str(
            "| figure | reference | computed | error | tolerance | |\n|---|---:|---:|---:|---:|---|\n",
        );
        for comparison in comparisons {
            writeln!(page, "| {} |", comparison.cells().join(" | "))?;
        }
    }
    Ok(page)
}

/// The failures of a case, one line each, with the known reason.
fn failures(case: &Case, comparisons: &[Comparison]) -> Option<String> {
    let line = |comparison: &Comparison| {
        format!("- {}: {}, {}", case.name, comparison.quantity, comparison.summary())
    };
    let lines: Vec<String> = comparisons.iter().filter(|comparison| !comparison.holds()).map(line).collect();
    let reason = case.known_failure.unwrap_or("Not known to fail: something has changed.");
    (!lines.is_empty()).then(|| format!("{}\n  {reason}", lines.join("\n")))
}

impl Comparison {
    /// Figure, reference, computed, error, tolerance, status.
    pub fn cells(&self) -> [String; 6] {
        let (exact, tolerance) = match self.tolerance {
            Tolerance::Relative(most) => (figure(self.exact), format!("{} %", figure(100.0 * most))),
            Tolerance::Absolute(most) => (figure(self.exact), figure(most)),
            Tolerance::AtMost => (String::new(), format!("≤ {}", figure(self.exact))),
            Tolerance::AtLeast => (String::new(), format!("≥ {}", figure(self.exact))),
        };
        let word = if self.holds() { "ok" } else { "**fails**" };
        [self.quantity.clone(), exact, figure(self.found), self.error_in_words(), tolerance, word.to_owned()]
    }

    /// Computed figure, reference and tolerance.
    fn summary(&self) -> String {
        let [_, exact, found, error, tolerance, _] = self.cells();
        match self.error() {
            Some(_) => format!("{found} instead of {exact}: error {error}, tolerance {tolerance}"),
            None => format!("{found}, tolerance {tolerance}"),
        }
    }

    fn error_in_words(&self) -> String {
        match (self.error(), self.tolerance) {
            (Some(error), Tolerance::Relative(_)) => format!("{} %", signed(100.0 * error)),
            (Some(error), _) => signed(error),
            (None, _) => String::new(),
        }
    }
}

/// Five significant digits.
fn figure(x: f64) -> String {
    match x.abs() {
        size if size == 0.0 || !size.is_finite() => format!("{x}"),
        size if !(1e-3..1e6).contains(&size) => format!("{x:.2e}"),
        size => {
            let digits = (4 - size.log10().floor() as i32).clamp(0, 7) as usize;
            let text = format!("{x:.digits$}");
            if text.contains('.') {
                text.trim_end_matches('0').trim_end_matches('.').to_owned()
            } else {
                text
            }
        }
    }
}

/// Two significant digits with a sign.
fn signed(x: f64) -> String {
    let digits =
        if x == 0.0 || !x.is_finite() { 0 } else { (1 - x.abs().log10().floor() as i32).clamp(0, 6) };
    let digits = digits as usize;
    format!("{x:+.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_lists_failures_with_their_figures() {
        let case = Case {
            known_failure: Some("A reason."),
            ..super::super::cases().next().expect("there are cases")
        };
        let comparisons = vec![
            Comparison::new("right", 2.0, 2.01, Tolerance::Relative(0.01)),
            Comparison::new("wrong", 2.0, 2.5, Tolerance::Absolute(0.1)),
        ];
        let page = page(&[(case, comparisons)]).expect("memory takes text");
        assert!(page.contains("1 of 2 figures"), "{page}");
        assert!(
            page.contains("wrong, 2.5 instead of 2: error +0.50, tolerance 0.1\n  A reason.\n"),
            "{page}"
        );
        assert!(page.contains("| right | 2 | 2.01 | +0.50 % | 1 % | ok |"), "{page}");
    }
}
