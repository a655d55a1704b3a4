//! The auditor over whole meshes and runs.

use std::collections::HashSet;

use nalgebra::{Rotation3, Vector3};
use nucleus_audit::{
    Account, Auditor, Body, EdgeId, FaceId, Moment, Overlap, Pair, Passage, Plane, Rules, World, crossings,
    intersections,
};
use proptest::prelude::*;

/// A level sheet of `n` by `n` points, 1 wide, cut into triangles.
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

/// Two sheets of 5 by 5 points, the upper one `height` above the lower and a little askew.
fn two_sheets(height: f64) -> (World, Vec<Vector3<f64>>) {
    let (lower, places) = sheet("lower", 5);
    let (upper, _) = sheet("upper", 5);
    let above = moved(&places, [0.03, height, 0.017]);
    (World::new(vec![lower, upper]), [places, above].concat())
}

/// Both sheets with the upper one at another height.
fn with_upper(state: &[Vector3<f64>], height: f64) -> Vec<Vector3<f64>> {
    let place = |(k, place): (usize, &Vector3<f64>)| {
        Vector3::new(place.x, if k < 25 { place.y } else { height }, place.z)
    };
    state.iter().enumerate().map(place).collect()
}

fn run(world: &World, rules: &Rules, states: &[Vec<Vector3<f64>>]) -> Auditor {
    let mut auditor = Auditor::new(world.clone(), rules.clone(), &states[0]);
    for (frame, state) in (2..).zip(&states[1..]) {
        let moment = Moment { frame, substep: 1 };
        auditor.see(moment, state);
        auditor.look(moment);
    }
    auditor
}

#[test]
fn a_sheet_that_falls_through_another_is_found_though_they_end_apart() {
    let (world, start) = two_sheets(0.1);
    let end = with_upper(&start, -0.1);
    let auditor = run(&world, &Rules::default(), &[start, end.clone()]);
    let account = auditor.account();
    // Every inner point of either goes through a face of the other.
    assert!(account.crossings >= 2 * 16, "{account:?}");
    assert_eq!((account.overlaps, account.inside), (0, 0), "they end apart");
    assert!(intersections(&world, &Rules::default(), &end).is_empty());
}

#[test]
fn a_finding_names_body_elements_and_time() {
    let (world, start) = two_sheets(0.1);
    let end = with_upper(&start, -0.1);
    let auditor = run(&world, &Rules::default(), &[start, end]);
    let first = auditor.describe(&auditor.findings()[0]).to_string();
    assert!(first.starts_with("frame 2, substep 1: point lower.vtx["), "{first}");
    assert!(first.contains(" went through face upper.vtx["), "{first}");
}

#[test]
fn a_sheet_that_falls_and_turns_without_meeting_anything_is_clean() {
    let (world, start) = two_sheets(0.1);
    let turn = Rotation3::from_euler_angles(0.3, 0.2, 0.1);
    let turned: Vec<_> = start.iter().map(|place| turn * place - Vector3::y()).collect();
    // Exactly level, and falling level: every pair of neighbours lies in one plane throughout.
    let fallen = moved(&start, [0.0, -3.0, 0.0]);
    let auditor = run(&world, &Rules::default(), &[start, fallen, turned]);
    assert!(auditor.account().is_clean(), "{:?}", auditor.findings());
}

#[test]
fn a_sheet_that_folds_onto_itself_passes_through_itself() {
    let (body, start) = sheet("sheet", 9);
    let world = World::new(vec![body]);
    // Its right half turns over like a page and on through the left half.
    let page = |angle: f64| -> Vec<Vector3<f64>> {
        let fold = |place: &Vector3<f64>| {
            let (x, y) = (f64::max(place.x - 0.5, 0.0), angle);
            Vector3::new(place.x.min(0.5) + x * y.cos(), x * y.sin(), place.z + 0.01 * x)
        };
        start.iter().map(fold).collect()
    };
    let angles = [0.0, 0.8, 1.6, 2.4, 3.0].map(page);
    let closed = run(&world, &Rules::default(), &angles);
    assert!(closed.account().is_clean(), "{:?}", closed.findings());
    let through = run(&world, &Rules::default(), &[angles.as_slice(), &[page(3.3)]].concat());
    assert!(through.account().crossings > 0);
}

