//! Nodes are only an interface to the solver.

use std::fs;
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, FrameInput, Mass, ModelBuilder, Pin,
    PointId, ResistanceModel, Solver,
};
use nucleus_graph::Simulation;
use nucleus_graph::mesh::{poly_plane, poly_sphere};
use nucleus_tests::gallery::{program_of, root};

/// The dependencies of a crate in this workspace.
fn needs(manifest: &Path) -> Vec<String> {
    let text = fs::read_to_string(manifest).expect("every crate has a manifest");
    let (_, after) = text.split_once("[dependencies]").expect("every crate needs something");
    let section = after.split("\n[").next().unwrap_or_default();
    let names = section.lines().filter_map(|line| line.split(['.', ' ', '=']).next());
    names.filter(|name| name.starts_with("nucleus-")).map(str::to_owned).collect()
}

// EVIDENCE: N1.1-2  the solver depends on no other crate of this workspace
#[test]
fn crate_dependencies_have_one_direction_and_the_solver_has_none() {
    let manifest = |name: &str| needs(&root().join("crates").join(name).join("Cargo.toml"));
    assert_eq!(manifest("nucleus-core"), [""; 0]);
    assert_eq!(manifest("nucleus-graph"), ["nucleus-audit", "nucleus-core"]);
    assert_eq!(manifest("nucleus-cache"), ["nucleus-core"]);
    assert!(!manifest("nucleus-view").contains(&"nucleus-graph".to_owned()));
}

/// A sheet over a sphere, pinned at a corner, as nodes.
const NODES: &str = r#"
    "nucleus1": nucleus(subSteps: 2, evaluations: 24, gravity: 9.8, airDensity: 0),
    "sheet": polyPlane(width: 2, height: 2, subdivisions: (12, 12), translate: (0, 0.6, 0)),
    "cloth": nCloth(inputMesh: "sheet", pointMass: 0.5, stretchResistance: 15, compressionResistance: 5,
        bendResistance: 2, stretchDamp: 0, thickness: 0.02, friction: 0.3, selfCollide: false),
    "pin": dynamicConstraint(constraintType: transform, components: ["cloth.vtx[0]"]),
    "sphere": polySphere(radius: 0.5),
    "ball": nRigid(inputMesh: "sphere", thickness: 0.01, friction: 0.2)"#;

/// The same model, built without nodes.
fn by_hand(frames: u32) -> u64 {
    let mut sheet = poly_plane(2.0, 2.0, (12, 12)).expect("it has a size");
    sheet.positions.iter_mut().for_each(|position| position.y += 0.6);
    let corner = sheet.positions[0];
    let lists =
        ClothLists { shear: false, air: false, damp: false, self_collision: false, ..ClothLists::DEFAULT };
    let mut builder = ModelBuilder::new();
    let cloth = Cloth::new(sheet, Mass::PerArea(0.5), lists);
    builder.cloth(cloth).expect("it is a sound mesh");
    let sphere = poly_sphere(0.5, (20, 20)).expect("it has a size");
    builder.collider(Collider { surface: sphere }).expect("it is a sound mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let input = FrameInput {
        duration: 1.0 / 24.0,
        substeps: 2,
        collision_iterations: 4.0,
        resistance: ResistanceModel::Physical { evaluations: 24.0 },
        gravity: Vector3::new(0.0, -9.8, 0.0),
        wind: Vector3::zeros(),
        air_density: 0.0,
        plane: None,
        layer_range: 4.0,
        self_collision_iterations: 4.0,
        cloths: vec![ClothFrame {
            stretch_resistance: 15.0,
            compression_resistance: 5.0,
            bend_resistance: 2.0,
            stretch_damp: 0.0,
            thickness: 0.02,
            friction: 0.3,
            ..ClothFrame::default()
        }],
        colliders: vec![ColliderFrame {
            collide: true,
            thickness: 0.01,
            friction: 0.2,
            ..ColliderFrame::default()
        }],
        pins: vec![Pin { cloth: ClothId(0), point: PointId(0), start: corner, end: corner }],
        ..FrameInput::default()
    };
    for _ in 0..frames {
        solver.step(&input, &mut ());
    }
    solver.state_hash()
}

// EVIDENCE: N1.1-2, N1.1-3  nodes set up relations and carry data; doing so without nodes gives the same bits
#[test]
fn a_scene_and_the_same_model_built_without_nodes_give_the_same_bits() {
    let program = program_of(NODES);
    let mut run = Simulation::<f32>::new(&program, 1);
    for _ in 0..20 {
        run.advance(&mut ());
    }
    assert_eq!(run.solver().state_hash(), by_hand(20));
}
