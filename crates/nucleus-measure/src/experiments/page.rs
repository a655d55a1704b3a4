//! The experiments as a Markdown page.

use std::fmt::Write;

use super::{Experiment, Table};

const HEAD: &str = "# Four design experiments

The solver's design rests on four experiments on a prototype.
This page repeats them on the solver and compares the results.
`cargo xtask book --only experiments` rewrites this page.
Milliseconds are processor time of one core, of the current solver; the prototype's are not comparable and are omitted.
";

/// The page in Markdown; `machine` describes the machine of the times.
pub fn page(results: &[(Experiment, Vec<Table>)], machine: &str) -> String {
    let mut text = format!("{HEAD}\n{machine}\n");
    for (experiment, tables) in results {
        let Experiment { name, description, differences, .. } = experiment;
        put(&mut text, format_args!("\n## {name}\n\n{description}\n\n**Differences.** {differences}"));
        tables.iter().for_each(|found| table(&mut text, found));
    }
    text
}

fn table(text: &mut String, Table { title, head, rows }: &Table) {
    put(text, format_args!("\n### {title}\n\n| {} |\n|{}", head.join(" | "), "---:|".repeat(head.len())));
    for row in rows {
        put(text, format_args!("| {} |", row.join(" | ")));
    }
}

fn put(text: &mut String, line: std::fmt::Arguments) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{line}");
}

#[cfg(test)]
mod tests {
    use super::super::experiments;
    use super::*;

    #[test]
    fn the_page_has_every_experiment_with_its_tables_and_differences() {
        let table =
            Table { title: "Figures", head: vec!["a", "b"], rows: vec![vec!["1".into(), "2".into()]] };
        let results: Vec<_> = experiments().into_iter().map(|one| (one, vec![table.clone()])).collect();
        let page = page(&results, "a machine");
        for (experiment, _) in &results {
            assert!(
                page.contains(&format!("## {}\n\n{}", experiment.name, experiment.description)),
                "{page}"
            );
            assert!(page.contains(experiment.differences), "{page}");
        }
        assert_eq!(page.matches("| a | b |\n|---:|---:|\n| 1 | 2 |\n").count(), 4);
    }
}
