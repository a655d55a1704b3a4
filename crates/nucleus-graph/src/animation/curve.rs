//! A value that changes from key to key.

/// How the curve leaves a key, and how it arrives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tangent {
    /// The value stays until the next key.
    Stepped,
    /// Straight from key to key.
    Linear,
    /// Smooth: at a key the curve is parallel to the line through its two neighbours, at the ends it is flat.
    Spline,
    /// Level at the key.
    Flat,
    /// Smooth like a spline, but never beyond its keys: level where the keys turn back, and at the ends.
    Auto,
}

/// How a curve goes on before its first and after its last key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Infinity {
    /// It stays.
    #[default]
    Constant,
    /// It goes straight on as it leaves its end.
    Linear,
    /// It begins anew.
    Cycle,
    /// It begins anew from where it has come to.
    CycleOffset,
    /// It runs back and forth.
    Oscillate,
}

impl Tangent {
    /// All of them, as scenes write them.
    pub const WORDS: [(&'static str, Self); 5] = [
        ("stepped", Self::Stepped),
        ("linear", Self::Linear),
        ("spline", Self::Spline),
        ("flat", Self::Flat),
        ("auto", Self::Auto),
    ];
}

impl Infinity {
    /// All of them, as scenes write them.
    pub const WORDS: [(&'static str, Self); 5] = [
        ("constant", Self::Constant),
        ("linear", Self::Linear),
        ("cycle", Self::Cycle),
        ("cycleOffset", Self::CycleOffset),
        ("oscillate", Self::Oscillate),
    ];
}

/// A value at a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// When; frames may be broken.
    pub frame: f64,
    /// The value then.
    pub value: f64,
    /// How the curve runs through it. From a stepped key on nothing else counts; a linear key makes its end
    /// of the way to a spline key straight.
    pub tangent: Tangent,
}

/// Why keys are not a curve.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// There are none.
    #[error("a curve needs at least one key")]
    NoKeys,
    /// A frame or value is NaN or infinite, or so large that the curve between keys would be.
    #[error("the key at frame {frame} is not finite: its value is {value}")]
    NotFinite {
        /// Its frame.
        frame: f64,
        /// Its value.
        value: f64,
    },
    /// A key comes earlier than the one before it in the list.
    #[error("the keys are not in order: frame {frame} comes after frame {previous}")]
    OutOfOrder {
        /// Its frame.
        frame: f64,
        /// The frame before it in the list.
        previous: f64,
    },
    /// Two keys are at the same frame.
    #[error("there are two keys at frame {frame}")]
    Repeated {
        /// Their frame.
        frame: f64,
    },
}

/// Values are kept within this, so that differences of two never overflow.
const LARGEST: f64 = f64::MAX / 16.0;

/// Keys in order of time, and how it goes on on both sides of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    keys: Vec<Key>,
    before: Infinity,
    after: Infinity,
}

