//! When a nucleus begins, and what drives it.

use crate::attributes::nucleus;
use crate::graph::NodeId;
use crate::scene::{Findings, Scene, TimeSpan};

/// The frame at which a nucleus begins: where the scene's time and, if it says so, the nucleus have begun.
pub(super) fn start(scene: &Scene, nucleus: NodeId, findings: &mut Findings) -> i64 {
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
        return start_frame.ceil() as i64;
    } else if start_frame < start as f64 {
        let message = format!("frames before {start}, where the scene's time begins, are not solved");
        findings.warning(&place, message);
    }
    start
}

/// A nucleus that no time drives is never solved.
pub(super) fn check_driven(scene: &Scene, nucleus: NodeId, findings: &mut Findings) {
    if scene.graph.source(nucleus, &nucleus::CURRENT_TIME).is_none() {
        let name = scene.graph.node(nucleus).name();
        let message = format!("nothing is connected to `{name}.currentTime`: nothing is solved");
        let warning = findings.warning(&scene.source.place(name), message);
        warning.help(format!("connect `time1.outTime` to `{name}.currentTime`"));
    }
}
