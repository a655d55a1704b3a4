//! The syntax of expressions: the part of MEL that artists write into expression nodes.

/// A number, a name, or a sign.
#[derive(Debug, Clone, PartialEq)]
enum Lexeme {
    Number(f64),
    /// `time`, `sin`, `$x`, `.I[0]`, `nCloth1.tx`.
    Name(String),
    Sign(&'static str),
}

/// A statement.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    /// A value for a name: `.O[0]`, `$x` or a plug.
    Let(String, Term),
    /// One of two blocks.
    If(Term, Vec<Step>, Vec<Step>),
}

/// A term.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Term {
    Number(f64),
    Name(String),
    Call(String, Vec<Term>),
    Two(&'static str, Box<Term>, Box<Term>),
    Minus(Box<Term>),
    Not(Box<Term>),
    Choose(Box<[Term; 3]>),
}

/// Signs, longer ones first.
const SIGNS: [&str; 27] = [
    "<=", ">=", "==", "!=", "&&", "||", "+=", "-=", "*=", "/=", "++", "--", "+", "-", "*", "/", "%", "(",
    ")", "{", "}", "<", ">", "=", "?", ":", "!",
];

/// Binary signs by how they bind, loosest first.
const BINARY: [&[&str]; 6] =
    [&["||"], &["&&"], &["==", "!="], &["<", "<=", ">", ">="], &["+", "-"], &["*", "/", "%"]];

/// Deepest nesting of terms and blocks.
const MAX_DEPTH: u32 = 100;

/// Most binary signs of a statement: each makes the tree of a term deeper, which is checked and freed recursively.
const MAX_SIGNS: u32 = 1000;

/// Parses the text of an expression.
pub(super) fn parse(text: &str) -> Result<Vec<Step>, String> {
    let mut parser = Parser { lexemes: lexemes(text)?, at: 0, depth: 0, signs: 0 };
    let mut steps = Vec::new();
    while parser.at < parser.lexemes.len() {
        parser.statement(&mut steps)?;
    }
    Ok(steps)
}

fn lexemes(text: &str) -> Result<Vec<Lexeme>, String> {
    let mut all = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        if first.is_whitespace() {
            rest = &rest[first.len_utf8()..];
        } else if rest.starts_with("//") {
            rest = rest.split_once('\n').map_or("", |(_, after)| after);
        } else if rest.starts_with("/*") {
            rest = rest.split_once("*/").map_or("", |(_, after)| after);
        } else if first.is_ascii_digit() || is_number_with_dot(rest) {
            let end = number_end(rest);
            let number = rest[..end].parse().map_err(|_| format!("`{}` is no number", &rest[..end]))?;
            all.push(Lexeme::Number(number));
            rest = &rest[end..];
        } else if first.is_alphabetic() || matches!(first, '$' | '_' | '.' | '|' if !rest.starts_with("||")) {
            let end = name_end(rest);
            all.push(Lexeme::Name(rest[..end].to_owned()));
            rest = &rest[end..];
        } else if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
            all.push(Lexeme::Sign(sign));
            rest = &rest[sign.len()..];
        } else if let Some(sign) = [";", ","].iter().find(|sign| rest.starts_with(**sign)) {
            all.push(Lexeme::Sign(sign));
            rest = &rest[1..];
        } else {
            return Err(format!("`{first}` is not read"));
        }
    }
    Ok(all)
}

fn is_number_with_dot(rest: &str) -> bool {
    rest.starts_with('.') && rest[1..].starts_with(|c: char| c.is_ascii_digit())
}

fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = bytes.iter().position(|b| !(b.is_ascii_digit() || *b == b'.')).unwrap_or(bytes.len());
    if end < bytes.len() && matches!(bytes[end], b'e' | b'E') {
        let sign = usize::from(end + 1 < bytes.len() && matches!(bytes[end + 1], b'+' | b'-'));
        let digits = bytes[end + 1 + sign..].iter().take_while(|b| b.is_ascii_digit()).count();
        end += if digits > 0 { 1 + sign + digits } else { 0 };
    }
    end
}

fn name_end(text: &str) -> usize {
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '$' | '_' | '.' | '|' | ':' | '[' | ']');
    let end = text.find(|c: char| !is_part(c)).unwrap_or(text.len());
    // `a ? b:c` without blanks: a colon belongs to a name only between letters of a namespace.
    let name = &text[..end];
    match name.find(':') {
        Some(colon) if !name[colon + 1..].contains('.') => colon,
        _ => end,
    }
}

struct Parser {
    lexemes: Vec<Lexeme>,
    at: usize,
    depth: u32,
    /// Binary signs of the present statement.
    signs: u32,
}

impl Parser {
    fn take(&mut self, sign: &str) -> bool {
        let is_there = self.lexemes.get(self.at)
            == SIGNS.iter().chain(&[";", ","]).find(|s| **s == sign).map(|s| Lexeme::Sign(s)).as_ref();
        self.at += usize::from(is_there);
        is_there
    }

    fn expect(&mut self, sign: &str) -> Result<(), String> {
        if self.take(sign) { Ok(()) } else { Err(format!("`{sign}` is missing")) }
    }

