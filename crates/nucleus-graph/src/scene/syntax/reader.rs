//! A recursive-descent parser of RON: one function per form of value.

use super::cursor::Cursor;
use super::number::{self, NumberError};
use super::text;
use super::tree::{Node, SyntaxError, Value, Word};

/// Limit on nesting of brackets. Scenes need 6; the limit of `ron` is 128.
const MAX_DEPTH: usize = 64;

/// An opening bracket.
#[derive(Clone, Copy)]
struct Bracket {
    /// Its byte offset.
    at: usize,
    /// The character: `(`, `[` or `{`.
    opening: char,
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

/// Parses a text of one value.
///
/// # Errors
/// All mistakes that parsing can continue after (bad numbers, bad escapes, missing commas ...) and the first that it
/// cannot, in the order of the text. At least one.
pub fn parse(text: &str) -> Result<Node, Vec<SyntaxError>> {
    let mut reader = Reader { cursor: Cursor::new(text), errors: Vec::new(), open: Vec::new() };
    match reader.document() {
        Ok(node) if reader.errors.is_empty() => Ok(node),
        _ => Err(reader.errors),
    }
}

struct Reader<'a> {
    cursor: Cursor<'a>,
    errors: Vec<SyntaxError>,
    /// The open brackets, outermost first.
    open: Vec<Bracket>,
}

/// Parsing cannot continue. The last error is the reason.
struct Stop;

type Read<T> = Result<T, Stop>;

