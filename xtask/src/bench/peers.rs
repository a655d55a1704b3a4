//! Figures of other solvers on the same workloads on one core.

use super::workload::Workload::{self, Drape, Swing};

/// When and how the figures below were taken.
pub const SOURCE: &str = "The peers' figures were taken on 21 November 2026 on two shared cores of a Xeon with \
    AVX-512: processor time in the stepping call, one thread, many of them a single run.";

/// A run of another solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peer {
    /// Its name.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
    /// Its setting.
    pub setting: &'static str,
    /// The workload.
    pub workload: Workload,
    /// Points along each side of the cloth.
    pub size: u32,
    /// Milliseconds of processor time per frame.
    pub ms: f64,
    /// W1: RMS strain of all edges over all frames. W2: RMS stretch at the last frame. In percent; endless
    /// if the run diverged.
    pub error: f64,
    /// Deepest point in the ball at the last frame and at the worst, in millimetres, where it was noted.
    pub depth: Option<[f64; 2]>,
}

const JOLT: (&str, &str) = ("Jolt", "5.5.1");
const PBD: (&str, &str) = ("pyPBD", "2.2.2");
const BLENDER: (&str, &str) = ("Blender", "4.5.15");
const NEWTON: (&str, &str) = ("Newton", "1.8.0");
const MUJOCO: (&str, &str) = ("MuJoCo", "4.0.0");
const RAPIER: (&str, &str) = ("rapier3d", "0.36");
const RAPIER_CLOTH: (&str, &str) = ("rapier-cloth", "0.3.0");
const LOST: f64 = f64::INFINITY;

/// All of them, by workload and size.
pub const PEERS: &[Peer] = &[
    w1(33, JOLT, "10 substeps", 0.28, 8.8),
    w1(33, JOLT, "30 substeps", 0.82, 1.26),
    w1(33, JOLT, "100 substeps", 2.88, 0.17),
    w1(33, JOLT, "300 substeps", 8.2, 0.06),
    w1(33, PBD, "10 substeps", 0.80, 10.5),
    w1(33, PBD, "30 substeps", 2.20, 1.57),
    w1(33, PBD, "100 substeps", 7.33, 0.22),
    w1(33, PBD, "300 substeps", 20.9, 0.058),
    w1(33, RAPIER, "", 13.5, 0.54),
    w1(33, RAPIER, "", 44.0, 0.09),
    w1(33, RAPIER_CLOTH, "", 18.0, 2.6),
    w1(33, RAPIER_CLOTH, "", 58.2, 0.74),
    w1(33, NEWTON, "XPBD 40 x 2, ke 20", 19.5, 4.7),
    w1(33, NEWTON, "XPBD 100 x 1, ke 100", 30.1, 1.4),
    w1(33, NEWTON, "VBD 5 x 10", 107.0, 17.0),
    w1(33, NEWTON, "VBD 10 x 20", 425.0, 1.5),
    w1(33, MUJOCO, "10 steps", 23.1, 0.66),
    w1(33, BLENDER, "quality 5, tension 200", 30.8, 0.054),
    w1(33, BLENDER, "quality 5, tension 2000", 31.4, 0.011),
    w1(65, JOLT, "10 substeps", 1.19, 41.0),
    w1(65, JOLT, "30 substeps", 3.25, 7.4),
    w1(65, JOLT, "100 substeps", 10.9, 2.9),
    w1(65, JOLT, "300 substeps", 32.4, 1.8),
    w1(65, PBD, "10 substeps", 3.1, 34.0),
    w1(65, PBD, "30 substeps", 9.05, 5.6),
    w1(65, PBD, "100 substeps", 29.4, 0.74),
    w1(65, PBD, "300 substeps", 87.3, 0.14),
    w1(65, RAPIER, "", 182.0, 0.235),
    w1(65, BLENDER, "quality 5, tension 200", 128.0, 0.11),
    w1(65, BLENDER, "quality 5, tension 2000", 126.0, 0.023),
    w1(129, JOLT, "10 substeps", 4.6, LOST),
    w1(129, JOLT, "30 substeps", 13.1, 57.0),
    w1(129, JOLT, "100 substeps", 44.9, 6.9),
    w1(129, JOLT, "300 substeps, sag 0.86", 134.0, 3.3),
    w1(129, PBD, "10 substeps", 13.8, 147.0),
    w1(129, PBD, "30 substeps", 39.7, 18.0),
    w1(129, PBD, "100 substeps", 135.0, 2.5),
    w1(129, RAPIER, "", 784.0, 0.80),
    w1(129, BLENDER, "quality 5, tension 200", 560.0, 0.20),
    w1(129, BLENDER, "quality 5, tension 2000, sag 0.82", 561.0, 0.03),
    w1(257, PBD, "30 substeps", 170.0, 61.0),
    w1(257, JOLT, "100 substeps", 220.0, LOST),
    w2(65, JOLT, "30 substeps", 4.53, 4.0, [0.0, 38.0]),
    w2(65, PBD, "4 steps x 20", 28.2, 0.45, [12.8, 31.0]),
    Peer { depth: None, ..w2(65, RAPIER, "0 mm deep at the end", 108.0, 0.65, [0.0; 2]) },
    w2(65, BLENDER, "quality 5", 221.0, 0.24, [0.0, 0.0]),
    w2(129, JOLT, "30 substeps", 18.7, 5.6, [0.0, 92.0]),
    w2(129, PBD, "4 steps x 20", 123.0, 0.79, [8.0, 42.0]),
    Peer { depth: None, ..w2(129, RAPIER, "", 503.0, 1.34, [0.0; 2]) },
    Peer { depth: None, ..w2(129, RAPIER, "", 1390.0, 0.30, [0.0; 2]) },
    w2(129, BLENDER, "quality 5", 790.0, 0.27, [0.0, 27.0]),
];

const fn w1(
    size: u32,
    (name, version): (&'static str, &'static str),
    setting: &'static str,
    ms: f64,
    error: f64,
) -> Peer {
    Peer { name, version, setting, workload: Swing, size, ms, error, depth: None }
}

const fn w2(
    size: u32,
    (name, version): (&'static str, &'static str),
    setting: &'static str,
    ms: f64,
    error: f64,
    depth: [f64; 2],
) -> Peer {
    Peer { name, version, setting, workload: Drape, size, ms, error, depth: Some(depth) }
}
