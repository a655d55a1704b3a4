//! Particles by number and kind, on every number of threads: free ones among colliders, grains that collide with each
//! other, and a liquid.

use nalgebra::Vector3;
use nucleus_core::{
    Cloth, ClothFrame, ClothLists, Collider, ColliderFrame, Elements, Faces, FrameInput, GroundPlane, Liquid,
    Mass, ModelBuilder, Particles, ResistanceModel, SelfCollision, Solver, Surface,
};
use nucleus_measure::clock::{StageClock, Timing};

use super::mesh;
use super::report::Report;
use super::table::{StageRow, Table, figure};
use super::workload::GRAVITY;

type Vec3 = Vector3<f64>;

/// Numbers of particles.
const COUNTS: [u32; 3] = [10_000, 100_000, 1_000_000];

/// Target of a frame of a million free particles in milliseconds, on one core.
const FREE_TARGET: f64 = 60.0;
/// Tolerance of linear growth, from the second number of particles to the last.
const CHANCE: f64 = 1.1;

/// How particles act on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Free,
    Colliding,
    Liquid,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Free, Self::Colliding, Self::Liquid];

    fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Colliding => "colliding",
            Self::Liquid => "liquid",
        }
    }

    /// Frames that are timed, after half as many that are not.
    fn frames(self, count: u32) -> u32 {
        match (self, count) {
            (Self::Free, _) => 24,
            (Self::Colliding, _) => 4,
            (Self::Liquid, ..=100_000) => 4,
            (Self::Liquid, _) => 2,
        }
    }

    /// Distance of particles at the start in metres, for so many along a side.
    fn spacing(self, side: u32) -> f64 {
        if self == Self::Free { 2.0 / f64::from(side) } else { 0.02 }
    }
}

/// A timed run.
struct Run {
    kind: Kind,
    count: u32,
    threads: u32,
    /// Milliseconds per frame: processor time with one thread, wall time with more.
    ms: f64,
    /// Largest mean excess of density over the timed frames.
    density_error: f64,
    shares: [f64; nucleus_measure::clock::STAGES.len()],
    hash: u64,
}

impl Run {
    fn nanoseconds(&self) -> f64 {
        self.ms * 1e6 / f64::from(self.count)
    }
}

/// Times all kinds and numbers of particles.
///
/// # Errors
/// When the solver rejects a scene, or threads change a bit.
pub fn run(threads: &[u32], report: &mut Report) -> anyhow::Result<()> {
    let mut runs = Vec::new();
    for kind in Kind::ALL {
        for count in COUNTS {
            let first = runs.len();
            for &threads in threads {
                let run = time(kind, count, threads)?;
                eprintln!("{} {count}, threads {threads}: {:.2} ms per frame", kind.name(), run.ms);
                runs.push(run);
            }
            let same = runs[first..].iter().all(|run| run.hash == runs[first].hash);
            anyhow::ensure!(same, "{} {count}: threads change the state", kind.name());
        }
    }
    report.show(table(&runs));
    let alone = || runs.iter().filter(|run| run.threads == 1);
    let stages: Vec<StageRow> = alone()
        .map(|run| (vec![run.kind.name().to_owned(), run.count.to_string()], run.ms, run.shares))
        .collect();
    report.show(Table::by_stage(
        "Particles: milliseconds per frame by stage, one thread",
        &["kind", "particles"],
        &stages,
    ));
    for kind in Kind::ALL {
        let of_kind: Vec<&Run> = alone().filter(|run| run.kind == kind).collect();
        if let [_, middle, most] = of_kind[..] {
            check_targets(kind, middle, most, report);
        }
    }
    Ok(())
}

fn table(runs: &[Run]) -> Table {
    let head = ["kind", "particles", "threads", "ms", "ns per particle", "density error %", "hash"];
    let mut table = Table::new("Particles", &head);
    for run in runs {
        let names = [run.kind.name().to_owned(), run.count.to_string(), run.threads.to_string()];
        let error = if run.kind == Kind::Liquid { figure(1e2 * run.density_error) } else { String::new() };
        let cells = [figure(run.ms), figure(run.nanoseconds()), error, format!("{:016x}", run.hash)];
        table.row(names.into_iter().chain(cells));
    }
    table.note(
        "Free particles fall on a ball and the ground and do not collide with each other, at one substep and one collision \
         pass. Colliding ones are loose grains that fall into a heap, at four. The liquid is a block of water on the \
         ground, of which a side collapses.",
    );
    table
}

