//! The table as a Markdown page.

use std::fmt::Write;

use super::evaluation::{Evaluation, Kind, Measurement};
use super::row::Recovery;

const HEAD: &str = "# Extremes

Behaviour of the solver with extreme inputs.
`nucleus extremes --only NAME` runs a row, and `nucleus extremes --save FOLDER` writes its scene, so that it can be changed, recorded and viewed.
The scenes are in `scenes/extremes/`. Seven rows inject faults into the input of single frames (NaN, infinity, a frame without duration); no scene file can express these, so they are in code (`extremes/rows/input.rs`).
Bounds are set before a row is run, from the scene itself or from the needs of a user; a row outside a bound is listed as failing, with its figure.

- **Energy** is the maximum of kinetic energy over supplied energy. Gravity, forces and changes of attributes supply energy, and wind, colliders and pins do so as if each had struck the cloth elastically. Above 1.01 the solver has created energy.
- **Speed** (root mean square) and **strain** (99th percentile of all links) are the maxima after the disturbance has ended and some time has passed; the frames are in the scenes.
- **Cost** is processor time over that of the baseline, the same scene without the extreme input: per frame, or per time step or evaluated row if their number is the extreme. The limit is 3. A run above the limit is aborted after 20 s, and bounds on its end are not evaluated.
- **Reported** lists diagnostics of the scene and counters of the solver.

";

/// The page, from the evaluations of all rows.
pub fn page(evaluations: &[Evaluation]) -> String {
    let mut text = HEAD.to_owned();
    let failing = evaluations.iter().filter(|evaluation| !evaluation.holds()).count();
    let holding = evaluations.len() - failing;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{holding} of {} rows hold.", evaluations.len());
    if evaluations.iter().any(Evaluation::is_untimed) {
        let _ =
            writeln!(text, "Cost was not measured, because rows shared a machine; `--jobs 1` measures it.");
    }
    if failing > 0 {
        let _ = writeln!(text, "\n## Failures\n");
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
    let _ = writeln!(text, "**`{}`**: {}.\n{}", stress_case.name, stress_case.summary, stress_case.expected);
    let own = evaluation.figures.iter().filter(|figure| figure.kind == Kind::Own).map(failure_text);
    let own: Vec<String> = own.collect();
    if !own.is_empty() {
        let _ = writeln!(text, "Measured: {}.", own.join("; "));
    }
    if let Some(Recovery { from, speed, strain }) = evaluation.recovery {
        let (speed, strain) = (number(speed), percent(strain));
        let _ = writeln!(text, "Bounds from frame {from} on: speed {speed} m/s, strain {strain}.");
    }
    text.push('\n');
}

/// Three significant digits.
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
