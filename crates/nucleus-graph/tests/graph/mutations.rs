//! Mutated scenes: each runs, or is refused with errors at valid places.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::{env, fs};

use nucleus_graph::compile::compile;
use nucleus_graph::scene::{Diagnostic, Severity, read_scene_text};

use super::scenes::gallery;

/// Pseudo-random small numbers, the same on every platform (splitmix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) % sides.max(1) as u64) as usize
    }
}

/// Words, numbers, quoted texts, single other characters, and the space between them.
fn tokens(text: &str) -> Vec<String> {
    let class = |c: char| match c {
        c if c.is_alphanumeric() || matches!(c, '.' | '_' | '-') => 1,
        c if c.is_whitespace() => 2,
        _ => 0,
    };
    let mut tokens: Vec<String> = Vec::new();
    for c in text.chars() {
        match tokens.last_mut() {
            Some(last) if class(c) != 0 && last.chars().all(|d| class(d) == class(c)) => last.push(c),
            _ => tokens.push(c.into()),
        }
    }
    tokens
}

const STRANGE: [&str; 28] = [
    "3",
    "true",
    "\"x\"",
    "foo",
    "(1, 2)",
    "[]",
    "-1",
    "1e999",
    "{}",
    "keys([(1, 2)])",
    "0",
    "nan",
    "inf",
    "\"\"",
    "keys(at: [(1, 0), (2, 1)], post: cycle)",
    "\"time1.outTime\"",
    "\"cloth1.vtx[*]\"",
    "/*",
    "//",
    "#",
    "\u{e9}",
    "18446744073709551616",
    "preset: \"silk\"",
    "connections: [(\"a.tx\", \"a.ty\")],",
    "massMapType: perVertex",
    "massPerVertex: expression(\"1 + x * u\")",
    "bendMap: texture(\"a.png\")",
    "startPositions: [(0, 1, 2)]",
];

/// Removes, doubles, misspells, retypes, replaces, swaps or cuts off.
fn damage(tokens: &mut Vec<String>, dice: &mut Dice) {
    if tokens.is_empty() {
        return;
    }
    let (at, other) = (dice.roll(tokens.len()), dice.roll(tokens.len()));
    match dice.roll(8) {
        0 => drop(tokens.remove(at)),
        1 => tokens.insert(at, tokens[at].clone()),
        2 => drop(tokens[at].pop()),
        3 => tokens[at] = STRANGE[dice.roll(STRANGE.len())].to_owned(),
        4 => tokens[at] = tokens[other].clone(),
        5 => tokens.swap(at, other),
        6 => tokens.insert(at, STRANGE[dice.roll(STRANGE.len())].to_owned()),
        _ => tokens.truncate(at.max(tokens.len() * 3 / 4)),
    }
}

/// All diagnostics of a text, after a check of their places.
fn judge(text: &str, file: &Path) -> Vec<Diagnostic> {
    let diagnostics = match read_scene_text(text, file) {
        Ok((mut scene, warnings)) => {
            // A run of a billion frames is valid, and too long for a test.
            scene.time.end = scene.time.end.min(scene.time.start.saturating_add(3));
            match compile(&scene) {
                Ok(_) => return warnings,
                Err(mistakes) => mistakes,
            }
        }
        Err(mistakes) => mistakes,
    };
    assert!(
        diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error),
        "refused without a reason"
    );
    for diagnostic in &diagnostics {
        let notes = diagnostic.notes.iter().filter_map(|note| note.span.clone());
        for place in notes.chain([diagnostic.span.clone()]) {
            assert!(text.get(place.clone()).is_some(), "{place:?} of {diagnostic:?}");
        }
        assert!(!diagnostic.message.is_empty() && !diagnostic.message.ends_with('.'), "{diagnostic:?}");
    }
    diagnostics
}

