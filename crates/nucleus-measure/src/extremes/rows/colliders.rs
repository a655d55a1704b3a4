//! Colliders that leap, fold up, close in, or are where the cloth is.

use super::{DRAPED, RUNS, Recovery, Runs, StressCase, TestScene, at_least, at_most, drape, nucleus};

/// A sheet in the air between two plates that close on it and open again. Heights of the plates' middles.
fn pinch(closed: f64) -> TestScene {
    let keys = |sign: f64| {
        let at = |height: f64| format!("(0, {}, 0)", sign * height);
        format!(
            "keys([(0, {open}), (24, {shut}), (30, {shut}), (54, {open})])",
            open = at(0.4),
            shut = at(closed / 2.0 + 0.1)
        )
    };
    let plate = |name: &str, sign: f64| {
        format!(
            "\"{name}Shape\": polyCube(width: 0.8, height: 0.2, depth: 0.8, subdivisions: (4, 1, 4), translate: {}),
            \"{name}\": nRigid(inputMesh: \"{name}Shape\", thickness: 0.005),",
            keys(sign)
        )
    };
    nucleus("gravity: 1")
        .with(
            "\"sheet\": polyPlane(width: 1, height: 1, subdivisions: (16, 16)),
            \"cloth\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, thickness: 0.005, friction: 0.5),
            \"rail\": dynamicConstraint(constraintType: transform, components: [\"cloth.vtx[0:16]\", \"cloth.vtx[272:288]\"]),",
        )
        .with(&plate("upper", 1.0))
        .with(&plate("lower", -1.0))
        .scene(108)
}

const RESTS: Option<Recovery> = Some(Recovery { from: 96, speed: 0.5, strain: 0.05 });