    fn nested<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, String>) -> Result<T, String> {
        if self.depth == MAX_DEPTH {
            return Err("it is nested too deeply".to_owned());
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    fn statement(&mut self, steps: &mut Vec<Step>) -> Result<(), String> {
        self.signs = 0;
        if self.take(";") {
            return Ok(());
        }
        if self.take("{") {
            while !self.take("}") {
                if self.at >= self.lexemes.len() {
                    return Err("`}` is missing".to_owned());
                }
                self.nested(|parser| parser.statement(steps))?;
            }
            return Ok(());
        }
        let Some(Lexeme::Name(name)) = self.lexemes.get(self.at).cloned() else {
            return Err("a statement begins with a name".to_owned());
        };
        self.at += 1;
        match name.as_str() {
            "if" => self.choice(steps),
            "float" | "int" => self.declaration(steps),
            _ => self.assignment(name, steps),
        }
    }

    fn choice(&mut self, steps: &mut Vec<Step>) -> Result<(), String> {
        self.expect("(")?;
        let condition = self.term()?;
        self.expect(")")?;
        let (mut yes, mut no) = (Vec::new(), Vec::new());
        self.nested(|parser| parser.statement(&mut yes))?;
        if self.lexemes.get(self.at) == Some(&Lexeme::Name("else".to_owned())) {
            self.at += 1;
            self.nested(|parser| parser.statement(&mut no))?;
        }
        steps.push(Step::If(condition, yes, no));
        Ok(())
    }

    fn declaration(&mut self, steps: &mut Vec<Step>) -> Result<(), String> {
        loop {
            let Some(Lexeme::Name(name)) = self.lexemes.get(self.at).cloned() else {
                return Err("a variable has no name".to_owned());
            };
            self.at += 1;
            let value = if self.take("=") { self.term()? } else { Term::Number(0.0) };
            steps.push(Step::Let(name, value));
            if !self.take(",") {
                return self.end();
            }
        }
    }

    fn assignment(&mut self, name: String, steps: &mut Vec<Step>) -> Result<(), String> {
        let own = || Box::new(Term::Name(name.clone()));
        for (sign, with) in [("+=", "+"), ("-=", "-"), ("*=", "*"), ("/=", "/")] {
            if self.take(sign) {
                let value = Term::Two(with, own(), Box::new(self.term()?));
                steps.push(Step::Let(name, value));
                return self.end();
            }
        }
        if !self.take("=") {
            return Err(format!("`{name}` is a command, which is not carried out"));
        }
        let value = self.term()?;
        steps.push(Step::Let(name, value));
        self.end()
    }

    /// A semicolon, which may be missing at the end of a block or of the text.
    fn end(&mut self) -> Result<(), String> {
        let closes = self.lexemes.get(self.at) == Some(&Lexeme::Sign("}"));
        if self.take(";") || closes || self.at >= self.lexemes.len() {
            Ok(())
        } else {
            Err("`;` is missing".to_owned())
        }
    }

    fn term(&mut self) -> Result<Term, String> {
        self.nested(|parser| {
            let condition = parser.binary(0)?;
            if !parser.take("?") {
                return Ok(condition);
            }
            let yes = parser.term()?;
            parser.expect(":")?;
            let no = parser.term()?;
            Ok(Term::Choose(Box::new([condition, yes, no])))
        })
    }

    fn binary(&mut self, level: usize) -> Result<Term, String> {
        let Some(signs) = BINARY.get(level) else { return self.unary() };
        let mut left = self.binary(level + 1)?;
        while let Some(sign) = signs.iter().copied().find(|sign| self.take(sign)) {
            let right = self.binary(level + 1)?;
            left = Term::Two(sign, Box::new(left), Box::new(right));
            self.signs += 1;
            if self.signs > MAX_SIGNS {
                return Err("it is too long".to_owned());
            }
        }
        Ok(left)
    }

    fn unary(&mut self) -> Result<Term, String> {
        self.nested(|parser| {
            if parser.take("-") {
                return Ok(Term::Minus(Box::new(parser.unary()?)));
            }
            if parser.take("!") {
                return Ok(Term::Not(Box::new(parser.unary()?)));
            }
            if parser.take("+") {
                return parser.unary();
            }
            parser.primary()
        })
    }

    fn primary(&mut self) -> Result<Term, String> {
        if self.take("(") {
            let inside = self.term()?;
            self.expect(")")?;
            return Ok(inside);
        }
        let lexeme = self.lexemes.get(self.at).cloned().ok_or("it ends too early")?;
        self.at += 1;
        match lexeme {
            Lexeme::Number(number) => Ok(Term::Number(number)),
            Lexeme::Name(name) if self.take("(") => {
                let mut arguments = Vec::new();
                while !self.take(")") {
                    arguments.push(self.term()?);
                    if !self.take(",") {
                        self.expect(")")?;
                        break;
                    }
                }
                Ok(Term::Call(name, arguments))
            }
            Lexeme::Name(name) => Ok(Term::Name(name)),
            Lexeme::Sign(sign) => Err(format!("`{sign}` stands where a number should")),
        }
    }
}
