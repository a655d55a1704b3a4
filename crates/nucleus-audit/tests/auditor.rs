//! Audits of whole meshes and runs.

use std::collections::HashSet;

use nalgebra::{Rotation3, Vector3};
use nucleus_audit::{
    AuditCounts, Auditor, Body, CcdResult, CollisionFilter, CollisionMesh, EdgeId, FaceId, IntersectionKind,
    Pair, Plane, StateIndex, collisions, intersections,
};
use proptest::prelude::*;

/// A level sheet of `n` by `n` points, 1 m wide, triangulated.
fn sheet(name: &str, n: u32) -> (Body, Vec<Vector3<f64>>) {
    let at = |k: u32| f64::from(k) / f64::from(n - 1);
    let places = (0..n * n).map(|k| Vector3::new(at(k % n), 0.0, at(k / n))).collect();
    let quad = |k: u32| {
        let a = k / (n - 1) * n + k % (n - 1);
        [a, a + n, a + n + 1, a + 1]
    };
    let quads: Vec<[u32; 4]> = (0..(n - 1) * (n - 1)).map(quad).collect();
    (Body::mesh(name, (n * n) as usize, quads.iter().map(|quad| quad.as_slice())), places)
}

fn moved(places: &[Vector3<f64>], by: [f64; 3]) -> Vec<Vector3<f64>> {
    places.iter().map(|place| place + Vector3::from(by)).collect()
}

/// Two sheets of 5 by 5 points, the upper one `height` above the lower and slightly offset.
fn two_sheets(height: f64) -> (CollisionMesh, Vec<Vector3<f64>>) {
    let (lower, places) = sheet("lower", 5);
    let (upper, _) = sheet("upper", 5);
    let above = moved(&places, [0.03, height, 0.017]);
    (CollisionMesh::new(vec![lower, upper]), [places, above].concat())
}

/// Both sheets with the upper one at another height.
fn with_upper(state: &[Vector3<f64>], height: f64) -> Vec<Vector3<f64>> {
    let place = |(k, place): (usize, &Vector3<f64>)| {
        Vector3::new(place.x, if k < 25 { place.y } else { height }, place.z)
    };
    state.iter().enumerate().map(place).collect()
}

fn run(mesh: &CollisionMesh, filter: &CollisionFilter, states: &[Vec<Vector3<f64>>]) -> Auditor {
    let mut auditor = Auditor::new(mesh.clone(), filter.clone(), &states[0]);
    for (frame, state) in (2..).zip(&states[1..]) {
        let index = StateIndex { frame, substep: 1 };
        auditor.check_motion(index, state);
        auditor.check_intersections(index);
    }
    auditor
}

#[test]
fn a_sheet_that_falls_through_another_is_found_though_they_end_separated() {
    let (mesh, start) = two_sheets(0.1);
    let end = with_upper(&start, -0.1);
    let auditor = run(&mesh, &CollisionFilter::default(), &[start, end.clone()]);
    let counts = auditor.counts();
    // Every inner point of either goes through a face of the other.
    assert!(counts.crossings >= 2 * 16, "{counts:?}");
    assert_eq!((counts.intersections, counts.current_intersections), (0, 0), "they end apart");
    assert!(intersections(&mesh, &CollisionFilter::default(), &end).is_empty());
}

#[test]
fn a_finding_names_body_elements_and_time() {
    let (mesh, start) = two_sheets(0.1);
    let end = with_upper(&start, -0.1);
    let auditor = run(&mesh, &CollisionFilter::default(), &[start, end]);
    let first = auditor.describe(&auditor.findings()[0]).to_string();
    assert!(first.starts_with("frame 2, substep 1: point lower.vtx["), "{first}");
    assert!(first.contains(" went through face upper.vtx["), "{first}");
}

#[test]
fn a_sheet_that_falls_and_turns_without_meeting_anything_is_clean() {
    let (mesh, start) = two_sheets(0.1);
    let turn = Rotation3::from_euler_angles(0.3, 0.2, 0.1);
    let turned: Vec<_> = start.iter().map(|place| turn * place - Vector3::y()).collect();
    // Exactly level, and falling level: every pair of neighbours is coplanar throughout.
    let fallen = moved(&start, [0.0, -3.0, 0.0]);
    let auditor = run(&mesh, &CollisionFilter::default(), &[start, fallen, turned]);
    assert!(auditor.counts().is_clean(), "{:?}", auditor.findings());
}

