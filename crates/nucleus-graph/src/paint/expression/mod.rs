//! A number for each point, by an expression: `x > 0 ? 2 : 1`, `clamp(3 * u, 0.2, 1)`.
//!
//! | Can stand there | |
//! |---|---|
//! | `x` `y` `z` | where the point is in the space of its mesh at the start, in scene units |
//! | `u` `v` | its texture coordinates |
//! | `i` `n` | its number, from 0, and how many there are |
//! | `pi` | 3.14159... |
//! | `+ - * / % ^` | `%` has the sign of what is divided, `^` binds strongest and to the right |
//! | `< <= > >= == !=` | 1 where it holds, else 0 |
//! | `! && \|\|` and `a ? b : c` | what is not 0 holds |
//! | functions | see [`FUNCTIONS`](functions::FUNCTIONS) |

mod functions;
mod lexer;
mod parser;
#[cfg(test)]
mod tests;

use std::ops::Range;

/// What an expression can know of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// `x`, `y` or `z`: where it is, along an axis.
    Position(usize),
    /// `u` or `v`: its texture coordinates.
    Uv(usize),
    /// `i`: its number.
    Index,
    /// `n`: how many points there are.
    Count,
}

/// A point as an expression sees it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// In the space of its mesh.
    pub position: [f64; 3],
    /// Texture coordinates.
    pub uv: [f64; 2],
    /// Its number, from 0.
    pub index: usize,
    /// How many there are.
    pub count: usize,
}

/// One step of the evaluation, on a stack.
#[derive(Debug, Clone, Copy)]
enum Op {
    Number(f64),
    Variable(Variable),
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

/// An expression that has been understood. Evaluating it cannot fail, but may give no number, as `1 / 0` does.
#[derive(Debug, Clone)]
pub struct Expression {
    ops: Vec<Op>,
}

/// Why an expression cannot be understood, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// Lower case, no full stop, names in backticks.
    pub message: String,
    /// Where: bytes of the expression.
    pub span: Range<usize>,
    /// What can be done about it.
    pub help: Option<String>,
}

impl ExpressionError {
    fn new(message: impl Into<String>, span: Range<usize>) -> Self {
        Self { message: message.into(), span, help: None }
    }
}

impl Expression {
    /// Understands an expression.
    ///
    /// # Errors
    /// When it is not one; see [`ExpressionError`].
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Ok(Self { ops: parser::parse(text)? })
    }

    /// Its value at a point.
    pub fn at(&self, point: &Point) -> f64 {
        let mut stack = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            // The parser has seen to it that what is taken is there.
            let mut pop = || stack.pop().unwrap_or(f64::NAN);
            let value = match *op {
                Op::Number(number) => number,
                Op::Variable(variable) => point.value(variable),
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

    /// Whether it asks for texture coordinates.
    pub fn needs_uv(&self) -> bool {
        self.ops.iter().any(|op| matches!(op, Op::Variable(Variable::Uv(_))))
    }
}

impl Point {
    fn value(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Position(axis) => self.position[axis],
            Variable::Uv(part) => self.uv[part],
            Variable::Index => self.index as f64,
            Variable::Count => self.count as f64,
        }
    }
}
