//! Random mutations of scenes, and what must hold for every one of them.

use std::path::Path;

use nucleus_graph::scene::{read_scene_text, write_scene};
use nucleus_maya::ascii::SourceText;
use nucleus_maya::{ImportOptions, import_text};

/// Random numbers (SplitMix64, Steele et al. 2014): the same for the same seed.
pub struct Random(pub u64);

impl Random {
    /// A number below a bound, which is above zero.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

/// Pieces that break something.
const PIECES: [&str; 24] = [
    "\"",
    ";",
    "-1",
    "1e999",
    "nan",
    "[0:4000000000]",
    "[-1]",
    "|",
    ":",
    ".",
    "\\",
    "{",
    "(",
    "/*",
    "//",
    "\0",
    "é",
    "-type \"vectorArray\" 99999999 ",
    "parent \"nCloth1\" \"nCloth1\";",
    " 0 ",
    "4294967295",
    "createNode mesh -n \"a\";",
    "connectAttr \"a.i\" \"a.w\";",
    "\n",
];

/// A mutated copy of a scene, with pieces of another one.
pub fn mutated(scene: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut text = scene.to_vec();
    for _ in 0..1 + random.below(6) {
        let at = random.below(text.len() + 1);
        let length = random.below(40).min(text.len() - at);
        match random.below(7) {
            0 => text.truncate(at),
            1 => drop(text.drain(at..at + length)),
            2 => {
                let piece = PIECES[random.below(PIECES.len())];
                text.splice(at..at, piece.bytes());
            }
            3 => {
                let from = random.below(other.len().max(1)).min(other.len());
                let to = (from + random.below(200)).min(other.len());
                text.splice(at..at, other[from..to].iter().copied());
            }
            4 if at < text.len() => text[at] = random.below(256) as u8,
            5 => {
                let copy = text[at..at + length].to_vec();
                let to = random.below(text.len() + 1);
                text.splice(to..to, copy);
            }
            // A number becomes another.
            _ => {
                if let Some(digit) = (at..text.len()).find(|k| text[*k].is_ascii_digit()) {
                    text[digit] = b'0' + random.below(10) as u8;
                }
            }
        }
    }
    text
}

/// Imports a text. What is imported reads back as the same scene; anything else is an error with a message.
///
/// # Panics
/// When one of these does not hold.
pub fn check(text: Vec<u8>) {
    let Ok(source) = SourceText::from_bytes(Path::new("mutated.ma"), text) else { return };
    let mut options = ImportOptions::new("meshes", |name, _| {
        assert!(
            name.starts_with("meshes/") && !name.contains(".."),
            "a path leads out of the folder: {name}"
        );
        Ok(())
    });
    let Ok(imported) = import_text(source, Path::new("out.ron"), &mut options) else { return };
    let text = write_scene(&imported.scene);
    match read_scene_text(&text, Path::new("out.ron")) {
        Ok((again, _)) => assert!(again == imported.scene, "it reads back as another scene"),
        Err(found) => panic!("it is refused: {}\n{text}", found[0].message),
    }
}
