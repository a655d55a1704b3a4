use proptest::prelude::*;

use super::*;

fn value(text: &str) -> f64 {
    let point = Point { position: [2.0, -3.0, 0.5], uv: [0.25, 0.75], index: 4, count: 10 };
    Expression::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).at(&point)
}

#[test]
fn operators_have_their_usual_precedence_and_functions_their_values() {
    for (text, expected) in [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("8 - 3 - 2", 3.0),
        ("16 / 4 / 2", 2.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("-2 ^ 2", -4.0),
        ("2 ^ -1", 0.5),
        ("--3", 3.0),
        ("7 % 4", 3.0),
        (".5 + 1.5e1 + 2E-1", 15.7),
        ("x * x + y * y", 13.0),
        ("u + 10 * v", 7.75),
        ("i / (n - 1)", 4.0 / 9.0),
        ("z", 0.5),
        ("x > 1 ? 5 : 7", 5.0),
        ("y > 1 ? 5 : z < 1 ? 6 : 7", 6.0),
        ("x >= 2 && y != 0", 1.0),
        ("x < 2 || !(y == 0)", 1.0),
        ("1 < 2 == 1", 1.0),
        ("clamp(x, 0, 1)", 1.0),
        ("max(min(x, 1), -1)", 1.0),
        ("smoothstep(0, 1, z)", 0.5),
        ("mix(1, 3, z)", 2.0),
        ("step(0.5, z)", 1.0),
        ("sqrt(abs(y) + 6)", 3.0),
        ("round(sin(pi / 2))", 1.0),
        ("atan2(1, 1) * 4 / pi", 1.0),
    ] {
        let found = value(text);
        assert!((found - expected).abs() < 1e-15, "{text} is {found}");
    }
}

#[test]
fn a_mistake_is_reported_with_its_place() {
    for (text, at, message) in [
        ("", "", "expected a value, but the expression ends"),
        ("1 +", "", "expected a value, but the expression ends"),
        ("1 2", "2", "expected nothing more, but found 2"),
        ("(1 + 2", "", "expected `)`, but the expression ends"),
        ("w * 2", "w", "there is no `w` in an expression"),
        ("3 * sin", "sin", "there is no `sin` in an expression"),
        ("sine(x)", "sine", "there is no function `sine`"),
        ("min(x)", "min", "`min` takes 2 arguments, found 1"),
        ("abs()", "abs", "`abs` takes 1 arguments, found 0"),
        ("1 $ 2", "$", "an expression has no `$`"),
        ("1e999", "1e999", "`1e999` is not a finite number"),
        ("x ? 1", "", "expected `:`, but the expression ends"),
        ("µ", "µ", "there is no `µ` in an expression"),
        ("1..2", ".2", "expected nothing more, but found 0.2"),
    ] {
        let error = Expression::parse(text).expect_err(text);
        assert_eq!((error.message.as_str(), &text[error.span.clone()]), (message, at), "{text}");
    }
    assert_eq!(Expression::parse("sine(x)").expect_err("no").help.as_deref(), Some("did you mean `sin`?"));
}

#[test]
fn deep_brackets_are_refused_and_long_sums_are_not() {
    let deep = format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000));
    assert_eq!(Expression::parse(&deep).expect_err("too deep").message, "this is nested too deeply");
    let powers = "2^".repeat(100_000) + "1";
    assert_eq!(Expression::parse(&powers).expect_err("too deep").message, "this is nested too deeply");
    assert_eq!(value(&("1+".repeat(100_000) + "1")), 100_001.0);
    assert_eq!(value(&("-".repeat(100_000) + "1")), 1.0);
}

proptest! {
    #[test]
    fn any_text_parses_or_gives_an_error_within_the_text(text in "[-+*/%^<>=!&|?:(),. 0-9a-zµ]{0,40}") {
        match Expression::parse(&text) {
            Ok(expression) => drop(expression.at(&Point::default())),
            Err(error) => prop_assert!(text.get(error.span.clone()).is_some(), "{error:?}"),
        }
    }

    #[test]
    fn expressions_of_numbers_have_the_value_of_the_same_rust_expression(a in -1e3..1e3f64, b in -1e3..1e3f64, c in -1e3..1e3f64) {
        prop_assert_eq!(value(&format!("{a} * ({b}) - ({c})")), a * b - c);
        prop_assert_eq!(value(&format!("{a} < {b} ? {c} : {a}")), if a < b { c } else { a });
    }
}

#[test]
fn every_documented_function_and_variable_is_understood() {
    for (usage, doc) in functions() {
        let (name, arguments) = usage.split_once('(').expect(usage);
        let call = format!("{name}({})", vec!["0.5"; arguments.split(',').count()].join(", "));
        assert!(Expression::parse(&call).is_ok() && !doc.is_empty(), "{call}");
    }
    for (name, _) in variables() {
        assert!(Expression::parse(name).is_ok(), "{name}");
    }
    assert_eq!((functions().count(), variables().count()), (22, 8));
}
