//! Self-collision and contact between cloths: no penetration, rest.

use crate::scenes::{Vec3, frame, grid, ground, physical, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Elements, FrameInput, Mass, ModelBuilder, ResistanceModel,
    SelfCollision, Solver, Surface,
};

const LISTS: ClothLists = ClothLists { stretch: true, bend: true, self_collision: true, ..ClothLists::NONE };

fn full_surface(thickness: f64) -> SelfCollision {
    SelfCollision { on: true, thickness, elements: Elements::Faces, edges: true }
}

/// Signed volume of four points, times six.
fn orient([a, b, c, d]: [Vec3; 4]) -> f64 {
    (b - a).cross(&(c - a)).dot(&(d - a))
}

/// Edges that pass through faces, of all cloths together.
fn crossings(cloths: &[(&Surface, Vec<Vec3>)]) -> usize {
    let mut edges = Vec::new();
    let mut faces = Vec::new();
    for (cloth, (surface, at)) in cloths.iter().enumerate() {
        for [a, b, c] in surface.faces.triangles() {
            faces.push((cloth, [a, b, c], [a, b, c].map(|k| at[k as usize])));
            for (a, b) in [(a, b), (b, c), (c, a)] {
                edges.push((cloth, [a, b], [a, b].map(|k| at[k as usize])));
            }
        }
    }
    let through = |(cloth, ends, [p, q]): &(usize, [u32; 2], [Vec3; 2]),
                   (other, corners, [a, b, c]): &(usize, [u32; 3], [Vec3; 3])| {
        if cloth == other && ends.iter().any(|end| corners.contains(end)) {
            return false;
        }
        if (0..3)
            .any(|k| p[k].min(q[k]) > a[k].max(b[k]).max(c[k]) || p[k].max(q[k]) < a[k].min(b[k]).min(c[k]))
        {
            return false;
        }
        let sides = [orient([*a, *b, *c, *p]), orient([*a, *b, *c, *q])];
        let round = [orient([*p, *q, *a, *b]), orient([*p, *q, *b, *c]), orient([*p, *q, *c, *a])];
        sides[0] * sides[1] < 0.0 && (round.iter().all(|x| *x > 0.0) || round.iter().all(|x| *x < 0.0))
    };
    // The faces that an edge can pass through are a run of them, sorted along x.
    let low = |corners: &[Vec3]| corners.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
    let high = |corners: &[Vec3]| corners.iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
    faces.sort_by(|a, b| low(&a.2).total_cmp(&low(&b.2)));
    let widest = faces.iter().map(|face| high(&face.2) - low(&face.2)).fold(0.0, f64::max);
    let near = |edge: &(usize, [u32; 2], [Vec3; 2])| {
        let from = faces.partition_point(|face| low(&face.2) < low(&edge.2) - widest);
        let to = faces.partition_point(|face| low(&face.2) <= high(&edge.2));
        &faces[from..to]
    };
    edges.iter().map(|edge| near(edge).iter().filter(|face| through(edge, face)).count()).sum()
}

fn positions(solver: &Solver<f32>, cloth: u32, points: usize) -> Vec<Vec3> {
    use nucleus_core::StateView;
    (0..points).map(|k| solver.point(ClothId(cloth), k)).collect()
}

// A reversed quad is triangulated along its other diagonal: the two diagonals cross and coincide at rest.
#[test]
fn a_sheet_with_doubled_faces_has_no_self_contact() {
    let (u, v) = (Vec3::new(0.8, 0.1, 0.59), Vec3::new(-0.3, -0.9, 0.31));
    let mut sheet = grid(17, 17, u, v);
    let faces: Vec<Vec<u32>> = sheet.faces.iter().map(<[u32]>::to_vec).collect();
    faces.iter().for_each(|face| sheet.faces.push(&face.iter().rev().copied().collect::<Vec<_>>()));
    let pins = crate::scenes::pins(&sheet, 0..17);
    let mut solver = Solver::<f32>::new(crate::scenes::one_cloth(sheet, LISTS), 1);
    let cloths = vec![ClothFrame { self_collision: full_surface(0.01), ..still() }];
    let input = FrameInput { pins, cloths, ..frame(3, physical(48.0)) };
    for step in 0..24 {
        let report = solver.step(&input, &mut ());
        assert_eq!(
            (report.contacts, report.pairs_reverted, report.pairs_unresolved),
            (0, 0, 0),
            "frame {step}: {report:?}"
        );
    }
}

