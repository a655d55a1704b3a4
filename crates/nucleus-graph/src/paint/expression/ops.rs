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

/// All functions. Angles are in radians. `step(edge, x)` is 1 for `x >= edge`, else 0. `smoothstep(from, to, x)` rises
/// smoothly from 0 to 1. `mix(a, b, t)` interpolates linearly from a to b.
pub(super) const FUNCTIONS: [(&str, Call); 22] = [
    ("abs", Call::One(f64::abs)),
    ("sqrt", Call::One(f64::sqrt)),
    ("exp", Call::One(f64::exp)),
    ("log", Call::One(f64::ln)),
    ("sin", Call::One(f64::sin)),
    ("cos", Call::One(f64::cos)),
    ("tan", Call::One(f64::tan)),
    ("asin", Call::One(f64::asin)),
    ("acos", Call::One(f64::acos)),
    ("atan", Call::One(f64::atan)),
    ("floor", Call::One(f64::floor)),
    ("ceil", Call::One(f64::ceil)),
    ("round", Call::One(f64::round)),
    ("sign", Call::One(sign)),
    ("min", Call::Two(f64::min)),
    ("max", Call::Two(f64::max)),
    ("pow", Call::Two(f64::powf)),
    ("atan2", Call::Two(f64::atan2)),
    ("step", Call::Two(step)),
    ("clamp", Call::Three(clamp)),
    ("smoothstep", Call::Three(smoothstep)),
    ("mix", Call::Three(mix)),
];

/// Variables and constants by name.
pub(super) const NAMES: [(&str, Op); 8] = [
    ("x", Op::Variable(Variable::Position(0))),
    ("y", Op::Variable(Variable::Position(1))),
    ("z", Op::Variable(Variable::Position(2))),
    ("u", Op::Variable(Variable::Uv(0))),
    ("v", Op::Variable(Variable::Uv(1))),
    ("i", Op::Variable(Variable::Index)),
    ("n", Op::Variable(Variable::Count)),
    ("pi", Op::Number(std::f64::consts::PI)),
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
