//! Wall time and processor time, in total and by stage; and the machine they are measured on.

use std::time::{Duration, Instant};
use std::{env, fs, thread};

use nucleus_core::{Stage, StateView, StepObserver, SubstepIndex};

/// The stages of a frame and their names in tables.
pub const STAGES: [(Stage, &str); 9] = [
    (Stage::FrameStart, "start"),
    (Stage::Normals, "normals"),
    (Stage::Predict, "predict"),
    (Stage::Constraints, "relax"),
    (Stage::BroadPhase, "pairs"),
    (Stage::Contact, "collide"),
    (Stage::Velocity, "velocity"),
    (Stage::Observe, "watch"),
    (Stage::Report, "report"),
];

/// Scope of a processor-time clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// All threads of the process.
    Process,
    /// The calling thread; work on other threads does not count.
    Thread,
}

impl Clock {
    /// Processor time used so far; `None` on systems that do not report it.
    pub fn read(self) -> Option<Duration> {
        #[cfg(target_os = "linux")]
        {
            let id = match self {
                Self::Process => rustix::time::ClockId::ProcessCPUTime,
                Self::Thread => rustix::time::ClockId::ThreadCPUTime,
            };
            let time = rustix::time::clock_gettime(id);
            Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
        }
        #[cfg(not(target_os = "linux"))]
        None
    }
}

/// Duration of a piece of work.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Timing {
    /// Wall time in seconds.
    pub wall: f64,
    /// Processor time in seconds; wall time on systems that do not report it.
    pub processor: f64,
}

impl Timing {
    /// Runs some work and measures it, with the processor time of all threads of the process.
    pub fn of_process<T>(work: impl FnOnce() -> T) -> (Self, T) {
        Self::measure(Clock::Process, work)
    }

    /// Runs some work and measures it, with the processor time of `clock`.
    pub fn measure<T>(clock: Clock, work: impl FnOnce() -> T) -> (Self, T) {
        let watch = Stopwatch::start(clock);
        let result = work();
        (watch.elapsed(), result)
    }
}

/// Measures the time since its start.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    clock: Clock,
    start: Instant,
    processor: Option<Duration>,
}

impl Stopwatch {
    /// Starts now.
    pub fn start(clock: Clock) -> Self {
        Self { clock, start: Instant::now(), processor: clock.read() }
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Timing {
        let (after, wall) = (self.clock.read(), self.start.elapsed());
        let processor =
            self.processor.zip(after).map_or(wall, |(before, after)| after.saturating_sub(before));
        Timing { wall: wall.as_secs_f64(), processor: processor.as_secs_f64() }
    }
}

/// Observer that sums the wall time of each stage. Reading the processor clock costs more than some stages, so only
/// the shares of the stages are meaningful on a loaded machine.
#[derive(Debug, Default)]
pub struct StageClock {
    now: Option<(Stage, Instant)>,
    spent: [Duration; STAGES.len()],
}

impl StageClock {
    /// Ends the running stage. Call it at the end of a frame.
    pub fn stop(&mut self) {
        self.switch(None, Instant::now());
    }

    /// Share of each of [`STAGES`] in the total time, in their order; 0 if nothing ran.
    pub fn shares(&self) -> [f64; STAGES.len()] {
        let all: f64 = self.spent.iter().map(Duration::as_secs_f64).sum();
        self.spent.map(|spent| if all > 0.0 { spent.as_secs_f64() / all } else { 0.0 })
    }

    fn switch(&mut self, next: Option<Stage>, at: Instant) {
        if let Some((stage, entered)) = self.now {
            let index = STAGES.iter().position(|(named, _)| *named == stage);
            index.into_iter().for_each(|index| self.spent[index] += at - entered);
        }
        self.now = next.map(|stage| (stage, at));
    }
}

impl StepObserver for StageClock {
    fn substep(&mut self, _moment: SubstepIndex, _state: &dyn StateView) {}

    fn observes_substeps(&self) -> bool {
        false
    }

    fn enter(&mut self, stage: Stage) {
        self.switch(Some(stage), Instant::now());
    }
}

/// The machine: cores, processor, cache and load, one line each.
pub fn describe_machine() -> Vec<String> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let processors = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = field(&processors, "model name").unwrap_or("unknown processor");
    let mut lines = vec![format!("Machine: {cores} cores, {name}, {}.", env::consts::ARCH)];
    if let Some(cache) = field(&processors, "cache size") {
        lines.push(format!("Last cache: {cache}."));
    }
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    if let Some(load) = load.split_whitespace().next() {
        lines.push(format!("Load at the start: {load}; above 0, other programs were running."));
    }
    lines
}

/// A field of the first processor in `/proc/cpuinfo`.
fn field<'a>(processors: &'a str, name: &str) -> Option<&'a str> {
    let (_, value) =
        processors.lines().filter_map(|line| line.split_once(':')).find(|(key, _)| key.trim() == name)?;
    Some(value.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_is_attributed_to_the_stage_entered_last() {
        let (mut clock, start) = (StageClock::default(), Instant::now());
        let at = |ms| start + Duration::from_millis(ms);
        clock.switch(Some(Stage::Predict), at(0));
        clock.switch(Some(Stage::Constraints), at(1));
        clock.switch(Some(Stage::Predict), at(7));
        clock.switch(None, at(8));
        clock.switch(Some(Stage::Constraints), at(100)); // time between frames is not counted
        clock.switch(None, at(102));
        let share = |stage| clock.shares()[STAGES.iter().position(|(named, _)| *named == stage).unwrap()];
        assert_eq!(
            (share(Stage::Predict), share(Stage::Constraints), share(Stage::Contact)),
            (0.2, 0.8, 0.0)
        );
    }

    #[test]
    fn both_clocks_advance_during_work() {
        for clock in [Clock::Process, Clock::Thread] {
            let (spent, steps) = Timing::measure(clock, || {
                let start = Instant::now();
                (0u64..).take_while(|_| start.elapsed() < Duration::from_millis(30)).count()
            });
            assert!(steps > 0 && spent.wall >= 0.03 && spent.processor > 0.0, "{spent:?}");
        }
    }

    #[test]
    fn a_sleeping_thread_uses_no_processor_time() {
        let (spent, ()) = Timing::measure(Clock::Thread, || thread::sleep(Duration::from_millis(30)));
        assert!(spent.processor < 0.02 || Clock::Thread.read().is_none(), "{spent:?}");
    }

    #[test]
    fn fields_are_read_from_the_first_processor() {
        let text =
            "processor\t: 0\nmodel name\t: A: one\nflags\t\t: x\n\nprocessor\t: 1\nmodel name\t: Another\n";
        assert_eq!(field(text, "model name"), Some("A: one"));
        assert_eq!(field(text, "cache size"), None);
    }
}
