//! Damaged scenes, presets and caches are an error or an omission, and never a panic.

use std::path::Path;

use nucleus_maya::ncache::NCache;
use nucleus_maya::read_maya_preset;

mod mutate;

use mutate::{Random, check, mutated};

fn corpus() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/maya");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.into_iter().filter(|path| path.is_file()).map(|path| std::fs::read(path).unwrap()).collect()
}

#[test]
fn mutated_scenes_are_imported_or_refused() {
    let corpus = corpus();
    let mut random = Random(7);
    for _ in 0..500 {
        let [a, b] = [0, 1].map(|_| random.below(corpus.len()));
        check(mutated(&corpus[a], &corpus[b], &mut random));
    }
}

#[test]
fn every_scene_can_be_cut_at_any_statement() {
    for scene in corpus() {
        let ends = scene.iter().enumerate().filter(|(_, byte)| **byte == b';').map(|(at, _)| at);
        ends.step_by(23).for_each(|at| check(scene[..at].to_vec()));
    }
}

#[test]
fn mutated_presets_and_caches_are_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let preset = b"startAttrPreset( \"nCloth\" );\nblendAttr \"friction\" 0.05;\nblendAttr \"fieldScale[0].fieldScale_Position\" 0;\n".to_vec();
    let mut cache =
        b"FOR4\0\0\0\x10CACHSTIM\0\0\0\x04\0\0\0\xfaFOR4\0\0\0\x28MYCHCHNM\0\0\0\x02p\0\0\0FVCA\0\0\0\x0c"
            .to_vec();
    cache.extend([0; 12]);
    let mut random = Random(11);
    for _ in 0..400 {
        let [mel, mc] = ["a.mel", "a.mc"].map(|name| folder.path().join(name));
        std::fs::write(&mel, mutated(&preset, &preset, &mut random)).unwrap();
        std::fs::write(&mc, mutated(&cache, &cache, &mut random)).unwrap();
        let _ = read_maya_preset(&mel);
        let _ = NCache::read(&mc);
    }
}