#[test]
fn a_sheet_that_folds_onto_itself_passes_through_itself() {
    let (body, start) = sheet("sheet", 9);
    let mesh = CollisionMesh::new(vec![body]);
    // Its right half turns over like a page and on through the left half.
    let page = |angle: f64| -> Vec<Vector3<f64>> {
        let fold = |place: &Vector3<f64>| {
            let (x, y) = (f64::max(place.x - 0.5, 0.0), angle);
            Vector3::new(place.x.min(0.5) + x * y.cos(), x * y.sin(), place.z + 0.01 * x)
        };
        start.iter().map(fold).collect()
    };
    let angles = [0.0, 0.8, 1.6, 2.4, 3.0].map(page);
    let closed = run(&mesh, &CollisionFilter::default(), &angles);
    assert!(closed.counts().is_clean(), "{:?}", closed.findings());
    let through = run(&mesh, &CollisionFilter::default(), &[angles.as_slice(), &[page(3.3)]].concat());
    assert!(through.counts().crossings > 0);
}

#[test]
fn ignored_bodies_and_kinematic_points_are_not_tested() {
    let (mesh, start) = two_sheets(0.1);
    let states = [start.clone(), with_upper(&start, -0.1)];
    let mut ignored = CollisionFilter::default();
    ignored.ignore(1, 0);
    assert!(run(&mesh, &ignored, &states).counts().is_clean());
    let mut kinematic = CollisionFilter::default();
    (0..50).for_each(|point| kinematic.set_kinematic(point));
    assert!(run(&mesh, &kinematic, &states).counts().is_clean());
    let mut half = CollisionFilter::default();
    (0..25).for_each(|point| half.set_kinematic(point));
    assert!(!run(&mesh, &half, &states).counts().is_clean(), "the upper one was free to give way");
}

#[test]
fn initial_intersections_are_excluded_until_they_have_separated() {
    let (mesh, start) = two_sheets(0.0);
    // The upper sheet is tilted through the lower one and slides along.
    let tilted = |height: f64, slide: f64| -> Vec<Vector3<f64>> {
        let place = |(k, place): (usize, &Vector3<f64>)| {
            if k < 25 {
                return *place;
            }
            Vector3::new(place.x + slide, height + 0.6 * (place.x - 0.5), place.z)
        };
        start.iter().enumerate().map(place).collect()
    };
    let states = [tilted(0.0, 0.0), tilted(0.05, 0.1), tilted(0.1, 0.0), tilted(0.9, 0.0)];
    let apart = run(&mesh, &CollisionFilter::default(), &states);
    let counts = apart.counts();
    assert!(counts.is_clean(), "{counts:?} {:?}", apart.findings());
    assert!(
        counts.initial_intersections > 0
            && counts.excluded_collisions > 0
            && counts.remaining_initial_intersections == 0,
        "{counts:?}"
    );
    let again = run(&mesh, &CollisionFilter::default(), &[states.as_slice(), &[tilted(0.1, 0.0)]].concat());
    assert!(again.counts().crossings > 0, "they were apart, and went into each other again");
}

#[test]
fn an_initial_intersection_excludes_no_collision_elsewhere() {
    let (mesh, start) = two_sheets(0.0);
    let (third, places) = sheet("third", 5);
    let bodies = [mesh.bodies(), &[third]].concat();
    let mesh = CollisionMesh::new(bodies);
    let state = |height: f64| -> Vec<Vector3<f64>> {
        let tilt = |(k, place): (usize, &Vector3<f64>)| {
            Vector3::new(place.x, if k < 25 { 0.0 } else { 0.6 * (place.x - 0.5) }, place.z)
        };
        let two = start.iter().enumerate().map(tilt).collect::<Vec<_>>();
        // Beyond the edge of the lower sheet, far from the tilted one.
        [two, moved(&places, [-0.9, height, 0.013])].concat()
    };
    let auditor = run(&mesh, &CollisionFilter::default(), &[state(0.05), state(-0.05)]);
    assert!(auditor.counts().crossings > 0 && auditor.counts().initial_intersections > 0);
}

