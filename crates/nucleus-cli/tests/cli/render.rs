//! `nucleus render`.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::sample::{assert_refused, cache, folder, nucleus, stderr, stdout};

/// Width and height of a PNG, and its number of frames if it is animated.
fn png(path: &Path) -> ([u32; 2], Option<u32>) {
    let bytes = fs::read(path).unwrap();
    let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
    let animation = bytes.windows(4).position(|name| name == b"acTL");
    ([word(16), word(20)], animation.map(|at| word(at + 4)))
}

#[test]
fn a_frame_becomes_a_png_of_the_requested_size() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["render", "fall.mcap", "--frame", "3", "--size", "64x48"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(png(&folder.path().join("fall.png")), ([64, 48], None));
}

#[test]
fn a_hash_in_the_name_of_the_cache_is_no_frame_number() {
    let folder = folder();
    fs::rename(cache(folder.path()), folder.path().join("take#2.mcap")).unwrap();
    for more in [&["--animate"][..], &[]] {
        let output = nucleus(folder.path(), &[&["render", "take#2.mcap", "--size", "64x48"], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.collect();
        names.sort();
        assert_eq!(names, ["take#2.mcap", "take#2.png"]);
        assert_eq!(png(&folder.path().join("take#2.png")).1.is_some(), !more.is_empty());
    }
}

#[test]
fn a_gif_of_a_high_frame_rate_says_that_it_has_fewer_pictures() {
    let folder = folder();
    let text = include_str!("../../src/commands/templates/drape.ron").replace("fps: 24", "fps: 60");
    fs::write(folder.path().join("drape.ron"), text).unwrap();
    let run = nucleus(folder.path(), &["run", "drape.ron", "--frames", "6"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let output = nucleus(folder.path(), &["render", "drape.mcap", "--size", "64x48", "-o", "a.gif"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    assert!(said.starts_with("3 of 6 frames in `a.gif`"), "{said}");
    assert!(said.ends_with("; a GIF shows at most 50 pictures a second\n"), "{said}");
}

#[test]
fn a_run_becomes_an_animated_png_of_every_nth_frame() {
    let folder = folder();
    cache(folder.path());
    let arguments = ["render", "fall.mcap", "--animate", "--every", "2", "--size", "64x48", "-o", "a.png"];
    let output = nucleus(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(png(&folder.path().join("a.png")), ([64, 48], Some(3)));
}

#[test]
fn a_missing_frame_and_an_invalid_size_are_refused() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["render", "fall.mcap", "--frame", "99"]);
    assert_refused(&output, "there is no frame 99; the cache has 1 to 6");
    for size in ["0x5", "5", "99999x5", "-1x5"] {
        let output = nucleus(folder.path(), &["render", "fall.mcap", "--size", size]);
        assert_eq!(output.status.code(), Some(2), "{size}");
    }
}

#[test]
fn an_unknown_camera_is_refused_and_none_selects_the_automatic_camera() {
    let folder = folder();
    cache(folder.path());
    let render =
        |camera| nucleus(folder.path(), &["render", "fall.mcap", "--camera", camera, "--size", "64x48"]);
    assert_refused(&render("shot"), "there is no camera `shot`: the cache has none");
    assert_eq!(render("none").status.code(), Some(0));
}

#[test]
fn the_camera_of_the_scene_is_the_default() {
    let folder = folder();
    let shot = r#""shot": camera(translateY: keys([(1, 1), (4, 3)]), translateZ: 4, focalLength: 50),"#;
    let text = include_str!("../../src/commands/templates/drape.ron").replacen(
        "nodes: {",
        &format!("nodes: {{ {shot}"),
        1,
    );
    fs::write(folder.path().join("drape.ron"), text).unwrap();
    let run = nucleus(folder.path(), &["run", "drape.ron", "--frames", "4"]);
    assert!(folder.path().join("drape.mcap").exists(), "{}", stderr(&run));
    let info = stdout(&nucleus(folder.path(), &["info", "drape.mcap"]));
    assert!(info.contains("camera shot: moving"), "{info}");
    let picture = |arguments: &[&str]| {
        let all = [&["render", "drape.mcap", "--size", "64x48", "-o", "a.png"], arguments].concat();
        let output = nucleus(folder.path(), &all);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read(folder.path().join("a.png")).unwrap()
    };
    assert_eq!(picture(&[]), picture(&["--camera", "shot"]));
    assert_ne!(picture(&[]), picture(&["--camera", "none"]));
}

/// Whether ffmpeg is installed; prints a note if not.
fn has_ffmpeg() -> bool {
    let found = Command::new("ffmpeg").arg("-version").output().is_ok();
    if !found {
        eprintln!("ffmpeg is not installed: no film was written");
    }
    found
}

#[test]
fn a_film_has_every_frame_at_its_rate_and_the_colours_of_the_picture() {
    if !has_ffmpeg() {
        return;
    }
    let folder = folder();
    cache(folder.path());
    for name in ["a.mp4", "a.mov", "a.webm"] {
        let output =
            nucleus(folder.path(), &["render", "fall.mcap", "--frames", "6", "--size", "63x49", "-o", name]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
        let mut ffmpeg = Command::new("ffmpeg");
        ffmpeg.args(["-i", name, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]).current_dir(folder.path());
        let read = ffmpeg.output().unwrap();
        let said = String::from_utf8_lossy(&read.stderr);
        assert!(said.contains("bt709") && said.contains("64x50") && said.contains("24 fps"), "{said}");
        assert_eq!(read.stdout.len(), 6 * 64 * 50 * 3, "{name}");
        // The background in the upper left corner is nearly white.
        assert!(read.stdout[..3].iter().all(|&byte| byte > 200), "{:?}", &read.stdout[..3]);
        assert!(!folder.path().join(format!("{name}.part")).exists());
    }
}

#[test]
fn a_still_may_have_opacities_a_colour_behind_it_and_coloured_objects() {
    let folder = folder();
    cache(folder.path());
    let render = |more: &[&str]| {
        let all = [&["render", "fall.mcap", "--size", "64x48", "-o", "a.png"], more].concat();
        nucleus(folder.path(), &all)
    };
    let colour_type = || fs::read(folder.path().join("a.png")).unwrap()[25];
    assert_eq!(render(&[]).status.code(), Some(0));
    assert_eq!(colour_type(), 2, "red, green, blue");
    assert_eq!(render(&["--background", "none"]).status.code(), Some(0));
    assert_eq!(colour_type(), 6, "and opacity");
    assert_eq!(
        render(&["--background", "#102030", "--tint", "sheet=#ffffff", "--samples", "1"]).status.code(),
        Some(0)
    );
    assert_eq!(render(&["--background", "blue"]).status.code(), Some(2));
    let film = nucleus(folder.path(), &["render", "fall.mcap", "-o", "a.gif", "--background", "none"]);
    assert_refused(&film, "a film has no opacities");
}

#[test]
fn a_pattern_hides_or_tints_every_object_that_it_matches() {
    let folder = folder();
    cache(folder.path());
    let picture = |more: &[&str]| {
        let all =
            [&["render", "fall.mcap", "--size", "64x48", "--samples", "1", "-o", "a.png"], more].concat();
        let output = nucleus(folder.path(), &all);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read(folder.path().join("a.png")).unwrap()
    };
    let [whole, hidden, tinted] = [&[][..], &["--hide", "she*"], &["--tint", "?heet=#0000ff"]].map(picture);
    assert!(whole != hidden && whole != tinted && hidden != tinted);
    assert!(hidden == picture(&["--hide", "sheet"]) && tinted == picture(&["--tint", "sheet=#0000ff"]));
}

#[test]
fn a_picture_never_replaces_the_cache_that_it_shows() {
    let folder = folder();
    let path = cache(folder.path());
    let bytes = fs::read(&path).unwrap();
    fs::copy(&path, folder.path().join("fall.png")).unwrap();
    let words = "`fall.png` is the file that is read";
    assert_refused(&nucleus(folder.path(), &["render", "fall.png"]), words);
    let export = ["export", "fall.mcap", "--as", "foxglove", "-o", "./fall.mcap", "--force"];
    assert_refused(&nucleus(folder.path(), &export), "`./fall.mcap` is the file that is read");
    assert!(fs::read(&path).unwrap() == bytes && fs::read(folder.path().join("fall.png")).unwrap() == bytes);
}

#[test]
fn an_option_without_effect_is_refused() {
    let folder = folder();
    cache(folder.path());
    for (options, words) in [
        (&["--tint", "shet=#00ff00"][..], "there is no object `shet`; did you mean `sheet`?"),
        (&["--hide", "shet"], "`--hide`: there is no object `shet`; did you mean `sheet`?"),
        (&["--hide", "x*"], "`--hide`: there is no object `x*`; there are `sheet`"),
        (&["--frames", "1..4"], "`--frames` is for several frames, and the output is a still: `--animate`"),
        (&["--every", "2"], "`--every` is for several frames"),
        (&["--animate", "-o", "a.exr"], "`--animate` is for several frames"),
        (&["--frame", "2", "-o", "a.gif"], "`--frame` is for a still"),
        (&["--fov", "50"], "`--fov` is for a camera of `--eye` or `--target`"),
        (&["--eye", "1,2,3", "--target", "1,2,3"], "`--eye` and `--target` are one point"),
        (&["--surface"], "`--surface` is for particles, and the cache has none"),
    ] {
        let output = nucleus(folder.path(), &[&["render", "fall.mcap"], options].concat());
        assert_refused(&output, words);
    }
    let strain = nucleus(folder.path(), &["render", "fall.mcap", "--strain", "0"]);
    assert_refused(&strain, "give a number above zero");
}
