//! The pages of the manual: their scenes compile, and their programs run.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::sample::{END, cache, folder, nucleus, stderr};

fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The code blocks of a language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let begin = format!("```{language}\n");
    page.split(&begin).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_scene_of_the_manual_compiles_without_a_warning() {
    let page = page("scene.md");
    let scenes: Vec<&str> =
        blocks(&page, "ron").into_iter().filter(|block| block.starts_with("Scene(")).collect();
    assert!(scenes.len() >= 2);
    for scene in scenes {
        let folder = folder();
        fs::write(folder.path().join("a.ron"), scene).unwrap();
        let output = nucleus(folder.path(), &["check", "a.ron"]);
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{scene}");
    }
}

#[test]
fn the_manual_names_every_check_and_function() {
    let page = page("scene.md");
    let listed = |arguments: &[&str]| crate::sample::stdout(&nucleus(Path::new("."), arguments));
    let names = listed(&["checks"]);
    for line in names.lines().take_while(|line| !line.is_empty()) {
        let name = line.split(['(', ' ']).next().unwrap_or_default();
        assert!(page.contains(&format!("| `{name}")), "{name}");
    }
    let functions = listed(&["functions"]);
    let (_, functions) = functions.split_once("\nFunctions\n").expect("they have a head");
    for line in functions.lines().filter(|line| line.starts_with("  ")) {
        let name = line.trim().split(['(', ' ']).next().unwrap_or_default();
        assert!(page.contains(name), "{name}");
    }
}

/// A Python with the packages of the page: that of `NUCLEUS_PYTHON`, else `python3`. `None`, with a note, if it has not.
fn python() -> Option<PathBuf> {
    let python: PathBuf = std::env::var_os("NUCLEUS_PYTHON").unwrap_or_else(|| "python3".into()).into();
    let found = Command::new(&python).args(["-c", "import mcap, numpy, zstandard"]).output();
    if found.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    eprintln!("no Python with mcap, numpy and zstandard here: the program of the cache page was not tested");
    None
}

#[test]
fn the_python_of_the_cache_page_reads_the_recorded_positions() {
    let Some(python) = python() else { return };
    let folder = folder();
    cache(folder.path());
    let program = folder.path().join("read.py");
    fs::write(&program, blocks(&page("cache_format.md"), "python")[0]).unwrap();
    let mut read = Command::new(python);
    read.arg(&program).args(["fall.mcap", "sheet"]).current_dir(folder.path());
    let output = read.output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let mut recorded = nucleus_cache::Playback::open(folder.path().join("fall.mcap")).unwrap();
    let frames: Vec<&str> = said.lines().collect();
    assert_eq!(frames.len(), END as usize, "{said}{}", String::from_utf8_lossy(&output.stderr));
    for (sample, line) in frames.iter().enumerate() {
        let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
        let points = recorded.positions(0, sample).unwrap();
        let mean = |axis: usize| points.iter().map(|point| f64::from(point[axis])).sum::<f64>() / 4.0;
        assert_eq!(numbers[0], sample as f64 + 1.0);
        (0..3).for_each(|axis| assert!((numbers[2 + axis] - mean(axis)).abs() < 1e-3, "{line}"));
    }
}
