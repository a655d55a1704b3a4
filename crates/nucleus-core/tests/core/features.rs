//! A scene pays only for the features it uses: a feature that is off has no rows and no passes.

use crate::scenes::{Vec3, frame, grid, physical};
use nucleus_core::{
    BendSolver, Bending, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, FieldSide,
    ForceField, FrameInput, GroundPlane, InputAttract, InputMesh, Mass, ModelBuilder, PointField, Pressure,
    Solver, WindField,
};

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

const PLANE: GroundPlane = GroundPlane::new(Vec3::new(0.0, -9.0, 0.0), Vec3::new(0.0, 1.0, 0.0));

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
        builder.collider(Collider { surface: crate::scenes::sphere(0.3, -Vec3::y()) }).expect("a good mesh");
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
        // What holds a cloth together that flies freely keeps its angular momentum.
        expected.retain(|(known, _)| *known != "angular momentum");
        expected.push(("angular momentum", POINTS));
        let mut found = passes(lists, &frame);
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
}

#[test]
fn a_list_whose_attribute_is_zero_in_a_frame_is_not_swept_in_it() {
    assert_eq!(passes(ClothLists::DEFAULT, &bare()), [("predict", POINTS)]);
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
    assert_eq!(names(alone, &frame), ["predict"], "within no distance");
    frame.cloths[0].push_out.radius = 0.1;
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

/// An effect on a whole cloth: the list that it needs, the attribute that switches it on, its pass, and whether it needs
/// memory of its own.
type WholeEffect = (fn(&mut ClothLists), fn(&mut FrameInput), &'static str, bool);

const WHOLE_EFFECTS: [WholeEffect; 11] = [
    (
        |lists| lists.pressure = true,
        |frame| frame.cloths[0].pressure = Pressure::Manual { pascals: 10.0, damping: 0.0 },
        "pressure",
        true,
    ),
    (|lists| lists.shape = true, |frame| frame.cloths[0].rigidity = 1.0, "shape", true),
    (|lists| lists.shape = true, |frame| frame.cloths[0].deform_resistance = 1.0, "shape", true),
    (
        |lists| (lists.stretch, lists.plastic) = (true, true),
        |frame| (frame.cloths[0].stretch_resistance, frame.cloths[0].yield_strain) = (20.0, 0.1),
        "yield",
        true,
    ),
    (
        |lists| (lists.bend, lists.bend_angles) = (true, true),
        |frame| {
            frame.cloths[0].bend_resistance = 0.1;
            frame.cloths[0].bending = Bending { solver: BendSolver::FlipTracking, ..Bending::DEFAULT };
        },
        "yield",
        true,
    ),
    (
        |_| {},
        |frame| {
            frame.cloths[0].input_attract = InputAttract { strength: 0.5, damp: 0.5, motion_drag: 0.0 };
            let goal = grid(CELLS as u32 + 1, CELLS as u32 + 1, Vec3::x(), Vec3::z()).positions;
            frame.input_meshes = vec![InputMesh { cloth: ClothId(0), start: goal.clone(), end: goal }];
        },
        "attract",
        false,
    ),
    (
        |lists| lists.air = true,
        |frame| (frame.cloths[0].drag, frame.wind, frame.wind_noise) = (0.05, Vec3::x(), 0.5),
        "gusts",
        true,
    ),
    (
        |lists| lists.air = true,
        |frame| {
            (frame.cloths[0].drag, frame.wind) = (0.05, Vec3::x());
            frame.cloths[0].wind_field =
                WindField { shadow_distance: 1.0, self_shadow: true, ..WindField::OFF };
        },
        "wind shadow",
        true,
    ),
    (
        |lists| lists.air = true,
        |frame| {
            frame.cloths[0].drag = 0.05;
            frame.cloths[0].wind_field = WindField { push_distance: 1.0, ..WindField::OFF };
        },
        "air push",
        true,
    ),
    (
        |_| {},
        |frame| {
            frame.cloths[0].point_field = Some(PointField {
                magnitude: 1.0,
                self_attract: 1.0,
                radius: 0.1,
                distance: 0.5,
                falloff: [1.0; ForceField::SAMPLES],
            });
        },
        "point field",
        false,
    ),
    (
        |_| {},
        |frame| {
            let falloff = [1.0; ForceField::SAMPLES];
            let field = ForceField { side: FieldSide::Double, magnitude: 1.0, distance: 9.0, falloff };
            frame.colliders = vec![ColliderFrame { field: Some(field), ..ColliderFrame::default() }];
        },
        "force field",
        false,
    ),
];

/// Bytes of the columns and lists of a sheet.
fn bytes(lists: ClothLists) -> usize {
    let mut builder = ModelBuilder::new();
    let side = CELLS as u32 + 1;
    let surface = grid(side, side, Vec3::x(), Vec3::z());
    builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), lists)).expect("a good mesh");
    Solver::<f32>::new(builder, 1).memory()
}

#[test]
fn an_effect_on_a_whole_cloth_takes_a_pass_where_it_is_on_and_bytes_where_it_can_ever_be() {
    for (list, set, name, needs_memory) in WHOLE_EFFECTS {
        let (mut lists, mut frame) = (ClothLists::NONE, bare());
        list(&mut lists);
        let rows_off = passes(lists, &frame);
        assert_eq!(rows_off, [("predict", POINTS)], "{name} is at zero, and takes no pass");
        set(&mut frame);
        let found = passes(lists, &frame);
        assert!(found.iter().any(|(known, rows)| *known == name && *rows > 0), "{name}: {found:?}");
        let more = bytes(lists) - bytes(ClothLists::NONE);
        assert_eq!(more > 0, needs_memory, "{name} takes {more} bytes");
    }
}
