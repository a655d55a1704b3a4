//! Agreement with `ron`: a text that is accepted here gives the same values there, and a text that `ron` refuses is
//! refused here.

use proptest::prelude::*;

use super::*;

/// A tree with the content of `ron::Value`: no names, and words as units.
#[derive(Debug, Clone, PartialEq)]
enum Plain {
    Number(f64),
    Text(String),
    Bool(bool),
    Nothing,
    Many(Vec<Plain>),
    Map(Vec<(Plain, Plain)>),
}

fn ours(node: &Node) -> Plain {
    let text = |word: &crate::scene::syntax::Word| Plain::Text(word.text.clone());
    match &node.value {
        Value::Number(number) => plain_number(*number),
        Value::Text(text) => Plain::Text(text.clone()),
        Value::Bool(bool) => Plain::Bool(*bool),
        Value::Word(_) => Plain::Nothing,
        Value::List(items) | Value::Tuple { items, .. } => many(items.iter().map(ours)),
        Value::Record { fields, .. } if fields.is_empty() => Plain::Nothing,
        Value::Record { fields, .. } => map(fields.iter().map(|(k, v)| (text(k), ours(v)))),
        Value::Map(entries) => map(entries.iter().map(|(k, v)| (ours(k), ours(v)))),
    }
}

fn theirs(value: &ron::Value) -> Plain {
    match value {
        ron::Value::Number(number) => plain_number(number.into_f64()),
        ron::Value::String(text) => Plain::Text(text.clone()),
        ron::Value::Bool(bool) => Plain::Bool(*bool),
        ron::Value::Unit => Plain::Nothing,
        ron::Value::Seq(items) => many(items.iter().map(theirs)),
        ron::Value::Map(entries) => map(entries.iter().map(|(k, v)| (theirs(k), theirs(v)))),
        other => panic!("no counterpart: {other:?}"),
    }
}

/// `ron` reads -0 as an integer, which has no sign: keys have to be sorted alike.
fn plain_number(number: f64) -> Plain {
    Plain::Number(if number == 0.0 { 0.0 } else { number })
}

/// `ron` reads an empty tuple as a unit or as an empty sequence, depending on its blanks.
fn many(items: impl Iterator<Item = Plain>) -> Plain {
    let items: Vec<_> = items.collect();
    if items.is_empty() { Plain::Nothing } else { Plain::Many(items) }
}

fn map(entries: impl Iterator<Item = (Plain, Plain)>) -> Plain {
    let mut entries: Vec<_> = entries.collect();
    entries.sort_by_key(|(key, _)| format!("{key:?}"));
    Plain::Map(entries)
}

/// `ron::Value` keeps only the last of equal keys, by another equality (1 and 1.0 differ).
fn has_equal_keys(plain: &Plain) -> bool {
    match plain {
        Plain::Many(items) => items.iter().any(has_equal_keys),
        Plain::Map(entries) => {
            entries.windows(2).any(|pair| pair[0].0 == pair[1].0)
                || entries.iter().any(|(key, value)| has_equal_keys(key) || has_equal_keys(value))
        }
        _ => false,
    }
}

/// Texts in RON: values with random names, blanks and comments.
fn written() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        any::<f64>().prop_filter("finite", |x| x.is_finite()).prop_map(|x| format!("{x:?}")),
        any::<i64>().prop_map(|x| x.to_string()),
        any::<u32>().prop_map(|x| format!("{x:#x}")),
        any::<u16>().prop_map(|x| format!("-{x:#o}")),
        "[0-9]{1,3}_[0-9]{1,3}(\\.[0-9]{0,3})?([eE][+-]?[0-9]{1,2})?",
        ".{0,6}".prop_map(|text| format!("{text:?}")),
        "[a-z\"\\\\\n]{0,6}".prop_map(|text| format!("r##\"{text}\"##")),
        Just("true".to_owned()),
        word(),
    ];
    leaf.prop_recursive(4, 48, 5, |inner| {
        let item = || (blank(), inner.clone(), blank()).prop_map(|(a, item, b)| format!("{a}{item}{b}"));
        let items = || prop::collection::vec(item(), 0..5);
        let named = prop::collection::vec((blank(), word(), item()), 0..5);
        let keyed = prop::collection::vec((item(), item()), 0..5);
        let name = || prop_oneof![Just(String::new()), (word(), blank()).prop_map(|(name, b)| name + &b)];
        prop_oneof![
            (items(), comma()).prop_map(|(items, end)| brackets("[", &items, &end, "]")),
            (name(), items(), comma())
                .prop_map(|(name, items, end)| name + &brackets("(", &items, &end, ")")),
            (name(), named, comma()).prop_map(|(name, fields, end)| {
                let fields: Vec<_> =
                    fields.iter().map(|(blank, key, value)| format!("{blank}{key}:{value}")).collect();
                name + &brackets("(", &fields, &end, ")")
            }),
            (keyed, comma()).prop_map(|(entries, end)| {
                let entries: Vec<_> = entries.iter().map(|(key, value)| format!("{key}:{value}")).collect();
                brackets("{", &entries, &end, "}")
            }),
        ]
    })
}

