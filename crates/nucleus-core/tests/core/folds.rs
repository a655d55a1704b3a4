//! Links that resist folding between joined edges.

use crate::scenes::links::{PHYSICAL, model, momenta, place, point, points, run, tied};
use crate::scenes::{Vec3, grid, pins};
use nucleus_core::{
    Cloth, ClothId, ClothLists, ConstraintFrame, FrameInput, Link, LinkMethod, Mass, ResistanceModel, Solver,
    StateView, Surface, fold_link,
};

/// A cantilever of quads, cut across at its third column, and the links that join the halves: welds, then folds.
fn cut_strip(is_joined: bool) -> (Surface, Vec<Link>) {
    let [columns, rows] = [9u32, 3];
    let mut strip = grid(columns, rows, Vec3::x() * 0.3, Vec3::z() * 0.1);
    let cut = |row: u32| row * columns + 3;
    let first = strip.positions.len() as u32;
    let mut links = Vec::new();
    for row in 0..rows {
        strip.positions.push(strip.positions[cut(row) as usize]);
        links.push(Link::new([point(0, cut(row)), point(0, first + row)], 0.0));
    }
    let mut faces = nucleus_core::Faces::default();
    for face in strip.faces.iter() {
        let right = face.iter().any(|point| point % columns > 3);
        let own = |&point: &u32| if right && point % columns == 3 { first + point / columns } else { point };
        faces.push(&face.iter().map(own).collect::<Vec<u32>>());
    }
    strip.faces = faces;
    for row in (0..rows - 1).filter(|_| is_joined) {
        for end in [row, row + 1] {
            let ours = [cut(row), cut(row + 1), cut(end) - 1];
            let theirs = [first + row, first + row + 1, cut(end) + 1];
            let places = [ours, theirs].map(|side| side.map(|point| strip.positions[point as usize]));
            let sides = [ours, theirs].map(|points| place(0, points, [0.0; 3]));
            links.extend(fold_link(sides, places, 0.5, [row, row + 1]));
        }
    }
    (strip, links)
}

/// How far the end of a strip sags that is held at its first two columns, in metres.
fn sag(surface: &Surface, links: Vec<Link>, resistance: ResistanceModel, bend: f64) -> f64 {
    let lists = ClothLists { stretch: true, bend: true, damp: true, ..ClothLists::NONE };
    let mut solver: Solver<f64> =
        Solver::new(model([Cloth::new(surface.clone(), Mass::PerArea(0.2), lists)]), 1);
    let constraint = ConstraintFrame {
        formed: Some(links),
        method: LinkMethod::Weld,
        bend_strength: bend,
        ..ConstraintFrame::default()
    };
    let mut input = tied(1, resistance, constraint);
    input.pins = pins(surface, (0..3).flat_map(|row| [row * 9, row * 9 + 1]));
    input.cloths[0].bend_resistance = bend;
    input.cloths[0].damp = 1.0;
    run(&mut solver, &mut input, 72);
    -solver.point(ClothId(0), 8).y
}

// EVIDENCE: N2.3-5  joined edges hinge, unless they resist folding
#[test]
fn a_strip_that_is_cut_and_joined_by_folds_bends_like_the_whole_one() {
    let whole = grid(9, 3, Vec3::x() * 0.3, Vec3::z() * 0.1);
    let [hinged, joined] = [false, true].map(cut_strip);
    for (resistance, bend, within) in [(PHYSICAL, 300.0, 0.03), (ResistanceModel::Classic, 80.0, 0.25)] {
        let whole = sag(&whole, Vec::new(), resistance, bend);
        let [hinged, joined] =
            [&hinged, &joined].map(|(surface, links)| sag(surface, links.clone(), resistance, bend));
        assert!(whole > 0.005, "{whole}");
        assert!((joined / whole - 1.0).abs() < within, "{resistance:?}: {joined} m, whole {whole} m");
        assert!(hinged > 1.3 * whole, "{resistance:?}: {hinged} m without folds, whole {whole} m");
    }
}

