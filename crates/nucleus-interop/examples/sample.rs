//! Writes a small synthetic cache of cases that break exporters: faces of three to six corners, points without
//! faces, names that other tools reject, a collider that starts to move late, a static collider, and particles.
//!
//! `cargo run -p nucleus-interop --example sample -- sample.mcap`

use std::error::Error;

#[path = "../tests/sample/mod.rs"]
mod sample;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("name the file to write")?;
    sample::write(path.as_ref());
    Ok(())
}
