//! Operations of an expression: variables, constants and functions.

/// A variable of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// `x`, `y` or `z`: a coordinate of the position.
    Position(usize),
    /// `u` or `v`: a texture coordinate.
    Uv(usize),
    /// `i`: the number of the point.
    Index,
    /// `n`: the number of points.
    Count,
    /// A variable of statements, by its place among their names.
    Own(usize),
}

/// The values of the variables at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Position in the space of the mesh, in scene units.
    pub position: [f64; 3],
    /// Texture coordinates.
    pub uv: [f64; 2],
    /// Number of the point, from 0.
    pub index: usize,
    /// Number of points.
    pub count: usize,
}

impl Point {
    pub(super) fn value(&self, variable: Variable) -> f64 {
        match variable {
            Variable::Position(axis) => self.position[axis],
            Variable::Uv(part) => self.uv[part],
            Variable::Index => self.index as f64,
            Variable::Count => self.count as f64,
            Variable::Own(_) => f64::NAN,
        }
    }
}

/// One operation on the stack of the evaluation.
#[derive(Debug, Clone, Copy)]
pub(super) enum Op {
    Number(f64),
    Variable(Variable),
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

/// A function by its number of arguments.
#[derive(Debug, Clone, Copy)]
pub(super) enum Call {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

impl Call {
    /// The number of arguments.
    pub(super) fn arguments(self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Three(_) => 3,
        }
    }

    pub(super) fn op(self) -> Op {
        match self {
            Self::One(f) => Op::One(f),
            Self::Two(f) => Op::Two(f),
            Self::Three(f) => Op::Three(f),
        }
    }
}

/// All functions: name, code, signature and meaning.
pub(super) const FUNCTIONS: [(&str, Call, &str, &str); 22] = [
    ("abs", Call::One(f64::abs), "abs(a)", "a without its sign"),
    ("sqrt", Call::One(f64::sqrt), "sqrt(a)", "square root"),
    ("exp", Call::One(f64::exp), "exp(a)", "e to the power of a"),
    ("log", Call::One(f64::ln), "log(a)", "natural logarithm"),
    ("sin", Call::One(f64::sin), "sin(a)", "sine of an angle in radians"),
    ("cos", Call::One(f64::cos), "cos(a)", "cosine of an angle in radians"),
    ("tan", Call::One(f64::tan), "tan(a)", "tangent of an angle in radians"),
    ("asin", Call::One(f64::asin), "asin(a)", "angle in radians whose sine is a"),
    ("acos", Call::One(f64::acos), "acos(a)", "angle in radians whose cosine is a"),
    ("atan", Call::One(f64::atan), "atan(a)", "angle in radians whose tangent is a"),
    ("floor", Call::One(f64::floor), "floor(a)", "largest whole number that is not above a"),
    ("ceil", Call::One(f64::ceil), "ceil(a)", "smallest whole number that is not below a"),
    ("round", Call::One(f64::round), "round(a)", "nearest whole number; halves go away from zero"),
    ("sign", Call::One(sign), "sign(a)", "-1, 0 or 1"),
    ("min", Call::Two(f64::min), "min(a, b)", "the smaller of two"),
    ("max", Call::Two(f64::max), "max(a, b)", "the larger of two"),
    ("pow", Call::Two(f64::powf), "pow(a, b)", "a to the power of b, like `a ^ b`"),
    ("atan2", Call::Two(f64::atan2), "atan2(a, b)", "angle in radians of the direction (b, a)"),
    ("step", Call::Two(step), "step(edge, a)", "1 for a at or above the edge, else 0"),
    ("clamp", Call::Three(clamp), "clamp(a, low, high)", "a, but not below low or above high"),
    (
        "smoothstep",
        Call::Three(smoothstep),
        "smoothstep(from, to, a)",
        "rises smoothly from 0 to 1 as a goes from `from` to `to`",
    ),
    ("mix", Call::Three(mix), "mix(a, b, t)", "a for t = 0, b for t = 1, linear between"),
];

/// Variables and constants: name, value and meaning.
pub(super) const NAMES: [(&str, Op, &str); 8] = [
    (
        "x",
        Op::Variable(Variable::Position(0)),
        "position in the space of the mesh at the start, in scene units",
    ),
    ("y", Op::Variable(Variable::Position(1)), "the same along y"),
    ("z", Op::Variable(Variable::Position(2)), "the same along z"),
    ("u", Op::Variable(Variable::Uv(0)), "texture coordinate"),
    ("v", Op::Variable(Variable::Uv(1)), "the other texture coordinate"),
    ("i", Op::Variable(Variable::Index), "number of the point, from 0"),
    ("n", Op::Variable(Variable::Count), "number of points"),
    ("pi", Op::Number(std::f64::consts::PI), "3.14159..."),
];

fn sign(x: f64) -> f64 {
    if x == 0.0 || x.is_nan() { x } else { x.signum() }
}

fn step(edge: f64, x: f64) -> f64 {
    f64::from(u8::from(x >= edge))
}

/// Unlike `f64::clamp`, it accepts a lower limit above the upper one; the upper one then has precedence.
fn clamp(x: f64, min: f64, max: f64) -> f64 {
    x.max(min).min(max)
}

fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    if from == to {
        return step(from, x);
    }
    let t = clamp((x - from) / (to - from), 0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}
