//! The filtered and the exact test against each other, and both against motions whose result is known by construction.

use proptest::prelude::*;

use super::*;

fn kinds() -> impl Strategy<Value = PairKind> {
    prop_oneof![Just(PairKind::PointFace), Just(PairKind::EdgeEdge)]
}

fn corner(range: impl Strategy<Value = f64>) -> impl Strategy<Value = Vector3<f64>> {
    prop::collection::vec(range, 3).prop_map(|x| Vector3::new(x[0], x[1], x[2]))
}

/// Four corners on a coarse grid, so that degenerate positions are frequent.
fn coarse() -> impl Strategy<Value = Corners> {
    prop::array::uniform4(corner((-3_i8..=3).prop_map(f64::from)))
}

fn anywhere() -> impl Strategy<Value = Corners> {
    prop::array::uniform4(corner(-1.0..1.0_f64))
}

fn certified(kind: PairKind, before: &Corners, after: &Corners) -> Option<CcdResult> {
    let vectors = [before, after].map(|corners| vectors(kind, corners));
    if has_separating_plane(kind, &vectors, 0.0) {
        Some(CcdResult::Separated)
    } else {
        classify_by_bisection(kind, &vectors)
    }
}

/// Without the time, which is for display.
fn word(result: CcdResult) -> &'static str {
    match result {
        CcdResult::Separated => "apart",
        CcdResult::Crossing { .. } => "crosses",
        CcdResult::Touching { .. } => "touches",
        CcdResult::Undecided => "undecided",
    }
}

/// Whether two results for one motion agree. Where a pair has no volume throughout, a separating plane may decide it from one
/// side and rounding hide it from the other: undecided claims nothing.
fn agree(one: CcdResult, other: CcdResult) -> bool {
    let words = [word(one), word(other)];
    words[0] == words[1] || words == ["apart", "undecided"] || words == ["undecided", "apart"]
}

fn at(before: &Corners, after: &Corners, t: f64) -> Corners {
    std::array::from_fn(|k| before[k] * (1.0 - t) + after[k] * t)
}

/// The signed volume of the pair, and the margin by which the meeting point is inside.
fn volume_and_margin(kind: PairKind, corners: &Corners) -> (f64, f64) {
    let [first, second, third] = vectors(kind, corners);
    let normal = first.cross(&second);
    let area = normal.norm_squared();
    let inside = match kind {
        PairKind::PointFace => {
            let (c, b) = (normal.dot(&first.cross(&third)), normal.dot(&third.cross(&second)));
            [b, c, area - b - c].into_iter().fold(f64::INFINITY, f64::min)
        }
        PairKind::EdgeEdge => {
            let (s, r) = (normal.dot(&third.cross(&second)), normal.dot(&third.cross(&first)));
            [s, area - s, r, area - r].into_iter().fold(f64::INFINITY, f64::min)
        }
    };
    (normal.dot(&third), inside / area.max(1e-300))
}

