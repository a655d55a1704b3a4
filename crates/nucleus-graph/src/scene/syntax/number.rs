//! Numbers of RON: `12`, `-1_000`, `.5`, `1e-3`, `0xff`, `0o17`, `0b11`.

/// Reasons why characters are not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NumberError {
    /// They do not have the form of a number.
    Unreadable,
    /// The number is too large for a 64-bit float.
    TooLarge,
    /// The word stands for infinity or NaN.
    NotFinite,
}

/// Reads one number, which must be all of `text`.
pub(super) fn read(text: &str) -> Result<f64, NumberError> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if is_not_finite(digits) {
        return Err(NumberError::NotFinite);
    }
    let negative = text.starts_with('-');
    match digits.get(..2) {
        Some("0x") => read_based(&digits[2..], 16, negative),
        Some("0o") => read_based(&digits[2..], 8, negative),
        Some("0b") => read_based(&digits[2..], 2, negative),
        _ => read_decimal(text),
    }
}

/// Whether a word is one of RON's names for infinity or NaN.
pub(super) fn is_not_finite(word: &str) -> bool {
    matches!(word, "inf" | "inff32" | "inff64" | "NaN" | "NaNf32" | "NaNf64")
}

/// Integers of 64 bits in base 2, 8 or 16.
fn read_based(digits: &str, base: u32, negative: bool) -> Result<f64, NumberError> {
    if digits.is_empty() || digits.starts_with('_') {
        return Err(NumberError::Unreadable);
    }
    let mut magnitude = 0_u64;
    for c in digits.chars().filter(|&c| c != '_') {
        let digit = u64::from(c.to_digit(base).ok_or(NumberError::Unreadable)?);
        let longer = magnitude.checked_mul(u64::from(base)).and_then(|m| m.checked_add(digit));
        magnitude = longer.ok_or(NumberError::TooLarge)?;
    }
    match (negative, magnitude) {
        (false, _) => Ok(magnitude as f64),
        (true, ..=0x8000_0000_0000_0000) => Ok(-(magnitude as f64)),
        (true, _) => Err(NumberError::TooLarge),
    }
}

/// Decimal numbers. `_` is allowed after a digit or the `e` of an exponent, not at the start or after the point.
fn read_decimal(text: &str) -> Result<f64, NumberError> {
    let mut plain = String::with_capacity(text.len());
    let mut underscore_allowed = false;
    for c in text.chars() {
        match c {
            '_' if underscore_allowed => continue,
            '0'..='9' | 'e' | 'E' => underscore_allowed = true,
            '.' => underscore_allowed = false,
            '+' | '-' => {}
            _ => return Err(NumberError::Unreadable),
        }
        plain.push(c);
    }
    let value: f64 = plain.parse().map_err(|_| NumberError::Unreadable)?;
    if value.is_finite() { Ok(value) } else { Err(NumberError::TooLarge) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_forms_of_numbers_are_read() {
        let forms = [
            ("0", 0.0),
            ("+12", 12.0),
            ("-1_000", -1000.0),
            (".5", 0.5),
            ("-5.", -5.0),
            ("1e-3", 0.001),
            ("2.5E2", 250.0),
            ("0xff", 255.0),
            ("0xF_F", 255.0),
            ("-0o17", -15.0),
            ("0b1_01", 5.0),
            ("0.1", 0.1),
            ("18446744073709551616", 18_446_744_073_709_551_616.0),
        ];
        for (text, value) in forms {
            assert_eq!(read(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn malformed_numbers_are_refused() {
        for text in
            ["", "-", ".", "1.2.3", "12ab", "0x", "0x_1", "0b2", "_1", "1._5", "1cm", "--1", "1e", "1..2"]
        {
            assert_eq!(read(text), Err(NumberError::Unreadable), "{text}");
        }
    }

    #[test]
    fn infinity_nan_and_overflow_are_refused() {
        for text in ["inf", "-inf", "NaN", "+NaN", "-inff32"] {
            assert_eq!(read(text), Err(NumberError::NotFinite), "{text}");
        }
        for text in ["1e999", "-1e309", "0x10000000000000000", "-0x8000000000000001"] {
            assert_eq!(read(text), Err(NumberError::TooLarge), "{text}");
        }
    }
}