/// The upper sheet tilted through the lower one.
fn tilted(start: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let tilt = |(k, p): (usize, &Vector3<f64>)| Vector3::new(p.x, if k < 25 { p.y } else { p.x - 0.5 }, p.z);
    start.iter().enumerate().map(tilt).collect()
}

#[test]
fn an_intersection_without_a_known_motion_is_found_once() {
    let (mesh, start) = two_sheets(0.1);
    let mut auditor = Auditor::new(mesh, CollisionFilter::default(), &start);
    let follow = |auditor: &mut Auditor, frame: i64, state: &[Vector3<f64>]| {
        auditor.check_state(StateIndex { frame, substep: 1 }, state);
        auditor.counts().intersections
    };
    let found = follow(&mut auditor, 2, &tilted(&start));
    assert!(found > 0 && auditor.counts().crossings == 0);
    assert_eq!(follow(&mut auditor, 3, &tilted(&start)), found);
    assert!(auditor.describe(&auditor.findings()[0]).to_string().contains(" is inside face "));
    assert_eq!(follow(&mut auditor, 4, &start), found, "they have come apart");
    assert_eq!(follow(&mut auditor, 5, &tilted(&start)), 2 * found, "and are inside each other again");
}

#[test]
fn intersections_that_a_new_filter_includes_count_as_initial() {
    let (mesh, start) = two_sheets(0.1);
    let mut blind = CollisionFilter::default();
    blind.ignore(0, 1);
    let mut auditor = Auditor::new(mesh, blind, &start);
    auditor.check_motion(StateIndex { frame: 2, substep: 1 }, &tilted(&start));
    auditor.set_filter(CollisionFilter::default());
    auditor.check_motion(StateIndex { frame: 3, substep: 1 }, &start);
    auditor.check_intersections(StateIndex { frame: 3, substep: 1 });
    let counts = auditor.counts();
    assert!(
        counts.is_clean() && counts.initial_intersections > 0 && counts.excluded_collisions > 0,
        "{counts:?}"
    );
    auditor.check_motion(StateIndex { frame: 4, substep: 1 }, &tilted(&start));
    assert!(auditor.counts().crossings > 0);
}

#[test]
fn a_nan_point_is_reported_and_hides_no_other_collision() {
    let (mesh, start) = two_sheets(0.1);
    let mut end = with_upper(&start, -0.1);
    end[30] = Vector3::repeat(f64::NAN);
    let auditor = run(&mesh, &CollisionFilter::default(), &[start, end]);
    let AuditCounts { crossings, undecided, .. } = auditor.counts();
    assert!(crossings > 0 && undecided > 0);
}

#[test]
fn degenerate_faces_and_edges_cause_no_finding() {
    let (mut lower, places) = sheet("lower", 5);
    // A collinear triangle, one that repeats a point, and a duplicated point.
    lower.triangles.extend([[0, 1, 2], [3, 3, 4]]);
    lower.points += 1;
    lower.triangles.push([7, 8, 25]);
    let (upper, _) = sheet("upper", 5);
    let mesh = CollisionMesh::new(vec![lower, upper]);
    let state =
        |height: f64| [places.clone(), vec![places[7]], moved(&places, [0.03, height, 0.017])].concat();
    let clean = run(&mesh, &CollisionFilter::default(), &[state(0.2), state(0.1)]);
    assert!(clean.counts().is_clean(), "{:?}", clean.findings());
    let through = run(&mesh, &CollisionFilter::default(), &[state(0.2), state(-0.1)]);
    assert!(through.counts().crossings > 0);
}

/// A level plane at `height`, with a normal that is not of unit length.
fn level(height: f64) -> Plane {
    Plane::new(Vector3::new(0.0, height, -7.0), Vector3::y() * 2.0).expect("it has a direction")
}

