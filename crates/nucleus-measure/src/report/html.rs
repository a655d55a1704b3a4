//! The HTML page: one file with embedded pictures, for light and dark colour schemes.

use std::collections::BTreeSet;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chart::{Axis, Chart, Dot, Line};
use super::figures::{figure, percent};
use super::text::{ERRORS, component, errors, method_text, time_to};
use crate::trade::{Choice, Component, Point, Quantity, Reading, Request, Setting, Trade, for_error};

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
    /// The recommendation in words, one sentence a line.
    pub recommendation: &'a str,
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
    let scene = page.scene;
    let [start, end] = page.trade.frames;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            title { (scene) ": speed against accuracy" }
            style { (PreEscaped(include_str!("style.css"))) }
            h1 { (scene) }
            p.soft { "Speed against accuracy, compared over frames " (start + 1) " to " (end) "." }
            (lead(page))
            (cards(page.trade))
            (pictures(page.pictures))
            (trade_chart(page))
            (divergence_chart(page))
            (table(page.trade))
            (method(page))
        }
    };
    page.into_string()
}

/// The recommendation, and the scene's own setting beside it.
fn lead(page: &Page) -> Markup {
    let differs = |own: &&Point| page.recommended.is_none_or(|best| best.setting != own.setting);
    html! {
        @for line in page.recommendation.lines() { p.lead { (line) } }
        @if let Some(own) = page.trade.own_point().filter(differs) {
            p { "The scene's own setting, " (own.setting) ", takes " (figure(own.ms)) " ms: " (errors_of(page.trade, own)) "." }
        }
    }
}

/// The errors of a setting in words.
fn errors_of(trade: &Trade, point: &Point) -> String {
    errors(trade, &Request::default(), point)
}

/// The recommendations for some errors, and the slope of the curve.
fn cards(trade: &Trade) -> Markup {
    let card = |title: &str, big: &str, small: &str| {
        html! { div.card { div.soft { (title) } div.big { (big) } div.soft { (small) } } }
    };
    let time_to_error = |error: f64| {
        let title = format!("time to {}", percent(error));
        let said = time_to(trade, error);
        let said = said.split_once(": ").map_or(said.as_str(), |(_, said)| said);
        match for_error(trade, &Request::every(error)) {
            Choice::Found(point) => {
                let with = said.split_once(" with ").map_or(said, |(_, with)| with);
                card(&title, &format!("{} ms", figure(point.ms)), with)
            }
            _ => card(&title, "–", said),
        }
    };
    html! {
        div.cards {
            @for error in ERRORS { (time_to_error(error)) }
            @if let Some(slope) = trade.slope() {
                (card("slope", &format!("{slope:.2}"), "exponent of error against time"))
            }
        }
    }
}

fn pictures(pictures: &[Picture]) -> Markup {
    html! {
        @if !pictures.is_empty() {
            div.pictures {
                @for Picture { title, caption, png } in pictures {
                    figure {
                        img alt=(title) src={ "data:image/png;base64," (base64(png)) };
                        figcaption { b { (title) } br; (caption) }
                    }
                }
            }
        }
    }
}

/// Settings with one colour: whether their reading is Classic, and their substeps.
type Family = (bool, u32);

fn family(setting: &Setting) -> Family {
    (setting.reading == Reading::Classic, setting.substeps)
}

/// The largest error that a setting may have against another reference, where it is above the error that it meets.
fn known_below(trade: &Trade, point: &Point) -> Option<f64> {
    let request = Request::default();
    let largest = |error: &Component| {
        let bound = request.noise_bound(&trade.measure, error);
        bound.unwrap_or_else(|| error.largest())
    };
    let largest = point.errors.iter().map(largest).reduce(f64::max);
    largest.filter(|bound| point.error.is_some_and(|error| *bound > error))
}

/// Error against time.
fn trade_chart(page: &Page) -> Markup {
    let trade = page.trade;
    let families: BTreeSet<Family> = trade.points.iter().map(|point| family(&point.setting)).collect();
    let families: Vec<Family> = families.into_iter().collect();
    let errors = trade.points.iter().filter_map(place).map(|[_, error]| error);
    let errors = errors.chain(trade.points.iter().filter_map(|point| known_below(trade, point)));
    let chart = Chart {
        x: Axis::log("milliseconds per frame, on one core", trade.points.iter().map(|point| point.ms)),
        y: Axis::log("least wanted error that a setting meets", errors).in_percent(),
        dots: trade.points.iter().filter_map(|point| dot(page, &families, point)).collect(),
        lines: vec![Line { through: trade.frontier().filter_map(place).collect(), class: "frontier" }],
        floor: None,
        mark: None,
    };
    html! {
        h2 { "Error against time" }
        div.chart {
            (chart.svg())
            (trade_key(trade, &families))
        }
    }
}

/// Time and error of a setting, where its error is known.
fn place(point: &Point) -> Option<[f64; 2]> {
    point.error.map(|error| [point.ms, error.max(1e-7)])
}

