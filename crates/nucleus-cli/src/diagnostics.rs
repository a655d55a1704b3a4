//! Errors and warnings of a scene, printed on standard error with an excerpt of the file.

use std::io::{IsTerminal, Write, stderr};
use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic as Shown, Label};
use codespan_reporting::files::{Error, Files, SimpleFile};
use codespan_reporting::term::termcolor::{Buffer, BufferWriter, ColorChoice};
use codespan_reporting::term::{Config, emit_to_write_style};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Diagnostic, Scene, Severity, nearest};

use crate::{figures, output};

/// Longest line, in bytes, that is shown whole. Longer lines are cut around the marked place.
const MAX_LINE: usize = 400;
/// Bytes that a cut line keeps on each side of the marked place.
const CONTEXT: usize = 100;
/// Diagnostics that are printed; any further ones are only counted.
const MAX_PRINTED: usize = 100;

/// Prints each diagnostic with its place in `text`, and their count.
pub fn print(diagnostics: &[Diagnostic], text: &str) -> anyhow::Result<()> {
    if diagnostics.is_empty() {
        return Ok(());
    }
    let choice = match output::color() {
        clap::ColorChoice::Always => ColorChoice::Always,
        // `Auto` respects NO_COLOR but does not detect a terminal.
        clap::ColorChoice::Auto if stderr().is_terminal() => ColorChoice::Auto,
        _ => ColorChoice::Never,
    };
    let writer = BufferWriter::stderr(choice);
    let mut buffer = writer.buffer();
    for diagnostic in diagnostics.iter().take(MAX_PRINTED) {
        show(diagnostic, text, &mut buffer)?;
    }
    if let Some(more) = diagnostics.len().checked_sub(MAX_PRINTED).filter(|more| *more > 0) {
        writeln!(buffer, "... and {more} more")?;
    }
    writeln!(buffer, "{}", count(diagnostics))?;
    Ok(writer.print(&buffer)?)
}

/// The program of a scene that was changed after it was read. The error says `message`, and the first diagnostic.
pub fn compile_changed(scene: &Scene, message: &str) -> anyhow::Result<Program> {
    compile(scene).map_err(|found| {
        let first = found.into_iter().next().map(|one| one.message).unwrap_or_default();
        anyhow::anyhow!("{message}: {first}")
    })
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

fn show(diagnostic: &Diagnostic, text: &str, buffer: &mut Buffer) -> anyhow::Result<()> {
    match Excerpt::of(diagnostic, text) {
        Some(Excerpt { text, diagnostic, before }) => show_in(&diagnostic, text, before, buffer),
        None => show_in(diagnostic, text, [0, 0], buffer),
    }
}

/// A cut line, and the diagnostic with its place in it.
struct Excerpt<'a> {
    text: &'a str,
    diagnostic: Diagnostic,
    /// Lines before the excerpt, and characters before it in its line.
    before: [usize; 2],
}

impl<'a> Excerpt<'a> {
    /// `None` if every line of the diagnostic is short.
    fn of(diagnostic: &Diagnostic, text: &'a str) -> Option<Self> {
        let span = place(&diagnostic.span, text)?;
        let start = text[..span.start].rfind('\n').map_or(0, |end| end + 1);
        let end = text[span.end..].find('\n').map_or(text.len(), |end| span.end + end);
        if text[start..end].lines().all(|line| line.len() <= MAX_LINE) {
            return None;
        }
        let from = boundary(text, span.start.saturating_sub(CONTEXT).max(start));
        let first_line = text[span.start..span.end].find('\n').map_or(span.end, |end| span.start + end);
        let shown_end = boundary(text, first_line.min(span.start + CONTEXT));
        let to = boundary(text, (shown_end + CONTEXT).min(end));
        let cut = text[from..to].lines().next().unwrap_or_default();
        let mut own = diagnostic.clone();
        own.span = span.start - from..(shown_end - from).min(cut.len());
        own.notes.iter_mut().for_each(|note| note.span = None);
        let before = [text[..start].matches('\n').count(), text[start..from].chars().count()];
        Some(Self { text: cut, diagnostic: own, before })
    }
}

/// The nearest character boundary at or before a byte.
fn boundary(text: &str, at: usize) -> usize {
    (0..=at).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// An excerpt that reports the lines and columns of the whole file.
struct Part<'a> {
    file: SimpleFile<&'a str, &'a str>,
    before: [usize; 2],
}

impl<'a> Files<'a> for Part<'a> {
    type FileId = ();
    type Name = &'a str;
    type Source = &'a str;

    fn name(&self, (): ()) -> Result<&'a str, Error> {
        Ok(self.file.name())
    }

    fn source(&self, (): ()) -> Result<&'a str, Error> {
        Ok(self.file.source())
    }

    fn line_index(&self, (): (), byte: usize) -> Result<usize, Error> {
        self.file.line_index((), byte)
    }

    fn line_number(&self, (): (), line: usize) -> Result<usize, Error> {
        Ok(self.file.line_number((), line)? + self.before[0])
    }

    fn column_number(&self, (): (), line: usize, byte: usize) -> Result<usize, Error> {
        let before = if line == 0 { self.before[1] } else { 0 };
        Ok(self.file.column_number((), line, byte)? + before)
    }

    fn line_range(&self, (): (), line: usize) -> Result<Range<usize>, Error> {
        self.file.line_range((), line)
    }
}

fn show_in(
    diagnostic: &Diagnostic,
    text: &str,
    before: [usize; 2],
    buffer: &mut Buffer,
) -> anyhow::Result<()> {
    let name = diagnostic.file.display().to_string();
    let file = Part { file: SimpleFile::new(&name, text), before };
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

/// A span that can be shown. `0..0` stands for the whole file; a span may exceed a text that has changed.
fn place(span: &Range<usize>, text: &str) -> Option<Range<usize>> {
    (*span != (0..0) && span.start <= span.end && span.end <= text.len()).then(|| span.clone())
}

/// `` there is no preset `silkk`; did you mean `silk`? ``, or the known names where none is near.
pub fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("there is no {what} `{name}`; did you mean `{near}`?"),
        None => {
            let known: Vec<String> = known.map(|known| format!("`{known}`")).collect();
            format!("there is no {what} `{name}`; there are {}", known.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn excerpt(text: &str, span: Range<usize>) -> Option<(String, String, [usize; 2])> {
        let message = "wrong".to_owned();
        let (severity, file, help) = (Severity::Error, "a.ron".into(), None);
        let diagnostic = Diagnostic { severity, message, file, span, help, notes: Vec::new() };
        Excerpt::of(&diagnostic, text)
            .map(|cut| (cut.text.to_owned(), cut.text[cut.diagnostic.span.clone()].to_owned(), cut.before))
    }

    #[test]
    fn a_long_line_is_cut_around_the_marked_place() {
        let text = format!("first\n{}HERE{}\nlast", "ä".repeat(100_000), "b".repeat(100_000));
        let at = text.find("HERE").unwrap();
        let (shown, marked, before) = excerpt(&text, at..at + 4).unwrap();
        assert!(shown.len() <= MAX_LINE && marked == "HERE", "{shown}");
        assert_eq!(before, [1, 100_000 - CONTEXT / 2]);
        // A marked place that is itself too long is cut too.
        let (shown, marked, _) = excerpt(&text, at..text.len() - 5).unwrap();
        assert!(shown.len() <= MAX_LINE && marked.starts_with("HEREbb"), "{shown}");
        assert_eq!(excerpt(&text, 0..5), None);
    }
}
