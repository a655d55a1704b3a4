//! The table as CSV: a line per run, numbers in full.

use super::row::{FIGURES, Row, text};
use crate::plan::Plan;

/// The table (RFC 4180, with line feeds).
pub fn table(plan: &Plan, rows: &[Row]) -> String {
    let has_seeds = plan.runs.iter().any(|run| run.seed.is_some());
    let seed = has_seeds.then_some("seed").into_iter();
    let head = ["run"].into_iter().chain(plan.header.columns.iter().map(String::as_str)).chain(seed);
    let head = head.chain(["outcome"]).chain(FIGURES.iter().map(|(name, _)| *name));
    let mut table = line(head.chain(["seconds", "machine", "problems"]).map(str::to_owned));
    for row @ Row { run, result, .. } in rows {
        let seed = has_seeds.then(|| run.seed.map(|seed| seed.to_string()).unwrap_or_default());
        let facts = [run.name.clone()].into_iter().chain(run.values.iter().cloned()).chain(seed);
        let outcome = result.map_or("open", |result| result.outcome.word()).to_owned();
        let figures = FIGURES.iter().map(|(_, figure)| result.map(|result| text(&figure(result))));
        let rest = match result {
            None => [const { String::new() }; 3],
            Some(result) => {
                [format!("{}", result.seconds), result.machine.clone(), row.problems().join("; ")]
            }
        };
        table += &line(facts.chain([outcome]).chain(figures.map(Option::unwrap_or_default)).chain(rest));
    }
    table
}

fn line(fields: impl Iterator<Item = String>) -> String {
    fields.map(|field| quoted(&field)).collect::<Vec<_>>().join(",") + "\n"
}

fn quoted(field: &str) -> String {
    match field.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_commas_and_quotes_are_quoted() {
        let fields = ["0017", "(0, 1, 0)", "said \"no\""].map(str::to_owned);
        assert_eq!(line(fields.into_iter()), "0017,\"(0, 1, 0)\",\"said \"\"no\"\"\"\n");
    }
}