/// As `judge`; a panic keeps the text in a file.
fn judge_or_keep(text: &str, file: &Path) -> Vec<Diagnostic> {
    catch_unwind(AssertUnwindSafe(|| judge(text, file))).unwrap_or_else(|_| {
        let kept = env::temp_dir().join("nucleus-broken-scene.ron");
        let _ = fs::write(&kept, text);
        panic!("the scene in {} panics:\n{text}", kept.display())
    })
}

/// `NUCLEUS_MUTATIONS` says how many mutations of each scene are tried; 10,000 in all take a few minutes.
#[test]
fn a_scene_with_mistakes_is_refused_at_a_place_or_runs() {
    let each = env::var("NUCLEUS_MUTATIONS").ok().and_then(|count| count.parse().ok()).unwrap_or(60);
    let mut dice = Dice(1);
    for (path, text) in gallery() {
        for _ in 0..each {
            let mut tokens = tokens(&text);
            (0..=dice.roll(3)).for_each(|_| damage(&mut tokens, &mut dice));
            judge_or_keep(&tokens.concat(), &path);
        }
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

#[test]
fn no_text_of_the_corpus_panics() {
    let mut seen = 0;
    for entry in fs::read_dir(corpus()).expect("the corpus is there") {
        let path = entry.expect("an entry").path();
        let text = String::from_utf8_lossy(&fs::read(&path).expect("it can be read")).into_owned();
        judge_or_keep(&text, &path);
        seen += 1;
    }
    assert!(seen > 0);
}

/// The messages without names and numbers: equal for texts that are refused for the same reasons.
fn reasons(diagnostics: &[Diagnostic]) -> String {
    let plain = |message: &str| {
        let mut quoted = false;
        let mut text = String::new();
        for c in message.chars() {
            quoted ^= c == '`';
            if !quoted && !c.is_ascii_digit() {
                text.push(c);
            }
        }
        text
    };
    let mut reasons: Vec<String> = diagnostics.iter().map(|diagnostic| plain(&diagnostic.message)).collect();
    reasons.sort();
    reasons.dedup();
    reasons.truncate(2);
    reasons.join("; ")
}

/// Mutates texts, and keeps those that are refused for a new reason. `NUCLEUS_FUZZ_SECONDS` is the duration.
#[test]
#[ignore = "runs for NUCLEUS_FUZZ_SECONDS, like 600"]
fn the_reader_is_fuzzed() {
    let seconds = env::var("NUCLEUS_FUZZ_SECONDS").ok().and_then(|count| count.parse().ok()).unwrap_or(10);
    let begin = std::time::Instant::now();
    let mut dice = Dice(begin.elapsed().as_nanos() as u64 ^ u64::from(std::process::id()));
    let mut known = std::collections::BTreeSet::new();
    let mut pool: Vec<String> = gallery().into_iter().map(|(_, text)| text.replace("EVIDENCE", "")).collect();
    for entry in fs::read_dir(corpus()).expect("the corpus is there") {
        let text =
            String::from_utf8_lossy(&fs::read(entry.expect("an entry").path()).expect("read")).into_owned();
        known.insert(reasons(&judge_or_keep(&text, Path::new("fuzz.ron"))));
        pool.push(text);
    }
    let (mut tried, mut kept) = (0_u64, 0);
    while begin.elapsed().as_secs() < seconds {
        let mut tokens = tokens(&pool[dice.roll(pool.len())]);
        (0..=dice.roll(4)).for_each(|_| damage(&mut tokens, &mut dice));
        let text = tokens.concat();
        tried += 1;
        if known.insert(reasons(&judge_or_keep(&text, Path::new("fuzz.ron")))) && text.len() < 4096 {
            // Named by a hash of the text, so that no run replaces the finds of another.
            let name = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            });
            fs::write(corpus().join(format!("{name:016x}.ron")), &text).expect("it can be kept");
            kept += 1;
            pool.push(text);
        }
    }
    println!("{tried} scenes tried, {kept} kept, {} reasons known", known.len());
}
