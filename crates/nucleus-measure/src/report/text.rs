//! Text renderings of a trade: terminal, CSV, and the Markdown index.

use super::figures::{figure, percent};
use crate::trade::{ErrorMeasure, Reading, Trade};

/// Errors for which the time is reported.
const ERRORS: [f64; 3] = [0.1, 0.01, 0.001];

/// Text for the terminal.
pub fn text(trade: &Trade) -> String {
    let mut lines = vec![trade.measure.sentence()];
    if let Some(floor) = trade.floor {
        lines.push(format!(
            "The reference uncertainty is {}: smaller errors are not resolved.",
            percent(floor)
        ));
    }
    lines.push(String::new());
    lines.extend(table(trade));
    lines.push(String::new());
    lines.extend(ERRORS.map(|error| time_to(trade, error)));
    if let Some(slope) = trade.slope() {
        lines.push(format!("error scales with time to the power {slope:.2}"));
    }
    lines.extend(troubles(trade));
    lines.join("\n") + "\n"
}

/// `to 1 %: 12.5 ms per frame with 96 evaluations in 3 substeps`.
pub fn time_to(trade: &Trade, error: f64) -> String {
    let wanted = percent(error);
    if !trade.resolves(error) {
        let floor = percent(trade.floor.unwrap_or_default());
        return format!("to {wanted}: not resolved, the reference uncertainty is {floor}");
    }
    match (trade.cheapest(error), trade.frontier().last()) {
        (Some(point), _) => format!("to {wanted}: {} ms per frame with {}", figure(point.ms), point.setting),
        (None, Some(best)) => {
            let error = percent(best.error.unwrap_or_default());
            format!(
                "to {wanted}: no setting; the nearest is {error} in {} ms with {}",
                figure(best.ms),
                best.setting
            )
        }
        (None, None) => format!("to {wanted}: no setting is sound"),
    }
}

/// The settings by increasing cost; `*` marks the Pareto frontier.
fn table(trade: &Trade) -> Vec<String> {
    let mut lines =
        vec![format!("  {:>8} {:>9} {:>9} {:>9}  setting", "ms/frame", "error", "strain", "largest")];
    for point in &trade.points {
        let error = point.error.map_or("lost".to_owned(), percent);
        let mark = if point.on_frontier { '*' } else { ' ' };
        let own = if point.setting == trade.own { " (the scene's own)" } else { "" };
        let trouble = point.trouble().map(|trouble| format!("; {trouble}")).unwrap_or_default();
        lines.push(format!(
            "{mark} {:>8} {error:>9} {:>9} {:>9}  {}{own}{trouble}",
            figure(point.ms),
            percent(point.strain),
            percent(point.max_strain),
            point.setting,
        ));
    }
    lines
}

/// Counts of settings that are not sound.
fn troubles(trade: &Trade) -> Vec<String> {
    let count =
        |is: &dyn Fn(&crate::trade::Point) -> bool| trade.points.iter().filter(|point| is(point)).count();
    let all = trade.points.len();
    let unresolved = count(&|point| point.pairs_unresolved > 0);
    let first_nonfinite = count(&|point| point.first_nonfinite.is_some());
    let energy = match trade.is_closed {
        true => format!("{} of {all} settings created energy", count(&|point| point.created_energy())),
        false => "wind or animation drives the cloth: created energy is not measured".to_owned(),
    };
    vec![
        energy,
        format!(
            "{unresolved} of {all} settings left pairs unresolved, {first_nonfinite} did not stay finite"
        ),
    ]
}

