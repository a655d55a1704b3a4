//! Checkpoints with a valid checksum and damaged content: restoring refuses or accepts them, and never panics.

use std::sync::OnceLock;

use crate::scenes::{Vec3, frame, grid, ground, physical, sphere, still};
use nucleus_core::{
    Cloth, ClothId, ClothLists, Collider, ConstraintFrame, FrameInput, Link, LinkKind, LinkSide, Mass,
    ModelBuilder, PointId, RestoreError, SelfCollision, Solver, Surface, add_checksum, verify_checksum,
};
use proptest::prelude::*;

/// A cloth with self-collision that falls on a ball and the ground.
fn scene() -> (ModelBuilder, FrameInput) {
    let mut sheet = grid(9, 9, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.5, 0.21, -0.5));
    let mut builder = crate::scenes::one_cloth(sheet, ClothLists::DEFAULT);
    builder.collider(Collider { surface: sphere(0.2, Vec3::zeros()) }).expect("a good mesh");
    let own = SelfCollision { on: true, thickness: 0.02, ..SelfCollision::OFF };
    let cloth = nucleus_core::ClothFrame { thickness: 0.02, self_collision: own, ..still() };
    let plane = ground(0.1);
    let collider = nucleus_core::ColliderFrame { collide: true, thickness: 0.01, ..Default::default() };
    let input = FrameInput {
        plane: Some(plane),
        cloths: vec![cloth],
        colliders: vec![collider],
        ..frame(1, physical(24.0))
    };
    (builder, input)
}

/// Its checkpoint after some frames.
fn saved() -> Vec<u8> {
    let (builder, input) = scene();
    let mut solver = Solver::<f32>::new(builder, 1);
    (0..8).for_each(|_| {
        solver.step(&input, &mut ());
    });
    solver.save()
}

static SAVED: OnceLock<Vec<u8>> = OnceLock::new();

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn restoring_damaged_content_never_panics(at in 0.0..1.0f64, byte: u8, cut in 0usize..3) {
        let whole = SAVED.get_or_init(saved);
        let kind: [u8; 8] = whole[..8].try_into().unwrap();
        let mut inner = verify_checksum(kind, whole).unwrap().to_vec();
        let at = (at * inner.len() as f64) as usize;
        match cut {
            0 => inner.truncate(at),
            _ => inner[at] = byte,
        }
        if let Ok(solver) = Solver::<f32>::restored(scene().0, 1, &add_checksum(kind, &inner)) {
            // Only the checksum is compared, because restoring drops pairs that are valid for one frame only.
            prop_assert!(verify_checksum(kind, &solver.save()).is_ok());
        }
    }
}

#[test]
fn a_checkpoint_of_another_version_is_refused_with_that_reason() {
    let whole = saved();
    let kind: [u8; 8] = whole[..8].try_into().unwrap();
    let inner = verify_checksum(kind, &whole).unwrap();
    let newer = add_checksum(*b"solver99", inner);
    let restored = Solver::<f32>::restored(scene().0, 1, &newer).map(|_| ());
    assert_eq!(restored, Err(RestoreError::OtherVersion));
}

/// A sheet of this size in metres with these lists.
fn sheet(size: f64, lists: ClothLists) -> ModelBuilder {
    let sheet = Surface::sheet(Vec3::y() * 0.4, [Vec3::x() * size, Vec3::z() * size], [8, 8]);
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(sheet, Mass::PerPoint(0.01), lists)).expect("a good mesh");
    builder
}

#[test]
fn a_checkpoint_of_another_shape_or_of_other_lists_is_of_another_model() {
    let saved = Solver::<f32>::new(sheet(1.0, ClothLists::DEFAULT), 1).save();
    let restored = |builder| Solver::<f32>::restored(builder, 1, &saved).map(|_| ());
    assert_eq!(restored(sheet(1.0, ClothLists::DEFAULT)), Ok(()));
    assert_eq!(restored(sheet(3.0, ClothLists::DEFAULT)), Err(RestoreError::OtherModel));
    for lists in [
        ClothLists { plastic: true, ..ClothLists::DEFAULT },
        ClothLists { bend_angles: true, ..ClothLists::DEFAULT },
        ClothLists { pressure: true, ..ClothLists::DEFAULT },
        ClothLists { shape: true, ..ClothLists::DEFAULT },
    ] {
        assert_eq!(restored(sheet(1.0, lists)), Err(RestoreError::OtherModel), "{lists:?}");
    }
}

#[test]
fn links_that_stop_sliding_continue_with_the_same_bits() {
    // The place is beside the edge of the sheet.
    let face = LinkSide::Cloth {
        cloth: ClothId(0),
        points: [PointId(43), PointId(44), PointId(53)],
        weights: [0.3, 0.3, 0.4],
    };
    let place = LinkSide::Space(Vec3::new(1.4, 0.4, 0.6));
    let link = Link { kind: LinkKind::Surface, ..Link::new([place, face], 0.05) };
    let mut solver = Solver::<f32>::new(sheet(1.0, ClothLists::DEFAULT), 1);
    let input = |solver: &Solver<f32>, formed: Option<Vec<Link>>, slides: bool| {
        let constraint = ConstraintFrame { formed, slides, friction: 0.5, ..ConstraintFrame::default() };
        FrameInput { constraints: vec![constraint], ..solver.default_frame() }
    };
    for number in 0..3 {
        let input = input(&solver, (number == 0).then(|| vec![link]), true);
        solver.step(&input, &mut ());
    }
    let saved = solver.save();
    let mut restored =
        Solver::<f32>::restored(sheet(1.0, ClothLists::DEFAULT), 1, &saved).expect("the same model");
    for slides in [false, true] {
        let input = input(&solver, None, slides);
        solver.step(&input, &mut ());
        restored.step(&input, &mut ());
        assert_eq!(solver.state_hash(), restored.state_hash(), "slides: {slides}");
    }
}
