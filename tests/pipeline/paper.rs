//! Claims of the white paper, shown on scenes.

use nalgebra::Vector3;
use nucleus_core::ClothId;
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;
use nucleus_tests::gallery::program_of;

/// Position of a point of the only cloth after `frames` frames, in metres.
fn point_after(program: &Program, frames: usize, point: usize) -> Vector3<f64> {
    let mut run = Simulation::<f32>::new(program, 1);
    for _ in 0..frames {
        run.advance(&mut ());
    }
    run.state().point(ClothId(0), point)
}

/// A flag with high lift in a wind. One metre is `unit` scene units.
fn flag(unit: f64) -> Program {
    program_of(&format!(
        r#""nucleus1": nucleus(spaceScale: {}, windSpeed: 6, windDirection: (1, 0, 0.5)),
           "plane": polyPlane(width: {unit}, height: {unit}, subdivisions: (8, 8), rotate: (-90, 0, 90)),
           "flag": nCloth(inputMesh: "plane", pointMass: 0.2, lift: 0.5, drag: 0.1),
           "hoist": dynamicConstraint(constraintType: transform, components: ["flag.vtx[0:8]"])"#,
        1.0 / unit
    ))
}

// EVIDENCE: N1.3-4  with the same lift, a flag in centimetres moves as one in metres; no attribute is scaled by hand
#[test]
fn lift_does_not_depend_on_the_scene_unit() {
    let [metres, centimetres] = [1.0, 100.0].map(|unit| point_after(&flag(unit), 12, 80));
    assert!((metres - centimetres).norm() < 1e-3, "{metres:?} {centimetres:?}");
    let start = point_after(&flag(1.0), 0, 80);
    assert!((metres - start).norm() > 0.1, "the flag has not moved");
}

/// The largest strain of a sheet that is held by its corners while a ball is pushed into it, with the Classic model.
fn strain_beside_a_ball(sub_steps: u32, collision_iterations: u32) -> f64 {
    let program = program_of(&format!(
        r#""nucleus1": nucleus(resistanceModel: classic, subSteps: {sub_steps},
               maxCollisionIterations: {collision_iterations}),
           "plane": polyPlane(width: 1, height: 1, subdivisions: (30, 30)),
           "sheet": nCloth(inputMesh: "plane", stretchResistance: 60, thickness: 0.01),
           "corners": dynamicConstraint(constraintType: transform,
               components: ["sheet.vtx[0]", "sheet.vtx[30]", "sheet.vtx[930]", "sheet.vtx[960]"]),
           "sphere": polySphere(radius: 0.2, translateY: keys([(1, -0.3), (13, 0), (24, 0)])),
           "ball": nRigid(inputMesh: "sphere", thickness: 0.01)"#
    ));
    let mut run = Simulation::<f32>::new(&program, 1);
    (0..20).map(|_| run.advance(&mut ()).report.max_strain).fold(0.0, f64::max)
}

// EVIDENCE: N2.2-3  contact passes between stretch passes reduce stretch at a contact: from 956 % to 159 %
#[test]
fn contact_passes_among_stretch_passes_reduce_stretch_at_a_contact() {
    for sub_steps in [1, 2] {
        let [few, many] = [1, 16].map(|passes| strain_beside_a_ball(sub_steps, passes));
        assert!(many < 0.75 * few, "{sub_steps} substeps: {few} with 1 pass, {many} with 16");
    }
}

// EVIDENCE: N1.3-3, N2.2-5  at the same iteration counts, more substeps reduce stretch at a contact: from 159 % to 49 %
#[test]
fn substeps_reduce_stretch_at_a_contact() {
    let strains = [1, 4, 16].map(|sub_steps| strain_beside_a_ball(sub_steps, 16));
    assert!(strains.is_sorted_by(|more, less| *less < 0.75 * more), "{strains:?}");
}

// EVIDENCE: N2.4-5  a constraint whose `enable` is keyed on attaches to points at their positions in that frame
#[test]
fn a_constraint_that_is_enabled_attaches_to_falling_points() {
    let program = program_of(
        r#""nucleus1": nucleus(airDensity: 0),
           "plane": polyPlane(subdivisions: (2, 2)), "sheet": nCloth(inputMesh: "plane"),
           "hand": dynamicConstraint(constraintType: transform, components: ["sheet.vtx[*]"],
               enable: keys([(1, false), (13, true)]), translateX: keys([(12, 0), (24, 2)]))"#,
    );
    let [attached, later] = [11, 23].map(|frames| point_after(&program, frames, 4));
    assert!(attached.y < -0.9, "it has fallen for 11 frames: {attached:?}");
    assert!((later - attached - Vector3::new(2.0, 0.0, 0.0)).norm() < 1e-5, "{attached:?} {later:?}");
}

/// The largest strain of a sheet that is shaken by its upper edge so far, four times a second.
fn strain_when_shaken(way: f64, evaluations: u32) -> f64 {
    let keys: String =
        (0..8).map(|k| format!("({}, {}),", 1 + 3 * k, if k % 2 == 0 { -way } else { way })).collect();
    let program = program_of(&format!(
        r#""nucleus1": nucleus(evaluations: {evaluations}, gravity: 0),
           "plane": polyPlane(subdivisions: (10, 10), rotate: (90, 0, 0)),
           "sheet": nCloth(inputMesh: "plane", pointMass: 0.2, selfCollide: false),
           "hand": dynamicConstraint(constraintType: transform, components: ["sheet.vtx[0:10]"],
               translateY: keys([{keys}]))"#
    ));
    let mut run = Simulation::<f32>::new(&program, 1);
    (0..20).map(|_| run.advance(&mut ()).report.max_strain).fold(0.0, f64::max)
}

// EVIDENCE: N2.2-6  shaken tenfold, a sheet needs more than four times the evaluations for the same strain
#[test]
fn violent_motion_takes_more_evaluations() {
    let [gentle, violent, more] =
        [(0.02, 24), (0.2, 24), (0.2, 96)].map(|(way, n)| strain_when_shaken(way, n));
    assert!(violent > 2.0 * gentle, "{gentle} {violent}");
    assert!(more > gentle && more < violent, "{gentle} {more} {violent}");
}
