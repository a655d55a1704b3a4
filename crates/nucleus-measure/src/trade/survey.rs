//! A survey: one run of the whole scene at its own setting, to find the frames that a comparison has to include.
//!
//! Errors of the first second say nothing about a sheet that lands in the next. Cloth needs accuracy where it is stretched, so
//! the comparison goes on until the strain of the survey has come close to its largest.

use nucleus_graph::Simulation;
use serde::{Deserialize, Serialize};

use super::benchmark::{Benchmark, TradeError};
use super::run::all_points;
use super::setting::Setting;
use crate::result_cache::ResultCache;

/// List of the surveys of a scene.
const LIST: &str = "surveys.jsonl";

/// Share of the largest strain that counts as close to it.
const CLOSE: f64 = 0.9;
/// Strain below which cloth counts as unstretched.
const UNSTRETCHED: f64 = 1e-3;
/// Seconds that a comparison goes on after the frame of the largest strain, where the errors of that frame show.
const AFTER: f64 = 0.25;

/// The strain of every frame of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Survey {
    /// The setting.
    pub setting: Setting,
    /// Frames that were asked for, without the start.
    pub asked: usize,
    /// 99th percentile of the strains of all edges in each frame after the start; fewer if one was not finite.
    pub strains: Vec<f64>,
}

impl Survey {
    /// Runs the scene on `threads`, or loads the run from `cache`.
    ///
    /// # Errors
    /// When it cannot be loaded or saved, and when `should_continue`, which gets the share that is done, returns false.
    pub fn of(
        benchmark: &Benchmark,
        threads: usize,
        cache: &ResultCache,
        should_continue: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Self, TradeError> {
        let (setting, asked) = (benchmark.own(), benchmark.frames());
        let is_same = |survey: &Self| (survey.setting, survey.asked) == (setting, asked);
        if let Some(kept) = cache.list::<Self>(LIST)?.into_iter().find(is_same) {
            return Ok(kept);
        }
        let mut simulation: Simulation = Simulation::new(benchmark.program(), threads);
        let (mut points, mut strains) = (Vec::new(), Vec::new());
        for frame in 0..asked {
            if !should_continue(frame as f64 / asked as f64) {
                return Err(TradeError::Interrupted);
            }
            if !simulation.advance(&mut ()).report.finite {
                break;
            }
            all_points(&simulation, &mut points);
            strains.push(benchmark.strain(&points).p99.max(0.0));
        }
        let survey = Self { setting, asked, strains };
        cache.append(LIST, &survey)?;
        Ok(survey)
    }

    /// The first frame whose strain is close to the largest, counted from the start; `None` where nothing is stretched.
    pub fn busiest(&self) -> Option<usize> {
        let most = self.strains.iter().copied().fold(0.0, f64::max);
        let found = self.strains.iter().position(|&strain| strain >= CLOSE * most)?;
        (most > UNSTRETCHED).then_some(found + 1)
    }

    /// The frames, without the start, that a comparison has to include: `least`, or up to a moment after the busiest.
    pub fn frames(&self, least: usize, fps: f64) -> usize {
        let after = (AFTER * fps).ceil() as usize;
        self.busiest().map_or(least, |busiest| least.max(busiest + after)).min(self.asked)
    }
}

#[cfg(test)]
mod tests {
    use super::super::curve::tests::point;
    use super::*;

    fn survey(strains: Vec<f64>) -> Survey {
        Survey { setting: point(96.0, 0.0).setting, asked: strains.len(), strains }
    }

    #[test]
    fn a_comparison_goes_on_until_the_cloth_is_stretched_most() {
        let landing = survey((1..=60).map(|frame| if frame == 38 { 0.02 } else { 1e-4 }).collect());
        assert_eq!((landing.busiest(), landing.frames(24, 24.0)), (Some(38), 44));
        let at_the_end = survey((1..=60).map(|frame| if frame == 59 { 0.02 } else { 1e-4 }).collect());
        assert_eq!(at_the_end.frames(24, 24.0), 60, "the scene has no more");
        let hanging = survey((1..=60).map(|frame| 0.02 + 1e-4 * f64::from(frame)).collect());
        assert_eq!((hanging.busiest(), hanging.frames(24, 24.0)), (Some(35), 41));
        let soon = survey((1..=60).map(|frame| if frame == 3 { 0.02 } else { 0.017 }).collect());
        assert_eq!(soon.frames(24, 24.0), 24);
    }

    #[test]
    fn cloth_that_is_not_stretched_has_no_busiest_frame() {
        assert_eq!(survey(vec![1e-5; 60]).frames(24, 24.0), 24);
        assert_eq!(survey(Vec::new()).busiest(), None);
    }
}
