//! Diagnostics of a scene file: message, place, and fix; and the name that a misspelt word probably means.

use std::ops::Range;
use std::path::PathBuf;

/// The severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene runs, but part of it has no effect or not the expected one.
    Warning,
    /// The scene cannot run.
    Error,
}

/// An error or a warning about a place in a scene file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The mistake: lower case, no full stop, names in backticks.
    pub message: String,
    /// The scene file.
    pub file: PathBuf,
    /// The place: byte offsets into the file. `0..0` for the file as a whole.
    pub span: Range<usize>,
    /// How to fix it, in one line.
    pub help: Option<String>,
    /// Related places and facts.
    pub notes: Vec<Note>,
}

/// An addition to a diagnostic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The text of the note.
    pub message: String,
    /// The place in the same file that it refers to.
    pub span: Option<Range<usize>>,
}

impl Diagnostic {
    /// Adds how to fix it.
    pub(crate) fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(bounded(help.into()));
        self
    }

    /// Adds the help `did you mean ...`, if there is a nearest name.
    pub(crate) fn did_you_mean(&mut self, nearest: Option<&str>) -> &mut Self {
        match nearest {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// Adds a note with a related place.
    pub(crate) fn note_at(&mut self, span: &Range<usize>, message: impl Into<String>) -> &mut Self {
        self.notes.push(Note { message: bounded(message.into()), span: Some(span.clone()) });
        self
    }
}

/// Collects the diagnostics of one file.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    file: PathBuf,
    all: Vec<Diagnostic>,
}

impl Findings {
    /// An empty collection.
    pub(crate) fn new(file: PathBuf) -> Self {
        Self { file, all: Vec::new() }
    }

    /// Adds an error. Help and notes can be added to the result.
    pub(crate) fn error(&mut self, span: &Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Error, span, message.into())
    }

    /// Adds a warning. Help and notes can be added to the result.
    pub(crate) fn warning(&mut self, span: &Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Severity::Warning, span, message.into())
    }

    /// The number of errors. A caller compares it before and after a step to see whether the step failed.
    pub(crate) fn errors(&self) -> usize {
        self.all.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count()
    }

    /// Adds diagnostics from elsewhere.
    pub(crate) fn extend(&mut self, diagnostics: Vec<Diagnostic>) {
        self.all.extend(diagnostics);
    }

    /// All diagnostics in the order of their places.
    pub(crate) fn in_order(mut self) -> Vec<Diagnostic> {
        self.all.sort_by_key(|diagnostic| (diagnostic.span.start, diagnostic.span.end));
        self.all
    }

    fn push(&mut self, severity: Severity, span: &Range<usize>, message: String) -> &mut Diagnostic {
        let (file, span, message) = (self.file.clone(), span.clone(), bounded(message));
        self.all.push(Diagnostic { severity, message, file, span, help: None, notes: Vec::new() });
        let last = self.all.len() - 1;
        &mut self.all[last]
    }
}

/// Longest text of a diagnostic in characters.
const MAX_TEXT: usize = 600;

/// A text that can be shown in a terminal: without its middle if it is too long, because a scene may hold names of megabytes,
/// and with escapes for characters that control the terminal or turn the direction of the text.
fn bounded(text: String) -> String {
    let turns =
        |c: char| matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let controls = |c: char| (c.is_control() && c != '\n') || turns(c);
    let text = match text.contains(controls) {
        true => text
            .chars()
            .flat_map(|c| if controls(c) { c.escape_unicode().collect() } else { vec![c] })
            .collect(),
        false => text,
    };
    let characters = text.chars().count();
    if characters <= MAX_TEXT {
        return text;
    }
    let first: String = text.chars().take(MAX_TEXT / 2).collect();
    let last: String = text.chars().skip(characters - MAX_TEXT / 2).collect();
    format!("{first} … {last}")
}

/// Joins words for a sentence: `a`, `b` and `c`.
pub(crate) fn listed<S: AsRef<str>>(words: &[S]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{}`", word.as_ref())).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// The value of a word of an enum. The word may be in upper or lower case and of parts that are joined or not: `liveForever`,
/// `Live forever` and `live forever` are one word.
pub(crate) fn value_of<'a, T>(word: &str, known: impl IntoIterator<Item = (&'a str, T)>) -> Option<T> {
    let bare = |word: &str| -> String {
        word.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
    };
    let word = bare(word);
    known.into_iter().find(|(name, _)| bare(name) == word).map(|(_, value)| value)
}

/// The candidate with the smallest edit distance, if that is at most a third of the word's length (at least 1). Of
/// equals, the first.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters = word.chars().count();
    let limit = (letters / 3).max(1);
    let candidates = candidates.into_iter().filter(|one| letters.abs_diff(one.chars().count()) <= limit);
    let near = candidates.map(|candidate| (changes(word, candidate), candidate));
    let best = near.min_by_key(|&(changes, _)| changes)?;
    (best.0 <= limit).then_some(best.1)
}

/// Edit distance: letters added, removed, replaced, or swapped with the next (optimal string alignment). Case is
/// ignored.
fn changes(a: &str, b: &str) -> usize {
    let letters = |word: &str| word.chars().flat_map(char::to_lowercase).collect::<Vec<char>>();
    let (a, b) = (letters(a), letters(b));
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut cost = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                cost = cost.min(before[j - 2] + 1);
            }
            row.push(cost);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_added_removed_replaced_or_swapped_are_one_change_each() {
        for word in ["bendd", "ben", "bent", "bned"] {
            assert_eq!(changes(word, "bend"), 1, "{word}");
        }
        assert_eq!(changes("BEND", "bend"), 0);
        assert_eq!(changes("", "bend"), 4);
    }

    #[test]
    fn characters_that_control_a_terminal_are_shown_as_escapes() {
        let mut findings = Findings::new(PathBuf::new());
        findings.error(&(0..0), "`p\u{1b}[31m\u{7}\u{202e}é`\nnext").help("\u{9b}2J");
        let found = findings.in_order();
        assert_eq!(found[0].message, "`p\\u{1b}[31m\\u{7}\\u{202e}é`\nnext");
        assert_eq!(found[0].help.as_deref(), Some("\\u{9b}2J"));
    }

    #[test]
    fn only_near_names_are_suggested() {
        let names = ["stretchResistance", "bendResistance", "shearResistance"];
        assert_eq!(nearest("bendResistence", names), Some("bendResistance"));
        assert_eq!(nearest("colour", names), None);
        assert_eq!(nearest("x", ["y", "z"]), Some("y"));
    }
}
