//! The rows of a wedge: a grid over listed values, times a sampled design over intervals, times seeds.

use std::collections::BTreeSet;

use nucleus_graph::attributes::Attribute;
use nucleus_graph::graph::Graph;

use crate::axis::{Axis, AxisError, Values};
use crate::seed::SplitMix;

/// The largest number of runs of a plan.
const MAX_RUNS: usize = 1_000_000;

/// How intervals are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// Latin hypercube: each interval is divided into as many strata as samples, and each stratum has one sample (McKay,
    /// Beckman and Conover 1979).
    #[default]
    Latin,
    /// Independent uniform samples.
    Random,
}

/// The axes of a wedge, and how they are combined.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Design {
    /// The axes. Lists and steps form a grid; intervals are sampled together.
    pub axes: Vec<Axis>,
    /// Samples of the intervals.
    pub samples: u32,
    /// How intervals are sampled.
    pub sampling: Sampling,
    /// The seed of the first repetition.
    pub seed: u32,
    /// Repetitions of the table with the seeds from [`seed`](Self::seed) on; `None` if the runs have no seed.
    pub seeds: Option<u32>,
}

/// One row of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// A value per column.
    pub values: Vec<String>,
    /// The seed of the run.
    pub seed: Option<u32>,
}

/// Reasons why axes do not form a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// An axis does not fit the scene.
    #[error(transparent)]
    Axis(#[from] AxisError),
    /// Nothing varies.
    #[error("nothing varies: give values with `--vary node.attribute=0.1,1,10`, or `--seeds 3`")]
    Nothing,
    /// An interval without a number of samples.
    #[error("`{axis}` is an interval: say how many samples to take, `--samples 20`, or divide it, `0..20/5`")]
    NoSamples {
        /// Node and attribute.
        axis: String,
    },
    /// Samples without an interval.
    #[error("`--samples` needs an interval to sample, such as `--vary cloth1.bendResistance=0.1..10:log`")]
    NothingToSample,
    /// Too many runs.
    #[error("the table has {runs} runs; at most {MAX_RUNS} are planned at once")]
    TooMany {
        /// Their number.
        runs: u128,
    },
    /// A table file is malformed.
    #[error("line {line}: {message}")]
    Table {
        /// The line, from 1.
        line: usize,
        /// The mistake, and how to fix it.
        message: String,
    },
}

