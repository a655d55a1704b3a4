//! Expression nodes: their text is translated, not executed, and evaluated at each frame.

use std::collections::BTreeMap;

use super::syntax::{self, Step, Term};

/// A translated expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Script {
    steps: Vec<Step>,
}

/// The values that an evaluation needs.
struct Scope<'a> {
    /// The values of names that are not variables.
    named: &'a dyn Fn(&str) -> Option<f64>,
    variables: BTreeMap<String, f64>,
}

impl Script {
    /// Translates a text.
    ///
    /// # Errors
    /// The part that is not supported: commands, vectors, strings, loops, random numbers.
    pub fn parse(text: &str) -> Result<Self, String> {
        let steps = syntax::parse(text)?;
        steps.iter().try_for_each(check_step)?;
        Ok(Self { steps })
    }

    /// Whether it uses noise, whose numbers are not Maya's.
    pub fn uses_noise(&self) -> bool {
        fn of(term: &Term) -> bool {
            match term {
                Term::Call(name, arguments) => name == "noise" || arguments.iter().any(of),
                Term::Two(_, a, b) => of(a) || of(b),
                Term::Minus(a) | Term::Not(a) => of(a),
                Term::Choose(all) => all.iter().any(of),
                Term::Number(_) | Term::Name(_) => false,
            }
        }
        fn step(one: &Step) -> bool {
            match one {
                Step::Let(_, term) => of(term),
                Step::If(condition, yes, no) => of(condition) || yes.iter().chain(no).any(step),
            }
        }
        self.steps.iter().any(step)
    }

    /// The value of an output; `named` gives the values of attributes, `time` and `frame`.
    ///
    /// # Errors
    /// When the expression does not set it, or reads something that has no value.
    pub fn output(&self, index: u32, named: &dyn Fn(&str) -> Option<f64>) -> Result<f64, String> {
        let mut scope = Scope { named, variables: BTreeMap::new() };
        scope.run(&self.steps)?;
        let name = format!(".O[{index}]");
        scope.variables.get(&name).copied().ok_or_else(|| format!("it does not set output {index}"))
    }
}

/// Refuses functions that are not known.
fn check_step(step: &Step) -> Result<(), String> {
    match step {
        Step::Let(_, term) => check(term),
        Step::If(condition, yes, no) => {
            check(condition)?;
            yes.iter().chain(no).try_for_each(check_step)
        }
    }
}

fn check(term: &Term) -> Result<(), String> {
    match term {
        Term::Call(name, arguments) => {
            arguments.iter().try_for_each(check)?;
            let zeros = vec![0.5; arguments.len()];
            call(name, &zeros).map(|_| ())
        }
        Term::Two(_, a, b) => check(a).and_then(|()| check(b)),
        Term::Minus(a) | Term::Not(a) => check(a),
        Term::Choose(all) => all.iter().try_for_each(check),
        Term::Number(_) | Term::Name(_) => Ok(()),
    }
}

impl Scope<'_> {
    fn run(&mut self, steps: &[Step]) -> Result<(), String> {
        for step in steps {
            match step {
                Step::Let(name, term) => {
                    let value = self.value(term)?;
                    self.variables.insert(name.clone(), value);
                }
                Step::If(condition, yes, no) => {
                    let taken = if self.value(condition)? != 0.0 { yes } else { no };
                    self.run(taken)?;
                }
            }
        }
        Ok(())
    }

    fn value(&self, term: &Term) -> Result<f64, String> {
        Ok(match term {
            Term::Number(number) => *number,
            Term::Name(name) => self.named(name)?,
            Term::Minus(a) => -self.value(a)?,
            Term::Not(a) => truth(self.value(a)? == 0.0),
            Term::Choose(all) => {
                let [condition, yes, no] = &**all;
                self.value(if self.value(condition)? != 0.0 { yes } else { no })?
            }
            Term::Two(..) => {
                // Without recursion along a sum: each node of a chain of expressions may have a long one.
                let (mut first, mut rest) = (term, Vec::new());
                while let Term::Two(sign, a, b) = first {
                    rest.push((*sign, &**b));
                    first = a;
                }
                let mut value = self.value(first)?;
                for (sign, term) in rest.into_iter().rev() {
                    value = combined(sign, value, self.value(term)?)?;
                }
                value
            }
            Term::Call(name, arguments) => {
                let values: Vec<f64> =
                    arguments.iter().map(|one| self.value(one)).collect::<Result<_, _>>()?;
                call(name, &values)?
            }
        })
    }

    fn named(&self, name: &str) -> Result<f64, String> {
        if let Some(value) = self.variables.get(name) {
            return Ok(*value);
        }
        match name {
            "true" | "on" | "yes" => Ok(1.0),
            "false" | "off" | "no" => Ok(0.0),
            _ => (self.named)(name).ok_or_else(|| format!("`{name}` has no value")),
        }
    }
}