/// The dot of a setting.
fn dot(page: &Page, families: &[Family], point: &Point) -> Option<Dot> {
    let at = place(point)?;
    let is_best = page.recommended.is_some_and(|best| best.setting == point.setting);
    let label = match (is_best, point.setting == page.trade.own) {
        (true, true) => Some("recommended, and the scene's own"),
        (true, false) => Some("recommended"),
        (false, true) => Some("the scene's own"),
        (false, false) => None,
    };
    let trouble = point.trouble().map(|trouble| format!("\n{trouble}")).unwrap_or_default();
    let [ms, error] = [figure(point.ms), percent(at[1])];
    Some(Dot {
        at,
        up_to: known_below(page.trade, point),
        colour: families.iter().position(|of| *of == family(&point.setting)).unwrap_or(0),
        is_sound: point.is_sound(),
        title: format!(
            "{}\n{ms} ms, meets {error}\n{}{trouble}",
            point.setting,
            errors_of(page.trade, point)
        ),
        label: label.map(str::to_owned),
    })
}

/// What the colours and lines of the chart mean.
fn trade_key(trade: &Trade, families: &[Family]) -> Markup {
    let reading = |is_classic: bool| if is_classic { "Classic, " } else { "" };
    let plural = |substeps: u32| if substeps == 1 { "" } else { "s" };
    html! {
        div.key {
            @for (index, &(is_classic, substeps)) in families.iter().enumerate() {
                span {
                    i style={ "background:var(--c" (index % 6) ")" } {}
                    (reading(is_classic)) (substeps) " substep" (plural(substeps))
                }
            }
            span { i style="border:2px solid var(--bad)" {} "not sound" }
            @if trade.points.iter().any(|point| known_below(trade, point).is_some()) {
                span { "line above a dot: in a quantity that the references do not resolve, the error may be as large" }
            }
        }
    }
}

/// Distance of runs from the reference, frame by frame.
fn divergence_chart(page: &Page) -> Markup {
    let trade = page.trade;
    if trade.divergence.is_empty() {
        return html! {};
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
    let comparable = trade.measure.comparable;
    let mark = (comparable > 0).then(|| (start + comparable as f64 - 1.0, "end of comparison".to_owned()));
    let chart = Chart {
        x: Axis::linear("frame", start, trade.frames[1] as f64),
        y: Axis::log("distance from the reference", values).in_percent(),
        dots: Vec::new(),
        lines,
        floor: None,
        mark,
    };
    html! {
        h2 { "Predictability horizon" }
        div.chart {
            (chart.svg())
            div.key {
                @for (name, colour) in named.zip(["soft", "c0", "c1"]) {
                    span { i style={ "background:var(--" (colour) ")" } {} (name) }
                }
            }
        }
        p.soft {
            "Two references, one with half the step of the other, diverge when a fold falls to one side in one of them and to "
            "the other side in the other. Beyond that frame the distance measures chaos, not the error of a setting."
        }
    }
}

fn table(trade: &Trade) -> Markup {
    let measured: Vec<Quantity> = trade.measure.floors.iter().map(|(quantity, _)| *quantity).collect();
    let figures = ["strain, 99 %", "largest", "energy created", "gap"];
    html! {
        h2 { "All settings" }
        div.wide {
            table {
                tr {
                    @for head in ["setting", "ms", "meets", "limited by"] { th { (head) } }
                    @for quantity in &measured { th { (quantity.name()) } }
                    @for head in figures { th { (head) } }
                }
                @if let Some(point) = &trade.reference { (row(trade, point, &measured, true)) }
                @for point in &trade.points { (row(trade, point, &measured, false)) }
            }
        }
    }
}

fn row(trade: &Trade, point: &Point, measured: &[Quantity], is_reference: bool) -> Markup {
    let maybe = |x: Option<f64>, show: fn(f64) -> String| x.map_or("–".to_owned(), show);
    let classes = [(point.on_frontier, "frontier"), (point.setting == trade.own && !is_reference, "own")];
    let classes: Vec<&str> = classes.iter().filter(|(is, _)| *is).map(|(_, class)| *class).collect();
    let error = if is_reference { "reference".to_owned() } else { maybe(point.error, percent) };
    let limit = point.limit.filter(|_| !is_reference).map_or("–", Quantity::name).to_owned();
    let of = |quantity: &Quantity| {
        let found = point.errors.iter().find(|error| error.quantity == *quantity);
        let shown = |found| component(trade, &Request::default(), found);
        found.filter(|_| !is_reference).map_or("–".to_owned(), shown)
    };
    let figures = [
        percent(point.strain),
        percent(point.max_strain),
        maybe(point.created, percent),
        maybe(point.least_gap, figure),
    ];
    let cells = [figure(point.ms), error, limit].into_iter().chain(measured.iter().map(of)).chain(figures);
    html! {
        tr class=(classes.join(" ")) {
            td {
                (point.setting)
                @if is_reference { ", in double precision" }
                @if let Some(trouble) = point.trouble() { " " span.trouble { (trouble) } }
            }
            @for cell in cells { td { (cell) } }
        }
    }
}

fn method(page: &Page) -> Markup {
    let trade = page.trade;
    let energy = match trade.is_closed {
        true => {
            "Nothing drives the cloth, so any rise of kinetic plus potential energy above its initial value is created by the \
             solver; the table gives it over the energy of a fall by the cloth's own size."
        }
        false => "Wind or animation drives the cloth, so created energy is not measured.",
    };
    html! {
        h2 { "Method" }
        @for line in method_text(trade).lines() { p { (line) } }
        p {
            "Times are processor time of one core, in the solver alone. Strain is the 99th percentile over all edges, RMS over "
            "all frames; gap is the minimum over the thickness. " (energy)
        }
        footer { (page.machine) " · scene and solver " (trade.name) }
    }
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
