//! The fields of a record. A reader takes the fields that it knows, and refuses the rest.

use std::ops::Range;

use crate::diagnostic::{Findings, listed, nearest};
use crate::scene::syntax::{Node, Value, Word};

use super::value::found;

/// Fields that have not been taken yet.
pub(super) struct Fields<'a> {
    left: Vec<(&'a Word, &'a Node)>,
    /// The place of errors about the record as a whole.
    place: Range<usize>,
}

impl<'a> Fields<'a> {
    /// The fields of a record. A repeated field is an error.
    pub(super) fn new(fields: &'a [(Word, Node)], place: Range<usize>, findings: &mut Findings) -> Self {
        let mut left: Vec<(&Word, &Node)> = Vec::new();
        for (word, node) in fields {
            if let Some((first, _)) = left.iter().find(|(first, _)| first.text == word.text) {
                let error = findings.error(&word.span, format!("`{}` is given twice", word.text));
                error.note_at(&first.span, "here for the first time");
            } else {
                left.push((word, node));
            }
        }
        Self { left, place }
    }

    /// The fields of `Scene(...)`.
    pub(super) fn of_scene(root: &'a Node, findings: &mut Findings) -> Option<Self> {
        let help = "a scene file begins with `Scene(time: (start: 1, end: 120, fps: 24), nodes: {`";
        let (name, fields) = match &root.value {
            Value::Record { name, fields } => (name, fields),
            other => {
                findings
                    .error(&root.span, format!("expected `Scene(...)`, found {}", found(other)))
                    .help(help);
                return None;
            }
        };
        match name {
            Some(word) if word.text == "Scene" => Some(Self::new(fields, word.span.clone(), findings)),
            Some(word) => {
                findings.error(&word.span, format!("expected `Scene`, found `{}`", word.text)).help(help);
                Some(Self::new(fields, word.span.clone(), findings))
            }
            None => {
                let start = root.span.start..root.span.start + 1;
                findings.error(&start, "expected `Scene` before this bracket").help(help);
                Some(Self::new(fields, start, findings))
            }
        }
    }

    /// Takes a field.
    pub(super) fn take(&mut self, name: &str) -> Option<&'a Node> {
        let at = self.left.iter().position(|(word, _)| word.text == name)?;
        Some(self.left.remove(at).1)
    }

    /// Takes a required field.
    pub(super) fn take_required(
        &mut self,
        name: &str,
        example: &str,
        findings: &mut Findings,
    ) -> Option<&'a Node> {
        let node = self.take(name);
        // `refuse_rest` reports a misspelt field.
        let misspelt = self.left.iter().any(|(word, _)| nearest(&word.text, [name]).is_some());
        if node.is_none() && !misspelt {
            findings.error(&self.place, format!("`{name}` is missing")).help(format!("add {example}"));
        }
        node
    }

    /// Refuses the fields that have not been taken.
    pub(super) fn refuse_rest(&self, owner: &str, names: &[&str], findings: &mut Findings) {
        for (word, _) in &self.left {
            let error = findings.error(&word.span, format!("{owner} has no `{}`", word.text));
            match nearest(&word.text, names.iter().copied()) {
                Some(name) => error.did_you_mean(Some(name)),
                None => error.help(format!("it takes {}", listed(names))),
            };
        }
    }
}

/// The current name of a word. `renamed` has pairs of a former and the current name; a former name is a warning.
pub(super) fn current_name<'a>(
    word: &'a str,
    renamed: &[(&str, &'static str)],
    span: &Range<usize>,
    findings: &mut Findings,
) -> &'a str {
    let Some((_, current)) = renamed.iter().find(|(former, _)| *former == word) else { return word };
    let warning = findings.warning(span, format!("`{word}` is now called `{current}`"));
    warning.help(format!("write `{current}` in its place"));
    current
}
