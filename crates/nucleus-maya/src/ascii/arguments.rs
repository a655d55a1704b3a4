//! Arguments of a command: flags in their short and long forms, and positional arguments.

use super::statements::{Token, Tokens};

/// A flag that a command knows: its short and its long name, and how many arguments it takes.
#[derive(Debug, Clone, Copy)]
pub struct Flag {
    /// The short name, without the minus.
    pub short: &'static str,
    /// The long name, without the minus.
    pub long: &'static str,
    /// How many arguments follow it.
    pub takes: usize,
}

impl Flag {
    /// A flag that takes this many arguments.
    pub const fn new(short: &'static str, long: &'static str, takes: usize) -> Self {
        Self { short, long, takes }
    }
}

/// The arguments of a command, with its flags sorted out.
#[derive(Debug, Default)]
pub struct Arguments<'a> {
    /// Flags by their short name, each with its first argument if it takes any.
    flags: Vec<(&'static str, Option<Token<'a>>)>,
    /// Positional arguments, in order.
    pub plain: Vec<Token<'a>>,
}

impl<'a> Arguments<'a> {
    /// Sorts tokens. Unknown flags are taken to have no argument.
    pub fn of(tokens: &mut Tokens<'a>, known: &'static [Flag]) -> Self {
        Self::until(tokens, known, usize::MAX)
    }

    /// As [`of`](Self::of), but stops at the token after `count` plain ones, which a value begins with.
    pub fn until(tokens: &mut Tokens<'a>, known: &'static [Flag], count: usize) -> Self {
        let mut sorted = Self::default();
        loop {
            let before = tokens.clone();
            let Some(token) = tokens.next() else { return sorted };
            match flag_of(token, known) {
                Some(Some(flag)) => {
                    let argument = (flag.takes > 0).then(|| tokens.next()).flatten();
                    (1..flag.takes).for_each(|_| {
                        tokens.next();
                    });
                    sorted.flags.push((flag.short, argument));
                }
                Some(None) => {}
                None if sorted.plain.len() == count => {
                    *tokens = before;
                    return sorted;
                }
                None => sorted.plain.push(token),
            }
        }
    }

    /// Whether a flag is there.
    pub fn has(&self, short: &str) -> bool {
        self.flags.iter().any(|(name, _)| *name == short)
    }

    /// The argument of a flag, by its short name.
    pub fn get(&self, short: &str) -> Option<Token<'a>> {
        self.flags.iter().rev().find(|(name, _)| *name == short)?.1
    }
}

/// Whether a token is a flag, and which. A minus before a digit begins a number.
fn flag_of(token: Token<'_>, known: &'static [Flag]) -> Option<Option<&'static Flag>> {
    let Token::Word(word) = token else { return None };
    let name = word.strip_prefix('-')?;
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || is_number(word) {
        return None;
    }
    Some(known.iter().find(|flag| flag.short == name || flag.long == name))
}

/// `-inf` and `-nan` are numbers, too.
fn is_number(word: &str) -> bool {
    let name = word.trim_start_matches('-').to_ascii_lowercase();
    name.starts_with("inf") || name.starts_with("nan")
}

/// One step of a path of attributes: `fsc[0:1]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment<'a> {
    /// The name, short or long.
    pub name: &'a str,
    /// The first and the last index, if any.
    pub range: Option<(u32, u32)>,
}

/// The path of an attribute inside its node: `uvst[0].uvsp[0:24]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlugPath<'a>(pub &'a str);

impl<'a> PlugPath<'a> {
    /// Its steps.
    pub fn segments(self) -> impl Iterator<Item = Segment<'a>> {
        self.0.split('.').filter(|part| !part.is_empty()).map(|part| {
            let Some((name, index)) = part.split_once('[') else {
                return Segment { name: part, range: None };
            };
            let index = index.trim_end_matches(']');
            let (first, last) = index.split_once(':').unwrap_or((index, index));
            let range = first.trim().parse().ok().zip(last.trim().parse().ok());
            Segment { name, range }
        })
    }

    /// The first step, and those after it.
    pub fn split_first(self) -> (Segment<'a>, PlugPath<'a>) {
        let (_, rest) = self.0.split_once('.').unwrap_or((self.0, ""));
        (self.segments().next().unwrap_or(Segment { name: "", range: None }), PlugPath(rest))
    }

    /// Whether two paths end at the same attribute, each in its short or its full name.
    pub fn is_same(self, other: PlugPath) -> bool {
        let (a, b) = (self.last(), other.last());
        let is_same_element = a.range.is_none() || b.range.is_none() || a.range == b.range;
        is_same_element && (a.name == b.name || a.name == initials(b.name) || initials(a.name) == b.name)
    }

    /// The last step.
    pub fn last(self) -> Segment<'a> {
        self.segments().last().unwrap_or(Segment { name: "", range: None })
    }
}

/// Maya's usual short name of an attribute: `tx` of `translateX`, `iog` of `instObjGroups`.
fn initials(name: &str) -> String {
    let is_kept = |(at, c): &(usize, char)| *at == 0 || c.is_ascii_uppercase() || c.is_ascii_digit();
    name.char_indices().filter(is_kept).map(|(_, c)| c.to_ascii_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: &[Flag] =
        &[Flag::new("k", "keyable", 1), Flag::new("s", "size", 1), Flag::new("av", "alteredValue", 0)];

    #[test]
    fn flags_stand_before_or_after_the_plug_in_either_dialect() {
        for text in ["-k off -s 2 \".v\" -av -1 -.5", "\".v\" -keyable off -size 2 -alteredValue -1 -.5"] {
            let mut tokens = Tokens::new(text);
            let arguments = Arguments::until(&mut tokens, KNOWN, 1);
            assert_eq!(arguments.get("k"), Some(Token::Word("off")), "{text}");
            assert!(arguments.has("av") && arguments.has("s"));
            assert_eq!(arguments.plain, [Token::Quoted(".v")]);
            let values: Vec<_> = tokens.map(|token| token.text()).collect();
            assert_eq!(values, ["-1", "-.5"]);
        }
    }

    #[test]
    fn a_path_has_names_and_ranges() {
        let path = PlugPath("uvst[0].uvsp[0:24].u");
        let all: Vec<_> = path.segments().map(|s| (s.name, s.range)).collect();
        assert_eq!(all, [("uvst", Some((0, 0))), ("uvsp", Some((0, 24))), ("u", None)]);
        assert_eq!(PlugPath("a[x]").last(), Segment { name: "a", range: None });
        assert_eq!(path.split_first().1, PlugPath("uvsp[0:24].u"));
    }
}
