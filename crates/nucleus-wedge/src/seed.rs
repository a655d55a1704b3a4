//! Seeds: runs that begin slightly differently, to see how much of a result is chance.

use std::collections::BTreeSet;

use nucleus_graph::Simulation;
use nucleus_graph::attributes::{Value, n_base};
use nucleus_graph::compile::{Object, ObjectKind, Program};
use nucleus_graph::graph::Setting;
use nucleus_graph::scene::Scene;

/// The largest displacement along each axis, as a share of the mean edge length of a mesh or of the radius of particles.
pub const DISPLACEMENT: f64 = 1e-3;

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every machine.
pub(crate) struct SplitMix(pub u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number from 0 to 1, 1 excluded.
    pub fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The numbers from 0 to `count` in random order (Fisher and Yates).
    pub fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut all: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            let other = (self.share() * (last + 1) as f64) as usize;
            all.swap(last, other);
        }
        all
    }
}

/// The scene with the start positions of all cloth and particles displaced at random by up to [`DISPLACEMENT`].
/// `program` is the program of the scene; the result has to be compiled again. Rest lengths stay unchanged.
pub fn displaced(mut scene: Scene, program: &Program, seed: u32) -> Scene {
    let start: Simulation = Simulation::new(program, 1);
    let mut random = SplitMix(u64::from(seed));
    let mut positions = Vec::new();
    for object in program.objects() {
        let ObjectKind::Cloth(id) = object.kind else { continue };
        start.state().positions(id, program.units_per_metre(), &mut positions);
        let most = DISPLACEMENT * size(object, &positions);
        let mut moved = |x: f32| f64::from(x) + most * (2.0 * random.share() - 1.0);
        // Points that a tear may part begin in one place.
        let displaced =
            positions.iter().take(object.mesh_points).map(|point| point.map(&mut moved)).collect();
        let Some(node) = scene.graph.find(&object.name) else { continue };
        // Vectors fit these attributes of every cloth and particle object.
        let _ = match object.radius {
            Some(_) => scene.set_particle_positions(node, displaced),
            None => {
                scene.graph.set(node, &n_base::START_POSITIONS.row, Setting::Fixed(Value::Vectors(displaced)))
            }
        };
    }
    scene
}

/// The mean edge length of a mesh, or the radius of particles, in scene units.
fn size(object: &Object, positions: &[[f32; 3]]) -> f64 {
    if let Some(radius) = object.radius {
        return radius;
    }
    let mut edges = BTreeSet::new();
    for face in object.faces.iter() {
        let next = face.iter().cycle().skip(1);
        edges.extend(face.iter().zip(next).map(|(a, b)| (*a.min(b) as usize, *a.max(b) as usize)));
    }
    let length = |&(a, b): &(usize, usize)| {
        let d = [0, 1, 2].map(|axis| f64::from(positions[a][axis]) - f64::from(positions[b][axis]));
        d.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use nucleus_graph::compile::compile;
    use nucleus_graph::scene::read_scene_text;

    #[test]
    fn a_mesh_that_can_tear_is_displaced_whole() {
        let text = r#"Scene(time: (start: 1, end: 3, fps: 24), nodes: {
            "n": nucleus(), "p": polyPlane(subdivisions: (2, 2)), "c": nCloth(inputMesh: "p"),
            "t": dynamicConstraint(constraintType: tearableSurface, components: ["c"]),
        })"#;
        let (scene, _) = read_scene_text(text, "a.ron".as_ref()).unwrap();
        let program = compile(&scene).unwrap();
        let seeded = compile(&displaced(scene, &program, 1)).unwrap();
        let places = |program: &Program| {
            let (run, mut out): (Simulation, _) = (Simulation::new(program, 1), Vec::new());
            run.state().positions(nucleus_core::ClothId(0), 1.0, &mut out);
            let distinct: BTreeSet<[u32; 3]> = out.iter().map(|point| point.map(f32::to_bits)).collect();
            (out, distinct.len())
        };
        let (before, after) = (places(&program), places(&seeded));
        assert_eq!((before.0.len(), before.1, after.0.len(), after.1), (16, 9, 16, 9));
        assert_ne!(before.0, after.0);
    }

    #[test]
    fn a_seed_displaces_particles_that_fill_a_volume_and_adds_none() {
        let box_of_eight = "minimumCorner: (-0.1, 0.5, -0.1), maximumCorner: (0.1, 0.7, 0.1)";
        for (filling, count) in [(box_of_eight, 8), ("fillMesh: \"m\"", 1000), ("position: [(0, 0, 0)]", 1)] {
            let text = format!(
                r#"Scene(time: (start: 1, end: 3, fps: 24), nodes: {{
                    "n": nucleus(), "m": polyCube(), "q": nParticle(radius: 0.05, {filling}),
                }})"#
            );
            let (scene, _) = read_scene_text(&text, "a.ron".as_ref()).unwrap();
            let program = compile(&scene).unwrap();
            let seeded = compile(&displaced(scene, &program, 1)).unwrap();
            let counts = [&program, &seeded].map(|program| program.objects()[0].points);
            assert_eq!(counts, [count; 2], "{filling}");
        }
    }

    #[test]
    fn a_seed_displaces_every_point_by_at_most_a_thousandth_of_an_edge() {
        let text = r#"Scene(time: (start: 1, end: 3, fps: 24), nodes: {
            "n": nucleus(spaceScale: 0.01), "p": polyPlane(width: 10, height: 10, subdivisions: (5, 5)),
            "c": nCloth(inputMesh: "p"),
        })"#;
        let (scene, _) = read_scene_text(text, "a.ron".as_ref()).unwrap();
        let program = compile(&scene).unwrap();
        let start = |scene: &Scene| {
            let (run, mut out): (Simulation, _) = (Simulation::new(&compile(scene).unwrap(), 1), Vec::new());
            run.state().positions(nucleus_core::ClothId(0), 100.0, &mut out);
            out
        };
        let (plain, one) = (start(&scene), start(&displaced(scene.clone(), &program, 1)));
        // The edges are 2 long; positions are stored in single precision.
        let apart = |a: &[[f32; 3]], b: &[[f32; 3]]| {
            a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
        };
        assert!((1e-4..=2.001e-3).contains(&apart(&plain, &one)), "{}", apart(&plain, &one));
        assert_eq!(one, start(&displaced(scene.clone(), &program, 1)));
        assert_ne!(one, start(&displaced(scene.clone(), &program, 2)));
    }
}