#[test]
fn bodies_and_points_that_are_ignored_or_held_are_not_looked_at() {
    let (world, start) = two_sheets(0.1);
    let states = [start.clone(), with_upper(&start, -0.1)];
    let mut ignored = Rules::default();
    ignored.ignore(1, 0);
    assert!(run(&world, &ignored, &states).account().is_clean());
    let mut held = Rules::default();
    (0..50).for_each(|point| held.hold(point));
    assert!(run(&world, &held, &states).account().is_clean());
    let mut half = Rules::default();
    (0..25).for_each(|point| half.hold(point));
    assert!(!run(&world, &half, &states).account().is_clean(), "the upper one was free to give way");
}

#[test]
fn what_starts_inside_each_other_is_excused_until_it_has_come_apart() {
    let (world, start) = two_sheets(0.0);
    // The upper sheet is tilted through the lower one, and slides along while it is.
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
    let apart = run(&world, &Rules::default(), &states);
    let account = apart.account();
    assert!(account.is_clean(), "{account:?} {:?}", apart.findings());
    assert!(account.tangled_at_start > 0 && account.excused > 0 && account.tangled == 0, "{account:?}");
    let again = run(&world, &Rules::default(), &[states.as_slice(), &[tilted(0.1, 0.0)]].concat());
    assert!(again.account().crossings > 0, "they were apart, and went into each other again");
}

#[test]
fn a_tangle_excuses_nothing_elsewhere() {
    let (world, start) = two_sheets(0.0);
    let (third, places) = sheet("third", 5);
    let bodies = [world.bodies(), &[third]].concat();
    let world = World::new(bodies);
    let state = |height: f64| -> Vec<Vector3<f64>> {
        let tilt = |(k, place): (usize, &Vector3<f64>)| {
            Vector3::new(place.x, if k < 25 { 0.0 } else { 0.6 * (place.x - 0.5) }, place.z)
        };
        let two = start.iter().enumerate().map(tilt).collect::<Vec<_>>();
        // Over the edge of the lower sheet, where the tilted one is far.
        [two, moved(&places, [-0.9, height, 0.013])].concat()
    };
    let auditor = run(&world, &Rules::default(), &[state(0.05), state(-0.05)]);
    assert!(auditor.account().crossings > 0 && auditor.account().tangled_at_start > 0);
}

/// The upper sheet tilted through the lower one.
fn tilted(start: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let tilt = |(k, p): (usize, &Vector3<f64>)| Vector3::new(p.x, if k < 25 { p.y } else { p.x - 0.5 }, p.z);
    start.iter().enumerate().map(tilt).collect()
}

#[test]
fn an_overlap_is_found_once_where_the_way_there_is_not_known() {
    let (world, start) = two_sheets(0.1);
    let mut auditor = Auditor::new(world, Rules::default(), &start);
    let follow = |auditor: &mut Auditor, frame: i64, state: &[Vector3<f64>]| {
        auditor.follow(Moment { frame, substep: 1 }, state);
        auditor.account().overlaps
    };
    let found = follow(&mut auditor, 2, &tilted(&start));
    assert!(found > 0 && auditor.account().crossings == 0);
    assert_eq!(follow(&mut auditor, 3, &tilted(&start)), found);
    assert!(auditor.describe(&auditor.findings()[0]).to_string().contains(" is inside face "));
    assert_eq!(follow(&mut auditor, 4, &start), found, "they have come apart");
    assert_eq!(follow(&mut auditor, 5, &tilted(&start)), 2 * found, "and are inside each other again");
}

#[test]
fn what_is_inside_each_other_when_it_is_first_looked_at_is_excused() {
    let (world, start) = two_sheets(0.1);
    let mut blind = Rules::default();
    blind.ignore(0, 1);
    let mut auditor = Auditor::new(world, blind, &start);
    auditor.see(Moment { frame: 2, substep: 1 }, &tilted(&start));
    auditor.set_rules(Rules::default());
    auditor.see(Moment { frame: 3, substep: 1 }, &start);
    auditor.look(Moment { frame: 3, substep: 1 });
    let account = auditor.account();
    assert!(account.is_clean() && account.tangled_at_start > 0 && account.excused > 0, "{account:?}");
    auditor.see(Moment { frame: 4, substep: 1 }, &tilted(&start));
    assert!(auditor.account().crossings > 0);
}