fn check_targets(kind: Kind, middle: &Run, most: &Run, report: &mut Report) {
    let ratio = most.nanoseconds() / middle.nanoseconds();
    let target =
        format!("{}: time per particle at {} no more than at {}", kind.name(), most.count, middle.count);
    report.check_target(target, format!("{} times", figure(ratio)), ratio <= CHANCE);
    if kind == Kind::Free {
        let target = format!("{} free particles on a ball and the ground below {FREE_TARGET} ms", most.count);
        report.check_target(target, format!("{} ms", figure(most.ms)), most.ms < FREE_TARGET);
    }
}

fn time(kind: Kind, count: u32, threads: u32) -> anyhow::Result<Run> {
    let side = f64::from(count).cbrt().ceil() as u32;
    let spacing = kind.spacing(side);
    let mut solver = Solver::<f32>::new(scene(kind, count, side)?, threads as usize);
    let input = input(kind, spacing);
    let frames = kind.frames(count);
    (0..frames / 2).for_each(|_| _ = solver.step(&input, &mut ()));
    let (mut stages, mut density_error) = (StageClock::default(), 0.0f64);
    let (timing, ()) = Timing::of_process(|| {
        for _ in 0..frames {
            density_error = density_error.max(solver.step(&input, &mut stages).density_error);
            stages.stop();
        }
    });
    let seconds = if threads == 1 { timing.processor } else { timing.wall };
    let ms = 1e3 * seconds / f64::from(frames);
    Ok(Run { kind, count, threads, ms, density_error, shares: stages.shares(), hash: solver.state_hash() })
}

fn scene(kind: Kind, count: u32, side: u32) -> anyhow::Result<ModelBuilder> {
    let spacing = kind.spacing(side);
    let place = |k: u32| {
        let [x, y, z] = [k % side, k / (side * side), k / side % side].map(|n| f64::from(n) * spacing);
        match kind {
            Kind::Free => Vec3::new(x - 1.0, y + 0.6, z - 1.0),
            Kind::Colliding | Kind::Liquid => Vec3::new(x, y - 0.49, z),
        }
    };
    let surface = Surface { positions: (0..count).map(place).collect(), faces: Faces::default() };
    let particles = Some(Particles { capacity: count as usize, ..Particles::default() });
    let lists = ClothLists { self_collision: kind == Kind::Colliding, ..ClothLists::NONE };
    let mass = Mass::PerPoint(if kind == Kind::Free { 1e-3 } else { 1000.0 * spacing.powi(3) });
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth { particles, ..Cloth::new(surface, mass, lists) })?;
    builder.collider(Collider { surface: mesh::sphere(0.5, Vec3::zeros()) })?;
    Ok(builder)
}

fn input(kind: Kind, spacing: f64) -> FrameInput {
    let radius = match kind {
        Kind::Free => 0.002,
        Kind::Colliding => 0.48 * spacing,
        Kind::Liquid => 0.4 * spacing,
    };
    let water = Liquid { spacing, incompressibility: 1.0, viscosity: 0.0, surface_tension: 0.0 };
    let own = SelfCollision { on: true, thickness: radius, elements: Elements::Points, edges: false };
    let balls = ClothFrame {
        thickness: radius,
        elements: Elements::Points,
        self_collision: if kind == Kind::Colliding { own } else { SelfCollision::OFF },
        liquid: (kind == Kind::Liquid).then_some(water),
        ..ClothFrame::default()
    };
    let plane = GroundPlane { friction: 0.2, ..GroundPlane::new(-Vec3::y() * 0.5, Vec3::y()) };
    let collider = ColliderFrame {
        collide: kind == Kind::Free,
        thickness: 0.001,
        friction: 0.2,
        ..ColliderFrame::default()
    };
    FrameInput {
        resistance: ResistanceModel::Classic,
        substeps: 1,
        collision_iterations: if kind == Kind::Colliding { 4.0 } else { 1.0 },
        gravity: -Vec3::y() * GRAVITY,
        plane: Some(plane),
        cloths: vec![balls],
        colliders: vec![collider],
        ..FrameInput::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_bits_come_from_any_number_of_threads() {
        for kind in Kind::ALL {
            let [one, two] = [1, 2].map(|threads| time(kind, 600, threads).expect("a valid scene"));
            assert_eq!(one.hash, two.hash, "{kind:?}");
            assert!(one.density_error < 0.01, "{kind:?}: {}", one.density_error);
        }
    }
}
