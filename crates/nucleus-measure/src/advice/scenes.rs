//! The scenes of the experiments.

use nucleus_graph::scene::read_scene_text;

use crate::trade::run::{Run, run_setting};
use crate::trade::{Benchmark, Reading};

/// Parameters of an experiment.
#[derive(Debug, Clone, Copy)]
pub struct Parameters {
    pub reading: Reading,
    pub substeps: u32,
    pub collision_iterations: u32,
    pub stretch: f64,
    pub evaluations: f64,
}

impl Parameters {
    /// Maya's defaults.
    pub const fn new(reading: Reading) -> Self {
        Self { reading, substeps: 3, collision_iterations: 4, stretch: 20.0, evaluations: 96.0 }
    }

    fn nucleus(&self) -> String {
        let reading = if self.reading == Reading::Classic { "classic" } else { "physical" };
        format!(
            "nucleus(spaceScale: 0.01, resistanceModel: {reading}, subSteps: {}, maxCollisionIterations: {}, evaluations: {})",
            self.substeps, self.collision_iterations, self.evaluations
        )
    }
}

/// One second of a sheet of 0.6 m that a ball strikes at 0.9 m/s.
pub fn drape(parameters: &Parameters) -> Run {
    run(&format!(
        r#"Scene(time: (start: 1, end: 25, fps: 24), nodes: {{
        "nucleus1": {},
        "sheet": polyPlane(width: 60, height: 60, subdivisions: (24, 24), translate: (0, 21, 0)),
        "cloth": nCloth(inputMesh: "sheet", thickness: 0.6, stretchResistance: {stretch}, compressionResistance: {half}, friction: 0.3),
        "sphere": polySphere(radius: 20, subdivisions: (24, 16), translateY: keys([(1, 0), (13, 45), (25, 45)])),
        "ball": nRigid(inputMesh: "sphere", thickness: 0.4, friction: 0.3),
    }})"#,
        parameters.nucleus(),
        stretch = parameters.stretch,
        half = parameters.stretch / 2.0
    ))
}

/// One second of a strip of `cells` cells that hangs from its upper edge.
pub fn strip(parameters: &Parameters, cells: u32) -> Run {
    run(&format!(
        r#"Scene(time: (start: 1, end: 25, fps: 24), nodes: {{
        "nucleus1": {},
        "plane": polyPlane(width: 4, height: {cells}, subdivisions: (4, {cells}), rotate: (90, 0, 0)),
        "cloth": nCloth(inputMesh: "plane", stretchResistance: {stretch}, compressionResistance: {stretch}, bendResistance: 0, damp: 0.5, selfCollide: false),
        "rail": dynamicConstraint(constraintType: transform, components: ["cloth.vtx[0:4]"]),
    }})"#,
        parameters.nucleus(),
        stretch = parameters.stretch,
    ))
}

/// One second of points without links that fall on a ball and on the ground.
pub fn particles(parameters: &Parameters) -> Run {
    run(&format!(
        r#"Scene(time: (start: 1, end: 25, fps: 24), nodes: {{
        "nucleus1": {},
        "grid": polyPlane(width: 30, height: 30, subdivisions: (15, 15), translate: (0, 40, 0)),
        "points": nCloth(inputMesh: "grid", thickness: 0.5, stretchResistance: 0, compressionResistance: 0, bendResistance: 0, stretchDamp: 0, selfCollide: false),
        "sphere": polySphere(radius: 20, subdivisions: (24, 16)),
        "ball": nRigid(inputMesh: "sphere", thickness: 0.5),
    }})"#,
        parameters.nucleus().replace("nucleus(", "nucleus(usePlane: true, planeOrigin: (0, -20, 0), "),
    ))
}

/// Runs a scene; panics if it does not compile, which is a bug of this module.
fn run(text: &str) -> Run {
    let (scene, _) =
        read_scene_text(text, "experiment.ron".as_ref()).unwrap_or_else(|found| panic!("{found:?}"));
    let benchmark = Benchmark::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let setting = benchmark.own();
    let followed = run_setting::<f32>(&benchmark, &setting, benchmark.program(), None, &|| true);
    let (run, _) = followed.unwrap_or_else(|| panic!("never cancelled"));
    run
}

/// 99th percentile of strain, RMS over the frames.
pub fn strain(run: &Run) -> f64 {
    crate::metrics::root_mean_square(run.frames.iter().map(|frame| frame.strain))
}

/// The same over the last quarter of the frames.
pub fn late_strain(run: &Run) -> f64 {
    let from = run.frames.len() - run.frames.len() / 4;
    crate::metrics::root_mean_square(run.frames[from..].iter().map(|frame| frame.strain))
}

/// Mean number of candidate pairs per broad-phase query.
pub fn pairs_per_query(run: &Run) -> f64 {
    run.pairs as f64 / run.queries.max(1) as f64
}
