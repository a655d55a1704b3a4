//! How a run went, frame by frame.

use nalgebra::Vector3;
use nucleus_core::{ClothId, Real, StepReport};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{ObjectKind, Program};

use super::energy_budget::{Energy, EnergyBudget};
use super::scene::FaultInjection;
use crate::clock::{Clock, Stopwatch};
use crate::metrics::max_or_nan;

/// What was seen at the end of a frame.
#[derive(Debug, Clone, Copy)]
pub struct FrameRecord {
    /// The frame.
    pub frame: i64,
    /// What the solver said.
    pub report: StepReport,
    /// How fast it is, and how much energy it has.
    pub energy: Energy,
}

/// A run, measured.
#[derive(Debug, Clone, Default)]
pub struct Timeline {
    /// Every frame that was solved.
    pub frames: Vec<FrameRecord>,
    /// Where the points of all cloths were when it began, in metres.
    pub start: Vec<Vec<Vector3<f64>>>,
    /// Where they are in the end.
    pub end: Vec<Vec<Vector3<f64>>>,
    /// Processor time of all frames in seconds.
    pub seconds: f64,
    /// Time steps of all frames.
    pub steps: f64,
    /// Rows evaluated in all frames.
    pub evaluations: f64,
    /// The frame after which it was given up, if it was.
    pub aborted_after: Option<i64>,
}

impl Timeline {
    /// Runs a program on one thread. `inject` changes what frames bring; `initial_energy` is what the start holds in joules,
    /// besides what falls and is stretched. After each frame `should_continue` says whether there is to be another.
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

/// How many points each cloth has.
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
    /// The worst of a figure over all frames.
    pub fn most(&self, figure: impl Fn(&FrameRecord) -> f64) -> f64 {
        self.frames.iter().map(figure).fold(0.0, max_or_nan)
    }

    /// The worst of a figure from a frame on.
    pub fn most_from(&self, frame: i64, figure: impl Fn(&FrameRecord) -> f64) -> f64 {
        self.frames.iter().filter(|record| record.frame >= frame).map(figure).fold(0.0, max_or_nan)
    }

    /// A count over all frames.
    pub fn sum(&self, figure: impl Fn(&FrameRecord) -> u64) -> u64 {
        self.frames.iter().map(figure).sum()
    }

    /// Whether every frame was finite.
    pub fn is_finite(&self) -> bool {
        self.frames.iter().all(|record| record.report.finite && record.energy.speed.is_finite())
    }

    /// The farthest that any point is in the end from where it began, in metres.
    pub fn farthest_from_start(&self) -> f64 {
        farthest(&self.start, &self.end)
    }

    /// The farthest that any point is in the end from where another run has it, in metres.
    pub fn farthest_from(&self, other: &Self) -> f64 {
        farthest(&self.end, &other.end)
    }

    /// The farthest that the way of any point from its start is from its way in another run, in metres: the same
    /// scene put elsewhere is to move in the same way.
    pub fn farthest_moves_from(&self, other: &Self) -> f64 {
        let ways = |timeline: &Self| {
            let pairs = timeline.end.iter().flatten().zip(timeline.start.iter().flatten());
            vec![pairs.map(|(end, start)| end - start).collect::<Vec<_>>()]
        };
        farthest(&ways(self), &ways(other))
    }

    /// The lowest point in the end, in metres.
    pub fn lowest(&self) -> f64 {
        self.end.iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min)
    }
}

fn farthest(a: &[Vec<Vector3<f64>>], b: &[Vec<Vector3<f64>>]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).norm()).fold(0.0, max_or_nan)
}
