//! Mass: how light, how heavy, and both side by side.

use super::super::meshes;
use super::{CostUnit, RUNS, Recovery, Runs, StressCase, at_most, banner, hung};

pub static ROWS: [StressCase; 5] = [
    StressCase {
        name: "mass-ratio-in-a-mesh",
        group: "Mass",
        what: "a strip whose last point weighs a million times its first, hung by the light end",
        expect: "The strip hangs and stays whole. The light end carries all the weight over a narrow strip, so it is \
            stretched by what its material gives; sizes of faces within a factor of ten keep the error small.",
        expectation: Runs {
            scene: || {
                hung("graded.obj", "vtx[0:1]", meshes::graded(40, 1e6))
            },
            baseline: || {
                hung("even.obj", "vtx[0:1]", meshes::graded(40, 1.0))
            },
            recovery: Some(Recovery { from: 72, speed: 0.2, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "A sweep hands a load on from point to point, each by its own mass, so that light points cannot hold a heavy one; it \
            takes a solve of the whole cloth at once.",
        ),
    },
    StressCase {
        name: "mass-ratio-100-in-a-mesh",
        group: "Mass",
        what: "a strip whose last point weighs a hundred times its first, hung by the light end",
        expect: "The strip hangs and stays whole.",
        expectation: Runs {
            scene: || {
                hung("graded.obj", "vtx[0:1]", meshes::graded(40, 1e2))
            },
            baseline: || {
                hung("even.obj", "vtx[0:1]", meshes::graded(40, 1.0))
            },
            recovery: Some(Recovery { from: 72, speed: 0.2, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "As above. At even masses the error is a hundredth of this.",
        ),
    },
    StressCase {
        name: "mass-ratio-of-cloths",
        group: "Mass",
        what: "a cloth of 1 mg/m² beside one of 1 t/m²",
        expect: "Both hang. The air carries the light one, since drag is divided by `pointMass`; a ton needs a \
            resistance to match: at the default of 20 it would be stretched to twice its length.",
        expectation: Runs {
            scene: || {
                banner("", "stretchResistance: 20000, compressionResistance: 10000")
                    .with(
                        "\"other\": polyPlane(width: 1, height: 1, subdivisions: (16, 16), rotate: (-90, 0, 0), translate: (3, 0, 0)),
                        \"heavy\": nCloth(inputMesh: \"other\", pointMass: 1000, damp: 1, stretchResistance: 20000, compressionResistance: 10000),
                        \"light\": nCloth(inputMesh: \"third\", pointMass: 0.000001, damp: 1),
                        \"third\": polyPlane(width: 1, height: 1, subdivisions: (16, 16), rotate: (-90, 0, 0), translate: (-3, 0, 0)),
                        \"rails\": dynamicConstraint(constraintType: transform, components: [\"heavy.vtx[0:16]\", \"light.vtx[0:16]\"]),",
                    )
                    .scene(96)
            },
            cost: CostUnit::Evaluation,
            recovery: Some(Recovery { from: 72, speed: 0.2, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "mass-1e-9",
        group: "Mass",
        what: "`pointMass` 1e-9: a microgram per square metre",
        expect: "It hangs in the air as a feather would; nothing shakes.",
        expectation: Runs {
            scene: || banner("", "").scene(96).replace("pointMass: 0.2", "pointMass: 0.000000001"),
            recovery: Some(Recovery { from: 48, speed: 0.2, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some("Cloth that lies in a heap on itself has very many pairs, and every one is looked at in every step."),
    },
    StressCase {
        name: "mass-1e6",
        group: "Mass",
        what: "`pointMass` 1e6, and resistances and air five million times the ordinary to match",
        expect: "The ordinary banner in other units: it moves in the same way.",
        expectation: Runs {
            scene: || {
                banner("", "stretchResistance: 1e8, compressionResistance: 5e7, bendResistance: 5e5, drag: 2.5e5, lift: 2.5e5")
                    .scene(96)
                    .replace("pointMass: 0.2", "pointMass: 1000000")
            },
            recovery: Some(Recovery { from: 72, speed: 0.2, strain: 0.02 }),
            assertions: &[at_most("farthest from the ordinary banner (m)", 0.02, |timeline, baseline| {
                timeline.farthest_from(baseline)
            })],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
];
