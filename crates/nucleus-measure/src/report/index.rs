//! The page that leads to the reports of several scenes.

use super::{figure, percent};
use crate::trade::{Measure, Trade};

/// The page in Markdown. Names are those of the scenes' files.
pub fn index(trades: &[(String, Trade)], machine: &str) -> String {
    let mut text = format!(
        "# Speed against accuracy\n\nWhat settings cost and how wrong they are, scene by scene.\n`nucleus trade SCENE` makes such \
         a report for any scene; `cargo xtask book` makes these anew.\nTimes are milliseconds of processor time to a frame, on one \
         core.\n\n{machine}\n\n| Scene | Frames | Settings | Error | To 10 % | To 1 % | To 0.1 % | Slope | Its own setting |\n|---|---|---|---|---|---|---|---|---|\n"
    );
    for (name, trade) in trades {
        let time = |error: f64| match trade.cheapest(error) {
            _ if !trade.can_tell(error) => "cannot be told".to_owned(),
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
    text += "\nThe reports are pages with pictures; download one and open it in a browser. Beside each lie a table (`.csv`) and all \
             figures (`.json`).\nThe slope is the power of the time with which the error falls along the settings that nothing \
             beats.\n\n## Troubles\n\n";
    for (name, trade) in trades {
        let bad: Vec<String> = trade
            .points
            .iter()
            .filter_map(|point| Some(format!("- {name}, {}: {}\n", point.setting, point.trouble()?)))
            .collect();
        text += &if bad.is_empty() {
            format!("- {name}: none of {} settings went wrong\n", trade.points.len())
        } else {
            bad.concat()
        };
    }
    text
}

/// What the error is, in a few words.
fn measure(trade: &Trade) -> String {
    let floor = trade.floor.map(|floor| format!(", told from {}", percent(2.0 * floor))).unwrap_or_default();
    match trade.measure {
        Measure::Position { frames } => format!("position, RMS over {frames} frames{floor}"),
        Measure::StrainAgainstReference => format!("strain against the reference's{floor}"),
        Measure::Strain => "strain".to_owned(),
    }
}
