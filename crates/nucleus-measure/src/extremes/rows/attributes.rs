//! Resistances and lengths: nothing, too much, and both at once.

use super::{CostUnit, DRAPED, RUNS, Recovery, Runs, StressCase, at_most, banner, drape};

/// A second banner beside the first, without any resistance.
const LIMP: &str = "
    \"other\": polyPlane(width: 1, height: 1, subdivisions: (16, 16), rotate: (-90, 0, 0), translate: (3, 0, 0)),
    \"limp\": nCloth(inputMesh: \"other\", pointMass: 0.2, damp: 1, stretchResistance: 0, compressionResistance: 0, bendResistance: 0, shearResistance: 0),
    \"rails\": dynamicConstraint(constraintType: transform, components: [\"limp.vtx[0:16]\"]),";

/// All resistances a million.
const RIGID: &str =
    "stretchResistance: 1e6, compressionResistance: 1e6, shearResistance: 1e6, bendResistance: 1e6";

pub static ROWS: [StressCase; 9] = [
    StressCase {
        name: "resistance-0-beside-1e6",
        group: "Resistances",
        what: "a banner whose resistances are all 1e6 beside one where they are 0",
        expect: "The stiff one hangs like a plate. The limp one keeps only the points that are held; the others fall.",
        expectation: Runs {
            scene: || banner("", RIGID).with(LIMP).scene(96),
            cost: CostUnit::Evaluation,
            assertions: &[at_most("99 % strain at any time", 0.05, |timeline, _| {
                timeline.most(|record| record.report.strain_99)
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The half without resistance falls in a heap on itself, whose contacts are most of the cost.",
        ),
    },
    StressCase {
        name: "resistance-0-beside-1e6-classic",
        group: "Resistances",
        what: "the same with `resistanceModel: Classic`: 10,000 sweeps a substep",
        expect: "As above. Every iteration is paid for: a count of 1e6 is held to 10,000 in a substep.",
        expectation: Runs {
            scene: || {
                banner("resistanceModel: Classic", RIGID).with(LIMP).scene(4).replace("(16, 16)", "(8, 8)").replace("0:16", "0:8")
            },
            baseline: || {
                banner("resistanceModel: Classic", "").scene(48).replace("(16, 16)", "(8, 8)").replace("0:16", "0:8")
            },
            cost: CostUnit::Evaluation,
            assertions: &[at_most("99 % strain at any time", 0.05, |timeline, _| {
                timeline.most(|record| record.report.strain_99)
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "rigid-drape",
        group: "Resistances",
        what: "all resistances 1e6 on a sheet that falls on a ball",
        expect: "A plate that tips and slides off the ball, without shaking.",
        expectation: Runs {
            scene: || drape("", RIGID, "").scene(96),
            recovery: Some(Recovery { from: 90, speed: 2.0, strain: 0.05 }),
            ..DRAPED
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "resistance-jumps",
        group: "Resistances",
        what: "resistances are 0 for a second, in which the cloth falls apart, and 20 from then on",
        expect: "The links draw the cloth together, faster than it fell; it comes to rest.",
        expectation: Runs {
            scene: || {
                banner("", "damp: 4, stretchResistance: keys([(0, 0), (24, 0), (25, 20)]), compressionResistance: keys([(0, 0), (24, 0), (25, 10)])")
                    .scene(144)
            },
            recovery: Some(Recovery { from: 120, speed: 0.3, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some("Cloth that lies in a heap on itself has very many pairs, and every one is looked at in every step."),
    },
    StressCase {
        name: "tiny-resistances",
        group: "Resistances",
        what: "resistances keyed down to 1e-30",
        expect: "The cloth falls as if they were 0, and nothing is lost on the way there.",
        expectation: Runs {
            scene: || {
                banner("", "bendResistance: 1e-40, stretchResistance: keys([(0, 20), (24, 1e-30)]), compressionResistance: keys([(0, 10), (24, 1e-30)])")
                    .scene(48)
            },
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "rest-length-0",
        group: "Resistances",
        what: "`restLengthScale` goes to 0 for half a second, and back to 1",
        expect: "The cloth shrinks to its rail and folds out again when its length comes back.",
        expectation: Runs {
            scene: || banner("", "damp: 4, restLengthScale: keys([(12, 1), (24, 0), (36, 0), (48, 1)])").scene(120),
            recovery: Some(Recovery { from: 96, speed: 0.3, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some("Cloth that lies in a heap on itself has very many pairs, and every one is looked at in every step: all of the cloth is in its rail, and the run takes minutes."),
    },
    StressCase {
        name: "rest-length-10",
        group: "Resistances",
        what: "`restLengthScale` jumps to 10 within a frame, and back to 1 after a second",
        expect: "The cloth is thrown open and drawn together again. A jump stores much energy: key such a scale over \
            a few frames.",
        expectation: Runs {
            scene: || banner("", "damp: 4, restLengthScale: keys([(12, 1), (13, 10), (36, 10), (37, 1)])").scene(144),
            recovery: Some(Recovery { from: 120, speed: 0.3, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some("As `rest-length-0`, when it is drawn together."),
    },
    StressCase {
        name: "damp-1e6",
        group: "Resistances",
        what: "`damp` and `stretchDamp` 1e6",
        expect: "The cloth moves like one in honey, and never backwards.",
        expectation: Runs {
            scene: || banner("", "damp: 1e6, stretchDamp: 1e6").scene(96),
            recovery: Some(Recovery { from: 48, speed: 0.2, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "everything-keyed",
        group: "Resistances",
        what: "twenty attributes leap every frame: resistances by a factor of eight, the others from end to end of their sliders",
        expect: "A cloth that twitches and stays whole, and hangs still when the keys end. A resistance that leaps while the \
            cloth is stretched brings energy in, as it would in a spring: key it over some frames.",
        expectation: Runs {
            scene: everything_keyed,
            recovery: Some(Recovery { from: 108, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some("As `rest-length-0`, where it is crumpled."),
    },
];

/// Every attribute leaps, each at a rhythm of its own, until frame 60.
fn everything_keyed() -> super::TestScene {
    let leaps = |low: &str, high: &str, rhythm: i64, after: &str| {
        let key = |frame: i64| format!("({frame}, {})", if frame % rhythm == 0 { high } else { low });
        let keys: Vec<String> = (0..60).map(key).collect();
        format!("keys([{}, (60, {after})])", keys.join(", "))
    };
    let solver = [
        ("gravity", leaps("0", "100", 2, "9.8")),
        ("gravityDirection", leaps("(0, -1, 0)", "(1, 0, 1)", 3, "(0, -1, 0)")),
        ("windSpeed", leaps("0", "50", 5, "0")),
        ("airDensity", leaps("0", "10", 7, "1")),
        ("subSteps", leaps("1", "20", 2, "3")),
        ("maxCollisionIterations", leaps("0", "100", 3, "4")),
        ("timeScale", leaps("0.01", "10", 4, "1")),
        ("evaluations", leaps("24", "384", 3, "96")),
    ];
    let cloth = [
        ("stretchResistance", leaps("5", "40", 5, "20")),
        ("compressionResistance", leaps("2", "20", 3, "10")),
        ("bendResistance", leaps("0", "10", 2, "0.1")),
        ("shearResistance", leaps("0", "20", 7, "0")),
        ("stretchDamp", leaps("0", "10", 4, "0.1")),
        ("damp:", leaps("0", "10", 3, "4")),
        ("drag", leaps("0", "2", 2, "0.05")),
        ("tangentialDrag", leaps("0", "1", 3, "0")),
        ("lift", leaps("0", "2", 5, "0.05")),
        ("restLengthScale", leaps("0.9", "1.1", 11, "1")),
        ("thickness", leaps("0", "1", 6, "0.01")),
        ("friction", leaps("0", "1", 4, "0.1")),
    ];
    let text = |rows: &[(&str, String)]| {
        let rows: Vec<String> =
            rows.iter().map(|(name, keys)| format!("{}: {keys}", name.trim_end_matches(':'))).collect();
        rows.join(", ")
    };
    banner(&text(&solver), &text(&cloth)).scene(144)
}
