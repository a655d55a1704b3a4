//! Draws a cloth shaped by a formula, without running a solver:
//! `cargo run --release -p nucleus-view --example draped -- <folder>`.

use nucleus_core::Faces;
use nucleus_view::{AnimationWriter, Bounds, Camera, Colouring, Kind, Object, Style, ViewError, draw};

const SIDE: u32 = 160;

fn main() -> Result<(), ViewError> {
    let folder = std::path::PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    let (faces, rest) = (grid(SIDE), points(|x, z| [x, 0.0, z]));
    let draped = points(drape);
    let ball = sphere(1.0, 0.93);
    let cube = cube([1.9, 0.25, 0.9], 0.25);
    let objects = [
        Object {
            name: "cloth",
            kind: Kind::Cloth,
            faces: &faces,
            positions: &draped,
            rest: Some(&rest),
            radius: None,
            looks: None,
        },
        Object {
            name: "ball",
            kind: Kind::Collider,
            faces: &ball.0,
            positions: &ball.1,
            rest: None,
            radius: None,
            looks: None,
        },
        Object {
            name: "cube",
            kind: Kind::Collider,
            faces: &cube.0,
            positions: &cube.1,
            rest: None,
            radius: None,
            looks: None,
        },
    ];
    let plain = Style::default();
    let camera = Camera::framing(&Bounds::of_interest(&objects), plain.size);
    let begun = std::time::Instant::now();
    draw(&objects, &camera, &plain).write_png(folder.join("plain.png"))?;
    println!("plain.png in {:?}", begun.elapsed());
    let wire = Style { wireframe: true, ..plain.clone() };
    draw(&objects, &camera, &wire).write_png(folder.join("wire.png"))?;
    let strain = Style { colouring: Colouring::Strain { full_scale: 0.25 }, ..plain.clone() };
    draw(&objects, &camera, &strain).write_png(folder.join("strain.png"))?;

    let small = Style { size: [480, 270], ..plain };
    let mut film = AnimationWriter::create(folder.join("film.png"), small.size)?;
    for frame in 0..12 {
        let turn = frame as f32 / 12.0 * std::f32::consts::TAU;
        let eye = [turn.sin() * 6.0, 3.0, turn.cos() * 6.0];
        film.push(&draw(&objects, &Camera { eye, ..camera }, &small), 1.0 / 12.0)?;
    }
    film.finish()
}

/// A sheet that lies on a ball and falls in folds around it.
fn drape(x: f32, z: f32) -> [f32; 3] {
    let (far, around) = ((x * x + z * z).sqrt().max(1e-6), z.atan2(x));
    let hang = ((far - 0.9) / 1.2).clamp(0.0, 1.0);
    let folds = hang * (0.12 * (9.0 * around).sin() + 0.04 * (23.0 * around + 3.0 * far).sin());
    let angle = far.min(1.35) / 1.05;
    let (flat, height) = (1.05 * angle.sin(), 1.0 + 1.05 * angle.cos());
    let beyond = (far - 1.35).max(0.0);
    let radius = flat + folds + beyond * 0.2;
    [x / far * radius, (height - beyond * 0.95).max(0.02), z / far * radius]
}

fn points(at: impl Fn(f32, f32) -> [f32; 3]) -> Vec<[f32; 3]> {
    let place = |k: u32| (k as f32 / SIDE as f32 - 0.5) * 3.6;
    (0..=SIDE)
        .flat_map(|row| (0..=SIDE).map(move |column| (place(column), place(row))))
        .map(|(x, z)| at(x, z))
        .collect()
}

fn grid(side: u32) -> Faces {
    let mut faces = Faces::default();
    for row in 0..side {
        for column in 0..side {
            let a = row * (side + 1) + column;
            faces.push(&[a, a + side + 1, a + side + 2, a + 1]);
        }
    }
    faces
}

fn sphere(height: f32, radius: f32) -> (Faces, Vec<[f32; 3]>) {
    let (rows, columns) = (32u32, 64u32);
    let mut faces = Faces::default();
    let mut points = Vec::new();
    for row in 0..=rows {
        for column in 0..columns {
            let down = row as f32 / rows as f32 * std::f32::consts::PI;
            let around = column as f32 / columns as f32 * std::f32::consts::TAU;
            let out = [down.sin() * around.cos(), down.cos(), -down.sin() * around.sin()];
            points.push([radius * out[0], height + radius * out[1], radius * out[2]]);
            let (a, b) = (row * columns + column, row * columns + (column + 1) % columns);
            if row < rows {
                faces.push(&[a, a + columns, b + columns, b]);
            }
        }
    }
    (faces, points)
}

fn cube(centre: [f32; 3], half: f32) -> (Faces, Vec<[f32; 3]>) {
    let corner =
        |k: usize| std::array::from_fn(|axis| centre[axis] + if k >> axis & 1 == 1 { half } else { -half });
    let sides: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (sides.iter().map(|side| &side[..]).collect(), (0..8).map(corner).collect())
}
