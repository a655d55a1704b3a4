//! An axis of a wedge: one attribute and its values, as `--vary` states them.

use std::str::FromStr;

use nucleus_graph::attributes::{Attribute, Kind};
use nucleus_graph::graph::Graph;
use nucleus_graph::scene::{AssignError, Assignment};

/// The largest number of values of a range.
const MAX_VALUES: u32 = 1_000_000;

/// An attribute that differs from run to run, and its values.
///
/// ```
/// use nucleus_wedge::{Axis, Values};
///
/// let axis: Axis = "cloth1.bendResistance=0.1,1,10".parse().unwrap();
/// assert_eq!(axis.values, Values::List(vec!["0.1".into(), "1".into(), "10".into()]));
/// let axis: Axis = "nucleus1.windSpeed=0..20/5".parse().unwrap();
/// assert_eq!(axis.steps().unwrap(), ["0", "5", "10", "15", "20"]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name of the node.
    pub node: String,
    /// The name of the attribute, or of a component of a vector.
    pub attribute: String,
    /// The values.
    pub values: Values,
    /// Whether numbers are rounded to whole ones.
    pub is_whole: bool,
}

/// The values of an axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// `0.1,1,10`: these values, in the syntax of scenes.
    List(Vec<String>),
    /// `0..20/5`: this many values, the first and the last included.
    Steps(Interval, u32),
    /// `0..20`: an interval that is sampled.
    Sampled(Interval),
}

/// An interval of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The first number.
    pub from: f64,
    /// The last number.
    pub to: f64,
    /// How numbers are spread.
    pub spacing: Spacing,
}

/// How numbers are spread over an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// Evenly in their logarithm: `0.1..10:log`.
    Logarithmic,
}

/// Reasons why an axis cannot be read, or does not fit a scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AxisError {
    /// The text is not an axis.
    #[error("`{text}`: write `node.attribute=0.1,1,10`, `node.attribute=0..20/5` or `node.attribute=0..20`")]
    NotAnAxis {
        /// The text.
        text: String,
    },
    /// A list has an empty place.
    #[error("`{text}` has an empty value between its commas")]
    EmptyValue {
        /// The text.
        text: String,
    },
    /// A range has fewer than two values.
    #[error("`{text}`: a range has at least 2 values, its first and its last")]
    TooFew {
        /// The text.
        text: String,
    },
    /// A range has too many values.
    #[error("`{text}`: a range has at most {MAX_VALUES} values")]
    TooMany {
        /// The text.
        text: String,
    },
    /// A logarithmic range reaches zero.
    #[error("`{text}`: both ends of a logarithmic range must be above zero")]
    NoLogarithm {
        /// The text.
        text: String,
    },
    /// A range ends where it begins.
    #[error("`{text}`: the range ends where it begins")]
    EmptyRange {
        /// The text.
        text: String,
    },
    /// A value does not fit the attribute.
    #[error(transparent)]
    Value(#[from] AssignError),
    /// A range of values that are not numbers.
    #[error("`{axis}` takes {expects}, which has no range: list the values, separated by commas")]
    NotANumber {
        /// Node and attribute.
        axis: String,
        /// Values that the attribute accepts.
        expects: &'static str,
    },
    /// An attribute is varied twice.
    #[error("`{axis}` is varied twice")]
    Twice {
        /// Node and attribute.
        axis: String,
    },
    /// A vector is varied as a whole, and so is a component of it.
    #[error("`{axis}` and `{other}` set the same number: vary one of them")]
    Overlaps {
        /// Node and attribute.
        axis: String,
        /// Those of the axis before.
        other: String,
    },
}

impl FromStr for Axis {
    type Err = AxisError;

    fn from_str(text: &str) -> Result<Self, AxisError> {
        let Ok(Assignment { node, attribute, value }) = text.parse() else {
            return Err(AxisError::NotAnAxis { text: text.to_owned() });
        };
        Ok(Self { node, attribute, values: Values::read(&value, text)?, is_whole: false })
    }
}

