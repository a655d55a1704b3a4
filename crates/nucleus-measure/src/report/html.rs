//! The HTML page: one file with embedded pictures, for light and dark colour schemes.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::chart::{Axis, Chart, Dot, Line, escape};
use super::{figure, percent, time_to};
use crate::trade::{Point, Reading, Setting, Trade};

/// A picture of the last state of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Title: `cheapest`, `recommended`, `reference`.
    pub title: String,
    /// Caption.
    pub caption: String,
    /// A PNG file.
    pub png: Vec<u8>,
}

/// Content of the page.
pub struct Page<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// The work-precision curve.
    pub trade: &'a Trade,
    /// The requested error.
    pub wanted: f64,
    /// The recommended setting, if any is sound.
    pub recommended: Option<&'a Point>,
    /// Pictures, side by side.
    pub pictures: &'a [Picture],
    /// Distance of single runs from the reference in each frame, by name.
    pub series: &'a [(String, Vec<f64>)],
    /// Description of the machine.
    pub machine: &'a str,
}

/// Renders the page.
pub fn html(page: &Page) -> String {
    let scene = escape(page.scene);
    let [start, end] = page.trade.frames;
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{scene}: speed against accuracy</title>\n<style>\n{}</style>\n\
         <h1>{scene}</h1>\n<p class=\"soft\">Speed against accuracy, frames {start} to {end}.</p>\n",
        include_str!("style.css")
    );
    text += &lead(page);
    text += &cards(page.trade);
    text += &pictures(page.pictures);
    text += &trade_chart(page);
    text += &divergence_chart(page);
    text += &table(page.trade);
    text += &how(page);
    text
}

/// The recommendation, in one sentence.
fn lead(page: &Page) -> String {
    let trade = page.trade;
    let Some(best) = page.recommended else {
        return "<p class=\"lead\">No setting is sound; the table below lists the reasons.</p>\n".to_owned();
    };
    let error = best.error.unwrap_or_default();
    let reached = match error <= page.wanted {
        true => format!("the cheapest with an error of at most {}", percent(page.wanted)),
        false => format!("the nearest to an error of {}, which no setting reaches", percent(page.wanted)),
    };
    let mut text = format!(
        "<p class=\"lead\"><b>{}</b> is {reached}: {} ms per frame, error {}.",
        escape(&best.setting.to_string()),
        figure(best.ms),
        percent(error)
    );
    if let Some(own) = trade.own_point().filter(|own| own.setting != best.setting)
        && let Some(error) = own.error
    {
        let _ = write!(
            text,
            " The scene's own setting, {}, takes {} ms and has an error of {}.",
            escape(&own.setting.to_string()),
            figure(own.ms),
            percent(error)
        );
    }
    text + "</p>\n"
}

/// Time to three errors, and the slope of the curve.
fn cards(trade: &Trade) -> String {
    let card = |title: String, big: String, small: String| {
        format!(
            "<div class=\"card\"><div class=\"soft\">{title}</div><div class=\"big\">{big}</div><div class=\"soft\">{}</div></div>\n",
            escape(&small)
        )
    };
    let mut text = "<div class=\"cards\">\n".to_owned();
    for error in [0.1, 0.01, 0.001] {
        let title = format!("time to {}", percent(error));
        text += &match trade.cheapest(error).filter(|_| trade.resolves(error)) {
            Some(point) => card(title, format!("{} ms", figure(point.ms)), point.setting.to_string()),
            None => {
                let why = time_to(trade, error);
                let why = why.split_once(": ").map_or(why.as_str(), |(_, why)| why).to_owned();
                card(title, "–".to_owned(), why)
            }
        };
    }
    if let Some(slope) = trade.slope() {
        let small = "exponent of error against time".to_owned();
        text += &card("slope".to_owned(), format!("{slope:.2}"), small);
    }
    text + "</div>\n"
}

