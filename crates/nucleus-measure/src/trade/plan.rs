//! The settings of a sweep and of its references.

use nucleus_graph::Simulation;

use super::benchmark::{Benchmark, TradeError};
use super::curve::{Choice, Trade, Wish};
use super::setting::{Reading, Setting};

/// Requested values; an empty list means values chosen for the scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SweepOptions {
    /// Readings; the scene's own if empty.
    pub readings: Vec<Reading>,
    /// Substeps.
    pub substeps: Vec<u32>,
    /// Collision iterations.
    pub collision_iterations: Vec<u32>,
    /// Physical: evaluations.
    pub evaluations: Vec<f64>,
    /// Classic: factors on the resistances.
    pub resistances: Vec<f64>,
    /// Whether to try the whole grid of settings, against finer references, instead of a few settings and those near the
    /// recommended one.
    pub is_thorough: bool,
}

impl SweepOptions {
    /// Whether the sweep starts with few settings and adds those near the recommended one.
    pub fn is_refined(&self) -> bool {
        !self.is_thorough && self.evaluations.is_empty() && self.substeps.is_empty()
    }
}

/// Default evaluations; extended by doubling up to the scene's own.
const EVALUATIONS: [f64; 5] = [24.0, 48.0, 96.0, 192.0, 384.0];

/// Default substeps, for Physical and for Classic.
const SUBSTEPS: [u32; 3] = [1, 3, 8];
const CLASSIC_SUBSTEPS: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// Default factors on resistances.
const RESISTANCES: [f64; 3] = [0.25, 1.0, 4.0];

/// Evaluations of the two references (step h and step h/2), as multiples of those of the most exact run.
const FINER: [f64; 2] = [2.0, 4.0];

/// The same in a refined sweep, which doubles them if they do not resolve the wanted error.
const FINER_AT_FIRST: [f64; 2] = [1.0, 2.0];

/// Number of default evaluations that a refined sweep starts with.
const EVALUATIONS_AT_FIRST: usize = 4;

/// All settings to run without duplicates, the scene's own first.
///
/// # Errors
/// When the scene does not compile at one of them.
pub fn settings(benchmark: &Benchmark, options: &SweepOptions) -> Result<Vec<Setting>, TradeError> {
    let own = benchmark.own();
    let mut all = vec![own];
    let readings = or_default(&options.readings, || vec![own.reading]);
    for reading in readings {
        let found = match reading {
            Reading::Physical => physical(benchmark, options)?,
            Reading::Classic => classic(benchmark, options),
        };
        for setting in found {
            if all.iter().all(|other| other.key() != setting.key()) {
                all.push(setting);
            }
        }
    }
    Ok(all)
}

/// Settings of the two references, the finer last. `None` if all settings are Classic, which has no limit to converge to:
/// more iterations and more substeps make a different material.
///
/// `finer` are the multiples of the most evaluations.
pub fn references(benchmark: &Benchmark, settings: &[Setting], finer: [f64; 2]) -> Option<[Setting; 2]> {
    let physical = settings.iter().filter(|setting| setting.reading == Reading::Physical);
    let most = physical.clone().map(|setting| setting.evaluations).reduce(f64::max)?;
    let own = benchmark.own();
    let substeps = if own.reading == Reading::Physical { own.substeps.max(3) } else { 3 };
    Some(finer.map(|finer| Setting {
        reading: Reading::Physical,
        substeps: substeps * finer as u32,
        collision_iterations: own.collision_iterations,
        evaluations: most * finer,
        resistance: 1.0,
        tethers: false,
    }))
}

/// The multiples for [`references`] that a sweep tries in order, until the references resolve the wanted error and a
/// setting meets it.
pub fn finenesses(is_refined: bool) -> &'static [[f64; 2]] {
    const ALL: [[f64; 2]; 2] = [FINER_AT_FIRST, FINER];
    if is_refined { &ALL } else { &ALL[1..] }
}

