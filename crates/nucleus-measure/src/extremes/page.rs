//! The table as a page of the book.

use std::fmt::Write;

use super::row::{Recovery, Trial};
use super::verdict::{Figure, Kind, Outcome};

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
pub fn page(outcomes: &[Outcome]) -> String {
    let mut text = HEAD.to_owned();
    let failing = outcomes.iter().filter(|outcome| !outcome.holds()).count();
    let holding = outcomes.len() - failing;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{holding} of {} rows hold.", outcomes.len());
    if failing > 0 {
        let _ = writeln!(text, "\n## What fails\n");
        for outcome in outcomes.iter().filter(|outcome| !outcome.holds()) {
            fails(&mut text, outcome);
        }
    }
    for group in outcomes.chunk_by(|a, b| a.extreme.group == b.extreme.group) {
        let _ = writeln!(text, "\n## {}\n", group[0].extreme.group);
        table(&mut text, group);
        text.push('\n');
        group.iter().for_each(|outcome| entry(&mut text, outcome));
    }
    text
}

fn fails(text: &mut String, outcome: &Outcome) {
    let misses: Vec<String> = outcome.failures().map(miss).collect();
    let reason = outcome.extreme.fails.unwrap_or("Not known to fail: something has changed.");
    let _ = writeln!(text, "- **`{}`**: {}.\n  {reason}", outcome.extreme.name, misses.join("; "));
}

/// `speed from frame 72 on (m/s): 5.1, at most 0.5`.
pub fn miss(figure: &Figure) -> String {
    format!(
        "{}: {}, {} {}",
        figure.what.trim(),
        number(figure.value),
        figure.side.words(),
        number(figure.limit)
    )
}

fn table(text: &mut String, outcomes: &[Outcome]) {
    text.push_str(
        "| Extreme | Energy | Speed, m/s | Strain | Cost | Reported | |\n|---|--:|--:|--:|--:|---|---|\n",
    );
    for outcome in outcomes {
        let cell = |kind: Kind, show: fn(f64) -> String| {
            outcome.figure(kind).map_or("–".to_owned(), |figure| show(figure.value))
        };
        let [energy, speed] = [Kind::Energy, Kind::Speed].map(|kind| cell(kind, number));
        let (strain, cost) = (cell(Kind::Strain, percent), cell(Kind::Cost, |cost| format!("{cost:.1}")));
        let reported =
            if outcome.reported.is_empty() { "–".to_owned() } else { outcome.reported.join("; ") };
        let verdict = if outcome.holds() { "holds" } else { "**fails**" };
        let name = outcome.extreme.name;
        let reported = reported.replace('|', "\\|");
        let _ =
            writeln!(text, "| `{name}` | {energy} | {speed} | {strain} | {cost} | {reported} | {verdict} |");
    }
}

fn entry(text: &mut String, outcome: &Outcome) {
    let extreme = &outcome.extreme;
    let _ = writeln!(text, "**`{}`**: {}.\n{}", extreme.name, extreme.what, extreme.expect);
    let own = outcome.figures.iter().filter(|figure| figure.kind == Kind::Own).map(miss);
    let own: Vec<String> = own.collect();
    if !own.is_empty() {
        let _ = writeln!(text, "Measured: {}.", own.join("; "));
    }
    if let Trial::Runs { recovery: Some(Recovery { from, speed, strain }), .. } = extreme.trial {
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
