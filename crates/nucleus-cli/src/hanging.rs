//! How far sweeps leave cloth stretched that hangs by pins, estimated before a run.
//!
//! In a step of h seconds a sweep holds an edge no stiffer than about m / h², whatever its resistance is. Where P pins
//! carry N points of mass m, an edge of length d beside them is therefore stretched by N g h² / (P d).

use nucleus_core::{COUNT_PERIOD, Cloth, FrameInput, ResistanceModel};
use nucleus_graph::compile::{ObjectKind, Program};

use crate::figures;

/// Strain from which on there is a hint.
const MIN_STRAIN: f64 = 0.1;
/// Strain of the setting that the hint names.
const WANTED: f64 = 0.01;

/// A cloth that hangs by pins.
struct Hanging {
    points: usize,
    pins: usize,
    evaluations: f64,
    /// Estimated strain of the edges at the pins, at rest.
    strain: f64,
}

/// Hints at the cloths of a scene that its budget leaves stretched, one line each.
pub fn hints(program: &Program) -> Vec<String> {
    let mut hints = Vec::new();
    for (nucleus, input) in program.nuclei().iter().zip(program.first_inputs()) {
        for (index, (id, cloth)) in nucleus.cloths().zip(nucleus.model().cloths()).enumerate() {
            let own = |kind: &ObjectKind| matches!(kind, ObjectKind::Cloth(cloth) if cloth.0 == id);
            let name = program.objects().iter().find(|object| own(&object.kind)).map(|object| &object.name);
            let found = hanging(index, cloth, &input).filter(|found| found.strain >= MIN_STRAIN);
            hints.extend(name.zip(found).map(|(name, found)| found.hint(name)));
        }
    }
    hints
}

/// The estimate for the `index`th cloth of a nucleus; `None` where sweeps are not what limits it.
fn hanging(index: usize, cloth: &Cloth, input: &FrameInput) -> Option<Hanging> {
    let ResistanceModel::Physical { evaluations } = input.resistance else { return None };
    let settings = input.cloths.get(index)?;
    let points = cloth.surface.positions.len();
    let mut pins: Vec<_> =
        input.pins.iter().filter(|pin| pin.cloth.index() == index).map(|pin| pin.point).collect();
    pins.sort_unstable();
    pins.dedup();
    if !cloth.lists.stretch || pins.is_empty() || settings.tethers.is_some() || !settings.feels_gravity {
        return None;
    }
    let step = COUNT_PERIOD / evaluations;
    let load = (points - pins.len()) as f64 / pins.len() as f64;
    let strain = load * input.gravity.norm() * step * step / mean_edge(cloth)?;
    Some(Hanging { points, pins: pins.len(), evaluations, strain })
}

/// Mean length of the sides of the faces in metres; `None` without faces.
fn mean_edge(cloth: &Cloth) -> Option<f64> {
    let place = |point: u32| cloth.surface.positions[point as usize];
    let sides = cloth.surface.faces.iter().flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)));
    let lengths = sides.map(|(&a, &b)| (place(a) - place(b)).norm());
    let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
    (sum > 0.0).then(|| sum / count)
}

impl Hanging {
    /// `hint: ...`. The strain falls with the square of the evaluations.
    fn hint(&self, name: &str) -> String {
        let Self { points, pins, evaluations, strain } = self;
        let needed = (evaluations * (strain / WANTED).sqrt() / 10.0).ceil() * 10.0;
        let pins = figures::count(*pins, "pin");
        format!(
            "hint: `{name}` hangs {points} points on {pins}: {} `evaluations` leave it stretched by about {} beside them; \
             `evaluations: {needed}` would leave 1 %; `tethers: true` on the cloth costs less",
            figures::number(*evaluations),
            figures::percent((100.0 * strain).round() / 100.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use nucleus_graph::compile::compile;
    use nucleus_graph::scene::read_scene_text;

    use super::*;

    fn hints_of(nucleus: &str, cloth: &str, pins: &str) -> Vec<String> {
        let text = format!(
            "Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
                \"nucleus\": nucleus({nucleus}),
                \"plane\": polyPlane(width: 1, height: 1, subdivisions: (64, 64)),
                \"curtain\": nCloth(inputMesh: \"plane\", {cloth}),
                \"pins\": dynamicConstraint(constraintType: transform, components: [{pins}]),
            }})"
        );
        let scene =
            read_scene_text(&text, Path::new("curtain.ron")).unwrap_or_else(|found| panic!("{found:?}")).0;
        hints(&compile(&scene).unwrap_or_else(|found| panic!("{found:?}")))
    }

    #[test]
    fn a_sheet_on_two_corners_gets_a_hint_with_its_strain_and_the_evaluations_for_1_percent() {
        let two = "\"curtain.vtx[0]\", \"curtain.vtx[64]\"";
        let said = hints_of("evaluations: 96", "pointMass: 0.2", two);
        // 4223 points on 2 pins: 2111.5 · 9.8 m/s² · (1/2304 s)² / (1/64 m) = 0.249.
        assert_eq!(
            said,
            [
                "hint: `curtain` hangs 4225 points on 2 pins: 96 `evaluations` leave it stretched by about 25 % beside them; \
              `evaluations: 480` would leave 1 %; `tethers: true` on the cloth costs less"
            ]
        );
        for (nucleus, cloth) in [
            ("evaluations: 192", "pointMass: 0.2"),
            ("resistanceModel: classic", "pointMass: 0.2"),
            ("gravity: 0", "pointMass: 0.2"),
            ("evaluations: 96", "tethers: true"),
        ] {
            assert_eq!(hints_of(nucleus, cloth, two), [""; 0], "{nucleus}, {cloth}");
        }
        assert_eq!(hints_of("evaluations: 96", "pointMass: 0.2", "\"curtain.vtx[0:64]\""), [""; 0]);
    }
}
