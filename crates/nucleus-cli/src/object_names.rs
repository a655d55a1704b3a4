//! Objects of a cache, by their names or by patterns.

use anyhow::{Result, ensure};
use nucleus_cache::Playback;

use crate::diagnostics::unknown;

/// The names of the objects of a cache that a pattern matches: `*` stands for any text, `?` for one character.
///
/// # Errors
/// If there is none; with the nearest name.
pub fn matching(cache: &Playback, option: &str, pattern: &str) -> Result<Vec<String>> {
    let known = || cache.objects().iter().map(|object| object.name.as_str());
    let found: Vec<String> = known().filter(|name| matches(pattern, name)).map(str::to_owned).collect();
    ensure!(!found.is_empty(), "`{option}`: {}", unknown("object", pattern, known()));
    Ok(found)
}

/// Whether a pattern matches all of a text.
fn matches(pattern: &str, text: &str) -> bool {
    let mut rest = pattern.chars();
    match rest.next() {
        None => text.is_empty(),
        Some('*') => {
            let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
            ends.into_iter().any(|at| matches(rest.as_str(), &text[at..]))
        }
        Some(first) => {
            let mut others = text.chars();
            others.next().is_some_and(|other| first == '?' || first == other)
                && matches(rest.as_str(), others.as_str())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn a_star_matches_any_text_and_a_question_mark_one_character() {
        for (pattern, text, is_match) in [
            ("wall", "wall", true),
            ("wall", "wall1", false),
            ("wall?", "wall1", true),
            ("wall?", "wall", false),
            ("wall*", "wall", true),
            ("*wall*", "left_wall_2", true),
            ("a*b*c", "a-c-b-c", true),
            ("a*b*c", "a-c-b", false),
            ("*", "", true),
            ("ü?", "üß", true),
        ] {
            assert_eq!(matches(pattern, text), is_match, "{pattern} {text}");
        }
    }
}
