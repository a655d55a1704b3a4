//! Keyed curves as in Maya: tangents, interpolation between keys, and infinities beyond them.

/// The tangent of a curve at a key, on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangent {
    /// Constant until the next key.
    Stepped,
    /// A straight line to the next key.
    Linear,
    /// Smooth: parallel to the line through the two neighbouring keys, and flat at the first and last key.
    Spline,
    /// Slope zero.
    Flat,
    /// A spline without overshoot: flat at local extremes and at the first and last key.
    Auto,
}

/// Extrapolation before the first key and after the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Infinity {
    /// The value of the end key.
    #[default]
    Constant,
    /// A straight line with the slope of the end.
    Linear,
    /// The curve repeats.
    Cycle,
    /// The curve repeats, each time offset by the difference of its end values.
    CycleOffset,
    /// The curve repeats, alternately mirrored in time.
    Oscillate,
}

impl Tangent {
    /// All tangents with their words in scene files.
    pub const WORDS: [(&'static str, Self); 5] = [
        ("stepped", Self::Stepped),
        ("linear", Self::Linear),
        ("spline", Self::Spline),
        ("flat", Self::Flat),
        ("auto", Self::Auto),
    ];
}

impl Infinity {
    /// All infinities with their words in scene files.
    pub const WORDS: [(&'static str, Self); 5] = [
        ("constant", Self::Constant),
        ("linear", Self::Linear),
        ("cycle", Self::Cycle),
        ("cycleOffset", Self::CycleOffset),
        ("oscillate", Self::Oscillate),
    ];
}

/// A key: a value at a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// The frame; fractions are allowed.
    pub frame: f64,
    /// The value at that frame.
    pub value: f64,
    /// The tangent. A stepped key makes the whole segment after it constant. A linear key gives its end of a
    /// segment the slope of the line between the two keys.
    pub tangent: Tangent,
}

/// Reasons why keys form no curve.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// There is no key.
    #[error("a curve needs at least one key")]
    NoKeys,
    /// A frame or value is NaN, infinite, or so large that interpolation could overflow.
    #[error("the key at frame {frame} is not finite: its value is {value}")]
    NotFinite {
        /// The frame of the key.
        frame: f64,
        /// The value of the key.
        value: f64,
    },
    /// The frame of a key is before that of the previous key in the list.
    #[error("the keys are not in order: frame {frame} comes after frame {previous}")]
    OutOfOrder {
        /// The frame of the key.
        frame: f64,
        /// The frame of the previous key in the list.
        previous: f64,
    },
    /// Two keys are at the same frame.
    #[error("there are two keys at frame {frame}")]
    Repeated {
        /// The frame of both.
        frame: f64,
    },
}

/// Bound on absolute values, so that the difference of two never overflows.
const MAX_VALUE: f64 = f64::MAX / 16.0;

/// Keys in strict order of frames, and the infinities on both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    keys: Vec<Key>,
    before: Infinity,
    after: Infinity,
}

impl Curve {
    /// A curve through `keys`, with constant infinities.
    ///
    /// # Errors
    /// When there is no key, frames are not strictly increasing, or a key is not finite.
    pub fn new(keys: Vec<Key>) -> Result<Self, CurveError> {
        if keys.is_empty() {
            return Err(CurveError::NoKeys);
        }
        for &Key { frame, value, .. } in &keys {
            // Differences of larger numbers could overflow.
            if !(frame.abs() < f64::MAX / 4.0 && value.abs() < MAX_VALUE) {
                return Err(CurveError::NotFinite { frame, value });
            }
        }
        for pair in keys.windows(2) {
            let (previous, frame) = (pair[0].frame, pair[1].frame);
            if frame == previous {
                return Err(CurveError::Repeated { frame });
            }
            if frame < previous {
                return Err(CurveError::OutOfOrder { frame, previous });
            }
        }
        Ok(Self { keys, before: Infinity::Constant, after: Infinity::Constant })
    }

    /// The same curve with these infinities before its first and after its last key.
    pub fn with_infinity(self, before: Infinity, after: Infinity) -> Self {
        Self { before, after, ..self }
    }

    /// The infinities before the first and after the last key.
    pub fn infinities(&self) -> [Infinity; 2] {
        [self.before, self.after]
    }

    /// A constant curve.
    ///
    /// # Errors
    /// When the value is not finite.
    pub fn constant(value: f64) -> Result<Self, CurveError> {
        Self::new(vec![Key { frame: 0.0, value, tangent: Tangent::Linear }])
    }

    /// The keys in order of frames.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// The value at a frame.
    pub fn value_at(&self, frame: f64) -> f64 {
        let (first, last) = (self.keys[0], self.keys[self.keys.len() - 1]);
        if frame < first.frame {
            self.extrapolate(frame, first, self.before)
        } else if frame > last.frame {
            self.extrapolate(frame, last, self.after)
        } else {
            self.interpolate(frame)
        }
    }

    /// The value at a frame between the first and the last key.
    fn interpolate(&self, frame: f64) -> f64 {
        match self.keys.partition_point(|key| key.frame <= frame) {
            0 => self.keys[0].value,
            after if after == self.keys.len() => self.keys[after - 1].value,
            after => self.segment(after - 1).value_at(frame),
        }
    }

