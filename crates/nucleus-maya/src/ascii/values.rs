//! The values of a `setAttr`: numbers, switches, words and strings.

use super::statements::{Token, Tokens};

/// The values after a plug, parsed one by one.
#[derive(Debug, Clone)]
pub struct Values<'a> {
    /// What `-type` says, if anything.
    pub data_type: Option<&'a str>,
    tokens: Tokens<'a>,
}

impl<'a> Values<'a> {
    /// The values of a text.
    pub fn new(data_type: Option<&'a str>, text: &'a str) -> Self {
        Self { data_type, tokens: Tokens::new(text) }
    }

    /// The tokens.
    pub fn tokens(&self) -> Tokens<'a> {
        self.tokens.clone()
    }

    /// Whether there is none: `setAttr -k off ".v"`.
    pub fn is_empty(&self) -> bool {
        self.tokens.clone().next().is_none()
    }

    /// The first value as a number; a switch is 0 or 1.
    pub fn number(&self) -> Option<f64> {
        self.tokens.clone().next().and_then(number)
    }

    /// The first value as a switch.
    pub fn switch(&self) -> Option<bool> {
        self.number().map(|x| x != 0.0)
    }

    /// All values that are numbers, up to the first that is none. `nan` is a number.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + use<'a> {
        self.tokens.clone().map_while(number)
    }

    /// The numbers of a counted array, `-type "vectorArray" 3 ...`, `width` for each element.
    ///
    /// # Errors
    /// When there are fewer than the count says, or no count: how many there are and should be.
    pub fn counted(&self, width: usize) -> Result<Vec<f64>, (usize, usize)> {
        let mut numbers = self.numbers();
        let count = numbers.next().ok_or((0, 1))?;
        let expected = if count >= 0.0 { (count as usize).saturating_mul(width) } else { 0 };
        // The count is only believed as far as there are values.
        let found: Vec<f64> = numbers.take(expected).collect();
        if found.len() < expected { Err((found.len(), expected)) } else { Ok(found) }
    }

    /// The text: all strings joined, since a long one is written as a sum of several.
    pub fn text(&self) -> Option<String> {
        let mut strings = self.tokens.clone().filter_map(|token| match token {
            Token::Quoted(_) => Some(token.text()),
            Token::Word(_) => None,
        });
        let first = strings.next()?.into_owned();
        Some(strings.fold(first, |all, one| all + &one))
    }

    /// All strings, one by one.
    pub fn strings(&self) -> impl Iterator<Item = String> + use<'a> {
        self.tokens.clone().filter_map(|token| match token {
            Token::Quoted(_) => Some(token.text().into_owned()),
            Token::Word(_) => None,
        })
    }
}

/// A number, or a switch as 0 or 1.
pub(crate) fn number(token: Token<'_>) -> Option<f64> {
    let Token::Word(word) = token else { return None };
    if let Ok(number) = word.parse::<f64>() {
        return Some(number);
    }
    match word {
        "yes" | "on" | "true" => Some(1.0),
        "no" | "off" | "false" => Some(0.0),
        // Microsoft's runtime writes `nan(ind)` and `1.#QNAN`.
        _ if word.contains("nan") || word.contains("#QNAN") || word.contains("#IND") => Some(f64::NAN),
        _ if word.contains("#INF") => Some(f64::INFINITY),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_numbers_and_broken_numbers_are_told_apart() {
        let numbers = |text| Values::new(None, text).numbers().collect::<Vec<_>>();
        assert_eq!(numbers("yes off -1e-3 .5 on"), [1.0, 0.0, -0.001, 0.5, 1.0]);
        assert_eq!(numbers("1 2 f 4"), [1.0, 2.0]);
        assert!(
            numbers("nan")[0].is_nan() && numbers("-nan(ind)")[0].is_nan() && numbers("1.#QNAN")[0].is_nan()
        );
    }

    #[test]
    fn a_long_string_is_a_sum() {
        let values = Values::new(Some("string"), "(\n\"a\\n\"\n\t\t+ \"b\")");
        assert_eq!(values.text().as_deref(), Some("a\nb"));
    }

    #[test]
    fn a_count_that_promises_too_much_is_an_error_and_takes_no_memory() {
        assert_eq!(Values::new(None, "2 1 2 3 4 5 6").counted(3), Ok(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(Values::new(None, "4000000000 1 2").counted(3), Err((2, 12_000_000_000)));
        assert_eq!(Values::new(None, "").counted(1), Err((0, 1)));
        assert_eq!(Values::new(None, "-3").counted(1), Ok(vec![]));
    }
}
