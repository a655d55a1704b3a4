//! Serves the player: `cargo run -p nucleus-view --example play -- [cache.mcap] [port]`.
//! Without a cache it plays a synthetic run.

#[path = "../tests/sample/mod.rs"]
mod sample;

use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = match arguments.next().filter(|path| !path.is_empty()) {
        Some(path) => PathBuf::from(path),
        None => {
            let path = std::env::temp_dir().join("nucleus-sample.mcap");
            sample::write(&path, sample::Sample { substeps: true, ..sample::Sample::default() });
            path
        }
    };
    let port = arguments.next().map_or(Ok(0), |port| port.parse())?;
    let player = nucleus_view::serve(path, port)?;
    println!("{}", player.url());
    player.wait();
    Ok(())
}
