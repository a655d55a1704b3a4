//! The page: a contact sheet and a table that sorts by its columns.

use std::fmt::Write;

use serde_json::Value;

use super::row::{Counts, FIGURES, Row};
use crate::pictures::SIZE;
use crate::plan::{Plan, PlannedRun};
use crate::result::rounded;

/// The page as HTML. Pictures are files beside it. `pictured` says which runs have one.
pub fn html(plan: &Plan, rows: &[Row], counts: Counts, pictured: &dyn Fn(&str) -> bool) -> String {
    let title = escape(&plan.header.title);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{title}: wedge</title>\n<style>\n{}</style>\n\
         <h1>{title}</h1>\n<p>{counts}. {}</p>\n",
        include_str!("page.css"),
        timing(rows)
    );
    page += &failures(rows);
    page += &sheet(plan, rows, pictured);
    page += &table(plan, rows);
    let _ = write!(page, "<script>\n{}</script>\n", include_str!("page.js"));
    page
}

/// Whether times are those of runs alone.
fn timing(rows: &[Row]) -> String {
    let most = rows.iter().filter_map(|row| row.result).map(|result| result.at_once).max();
    match most {
        None => String::new(),
        Some(0 | 1) => "Each run was alone on its machine, as far as this wedge goes.".to_owned(),
        Some(most) => format!(
            "Times were taken with up to {most} runs side by side on a machine: compare them with care."
        ),
    }
}

/// The runs with problems, each with its values and reasons.
fn failures(rows: &[Row]) -> String {
    let mut list = String::new();
    for row in rows {
        let Some(result) = row.result.filter(|_| !row.problems().is_empty()) else { continue };
        let (name, word) = (escape(&row.run.name), result.outcome.word());
        let why = escape(&row.problems().join("; "));
        let _ = writeln!(
            list,
            "<li class=\"{word}\"><a href=\"logs/{name}.txt\">{name}</a> ({}): {why}</li>",
            escape(&caption(row.run, &[]))
        );
    }
    if list.is_empty() { list } else { format!("<h2>Problems</h2>\n<ul>\n{list}</ul>\n") }
}

fn sheet(plan: &Plan, rows: &[Row], pictured: &dyn Fn(&str) -> bool) -> String {
    let shown: Vec<&Row> = rows.iter().filter(|row| pictured(&row.run.name)).collect();
    if shown.is_empty() {
        return String::new();
    }
    let mut sheet = "<h2>Last frames</h2>\n<div class=\"sheet\">\n".to_owned();
    let [width, height] = SIZE;
    for row in shown {
        let (name, word) = (escape(&row.run.name), row.result.map_or("open", |result| result.outcome.word()));
        let _ = writeln!(
            sheet,
            "<figure class=\"{word}\"><a href=\"runs/{name}.mcap\"><img src=\"pictures/{name}.png\" width=\"{width}\" \
             height=\"{height}\" loading=\"lazy\" alt=\"last frame of run {name}\"></a><figcaption><b>{name}</b> {}</figcaption></figure>",
            escape(&caption(row.run, &plan.header.columns))
        );
    }
    sheet + "</div>\n"
}

/// `bendResistance 0.1, windSpeed 5, seed 2`; the values alone without columns.
fn caption(run: &PlannedRun, columns: &[String]) -> String {
    let short = |column: &String| column.rsplit('.').next().unwrap_or_default().to_owned();
    let names = columns.iter().map(|column| short(column) + " ").chain(std::iter::repeat(String::new()));
    let values = run.values.iter().zip(names).map(|(value, name)| format!("{name}{value}"));
    values.chain(run.seed.map(|seed| format!("seed {seed}"))).collect::<Vec<_>>().join(", ")
}

fn table(plan: &Plan, rows: &[Row]) -> String {
    let mut table = "<h2>Figures</h2>\n<table>\n<thead><tr><th>run</th>".to_owned();
    let heads = plan.header.columns.iter().map(String::as_str).chain(["seed", "outcome"]);
    for head in heads.chain(FIGURES.iter().map(|(name, _)| *name)) {
        let _ = write!(table, "<th>{}</th>", escape(head));
    }
    table += "</tr></thead>\n<tbody>\n";
    for Row { run, result, .. } in rows {
        let word = result.map_or("open", |result| result.outcome.word());
        let _ = write!(table, "<tr class=\"{word}\"><td>{}</td>", escape(&run.name));
        let seed = run.seed.map(|seed| seed.to_string()).unwrap_or_default();
        for value in run.values.iter().map(String::as_str).chain([seed.as_str(), word]) {
            let _ = write!(table, "<td>{}</td>", escape(value));
        }
        for (_, figure) in FIGURES {
            let value = result.map_or(Value::Null, figure);
            let _ = write!(table, "<td>{}</td>", escape(&rounded(&value)));
        }
        table += "</tr>\n";
    }
    table + "</tbody>\n</table>\n"
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::PlanHeader;
    use crate::result::{RunOutcome, RunResult, SolvedFrames};

    #[test]
    fn a_page_names_what_failed_and_escapes_what_it_quotes() {
        let header = PlanHeader::new("<b>.ron".to_owned(), "/".into(), vec!["c.damp".to_owned()]);
        let run = PlannedRun {
            run: 0,
            name: "0000".to_owned(),
            values: vec!["\"<script>\"".to_owned()],
            seed: Some(7),
            arguments: Vec::new(),
        };
        let result = RunResult {
            outcome: RunOutcome::Failed,
            error: Some("the disk is full".to_owned()),
            seconds: 1.0,
            earlier: SolvedFrames::default(),
            at_once: 2,
            machine: String::new(),
            attempt: 0,
            report: None,
        };
        let plan = Plan { header, runs: vec![run] };
        let rows = [Row { run: &plan.runs[0], result: Some(&result), fault: Some("its cache is missing") }];
        let counts = Counts::of(rows.iter().map(|row| row.result));
        let page = html(&plan, &rows, counts, &|_| true);
        assert!(
            page.contains("1 run: 1 failed") && page.contains("the disk is full; its cache is missing"),
            "{page}"
        );
        assert!(page.contains("up to 2 runs side by side") && page.contains("seed 7"), "{page}");
        assert!(!page.contains("<b>.ron") && !page.contains("\"<script>\""), "{page}");
    }
}
