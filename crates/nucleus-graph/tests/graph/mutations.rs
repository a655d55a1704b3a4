//! Scenes that somebody has got wrong: each says what is wrong, at its place, or runs.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::{env, fs};

use nucleus_graph::compile::compile;
use nucleus_graph::scene::{Diagnostic, Severity, read_scene_text};

use super::scenes::gallery;

/// Small numbers that look random and are the same everywhere (splitmix64).
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

/// Everything that is said about a text, after looking at its places.
fn judge(text: &str, file: &Path) -> Vec<Diagnostic> {
    let said = match read_scene_text(text, file) {
        Ok((mut scene, warnings)) => {
            // A run of a billion frames is nobody's mistake here.
            scene.time.end = scene.time.end.min(scene.time.start.saturating_add(3));
            match compile(&scene) {
                Ok(_) => return warnings,
                Err(mistakes) => mistakes,
            }
        }
        Err(mistakes) => mistakes,
    };
    assert!(said.iter().any(|said| said.severity == Severity::Error), "refused without a reason");
    for diagnostic in &said {
        let notes = diagnostic.notes.iter().filter_map(|note| note.span.clone());
        for place in notes.chain([diagnostic.span.clone()]) {
            assert!(text.get(place.clone()).is_some(), "{place:?} of {diagnostic:?}");
        }
        assert!(!diagnostic.message.is_empty() && !diagnostic.message.ends_with('.'), "{diagnostic:?}");
    }
    said
}

/// Fails with the text that did it.
fn survive(text: &str, file: &Path) -> Vec<Diagnostic> {
    catch_unwind(AssertUnwindSafe(|| judge(text, file))).unwrap_or_else(|_| {
        let kept = env::temp_dir().join("nucleus-broken-scene.ron");
        let _ = fs::write(&kept, text);
        panic!("the scene in {} is not survived:\n{text}", kept.display())
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
            survive(&tokens.concat(), &path);
        }
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

#[test]
fn everything_in_the_corpus_is_survived() {
    let mut seen = 0;
    for entry in fs::read_dir(corpus()).expect("the corpus is there") {
        let path = entry.expect("an entry").path();
        let text = String::from_utf8_lossy(&fs::read(&path).expect("it can be read")).into_owned();
        survive(&text, &path);
        seen += 1;
    }
    assert!(seen > 0);
}

/// What is said, without names and numbers: two texts that are refused for the same reasons look alike.
fn reasons(said: &[Diagnostic]) -> String {
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
    let mut reasons: Vec<String> = said.iter().map(|said| plain(&said.message)).collect();
    reasons.sort();
    reasons.dedup();
    reasons.truncate(2);
    reasons.join("; ")
}

/// Goes on from whatever is refused for a new reason, and keeps it. `NUCLEUS_FUZZ_SECONDS` says how long.
#[test]
#[ignore = "runs as long as it is told to: NUCLEUS_FUZZ_SECONDS=600"]
fn the_reader_is_fuzzed() {
    let seconds = env::var("NUCLEUS_FUZZ_SECONDS").ok().and_then(|count| count.parse().ok()).unwrap_or(10);
    let begin = std::time::Instant::now();
    let mut dice = Dice(begin.elapsed().as_nanos() as u64 ^ u64::from(std::process::id()));
    let mut known = std::collections::BTreeSet::new();
    let mut pool: Vec<String> = gallery().into_iter().map(|(_, text)| text.replace("EVIDENCE", "")).collect();
    for entry in fs::read_dir(corpus()).expect("the corpus is there") {
        let text =
            String::from_utf8_lossy(&fs::read(entry.expect("an entry").path()).expect("read")).into_owned();
        known.insert(reasons(&survive(&text, Path::new("fuzz.ron"))));
        pool.push(text);
    }
    let (mut tried, mut kept) = (0_u64, 0);
    while begin.elapsed().as_secs() < seconds {
        let mut tokens = tokens(&pool[dice.roll(pool.len())]);
        (0..=dice.roll(4)).for_each(|_| damage(&mut tokens, &mut dice));
        let text = tokens.concat();
        tried += 1;
        if known.insert(reasons(&survive(&text, Path::new("fuzz.ron")))) && text.len() < 4096 {
            // Named by what is in it: no run replaces what another has found.
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
