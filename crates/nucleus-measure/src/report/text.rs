//! A trade in words.

use super::{figure, percent};
use crate::trade::Trade;

/// Errors to which the time is told.
const ERRORS: [f64; 3] = [0.1, 0.01, 0.001];

/// What there is to say of a trade, line by line.
pub fn text(trade: &Trade) -> String {
    let mut lines = vec![trade.measure.sentence()];
    if let Some(floor) = trade.floor {
        lines.push(format!("The references differ by {}: below that nothing can be told.", percent(floor)));
    }
    lines.push(String::new());
    lines.extend(table(trade));
    lines.push(String::new());
    lines.extend(ERRORS.map(|error| time_to(trade, error)));
    if let Some(slope) = trade.slope() {
        lines.push(format!("error falls with the power {slope:.2} of the time"));
    }
    lines.extend(troubles(trade));
    lines.join("\n") + "\n"
}

/// `to 1 %: 12.5 ms a frame with 96 evaluations in 3 substeps`.
pub fn time_to(trade: &Trade, error: f64) -> String {
    let wanted = percent(error);
    if !trade.can_tell(error) {
        let floor = percent(trade.floor.unwrap_or_default());
        return format!("to {wanted}: cannot be told, the references themselves differ by {floor}");
    }
    match (trade.cheapest(error), trade.frontier().last()) {
        (Some(point), _) => format!("to {wanted}: {} ms a frame with {}", figure(point.ms), point.setting),
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

/// The settings, the cheapest first; `*` marks those that nothing beats.
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

/// Which settings cannot be used.
fn troubles(trade: &Trade) -> Vec<String> {
    let count =
        |is: &dyn Fn(&crate::trade::Point) -> bool| trade.points.iter().filter(|point| is(point)).count();
    let all = trade.points.len();
    let unresolved = count(&|point| point.pairs_unresolved > 0);
    let lost = count(&|point| point.lost.is_some());
    let energy = match trade.is_closed {
        true => format!("{} of {all} settings created energy", count(&|point| point.made_energy())),
        false => "the cloth is driven, by wind or by what moves: energy created cannot be told".to_owned(),
    };
    vec![energy, format!("{unresolved} of {all} settings left pairs unresolved, {lost} did not stay finite")]
}
