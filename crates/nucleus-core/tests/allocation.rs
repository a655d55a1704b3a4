//! A warm substep allocates nothing.

#![allow(unsafe_code)]

mod scenes;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use nucleus_core::{ClothFrame, Solver, StateView, StepObserver, SubstepIndex};

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: every call is forwarded to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        unsafe { System.dealloc(place, layout) }
    }
    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.realloc(place, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The number of allocations up to the end of each substep.
struct AllocationCounts([usize; 3]);

impl StepObserver for AllocationCounts {
    fn substep(&mut self, moment: SubstepIndex, _state: &dyn StateView) {
        self.0[moment.substep as usize - 1] = ALLOCATIONS.load(Ordering::Relaxed);
    }
}

#[test]
fn a_warm_substep_allocates_nothing() {
    let (builder, mut input) = scenes::drape(33, 48.0);
    input.cloths[0] = ClothFrame { drag: 0.05, shear_resistance: 5.0, damp: 0.1, ..input.cloths[0] };
    let mut solver = Solver::<f32>::new(builder, 2);
    let mut seen = AllocationCounts([0; 3]);
    (0..60).for_each(|_| {
        solver.step(&input, &mut seen);
    });
    solver.step(&input, &mut seen);
    assert_eq!(seen.0[2] - seen.0[0], 0, "allocations in two substeps of the 61st frame");
}