impl Design {
    /// Checks all axes against a scene, and the number of rows.
    ///
    /// # Errors
    /// When an axis does not fit the scene or occurs twice, or the numbers of samples and rows make no table.
    pub fn resolve(&mut self, graph: &Graph) -> Result<(), DesignError> {
        let mut seen: Vec<(&Axis, &'static Attribute)> = Vec::new();
        for axis in &mut self.axes {
            let row = axis.resolve(graph)?;
            let same_row = seen.iter().filter(|(_, other)| other.name == row.name);
            same_row.clone().try_for_each(|(other, _)| axis.differs_from(other, row))?;
            seen.push((axis, row));
        }
        let sampled = self.axes.iter().find(|axis| matches!(axis.values, Values::Sampled(_)));
        match sampled {
            Some(axis) if self.samples == 0 => return Err(DesignError::NoSamples { axis: axis.name() }),
            None if self.samples > 0 => return Err(DesignError::NothingToSample),
            _ => {}
        }
        if self.axes.is_empty() && self.seeds.is_none() {
            return Err(DesignError::Nothing);
        }
        let counts = self.axes.iter().filter_map(|axis| Some(axis.steps()?.len() as u128));
        let grid = counts.fold(1, u128::saturating_mul);
        let repeated = u128::from(self.samples.max(1)) * u128::from(self.seeds.unwrap_or(1));
        let runs = grid.saturating_mul(repeated);
        if runs > MAX_RUNS as u128 { Err(DesignError::TooMany { runs }) } else { Ok(()) }
    }

    /// The headings of the columns.
    pub fn columns(&self) -> Vec<String> {
        self.axes.iter().map(Axis::name).collect()
    }

    /// All rows. The first axis changes slowest, the seed fastest.
    pub fn rows(&self) -> Vec<Row> {
        let seeds: Vec<Option<u32>> = match self.seeds {
            None => vec![None],
            Some(count) => (0..count).map(|k| Some(self.seed.saturating_add(k))).collect(),
        };
        // Each repetition samples the intervals anew.
        let samples: Vec<Vec<Vec<String>>> =
            seeds.iter().map(|seed| self.sampled(seed.unwrap_or(self.seed))).collect();
        let mut rows = Vec::new();
        for grid in self.grid() {
            for sample in 0..self.samples.max(1) as usize {
                for (seed, samples) in seeds.iter().zip(&samples) {
                    let mut sampled = samples[sample].iter();
                    let values = grid
                        .iter()
                        .map(|fixed| fixed.clone().or_else(|| sampled.next().cloned()).unwrap_or_default());
                    rows.push(Row { values: values.collect(), seed: *seed });
                }
            }
        }
        rows
    }

    /// The grid over lists and steps; `None` in the columns that are sampled.
    fn grid(&self) -> Vec<Vec<Option<String>>> {
        let mut rows = vec![Vec::new()];
        for axis in &self.axes {
            let values = match axis.steps() {
                Some(values) => values.into_iter().map(Some).collect(),
                None => vec![None],
            };
            let extended = |row: &Vec<Option<String>>, value: &Option<String>| {
                let mut row = row.clone();
                row.push(value.clone());
                row
            };
            rows = rows.iter().flat_map(|row| values.iter().map(move |value| extended(row, value))).collect();
        }
        rows
    }

    /// The samples of the intervals: a list per sample, a value per interval.
    fn sampled(&self, seed: u32) -> Vec<Vec<String>> {
        let count = self.samples.max(1) as usize;
        let mut random = SplitMix(u64::from(seed));
        let mut samples = vec![Vec::new(); count];
        for axis in self.axes.iter().filter(|axis| matches!(axis.values, Values::Sampled(_))) {
            let strata = random.permutation(count);
            for (sample, stratum) in samples.iter_mut().zip(strata) {
                let share = match self.sampling {
                    Sampling::Latin => (stratum as f64 + random.share()) / count as f64,
                    Sampling::Random => random.share(),
                };
                sample.extend(axis.sample(share));
            }
        }
        samples
    }
}

/// Reads a table of runs: a line of headings (`cloth1.damp,nucleus1.windSpeed`), then a line per run. Values that contain
/// commas are in brackets or quotes, as in scenes, or in the quotes of a CSV file (RFC 4180), as spreadsheets and
/// `wedge.csv` have them. A byte order mark, blank lines and lines that begin with `#` are skipped.
///
/// # Errors
/// When a line has another number of values than the headings, or a value does not fit the scene.
pub fn read_table(text: &str, graph: &Graph) -> Result<(Vec<String>, Vec<Row>), DesignError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let refused = |line, message| DesignError::Table { line, message };
    let Some((line, head)) = lines.next() else {
        return Err(refused(1, "the table is empty; its first line names the attributes".to_owned()));
    };
    let names = head.split(',').map(|name| name.trim().trim_matches('"').to_owned());
    let mut columns: Vec<String> = names.collect();
    if let (1, Some(sign)) = (columns.len(), head.chars().find(|sign| [';', '\t'].contains(sign))) {
        let name = if sign == ';' { "semicolons" } else { "tabs" };
        return Err(refused(line, format!("cells are separated by commas, and this line has {name}")));
    }
    if columns.iter().collect::<BTreeSet<_>>().len() < columns.len() {
        return Err(refused(line, "an attribute is named twice".to_owned()));
    }
    let (mut rows, mut checked) = (Vec::new(), BTreeSet::new());
    for (line, text) in lines {
        let mut values = Vec::new();
        let parts = crate::axis::split_list(text);
        if parts.len() != columns.len() {
            let (found, expected) = (parts.len(), columns.len());
            return Err(refused(
                line,
                format!("{found} values, but the first line names {expected} attributes"),
            ));
        }
        for (column, part) in columns.iter_mut().zip(parts) {
            let value = unquoted(part, |value| fits(column, value, graph));
            if value.is_empty() {
                return Err(refused(line, format!("the cell of `{column}` is empty")));
            }
            // The same value of an attribute is checked once.
            if checked.insert((column.clone(), value.clone())) {
                let mut axis: Axis = format!("{column}=0")
                    .parse()
                    .map_err(|error: AxisError| refused(1, error.to_string()))?;
                axis.values = Values::List(vec![value.clone()]);
                axis.resolve(graph).map_err(|error| refused(line, error.to_string()))?;
                *column = axis.name();
            }
            values.push(value);
        }
        rows.push(Row { values, seed: None });
    }
    if rows.is_empty() {
        return Err(refused(line, "the table has no runs; each further line is one".to_owned()));
    }
    Ok((columns, rows))
}

/// Whether an attribute takes a value.
fn fits(column: &str, value: &str, graph: &Graph) -> bool {
    let axis = format!("{column}=0").parse::<Axis>().ok();
    axis.is_some_and(|mut axis| {
        axis.values = Values::List(vec![value.to_owned()]);
        axis.resolve(graph).is_ok()
    })
}

