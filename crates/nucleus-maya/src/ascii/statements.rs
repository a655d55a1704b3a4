//! Statements and tokens: where a statement ends, and its words and quoted strings.

use std::borrow::Cow;

/// A statement of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Statement<'a> {
    /// Its text without the semicolon.
    pub text: &'a str,
    /// The first byte in the file.
    pub start: usize,
    /// Whether the file ends before its semicolon.
    pub is_cut: bool,
}

/// The statements of a text, one after the other.
#[derive(Debug)]
pub struct Statements<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Statements<'a> {
    /// From the start of a text.
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    fn next(&mut self) -> Option<Statement<'a>> {
        let bytes = self.text.as_bytes();
        let start = skip_blank(bytes, self.at);
        if start == bytes.len() {
            return None;
        }
        let mut at = start;
        while at < bytes.len() {
            match bytes[at] {
                b';' => {
                    self.at = at + 1;
                    return Some(Statement { text: &self.text[start..at], start, is_cut: false });
                }
                b'"' => at = after_string(bytes, at),
                b'/' => at = after_comment(bytes, at).unwrap_or(at + 1),
                _ => at += 1,
            }
        }
        self.at = bytes.len();
        Some(Statement { text: &self.text[start..], start, is_cut: true })
    }
}

/// The first byte at or after `at` that belongs to a statement.
fn skip_blank(bytes: &[u8], mut at: usize) -> usize {
    while at < bytes.len() {
        match bytes[at] {
            b' ' | b'\t' | b'\n' | b'\r' | b';' => at += 1,
            b'/' => match after_comment(bytes, at) {
                Some(after) => at = after,
                None => break,
            },
            _ => break,
        }
    }
    at
}

/// One after a comment that begins at `at`.
fn after_comment(bytes: &[u8], at: usize) -> Option<usize> {
    let rest = &bytes[at..];
    if rest.starts_with(b"//") {
        return Some(rest.iter().position(|b| *b == b'\n').map_or(bytes.len(), |end| at + end));
    }
    if rest.starts_with(b"/*") {
        let end = rest.windows(2).skip(2).position(|pair| pair == b"*/");
        return Some(end.map_or(bytes.len(), |end| at + end + 4));
    }
    None
}

/// One after the closing quote of a string that begins at `at`.
fn after_string(bytes: &[u8], at: usize) -> usize {
    let mut at = at + 1;
    while at < bytes.len() {
        match bytes[at] {
            b'\\' => at += 2,
            b'"' => return at + 1,
            _ => at += 1,
        }
    }
    bytes.len()
}

/// A token of a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Token<'a> {
    /// A word or a number.
    Word(&'a str),
    /// The inside of a string in quotes, with its escapes.
    Quoted(&'a str),
}

impl<'a> Token<'a> {
    /// The text of a word, or the text of a string.
    pub fn text(self) -> Cow<'a, str> {
        match self {
            Self::Word(word) => Cow::Borrowed(word),
            Self::Quoted(raw) => unescaped(raw),
        }
    }
}

/// The tokens of a text. Parentheses, braces and commas only separate.
#[derive(Debug, Clone)]
pub struct Tokens<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Tokens<'a> {
    /// The tokens of a statement.
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// The first byte of the next token.
    pub fn next_start(&self) -> usize {
        let bytes = self.text.as_bytes();
        let mut at = self.at;
        while at < bytes.len() {
            match bytes[at] {
                b' ' | b'\t' | b'\n' | b'\r' | b'(' | b')' | b'{' | b'}' | b',' => at += 1,
                b'/' => match after_comment(bytes, at) {
                    Some(after) => at = after,
                    None => break,
                },
                _ => break,
            }
        }
        at
    }

    /// The text after the tokens read so far.
    pub fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        let bytes = self.text.as_bytes();
        let start = self.next_start();
        if start == bytes.len() {
            self.at = start;
            return None;
        }
        if bytes[start] == b'"' {
            self.at = after_string(bytes, start);
            let closed = self.at - start >= 2 && bytes[self.at - 1] == b'"';
            let end = if closed { self.at - 1 } else { self.at };
            return Some(Token::Quoted(self.text.get(start + 1..end).unwrap_or_default()));
        }
        let is_end =
            |b: &u8| matches!(b, b' ' | b'\t' | b'\n' | b'\r' | b'"' | b'(' | b')' | b'{' | b'}' | b',');
        let length = bytes[start..].iter().position(is_end).unwrap_or(bytes.len() - start);
        self.at = start + length;
        Some(Token::Word(&self.text[start..self.at]))
    }
}

/// The text of a string, from the characters between its quotes.
pub fn unescaped(raw: &str) -> Cow<'_, str> {
    if !raw.contains('\\') {
        return Cow::Borrowed(raw);
    }
    let mut text = String::with_capacity(raw.len());
    let mut chars = raw.chars();
    while let Some(c) = chars.next() {
        match c {
            '\\' => match chars.next() {
                Some('n') => text.push('\n'),
                Some('t') => text.push('\t'),
                Some('r') => text.push('\r'),
                Some(other) => text.push(other),
                None => {}
            },
            c => text.push(c),
        }
    }
    Cow::Owned(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<Token<'_>> {
        Tokens::new(text).collect()
    }

    #[test]
    fn a_statement_ends_at_a_semicolon_outside_of_strings_and_comments() {
        let text = "//Maya ASCII; 2016\n/* a; */ a \"x;\\\";y\" // c;\n b;c ;\n\n";
        let all: Vec<_> = Statements::new(text).map(|statement| statement.text).collect();
        assert_eq!(all, ["a \"x;\\\";y\" // c;\n b", "c "]);
    }

    #[test]
    fn a_connection_may_be_wrapped_before_its_flags() {
        use Token::{Quoted, Word};
        let text = "connectAttr \"a.b\"\n\t\t\"c.d[0]\" // why\n\t\t -na";
        assert_eq!(tokens(text), [Word("connectAttr"), Quoted("a.b"), Quoted("c.d[0]"), Word("-na")]);
    }

    #[test]
    fn a_statement_without_its_semicolon_is_cut() {
        let mut all = Statements::new("a;b \"c;");
        assert!(!all.next().unwrap().is_cut);
        let last = all.next().unwrap();
        assert_eq!((last.text, last.start, last.is_cut), ("b \"c;", 2, true));
        assert_eq!(tokens(last.text), [Token::Word("b"), Token::Quoted("c;")]);
        assert_eq!(tokens("\""), [Token::Quoted("")]);
        assert_eq!(tokens("\"a\\"), [Token::Quoted("a\\")]);
    }

    #[test]
    fn escapes_are_resolved() {
        assert_eq!(unescaped(r#"a\n\"b\"\\\q"#), "a\n\"b\"\\q");
        assert_eq!(unescaped("a\\"), "a");
    }
}
