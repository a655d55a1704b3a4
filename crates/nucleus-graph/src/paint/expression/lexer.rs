//! The tokens of an expression: names, numbers and operators.

use std::ops::Range;

/// A mistake in an expression, with its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// The mistake: lower case, no full stop, names in backticks.
    pub message: String,
    /// The place: byte offsets into the expression.
    pub span: Range<usize>,
    /// How to fix it.
    pub help: Option<String>,
}

impl ExpressionError {
    pub(super) fn new(message: impl Into<String>, span: Range<usize>) -> Self {
        Self { message: message.into(), span, help: None }
    }
}

/// A token.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    /// An operator, a bracket, a comma.
    Sign(&'static str),
    End,
}

/// Longer ones first, so that `<=` is not read as `<`.
const SIGNS: [&str; 19] =
    ["<=", ">=", "==", "!=", "&&", "||", "<", ">", "!", "+", "-", "*", "/", "%", "^", "(", ")", ",", "?"];

/// Splits a text into tokens, each with its byte range. The last token is the end.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token<'_>, Range<usize>)>, ExpressionError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = match c {
            c if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            c if c.is_ascii_digit() || c == '.' => number_length(rest),
            c if c.is_alphabetic() || c == '_' => {
                rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
            }
            _ => sign(rest).map_or(c.len_utf8(), str::len),
        };
        let (piece, span) = (&rest[..length], at..at + length);
        let token = match c {
            c if c.is_ascii_digit() || c == '.' => Token::Number(number(piece, &span)?),
            c if c.is_alphabetic() || c == '_' => Token::Name(piece),
            _ => match sign(rest) {
                Some(sign) => Token::Sign(sign),
                None => return Err(ExpressionError::new(format!("an expression has no `{c}`"), span)),
            },
        };
        tokens.push((token, span));
        at += length;
    }
    tokens.push((Token::End, at..at));
    Ok(tokens)
}

fn sign(rest: &str) -> Option<&'static str> {
    SIGNS.into_iter().chain([":"]).find(|sign| rest.starts_with(sign))
}

/// Digits, a point, digits, and an exponent if there is one.
fn number_length(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let signed = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = if length + 1 + signed <= bytes.len() { digits(length + 1 + signed) } else { 0 };
        if exponent > 0 {
            length += 1 + signed + exponent;
        }
    }
    length
}

fn number(piece: &str, span: &Range<usize>) -> Result<f64, ExpressionError> {
    match piece.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(ExpressionError::new(format!("`{piece}` is not a finite number"), span.clone())),
    }
}
