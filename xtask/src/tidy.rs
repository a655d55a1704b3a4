//! Checks that no compiler makes: the map fits the tree, attributes name modules that exist, files stay short and import
//! each other in no circle, crates forbid unsafe code, nothing names one machine.

mod imports;

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;

use anyhow::bail;

use crate::files;
use crate::map::{self, CodeMap, Named};

/// Lines a source file may have; longer ones want to be split.
const MOST_LINES: usize = 600;

/// Attribute tables may be as long as they are.
const TABLES: &str = "crates/nucleus-graph/src/attributes/";

/// The only crate with unsafe code.
const UNSAFE: &str = "crates/nucleus-core";

/// Beginnings of paths that exist on one machine only. (In two halves, so that this file passes.)
const MACHINE_PATHS: [&str; 3] = [concat!("/wo", "rk/"), concat!("/ro", "ot/"), concat!("/ho", "me/")];

/// Words of an older, private vocabulary, which must not come back; the field has terms for all of them. (In two halves, so
/// that this file passes.)
const RETIRED: [&str; 33] = [
    concat!("nou", "ght"),
    concat!("fore", "seen"),
    concat!("fore", "see"),
    concat!("stra", "yed"),
    concat!("led ", "out"),
    concat!("last ", "word"),
    concat!("bro", "om"),
    concat!("run", "gs"),
    concat!("sou", "ght"),
    concat!("squee", "ze"),
    concat!("hold_", "back"),
    concat!("beside ", "the way"),
    concat!("has no ", "say"),
    concat!("goes ", "nowhere"),
    concat!("what ", "lies"),
    concat!("Uni", "verse"),
    concat!("Gri", "ps"),
    concat!("MeetEach", "Other"),
    concat!("By", "Parts"),
    concat!("find_", "strays"),
    concat!("begin_", "meeting"),
    concat!("keep_", "start"),
    concat!("follow_", "positions"),
    concat!("let_", "go"),
    concat!("hold_", "none"),
    concat!("par", "ted"),
    concat!("Ta", "lly"),
    concat!("wit", "ness"),
    concat!("salv", "age"),
    concat!("whole_", "file"),
    concat!("mov", "er"),
    concat!("LE", "AP"),
    concat!("Rem", "edy"),
];

/// Prints all problems; fails if there are any.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let problems = problems(root)?;
    problems.iter().for_each(|problem| println!("{problem}"));
    match problems.len() {
        0 => Ok(()),
        1 => bail!("1 thing is not tidy"),
        count => bail!("{count} things are not tidy"),
    }
}

/// Everything that is not tidy, each with its place.
pub fn problems(root: &Path) -> io::Result<Vec<String>> {
    let mut problems = map_problems(root)?;
    for path in files::below(root)? {
        // A file that is not text has neither lines nor words.
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let name = files::name(root, &path);
        problems.extend(text_problems(&name, &text));
        if name.starts_with(TABLES) {
            problems.extend(solved_problems(root, &name, &text));
        }
    }
    problems.extend(missing_tests(root)?);
    for package in packages(root)? {
        let src = root.join(&package).join("src");
        let circles = imports::circles(&src)?;
        problems.extend(circles.iter().map(|circle| format!("{package}/src: {circle}")));
        problems.extend(unsafe_problems(root, &package));
    }
    Ok(problems)
}

fn text_problems(name: &str, text: &str) -> Vec<String> {
    let mut problems = Vec::new();
    let lines = text.lines().count();
    if name.ends_with(".rs") && lines > MOST_LINES && !name.starts_with(TABLES) {
        problems.push(format!("{name}: {lines} lines, more than {MOST_LINES}; split it by its nouns"));
    }
    for (index, line) in text.lines().enumerate() {
        if let Some(path) = MACHINE_PATHS.iter().find(|path| line.contains(**path)) {
            problems.push(format!("{name}:{}: `{path}` is a path of one machine", index + 1));
        }
    }
    problems.extend(retired_words(name, text));
    problems
}

/// Retired words in prose, names and texts. The paper's claims keep the paper's words.
fn retired_words(name: &str, text: &str) -> Vec<String> {
    if name.ends_with("claims.md") || !matches!(name.rsplit('.').next(), Some("rs" | "md" | "js" | "ron")) {
        return Vec::new();
    }
    let is_part = |c: char| c.is_alphanumeric();
    let holds = |line: &str, word: &str| {
        line.match_indices(word)
            .any(|(at, _)| !line[..at].ends_with(is_part) && !line[at + word.len()..].starts_with(is_part))
    };
    let of_line = |(index, line): (usize, &str)| {
        let word = RETIRED.iter().find(|word| holds(line, word))?;
        Some(format!("{name}:{}: `{word}` is a retired word; use the field's term", index + 1))
    };
    text.lines().enumerate().filter_map(of_line).collect()
}

