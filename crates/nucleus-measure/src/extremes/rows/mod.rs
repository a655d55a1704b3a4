//! The rows, a file per part of the table, and the ordinary scenes that they are made from.

mod attributes;
mod colliders;
mod forces;
mod input;
mod mass;
mod mesh;
mod scale;
mod thickness;
mod time;

use super::row::{Assertion, CostUnit, Expectation, Recovery, Side, StressCase};
use super::scene::TestScene;
use super::timeline::Timeline;

/// All rows, in the order of the table.
pub fn rows() -> impl Iterator<Item = &'static StressCase> {
    let parts: [&'static [StressCase]; 9] = [
        &mass::ROWS,
        &attributes::ROWS,
        &time::ROWS,
        &scale::ROWS,
        &forces::ROWS,
        &thickness::ROWS,
        &mesh::ROWS,
        &colliders::ROWS,
        &input::ROWS,
    ];
    parts.into_iter().flatten()
}

/// The row of this name.
pub fn named(name: &str) -> Option<&'static StressCase> {
    rows().find(|row| row.name == name)
}

/// A row whose scene runs; the rest is as most rows have it, and each changes what differs.
const RUNS: Runs = Runs {
    scene: || TestScene::new(0, ""),
    baseline: || banner("", "").scene(96),
    cost: CostUnit::Frame,
    initial_energy: 0.0,
    recovery: None,
    assertions: &[],
    warnings: &[],
};

/// A row on a sheet that lies on a ball: nothing crosses, and it costs no more than three such sheets.
const DRAPED: Runs =
    Runs { baseline: || drape("", "", "").scene(96), assertions: &[NO_UNRESOLVED_PAIRS], ..RUNS };

/// What [`Expectation::Runs`] is made from, so that a row need only say what is its own.
struct Runs {
    scene: fn() -> TestScene,
    baseline: fn() -> TestScene,
    cost: CostUnit,
    initial_energy: f64,
    recovery: Option<Recovery>,
    assertions: &'static [Assertion],
    warnings: &'static [&'static str],
}

impl Runs {
    const fn expectation(self) -> Expectation {
        let Self { scene, baseline, cost, initial_energy, recovery, assertions, warnings } = self;
        Expectation::Runs { scene, baseline, cost, initial_energy, recovery, assertions, warnings }
    }
}

/// A bound that a figure must not be above.
const fn at_most(what: &'static str, limit: f64, figure: fn(&Timeline, &Timeline) -> f64) -> Assertion {
    Assertion { what, figure, side: Side::AtMost, limit }
}

/// A bound that a figure must not be below.
const fn at_least(what: &'static str, limit: f64, figure: fn(&Timeline, &Timeline) -> f64) -> Assertion {
    Assertion { what, figure, side: Side::AtLeast, limit }
}

/// The safeguard keeps every pair of elements apart.
const NO_UNRESOLVED_PAIRS: Assertion = at_most("pairs unresolved", 0.0, |timeline, _| {
    timeline.sum(|record| record.report.pairs_unresolved) as f64
});

/// Nodes of a scene, as text.
struct Nodes(String);

impl Nodes {
    /// With more nodes.
    fn with(mut self, nodes: &str) -> Self {
        for line in nodes.lines().map(str::trim).filter(|line| !line.is_empty()) {
            self.0 += "        ";
            self.0 += line;
            self.0.push('\n');
        }
        self
    }

    /// As a scene of so many frames.
    fn scene(self, frames: i64) -> TestScene {
        TestScene::new(frames, self.0)
    }
}

/// A nucleus with these attributes.
fn nucleus(attributes: &str) -> Nodes {
    Nodes(String::new()).with(&format!("\"nucleus1\": nucleus({attributes}),"))
}

/// A banner of a metre, 17 points each way, hung from its upper edge. Attributes of the nucleus and of the cloth. Like
/// all ordinary scenes here it is damped by the air in every direction, so that it is at rest two seconds after the cause of
/// its motion has ended: drag takes a share of 3 of the speed in a second.
fn banner(solver: &str, cloth: &str) -> Nodes {
    let damp = if cloth.contains("damp:") { "" } else { "damp: 1, " };
    let tangential = if cloth.contains("tangentialDrag:") { "" } else { "tangentialDrag: 0.5, " };
    nucleus(solver).with(&format!(
        "\"sheet\": polyPlane(width: 1, height: 1, subdivisions: (16, 16), rotate: (-90, 0, 0)),
        \"banner\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, {damp}{tangential}{cloth}),
        \"rail\": dynamicConstraint(constraintType: transform, components: [\"banner.vtx[0:16]\"]),"
    ))
}

/// A cloth made from an OBJ file that lies flat a metre wide; turned up, it hangs from these of its points.
fn from_file(file: &str, held: &str, solver: &str, cloth: &str) -> Nodes {
    nucleus(solver).with(&format!(
        "\"sheet\": mesh(file: \"{file}\", rotate: (-90, 0, 0)),
        \"banner\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, tangentialDrag: 0.5, {cloth}),
        \"rail\": dynamicConstraint(constraintType: transform, components: [\"banner.{held}\"]),"
    ))
}

/// Such a cloth for four seconds, with nothing else set.
fn hung(file: &'static str, held: &str, mesh: String) -> TestScene {
    from_file(file, held, "", "").scene(96).mesh(file, mesh)
}

/// A sheet of a metre that falls from 10 cm on the ground.
fn floor(solver: &str, cloth: &str) -> Nodes {
    nucleus(&format!("usePlane: true, planeFriction: 0.5, {solver}")).with(&format!(
        "\"sheet\": polyPlane(width: 1, height: 1, subdivisions: (16, 16), translate: (0, 0.1, 0)),
        \"rug\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, tangentialDrag: 0.5, {cloth}),"
    ))
}

/// A sheet of a metre that falls on a ball of 30 cm that rests on the ground.
fn drape(solver: &str, cloth: &str, ball: &str) -> Nodes {
    nucleus(&format!("usePlane: true, {solver}")).with(&format!(
        "\"sheet\": polyPlane(width: 1, height: 1, subdivisions: (16, 16), translate: (0, 0.65, 0)),
        \"cloth\": nCloth(inputMesh: \"sheet\", pointMass: 0.2, damp: 1, tangentialDrag: 0.5, friction: 0.5, {cloth}),
        \"sphere\": polySphere(radius: 0.3, subdivisions: (20, 12), {}),
        \"ball\": nRigid(inputMesh: \"sphere\", friction: 0.5),",
        if ball.contains("translate") { ball.to_owned() } else { format!("translate: (0, 0.3, 0), {ball}") }
    ))
}