/// The motion sampled at 4,000 times: `Some(true)` where it crosses well inside, `Some(false)` where it stays clearly
/// apart, `None` where samples cannot decide.
fn sampled(kind: PairKind, before: &Corners, after: &Corners) -> Option<bool> {
    const SAMPLES: usize = 4000;
    let samples: Vec<(f64, f64)> = (0..=SAMPLES)
        .map(|k| volume_and_margin(kind, &at(before, after, k as f64 / SAMPLES as f64)))
        .collect();
    let mut near = false;
    for pair in samples.windows(2) {
        let [(volume, inside), (next, next_inside)] = [pair[0], pair[1]];
        let changes = volume * next < 0.0 && volume.abs().min(next.abs()) > 1e-12;
        if changes && inside.min(next_inside) > 0.01 {
            return Some(true);
        }
        near |= volume * next <= 1e-6 && inside.max(next_inside) > -0.05;
    }
    if near { None } else { Some(false) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn integers_confirm_every_certified_result(kind in kinds(), before in anywhere(), after in anywhere()) {
        if let Some(found) = certified(kind, &before, &after) {
            prop_assert_eq!(word(found), word(exact::ccd(kind, &before, &after)));
        }
    }

    #[test]
    fn integers_confirm_every_certified_result_of_degenerate_motions(
        kind in kinds(), before in coarse(), after in coarse(),
    ) {
        if let Some(found) = certified(kind, &before, &after) {
            // A separating plane decides even where the face has no area.
            let exactly = exact::ccd(kind, &before, &after);
            prop_assert!(word(found) == word(exactly) || (found, exactly) == (CcdResult::Separated, CcdResult::Undecided));
        }
    }

    #[test]
    fn time_can_run_backwards(kind in kinds(), before in coarse(), after in coarse()) {
        let [one, other] = [ccd(kind, &before, &after), ccd(kind, &after, &before)];
        prop_assert!(agree(one, other), "{} {}", word(one), word(other));
    }

    #[test]
    fn edges_can_change_places(before in coarse(), after in coarse()) {
        let swap = |[a, b, c, d]: Corners| [d, c, a, b];
        let [one, other] = [
            ccd(PairKind::EdgeEdge, &before, &after),
            ccd(PairKind::EdgeEdge, &swap(before), &swap(after)),
        ];
        prop_assert!(agree(one, other), "{} {}", word(one), word(other));
    }

    #[test]
    fn a_pair_that_meets_by_construction_is_never_missed(
        kind in kinds(), middle in coarse(), half in coarse(), s in 0_u8..=8, r in 0_u8..=8,
    ) {
        // All corners are multiples of 1/64 and below 2^10, so that nothing is rounded.
        let (s, r) = (f64::from(s) / 8.0, f64::from(r) / 8.0);
        let mut middle = middle;
        match kind {
            PairKind::PointFace if s + r <= 1.0 => {
                middle[0] = middle[1] + (middle[2] - middle[1]) * s + (middle[3] - middle[1]) * r;
            }
            PairKind::PointFace => return Ok(()),
            // The point at s of the first edge is the point at r of the second.
            PairKind::EdgeEdge => {
                let meeting = middle[0] + (middle[1] - middle[0]) * s;
                let along = middle[3];
                middle[2] = meeting - along * r;
                middle[3] = meeting + along * (1.0 - r);
            }
        }
        let [before, after] = [-1.0, 1.0].map(|sign| std::array::from_fn(|k| middle[k] + half[k] * sign));
        let found = ccd(kind, &before, &after);
        // Elements without extent throughout have no sides: their edges or end points are tested instead.
        let extent = |corners: &Corners| {
            let [first, second, _] = vectors(kind, corners);
            match kind {
                PairKind::PointFace => first.cross(&second).norm(),
                PairKind::EdgeEdge => first.norm().min(second.norm()),
            }
        };
        let flat = [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|&t| extent(&at(&before, &after, t)) == 0.0);
        prop_assert!(found != CcdResult::Separated || flat, "{before:?} {after:?}");
    }

    #[test]
    fn crossings_shown_by_samples_are_found(kind in kinds(), before in anywhere(), after in anywhere()) {
        if let Some(crosses) = sampled(kind, &before, &after) {
            let found = ccd(kind, &before, &after);
            prop_assert_eq!(matches!(found, CcdResult::Crossing { .. }), crosses, "{:?}", found);
        }
    }

    #[test]
    fn a_pair_separated_by_the_smallest_gap_is_separated(
        kind in kinds(), before in anywhere(), after in anywhere(), hair in prop::sample::select(vec![5e-324_f64, 1e-200, 1e-17, 1e-3]),
    ) {
        // The first element stays at or below height 0, the second at or above `hair`.
        let first = if kind == PairKind::PointFace { 1 } else { 2 };
        let [before, after] = [before, after].map(|mut corners| {
            for (k, corner) in corners.iter_mut().enumerate() {
                corner.z = if k < first { -corner.z.abs() } else { hair.max(corner.z.abs()) };
            }
            corners[0].z = 0.0;
            corners[3].z = hair;
            corners
        });
        prop_assert_eq!(ccd(kind, &before, &after), CcdResult::Separated);
    }
}

fn corners(all: [[f64; 3]; 4]) -> Corners {
    all.map(Vector3::from)
}

const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

/// A point moves from `start` to `end` over a resting face.
fn flight(start: [f64; 3], end: [f64; 3]) -> CcdResult {
    let [a, b, c] = FACE;
    ccd(PairKind::PointFace, &corners([start, a, b, c]), &corners([end, a, b, c]))
}

#[test]
fn the_crossing_time_of_a_point_and_a_face_is_found() {
    let CcdResult::Crossing { at } = flight([1.0, 1.0, 1.0], [1.0, 1.0, -3.0]) else {
        panic!("it goes through")
    };
    assert!((at - 0.25).abs() < 0.26, "{at}");
    assert_eq!(flight([3.0, 3.0, 1.0], [3.0, 3.0, -3.0]), CcdResult::Separated);
    assert_eq!(flight([1.0, 1.0, 1.0], [1.0, 1.0, 0.5]), CcdResult::Separated);
}

#[test]
fn a_point_through_a_side_or_a_corner_of_a_face_goes_through() {
    for [x, y] in [[2.0, 0.0], [2.0, 2.0], [0.0, 0.0], [4.0, 0.0]] {
        let found = flight([x, y, 1.0], [x, y, -1.0]);
        assert!(matches!(found, CcdResult::Crossing { at } if (at - 0.5).abs() < 1e-6), "{found:?}");
        let beside = flight([x.next_up(), y, 1.0], [x.next_up(), y, -1.0]);
        assert_eq!(
            matches!(beside, CcdResult::Crossing { .. }),
            [x, y] == [2.0, 0.0] || [x, y] == [0.0, 0.0]
        );
    }
}

#[test]
fn a_point_that_lands_on_a_face_touches_it() {
    assert_eq!(flight([1.0, 1.0, 1.0], [1.0, 1.0, 0.0]), CcdResult::Touching { at: 1.0 });
    assert_eq!(flight([1.0, 1.0, 0.0], [1.0, 1.0, -1.0]), CcdResult::Touching { at: 0.0 });
    assert_eq!(flight([1.0, 1.0, 1.0], [1.0, 1.0, 5e-324]), CcdResult::Separated);
}

#[test]
fn a_point_sliding_in_the_plane_of_a_face_touches_it_only_inside() {
    let CcdResult::Touching { at } = flight([-4.0, 1.0, 0.0], [4.0, 1.0, 0.0]) else {
        panic!("it slides in")
    };
    assert!(at > 0.4, "{at}");
    assert_eq!(flight([-4.0, 1.0, 0.0], [-1.0, 1.0, 0.0]), CcdResult::Separated);
    assert_eq!(flight([5.0, -4.0, 0.0], [5.0, 4.0, 0.0]), CcdResult::Separated);
}

#[test]
fn a_point_that_dips_to_a_face_and_rises_again_touches_it() {
    // The face rotates about the line x = 0, z = 0 while the point moves along x: with u = 2t - 1 the point is at (u,
    // 0, 0) and the plane at height u², which is zero at u = 0.
    let state =
        |u: f64, height: f64| corners([[u, 0.0, height], [-1.0, -8.0, -u], [-1.0, 8.0, -u], [1.0, 0.0, u]]);
    let found = |height: f64| ccd(PairKind::PointFace, &state(-1.0, height), &state(1.0, height));
    let CcdResult::Touching { at } = found(0.0) else { panic!("it touches at one time: {:?}", found(0.0)) };
    assert!((at - 0.5).abs() < 1e-6, "{at}");
    assert_eq!(word(found(-1e-12)), "apart");
    assert_eq!(word(found(1e-12)), "crosses", "it dips in and comes out again");
}

#[test]
fn an_edge_falling_on_another_crosses_touches_or_stays_above() {
    let start = corners([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 1.0], [0.0, 1.0, 1.0]]);
    let found = |fall: f64| {
        let end = corners([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, fall], [0.0, 1.0, fall]]);
        word(ccd(PairKind::EdgeEdge, &start, &end))
    };
    assert_eq!([found(0.5), found(0.0), found(-0.5)], ["apart", "touches", "crosses"]);
}

