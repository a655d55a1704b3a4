//! A warm substep allocates nothing.

#![allow(unsafe_code)]

#[path = "core/scenes/mod.rs"]
mod scenes;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use nucleus_core::{
    Cloth, ClothFrame, ClothLists, ColliderId, ConstraintFrame, Elements, FrameInput, Link, LinkKind,
    LinkSide, Mass, ModelBuilder, PointId, Pressure, SelfCollision, Solver, StateView, StepObserver,
    SubstepIndex,
};
use scenes::links::point;

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

/// Steps a solver until its buffers have grown, and counts the allocations of two substeps.
fn allocations(builder: ModelBuilder, mut input: FrameInput) -> usize {
    let mut solver = Solver::<f32>::new(builder, 2);
    let mut seen = AllocationCounts([0; 3]);
    for _ in 0..61 {
        solver.step(&input, &mut seen);
        input.constraints.iter_mut().for_each(|constraint| constraint.formed = None);
    }
    seen.0[2] - seen.0[0]
}

/// A sheet that falls on a ball.
fn drape() -> (ModelBuilder, FrameInput) {
    let (builder, mut input) = scenes::drape(33, 48.0);
    input.cloths[0] = ClothFrame { drag: 0.05, shear_resistance: 5.0, damp: 0.1, ..input.cloths[0] };
    (builder, input)
}

/// The same with points that slide on the ball, and a spring between two points.
fn tied_drape() -> (ModelBuilder, FrameInput) {
    let (builder, mut input) = drape();
    let foot = LinkSide::Collider {
        collider: ColliderId(0),
        points: [0, 1, 2].map(PointId),
        weights: [1.0, 0.0, 0.0],
    };
    let slides = |at: u32| Link { kind: LinkKind::Surface, ..Link::new([point(0, at), foot], 0.05) };
    let sliding = ConstraintFrame {
        formed: Some([544, 545, 546].map(slides).to_vec()),
        slides: true,
        friction: 0.1,
        keep_off: Some(0.01),
        ..ConstraintFrame::default()
    };
    let spring = Link::new([point(0, 0), point(0, 32)], 1.0);
    let spring = ConstraintFrame { formed: Some(vec![spring]), ..ConstraintFrame::default() };
    input.constraints = vec![sliding, spring];
    (builder, input)
}

/// Two sheets that lie on each other and on the ground.
fn stack() -> (ModelBuilder, FrameInput) {
    let mut builder = ModelBuilder::new();
    for height in [0.005, 0.01] {
        let mut sheet = scenes::grid(33, 33, scenes::Vec3::x(), scenes::Vec3::z());
        sheet.positions.iter_mut().for_each(|p| p.y = height);
        let lists = ClothLists { stretch: true, self_collision: true, ..ClothLists::NONE };
        builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), lists)).expect("a good mesh");
    }
    let own = SelfCollision { on: true, thickness: 0.0025, elements: Elements::Faces, edges: true };
    let cloth = ClothFrame { thickness: 0.0025, self_collision: own, ..scenes::still() };
    let input = FrameInput {
        plane: Some(scenes::ground(0.3)),
        cloths: vec![cloth; 2],
        ..scenes::frame(3, scenes::physical(48.0))
    };
    (builder, input)
}

/// A sphere of cloth with a hole, sealed or open, that gas inflates.
fn balloon(sealed: bool) -> (ModelBuilder, FrameInput) {
    let mut surface = scenes::sphere(0.5, scenes::Vec3::zeros());
    let faces = &surface.faces;
    surface.faces = (1..faces.len()).map(|at| faces.face(at)).collect();
    let lists = ClothLists { stretch: true, pressure: true, damp: true, ..ClothLists::NONE };
    let pressure = Pressure::Gas { start: 0.3, bulk: 1e3, pump: 0.0, tightness: 1.0, damping: 0.0, sealed };
    let cloth = ClothFrame { pressure, damp: 1.0, ..scenes::still() };
    let input = FrameInput {
        gravity: scenes::Vec3::zeros(),
        cloths: vec![cloth],
        ..scenes::frame(3, scenes::physical(48.0))
    };
    (scenes::one_cloth(surface, lists), input)
}

// One test, because the count is of the whole program.
#[test]
fn a_warm_substep_allocates_nothing() {
    let scenes = [
        ("drape", drape()),
        ("tied", tied_drape()),
        ("stack", stack()),
        ("sealed", balloon(true)),
        ("open", balloon(false)),
    ];
    for (name, (builder, input)) in scenes {
        assert_eq!(allocations(builder, input), 0, "allocations in two substeps of the 61st frame: {name}");
    }
}
