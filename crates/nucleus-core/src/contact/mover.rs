//! What contacts move: places, and how far they were led out of a thickness.

use crate::math::{Real, Row4, add};
use crate::parallel::disjoint::DisjointSlice;

/// The columns that contacts write.
#[derive(Clone, Copy)]
pub struct Mover<'a, R> {
    displacement: DisjointSlice<'a, Row4<R>>,
    led: DisjointSlice<'a, Row4<R>>,
    parted: DisjointSlice<'a, Row4<R>>,
    predicted: &'a [Row4<R>],
}

#[allow(unsafe_code)]
impl<'a, R: Real> Mover<'a, R> {
    /// Lends three columns of a state: displacement with inverse mass, and how far colliders and cloth led it; and shows
    /// where it would be had nothing held it.
    pub fn new(columns: [&'a mut Vec<Row4<R>>; 3], predicted: &'a [Row4<R>]) -> Self {
        let [displacement, led, parted] = columns.map(|column| DisjointSlice::new(column));
        Self { displacement, led, parted, predicted }
    }

    /// Where a point would be had nothing held it, but for what led it.
    #[inline(always)]
    pub fn predicted(&self, point: u32) -> [R; 3] {
        // SAFETY: as below.
        let parted = unsafe { self.parted.get(point) }.xyz();
        add(self.predicted[point as usize].xyz(), add(self.led(point), parted))
    }

    /// A point's displacement, and its inverse mass.
    #[inline(always)]
    pub fn row(&self, point: u32) -> Row4<R> {
        // SAFETY: a phase hands every task points of its own.
        unsafe { self.displacement.get(point) }
    }

    /// How far colliders led a point in this step: a motion without velocity.
    #[inline(always)]
    pub fn led(&self, point: u32) -> [R; 3] {
        // SAFETY: as above.
        unsafe { self.led.get(point) }.xyz()
    }

    /// Moves a point off a collider; `led` is the part of it that is not to become velocity.
    #[inline(always)]
    pub fn push(&self, point: u32, row: Row4<R>, led: [R; 3]) {
        let [x, y, z] = add(self.led(point), led);
        // SAFETY: as above.
        unsafe {
            self.displacement.set(point, row);
            self.led.set(point, Row4([x, y, z, R::ZERO]));
        }
    }

    /// Moves a point off something that is moved too; `led` is the part of it that is not to become velocity, but does if a
    /// collider takes it back: what is between the two has to bear the load.
    #[inline(always)]
    pub fn part(&self, point: u32, row: Row4<R>, led: [R; 3]) {
        // SAFETY: as above.
        unsafe {
            let mut parted = self.parted.get(point);
            (0..3).for_each(|axis| parted.0[axis] += led[axis]);
            self.displacement.set(point, row);
            self.parted.set(point, parted);
        }
    }

    /// Puts a point somewhere, and forgets that it was led.
    #[inline(always)]
    pub fn put(&self, point: u32, row: Row4<R>) {
        // SAFETY: as above.
        unsafe {
            self.displacement.set(point, row);
            self.led.set(point, Row4::ZERO);
            self.parted.set(point, Row4::ZERO);
        }
    }
}