pub static ROWS: [StressCase; 12] = [
    StressCase {
        name: "collider-teleports",
        group: "Colliders",
        what: "a ball that leaps 20 m away and back under the sheet, each time within a frame",
        expect: "The sheet falls when its ball is gone, and is struck by the ball that comes back at 480 m/s. Nothing \
            passes through it; a leap that is not meant as motion wants `collide` keyed off for that frame.",
        expectation: Runs {
            scene: || {
                drape("", "", "translate: keys([(0, (0, 0.3, 0)), (48, (0, 0.3, 0)), (49, (20, 0.3, 0)), (50, (0, 0.3, 0))])")
                    .scene(240)
            },
            recovery: Some(Recovery { from: 216, speed: 0.5, strain: 0.1 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: Some(
            "Time steps are split, into 256 at most, while the collider leaps past the cloth.",
        ),
    },
    StressCase {
        name: "collider-at-1000-m-s",
        group: "Colliders",
        what: "a ball that goes through a hanging sheet's place at 1,000 m/s",
        expect: "The sheet is struck and stretched; no point goes through the ball.",
        expectation: Runs {
            scene: || {
                drape("gravity: 0", "damp: 4", "translate: keys([(0, (0, -20, 0)), (12, (0, -20, 0)), (13, (0, 21.6, 0))])")
                    .scene(24)
                    .replace("damp: 1, ", "")
                    .replace("usePlane: true", "usePlane: false")
            },
            ..DRAPED
        }
        .expectation(),
        known_failure: Some(
            "Time steps are split, into 256 at most, while the collider is near, and the sheet that it takes along is stretched far.",
        ),
    },
    StressCase {
        name: "collider-spins",
        group: "Colliders",
        what: "a ball under a sheet that turns a thousand times a second",
        expect: "Points of a collider move along straight lines within a frame, so such a spin is not seen as one; the \
            sheet stays outside.",
        expectation: Runs {
            scene: || drape("", "", "rotate: keys([(0, (0, 0, 0)), (96, (0, 1444440, 0), linear)])").scene(96),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "collider-scaled-to-0",
        group: "Colliders",
        what: "a ball under a sheet is scaled to 0 within a second, and back",
        expect: "The sheet sinks with the ball, and is lifted by it again.",
        expectation: Runs {
            scene: || drape("", "", "scale: keys([(0, (1, 1, 1)), (48, (1, 1, 1)), (72, (0, 0, 0)), (84, (0, 0, 0)), (108, (1, 1, 1))])").scene(168),
            recovery: Some(Recovery { from: 156, speed: 0.5, strain: 0.1 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "collider-collapses",
        group: "Colliders",
        what: "a ball under a sheet is scaled to 0 within one frame",
        expect: "The sheet falls to the ground.",
        expectation: Runs {
            scene: || drape("", "", "scale: keys([(0, (1, 1, 1)), (48, (1, 1, 1)), (49, (0, 0, 0))])").scene(120),
            recovery: Some(Recovery { from: 108, speed: 0.5, strain: 0.1 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "collider-turned-inside-out",
        group: "Colliders",
        what: "a ball under a sheet goes through scale 0 to -1",
        expect: "The sheet falls when the ball is a point; when it comes back as its mirror image, it pushes like a ball.",
        expectation: Runs {
            scene: || drape("", "", "scale: keys([(0, (1, 1, 1)), (48, (1, 1, 1)), (96, (-1, -1, -1))])").scene(144),
            recovery: Some(Recovery { from: 132, speed: 0.5, strain: 0.1 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "collider-flattened",
        group: "Colliders",
        what: "a ball under a sheet is pressed flat (`scale: (1, 0, 1)`) and round again",
        expect: "The sheet sinks to the disc, and is lifted again.",
        expectation: Runs {
            scene: || drape("", "", "scale: keys([(0, (1, 1, 1)), (48, (1, 1, 1)), (72, (1, 0, 1)), (84, (1, 0, 1)), (108, (1, 1, 1))])").scene(168),
            recovery: Some(Recovery { from: 156, speed: 0.5, strain: 0.1 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "pinch",
        group: "Colliders",
        what: "two plates close on a sheet to its thickness, and open again",
        expect: "The sheet is held between the plates and comes free.",
        expectation: Runs { scene: || pinch(0.021), baseline: || pinch(0.5), recovery: RESTS, ..DRAPED }
            .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "pinch-to-nothing",
        group: "Colliders",
        what: "two plates close on a sheet with no gap between them, and open again",
        expect: "No place is left for the sheet: it is held on its plane between the two, and comes free on the right side \
            of both.",
        expectation: Runs { scene: || pinch(0.0), baseline: || pinch(0.5), recovery: RESTS, ..DRAPED }
            .expectation(),
        known_failure: Some(
            "Two faces push a point in turn, each out of itself, and the pushes count as motion.",
        ),
    },
    StressCase {
        name: "pinch-overlapping",
        group: "Colliders",
        what: "two plates go 5 cm into one another with a sheet between them, and part again",
        expect: "As above: what cannot be right is held as it is, and is right again when it can be.",
        expectation: Runs { scene: || pinch(-0.05), baseline: || pinch(0.5), recovery: RESTS, ..RUNS }.expectation(),
        known_failure: Some(
            "As above.",
        ),
    },
    StressCase {
        name: "starts-inside",
        group: "Colliders",
        what: "a sheet that starts across the middle of a ball",
        expect: "The part inside is led out slowly, or stays inside and at rest; nothing is thrown.",
        expectation: Runs {
            scene: || drape("", "", "").scene(144).replace("translate: (0, 0.65, 0)", "translate: (0, 0.4, 0)"),
            initial_energy: 0.2 * 9.8 * 0.3,
            recovery: Some(Recovery { from: 132, speed: 0.5, strain: 0.2 }),
            // It begins on both sides.
            assertions: &[],
            ..DRAPED
        }
        .expectation(),
        known_failure: Some(
            "Some points stay inside, and the sheet is stretched over the ball between them and those outside.",
        ),
    },
    StressCase {
        name: "sheet-drawn-to-a-point",
        group: "Colliders",
        what: "every point of a sheet is held and drawn together to a thousandth of its size, then let go",
        expect: "It springs open and comes to rest. At a scale of exactly 0 points would be at one place and have no direction \
            to part in: they would fall as one.",
        expectation: Runs {
            scene: || {
                nucleus("usePlane: true, planeOrigin: (0, -1, 0)")
                    .with(
                        "\"sheet\": polyPlane(width: 1, height: 1, subdivisions: (16, 16)),
                        \"cloth\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1),
                        \"hand\": dynamicConstraint(constraintType: transform, components: [\"cloth.vtx[*]\"],
                        scale: keys([(0, (1, 1, 1)), (12, (0.001, 0.001, 0.001))]), enable: keys([(0, true), (24, false)])),",
                    )
                    .scene(120)
            },
            recovery: Some(Recovery { from: 96, speed: 0.2, strain: 0.02 }),
            assertions: &[
                at_most("frames not finite ", 0.0, |timeline, _| f64::from(!timeline.is_finite())),
                at_least("lowest point in the end (m)", -1.0, |timeline, _| timeline.lowest()),
            ],
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "As `rest-length-0`: all elements are in one place, and each is a pair with each.",
        ),
    },
];
