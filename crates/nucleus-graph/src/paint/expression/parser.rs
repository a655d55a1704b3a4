//! A recursive-descent parser: from tokens to stack operations, by precedence.

use std::ops::Range;

use super::lexer::{ExpressionError, Token, tokens};
use super::ops::{FUNCTIONS, NAMES, Op, Variable};
use crate::diagnostic::nearest;

/// Limit on nesting: deeper brackets are a mistake, and recursion needs stack.
const MAX_DEPTH: usize = 64;

/// A binary operator and its function.
type Operator = (&'static str, fn(f64, f64) -> f64);

/// Binary operators by precedence, lowest first, all left-associative.
const BINARY: [&[Operator]; 5] = [
    &[("||", |a, b| truth(a != 0.0 || b != 0.0))],
    &[("&&", |a, b| truth(a != 0.0 && b != 0.0))],
    &[
        ("<", |a, b| truth(a < b)),
        ("<=", |a, b| truth(a <= b)),
        (">", |a, b| truth(a > b)),
        (">=", |a, b| truth(a >= b)),
        ("==", |a, b| truth(a == b)),
        ("!=", |a, b| truth(a != b)),
    ],
    &[("+", |a, b| a + b), ("-", |a, b| a - b)],
    &[("*", |a, b| a * b), ("/", |a, b| a / b), ("%", |a, b| a % b)],
];

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// Parses an expression into stack operations. `own` are names of variables in place of those of a point, if there are any.
pub(super) fn parse(text: &str, own: &[&str]) -> Result<Vec<Op>, ExpressionError> {
    let mut parser = Parser { tokens: tokens(text)?, own, at: 0, depth: 0, ops: Vec::new() };
    parser.choice()?;
    match parser.token() {
        Token::End => Ok(parser.ops),
        _ => Err(parser.unexpected("nothing more")),
    }
}

struct Parser<'a> {
    tokens: Vec<(Token<'a>, Range<usize>)>,
    own: &'a [&'a str],
    at: usize,
    depth: usize,
    ops: Vec<Op>,
}

impl<'a> Parser<'a> {
    fn token(&self) -> Token<'a> {
        self.tokens[self.at].0
    }

    fn span(&self) -> Range<usize> {
        self.tokens[self.at].1.clone()
    }

    /// Consumes this sign if it is next.
    fn eat(&mut self, sign: &str) -> bool {
        let is_next = matches!(self.token(), Token::Sign(next) if next == sign);
        self.at += usize::from(is_next);
        is_next
    }

    fn expect(&mut self, sign: &str) -> Result<(), ExpressionError> {
        if self.eat(sign) { Ok(()) } else { Err(self.unexpected(&format!("`{sign}`"))) }
    }

    fn unexpected(&self, wanted: &str) -> ExpressionError {
        let found = match self.token() {
            Token::Number(number) => format!("found {number}"),
            Token::Name(name) => format!("found `{name}`"),
            Token::Sign(sign) => format!("found `{sign}`"),
            Token::End => "the expression ends".to_owned(),
        };
        ExpressionError::new(format!("expected {wanted}, but {found}"), self.span())
    }

    /// `a ? b : c`. Both branches are evaluated, and one is selected.
    fn choice(&mut self) -> Result<(), ExpressionError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(ExpressionError::new("this is nested too deeply", self.span()));
        }
        self.binary(0)?;
        if self.eat("?") {
            self.choice()?;
            self.expect(":")?;
            self.choice()?;
            self.ops.push(Op::Three(|condition, yes, no| if condition != 0.0 { yes } else { no }));
        }
        self.depth -= 1;
        Ok(())
    }

    fn binary(&mut self, level: usize) -> Result<(), ExpressionError> {
        let Some(operators) = BINARY.get(level) else { return self.unary() };
        self.binary(level + 1)?;
        while let Some((_, f)) = operators.iter().find(|(sign, _)| self.eat(sign)) {
            self.binary(level + 1)?;
            self.ops.push(Op::Two(*f));
        }
        Ok(())
    }

    /// Prefix operators, applied from the innermost.
    fn unary(&mut self) -> Result<(), ExpressionError> {
        let mut signs: Vec<fn(f64) -> f64> = Vec::new();
        loop {
            if self.eat("-") {
                signs.push(|a| -a);
            } else if self.eat("!") {
                signs.push(|a| truth(a == 0.0));
            } else if !self.eat("+") {
                break;
            }
        }
        self.power()?;
        self.ops.extend(signs.into_iter().rev().map(Op::One));
        Ok(())
    }

    /// `a ^ b` binds more strongly than a prefix of `a`, and less than a prefix of `b`.
    fn power(&mut self) -> Result<(), ExpressionError> {
        self.value()?;
        if self.eat("^") {
            self.depth += 1;
            if self.depth > MAX_DEPTH {
                return Err(ExpressionError::new("this is nested too deeply", self.span()));
            }
            self.unary()?;
            self.depth -= 1;
            self.ops.push(Op::Two(f64::powf));
        }
        Ok(())
    }

    fn value(&mut self) -> Result<(), ExpressionError> {
        match self.token() {
            Token::Number(number) => {
                self.at += 1;
                self.ops.push(Op::Number(number));
                Ok(())
            }
            Token::Name(name) => {
                let span = self.span();
                self.at += 1;
                if self.eat("(") { self.call(name, span) } else { self.name(name, span) }
            }
            Token::Sign("(") => {
                self.at += 1;
                self.choice()?;
                self.expect(")")
            }
            _ => Err(self.unexpected("a value")),
        }
    }

    fn name(&mut self, name: &str, span: Range<usize>) -> Result<(), ExpressionError> {
        let is_own = !self.own.is_empty();
        if let Some(at) = self.own.iter().position(|known| *known == name) {
            self.ops.push(Op::Variable(Variable::Own(at)));
            return Ok(());
        }
        let is_known = |op: &Op| !is_own || matches!(op, Op::Number(_));
        if let Some((_, op, _)) = NAMES.iter().find(|(known, op, _)| *known == name && is_known(op)) {
            self.ops.push(*op);
            return Ok(());
        }
        let mut error = ExpressionError::new(format!("there is no `{name}` in an expression"), span);
        let is_function = FUNCTIONS.iter().any(|(known, ..)| *known == name);
        let names: Vec<&str> = match is_own {
            true => self.own.to_vec(),
            false => NAMES.iter().map(|(name, ..)| *name).collect(),
        };
        error.help = Some(match is_function {
            true => format!("`{name}` is a function: write `{name}(...)`"),
            false if is_own => format!("a particle has {}", names.join(", ")),
            false => format!("a point has {}", names.join(", ")),
        });
        Err(error)
    }

    /// A function call, after its opening bracket.
    fn call(&mut self, name: &str, span: Range<usize>) -> Result<(), ExpressionError> {
        let Some((_, function, ..)) = FUNCTIONS.iter().find(|(known, ..)| *known == name) else {
            let mut error = ExpressionError::new(format!("there is no function `{name}`"), span);
            let all: Vec<&str> = FUNCTIONS.iter().map(|(name, ..)| *name).collect();
            error.help = Some(match nearest(name, all.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", all.join(", ")),
            });
            return Err(error);
        };
        let mut found = 0;
        if !self.eat(")") {
            loop {
                self.choice()?;
                found += 1;
                if !self.eat(",") {
                    break;
                }
            }
            self.expect(")")?;
        }
        let wanted = function.arguments();
        if found != wanted {
            let message = format!("`{name}` takes {wanted} arguments, found {found}");
            return Err(ExpressionError::new(message, span));
        }
        self.ops.push(function.op());
        Ok(())
    }
}
