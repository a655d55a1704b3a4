//! Time of particles by number, kind and threads: `cargo run --release -p nucleus-core --example particles`.
//!
//! Free particles fall on a ball and the ground and do not collide with each other: one substep and one collision pass
//! suffice for them. Colliding ones are loose grains that fall into a heap. The liquid is a block of water on the ground.
//! Arguments are the largest number of particles, and the kinds (`free`, `colliding`, `liquid`); all by default.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use nalgebra::Vector3;
use nucleus_core::{
    Cloth, ClothFrame, ClothLists, Collider, ColliderFrame, Elements, Faces, FrameInput, GroundPlane, Liquid,
    Mass, ModelBuilder, Particles, ResistanceModel, SelfCollision, Solver, Surface,
};

type Vec3 = Vector3<f64>;

/// How particles act on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Free,
    Colliding,
    Liquid,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Free, Self::Colliding, Self::Liquid];

    fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Colliding => "colliding",
            Self::Liquid => "liquid",
        }
    }

    /// Frames that are timed, after half as many that are not.
    fn frames(self) -> u32 {
        if self == Self::Free { 24 } else { 4 }
    }

    /// Distance of particles at the start in metres, for so many along a side.
    fn spacing(self, side: usize) -> f64 {
        if self == Self::Free { 2.0 / side as f64 } else { 0.02 }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let most = arguments.iter().find_map(|text| text.parse().ok()).unwrap_or(1_000_000);
    let asked = |kind: &Kind| arguments.iter().any(|text| text == kind.name());
    let any = Kind::ALL.iter().any(asked);
    println!("| kind | particles | threads | ms per frame | ns per particle | hash |");
    println!("|------|----------:|--------:|-------------:|----------------:|------|");
    for kind in Kind::ALL.into_iter().filter(|kind| !any || asked(kind)) {
        for count in [10_000, 100_000, 1_000_000].into_iter().filter(|count| *count <= most) {
            let mut hashes = Vec::new();
            for threads in [1, 2] {
                let (milliseconds, hash) = time(kind, count, threads);
                let each = milliseconds * 1e6 / count as f64;
                let name = kind.name();
                println!("| {name} | {count} | {threads} | {milliseconds:.2} | {each:.1} | {hash:016x} |");
                hashes.push(hash);
            }
            assert!(hashes.windows(2).all(|pair| pair[0] == pair[1]), "threads change no bit");
        }
    }
}

/// Milliseconds per frame of so many particles, and the hash of the last state.
fn time(kind: Kind, count: usize, threads: usize) -> (f64, u64) {
    let side = (count as f64).cbrt().ceil() as usize;
    let spacing = kind.spacing(side);
    let place = |k: usize| {
        let [x, y, z] = [k % side, k / (side * side), k / side % side].map(|n| n as f64 * spacing);
        match kind {
            Kind::Free => Vec3::new(x - 1.0, y + 0.6, z - 1.0),
            _ => Vec3::new(x, y - 0.49, z),
        }
    };
    let surface = Surface { positions: (0..count).map(place).collect(), faces: Faces::default() };
    let particles = Some(Particles { capacity: count, ..Particles::default() });
    let mut builder = ModelBuilder::new();
    let lists = ClothLists { self_collision: kind == Kind::Colliding, ..ClothLists::NONE };
    let mass = Mass::PerPoint(if kind == Kind::Free { 1e-3 } else { 1000.0 * spacing.powi(3) });
    builder.cloth(Cloth { particles, ..Cloth::new(surface, mass, lists) }).expect("valid particles");
    builder.collider(Collider { surface: sphere(0.5) }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, threads);
    let input = input(kind, spacing);
    (0..kind.frames() / 2).for_each(|_| _ = solver.step(&input, &mut ()));
    let begin = Instant::now();
    (0..kind.frames()).for_each(|_| _ = solver.step(&input, &mut ()));
    (begin.elapsed().as_secs_f64() * 1e3 / f64::from(kind.frames()), solver.state_hash())
}

fn input(kind: Kind, spacing: f64) -> FrameInput {
    let radius = match kind {
        Kind::Free => 0.002,
        Kind::Colliding => 0.48 * spacing,
        Kind::Liquid => 0.4 * spacing,
    };
    let water = Liquid { spacing, incompressibility: 1.0, viscosity: 0.0, surface_tension: 0.0 };
    let own = SelfCollision { on: true, thickness: radius, elements: Elements::Points, edges: false };
    let balls = ClothFrame {
        thickness: radius,
        elements: Elements::Points,
        self_collision: if kind == Kind::Colliding { own } else { SelfCollision::OFF },
        liquid: (kind == Kind::Liquid).then_some(water),
        ..ClothFrame::default()
    };
    let plane = GroundPlane {
        origin: -Vec3::y() * 0.5,
        normal: Vec3::y(),
        bounce: 0.0,
        friction: 0.2,
        stickiness: 0.0,
    };
    let collider = ColliderFrame {
        collide: kind == Kind::Free,
        thickness: 0.001,
        friction: 0.2,
        ..ColliderFrame::default()
    };
    FrameInput {
        resistance: ResistanceModel::Classic,
        substeps: 1,
        collision_iterations: if kind == Kind::Colliding { 4.0 } else { 1.0 },
        gravity: -Vec3::y() * 9.81,
        plane: Some(plane),
        cloths: vec![balls],
        colliders: vec![collider],
        ..FrameInput::default()
    }
}

/// A sphere about the origin, 64 round and 32 down.
fn sphere(radius: f64) -> Surface {
    let (round, down) = (64u32, 32u32);
    let mut surface = Surface { positions: vec![Vec3::y() * radius], faces: Faces::default() };
    for (j, i) in (1..down).flat_map(|j| (0..round).map(move |i| (j, i))) {
        let (polar, turn) = (PI * f64::from(j) / f64::from(down), TAU * f64::from(i) / f64::from(round));
        let across = Vec3::new(turn.cos(), 0.0, turn.sin()) * polar.sin();
        surface.positions.push((across + Vec3::y() * polar.cos()) * radius);
    }
    surface.positions.push(-Vec3::y() * radius);
    let last = 1 + (down - 1) * round;
    for i in 0..round {
        let next = (i + 1) % round;
        surface.faces.push(&[0, 1 + next, 1 + i]);
        for a in (0..down - 2).map(|j| 1 + j * round) {
            surface.faces.push(&[a + i, a + next, a + next + round]);
            surface.faces.push(&[a + i, a + next + round, a + i + round]);
        }
        surface.faces.push(&[last, last - round + i, last - round + next]);
    }
    surface
}
