//! Components as Maya writes them, `cloth1.vtx[3]`, `cloth1.e[0:8]`, `cloth1.f[*]`, `cloth1`; and by meaning,
//! `cloth1.e[border]`, `cloth1.vtx[where(y > 1.49)]`. Without a kind, a meaning selects points: `cloth1.border`.

use crate::diagnostic::nearest;

use super::value::{Component, ElementKind, Selection, Which};

/// Examples of a selection by meaning, for messages.
const MEANINGS: &str = "`border`, `corners`, `where(...)`, `group(...)` or `mask(...)`";

/// Reads a component.
///
/// # Errors
/// The message of a diagnostic.
pub fn read_component(text: &str) -> Result<Component, String> {
    let Some((object, elements)) = text.split_once('.') else {
        let object = text.to_owned();
        return Ok(Component { object, selection: Selection::Object });
    };
    let selection = match read_meaning(elements) {
        Some(which) => Selection::Elements(ElementKind::Point, which?),
        None => {
            let bracketed = elements.strip_suffix(']').and_then(|elements| elements.split_once('['));
            let (word, which) = bracketed.ok_or_else(|| match nearest(elements, ["border", "corners"]) {
                Some(near) => format!("`{text}` is not a component; did you mean `{object}.{near}`?"),
                None => format!("`{text}` is not a component"),
            })?;
            let kind = ElementKind::WORDS.iter().find(|(known, _)| *known == word).map(|(_, kind)| *kind);
            let kind = kind.ok_or_else(|| {
                format!("`{word}` is no kind of elements: points are `vtx`, edges `e`, faces `f`")
            })?;
            Selection::Elements(kind, read_which(kind, which)?)
        }
    };
    Ok(Component { object: object.to_owned(), selection })
}

/// Reads the text between the brackets of a component.
///
/// # Errors
/// The message of a diagnostic.
pub(crate) fn read_which(kind: ElementKind, text: &str) -> Result<Which, String> {
    if text == "*" || text == ":" {
        return Ok(Which::All);
    }
    if let Some(which) = read_meaning(text) {
        return which;
    }
    let (first, last) = text.split_once(':').unwrap_or((text, text));
    let noun = kind.noun();
    let number = |digits: &str| {
        // `parse` alone would accept a plus sign.
        let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = if plain { digits.parse::<u32>().ok() } else { None };
        let article = if kind == ElementKind::Edge { "an" } else { "a" };
        number.ok_or_else(|| {
            let meant =
                nearest(digits, ["border", "corners"]).map(|word| format!("; did you mean `{word}`?"));
            format!("`{digits}` is not the number of {article} {noun}{}", meant.unwrap_or_default())
        })
    };
    let (first, last) = (number(first)?, number(last)?);
    if first > last {
        return Err(format!("the {noun}s from {first} to {last} are in the wrong order"));
    }
    Ok(Which::Range(first, last))
}

/// A selection by meaning; `None` where the text is none.
fn read_meaning(text: &str) -> Option<Result<Which, String>> {
    match text {
        "border" => return Some(Ok(Which::Border)),
        "corners" => return Some(Ok(Which::Corners)),
        _ => {}
    }
    let (word, argument) = text.strip_suffix(')')?.split_once('(')?;
    let quoted = argument.strip_prefix('"').and_then(|argument| argument.strip_suffix('"'));
    let argument = quoted.unwrap_or(argument).to_owned();
    Some(match word {
        _ if argument.is_empty() => Err(format!("`{word}()` needs something between its brackets")),
        "where" => Ok(Which::Where(argument)),
        "group" => Ok(Which::Group(argument)),
        "mask" => Ok(Which::Mask(argument)),
        _ => Err(format!("`{word}(...)` selects nothing: there is {MEANINGS}")),
    })
}

/// The values of a map that is given by a selection of points: `border; group(collar) ? 5 : 1`. Without values they are 1
/// for the selected points and 0 for the others.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SelectedValues {
    /// Points that are selected.
    pub(crate) selections: Vec<Which>,
    /// The value of selected points, and of others.
    pub(crate) values: [f64; 2],
}

