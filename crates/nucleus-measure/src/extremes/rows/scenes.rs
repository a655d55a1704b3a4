//! Rows whose scene is a file of `scenes/extremes/`, embedded so that an installed program has them.
//!
//! The first lines of a file are comments: the summary, `Expected: ...`, `Rejected: ...` with parts of the error if the scene
//! is no valid one, and `Known failure: ...` if there is one.
//! Bounds of the check language are checks of the scene. Each row adds its baseline and its other bounds.

use super::super::row::{Assertion, CostUnit, Expectation, Runs, StressCase};
use super::super::scene::TestScene;

/// The text of `scenes/extremes/PATH.ron`.
macro_rules! text {
    ($path:literal) => {
        include_str!(concat!("../../../../../scenes/extremes/", $path, ".ron"))
    };
}

/// The scene of `scenes/extremes/PATH.ron`, with OBJ files of its folder.
macro_rules! scene {
    ($path:literal $(, $mesh:literal)*) => {
        TestScene::new(text!($path))
            $(.mesh($mesh, include_str!(concat!("../../../../../scenes/extremes/", $mesh))))*
    };
}

/// The row of a file and of its OBJ files; `Runs` without its scene.
macro_rules! row {
    ($path:literal $(, $mesh:literal)*; $runs:expr) => {{
        const BOUNDS: Runs = $runs;
        const RUNS: Runs = Runs { scene: || scene!($path $(, $mesh)*), ..BOUNDS };
        from_text($path, text!($path), Expectation::Runs(RUNS))
    }};
}

/// The row of a file that is rejected, with its OBJ file.
macro_rules! rejected {
    ($path:literal, $mesh:literal) => {
        from_text(
            $path,
            text!($path),
            Expectation::Rejected {
                scene: || scene!($path, $mesh),
                message: labelled(text!($path), "Rejected: ").unwrap_or_default(),
            },
        )
    };
}

/// The baseline banner.
pub(super) fn banner() -> TestScene {
    scene!("baseline/banner")
}

/// The baseline sheet on a ball.
pub(super) fn drape() -> TestScene {
    scene!("baseline/drape")
}

/// A scene compared with the baseline banner.
pub(super) const BANNER: Runs = Runs {
    scene: banner,
    baseline: banner,
    cost: CostUnit::Frame,
    initial_energy: 0.0,
    recovery: None,
    assertions: &[],
    warnings: &[],
};

/// A scene compared with the baseline sheet on a ball.
const DRAPE: Runs = Runs { baseline: drape, ..BANNER };
const CLASSIC: Runs = Runs { baseline: || scene!("baseline/banner-classic"), ..BANNER };
const RUG: Runs = Runs { baseline: || scene!("baseline/rug"), ..BANNER };
const PINCH: Runs = Runs { baseline: || scene!("baseline/pinch"), ..BANNER };
const SHORT_BANNER: Runs = Runs { baseline: || scene!("baseline/banner-48"), ..BANNER };
const SMALL_SHORT_BANNER: Runs =
    Runs { baseline: || scene!("baseline/small-banner-48"), cost: CostUnit::Step, ..BANNER };

const STRIP: Runs = Runs { baseline: || scene!("baseline/even-strip", "baseline/even.obj"), ..BANNER };
const FROM_A_FILE: Runs =
    Runs { baseline: || scene!("baseline/banner-from-a-file", "baseline/grid.obj"), ..BANNER };
const LARGER_MESH: Runs = Runs { cost: CostUnit::Evaluation, ..FROM_A_FILE };
const FREE: Runs = Runs { baseline: || scene!("baseline/small-free-sheet", "baseline/grid2.obj"), ..BANNER };

/// Weight in N of a sheet of 1 m².
const WEIGHT: f64 = 0.2 * 9.8;

/// Fall in metres after a time in seconds, by gravity of 9.8 m/s².
const fn fall(seconds: f64) -> f64 {
    0.5 * 9.8 * seconds * seconds
}

/// All rows of files, group by group.
pub(super) fn rows() -> Vec<StressCase> {
    [material(), time(), scale(), forces(), thickness(), meshes(), colliders()].concat()
}