/// CSV: one setting per line, by increasing cost; times in milliseconds, errors and strains as ratios.
pub fn csv(trade: &Trade) -> String {
    let head = "reading,substeps,collision_iterations,evaluations,resistance_factor,ms_per_frame,error,\
                position_rms,position_max,strain_99,strain_max,energy_created,least_gap,pairs_unresolved,pairs_per_frame,\
                broad_phases_per_frame,first_frame_not_finite,sound,frontier,hash\n";
    let mut text = head.to_owned();
    for point in &trade.points {
        let setting = &point.setting;
        let reading = if setting.reading == Reading::Classic { "classic" } else { "physical" };
        let maybe = |x: Option<f64>| x.map(|x| x.to_string()).unwrap_or_default();
        let cells = [
            reading.to_owned(),
            setting.substeps.to_string(),
            setting.collision_iterations.to_string(),
            setting.evaluations.to_string(),
            setting.resistance.to_string(),
            point.ms.to_string(),
            maybe(point.error),
            maybe(point.position.map(|[rms, _]| rms)),
            maybe(point.position.map(|[_, max]| max)),
            point.strain.to_string(),
            point.max_strain.to_string(),
            maybe(point.created),
            maybe(point.least_gap),
            point.pairs_unresolved.to_string(),
            point.pairs.to_string(),
            point.queries.to_string(),
            point.first_nonfinite.map(|frame| frame.to_string()).unwrap_or_default(),
            point.is_sound().to_string(),
            point.on_frontier.to_string(),
            point.hash.clone(),
        ];
        text += &(cells.join(",") + "\n");
    }
    text
}

/// The Markdown index of several reports. Names are those of the scene files.
pub fn index(trades: &[(String, Trade)], machine: &str) -> String {
    let mut text = format!(
        "# Speed against accuracy\n\nCost and error of settings, scene by scene.\n`nucleus trade SCENE` writes such \
         a report for any scene; `cargo xtask book` rewrites these.\nTimes are milliseconds of processor time per frame, on one \
         core.\n\n{machine}\n\n| Scene | Frames | Settings | Error | To 10 % | To 1 % | To 0.1 % | Slope | Its own setting |\n|---|---|---|---|---|---|---|---|---|\n"
    );
    for (name, trade) in trades {
        let time = |error: f64| match trade.cheapest(error) {
            _ if !trade.resolves(error) => "not resolved".to_owned(),
            Some(point) => format!("{} ms: {}", figure(point.ms), point.setting),
            None => "no setting".to_owned(),
        };
        let slope = trade.slope().map_or("–".to_owned(), |slope| format!("{slope:.2}"));
        let own = trade.own_point().map_or("–".to_owned(), |own| {
            format!("{} ms, {}", figure(own.ms), own.error.map_or("lost".to_owned(), percent))
        });
        let [to_10, to_1, to_01] = [0.1, 0.01, 0.001].map(time);
        let measure = measure(trade);
        let ([from, to], settings) = (trade.frames, trade.points.len());
        text += &format!(
            "| [{name}]({name}.trade.html) | {from} to {to} | {settings} | {measure} | {to_10} | {to_1} | {to_01} | {slope} | {own} |\n"
        );
    }
    text += "\nThe reports are HTML pages with pictures; download one and open it in a browser. The same folder holds a table \
             (`.csv`) and all figures (`.json`).\nThe slope is the exponent of error against time along the Pareto \
             frontier.\n\n## Unsound settings\n\n";
    for (name, trade) in trades {
        let bad: Vec<String> = trade
            .points
            .iter()
            .filter_map(|point| Some(format!("- {name}, {}: {}\n", point.setting, point.trouble()?)))
            .collect();
        text += &if bad.is_empty() {
            format!("- {name}: all {} settings are sound\n", trade.points.len())
        } else {
            bad.concat()
        };
    }
    text
}

/// Short definition of the error.
fn measure(trade: &Trade) -> String {
    let floor =
        trade.floor.map(|floor| format!(", resolved from {}", percent(2.0 * floor))).unwrap_or_default();
    match trade.measure {
        ErrorMeasure::Position { frames } => format!("position, RMS over {frames} frames{floor}"),
        ErrorMeasure::StrainAgainstReference => format!("strain against the reference's{floor}"),
        ErrorMeasure::Strain => "strain".to_owned(),
    }
}
