//! Time: one substep, very many, and time that hardly passes or flies.

use super::{
    CostUnit, DRAPED, RUNS, Recovery, Runs, StressCase, TestScene, at_least, at_most, banner, drape, floor,
};

/// The small banner on which time is cheap.
fn small(scene: TestScene) -> TestScene {
    scene.replace("(16, 16)", "(8, 8)").replace("0:16", "0:8")
}

pub static ROWS: [StressCase; 10] = [
    StressCase {
        name: "one-step-a-frame",
        group: "Time",
        what: "`subSteps: 1`, `evaluations: 1`: one time step of 1/24 s, and a rail that leaps 10 m within a frame",
        expect: "The cloth follows like rubber, since one sweep a frame is hardly a solve, and should come to rest at its length.",
        expectation: Runs {
            scene: || {
                banner("subSteps: 1, evaluations: 1", "damp: 4").scene(240).replace(
                    "transform, ",
                    "transform, translate: keys([(24, (0, 0, 0)), (25, (10, 0, 0))]), ",
                )
            },
            recovery: Some(Recovery { from: 216, speed: 0.3, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "One sweep a frame does not hold the cloth apart from itself and together at once.",
        ),
    },
    StressCase {
        name: "one-step-a-frame-classic",
        group: "Time",
        what: "`resistanceModel: Classic`, `subSteps: 1`, and a rail that leaps 10 m within a frame",
        expect: "The cloth is stretched by the leap and draws together.",
        expectation: Runs {
            scene: || {
                banner("resistanceModel: Classic, subSteps: 1", "damp: 4").scene(144).replace(
                    "transform, ",
                    "transform, translate: keys([(24, (0, 0, 0)), (25, (10, 0, 0))]), ",
                )
            },
            baseline: || banner("resistanceModel: Classic", "").scene(96),
            recovery: Some(Recovery { from: 120, speed: 0.3, strain: 0.5 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some("As above."),
    },
    StressCase {
        name: "one-step-a-frame-contact",
        group: "Time",
        what: "one time step a frame, and a ball that crosses the cloth at 240 m/s",
        expect: "The ball takes the cloth along or is gone past its rim; no point goes through it.",
        expectation: Runs {
            scene: || {
                drape(
                    "subSteps: 1, evaluations: 1, gravity: 0",
                    "",
                    "translate: keys([(0, (0, -20, 0)), (8, (0, 60, 0), linear)])",
                )
                .scene(24)
                .replace("usePlane: true", "usePlane: false")
            },
            ..DRAPED
        }
        .expectation(),
        known_failure: Some("A step of 10 m has a pair for everything within it."),
    },
    StressCase {
        name: "substeps-1000",
        group: "Time",
        what: "1,000 substeps a frame in single precision",
        expect: "The cloth hangs where 3 substeps leave it: steps of 42 µs are not lost in rounding.",
        expectation: Runs {
            scene: || small(banner("subSteps: 1000", "").scene(48)),
            baseline: || small(banner("", "").scene(48)),
            cost: CostUnit::Step,
            assertions: &[at_most("farthest from the run of 3 substeps (m)", 0.01, |timeline, baseline| {
                timeline.farthest_from(baseline)
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "substeps-1000-classic",
        group: "Time",
        what: "1,000 substeps a frame with `resistanceModel: Classic`",
        expect: "Counts are shared out, so each substep does a fiftieth of a sweep: it hangs, stretched as before.",
        expectation: Runs {
            scene: || small(banner("resistanceModel: Classic, subSteps: 1000", "").scene(48)),
            baseline: || small(banner("resistanceModel: Classic", "").scene(96)),
            cost: CostUnit::Step,
            recovery: Some(Recovery { from: 44, speed: 0.5, strain: 0.2 }),
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "substeps-100000",
        group: "Time",
        what: "the most substeps there can be: 100,000 a frame, each 0.4 µs long",
        expect: "It runs, at the cost of 100,000 steps a frame, and falls as far as it should.",
        expectation: Runs {
            scene: || small(floor("subSteps: 100000", "drag: 0, lift: 0").scene(3)),
            baseline: || small(floor("", "drag: 0, lift: 0").scene(3)),
            cost: CostUnit::Step,
            assertions: &[at_most("farthest from the run of 3 substeps (m)", 1e-3, |timeline, baseline| {
                timeline.farthest_from(baseline)
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "time-scale-1e-4",
        group: "Time",
        what: "`timeScale` at its least, 0.0001, for a second, then 1",
        expect: "Time stands all but still, and goes on as if nothing had been.",
        expectation: Runs {
            scene: || banner("timeScale: keys([(0, 0.0001), (24, 0.0001), (25, 1)])", "").scene(96),
            cost: CostUnit::Step,
            recovery: Some(Recovery { from: 84, speed: 0.2, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "time-scale-1e4",
        group: "Time",
        what: "`timeScale` at its most, 10000, for two frames (14 minutes), then 1",
        expect: "A frame is 417 s and costs as much, up to 10,000 steps a substep. What is left in the end hangs still.",
        expectation: Runs {
            scene: || {
                small(banner("timeScale: keys([(0, 1), (2, 10000), (3, 10000), (4, 1)])", "").scene(48))
            },
            baseline: || small(banner("", "").scene(96)),
            cost: CostUnit::Step,
            recovery: Some(Recovery { from: 36, speed: 0.2, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "Steps of 14 ms leave the cloth stretched by a fifth. When they become short again, the links return that as if it had been put in.",
        ),
    },
    StressCase {
        name: "a-million-frames-a-second",
        group: "Time",
        what: "`fps: 1000000`",
        expect: "A frame is a microsecond; in 48 of them the cloth falls a hundredth of a micrometre.",
        expectation: Runs {
            scene: || banner("", "").scene(48).fps(1e6),
            cost: CostUnit::Step,
            assertions: &[
                at_most("farthest it has fallen (m)", 0.5 * 9.8 * 48e-6 * 49e-6 * 1.01, |timeline, _| {
                    timeline.farthest_from_start()
                }),
                at_least("farthest it has fallen (m) ", 0.5 * 9.8 * 48e-6 * 48e-6 * 0.99, |timeline, _| {
                    timeline.farthest_from_start()
                }),
            ],
            ..RUNS
        }
        .expectation(),
        known_failure: Some("The broad phase runs once a frame, of which each is one step long."),
    },
    StressCase {
        name: "rest-for-1000-frames",
        group: "Time",
        what: "a rug that lies on the ground for 1,000 frames",
        expect: "It lies still: no creep, no jitter.",
        expectation: Runs {
            scene: || small(floor("evaluations: 24", "").scene(1000)),
            baseline: || small(floor("evaluations: 24", "").scene(96)),
            recovery: Some(Recovery { from: 96, speed: 0.01, strain: 0.005 }),
            assertions: &[at_most("farthest from where it lay after 4 s (m)", 1e-3, |timeline, baseline| {
                timeline.farthest_from(baseline)
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
];
