//! Brackets, and the commas between what they hold.

use super::error::SyntaxError;
use super::reader::{Read, Reader, Stop, begins_word};

/// Brackets inside brackets that are followed. Scenes need six; `ron` follows 128.
const DEEPEST: usize = 64;

/// An opening bracket.
#[derive(Clone, Copy)]
pub(super) struct Bracket {
    /// Its byte offset.
    pub(super) at: usize,
    /// `(`, `[` or `{`.
    pub(super) opening: char,
}

impl Bracket {
    fn closing(self) -> char {
        match self.opening {
            '[' => ']',
            '{' => '}',
            _ => ')',
        }
    }
}

impl Reader<'_> {
    /// Items with commas between them, from the opening bracket that comes next to its closing one.
    pub(super) fn within_brackets<T>(&mut self, item: fn(&mut Self) -> Read<T>) -> Read<Vec<T>> {
        let bracket = self.open_bracket()?;
        let mut items = Vec::new();
        loop {
            self.skip_blank()?;
            if self.cursor.peek() == Some(bracket.closing()) {
                self.cursor.next();
                self.open.pop();
                return Ok(items);
            }
            items.push(item(self)?);
            self.comma(bracket)?;
        }
    }

    fn open_bracket(&mut self) -> Read<Bracket> {
        let at = self.cursor.at();
        let bracket = Bracket { at, opening: self.cursor.next().unwrap_or('(') };
        self.open.push(bracket);
        if self.open.len() > DEEPEST {
            let message = format!("more than {DEEPEST} brackets inside each other");
            return Err(self.stop(SyntaxError::new(message, at..at + 1)));
        }
        Ok(bracket)
    }

    /// A comma, unless the bracket closes. If it was only forgotten, that is noted and reading goes on.
    fn comma(&mut self, bracket: Bracket) -> Read<()> {
        let end = self.cursor.at();
        self.skip_blank()?;
        if self.cursor.eat(",") || self.cursor.peek() == Some(bracket.closing()) {
            return Ok(());
        }
        let touches = self.cursor.at() == end;
        if touches
            || !self.cursor.peek().is_some_and(|c| begins_word(c) || matches!(c, '"' | '0'..='9' | '-'))
        {
            return Err(self.unexpected(&format!("`,` or `{}`", bracket.closing())));
        }
        self.errors.push(
            SyntaxError::new("a comma is missing", end..end)
                .help("write `,` between two values, `:` between a name and its value"),
        );
        Ok(())
    }

    /// The text is over: the place to look at is the innermost bracket that is still open.
    pub(super) fn ends_early(&mut self, expected: &str) -> Stop {
        let end = self.cursor.at();
        let error = match self.open.last() {
            Some(bracket) => {
                let message = format!("this `{}` is never closed", bracket.opening);
                SyntaxError::new(message, bracket.at..bracket.at + 1)
                    .help(format!("the file ends where {expected} or `{}` should come", bracket.closing()))
            }
            None => SyntaxError::new(format!("expected {expected}, found the end of the file"), end..end),
        };
        self.stop(error)
    }
}
