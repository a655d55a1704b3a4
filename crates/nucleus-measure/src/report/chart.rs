//! SVG charts in the colours of the page's style sheet.

use std::fmt::Write;

use super::{figure, percent};

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
    pub fn svg(&self) -> String {
        let [width, height] = SIZE;
        let mut svg = format!(
            "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{} against {}\">\n",
            escape(&self.y.name),
            escape(&self.x.name)
        );
        self.draw_floor(&mut svg);
        self.draw_axes(&mut svg);
        self.draw_mark(&mut svg);
        for line in &self.lines {
            self.draw_line(line, &mut svg);
        }
        for dot in &self.dots {
            self.draw_dot(dot, &mut svg);
        }
        svg + "</svg>\n"
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = MARGIN;
        let across = SIZE[0] - left - right;
        let up = SIZE[1] - top - bottom;
        [left + across * self.x.share(x), top + up * (1.0 - self.y.share(y))]
    }

    fn draw_axes(&self, svg: &mut String) {
        let [left, bottom] = self.place([self.x.low, self.y.low]);
        let [right, top] = self.place([self.x.high, self.y.high]);
        for tick in self.x.ticks() {
            let x = self.place([tick, self.y.low])[0];
            let below = bottom + 18.0;
            put(svg, format_args!("<path class=\"grid\" d=\"M{x:.1} {top:.1}V{bottom:.1}\"/>"));
            let words = self.x.tick_label(tick);
            put(
                svg,
                format_args!("<text x=\"{x:.1}\" y=\"{below:.1}\" text-anchor=\"middle\">{words}</text>"),
            );
        }
        for tick in self.y.ticks() {
            let y = self.place([self.x.low, tick])[1];
            put(svg, format_args!("<path class=\"grid\" d=\"M{left:.1} {y:.1}H{right:.1}\"/>"));
            let (beside, middle, words) = (left - 8.0, y + 4.0, self.y.tick_label(tick));
            put(
                svg,
                format_args!("<text x=\"{beside:.1}\" y=\"{middle:.1}\" text-anchor=\"end\">{words}</text>"),
            );
        }
        let (middle, lowest, name) = ((left + right) / 2.0, SIZE[1] - 8.0, escape(&self.x.name));
        put(
            svg,
            format_args!(
                "<text class=\"name\" x=\"{middle:.1}\" y=\"{lowest:.1}\" text-anchor=\"middle\">{name}</text>"
            ),
        );
        let (middle, name) = ((top + bottom) / 2.0, escape(&self.y.name));
        put(
            svg,
            format_args!(
                "<text class=\"name\" transform=\"translate(14 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{name}</text>"
            ),
        );
    }

    fn draw_floor(&self, svg: &mut String) {
        let Some((floor, words)) = &self.floor else { return };
        let [left, bottom] = self.place([self.x.low, self.y.low]);
        let [right, top] = self.place([self.x.high, *floor]);
        let (width, height) = (right - left, bottom - top);
        put(
            svg,
            format_args!(
                "<rect class=\"floor\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"
            ),
        );
        let (x, y, words) = (left + 8.0, (top + 16.0).min(bottom - 6.0), escape(words));
        put(svg, format_args!("<text class=\"remark\" x=\"{x:.1}\" y=\"{y:.1}\">{words}</text>"));
    }

    fn draw_mark(&self, svg: &mut String) {
        let Some((mark, words)) = &self.mark else { return };
        let [x, bottom] = self.place([*mark, self.y.low]);
        let top = self.place([*mark, self.y.high])[1];
        put(svg, format_args!("<path class=\"mark\" d=\"M{x:.1} {top:.1}V{bottom:.1}\"/>"));
        let is_right = self.x.share(*mark) > 0.6;
        let (beside, anchor) = if is_right { (x - 6.0, "end") } else { (x + 6.0, "start") };
        let (y, words) = (top + 14.0, escape(words));
        put(
            svg,
            format_args!(
                "<text class=\"remark\" x=\"{beside:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>"
            ),
        );
    }

    fn draw_line(&self, line: &Line, svg: &mut String) {
        let places: Vec<[f64; 2]> = line.through.iter().map(|at| self.place(*at)).collect();
        let points: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        put(svg, format_args!("<polyline class=\"{}\" points=\"{}\"/>", line.class, points.join(" ")));
    }

    fn draw_dot(&self, dot: &Dot, svg: &mut String) {
        let [x, y] = self.place(dot.at);
        let sound = if dot.is_sound { "" } else { " bad" };
        put(
            svg,
            format_args!(
                "<circle class=\"dot c{}{sound}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\"><title>{}</title></circle>",
                dot.colour % 6,
                escape(&dot.title)
            ),
        );
        if let Some(words) = &dot.label {
            let is_right = self.x.share(dot.at[0]) > 0.7;
            let (beside, anchor) = if is_right { (x - 10.0, "end") } else { (x + 10.0, "start") };
            let (y, words) = (y - 8.0, escape(words));
            put(
                svg,
                format_args!(
                    "<text class=\"label\" x=\"{beside:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>"
                ),
            );
        }
    }
}

fn put(svg: &mut String, element: std::fmt::Arguments) {
    // Writing to a string cannot fail.
    let _ = writeln!(svg, "{element}");
}

/// Escapes text for HTML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
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
        assert!(chart.svg().contains("a &lt; b &amp; c") && !chart.svg().contains("a < b"));
    }

    #[test]
    fn an_axis_without_values_still_has_ticks() {
        assert!(Axis::log("x", []).ticks().len() > 1);
        assert!(Axis::linear("x", 0.0, 0.0).ticks().len() > 1);
    }
}
