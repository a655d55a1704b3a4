//! Hints at cloth that hangs by pins or is inflated and that its budget leaves stretched, before a run; the budget that
//! `autoEvaluations` chose; budgets beyond what single precision resolves; liquids that need many time steps; and forces
//! that depend on the mesh.

use nucleus_core::{COUNT_PERIOD, FrameInput, Liquid, ResistanceModel};
use nucleus_graph::compile::budget::{Hanging, Inflated, MAX_BUDGET, hanging};
use nucleus_graph::compile::{Object, ObjectKind, Program};

use crate::figures;

/// Strain from which on there is a hint.
const MIN_STRAIN: f64 = 0.1;
/// Strain of the setting that the hint names.
const WANTED: f64 = 0.01;

/// Hints at the cloths of a scene that its budget leaves stretched, one line each.
pub fn hints(program: &Program) -> Vec<String> {
    let mut hints = Vec::new();
    for (at, (nucleus, input)) in program.nuclei().iter().zip(program.first_inputs()).enumerate() {
        for (index, id) in nucleus.cloths().enumerate() {
            let name = name_of(program, id);
            let found =
                hanging(index, nucleus.model().cloths(), &input).filter(|found| found.strain >= MIN_STRAIN);
            hints.extend(name.zip(found).map(|(name, found)| hint(&found, name)));
            let inflated = Inflated::of(program, at, index, &input);
            hints.extend(
                name.zip(inflated).and_then(|(name, inflated)| inflated_hint(&inflated, &input, name)),
            );
        }
    }
    hints
}

/// The name of a cloth.
fn name_of(program: &Program, id: u32) -> Option<&str> {
    let own = |object: &&Object| matches!(object.kind, ObjectKind::Cloth(cloth) if cloth.0 == id);
    program.objects().iter().find(own).map(|object| object.name.as_str())
}

/// `hint: ...`. The strain falls with the square of the evaluations.
fn hint(found: &Hanging, name: &str) -> String {
    let Hanging { points, pins, evaluations, strain } = found;
    let needed = (evaluations * (strain / WANTED).sqrt() / 10.0).ceil() * 10.0;
    let pins = figures::count(*pins, "pin");
    format!(
        "hint: `{name}` hangs {points} points on {pins}: {} `evaluations` leave it stretched by about {} beside them; \
         `evaluations: {needed}` would leave 1 %; `tethers: true` on the cloth costs less",
        figures::number(*evaluations),
        figures::percent((100.0 * strain).round() / 100.0),
    )
}

/// `hint: ...` where the skin of inflated cloth is stretched visibly beyond its material.
fn inflated_hint(inflated: &Inflated, input: &FrameInput, name: &str) -> Option<String> {
    let ResistanceModel::Physical { evaluations } = input.resistance else { return None };
    let strain = inflated.strain(COUNT_PERIOD / evaluations);
    let needed = (COUNT_PERIOD / inflated.step(WANTED) / 10.0).ceil() * 10.0;
    (strain >= MIN_STRAIN).then(|| {
        format!(
            "hint: `{name}` is inflated to {} kPa: {} `evaluations` leave its skin stretched by about {} more than its \
             material; `evaluations: {needed}` would leave 1 %",
            figures::number((inflated.pascals / 10.0).round() / 100.0),
            figures::number(evaluations),
            figures::percent((100.0 * strain).round() / 100.0),
        )
    })
}

/// The budgets that `autoEvaluations` chose, one line each.
pub fn budgets(program: &Program) -> Vec<String> {
    let line = |(index, own): (usize, &nucleus_graph::compile::NucleusProgram)| {
        let name = program.graph().node(own.node()).name();
        let budget = program.budget(index)?;
        let reason =
            if budget < MAX_BUDGET { "for about 1 % of stretch" } else { "the most it takes by itself" };
        let budget = figures::number(budget);
        Some(format!("`{name}` takes {budget} evaluations in 1/24 s, {reason}; `evaluations` sets others"))
    };
    program.nuclei().iter().enumerate().filter_map(line).collect()
}

/// Time steps in 1/24 s from which on single precision is farther from the limit than with half of them, in fast motion. A
/// correction per step is then below half the rounding of a displacement, and its smaller components are lost: a pendulum of 1 m
/// that starts level is 0.07° from its limit after a second with 384 steps, and 1.5° with 768. In Classic with `subSteps` it is
/// 0.03° from it with 384 steps, 0.12° with 600 and 0.71° with 2,000; with stretchy links 0.36° with 600.
const SINGLE_PRECISION: f64 = 600.0;

/// Warnings of the nuclei whose time steps single precision does not resolve, one line each.
pub fn unresolved_steps(program: &Program) -> Vec<String> {
    let warning = |(own, input): (&nucleus_graph::compile::NucleusProgram, FrameInput)| {
        let evaluations = match input.resistance {
            ResistanceModel::Physical { evaluations } => evaluations,
            ResistanceModel::Classic => 0.0,
        };
        let name = program.graph().node(own.node()).name();
        let steps = evaluations.max(f64::from(input.substeps) * COUNT_PERIOD / input.duration);
        (steps > SINGLE_PRECISION).then(|| {
            format!(
                "warning: `{name}` takes {} time steps in 1/24 s: in single precision, errors of fast motion grow again \
                 from about {} on, because positions are rounded in each step; `--scalar f64` resolves them",
                figures::number(steps.round()),
                figures::number(SINGLE_PRECISION)
            )
        })
    };
    program.nuclei().iter().zip(program.first_inputs()).filter_map(warning).collect()
}

/// Time steps of a liquid in 1/24 s from which on there is a hint.
const MANY_STEPS: f64 = 400.0;

