//! What `nucleus wedge` says to mistakes, in full: `mistakes.txt` is a session in a shell. Each command follows a `$`, and its
//! output and exit code follow the command.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

use crate::sample::{folder, scene};

/// The output of a line in a shell in which `nucleus` is the built binary, and its exit code.
fn said(folder: &Path, line: &str) -> String {
    let script = format!("exec 2>&1\nnucleus() {{ \"$NUCLEUS\" \"$@\"; }}\n{line}");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).env("NUCLEUS", env!("CARGO_BIN_EXE_nucleus")).current_dir(folder);
    let output = shell.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let text: String = text.lines().map(|line| without_sizes(line) + "\n").collect();
    format!("{text}exit {}\n", output.status.code().unwrap())
}

/// A line without the numbers of frames and bytes that fit on a full disk.
fn without_sizes(line: &str) -> String {
    let is_size = |next: Option<&&str>| next.is_some_and(|next| ["frames", "bytes)"].contains(next));
    let words: Vec<&str> = line.split(' ').collect();
    let shown = words.iter().enumerate().map(|(index, word)| match word.strip_prefix('(') {
        _ if !is_size(words.get(index + 1)) => (*word).to_owned(),
        Some(_) => "(N".to_owned(),
        None => "N".to_owned(),
    });
    shown.collect::<Vec<_>>().join(" ")
}

#[test]
fn mistakes_are_named_with_their_place_and_their_fix_and_finished_runs_are_kept() {
    let folder = folder();
    let root = folder.path().canonicalize().unwrap();
    scene(&root, 200, "");
    let session = include_str!("mistakes.txt");
    let lines = session.lines().filter_map(|line| line.strip_prefix("$ "));
    let found: String = lines
        .map(|line| format!("$ {line}\n{}", said(&root, line)))
        .collect::<String>()
        .replace(root.to_str().unwrap(), "FOLDER");
    for (found, expected) in found.lines().zip(session.lines()) {
        assert_eq!(found, expected);
    }
    assert_eq!(found.lines().count(), session.lines().count());
}
