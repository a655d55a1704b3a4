//! What a result belongs to: a scene and a solver, each as a number.

use nucleus_graph::Simulation;
use nucleus_graph::compile::compile;
use nucleus_graph::scene::read_scene_text;

/// Adds words up to a number that is the same for the same words only (FNV-1a over 64 bits).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Takes up bytes.
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        self
    }

    /// Sixteen digits, fit for the name of a file.
    pub fn name(self) -> String {
        format!("{:016x}", self.0)
    }
}

/// A scene in which everything happens that a scene can ask for, so that a solver that does anything otherwise ends
/// it with other bits.
const CANARY: &str = r#"Scene(
    time: (start: 1, end: 9, fps: 24),
    nodes: {
        "n": nucleus(spaceScale: 0.01, usePlane: true, windSpeed: 2, subSteps: 2, evaluations: 8, resistanceModel: MODEL),
        "p": polyPlane(width: 60, height: 60, subdivisions: (6, 6), translate: (3, 22, 0), rotate: (0, 10, 4)),
        "c": nCloth(inputMesh: "p", shearResistance: 2, bendResistance: 1, damp: 0.1, friction: 0.3, bounce: 0.2, thickness: 1),
        "d": dynamicConstraint(constraintType: transform, components: ["c.vtx[0]"], translateY: keys([(1, 22), (9, 30)])),
        "s": polySphere(radius: 18, subdivisions: (8, 6)),
        "r": nRigid(inputMesh: "s", friction: 0.2),
    },
)"#;

/// The solver: its version, and the bits it ends a small scene with. A build that computes anything else is another
/// solver, whatever its version says.
pub fn solver() -> Fingerprint {
    let version = Fingerprint::default().bytes(env!("CARGO_PKG_VERSION").as_bytes());
    ["physical", "classic"].iter().fold(version, |print, model| {
        let text = CANARY.replace("MODEL", model);
        let scene = read_scene_text(&text, "canary.ron".as_ref());
        let program = scene.ok().and_then(|(scene, _)| compile(&scene).ok());
        let hash = program.map_or(0, |program| {
            let mut run: Simulation = Simulation::new(&program, 1);
            while !run.is_done() {
                run.advance(&mut ());
            }
            run.solver().state_hash()
        });
        print.bytes(&hash.to_le_bytes())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_bytes_are_another_number() {
        let of = |text: &str| Fingerprint::default().bytes(text.as_bytes()).name();
        assert_eq!(of("a"), "af63dc4c8601ec8c"); // as published with the algorithm
        assert_ne!(of("ab"), of("ba"));
    }

    #[test]
    fn the_solver_has_the_same_number_each_time_and_its_small_scene_can_run() {
        assert_eq!(solver(), solver());
        for model in ["physical", "classic"] {
            let (scene, _) = read_scene_text(&CANARY.replace("MODEL", model), "c".as_ref()).unwrap();
            assert!(compile(&scene).is_ok());
        }
    }
}
