//! Measures the audit of one motion of a crumpled sheet: `cargo run --release -p nucleus-audit --example cost`.

use std::time::Instant;

use nalgebra::Vector3;
use nucleus_audit::{Body, CollisionFilter, CollisionMesh, collisions, intersections};

fn main() {
    for n in [33_u32, 65, 129, 257, 500] {
        let quad = |k: u32| {
            let a = k / (n - 1) * n + k % (n - 1);
            [a, a + n, a + n + 1, a + 1]
        };
        let quads: Vec<[u32; 4]> = (0..(n - 1) * (n - 1)).map(quad).collect();
        let body = Body::mesh("sheet", (n * n) as usize, quads.iter().map(|quad| quad.as_slice()));
        let mesh = CollisionMesh::new(vec![body]);
        let place = |k: u32, time: f64| {
            let [x, z] = [k % n, k / n].map(|k| f64::from(k) / f64::from(n - 1));
            // Folds like those of a curtain, and a fall of 5 cm.
            Vector3::new(0.6 * x, 0.05 * (25.0 * x + 3.0 * z + time).sin() - 0.05 * time, z)
        };
        let state = |time: f64| (0..n * n).map(|k| place(k, time)).collect::<Vec<_>>();
        let (before, after) = (state(0.0), state(1.0));
        let begin = Instant::now();
        let events = collisions(&mesh, &CollisionFilter::default(), &before, &after).len();
        let motion = begin.elapsed().as_secs_f64();
        let begin = Instant::now();
        let inside = intersections(&mesh, &CollisionFilter::default(), &after).len();
        let state = begin.elapsed().as_secs_f64();
        println!("{n:4}²: motion {motion:.3} s ({events} events), state {state:.3} s ({inside} inside)");
    }
}
