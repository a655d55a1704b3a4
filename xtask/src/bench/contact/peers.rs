//! Figures of other solvers on W3, W4 and W8 on one core; see [`SOURCE`](crate::bench::peers::SOURCE).

use super::run::RunResult;
use super::workload::Workload::{self, Folds, Layers, Shot};

/// A run of another solver.
#[derive(Debug, Clone, Copy)]
pub struct Peer {
    /// Its name, version and setting.
    pub name: &'static str,
    pub workload: Workload,
    /// Points along each side of a sheet.
    pub size: u32,
    /// Milliseconds of processor time per frame.
    pub ms: f64,
    /// RMS stretch at the last frame in percent, where it was noted.
    pub stretch: Option<f64>,
    /// Penetrations: for W3 and W8 pairs of triangles at the last frame, for W4 points in the ball's path that were behind
    /// its centre just after it passed, and a frame later.
    pub left: &'static str,
}

pub const PEERS: &[Peer] = &[
    peer(Folds, 33, "rapier3d 0.36, 2 x 8", 32.5, Some(0.77), "0"),
    peer(Folds, 33, "rapier3d 0.36, 4 x 8", 50.7, Some(0.44), "0"),
    peer(Folds, 33, "Blender 4.5.15, quality 5", 88.6, None, "7"),
    peer(Folds, 33, "MuJoCo 4.0.0, 20 steps", 132.0, Some(0.50), "0"),
    peer(Folds, 33, "Newton 1.8.0, VBD 5 x 5", 172.0, None, "23"),
    peer(Folds, 33, "rapier-cloth 0.3.0, 10 x 4", 214.0, None, "0"),
    peer(Folds, 33, "Blender 4.5.15, quality 10", 261.0, None, "0"),
    peer(Folds, 65, "rapier3d 0.36, 2 x 8", 166.0, Some(1.29), "226"),
    peer(Folds, 65, "rapier3d 0.36, 4 x 8", 229.0, Some(0.62), "0"),
    peer(Folds, 65, "Blender 4.5.15, quality 5", 241.0, Some(0.27), "0"),
    peer(Folds, 65, "Newton 1.8.0, VBD 5 x 5", 589.0, Some(9.8), "0"),
    peer(Folds, 129, "Blender 4.5.15, quality 5", 873.0, Some(1.8), "8"),
    peer(Shot, 65, "Jolt 5.5.1, 10 x 10", 10.7, None, "0 of 109, 492 of 565"),
    peer(Shot, 65, "rapier3d 0.36, 4 x 8", 114.0, None, "0 of 114, 143 of 264"),
    peer(Shot, 65, "rapier3d 0.36, 10 x 10", 226.0, None, "0 of 142, 336 of 482"),
    peer(Shot, 65, "Blender 4.5.15, quality 80", 1139.0, None, "0 of 145, 472 of 618"),
    peer(Layers, 33, "Blender 4.5.15, quality 5", 410.0, None, "50"),
    peer(Layers, 33, "rapier3d 0.36, 4 x 8", 647.0, Some(0.50), "142"),
    peer(Layers, 33, "Newton 1.8.0, VBD 5 x 5", 1198.0, None, "37"),
];

const fn peer(
    workload: Workload,
    size: u32,
    name: &'static str,
    ms: f64,
    stretch: Option<f64>,
    left: &'static str,
) -> Peer {
    Peer { name, workload, size, ms, stretch, left }
}

/// Our fastest run of no more error and without penetrations.
pub fn answer<'a>(peer: &Peer, runs: &'a [RunResult]) -> Option<&'a RunResult> {
    let clean = |run: &&RunResult| run.audit.is_some_and(|report| report.found() == 0);
    let good = |run: &&RunResult| {
        run.spec.size == peer.size && peer.stretch.is_none_or(|most| 1e2 * run.stretch <= most)
    };
    runs.iter().filter(clean).filter(good).min_by(|a, b| a.ms().total_cmp(&b.ms()))
}
