//! Columns that several tasks write at once, each its own rows.

#![allow(unsafe_code)]

use std::marker::PhantomData;

/// A column lent to the tasks of a phase.
///
/// A phase is laid out so that no two of its tasks touch one row: tasks work on blocks of points that do not
/// overlap, or on rows of one colour, which share no point. That is decided when the lists are built and
/// checked there; the compiler cannot see it, hence the raw pointer.
pub struct DisjointSlice<'a, T> {
    first: *mut T,
    len: usize,
    column: PhantomData<&'a mut [T]>,
}

// SAFETY: handing a row to another thread is handing over a `T`; see the type's note on disjointness.
unsafe impl<T: Send> Sync for DisjointSlice<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Send> Send for DisjointSlice<'_, T> {}

impl<T> Clone for DisjointSlice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for DisjointSlice<'_, T> {}

impl<'a, T: Copy> DisjointSlice<'a, T> {
    /// Lends a column.
    pub fn new(column: &'a mut [T]) -> Self {
        Self { first: column.as_mut_ptr(), len: column.len(), column: PhantomData }
    }

    /// Reads a row.
    ///
    /// # Safety
    /// `row` is inside the column, and no other task of this phase writes it.
    #[inline(always)]
    pub unsafe fn get(&self, row: u32) -> T {
        debug_assert!((row as usize) < self.len);
        unsafe { *self.first.add(row as usize) }
    }

    /// Writes a row.
    ///
    /// # Safety
    /// `row` is inside the column, and no other task of this phase reads or writes it.
    #[inline(always)]
    pub unsafe fn set(&self, row: u32, value: T) {
        debug_assert!((row as usize) < self.len);
        unsafe { *self.first.add(row as usize) = value };
    }

    /// A run of rows, to be read and written.
    ///
    /// # Safety
    /// The run is inside the column, and no other task of this phase touches it.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)]
    pub unsafe fn run(&self, rows: std::ops::Range<u32>) -> &mut [T] {
        debug_assert!(rows.start <= rows.end && rows.end as usize <= self.len);
        unsafe { std::slice::from_raw_parts_mut(self.first.add(rows.start as usize), rows.len()) }
    }
}
