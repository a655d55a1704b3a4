//! Presets: values of a material, kept in a file that looks like a node of a scene.
//!
//! ```ron
//! // Silk: light and smooth.
//! nCloth(friction: 0.05, stretchResistance: 60)
//! ```

use std::path::Path;

use crate::attributes::{Attribute, NodeType};
use crate::graph::Setting;
use crate::memory::Memory;

use super::read::{TextError, read_lone_node, read_text};
use super::syntax;
use super::write::setting_lines;
use crate::diagnostic::{Diagnostic, Findings, nearest};

/// A file that is longer is no preset.
const LONGEST: Memory = Memory(1_000_000);

/// The presets that come along, by name.
static PRESETS: [(&str, &str); 13] = [
    ("burlap", include_str!("../../presets/burlap.ron")),
    ("canvas", include_str!("../../presets/canvas.ron")),
    ("chainmail", include_str!("../../presets/chainmail.ron")),
    ("chiffon", include_str!("../../presets/chiffon.ron")),
    ("cotton", include_str!("../../presets/cotton.ron")),
    ("heavyDenim", include_str!("../../presets/heavyDenim.ron")),
    ("looseThickKnit", include_str!("../../presets/looseThickKnit.ron")),
    ("nylon", include_str!("../../presets/nylon.ron")),
    ("paper", include_str!("../../presets/paper.ron")),
    ("rubberSheet", include_str!("../../presets/rubberSheet.ron")),
    ("silk", include_str!("../../presets/silk.ron")),
    ("tShirt", include_str!("../../presets/tShirt.ron")),
    ("thickLeather", include_str!("../../presets/thickLeather.ron")),
];

/// Values for the attributes of one type of node.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// Its name.
    pub name: String,
    /// What it is like, in one line: the comment that its file begins with.
    pub doc: String,
    /// The type of node it is for; types that inherit from it can take it too.
    pub node_type: &'static NodeType,
    /// What it sets.
    pub settings: Vec<(&'static Attribute, Setting)>,
}

impl Preset {
    /// What it sets, each as a scene writes it: `friction: 0.4`.
    pub fn lines(&self) -> Vec<String> {
        self.settings.iter().flat_map(|(row, setting)| setting_lines(row, setting)).collect()
    }
}

/// All presets that come along, in the order of their names.
pub fn presets() -> Vec<Preset> {
    PRESETS.iter().filter_map(|(name, text)| read_preset(name, text, Path::new(name)).ok()).collect()
}

/// The preset of this name, or in this file if the name ends in `.ron`. `file` turns the name of a file into
/// its path.
///
/// # Errors
/// Why there is none, and what may have been meant.
pub(super) fn preset(
    name: &str,
    file: &dyn Fn(&str) -> std::path::PathBuf,
) -> Result<Preset, (String, String)> {
    if let Some((name, text)) = PRESETS.iter().find(|(known, _)| *known == name) {
        return read_preset(name, text, Path::new(name)).map_err(|mistakes| refusal(name, &mistakes));
    }
    if !name.ends_with(".ron") {
        let near = nearest(name, PRESETS.iter().map(|(known, _)| *known));
        let help =
            near.map_or("`nucleus presets` lists them".to_owned(), |near| format!("did you mean `{near}`?"));
        return Err((format!("there is no preset `{name}`"), help));
    }
    let path = file(name);
    let text = read_text(&path, LONGEST).map_err(|error| {
        let message = match error {
            TextError::Unreadable { path, cause } => format!("cannot read the preset `{path}`: {cause}"),
            other => format!("cannot take the preset `{name}`: {other}"),
        };
        (message, "a preset is a file like `nCloth(friction: 0.4)`".to_owned())
    })?;
    // What such a message quotes may be anything, if the file is not a preset.
    if let Err(mistakes) = syntax::parse(&text) {
        let at = mistakes.first().map_or(0, |mistake| mistake.span.start.min(text.len()));
        let before = text.get(..at).unwrap_or_default();
        let (line, start) = (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |end| end + 1));
        let column = before[start..].chars().count() + 1;
        let message =
            format!("the preset `{name}` cannot be read: line {line}, column {column} is not as in a scene");
        return Err((message, "a preset is a file like `nCloth(friction: 0.4)`".to_owned()));
    }
    read_preset(name, &text, &path).map_err(|mistakes| refusal(name, &mistakes))
}

fn refusal(name: &str, mistakes: &[Diagnostic]) -> (String, String) {
    let first = mistakes.first().map(|mistake| mistake.message.as_str()).unwrap_or_default();
    (
        format!("the preset `{name}` cannot be read: {first}"),
        "a preset is a file like `nCloth(friction: 0.4)`".to_owned(),
    )
}

/// Reads a preset from text.
///
/// # Errors
/// All mistakes in it.
pub fn read_preset(name: &str, text: &str, file: &Path) -> Result<Preset, Vec<Diagnostic>> {
    let mut findings = Findings::new(file.to_owned());
    let read = read_lone_node(text, &mut findings);
    let comment = text.lines().next().and_then(|line| line.strip_prefix("//")).unwrap_or_default();
    match read {
        Some((node_type, settings)) if findings.errors() == 0 => {
            Ok(Preset { name: name.to_owned(), doc: comment.trim().to_owned(), node_type, settings })
        }
        _ => Err(findings.in_order()),
    }
}
