//! Loops over rows side by side, compiled for eight lanes of AVX2 and for two times four; the machine decides at run time.

#![allow(unsafe_code)]

use super::real::{Lanes, Real, Two};

/// A loop over rows side by side. Every width of lanes gives the same bits.
pub trait Kernel<R: Real> {
    /// Does the loop. Implementations are `#[inline(always)]`, so that they are compiled for the lanes of their caller.
    ///
    /// # Safety
    /// Stated by the implementation; the machine has the lanes.
    unsafe fn run<L: Lanes<R>>(self);
}

/// Runs a kernel with eight lanes.
///
/// # Safety
/// See the kernel.
pub unsafe fn run<R: Real>(kernel: impl Kernel<R>) {
    // SAFETY: the caller's promise, and the machine has the lanes.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        if R::has_wide_lanes() {
            return run_avx2(kernel);
        }
        kernel.run::<Two<R::Lanes>>();
    }
}

/// # Safety
/// See the kernel; the machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn run_avx2<R: Real>(kernel: impl Kernel<R>) {
    // SAFETY: the caller's promise.
    unsafe { kernel.run::<R::Wide>() };
}
