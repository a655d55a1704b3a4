//! Meshes that no modeller would keep.

use super::super::meshes;
use super::{Cost, Extreme, Nodes, RUNS, Recovery, Runs, Trial, at_least, at_most, from_file, hung, nucleus};

/// A cloth from a file that falls freely.
fn free(file: &str, cloth: &str) -> Nodes {
    nucleus("usePlane: true, planeOrigin: (0, -1, 0)").with(&format!(
        "\"sheet\": mesh(file: \"{file}\"),
        \"cloth\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, {cloth}),"
    ))
}

/// The ordinary banner from a file.
fn ordinary() -> super::Case {
    hung("grid.obj", "vtx[0:16]", meshes::grid(16))
}

const HANGS: Option<Recovery> = Some(Recovery { from: 84, speed: 0.2, strain: 0.02 });

pub static ROWS: [Extreme; 17] = [
    Extreme {
        name: "faces-without-area",
        group: "Meshes",
        what: "faces that name a point twice or lie on a line",
        expect: "They are left out, and a warning says how many.",
        trial: Runs {
            case: || hung("flat.obj", "vtx[0:16]", meshes::grid_and_flat_faces(16)),
            nominal: ordinary,
            recovery: HANGS,
            demands: &[at_most("farthest from the sheet without them (m)", 1e-9, |course, nominal| {
                course.farthest_from(nominal)
            })],
            warns: &["has 3 faces without area, which are left out"],
            ..RUNS
        }
        .trial(),
        fails: None,
    },
    Extreme {
        name: "slivers",
        group: "Meshes",
        what: "a row of faces a millionth as high as they are wide",
        expect: "The sheet hangs like an ordinary one.",
        trial: Runs {
            case: || hung("slivers.obj", "vtx[0:16]", meshes::slivers(16)),
            nominal: ordinary,
            recovery: HANGS,
            ..RUNS
        }
        .trial(),
        fails: Some(
            "Not looked into; points of slivers weigh next to nothing beside their neighbours, as in `mass-ratio-in-a-mesh`.",
        ),
    },
    Extreme {
        name: "edges-without-length",
        group: "Meshes",
        what: "a row of faces with two corners at the same place, joined by an edge of no length",
        expect: "The edge has no direction and holds nothing at first; the sheet hangs whole all the same.",
        trial: Runs {
            case: || hung("double.obj", "vtx[0:16]", meshes::edges_of_no_length(16)),
            nominal: ordinary,
            recovery: HANGS,
            ..RUNS
        }
        .trial(),
        fails: Some(
            "Not looked into; what is in one place at rest may come as near as it likes, and is on no side of its neighbour.",
        ),
    },
    Extreme {
        name: "doubled-points",
        group: "Meshes",
        what: "every point twice: two sheets in one mesh, not joined, at the same place",
        expect: "Two sheets that hang together. A mesh that should be one is to be merged first.",
        trial: Runs {
            case: || hung("two.obj", "vtx[0:16]\", \"banner.vtx[289:305]", meshes::doubled(16)),
            nominal: ordinary,
            cost: Cost::Evaluation,
            recovery: HANGS,
            ..RUNS
        }
        .trial(),
        fails: Some(
            "Two sheets in one place, joined by nothing: each point, edge and face touches its twin from the start.",
        ),
    },
    Extreme {
        name: "stray-points",
        group: "Meshes",
        what: "two points that belong to no face",
        expect: "They fall as free points, each with the mass of an average one, and a warning names the first.",
        trial: Runs {
            case: || hung("stray.obj", "vtx[0:16]", meshes::grid_and_stray_points(16)),
            nominal: ordinary,
            demands: &[
                at_most("99 % strain at any time", 0.02, |course, _| {
                    course.most(|seen| seen.report.strain_99)
                }),
                // 3.3 m/s after a third of a second, in this air.
                at_most("lowest point in the end (m)", -11.5, |course, _| course.lowest()),
            ],
            warns: &["2 points of no face, the first is point 289"],
            ..RUNS
        }
        .trial(),
        fails: None,
    },
    Extreme {
        name: "faces-twice",
        group: "Meshes",
        what: "every face twice, the second time turned over",
        expect: "A sheet twice as heavy and twice as stiff, which hangs like one.",
        trial: Runs {
            case: || hung("twice.obj", "vtx[0:16]", meshes::faces_twice(16)),
            nominal: ordinary,
            cost: Cost::Evaluation,
            recovery: HANGS,
            ..RUNS
        }
        .trial(),
        fails: None,
    },
    Extreme {
        name: "three-faces-on-an-edge",
        group: "Meshes",
        what: "five sheets that share one edge, like the pages of a book",
        expect: "Each page is hinged to the next; the book falls open and rests.",
        trial: Runs {
            case: || {
                from_file("book.obj", "vtx[0:8]", "", "").scene(120).mesh("book.obj", meshes::book(5, 8))
            },
            nominal: ordinary,
            cost: Cost::Evaluation,
            recovery: Some(Recovery { from: 108, speed: 0.3, strain: 0.02 }),
            ..RUNS
        }
        .trial(),
        fails: Some("The pages fall on each other and lie there; the ordinary banner touches nothing."),
    },
    Extreme {
        name: "fan-of-1000",
        group: "Meshes",
        what: "a thousand triangles round one point, hung by a part of the rim",
        expect: "It hangs. All links of the middle are swept one after the other, so a fan is slower than a grid.",
        trial: Runs {
            case: || hung("fan.obj", "vtx[100:400]", meshes::fan(1000)),
            nominal: || {
                from_file("grid32.obj", "vtx[0:32]", "", "").scene(24).mesh("grid32.obj", meshes::grid(32))
            },
            recovery: Some(Recovery { from: 84, speed: 0.5, strain: 0.05 }),
            ..RUNS
        }
        .trial(),
        fails: Some(
            "A thousand links of one point are swept one after the other, and the last undo what the first did.",
        ),
    },
    Extreme {
        name: "one-point",
        group: "Meshes",
        what: "a mesh of one point and no face",
        expect: "It falls as a free point and rests on the ground; a warning says that it has no faces.",
        trial: Runs {
            case: || free("point.obj", "drag: 0").scene(96).mesh("point.obj", meshes::points(1)),
            nominal: || free("grid2.obj", "").scene(96).mesh("grid2.obj", meshes::grid(2)),
            recovery: Some(Recovery { from: 72, speed: 0.01, strain: 0.0 }),
            demands: &[
                at_least("lowest point in the end (m)", -1.0, |course, _| course.lowest()),
                at_most("lowest point in the end (m) ", -0.9, |course, _| course.lowest()),
            ],
            warns: &["has no face, only free points"],
            ..RUNS
        }
        .trial(),
        fails: None,
    },
    Extreme {
        name: "one-face",
        group: "Meshes",
        what: "a mesh of one triangle",
        expect: "It falls and rests on the ground.",
        trial: Runs {
            case: || free("triangle.obj", "").scene(96).mesh("triangle.obj", meshes::triangle()),
            nominal: || free("grid2.obj", "").scene(96).mesh("grid2.obj", meshes::grid(2)),
            recovery: Some(Recovery { from: 72, speed: 0.01, strain: 0.02 }),
            demands: &[at_least("lowest point in the end (m)", -1.0, |course, _| course.lowest())],
            ..RUNS
        }
        .trial(),
        fails: None,
    },
    Extreme {
        name: "no-points",
        group: "Meshes",
        what: "an empty mesh",
        expect: "An error that names the file.",
        trial: Trial::InvalidInput {
            case: || free("empty.obj", "").scene(2).mesh("empty.obj", String::new()),
            names: &["empty.obj", "no vert"],
        },
        fails: None,
    },
    Extreme {
        name: "no-area",
        group: "Meshes",
        what: "a mesh all of whose faces lie on a line",
        expect: "An error that names the mesh.",
        trial: Trial::InvalidInput {
            case: || {
                let text = meshes::points(3) + "f 1 2 3\n";
                free("line.obj", "").scene(2).mesh("line.obj", text)
            },
            names: &["`sheet`", "no face with an area"],
        },
        fails: None,
    },
    Extreme {
        name: "nan-in-a-file",
        group: "Meshes",
        what: "a mesh file with a coordinate that is no number",
        expect: "An error that names file, line and column.",
        trial: Trial::InvalidInput {
            case: || {
                free("nan.obj", "").scene(2).mesh("nan.obj", format!("{}v 1 nan 2\n", meshes::triangle()))
            },
            names: &["nan.obj", "5", "not a finite number"],
        },
        fails: None,
    },
    Extreme {
        name: "no-such-point-in-a-file",
        group: "Meshes",
        what: "a mesh file with a face that names a point that is not there",
        expect: "An error that names file, line and point.",
        trial: Trial::InvalidInput {
            case: || {
                free("short.obj", "").scene(2).mesh("short.obj", format!("{}f 1 2 9\n", meshes::triangle()))
            },
            names: &["short.obj", "9"],
        },
        fails: None,
    },
    Extreme {
        name: "mesh-too-far",
        group: "Meshes",
        what: "a mesh file with a point 1e300 m away",
        expect: "An error that names the sheet, a point of it, and how far is too far.",
        trial: Trial::InvalidInput {
            case: || {
                free("far.obj", "").scene(2).mesh("far.obj", format!("{}v 1e300 0 0\n", meshes::triangle()))
            },
            names: &["`sheet`", "point 3", "1e12 m from the origin"],
        },
        fails: None,
    },
    Extreme {
        name: "mesh-scaled-to-nothing",
        group: "Meshes",
        what: "a sheet with `scale: (0, 0, 0)`",
        expect: "An error that names the sheet: it has no area.",
        trial: Trial::InvalidInput {
            case: || {
                let case = free("triangle.obj", "").scene(2).mesh("triangle.obj", meshes::triangle());
                case.replace("mesh(", "mesh(scale: (0, 0, 0), ")
            },
            names: &["`sheet`", "no area"],
        },
        fails: None,
    },
    Extreme {
        name: "mass-0",
        group: "Meshes",
        what: "`pointMass: 0`",
        expect: "An error that names the attribute. In Maya such a point is pinned: hold it by a constraint instead.",
        trial: Trial::InvalidInput {
            case: || {
                let case = free("triangle.obj", "").scene(2).mesh("triangle.obj", meshes::triangle());
                case.replace("pointMass: 0.2", "pointMass: 0")
            },
            names: &["`pointMass` of `cloth`", "above 0"],
        },
        fails: None,
    },
];
