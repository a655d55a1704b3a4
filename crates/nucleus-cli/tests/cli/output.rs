//! Standard output that is closed or full.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::sample::{folder, nucleus, scene, stderr};

/// Runs a command and closes its output, after the first line if `reads_a_line`. Returns the exit code and standard error.
fn closed(folder: &std::path::Path, arguments: &[&str], reads_a_line: bool) -> (Option<i32>, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_nucleus"))
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    if reads_a_line {
        out.read_line(&mut String::new()).unwrap();
    }
    drop(out);
    let output = child.wait_with_output().unwrap();
    (output.status.code(), stderr(&output))
}

#[test]
fn a_run_whose_output_is_closed_continues_to_its_end() {
    let folder = folder();
    scene(folder.path(), 30, "");
    let whole = nucleus(folder.path(), &["run", "drape.ron", "-o", "whole.mcap"]);
    assert_eq!(whole.status.code(), Some(0));
    let whole = fs::read(folder.path().join("whole.mcap")).unwrap();
    for reads_a_line in [true, false] {
        let run = ["run", "drape.ron", "--json", "--force"];
        let (code, said) = closed(folder.path(), &run, reads_a_line);
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains("standard output cannot be written to"), "{said}");
        assert!(fs::read(folder.path().join("drape.mcap")).unwrap() == whole);
    }
    let resume = ["resume", "drape.mcap", "--at", "10", "--json"];
    let (code, said) = closed(folder.path(), &resume, false);
    assert_eq!(code, Some(1), "{said}");
    assert!(fs::read(folder.path().join("drape.mcap")).unwrap() == whole);
    assert!(!folder.path().join("drape.mcap.part").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_whose_result_is_a_file_completes_it_where_the_output_is_full() {
    let folder = folder();
    scene(folder.path(), 5, "");
    let full = |arguments: &[&str]| {
        let [out, err] = [(); 2].map(|()| File::options().write(true).open("/dev/full").unwrap());
        let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
        command.args(arguments).current_dir(folder.path()).stdout(out).stderr(err).status().unwrap().code()
    };
    // Standard error is full too.
    assert_eq!(full(&["run", "drape.ron", "--json"]), Some(1));
    assert_eq!(full(&["export", "drape.mcap", "-o", "drape.usda"]), Some(1));
    assert_eq!(full(&["render", "drape.mcap", "--size", "64x36"]), Some(1));
    assert_eq!(full(&["recover", "drape.mcap"]), Some(1));
    for made in ["drape.mcap", "drape.usda", "drape.png", "drape.recovered.mcap"] {
        assert!(folder.path().join(made).exists(), "{made}");
    }
    // Exit code 1 and not 2: the command has started.
    assert_eq!(full(&["info", "drape.mcap"]), Some(1));
    let (code, said) = closed(folder.path(), &["info", "drape.mcap"], false);
    assert_eq!((code, said.as_str()), (Some(0), ""), "a closed pipe is no error");
}