    /// The value at a frame beyond the key at one end.
    fn extrapolate(&self, frame: f64, end: Key, infinity: Infinity) -> f64 {
        let (first, last) = (self.keys[0], self.keys[self.keys.len() - 1]);
        let span = last.frame - first.frame;
        if span == 0.0 {
            return end.value;
        }
        let rounds = ((frame - first.frame) / span).floor();
        // The remainder of a division is exact, a product with a count is not.
        let rest = first.frame + (frame - first.frame).rem_euclid(span);
        let value = match infinity {
            Infinity::Constant => end.value,
            Infinity::Linear => end.value + (frame - end.frame) * self.end_slope(end.frame == first.frame),
            Infinity::Cycle => self.interpolate(rest),
            Infinity::CycleOffset => self.interpolate(rest) + rounds * (last.value - first.value),
            Infinity::Oscillate if rounds % 2.0 == 0.0 => self.interpolate(rest),
            Infinity::Oscillate => self.interpolate(last.frame - (rest - first.frame)),
        };
        value.clamp(-MAX_VALUE, MAX_VALUE)
    }

    /// The slope of the first or last segment at its outer end, per frame.
    fn end_slope(&self, at_first: bool) -> f64 {
        let segment = self.segment(if at_first { 0 } else { self.keys.len() - 2 });
        let frames = segment.to.frame - segment.from.frame;
        match segment.shape {
            Shape::Held => 0.0,
            Shape::Straight => (segment.to.value - segment.from.value) / frames,
            Shape::Cubic { leaving, arriving } => (if at_first { leaving } else { arriving }) / frames,
        }
    }

    /// Whether all keys have the same value.
    pub fn is_constant(&self) -> bool {
        self.keys.iter().all(|key| key.value == self.keys[0].value)
    }

    /// A lower and an upper bound of all values. Between spline keys they may lie outside the true extremes.
    pub fn range(&self) -> (f64, f64) {
        let last = self.keys[self.keys.len() - 1].value;
        let segments = (0..self.keys.len() - 1).map(|start| self.segment(start).range());
        let inside = segments.fold((last, last), |all, one| (all.0.min(one.0), all.1.max(one.1)));
        if self.is_unbounded() { (-MAX_VALUE, MAX_VALUE) } else { inside }
    }

    /// An upper bound of all absolute values. Zero only if the curve is zero everywhere.
    pub fn max_abs(&self) -> f64 {
        let (low, high) = self.range();
        high.max(-low)
    }

    /// Whether an infinity leads to values without bound.
    fn is_unbounded(&self) -> bool {
        let last = self.keys.len() - 1;
        let rises = |infinity, at_first| match infinity {
            Infinity::Linear => self.end_slope(at_first) != 0.0,
            Infinity::CycleOffset => self.keys[last].value != self.keys[0].value,
            _ => false,
        };
        last > 0 && (rises(self.before, true) || rises(self.after, false))
    }

    /// The segment from key `start` to the next.
    fn segment(&self, start: usize) -> Segment {
        let (from, to) = (self.keys[start], self.keys[start + 1]);
        let rise = to.value - from.value;
        let along = |key: usize| match self.keys[key].tangent {
            Tangent::Spline | Tangent::Flat | Tangent::Auto => self.slope(key) * (to.frame - from.frame),
            Tangent::Linear | Tangent::Stepped => rise,
        };
        let shape = match (from.tangent, to.tangent) {
            (Tangent::Stepped, _) => Shape::Held,
            (Tangent::Linear, Tangent::Linear | Tangent::Stepped) => Shape::Straight,
            _ => Shape::Cubic { leaving: along(start), arriving: along(start + 1) },
        };
        Segment { from, to, shape }
    }

    /// The slope at a key with a smooth tangent, per frame.
    fn slope(&self, key: usize) -> f64 {
        if key == 0 || key + 1 == self.keys.len() || self.keys[key].tangent == Tangent::Flat {
            return 0.0;
        }
        let (before, at, after) = (self.keys[key - 1], self.keys[key], self.keys[key + 1]);
        let through = (after.value - before.value) / (after.frame - before.frame);
        if self.keys[key].tangent == Tangent::Spline {
            return through;
        }
        let coming = (at.value - before.value) / (at.frame - before.frame);
        let going = (after.value - at.value) / (after.frame - at.frame);
        if coming * going <= 0.0 {
            return 0.0;
        }
        // A cubic is monotone between its keys if its end slopes are at most three times the slope of the
        // segment (Fritsch and Carlson 1980).
        let limit = 3.0 * coming.abs().min(going.abs());
        through.clamp(-limit, limit)
    }
}

/// The part of a curve between two keys.
struct Segment {
    from: Key,
    to: Key,
    shape: Shape,
}

enum Shape {
    Held,
    Straight,
    /// A Hermite cubic. Slopes at its ends are per length of the segment.
    Cubic {
        leaving: f64,
        arriving: f64,
    },
}

impl Segment {
    fn value_at(&self, frame: f64) -> f64 {
        let (a, b) = (self.from.value, self.to.value);
        let s = (frame - self.from.frame) / (self.to.frame - self.from.frame);
        let value = match self.shape {
            Shape::Held => a,
            Shape::Straight => a * (1.0 - s) + b * s,
            Shape::Cubic { leaving, arriving } => {
                let rest = 1.0 - s;
                a + (b - a) * (s * s * (3.0 - 2.0 * s)) + s * rest * (leaving * rest - arriving * s)
            }
        };
        // Rounding may exceed the range by one bit.
        let (low, high) = self.range();
        value.clamp(low, high)
    }

    /// A cubic stays in the range of its four Bézier points.
    fn range(&self) -> (f64, f64) {
        let (a, b) = (self.from.value, self.to.value);
        match self.shape {
            Shape::Held => (a, a),
            Shape::Straight => (a.min(b), a.max(b)),
            Shape::Cubic { leaving, arriving } => {
                let (c, d) = (a + leaving / 3.0, b - arriving / 3.0);
                (a.min(b).min(c).min(d), a.max(b).max(c).max(d))
            }
        }
    }
}

#[cfg(test)]
mod tests;
