//! `autoEvaluations`: the budget follows the scene.

use std::path::Path;

use nucleus_core::ResistanceModel;

use crate::Simulation;
use crate::compile::{Program, compile};
use crate::scene::read_scene_text;

/// A square of 17² points in two corners, `size` metres wide.
fn hung(size: f64, nucleus: &str, cloth: &str) -> Program {
    let text = format!(
        "Scene(time: (start: 1, end: 999, fps: 24), nodes: {{
            \"nucleus\": nucleus({nucleus}),
            \"plane\": polyPlane(width: {size}, height: {size}, subdivisions: (16, 16)),
            \"cloth\": nCloth(inputMesh: \"plane\", pointMass: 0.2, {cloth}),
            \"pins\": dynamicConstraint(constraintType: transform, components: [\"cloth.vtx[0]\", \"cloth.vtx[16]\"]),
        }})"
    );
    let read = read_scene_text(&text, Path::new("hung.ron")).unwrap_or_else(|found| panic!("{found:?}"));
    compile(&read.0).unwrap_or_else(|found| panic!("{found:?}"))
}

fn budget(program: &Program) -> f64 {
    let ResistanceModel::Physical { evaluations } = program.first_input().resistance else {
        panic!("classic")
    };
    evaluations
}

#[test]
fn the_budget_follows_from_edge_load_and_gravity() {
    // 287 points on 2 pins: h = √(0.01 · (1/16 m) / (143.5 · 9.8 m/s²)) = 1/1500 s, 63 in 1/24 s.
    assert_eq!(budget(&hung(1.0, "", "")), 96.0, "at least the default");
    assert_eq!(budget(&hung(0.01, "", "")), 630.0);
    assert_eq!(budget(&hung(1e-3, "", "")), 1980.0);
    assert_eq!(budget(&hung(1e-4, "", "")), 2000.0, "at most 2,000");
    assert_eq!(budget(&hung(0.01, "autoEvaluations: false", "")), 96.0);
    assert_eq!(budget(&hung(0.01, "evaluations: 50", "")), 50.0);
    // Tethers carry the load of the pins: 8 points in a line remain.
    assert_eq!(budget(&hung(0.01, "", "tethers: true")), 150.0);
    // Points of a hundredth of the mass beside the pins: ten times the evaluations, nearly.
    let light = budget(&hung(1.0, "", "massPerVertex: expression(\"z > 0.4 ? 0.01 : 1\")"));
    assert!((550.0..=630.0).contains(&light), "{light}");
    // Cloth of 5 N/m stretches by itself: h = √(m / 4 K), m = 0.2 kg/m² · 1 m² / 289.
    assert_eq!(budget(&hung(1.0, "gravity: 980", "stretchResistance: 0.01")), 96.0);
}

#[test]
fn a_budget_that_is_given_and_chosen_is_warned_of() {
    let warns = |nucleus: &str| {
        let program = hung(1.0, nucleus, "");
        program
            .warnings()
            .iter()
            .any(|each| each.message.contains("`autoEvaluations` of `nucleus` has no effect"))
    };
    assert!(warns("autoEvaluations: true, evaluations: 50"));
    assert!(!warns("evaluations: 50"));
    assert!(!warns("autoEvaluations: true"));
}

#[test]
fn cloth_of_a_millimetre_and_of_a_hundred_metres_hang_equally_well() {
    let strain = |size: f64| {
        let program = hung(size, "", "damp: 1, tangentialDrag: 1, drag: 0.5");
        let mut simulation: Simulation = Simulation::new(&program, 1);
        // As many frames as a pendulum of this length takes for a swing and a half.
        let frames = (24.0 * 3.0 * size.sqrt()).clamp(8.0, 480.0) as u32;
        (0..frames).map(|_| simulation.advance(&mut ()).report.strain_99).last().unwrap_or(1.0)
    };
    for size in [1e-3, 1.0, 100.0] {
        let found = strain(size);
        assert!(found < 0.02, "{size} m: 99 % of the edges are below {found}");
    }
}

