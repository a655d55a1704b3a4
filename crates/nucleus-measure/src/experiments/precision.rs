//! Error of single precision.

use nucleus_core::{BuildError, COUNT_PERIOD, ClothLists, Real, ResistanceModel};

use super::experiment::{Experiment, Scheme, Table, or_dash};
use crate::fixture::{Fixture, GRAVITY, Vec3, sheet};
use crate::metrics::deformation::distance;
use crate::report::figure;

pub const PRECISION: Experiment = Experiment {
    name: "precision",
    description: "A point falls freely for a second, from several heights above the origin and with several substeps per 1/24 \
        s: relative error of the distance in single precision, compared with the exact sum of the steps. Then whole \
        sheets, the same run in single and in double precision: distance of their points, RMS over all points and \
        all frames, over the size.",
    differences: "The prototype stored positions in single precision and took velocities from their differences; its other \
        form stored displacements from an anchor, as the solver does. The prototype's figures for that form are the \
        maximum over all heights. A swinging sheet is chaotic: a difference of rounding grows to a difference of \
        folds, at any precision.",
    run,
};

/// Height in metres, substeps, and error of the prototype's positions in %, if known: 100 is not falling at all.
const FALLS: [(f64, u32, Option<f64>); 6] = [
    (10.0, 100, Some(12.0)),
    (10.0, 200, Some(100.0)),
    (100.0, 20, None),
    (100.0, 100, Some(100.0)),
    (1000.0, 50, Some(100.0)),
    (1000.0, 1000, None),
];

/// Maximum error of the prototype's displacements, in %.
const DISPLACED: f64 = 0.0025;

fn run() -> Result<Vec<Table>, BuildError> {
    Ok(vec![falls()?, sheets()?])
}

fn falls() -> Result<Table, BuildError> {
    let mut rows = Vec::new();
    for (height, substeps, positions) in FALLS {
        let [single, double] = [fall_error::<f32>(height, substeps)?, fall_error::<f64>(height, substeps)?];
        let ours = [single, double].map(|share| format!("{:.1e}", 100.0 * share.abs()));
        let theirs = [format!("≤ {DISPLACED}"), or_dash(positions)];
        let run = [figure(height), substeps.to_string()];
        rows.push(run.into_iter().chain(ours).chain(theirs).collect());
    }
    let head = vec![
        "height, m",
        "substeps",
        "single, %",
        "double, %",
        "prototype, displacements, %",
        "prototype, positions, %",
    ];
    Ok(Table { title: "Free fall", head, rows })
}

/// Relative error of the distance that a point falls in a second.
fn fall_error<R: Real>(height: f64, substeps: u32) -> Result<f64, BuildError> {
    let square = sheet([2, 2], Vec3::y() * height, Vec3::x(), Vec3::z());
    let mut fixture: Fixture<R> = Fixture::new(square, ClothLists::NONE, 1.0)?;
    fixture.frame.substeps = substeps;
    fixture.frame.resistance = ResistanceModel::Classic;
    fixture.run(24);
    // n steps of h, each with the velocity at its end, sum to g h² n (n + 1) / 2.
    let (steps, h) = (f64::from(24 * substeps), COUNT_PERIOD / f64::from(substeps));
    let exact = GRAVITY * h * h * steps * (steps + 1.0) / 2.0;
    Ok((height - fixture.point(0).y) / exact - 1.0)
}

fn sheets() -> Result<Table, BuildError> {
    let mut rows = Vec::new();
    for evaluations in [24, 96, 384, 1536] {
        let [hanging, swinging] = [deviation(true, evaluations)?, deviation(false, evaluations)?];
        let cells = [hanging, swinging].map(|share| format!("{:.1e}", share));
        rows.push([evaluations.to_string()].into_iter().chain(cells).collect());
    }
    let head = vec!["small steps in 1/24 s", "hangs from an edge", "swings from two corners"];
    Ok(Table { title: "Sheets of 41² points, single against double, a second", head, rows })
}

/// Distance of a sheet in single precision from one in double precision, RMS over points and frames, over the size.
fn deviation(hangs: bool, evaluations: u32) -> Result<f64, BuildError> {
    let (mut single, mut double) = (hung::<f32>(hangs, evaluations)?, hung::<f64>(hangs, evaluations)?);
    let frames = (0..24).map(|_| {
        single.step();
        double.step();
        distance(&single.points(), &double.points(), 2f64.sqrt()).rms
    });
    Ok(crate::metrics::root_mean_square(frames))
}

fn hung<R: Real>(hangs: bool, evaluations: u32) -> Result<Fixture<R>, BuildError> {
    let size = 41u32;
    let across = if hangs { -Vec3::y() } else { Vec3::z() };
    let cloth = sheet([size, size], Vec3::zeros(), Vec3::x(), across);
    let lists = ClothLists { stretch: true, cross_links: true, ..ClothLists::NONE };
    let mut fixture = Fixture::new(cloth, lists, 1.0)?;
    Scheme::SmallSteps.set(&mut fixture, evaluations);
    let held: Vec<usize> = if hangs { (0..size as usize).collect() } else { vec![0, size as usize - 1] };
    fixture.pin(held);
    Ok(fixture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_fall_in_single_precision_is_as_accurate_as_the_prototype() {
        for (height, substeps, _) in FALLS {
            let error = 100.0 * fall_error::<f32>(height, substeps).expect("four points").abs();
            assert!(error < DISPLACED, "{height} m, {substeps} substeps: {error} %");
        }
    }
}