fn material() -> Vec<StressCase> {
    vec![
        row!("mass/mass-ratio-in-a-mesh", "mass/graded-1e6.obj"; STRIP),
        row!("mass/mass-ratio-1e4-in-a-mesh", "mass/graded-1e4.obj"; STRIP),
        row!("mass/mass-ratio-100-in-a-mesh", "mass/graded-1e2.obj"; STRIP),
        row!("mass/mass-ratio-of-cloths"; Runs { cost: CostUnit::Evaluation, ..BANNER }),
        row!("mass/mass-1e-9"; BANNER),
        row!("mass/mass-1e6";
            Runs {
                assertions: &[Assertion::at_most(
                    "farthest from the ordinary banner (m)",
                    0.02,
                    |run, banner| { run.farthest_from(banner) }
                )],
                ..BANNER
            }
        ),
        row!("resistances/resistance-0-beside-1e6"; Runs { cost: CostUnit::Evaluation, ..BANNER }),
        row!("resistances/resistance-0-beside-1e6-classic";
            Runs {
                baseline: || scene!("baseline/small-banner-classic-48"),
                cost: CostUnit::Evaluation,
                ..BANNER
            }
        ),
        row!("resistances/rigid-drape"; DRAPE),
        row!("resistances/resistance-jumps"; BANNER),
        row!("resistances/tiny-resistances"; BANNER),
        row!("resistances/rest-length-0"; BANNER),
        row!("resistances/rest-length-10"; BANNER),
        row!("resistances/damp-1e6"; BANNER),
        row!("resistances/everything-keyed"; BANNER),
    ]
}

fn time() -> Vec<StressCase> {
    vec![
        row!("time/one-step-a-frame"; BANNER),
        row!("time/one-step-a-frame-classic"; CLASSIC),
        row!("time/one-step-a-frame-contact"; DRAPE),
        row!("time/substeps-1000";
            Runs {
                assertions: &[Assertion::at_most(
                    "farthest from the run of 3 substeps (m)",
                    0.01,
                    |run, banner| { run.farthest_from(banner) }
                )],
                ..SMALL_SHORT_BANNER
            }
        ),
        row!("time/substeps-1000-classic";
            Runs {
                baseline: || scene!("baseline/small-banner-classic"),
                cost: CostUnit::Step,
                ..BANNER
            }
        ),
        row!("time/substeps-100000";
            Runs {
                baseline: || scene!("baseline/small-rug-3"),
                cost: CostUnit::Step,
                assertions: &[Assertion::at_most(
                    "farthest from the run of 3 substeps (m)",
                    1e-3,
                    |run, rug| { run.farthest_from(rug) }
                )],
                ..BANNER
            }
        ),
        row!("time/time-scale-1e-4"; Runs { cost: CostUnit::Step, ..BANNER }),
        row!("time/time-scale-1e4";
            Runs {
                baseline: || scene!("baseline/small-banner"),
                cost: CostUnit::Step,
                ..BANNER
            }
        ),
        row!("time/a-million-frames-a-second";
            Runs {
                cost: CostUnit::Step,
                assertions: &[
                    Assertion::at_most(
                        "farthest it has fallen (m)",
                        0.5 * 9.8 * 48e-6 * 49e-6 * 1.01,
                        |run, _| { run.farthest_from_start() }
                    ),
                    Assertion::at_least("farthest it has fallen (m) ", fall(48e-6) * 0.99, |run, _| {
                        run.farthest_from_start()
                    }),
                ],
                ..BANNER
            }
        ),
        row!("time/rest-for-1000-frames";
            Runs {
                baseline: || scene!("baseline/small-rug"),
                assertions: &[Assertion::at_most(
                    "farthest from where it lay after 4 s (m)",
                    1e-3,
                    |run, rug| { run.farthest_from(rug) }
                )],
                ..BANNER
            }
        ),
    ]
}

fn scale() -> Vec<StressCase> {
    vec![
        row!("scale/size-1e-3"; BANNER),
        row!("scale/size-1e-3-and-evaluations"; Runs { cost: CostUnit::Step, ..BANNER }),
        row!("scale/size-1e5";
            Runs {
                assertions: &[Assertion::at_most("farthest it has fallen (m)", fall(4.05), |run, _| {
                    run.farthest_from_start()
                })],
                ..BANNER
            }
        ),
        row!("scale/space-scale-1e-6"; BANNER),
        row!("scale/space-scale-1e6";
            Runs { baseline: || scene!("baseline/drape-24"), ..BANNER }
        ),
        row!("scale/drape-1e-3"; DRAPE),
        row!("scale/10-km-away";
            Runs {
                assertions: &[Assertion::at_most(
                    "farthest from the run at the origin (m)",
                    1e-3,
                    |run, banner| { run.farthest_moves_from(banner) }
                )],
                ..SHORT_BANNER
            }
        ),
        row!("scale/1000-km-away";
            Runs {
                assertions: &[Assertion::at_most(
                    "farthest from the run at the origin (m)",
                    1e-2,
                    |run, banner| { run.farthest_moves_from(banner) }
                )],
                ..SHORT_BANNER
            }
        ),
        row!("scale/drape-10-km-away"; DRAPE),
    ]
}