/// Settings near the recommended one of a sweep that may be cheaper, or more exact in the same time.
///
/// The first round varies the substeps, the later ones halve the distance to the neighbour in evaluations that misses the
/// wish, on a logarithmic scale. Where no setting meets the wish, finer or cheaper ones are tried.
pub fn near(trade: &Trade, wish: &Wish, round: u32) -> Vec<Setting> {
    let own = match wish.choose(trade) {
        Choice::Found(found) => found.setting,
        Choice::Nearest(nearest) => {
            return match wish {
                Wish::Error(_) => finer(trade),
                Wish::Time(_) => cheaper(nearest.setting),
            };
        }
        Choice::Unresolved(_) | Choice::None => return Vec::new(),
    };
    if own.reading == Reading::Classic {
        return Vec::new();
    }
    if round == 0 {
        return SUBSTEPS.map(|substeps| Setting { substeps, ..own }).to_vec();
    }
    let others = trade.points.iter().map(|point| point.setting);
    let ladder = others.filter(|other| {
        Setting { substeps: own.substeps, ..*other }.with_evaluations(own.evaluations) == own
    });
    let neighbour = match wish {
        Wish::Error(_) => ladder.map(|x| x.evaluations).filter(|x| *x < own.evaluations).reduce(f64::max),
        Wish::Time(_) => ladder.map(|x| x.evaluations).filter(|x| *x > own.evaluations).reduce(f64::min),
    };
    let between = neighbour.map(|neighbour| (neighbour * own.evaluations).sqrt().round());
    between.map(|evaluations| own.with_evaluations(evaluations)).into_iter().collect()
}

/// Settings finer than all of a curve: more substeps, because air and colliders enter once in each, and twice the
/// evaluations. Only those for which the reference is finer by far, and without tethers, whose bias does not converge.
fn finer(trade: &Trade) -> Vec<Setting> {
    let Some(reference) = trade.reference.as_ref().map(|fine| fine.setting) else { return Vec::new() };
    let others = trade.points.iter().map(|point| point.setting);
    let own = others.filter(|other| other.reading == Reading::Physical && !other.tethers);
    let fineness = |x: &Setting| [x.evaluations, f64::from(x.substeps)];
    let finest = own.reduce(|a, b| if fineness(&b) > fineness(&a) { b } else { a });
    let Some(finest) = finest else { return Vec::new() };
    let substeps = finest.substeps.max(SUBSTEPS[SUBSTEPS.len() - 1]).min(reference.substeps);
    let all = [1.0, 2.0].map(|factor| finest.with_evaluations(factor * finest.evaluations));
    let all = all.into_iter().flat_map(|setting| [setting, Setting { substeps, ..setting }]);
    all.filter(|setting| 2.0 * setting.evaluations <= reference.evaluations && *setting != finest).collect()
}

/// Settings cheaper than the cheapest of a curve.
fn cheaper(cheapest: Setting) -> Vec<Setting> {
    if cheapest.reading == Reading::Classic {
        return Vec::new();
    }
    let halved = cheapest.with_evaluations((0.5 * cheapest.evaluations).round().max(1.0));
    [halved, Setting { substeps: 1, ..cheapest }, Setting { substeps: 1, ..halved }].to_vec()
}

/// Estimated cost of a frame at a setting, in row evaluations of single precision.
///
/// # Errors
/// When the scene does not compile at this setting.
pub fn work(benchmark: &Benchmark, setting: &Setting, bits: u32) -> Result<f64, TradeError> {
    let program = benchmark.at(setting)?;
    let simulation: Simulation = Simulation::new(&program, 1);
    let passes = simulation.solver().passes(&program.first_input());
    let wide = if bits == 64 { 1.5 } else { 1.0 };
    Ok(wide * passes.iter().map(|pass| pass.evaluations()).sum::<f64>().max(1.0))
}

fn physical(benchmark: &Benchmark, options: &SweepOptions) -> Result<Vec<Setting>, TradeError> {
    let own = Setting { reading: Reading::Physical, resistance: 1.0, ..benchmark.own() };
    let evaluations = or_default(&options.evaluations, || {
        if options.is_refined() {
            return EVALUATIONS[..EVALUATIONS_AT_FIRST].to_vec();
        }
        let mut all = EVALUATIONS.to_vec();
        while benchmark.own().reading == Reading::Physical && all[all.len() - 1] < own.evaluations {
            all.push(all[all.len() - 1] * 2.0);
        }
        all
    });
    // Settings that execute the same passes are redundant.
    let passes = match iterations_matter(benchmark, &own)? {
        true => or_default(&options.collision_iterations, || {
            let c = own.collision_iterations.max(1);
            if options.is_refined() { vec![own.collision_iterations] } else { vec![c, 4 * c] }
        }),
        false => vec![own.collision_iterations],
    };
    let substeps = or_default(&options.substeps, || {
        if options.is_refined() { vec![own.substeps] } else { SUBSTEPS.to_vec() }
    });
    let mut all = Vec::new();
    for &evaluations in &evaluations {
        for &substeps in &substeps {
            all.extend(passes.iter().map(|&collision_iterations| Setting {
                substeps,
                evaluations,
                collision_iterations,
                ..own
            }));
        }
    }
    // Tethers are a bias, and cost less than the evaluations that they save: references are without them.
    if benchmark.hangs() {
        let tethered = all.iter().map(|setting| Setting { tethers: true, ..*setting });
        all.extend(tethered.collect::<Vec<_>>());
    }
    Ok(all)
}

