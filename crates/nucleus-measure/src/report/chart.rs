//! SVG charts in the colours of the page's style sheet.

use maud::{Markup, html};

use super::figures::{figure, percent};

/// Width and height of a chart, in SVG units.
const SIZE: [f64; 2] = [760.0, 420.0];

/// Margins: left, top, right, bottom.
const MARGIN: [f64; 4] = [70.0, 16.0, 18.0, 48.0];

/// An axis.
#[derive(Debug, Clone)]
pub struct Axis {
    pub name: String,
    low: f64,
    high: f64,
    is_log: bool,
    is_share: bool,
}

/// A data point.
pub struct Dot {
    pub at: [f64; 2],
    /// The end of a line above it.
    pub up_to: Option<f64>,
    /// Index of the colour, from 0.
    pub colour: usize,
    pub is_sound: bool,
    /// Tooltip.
    pub title: String,
    /// Text beside the dot.
    pub label: Option<String>,
}

/// A polyline.
pub struct Line {
    pub through: Vec<[f64; 2]>,
    /// CSS class.
    pub class: &'static str,
}

/// A chart.
pub struct Chart {
    pub x: Axis,
    pub y: Axis,
    pub dots: Vec<Dot>,
    pub lines: Vec<Line>,
    /// Shaded region below a value, with a label.
    pub floor: Option<(f64, String)>,
    /// Vertical line at a value, with a label.
    pub mark: Option<(f64, String)>,
}

impl Axis {
    /// Logarithmic axis over the range of some values, with a margin.
    pub fn log(name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let usable = values.into_iter().filter(|x| x.is_finite() && *x > 0.0);
        let (low, high) = usable.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        let (low, high) = if low <= high { (low / 1.4, high * 1.4) } else { (0.1, 1.0) };
        Self { name: name.to_owned(), low, high, is_log: true, is_share: false }
    }

    /// Linear axis.
    pub fn linear(name: &str, low: f64, high: f64) -> Self {
        Self { name: name.to_owned(), low, high: high.max(low + 1.0), is_log: false, is_share: false }
    }

    /// The same, with tick labels in percent.
    pub fn in_percent(self) -> Self {
        Self { is_share: true, ..self }
    }

    /// Position of a value along the axis, 0 to 1, clamped.
    fn share(&self, x: f64) -> f64 {
        let scale = |x: f64| if self.is_log { x.max(1e-300).ln() } else { x };
        ((scale(x) - scale(self.low)) / (scale(self.high) - scale(self.low))).clamp(0.0, 1.0)
    }