// EVIDENCE: N2.3-3  cloth against itself, in point and face and edge and edge
#[test]
fn a_sheet_that_falls_on_its_edge_folds_and_never_passes_itself() {
    // In a Classic step points move farther than an edge is long, so the folds differ by chance.
    let classic = [0.003, 0.004, 0.008].map(|wave| (ResistanceModel::Classic, wave, 12));
    for (resistance, wave, frames) in [(physical(96.0), 0.003, 30)].into_iter().chain(classic) {
        let mut sheet = grid(33, 33, Vec3::new(1.0, 0.0, 0.05), Vec3::new(0.0, 1.0, 0.1));
        sheet.positions.iter_mut().for_each(|p| {
            p.y += 0.02;
            p.z += 0.01 * (9.0 * p.y).sin() + wave * (7.0 * p.x).sin();
        });
        let mut builder = ModelBuilder::new();
        builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(0.2), LISTS)).expect("a mesh");
        let cloth = ClothFrame {
            bend_resistance: 0.1,
            stretch_damp: 0.1,
            thickness: 0.005,
            self_collision: full_surface(0.005),
            ..still()
        };
        let input = FrameInput { plane: Some(ground(0.3)), cloths: vec![cloth], ..frame(3, resistance) };
        let mut solver = Solver::<f32>::new(builder, 1);
        let mut contacts = 0;
        for step in 0..frames {
            let report = solver.step(&input, &mut ());
            contacts += report.contacts;
            assert!(report.finite);
            let through = crossings(&[(&sheet, positions(&solver, 0, 33 * 33))]);
            assert_eq!(through, 0, "{resistance:?}, {wave}, frame {step}: {report:?}");
        }
        assert!(contacts > 1000, "it folded: {contacts}");
    }
}

#[test]
fn a_flat_sheet_without_gravity_has_no_contact_and_does_not_move() {
    // Its points fill no whole number of blocks, and it lies about the origin.
    let mut sheet = grid(17, 17, Vec3::x(), Vec3::y());
    sheet.positions.iter_mut().for_each(|p| *p -= Vec3::new(0.5, 0.5, 0.0));
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(0.2), LISTS)).expect("a mesh");
    let cloth = ClothFrame { thickness: 0.02, self_collision: full_surface(0.02), ..still() };
    let input = FrameInput { cloths: vec![cloth], gravity: Vec3::zeros(), ..frame(1, physical(96.0)) };
    let mut solver = Solver::<f32>::new(builder, 1);
    let start = positions(&solver, 0, 17 * 17);
    let report = solver.step(&input, &mut ());
    assert_eq!(report.contacts, 0, "{report:?}");
    assert_eq!(positions(&solver, 0, 17 * 17), start);
}

// What the first time step would carry through another cloth does not intersect it: it is stopped, not untangled.
#[test]
fn a_sheet_that_flies_at_another_from_the_first_step_on_never_passes_it() {
    let level = |size: f64, n: u32, height: f64| {
        let mut sheet = grid(n, n, Vec3::x() * size, Vec3::z() * size);
        sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-size / 2.0, height, -size / 2.0));
        sheet
    };
    let sheets = [level(0.93, 11, 0.0), level(1.37, 9, 0.15)];
    let mut builder = ModelBuilder::new();
    for sheet in &sheets {
        builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(0.05), LISTS)).expect("a mesh");
    }
    let still = ClothFrame { thickness: 0.002, self_collision: full_surface(0.002), ..still() };
    // Its corners, a quarter of the mass of other points, would go 26 cm in the first step.
    let flying = ClothFrame { local_force: Vec3::y() * 2.0, ..still };
    let input =
        FrameInput { gravity: Vec3::zeros(), cloths: vec![flying, still], ..frame(3, physical(12.0)) };
    let mut solver = Solver::<f32>::new(builder, 1);
    for step in 0..3 {
        let report = solver.step(&input, &mut ());
        let places = [positions(&solver, 0, 121), positions(&solver, 1, 81)];
        let [lower, upper] = places;
        let through = crossings(&[(&sheets[0], lower), (&sheets[1], upper)]);
        assert_eq!(
            (through, report.pairs_unresolved, report.intersections),
            (0, 0, 0),
            "frame {step}: {report:?}"
        );
        assert!(report.contacts > 0, "frame {step}: {report:?}");
    }
}
