//! The points that transform constraints hold, and their motion.

use super::*;

#[test]
fn pins_move_with_the_transform_of_their_constraint() {
    let pinned = program(
        &(sheet("spaceScale: 0.1", "")
            + r#""pin": dynamicConstraint(components: ["cloth1.vtx[1]"], tx: 5,
             rotateY: keys([(1, 0), (3, 90)]), ty: keys([(1, 0), (2, 0), (3, 2)]))"#),
    );
    // Point 1 is at (1, 0, 1), which is (-4, 0, 1) from the pin; a quarter about y makes that (1, 0, 4).
    let mut attachments = AttachmentState::default();
    let start = |cloth: ClothId, point: PointId| pinned.model().positions(cloth)[point.index()];
    let first = solved(&pinned, 2, &mut attachments, &start).pins;
    let second = solved(&pinned, 3, &mut attachments, &start).pins;
    assert_eq!((first.len(), first[0].cloth, first[0].point), (1, ClothId(0), PointId(1)));
    assert_eq!(first[0].start, Vector3::new(0.1, 0.0, 0.1));
    assert_eq!(first[0].end, second[0].start);
    assert!((second[0].end - Vector3::new(0.6, 0.2, 0.4)).norm() < 1e-15);
}

// EVIDENCE: N2.4-5  a constraint that becomes enabled attaches points at their current positions
#[test]
fn a_constraint_that_becomes_enabled_attaches_points_at_their_current_positions() {
    let hand = program(
        &(sheet("", "")
            + r#""hand": dynamicConstraint(components: ["cloth1.vtx[0]"], tx: keys([(1, 0), (11, 10)]),
             enable: keys([(1, false), (3, true), (5, false), (7, true)]))"#),
    );
    let mut attachments = AttachmentState::default();
    let mut pins = |frame, at: Vector3<f64>| solved(&hand, frame, &mut attachments, &|_, _| at).pins;
    let (here, there) = (Vector3::new(7.0, 8.0, 9.0), Vector3::new(0.0, -5.0, 0.0));
    assert_eq!(pins(2, here), []);
    let held = pins(3, here);
    assert_eq!((held[0].start, held[0].end), (here, here + Vector3::x()));
    let held = pins(4, there);
    assert_eq!((held[0].start, held[0].end), (here + Vector3::x(), here + Vector3::x() * 2.0));
    assert_eq!(pins(5, there), []);
    assert_eq!(pins(6, there), []);
    assert_eq!(pins(7, there)[0].start, there);
}

#[test]
fn a_point_of_two_constraints_has_one_pin() {
    let twice = program(
        &(sheet("", "")
            + r#""a": dynamicConstraint(components: ["cloth1.vtx[0:2]", "cloth1.vtx[1]", "cloth1"]),
             "b": dynamicConstraint(components: ["cloth1.vtx[*]"], tx: keys([(1, 0), (2, 5)]))"#),
    );
    let points: Vec<u32> = twice.first_input().pins.iter().map(|pin| pin.point.0).collect();
    assert_eq!(points, [0, 1, 2, 3]);
    assert_eq!(twice.warnings()[0].message, "`b` takes hold of points that another constraint may hold");
}
