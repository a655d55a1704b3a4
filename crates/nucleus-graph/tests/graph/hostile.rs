//! Nothing passes through anything unseen: generated scenes, in which cloths, colliders and the ground are thrown at each
//! other, under audit.

use nucleus_graph::Simulation;
use nucleus_graph::audit::Closeness;
use proptest::prelude::*;

use super::scenes::{of_nodes, program};

/// A triple as RON.
type Triple = [f64; 3];

fn triple(most: f64) -> impl Strategy<Value = Triple> {
    proptest::array::uniform3(-most..most)
}

fn ron([x, y, z]: Triple) -> String {
    format!("({x:.3}, {y:.3}, {z:.3})")
}

/// A power of ten.
fn decade(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|exponent| 10f64.powf(exponent))
}

/// A cloth that starts clear of all others.
#[derive(Debug, Clone)]
struct Thrown {
    is_box: bool,
    cells: u32,
    turn: Triple,
    thickness: f64,
    /// Factor on the thickness at frame 5.
    swells: f64,
    mass: f64,
    stretch: f64,
    friction: f64,
    /// Acceleration in m/s², about.
    pull: Triple,
}

fn thrown() -> impl Strategy<Value = Thrown> {
    let shape = (any::<bool>(), 3..8u32, triple(90.0));
    let contact = (decade(-3.3, -1.7), 0.3..4.0, 0.0..1.0);
    let body = (decade(-2.0, 0.3), decade(0.0, 2.0), triple(1.0), decade(0.0, 3.5));
    (shape, contact, body).prop_map(
        |((is_box, cells, turn), (thickness, swells, friction), (mass, stretch, pull, force))| Thrown {
            is_box,
            cells,
            turn,
            thickness,
            swells,
            mass,
            stretch,
            friction,
            pull: pull.map(|axis| axis * force),
        },
    )
}

impl Thrown {
    /// Its nodes; `k` counts cloths from below.
    fn nodes(&self, k: usize) -> String {
        let Self { is_box, cells, turn, thickness, swells, mass, stretch, friction, pull } = self;
        let (mesh, points) = match is_box {
            true => ("polyCube(width: 0.6, height: 0.5, depth: 0.6, subdivisions: (3, 3, 3)".to_owned(), 56),
            false => (
                format!("polyPlane(width: 0.9, height: 0.9, subdivisions: ({cells}, {cells})"),
                (cells + 1) * (cells + 1),
            ),
        };
        // `localForce` acts on every point.
        let force = pull.map(|axis| axis * mass / f64::from(points));
        format!(
            r#""m{k}": {mesh}, translate: (0, {}, 0), rotate: {}),
            "c{k}": nCloth(inputMesh: "m{k}", pointMass: {mass:.4}, stretchResistance: {stretch:.2},
                friction: {friction:.2}, selfCollisionFlag: "Full Surface", localForce: {},
                thickness: keys([(1, {thickness:.5}), (5, {:.5}), (9, {thickness:.5})])),"#,
            1.0 + 1.4 * k as f64,
            ron(*turn),
            ron(force),
            thickness * swells
        )
    }
}

/// A collider that starts below all cloths.
#[derive(Debug, Clone)]
struct Obstacle {
    mesh: &'static str,
    place: Triple,
    moved: Triple,
    turned: Triple,
}

fn obstacle() -> impl Strategy<Value = Obstacle> {
    const MESHES: [&str; 4] = [
        "polyCube(width: 0.8, height: 0.1, depth: 0.5",
        "polySphere(radius: 0.3, subdivisions: (12, 6)",
        "polyPlane(width: 1.2, height: 1.2, subdivisions: (2, 2)",
        "polyCylinder(radius: 0.02, height: 1.5, subdivisions: (5, 1, 1)",
    ];
    let motion = (triple(0.4), triple(1.5), triple(360.0));
    (proptest::sample::select(&MESHES[..]), motion).prop_map(|(mesh, (place, [x, y, z], turned))| Obstacle {
        mesh,
        place,
        moved: [x, y.abs() * 1.5, z],
        turned,
    })
}

impl Obstacle {
    fn nodes(&self, k: usize) -> String {
        let Self { mesh, place: [x, _, z], moved, turned } = self;
        let from = [*x, -1.0 - 2.5 * k as f64, *z];
        let to: Triple = std::array::from_fn(|axis| from[axis] + moved[axis]);
        format!(
            r#""k{k}": {mesh}, translate: keys([(1, {}), (8, {}, linear)]), rotate: keys([(1, (0, 0, 0)), (10, {})])),
            "r{k}": nRigid(inputMesh: "k{k}", thickness: 0.002, friction: 0.3),"#,
            ron(from),
            ron(to),
            ron(*turned)
        )
    }
}

/// Runs a scene under audit. Returns what passed, and what the solver counts as unresolved.
fn audited(text: &str, frames: u32, threads: usize) -> [u64; 2] {
    let mut run = Simulation::<f32>::new(&program(text), threads);
    run.begin_audit(Closeness::Steps);
    let mut counted = 0;
    for _ in 0..frames {
        let report = run.advance(&mut ()).report;
        assert!(report.finite, "{text}");
        counted += report.pairs_unresolved + report.depenetrating;
    }
    let found = run.audit().expect("it was begun").account();
    [found.crossings + found.intersections + found.below_ground, counted]
}

