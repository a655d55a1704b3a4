//! Gravity, wind and forces.

use super::{DRAPED, RUNS, Recovery, Runs, StressCase, at_most, banner, drape, floor};

pub static ROWS: [StressCase; 12] = [
    StressCase {
        name: "gravity-0",
        group: "Forces",
        what: "gravity 0, no wind",
        expect: "Nothing moves at all.",
        expectation: Runs {
            scene: || banner("gravity: 0", "").scene(96),
            assertions: &[at_most("farthest that any point has moved (m)", 0.0, |timeline, _| {
                timeline.farthest_from_start()
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "gravity-1e4",
        group: "Forces",
        what: "gravity 10,000 m/s² for a second, then 9.8",
        expect: "The cloth is stretched as its material gives, by a fifth at the rail, and draws together again.",
        expectation: Runs {
            scene: || banner("gravity: keys([(0, 10000), (24, 10000), (25, 9.8)])", "").scene(120),
            recovery: Some(Recovery { from: 96, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; this one rebounds when the weight is taken off, and meets itself.",
        ),
    },
    StressCase {
        name: "gravity-1e4-classic",
        group: "Forces",
        what: "the same with `resistanceModel: Classic`",
        expect: "Iterations are counts, not a stiffness: the cloth is stretched far, and draws together again.",
        expectation: Runs {
            scene: || {
                banner("resistanceModel: Classic, gravity: keys([(0, 10000), (24, 10000), (25, 9.8)])", "").scene(120)
            },
            baseline: || banner("resistanceModel: Classic", "").scene(96),
            recovery: Some(Recovery { from: 96, speed: 0.5, strain: 0.2 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "As `gravity-1e4`, from a stretch that Classic cloth has no stiffness against.",
        ),
    },
    StressCase {
        name: "gravity-1e4-floor",
        group: "Forces",
        what: "gravity 10,000 m/s² presses a rug on the ground for a second",
        expect: "The rug lies under a thousand times its weight, and rests when that is taken off.",
        expectation: Runs {
            scene: || floor("gravity: keys([(0, 9.8), (24, 10000), (47, 10000), (48, 9.8)])", "").scene(96),
            baseline: || floor("", "").scene(96),
            recovery: Some(Recovery { from: 72, speed: 0.05, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "gravity-1e4-drape",
        group: "Forces",
        what: "gravity 10,000 m/s² presses a sheet over a ball for a second",
        expect: "The sheet is drawn tight over the ball, which holds it; it stays outside.",
        expectation: Runs {
            scene: || drape("gravity: keys([(0, 9.8), (20, 9.8), (21, 10000), (44, 10000), (45, 9.8)])", "", "").scene(116),
            recovery: Some(Recovery { from: 104, speed: 0.3, strain: 0.05 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: Some(
            "The sheet is still sliding down on the ball after two seconds; drawn tight over it, it has many more contacts than the ordinary drape.",
        ),
    },
    StressCase {
        name: "gravity-flips",
        group: "Forces",
        what: "gravity leaps between +1,000 and -1,000 m/s² from frame to frame for two seconds",
        expect: "The cloth is beaten like a drum and hangs still when it stops.",
        expectation: Runs {
            scene: || banner(&flips("gravity", 1000), "").scene(120),
            recovery: Some(Recovery { from: 96, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; here the cloth crumples, and each of its contacts with itself is found and proven in every step.",
        ),
    },
    StressCase {
        name: "wind-1e3",
        group: "Forces",
        what: "wind at 1,000 m/s for two seconds",
        expect: "The cloth streams in the wind, stretched by it, never faster than it; it hangs still again afterwards.",
        expectation: Runs {
            scene: || banner("windDirection: (0.3, 0, 1), windSpeed: keys([(0, 1000), (48, 1000), (49, 0)])", "").scene(120),
            recovery: Some(Recovery { from: 96, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; here the cloth crumples, and each of its contacts with itself is found and proven in every step.",
        ),
    },
    StressCase {
        name: "wind-1e3-light",
        group: "Forces",
        what: "the same on a cloth of 1 g/m² with `drag: 2` and `lift: 2`",
        expect: "It flutters wildly, carried by air that outweighs it, and hangs still again.",
        expectation: Runs {
            scene: || {
                banner(
                    "windDirection: (0.3, 0, 1), windSpeed: keys([(0, 1000), (48, 1000), (49, 0)])",
                    "drag: 2, lift: 2, tangentialDrag: 0.5",
                )
                .scene(120)
                .replace("pointMass: 0.2", "pointMass: 0.001")
            },
            recovery: Some(Recovery { from: 96, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; here the cloth crumples, and each of its contacts with itself is found and proven in every step.",
        ),
    },
    StressCase {
        name: "wind-1e3-one-step",
        group: "Forces",
        what: "wind at 1,000 m/s with one time step a frame",
        expect: "The air never pushes faster than it blows, however long the step. One sweep a frame cannot hold the \
            cloth together in such a storm, and takes half a minute to draw it in again: use more `evaluations`.",
        expectation: Runs {
            scene: || {
                banner(
                    "subSteps: 1, evaluations: 1, windDirection: (0.3, 0, 1), windSpeed: keys([(0, 1000), (48, 1000), (49, 0)])",
                    "damp: 4, drag: 2, lift: 2",
                )
                .scene(96)
            },
            assertions: &[at_most("fastest (m/s)", 1000.0, |timeline, _| timeline.most(|record| record.energy.speed))],
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; here the cloth crumples, and each of its contacts with itself is found and proven in every step.",
        ),
    },
    StressCase {
        name: "wind-flips",
        group: "Forces",
        what: "wind that leaps between +1,000 and -1,000 m/s from frame to frame for two seconds",
        expect: "The cloth is shaken and hangs still when it stops.",
        expectation: Runs {
            scene: || banner(&format!("windDirection: (0.3, 0, 1), {}", flips("windSpeed", 1000)), "").scene(120),
            recovery: Some(Recovery { from: 96, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; here the cloth crumples, and each of its contacts with itself is found and proven in every step.",
        ),
    },
    StressCase {
        name: "air-1e6",
        group: "Forces",
        what: "`airDensity` 1e6: air as dense as a neutron star's crust is not, but near",
        expect: "The cloth hardly moves; drag slows, and never turns anything back.",
        expectation: Runs {
            scene: || banner("airDensity: 1e6", "tangentialDrag: 1").scene(96),
            recovery: Some(Recovery { from: 1, speed: 0.01, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "Why it costs more is not known.",
        ),
    },
    StressCase {
        name: "force-1e3",
        group: "Forces",
        what: "`localForce` of 1,000 N on every point (a million times its weight) for two frames",
        expect: "The cloth is torn to ten times its length, as its resistance allows, and comes back.",
        expectation: Runs {
            scene: || {
                banner("", "damp: 4, localForce: keys([(11, (0, 0, 0)), (12, (1000, 0, 0)), (13, (1000, 0, 0)), (14, (0, 0, 0))])")
                    .scene(144)
            },
            recovery: Some(Recovery { from: 120, speed: 0.5, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The ordinary banner touches nothing; here the cloth crumples, and each of its contacts with itself is found and proven in every step.",
        ),
    },
];

/// Keys that leap between plus and minus a size until frame 48.
fn flips(attribute: &str, size: i64) -> String {
    let key = |frame: i64| format!("({frame}, {})", if frame % 2 == 0 { size } else { -size });
    let keys: Vec<String> = (0..48).map(key).collect();
    let rest = if attribute == "gravity" { "9.8" } else { "0" };
    format!("{attribute}: keys([{}, (48, {rest})])", keys.join(", "))
}
