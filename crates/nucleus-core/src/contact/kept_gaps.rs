//! Gaps to colliders that points keep from a start inside the contact thickness (Classic): the column. How it is filled and
//! emptied is in `collider/start_gaps.rs`.

use crate::bytes::encode_struct;
use crate::math::Real;

/// The gaps that points keep, by the rows of the solver; nothing where every point keeps its thickness.
#[derive(Debug, Clone, Default)]
pub struct KeptGaps<R> {
    /// In metres; the largest number for a point that keeps its thickness. Empty where all do.
    pub gaps: Vec<R>,
    /// The smallest gap of each point at the start of a step, in metres; scratch.
    pub lowest: Vec<R>,
    /// Whether the start has been looked at.
    pub has_begun: bool,
}

encode_struct!([R: Real] KeptGaps<R> { gaps: Vec<R>, lowest: Vec<R>, has_begun: bool });

impl<R: Real> KeptGaps<R> {
    /// Whether no point keeps a gap below its thickness.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.gaps.is_empty()
    }

    /// The gap that a contact keeps, `thickness` at most, in metres.
    #[inline(always)]
    pub fn at<const N: usize>(&self, points: [u32; N], weights: [R; N], thickness: R) -> R {
        if self.gaps.is_empty() {
            return thickness;
        }
        (0..N).map(|k| weights[k] * least(self.gaps[points[k] as usize], thickness)).sum()
    }

    /// Whether the columns fit so many rows.
    pub fn is_valid(&self, rows: usize) -> bool {
        self.gaps.len() == self.lowest.len() && (self.gaps.is_empty() || self.gaps.len() == rows)
    }

    /// Lowers the gap that a point keeps, in a solver of so many rows.
    pub fn lower(&mut self, row: u32, rows: usize, gap: f64) {
        self.gaps.resize(rows, clear());
        self.lowest.resize(rows, clear());
        let kept = &mut self.gaps[row as usize];
        *kept = least(*kept, R::from_f64(gap));
    }
}

/// The gap of a point that keeps its thickness.
pub fn clear<R: Real>() -> R {
    R::from_f64(f64::from(f32::MAX))
}

/// The smaller of two.
pub fn least<R: Real>(a: R, b: R) -> R {
    if a < b { a } else { b }
}
