//! Kernels hold the instructions of their lanes: one that is called instead costs several times what it does.

#![cfg(all(target_arch = "x86_64", target_os = "linux", not(debug_assertions)))]

use std::{env, fs, str};

/// Names of functions in a program that contain `part`.
fn functions(program: &[u8], part: &str) -> Vec<String> {
    let is_name = |byte: &u8| byte.is_ascii_alphanumeric() || b"_$.".contains(byte);
    let names = program.split(|byte| !is_name(byte)).filter_map(|name| str::from_utf8(name).ok());
    let functions = names.filter(|name| name.starts_with("_ZN") || name.starts_with("_R"));
    functions.filter(|name| name.contains(part)).map(str::to_owned).collect()
}

#[test]
fn no_instruction_of_eight_lanes_is_called_as_a_function() {
    let program = fs::read(env::current_exe().unwrap()).unwrap();
    assert!(!functions(&program, "nucleus_core").is_empty(), "the program has no names");
    let called = functions(&program, "_mm256_");
    assert!(called.is_empty(), "{called:#?}");
}
