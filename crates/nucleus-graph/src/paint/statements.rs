//! Statements: `vy = 2 * vy; lifespan = 1 + rand`. They run one after another, each once, so they always end.

use super::expression::{Expression, ExpressionError, Variable};

/// Assignments of expressions to named variables.
#[derive(Debug, Clone)]
pub struct Statements {
    /// The place of the assigned variable among the names, and the expression.
    list: Vec<(usize, Expression)>,
}

impl Statements {
    /// Parses statements, separated by semicolons, over variables of these names; only the first `writable` of them may be
    /// assigned.
    ///
    /// # Errors
    /// The first mistake with its place; see [`ExpressionError`].
    pub fn parse(text: &str, names: &[&str], writable: usize) -> Result<Self, ExpressionError> {
        let mut list = Vec::new();
        let mut from = 0;
        for part in text.split(';') {
            let span = from..from + part.len();
            from = span.end + 1;
            if part.trim().is_empty() {
                continue;
            }
            let Some((name, expression)) = part.split_once('=') else {
                let message = format!("`{}` is no statement", part.trim());
                let help = "write `name = expression`".to_owned();
                return Err(ExpressionError { message, span, help: Some(help) });
            };
            let place =
                names.iter().position(|known| *known == name.trim()).filter(|&place| place < writable);
            let Some(place) = place else {
                let message = format!("`{}` cannot be assigned", name.trim());
                let help = format!("assign {}", names[..writable].join(", "));
                return Err(ExpressionError { message, span, help: Some(help) });
            };
            let before = span.start + name.len() + 1;
            let shifted = |error: ExpressionError| {
                let span = error.span.start + before..error.span.end + before;
                ExpressionError { span, ..error }
            };
            list.push((place, Expression::parse_over(expression, names).map_err(shifted)?));
        }
        Ok(Self { list })
    }

    /// Runs the statements on the values of the variables.
    pub fn run(&self, values: &mut [f64]) {
        for (place, expression) in &self.list {
            let value = expression.evaluate(|variable| match variable {
                Variable::Own(at) => values.get(at).copied().unwrap_or(f64::NAN),
                _ => f64::NAN,
            });
            values[*place] = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_run_in_their_order_and_see_what_was_assigned() {
        let statements =
            Statements::parse("a = b + 1; b = 2 * a; ", &["a", "b", "c"], 2).expect("they parse");
        let mut values = [0.0, 3.0, 9.0];
        statements.run(&mut values);
        assert_eq!(values, [4.0, 8.0, 9.0]);
    }

    #[test]
    fn a_mistake_is_named_at_its_place() {
        let error = |text: &str| {
            let error = Statements::parse(text, &["a", "b"], 1).expect_err("a mistake");
            (error.message, error.span)
        };
        assert_eq!(error("a = 1; b = 2"), ("`b` cannot be assigned".to_owned(), 6..12));
        assert_eq!(error("a = 1; a"), ("`a` is no statement".to_owned(), 6..8));
        assert_eq!(error("a = 1; a = x"), ("there is no `x` in an expression".to_owned(), 11..12));
    }
}
