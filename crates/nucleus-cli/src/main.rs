//! The `nucleus` program.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    nucleus_cli::run(std::env::args_os().collect()).into()
}