impl SelectedValues {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (selections, values) = match top_level(text, '?').split_first() {
            Some((selections, [])) => (*selections, [1.0, 0.0]),
            Some((selections, [values])) => (*selections, Self::both(values)?),
            _ => return Err(format!("`{text}` has more than one `?`")),
        };
        let selections = top_level(selections, ';');
        let selections: Result<_, _> =
            selections.iter().map(|part| read_which(ElementKind::Point, part.trim())).collect();
        Ok(Self { selections: selections?, values })
    }

    fn both(text: &str) -> Result<[f64; 2], String> {
        let number = |part: &str| part.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        let both = text.split_once(':').and_then(|(a, b)| Some([number(a)?, number(b)?]));
        both.ok_or_else(|| format!("`{}` must be two numbers, like `5 : 1`", text.trim()))
    }
}

/// The parts of a text between separators that are not in brackets.
fn top_level(text: &str, separator: char) -> Vec<&str> {
    let mut depth = 0_i32;
    let at = |letter: char| {
        depth += i32::from(letter == '(') - i32::from(letter == ')');
        letter == separator && depth == 0
    };
    text.split(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn selections() -> impl Strategy<Value = Selection> {
        let run = (any::<u32>(), any::<u32>()).prop_map(|(a, b)| Which::Range(a.min(b), a.max(b)));
        let which = prop_oneof![
            run,
            Just(Which::All),
            Just(Which::Border),
            Just(Which::Corners),
            "[xyz] [<>] [0-9]\\.[0-9]".prop_map(Which::Where),
            "[a-z_.]{1,9}".prop_map(Which::Group),
            "[a-z/]{1,9}\\.png".prop_map(Which::Mask),
        ];
        let kind = proptest::sample::select(ElementKind::WORDS.map(|(_, kind)| kind).to_vec());
        prop_oneof![
            Just(Selection::Object),
            (kind, which).prop_map(|(kind, which)| Selection::Elements(kind, which))
        ]
    }

    proptest! {
        #[test]
        fn a_written_component_is_read_back(object in "[a-z][a-z0-9_]{0,8}", selection in selections()) {
            let component = Component { object, selection };
            prop_assert_eq!(read_component(&component.to_string()), Ok(component));
        }
    }

    #[test]
    fn a_meaning_without_a_kind_selects_points() {
        for (short, long) in [
            ("a.border", "a.vtx[border]"),
            ("a.where(\"y > 1.5\")", "a.vtx[where(y > 1.5)]"),
            ("a.mask(tear.png)", "a.vtx[mask(tear.png)]"),
        ] {
            assert_eq!(read_component(short), read_component(long));
            assert_eq!(read_component(short).expect("a component").to_string(), long);
        }
    }

    #[test]
    fn malformed_components_are_refused() {
        for (text, message) in [
            ("a.vtx", "`a.vtx` is not a component"),
            ("a.vtx[", "`a.vtx[` is not a component"),
            ("a.corner", "`a.corner` is not a component; did you mean `a.corners`?"),
            ("a.cv[3]", "`cv` is no kind of elements: points are `vtx`, edges `e`, faces `f`"),
            ("a.vtx[-1]", "`-1` is not the number of a point"),
            ("a.e[]", "`` is not the number of an edge"),
            ("a.vtx[+1]", "`+1` is not the number of a point"),
            ("a.vtx[99999999999]", "`99999999999` is not the number of a point"),
            ("a.f[3:1]", "the faces from 3 to 1 are in the wrong order"),
            ("a.e[boder]", "`boder` is not the number of an edge; did you mean `border`?"),
            ("a.where()", "`where()` needs something between its brackets"),
            (
                "a.near(3)",
                "`near(...)` selects nothing: there is `border`, `corners`, `where(...)`, `group(...)` or `mask(...)`",
            ),
        ] {
            assert_eq!(read_component(text), Err(message.to_owned()));
        }
    }
}
