//! Names that other tools take.

use std::collections::HashSet;

/// Names for files: the scene's own names, with everything but letters, digits, `-` and `.` replaced by `_`.
/// No two are alike, whatever the case of their letters.
pub(crate) fn for_files<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    unique(names, |c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.'))
}

/// Names for nodes: letters, digits and `_`, not beginning with a digit.
pub(crate) fn for_nodes<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    unique(names, |c| c.is_ascii_alphanumeric() || c == '_')
}

fn unique<'a>(names: impl IntoIterator<Item = &'a str>, may_stay: impl Fn(char) -> bool) -> Vec<String> {
    let mut taken = HashSet::new();
    let made = names.into_iter().map(|name| {
        let plain: String = name.chars().map(|c| if may_stay(c) { c } else { '_' }).collect();
        let needs_letter = plain.chars().next().is_none_or(|c| !c.is_ascii_alphabetic() && c != '_');
        let plain = if needs_letter { format!("_{plain}") } else { plain };
        let mut name = plain.clone();
        let mut copy = 1;
        while !taken.insert(name.to_ascii_lowercase()) {
            copy += 1;
            name = format!("{plain}_{copy}");
        }
        name
    });
    made.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_no_two_are_alike() {
        let names = ["cloth1", "ns:cloth|1", "ns_cloth_1", "Cloth1", "1st", "ä", ""];
        let expected = ["cloth1", "ns_cloth_1", "ns_cloth_1_2", "Cloth1_2", "_1st", "_", "__2"];
        assert_eq!(for_nodes(names), expected);
        assert_eq!(for_files(["a-b.c", "a/b"]), ["a-b.c", "a_b"]);
    }
}
