//! `nucleus export`, `diff` and `recover`, and `run` where a cache exists.

use std::fs;

use crate::sample::{END, assert_refused, cache, folder, nucleus, scene, stderr, stdout};

#[test]
fn an_export_takes_its_format_from_the_name_it_is_given() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["export", "fall.mcap", "-o", "fall.usda"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("6 samples of 1 object as usda in `fall.usda` (1 file, "));
    assert!(fs::read_to_string(folder.path().join("fall.usda")).unwrap().starts_with("#usda 1.0"));
    let again = nucleus(folder.path(), &["export", "fall.mcap", "-o", "fall.usda"]);
    assert_refused(&again, "`fall.usda` exists; `--force` replaces it");
    let output =
        nucleus(folder.path(), &["export", "fall.mcap", "--as", "obj", "--frames", "2..4", "--every", "2"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let written = fs::read_dir(folder.path().join("fall_obj")).unwrap().count();
    assert_eq!(written, 3, "a mesh for each of two frames, and their materials");
}

#[test]
fn an_export_that_is_not_possible_lists_the_choices() {
    let folder = folder();
    cache(folder.path());
    let export = |more: &[&str]| nucleus(folder.path(), &[&["export", "fall.mcap"], more].concat());
    assert_refused(&export(&[]), "give `--as` one of obj, ply, pc2");
    assert_refused(&export(&["--as", "obj", "--object", "shirt"]), "there are `sheet`");
    assert_refused(&export(&["--as", "obj", "--frames", "90..99"]), "the cache has 1 to 6");
}

#[test]
fn the_same_scene_run_twice_makes_caches_that_do_not_differ() {
    let folder = folder();
    scene(folder.path(), 6, "");
    for (out, threads) in [("a.mcap", "1"), ("b.mcap", "2")] {
        let run = nucleus(folder.path(), &["run", "drape.ron", "-o", out, "--threads", threads]);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    }
    let output = nucleus(folder.path(), &["diff", "a.mcap", "b.mcap"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stdout(&output), "equal in every bit, 6 moments compared\n");
    let [a, b] = ["a.mcap", "b.mcap"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(a == b, "the files are equal too");
}

#[test]
fn the_first_difference_is_reported_by_frame_object_and_point() {
    let folder = folder();
    scene(folder.path(), 6, "");
    assert_eq!(nucleus(folder.path(), &["run", "drape.ron", "-o", "a.mcap"]).status.code(), Some(0));
    let text = fs::read_to_string(folder.path().join("drape.ron")).unwrap();
    fs::write(
        folder.path().join("drape.ron"),
        text.replace("spaceScale: 0.01,", "spaceScale: 0.01, gravity: 9.7,"),
    )
    .unwrap();
    assert_eq!(nucleus(folder.path(), &["run", "drape.ron", "-o", "b.mcap"]).status.code(), Some(0));
    let output = nucleus(folder.path(), &["diff", "a.mcap", "b.mcap"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("first in `cloth1`: frame 2, point 0 by "), "{}", stdout(&output));
    let json = nucleus(folder.path(), &["diff", "a.mcap", "b.mcap", "--json"]);
    let said: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!((&said["same"], &said["differences"][0]["points"]["frame"]), (&false.into(), &2.into()));
    let wide = nucleus(folder.path(), &["diff", "a.mcap", "b.mcap", "--tolerance", "5"]);
    assert_eq!(wide.status.code(), Some(0), "{}", stdout(&wide));
}

#[test]
fn a_damaged_cache_is_recovered_beside_itself() {
    let folder = folder();
    let path = cache(folder.path());
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let output = nucleus(folder.path(), &["recover", "fall.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("the file was cut off"), "{}", stdout(&output));
    let info = nucleus(folder.path(), &["info", "fall.recovered.mcap", "--verify"]);
    assert_eq!(info.status.code(), Some(0), "{}", stdout(&info));
    assert_eq!(fs::metadata(&path).unwrap().len(), bytes.len() as u64 / 2, "the damaged file is unchanged");
    assert_refused(&nucleus(folder.path(), &["recover", "fall.mcap"]), "`fall.recovered.mcap` exists");
    assert_refused(
        &nucleus(folder.path(), &["recover", "fall.mcap", "-o", "fall.mcap"]),
        "is not overwritten",
    );
}

#[test]
fn a_run_replaces_a_cache_only_with_force() {
    let folder = folder();
    scene(folder.path(), 3, "");
    let run = |more: &[&str]| nucleus(folder.path(), &[&["run", "drape.ron"], more].concat());
    assert_eq!(run(&[]).status.code(), Some(0));
    let before = fs::read(folder.path().join("drape.mcap")).unwrap();
    assert_refused(&run(&[]), "`drape.mcap` exists; `--force` replaces it");
    assert_eq!(fs::read(folder.path().join("drape.mcap")).unwrap(), before);
    assert_eq!(run(&["--force", "--record", "every:2", "--velocities", "--compact"]).status.code(), Some(0));
    let info = stdout(&nucleus(folder.path(), &["info", "drape.mcap"]));
    assert!(info.contains("recorded    every 2 frames"), "{info}");
    fs::write(folder.path().join("drape.mcap"), "my thesis").unwrap();
    assert_refused(&run(&["--force"]), "is not a nucleus cache");
}

#[test]
fn info_reports_the_bytes_of_each_channel() {
    let folder = folder();
    cache(folder.path());
    let output = nucleus(folder.path(), &["info", "fall.mcap", "--json"]);
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let points = said["channels"]
        .as_array()
        .unwrap()
        .iter()
        .find(|channel| channel["topic"] == "/sheet/points")
        .unwrap();
    // Each frame has a header of 32 bytes and four points of twelve.
    assert_eq!(points["bytes"], END * (32 + 4 * 12));
    assert!(
        stdout(&nucleus(folder.path(), &["info", "fall.mcap"]))
            .contains("/points: nucleus.points.v1, 6 messages, 480 bytes")
    );
}

/// Flips a bit of a cache such that a frame is lost.
fn damage_a_frame(path: &std::path::Path) {
    let bytes = fs::read(path).unwrap();
    let costs_a_frame = |at: usize| {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        fs::write(path, damaged).unwrap();
        !nucleus_cache::Playback::open(path).unwrap().verify().unwrap().frames.is_empty()
    };
    assert!((bytes.len() / 6..bytes.len()).any(costs_a_frame));
}

#[test]
fn a_damaged_frame_is_reported_by_info_and_once_by_recover() {
    let folder = folder();
    let path = cache(folder.path());
    damage_a_frame(&path);
    let info = nucleus(folder.path(), &["info", "fall.mcap"]);
    assert_eq!(info.status.code(), Some(1), "{}", stdout(&info));
    assert!(stdout(&info).contains("missing or damaged: frame "), "{}", stdout(&info));
    let output = nucleus(folder.path(), &["recover", "fall.mcap"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    assert!(said.contains("lost for good: missing or damaged: frame "), "{said}");
    assert!(
        !said.contains("nothing is lost") && said.contains("5 frames in `fall.recovered.mcap`"),
        "{said}"
    );
}

#[test]
fn the_error_of_a_damaged_frame_names_the_remedies() {
    let folder = folder();
    let path = cache(folder.path());
    damage_a_frame(&path);
    let words = "`--frames` selects other frames, and `nucleus recover fall.mcap` writes the intact ones as another cache";
    let export = ["export", "fall.mcap", "--as", "obj"];
    let output = nucleus(folder.path(), &export);
    assert!(output.status.code() == Some(2) && stderr(&output).contains(words), "{}", stderr(&output));
    let render = ["render", "fall.mcap", "--size", "64x48", "-o", "a.gif"];
    let output = nucleus(folder.path(), &render);
    assert!(output.status.code() == Some(2) && stderr(&output).contains(words), "{}", stderr(&output));
    let said = stderr(&output);
    // `frame 4 is damaged`
    let words = said.split_whitespace().collect::<Vec<_>>();
    let damaged = words.windows(3).find(|words| words[0] == "frame" && words[2] == "is");
    let damaged: i32 = damaged.unwrap_or_else(|| panic!("{said}"))[1].parse().unwrap();
    let others = if damaged > 3 { format!("1..{}", damaged - 1) } else { format!("{}..6", damaged + 1) };
    let output = nucleus(folder.path(), &[&render[..], &["--frames", &others]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(nucleus(folder.path(), &["recover", "fall.mcap"]).status.code(), Some(1));
    assert!(folder.path().join("fall.recovered.mcap").exists());
}

#[test]
fn a_cache_whose_first_byte_is_damaged_is_recovered_completely() {
    let folder = folder();
    let path = cache(folder.path());
    let sound = fs::read(&path).unwrap();
    let mut bytes = sound.clone();
    bytes[0] ^= 1;
    fs::write(&path, bytes).unwrap();
    let output = nucleus(folder.path(), &["recover", "fall.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("the start of the file is damaged"), "{}", stdout(&output));
    assert!(fs::read(folder.path().join("fall.recovered.mcap")).unwrap() == sound);
}

#[test]
fn a_cache_that_has_lost_its_start_is_recovered_with_the_meshes_of_its_scene() {
    let folder = folder();
    scene(folder.path(), 6, "");
    let run = nucleus(folder.path(), &["run", "drape.ron", "--checkpoint", "0"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let path = folder.path().join("drape.mcap");
    let bytes = fs::read(&path).unwrap();
    // The file keeps only the bytes between the first copy and the second: not the start, the last copy and the index.
    let mark = b"nucleus.copy";
    let copies: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at..].starts_with(mark)).collect();
    let mut damaged = bytes[..copies[1] - 33].to_vec();
    damaged[..=copies[0]].fill(0);
    fs::write(&path, damaged).unwrap();
    let output = nucleus(folder.path(), &["recover", "drape.mcap", "-o", "points.mcap"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("shown as points, without a mesh: `object 1`"), "{}", stdout(&output));
    let output =
        nucleus(folder.path(), &["recover", "drape.mcap", "--scene", "drape.ron", "-o", "meshes.mcap"]);
    assert!(!stdout(&output).contains("shown as points"), "{}{}", stdout(&output), stderr(&output));
    let cache = nucleus_cache::Playback::open(folder.path().join("meshes.mcap")).unwrap();
    assert_eq!((cache.objects()[0].name.as_str(), cache.objects()[0].faces.len()), ("cloth1", 36));
    assert_eq!((cache.run().units_per_metre, cache.run().start), (100.0, 1));
    assert!(cache.time_samples().len() >= 4, "{}", cache.corruption());
}

#[test]
fn an_export_option_without_effect_is_refused() {
    let folder = folder();
    cache(folder.path());
    scene(folder.path(), 2, "");
    for (options, words) in [
        (&["fall.mcap", "--as", "obj", "--substeps"][..], "`nucleus run --record substeps` records them"),
        (&["fall.mcap", "--as", "obj", "--surface"], "`--surface` is for particles, and the cache has none"),
        (
            &["fall.mcap", "--as", "usda", "-o", "q.glb"],
            "`q.glb` is the name of a glb file, but `--as` asks for usda: name it `q.usda`",
        ),
        (
            &["fall.mcap", "--as", "glb", "-o", "drape.ron", "--force"],
            "`drape.ron` is not the name of a glb file: write `-o drape.glb`",
        ),
        (&["drape.ron", "-o", "q.mb"], "write `-o q.ma`"),
        (&["drape.ron", "--frames", "4"], "`--frames` is for caches, and `drape.ron` is a scene"),
    ] {
        assert_refused(&nucleus(folder.path(), &[&["export"], options].concat()), words);
    }
    let usd = nucleus(folder.path(), &["export", "fall.mcap", "--as", "usda", "-o", "q.usd"]);
    assert_eq!(usd.status.code(), Some(0), "{}", stderr(&usd));
}

#[test]
fn a_frame_between_recorded_ones_is_refused_with_its_neighbours() {
    let folder = folder();
    scene(folder.path(), 20, "");
    let run = nucleus(folder.path(), &["run", "drape.ron", "--record", "every:7"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let render = nucleus(folder.path(), &["render", "drape.mcap", "--frame", "5"]);
    assert_refused(&render, "there is no frame 5; the cache has 1 to 20, of those next to it 1 and 8");
}

#[test]
fn runs_that_start_apart_do_not_differ_in_the_frames_of_both() {
    let folder = folder();
    scene(folder.path(), 8, "");
    nucleus(folder.path(), &["run", "drape.ron", "--velocities"]);
    let late = ["run", "drape.ron", "--from", "drape.mcap@4", "--frames", "4..8", "-o", "late.mcap"];
    let run = nucleus(folder.path(), &late);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let diff = nucleus(folder.path(), &["diff", "drape.mcap", "late.mcap", "--tolerance", "0.1"]);
    assert_eq!(stdout(&diff).lines().next(), Some("frame 1 is the first that is in `drape.mcap` only"));
    assert!(!stdout(&diff).contains("first in"), "{}", stdout(&diff));
}

#[test]
fn frames_of_an_ncache_or_of_the_run_alone_are_a_difference() {
    let folder = folder();
    scene(folder.path(), 12, "");
    let run = |arguments: &[&str]| nucleus(folder.path(), arguments);
    assert_eq!(run(&["run", "drape.ron", "-o", "long.mcap"]).status.code(), Some(0));
    assert_eq!(run(&["run", "drape.ron", "-o", "short.mcap", "--frames", "1..6"]).status.code(), Some(0));
    for name in ["long", "short"] {
        let export = run(&["export", &format!("{name}.mcap"), "--as", "mcx", "-o", name]);
        assert_eq!(export.status.code(), Some(0), "{}", stderr(&export));
    }
    let diff = |cache: &str, ncache: &str| {
        let output = run(&["diff", cache, ncache, "--tolerance", "1e-3"]);
        (output.status.code(), stdout(&output) + &stderr(&output))
    };
    for name in ["long", "short"] {
        let said = diff(&format!("{name}.mcap"), &format!("{name}/cloth1.xml"));
        assert!(said.0 == Some(0) && !said.1.contains("only"), "{}", said.1);
    }
    let (code, text) = diff("long.mcap", "short/cloth1.xml");
    assert!(code == Some(1) && text.contains("frames 7 to 12 of `cloth1` are in `long.mcap` only"), "{text}");
    let (code, text) = diff("short.mcap", "long/cloth1.xml");
    assert!(
        code == Some(1) && text.contains("frames 7 to 12 of `cloth1` are in `long/cloth1.xml` only"),
        "{text}"
    );
}

#[test]
fn an_ncache_of_frames_beyond_its_ticks_is_refused_before_anything_is_written() {
    let folder = folder();
    scene(folder.path(), 12, "");
    let run = |arguments: &[&str]| nucleus(folder.path(), arguments);
    let frames = "8589931..8589936";
    assert_eq!(run(&["run", "drape.ron", "-o", "late.mcap", "--frames", frames]).status.code(), Some(0));
    for format in ["mc", "mcx"] {
        let export = ["export", "late.mcap", "--as", format, "-o", "out"];
        assert_refused(
            &run(&export),
            "frame 8589935 is beyond 8589934, the largest that nCache can state at 24",
        );
        assert!(!folder.path().join("out").exists());
    }
    let export = ["export", "late.mcap", "--as", "mcx", "-o", "out", "--frames", "8589931..8589934"];
    assert_eq!(run(&export).status.code(), Some(0));
    assert_eq!(run(&["diff", "late.mcap", "out/cloth1.xml", "--tolerance", "1e-3"]).status.code(), Some(1));
}
