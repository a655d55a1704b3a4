//! Rows that inject faults into the input of frames: NaN, infinity and invalid durations, which a scene file cannot express.

use nalgebra::Vector3;
use nucleus_core::FrameInput;

use super::super::row::{Assertion, Expectation, Recovery, Runs, StressCase};
use super::super::scene::TestScene;
use super::scenes::{BANNER, banner, drape};

/// A sheet on a ball that moves slowly, so that every frame has positions of the collider.
fn carried() -> TestScene {
    drape()
        .replace("translate: (0, 0.3, 0)", "translate: keys([(0, (0, 0.3, 0)), (96, (0.1, 0.3, 0), linear)])")
}

const RESTS: Option<Recovery> = Some(Recovery { from: 90, speed: 0.4, strain: 0.05 });

/// No pair of elements is unresolved.
const NO_UNRESOLVED_PAIRS: Assertion = Assertion::at_most("pairs unresolved", 0.0, |run, _| {
    run.sum(|record| record.report.pairs_unresolved) as f64
});

/// Minimum number of rejected inputs.
macro_rules! refused {
    ($count:expr) => {
        Assertion::at_least("inputs refused", $count, |run, _| {
            run.sum(|record| record.report.sanitized.count) as f64
        })
    };
}

/// Maximum number of rejected inputs.
macro_rules! no_more_refused {
    ($count:expr) => {
        Assertion::at_most("inputs refused ", $count, |run, _| {
            run.sum(|record| record.report.sanitized.count) as f64
        })
    };
}

pub static ROWS: [StressCase; 7] = [
    StressCase {
        name: "nan-in-a-collider",
        group: "Input",
        summary: "one point of a moving ball is NaN in frame 10",
        expected: "The point stays where it was for that frame, and the report names it; the sheet is unaffected.",
        expectation: Expectation::Runs(Runs {
            scene: || carried().inject(|frame, input| at_frame_10(frame, || collider_point(input, f64::NAN))),
            baseline: carried,
            recovery: RESTS,
            assertions: &[
                NO_UNRESOLVED_PAIRS,
                refused!(1.0),
                no_more_refused!(1.0),
                Assertion::at_most("farthest from the run without it (m)", 0.05, |run, baseline| {
                    run.farthest_from(baseline)
                }),
            ],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "infinity-in-a-collider",
        group: "Input",
        summary: "one point of a moving ball is at infinity in frame 10",
        expected: "As above.",
        expectation: Expectation::Runs(Runs {
            scene: || {
                carried().inject(|frame, input| at_frame_10(frame, || collider_point(input, f64::INFINITY)))
            },
            baseline: carried,
            recovery: RESTS,
            assertions: &[NO_UNRESOLVED_PAIRS, refused!(1.0), no_more_refused!(1.0)],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-all-of-a-collider",
        group: "Input",
        summary: "every point of a moving ball is NaN from frame 10 to frame 20",
        expected: "The ball stands still for ten frames, then continues at its keyed position.",
        expectation: Expectation::Runs(Runs {
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
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-a-pin",
        group: "Input",
        summary: "the target of a pinned point is NaN in frame 10",
        expected: "The point stays where it was for that frame, and the report names it.",
        expectation: Expectation::Runs(Runs {
            scene: || {
                banner().inject(|frame, input| {
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
                Assertion::at_most("farthest from the run without it (m)", 1e-9, |run, baseline| {
                    run.farthest_from(baseline)
                }),
            ],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-gravity-and-wind",
        group: "Input",
        summary: "gravity and wind are NaN in frame 10",
        expected: "They are ignored for that frame, and the report says so.",
        expectation: Expectation::Runs(Runs {
            scene: || {
                banner().inject(|frame, input| {
                    at_frame_10(frame, || {
                        input.gravity.y = f64::NAN;
                        input.wind.x = f64::NEG_INFINITY;
                    });
                })
            },
            recovery: Some(Recovery { from: 84, speed: 0.2, strain: 0.02 }),
            assertions: &[refused!(1.0), no_more_refused!(1.0)],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "nan-in-attributes",
        group: "Input",
        summary: "resistances, thickness, friction and damping are NaN in frame 10",
        expected: "They take their defaults for that frame, and the report names the cloth.",
        expectation: Expectation::Runs(Runs {
            scene: || drape().inject(|frame, input| at_frame_10(frame, || attributes(input))),
            baseline: drape,
            recovery: RESTS,
            assertions: &[NO_UNRESOLVED_PAIRS, refused!(1.0), no_more_refused!(1.0)],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "no-duration",
        group: "Input",
        summary: "frames of zero, negative and NaN duration",
        expected: "They are skipped: the state does not change.",
        expectation: Expectation::Runs(Runs {
            scene: || {
                banner().inject(|frame, input| match frame {
                    10 => input.duration = 0.0,
                    11 => input.duration = -1.0,
                    12 => input.duration = f64::NAN,
                    _ => {}
                })
            },
            recovery: Some(Recovery { from: 84, speed: 0.2, strain: 0.02 }),
            assertions: &[refused!(3.0), no_more_refused!(3.0)],
            ..BANNER
        }),
        known_failure: None,
    },
];

fn at_frame_10(frame: i64, inject: impl FnOnce()) {
    if frame == 10 {
        inject();
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
