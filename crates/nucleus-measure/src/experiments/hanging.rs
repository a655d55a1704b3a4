//! A sheet that hangs from its upper edge, and one that swings down from two corners.

use nucleus_core::{BuildError, ClothLists};

use super::experiment::{Experiment, STIFFNESS, Scheme, Table, or_dash, timed};
use crate::fixture::{DENSITY, Fixture, GRAVITY, Vec3, sheet};
use crate::report::figure;

pub const HANGING: Experiment = Experiment {
    name: "hanging",
    description: "A sheet of 1 m of square cells, 0.2 kg/m² and 10 kN/m, hangs from its upper edge; its sag is ρ g H² / 2K. \
        Links run along the edges of the cells only. 41² points run for 2.5 s, 81² points for 1.7 s; the sag is the \
        mean over the last half second. In a second run it starts horizontal, pinned at two corners, and swings down \
        for 2 s: maximum strain.",
    differences: "The prototype's damping is unknown, and it took the sag at the end; here drag removes a share of 4 of the \
        velocity per second. The prototype swept one substep in the order of the points, here links are always \
        coloured. The prototype also had springs of a tenth across its cells, which may be why its corners are \
        stretched a third as much in the swing. Small steps sag as the prototype's did, up to a half more at the \
        smallest budget. Passes sag three to four times as much as the prototype's coloured ones, at every budget \
        and on both sheets, for an unknown reason; swept in the order of the points, against gravity, the \
        prototype's sag even less.",
    run,
};

/// Points along a side, and frames.
const SHEETS: [(u32, u32); 2] = [(41, 60), (81, 41)];
const EVALUATIONS: [u32; 3] = [24, 96, 384];

/// The last half second.
const LATE: u32 = 12;

/// Sags of the prototype in mm, by points along a side and scheme.
fn prototype(size: u32, scheme: Scheme) -> [Option<f64>; 3] {
    match (size, scheme) {
        (41, Scheme::SmallSteps) => [18.0, 1.4, 0.17].map(Some),
        (41, Scheme::Passes(3)) => [56.0, 13.0, 2.6].map(Some),
        (41, Scheme::Passes(1)) => [85.0, 16.0, 0.87].map(Some),
        (81, Scheme::SmallSteps) => [65.0, 4.7, 0.41].map(Some),
        (81, Scheme::Passes(3)) => [172.0, 46.0, 11.0].map(Some),
        _ => [None; 3],
    }
}

fn run() -> Result<Vec<Table>, BuildError> {
    Ok(vec![sags()?, swings()?])
}

fn sags() -> Result<Table, BuildError> {
    let exact = 1e3 * DENSITY * GRAVITY / (2.0 * STIFFNESS);
    let mut rows = Vec::new();
    for (size, frames) in SHEETS {
        for scheme in [Scheme::SmallSteps, Scheme::Passes(3), Scheme::Passes(1)] {
            for (evaluations, prototype) in EVALUATIONS.into_iter().zip(prototype(size, scheme)) {
                let (sag, ms) = sag(size, frames, scheme, evaluations)?;
                let cells = [figure(exact), figure(1e3 * sag), or_dash(prototype), figure(ms)];
                let run = [format!("{size}²"), scheme.words(), evaluations.to_string()];
                rows.push(run.into_iter().chain(cells).collect());
            }
        }
    }
    let head = vec![
        "points",
        "evaluations are",
        "in 1/24 s",
        "exact, mm",
        "sag, mm",
        "prototype, mm",
        "ms per frame",
    ];
    Ok(Table { title: "Sag", head, rows })
}

/// Sag of the lower edge in metres, and milliseconds per frame.
fn sag(size: u32, frames: u32, scheme: Scheme, evaluations: u32) -> Result<(f64, f64), BuildError> {
    let cloth = sheet([size, size], Vec3::zeros(), Vec3::x(), -Vec3::y());
    let lists = ClothLists { stretch: true, air: true, ..ClothLists::NONE };
    let mut fixture: Fixture<f32> = Fixture::new(cloth, lists, 1.0)?;
    scheme.set(&mut fixture, evaluations);
    fixture.damp_velocity(4.0);
    fixture.pin(0..size as usize);
    let lowest = (size * (size - 1)) as usize..(size * size) as usize;
    let mut low = 0.0;
    let mut frame = 0;
    let ms = timed(frames, || {
        fixture.step();
        frame += 1;
        if frame > frames - LATE {
            let edge = lowest.clone().map(|point| fixture.point(point).y).sum::<f64>() / f64::from(size);
            low += edge / f64::from(LATE);
        }
    });
    Ok((-1.0 - low, ms))
}

fn swings() -> Result<Table, BuildError> {
    let mut rows = Vec::new();
    for (scheme, prototype) in [(Scheme::SmallSteps, Some(749.0)), (Scheme::Passes(3), Some(3600.0))] {
        for (evaluations, prototype) in [(24, prototype), (96, None), (384, None)] {
            let most = swing(81, scheme, evaluations)?;
            let cells = [figure(100.0 * most), or_dash(prototype)];
            rows.push([scheme.words(), evaluations.to_string()].into_iter().chain(cells).collect());
        }
    }
    let head = vec!["evaluations are", "in 1/24 s", "largest strain, %", "prototype, %"];
    Ok(Table { title: "Swing of 81² points, largest strain in 2 s", head, rows })
}

/// Maximum strain at the end of a frame.
fn swing(size: u32, scheme: Scheme, evaluations: u32) -> Result<f64, BuildError> {
    let cloth = sheet([size, size], Vec3::zeros(), Vec3::x(), Vec3::z());
    let lists = ClothLists { stretch: true, ..ClothLists::NONE };
    let mut fixture: Fixture<f32> = Fixture::new(cloth, lists, 1.0)?;
    scheme.set(&mut fixture, evaluations);
    fixture.pin([0, size as usize - 1]);
    Ok((0..48).map(|_| fixture.step().max_strain).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_steps_bring_the_sag_nearer_than_passes_over_three_substeps_do() {
        let exact = DENSITY * GRAVITY / (2.0 * STIFFNESS);
        let off = |scheme| sag(21, 60, scheme, 96).map(|(sag, _)| (sag - exact).abs()).expect("a sheet");
        assert!(off(Scheme::SmallSteps) < off(Scheme::Passes(3)) / 2.0);
    }
}
