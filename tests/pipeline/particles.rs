//! Particles in contact with cloth, audited.

use nucleus_tests::gallery::program_of;
use nucleus_tests::{Audited, audited};

/// A particle that hits a hanging sheet at 100 m/s.
fn shot(sub_steps: u32, model: &str, size: f64, mass: f64) -> Audited {
    let program = program_of(&format!(
        r#""n": nucleus(subSteps: {sub_steps}, resistanceModel: {model}),
           "plane": polyPlane(width: 1, height: 1, subdivisions: (12, 12), rotate: (90, 0, 0)),
           "sheet": nCloth(inputMesh: "plane", thickness: {size}, selfCollisionFlag: "Full Surface"),
           "rail": dynamicConstraint(components: ["sheet.vtx[0:12]"]),
           "bead": nParticle(position: [(0.03, 0.05, -0.7)], velocity: [(0, 0, 100)], radius: {size}, pointMass: {mass})"#
    ));
    audited(&program, 4, 1)
}

// EVIDENCE: N2.3-4  continuous collision detection holds a fast particle
#[test]
fn a_fast_particle_passes_through_no_sheet_at_any_size_and_any_substeps() {
    for model in ["classic", "physical, evaluations: 24"] {
        for sub_steps in [1, 3, 8] {
            for size in [0.01, 0.001, 0.00001, 0.0] {
                for mass in [0.0001, 0.01] {
                    let name = format!("{model}, {sub_steps} substeps, {size} m, {mass} kg");
                    shot(sub_steps, model, size, mass).assert_clean(&name);
                }
            }
        }
    }
}
