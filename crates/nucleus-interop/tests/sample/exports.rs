//! Exports of the sample, and their bytes.

use std::fs;
use std::path::{Path, PathBuf};

use nucleus_cache::Playback;
use nucleus_interop::{ExportError, Exported, Format, Request, Selection, export};
use tempfile::TempDir;

/// Writes a cache and exports it: the folder of both, the output, and the result.
pub fn try_export(
    write: impl Fn(&Path),
    format: Format,
    selection: Selection,
) -> (TempDir, PathBuf, Result<Exported, ExportError>) {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().join("sample.mcap");
    write(&cache);
    let out = folder.path().join("out");
    let request = Request { format, out: out.clone(), selection, force: false };
    let exported = export(&mut Playback::open(&cache).unwrap(), &request, &mut |_| {});
    (folder, out, exported)
}

/// A number of four bytes.
pub fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

/// The JSON and the binary part of a glTF file.
pub fn parts(path: &Path) -> (serde_json::Value, Vec<u8>) {
    let bytes = fs::read(path).unwrap();
    assert_eq!((&bytes[..4], word(&bytes, 8) as usize), (&b"glTF"[..], bytes.len()));
    let text = word(&bytes, 12) as usize;
    (serde_json::from_slice(&bytes[20..20 + text]).unwrap(), bytes[28 + text..].to_vec())
}
