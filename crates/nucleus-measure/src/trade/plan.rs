//! The settings of a sweep and of its references.

use nucleus_graph::Simulation;

use super::benchmark::{Benchmark, TradeError};
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
pub fn references(benchmark: &Benchmark, settings: &[Setting]) -> Option<[Setting; 2]> {
    let physical = settings.iter().filter(|setting| setting.reading == Reading::Physical);
    let most = physical.clone().map(|setting| setting.evaluations).reduce(f64::max)?;
    let own = benchmark.own();
    let substeps = if own.reading == Reading::Physical { own.substeps.max(3) } else { 3 };
    Some(FINER.map(|finer| Setting {
        reading: Reading::Physical,
        substeps: substeps * finer as u32,
        collision_iterations: own.collision_iterations,
        evaluations: most * finer,
        resistance: 1.0,
    }))
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
            vec![c, 4 * c]
        }),
        false => vec![own.collision_iterations],
    };
    let substeps = or_default(&options.substeps, || SUBSTEPS.to_vec());
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
    let own = Setting { reading: Reading::Classic, ..benchmark.own() };
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
