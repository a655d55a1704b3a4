//! Meshes that no modeller would keep.

use super::super::meshes;
use super::{
    CostUnit, Expectation, Nodes, RUNS, Recovery, Runs, StressCase, at_least, at_most, from_file, hung,
    nucleus,
};

/// A cloth from a file that falls freely.
fn free(file: &str, cloth: &str) -> Nodes {
    nucleus("usePlane: true, planeOrigin: (0, -1, 0)").with(&format!(
        "\"sheet\": mesh(file: \"{file}\"),
        \"cloth\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, {cloth}),"
    ))
}

/// The ordinary banner from a file.
fn ordinary() -> super::TestScene {
    hung("grid.obj", "vtx[0:16]", meshes::grid(16))
}

const HANGS: Option<Recovery> = Some(Recovery { from: 84, speed: 0.2, strain: 0.02 });

pub static ROWS: [StressCase; 17] = [
    StressCase {
        name: "faces-without-area",
        group: "Meshes",
        what: "faces that name a point twice or lie on a line",
        expect: "They are left out, and a warning says how many.",
        expectation: Runs {
            scene: || hung("flat.obj", "vtx[0:16]", meshes::grid_and_flat_faces(16)),
            baseline: ordinary,
            recovery: HANGS,
            assertions: &[at_most("farthest from the sheet without them (m)", 1e-9, |timeline, baseline| {
                timeline.farthest_from(baseline)
            })],
            warnings: &["has 3 faces without area, which are left out"],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "slivers",
        group: "Meshes",
        what: "a row of faces a millionth as high as they are wide",
        expect: "The sheet hangs like an ordinary one.",
        expectation: Runs {
            scene: || hung("slivers.obj", "vtx[0:16]", meshes::slivers(16)),
            baseline: ordinary,
            recovery: HANGS,
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "Not looked into; points of slivers weigh next to nothing beside their neighbours, as in `mass-ratio-in-a-mesh`.",
        ),
    },
    StressCase {
        name: "edges-without-length",
        group: "Meshes",
        what: "a row of faces with two corners at the same place, joined by an edge of no length",
        expect: "The edge has no direction and holds nothing at first; the sheet hangs whole all the same.",
        expectation: Runs {
            scene: || hung("double.obj", "vtx[0:16]", meshes::edges_of_no_length(16)),
            baseline: ordinary,
            recovery: HANGS,
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "Not looked into; what is in one place at rest may come as near as it likes, and is on no side of its neighbour.",
        ),
    },
    StressCase {
        name: "doubled-points",
        group: "Meshes",
        what: "every point twice: two sheets in one mesh, not joined, at the same place",
        expect: "Two sheets that hang together. A mesh that should be one is to be merged first.",
        expectation: Runs {
            scene: || hung("two.obj", "vtx[0:16]\", \"banner.vtx[289:305]", meshes::doubled(16)),
            baseline: ordinary,
            cost: CostUnit::Evaluation,
            recovery: HANGS,
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "Two sheets in one place, joined by nothing: each point, edge and face touches its twin from the start.",
        ),
    },
    StressCase {
        name: "stray-points",
        group: "Meshes",
        what: "two points that belong to no face",
        expect: "They fall as free points, each with the mass of an average one, and a warning names the first.",
        expectation: Runs {
            scene: || hung("stray.obj", "vtx[0:16]", meshes::grid_and_stray_points(16)),
            baseline: ordinary,
            assertions: &[
                at_most("99 % strain at any time", 0.02, |timeline, _| {
                    timeline.most(|record| record.report.strain_99)
                }),
                // 3.3 m/s after a third of a second, in this air.
                at_most("lowest point in the end (m)", -11.5, |timeline, _| timeline.lowest()),
            ],
            warnings: &["2 points of no face, the first is point 289"],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "faces-twice",
        group: "Meshes",
        what: "every face twice, the second time turned over",
        expect: "A sheet twice as heavy and twice as stiff, which hangs like one.",
        expectation: Runs {
            scene: || hung("twice.obj", "vtx[0:16]", meshes::faces_twice(16)),
            baseline: ordinary,
            cost: CostUnit::Evaluation,
            recovery: HANGS,
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "three-faces-on-an-edge",
        group: "Meshes",
        what: "five sheets that share one edge, like the pages of a book",
        expect: "Each page is hinged to the next; the book falls open and rests.",
        expectation: Runs {
            scene: || {
                from_file("book.obj", "vtx[0:8]", "", "").scene(120).mesh("book.obj", meshes::book(5, 8))
            },
            baseline: ordinary,
            cost: CostUnit::Evaluation,
            recovery: Some(Recovery { from: 108, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "The pages fall on each other and lie there; the ordinary banner touches nothing.",
        ),
    },
    StressCase {
        name: "fan-of-1000",
        group: "Meshes",
        what: "a thousand triangles round one point, hung by a part of the rim",
        expect: "It hangs. All links of the middle are swept one after the other, so a fan is slower than a grid.",
        expectation: Runs {
            scene: || hung("fan.obj", "vtx[100:400]", meshes::fan(1000)),
            baseline: || {
                from_file("grid32.obj", "vtx[0:32]", "", "").scene(24).mesh("grid32.obj", meshes::grid(32))
            },
            recovery: Some(Recovery { from: 84, speed: 0.5, strain: 0.05 }),
            ..RUNS
        }
        .expectation(),
        known_failure: Some(
            "A thousand links of one point are swept one after the other, and the last undo what the first did.",
        ),
    },
    StressCase {
        name: "one-point",
        group: "Meshes",
        what: "a mesh of one point and no face",
        expect: "It falls as a free point and rests on the ground; a warning says that it has no faces.",
        expectation: Runs {
            scene: || free("point.obj", "drag: 0").scene(96).mesh("point.obj", meshes::points(1)),
            baseline: || free("grid2.obj", "").scene(96).mesh("grid2.obj", meshes::grid(2)),
            recovery: Some(Recovery { from: 72, speed: 0.01, strain: 0.0 }),
            assertions: &[
                at_least("lowest point in the end (m)", -1.0, |timeline, _| timeline.lowest()),
                at_most("lowest point in the end (m) ", -0.9, |timeline, _| timeline.lowest()),
            ],
            warnings: &["has no face, only free points"],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "one-face",
        group: "Meshes",
        what: "a mesh of one triangle",
        expect: "It falls and rests on the ground.",
        expectation: Runs {
            scene: || free("triangle.obj", "").scene(96).mesh("triangle.obj", meshes::triangle()),
            baseline: || free("grid2.obj", "").scene(96).mesh("grid2.obj", meshes::grid(2)),
            recovery: Some(Recovery { from: 72, speed: 0.01, strain: 0.02 }),
            assertions: &[at_least("lowest point in the end (m)", -1.0, |timeline, _| timeline.lowest())],
            ..RUNS
        }
        .expectation(),
        known_failure: None,
    },
    StressCase {
        name: "no-points",
        group: "Meshes",
        what: "an empty mesh",
        expect: "An error that names the file.",
        expectation: Expectation::InvalidInput {
            scene: || free("empty.obj", "").scene(2).mesh("empty.obj", String::new()),
            names: &["empty.obj", "no vert"],
        },
        known_failure: None,
    },
    StressCase {
        name: "no-area",
        group: "Meshes",
        what: "a mesh all of whose faces lie on a line",
        expect: "An error that names the mesh.",
        expectation: Expectation::InvalidInput {
            scene: || {
                let text = meshes::points(3) + "f 1 2 3\n";
                free("line.obj", "").scene(2).mesh("line.obj", text)
            },
            names: &["`sheet`", "no face with an area"],
        },
        known_failure: None,
    },
    StressCase {
        name: "nan-in-a-file",
        group: "Meshes",
        what: "a mesh file with a coordinate that is no number",
        expect: "An error that names file, line and column.",
        expectation: Expectation::InvalidInput {
            scene: || {
                free("nan.obj", "").scene(2).mesh("nan.obj", format!("{}v 1 nan 2\n", meshes::triangle()))
            },
            names: &["nan.obj", "5", "not a finite number"],
        },
        known_failure: None,
    },
    StressCase {
        name: "no-such-point-in-a-file",
        group: "Meshes",
        what: "a mesh file with a face that names a point that is not there",
        expect: "An error that names file, line and point.",
        expectation: Expectation::InvalidInput {
            scene: || {
                free("short.obj", "").scene(2).mesh("short.obj", format!("{}f 1 2 9\n", meshes::triangle()))
            },
            names: &["short.obj", "9"],
        },
        known_failure: None,
    },
    StressCase {
        name: "mesh-too-far",
        group: "Meshes",
        what: "a mesh file with a point 1e300 m away",
        expect: "An error that names the sheet, a point of it, and how far is too far.",
        expectation: Expectation::InvalidInput {
            scene: || {
                free("far.obj", "").scene(2).mesh("far.obj", format!("{}v 1e300 0 0\n", meshes::triangle()))
            },
            names: &["`sheet`", "point 3", "1e12 m from the origin"],
        },
        known_failure: None,
    },
    StressCase {
        name: "mesh-scaled-to-nothing",
        group: "Meshes",
        what: "a sheet with `scale: (0, 0, 0)`",
        expect: "An error that names the sheet: it has no area.",
        expectation: Expectation::InvalidInput {
            scene: || {
                let scene = free("triangle.obj", "").scene(2).mesh("triangle.obj", meshes::triangle());
                scene.replace("mesh(", "mesh(scale: (0, 0, 0), ")
            },
            names: &["`sheet`", "no area"],
        },
        known_failure: None,
    },
    StressCase {
        name: "mass-0",
        group: "Meshes",
        what: "`pointMass: 0`",
        expect: "An error that names the attribute. In Maya such a point is pinned: hold it by a constraint instead.",
        expectation: Expectation::InvalidInput {
            scene: || {
                let scene = free("triangle.obj", "").scene(2).mesh("triangle.obj", meshes::triangle());
                scene.replace("pointMass: 0.2", "pointMass: 0")
            },
            names: &["`pointMass` of `cloth`", "above 0"],
        },
        known_failure: None,
    },
];
