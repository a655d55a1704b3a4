//! Finds and reads material presets: the built-in ones, and files.

use std::path::{Path, PathBuf};

use crate::attributes::{Attribute, NodeType, n_base};
use crate::diagnostic::{Diagnostic, Findings, nearest};
use crate::graph::Setting;
use crate::memory::Memory;
use crate::scene::document::Source;
use crate::scene::file_text::{TextError, read_text};
use crate::scene::preset::Preset;
use crate::scene::syntax;

use super::declaration;
use super::nodes;

/// Limit on the size of a preset file.
const MAX_SIZE: Memory = Memory(1_000_000);

/// Largest number of preset files of which each is based on the next.
const MAX_CHAIN: usize = 64;

/// The built-in presets by name.
static PRESETS: [(&str, &str); 17] = [
    ("burlap", include_str!("../../../presets/burlap.ron")),
    ("canvas", include_str!("../../../presets/canvas.ron")),
    ("chainmail", include_str!("../../../presets/chainmail.ron")),
    ("chiffon", include_str!("../../../presets/chiffon.ron")),
    ("cotton", include_str!("../../../presets/cotton.ron")),
    ("heavyDenim", include_str!("../../../presets/heavyDenim.ron")),
    ("looseThickKnit", include_str!("../../../presets/looseThickKnit.ron")),
    ("nylon", include_str!("../../../presets/nylon.ron")),
    ("paper", include_str!("../../../presets/paper.ron")),
    ("rubberSheet", include_str!("../../../presets/rubberSheet.ron")),
    ("silk", include_str!("../../../presets/silk.ron")),
    ("tShirt", include_str!("../../../presets/tShirt.ron")),
    ("thickLeather", include_str!("../../../presets/thickLeather.ron")),
    ("wovenCotton", include_str!("../../../presets/wovenCotton.ron")),
    ("wovenDenim", include_str!("../../../presets/wovenDenim.ron")),
    ("wovenSilk", include_str!("../../../presets/wovenSilk.ron")),
    ("wovenWool", include_str!("../../../presets/wovenWool.ron")),
];

/// All built-in presets in the order of their names.
pub fn presets() -> Vec<Preset> {
    PRESETS.iter().filter_map(|(name, text)| read_preset(name, text, Path::new(name)).ok()).collect()
}

/// The built-in preset of this name, or the preset in this file if the name ends in `.ron`. A path is relative to the
/// folder of `source`.
///
/// # Errors
/// A message and a help: the preset does not exist, its file cannot be read, or it is based on itself.
pub(super) fn find(name: &str, source: &Source) -> Result<Preset, (String, String)> {
    find_within(&[], name, source)
}

/// A preset file that is being read.
#[derive(Clone)]
struct OpenPreset {
    /// As the file above it names it.
    name: String,
    /// Without links and `..`, to compare.
    path: PathBuf,
}

/// As [`find`], for a preset that the innermost of these files names.
fn find_within(open: &[OpenPreset], name: &str, source: &Source) -> Result<Preset, (String, String)> {
    if let Some((name, text)) = PRESETS.iter().find(|(known, _)| *known == name) {
        return read_preset(name, text, Path::new(name)).map_err(|mistakes| refusal(name, &mistakes));
    }
    if !name.ends_with(".ron") {
        let near = nearest(name, PRESETS.iter().map(|(known, _)| *known));
        let help =
            near.map_or("`nucleus presets` lists them".to_owned(), |near| format!("did you mean `{near}`?"));
        return Err((format!("there is no preset `{name}`"), help));
    }
    let path = source.path(name);
    let text = read_text(&path, MAX_SIZE).map_err(|error| {
        let message = match error {
            TextError::Unreadable { path, cause } => format!("cannot read the preset `{path}`: {cause}"),
            other => format!("cannot take the preset `{name}`: {other}"),
        };
        (message, "a preset is a file like `nCloth(friction: 0.4)`".to_owned())
    })?;
    // Syntax errors quote the text, and a file that is no preset may hold anything.
    if let Err(mistakes) = syntax::parse(&text) {
        let at = mistakes.first().map_or(0, |mistake| mistake.span.start.min(text.len()));
        let before = text.get(..at).unwrap_or_default();
        let (line, start) = (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |end| end + 1));
        let column = before[start..].chars().count() + 1;
        let message =
            format!("the preset `{name}` cannot be read: malformed at line {line}, column {column}");
        return Err((message, "a preset is a file like `nCloth(friction: 0.4)`".to_owned()));
    }
    let own =
        OpenPreset { name: name.to_owned(), path: path.canonicalize().unwrap_or_else(|_| path.clone()) };
    let open = [open, &[own]].concat();
    check_cycle(&open)?;
    read_within(&open, name, &text, &path).map_err(|mistakes| refusal(name, &mistakes))
}

