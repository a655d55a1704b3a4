//! Gathers what there is to say while a scene is read or compiled.

use std::ops::Range;
use std::path::PathBuf;

use super::diagnostic::{Diagnostic, Note, Severity};

/// Diagnostics of one file.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    file: PathBuf,
    all: Vec<Diagnostic>,
}

impl Findings {
    /// Nothing to say yet.
    pub(crate) fn new(file: PathBuf) -> Self {
        Self { file, all: Vec::new() }
    }

    /// Adds an error; help and notes can be given to what comes back.
    pub(crate) fn error(&mut self, span: &Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Error, span, message.into())
    }

    /// Adds a warning.
    pub(crate) fn warning(&mut self, span: &Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Warning, span, message.into())
    }

    /// How many there are; to see whether something has been found since.
    pub(crate) fn errors(&self) -> usize {
        self.all.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count()
    }

    /// Adds what was found elsewhere.
    pub(crate) fn extend(&mut self, diagnostics: Vec<Diagnostic>) {
        self.all.extend(diagnostics);
    }

    /// All of them in the order of the file.
    pub(crate) fn in_order(mut self) -> Vec<Diagnostic> {
        self.all.sort_by_key(|diagnostic| (diagnostic.span.start, diagnostic.span.end));
        self.all
    }

    fn push(&mut self, severity: Severity, span: &Range<usize>, message: String) -> &mut Diagnostic {
        let (file, span) = (self.file.clone(), span.clone());
        self.all.push(Diagnostic { severity, message, file, span, help: None, notes: Vec::new() });
        let last = self.all.len() - 1;
        &mut self.all[last]
    }
}

impl Diagnostic {
    /// Adds what can be done about it.
    pub(crate) fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(help.into());
        self
    }

    /// Adds `did you mean ...`, if there is anything near.
    pub(crate) fn did_you_mean(&mut self, nearest: Option<&str>) -> &mut Self {
        match nearest {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// Adds another place.
    pub(crate) fn note_at(&mut self, span: &Range<usize>, message: impl Into<String>) -> &mut Self {
        self.notes.push(Note { message: message.into(), span: Some(span.clone()) });
        self
    }
}