/// Audits a sheet at some heights, while a plane moves from height to height.
fn over_a_plane(filter: CollisionFilter, sheets: &[f64], planes: &[f64]) -> Auditor {
    let (body, start) = sheet("sheet", 3);
    let at = |height: f64| moved(&start, [0.0, height, 0.0]);
    let mut auditor = Auditor::new(CollisionMesh::new(vec![body]), filter, &at(sheets[0]));
    for (frame, (sheet, planes)) in (2..).zip(sheets[1..].iter().zip(planes.windows(2))) {
        let index = StateIndex { frame, substep: 1 };
        auditor.check_ground(index, 0, Some([level(planes[0]), level(planes[1])]), &at(*sheet));
        auditor.check_motion(index, &at(*sheet));
    }
    auditor
}

#[test]
fn a_plane_that_rises_through_vertices_at_rest_is_found_and_named() {
    let auditor = over_a_plane(CollisionFilter::default(), &[0.1; 4], &[0.0, 0.05, 0.2, 0.3]);
    assert_eq!(auditor.counts().below_ground, 9, "each vertex once");
    assert!(!auditor.counts().is_clean());
    let first = auditor.describe(&auditor.findings()[0]).to_string();
    assert_eq!(first, "frame 3, substep 1: point sheet.vtx[0] went through the ground plane");
}

#[test]
fn vertices_that_rest_on_a_rising_plane_have_not_passed_through_it() {
    let heights = [0.0, 0.1, 0.3, 0.7];
    // Single precision at a coordinate of 7 m is accurate to less than a millionth of it.
    let rounded = heights.map(|height| height - 5e-7);
    assert!(over_a_plane(CollisionFilter::default(), &rounded, &heights).counts().is_clean());
    let sunk = heights.map(|height| height - 1e-5 * f64::from(height > 0.1));
    assert_eq!(over_a_plane(CollisionFilter::default(), &sunk, &heights).counts().below_ground, 9);
}

#[test]
fn vertices_that_begin_below_a_plane_or_are_kinematic_do_not_pass_through_it() {
    let begins_below = over_a_plane(CollisionFilter::default(), &[-0.1, -0.2, 0.1, -0.1], &[0.0; 4]);
    assert_eq!(begins_below.counts().below_ground, 9, "only once they were above it");
    let mut kinematic = CollisionFilter::default();
    (0..9).for_each(|point| kinematic.set_kinematic(point));
    assert!(over_a_plane(kinematic, &[0.1; 3], &[0.0, 0.2, 0.2]).counts().is_clean());
}

#[test]
fn a_tilting_plane_passes_the_vertices_that_it_has_reached() {
    let slope = Plane::new(Vector3::zeros(), Vector3::new(-1.0, 1.0, 0.0)).expect("it has a direction");
    let (body, start) = sheet("sheet", 3);
    let mesh = CollisionMesh::new(vec![body]);
    let places = moved(&start, [0.0, 0.1, 0.0]);
    for (share, passed) in [(0.05, 0), (0.15, 3), (1.0, 6)] {
        let mut auditor = Auditor::new(mesh.clone(), CollisionFilter::default(), &places);
        let planes = [level(0.0), level(0.0).towards(&slope, share)];
        auditor.check_ground(StateIndex::default(), 0, Some(planes), &places);
        assert_eq!(auditor.counts().below_ground, passed, "after {share} of the way");
    }
    assert_eq!(Plane::new(Vector3::zeros(), Vector3::zeros()), None);
}

/// Whether a collision of this pair can take an edge out of a face.
fn leads(mesh: &CollisionMesh, pair: Pair, edge: EdgeId, face: FaceId) -> bool {
    match pair {
        Pair::PointFace(point, other) => other == face && mesh.edges()[edge.0 as usize].contains(&point),
        Pair::EdgeEdge(a, b) => {
            let sides = mesh.sides(face);
            (a == edge && sides.contains(&b)) || (b == edge && sides.contains(&a))
        }
    }
}

