//! Only what a scene needs: one feature at a time is added to the same sheet, and its cost is measured.

use nalgebra::Vector3;
use nucleus_core::{
    BuildError, ClothFrame, ClothLists, FrameInput, GroundPlane, Mass, ModelBuilder, PassCost, Solver,
};

use super::mesh::{self, Cells};
use super::report::Report;
use super::table::{Table, figure};
use super::workload::{DENSITY, Setting, frame};
use nucleus_measure::clock::Timing;

/// Points along the side of the sheet.
const SIZE: u32 = 65;
const FRAMES: u32 = 8;

/// What is added, the list that is built for it, and what is set.
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
            frame.plane = Some(GroundPlane { origin, normal, bounce: 0.0, friction: 0.0, stickiness: 0.0 });
        },
    ),
];

/// What a frame costs.
struct Cost {
    /// Milliseconds of the processor.
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

/// What the page on this says above its table.
pub const HEAD: &str = "# Only what a scene needs

One feature after the other is added to the same sheet of 65² points that falls, 48 evaluations in 1/24 s.
**Rows** are what is swept, **passes** what is done in every step; both are those that `nucleus info` shows.
**More ms** is what the feature adds to a frame.
**Off** is the same with the feature's list built and its attribute at 0, against the sheet without that list: it has no rows \
and no passes more; by what its time differs is to be noise.
`cargo xtask book --only features` makes this page anew.
";

/// Adds the features one by one.
///
/// # Errors
/// When the solver refuses the sheet.
pub fn run(repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    report.show(table(repeat)?);
    Ok(())
}

/// The same, as a table.
///
/// # Errors
/// When the solver refuses the sheet.
pub fn table(repeat: u32) -> anyhow::Result<Table> {
    let head = ["with", "rows", "passes", "ms", "more ms", "off: more rows", "more passes", "more ms"];
    let mut table = Table::new("What is added, and what it costs", &head);
    let mut input = frame(&Setting { resistance: 0.0, bend: 0.0, evaluations: 48 });
    input.cloths[0] = ClothFrame { compression_resistance: 0.0, ..input.cloths[0] };
    let mut lists = ClothLists::NONE;
    let mut before = measure(lists, &input, repeat)?;
    table.row(before.cells("points alone", 0.0, None));
    for (name, list, set) in FEATURES {
        list(&mut lists);
        // Cross links are swept with the links along edges, and the ground has no list: neither can be built and off.
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
    /// Rows, passes and milliseconds above those of another.
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
    fn what_is_off_has_no_row_and_no_pass() {
        let table = table(1).expect("a sheet of ours");
        let off: Vec<_> = table.rows.iter().filter(|row| !row[5].is_empty()).collect();
        assert_eq!(off.len(), 5);
        for row in off {
            assert_eq!((row[5].as_str(), row[6].as_str()), ("0", "0"), "{row:?}");
        }
        // What is on has some, so that the count above could have been another.
        assert!(table.rows.windows(2).all(|pair| pair[0][1..3] != pair[1][1..3] || pair[1][0] == "ground"));
    }
}
