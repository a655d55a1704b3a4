//! How long a scene of 1,000 nodes and a mesh of a million vertices takes to read and compile, beside reading
//! the mesh alone; a usual scene; and the memory of the solver of such a mesh. Medians of processor time, all in one
//! run.
//!
//! ```text
//! cargo run --release -p nucleus-graph --example reading
//! ```

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;
use std::{env, fs};

use nucleus_graph::Simulation;
use nucleus_graph::compile::compile;
use nucleus_graph::mesh::read_obj;
use nucleus_graph::scene::read_scene_text;

const SIDE: usize = 1000;
const NODES: usize = 1000;
const ROUNDS: usize = 5;

fn main() -> std::io::Result<()> {
    let folder = env::temp_dir().join("nucleus-reading");
    fs::create_dir_all(&folder)?;
    let mesh = folder.join("million.obj");
    fs::write(&mesh, sheet(1e-3))?;
    fs::write(folder.join("flat.obj"), sheet(0.0))?;
    let file = folder.join("scene.ron");
    let text = scene();
    let (mut alone, mut whole) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        alone.push(time(|| drop(read_obj(&mesh).expect("a mesh"))));
        whole.push(time(|| check(&text, &file)));
    }
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cloth/flag.ron");
    let usual_text = fs::read_to_string(&usual)?;
    let usual_time: Vec<Duration> = (0..ROUNDS).map(|_| time(|| check(&usual_text, &usual))).collect();
    let (alone, whole, usual_time) = (median(alone), median(whole), median(usual_time));
    println!("mesh of {} vertices alone: {alone:?}", SIDE * SIDE);
    println!(
        "scene of {NODES} nodes with it: {whole:?}, {:.2} times as long",
        whole.as_secs_f64() / alone.as_secs_f64()
    );
    println!("the flag of the gallery: {usual_time:?}");
    tell_memory("a run of a flat mesh", &scene_of("flat.obj", ""), &file);
    tell_memory("a run of this mesh, whose hinges are bent at rest", &scene_of("million.obj", ""), &file);
    tell_memory(
        "with a mass map",
        &scene_of("million.obj", r#", massMapType: perVertex, massPerVertex: expression("1 + x")"#),
        &file,
    );
    fs::remove_dir_all(&folder)
}

fn check(text: &str, file: &Path) {
    let (scene, _) = read_scene_text(text, file).unwrap_or_else(|mistakes| panic!("{:?}", mistakes.first()));
    drop(compile(&scene).unwrap_or_else(|mistakes| panic!("{:?}", mistakes.first())));
}

fn time(work: impl FnOnce()) -> Duration {
    let begin = processor_time();
    work();
    processor_time() - begin
}

/// Of this thread: other programs do not count.
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Bytes that the process holds in memory; nothing where the system does not tell.
fn resident() -> Option<usize> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<usize>().ok()? * 1024)
}

/// What the solver of a scene takes, its program and the text left out.
fn tell_memory(what: &str, text: &str, file: &Path) {
    let (scene, _) = read_scene_text(text, file).unwrap_or_else(|mistakes| panic!("{:?}", mistakes.first()));
    let program = compile(&scene).unwrap_or_else(|mistakes| panic!("{:?}", mistakes.first()));
    let before = resident();
    let mut run: Simulation = Simulation::new(&program, 1);
    run.advance(&mut ());
    let taken = before.zip(resident()).map(|(before, now)| now.saturating_sub(before) / (SIDE * SIDE));
    println!("{what} after a frame, beside its program: {taken:?} bytes a vertex");
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

/// A square sheet with a million vertices, with bumps of up to six times this height in metres.
fn sheet(height: f64) -> String {
    let mut text = String::new();
    for z in 0..SIDE {
        for x in 0..SIDE {
            let _ = writeln!(
                text,
                "v {:.6} {:.6} {:.6}",
                x as f64 * 0.01,
                (x * z % 7) as f64 * height,
                z as f64 * 0.01
            );
        }
    }
    for z in 0..SIDE - 1 {
        for x in 0..SIDE - 1 {
            let a = z * SIDE + x + 1;
            let _ = writeln!(text, "f {a} {} {} {}", a + 1, a + SIDE + 1, a + SIDE);
        }
    }
    text
}

/// The sheet as cloth, alone.
fn scene_of(mesh: &str, fields: &str) -> String {
    format!(
        r#"Scene(time: (start: 1, end: 24, fps: 24), nodes: {{"n": nucleus(evaluations: 1), "sheet": mesh(file: "{mesh}"),
           "cloth": nCloth(inputMesh: "sheet", selfCollide: false, preset: "silk"{fields})}})"#
    )
}

/// The sheet as cloth, and 330 colliders with their meshes and transforms.
fn scene() -> String {
    let mut nodes = String::from(
        r#""n": nucleus(), "sheet": mesh(file: "million.obj"), "cloth": nCloth(inputMesh: "sheet", preset: "silk"),"#,
    );
    for k in 0..(NODES - 3) / 3 {
        let _ = write!(
            nodes,
            r#""t{k}": transform(translate: ({k}, 0, 0), ry: keys([(1, 0), (24, {k}, auto)])),
               "b{k}": polyCube(parent: "t{k}", width: 0.5, translateY: -3),
               "r{k}": nRigid(inputMesh: "b{k}", friction: 0.3, thickness: 0.01),"#
        );
    }
    format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}}, checks: [finite])")
}