impl Curve {
    /// A curve through `keys`.
    ///
    /// # Errors
    /// When there are none, when they are not in strict order of time, or when one is not finite.
    pub fn new(keys: Vec<Key>) -> Result<Self, CurveError> {
        if keys.is_empty() {
            return Err(CurveError::NoKeys);
        }
        for &Key { frame, value, .. } in &keys {
            // Beyond this, differences of two could overflow.
            if !(frame.abs() < f64::MAX / 4.0 && value.abs() < LARGEST) {
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

    /// The same curve, going on in these ways before its first and after its last key.
    pub fn going_on(self, before: Infinity, after: Infinity) -> Self {
        Self { before, after, ..self }
    }

    /// How it goes on before its first and after its last key.
    pub fn infinities(&self) -> [Infinity; 2] {
        [self.before, self.after]
    }

    /// A curve that always has the same value.
    ///
    /// # Errors
    /// When it is not finite.
    pub fn constant(value: f64) -> Result<Self, CurveError> {
        Self::new(vec![Key { frame: 0.0, value, tangent: Tangent::Linear }])
    }

    /// The keys, in order of time.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// The value at a frame.
    pub fn value_at(&self, frame: f64) -> f64 {
        let (first, last) = (self.keys[0], self.keys[self.keys.len() - 1]);
        if frame < first.frame {
            self.outside(frame, first, self.before)
        } else if frame > last.frame {
            self.outside(frame, last, self.after)
        } else {
            self.inside(frame)
        }
    }

    /// The value between the first and the last key.
    fn inside(&self, frame: f64) -> f64 {
        match self.keys.partition_point(|key| key.frame <= frame) {
            0 => self.keys[0].value,
            after if after == self.keys.len() => self.keys[after - 1].value,
            after => self.stretch(after - 1).value_at(frame),
        }
    }

    /// The value beyond the key at one end.
    fn outside(&self, frame: f64, end: Key, infinity: Infinity) -> f64 {
        let (first, last) = (self.keys[0], self.keys[self.keys.len() - 1]);
        let span = last.frame - first.frame;
        if span == 0.0 {
            return end.value;
        }
        let rounds = ((frame - first.frame) / span).floor();
        // The rest of a division is exact, the product of a count is not.
        let rest = first.frame + (frame - first.frame).rem_euclid(span);
        let value = match infinity {
            Infinity::Constant => end.value,
            Infinity::Linear => end.value + (frame - end.frame) * self.end_slope(end.frame == first.frame),
            Infinity::Cycle => self.inside(rest),
            Infinity::CycleOffset => self.inside(rest) + rounds * (last.value - first.value),
            Infinity::Oscillate if rounds % 2.0 == 0.0 => self.inside(rest),
            Infinity::Oscillate => self.inside(last.frame - (rest - first.frame)),
        };
        value.clamp(-LARGEST, LARGEST)
    }

    /// The slope with which the curve leaves one of its ends, per frame.
    fn end_slope(&self, at_first: bool) -> f64 {
        let stretch = self.stretch(if at_first { 0 } else { self.keys.len() - 2 });
        let frames = stretch.to.frame - stretch.from.frame;
        match stretch.shape {
            Shape::Held => 0.0,
            Shape::Straight => (stretch.to.value - stretch.from.value) / frames,
            Shape::Cubic { leaving, arriving } => (if at_first { leaving } else { arriving }) / frames,
        }
    }

    /// Whether it never changes.
    pub fn is_constant(&self) -> bool {
        self.keys.iter().all(|key| key.value == self.keys[0].value)
    }

    /// Values that the curve never goes below and never above. Between spline keys the true extremes may
    /// lie a little further in.
    pub fn range(&self) -> (f64, f64) {
        let last = self.keys[self.keys.len() - 1].value;
        let stretches = (0..self.keys.len() - 1).map(|start| self.stretch(start).range());
        let inside = stretches.fold((last, last), |all, one| (all.0.min(one.0), all.1.max(one.1)));
        if self.leaves_its_keys() { (-LARGEST, LARGEST) } else { inside }
    }

    /// A number that the size of no value exceeds. Zero only if the curve is never anything else.
    pub fn max_abs(&self) -> f64 {
        let (low, high) = self.range();
        high.max(-low)
    }

    /// Whether it goes on and on beyond the values of its keys.
    fn leaves_its_keys(&self) -> bool {
        let last = self.keys.len() - 1;
        let rises = |infinity, at_first| match infinity {
            Infinity::Linear => self.end_slope(at_first) != 0.0,
            Infinity::CycleOffset => self.keys[last].value != self.keys[0].value,
            _ => false,
        };
        last > 0 && (rises(self.before, true) || rises(self.after, false))
    }

    /// The way from one key to the next.
    fn stretch(&self, start: usize) -> Stretch {
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
        Stretch { from, to, shape }
    }

    /// The slope at a key that has a smooth tangent, per frame.
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
        // Up to three times the slope of the way on either side, a cubic does not swing beyond its keys
        // (Fritsch and Carlson 1980).
        let most = 3.0 * coming.abs().min(going.abs());
        through.clamp(-most, most)
    }
}

/// The part of a curve between two keys.
struct Stretch {
    from: Key,
    to: Key,
    shape: Shape,
}

enum Shape {
    Held,
    Straight,
    /// Hermite's cubic, with what the value would change by over the whole stretch at either end's slope.
    Cubic {
        leaving: f64,
        arriving: f64,
    },
}

impl Stretch {
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
        // Rounding may carry it out by a bit.
        let (low, high) = self.range();
        value.clamp(low, high)
    }

    /// A cubic stays among its four Bézier points.
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
