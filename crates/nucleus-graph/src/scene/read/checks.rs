//! `checks: [noPenetration, maxStretch(0.02), atRestBy(frame: 100, speed: 0.01)]`.

use crate::checks::{Check, Form, MAX_MEASURED_GAP, RENAMED, Values};
use crate::diagnostic::{Findings, listed, nearest};
use crate::scene::syntax::{Node, Value, Word};

use super::fields::{Fields, current_name};
use super::value::{found, number, whole_number};

/// Reads the checks of a scene whose last frame is `end`, if that could be read.
pub(super) fn read(node: &Node, end: Option<i64>, findings: &mut Findings) -> Vec<Check> {
    let Value::List(items) = &node.value else {
        let message = format!("`checks` takes a list, found {}", found(&node.value));
        findings.error(&node.span, message).help("write `checks: [noPenetration]`");
        return Vec::new();
    };
    let mut checks = Vec::new();
    for item in items {
        let Some(check) = read_check(item, findings) else { continue };
        warn_of_late_check(&check, item, end, findings);
        checks.push(check);
    }
    checks
}

/// Warns of a check that applies from a frame on that the scene does not reach: it fails, unless the run is longer.
fn warn_of_late_check(check: &Check, node: &Node, end: Option<i64>, findings: &mut Findings) {
    let (Some(first), Some(end)) = (check.first_frame(), end) else { return };
    if first > end as f64 {
        let message = format!("`{check}` cannot pass: the scene ends at frame {end}");
        findings
            .warning(&node.span, message)
            .help("a check that applies to no frame fails: name an earlier one");
    }
}

fn read_check(node: &Node, findings: &mut Findings) -> Option<Check> {
    let (name, span) = match &node.value {
        Value::Word(name) => (name, &node.span),
        Value::Tuple { name: Some(Word { text, span }), .. }
        | Value::Record { name: Some(Word { text, span }), .. } => (text, span),
        other => {
            findings.error(&node.span, format!("expected a check, found {}", found(other))).help(all_names());
            return None;
        }
    };
    let name = current_name(name, RENAMED, span, findings);
    let Some(form) = Form::all().iter().find(|form| form.name == name) else {
        let error = findings.error(span, format!("there is no check `{name}`"));
        match nearest(name, Form::all().iter().map(|form| form.name)) {
            Some(nearest) => error.did_you_mean(Some(nearest)),
            None => error.help(all_names()),
        };
        return None;
    };
    let arguments = arguments(form, node, findings)?;
    let check = Check::new(form.name, &arguments)?;
    if check.is_below_zero() {
        let message = format!("`{check}` cannot pass: what it limits is never below 0");
        findings.error(&node.span, message).help(form.doc);
        return None;
    }
    Some(check)
}

fn arguments(form: &Form, node: &Node, findings: &mut Findings) -> Option<Vec<f64>> {
    let label = |parameter: &str| format!("`{parameter}` of `{}`", form.name);
    let values: Vec<&Node> = match &node.value {
        Value::Record { fields, .. } => {
            let mut fields = Fields::new(fields, node.span.clone(), findings);
            let take =
                |parameter: &&str| fields.take_required(parameter, &format!("`{parameter}: ...`"), findings);
            let values: Vec<Option<&Node>> = form.parameters.iter().map(take).collect();
            fields.refuse_rest(&format!("`{}`", form.name), form.parameters, findings);
            values.into_iter().collect::<Option<_>>()?
        }
        Value::Tuple { items, .. } => items.iter().collect(),
        _ => Vec::new(),
    };
    if values.len() != form.parameters.len() {
        let takes = match form.parameters {
            [] => "nothing".to_owned(),
            parameters => listed(parameters),
        };
        findings.error(&node.span, format!("`{}` takes {takes}", form.name)).help(form.doc);
        return None;
    }
    let values: Vec<Option<f64>> = form
        .parameters
        .iter()
        .zip(values)
        .map(|(parameter, value)| match form.values {
            Values::Numbers => number(&label(parameter), value, findings),
            Values::Counts => count(&label(parameter), value, findings),
            Values::Gaps => gap(form, &label(parameter), value, findings),
        })
        .collect();
    values.into_iter().collect()
}

/// A whole number from 0.
fn count(label: &str, node: &Node, findings: &mut Findings) -> Option<f64> {
    let count = whole_number(label, node, findings)?;
    if count < 0.0 {
        findings.error(&node.span, format!("{label} takes a whole number from 0, found {count}"));
        return None;
    }
    Some(count)
}

/// A gap ratio as far as it is measured.
fn gap(form: &Form, label: &str, node: &Node, findings: &mut Findings) -> Option<f64> {
    let gap = number(label, node, findings)?;
    if gap > MAX_MEASURED_GAP {
        let name = form.name;
        let message =
            format!("`{name}` takes at most {MAX_MEASURED_GAP}: gaps above the thickness are not measured");
        findings
            .error(&node.span, message)
            .help(format!("write `{name}({MAX_MEASURED_GAP})`, or raise `thickness`"));
        return None;
    }
    Some(gap)
}

fn all_names() -> String {
    let names: Vec<&str> = Form::all().iter().map(|form| form.name).collect();
    format!("there are {}", listed(&names))
}