impl Values {
    fn read(value: &str, text: &str) -> Result<Self, AxisError> {
        let text = || text.to_owned();
        let Some((interval, count)) = interval(value) else {
            let parts = split_list(value);
            return match parts.iter().any(String::is_empty) {
                true => Err(AxisError::EmptyValue { text: text() }),
                false => Ok(Self::List(parts)),
            };
        };
        if interval.from == interval.to {
            return Err(AxisError::EmptyRange { text: text() });
        }
        if interval.spacing == Spacing::Logarithmic && (interval.from <= 0.0 || interval.to <= 0.0) {
            return Err(AxisError::NoLogarithm { text: text() });
        }
        match count {
            None => Ok(Self::Sampled(interval)),
            Some(count) if count > MAX_VALUES => Err(AxisError::TooMany { text: text() }),
            Some(count) if count >= 2 => Ok(Self::Steps(interval, count)),
            Some(_) => Err(AxisError::TooFew { text: text() }),
        }
    }
}

/// `0.1..10/5:log`; `None` if the text is not an interval.
fn interval(text: &str) -> Option<(Interval, Option<u32>)> {
    let (text, spacing) = match text.strip_suffix(":log") {
        Some(text) => (text, Spacing::Logarithmic),
        None => (text, Spacing::Linear),
    };
    let (from, rest) = text.split_once("..")?;
    let (to, count) = match rest.split_once('/') {
        Some((to, count)) => (to, Some(count.trim().parse().ok()?)),
        None => (rest, None),
    };
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    Some((Interval { from: number(from)?, to: number(to)?, spacing }, count))
}

/// The parts of a list. Commas within brackets and quotes belong to a value: `(0, 1, 0),(1, 0, 0)`.
pub(crate) fn split_list(text: &str) -> Vec<String> {
    let (mut parts, mut depth, mut quoted, mut escaped) = (vec![String::new()], 0_i32, false, false);
    for c in text.chars() {
        match c {
            '"' if !escaped => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            ',' if depth == 0 && !quoted => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        escaped = c == '\\' && !escaped;
        if let Some(last) = parts.last_mut() {
            last.push(c);
        }
    }
    parts.iter().map(|part| part.trim().to_owned()).collect()
}

impl Interval {
    /// The number at a share of the interval, 0 to 1.
    pub fn at(self, share: f64) -> f64 {
        let Self { from, to, spacing } = self;
        match spacing {
            Spacing::Linear => from + (to - from) * share,
            Spacing::Logarithmic => from * (to / from).powf(share),
        }
    }
}

impl Axis {
    /// `node.attribute`, the heading of its column.
    pub fn name(&self) -> String {
        format!("{}.{}", self.node, self.attribute)
    }

    /// Checks that it sets no number of the attribute `row` that `other` sets too.
    ///
    /// # Errors
    /// When both are the same, or one is a component of the other.
    pub(crate) fn differs_from(&self, other: &Self, row: &Attribute) -> Result<(), AxisError> {
        let [own, theirs] = [self, other].map(|axis| axis.attribute.as_str());
        let is_same_node = self.node == other.node;
        let [axis, other] = [self, other].map(Self::name);
        match is_same_node {
            true if own == theirs => Err(AxisError::Twice { axis }),
            true if [own, theirs].contains(&row.name) => Err(AxisError::Overlaps { axis, other }),
            _ => Ok(()),
        }
    }

    /// All values of a list or a stepped range; `None` for an interval that is sampled.
    pub fn steps(&self) -> Option<Vec<String>> {
        match &self.values {
            Values::List(values) => Some(values.clone()),
            Values::Steps(interval, count) => {
                let share = |k: u32| f64::from(k) / f64::from(count - 1);
                let mut values: Vec<_> = (0..*count).map(|k| self.written(*interval, share(k))).collect();
                values.dedup(); // of whole numbers
                Some(values)
            }
            Values::Sampled(_) => None,
        }
    }

    /// The value at a share of a sampled interval; `None` for lists and steps.
    pub fn sample(&self, share: f64) -> Option<String> {
        match &self.values {
            Values::Sampled(interval) => Some(self.written(*interval, share)),
            _ => None,
        }
    }

    /// A number of the interval as text: six significant digits, and never beyond its ends.
    fn written(&self, interval: Interval, share: f64) -> String {
        let (low, high) = (interval.from.min(interval.to), interval.from.max(interval.to));
        let rounded = if self.is_whole { interval.at(share).round() } else { rounded(interval.at(share)) };
        format!("{}", rounded.clamp(low, high))
    }

    /// Checks node, attribute and every value against a scene. Returns the row of the attribute.
    ///
    /// Of an interval, the two ends are checked: a range of valid numbers is valid throughout.
    ///
    /// # Errors
    /// When the node or the attribute does not exist, or a value does not fit.
    pub fn resolve(&mut self, graph: &Graph) -> Result<&'static Attribute, AxisError> {
        let values = match &self.values {
            Values::List(values) => values.clone(),
            Values::Steps(interval, _) | Values::Sampled(interval) => {
                [interval.from, interval.to].map(|x| format!("{x}")).to_vec()
            }
        };
        let is_range = !matches!(self.values, Values::List(_));
        let (mut row, mut resolved) = (None, Vec::new());
        for value in values {
            let mut one = Assignment { node: self.node.clone(), attribute: self.attribute.clone(), value };
            row = Some(one.resolve(graph)?);
            self.attribute = one.attribute;
            resolved.push(one.value);
        }
        if let Values::List(values) = &mut self.values {
            *values = resolved;
        }
        let Some(row) = row else { return Err(AxisError::EmptyValue { text: self.name() }) };
        if is_range && matches!(row.kind, Kind::Bool | Kind::Choice(_)) {
            return Err(AxisError::NotANumber { axis: self.name(), expects: row.kind.expects() });
        }
        self.is_whole = row.kind == Kind::Int;
        Ok(row)
    }
}

