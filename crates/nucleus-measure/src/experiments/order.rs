//! Energy created by a fixed order of sweeps, for several numberings of the points.

use nucleus_core::{BuildError, ClothLists, Faces, Surface};

use super::experiment::{Experiment, Scheme, Table, or_dash};
use crate::fixture::{DENSITY, Fixture, GRAVITY, Vec3, sheet, vertex_areas};
use crate::metrics::conservation::potential;
use crate::report::figure;

pub const ORDER: Experiment = Experiment {
    name: "order",
    description: "A horizontal sheet of 1 m, 0.2 kg and 10 kN/m, pinned at two corners, swings down for 2 s, undamped, with \
        one sweep per step: maximum of kinetic plus potential energy at the end of a frame, over the initial value, \
        in J. Points are numbered row by row, column by column, and at random, which changes the colours of the \
        links and their order.",
    differences: "The prototype could sweep in any order; the solver has one, coloured, and rarely reverses it, so the \
        numbering of the mesh varies here. Of the prototype's orders the table has the two relevant ones: by the \
        number of the points, and coloured. Falling by its own length, such a sheet converts 1 to 2 J.",
    run,
};

const SIZES: [u32; 2] = [41, 81];
const STEPS: [u32; 4] = [24, 48, 96, 192];
const FRAMES: u32 = 48;

/// Energies of the prototype in J, swept in the order of the points.
fn by_number(size: u32) -> [f64; 4] {
    if size == 41 { [1.1, 6.1, 0.0, 0.0] } else { [0.6, 10.0, 46_532.0, 24.0] }
}

/// Numbering of the points of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Numbering {
    Rows,
    Columns,
    Shuffled,
}

impl Numbering {
    const ALL: [Self; 3] = [Self::Rows, Self::Columns, Self::Shuffled];

    /// The place of each of `size` by `size` points.
    fn places(self, size: u32) -> Vec<u32> {
        let all = 0..size * size;
        match self {
            Self::Rows => all.collect(),
            Self::Columns => all.map(|k| k % size * size + k / size).collect(),
            Self::Shuffled => {
                let mut places: Vec<u32> = all.collect();
                let mut state = 1u64;
                for k in (1..places.len()).rev() {
                    // Knuth's MMIX generator; its upper half is random enough.
                    state =
                        state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    places.swap(k, (state >> 33) as usize % (k + 1));
                }
                places
            }
        }
    }
}

fn run() -> Result<Vec<Table>, BuildError> {
    let mut rows = Vec::new();
    for (size, cross_links) in [(SIZES[0], false), (SIZES[0], true), (SIZES[1], false)] {
        for (steps, by_number) in STEPS.into_iter().zip(by_number(size)) {
            let mut row =
                vec![format!("{size}²{}", if cross_links { ", cross links" } else { "" }), steps.to_string()];
            for numbering in Numbering::ALL {
                row.push(figure(energy_gain(size, cross_links, Scheme::SmallSteps, steps, numbering)?));
            }
            row.push(figure(energy_gain(size, cross_links, Scheme::Passes(steps), steps, Numbering::Rows)?));
            // The prototype had no cross links.
            let theirs = [by_number, 0.0].map(|energy| or_dash((!cross_links).then_some(energy)));
            row.extend(theirs);
            rows.push(row);
        }
    }
    let head = vec![
        "points",
        "steps in 1/24 s",
        "by rows, J",
        "by columns, J",
        "shuffled, J",
        "Classic, by rows, J",
        "prototype, by number, J",
        "prototype, coloured, J",
    ];
    Ok(vec![Table { title: "Energy created", head, rows }])
}

/// Maximum energy above the initial value, in J; never negative.
fn energy_gain(
    size: u32,
    cross_links: bool,
    scheme: Scheme,
    steps: u32,
    numbering: Numbering,
) -> Result<f64, BuildError> {
    let places = numbering.places(size);
    let cloth = renumbered(&sheet([size, size], Vec3::zeros(), Vec3::x(), Vec3::z()), &places);
    let lists = ClothLists { stretch: true, cross_links, ..ClothLists::NONE };
    let mut fixture: Fixture<f64> = Fixture::new(cloth, lists, 1.0)?;
    scheme.set(&mut fixture, steps);
    fixture.pin([0, size as usize - 1].map(|corner| places[corner] as usize));
    let masses: Vec<f64> = vertex_areas(&fixture.surface).into_iter().map(|area| area * DENSITY).collect();
    let mut most = 0.0f64;
    for _ in 0..FRAMES {
        let kinetic = fixture.step().kinetic_energy;
        most = most.max(kinetic + potential(&masses, &fixture.points(), -Vec3::y() * GRAVITY));
    }
    Ok(most)
}

/// The same mesh with permuted points.
fn renumbered(surface: &Surface, places: &[u32]) -> Surface {
    let mut positions = surface.positions.clone();
    for (position, &place) in surface.positions.iter().zip(places) {
        positions[place as usize] = *position;
    }
    let mut faces = Faces::default();
    for face in surface.faces.iter() {
        let corners: Vec<u32> = face.iter().map(|&corner| places[corner as usize]).collect();
        faces.push(&corners);
    }
    Surface { positions, faces }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_renumbered_mesh_is_the_same_mesh() {
        let plain = sheet([5, 5], Vec3::zeros(), Vec3::x(), Vec3::z());
        for numbering in Numbering::ALL {
            let places = numbering.places(5);
            let mut sorted = places.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..25), "{numbering:?}");
            let other = renumbered(&plain, &places);
            let corners = |mesh: &Surface| -> Vec<Vec<Vec3>> {
                let face = |face: &[u32]| face.iter().map(|&k| mesh.positions[k as usize]).collect();
                mesh.faces.iter().map(face).collect()
            };
            assert_eq!(corners(&other), corners(&plain), "{numbering:?}");
        }
    }

    // 1e-4 J is a ten-thousandth of the energy that such a sheet converts.
    #[test]
    fn no_numbering_of_a_mesh_creates_energy() {
        for numbering in Numbering::ALL {
            let energy = energy_gain(21, false, Scheme::SmallSteps, 24, numbering).expect("a sheet");
            assert!(energy < 1e-4, "{numbering:?}: {energy} J");
        }
    }
}
