//! Scale and place: a millimetre, a hundred kilometres, and far from the origin.

use super::{
    CostUnit, DRAPED, NO_UNRESOLVED_PAIRS, RUNS, Recovery, Runs, StressCase, TestScene, at_most, banner,
    drape,
};

/// The banner put elsewhere, in scene units.
fn moved(scene: TestScene, by: &str) -> TestScene {
    scene.replace("rotate: (-90, 0, 0)", &format!("rotate: (-90, 0, 0), translate: ({by}, 0, {by})"))
}

/// How much farther than another run a run has its points from where that run began, each taken from its own origin.
macro_rules! apart {
    ($what:literal, $limit:expr) => {
        at_most($what, $limit, |timeline, baseline| timeline.farthest_moves_from(baseline))
    };
}

pub static ROWS: [StressCase; 9] = [
    StressCase {
        name: "size-1e-3",
        group: "Scale",
        what: "a banner of a millimetre (`spaceScale: 0.001`)",
        expect: "It is too light to stretch, and should rest at once. What is small swings fast: a thousandth of the size \
            wants about thirty times the `evaluations` for the same error, as the next row has them.",
        expectation: Runs {
            scene: || banner("spaceScale: 0.001", "").scene(96),
            recovery: Some(Recovery { from: 48, speed: 0.01, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The default of 96 `evaluations` is for cloth of about a metre; that the budget does not follow the size of the \
            scene by itself is not solved.",
        ),
    },
    StressCase {
        name: "size-1e-3-and-evaluations",
        group: "Scale",
        what: "the same with 3,000 `evaluations`, as many in the time that a wave takes through it as the banner of a metre",
        expect: "It is too light to stretch and comes to rest at once.",
        expectation: Runs {
            scene: || banner("spaceScale: 0.001, evaluations: 3000", "").scene(24),
            cost: CostUnit::Step,
            recovery: Some(Recovery { from: 20, speed: 0.01, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The run takes minutes: in each of 3,000 steps a frame the cloth is held apart from itself.",
        ),
    },
    StressCase {
        name: "size-1e5",
        group: "Scale",
        what: "a banner of a hundred kilometres (`spaceScale: 100000`)",
        expect: "In four seconds it falls 78 m, a thousandth of its size: nothing moves that could be seen. Units of \
            100 km are a mistake of `spaceScale` in most scenes.",
        expectation: Runs {
            scene: || banner("spaceScale: 100000", "").scene(96),
            assertions: &[at_most("farthest it has fallen (m)", 0.5 * 9.8 * 4.05 * 4.05, |timeline, _| {
                timeline.farthest_from_start()
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "space-scale-1e-6",
        group: "Scale",
        what: "`spaceScale` at its least, 0.000001: a banner of a micrometre",
        expect: "It is too light to stretch, and should rest at once.",
        expectation: Runs {
            scene: || banner("spaceScale: 0.000001", "").scene(96),
            recovery: Some(Recovery { from: 48, speed: 0.01, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "As `size-1e-3`: no budget of `evaluations` is enough to hold together what swings in microseconds.",
        ),
    },
    StressCase {
        name: "space-scale-1e6",
        group: "Scale",
        what: "`spaceScale` at its most, 1000000, with a ball under a sheet",
        expect: "A sheet of a thousand kilometres that falls for four seconds.",
        expectation: Runs {
            scene: || drape("spaceScale: 1000000", "", "").scene(24),
            baseline: || drape("", "", "").scene(24),
            assertions: &[NO_UNRESOLVED_PAIRS],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "drape-1e-3",
        group: "Scale",
        what: "a drape of a millimetre on a ball of 0.3 mm",
        expect: "It falls on the ball in a hundredth of a second and lies there: too light to bend over it.",
        expectation: Runs {
            scene: || drape("spaceScale: 0.001", "", "").scene(72),
            recovery: Some(Recovery { from: 60, speed: 0.01, strain: 0.05 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: Some(
            "As `size-1e-3`; and contact keeps at least a hundredth of a millimetre, which is much here.",
        ),
    },
    StressCase {
        name: "10-km-away",
        group: "Scale",
        what: "a banner 10 km from the origin in two directions, beside the same at the origin",
        expect: "The same motion: positions are kept as displacements from anchors in double precision.",
        expectation: Runs {
            scene: || moved(banner("", "").scene(48), "10000"),
            baseline: || banner("", "").scene(48),
            assertions: &[apart!("farthest from the run at the origin (m)", 1e-3)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "1000-km-away",
        group: "Scale",
        what: "a banner a thousand kilometres from the origin",
        expect: "The same motion to the millimetre. The cache keeps `f32` positions and shows it in steps of 6 cm: put \
            the origin near the scene.",
        expectation: Runs {
            scene: || moved(banner("", "").scene(48), "1000000"),
            baseline: || banner("", "").scene(48),
            assertions: &[apart!("farthest from the run at the origin (m)", 1e-2)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "drape-10-km-away",
        group: "Scale",
        what: "a drape on a ball 10 km from the origin in two directions",
        expect: "It comes to rest on the ball as it does at the origin.",
        expectation: Runs {
            scene: || {
                drape("", "", "translate: (10000, 0.3, 10000)")
                    .scene(96)
                    .replace("translate: (0, 0.65, 0)", "translate: (10000, 0.65, 10000)")
            },
            recovery: Some(Recovery { from: 90, speed: 0.3, strain: 0.05 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
];
