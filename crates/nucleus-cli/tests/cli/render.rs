//! `nucleus render`.

use std::fs;
use std::path::Path;

use crate::sample::{assert_refused, cache, folder, nucleus, stderr};

/// Width and height that a PNG states, and how many frames it has.
fn png(path: &Path) -> ([u32; 2], Option<u32>) {
    let bytes = fs::read(path).unwrap();
    let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
    let animation = bytes.windows(4).position(|name| name == b"acTL");
    ([word(16), word(20)], animation.map(|at| word(at + 4)))
}

#[test]
fn a_frame_becomes_a_png_of_the_size_asked_for() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["render", "fall.mcap", "--frame", "3", "--size", "64x48"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(png(&folder.path().join("fall.png")), ([64, 48], None));
}

#[test]
fn a_run_becomes_an_animated_png_with_every_so_many_frames() {
    let folder = folder();
    cache(folder.path());
    let arguments = ["render", "fall.mcap", "--animate", "--every", "2", "--size", "64x48", "-o", "a.png"];
    let output = nucleus(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(png(&folder.path().join("a.png")), ([64, 48], Some(3)));
}

#[test]
fn a_frame_that_is_not_there_and_a_size_that_is_none_are_refused() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["render", "fall.mcap", "--frame", "99"]);
    assert_refused(&output, "there is no frame 99; the cache has 1 to 6");
    for size in ["0x5", "5", "99999x5", "-1x5"] {
        let output = nucleus(folder.path(), &["render", "fall.mcap", "--size", size]);
        assert_eq!(output.status.code(), Some(2), "{size}");
    }
}
