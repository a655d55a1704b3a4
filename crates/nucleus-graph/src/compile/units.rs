//! Space and time of a nucleus: metres per scene unit, and the frame at which it starts.
//!
//! A scene unit is `spaceScale` metres (N1.3-1). Positions and thicknesses are in scene units; gravity, wind, masses
//! and forces are in metres, kilograms and seconds. An object therefore falls with gravity / `spaceScale`, in scene
//! units per second squared. No other file converts scene units to metres.

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::animation::Affine;
use crate::attributes::{Choice, nucleus};
use crate::diagnostic::Findings;
use crate::graph::{NodeId, Setting};
use crate::scene::document::{Scene, TimeSpan};

/// `resistanceModel: classic`.
pub(super) const CLASSIC: Choice = Choice(0);

/// The length of a scene unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Units {
    metres_per_unit: f64,
}

impl Units {
    /// From `spaceScale`, which is above zero.
    pub(super) fn new(space_scale: f64) -> Self {
        Self { metres_per_unit: space_scale }
    }

    /// A length in metres.
    pub(super) fn length(self, units: f64) -> f64 {
        units * self.metres_per_unit
    }

    /// A position in metres.
    pub(super) fn point(self, units: Vector3<f64>) -> Vector3<f64> {
        units * self.metres_per_unit
    }

    /// The points of a placed mesh in metres.
    pub(super) fn placed(self, placement: &Affine, points: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        points.iter().map(|point| self.point(placement.point(*point))).collect()
    }

    /// A position in scene units.
    pub(super) fn scene_point(self, metres: Vector3<f64>) -> Vector3<f64> {
        metres / self.metres_per_unit
    }

    /// A surface in metres.
    pub(super) fn surface(self, mut surface: Surface) -> Surface {
        for position in &mut surface.positions {
            *position = self.point(*position);
        }
        surface
    }

    /// Scene units per metre.
    pub(super) fn per_metre(self) -> f64 {
        1.0 / self.metres_per_unit
    }
}

/// The time of a nucleus after which it is solved, in frames of its `currentTime`: its `startFrame`, but not before its time
/// at the first frame of the scene. Without `startFrame` it is solved from that frame on.
pub(super) fn start_time(scene: &Scene, nucleus: NodeId, start_frame: i64) -> f64 {
    let first = scene.time.start;
    let now = scene.graph.at(first as f64).get(nucleus, &nucleus::CURRENT_TIME);
    if start_frame > first {
        start_frame as f64
    } else if scene.graph.is_given(nucleus, &nucleus::START_FRAME) {
        now.max(scene.graph.at(first as f64).get(nucleus, &nucleus::START_FRAME))
    } else {
        now
    }
}

/// The start frame of a nucleus: its `startFrame`, but not before the first frame of the scene.
pub(super) fn start_frame(scene: &Scene, nucleus: NodeId, findings: &mut Findings) -> i64 {
    let TimeSpan { start, end, .. } = scene.time;
    let node = scene.graph.node(nucleus);
    let set = node.setting(&nucleus::START_FRAME).is_some();
    let fed = scene.graph.source(nucleus, &nucleus::START_FRAME).is_some();
    if !set && !fed {
        return start;
    }
    let start_frame = scene.graph.at(start as f64).get(nucleus, &nucleus::START_FRAME);
    let place = scene.source.place(&format!("{}.startFrame", node.name()));
    if start_frame > end as f64 {
        let message = format!("`startFrame` of `{}` comes after the last frame, {end}", node.name());
        findings.error(&place, message);
    } else if start_frame > start as f64 {
        let first = start_frame.ceil();
        if first > start_frame {
            let name = node.name();
            let message = format!("`startFrame` of `{name}` is {start_frame}: it starts at frame {first}");
            findings.warning(&place, message).help("nuclei start at whole frames");
        }
        return first as i64;
    } else if start_frame < start as f64 {
        let message = format!("frames before {start}, where the scene's time begins, are not solved");
        findings.warning(&place, message);
    }
    start
}

/// Warns of a nucleus whose time has no input or stands still: it is never solved.
pub(super) fn check_time_input(scene: &Scene, nucleus: NodeId, findings: &mut Findings) {
    let node = scene.graph.node(nucleus);
    let is_still = match node.setting(&nucleus::CURRENT_TIME) {
        Some(Setting::Fixed(_)) | None => true,
        Some(Setting::Keyed(_) | Setting::Parts(_)) => false,
    };
    if is_still && scene.graph.source(nucleus, &nucleus::CURRENT_TIME).is_none() {
        let name = node.name();
        let message = format!("nothing is connected to `{name}.currentTime`: nothing is solved");
        let warning = findings.warning(&scene.source.place(name), message);
        warning.help(format!("connect `time1.outTime` to `{name}.currentTime`"));
    }
}
