//! Writes a small cache by a formula, with everything that makes exports go wrong: faces of three to six
//! corners, points that no face uses, names that other tools do not take, a collider that moves late, one that
//! never does, and particles.
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
