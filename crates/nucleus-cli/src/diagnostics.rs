//! What is said about a scene, shown at its place in the file, on standard error.

use std::io::{IsTerminal, Write, stderr};
use std::ops::Range;

use anyhow::Result;
use codespan_reporting::diagnostic::{Diagnostic as Shown, Label};
use codespan_reporting::files::SimpleFile;
use codespan_reporting::term::termcolor::{Buffer, BufferWriter, ColorChoice};
use codespan_reporting::term::{Config, emit_to_write_style};
use nucleus_graph::scene::{Diagnostic, Severity};

use crate::figures;

/// Prints them all, each with its place in `text`, and a count.
pub fn print(diagnostics: &[Diagnostic], text: &str) -> Result<()> {
    if diagnostics.is_empty() {
        return Ok(());
    }
    // `Auto` heeds NO_COLOR, but not where the output goes.
    let choice = if stderr().is_terminal() { ColorChoice::Auto } else { ColorChoice::Never };
    let writer = BufferWriter::stderr(choice);
    let mut buffer = writer.buffer();
    for diagnostic in diagnostics {
        show(diagnostic, text, &mut buffer)?;
    }
    writeln!(buffer, "{}", count(diagnostics))?;
    Ok(writer.print(&buffer)?)
}

/// `2 errors, 1 warning`.
pub fn count(diagnostics: &[Diagnostic]) -> String {
    let number = |severity| diagnostics.iter().filter(|diagnostic| diagnostic.severity == severity).count();
    let (errors, warnings) = (number(Severity::Error), number(Severity::Warning));
    match (errors, warnings) {
        (0, 0) => "no errors, no warnings".to_owned(),
        (0, warnings) => figures::count(warnings, "warning"),
        (errors, 0) => figures::count(errors, "error"),
        (errors, warnings) => {
            format!("{}, {}", figures::count(errors, "error"), figures::count(warnings, "warning"))
        }
    }
}

fn show(diagnostic: &Diagnostic, text: &str, buffer: &mut Buffer) -> Result<()> {
    let name = diagnostic.file.display().to_string();
    let file = SimpleFile::new(&name, text);
    let shown = match diagnostic.severity {
        Severity::Error => Shown::error(),
        Severity::Warning => Shown::warning(),
    };
    let mut labels = Vec::new();
    let mut notes = Vec::new();
    if let Some(span) = place(&diagnostic.span, text) {
        labels.push(Label::primary((), span).with_message(diagnostic.help.as_deref().unwrap_or_default()));
    } else {
        notes.extend(diagnostic.help.clone());
    }
    for note in &diagnostic.notes {
        match note.span.as_ref().and_then(|span| place(span, text)) {
            Some(span) => labels.push(Label::secondary((), span).with_message(&note.message)),
            None => notes.push(note.message.clone()),
        }
    }
    let shown = shown.with_message(&diagnostic.message).with_labels(labels).with_notes(notes);
    emit_to_write_style(buffer, &Config::default(), &file, &shown)?;
    Ok(())
}

/// A span that can be shown: not that of the file as a whole, and not beyond the text.
fn place(span: &Range<usize>, text: &str) -> Option<Range<usize>> {
    (*span != (0..0) && span.start <= span.end && span.end <= text.len()).then(|| span.clone())
}
