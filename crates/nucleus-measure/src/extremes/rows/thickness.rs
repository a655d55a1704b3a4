//! Thickness: none, and more than there is room for.

use super::{DRAPED, RUNS, Recovery, Runs, StressCase, at_least, drape, floor};

pub static ROWS: [StressCase; 5] = [
    StressCase {
        name: "thickness-0",
        group: "Thickness",
        what: "no thickness on either side",
        expect: "The sheet lies on the ball; a hundredth of a millimetre is kept to tell the sides apart.",
        expectation: Runs {
            scene: || drape("", "thickness: 0", "").scene(96).replace("nRigid(", "nRigid(thickness: 0, "),
            recovery: Some(Recovery { from: 90, speed: 0.3, strain: 0.05 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "thickness-above-a-face",
        group: "Thickness",
        what: "a thickness of 10 cm on faces of 6 cm",
        expect: "The sheet lies 10 cm above the ball, and rests.",
        expectation: Runs {
            scene: || {
                drape("", "thickness: 0.1", "").scene(48).replace("nRigid(", "nRigid(thickness: 0.002, ")
            },
            recovery: Some(Recovery { from: 42, speed: 0.3, strain: 0.05 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: Some(
            "All that is within the thickness is a pair in every step, and where it is more than a face that is many; the \
            sheet is pushed up with some speed.",
        ),
    },
    StressCase {
        name: "thickness-above-the-cloth",
        group: "Thickness",
        what: "a thickness of 2 m on a sheet of 1 m that starts 5 cm above a ball",
        expect: "The sheet is led out of the ball's reach at 1 m/s, without a leap, and rests on it.",
        expectation: Runs {
            scene: || {
                drape("", "thickness: 2", "").scene(144).replace("nRigid(", "nRigid(thickness: 0.002, ")
            },
            // Lifted by 2 m.
            initial_energy: 0.2 * 9.8 * 2.2,
            recovery: Some(Recovery { from: 130, speed: 0.5, strain: 0.1 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: Some("The sheet gains speed while it is led out, and slides off."),
    },
    StressCase {
        name: "thickness-above-the-cloth-floor",
        group: "Thickness",
        what: "a thickness of 2 m on a sheet of 1 m that starts 10 cm above the ground",
        expect: "The sheet is led up at 1 m/s and rests 2 m above the ground.",
        expectation: Runs {
            scene: || floor("", "thickness: 2").scene(96),
            baseline: || floor("", "").scene(96),
            initial_energy: 0.2 * 9.8 * 2.0,
            recovery: Some(Recovery { from: 84, speed: 0.1, strain: 0.02 }),
            assertions: &[at_least("lowest point in the end (m)", 1.99, |timeline, _| timeline.lowest())],
            ..RUNS
        }
        .expectation(),
        known_failure: Some("Every point, edge and face is a pair with every other, in every step."),
    },
    StressCase {
        name: "thickness-leaps",
        group: "Thickness",
        what: "a thickness that leaps between 1 mm and 50 cm from second to second",
        expect: "The sheet is led out when it grows and falls when it shrinks; it never jumps.",
        expectation: Runs {
            scene: || {
                floor("", "thickness: keys([(0, 0.001), (24, 0.001), (25, 0.5), (48, 0.5), (49, 0.001)])")
                    .scene(120)
            },
            baseline: || floor("", "").scene(96),
            initial_energy: 0.2 * 9.8 * 0.5,
            recovery: Some(Recovery { from: 108, speed: 0.1, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "Every time the thickness leaps up, all that is within it is pushed apart at once.",
        ),
    },
];
