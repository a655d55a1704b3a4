//! What looks wrong after the last frame of a run: sheets that are pressed together and stay flat.
//!
//! A sheet that is flat to the last bit has no side to buckle to: every force in it lies in its plane. The solver adds no
//! noise of its own, so only a perturbed start lets it fold.

use nalgebra::{Matrix3, Vector3};
use nucleus_core::Real;

use crate::compile::{Object, ObjectKind};
use crate::mesh::area;
use crate::simulation::Simulation;

/// Thickness over width, both as standard deviations, below which the start of a sheet is flat to rounding.
const FLAT_START: f64 = 1e-7;
/// The same at the end, where rounding has accumulated.
const FLAT_END: f64 = 1e-4;
/// Share of its area that a sheet has lost if it is pressed together.
const PRESSED: f64 = 0.02;

/// The names of the cloths that started flat, are pressed together in their plane, and are still flat.
pub fn flat_cloths<R: Real>(simulation: &Simulation<R>) -> Vec<String> {
    let program = simulation.program();
    let is_stuck = |object: &&Object| {
        let ObjectKind::Cloth(cloth) = object.kind else { return false };
        let (nucleus, own) = program.locate_cloth(cloth);
        let start = program.nuclei()[nucleus].model().positions(own);
        if object.faces.is_empty() || flatness(start) > FLAT_START {
            return false;
        }
        let state = simulation.state();
        let end: Vec<_> = (0..object.points).map(|point| state.point(cloth, point)).collect();
        flatness(&end) < FLAT_END && area(&object.faces, &end) < (1.0 - PRESSED) * area(&object.faces, start)
    };
    simulation.objects().iter().filter(is_stuck).map(|object| object.name.clone()).collect()
}

/// Thickness of a cloud of points over its width; 1 without points.
fn flatness(points: &[Vector3<f64>]) -> f64 {
    let middle = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let spread: Matrix3<f64> = points.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    // The thickness from the points themselves: an eigenvalue near zero is as uncertain as the largest is large.
    let eigen = spread.symmetric_eigen();
    let normal = eigen.eigenvectors.column(eigen.eigenvalues.imin());
    let thickness = points.iter().map(|p| (p - middle).dot(&normal).powi(2)).sum::<f64>();
    if eigen.eigenvalues.max() > 0.0 { (thickness / eigen.eigenvalues.max()).sqrt() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read_scene_text;

    /// The flat cloths after a curtain of 1 m is drawn to `width` m in eight frames.
    fn flat(cloth: &str, width: f64) -> Vec<String> {
        let text = format!(
            r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
                "n": nucleus(), "p": polyPlane(subdivisions: (6, 6), rotate: (90, 0, 0)),
                "sheet": nCloth(inputMesh: "p", selfCollide: false, {cloth}),
                "rail": dynamicConstraint(components: ["sheet.vtx[0]", "sheet.vtx[6]"], scaleX: keys([(1, 1), (9, {width})])),
            }})"#
        );
        let (scene, _) = read_scene_text(&text, "sheet.ron".as_ref()).expect("it reads");
        let program = crate::compile::compile(&scene).expect("it compiles");
        let mut simulation = Simulation::<f32>::new(&program, 1);
        while !simulation.is_done() {
            simulation.advance(&mut ());
        }
        flat_cloths(&simulation)
    }

    #[test]
    fn a_sheet_that_is_pressed_together_and_stays_flat_is_named() {
        assert_eq!(flat("", 0.6), ["sheet"]);
        assert!(flat("initialPerturbation: 0.01", 0.6).is_empty(), "it folds");
        assert!(flat("", 1.0).is_empty(), "a sheet that merely hangs is flat rightly");
    }
}