#[test]
fn a_point_that_is_lost_is_named_and_hides_nothing() {
    let (world, start) = two_sheets(0.1);
    let mut end = with_upper(&start, -0.1);
    end[30] = Vector3::repeat(f64::NAN);
    let auditor = run(&world, &Rules::default(), &[start, end]);
    let Account { crossings, undecided, .. } = auditor.account();
    assert!(crossings > 0 && undecided > 0);
}

#[test]
fn a_face_without_area_and_an_edge_without_length_do_no_harm() {
    let (mut lower, places) = sheet("lower", 5);
    // A triangle on one line, one that names a point twice, and one point that is given twice.
    lower.triangles.extend([[0, 1, 2], [3, 3, 4]]);
    lower.points += 1;
    lower.triangles.push([7, 8, 25]);
    let (upper, _) = sheet("upper", 5);
    let world = World::new(vec![lower, upper]);
    let state =
        |height: f64| [places.clone(), vec![places[7]], moved(&places, [0.03, height, 0.017])].concat();
    let clean = run(&world, &Rules::default(), &[state(0.2), state(0.1)]);
    assert!(clean.account().is_clean(), "{:?}", clean.findings());
    let through = run(&world, &Rules::default(), &[state(0.2), state(-0.1)]);
    assert!(through.account().crossings > 0);
}

/// A level plane at some height, with a normal that is not of unit length.
fn level(height: f64) -> Plane {
    Plane::new(Vector3::new(0.0, height, -7.0), Vector3::y() * 2.0).expect("it has a direction")
}

/// What is found of a sheet at the heights, while a plane rises from height to height.
fn over_a_plane(rules: Rules, sheets: &[f64], planes: &[f64]) -> Auditor {
    let (body, start) = sheet("sheet", 3);
    let at = |height: f64| moved(&start, [0.0, height, 0.0]);
    let mut auditor = Auditor::new(World::new(vec![body]), rules, &at(sheets[0]));
    for (frame, (sheet, planes)) in (2..).zip(sheets[1..].iter().zip(planes.windows(2))) {
        let moment = Moment { frame, substep: 1 };
        auditor.see_ground(moment, 0, Some([level(planes[0]), level(planes[1])]), &at(*sheet));
        auditor.see(moment, &at(*sheet));
    }
    auditor
}

#[test]
fn a_plane_that_rises_through_vertices_at_rest_is_found_and_named() {
    let auditor = over_a_plane(Rules::default(), &[0.1; 4], &[0.0, 0.05, 0.2, 0.3]);
    assert_eq!(auditor.account().below_ground, 9, "each vertex once");
    assert!(!auditor.account().is_clean());
    let first = auditor.describe(&auditor.findings()[0]).to_string();
    assert_eq!(first, "frame 3, substep 1: point sheet.vtx[0] went through the ground plane");
}

#[test]
fn vertices_that_rest_on_a_rising_plane_have_not_passed_through_it() {
    let heights = [0.0, 0.1, 0.3, 0.7];
    // Single precision at a coordinate of 7 m is good for less than a millionth of that.
    let rounded = heights.map(|height| height - 5e-7);
    assert!(over_a_plane(Rules::default(), &rounded, &heights).account().is_clean());
    let sunk = heights.map(|height| height - 1e-5 * f64::from(height > 0.1));
    assert_eq!(over_a_plane(Rules::default(), &sunk, &heights).account().below_ground, 9);
}

#[test]
fn vertices_that_begin_below_a_plane_or_are_held_do_not_pass_through_it() {
    let begins_below = over_a_plane(Rules::default(), &[-0.1, -0.2, 0.1, -0.1], &[0.0; 4]);
    assert_eq!(begins_below.account().below_ground, 9, "only once they were above it");
    let mut held = Rules::default();
    (0..9).for_each(|point| held.hold(point));
    assert!(over_a_plane(held, &[0.1; 3], &[0.0, 0.2, 0.2]).account().is_clean());
}

#[test]
fn a_plane_that_tilts_passes_the_vertices_that_it_has_come_to() {
    let slope = Plane::new(Vector3::zeros(), Vector3::new(-1.0, 1.0, 0.0)).expect("it has a direction");
    let (body, start) = sheet("sheet", 3);
    let world = World::new(vec![body]);
    let places = moved(&start, [0.0, 0.1, 0.0]);
    for (share, passed) in [(0.05, 0), (0.15, 3), (1.0, 6)] {
        let mut auditor = Auditor::new(world.clone(), Rules::default(), &places);
        let planes = [level(0.0), level(0.0).towards(&slope, share)];
        auditor.see_ground(Moment::default(), 0, Some(planes), &places);
        assert_eq!(auditor.account().below_ground, passed, "after {share} of the way");
    }
    assert_eq!(Plane::new(Vector3::zeros(), Vector3::zeros()), None);
}

