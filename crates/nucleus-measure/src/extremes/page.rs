//! The table as a page of the book.

use std::fmt::Write;

use super::evaluation::{Evaluation, Kind, Measurement};
use super::row::{Expectation, Recovery};

const HEAD: &str = "# Extremes

What the solver does where scenes leave the ordinary.
Every row is a scene of its own: `nucleus extremes --only NAME` runs it, and `nucleus extremes --save FOLDER` writes it out, so that it can be changed, recorded and looked at.
Bounds are set before a row is run, from the scene itself or from what one needs of it; a row that misses one is listed as failing, with its figure.

- **Energy** is the energy of motion, at its worst, over what weight, forces and changes of attributes had brought in by then, as if wind, colliders and held points had each struck the cloth elastically; above 1.01 the solver has made energy.
- **Speed** (root mean square) and **strain** (99 % of all links are below it) are what is left when the cause has ended and some time has passed; the frames are in the scenes.
- **Cost** is processor time over that of the same scene without the extreme, per frame, or per time step or evaluated row where the extreme is the number of those; at most 3. A run that has taken 20 s and is above that is given up; what would have to hold in its end is then not judged.
- **Reported** is what was said when the scene was read, and what the solver counted.

";

/// The page, from the outcomes of all rows.
pub fn page(evaluations: &[Evaluation]) -> String {
    let mut text = HEAD.to_owned();
    let failing = evaluations.iter().filter(|evaluation| !evaluation.holds()).count();
    let holding = evaluations.len() - failing;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{holding} of {} rows hold.", evaluations.len());
    if failing > 0 {
        let _ = writeln!(text, "\n## What fails\n");
        for evaluation in evaluations.iter().filter(|evaluation| !evaluation.holds()) {
            known_failure(&mut text, evaluation);
        }
    }
    for group in evaluations.chunk_by(|a, b| a.stress_case.group == b.stress_case.group) {
        let _ = writeln!(text, "\n## {}\n", group[0].stress_case.group);
        table(&mut text, group);
        text.push('\n');
        group.iter().for_each(|evaluation| entry(&mut text, evaluation));
    }
    text
}

fn known_failure(text: &mut String, evaluation: &Evaluation) {
    let misses: Vec<String> = evaluation.failures().map(failure_text).collect();
    let reason = evaluation.stress_case.known_failure.unwrap_or("Not known to fail: something has changed.");
    let _ = writeln!(text, "- **`{}`**: {}.\n  {reason}", evaluation.stress_case.name, misses.join("; "));
}

/// `speed from frame 72 on (m/s): 5.1, at most 0.5`.
pub fn failure_text(figure: &Measurement) -> String {
    format!(
        "{}: {}, {} {}",
        figure.what.trim(),
        number(figure.value),
        figure.side.words(),
        number(figure.limit)
    )
}

fn table(text: &mut String, evaluations: &[Evaluation]) {
    text.push_str(
        "| Extreme | Energy | Speed, m/s | Strain | Cost | Reported | |\n|---|--:|--:|--:|--:|---|---|\n",
    );
    for evaluation in evaluations {
        let cell = |kind: Kind, show: fn(f64) -> String| {
            evaluation.figure(kind).map_or("–".to_owned(), |figure| show(figure.value))
        };
        let [energy, speed] = [Kind::Energy, Kind::Speed].map(|kind| cell(kind, number));
        let (strain, cost) = (cell(Kind::Strain, percent), cell(Kind::Cost, |cost| format!("{cost:.1}")));
        let reported =
            if evaluation.reported.is_empty() { "–".to_owned() } else { evaluation.reported.join("; ") };
        let status = if evaluation.holds() { "holds" } else { "**fails**" };
        let name = evaluation.stress_case.name;
        let reported = reported.replace('|', "\\|");
        let _ =
            writeln!(text, "| `{name}` | {energy} | {speed} | {strain} | {cost} | {reported} | {status} |");
    }
}

fn entry(text: &mut String, evaluation: &Evaluation) {
    let stress_case = &evaluation.stress_case;
    let _ = writeln!(text, "**`{}`**: {}.\n{}", stress_case.name, stress_case.what, stress_case.expect);
    let own = evaluation.figures.iter().filter(|figure| figure.kind == Kind::Own).map(failure_text);
    let own: Vec<String> = own.collect();
    if !own.is_empty() {
        let _ = writeln!(text, "Measured: {}.", own.join("; "));
    }
    if let Expectation::Runs { recovery: Some(Recovery { from, speed, strain }), .. } =
        stress_case.expectation
    {
        let _ = write!(text, "From frame {from} on it has to be slower than {} m/s", number(speed));
        if strain.is_finite() {
            let _ =
                write!(text, " and, but for 1 % of the links, stretched by less than {}", percent(strain));
        }
        text.push_str(".\n");
    }
    text.push('\n');
}

/// Three digits that matter, as a page wants them.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".to_owned()
    } else if !x.is_finite() {
        format!("{x}")
    } else if !(1e-3..1e5).contains(&size) {
        format!("{x:.1e}")
    } else {
        let digits = (2 - size.log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

fn percent(share: f64) -> String {
    format!("{} %", number(100.0 * share))
}