fn pictures(pictures: &[Picture]) -> String {
    if pictures.is_empty() {
        return String::new();
    }
    let mut text = "<div class=\"pictures\">\n".to_owned();
    for Picture { title, caption, png } in pictures {
        let (title, caption) = (escape(title), escape(caption));
        let _ = writeln!(
            text,
            "<figure><img alt=\"{title}\" src=\"data:image/png;base64,{}\"><figcaption><b>{title}</b><br>{caption}</figcaption></figure>",
            base64(png)
        );
    }
    text + "</div>\n"
}

/// Group of settings with one colour: reading and substeps.
fn family(setting: &Setting) -> (Reading, u32) {
    (setting.reading, setting.substeps)
}

/// Error against time.
fn trade_chart(page: &Page) -> String {
    let trade = page.trade;
    let families: BTreeSet<(bool, u32)> = trade
        .points
        .iter()
        .map(|point| family(&point.setting))
        .map(|(reading, substeps)| (reading == Reading::Classic, substeps))
        .collect();
    let families: Vec<(bool, u32)> = families.into_iter().collect();
    let colour = |setting: &Setting| {
        let (reading, substeps) = family(setting);
        families.iter().position(|of| *of == (reading == Reading::Classic, substeps)).unwrap_or(0)
    };
    let known = |point: &Point| point.error.map(|error| [point.ms, error.max(1e-7)]);
    let dot = |point: &Point| {
        let at = known(point)?;
        let is_best = page.recommended.is_some_and(|best| best.setting == point.setting);
        let label = match (is_best, point.setting == trade.own) {
            (true, true) => Some("recommended, and the scene's own"),
            (true, false) => Some("recommended"),
            (false, true) => Some("the scene's own"),
            (false, false) => None,
        };
        let trouble = point.trouble().map(|trouble| format!("\n{trouble}")).unwrap_or_default();
        Some(Dot {
            at,
            colour: colour(&point.setting),
            is_sound: point.is_sound(),
            title: format!("{}\n{} ms, {}{trouble}", point.setting, figure(point.ms), percent(at[1])),
            label: label.map(str::to_owned),
        })
    };
    let errors = trade.points.iter().filter_map(known).map(|[_, error]| error).chain(trade.floor);
    let chart = Chart {
        x: Axis::log("milliseconds per frame, on one core", trade.points.iter().map(|point| point.ms)),
        y: Axis::log(trade.measure.name(), errors).in_percent(),
        dots: trade.points.iter().filter_map(dot).collect(),
        lines: vec![Line { through: trade.frontier().filter_map(known).collect(), class: "frontier" }],
        floor: trade.floor.map(|floor| (floor, "reference uncertainty".to_owned())),
        mark: None,
    };
    let mut text =
        format!("<h2>Error against time</h2>\n<div class=\"chart\">{}<div class=\"key\">", chart.svg());
    for (index, (is_classic, substeps)) in families.iter().enumerate() {
        let reading = if *is_classic { "Classic, " } else { "" };
        let plural = if *substeps == 1 { "" } else { "s" };
        let _ = write!(
            text,
            "<span><i style=\"background:var(--c{})\"></i>{reading}{substeps} substep{plural}</span>",
            index % 6
        );
    }
    text + "<span><i style=\"border:2px solid var(--bad)\"></i>not sound</span></div></div>\n"
}

