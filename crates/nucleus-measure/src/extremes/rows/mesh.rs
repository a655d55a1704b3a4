//! Rows whose mesh is generated: degenerate and extreme meshes.

use super::super::meshes;
use super::super::row::{Assertion, CostUnit, Expectation, Recovery, Runs, StressCase};
use super::super::scene::TestScene;
use super::scenes::BANNER;

/// A scene of `frames` frames.
fn scene(frames: i64, nucleus: &str, nodes: &str) -> TestScene {
    TestScene::new(format!(
        "Scene(\n    time: (start: 0, end: {frames}, fps: 24),\n    nodes: {{\n        \"nucleus1\": nucleus({nucleus}),\n\
         {nodes}    }},\n)\n"
    ))
}

/// A free cloth with an OBJ mesh that falls on the ground 1 m below.
fn free(file: &'static str, mesh: String, cloth: &str, frames: i64) -> TestScene {
    let nodes = format!(
        "        \"sheet\": mesh(file: \"{file}\"),\n        \"cloth\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1{cloth}),\n"
    );
    scene(frames, "usePlane: true, planeOrigin: (0, -1, 0)", &nodes).mesh(file, mesh)
}

/// A cloth with an OBJ mesh in the plane y = 0, turned upright and hung from the points `held`.
fn hung_for(frames: i64, file: &'static str, held: &str, mesh: String) -> TestScene {
    let nodes = format!(
        "        \"sheet\": mesh(file: \"{file}\", rotate: (-90, 0, 0)),\n        \"banner\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, \
         tangentialDrag: 0.5),\n        \"rail\": dynamicConstraint(constraintType: transform, components: [\"banner.{held}\"]),\n"
    );
    scene(frames, "", &nodes).mesh(file, mesh)
}

/// Such a cloth for four seconds.
fn hung(file: &'static str, held: &str, mesh: String) -> TestScene {
    hung_for(96, file, held, mesh)
}

/// The baseline banner from a file.
fn ordinary() -> TestScene {
    hung("grid.obj", "vtx[0:16]", meshes::grid(16))
}

const HANGS: Option<Recovery> = Some(Recovery { from: 84, speed: 0.2, strain: 0.02 });

/// Rows with a mass ratio within a mesh.
pub static MASS: [StressCase; 2] = [
    StressCase {
        name: "mass-ratio-in-a-mesh",
        group: "Mass",
        summary: "a strip whose last vertex has a million times the mass of its first, hung from the light end",
        expected: "The strip hangs and stays whole. The light end carries the whole weight over a narrow strip, so its material stretches; keep the sizes of faces within a factor of ten.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("graded.obj", "vtx[0:1]", meshes::graded(40, 1e6)),
            baseline: || hung("even.obj", "vtx[0:1]", meshes::graded(40, 1.0)),
            recovery: Some(Recovery { from: 72, speed: 0.2, strain: 0.05 }),
            ..BANNER
        }),
        known_failure: Some(
            "Gauss-Seidel sweeps pass a load from vertex to vertex in proportion to inverse mass, so light vertices cannot hold a heavy one. A global solve is needed.",
        ),
    },
    StressCase {
        name: "mass-ratio-100-in-a-mesh",
        group: "Mass",
        summary: "a strip whose last vertex has a hundred times the mass of its first, hung from the light end",
        expected: "The strip hangs and stays whole.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("graded.obj", "vtx[0:1]", meshes::graded(40, 1e2)),
            baseline: || hung("even.obj", "vtx[0:1]", meshes::graded(40, 1.0)),
            recovery: Some(Recovery { from: 72, speed: 0.2, strain: 0.05 }),
            ..BANNER
        }),
        known_failure: Some("As above. With uniform masses the error is a hundredth of this."),
    },
];

