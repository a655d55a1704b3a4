//! The points that constraints name, stored as metadata, so that the player can show them.

use std::collections::BTreeMap;

/// The points of an object that a constraint names.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SelectedPoints {
    /// Name of the constraint.
    pub owner: String,
    /// Name of the object.
    pub object: String,
    /// The points, ascending.
    pub points: Vec<u32>,
}

/// Prefix of a metadata key; the index of the selection follows.
const KEY: &str = "selection ";

/// Selections as keys and values of a metadata record: the constraint in the first line, the object in the second, and the
/// points in the third.
pub(crate) fn to_keys(all: &[SelectedPoints]) -> BTreeMap<String, String> {
    let text = |SelectedPoints { owner, object, points }: &SelectedPoints| {
        let owned = [owner, object].map(|name| name.replace('\n', " "));
        format!("{}\n{}\n{}", owned[0], owned[1], runs(points))
    };
    // Digits of one length keep the order.
    (0..).zip(all).map(|(index, one): (u32, _)| (format!("{KEY}{index:06}"), text(one))).collect()
}

/// Selections from such keys; malformed entries are left out.
pub(crate) fn from_keys(keys: &BTreeMap<String, String>) -> Vec<SelectedPoints> {
    let entry = |(key, text): (&String, &String)| {
        key.strip_prefix(KEY)?;
        let mut lines = text.split('\n');
        let (owner, object) = (lines.next()?.to_owned(), lines.next()?.to_owned());
        Some(SelectedPoints { owner, object, points: from_runs(lines.next()?)? })
    };
    keys.iter().filter_map(entry).collect()
}

/// The longest run.
const MAX_RUN: u32 = 100_000_000;

/// Ascending numbers as text, with runs as their ends: `3 5:8`.
pub(crate) fn runs(numbers: &[u32]) -> String {
    let mut runs: Vec<[u32; 2]> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some(run) if run[1].checked_add(1) == Some(number) => run[1] = number,
            _ => runs.push([number; 2]),
        }
    }
    let word = |[first, last]: &[u32; 2]| match first == last {
        true => first.to_string(),
        false => format!("{first}:{last}"),
    };
    runs.iter().map(word).collect::<Vec<_>>().join(" ")
}

/// Numbers from such a text; `None` if it is malformed.
pub(crate) fn from_runs(text: &str) -> Option<Vec<u32>> {
    let mut numbers = Vec::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        let (first, last) = word.split_once(':').unwrap_or((word, word));
        let (first, last): (u32, u32) = (first.parse().ok()?, last.parse().ok()?);
        // A damaged end must not take all memory.
        if last.checked_sub(first)? > MAX_RUN {
            return None;
        }
        numbers.extend(first..=last);
    }
    Some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selections_come_back_as_they_were() {
        let one = |owner: &str, points: &[u32]| SelectedPoints {
            owner: owner.to_owned(),
            object: "cloth 1".to_owned(),
            points: points.to_vec(),
        };
        let all = vec![one("pin", &[0, 3, 4, 5, 6, 9]), one("a:b", &[]), one("rim", &[u32::MAX])];
        let keys = to_keys(&all);
        assert_eq!(keys["selection 000000"], "pin\ncloth 1\n0 3:6 9");
        assert_eq!(from_keys(&keys), all);
    }

    #[test]
    fn malformed_selections_are_left_out() {
        for text in ["", "a\nb", "a\nb\nx", "a\nb\n5:3", "a\nb\n0:4294967295"] {
            assert_eq!(
                from_keys(&BTreeMap::from([("selection 0".to_owned(), text.to_owned())])),
                [],
                "{text}"
            );
        }
    }
}
