//! Each effect of a cloth alone on a sheet of 129² points: its cost beside the plain sheet, and its memory.

use nalgebra::Vector3;
use nucleus_core::{
    BendSolver, Bending, Cloth, ClothFrame, ClothId, ClothLists, FieldSide, ForceField, FrameInput,
    InputAttract, InputMesh, LinkOrder, Mass, ModelBuilder, PointField, Pressure, Solver, WindField,
};

use super::super::mesh::{self, Cells};
use super::super::table::{Table, figure};
use super::super::workload::{DENSITY, Setting, Variant, frame};
use nucleus_measure::clock::Timing;

/// Points along each side of the sheet.
const SIZE: u32 = 129;
/// The plain sheet and the one with the effect take turns, so many frames each.
const ROUNDS: u32 = 3;
const FRAMES: u32 = 2;

/// A cloth of the bench, and the input of its frames.
pub struct Sheet {
    cloth: Cloth,
    order: LinkOrder,
    input: FrameInput,
}

/// An effect: its name, and what it changes of the plain sheet.
pub type Effect = (&'static str, fn(&mut Sheet));

/// A pressure that changes nothing but the cost.
const GAS: Pressure =
    Pressure::Gas { start: 0.0, bulk: 10.0, pump: 0.0, tightness: 1.0, damping: 1.0, sealed: true };

/// The effects, in the order of the table.
pub const EFFECTS: [Effect; 17] = [
    ("signed rest angles", |sheet| {
        sheet.cloth.lists.bend_angles = true;
        sheet.settings().bending = Bending { solver: BendSolver::Signed, ..Bending::DEFAULT };
    }),
    ("flip tracking", |sheet| {
        sheet.cloth.lists.bend_angles = true;
        sheet.settings().bending = Bending { solver: BendSolver::FlipTracking, ..Bending::DEFAULT };
    }),
    ("restitution angle", |sheet| {
        sheet.cloth.lists.bend_angles = true;
        sheet.settings().bending =
            Bending { yield_sine: 0.5, yield_half_angle: std::f64::consts::PI / 6.0, ..Bending::DEFAULT };
    }),
    ("restitution tension", |sheet| {
        sheet.cloth.lists.plastic = true;
        sheet.settings().yield_strain = 0.1;
    }),
    ("parallel links", |sheet| sheet.order = LinkOrder::Parallel),
    ("pressure", |sheet| {
        sheet.cloth.lists.pressure = true;
        sheet.settings().pressure = GAS;
    }),
    ("rigidity", |sheet| {
        sheet.cloth.lists.shape = true;
        sheet.settings().rigidity = 1.0;
    }),
    ("deform resistance", |sheet| {
        sheet.cloth.lists.shape = true;
        sheet.settings().deform_resistance = 1.0;
    }),
    ("input mesh attract", |sheet| {
        sheet.settings().input_attract = InputAttract { strength: 0.1, damp: 0.5, motion_drag: 0.0 };
        let start = sheet.cloth.surface.positions.clone();
        let end = start.clone();
        sheet.input.input_meshes = vec![InputMesh { cloth: ClothId(0), start, end }];
    }),
    ("drag", |sheet| sheet.breathe(0.0)),
    ("drag and lift", |sheet| sheet.breathe(0.05)),
    ("drag in gusts", |sheet| {
        sheet.breathe(0.0);
        sheet.input.wind_noise = 0.5;
    }),
    ("drag in its own shadow", |sheet| {
        sheet.breathe(0.0);
        sheet.settings().wind_field = WindField { shadow_distance: 0.5, self_shadow: true, ..WindField::OFF };
    }),
    ("point field", |sheet| {
        let spacing = 1.0 / f64::from(SIZE - 1);
        let falloff = [1.0; ForceField::SAMPLES];
        sheet.settings().point_field = Some(PointField {
            magnitude: 0.0,
            self_attract: 1e-3,
            radius: spacing,
            distance: spacing,
            falloff,
        });
    }),
    ("force field", |sheet| {
        let falloff = [1.0; ForceField::SAMPLES];
        let (side, distance) = (FieldSide::Double, 0.1);
        sheet.settings().field = Some(ForceField { side, magnitude: 1e-3, distance, falloff });
    }),
    ("stretch map", |sheet| {
        sheet.cloth.vertex_maps.stretch = sheet.map();
    }),
    ("drag with a map", |sheet| {
        sheet.breathe(0.0);
        sheet.cloth.vertex_maps.drag = sheet.map();
    }),
];

impl Sheet {
    /// Stretch, bending and damping, without contact or air.
    fn plain() -> Self {
        let surface = mesh::sheet(SIZE, Cells::Quads, Vector3::zeros(), Vector3::x(), Vector3::z());
        let lists =
            ClothLists { stretch: true, cross_links: true, bend: true, damp: true, ..ClothLists::NONE };
        let mut input =
            frame(&Setting { resistance: 20.0, bend: 0.1, evaluations: 48, variant: Variant::Plain });
        input.cloths[0] = ClothFrame { stretch_damp: 0.1, collide: false, ..input.cloths[0] };
        Self {
            cloth: Cloth::new(surface, Mass::PerArea(DENSITY), lists),
            order: LinkOrder::Sequential,
            input,
        }
    }

    fn settings(&mut self) -> &mut ClothFrame {
        &mut self.input.cloths[0]
    }

    /// Drag in a light wind.
    fn breathe(&mut self, lift: f64) {
        self.cloth.lists.air = true;
        self.input.air_density = 1.0;
        self.input.wind = Vector3::new(0.5, 0.2, 0.1);
        *self.settings() = ClothFrame { drag: 0.05, lift, ..*self.settings() };
    }

    /// Factors that differ from point to point.
    fn map(&self) -> Vec<f64> {
        (0..self.cloth.surface.positions.len()).map(|k| 0.5 + 0.5 * (k % 7) as f64 / 6.0).collect()
    }

    fn solver(&self) -> anyhow::Result<Solver<f32>> {
        let mut builder = ModelBuilder::new();
        let cloth = builder.cloth(self.cloth.clone())?;
        builder.set_link_order(cloth, self.order.clone())?;
        Ok(Solver::new(builder, 1))
    }
}

/// A sheet that runs, its processor time, and its memory.
struct Run {
    sheet: Sheet,
    solver: Solver<f32>,
    /// The shortest round in milliseconds per frame.
    ms: f64,
}

impl Run {
    fn new(sheet: Sheet) -> anyhow::Result<Self> {
        let mut solver = sheet.solver()?;
        solver.step(&sheet.input, &mut ());
        Ok(Self { sheet, solver, ms: f64::INFINITY })
    }

    fn go(&mut self) {
        let Self { sheet, solver, ms } = self;
        let (timing, ()) = Timing::of_process(|| {
            (0..FRAMES).for_each(|_| {
                solver.step(&sheet.input, &mut ());
            });
        });
        *ms = ms.min(1e3 * timing.processor / f64::from(FRAMES));
    }

    fn bytes_per_vertex(&self) -> f64 {
        self.solver.memory() as f64 / f64::from(SIZE * SIZE)
    }
}

/// Measures the effects, each against the plain sheet in the same minutes.
///
/// # Errors
/// When the solver rejects the sheet.
pub fn table() -> anyhow::Result<Table> {
    let head = ["alone", "ms", "times the plain sheet", "bytes a vertex", "more bytes"];
    let mut table = Table::new("Each effect alone on a sheet of 129² points", &head);
    for (name, set) in [("nothing more", (|_| {}) as fn(&mut Sheet))].into_iter().chain(EFFECTS) {
        let mut plain = Run::new(Sheet::plain())?;
        let mut sheet = Sheet::plain();
        set(&mut sheet);
        let mut with = Run::new(sheet)?;
        for _ in 0..ROUNDS {
            plain.go();
            with.go();
        }
        let [bytes, more] = [with.bytes_per_vertex(), with.bytes_per_vertex() - plain.bytes_per_vertex()];
        let cells = [with.ms, with.ms / plain.ms, bytes, more].map(figure);
        table.row([name.to_owned()].into_iter().chain(cells));
    }
    table.note(
        "The plain sheet has stretch, cross links, bending and stretch damping, with 48 evaluations per 1/24 s. Both sheets \
         take turns; of each the fastest round counts. Bytes are those of points and rows, without contact. A force field \
         costs nothing here, because it acts on others only.",
    );
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_adds_a_pass_or_bytes_and_the_plain_sheet_neither() {
        let facts = |set: fn(&mut Sheet)| {
            let mut sheet = Sheet::plain();
            set(&mut sheet);
            let solver = sheet.solver().expect("a valid sheet");
            (solver.passes(&sheet.input), solver.memory())
        };
        let plain = facts(|_| {});
        for (name, set) in EFFECTS.into_iter().filter(|(name, _)| *name != "force field") {
            assert_ne!(facts(set), plain, "{name}");
        }
        assert_eq!(facts(|sheet| sheet.settings().rigidity = 0.0), plain);
    }
}