impl Reader<'_> {
    fn document(&mut self) -> Read<Node> {
        self.skip_blank()?;
        if self.cursor.peek().is_none() {
            let end = self.cursor.at();
            return Err(self.stop(SyntaxError::new("there is nothing in this file", end..end)));
        }
        let node = self.value()?;
        self.skip_blank()?;
        match self.cursor.peek() {
            None => Ok(node),
            Some(_) => Err(self.unexpected("the end of the file")),
        }
    }

    fn value(&mut self) -> Read<Node> {
        let start = self.cursor.at();
        let value = match self.cursor.peek() {
            Some('"') => {
                let text = text::read_quoted(&mut self.cursor, &mut self.errors);
                Value::Text(text.map_err(|error| self.stop(error))?)
            }
            Some('\'') => self.single_quoted()?,
            Some('[') => Value::List(self.within_brackets(Self::value)?),
            Some('{') => Value::Map(self.within_brackets(Self::entry)?),
            Some('(') => self.parenthesised(None)?,
            Some('0'..='9' | '+' | '-' | '.') => Value::Number(self.number()),
            Some('r') if text::raw_begins(self.cursor.rest()) => {
                Value::Text(text::read_raw(&mut self.cursor).map_err(|error| self.stop(error))?)
            }
            Some(c) if begins_word(c) => self.word_or_named()?,
            _ => return Err(self.unexpected("a value")),
        };
        Ok(Node { value, span: self.cursor.since(start) })
    }

    fn entry(&mut self) -> Read<(Node, Node)> {
        let key = self.value()?;
        Ok((key, self.after_colon()?))
    }

    fn field(&mut self) -> Read<(Word, Node)> {
        if !self.cursor.peek().is_some_and(begins_word) || text::raw_begins(self.cursor.rest()) {
            return Err(self.unexpected("a field's name"));
        }
        let name = self.word();
        Ok((name, self.after_colon()?))
    }

    fn after_colon(&mut self) -> Read<Node> {
        self.skip_blank()?;
        if !self.cursor.eat(":") {
            return Err(self.unexpected("`:`"));
        }
        self.skip_blank()?;
        self.value()
    }

    /// A word, or the record or tuple that it names.
    fn word_or_named(&mut self) -> Read<Value> {
        let name = self.word();
        match name.text.as_str() {
            "true" => return Ok(Value::Bool(true)),
            "false" => return Ok(Value::Bool(false)),
            "Some" | "None" => {
                let error = SyntaxError::new(format!("`{}` is not used here", name.text), name.span);
                return Err(self.stop(error.help("write the value alone, or leave the field out")));
            }
            word if number::is_not_finite(word) => {
                self.errors.push(not_a_number(word, NumberError::NotFinite, name.span.start));
                return Ok(Value::Number(0.0));
            }
            _ => {}
        }
        let end = self.cursor.at();
        self.skip_blank()?;
        if self.cursor.peek() == Some('(') {
            return self.parenthesised(Some(name));
        }
        self.cursor.set(end);
        Ok(Value::Word(name.text))
    }

    /// `(a: 1)` or `(1, 2)`: a colon after the first word decides.
    fn parenthesised(&mut self, name: Option<Word>) -> Read<Value> {
        if self.field_or_nothing_follows()? {
            Ok(Value::Record { name, fields: self.within_brackets(Self::field)? })
        } else {
            Ok(Value::Tuple { name, items: self.within_brackets(Self::value)? })
        }
    }

    fn field_or_nothing_follows(&mut self) -> Read<bool> {
        let start = self.cursor.at();
        self.cursor.eat("(");
        self.skip_blank()?;
        let mut follows = self.cursor.peek() == Some(')');
        if self.cursor.peek().is_some_and(begins_word) {
            self.word();
            self.skip_blank()?;
            follows = self.cursor.peek() == Some(':');
        }
        self.cursor.set(start);
        Ok(follows)
    }

    fn word(&mut self) -> Word {
        let start = self.cursor.at();
        let text = self.cursor.take_while(continues_word).to_owned();
        Word { text, span: self.cursor.since(start) }
    }

    /// A number. A malformed one is reported and becomes zero; the tree is then not returned.
    fn number(&mut self) -> f64 {
        let start = self.cursor.at();
        let text = self.cursor.take_while(|c| continues_word(c) || matches!(c, '+' | '-' | '.'));
        number::read(text).unwrap_or_else(|reason| {
            self.errors.push(not_a_number(text, reason, start));
            0.0
        })
    }

    /// `'a'` is a single character in RON. Scenes have none, so text was probably meant.
    fn single_quoted(&mut self) -> Read<Value> {
        let start = self.cursor.at();
        self.cursor.eat("'");
        self.cursor.take_while(|c| !matches!(c, '\'' | '\n'));
        let closed = self.cursor.eat("'");
        let error = SyntaxError::new("text is written in double quotes", self.cursor.since(start));
        if !closed {
            return Err(self.stop(error));
        }
        self.errors.push(error);
        Ok(Value::Text(String::new()))
    }

    fn skip_blank(&mut self) -> Read<()> {
        self.cursor.skip_blank().map_err(|error| self.stop(error))
    }

    fn stop(&mut self, error: SyntaxError) -> Stop {
        self.errors.push(error);
        Stop
    }

    /// Stops at an unexpected character or word.
    fn unexpected(&mut self, expected: &str) -> Stop {
        let start = self.cursor.at();
        let Some(found) = self.cursor.peek() else { return self.ends_early(expected) };
        if self.cursor.take_while(continues_word).is_empty() {
            self.cursor.next();
        }
        let span = self.cursor.since(start);
        let message = if found.is_ascii_graphic() {
            format!("expected {expected}, found `{}`", self.cursor.text(span.clone()))
        } else {
            // Such as the no-break space in text copied from a web page.
            format!("expected {expected}, found the character U+{:04X}", u32::from(found))
        };
        let mut error = SyntaxError::new(message, span);
        if let Some(bracket) = self.open.last() {
            let place = self.cursor.place(bracket.at);
            error = error.help(format!("this is inside the `{}` of {place}", bracket.opening));
        }
        self.stop(error)
    }
}

impl Reader<'_> {
    /// Items separated by commas, from the next opening bracket to its closing one.
    fn within_brackets<T>(&mut self, item: fn(&mut Self) -> Read<T>) -> Read<Vec<T>> {
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
        if self.open.len() > MAX_DEPTH {
            let message = format!("more than {MAX_DEPTH} brackets inside each other");
            return Err(self.stop(SyntaxError::new(message, at..at + 1)));
        }
        Ok(bracket)
    }

    /// A comma, unless the bracket closes. A missing comma before another value is reported, and parsing continues.
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

    /// The text ends too early: the error points at the innermost open bracket.
    fn ends_early(&mut self, expected: &str) -> Stop {
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

/// Names consist of ASCII letters, digits and `_`.
fn begins_word(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_'
}

fn continues_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn not_a_number(text: &str, reason: NumberError, start: usize) -> SyntaxError {
    let span = start..start + text.len();
    match reason {
        NumberError::Unreadable => SyntaxError::new(format!("`{text}` is not a number"), span),
        NumberError::TooLarge => SyntaxError::new(format!("`{text}` is too large for a number"), span),
        NumberError::NotFinite => SyntaxError::new(format!("`{text}` is not a finite number"), span),
    }
}
