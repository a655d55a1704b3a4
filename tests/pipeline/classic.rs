//! The effects on whole cloths with the Classic resistance model, where a resistance is a count.

use nalgebra::Vector3;
use nucleus_core::ClothId;
use nucleus_graph::Simulation;
use nucleus_tests::gallery::program_of;

type Vec3 = Vector3<f64>;

/// The points of the cloth after some frames, in metres.
fn after(nucleus: &str, nodes: &str, frames: usize) -> Vec<Vec3> {
    let program =
        program_of(&format!(r#""nucleus1": nucleus(resistanceModel: classic, {nucleus}), {nodes}"#));
    let mut run = Simulation::<f32>::new(&program, 1);
    for _ in 0..frames {
        assert!(run.advance(&mut ()).report.finite);
    }
    let count = program.objects()[0].points;
    (0..count).map(|point| run.state().point(ClothId(0), point)).collect()
}

fn mean(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len() as f64
}

/// Root mean square distance from the middle.
fn size(points: &[Vec3]) -> f64 {
    let middle = mean(points);
    (points.iter().map(|p| (p - middle).norm_squared()).sum::<f64>() / points.len() as f64).sqrt()
}

// EVIDENCE: N1.2-4  in Classic too a balloon grows with the gas in it, and keeps its place
#[test]
fn pressure_inflates_a_ball_and_a_harder_gas_more() {
    let ball = |fields: &str| {
        let nodes = format!(
            r#""p": polySphere(radius: 0.3, subdivisions: (16, 12)), "c": nCloth(inputMesh: "p", pointMass: 0.01,
                stretchResistance: 4, compressionResistance: 0, damp: 1, selfCollide: false, {fields})"#
        );
        after("gravity: 0, airDensity: 0, subSteps: 6", &nodes, 24)
    };
    let gas = |start: f64| {
        format!("pressureMethod: volumeTrackingModel, incompressibility: 40, startPressure: {start}")
    };
    let [slack, some, more] = [String::new(), gas(0.2), gas(0.6)].map(|fields| ball(&fields));
    assert!(size(&some) > 1.02 * size(&slack) && size(&more) > 1.05 * size(&some));
    assert!(mean(&more).norm() < 1e-3, "pressure pushes nothing as a whole: {}", mean(&more));
    let by_hand = ball("pressure: 0.5");
    assert!(size(&by_hand) > 1.02 * size(&slack), "{} {}", size(&by_hand), size(&slack));
}

// EVIDENCE: N1.2-7  half-rigid things keep their shape by counts too
#[test]
fn rigidity_and_deform_resistance_keep_the_shape_of_a_box() {
    // Height of the lowest point of its top, 0.41 m if it keeps its shape.
    let height = |fields: &str| {
        let nodes = format!(
            r#""p": polyCube(width: 0.4, height: 0.4, depth: 0.4, subdivisions: (4, 4, 4), translateY: 0.25),
               "c": nCloth(inputMesh: "p", thickness: 0.01, bendResistance: 0, stretchResistance: 10, {fields})"#
        );
        let start = after("usePlane: true, subSteps: 6", &nodes, 0);
        let points = after("usePlane: true, subSteps: 6", &nodes, 24);
        let top = start.iter().zip(&points).filter(|(start, _)| start.y > 0.44);
        top.map(|(_, now)| now.y).fold(f64::INFINITY, f64::min)
    };
    let [soft, rigid, deforming] = ["", "rigidity: 5", "deformResistance: 5"].map(height);
    assert!(soft < 0.36, "without it the top sags: {soft}");
    assert!((rigid - 0.41).abs() < 0.005 && (deforming - 0.41).abs() < 0.005, "{rigid} {deforming}");
}

/// A strip, held at its left end, whose right end is moved and then released.
fn strip(mesh: &str, fields: &str, [left, right]: [&str; 2], motion: &str) -> Vec<Vec3> {
    let nodes = format!(
        r#""p": polyPlane(width: 1, height: 0.2, {mesh}), "c": nCloth(inputMesh: "p", pointMass: 0.1,
            bendResistance: 20, damp: 1, selfCollide: false, {fields}),
           "left": dynamicConstraint(components: ["{left}"]),
           "right": dynamicConstraint(components: ["{right}"], enable: keys([(1, true), (9, false)]), {motion})"#
    );
    after("gravity: 0, airDensity: 0, subSteps: 4", &nodes, 144)
}

