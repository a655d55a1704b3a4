//! Contact scenes of the gallery, on one thread and on more: cost by stage, candidate pairs, and identical bits.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail, ensure};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;

use super::report::Report;
use super::table::{StageRow, Table, figure};
use super::timed::Timed;

/// Default folder of scenes, from the root of the repository.
const FOLDER: &str = "scenes/collision";

/// Runs of a scene, one per number of threads.
struct Runs {
    name: String,
    runs: Vec<Timed>,
}

/// Runs these scenes to their ends, or those of the gallery if there are none.
///
/// # Errors
/// When a scene cannot be read or compiled, or threads change its result.
pub fn run(files: &[PathBuf], threads: &[u32], report: &mut Report) -> anyhow::Result<()> {
    let found =
        if files.is_empty() { of_the_gallery(&crate::files::root().join(FOLDER))? } else { files.to_vec() };
    let all: anyhow::Result<Vec<Runs>> = found.iter().map(|file| Runs::new(file, threads)).collect();
    let all = all?;
    report.show(time_table(&all));
    report.show(stage_table(&all));
    Ok(())
}

/// The scenes in a folder, in order of their names.
fn of_the_gallery(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("`{}` cannot be listed", folder.display()))? {
        let path = entry?.path();
        if path.extension().is_some_and(|end| end == "ron") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

impl Runs {
    fn new(file: &Path, threads: &[u32]) -> anyhow::Result<Self> {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let program = program(file)?;
        let mut runs: Vec<Timed> = Vec::new();
        for &threads in threads {
            let run = Timed::run(&program, threads, None, |_| {});
            let (ms, hash) = (figure(run.ms()), run.hash);
            eprintln!("{name}, threads {threads}: {ms} ms per frame, {} frames, {hash:016x}", run.frames);
            runs.push(run);
        }
        same_bits(&name, &runs)?;
        Ok(Self { name, runs })
    }
}

fn program(file: &Path) -> anyhow::Result<Program> {
    let text = fs::read_to_string(file).with_context(|| format!("`{}` cannot be read", file.display()))?;
    match read_scene_text(&text, file).and_then(|(scene, _)| compile(&scene)) {
        Ok(program) => Ok(program),
        Err(mistakes) => bail!("`{}` is refused: {mistakes:?}", file.display()),
    }
}

fn same_bits(name: &str, runs: &[Timed]) -> anyhow::Result<()> {
    for pair in runs.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        ensure!(
            a.hash == b.hash,
            "{name}: hash {:016x} on {} threads, {:016x} on {}",
            a.hash,
            a.threads,
            b.hash,
            b.threads
        );
    }
    Ok(())
}

fn time_table(all: &[Runs]) -> Table {
    let head = [
        "scene",
        "threads",
        "frames",
        "ms",
        "wall",
        "times as fast",
        "queries",
        "pairs",
        "most pairs",
        "MB",
        "hash",
    ];
    let mut table = Table::new("Contact scenes of the gallery", &head);
    for Runs { name, runs } in all {
        for run in runs {
            let gain = runs[0].timing.wall / run.timing.wall;
            let times = [run.ms(), 1e3 * run.timing.wall, gain, run.queries, run.pairs].map(figure);
            let whole = [run.threads, run.frames].map(|count| count.to_string());
            let rest = [run.most_pairs.to_string(), figure(run.megabytes()), format!("{:016x}", run.hash)];
            table.row([name.clone()].into_iter().chain(whole).chain(times).chain(rest));
        }
    }
    table
}

fn stage_table(all: &[Runs]) -> Table {
    let row =
        |name: &str, run: &Timed| (vec![name.to_owned(), run.threads.to_string()], run.ms(), run.shares);
    let rows: Vec<StageRow> =
        all.iter().flat_map(|Runs { name, runs }| runs.iter().map(move |run| row(name, run))).collect();
    Table::by_stage("Contact scenes: milliseconds per frame by stage", &["scene", "threads"], &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"Scene(time: (start: 1, end: 4, fps: 24), nodes: {
        "nucleus1": nucleus(usePlane: true, evaluations: 6),
        "plane": polyPlane(width: 1, height: 1, subdivisions: (6, 6), translate: (0, 0.02, 0)),
        "cloth": nCloth(inputMesh: "plane", thickness: 0.01),
    })"#;

    #[test]
    fn a_scene_is_run_to_its_end_with_the_same_bits_on_all_threads() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("small.ron");
        fs::write(&file, SCENE).unwrap();
        let mut report = Report::default();
        run(&[file], &[1, 3], &mut report).unwrap();
        let [times, stages] = &report.tables[..] else { panic!("{:?}", report.tables) };
        assert_eq!(times.rows.len(), 2);
        for (row, threads) in times.rows.iter().zip(["1", "3"]) {
            assert_eq!(row[..3], ["small", threads, "3"]);
            assert_eq!(row.last(), times.rows[0].last());
        }
        assert_eq!(stages.rows.len(), 2);
    }

    #[test]
    fn a_result_that_depends_on_threads_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("small.ron");
        fs::write(&file, SCENE).unwrap();
        let Runs { runs, .. } = Runs::new(&file, &[1]).unwrap();
        let other = Timed { hash: runs[0].hash ^ 1, ..runs[0].clone() };
        assert!(same_bits("small", &[runs[0].clone(), runs[0].clone()]).is_ok());
        assert!(same_bits("small", &[runs[0].clone(), other]).is_err());
    }

    #[test]
    fn a_scene_with_errors_is_not_run() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("wrong.ron");
        fs::write(&file, "Scene(nodes: {})").unwrap();
        assert!(run(&[file], &[1], &mut Report::default()).is_err());
    }

    #[test]
    fn the_scenes_of_the_gallery_are_all_found() {
        let found = of_the_gallery(&crate::files::root().join(FOLDER)).unwrap();
        let names: Vec<_> = found.iter().map(|file| file.file_stem().unwrap().to_string_lossy()).collect();
        assert!(names.is_sorted() && names.iter().any(|name| name == "reef_knot"), "{names:?}");
    }
}