/// Hints at the liquids that take many time steps even at rest, one line each.
pub fn liquid_steps(program: &Program) -> Vec<String> {
    let mut hints = Vec::new();
    for (nucleus, input) in program.nuclei().iter().zip(program.first_inputs()) {
        let liquids = nucleus.cloths().zip(&input.cloths);
        for (id, liquid) in liquids.filter_map(|(id, settings)| Some((id, settings.liquid?))) {
            let steps = |liquid: &Liquid| COUNT_PERIOD / liquid.longest_step_at_rest(input.gravity.norm());
            let Some(name) = name_of(program, id).filter(|_| steps(&liquid) >= MANY_STEPS) else { continue };
            let calm = Liquid { surface_tension: 0.0, ..liquid };
            let tension = if steps(&calm) < steps(&liquid) { ", or no `surfaceTension`," } else { "" };
            hints.push(format!(
                "hint: `{name}` takes about {} time steps in 1/24 s: its particles are {} mm apart; larger ones{tension} take \
                 fewer",
                figures::number((steps(&liquid) / 10.0).round() * 10.0),
                figures::number((liquid.spacing * 1e5).round() / 100.0),
            ));
        }
    }
    hints
}

/// Hints at cloth whose mass is per area and whose `localForce` is per point, one line each.
pub fn local_forces(program: &Program) -> Vec<String> {
    let mut hints = Vec::new();
    for (nucleus, input) in program.nuclei().iter().zip(program.first_inputs()) {
        if !matches!(input.resistance, ResistanceModel::Physical { .. }) {
            continue;
        }
        let cloths = nucleus.cloths().zip(nucleus.model().cloths()).zip(&input.cloths);
        for ((id, cloth), settings) in cloths {
            let (points, force) = (cloth.surface.positions.len(), settings.local_force.norm());
            let pushed = name_of(program, id).filter(|_| force > 0.0 && !cloth.surface.faces.is_empty());
            hints.extend(pushed.map(|name| {
                format!(
                    "hint: `localForce` of `{name}` acts on each of its {points} points, {} N in all: a finer mesh is pushed \
                     harder; a `uniformField` acts on every mesh alike",
                    figures::number((force * points as f64 * 1e3).round() / 1e3),
                )
            }));
        }
    }
    hints
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
    fn time_steps_that_single_precision_does_not_resolve_are_warned_of() {
        let warnings = |nucleus: &str| {
            let text = format!(
                "Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
                    \"nucleus\": nucleus({nucleus}),
                    \"plane\": polyPlane(),
                    \"curtain\": nCloth(inputMesh: \"plane\"),
                }})"
            );
            let scene = read_scene_text(&text, Path::new("curtain.ron")).expect("a scene").0;
            unresolved_steps(&compile(&scene).unwrap_or_else(|found| panic!("{found:?}")))
        };
        assert_eq!(warnings("evaluations: 600"), [""; 0]);
        assert!(warnings("evaluations: 12000")[0].starts_with("warning: `nucleus` takes 12000 time steps"));
        assert!(warnings("subSteps: 800")[0].starts_with("warning: `nucleus` takes 800 time steps"));
        let classic = |substeps: u32| warnings(&format!("resistanceModel: classic, subSteps: {substeps}"));
        assert_eq!(classic(600), [""; 0]);
        assert!(classic(800)[0].starts_with("warning: `nucleus` takes 800 time steps"));
        // Fewer steps would stretch the cloth of a budget that was chosen for it.
        assert!(classic(800)[0].ends_with("; `--scalar f64` resolves them"), "{}", classic(800)[0]);
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

    #[test]
    fn a_liquid_of_small_drops_gets_a_hint_with_its_time_steps() {
        let hints = |radius: f64, tension: f64| {
            let text = format!(
                "Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
                    \"nucleus\": nucleus(spaceScale: 0.001),
                    \"water\": nParticle(enableSPH: true, radius: {radius}, surfaceTension: {tension},
                        minimumCorner: (0, 0, 0), maximumCorner: (4, 4, 4)),
                }})"
            );
            let scene = read_scene_text(&text, Path::new("water.ron")).expect("a scene").0;
            liquid_steps(&compile(&scene).unwrap_or_else(|found| panic!("{found:?}")))
        };
        // Particles are 1.28 radii apart; √(7.3e-5 / 1.28e-4³) / 0.2 / 24 = 1230.
        let tiny = "hint: `water` takes about 1230 time steps in 1/24 s: its particles are 0.13 mm apart; larger ones, or no \
                    `surfaceTension`, take fewer";
        assert_eq!(hints(0.1, 0.073), [tiny]);
        assert_eq!(hints(0.1, 0.0), [""; 0]);
        assert_eq!(hints(1.0, 0.073), [""; 0]);
    }

    #[test]
    fn a_force_per_point_on_cloth_of_a_mass_per_area_is_a_hint() {
        let hints = |nucleus: &str, cloth: &str| {
            let text = format!(
                r#"Scene(time: (start: 1, end: 2, fps: 24), nodes: {{"n": nucleus({nucleus}),
                    "p": polyPlane(subdivisions: (6, 6)), "c": nCloth(inputMesh: "p", {cloth}),
                    "q": nParticle(position: [(0, 9, 0)], localForce: (1, 0, 0))}})"#
            );
            let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it can be read");
            local_forces(&compile(&scene).expect("it can run"))
        };
        let expected = "hint: `localForce` of `c` acts on each of its 49 points, 0.49 N in all: a finer mesh is pushed \
            harder; a `uniformField` acts on every mesh alike";
        assert_eq!(hints("", "localForce: (0.01, 0, 0)"), [expected]);
        assert!(hints("", "").is_empty());
        assert!(hints("resistanceModel: classic", "localForce: (0.01, 0, 0)").is_empty());
    }
}