#[test]
fn a_fold_breaks_at_its_break_angle_and_with_the_links_of_its_edge() {
    for (bend, degrees, glue, expected) in
        [(300.0, 180.0f64, 1.0, 0), (1.0, 30.0, 1.0, 4), (300.0, 30.0, 1.0, 0), (300.0, 180.0, 0.0, 7)]
    {
        let (strip, links) = cut_strip(true);
        let lists = ClothLists { stretch: true, bend: true, damp: true, ..ClothLists::NONE };
        let mut solver: Solver<f64> =
            Solver::new(model([Cloth::new(strip.clone(), Mass::PerArea(0.2), lists)]), 1);
        let constraint = ConstraintFrame {
            formed: Some(links),
            method: LinkMethod::Weld,
            bend_strength: bend,
            break_half_sine: (degrees.to_radians() / 2.0).sin(),
            can_break: glue < 1.0,
            glue_strength: glue,
            ..ConstraintFrame::default()
        };
        let mut input = tied(1, PHYSICAL, constraint);
        // The free half cannot bend in itself.
        input.pins = pins(&strip, (0..3).flat_map(|row| (0..4).map(move |column| row * 9 + column)));
        input.cloths[0].damp = 1.0;
        input.cloths[0].bend_resistance = 2000.0;
        let broken = run(&mut solver, &mut input, 24).broken_links;
        assert_eq!(broken, expected, "bend {bend}, {degrees}°, glue {glue}");
    }
}

#[test]
fn folds_between_free_faces_keep_momentum() {
    let places = [
        Vec3::zeros(),
        Vec3::x(),
        Vec3::new(0.3, 0.2, 0.8),
        Vec3::zeros(),
        Vec3::x(),
        Vec3::new(0.6, 0.5, -0.9),
    ];
    let sides = [place(0, [0, 1, 2], [0.0; 3]), place(1, [0, 1, 2], [0.0; 3])];
    let fold =
        fold_link(sides, [[places[0], places[1], places[2]], [places[3], places[4], places[5]]], 1.0, [0, 1]);
    let fold = Link { rest: 0.0, ..fold.expect("faces with an area") };
    let welds = [0, 1].map(|k| Link::new([point(0, k), point(1, k)], 0.0));
    let constraint = ConstraintFrame {
        formed: Some([welds[0], welds[1], fold].to_vec()),
        method: LinkMethod::Weld,
        bend_strength: 1e6,
        ..ConstraintFrame::default()
    };
    let mut solver: Solver<f64> = Solver::new(model([points(&places[..3]), points(&places[3..])]), 1);
    let mut input = FrameInput { gravity: Vec3::zeros(), ..tied(2, PHYSICAL, constraint) };
    run(&mut solver, &mut input, 3);
    let moved = (solver.point(ClothId(0), 2) - places[2]).norm();
    let [linear, angular] = momenta(&solver, &[3, 3]);
    assert!(moved > 0.01, "{moved} m: it unfolds");
    assert!(linear.norm() < 1e-4 && angular.norm() < 0.05, "{linear} {angular}");
}

#[test]
fn folds_continue_from_a_checkpoint_with_the_same_bits() {
    let build = || {
        let (strip, links) = cut_strip(true);
        let lists = ClothLists { stretch: true, bend: true, ..ClothLists::NONE };
        let builder = model([Cloth::new(strip.clone(), Mass::PerArea(0.2), lists)]);
        let constraint = ConstraintFrame {
            formed: Some(links),
            method: LinkMethod::Weld,
            bend_strength: 1.0,
            break_half_sine: 0.2,
            ..ConstraintFrame::default()
        };
        let pins = pins(&strip, (0..3).flat_map(|row| [row * 9, row * 9 + 1]));
        (builder, FrameInput { pins, ..tied(1, PHYSICAL, constraint) })
    };
    let (builder, mut input) = build();
    let mut solver: Solver<f64> = Solver::new(builder, 1);
    run(&mut solver, &mut input, 6);
    let mut restored: Solver<f64> = Solver::restored(build().0, 2, &solver.save()).expect("a checkpoint");
    let reports = [&mut solver, &mut restored].map(|solver| run(solver, &mut input, 6));
    assert_eq!(solver.state_hash(), restored.state_hash());
    assert_eq!(reports[0].broken_links, reports[1].broken_links);
}
