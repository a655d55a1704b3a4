//! The memory of a cloth, per vertex: what the solver holds after a frame, counted in the allocator.

#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::Vector3;
use nucleus_core::{Cloth, ClothLists, Mass, ModelBuilder, Solver, Surface};

static HELD: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: every call is forwarded to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size(), Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(place, layout) }
    }
    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        HELD.fetch_add(size, Ordering::Relaxed);
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(place, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Points along each side.
const SIDE: u32 = 257;

/// Bytes that a solver of a sheet of quads holds after a frame, and those of its columns and lists alone, per vertex.
fn bytes(lists: ClothLists) -> [f64; 2] {
    let before = HELD.load(Ordering::Relaxed);
    let cells = SIDE - 1;
    let surface = Surface::sheet(Vector3::zeros(), [Vector3::x(), Vector3::z()], [cells, cells]);
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), lists)).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let mut input = solver.default_frame();
    input.cloths[0].bend_resistance = 0.1;
    solver.step(&input, &mut ());
    let held = HELD.load(Ordering::Relaxed) as f64 - before as f64;
    [held, solver.memory() as f64].map(|bytes| bytes / f64::from(SIDE * SIDE))
}

// One test, because the count is of the whole program.
#[test]
fn a_cloth_takes_at_most_400_bytes_a_vertex_without_contact() {
    let plain = ClothLists {
        stretch: true,
        cross_links: true,
        bend: true,
        air: true,
        damp: true,
        ..ClothLists::NONE
    };
    let found = bytes(plain);
    println!("{found:?} bytes per vertex");
    assert!(found[0] <= 400.0, "{found:?} bytes per vertex");
}