fn combined(sign: &str, a: f64, b: f64) -> Result<f64, String> {
    Ok(match sign {
        "+" => a + b,
        "-" => a - b,
        "*" => a * b,
        "/" | "%" if b == 0.0 => return Err("it divides by zero".to_owned()),
        "/" => a / b,
        "%" => a % b,
        "<" => truth(a < b),
        "<=" => truth(a <= b),
        ">" => truth(a > b),
        ">=" => truth(a >= b),
        "==" => truth(a == b),
        "!=" => truth(a != b),
        "&&" => truth(a != 0.0 && b != 0.0),
        _ => truth(a != 0.0 || b != 0.0),
    })
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// The functions of MEL that depend on nothing but their arguments.
fn call(name: &str, x: &[f64]) -> Result<f64, String> {
    const TURN: f64 = 180.0 / std::f64::consts::PI;
    Ok(match (name, x) {
        ("sin", &[x]) => libm::sin(x),
        ("cos", &[x]) => libm::cos(x),
        ("tan", &[x]) => libm::tan(x),
        ("asin", &[x]) => libm::asin(x.clamp(-1.0, 1.0)),
        ("acos", &[x]) => libm::acos(x.clamp(-1.0, 1.0)),
        ("atan", &[x]) => libm::atan(x),
        ("atan2", &[y, x]) => libm::atan2(y, x),
        ("sind", &[x]) => libm::sin(x / TURN),
        ("cosd", &[x]) => libm::cos(x / TURN),
        ("sqrt", &[x]) => x.max(0.0).sqrt(),
        ("pow", &[x, y]) => libm::pow(x, y),
        ("exp", &[x]) => libm::exp(x),
        ("log", &[x]) => libm::log(x),
        ("log10", &[x]) => libm::log10(x),
        ("abs" | "fabs", &[x]) => x.abs(),
        ("floor", &[x]) => x.floor(),
        ("ceil", &[x]) => x.ceil(),
        ("trunc" | "int", &[x]) => x.trunc(),
        ("float", &[x]) => x,
        ("sign", &[x]) => {
            if x > 0.0 {
                1.0
            } else {
                -truth(x < 0.0)
            }
        }
        ("min", &[a, b]) => a.min(b),
        ("max", &[a, b]) => a.max(b),
        ("fmod", &[a, b]) if b != 0.0 => a % b,
        ("clamp", &[low, high, x]) => x.max(low).min(high),
        ("linstep", &[a, b, x]) => step(a, b, x),
        ("smoothstep", &[a, b, x]) => {
            let s = step(a, b, x);
            s * s * (3.0 - 2.0 * s)
        }
        ("deg_to_rad", &[x]) => x / TURN,
        ("rad_to_deg", &[x]) => x * TURN,
        ("noise", &[x]) => noise(x),
        ("rand" | "gauss" | "sphrand" | "seed", _) => {
            return Err(format!("`{name}` gives other numbers in every session of Maya"));
        }
        _ => return Err(format!("the function `{name}` is not read")),
    })
}

fn step(a: f64, b: f64, x: f64) -> f64 {
    if b > a { ((x - a) / (b - a)).clamp(0.0, 1.0) } else { truth(x >= b) }
}

/// Gradient noise in one dimension, from -1 to 1 and 0 at whole numbers (Perlin 2002). Maya's own table of gradients is
/// not public, so the numbers differ from Maya's; period and size are the same.
fn noise(x: f64) -> f64 {
    let cell = x.floor();
    let s = x - cell;
    let gradient = |cell: f64| {
        let mut hash = (cell as i64 as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        hash ^= hash >> 29;
        hash = hash.wrapping_mul(0xBF58_476D_1CE4_E5B9);
        hash ^= hash >> 32;
        (hash >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let fade = s * s * s * (s * (s * 6.0 - 15.0) + 10.0);
    let (a, b) = (gradient(cell) * s, gradient(cell + 1.0) * (s - 1.0));
    2.0 * (a + fade * (b - a))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::animation::Evaluator;
    use crate::ascii::SourceText;
    use crate::scene::MayaScene;

    fn output(text: &str, frame: f64) -> Result<f64, String> {
        let head = "//Maya ASCII 2016 scene\ncurrentUnit -l centimeter -a degree -t film;createNode expression -n \"e\";\
                    createNode transform -n \"ball\"; setAttr \".t\" -type \"double3\" 1 2 3;";
        let source = SourceText::from_bytes(Path::new("a.ma"), head.as_bytes().to_vec()).unwrap();
        let scene = MayaScene::of_text(source).unwrap();
        let evaluator = Evaluator::new(&scene);
        let node = scene.find("e").unwrap();
        Script::parse(text)?.output(0, &|name| evaluator.named(node, name, frame))
    }

    #[test]
    fn common_expressions_are_translated() {
        for (text, value) in [
            (".O[0] = frame", 12.0),
            (".O[0] = time * 2;", 1.0),
            (".O[0]=sin(0)+cos(0)*3;", 3.0),
            ("float $a = 2; $a += 1; .O[0] = $a * -2 + 1;", -5.0),
            ("if (frame > 10) { .O[0] = 1; } else .O[0] = 2;", 1.0),
            ("if (frame < 10) .O[0] = 1; else if (frame < 20) .O[0] = 5; else .O[0] = 7;", 5.0),
            (".O[0] = frame > 20 ? 1 : frame == 12 ? 4 : 9;", 4.0),
            (".O[0] = clamp(0, 1, .5e1) + smoothstep(0, 24, frame) + 7 % 4;", 4.5),
            ("// a comment\n.O[0] = max(1, 2) /* two */ - abs(-1);", 1.0),
            (".O[0] = !0 && (1 || 0);", 1.0),
            (".O[0] = noise(3);", 0.0),
        ] {
            assert_eq!(output(text, 12.0), Ok(value), "{text}");
        }
    }

    #[test]
    fn commands_of_maya_are_refused_by_name() {
        for (text, word) in [
            ("move 1 2 3 ball;", "`move` is a command"),
            (".O[0] = rand(1);", "`rand` gives other numbers"),
            (".O[0] = getAttr(1);", "`getAttr`"),
            (".O[0] = 1 +;", "`;` stands where"),
            (".O[0] = (1;", "`)` is missing"),
            ("if (1) { .O[0] = 1;", "`}` is missing"),
            (".O[0] = \"a\";", "is not read"),
            (".O[0] = 1 / (frame - 12);", "divides by zero"),
            (".O[0] = other.tx;", "`other.tx` has no value"),
        ] {
            let error = output(text, 12.0).unwrap_err();
            assert!(error.contains(word), "{text}: {error}");
        }
        assert!(output(&format!(".O[0] = {}1;", "(".repeat(9000)), 1.0).is_err());
        assert!(output(&format!(".O[0] = {}1;", "-".repeat(9000)), 1.0).is_err());
        assert!(output(&format!(".O[0] = 1{};", "+1".repeat(9000)), 1.0).is_err());
        let nested = (0..45).fold("1".to_owned(), |inner, _| format!("({inner}{})", "+1".repeat(900)));
        assert!(output(&format!(".O[0] = {nested};"), 1.0).unwrap_err().contains("too long"));
    }

    #[test]
    fn noise_is_smooth_bounded_and_zero_at_whole_numbers() {
        let mut last = noise(-20.0);
        for k in -20_000..20_000 {
            let x = f64::from(k) * 1e-3;
            let value = noise(x);
            assert!(value.abs() <= 1.0 && (value - last).abs() < 0.02, "{x}: {value}");
            last = value;
        }
        assert_eq!(noise(7.0), 0.0);
    }
}
