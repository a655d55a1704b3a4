//! A scene pays only for the features it uses: a feature that is off has no rows and no passes.

mod scenes;

use nucleus_core::{
    Cloth, ClothFrame, ClothLists, Collider, ColliderFrame, FrameInput, GroundPlane, Mass, ModelBuilder,
    Solver,
};
use scenes::{Vec3, frame, grid, physical};

/// Cells along each side of the sheet, and its points, edges, diagonals and cells.
const CELLS: usize = 16;
const POINTS: usize = (CELLS + 1) * (CELLS + 1);
const EDGES: usize = 2 * CELLS * (CELLS + 1);
const DIAGONALS: usize = 2 * CELLS * CELLS;
const HINGES: usize = 2 * CELLS * (CELLS - 1) + CELLS * CELLS;

/// A feature: the list and the attribute that switch it on, the pass it adds, and the rows of that pass.
type Feature = (fn(&mut ClothLists), fn(&mut FrameInput), &'static str, usize);

/// Each is switched on in addition to those before it.
const FEATURES: [Feature; 7] = [
    (|lists| lists.stretch = true, |frame| frame.cloths[0].stretch_resistance = 20.0, "stretch", EDGES),
    (|lists| lists.cross_links = true, |_| {}, "stretch", EDGES + DIAGONALS),
    (|lists| lists.shear = true, |frame| frame.cloths[0].shear_resistance = 5.0, "shear", DIAGONALS),
    (|lists| lists.bend = true, |frame| frame.cloths[0].bend_resistance = 0.1, "bend", HINGES),
    (|lists| lists.air = true, |frame| frame.cloths[0].drag = 0.05, "air", POINTS),
    (|lists| lists.damp = true, |frame| frame.cloths[0].stretch_damp = 0.1, "damp", EDGES + DIAGONALS),
    (|_| {}, |frame| frame.plane = Some(PLANE), "ground", POINTS),
];

const PLANE: GroundPlane = GroundPlane {
    origin: Vec3::new(0.0, -9.0, 0.0),
    normal: Vec3::new(0.0, 1.0, 0.0),
    bounce: 0.0,
    friction: 0.0,
    stickiness: 0.0,
};

/// A frame with gravity only.
fn bare() -> FrameInput {
    let off = ClothFrame {
        stretch_resistance: 0.0,
        compression_resistance: 0.0,
        bend_resistance: 0.0,
        stretch_damp: 0.0,
        drag: 0.0,
        lift: 0.0,
        ..ClothFrame::default()
    };
    FrameInput { cloths: vec![off], ..frame(2, physical(20.0)) }
}

/// The passes of a sheet by name, with their rows.
fn passes(lists: ClothLists, frame: &FrameInput) -> Vec<(&'static str, usize)> {
    let mut builder = ModelBuilder::new();
    let side = CELLS as u32 + 1;
    let surface = grid(side, side, Vec3::x(), Vec3::z());
    builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), lists)).expect("a good mesh");
    if !frame.colliders.is_empty() {
        builder.collider(Collider { surface: scenes::sphere(0.3, -Vec3::y()) }).expect("a good mesh");
    }
    let passes = Solver::<f32>::new(builder, 1).passes(frame);
    passes.iter().map(|pass| (pass.name, pass.rows)).collect()
}

// EVIDENCE: N2.2-7  a feature that is used has a list, one that is not has none
#[test]
fn each_feature_adds_its_own_rows_and_no_others() {
    let (mut lists, mut frame) = (ClothLists::NONE, bare());
    let mut expected = vec![("predict", POINTS)];
    assert_eq!(passes(lists, &frame), expected);
    for (list, set, name, rows) in FEATURES {
        list(&mut lists);
        set(&mut frame);
        expected.retain(|(known, _)| *known != name);
        expected.push((name, rows));
        let mut found = passes(lists, &frame);
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
}

#[test]
fn a_list_whose_attribute_is_zero_in_a_frame_is_not_swept_in_it() {
    assert_eq!(passes(ClothLists::ALL, &bare()), [("predict", POINTS)]);
}

#[test]
fn each_contact_effect_is_a_pass_only_where_an_attribute_switches_it_on() {
    let mut frame = bare();
    frame.cloths[0].collide = true;
    let names = |lists: ClothLists, frame: &FrameInput| -> Vec<&str> {
        passes(lists, frame).into_iter().map(|(name, _)| name).collect()
    };
    let alone = ClothLists { self_collision: true, ..ClothLists::NONE };
    assert_eq!(names(alone, &frame), ["predict"]);
    frame.cloths[0].self_collision.on = true;
    assert_eq!(names(alone, &frame), ["predict", "cloth contact"]);
    frame.cloths[0].stickiness = 0.5;
    assert_eq!(names(alone, &frame), ["predict", "cloth contact", "stick"]);
    frame.cloths[0].bounce = 0.5;
    assert_eq!(names(alone, &frame), ["predict", "cloth contact", "stick", "bounce"]);
    frame.cloths[0].collide_strength = 0.0;
    assert_eq!(names(alone, &frame), ["predict"]);
    frame.cloths[0].push_out.share = 1.0;
    assert_eq!(names(alone, &frame), ["predict", "push out"]);
}

#[test]
fn collider_contact_is_a_pass_only_where_both_sides_collide() {
    let mut frame = bare();
    frame.colliders = vec![ColliderFrame { collide: true, ..ColliderFrame::default() }];
    let names = |frame: &FrameInput| -> Vec<&str> {
        passes(ClothLists::NONE, frame).into_iter().map(|(name, _)| name).collect()
    };
    assert_eq!(names(&frame), ["predict", "collider contact"]);
    frame.colliders[0].collide = false;
    assert_eq!(names(&frame), ["predict"]);
    frame.colliders[0].collide = true;
    frame.cloths[0].collide = false;
    assert_eq!(names(&frame), ["predict"]);
}
