//! `time: (start: 1, end: 120, fps: 24)` and `record: every(10)`.

use crate::diagnostic::{Findings, value_of};
use crate::scene::document::{MAX_FRAME, Record, TimeSpan, evaluation_interval, is_frame_rate};
use crate::scene::syntax::{Node, Value};

use super::fields::Fields;
use super::value::{found, number, whole_number};

/// Reads the frames of a run, and the evaluation interval in frames.
pub(super) fn read(node: Option<&Node>, findings: &mut Findings) -> Option<(TimeSpan, f64)> {
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
    let every = fields.take("every");
    fields.refuse_rest("`time`", &["start", "end", "fps", "every"], findings);
    let first = start.and_then(|node| frame("start", node, findings));
    let last = end.and_then(|node| frame("end", node, findings));
    let fps = fps.and_then(|node| frames_per_second(node, findings));
    let every = every.map_or(Some(1.0), |node| evaluations(node, findings));
    let span = TimeSpan { start: first?, end: last?, fps: fps? };
    if span.start > span.end {
        let (start, end) = (start?, end?);
        let message = format!("the run starts at frame {} and ends before it, at {}", span.start, span.end);
        findings.error(&end.span, message).note_at(&start.span, "the start is here");
        return None;
    }
    Some((span, every?))
}

fn frame(name: &str, node: &Node, findings: &mut Findings) -> Option<i64> {
    let frame = whole_number(&format!("`{name}`"), node, findings)?;
    if frame.abs() > MAX_FRAME as f64 {
        findings.error(&node.span, format!("frame {frame} is beyond the limit of {MAX_FRAME}"));
        return None;
    }
    Some(frame as i64)
}

fn frames_per_second(node: &Node, findings: &mut Findings) -> Option<f64> {
    let fps = number("`fps`", node, findings)?;
    if !is_frame_rate(fps) {
        let bounds = if fps <= 0.0 { "above 0" } else { "from 0.001 to 1000000" };
        let error = findings.error(&node.span, format!("`fps` must be {bounds}, found {fps}"));
        error.help("Maya's film is 24, PAL 25, NTSC 30");
        return None;
    }
    Some(fps)
}

/// The evaluation interval: a whole number of frames, or the reciprocal of one.
fn evaluations(node: &Node, findings: &mut Findings) -> Option<f64> {
    let every = number("`every`", node, findings)?;
    if let Some(interval) = evaluation_interval(every) {
        return Some(interval);
    }
    let message = format!("`every` must be a whole number of frames, or 1 divided by one, found {every}");
    findings.error(&node.span, message).help("2 evaluates every other frame, 0.25 four times in each");
    None
}

/// Reads `record`.
pub(super) fn read_record(node: &Node, findings: &mut Findings) -> Option<Record> {
    let words = [("frames", Record::Frames), ("substeps", Record::Substeps), ("none", Record::None)];
    if let Value::Word(word) = &node.value
        && let Some(record) = value_of(word, words)
    {
        return Some(record);
    }
    match &node.value {
        Value::Tuple { name: Some(name), items } if name.text == "every" => every(items).or_else(|| {
            let error = findings.error(&node.span, "`every` takes a whole number above zero".to_owned());
            error.help("`every(10)` records each tenth frame and the last");
            None
        }),
        other => {
            let error = findings.error(&node.span, format!("`record` takes a word, found {}", found(other)));
            error.help("write `frames`, `substeps`, `every(10)` or `none`");
            None
        }
    }
}

/// `every(10)`.
fn every(items: &[Node]) -> Option<Record> {
    match items {
        [Node { value: Value::Number(n), .. }] if n.fract() == 0.0 && (1.0..=1e9).contains(n) => {
            Some(Record::Every(*n as u32))
        }
        _ => None,
    }
}
