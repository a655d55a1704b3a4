//! Cost of each feature: one at a time is added to the same sheet.

pub mod alone;

use nalgebra::Vector3;
use nucleus_core::{
    BuildError, ClothFrame, ClothLists, FrameInput, GroundPlane, Mass, ModelBuilder, PassCost, Solver,
};

use super::mesh::{self, Cells};
use super::report::Report;
use super::table::{Table, figure};
use super::workload::{DENSITY, Setting, Variant, frame};
use nucleus_measure::clock::Timing;

/// Points along each side of the sheet.
const SIZE: u32 = 65;
const FRAMES: u32 = 8;

/// A feature: name, list to build, attribute to set.
type Feature = (&'static str, fn(&mut ClothLists), fn(&mut FrameInput));

const FEATURES: [Feature; 7] = [
    ("stretch", |lists| lists.stretch = true, |frame| frame.cloths[0].stretch_resistance = 20.0),
    ("cross links", |lists| lists.cross_links = true, |_| {}),
    ("shear", |lists| lists.shear = true, |frame| frame.cloths[0].shear_resistance = 5.0),
    ("bend", |lists| lists.bend = true, |frame| frame.cloths[0].bend_resistance = 0.1),
    ("drag", |lists| lists.air = true, |frame| frame.cloths[0].drag = 0.05),
    ("damping", |lists| lists.damp = true, |frame| frame.cloths[0].stretch_damp = 0.1),
    (
        "ground",
        |_| {},
        |frame| {
            let (origin, normal) = (Vector3::y() * -99.0, Vector3::y());
            frame.plane = Some(GroundPlane::new(origin, normal));
        },
    ),
];

/// Cost of a frame.
struct Cost {
    /// Milliseconds of processor time.
    ms: f64,
    passes: Vec<PassCost>,
}

fn measure(lists: ClothLists, input: &FrameInput, repeat: u32) -> Result<Cost, BuildError> {
    let mut times = Vec::new();
    let mut passes = Vec::new();
    for _ in 0..repeat.max(3) {
        let mut builder = ModelBuilder::new();
        let surface = mesh::sheet(SIZE, Cells::Quads, Vector3::zeros(), Vector3::x(), Vector3::z());
        builder.cloth(nucleus_core::Cloth::new(surface, Mass::PerArea(DENSITY), lists))?;
        let mut solver = Solver::<f32>::new(builder, 1);
        passes = solver.passes(input);
        solver.step(input, &mut ());
        let (timing, ()) = Timing::of_process(|| {
            (0..FRAMES).for_each(|_| {
                solver.step(input, &mut ());
            });
        });
        times.push(1e3 * timing.processor / f64::from(FRAMES));
    }
    times.sort_by(f64::total_cmp);
    Ok(Cost { ms: times[times.len() / 2], passes })
}

/// Text of the page above its table.
pub const HEAD: &str = "# Only what a scene needs

Features are added one by one to the same falling sheet of 65² points, with 48 evaluations per 1/24 s.
**Rows** are the constraints that are swept, **passes** the operations of every step, as `nucleus info` shows them.
**More ms** is the time that the feature adds to a frame.
**Off** has the feature's list built and its attribute at 0, compared with the sheet without that list: it adds no rows \
and no passes, and its difference in time is noise.
`cargo xtask book --only features` rewrites this page.
";

/// Measures the features one by one.
///
/// # Errors
/// When the solver rejects the sheet.
pub fn run(repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    report.show(table(repeat)?);
    report.show(alone::table()?);
    Ok(())
}

/// The same, as a table.
///
/// # Errors
/// When the solver rejects the sheet.
pub fn table(repeat: u32) -> anyhow::Result<Table> {
    let head = ["with", "rows", "passes", "ms", "more ms", "off: more rows", "more passes", "more ms"];
    let mut table = Table::new("Features and their cost", &head);
    let mut input = frame(&Setting { resistance: 0.0, bend: 0.0, evaluations: 48, variant: Variant::Plain });
    input.cloths[0] = ClothFrame { compression_resistance: 0.0, ..input.cloths[0] };
    let mut lists = ClothLists::NONE;
    let mut before = measure(lists, &input, repeat)?;
    table.row(before.cells("points alone", 0.0, None));
    for (name, list, set) in FEATURES {
        list(&mut lists);
        // Cross links share the pass of edge links, and the ground has no list: neither can be built and off.
        let can_be_off = !matches!(name, "cross links" | "ground");
        let off = if can_be_off { Some(measure(lists, &input, repeat)?.more_than(&before)) } else { None };
        set(&mut input);
        let with = measure(lists, &input, repeat)?;
        table.row(with.cells(name, with.ms - before.ms, off));
        before = with;
    }
    table.note("One thread; time is the processor's, the median of several runs.");
    Ok(table)
}

impl Cost {
    /// Rows, passes and milliseconds in addition to those of another.
    fn more_than(&self, other: &Self) -> [f64; 3] {
        let count = |of: fn(&Self) -> usize| of(self) as f64 - of(other) as f64;
        [count(Self::rows), count(|cost| cost.passes.len()), self.ms - other.ms]
    }

    fn rows(&self) -> usize {
        self.passes.iter().map(|pass| pass.rows).sum()
    }

    fn cells(&self, name: &str, more: f64, off: Option<[f64; 3]>) -> [String; 8] {
        let off = off.map_or_else(Default::default, |off| off.map(figure));
        let [rows, passes] = [self.rows(), self.passes.len()].map(|count| count.to_string());
        let [off_rows, off_passes, off_ms] = off;
        [name.to_owned(), rows, passes, figure(self.ms), figure(more), off_rows, off_passes, off_ms]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disabled_feature_has_no_rows_and_no_passes() {
        let table = table(1).expect("a valid sheet");
        let off: Vec<_> = table.rows.iter().filter(|row| !row[5].is_empty()).collect();
        assert_eq!(off.len(), 5);
        for row in off {
            assert_eq!((row[5].as_str(), row[6].as_str()), ("0", "0"), "{row:?}");
        }
        // Enabled features have rows or passes, so the zeros above are significant.
        assert!(table.rows.windows(2).all(|pair| pair[0][1..3] != pair[1][1..3] || pair[1][0] == "ground"));
    }
}
