//! From the options of `nucleus wedge` to a plan, with everything checked before any run starts.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use nucleus_graph::attributes::Attribute;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Assignment, Scene, assigned, read_scene_within};
use nucleus_measure::result_cache::Fingerprint;
use nucleus_wedge::{Axis, Design, Plan, PlanHeader, PlannedRun, Row, Values, read_table, run_name};

use super::options::Wedge;
use crate::options::FrameRange;
use crate::output::say;
use crate::{files, recording};

/// The most different values of an attribute for which the whole scene is compiled before any run starts.
const MAX_COMPILED: usize = 16;

/// Bytes that a run takes besides its scene.
const PROCESS: u64 = 50_000_000;

/// Plans the runs of a scene. Returns `None` if the scene has errors, which are reported.
pub fn plan(wedge: &Wedge, scene_path: &Path) -> Result<Option<Plan>> {
    let Some((scene, program, text)) = files::open_scene(scene_path, wedge.frames)?.report()? else {
        return Ok(None);
    };
    recording::frames(&program)?;
    let (columns, rows) = rows(wedge, &scene)?;
    check_values(&scene, &text, &columns, &rows)?;
    let title = scene_path.to_str().context("the path of the scene is not UTF-8")?.to_owned();
    let directory = std::env::current_dir().context("the working folder is unknown")?;
    let count = rows.len();
    let run = |(run, row): (u32, Row)| PlannedRun {
        run,
        name: run_name(run, count),
        arguments: arguments(wedge, &title, &columns, &row),
        values: row.values,
        seed: row.seed,
    };
    let runs = (0..).zip(rows).map(run).collect();
    let header = PlanHeader {
        fingerprint: fingerprint(&text, scene_path, &program),
        memory: memory(&program),
        ..PlanHeader::new(title, directory, columns)
    };
    Ok(Some(Plan { header, runs }))
}

/// A fingerprint of all that a run takes from a scene: nodes with their meshes and maps, time, record and checks as its
/// text has them.
pub fn fingerprint(text: &str, path: &Path, program: &Program) -> String {
    let nodes = recording::fingerprint(program);
    // `--frames` belongs to the arguments of the runs, so the time is read without it.
    let rest = match read_scene_within(text, path, files::memory_limit()) {
        Ok((Scene { time, every, record, checks, .. }, _)) => {
            let checks: Vec<String> = checks.iter().map(ToString::to_string).collect();
            format!("{time:?} {every} {record:?} {}", checks.join(" "))
        }
        Err(_) => String::new(),
    };
    Fingerprint::default().bytes(format!("{nodes} {rest}").as_bytes()).name()
}

fn memory(program: &Program) -> u64 {
    program.memory().0.saturating_add(PROCESS)
}

/// The columns and rows of the table.
fn rows(wedge: &Wedge, scene: &Scene) -> Result<(Vec<String>, Vec<Row>)> {
    let seeds = |row: Row| {
        let count = wedge.seeds.map_or(1, |seeds| seeds.max(1));
        let seed = move |k: u32| wedge.seeds.map(|_| wedge.seed.saturating_add(k));
        (0..count).map(move |k| Row { seed: seed(k), ..row.clone() })
    };
    if let Some(path) = &wedge.table {
        let named = || format!("`{}`", path.display());
        let text = std::fs::read_to_string(path).with_context(named)?;
        let (columns, rows) = read_table(&text, &scene.graph).with_context(named)?;
        return Ok((columns, rows.into_iter().flat_map(seeds).collect()));
    }
    let axes = wedge.vary.iter().map(|text| text.parse::<Axis>().context("`--vary`"));
    let mut design = Design {
        axes: axes.collect::<Result<_>>()?,
        samples: wedge.samples,
        sampling: wedge.sampling.into(),
        seed: wedge.seed,
        seeds: wedge.seeds,
    };
    design.resolve(&scene.graph)?;
    for axis in &design.axes {
        warn_without_effect(axis, scene);
    }
    Ok((design.columns(), design.rows()))
}

/// Warns of an attribute that changes nothing.
fn warn_without_effect(axis: &Axis, scene: &Scene) {
    let Some(id) = scene.graph.find(&axis.node) else { return };
    let node_type = scene.graph.node(id).node_type();
    let row: Option<&Attribute> = node_type.attribute(&axis.attribute);
    if let Some(lack) = row.and_then(|row| row.effect.lack()) {
        say!("warning: `{}` {lack}", axis.name());
    }
    if let Values::List(values) = &axis.values
        && values.iter().collect::<BTreeSet<_>>().len() < values.len()
    {
        say!("warning: `{}` has the same value several times", axis.name());
    }
}

/// Compiles the scene with each value of an attribute, so that nothing starts that cannot run. Of many values, which are
/// checked against their attribute alone, the first and last few are compiled.
fn check_values(scene: &Scene, text: &str, columns: &[String], rows: &[Row]) -> Result<()> {
    for (column, name) in columns.iter().enumerate() {
        let values: BTreeSet<&str> = rows.iter().map(|row| row.values[column].as_str()).collect();
        let half = MAX_COMPILED / 2;
        let few = values.len() <= MAX_COMPILED;
        let picked = values.iter().enumerate().filter(|(k, _)| few || *k < half || *k >= values.len() - half);
        for (_, value) in picked {
            check_value(scene, text, &assignment(name, value))?;
        }
    }
    Ok(())
}

fn check_value(scene: &Scene, text: &str, assignment: &Assignment) -> Result<()> {
    let refused = |found: Vec<nucleus_graph::scene::Diagnostic>| {
        let first = found.into_iter().find(|one| one.severity == nucleus_graph::scene::Severity::Error);
        let message = first.map(|first| first.message).unwrap_or_default();
        anyhow!("`{assignment}`: {message}")
    };
    let text = assigned(text, std::slice::from_ref(assignment))?;
    let (read, _) = read_scene_within(&text, scene.source.file(), files::memory_limit()).map_err(refused)?;
    compile(&read).map(drop).map_err(refused)
}

fn assignment(column: &str, value: &str) -> Assignment {
    let (node, attribute) = column.split_once('.').unwrap_or((column, ""));
    Assignment { node: node.to_owned(), attribute: attribute.to_owned(), value: value.to_owned() }
}

/// The arguments of `nucleus run` for one row.
fn arguments(wedge: &Wedge, scene: &str, columns: &[String], row: &Row) -> Vec<String> {
    let mut all = vec!["run".to_owned(), scene.to_owned()];
    let set = columns.iter().zip(&row.values);
    all.extend(set.flat_map(|(column, value)| ["--set".to_owned(), assignment(column, value).to_string()]));
    let mut option = |name: &str, value: Option<String>| {
        all.extend(value.into_iter().flat_map(|value| [name.to_owned(), value]));
    };
    option("--seed", row.seed.map(|seed| seed.to_string()));
    option(
        "--frames",
        wedge.frames.map(|frames| match frames {
            FrameRange::Count(count) => count.to_string(),
            FrameRange::Span(first, last) | FrameRange::Reaching(first, last) => format!("{first}..{last}"),
        }),
    );
    option("--record", wedge.record.clone());
    option("--checkpoint", wedge.checkpoint.map(|frames| frames.to_string()));
    if wedge.audit {
        all.push("--audit".to_owned());
    }
    all
}
