//! Components as Maya writes them: `cloth1.vtx[3]`, `cloth1.vtx[0:8]`, `cloth1.vtx[*]`, `cloth1`.

use crate::attributes::{Component, Selection};

/// Reads a component.
///
/// # Errors
/// The message of a diagnostic.
pub(super) fn read(text: &str) -> Result<Component, String> {
    let Some((object, elements)) = text.split_once('.') else {
        let object = text.to_owned();
        return Ok(Component { object, selection: Selection::Object });
    };
    let bracketed = elements.strip_suffix(']').and_then(|elements| elements.split_once('['));
    let (kind, index) = bracketed.ok_or_else(|| format!("`{text}` is not a component"))?;
    if kind != "vtx" {
        return Err(format!("only points (`vtx`) are supported, not `{kind}`"));
    }
    Ok(Component { object: object.to_owned(), selection: read_points(index)? })
}

fn read_points(index: &str) -> Result<Selection, String> {
    if index == "*" || index == ":" {
        return Ok(Selection::AllPoints);
    }
    let (first, last) = index.split_once(':').unwrap_or((index, index));
    let point = |digits: &str| {
        // `parse` alone would accept a plus sign.
        let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = if plain { digits.parse::<u32>().ok() } else { None };
        number.ok_or_else(|| format!("`{digits}` is not the number of a point"))
    };
    let (first, last) = (point(first)?, point(last)?);
    if first > last {
        return Err(format!("the points from {first} to {last} are in the wrong order"));
    }
    Ok(Selection::Points { first, last })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn selections() -> impl Strategy<Value = Selection> {
        let run = (any::<u32>(), any::<u32>());
        let points = run.prop_map(|(a, b)| Selection::Points { first: a.min(b), last: a.max(b) });
        prop_oneof![Just(Selection::Object), Just(Selection::AllPoints), points]
    }

    proptest! {
        #[test]
        fn a_written_component_is_read_back(object in "[a-z][a-z0-9_]{0,8}", selection in selections()) {
            let component = Component { object, selection };
            prop_assert_eq!(read(&component.to_string()), Ok(component));
        }
    }

    #[test]
    fn malformed_components_are_refused() {
        for (text, message) in [
            ("a.vtx", "`a.vtx` is not a component"),
            ("a.vtx[", "`a.vtx[` is not a component"),
            ("a.f[3]", "only points (`vtx`) are supported, not `f`"),
            ("a.vtx[-1]", "`-1` is not the number of a point"),
            ("a.vtx[]", "`` is not the number of a point"),
            ("a.vtx[+1]", "`+1` is not the number of a point"),
            ("a.vtx[99999999999]", "`99999999999` is not the number of a point"),
            ("a.vtx[3:1]", "the points from 3 to 1 are in the wrong order"),
        ] {
            assert_eq!(read(text), Err(message.to_owned()));
        }
    }
}
