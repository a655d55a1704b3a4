//! Nothing passes through anything, according to an audit that is independent of the solver.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, thread};

use nucleus_graph::checks::Check;
use nucleus_tests::gallery::{program, program_of, scene, scenes};
use nucleus_tests::{Audited, audited};

/// Frames of each scene that this test runs; `nucleus run` audits such a scene to its end.
const FRAMES: usize = 6;

// EVIDENCE: N2.3-2, N2.3-3, N2.3-4  in every scene with such a check, nothing passes through anything
#[test]
fn nothing_passes_through_anything_in_scenes_with_such_a_check() {
    let files = scenes();
    let (next, audits) = (AtomicUsize::new(0), AtomicUsize::new(0));
    // One scene per core is faster than one scene on all cores.
    let audit_all = || {
        while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
            let scene = scene(&fs::read_to_string(file).expect("it is text"), file);
            if scene.checks.iter().any(Check::needs_audit) {
                audited(&program(&scene), FRAMES, 1).assert_clean(&file.display().to_string());
                audits.fetch_add(1, Ordering::Relaxed);
            }
        }
    };
    thread::scope(|scope| {
        (0..thread::available_parallelism().map_or(1, NonZero::get)).for_each(|_| {
            scope.spawn(audit_all);
        });
    });
    let audits = audits.into_inner();
    assert!(audits >= 3, "only {audits} scenes have such a check");
}

/// A ball of radius 0.2 m that hits a free sheet of 1 m² at `speed` m/s.
fn shot(speed: f64, sub_steps: u32, thickness: f64) -> Audited {
    let way = speed / 24.0;
    let program = program_of(&format!(
        r#""n": nucleus(subSteps: {sub_steps}, evaluations: 24),
           "plane": polyPlane(width: 1, height: 1, subdivisions: (12, 12), rotate: (90, 0, 0)),
           "sheet": nCloth(inputMesh: "plane", thickness: {thickness}),
           "sphere": polySphere(radius: 0.2, subdivisions: (16, 10), tx: 0.03, ty: 0.05, tz: keys([(1, {}), (3, {})])),
           "ball": nRigid(inputMesh: "sphere", thickness: {thickness})"#,
        -0.3 - 0.7 * way,
        0.3 + 1.3 * way
    ));
    audited(&program, 6, 1)
}

// EVIDENCE: N2.4-8  a ball does not pass through at any number of substeps
#[test]
fn a_ball_does_not_pass_through_a_sheet_nor_the_sheet_through_itself() {
    // Without thickness it is not covered: at 1 m/s up to six pairs of 450 pass, at some values of `lift`; see
    // `workshop/no_thickness.ron`.
    for (speed, thickness) in [(1.0, 0.01), (1.0, 0.0005), (10.0, 0.01), (100.0, 0.01)] {
        for sub_steps in [1, 3] {
            let name = format!("{speed} m/s, {sub_steps} substeps, thickness {thickness}");
            shot(speed, sub_steps, thickness).assert_clean(&name);
        }
    }
}
