//! Only what a scene needs: one feature at a time is added to the same sheet, and its cost is measured.

use nalgebra::Vector3;
use nucleus_core::{
    BuildError, ClothFrame, ClothLists, FrameInput, GroundPlane, Mass, ModelBuilder, PassCost, Solver,
};

use super::mesh::{self, Cells};
use super::report::Report;
use super::table::{Table, figure};
use super::workload::{DENSITY, Setting, frame};
use nucleus_measure::clock::Spent;

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
            frame.plane = Some(GroundPlane { origin, normal, bounce: 0.0, friction: 0.0 });
        },
    ),
];

/// Milliseconds of the processor for a frame, and the passes of it.
fn measure(lists: ClothLists, input: &FrameInput, repeat: u32) -> Result<(f64, Vec<PassCost>), BuildError> {
    let mut times = Vec::new();
    let mut passes = Vec::new();
    for _ in 0..repeat.max(3) {
        let mut builder = ModelBuilder::new();
        let surface = mesh::sheet(SIZE, Cells::Quads, Vector3::zeros(), Vector3::x(), Vector3::z());
        builder.cloth(nucleus_core::Cloth::new(surface, Mass::PerArea(DENSITY), lists))?;
        let mut solver = Solver::<f32>::new(builder, 1);
        passes = solver.passes(input);
        solver.step(input, &mut ());
        let (spent, ()) = Spent::on(|| {
            (0..FRAMES).for_each(|_| {
                solver.step(input, &mut ());
            });
        });
        times.push(1e3 * spent.processor / f64::from(FRAMES));
    }
    times.sort_by(f64::total_cmp);
    Ok((times[times.len() / 2], passes))
}

/// Adds the features one by one.
///
/// # Errors
/// When the solver refuses the sheet.
pub fn run(repeat: u32, report: &mut Report) -> anyhow::Result<()> {
    let head = ["with", "rows", "passes", "ms", "more ms", "list built, set to 0: more ms"];
    let mut table = Table::new("Only what a scene needs, one thread, 48 evaluations", &head);
    let mut input = frame(&Setting { resistance: 0.0, bend: 0.0, evaluations: 48 });
    input.cloths[0] = ClothFrame { compression_resistance: 0.0, ..input.cloths[0] };
    let mut lists = ClothLists::NONE;
    let (mut before, passes) = measure(lists, &input, repeat)?;
    table.row(cells("points alone", &passes, before, 0.0, None));
    for (name, list, set) in FEATURES {
        list(&mut lists);
        // What is built but set to nought is not swept.
        let is_set_apart = !matches!(name, "cross links" | "ground");
        let off = if is_set_apart { Some(measure(lists, &input, repeat)?.0 - before) } else { None };
        set(&mut input);
        let (ms, passes) = measure(lists, &input, repeat)?;
        table.row(cells(name, &passes, ms, ms - before, off));
        before = ms;
    }
    table
        .note("What is off has no rows and no passes: tests hold the solver to it. Time is the processor's.");
    report.show(table);
    Ok(())
}

fn cells(name: &str, passes: &[PassCost], ms: f64, more: f64, off: Option<f64>) -> [String; 6] {
    let rows: usize = passes.iter().map(|pass| pass.rows).sum();
    let off = off.map_or_else(String::new, figure);
    [name.to_owned(), rows.to_string(), passes.len().to_string(), figure(ms), figure(more), off]
}
