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
