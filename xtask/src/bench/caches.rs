//! Speed of writing, reading, seeking and playing caches, and the cost of recording and checkpoints.

mod player;
mod recording;
mod target;
mod throughput;

use std::path::Path;

use target::Target;

/// Text above the tables.
pub const HEAD: &str = "# Caches

**Write** and **read** are megabytes of uncompressed positions per second of one core, including byte shuffling, zstd, checksums and system calls.
The sheet waves so that every float changes in every frame; figures are medians of three runs.
**Packed** is the ratio of file size to uncompressed size.
**Seek** is the wall time to a random frame in milliseconds: median and 99th percentile.
`cargo xtask book --only caches` rewrites this page; it needs 12 GB of disk temporarily.
";

/// All tables of the page, targets first.
pub fn tables(root: &Path) -> anyhow::Result<String> {
    let folder = crate::files::target(root).join("caches");
    std::fs::create_dir_all(&folder)?;
    let [costs, checkpoint] = recording::tables()?;
    let (throughput, large) = (throughput::throughput(root, &folder)?, throughput::large(root, &folder)?);
    let parts = [throughput, large, costs, checkpoint, player::table(root, &folder)?];
    let targets: Vec<&Target> = parts.iter().flat_map(|(_, targets)| targets).collect();
    let tables = std::iter::once(target::table(&targets)).chain(parts.iter().map(|(table, _)| table.clone()));
    Ok(tables.map(|table| format!("{table}\n")).collect())
}
