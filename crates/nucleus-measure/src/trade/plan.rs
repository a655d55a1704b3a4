//! Which settings are run.

use nucleus_graph::Simulation;

use super::setting::{Reading, Setting};
use super::subject::{Subject, TradeError};

/// What is asked for; what is left empty is chosen for the scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Wishes {
    /// Which readings; the scene's own if there are none.
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

/// Evaluations that are tried at least, each twice the one before.
const EVALUATIONS: [f64; 5] = [24.0, 48.0, 96.0, 192.0, 384.0];

/// Substeps that are tried, read as Physical and as Classic.
const SUBSTEPS: [u32; 3] = [1, 3, 8];
const CLASSIC_SUBSTEPS: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// Factors on resistances that are tried.
const RESISTANCES: [f64; 3] = [0.25, 1.0, 4.0];

/// How many times more evaluations than the most exact run the two references have: step h, and step h/2.
const FINER: [f64; 2] = [2.0, 4.0];

/// All settings to run, the scene's own first, none twice.
///
/// # Errors
/// When the scene does not compile at one of them.
pub fn settings(subject: &Subject, wishes: &Wishes) -> Result<Vec<Setting>, TradeError> {
    let own = subject.own();
    let mut all = vec![own];
    let readings = or(&wishes.readings, || vec![own.reading]);
    for reading in readings {
        let found = match reading {
            Reading::Physical => physical(subject, wishes)?,
            Reading::Classic => classic(subject, wishes),
        };
        for setting in found {
            if all.iter().all(|other| other.key() != setting.key()) {
                all.push(setting);
            }
        }
    }
    Ok(all)
}

/// The two references, the finer last; `settings` are what they are for. Classic has none of its own: with more
/// iterations, and with more substeps, its cloth becomes another.
pub fn references(subject: &Subject, settings: &[Setting]) -> Option<[Setting; 2]> {
    let physical = settings.iter().filter(|setting| setting.reading == Reading::Physical);
    let most = physical.clone().map(|setting| setting.evaluations).reduce(f64::max)?;
    let own = subject.own();
    let substeps = if own.reading == Reading::Physical { own.substeps.max(3) } else { 3 };
    Some(FINER.map(|finer| Setting {
        reading: Reading::Physical,
        substeps: substeps * finer as u32,
        collision_iterations: own.collision_iterations,
        evaluations: most * finer,
        resistance: 1.0,
    }))
}

/// What a frame at a setting costs about, in row evaluations of single precision.
///
/// # Errors
/// When the scene does not compile so.
pub fn work(subject: &Subject, setting: &Setting, bits: u32) -> Result<f64, TradeError> {
    let program = subject.at(setting)?;
    let simulation: Simulation = Simulation::new(&program, 1);
    let passes = simulation.solver().passes(&program.first_input());
    let wide = if bits == 64 { 1.5 } else { 1.0 };
    Ok(wide * passes.iter().map(|pass| pass.evaluations()).sum::<f64>().max(1.0))
}

fn physical(subject: &Subject, wishes: &Wishes) -> Result<Vec<Setting>, TradeError> {
    let own = Setting { reading: Reading::Physical, resistance: 1.0, ..subject.own() };
    let evaluations = or(&wishes.evaluations, || {
        let mut all = EVALUATIONS.to_vec();
        while subject.own().reading == Reading::Physical && all[all.len() - 1] < own.evaluations {
            all.push(all[all.len() - 1] * 2.0);
        }
        all
    });
    // A setting that changes no pass is not worth a run.
    let passes = match does_anything(subject, &own)? {
        true => or(&wishes.collision_iterations, || {
            let c = own.collision_iterations.max(1);
            vec![c, 4 * c]
        }),
        false => vec![own.collision_iterations],
    };
    let substeps = or(&wishes.substeps, || SUBSTEPS.to_vec());
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

/// Whether collision iterations change what is done.
fn does_anything(subject: &Subject, setting: &Setting) -> Result<bool, TradeError> {
    let passes = |collision_iterations: u32| -> Result<_, TradeError> {
        let program = subject.at(&Setting { collision_iterations, ..*setting })?;
        let simulation: Simulation = Simulation::new(&program, 1);
        Ok(simulation.solver().passes(&program.first_input()))
    };
    Ok(passes(1)? != passes(1000)?)
}

/// Collision iterations go with the substeps: one to each, slightly more, and many more (N2.4-15).
fn classic(subject: &Subject, wishes: &Wishes) -> Vec<Setting> {
    let own = Setting { reading: Reading::Classic, ..subject.own() };
    let mut all = Vec::new();
    for substeps in or(&wishes.substeps, || CLASSIC_SUBSTEPS.to_vec()) {
        for collision_iterations in
            or(&wishes.collision_iterations, || vec![substeps, substeps + substeps.div_ceil(4), 4 * substeps])
        {
            let each = or(&wishes.resistances, || RESISTANCES.to_vec()).into_iter();
            all.extend(each.map(|resistance| Setting { substeps, collision_iterations, resistance, ..own }));
        }
    }
    all
}

fn or<T: Clone>(wished: &[T], otherwise: impl FnOnce() -> Vec<T>) -> Vec<T> {
    if wished.is_empty() { otherwise() } else { wished.to_vec() }
}
