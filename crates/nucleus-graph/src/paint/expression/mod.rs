//! Expressions that give a number per point: `x > 0 ? 2 : 1`, `clamp(3 * u, 0.2, 1)`.
//!
//! | Syntax | Meaning |
//! |---|---|
//! | `x` `y` `z` | position of the point in the space of its mesh at the start, in scene units |
//! | `u` `v` | its texture coordinates |
//! | `i` `n` | its number from 0, and the number of points |
//! | `pi` | 3.14159... |
//! | `+ - * / % ^` | `%` has the sign of the dividend; `^` binds strongest and is right-associative |
//! | `< <= > >= == !=` | 1 if true, else 0 |
//! | `! && \|\|` and `a ? b : c` | nonzero is true |
//! | functions | see [`FUNCTIONS`](ops::FUNCTIONS) |

mod lexer;
mod ops;
mod parser;
#[cfg(test)]
mod tests;

pub use lexer::ExpressionError;
use ops::Op;
pub use ops::{Point, Variable};

/// A parsed expression. Evaluation cannot fail, but its result need not be finite: `1 / 0`.
#[derive(Debug, Clone)]
pub struct Expression {
    ops: Vec<Op>,
}

/// Variables and constants of expressions, each with its meaning.
pub fn variables() -> impl Iterator<Item = (&'static str, &'static str)> {
    ops::NAMES.iter().map(|(name, _, doc)| (*name, *doc))
}

/// Functions of expressions, each as it is written, with its meaning.
pub fn functions() -> impl Iterator<Item = (&'static str, &'static str)> {
    ops::FUNCTIONS.iter().map(|(_, _, usage, doc)| (*usage, *doc))
}

/// Operators of expressions by precedence, weakest first, each with its meaning.
pub fn operators() -> impl Iterator<Item = (&'static str, &'static str)> {
    [
        ("a ? b : c", "b where a is not zero, else c"),
        ("a || b", "1 where one of them is not zero, else 0"),
        ("a && b", "1 where both are not zero, else 0"),
        ("< <= > >= == !=", "1 if true, else 0"),
        ("a + b, a - b", "sum and difference"),
        ("a * b, a / b, a % b", "product, quotient and remainder, which has the sign of a"),
        ("-a, !a", "negative; 1 where a is zero, else 0"),
        ("a ^ b", "power, from right to left"),
    ]
    .into_iter()
}

impl Expression {
    /// Parses an expression.
    ///
    /// # Errors
    /// The first mistake with its place; see [`ExpressionError`].
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Ok(Self { ops: parser::parse(text, &[])? })
    }

    /// Parses an expression over variables of these names, in place of those of a point.
    pub(super) fn parse_over(text: &str, names: &[&str]) -> Result<Self, ExpressionError> {
        Ok(Self { ops: parser::parse(text, names)? })
    }

    /// The value at a point.
    pub fn at(&self, point: &Point) -> f64 {
        self.evaluate(|variable| point.value(variable))
    }

    /// The value for values of its variables.
    pub(super) fn evaluate(&self, value: impl Fn(Variable) -> f64) -> f64 {
        let mut stack = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            // The parser guarantees enough operands on the stack.
            let mut pop = || stack.pop().unwrap_or(f64::NAN);
            let value = match *op {
                Op::Number(number) => number,
                Op::Variable(variable) => value(variable),
                Op::One(f) => f(pop()),
                Op::Two(f) => {
                    let b = pop();
                    f(pop(), b)
                }
                Op::Three(f) => {
                    let (c, b) = (pop(), pop());
                    f(pop(), b, c)
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or(f64::NAN)
    }

    /// Whether it uses texture coordinates.
    pub fn needs_uv(&self) -> bool {
        self.ops.iter().any(|op| matches!(op, Op::Variable(Variable::Uv(_))))
    }
}
