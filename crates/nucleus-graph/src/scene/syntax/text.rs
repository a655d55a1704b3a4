//! Text in quotes: `"..."` with escapes on one line, `r"..."` and `r#"..."#` without escapes.

use super::cursor::Cursor;
use super::tree::SyntaxError;

/// Reads text in double quotes, from the first quote. Invalid escapes are added to `errors`, and reading continues.
pub(super) fn read_quoted(cursor: &mut Cursor, errors: &mut Vec<SyntaxError>) -> Result<String, SyntaxError> {
    let start = cursor.at();
    cursor.eat("\"");
    let mut text = String::new();
    loop {
        text.push_str(cursor.take_while(|c| !matches!(c, '"' | '\\' | '\n')));
        let at = cursor.at();
        match cursor.next() {
            Some('"') => return Ok(text),
            Some('\\') => match read_escape(cursor) {
                Ok(c) => text.extend(c),
                Err(reason) => errors.push(bad_escape(cursor, at, reason)),
            },
            // RON allows line ends here. A missing quote would then be noticed only far behind it, so scenes write
            // text of several lines in one of the other forms.
            _ => return Err(unterminated(start, at)),
        }
    }
}

/// Reads raw text, from the `r`.
pub(super) fn read_raw(cursor: &mut Cursor) -> Result<String, SyntaxError> {
    let start = cursor.at();
    cursor.eat("r");
    let end = format!("\"{}", cursor.take_while(|c| c == '#'));
    cursor.eat("\"");
    let opening = cursor.since(start);
    let Some(length) = cursor.rest().find(&end) else {
        let error = SyntaxError::new("this text is never closed", opening);
        return Err(error.help(format!("close it with `{end}`")));
    };
    let text = cursor.rest()[..length].to_owned();
    cursor.set(cursor.at() + length + end.len());
    Ok(text)
}

/// Whether raw text begins here, and not a word that starts with `r`.
pub(super) fn raw_begins(rest: &str) -> bool {
    rest.strip_prefix('r').is_some_and(|rest| rest.trim_start_matches('#').starts_with('"'))
}

/// The character of an escape, after its backslash. `None` for a backslash at the end of a line.
fn read_escape(cursor: &mut Cursor) -> Result<Option<char>, &'static str> {
    let escaped = match cursor.peek() {
        Some(c @ ('\'' | '"' | '\\')) => c,
        Some('n') => '\n',
        Some('r') => '\r',
        Some('t') => '\t',
        Some('0') => '\0',
        Some('x') => return read_byte_escape(cursor).map(Some),
        Some('u') => return read_unicode_escape(cursor).map(Some),
        _ if cursor.eat("\r\n") || cursor.eat("\n") => {
            cursor.take_while(|c| matches!(c, ' ' | '\t' | '\n' | '\r'));
            return Ok(None);
        }
        _ => return Err("a backslash is written `\\\\`; paths may use `/`"),
    };
    cursor.next();
    Ok(Some(escaped))
}

fn read_byte_escape(cursor: &mut Cursor) -> Result<char, &'static str> {
    const FORM: &str = "`\\x` takes two hexadecimal digits up to 7f; `\\u{...}` writes any character";
    let digits = cursor.rest().get(1..3).filter(|digits| is_hexadecimal(digits)).ok_or(FORM)?;
    let code = u8::from_str_radix(digits, 16).ok().filter(u8::is_ascii).ok_or(FORM)?;
    cursor.set(cursor.at() + 3);
    Ok(char::from(code))
}

fn read_unicode_escape(cursor: &mut Cursor) -> Result<char, &'static str> {
    const FORM: &str = "`\\u{...}` takes one to six hexadecimal digits that name a character";
    let (digits, _) =
        cursor.rest()[1..].strip_prefix('{').and_then(|rest| rest.split_once('}')).ok_or(FORM)?;
    if !is_hexadecimal(digits) || digits.len() > 6 {
        return Err(FORM);
    }
    let escaped = u32::from_str_radix(digits, 16).ok().and_then(char::from_u32).ok_or(FORM)?;
    cursor.set(cursor.at() + digits.len() + 3);
    Ok(escaped)
}

/// `from_str_radix` alone would accept a sign.
fn is_hexadecimal(digits: &str) -> bool {
    digits.bytes().all(|digit| digit.is_ascii_hexdigit())
}

fn bad_escape(cursor: &Cursor, start: usize, reason: &str) -> SyntaxError {
    let next = cursor.peek().filter(|c| !c.is_control());
    let end = start + 1 + next.map_or(0, char::len_utf8);
    SyntaxError::new("this is no valid escape", start..end).help(reason)
}

fn unterminated(start: usize, end: usize) -> SyntaxError {
    SyntaxError::new("this text is never closed", start..end)
        .help("close it with `\"` on the same line; text over several lines is written r#\"...\"#")
}
