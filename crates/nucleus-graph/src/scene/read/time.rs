//! `time: (start: 1, end: 120, fps: 24)`.

use crate::scene::document::TimeSpan;
use crate::scene::findings::Findings;
use crate::scene::syntax::{Node, Value};

use super::fields::Fields;
use super::value::{found, number, whole_number};

/// The most frames a number can name exactly.
const MOST_FRAMES: f64 = 1e9;

/// Reads the frames of a run.
pub(super) fn read(node: Option<&Node>, findings: &mut Findings) -> Option<TimeSpan> {
    let node = node?;
    let Value::Record { name: None, fields } = &node.value else {
        let message = format!("`time` takes start, end and frames per second, found {}", found(&node.value));
        findings.error(&node.span, message).help("write `time: (start: 1, end: 120, fps: 24)`");
        return None;
    };
    let mut fields = Fields::new(fields, node.span.clone(), findings);
    let start = fields.take_required("start", "`start: 1`, the first frame", findings);
    let end = fields.take_required("end", "`end: 120`, the last frame", findings);
    let fps = fields.take_required("fps", "`fps: 24`, the frames per second", findings);
    fields.refuse_rest("`time`", &["start", "end", "fps"], findings);
    let first = start.and_then(|node| frame("start", node, findings));
    let last = end.and_then(|node| frame("end", node, findings));
    let fps = fps.and_then(|node| frames_per_second(node, findings));
    let span = TimeSpan { start: first?, end: last?, fps: fps? };
    if span.start > span.end {
        let (start, end) = (start?, end?);
        let message = format!("the run starts at frame {} and ends before it, at {}", span.start, span.end);
        findings.error(&end.span, message).note_at(&start.span, "the start is here");
        return None;
    }
    Some(span)
}

fn frame(name: &str, node: &Node, findings: &mut Findings) -> Option<i64> {
    let frame = whole_number(&format!("`{name}`"), node, findings)?;
    if frame.abs() > MOST_FRAMES {
        findings.error(&node.span, format!("frame {frame} is too far away"));
        return None;
    }
    Some(frame as i64)
}

fn frames_per_second(node: &Node, findings: &mut Findings) -> Option<f64> {
    let fps = number("`fps`", node, findings)?;
    if !(1e-3..=1e6).contains(&fps) {
        let error =
            findings.error(&node.span, format!("`fps` must be above 0 and at most 1000000, found {fps}"));
        error.help("Maya's film is 24, PAL 25, NTSC 30");
        return None;
    }
    Some(fps)
}