fn forces() -> Vec<StressCase> {
    vec![
        row!("forces/gravity-0";
            Runs {
                assertions: &[Assertion::at_most("farthest that any point has moved (m)", 0.0, |run, _| {
                    run.farthest_from_start()
                })],
                ..BANNER
            }
        ),
        row!("forces/gravity-1e4"; BANNER),
        row!("forces/gravity-1e4-classic"; CLASSIC),
        row!("forces/gravity-1e4-floor"; RUG),
        row!("forces/gravity-1e4-drape"; DRAPE),
        row!("forces/gravity-flips"; BANNER),
        row!("forces/wind-1e3"; BANNER),
        row!("forces/wind-1e3-light"; BANNER),
        row!("forces/wind-1e3-one-step";
            Runs {
                assertions: &[Assertion::at_most("fastest (m/s)", 1000.0, |run, _| {
                    run.max(|record| record.energy.speed)
                })],
                ..BANNER
            }
        ),
        row!("forces/wind-flips"; BANNER),
        row!("forces/air-1e6"; BANNER),
        row!("forces/force-1e3"; BANNER),
    ]
}

fn thickness() -> Vec<StressCase> {
    vec![
        row!("thickness/thickness-0"; DRAPE),
        // It starts 5 cm above the ball, and depenetration lifts it to 10 cm.
        row!("thickness/thickness-above-a-face"; Runs { initial_energy: WEIGHT * 0.05, ..DRAPE }),
        // Depenetration lifts it by 2 m.
        row!("thickness/thickness-above-the-cloth";
            Runs {
                initial_energy: WEIGHT * 2.2,
                warnings: &["makes it wider than all objects together"],
                ..DRAPE
            }
        ),
        row!("thickness/thickness-above-the-cloth-floor";
            Runs {
                initial_energy: WEIGHT * 2.0,
                warnings: &["makes it wider than all objects together"],
                assertions: &[Assertion::at_least("lowest point in the end (m)", 1.99, |run, _| run.lowest())],
                ..RUG
            }
        ),
        row!("thickness/thickness-leaps"; Runs { initial_energy: WEIGHT * 0.5, ..RUG }),
    ]
}

fn meshes() -> Vec<StressCase> {
    const ABOVE_GROUND: Assertion =
        Assertion::at_least("lowest point in the end (m)", -1.0, |run, _| run.lowest());
    vec![
        row!(
            "meshes/faces-without-area", "meshes/flat.obj";
            Runs {
                assertions: &[Assertion::at_most(
                    "farthest from the sheet without them (m)",
                    1e-9,
                    |run, baseline| run.farthest_from(baseline),
                )],
                warnings: &["has 3 faces without area, which are left out"],
                ..FROM_A_FILE
            }
        ),
        row!(
            "meshes/slivers", "meshes/slivers.obj";
            Runs {
                assertions: &[
                    Assertion::at_most("lowest point below that of the ordinary banner (m)", 0.02, |run, banner| {
                        banner.lowest() - run.lowest()
                    }),
                    Assertion::at_most("speed from frame 84 on (m/s)", 0.2, |run, _| {
                        run.max_from(84, |record| record.energy.speed)
                    }),
                ],
                ..FROM_A_FILE
            }
        ),
        row!("meshes/edges-without-length", "meshes/double.obj"; FROM_A_FILE),
        row!("meshes/doubled-points", "meshes/two.obj"; LARGER_MESH),
        row!(
            "meshes/stray-points", "meshes/stray.obj";
            Runs {
                // 3.3 m/s after a third of a second, in this air.
                assertions: &[Assertion::at_most("lowest point in the end (m)", -11.5, |run, _| run.lowest())],
                warnings: &["2 points of no face, the first is point 289"],
                ..FROM_A_FILE
            }
        ),
        row!("meshes/faces-twice", "meshes/twice.obj"; LARGER_MESH),
        row!("meshes/three-faces-on-an-edge", "meshes/book.obj"; LARGER_MESH),
        row!(
            "meshes/fan-of-1000", "meshes/fan.obj";
            Runs {
                baseline: || scene!("baseline/banner-from-a-file-24", "baseline/grid32.obj"),
                ..BANNER
            }
        ),
        row!(
            "meshes/one-point", "meshes/point.obj";
            Runs {
                assertions: &[
                    ABOVE_GROUND,
                    Assertion::at_most("lowest point in the end (m) ", -0.9, |run, _| run.lowest()),
                ],
                warnings: &["has no face, only free points"],
                ..FREE
            }
        ),
        row!("meshes/one-face", "meshes/triangle.obj"; Runs { assertions: &[ABOVE_GROUND], ..FREE }),
        rejected!("meshes/no-points", "meshes/empty.obj"),
        rejected!("meshes/no-area", "meshes/line.obj"),
        rejected!("meshes/nan-in-a-file", "meshes/nan.obj"),
        rejected!("meshes/no-such-point-in-a-file", "meshes/short.obj"),
        rejected!("meshes/mesh-too-far", "meshes/far.obj"),
        rejected!("meshes/mesh-scaled-to-nothing", "meshes/triangle.obj"),
        rejected!("meshes/mass-0", "meshes/triangle.obj"),
    ]
}

