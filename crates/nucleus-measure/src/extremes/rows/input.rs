//! What no scene can say and a program can: numbers that are none, in what a frame brings.

use nalgebra::Vector3;
use nucleus_core::FrameInput;

use super::{NO_UNRESOLVED_PAIRS, RUNS, Recovery, Runs, StressCase, at_least, at_most, banner, drape};

/// A ball under a sheet that is carried slowly, so that every frame brings where its points are.
const CARRIED: &str = "translate: keys([(0, (0, 0.3, 0)), (96, (0.1, 0.3, 0), linear)])";

fn carried() -> super::TestScene {
    drape("", "", CARRIED).scene(96)
}

const RESTS: Option<Recovery> = Some(Recovery { from: 90, speed: 0.4, strain: 0.05 });

/// How many things were refused.
macro_rules! refused {
    ($count:expr) => {
        at_least("inputs refused", $count, |timeline, _| {
            timeline.sum(|record| record.report.sanitized.count) as f64
        })
    };
}

/// How many more than these there were.
macro_rules! no_more_refused {
    ($count:expr) => {
        at_most("inputs refused ", $count, |timeline, _| {
            timeline.sum(|record| record.report.sanitized.count) as f64
        })
    };
}

pub static ROWS: [StressCase; 7] = [
    StressCase {
        name: "nan-in-a-collider",
        group: "Input",
        what: "one point of a moving ball is not a number in frame 10",
        expect: "The point stays where it was for that frame, and is named; the sheet never knows.",
        expectation: Runs {
            scene: || carried().inject(|frame, input| at_frame_10(frame, || collider_point(input, f64::NAN))),
            baseline: carried,
            recovery: RESTS,
            assertions: &[
                NO_UNRESOLVED_PAIRS,
                refused!(1.0),
                no_more_refused!(1.0),
                at_most("farthest from the run without it (m)", 0.05, |timeline, baseline| {
                    timeline.farthest_from(baseline)
                }),
            ],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "infinity-in-a-collider",
        group: "Input",
        what: "one point of a moving ball is infinitely far away in frame 10",
        expect: "As above.",
        expectation: Runs {
            scene: || {
                carried().inject(|frame, input| at_frame_10(frame, || collider_point(input, f64::INFINITY)))
            },
            baseline: carried,
            recovery: RESTS,
            assertions: &[NO_UNRESOLVED_PAIRS, refused!(1.0), no_more_refused!(1.0)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-all-of-a-collider",
        group: "Input",
        what: "every point of a moving ball is not a number from frame 10 to frame 20",
        expect: "The ball stands still for ten frames, and goes on to where it should be.",
        expectation: Runs {
            scene: || {
                carried().inject(|frame, input| {
                    if (10..=20).contains(&frame) {
                        let ends = input.colliders.iter_mut().flat_map(|collider| &mut collider.end);
                        ends.for_each(|end| *end = Vector3::repeat(f64::NAN));
                    }
                })
            },
            baseline: carried,
            recovery: RESTS,
            assertions: &[NO_UNRESOLVED_PAIRS, refused!(11.0)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-a-pin",
        group: "Input",
        what: "where a held point goes is not a number in frame 10",
        expect: "The point stays where it was for that frame, and is named.",
        expectation: Runs {
            scene: || {
                banner("", "").scene(96).inject(|frame, input| {
                    at_frame_10(frame, || {
                        if let Some(pin) = input.pins.first_mut() {
                            pin.start.x = f64::NAN;
                            pin.end.y = f64::NAN;
                        }
                    });
                })
            },
            recovery: Some(Recovery { from: 84, speed: 0.2, strain: 0.02 }),
            assertions: &[
                refused!(1.0),
                no_more_refused!(1.0),
                at_most("farthest from the run without it (m)", 1e-9, |timeline, baseline| {
                    timeline.farthest_from(baseline)
                }),
            ],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-gravity-and-wind",
        group: "Input",
        what: "gravity and wind are not numbers in frame 10",
        expect: "They are left out for that frame, and the report says so.",
        expectation: Runs {
            scene: || {
                banner("", "").scene(96).inject(|frame, input| {
                    at_frame_10(frame, || {
                        input.gravity.y = f64::NAN;
                        input.wind.x = f64::NEG_INFINITY;
                    });
                })
            },
            recovery: Some(Recovery { from: 84, speed: 0.2, strain: 0.02 }),
            assertions: &[refused!(1.0), no_more_refused!(1.0)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-attributes",
        group: "Input",
        what: "resistances, thickness, friction and damping are not numbers in frame 10",
        expect: "They take their defaults for that frame, and the report names the cloth.",
        expectation: Runs {
            scene: || {
                drape("", "", "").scene(96).inject(|frame, input| at_frame_10(frame, || attributes(input)))
            },
            baseline: || drape("", "", "").scene(96),
            recovery: RESTS,
            assertions: &[NO_UNRESOLVED_PAIRS, refused!(1.0), no_more_refused!(1.0)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "no-duration",
        group: "Input",
        what: "a frame of no length, one of a negative and one that is no number",
        expect: "They are passed over: all stays as it is.",
        expectation: Runs {
            scene: || {
                banner("", "").scene(96).inject(|frame, input| match frame {
                    10 => input.duration = 0.0,
                    11 => input.duration = -1.0,
                    12 => input.duration = f64::NAN,
                    _ => {}
                })
            },
            recovery: Some(Recovery { from: 84, speed: 0.2, strain: 0.02 }),
            assertions: &[refused!(3.0), no_more_refused!(3.0)],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
];

fn at_frame_10(frame: i64, plant: impl FnOnce()) {
    if frame == 10 {
        plant();
    }
}

/// Point 17 of the first collider.
fn collider_point(input: &mut FrameInput, x: f64) {
    if let Some(point) = input.colliders.first_mut().and_then(|collider| collider.end.get_mut(17)) {
        point.x = x;
    }
}

fn attributes(input: &mut FrameInput) {
    for cloth in &mut input.cloths {
        cloth.stretch_resistance = f64::NAN;
        cloth.thickness = f64::NAN;
        cloth.friction = f64::INFINITY;
        cloth.damp = f64::NAN;
    }
}
