//! The workloads as scenes: what is timed is what an artist would run. Metres.

use std::fmt::{self, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs, io, process};

use anyhow::bail;
use nalgebra::{Rotation3, Vector3};
use nucleus_core::Surface;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;

use super::Workload;
use crate::bench::ball::Ball;
use crate::bench::mesh::{self, Cells};
use crate::bench::workload::{DENSITY, GRAVITY};

/// What is set for a run.
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

/// A folder for meshes, removed when it is dropped.
pub struct MeshFolder(PathBuf);

impl MeshFolder {
    /// A folder of its own.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn new() -> io::Result<Self> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let name = format!("nucleus-bench-{}-{}", process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let folder = env::temp_dir().join(name);
        fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }
}

impl Drop for MeshFolder {
    fn drop(&mut self) {
        // What is left in a folder for what may be lost does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The sheet that errors are measured on.
pub fn lowest_sheet(workload: Workload, size: u32) -> Surface {
    sheet(workload, size, 0)
}

/// Sheet `k` of a workload, counted from below.
fn sheet(workload: Workload, n: u32, k: u32) -> Surface {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    if workload == Workload::Shot {
        return mesh::sheet(n, Cells::Triangles, Vector3::zeros(), x, -y);
    }
    let corner = Vector3::new(-0.75, 0.90 + 0.05 * f64::from(k), -0.75);
    let mut sheet = mesh::sheet(n, Cells::Triangles, corner, x * 1.5, z * 1.5);
    let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), -0.2 * f64::from(k));
    sheet.positions.iter_mut().for_each(|place| *place = turn * *place);
    sheet
}

/// The scene of a workload with `n` by `n` points a sheet, ready to run.
///
/// # Errors
/// When a mesh cannot be written or the scene is refused.
pub fn program(workload: Workload, n: u32, setting: Setting, place: MeshFolder) -> anyhow::Result<Program> {
    let sheets = if workload == Workload::Layers { 5 } else { 1 };
    let draft = Draft {
        frames: workload.frames(),
        plane: workload != Workload::Shot,
        sheets: (0..sheets).map(|k| sheet(workload, n, k)).collect(),
        other_nodes: other_nodes(workload, n, &place)?,
    };
    draft.program(setting, &place)
}

/// A scene that is yet to be written.
pub struct Draft {
    pub frames: u32,
    /// Whether there is a ground at height 0.
    pub plane: bool,
    /// The cloths, as they start.
    pub sheets: Vec<Surface>,
    /// What they meet and what holds them, as nodes.
    pub other_nodes: String,
}

impl Draft {
    /// Writes the scene and compiles it; both sides of a contact together keep 5 mm.
    ///
    /// # Errors
    /// When a mesh cannot be written or the scene is refused.
    pub fn program(&self, setting: Setting, place: &MeshFolder) -> anyhow::Result<Program> {
        let Setting { evaluations, self_collide } = setting;
        let mut nodes = String::new();
        for (k, sheet) in self.sheets.iter().enumerate() {
            fs::write(place.0.join(format!("sheet{k}.obj")), obj(sheet))?;
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
        let file = place.0.join("workload.ron");
        match read_scene_text(&text, &file).and_then(|(scene, _)| compile(&scene)) {
            Ok(program) => Ok(program),
            Err(mistakes) => bail!("a scene of the bench is refused: {mistakes:?}"),
        }
    }
}

/// What the sheets meet and what holds them.
fn other_nodes(workload: Workload, n: u32, place: &MeshFolder) -> anyhow::Result<String> {
    let ball = workload.ball();
    fs::write(place.0.join("ball.obj"), obj(&mesh::sphere(ball.radius, ball.start.into())))?;
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

/// How a ball that flies is animated over so many frames; a ball that rests is not.
fn flight(ball: &Ball, frames: u32) -> String {
    if ball.flight == [0.0; 3] {
        return String::new();
    }
    let [x, y, z] = ball.flight.map(|way| way * f64::from(frames));
    format!(", translate: keys([(1, (0, 0, 0), linear), ({}, ({x}, {y}, {z}), linear)])", frames + 1)
}

fn obj(surface: &Surface) -> String {
    let mut text = String::new();
    for place in &surface.positions {
        text += &format!("v {} {} {}\n", place.x, place.y, place.z);
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
        let mut places = Vec::new();
        run.state().collider_positions(ColliderId(0), 1.0, &mut places);
        let pole = |place: &[f32; 3]| Vector3::from(place.map(f64::from));
        (pole(&places[0]) + pole(&places[places.len() - 1])) / 2.0
    }

    #[test]
    fn the_ball_that_errors_are_measured_against_is_the_one_that_flies() {
        for workload in [Workload::Folds, Workload::Shot] {
            let setting = Setting { evaluations: 6, self_collide: false };
            let program = program(workload, 5, setting, MeshFolder::new().unwrap()).unwrap();
            let mut run = Simulation::<f32>::new(&program, 1);
            for frame in 1..=workload.frames().min(24) {
                run.advance(&mut ());
                let off = (centre(&run) - workload.ball().centre(f64::from(frame))).norm();
                assert!(off < 1e-5, "{workload:?}, frame {frame}: {off} m off");
            }
        }
    }
}
