//! Clocks: what the machine spends, in all and by stage.

use std::time::{Duration, Instant};

use nucleus_core::{Stage, StateView, StepObserver, SubstepIndex};

/// The stages of a frame with the names that the tables give them.
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

/// Whose processor time is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// That of the whole process, all its threads together.
    Process,
    /// That of the thread that asks: what runs beside it on other threads does not count.
    Thread,
}

impl Clock {
    /// Processor time used so far; nothing where the system does not tell.
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

/// What some work took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spent {
    /// On the wall, in seconds.
    pub wall: f64,
    /// Of the processor, in seconds; as on the wall where the system does not tell.
    pub processor: f64,
}

impl Spent {
    /// Does some work and looks at the clocks before and after: of the processor at that of all threads together.
    pub fn on<T>(work: impl FnOnce() -> T) -> (Self, T) {
        Self::by(Clock::Process, work)
    }

    /// The same, by a clock of one's choice.
    pub fn by<T>(clock: Clock, work: impl FnOnce() -> T) -> (Self, T) {
        let (start, before) = (Instant::now(), clock.read());
        let result = work();
        let (after, wall) = (clock.read(), start.elapsed());
        let processor = before.zip(after).map_or(wall, |(before, after)| after.saturating_sub(before));
        (Self { wall: wall.as_secs_f64(), processor: processor.as_secs_f64() }, result)
    }
}

/// An observer that adds up how long each stage takes. On the wall: looking at the processor's clock would cost
/// more than some stages do, so that only the shares of the stages are of use on a busy machine.
#[derive(Debug, Default)]
pub struct StageClock {
    now: Option<(Stage, Instant)>,
    spent: [Duration; STAGES.len()],
}

impl StageClock {
    /// Ends the stage that is running; to be called when the frame is over.
    pub fn stop(&mut self) {
        self.turn(None, Instant::now());
    }

    /// The share of all time that went into each of [`STAGES`], in their order; nought where nothing ran.
    pub fn shares(&self) -> [f64; STAGES.len()] {
        let all: f64 = self.spent.iter().map(Duration::as_secs_f64).sum();
        self.spent.map(|spent| if all > 0.0 { spent.as_secs_f64() / all } else { 0.0 })
    }

    fn turn(&mut self, next: Option<Stage>, at: Instant) {
        if let Some((stage, entered)) = self.now {
            let index = STAGES.iter().position(|(named, _)| *named == stage);
            index.into_iter().for_each(|index| self.spent[index] += at - entered);
        }
        self.now = next.map(|stage| (stage, at));
    }
}

impl StepObserver for StageClock {
    fn substep(&mut self, _moment: SubstepIndex, _state: &dyn StateView) {}

    fn enter(&mut self, stage: Stage) {
        self.turn(Some(stage), Instant::now());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_moment_goes_to_the_stage_that_was_entered_last() {
        let (mut clock, start) = (StageClock::default(), Instant::now());
        let at = |ms| start + Duration::from_millis(ms);
        clock.turn(Some(Stage::Predict), at(0));
        clock.turn(Some(Stage::Constraints), at(1));
        clock.turn(Some(Stage::Predict), at(7));
        clock.turn(None, at(8));
        clock.turn(Some(Stage::Constraints), at(100)); // what lies between frames counts for none
        clock.turn(None, at(102));
        let share = |stage| clock.shares()[STAGES.iter().position(|(named, _)| *named == stage).unwrap()];
        assert_eq!(
            (share(Stage::Predict), share(Stage::Constraints), share(Stage::Contact)),
            (0.2, 0.8, 0.0)
        );
    }

    #[test]
    fn work_shows_on_both_clocks() {
        for clock in [Clock::Process, Clock::Thread] {
            let (spent, steps) = Spent::by(clock, || {
                let start = Instant::now();
                (0u64..).take_while(|_| start.elapsed() < Duration::from_millis(30)).count()
            });
            assert!(steps > 0 && spent.wall >= 0.03 && spent.processor > 0.0, "{spent:?}");
        }
    }

    #[test]
    fn a_thread_that_sleeps_spends_nothing_while_another_works() {
        let (spent, ()) = Spent::by(Clock::Thread, || std::thread::sleep(Duration::from_millis(30)));
        assert!(spent.processor < 0.02 || Clock::Thread.read().is_none(), "{spent:?}");
    }
}