/// Refuses a preset that is based on itself, and chains that are too long.
fn check_cycle(open: &[OpenPreset]) -> Result<(), (String, String)> {
    let Some((last, before)) = open.split_last() else { return Ok(()) };
    let help = "take out one `preset`";
    if let Some(first) = before.iter().position(|preset| preset.path == last.path) {
        let names: Vec<String> = open[first..].iter().map(|preset| format!("`{}`", preset.name)).collect();
        return Err((format!("it is based on itself: {}", names.join(" → ")), help.to_owned()));
    }
    if open.len() > MAX_CHAIN {
        return Err((format!("more than {MAX_CHAIN} presets are based on each other"), help.to_owned()));
    }
    Ok(())
}

fn refusal(name: &str, mistakes: &[Diagnostic]) -> (String, String) {
    let first = mistakes.first();
    let message = first.map(|mistake| mistake.message.as_str()).unwrap_or_default();
    let help = first.and_then(|mistake| mistake.help.clone());
    (
        format!("the preset `{name}` cannot be read: {message}"),
        help.unwrap_or_else(|| "a preset is a file like `nCloth(friction: 0.4)`".to_owned()),
    )
}

/// Reads a preset from text.
///
/// # Errors
/// All mistakes in the text.
pub fn read_preset(name: &str, text: &str, file: &Path) -> Result<Preset, Vec<Diagnostic>> {
    read_within(&[], name, text, file)
}

/// As [`read_preset`], for a preset that is read within these files.
fn read_within(open: &[OpenPreset], name: &str, text: &str, file: &Path) -> Result<Preset, Vec<Diagnostic>> {
    let mut findings = Findings::new(file.to_owned());
    let read = read_lone_node(open, text, file, &mut findings);
    let comment = text.lines().next().and_then(|line| line.strip_prefix("//")).unwrap_or_default();
    match read {
        Some((node_type, settings)) if findings.errors() == 0 => {
            Ok(Preset { name: name.to_owned(), doc: comment.trim().to_owned(), node_type, settings })
        }
        _ => Err(findings.in_order()),
    }
}

/// Reads a text of one node without a name: its type and settings.
fn read_lone_node(
    open: &[OpenPreset],
    text: &str,
    file: &Path,
    findings: &mut Findings,
) -> Option<(&'static NodeType, Vec<(&'static Attribute, Setting)>)> {
    let root = match syntax::parse(text) {
        Ok(root) => root,
        Err(errors) => {
            for error in errors {
                findings.error(&error.span, error.message).help = error.help;
            }
            return None;
        }
    };
    let declaration = declaration::unnamed(&root, findings)?;
    let node_type = declaration.node_type;
    let graph =
        nodes::read_lone(&declaration, file, &|name, source| find_within(open, name, source), findings);
    let (_, node) = graph.iter().find(|(_, node)| node.name() == declaration.name)?;
    // The preset that it is based on is part of it.
    let mut all = node.preset().clone();
    all.extend(node.settings().iter().map(|(name, setting)| (*name, setting.clone())));
    all.remove(n_base::PRESET.row.name);
    let with_row = |(name, setting)| Some((node_type.attribute(name)?, setting));
    Some((node_type, all.into_iter().filter_map(with_row).collect()))
}
