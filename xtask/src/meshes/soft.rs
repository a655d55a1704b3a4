//! Meshes of soft bodies: a balloon with an open neck, the round bed of a trampoline, a slinky, a paper aeroplane, a
//! rope bridge, a link of a chain, and the specimen of a drape test.

use super::mesh::{Mesh, ring};

/// Points round a balloon and a trampoline.
const AROUND: usize = 32;

/// A sphere of 12 with a neck of radius 1.6 that is open below; its faces face outwards.
pub fn balloon() -> Mesh {
    let neck = [(1.6, -19.0), (1.6, -17.5), (1.7, -16.0), (2.0, -14.5), (2.8, -13.0)];
    let sphere = (1..11).map(|k| {
        let turn = std::f64::consts::PI * (0.05 + 0.086 * f64::from(k));
        (12.0 * turn.sin(), -12.0 * turn.cos())
    });
    let outline: Vec<_> = neck.into_iter().chain(sphere).collect();
    let rows = outline.iter().map(|&(radius, height)| ring(AROUND, radius, height)).collect();
    let mut mesh = Mesh::rows(rows, true);
    let last = mesh.points.len() - AROUND;
    mesh.points.push([0.0, 12.0, 0.0]);
    let top = mesh.points.len() - 1;
    mesh.faces.extend((0..AROUND).map(|k| vec![last + k, top, last + (k + 1) % AROUND]));
    mesh
}

/// A flat disc of radius 60 that faces up: its rim first, then ring by ring to the centre.
pub fn trampoline() -> Mesh {
    let radii: Vec<f64> = (0..14).map(|k| 60.0 * (1.0 - f64::from(k) / 14.0)).collect();
    flat_disc(48, &radii)
}

/// The specimen of Cusick's drape test: a disc 30 across, finer where it hangs over a pedestal of 18.
pub fn disc() -> Mesh {
    flat_disc(48, &[15.0, 13.4, 11.8, 10.2, 8.6, 4.3])
}

fn flat_disc(around: usize, radii: &[f64]) -> Mesh {
    let mut mesh = Mesh::rows(radii.iter().map(|radius| ring(around, *radius, 0.0)).collect(), true);
    mesh.faces.iter_mut().for_each(|face| face.reverse());
    let last = mesh.points.len() - around;
    mesh.points.push([0.0; 3]);
    let centre = mesh.points.len() - 1;
    mesh.faces.extend((0..around).map(|k| vec![last + k, last + (k + 1) % around, centre]));
    mesh
}

/// A coil of ribbon: seven turns of radius 4, each 0.3 below the one before, of twelve rows of two points; 1.2 wide.
pub fn slinky() -> Mesh {
    coil(7, -0.3)
}

/// The same coil of fourteen turns, each 0.3 above the one before.
pub fn slinky_standing() -> Mesh {
    coil(14, 0.3)
}

/// A coil of ribbon from its first turn on; `pitch` is the way along y from turn to turn.
fn coil(turns: u32, pitch: f64) -> Mesh {
    let row = |k: u32| {
        let turn = std::f64::consts::TAU * f64::from(k) / 12.0;
        [3.4, 4.6].map(|r| [r * turn.cos(), pitch * f64::from(k) / 12.0, r * turn.sin()]).to_vec()
    };
    Mesh::rows((0..=12 * turns).map(row).collect(), false)
}

/// A paper dart, 20 long and 24 wide at its tail, that points along -z: two wings that rise to the sides, and a tail that is
/// bent up. Nine points a row, seven rows from the nose on.
pub fn aeroplane() -> Mesh {
    let row = |k: u32| {
        let along = f64::from(k) / 6.0;
        let up = if k == 6 { TAIL } else { 0.0 };
        let point = |i: i32| {
            let x = f64::from(i) / 4.0 * (1.0 + 11.0 * along);
            [x, 0.2 * x.abs() + up, 20.0 * along - 10.0]
        };
        (-4..=4).map(point).collect()
    };
    Mesh::rows((0..7).map(row).collect(), false)
}

/// A link of a chain: a tube of radius 0.8 about two half circles of radius 3 with straight sides of 4 between them, in the
/// xy plane.
pub fn chain_link() -> Mesh {
    const ALONG: usize = 24;
    const ROUND: usize = 8;
    let point = |k: usize| {
        let turns = |part: f64| (std::f64::consts::TAU * part).sin_cos();
        let (sin, cos) = turns(((k / ROUND) as f64 + 0.5) / ALONG as f64);
        let (up, out) = turns((k % ROUND) as f64 / ROUND as f64);
        let radius = 3.0 + 0.8 * out;
        [radius * cos, radius * sin + 2.0_f64.copysign(sin), 0.8 * up]
    };
    let count = ALONG * ROUND;
    let corner = |k: usize, j: usize| (k % ALONG) * ROUND + j % ROUND;
    let face = |at: usize| {
        let (k, j) = (at / ROUND, at % ROUND);
        vec![corner(k, j), corner(k + 1, j), corner(k + 1, j + 1), corner(k, j + 1)]
    };
    Mesh { points: (0..count).map(point).collect(), faces: (0..count).map(face).collect() }
}

/// How far the last row of the aeroplane is bent up.
const TAIL: f64 = 0.5;

/// A rope bridge along x, 600 long and 80 wide: 24 planks with gaps between them, and a net of 35 on either side. Four
/// points a row: rail, deck, deck, rail; two rows a plank.
pub fn bridge() -> Mesh {
    let row = |k: u32| {
        let x = f64::from(k / 2) * 25.0 + f64::from(k % 2) * 22.0 - 298.5;
        vec![[x, 35.0, -46.0], [x, 0.0, -40.0], [x, 0.0, 40.0], [x, 35.0, 46.0]]
    };
    Mesh::rows((0..48).map(row).collect(), false)
}
