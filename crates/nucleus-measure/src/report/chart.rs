//! Charts as SVG, drawn with the page's own colours.

use std::fmt::Write;

use super::{figure, percent};

/// Width and height of a chart.
const SIZE: [f64; 2] = [760.0, 420.0];

/// Room left of, above, right of and below the field.
const MARGIN: [f64; 4] = [70.0, 16.0, 18.0, 48.0];

/// An axis: from one value to another, over so many pixels.
#[derive(Debug, Clone)]
pub struct Axis {
    pub name: String,
    low: f64,
    high: f64,
    is_log: bool,
    is_share: bool,
}

/// A dot.
pub struct Dot {
    pub at: [f64; 2],
    /// Which of the colours, counted from nought.
    pub colour: usize,
    pub is_sound: bool,
    /// What is shown when it is pointed at.
    pub title: String,
    /// What is written beside it.
    pub label: Option<String>,
}

/// A line from place to place.
pub struct Line {
    pub through: Vec<[f64; 2]>,
    /// Its class in the style sheet.
    pub class: &'static str,
}

/// A chart.
pub struct Chart {
    pub x: Axis,
    pub y: Axis,
    pub dots: Vec<Dot>,
    pub lines: Vec<Line>,
    /// Below this everything is shaded, with a remark.
    pub floor: Option<(f64, String)>,
    /// A line straight up here, with a remark.
    pub mark: Option<(f64, String)>,
}

impl Axis {
    /// A logarithmic axis that holds these values with some room.
    pub fn log(name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let usable = values.into_iter().filter(|x| x.is_finite() && *x > 0.0);
        let (low, high) = usable.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        let (low, high) = if low <= high { (low / 1.4, high * 1.4) } else { (0.1, 1.0) };
        Self { name: name.to_owned(), low, high, is_log: true, is_share: false }
    }

    /// A plain axis.
    pub fn plain(name: &str, low: f64, high: f64) -> Self {
        Self { name: name.to_owned(), low, high: high.max(low + 1.0), is_log: false, is_share: false }
    }

    /// The same, with its values written in percent.
    pub fn in_percent(self) -> Self {
        Self { is_share: true, ..self }
    }

    /// Where a value is, 0 to 1; what is outside is at the end.
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

    fn written(&self, x: f64) -> String {
        if self.is_share { percent(x) } else { figure(x) }
    }
}

impl Chart {
    /// As SVG.
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
            let words = self.x.written(tick);
            put(
                svg,
                format_args!("<text x=\"{x:.1}\" y=\"{below:.1}\" text-anchor=\"middle\">{words}</text>"),
            );
        }
        for tick in self.y.ticks() {
            let y = self.place([self.x.low, tick])[1];
            put(svg, format_args!("<path class=\"grid\" d=\"M{left:.1} {y:.1}H{right:.1}\"/>"));
            let (beside, middle, words) = (left - 8.0, y + 4.0, self.y.written(tick));
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

/// Text that is safe in HTML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decade_on_a_log_axis_is_as_long_as_the_next() {
        let axis = Axis { low: 0.1, high: 10.0, ..Axis::log("x", [1.0]) };
        assert!((axis.share(1.0) - 0.5).abs() < 1e-12);
        assert_eq!(axis.share(0.0), 0.0);
        assert!(axis.ticks().iter().any(|tick| (tick - 1.0).abs() < 1e-12));
    }

    #[test]
    fn what_is_written_in_a_chart_can_hold_any_sign() {
        let x = Axis::log("a < b & c", [1.0, 2.0]);
        let chart =
            Chart { x: x.clone(), y: x, dots: Vec::new(), lines: Vec::new(), floor: None, mark: None };
        assert!(chart.svg().contains("a &lt; b &amp; c") && !chart.svg().contains("a < b"));
    }

    #[test]
    fn an_axis_of_nothing_can_still_be_drawn() {
        assert!(Axis::log("x", []).ticks().len() > 1);
        assert!(Axis::plain("x", 0.0, 0.0).ticks().len() > 1);
    }
}