// Cloth that lies against itself was frozen where the step began while the plate had to carry it on, in turn.
#[test]
fn a_plate_that_lifts_cloth_and_turns_back_passes_no_cloth_and_leaves_no_pair_unresolved() {
    let nodes = r#""n": nucleus(evaluations: 48),
        "m": polyPlane(width: 1.388, height: 1.388, subdivisions: (11, 11), translate: (-0.13, 1, 0.169)),
        "c": nCloth(inputMesh: "m", selfCollisionFlag: "Full Surface", thickness: 0),
        "k": polyPlane(width: 1.008, height: 1.52, subdivisions: (2, 2), translate: keys([
            (1, (-0.025, -1.139, -0.478)), (4, (0.819, 1.807, 1.279), linear), (9, (-0.057, 0.53, -0.578), linear)])),
        "r": nRigid(inputMesh: "k")"#;
    assert_eq!(audited(&of_nodes(nodes, ""), 6, 1), [0, 0]);
}

// Around a ball that turns, no two places have the same motion: points that were carried by the faces that they touched closed
// on cloth that others carried.
#[test]
fn cloth_that_a_turning_ball_throws_at_other_cloth_passes_none_and_leaves_no_pair_unresolved() {
    let nodes = r#""n": nucleus(evaluations: 24),
        "m1": polyCylinder(radius: 0.243, height: 0.6, subdivisions: (15, 13, 1), translate: (-0.247, 2.65, -0.082),
            rotate: (73.5, 46.8, 0)),
        "c1": nCloth(inputMesh: "m1", pointMass: 0.0122, selfCollisionFlag: "Full Surface", thickness: 0.00199),
        "m2": polyPlane(width: 0.943, height: 0.943, subdivisions: (7, 7), translate: (-0.234, 3.3, -0.048)),
        "c2": nCloth(inputMesh: "m2", pointMass: 0.7983, selfCollide: false, selfCollisionFlag: "Full Surface",
            friction: 0.82, bendResistance: 0.066, thickness: keys([(1, 0.00234), (7, 0.00202), (11, 0.00234)])),
        "k": polySphere(radius: 0.575, subdivisions: (12, 5), translate: keys([
            (1, (0.394, -2.354, -0.384)), (13, (0.885, 2.188, 1.212), linear), (15, (-0.623, 2.124, -0.306), spline)]),
            rotate: keys([(1, (88.1, 55.5, 63.2)), (27, (583.8, -344.3, 290.5))])),
        "r": nRigid(inputMesh: "k", thickness: 0.00052)"#;
    assert_eq!(audited(&of_nodes(nodes, ""), 17, 1), [0, 0]);
}

// Along a tear, elements of both pieces coincide at rest, and only what is apart at rest had a contact distance.
#[test]
fn flaps_that_were_torn_from_each_other_do_not_pass_along_their_tear() {
    let nodes = r#""n": nucleus(gravity: 0, evaluations: 48), "p": polyPlane(width: 2, height: 1, subdivisions: (4, 1)),
        "c": nCloth(inputMesh: "p", thickness: 0.02, selfCollide: true, bendResistance: 1000, damp: 1),
        "t": dynamicConstraint(type: tearableSurface, components: ["c.e[where(abs(x) < 0.01)]"], glueStrength: 0.01),
        "left": dynamicConstraint(type: transform, components: ["c.vtx[0:1]", "c.vtx[5:6]"]),
        "right": dynamicConstraint(type: transform, components: ["c.vtx[3:4]", "c.vtx[8:9]"], translate: keys([
            (1, (0, 0, 0)), (4, (0.3, 0, 0), linear), (8, (0.3, 0.3, 0), linear), (14, (-0.3, 0.3, 0), linear),
            (22, (-0.3, -0.3, 0), linear)]))"#;
    assert_eq!(audited(&of_nodes(nodes, ""), 24, 1), [0, 0]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, max_shrink_iters: 20, failure_persistence: None, ..ProptestConfig::default() })]

    // EVIDENCE: N2.3-3  surface against surface, in point and face and edge and edge: whatever is thrown at whatever
    #[test]
    fn nothing_passes_through_anything_unless_it_is_counted(
        cloths in proptest::collection::vec(thrown(), 1..4),
        obstacles in proptest::collection::vec(obstacle(), 0..3),
        has_ground in any::<bool>(),
        evaluations in proptest::sample::select(&[12, 24, 96][..]),
        threads in 1..3usize,
    ) {
        let solver = format!(
            r#""n": nucleus(evaluations: {evaluations}, usePlane: {has_ground}, planeOrigin: (0, -0.2, 0)),"#
        );
        let nodes = cloths.iter().enumerate().map(|(k, cloth)| cloth.nodes(k));
        let nodes = nodes.chain(obstacles.iter().enumerate().map(|(k, obstacle)| obstacle.nodes(k)));
        let text = of_nodes(&nodes.fold(solver, |all, nodes| all + &nodes), "");
        let [passed, counted] = audited(&text, 10, threads);
        prop_assert!(passed == 0 || counted > 0, "{passed}\n{text}");
    }
}
