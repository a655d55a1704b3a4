//! A free sheet that falls on a ball and sticks to it.

use nalgebra::Vector3;
use nucleus_core::{BuildError, Cloth, ClothLists, Collider, ColliderFrame, Mass, ModelBuilder};
use nucleus_graph::mesh::poly_sphere;

use super::experiment::{Experiment, STIFFNESS, Scheme, Table, or_dash};
use crate::clock::{Clock, Timing};
use crate::fixture::{DENSITY, Fixture, Vec3, sheet};
use crate::metrics::deformation::{Edges, Strain};
use crate::report::figure;

pub const DRAPED: Experiment = Experiment {
    name: "draped",
    description: "A free sheet of 1 m of square cells, 0.2 kg/m² and 10 kN/m, lies on a ball of 0.31 m radius, sticks to it by \
        friction, and drapes for 2.5 s. Its weight alone stretches it by about 0.02 %, so nearly all strain is the \
        error of the solve. Final strain of the edges: 99th percentile and maximum.",
    differences: "The prototype's ball was exact, and points froze on contact; here it is a mesh of 48 by 32, with a friction \
        of 10 and a thickness of 5 mm. In both, contacts are swept as often as links, and last. Shear stiffness is a \
        tenth of the stretch stiffness in the prototype; here it comes from cross links of a tenth for Physical, and \
        from a tenth of the passes for Classic. Drag damps at 1/s in all directions here; the prototype's damping is \
        unknown. Edges and faces collide with the ball here, only points there. The ranking of the methods and the \
        convergence with the budget are the same; the maximum strains of passes are smaller here, and those of small \
        steps with the smallest budget are larger.",
    run,
};

const SHEETS: [u32; 2] = [41, 61];
const EVALUATIONS: [u32; 4] = [24, 48, 96, 384];
const FRAMES: u32 = 60;
const RADIUS: f64 = 0.31;
const THICKNESS: f64 = 0.005;

/// Strains of the prototype in %: 99th percentile, and maximum.
fn prototype(size: u32, scheme: Scheme) -> [Option<[f64; 2]>; 4] {
    match (size, scheme) {
        (41, Scheme::SmallSteps) => [[9.4, 16.0], [4.7, 7.3], [2.1, 4.3], [0.58, 1.6]].map(Some),
        (41, Scheme::Passes(3)) => [[25.0, 44.0], [16.0, 37.0], [11.0, 40.0], [7.4, 35.0]].map(Some),
        (61, Scheme::SmallSteps) => [[14.0, 20.0], [6.6, 11.0], [3.1, 6.8], [0.72, 2.7]].map(Some),
        (61, Scheme::Passes(3)) => [[42.0, 79.0], [28.0, 70.0], [18.0, 45.0], [10.0, 92.0]].map(Some),
        _ => [None; 4],
    }
}

fn run() -> Result<Vec<Table>, BuildError> {
    let mut rows = Vec::new();
    for size in SHEETS {
        for scheme in [Scheme::SmallSteps, Scheme::Passes(3)] {
            for (evaluations, prototype) in EVALUATIONS.into_iter().zip(prototype(size, scheme)) {
                let (strain, ms) = drape(size, scheme, evaluations)?;
                let run = [format!("{size}²"), scheme.words(), evaluations.to_string()];
                let ours = [strain.p99, strain.max].map(|share| figure(100.0 * share));
                let theirs = [0, 1].map(|k| or_dash(prototype.map(|both| both[k])));
                let cells =
                    [ours[0].clone(), theirs[0].clone(), ours[1].clone(), theirs[1].clone(), figure(ms)];
                rows.push(run.into_iter().chain(cells).collect());
            }
        }
    }
    let head = vec![
        "points",
        "evaluations are",
        "in 1/24 s",
        "99 % strain, %",
        "prototype, %",
        "largest, %",
        "prototype, %",
        "ms per frame",
    ];
    Ok(vec![Table { title: "Strain on the ball", head, rows }])
}

/// Final strain, and milliseconds per frame.
fn drape(size: u32, scheme: Scheme, evaluations: u32) -> Result<(Strain, f64), BuildError> {
    let height = RADIUS + 1.5 * THICKNESS;
    let cloth = sheet([size, size], Vec3::new(-0.5, height, -0.5), Vec3::x(), Vec3::z());
    let lists = ClothLists { stretch: true, cross_links: false, shear: true, air: true, ..ClothLists::NONE };
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(cloth.clone(), Mass::PerArea(DENSITY), lists))?;
    let ball = poly_sphere(RADIUS, (48, 32)).unwrap_or_else(|error| panic!("a valid ball: {error}"));
    builder.collider(Collider { surface: ball })?;
    let edges = Edges::of(&cloth);
    let mut fixture: Fixture<f32> = Fixture::from_builder(builder, cloth, 1.0);
    scheme.set(&mut fixture, evaluations);
    let cloth = fixture.cloth();
    match scheme {
        Scheme::SmallSteps => cloth.stiffness.shear = Some(STIFFNESS / 10.0),
        Scheme::Passes(_) => cloth.shear_resistance = f64::from(evaluations) / 10.0,
    }
    (cloth.thickness, cloth.friction) = (THICKNESS / 2.0, 10.0);
    fixture.damp_velocity(1.0);
    fixture.frame.colliders =
        vec![ColliderFrame { collide: true, thickness: THICKNESS / 2.0, ..ColliderFrame::default() }];
    let (timing, ()) = Timing::measure(Clock::Thread, || fixture.run(FRAMES));
    let points: Vec<Vector3<f64>> = fixture.points();
    Ok((edges.strain(&points), 1e3 * timing.processor / f64::from(FRAMES)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_steps_strain_a_draped_sheet_less_than_passes_and_less_with_more_evaluations() {
        let most = |scheme, n| drape(21, scheme, n).map(|(strain, _)| strain.p99).expect("a sheet");
        let [few, many] = [24, 96].map(|evaluations| most(Scheme::SmallSteps, evaluations));
        assert!(many < few && many < most(Scheme::Passes(3), 96), "{few} {many}");
    }
}
