//! The name that was probably meant.

/// The candidate that takes the fewest changes to reach, if that is few enough; the first of equals.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let most = (word.chars().count() / 3).max(1);
    let near = candidates.into_iter().map(|candidate| (changes(word, candidate), candidate));
    let best = near.min_by_key(|&(changes, _)| changes)?;
    (best.0 <= most).then_some(best.1)
}

/// How many letters to add, remove, replace or swap with the next; upper and lower case count as equal.
fn changes(a: &str, b: &str) -> usize {
    let letters = |word: &str| word.chars().flat_map(char::to_lowercase).collect::<Vec<char>>();
    let (a, b) = (letters(a), letters(b));
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(before[j - 2] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_added_removed_replaced_or_swapped_are_one_change_each() {
        for word in ["bendd", "ben", "bent", "bned"] {
            assert_eq!(changes(word, "bend"), 1, "{word}");
        }
        assert_eq!(changes("BEND", "bend"), 0);
        assert_eq!(changes("", "bend"), 4);
    }

    #[test]
    fn only_what_is_near_is_suggested() {
        let names = ["stretchResistance", "bendResistance", "shearResistance"];
        assert_eq!(nearest("bendResistence", names), Some("bendResistance"));
        assert_eq!(nearest("colour", names), None);
        assert_eq!(nearest("x", ["y", "z"]), Some("y"));
    }
}
