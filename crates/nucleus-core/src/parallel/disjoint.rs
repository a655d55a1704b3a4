//! A column that several tasks write at once, each in rows of its own.

#![allow(unsafe_code)]

use std::marker::PhantomData;

/// A column that the tasks of a parallel loop borrow together.
///
/// No two tasks of a loop touch the same row: tasks work on blocks of points that do not overlap, or on constraint rows
/// of one colour, which share no point. Building the lists ensures it, and tests check it; the compiler cannot see it,
/// hence the raw pointer.
pub struct DisjointSlice<'a, T> {
    first: *mut T,
    len: usize,
    column: PhantomData<&'a mut [T]>,
}

// SAFETY: each row is used by one thread at a time, like a `T` that is sent to it; see the type's note on disjointness.
unsafe impl<T: Send> Sync for DisjointSlice<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Send> Send for DisjointSlice<'_, T> {}

impl<T> Clone for DisjointSlice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for DisjointSlice<'_, T> {}

impl<T: Copy> DisjointSlice<'_, T> {
    /// Reads a row.
    ///
    /// # Safety
    /// `row` is inside the column, and no other task of this loop writes it.
    #[inline(always)]
    pub unsafe fn get(&self, row: u32) -> T {
        debug_assert!((row as usize) < self.len);
        unsafe { *self.first.add(row as usize) }
    }

    /// Writes a row.
    ///
    /// # Safety
    /// `row` is inside the column, and no other task of this loop reads or writes it.
    #[inline(always)]
    pub unsafe fn set(&self, row: u32, value: T) {
        debug_assert!((row as usize) < self.len);
        unsafe { *self.first.add(row as usize) = value };
    }
}

impl<'a, T> DisjointSlice<'a, T> {
    /// Borrows a column.
    pub fn new(column: &'a mut [T]) -> Self {
        Self { first: column.as_mut_ptr(), len: column.len(), column: PhantomData }
    }

    /// A run of rows, to be read and written.
    ///
    /// # Safety
    /// The run is inside the column, and no other task of this loop touches it.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)]
    pub unsafe fn run(&self, rows: std::ops::Range<u32>) -> &mut [T] {
        debug_assert!(rows.start <= rows.end && rows.end as usize <= self.len);
        unsafe { std::slice::from_raw_parts_mut(self.first.add(rows.start as usize), rows.len()) }
    }
}
