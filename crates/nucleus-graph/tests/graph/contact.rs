//! Contact where pins and constraints leave less room than the thickness: cloth stays at rest and gains no energy.

use nucleus_graph::{FrameReport, Simulation};

use super::scenes::{of_nodes, program};

/// The reports of some frames.
fn reports(nodes: &str, frames: usize) -> Vec<FrameReport> {
    let program = program(&of_nodes(nodes, ""));
    let mut run = Simulation::<f32>::new(&program, 1);
    (0..frames).map(|_| run.advance(&mut ())).collect()
}

/// The largest kinetic energy of some frames in joules.
fn most_energy(reports: &[FrameReport]) -> f64 {
    reports.iter().map(|frame| frame.report.kinetic_energy).fold(0.0, f64::max)
}

#[test]
fn a_curtain_that_its_pins_draw_closer_than_its_thickness_hangs_still() {
    // `pointMass` is in kg/m², of 9 cm², and in Classic in kg per point, of 16.
    for (model, mass) in [("physical", 0.2 * 9e-4), ("classic", 0.2 * 16.0)] {
        for width in [0.4, 0.2] {
            let nodes = format!(
                r#""n": nucleus(spaceScale: 0.01, resistanceModel: {model}),
                "m": polyPlane(width: 3, height: 3, subdivisions: (3, 3), rotateX: 90),
                "q": nCloth(inputMesh: "m", thickness: 0.22, pointMass: 0.2, selfCollisionFlag: fullSurface),
                "rail": dynamicConstraint(constraintType: transform, components: ["q.vtx[0:3]"],
                    scaleX: keys([(1, 1), (10, {width})]))"#
            );
            let reports = reports(&nodes, 20);
            let most = mass * 9.8 * 0.03; // a fall by its whole height
            let found = most_energy(&reports);
            assert!(found < most, "{model}, drawn to {width}: {found} J of {most} J");
            assert!(reports.iter().all(|frame| frame.report.pairs_unresolved == 0), "{model}, {width}");
        }
    }
}

/// Two sheets of cloth with buttons between them, without weight and air.
fn buttoned(layers: [u32; 2], rest: f64) -> String {
    let [low, high] = layers;
    format!(
        r#""n": nucleus(gravity: 0, airDensity: 0),
        "a": polyPlane(width: 0.5, height: 0.5, subdivisions: (8, 8)),
        "b": polyPlane(width: 0.5, height: 0.5, subdivisions: (8, 8), translate: (0, 0.02, 0)),
        "p": nCloth(inputMesh: "a", preset: "cotton", thickness: 0.005, drag: 0, collisionLayer: {low}),
        "q": nCloth(inputMesh: "b", preset: "cotton", thickness: 0.005, drag: 0, collisionLayer: {high}),
        "buttons": dynamicConstraint(constraintType: pointToPoint, connectionMethod: withinMaxDistance,
            maxDistance: 0.03, restLengthScale: {rest}, components: ["p", "q"])"#
    )
}

#[test]
fn buttons_shorter_than_the_contact_distance_leave_cloth_at_rest_in_any_layer() {
    for layers in [[1, 1], [1, 2], [2, 1]] {
        let found = most_energy(&reports(&buttoned(layers, 0.3), 24)[12..]);
        assert!(found < 1e-8, "layers {layers:?}: {found} J");
    }
}

#[test]
fn the_smallest_gap_is_that_of_points_that_collide() {
    let nodes = r#""n": nucleus(usePlane: true),
        "m": polyPlane(width: 0.8, height: 0.8, subdivisions: (8, 8), translate: (0, 0.1, 0)),
        "q": nCloth(inputMesh: "m", thickness: 0.005),
        "s": polySphere(radius: 0.1, translate: (0, -5, 0)), "ball": nRigid(inputMesh: "s"),
        "off": dynamicConstraint(constraintType: disableCollision, components: ["q.where(x > 0)", "ball"])"#;
    let last = reports(nodes, 20).pop().expect("frames");
    assert!(last.report.min_gap > 0.9, "{}", last.report.min_gap);
}