/// A cell without the quotes of a CSV file. A text keeps its own quotes, which are part of the syntax of scenes.
fn unquoted(part: String, fits: impl Fn(&str) -> bool) -> String {
    let inner = part.strip_prefix('"').and_then(|part| part.strip_suffix('"'));
    let Some(inner) = inner.map(|inner| inner.replace("\"\"", "\"")) else { return part };
    if fits(&part) || !fits(inner.trim()) { part } else { inner.trim().to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nucleus_graph::scene::read_scene_text;
    use proptest::prelude::*;

    fn graph() -> Graph {
        let text = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
            "n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"),
        })"#;
        read_scene_text(text, "a.ron".as_ref()).unwrap().0.graph
    }

    fn design(axes: &[&str], samples: u32, seeds: Option<u32>) -> Result<Design, String> {
        let axes = axes.iter().map(|text| text.parse().unwrap()).collect();
        let mut design = Design { axes, samples, seeds, seed: 1, ..Design::default() };
        design.resolve(&graph()).map_err(|error| error.to_string())?;
        Ok(design)
    }

    #[test]
    fn lists_and_ranges_form_a_grid_and_seeds_repeat_it() {
        let design = design(&["c.bendResistance=0.1,1,10", "n.windSpeed=0..20/5"], 0, Some(3)).unwrap();
        let rows = design.rows();
        assert_eq!(rows.len(), 45);
        assert_eq!(
            (rows[0].values.as_slice(), rows[0].seed),
            (&["0.1".to_owned(), "0".to_owned()][..], Some(1))
        );
        assert_eq!(
            (rows[44].values.as_slice(), rows[44].seed),
            (&["10".to_owned(), "20".to_owned()][..], Some(3))
        );
        let distinct: BTreeSet<_> = rows.iter().map(|row| format!("{row:?}")).collect();
        assert_eq!(distinct.len(), 45);
    }

    #[test]
    fn tables_that_make_no_sense_are_refused() {
        let refused = |axes: &[&str], samples, seeds| design(axes, samples, seeds).unwrap_err();
        assert!(refused(&[], 0, None).contains("nothing varies"));
        assert!(refused(&["c.damp=0..1"], 0, None).contains("--samples 20"));
        assert!(refused(&["c.damp=0,1"], 5, None).contains("needs an interval"));
        assert!(refused(&["c.damp=0,1", "c.adng=2"], 0, None).contains("varied twice"));
        for [vector, component] in
            [["n.windDirection=(1, 0, 0)", "n.windDirectionY=0,1"], ["p.translate=(0, 1, 0)", "p.tx=1"]]
        {
            for axes in [[vector, component], [component, vector]] {
                assert!(refused(&axes, 0, None).contains("set the same number"), "{axes:?}");
            }
        }
        assert_eq!(design(&["p.tx=0,1", "p.ty=0,1"], 0, None).unwrap().rows().len(), 4);
        assert!(refused(&["c.damp=0..1/2000", "n.windSpeed=0..1/2000"], 0, None).contains("4000000 runs"));
    }

    #[test]
    fn a_table_file_has_a_line_per_run() {
        let read = |text: &str| read_table(text, &graph());
        let (columns, rows) =
            read("# mine\nc.bnd, n.windDirection\n0.1, (1, 0, 0)\n\n2, (0, 1, 0)\n").unwrap();
        assert_eq!(columns, ["c.bendResistance", "n.windDirection"]);
        assert_eq!(rows[1].values, ["2", "(0, 1, 0)"]);
        // As a spreadsheet writes it.
        let (columns, rows) =
            read("\u{feff}\"c.bnd\",n.windDirection\r\n0.1,\"(1, 0, 0)\"\r\n\"2\",\"(0, 1, 0)\"\r\n")
                .unwrap();
        assert_eq!(columns, ["c.bendResistance", "n.windDirection"]);
        assert_eq!((rows[0].values[1].as_str(), rows[1].values[0].as_str()), ("(1, 0, 0)", "2"));
        let refusals = [
            ("", "line 1: the table is empty"),
            ("c.damp", "line 1: the table has no runs"),
            ("c.damp,c.damp\n1,2", "named twice"),
            ("c.damp,c.adng\n1,", "line 2: the cell of `c.adng` is empty"),
            ("c.damp;c.adng\n1;2", "line 1: cells are separated by commas, and this line has semicolons"),
            ("c.damp\tc.adng\n1\t2", "this line has tabs"),
            ("c.damp\n1,2", "line 2: 2 values, but the first line names 1"),
            ("c.damp\n1\nmuch", "line 3: "),
            ("c.dampp\n1", "did you mean `damp`?"),
        ];
        for (text, words) in refusals {
            let said = read(text).unwrap_err().to_string();
            assert!(said.contains(words), "{text}: {said}");
        }
    }

    proptest! {
        #[test]
        fn a_latin_hypercube_has_one_sample_in_each_stratum(count in 1_u32..40, seed in 0_u32..1000) {
            let axes = ["c.damp=0..1", "n.windSpeed=0..1"].map(|text| text.parse().unwrap()).to_vec();
            let mut design = Design { axes, samples: count, seed, ..Design::default() };
            design.resolve(&graph()).unwrap();
            let rows = design.rows();
            for column in 0..2 {
                let mut values: Vec<f64> = rows.iter().map(|row| row.values[column].parse().unwrap()).collect();
                values.sort_unstable_by(f64::total_cmp);
                for (k, value) in values.into_iter().enumerate() {
                    // Values are rounded to six digits.
                    let border = |k: usize| k as f64 / f64::from(count);
                    prop_assert!(border(k) - 1e-6 <= value && value <= border(k + 1) + 1e-6, "{} {}", k, value);
                }
            }
            prop_assert_eq!(design.rows(), rows);
        }
    }
}
