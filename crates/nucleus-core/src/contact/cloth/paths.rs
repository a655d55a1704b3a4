//! Where each point is foreseen to go: along a straight line, within a ball that goes with it. As long as it
//! stays in there, the pairs that were found for it hold.
//!
//! The line follows the point's own motion, so that neighbours that move together stay as far apart as they
//! are: a sheet that falls or swings finds no pair with itself.

use crate::math::{Real, Row4, add, dot, scale, sub};
use crate::parallel::disjoint::DisjointSlice;

/// A line and a ball per point, over some span of time.
#[derive(Debug, Clone, Default)]
pub struct Paths<R> {
    /// Displacement at the start of the span, and the radius of the ball.
    pub from: Vec<Row4<R>>,
    /// Motion over the whole span.
    pub travel: Vec<Row4<R>>,
}

/// One point's line and ball.
#[derive(Debug, Clone, Copy)]
pub struct Path<R> {
    /// Displacement at the start of the span.
    pub from: [R; 3],
    /// Motion over the whole span.
    pub travel: [R; 3],
    /// Radius of the ball.
    pub ball: R,
}

impl<R: Real> Path<R> {
    /// Where the line is at a share of the span.
    #[inline(always)]
    pub fn at(&self, share: R) -> [R; 3] {
        add(self.from, scale(self.travel, share))
    }

    /// Whether a place lies within the ball.
    #[inline(always)]
    pub fn holds(&self, share: R, place: [R; 3]) -> bool {
        let away = sub(place, self.at(share));
        dot(away, away) <= self.ball * self.ball
    }
}

impl<R: Real> Paths<R> {
    /// Paths of points that are foreseen nowhere.
    pub fn new(rows: usize) -> Self {
        Self { from: vec![Row4::ZERO; rows], travel: vec![Row4::ZERO; rows] }
    }

    /// One point's.
    #[inline(always)]
    pub fn of(&self, point: u32) -> Path<R> {
        let from = self.from[point as usize];
        Path { from: from.xyz(), travel: self.travel[point as usize].xyz(), ball: from.0[3] }
    }

    /// Follows anchors into a new frame: what was foreseen for the end of the last is foreseen from now on.
    pub fn move_anchors(&mut self, moved: &[Row4<R>]) {
        for ((from, travel), moved) in self.from.iter_mut().zip(&mut self.travel).zip(moved) {
            let [x, y, z] = sub(add(from.xyz(), travel.xyz()), moved.xyz());
            *from = Row4([x, y, z, from.0[3]]);
            *travel = Row4::ZERO;
        }
    }

    /// Lends the columns to the tasks of a phase.
    pub fn shared(&mut self) -> SharedPaths<'_, R> {
        SharedPaths { from: DisjointSlice::new(&mut self.from), travel: DisjointSlice::new(&mut self.travel) }
    }
}

/// Paths, lent to the tasks of a phase.
#[derive(Clone, Copy)]
pub struct SharedPaths<'a, R> {
    from: DisjointSlice<'a, Row4<R>>,
    travel: DisjointSlice<'a, Row4<R>>,
}

#[allow(unsafe_code)]
impl<R: Real> SharedPaths<'_, R> {
    /// Reads a point's path.
    ///
    /// # Safety
    /// No other task of the phase writes it.
    #[inline(always)]
    pub unsafe fn of(&self, point: u32) -> Path<R> {
        let (from, travel) = unsafe { (self.from.get(point), self.travel.get(point)) };
        Path { from: from.xyz(), travel: travel.xyz(), ball: from.0[3] }
    }

    /// Writes a point's path.
    ///
    /// # Safety
    /// No other task of the phase touches it.
    #[inline(always)]
    pub unsafe fn set(&self, point: u32, path: Path<R>) {
        let ([a, b, c], [x, y, z]) = (path.from, path.travel);
        unsafe {
            self.from.set(point, Row4([a, b, c, path.ball]));
            self.travel.set(point, Row4([x, y, z, R::ZERO]));
        }
    }
}