/// Distance of runs from the reference, frame by frame.
fn divergence_chart(page: &Page) -> String {
    let trade = page.trade;
    if trade.divergence.is_empty() {
        return String::new();
    }
    let start = trade.frames[0] as f64 + 1.0;
    let places = |divergence: &[f64]| -> Vec<[f64; 2]> {
        divergence
            .iter()
            .enumerate()
            .map(|(k, divergence)| [start + k as f64, divergence.max(1e-7)])
            .collect()
    };
    let mut lines = vec![Line { through: places(&trade.divergence), class: "l0" }];
    for ((_, divergence), class) in page.series.iter().zip(["l1", "l2"]) {
        lines.push(Line { through: places(divergence), class });
    }
    let values =
        lines.iter().flat_map(|line| line.through.iter().map(|at| at[1].max(1e-6))).collect::<Vec<_>>();
    let named = ["the other reference"].into_iter().chain(page.series.iter().map(|(name, _)| name.as_str()));
    let key: String = named
        .zip(["soft", "c0", "c1"])
        .map(|(name, colour)| {
            format!("<span><i style=\"background:var(--{colour})\"></i>{}</span>", escape(name))
        })
        .collect();
    let key = format!("<div class=\"key\">{key}</div>");
    let mark = match trade.measure {
        crate::trade::ErrorMeasure::Position { frames } => {
            Some((start + frames as f64 - 1.0, "end of comparison".to_owned()))
        }
        _ => None,
    };
    let chart = Chart {
        x: Axis::linear("frame", start, trade.frames[1] as f64),
        y: Axis::log("distance from the reference", values).in_percent(),
        dots: Vec::new(),
        lines,
        floor: None,
        mark,
    };
    format!(
        "<h2>Predictability horizon</h2>\n<div class=\"chart\">{}{key}</div>\n<p class=\"soft\">Two references, \
         one with half the step of the other, diverge when a fold falls to one side in one of them and to the other side in the \
         other. Beyond that frame the distance measures chaos, not the error of a setting.</p>\n",
        chart.svg()
    )
}

fn table(trade: &Trade) -> String {
    let mut text = "<h2>All settings</h2>\n<div class=\"wide\"><table>\n<tr><th>ms</th><th>error</th><th>position, RMS</th>\
                    <th>largest</th><th>strain, 99 %</th><th>largest</th><th>energy created</th><th>gap</th><th>setting</th></tr>\n"
        .to_owned();
    let maybe = |x: Option<f64>, show: fn(f64) -> String| x.map_or("–".to_owned(), show);
    for point in trade.reference.iter().chain(&trade.points) {
        let is_reference = trade.reference.as_ref().is_some_and(|reference| std::ptr::eq(reference, point));
        let classes = [(point.on_frontier, "frontier"), (point.setting == trade.own && !is_reference, "own")];
        let classes: Vec<&str> = classes.iter().filter(|(is, _)| *is).map(|(_, class)| *class).collect();
        let trouble = point.trouble().map(|t| format!(" <span class=\"trouble\">{}</span>", escape(&t)));
        let _ = writeln!(
            text,
            "<tr class=\"{}\"><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}{}{}</td></tr>",
            classes.join(" "),
            figure(point.ms),
            if is_reference { "reference".to_owned() } else { maybe(point.error, percent) },
            maybe(point.position.map(|[rms, _]| rms), percent),
            maybe(point.position.map(|[_, max]| max), percent),
            percent(point.strain),
            percent(point.max_strain),
            maybe(point.created, percent),
            maybe(point.least_gap, figure),
            escape(&point.setting.to_string()),
            if is_reference { ", in double precision" } else { "" },
            trouble.unwrap_or_default()
        );
    }
    text + "</table></div>\n"
}

fn how(page: &Page) -> String {
    let trade = page.trade;
    let floor =
        trade.floor.map(|floor| format!(" The reference uncertainty is {} in this measure.", percent(floor)));
    let energy = match trade.is_closed {
        true => {
            "Nothing drives the cloth, so any rise of kinetic plus potential energy above its initial value is created by the \
                 solver; the table gives it over the energy of a fall by the cloth's own size."
        }
        false => "Wind or animation drives the cloth, so created energy is not measured.",
    };
    format!(
        "<h2>Method</h2>\n<p>{}{}</p>\n<p>Times are processor time of one core, in the solver alone. Strain is \
         the 99th percentile over all edges, RMS over all frames; gap is the minimum over the thickness. {energy}</p>\n\
         <footer>{} · scene and solver {}</footer>\n</html>\n",
        escape(&trade.measure.sentence()),
        floor.unwrap_or_default(),
        escape(page.machine),
        escape(&trade.name)
    )
}

/// Bytes as text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word =
            three.iter().fold(0u32, |word, byte| word << 8 | u32::from(*byte)) << (8 * (3 - three.len()));
        for place in 0..4 {
            let sign = char::from(SIGNS[(word >> (18 - 6 * place)) as usize & 63]);
            text.push(if place <= three.len() { sign } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        let all = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(all, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }
}
