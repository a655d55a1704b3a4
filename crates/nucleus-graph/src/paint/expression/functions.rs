//! What an expression can call, and the names it knows.

use super::{Op, Variable};

/// What a function does with its arguments.
#[derive(Debug, Clone, Copy)]
pub(super) enum Call {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
}

impl Call {
    /// How many arguments it takes.
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

/// Angles are in radians. `step(edge, x)` is 1 from the edge on; `smoothstep(from, to, x)` rises smoothly from 0 to
/// 1; `mix(a, b, t)` goes straight from a to b.
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

/// Names that stand for a number.
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

/// Unlike `f64::clamp` it takes limits that cross: the upper one counts.
fn clamp(x: f64, least: f64, most: f64) -> f64 {
    x.max(least).min(most)
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
