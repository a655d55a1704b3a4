//! The Python module `nucleus._nucleus`: what the package needs from Rust. The package itself is in `nucleus/`.
//!
//! | You want to know…                              | Read             |
//! |------------------------------------------------|------------------|
//! | how positions become numpy arrays without copy | `array.rs`       |
//! | a step loop, and how Ctrl-C reaches it         | `simulation.rs`  |
//! | how a cache is read                            | `playback.rs`    |
//! | how a scene is checked and changed             | `scene.rs`       |
//!
//! Structured results cross the border as JSON text, which the package parses; arrays cross it without a copy.
//!
//! **Invariant:** the interpreter is released while anything is solved, read or run.

#![forbid(unsafe_code)]

mod array;
mod playback;
mod scene;
mod simulation;

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the `nucleus` command with these arguments, without the program's name, and returns its exit code. `command` starts
/// another process of it, for the runs of a wedge.
#[pyfunction]
fn main(py: Python, arguments: Vec<OsString>, command: Vec<OsString>) -> u8 {
    py.detach(|| {
        nucleus_cli::set_command(command);
        nucleus_cli::run(std::iter::once(OsString::from("nucleus")).chain(arguments).collect())
    })
}

/// The module.
#[pymodule]
fn _nucleus(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(scene::check, module)?)?;
    module.add_function(wrap_pyfunction!(scene::assign, module)?)?;
    module.add_function(wrap_pyfunction!(scene::value, module)?)?;
    module.add_function(wrap_pyfunction!(scene::takes_word, module)?)?;
    module.add_function(wrap_pyfunction!(scene::attributes, module)?)?;
    module.add_class::<array::Rows>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<playback::Playback>()
}