/// Whether two elements are among those by which an edge can get out of a face.
fn leads(world: &World, pair: Pair, edge: EdgeId, face: FaceId) -> bool {
    match pair {
        Pair::PointFace(point, other) => other == face && world.edges()[edge.0 as usize].contains(&point),
        Pair::EdgeEdge(a, b) => {
            let sides = world.sides(face);
            (a == edge && sides.contains(&b)) || (b == edge && sides.contains(&a))
        }
    }
}

/// Two sheets of 3 by 3 points with every point somewhere near its place.
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
    fn nothing_gets_in_or_out_without_an_event(before in crumpled(), after in crumpled()) {
        let world = World::new(vec![sheet("a", 3).0, sheet("b", 3).0]);
        let rules = Rules::default();
        let events = crossings(&world, &rules, &before, &after);
        let inside = |state: &[Vector3<f64>]| -> HashSet<(EdgeId, FaceId)> {
            let found = intersections(&world, &rules, state);
            found.iter().filter(|found| found.overlap == Overlap::Through).map(|f| (f.edge, f.face)).collect()
        };
        for &(edge, face) in inside(&before).symmetric_difference(&inside(&after)) {
            prop_assert!(events.iter().any(|event| leads(&world, event.pair, edge, face)), "{edge:?} {face:?}");
        }
    }

    #[test]
    fn trees_and_boxes_change_nothing(before in crumpled(), after in crumpled()) {
        let world = World::new(vec![sheet("a", 3).0, sheet("b", 3).0]);
        let found: Vec<Pair> =
            crossings(&world, &Rules::default(), &before, &after).iter().map(|event| event.pair).collect();
        let mut all = Vec::new();
        for point in 0..world.points() as u32 {
            for (face, corners) in (0..).zip(world.triangles()) {
                let [a, b, c] = *corners;
                let four = |state: &[Vector3<f64>]| [point, a, b, c].map(|k| state[k as usize]);
                let apart = || nucleus_audit::passage(nucleus_audit::Kind::PointFace, &four(&before), &four(&after)) == Passage::Apart;
                if !corners.contains(&point) && !apart() {
                    all.push(Pair::PointFace(point, FaceId(face)));
                }
            }
        }
        for (i, &[a, b]) in (0..).zip(world.edges()) {
            for (j, &[c, d]) in (0..).zip(world.edges()).skip(i as usize + 1) {
                let four = |state: &[Vector3<f64>]| [a, b, c, d].map(|k| state[k as usize]);
                let apart = || nucleus_audit::passage(nucleus_audit::Kind::EdgeEdge, &four(&before), &four(&after)) == Passage::Apart;
                if ![c, d].iter().any(|end| [a, b].contains(end)) && !apart() {
                    all.push(Pair::EdgeEdge(EdgeId(i), EdgeId(j)));
                }
            }
        }
        prop_assert_eq!(found, all);
    }

    #[test]
    fn what_is_kept_from_step_to_step_hides_nothing(
        start in crumpled(), drift in crumpled(), leaps in prop::collection::vec((0..40_usize, 0..18_usize, -0.5..0.5_f64), 0..6),
    ) {
        let world = World::new(vec![sheet("a", 3).0, sheet("b", 3).0]);
        let mut auditor = Auditor::new(world.clone(), Rules::default(), &start);
        let (mut state, mut all) = (start, 0);
        for step in 0..40 {
            let mut next: Vec<_> = state.iter().zip(&drift).map(|(place, drift)| place + 0.02 * drift).collect();
            for &(_, point, by) in leaps.iter().filter(|(at, ..)| *at == step) {
                // One point is lost for good.
                next[point].y += if point == 17 { f64::NAN } else { by };
            }
            all += crossings(&world, &Rules::default(), &state, &next).len() as u64;
            auditor.see(Moment { frame: 1, substep: step as u32 }, &next);
            let Account { crossings, touches, undecided, excused, .. } = auditor.account();
            prop_assert_eq!(crossings + touches + undecided + excused, all, "step {}", step);
            state = next;
        }
    }
}