#[test]
fn parallel_edges_are_apart_or_on_one_line() {
    let pair = |offset: f64| corners([[0.0; 3], [2.0, 0.0, 0.0], [1.0, offset, 0.0], [3.0, offset, 0.0]]);
    assert_eq!(ccd(PairKind::EdgeEdge, &pair(1.0), &pair(0.5)), CcdResult::Separated);
    assert_eq!(ccd(PairKind::EdgeEdge, &pair(1.0), &pair(-1.0)), CcdResult::Undecided);
}

#[test]
fn coordinates_that_are_not_finite_are_undecided() {
    assert_eq!(flight([f64::NAN, 1.0, 1.0], [1.0, 1.0, 1.0]), CcdResult::Undecided);
    assert_eq!(flight([1.0, 1.0, 1.0], [1.0, f64::INFINITY, 1.0]), CcdResult::Undecided);
}

#[test]
fn results_do_not_depend_on_the_scale_of_a_scene() {
    for scale in [1e-150, 1e-30, 1e30, 1e150] {
        let [a, b, c] = FACE.map(|corner| corner.map(|x| x * scale));
        let found = |start: f64, end: f64| {
            let point = |z: f64| [scale, scale, z * scale];
            ccd(PairKind::PointFace, &corners([point(start), a, b, c]), &corners([point(end), a, b, c]))
        };
        assert_eq!([word(found(1.0, -1.0)), word(found(1.0, 1e-3))], ["crosses", "apart"], "{scale:e}");
    }
}