pub static ROWS: [StressCase; 17] = [
    StressCase {
        name: "faces-without-area",
        group: "Meshes",
        summary: "faces that name a vertex twice or lie on a line",
        expected: "They are ignored, and a warning says how many.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("flat.obj", "vtx[0:16]", meshes::grid_and_flat_faces(16)),
            baseline: ordinary,
            recovery: HANGS,
            assertions: &[Assertion::at_most(
                "farthest from the sheet without them (m)",
                1e-9,
                |run, baseline| run.farthest_from(baseline),
            )],
            warnings: &["has 3 faces without area, which are left out"],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "slivers",
        group: "Meshes",
        summary: "a row of faces a millionth as high as they are wide",
        expected: "The sheet hangs like the baseline.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("slivers.obj", "vtx[0:16]", meshes::slivers(16)),
            baseline: ordinary,
            recovery: HANGS,
            ..BANNER
        }),
        known_failure: Some(
            "Not investigated; vertices of slivers have almost no mass compared with their neighbours, as in `mass-ratio-in-a-mesh`.",
        ),
    },
    StressCase {
        name: "edges-without-length",
        group: "Meshes",
        summary: "a row of faces with two coincident corners, joined by an edge of zero length",
        expected: "The edge has no direction and no force at first; the sheet hangs whole all the same.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("double.obj", "vtx[0:16]", meshes::edges_of_no_length(16)),
            baseline: ordinary,
            recovery: HANGS,
            ..BANNER
        }),
        known_failure: Some(
            "Not investigated; elements that coincide at rest have no minimum distance and no separating direction.",
        ),
    },
    StressCase {
        name: "doubled-points",
        group: "Meshes",
        summary: "every vertex twice: two sheets in one mesh, not connected, at the same place",
        expected: "Two sheets hang together. Merge the vertices of a mesh that is meant as one sheet.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("two.obj", "vtx[0:16]\", \"banner.vtx[289:305]", meshes::doubled(16)),
            baseline: ordinary,
            cost: CostUnit::Evaluation,
            recovery: HANGS,
            ..BANNER
        }),
        known_failure: Some(
            "Two coincident sheets without connection: every point, edge and face touches its duplicate from the start.",
        ),
    },
    StressCase {
        name: "stray-points",
        group: "Meshes",
        summary: "two vertices that belong to no face",
        expected: "They fall as free points, each with the mean mass, and a warning names the first.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("stray.obj", "vtx[0:16]", meshes::grid_and_stray_points(16)),
            baseline: ordinary,
            assertions: &[
                Assertion::at_most("99 % strain at any time", 0.02, |run, _| {
                    run.max(|record| record.report.strain_99)
                }),
                // 3.3 m/s after a third of a second, in this air.
                Assertion::at_most("lowest point in the end (m)", -11.5, |run, _| run.lowest()),
            ],
            warnings: &["2 points of no face, the first is point 289"],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "faces-twice",
        group: "Meshes",
        summary: "every face twice, the second time with inverted winding",
        expected: "A sheet of twice the mass and twice the stiffness, which hangs like the baseline.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("twice.obj", "vtx[0:16]", meshes::faces_twice(16)),
            baseline: ordinary,
            cost: CostUnit::Evaluation,
            recovery: HANGS,
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "three-faces-on-an-edge",
        group: "Meshes",
        summary: "five sheets that share one edge, like the pages of a book",
        expected: "Each page is hinged to the next; the book falls open and rests.",
        expectation: Expectation::Runs(Runs {
            scene: || hung_for(120, "book.obj", "vtx[0:8]", meshes::book(5, 8)),
            baseline: ordinary,
            cost: CostUnit::Evaluation,
            recovery: Some(Recovery { from: 108, speed: 0.3, strain: 0.02 }),
            ..BANNER
        }),
        known_failure: Some(
            "The pages fall on each other and lie there; the baseline banner has no contacts.",
        ),
    },
    StressCase {
        name: "fan-of-1000",
        group: "Meshes",
        summary: "a thousand triangles round one point, hung by a part of the rim",
        expected: "It hangs. The links of the centre share a vertex, so they are swept serially, and a fan is slower than a grid.",
        expectation: Expectation::Runs(Runs {
            scene: || hung("fan.obj", "vtx[100:400]", meshes::fan(1000)),
            baseline: || hung_for(24, "grid32.obj", "vtx[0:32]", meshes::grid(32)),
            recovery: Some(Recovery { from: 84, speed: 0.5, strain: 0.05 }),
            ..BANNER
        }),
        known_failure: Some(
            "A thousand links of one vertex are swept serially, and the last ones undo the first.",
        ),
    },
    StressCase {
        name: "one-point",
        group: "Meshes",
        summary: "a mesh of one vertex and no face",
        expected: "It falls as a free point and rests on the ground; a warning says that it has no faces.",
        expectation: Expectation::Runs(Runs {
            scene: || free("point.obj", meshes::points(1), ", drag: 0", 96),
            baseline: || free("grid2.obj", meshes::grid(2), "", 96),
            recovery: Some(Recovery { from: 72, speed: 0.01, strain: 0.0 }),
            assertions: &[
                Assertion::at_least("lowest point in the end (m)", -1.0, |run, _| run.lowest()),
                Assertion::at_most("lowest point in the end (m) ", -0.9, |run, _| run.lowest()),
            ],
            warnings: &["has no face, only free points"],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "one-face",
        group: "Meshes",
        summary: "a mesh of one triangle",
        expected: "It falls and rests on the ground.",
        expectation: Expectation::Runs(Runs {
            scene: || free("triangle.obj", meshes::triangle(), "", 96),
            baseline: || free("grid2.obj", meshes::grid(2), "", 96),
            recovery: Some(Recovery { from: 72, speed: 0.01, strain: 0.02 }),
            assertions: &[Assertion::at_least("lowest point in the end (m)", -1.0, |run, _| run.lowest())],
            ..BANNER
        }),
        known_failure: None,
    },
    StressCase {
        name: "no-points",
        group: "Meshes",
        summary: "an empty mesh",
        expected: "An error that names the file.",
        expectation: Expectation::Rejected {
            scene: || free("empty.obj", String::new(), "", 2),
            names: &["empty.obj", "no vert"],
        },
        known_failure: None,
    },
    StressCase {
        name: "no-area",
        group: "Meshes",
        summary: "a mesh all of whose faces lie on a line",
        expected: "An error that names the mesh.",
        expectation: Expectation::Rejected {
            scene: || {
                let text = meshes::points(3) + "f 1 2 3\n";
                free("line.obj", text, "", 2)
            },
            names: &["`sheet`", "no face with an area"],
        },
        known_failure: None,
    },
    StressCase {
        name: "nan-in-a-file",
        group: "Meshes",
        summary: "a mesh file with a coordinate that is not a number",
        expected: "An error that names file, line and column.",
        expectation: Expectation::Rejected {
            scene: || free("nan.obj", format!("{}v 1 nan 2\n", meshes::triangle()), "", 2),
            names: &["nan.obj", "5", "not a finite number"],
        },
        known_failure: None,
    },
    StressCase {
        name: "no-such-point-in-a-file",
        group: "Meshes",
        summary: "a mesh file with a face that names a missing vertex",
        expected: "An error that names file, line and vertex.",
        expectation: Expectation::Rejected {
            scene: || free("short.obj", format!("{}f 1 2 9\n", meshes::triangle()), "", 2),
            names: &["short.obj", "9"],
        },
        known_failure: None,
    },
    StressCase {
        name: "mesh-too-far",
        group: "Meshes",
        summary: "a mesh file with a vertex 1e300 m away",
        expected: "An error that names the sheet, the vertex, and the largest distance.",
        expectation: Expectation::Rejected {
            scene: || free("far.obj", format!("{}v 1e300 0 0\n", meshes::triangle()), "", 2),
            names: &["`sheet`", "point 3", "1e12 m from the origin"],
        },
        known_failure: None,
    },
    StressCase {
        name: "mesh-scaled-to-nothing",
        group: "Meshes",
        summary: "a sheet with `scale: (0, 0, 0)`",
        expected: "An error that names the sheet: its area is zero.",
        expectation: Expectation::Rejected {
            scene: || {
                let scene = free("triangle.obj", meshes::triangle(), "", 2);
                scene.replace("mesh(", "mesh(scale: (0, 0, 0), ")
            },
            names: &["`sheet`", "no area"],
        },
        known_failure: None,
    },
    StressCase {
        name: "mass-0",
        group: "Meshes",
        summary: "`pointMass: 0`",
        expected: "An error that names the attribute. In Maya such a point is pinned: pin it with a constraint instead.",
        expectation: Expectation::Rejected {
            scene: || {
                let scene = free("triangle.obj", meshes::triangle(), "", 2);
                scene.replace("pointMass: 0.2", "pointMass: 0")
            },
            names: &["`pointMass` of `cloth`", "above 0"],
        },
        known_failure: None,
    },
];