/// Two sheets of 3 by 3 points with every point displaced at random.
fn crumpled() -> impl Strategy<Value = Vec<Vector3<f64>>> {
    prop::collection::vec(prop::array::uniform3(-0.5..0.5_f64), 18).prop_map(|noise| {
        let place = |(k, noise): (usize, &[f64; 3])| {
            let (row, column, layer) = (k % 9 / 3, k % 3, k / 9);
            Vector3::new(0.5 * row as f64, 0.2 * layer as f64, 0.5 * column as f64) + Vector3::from(*noise)
        };
        noise.iter().enumerate().map(place).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    // EVIDENCE: N2.3-3  nothing gets inside anything but by a point through a face or an edge through an edge
    #[test]
    fn no_intersection_begins_or_ends_without_a_collision(before in crumpled(), after in crumpled()) {
        let mesh = CollisionMesh::new(vec![sheet("a", 3).0, sheet("b", 3).0]);
        let rules = CollisionFilter::default();
        let found = collisions(&mesh, &rules, &before, &after);
        let inside = |state: &[Vector3<f64>]| -> HashSet<(EdgeId, FaceId)> {
            let found = intersections(&mesh, &rules, state);
            found.iter().filter(|found| found.kind == IntersectionKind::Through).map(|f| (f.edge, f.face)).collect()
        };
        for &(edge, face) in inside(&before).symmetric_difference(&inside(&after)) {
            prop_assert!(found.iter().any(|collision| leads(&mesh, collision.pair, edge, face)), "{edge:?} {face:?}");
        }
    }

    #[test]
    fn the_broad_phase_changes_no_result(before in crumpled(), after in crumpled()) {
        let mesh = CollisionMesh::new(vec![sheet("a", 3).0, sheet("b", 3).0]);
        let found: Vec<Pair> =
            collisions(&mesh, &CollisionFilter::default(), &before, &after).iter().map(|collision| collision.pair).collect();
        let mut all = Vec::new();
        for point in 0..mesh.points() as u32 {
            for (face, corners) in (0..).zip(mesh.triangles()) {
                let [a, b, c] = *corners;
                let four = |state: &[Vector3<f64>]| [point, a, b, c].map(|k| state[k as usize]);
                let apart = || nucleus_audit::ccd(nucleus_audit::PairKind::PointFace, &four(&before), &four(&after)) == CcdResult::Separated;
                if !corners.contains(&point) && !apart() {
                    all.push(Pair::PointFace(point, FaceId(face)));
                }
            }
        }
        for (i, &[a, b]) in (0..).zip(mesh.edges()) {
            for (j, &[c, d]) in (0..).zip(mesh.edges()).skip(i as usize + 1) {
                let four = |state: &[Vector3<f64>]| [a, b, c, d].map(|k| state[k as usize]);
                let apart = || nucleus_audit::ccd(nucleus_audit::PairKind::EdgeEdge, &four(&before), &four(&after)) == CcdResult::Separated;
                if ![c, d].iter().any(|end| [a, b].contains(end)) && !apart() {
                    all.push(Pair::EdgeEdge(EdgeId(i), EdgeId(j)));
                }
            }
        }
        prop_assert_eq!(found, all);
    }

    #[test]
    fn candidate_intervals_miss_no_collision(
        start in crumpled(), drift in crumpled(), jumps in prop::collection::vec((0..40_usize, 0..18_usize, -0.5..0.5_f64), 0..6),
    ) {
        let mesh = CollisionMesh::new(vec![sheet("a", 3).0, sheet("b", 3).0]);
        let mut auditor = Auditor::new(mesh.clone(), CollisionFilter::default(), &start);
        let (mut state, mut all) = (start, 0);
        for step in 0..40 {
            let mut next: Vec<_> = state.iter().zip(&drift).map(|(place, drift)| place + 0.02 * drift).collect();
            for &(_, point, by) in jumps.iter().filter(|(at, ..)| *at == step) {
                // One point stays NaN.
                next[point].y += if point == 17 { f64::NAN } else { by };
            }
            all += collisions(&mesh, &CollisionFilter::default(), &state, &next).len() as u64;
            auditor.check_motion(StateIndex { frame: 1, substep: step as u32 }, &next);
            let AuditCounts { crossings, touches, undecided, excluded_collisions, .. } = auditor.counts();
            prop_assert_eq!(crossings + touches + undecided + excluded_collisions, all, "step {}", step);
            state = next;
        }
    }
}
