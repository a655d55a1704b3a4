//! Loops over rows side by side, compiled for eight lanes of AVX2 and for two times four; the machine decides at run time.

#![allow(unsafe_code)]

use super::real::{Lanes, Real, Two};
use super::vector::Row4;

/// A loop over rows side by side. Every width of lanes gives the same bits.
pub trait Kernel<R: Real> {
    /// Does the loop. Implementations are `#[inline(always)]`, so that they are compiled for the lanes of their caller.
    ///
    /// # Safety
    /// Stated by the implementation; the machine has the lanes.
    unsafe fn run<L: Lanes<R>>(self);
}

/// A loop that takes eight at a time, in any register. Both kinds of lanes give the same bits.
pub trait KernelOfEight<R: Real> {
    /// Does the loop, as [`Kernel::run`].
    ///
    /// # Safety
    /// Stated by the implementation; the machine has the lanes.
    unsafe fn run_eight<L: Lanes<R, Array = [[R; 4]; 2]>>(self);
}

impl<R: Real, K: Kernel<R>> KernelOfEight<R> for K {
    #[inline(always)]
    unsafe fn run_eight<L: Lanes<R, Array = [[R; 4]; 2]>>(self) {
        // SAFETY: the caller's promise.
        unsafe { self.run::<L>() }
    }
}

/// Runs a kernel with eight lanes.
///
/// # Safety
/// See the kernel.
pub unsafe fn run<R: Real>(kernel: impl KernelOfEight<R>) {
    // SAFETY: the caller's promise, and the machine has the lanes.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        if R::has_wide_lanes() {
            return run_avx2(kernel);
        }
        kernel.run_eight::<Two<R::Lanes>>();
    }
}

/// # Safety
/// See the kernel; the machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn run_avx2<R: Real>(kernel: impl KernelOfEight<R>) {
    // SAFETY: the caller's promise.
    unsafe { kernel.run_eight::<R::Wide>() }
}

/// The numbers of the rows from one on, side by side, as many as there are lanes; beyond the last row, those of the last.
#[inline(always)]
pub fn load<R: Real, L: Lanes<R>>(rows: &[Row4<R>], first: usize) -> [L; 4] {
    L::transpose([
        load_fourth(rows, first),
        load_fourth(rows, first + 1),
        load_fourth(rows, first + 2),
        load_fourth(rows, first + 3),
    ])
}

/// A row of each four.
#[inline(always)]
fn load_fourth<R: Real, L: Lanes<R>>(rows: &[Row4<R>], first: usize) -> L {
    L::of_groups(|group| rows[(first + 4 * group).min(rows.len() - 1)].0)
}

/// Writes numbers side by side to the rows from one on, as many as there are.
#[inline(always)]
pub fn store<R: Real, L: Lanes<R>>(rows: &mut [Row4<R>], first: usize, numbers: [L; 4]) {
    let [a, b, c, d] = L::transpose(numbers);
    store_fourth(rows, first, a);
    store_fourth(rows, first + 1, b);
    store_fourth(rows, first + 2, c);
    store_fourth(rows, first + 3, d);
}

/// Writes a row of each four.
#[inline(always)]
fn store_fourth<R: Real, L: Lanes<R>>(rows: &mut [Row4<R>], first: usize, lanes: L) {
    lanes.for_groups(|group, row| {
        if let Some(to) = rows.get_mut(first + 4 * group) {
            *to = Row4(row);
        }
    });
}
