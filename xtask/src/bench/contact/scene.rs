//! The workloads as scenes, run through the graph crate. Metres.

use std::fmt::{self, Write};
use std::fs;

use anyhow::bail;
use nalgebra::{Rotation3, Vector3};
use nucleus_core::Surface;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;

use tempfile::TempDir;

use super::workload::Workload;
use crate::bench::mesh::{self, Cells};
use crate::bench::workload::{Ball, DENSITY, GRAVITY};

/// Settings of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Evaluations in 1/24 s, over 3 substeps.
    pub evaluations: u32,
    pub self_collide: bool,
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} evaluations", self.evaluations)
    }
}

/// The sheet whose errors are measured.
pub fn lowest_sheet(workload: Workload, size: u32) -> Surface {
    sheet(workload, size, 0)
}

/// Sheet `k` of a workload, from below.
fn sheet(workload: Workload, n: u32, k: u32) -> Surface {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    if workload == Workload::Shot {
        return mesh::sheet(n, Cells::Triangles, Vector3::zeros(), x, -y);
    }
    let corner = Vector3::new(-0.75, 0.90 + 0.05 * f64::from(k), -0.75);
    let mut sheet = mesh::sheet(n, Cells::Triangles, corner, x * 1.5, z * 1.5);
    let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), -0.2 * f64::from(k));
    sheet.positions.iter_mut().for_each(|point| *point = turn * *point);
    sheet
}

/// The compiled scene of a workload with `n` by `n` points per sheet.
///
/// # Errors
/// When a mesh cannot be written or the scene is rejected.
pub fn program(workload: Workload, n: u32, setting: Setting, folder: TempDir) -> anyhow::Result<Program> {
    let sheets = if workload == Workload::Layers { 5 } else { 1 };
    let draft = Draft {
        frames: workload.frames(),
        plane: workload != Workload::Shot,
        sheets: (0..sheets).map(|k| sheet(workload, n, k)).collect(),
        other_nodes: other_nodes(workload, n, &folder)?,
    };
    draft.program(setting, &folder)
}

/// Parts of a scene.
pub struct Draft {
    pub frames: u32,
    /// Whether there is a ground plane at height 0.
    pub plane: bool,
    /// Initial meshes of the cloths.
    pub sheets: Vec<Surface>,
    /// Nodes of colliders and constraints.
    pub other_nodes: String,
}

impl Draft {
    /// Writes the meshes and compiles the scene; the contact thickness of a pair is 5 mm.
    ///
    /// # Errors
    /// When a mesh cannot be written or the scene is rejected.
    pub fn program(&self, setting: Setting, folder: &TempDir) -> anyhow::Result<Program> {
        let Setting { evaluations, self_collide } = setting;
        let mut nodes = String::new();
        for (k, sheet) in self.sheets.iter().enumerate() {
            fs::write(folder.path().join(format!("sheet{k}.obj")), obj(sheet))?;
            write!(
                nodes,
                r#""mesh{k}": mesh(file: "sheet{k}.obj"),
                "sheet{k}": nCloth(inputMesh: "mesh{k}", pointMass: {DENSITY}, stretchResistance: 20,
                    compressionResistance: 20, bendResistance: 0, stretchDamp: 0.1, drag: 0, lift: 0,
                    thickness: 0.0025, friction: 0.25, selfCollide: {self_collide}),"#
            )?;
        }
        let Self { frames, plane, other_nodes, .. } = self;
        let text = format!(
            r#"Scene(time: (start: 1, end: {}, fps: 24), nodes: {{
                "nucleus1": nucleus(gravity: {GRAVITY}, usePlane: {plane}, planeFriction: 0.25, evaluations: {evaluations}),
                {nodes}
                {other_nodes}
            }})"#,
            frames + 1
        );
        let file = folder.path().join("workload.ron");
        match read_scene_text(&text, &file).and_then(|(scene, _)| compile(&scene)) {
            Ok(program) => Ok(program),
            Err(mistakes) => bail!("a scene of the bench is refused: {mistakes:?}"),
        }
    }
}

/// Nodes of the ball and of constraints.
fn other_nodes(workload: Workload, n: u32, folder: &TempDir) -> anyhow::Result<String> {
    let ball = workload.ball();
    fs::write(folder.path().join("ball.obj"), obj(&mesh::sphere(ball.radius, ball.start.into())))?;
    let way = flight(&ball, workload.frames());
    let mut nodes = format!(
        r#""ballMesh": mesh(file: "ball.obj"{way}),
        "ball": nRigid(inputMesh: "ballMesh", thickness: 0.0025, friction: 0.25),"#
    );
    if workload == Workload::Shot {
        let last = n - 1;
        write!(
            nodes,
            r#""corners": dynamicConstraint(constraintType: transform, components: ["sheet0.vtx[0]", "sheet0.vtx[{last}]"]),"#
        )?;
    }
    Ok(nodes)
}

/// Animation of a moving ball; empty for a ball at rest.
fn flight(ball: &Ball, frames: u32) -> String {
    if ball.flight == [0.0; 3] {
        return String::new();
    }
    let [x, y, z] = ball.flight.map(|way| way * f64::from(frames));
    format!(", translate: keys([(1, (0, 0, 0), linear), ({}, ({x}, {y}, {z}), linear)])", frames + 1)
}

fn obj(surface: &Surface) -> String {
    let mut text = String::new();
    for point in &surface.positions {
        text += &format!("v {} {} {}\n", point.x, point.y, point.z);
    }
    for face in surface.faces.iter() {
        let corners: Vec<String> = face.iter().map(|k| (k + 1).to_string()).collect();
        text += &format!("f {}\n", corners.join(" "));
    }
    text
}

#[cfg(test)]
mod tests {
    use nucleus_core::ColliderId;
    use nucleus_graph::Simulation;

    use super::*;

    /// The middle of the poles of the ball of a run, in metres.
    fn centre(run: &Simulation<f32>) -> Vector3<f64> {
        let mut positions = Vec::new();
        run.state().collider_positions(ColliderId(0), 1.0, &mut positions);
        let pole = |point: &[f32; 3]| Vector3::from(point.map(f64::from));
        (pole(&positions[0]) + pole(&positions[positions.len() - 1])) / 2.0
    }

    #[test]
    fn the_ball_that_errors_are_measured_against_is_the_one_that_flies() {
        for workload in [Workload::Folds, Workload::Shot] {
            let setting = Setting { evaluations: 6, self_collide: false };
            let program = program(workload, 5, setting, tempfile::tempdir().unwrap()).unwrap();
            let mut run = Simulation::<f32>::new(&program, 1);
            for frame in 1..=workload.frames().min(24) {
                run.advance(&mut ());
                let off = (centre(&run) - workload.ball().centre(f64::from(frame))).norm();
                assert!(off < 1e-5, "{workload:?}, frame {frame}: {off} m off");
            }
        }
    }
}
