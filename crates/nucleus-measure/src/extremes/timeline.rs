//! Timeline of a run: figures of every frame, and initial and final positions.

use nalgebra::Vector3;
use nucleus_core::{ClothId, Real, StepReport};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{ObjectKind, Program};

use super::energy_budget::{Energy, EnergyBudget};
use super::scene::FaultInjection;
use crate::clock::{Clock, Stopwatch};
use crate::metrics::max_or_nan;

/// Figures at the end of a frame.
#[derive(Debug, Clone, Copy)]
pub struct FrameRecord {
    /// The frame.
    pub frame: i64,
    /// Report of the solver.
    pub report: StepReport,
    /// Speed, and kinetic energy relative to its bound.
    pub energy: Energy,
}

/// A measured run.
#[derive(Debug, Clone, Default)]
pub struct Timeline {
    /// All solved frames.
    pub frames: Vec<FrameRecord>,
    /// Initial positions of all cloths, in metres.
    pub start: Vec<Vec<Vector3<f64>>>,
    /// Final positions of all cloths, in metres.
    pub end: Vec<Vec<Vector3<f64>>>,
    /// Processor time of all frames, in seconds.
    pub seconds: f64,
    /// Time steps, over all frames.
    pub steps: f64,
    /// Evaluated rows, over all frames.
    pub evaluations: f64,
    /// The frame after which the run was aborted, if it was.
    pub aborted_after: Option<i64>,
}

impl Timeline {
    /// Runs a program on one thread. `inject` changes the input of frames. `initial_energy` is the energy of the initial
    /// state in joules, besides potential and elastic energy. Aborts when `should_continue` returns false after a frame.
    pub fn of<R: Real>(
        program: &Program,
        inject: Option<FaultInjection>,
        initial_energy: f64,
        should_continue: &dyn Fn(&Self) -> bool,
    ) -> Self {
        let mut simulation = Simulation::<R>::new(program, 1);
        let points = cloths(program);
        let mut book = EnergyBudget::new(simulation.solver(), &points, initial_energy);
        let mut timeline = Timeline { start: places(&simulation, &points), ..Timeline::default() };
        while !simulation.is_done() {
            let frame = simulation.frame() + 1;
            let (mut steps, mut evaluations) = (0.0, 0.0);
            let start = || Stopwatch::start(Clock::Thread);
            let watch = std::cell::OnceCell::new();
            let record = simulation.advance_with(
                &mut |solver, input| {
                    if let Some(inject) = inject {
                        inject(frame, input);
                    }
                    book.begin(solver, input);
                    let passes = solver.passes(input);
                    steps = passes.iter().find(|pass| pass.name == "predict").map_or(0.0, |pass| pass.sweeps);
                    evaluations = passes.iter().map(nucleus_core::PassCost::evaluations).sum();
                    watch.get_or_init(start);
                },
                &mut (),
            );
            timeline.seconds += watch.get_or_init(start).elapsed().processor;
            timeline.steps += steps;
            timeline.evaluations += evaluations;
            let energy = book.end(simulation.solver());
            timeline.frames.push(FrameRecord { frame, report: record.report, energy });
            if !should_continue(&timeline) {
                timeline.aborted_after = Some(frame);
                break;
            }
        }
        timeline.end = places(&simulation, &points);
        timeline
    }
}

/// Number of points of each cloth.
fn cloths(program: &Program) -> Vec<usize> {
    let cloths = program.objects().iter().filter(|object| matches!(object.kind, ObjectKind::Cloth(_)));
    cloths.map(|object| object.points).collect()
}

fn places<R: Real>(simulation: &Simulation<R>, points: &[usize]) -> Vec<Vec<Vector3<f64>>> {
    let of = |(cloth, &count): (usize, &usize)| {
        (0..count).map(|point| simulation.state().point(ClothId(cloth as u32), point)).collect()
    };
    points.iter().enumerate().map(of).collect()
}

impl Timeline {
    /// Maximum of a figure over all frames.
    pub fn max(&self, figure: impl Fn(&FrameRecord) -> f64) -> f64 {
        self.frames.iter().map(figure).fold(0.0, max_or_nan)
    }

    /// Maximum of a figure from a frame on.
    pub fn max_from(&self, frame: i64, figure: impl Fn(&FrameRecord) -> f64) -> f64 {
        self.frames.iter().filter(|record| record.frame >= frame).map(figure).fold(0.0, max_or_nan)
    }

    /// Sum of a counter over all frames.
    pub fn sum(&self, figure: impl Fn(&FrameRecord) -> u64) -> u64 {
        self.frames.iter().map(figure).sum()
    }

    /// Whether every frame was finite.
    pub fn is_finite(&self) -> bool {
        self.frames.iter().all(|record| record.report.finite && record.energy.speed.is_finite())
    }

    /// Largest displacement of a point from start to end, in metres.
    pub fn farthest_from_start(&self) -> f64 {
        farthest(&self.start, &self.end)
    }

    /// Largest distance of final positions from those of another run, in metres.
    pub fn farthest_from(&self, other: &Self) -> f64 {
        farthest(&self.end, &other.end)
    }

    /// Largest difference of displacements from those of another run, in metres: invariant under a translation of the scene.
    pub fn farthest_moves_from(&self, other: &Self) -> f64 {
        let displacements = |timeline: &Self| {
            let pairs = timeline.end.iter().flatten().zip(timeline.start.iter().flatten());
            vec![pairs.map(|(end, start)| end - start).collect::<Vec<_>>()]
        };
        farthest(&displacements(self), &displacements(other))
    }

    /// Height of the lowest final position, in metres.
    pub fn lowest(&self) -> f64 {
        self.end.iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min)
    }
}

fn farthest(a: &[Vec<Vector3<f64>>], b: &[Vec<Vector3<f64>>]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).norm()).fold(0.0, max_or_nan)
}