fn colliders() -> Vec<StressCase> {
    // From frame 36 on there is room between the plates, and the sheet is where it began.
    const FREE_AGAIN: [Assertion; 2] = [
        Assertion::at_most("pairs unresolved from frame 36 on", 0.0, |run, _| {
            run.max_from(36, |record| record.report.pairs_unresolved as f64)
        }),
        Assertion::at_most("farthest from the start in the end (m)", 0.05, |run, _| {
            run.farthest_from_start()
        }),
    ];
    vec![
        row!("colliders/collider-teleports"; DRAPE),
        row!("colliders/collider-at-1000-m-s"; DRAPE),
        row!("colliders/collider-spins"; DRAPE),
        row!("colliders/collider-scaled-to-0"; DRAPE),
        row!("colliders/collider-collapses"; DRAPE),
        row!("colliders/collider-turned-inside-out"; DRAPE),
        row!("colliders/collider-flattened"; DRAPE),
        row!("colliders/pinch"; PINCH),
        row!("colliders/pinch-to-nothing"; Runs { assertions: &FREE_AGAIN, ..PINCH }),
        row!("colliders/pinch-overlapping"; Runs { assertions: &FREE_AGAIN, ..PINCH }),
        // It starts on both sides of the ball, and depenetration lifts it.
        row!("colliders/starts-inside"; Runs { initial_energy: WEIGHT * 0.3, ..DRAPE }),
        row!("colliders/sheet-drawn-to-a-point";
            Runs {
                assertions: &[
                    Assertion::at_most("frames not finite ", 0.0, |run, _| f64::from(!run.is_finite())),
                    Assertion::at_least("lowest point in the end (m)", -1.0, |run, _| run.lowest()),
                ],
                ..BANNER
            }
        ),
    ]
}

/// The row of a file at `GROUP/NAME`.
fn from_text(path: &'static str, text: &'static str, expectation: Expectation) -> StressCase {
    let (folder, name) = path.split_once('/').unwrap_or(("", path));
    StressCase {
        name,
        group: title(folder),
        summary: comments(text).next().unwrap_or_default(),
        expected: labelled(text, "Expected: ").unwrap_or_default(),
        expectation,
        known_failure: labelled(text, "Known failure: "),
    }
}

/// The comments at the head of a scene.
fn comments(text: &'static str) -> impl Iterator<Item = &'static str> {
    text.lines().map_while(|line| line.strip_prefix("// "))
}

/// The comment with this label.
fn labelled(text: &'static str, label: &str) -> Option<&'static str> {
    comments(text).find_map(|line| line.strip_prefix(label))
}

/// The heading of a folder.
fn title(folder: &str) -> &'static str {
    match folder {
        "mass" => "Mass",
        "meshes" => "Meshes",
        "resistances" => "Resistances",
        "time" => "Time",
        "scale" => "Scale",
        "forces" => "Forces",
        "thickness" => "Thickness",
        "colliders" => "Colliders",
        _ => "Other",
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn every_file_of_the_folder_is_a_row_or_a_baseline() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/extremes");
        let mut files = BTreeSet::new();
        for group in fs::read_dir(folder).expect("the folder exists").map(|entry| entry.expect("readable")) {
            if group.file_name() == "baseline" {
                continue;
            }
            for file in fs::read_dir(group.path()).expect("a folder").map(|entry| entry.expect("readable")) {
                let path = file.path();
                if path.extension().is_some_and(|end| end == "ron") {
                    files.insert(path.file_stem().expect("a name").to_string_lossy().into_owned());
                }
            }
        }
        let rows = rows();
        assert!(rows.iter().all(|row| row.group != "Other"));
        assert_eq!(files, rows.iter().map(|row| row.name.to_owned()).collect());
    }
}