/// A ball of 20 cm under pressure, without gravity.
fn inflated(nucleus: &str, cloth: &str) -> Program {
    skin(5000.0, nucleus, cloth)
}

/// The same with a skin of this stiffness in N/m.
fn skin(stiffness: f64, nucleus: &str, cloth: &str) -> Program {
    let text = format!(
        "Scene(time: (start: 1, end: 30, fps: 24), nodes: {{
            \"nucleus\": nucleus(gravity: 0, airDensity: 0, {nucleus}),
            \"sphere\": polySphere(radius: 0.2, subdivisions: (24, 16)),
            \"ball\": nCloth(inputMesh: \"sphere\", pointMass: 0.2, damp: 2, stretchStiffness: {stiffness}, {cloth}),
        }})"
    );
    let read = read_scene_text(&text, Path::new("ball.ron")).unwrap_or_else(|found| panic!("{found:?}"));
    compile(&read.0).unwrap_or_else(|found| panic!("{found:?}"))
}

/// The mean radius of the ball after 29 frames, over that at the start.
fn growth(program: &Program) -> f64 {
    let mut simulation: Simulation = Simulation::new(program, 1);
    let radius = |simulation: &Simulation| {
        let mut places = Vec::new();
        simulation.state().positions(nucleus_core::ClothId(0), 1.0, &mut places);
        let of = |[x, y, z]: &[f32; 3]| f64::from(x * x + y * y + z * z).sqrt();
        places.iter().map(of).sum::<f64>() / places.len() as f64
    };
    let start = radius(&simulation);
    (0..29).for_each(|_| _ = simulation.advance(&mut ()));
    radius(&simulation) / start - 1.0
}

#[test]
fn a_ball_under_pressure_takes_the_budget_that_keeps_its_size() {
    let ball = inflated("", "pressure: 1");
    let found = budget(&ball);
    // h = √(0.01 · 4 m / (p r)), m = 0.2 kg/m² · 0.495 m² / 362, p r = 1 kPa · 20 cm: 176 in 1/24 s.
    assert!((170.0..=200.0).contains(&found), "{found}");
    let exact = growth(&inflated("evaluations: 1500", "pressure: 1"));
    // Laplace: a tension of p r / 2 = 100 N/m stretches a skin of links of 5000 N/m by 1 to 2 %.
    assert!((0.01..0.02).contains(&exact), "{exact}");
    let (own, default) = (growth(&ball) - exact, growth(&inflated("evaluations: 96", "pressure: 1")) - exact);
    assert!(own < 0.012 && default > 0.02, "{own}, {default}");
}

#[test]
fn the_budget_of_inflated_cloth_follows_keys_and_gas_and_not_open_cloth() {
    let of = |cloth: &str| budget(&inflated("", cloth));
    let by_hand = of("pressure: 4");
    assert!(by_hand > 300.0, "{by_hand}");
    assert_eq!(of("pressure: keys([(1, 0), (20, 4)])"), by_hand, "the largest pressure counts");
    assert_eq!(of("pressureMethod: volumeTrackingModel, startPressure: 0"), 96.0);
    let gas = of("pressureMethod: volumeTrackingModel, incompressibility: 20, startPressure: 0.3");
    assert!((200.0..by_hand).contains(&gas), "{gas}");
    let pumped = of("pressureMethod: volumeTrackingModel, incompressibility: 20, pumpRate: 0.25");
    assert!((gas - pumped).abs() < 40.0, "30 % of the air in 1.2 s: {gas}, {pumped}");
    // Soft cloth stretches by itself.
    assert_eq!(budget(&skin(20.0, "", "pressure: 4")), 96.0);
    assert_eq!(budget(&hung(1.0, "gravity: 0", "pressure: 4")), 96.0, "pressure drives an open sheet");
}