// EVIDENCE: N1.2-7  in Classic too, links beyond the restitution tension stay longer, by what is beyond
#[test]
fn a_strip_pulled_beyond_its_restitution_tension_stays_longer_by_the_rest() {
    let length = |fields: &str| {
        let ends = ["c.where(x < -0.49)", "c.where(x > 0.49)"];
        let pull = "translateX: keys([(1, 0), (7, 0.3)])";
        let points = strip("subdivisions: (16, 2)", fields, ends, pull);
        points[17..34].windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>()
    };
    // Links of a resistance of 20 yield at a strain of 1 / 20: of 1.3 there remain 1.3 / 1.05. Cross links yield less,
    // because the strip narrows, and draw it together a little.
    let [elastic, plastic] = ["", "restitutionTension: 1"].map(length);
    assert!((elastic - 1.0).abs() < 0.03, "{elastic}");
    assert!((plastic - 1.3 / 1.05).abs() < 0.04, "{plastic}");
}

// EVIDENCE: N1.2-7  in Classic too, bends beyond the restitution angle stay, by what is beyond
#[test]
fn a_strip_bent_beyond_its_restitution_angle_stays_bent_by_the_rest() {
    let bend = |fields: &str| {
        let ends = ["c.where(x < 0.1)", "c.where(x > 0.4)"];
        let turn = "rotateZ: keys([(1, 0), (7, 90)])";
        let points = strip("subdivisions: (2, 1)", fields, ends, turn);
        points[2].y.atan2(points[2].x).to_degrees()
    };
    let [elastic, plastic] = ["", "restitutionAngle: 30"].map(bend);
    assert!(elastic.abs() < 3.0 && (plastic - 60.0).abs() < 3.0, "{elastic}° {plastic}°");
}

#[test]
fn attraction_follows_the_input_mesh_by_its_share_in_a_film_frame() {
    let away = |attract: &str| {
        let nodes = format!(
            r#""p": polyPlane(subdivisions: (6, 6), translateX: keys([(1, 0), (13, 3)])),
               "c": nCloth(inputMesh: "p", {attract} selfCollide: false)"#
        );
        (mean(&after("gravity: 0, airDensity: 0, subSteps: 4", &nodes, 24)) - Vec3::x() * 3.0).norm()
    };
    let [loose, half, all] =
        ["", "inputMeshAttract: 0.5, inputAttractDamp: 0,", "inputMeshAttract: 1, inputAttractDamp: 0,"]
            .map(away);
    assert!((loose - 3.0).abs() < 1e-6, "without attraction it stays: {loose}");
    assert!(half < 1.0 && all < 1e-3, "{half} {all}");
}

#[test]
fn the_force_field_of_a_collider_lifts_a_sheet_and_reverses_with_its_sign() {
    let height = |magnitude: f64| {
        let nodes = format!(
            r#""p": polyPlane(subdivisions: (4, 4), translateY: 0.5), "c": nCloth(inputMesh: "p", selfCollide: false),
               "q": polyPlane(width: 4, height: 4), "floor": nRigid(inputMesh: "q", collide: false,
                   forceField: doubleSided, fieldMagnitude: {magnitude}, fieldDistance: 2)"#
        );
        mean(&after("gravity: 0, airDensity: 0", &nodes, 6)).y
    };
    let [none, pushed, pulled] = [0.0, 1.0, -1.0].map(height);
    assert!((none - 0.5).abs() < 1e-6);
    // About 10 m/s² · 3/4 over a quarter of a second.
    assert!((0.65..0.8).contains(&pushed), "{pushed}");
    assert!((0.2..0.4).contains(&pulled), "{pulled}");
}