fn brackets(open: &str, items: &[String], end: &str, close: &str) -> String {
    let end = if items.is_empty() { "" } else { end };
    format!("{open}{}{end}{close}", items.join(","))
}

fn comma() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), blank().prop_map(|blank| format!(",{blank}"))]
}

fn blank() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => Just(String::new()),
        1 => "[ \t\r\n\u{b}\u{c}\u{85}\u{200e}\u{2028}]{1,2}",
        1 => "//[^\n]{0,4}\n",
        1 => "[ a*]{0,4}".prop_map(|text| format!("/*{text} /*{text} */ */")),
    ]
}

/// Names, except reserved words.
fn word() -> impl Strategy<Value = String> {
    "[a-zA-Z_][a-zA-Z0-9_]{0,5}".prop_filter("a name", |word| {
        !matches!(word.as_str(), "true" | "false" | "Some" | "None" | "inf" | "NaN" | "inff32" | "inff64")
    })
}

/// Whether `text` is accepted. If so, `ron` must accept it with the same values.
fn agree(text: &str) -> Result<bool, TestCaseError> {
    let Ok(node) = parse(text) else { return Ok(false) };
    match ron::from_str::<ron::Value>(text) {
        Ok(_) if has_equal_keys(&ours(&node)) => {}
        Ok(value) => prop_assert_eq!(ours(&node), theirs(&value), "{}", text),
        Err(error) => prop_assert!(false, "only ron refuses {:?}: {}", text, error),
    }
    Ok(true)
}

proptest! {
    #[test]
    fn valid_texts_are_read_as_by_ron(text in written()) {
        prop_assert!(agree(&text)?, "refused: {}: {:?}", text, parse(&text));
    }

    #[test]
    fn texts_that_ron_refuses_are_refused(
        text in written(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..3_u8, "[]()\\[{}:,\"'\\\\/*.#rxeb0-9_+\n -]"), 1..4),
    ) {
        let mut chars: Vec<char> = text.chars().collect();
        for (place, edit, new) in edits {
            let at = place.index(chars.len() + 1);
            match edit {
                0 => { chars.splice(at..at, new.chars()); }
                1 if at < chars.len() => { chars.remove(at); }
                _ => chars.truncate(at),
            }
        }
        agree(&chars.into_iter().collect::<String>())?;
    }

    #[test]
    fn no_text_panics_and_every_error_has_a_place(text in "(?s).{0,40}") {
        for error in parse(&text).err().unwrap_or_default() {
            prop_assert!(text.get(error.span.clone()).is_some(), "{:?} in {:?}", error, text);
        }
        agree(text.trim_start_matches('\u{feff}'))?;
    }
}

// These cases are cheap, and both parsers refuse most of them: only many find a text that one alone accepts.
proptest! {
    #![proptest_config(ProptestConfig::with_cases(8192))]

    #[test]
    fn runs_of_tokens_are_read_only_where_ron_reads_them(
        (open, close) in prop::sample::select(&[("", ""), ("(", ")"), ("[", "]"), ("{", "}"), ("a(", ")")][..]),
        tokens in prop::collection::vec(prop::sample::select(
            &["(", ")", "[", "]", "{", "}", ":", ",", "a", "r", "1", "\"x\"", "true", " ", "/**/", "a:", "[1]"][..]
        ), 0..7),
    ) {
        agree(&format!("{open}{}{close}", tokens.concat()))?;
    }

    #[test]
    fn numbers_are_read_only_where_ron_reads_them(text in "[-+]?(0[xob])?[0-9a-f_.eE+-]{1,5}") {
        agree(&text)?;
    }

    #[test]
    fn text_in_quotes_is_read_only_where_ron_reads_it(text in "r?#{0,2}\"([a\"#\n]|\\\\[nx0u{}4\"\\\\]?){0,6}\"#{0,2}") {
        agree(&text)?;
    }
}

#[test]
fn texts_at_the_nesting_limit_are_accepted_by_ron_too() {
    for (open, close) in [("[", "]"), ("(", ")"), ("{1:", "}"), ("a(b:", ")"), ("a(", ")")] {
        let text = format!("{}1{}", open.repeat(64), close.repeat(64));
        assert!(parse(&text).is_ok() && ron::from_str::<ron::Value>(&text).is_ok(), "{open}");
    }
}

#[test]
fn keys_of_minus_zero_are_read_as_by_ron() {
    assert!(agree("{-00: 1, -1: 2}").is_ok_and(|accepted| accepted));
}