/// A number rounded to six significant digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nucleus_graph::scene::read_scene_text;

    const SCENE: &str = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"),
    })"#;

    fn axis(text: &str) -> Result<Axis, String> {
        let (scene, _) = read_scene_text(SCENE, "a.ron".as_ref()).unwrap();
        let mut axis: Axis = text.parse().map_err(|error: AxisError| error.to_string())?;
        axis.resolve(&scene.graph).map_err(|error| error.to_string())?;
        Ok(axis)
    }

    #[test]
    fn ranges_include_both_ends() {
        let steps = |text: &str| axis(text).unwrap().steps().unwrap();
        assert_eq!(steps("n.windSpeed=0..20/5"), ["0", "5", "10", "15", "20"]);
        assert_eq!(steps("c.damp=0..1/4"), ["0", "0.333333", "0.666667", "1"]);
        assert_eq!(
            steps("c.bend=0.1..10/3:log".replace("bend", "bendResistance").as_str()),
            ["0.1", "1", "10"]
        );
        assert_eq!(steps("n.subSteps=1..3/5"), ["1", "2", "3"], "whole numbers occur once");
        assert_eq!(steps("n.windSpeed=5..-5/3"), ["5", "0", "-5"]);
        assert_eq!(steps("c.preset=silk,rubberSheet"), ["\"silk\"", "\"rubberSheet\""]);
        assert!(axis("c.damp=0..1/3000000000").unwrap_err().ends_with("a range has at most 1000000 values"));
    }

    #[test]
    fn commas_within_a_value_do_not_divide_a_list() {
        let axis = axis("n.windDirection=(1, 0, 0), (0, 1, 0)").unwrap();
        assert_eq!(axis.values, Values::List(vec!["(1, 0, 0)".into(), "(0, 1, 0)".into()]));
        assert_eq!(split_list(r#""a,b\",", 2"#), [r#""a,b\",""#, "2"]);
    }

    #[test]
    fn short_names_become_long_ones() {
        assert_eq!(axis("c.bnd=0..1").unwrap().name(), "c.bendResistance");
    }

    #[test]
    fn mistakes_are_refused_with_the_fix() {
        let refusals = [
            ("c.damp", "write `node.attribute=0.1,1,10`"),
            ("c.damp=1,,2", "an empty value"),
            ("c.damp=0..1/1", "at least 2 values"),
            ("c.damp=0..1/3:log", "above zero"),
            ("c.damp=1..1", "ends where it begins"),
            ("c.dampp=1,2", "did you mean `damp`?"),
            ("d.damp=1,2", "no node `d`"),
            ("c.damp=1,soft", "`c`"),
            ("n.resistanceModel=0..1/2", "list the values"),
            ("n.subSteps=0.5..4/3", "a whole number"),
            ("n.subSteps=-4..4/3", "must be"),
        ];
        for (text, words) in refusals {
            let said = axis(text).expect_err(text);
            assert!(said.contains(words), "{text}: {said}");
        }
    }

    #[test]
    fn samples_stay_within_their_interval() {
        let axis = axis("c.damp=0.1234567..0.7654321").unwrap();
        assert_eq!([0.0, 1.0].map(|share| axis.sample(share).unwrap()), ["0.123457", "0.765432"]);
    }
}
