//! Meshes that pass through each other: found, let go, and worked apart.

/// The points of elements that pass through each other.
#[derive(Debug, Clone, Default)]
pub struct Tangle {
    /// Whether a point is a corner of such an element.
    pub points: Vec<bool>,
    /// Whether there is any.
    pub any: bool,
}

impl Tangle {
    /// None yet.
    pub fn new(rows: usize) -> Self {
        Self { points: vec![false; rows], any: false }
    }

    /// Whether a pair is let alone, because both of its elements belong to a tangle.
    #[inline(always)]
    pub fn lets_pass(&self, [a, b, c, d]: [u32; 4]) -> bool {
        let is_in = |point: u32| self.points[point as usize];
        self.any && is_in(a) && is_in(b) && is_in(c) && is_in(d)
    }
}