/// Whether collision iterations change the passes.
fn iterations_matter(benchmark: &Benchmark, setting: &Setting) -> Result<bool, TradeError> {
    let passes = |collision_iterations: u32| -> Result<_, TradeError> {
        let program = benchmark.at(&Setting { collision_iterations, ..*setting })?;
        let simulation: Simulation = Simulation::new(&program, 1);
        Ok(simulation.solver().passes(&program.first_input()))
    };
    Ok(passes(1)? != passes(1000)?)
}

/// Collision iterations are tied to substeps: equal, slightly more, and four times as many (N2.4-15).
fn classic(benchmark: &Benchmark, options: &SweepOptions) -> Vec<Setting> {
    let own = Setting { reading: Reading::Classic, tethers: false, ..benchmark.own() };
    let mut all = Vec::new();
    for substeps in or_default(&options.substeps, || CLASSIC_SUBSTEPS.to_vec()) {
        for collision_iterations in or_default(&options.collision_iterations, || {
            vec![substeps, substeps + substeps.div_ceil(4), 4 * substeps]
        }) {
            let each = or_default(&options.resistances, || RESISTANCES.to_vec()).into_iter();
            all.extend(each.map(|resistance| Setting { substeps, collision_iterations, resistance, ..own }));
        }
    }
    all
}

fn or_default<T: Clone>(requested: &[T], default: impl FnOnce() -> Vec<T>) -> Vec<T> {
    if requested.is_empty() { default() } else { requested.to_vec() }
}

#[cfg(test)]
mod tests {
    use super::super::curve::tests::{point, trade};
    use super::super::request::Request;
    use super::*;

    #[test]
    fn a_sweep_with_requested_settings_or_a_thorough_one_is_not_refined() {
        assert!(SweepOptions::default().is_refined());
        assert!(!SweepOptions { is_thorough: true, ..SweepOptions::default() }.is_refined());
        assert!(!SweepOptions { evaluations: vec![24.0], ..SweepOptions::default() }.is_refined());
        assert!(!SweepOptions { substeps: vec![2], ..SweepOptions::default() }.is_refined());
    }

    #[test]
    fn refinement_varies_the_substeps_and_then_the_evaluations_next_to_the_limit() {
        let trade = trade(vec![point(25.0, 0.1), point(100.0, 0.005), point(400.0, 0.001)]);
        let settings = |wish: &Wish, round| -> Vec<(u32, f64)> {
            near(&trade, wish, round).iter().map(|x| (x.substeps, x.evaluations)).collect()
        };
        let error = Wish::Error(Request::every(0.01));
        assert_eq!(settings(&error, 0), [(1, 100.0), (3, 100.0), (8, 100.0)]);
        assert_eq!(settings(&error, 1), [(3, 50.0)]);
        // 100 evaluations are the most that this time allows, and 400 exceed it.
        assert_eq!(settings(&Wish::Time(150.0), 1), [(3, 200.0)]);
        assert_eq!(settings(&Wish::Time(500.0), 1), []);
        assert_eq!(settings(&Wish::Error(Request::every(0.0005)), 0), [], "no reference is finer");
    }

    #[test]
    fn where_no_setting_meets_an_error_finer_ones_are_tried_and_for_a_time_cheaper_ones() {
        let all = vec![point(24.0, 0.1), point(96.0, 0.03), point(192.0, 0.04)];
        let mut fine = point(768.0, 0.0);
        fine.setting.substeps = 12;
        let trade = Trade { reference: Some(fine), ..trade(all) };
        let settings = |wish: &Wish| -> Vec<(u32, f64)> {
            near(&trade, wish, 0).iter().map(|x| (x.substeps, x.evaluations)).collect()
        };
        assert_eq!(settings(&Wish::Error(Request::every(0.01))), [(8, 192.0), (3, 384.0), (8, 384.0)]);
        assert_eq!(settings(&Wish::Time(10.0)), [(3, 12.0), (1, 24.0), (1, 12.0)]);
    }
}