    fn ticks(&self) -> Vec<f64> {
        if !self.is_log {
            let step = [1.0, 2.0, 5.0, 10.0, 12.0, 20.0, 24.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
            let step = step.into_iter().find(|step| (self.high - self.low) / step <= 10.0).unwrap_or(5000.0);
            let first = (self.low / step).ceil() as i64;
            return (first..).map(|k| k as f64 * step).take_while(|x| *x <= self.high).collect();
        }
        let decades = (self.low.log10().floor() as i32)..=(self.high.log10().ceil() as i32);
        let wide = self.high / self.low > 300.0;
        let steps: &[f64] = if wide { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let all = decades.flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
        all.filter(|x| (self.low..=self.high).contains(x)).collect()
    }

    fn tick_label(&self, x: f64) -> String {
        if self.is_share { percent(x) } else { figure(x) }
    }
}

impl Chart {
    /// Renders the chart.
    pub fn svg(&self) -> Markup {
        let [width, height] = SIZE;
        html! {
            svg viewBox={ "0 0 " (width) " " (height) } role="img"
                aria-label={ (self.y.name) " against " (self.x.name) } {
                (self.floor())
                (self.axes())
                (self.mark())
                @for line in &self.lines { (self.line(line)) }
                @for dot in &self.dots { (self.dot(dot)) }
            }
        }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = MARGIN;
        let across = SIZE[0] - left - right;
        let up = SIZE[1] - top - bottom;
        [left + across * self.x.share(x), top + up * (1.0 - self.y.share(y))]
    }

    fn axes(&self) -> Markup {
        let [left, bottom] = self.place([self.x.low, self.y.low]);
        let [right, top] = self.place([self.x.high, self.y.high]);
        let across = |tick: f64| self.place([tick, self.y.low])[0];
        let up = |tick: f64| self.place([self.x.low, tick])[1];
        html! {
            @for (x, tick) in self.x.ticks().into_iter().map(|tick| (across(tick), tick)) {
                path.grid d={ "M" (at(x)) " " (at(top)) "V" (at(bottom)) } {}
                text x=(at(x)) y=(at(bottom + 18.0)) text-anchor="middle" { (self.x.tick_label(tick)) }
            }
            @for (y, tick) in self.y.ticks().into_iter().map(|tick| (up(tick), tick)) {
                path.grid d={ "M" (at(left)) " " (at(y)) "H" (at(right)) } {}
                text x=(at(left - 8.0)) y=(at(y + 4.0)) text-anchor="end" { (self.y.tick_label(tick)) }
            }
            text.name x=(at((left + right) / 2.0)) y=(at(SIZE[1] - 8.0)) text-anchor="middle" { (self.x.name) }
            text.name transform={ "translate(14 " (at((top + bottom) / 2.0)) ") rotate(-90)" } text-anchor="middle" {
                (self.y.name)
            }
        }
    }

    fn floor(&self) -> Markup {
        let Some((floor, words)) = &self.floor else { return html! {} };
        let [left, bottom] = self.place([self.x.low, self.y.low]);
        let [right, top] = self.place([self.x.high, *floor]);
        html! {
            rect.floor x=(at(left)) y=(at(top)) width=(at(right - left)) height=(at(bottom - top)) {}
            text.remark x=(at(left + 8.0)) y=(at((top + 16.0).min(bottom - 6.0))) { (words) }
        }
    }

    fn mark(&self) -> Markup {
        let Some((mark, words)) = &self.mark else { return html! {} };
        let [x, bottom] = self.place([*mark, self.y.low]);
        let top = self.place([*mark, self.y.high])[1];
        let is_right = self.x.share(*mark) > 0.6;
        let (beside, anchor) = if is_right { (x - 6.0, "end") } else { (x + 6.0, "start") };
        html! {
            path.mark d={ "M" (at(x)) " " (at(top)) "V" (at(bottom)) } {}
            text.remark x=(at(beside)) y=(at(top + 14.0)) text-anchor=(anchor) { (words) }
        }
    }

    fn line(&self, line: &Line) -> Markup {
        let places = line.through.iter().map(|at| self.place(*at));
        let points: Vec<String> = places.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        html! { polyline class=(line.class) points=(points.join(" ")) {} }
    }

    fn dot(&self, dot: &Dot) -> Markup {
        let [x, y] = self.place(dot.at);
        let is_right = self.x.share(dot.at[0]) > 0.7;
        let (beside, anchor) = if is_right { (x - 10.0, "end") } else { (x + 10.0, "start") };
        html! {
            @if let Some(end) = dot.up_to.map(|end| self.place([dot.at[0], end])[1]) {
                path.reach d={ "M" (at(x)) " " (at(y)) "V" (at(end)) "m-4 0h8" } {}
            }
            circle class={ "dot c" (dot.colour % 6) @if !dot.is_sound { " bad" } } cx=(at(x)) cy=(at(y)) r="5" {
                title { (dot.title) }
            }
            @if let Some(words) = &dot.label {
                text.label x=(at(beside)) y=(at(y - 8.0)) text-anchor=(anchor) { (words) }
            }
        }
    }
}

/// A coordinate, with the digits that an SVG needs.
fn at(x: f64) -> String {
    format!("{x:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_have_equal_length_on_a_log_axis() {
        let axis = Axis { low: 0.1, high: 10.0, ..Axis::log("x", [1.0]) };
        assert!((axis.share(1.0) - 0.5).abs() < 1e-12);
        assert_eq!(axis.share(0.0), 0.0);
        assert!(axis.ticks().iter().any(|tick| (tick - 1.0).abs() < 1e-12));
    }

    #[test]
    fn text_in_a_chart_is_escaped() {
        let x = Axis::log("a < b & c", [1.0, 2.0]);
        let chart =
            Chart { x: x.clone(), y: x, dots: Vec::new(), lines: Vec::new(), floor: None, mark: None };
        let svg = chart.svg().into_string();
        assert!(svg.contains("a &lt; b &amp; c") && !svg.contains("a < b"));
    }

    #[test]
    fn an_axis_without_values_still_has_ticks() {
        assert!(Axis::log("x", []).ticks().len() > 1);
        assert!(Axis::linear("x", 0.0, 0.0).ticks().len() > 1);
    }
}
