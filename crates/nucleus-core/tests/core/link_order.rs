//! The order of links: all from the same state, or outwards from held points.

use crate::scenes::{LINKS, Vec3, frame, grid, physical, pins, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, FrameInput, LinkOrder, Mass, ModelBuilder, PointId,
    ResistanceModel, Solver, StateView, Surface,
};

const CLOTH: ClothId = ClothId(0);

fn run(surface: &Surface, order: LinkOrder, input: &FrameInput, frames: usize) -> Vec<Vec3> {
    let mut builder = ModelBuilder::new();
    let lists = ClothLists { cross_links: true, ..LINKS };
    let cloth = builder.cloth(Cloth::new(surface.clone(), Mass::PerPoint(0.01), lists)).expect("a good mesh");
    builder.set_link_order(cloth, order).expect("points of the mesh");
    let mut solver = Solver::<f64>::new(builder, 2);
    (0..frames).for_each(|_| {
        solver.step(input, &mut ());
    });
    (0..surface.positions.len()).map(|point| solver.point(CLOTH, point)).collect()
}

/// Farthest that a point is from the mirror image of its twin, in a sheet of `side` columns about x = 0.
fn asymmetry(points: &[Vec3], side: usize) -> f64 {
    let twin = |k: usize| k / side * side + side - 1 - k % side;
    let off = |(k, p): (usize, &Vec3)| (points[twin(k)] - Vec3::new(-p.x, p.y, p.z)).norm();
    points.iter().enumerate().map(off).fold(0.0, f64::max)
}

#[test]
fn links_that_are_solved_at_once_keep_a_symmetric_sheet_symmetric() {
    let side = 9;
    let mut sheet = grid(side, side, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| p.x -= 0.5);
    let held = pins(&sheet, [0, side as usize - 1]);
    for resistance in [ResistanceModel::Classic, physical(48.0)] {
        let input = FrameInput { pins: held.clone(), ..frame(3, resistance) };
        let [sequential, parallel] = [LinkOrder::Sequential, LinkOrder::Parallel]
            .map(|order| asymmetry(&run(&sheet, order, &input, 12), side as usize));
        assert!(parallel < 1e-9, "{resistance:?}: {parallel:e}");
        assert!(sequential > 1e-6, "one after another they are biased by their order: {sequential:e}");
    }
}

#[test]
fn links_that_are_solved_at_once_keep_momentum_and_length() {
    let mut sheet = grid(9, 9, Vec3::x(), Vec3::z());
    // Stretched and sheared at the start, and free.
    let start: Vec<Vec3> =
        sheet.positions.iter().map(|p| Vec3::new(1.1 * p.x + 0.1 * p.z, 0.0, p.z)).collect();
    let free = ClothFrame { stretch_damp: 1.0, ..still() };
    let input = FrameInput { gravity: Vec3::zeros(), cloths: vec![free], ..frame(3, physical(96.0)) };
    let mean = |points: &[Vec3]| points.iter().sum::<Vec3>() / points.len() as f64;
    let mut builder = ModelBuilder::new();
    let lists = ClothLists { cross_links: true, damp: true, ..LINKS };
    let mut cloth = Cloth::new(sheet.clone(), Mass::PerPoint(0.01), lists);
    cloth.start.positions = start.clone();
    let cloth = builder.cloth(cloth).expect("a good mesh");
    builder.set_link_order(cloth, LinkOrder::Parallel).expect("points of the mesh");
    let mut solver = Solver::<f64>::new(builder, 1);
    let strain = (0..48).map(|_| solver.step(&input, &mut ()).max_strain).last().unwrap_or(1.0);
    sheet.positions = (0..81).map(|point| solver.point(CLOTH, point)).collect();
    assert!((mean(&sheet.positions) - mean(&start)).norm() < 1e-9);
    assert!(strain < 0.01, "{strain}");
}

#[test]
fn links_sorted_outwards_from_the_pins_hold_a_strip_up_better() {
    // One iteration in a substep: what a sweep passes on along the chain is all that holds it.
    let strip = grid(2, 60, Vec3::x() * 0.05, -Vec3::y() * 3.0);
    let cloth = ClothFrame { stretch_resistance: 3.0, compression_resistance: 0.0, ..still() };
    let held = pins(&strip, [0, 1]);
    let input = FrameInput { cloths: vec![cloth], pins: held, ..frame(3, ResistanceModel::Classic) };
    let length = |order: LinkOrder| {
        let points = run(&strip, order, &input, 48);
        points[0].y - points[118].y
    };
    let [sorted, unsorted] =
        [LinkOrder::Outwards(vec![PointId(0), PointId(1)]), LinkOrder::Sequential].map(length);
    let reversed = length(LinkOrder::Outwards(vec![PointId(118), PointId(119)]));
    assert!(sorted < unsorted && unsorted < reversed, "{sorted} {unsorted} {reversed}");
}
