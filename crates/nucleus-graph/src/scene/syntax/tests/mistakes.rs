//! Errors: place and message.

use super::*;

fn errors(text: &str) -> Vec<SyntaxError> {
    parse(text).expect_err(text)
}

/// The only error of a text: the text of its place, and its message.
fn error(text: &str) -> (&str, String) {
    let errors = errors(text);
    assert_eq!(errors.len(), 1, "{text}: {errors:?}");
    (at(text, &errors[0]), errors[0].message.clone())
}

#[test]
fn an_empty_file_is_refused() {
    for text in ["", "  \n", "// nothing", "\u{feff}", "/* nothing */"] {
        assert_eq!(error(text), ("", "there is nothing in this file".into()));
    }
}

#[test]
fn all_bad_numbers_are_reported_together() {
    let text = "(a: 1.2.3, b: NaN, c: [-inf, 1e999], d: 5cm, e: 2)";
    let all: Vec<_> = errors(text).iter().map(|e| (at(text, e), e.message.clone())).collect();
    let expected = [
        ("1.2.3", "`1.2.3` is not a number"),
        ("NaN", "`NaN` is not a finite number"),
        ("-inf", "`-inf` is not a finite number"),
        ("1e999", "`1e999` is too large for a number"),
        ("5cm", "`5cm` is not a number"),
    ];
    assert_eq!(all, expected.map(|(place, message)| (place, message.to_owned())));
}

#[test]
fn the_error_of_an_unclosed_bracket_points_at_the_bracket() {
    let all = errors("(a: [1, 2");
    assert_eq!((all[0].span.clone(), all[0].message.as_str()), (4..5, "this `[` is never closed"));
    assert_eq!(errors("(a: [1, 2]")[0].span, 0..1);
    assert_eq!(errors("(a: ")[0].span, 0..1);
}

#[test]
fn a_wrong_bracket_names_the_one_that_was_opened() {
    let text = "(\n  a: [1, 2)";
    let all = errors(text);
    assert_eq!((at(text, &all[0]), all[0].message.as_str()), (")", "expected `,` or `]`, found `)`"));
    assert_eq!(all[0].help.as_deref(), Some("this is inside the `[` of line 2, column 6"));
}

#[test]
fn a_missing_comma_does_not_hide_later_errors() {
    let text = "(\n  a: 1\n  b: 1.2.3,\n)";
    let all = errors(text);
    assert_eq!((all[0].span.clone(), all[0].message.as_str()), (8..8, "a comma is missing"));
    assert_eq!(at(text, &all[1]), "1.2.3");
    assert_eq!(all.len(), 2);
}

#[test]
fn unterminated_text_is_noticed_on_its_own_line() {
    assert_eq!(error("(a: \"silk,\n b: \"x\")"), ("\"silk,", "this text is never closed".into()));
    assert_eq!(error("r#\"silk\""), ("r#\"", "this text is never closed".into()));
    assert_eq!(error("(a: 1, /* silk"), ("/*", "this comment is never closed".into()));
}

#[test]
fn all_invalid_escapes_are_reported() {
    let text = r#"["C:\maya", "\u{110000}", "\xe9"]"#;
    let places: Vec<_> = errors(text).iter().map(|e| at(text, e).to_owned()).collect();
    assert_eq!(places, [r"\m", r"\u", r"\x"]);
    for escape in [r"\x+4", r"\x4", r"\u{0000041}", r"\u{+41}", r"\u{}", r"\u{41", r"\u41", r"\ü", r"\"] {
        let text = format!("[\"{escape}\"]");
        assert!(parse(&text).is_err() && ron::from_str::<ron::Value>(&text).is_err(), "{text}");
    }
}

#[test]
fn deep_nesting_is_an_error_and_no_stack_overflow() {
    for opening in ["(", "[", "{", "a(b:", "[("] {
        let all = errors(&opening.repeat(100_000));
        assert!(all[0].message.starts_with("more than 64 brackets"), "{opening}: {all:?}");
    }
    assert!(parse(&format!("{}{}", "[".repeat(64), "]".repeat(64))).is_ok());
}

#[test]
fn text_after_the_value_is_refused() {
    assert_eq!(error("(a: 1) b"), ("b", "expected the end of the file, found `b`".into()));
    assert_eq!(error("(a: 1))"), (")", "expected the end of the file, found `)`".into()));
}

#[test]
fn forms_that_scenes_do_not_use_are_refused_with_the_form_to_use() {
    assert_eq!(error("(a: 'silk')"), ("'silk'", "text is written in double quotes".into()));
    assert_eq!(error("(a: Some(1))"), ("Some", "`Some` is not used here".into()));
    assert_eq!(error("(a: 1\u{a0})").1, "expected `,` or `)`, found the character U+00A0");
    assert_eq!(error("(a: 1, b 2)"), ("2", "expected `:`, found `2`".into()));
    assert_eq!(error("(a: 1, 2)"), ("2", "expected a field's name, found `2`".into()));
    assert_eq!(error("[1,,2]"), (",", "expected a value, found `,`".into()));
    for text in ["1u8", "b\"x\"", "1..2", "r#a", "#![enable(implicit_some)] 1", "größe"] {
        assert!(parse(text).is_err(), "{text}");
    }
}