/// Tests that a page names and no source file has.
fn missing_tests(root: &Path) -> io::Result<Vec<String>> {
    // A name of four words or more, all in lower case: only tests are named like that.
    let is_test = |name: &str| {
        name.split('_').count() > 3
            && name.chars().all(|c| c == '_' || c.is_ascii_lowercase() || c.is_ascii_digit())
    };
    let mut named = Vec::new();
    let mut functions = BTreeSet::new();
    for path in files::below(root)? {
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let name = files::name(root, &path);
        let keyword = if name.ends_with(".rs") { "fn " } else { "def " };
        if name.ends_with(".rs") || name.ends_with(".py") {
            let words = text.split(keyword).skip(1).filter_map(|rest| rest.split(['(', '<']).next());
            functions.extend(words.map(str::to_owned));
        } else if name.ends_with(".md") {
            for (index, line) in text.lines().enumerate() {
                let tests = line.split('`').skip(1).step_by(2).filter(|word| is_test(word));
                named.extend(tests.map(|test| (format!("{name}:{}", index + 1), test.to_owned())));
            }
        }
    }
    let missing = named.iter().filter(|(_, test)| !functions.contains(test));
    Ok(missing.map(|(place, test)| format!("{place}: there is no test `{test}`")).collect())
}

/// Roots of a crate that do not forbid unsafe code. A lint of the workspace could be allowed again by a crate.
fn unsafe_problems(root: &Path, package: &str) -> Vec<String> {
    const LINE: &str = "#![forbid(unsafe_code)]";
    let roots = ["lib", "main"].map(|root| format!("{package}/src/{root}.rs"));
    let is_open = |name: &String| {
        let text = fs::read_to_string(root.join(name));
        package != UNSAFE && text.is_ok_and(|text| text.lines().all(|line| line != LINE))
    };
    let open = roots.into_iter().filter(is_open);
    open.map(|name| format!("{name}: `{LINE}` is missing; unsafe code is in {UNSAFE} alone")).collect()
}

/// Attributes of a table that name a module that is not there.
fn solved_problems(root: &Path, name: &str, text: &str) -> Vec<String> {
    const CALL: &str = "solved(\"";
    let of_line = |(index, line): (usize, &str)| {
        let (_, after) = line.split_once(CALL)?;
        let module = after.split('"').next()?;
        let files = module_files(module);
        if files.iter().any(|file| root.join(file).is_file()) {
            return None;
        }
        let [file, folder] = files;
        let hint = "write the path of the module in which the attribute takes effect now";
        Some(format!(
            "{name}:{}: `{module}` is no module, for there is neither `{file}` nor `{folder}`; {hint}",
            index + 1
        ))
    };
    text.lines().enumerate().filter_map(of_line).collect()
}

/// The files that a module can be in, from the root: `nucleus_core::contact::response` in
/// `crates/nucleus-core/src/contact/response.rs`.
fn module_files(module: &str) -> [String; 2] {
    let (package, path) = module.split_once("::").unwrap_or((module, ""));
    let stem = format!("crates/{}/src/{}", package.replace('_', "-"), path.replace("::", "/"));
    [format!("{stem}.rs"), format!("{stem}/mod.rs")]
}

/// Where `ARCHITECTURE.md` and the tree differ.
fn map_problems(root: &Path) -> io::Result<Vec<String>> {
    const PAGE: &str = "ARCHITECTURE.md";
    if !root.join(PAGE).is_file() {
        return Ok(vec![format!("{PAGE}: there is none")]);
    }
    let CodeMap { folders, crates } = map::read(&fs::read_to_string(root.join(PAGE))?);
    let mut problems = Vec::new();
    compare("folder", "", &folders, &files::folders(root)?, &mut problems);
    let headings: Vec<_> =
        crates.iter().map(|(name, entry)| Named { name: name.clone(), line: entry.line }).collect();
    let packages = packages(root)?;
    compare("crate", "", &headings, &packages, &mut problems);
    for package in packages {
        if let Some(entry) = crates.get(&package) {
            let there = modules(&root.join(&package).join("src"))?;
            compare("module", &format!("{package}/src/"), &entry.modules, &there, &mut problems);
        }
    }
    Ok(problems.into_iter().map(|problem| format!("{PAGE}{problem}")).collect())
}

/// Adds names without a thing, things without a name, and names that occur twice.
fn compare(kind: &str, inside: &str, named: &[Named], there: &[String], problems: &mut Vec<String>) {
    let mut seen = BTreeSet::new();
    for Named { name, line } in named {
        if !there.contains(name) {
            problems.push(format!(":{line}: there is no {kind} `{inside}{name}`"));
        } else if !seen.insert(name) {
            problems.push(format!(":{line}: the {kind} `{inside}{name}` is named twice"));
        }
    }
    for name in there.iter().filter(|name| !seen.contains(name)) {
        problems.push(format!(": the {kind} `{inside}{name}` is not named"));
    }
}

/// The folders of all crates, from the root.
fn packages(root: &Path) -> io::Result<Vec<String>> {
    let all = files::below(root)?;
    let manifests = all.iter().filter(|path| path.ends_with("Cargo.toml"));
    let folders = manifests.filter_map(|path| path.parent()).map(|folder| files::name(root, folder));
    Ok(folders.filter(|folder| !folder.is_empty()).collect())
}

/// The modules directly in a `src` folder: files and folders, except roots and those that only hold tests.
fn modules(src: &Path) -> io::Result<Vec<String>> {
    let mut modules = BTreeSet::new();
    for path in files::below(src)?.iter().filter(|path| path.extension().is_some_and(|end| end == "rs")) {
        let name = files::name(src, path);
        let module = name.split('/').next().unwrap_or_default().trim_end_matches(".rs");
        if !matches!(module, "lib" | "main" | "bin" | "tests") {
            modules.insert(module.to_owned());
        }
    }
    Ok(modules.into_iter().collect())
}

#[cfg(test)]
mod tests;
