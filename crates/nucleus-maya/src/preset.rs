//! Attribute presets of Maya: `startAttrPreset("nCloth"); blendAttr "friction" 0.4; ... endAttrPreset();`

use std::fmt::Write;
use std::path::Path;

use nucleus_graph::attributes::{self, Attribute, NodeType, Value, n_base};
use nucleus_graph::graph::{Channel, Setting};
use nucleus_graph::scene::Preset;

use crate::ascii::{ImportError, SourceText, Statements, Token, Tokens};
use crate::nucleus_nodes::Importer;
use crate::nucleus_nodes::{BorrowedOptions, ImportOptions};
use crate::omissions::Omissions;
use crate::scene::MayaScene;

/// Reads a preset of Maya (`.mel`). Also returns the omissions.
///
/// # Errors
/// When the file cannot be read, is no preset, or is one of a type of node that we do not have.
pub fn read_maya_preset(path: &Path) -> Result<(Preset, Omissions), ImportError> {
    let source = SourceText::read(path)?;
    let malformed = |byte: usize, message: String| {
        let (line, _) = source.place(byte);
        ImportError::Malformed { file: path.to_owned(), line, message }
    };
    let mut kind: Option<&'static NodeType> = None;
    // The values as statements of a scene, whose values are read in the same way.
    let mut text = String::from("//Maya ASCII preset\n");
    for statement in Statements::new(&source.text) {
        let mut tokens = Tokens::new(statement.text);
        let Some(Token::Word(command)) = tokens.next() else { continue };
        let name = tokens.next();
        match (command, name) {
            ("startAttrPreset", Some(Token::Quoted(name))) => {
                let known = attributes::node_type(name)
                    .filter(|node_type| node_type.is_a(&n_base::N_BASE) || node_type.name == "nucleus");
                let unknown = || malformed(statement.start, format!("presets of `{name}` are not read"));
                kind = Some(known.ok_or_else(unknown)?);
                let _ = writeln!(text, "createNode {name} -n \"preset\";");
            }
            ("blendAttr" | "setAttr", Some(Token::Quoted(name))) => {
                let _ = writeln!(text, "setAttr \".{}\" {};", name.trim_start_matches('.'), tokens.rest());
            }
            _ => {}
        }
    }
    let Some(node_type) = kind else {
        return Err(malformed(0, "it is no preset of attributes: `startAttrPreset` is missing".to_owned()));
    };
    let scene = MayaScene::of_text(SourceText { path: path.to_owned(), text })?;
    let mut options = ImportOptions::new("", |_, _| Ok(()));
    let (settings, omissions) =
        Importer::new(&scene, false, BorrowedOptions::of(&mut options, Path::new(""))).lone_node(node_type);
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let doc = format!("{name}, from a preset of Maya.");
    Ok((Preset { name, doc, node_type, settings }, omissions))
}

/// A preset as a Nucleus preset file: `nCloth(friction: 0.4)`.
pub fn preset_text(preset: &Preset) -> String {
    let doc: String = preset.doc.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let lines: Vec<String> = preset.lines().into_iter().map(|line| format!("    {line},\n")).collect();
    format!("// {doc}\n{}(\n{})\n", preset.node_type.name, lines.concat())
}

/// A preset as a file of Maya's.
pub fn maya_preset(preset: &Preset) -> String {
    let mut text = format!("startAttrPreset( \"{}\" );\n", preset.node_type.name);
    for (row, setting) in preset.settings.iter().filter(|(row, _)| !row.extension) {
        for (name, value) in values(row, setting) {
            let blends = matches!(
                row.kind,
                attributes::Kind::Float | attributes::Kind::Vector(_) | attributes::Kind::Ramp
            );
            let _ = writeln!(text, "{} \"{name}\" {value};", if blends { "blendAttr" } else { "setAttr" });
        }
    }
    text + "endAttrPreset();\n"
}

/// The plugs of a setting with their values. Curves and lists have no place in a preset.
fn values(row: &Attribute, setting: &Setting) -> Vec<(String, String)> {
    let one = |value: String| vec![(row.name.to_owned(), value)];
    match setting {
        Setting::Fixed(Value::Bool(on)) => one(u8::from(*on).to_string()),
        Setting::Fixed(Value::Int(x)) => one(x.to_string()),
        Setting::Fixed(Value::Float(x)) => one(x.to_string()),
        Setting::Fixed(Value::Choice(choice)) => one(choice.0.to_string()),
        Setting::Fixed(Value::Ramp(points)) => {
            let plug = |k: usize, part: &str| format!("{0}[{k}].{0}_{part}", row.name);
            let point = |(k, p): (usize, &attributes::RampPoint)| {
                [
                    (plug(k, "Position"), p.position.to_string()),
                    (plug(k, "FloatValue"), p.value.to_string()),
                    (plug(k, "Interp"), p.interpolation.0.to_string()),
                ]
            };
            points.iter().enumerate().flat_map(point).collect()
        }
        Setting::Parts(channels) => {
            let parts = row.parts().into_iter().flatten().zip(channels);
            parts
                .filter_map(|((name, _), channel)| match channel {
                    Channel::Fixed(x) => Some((name, x.to_string())),
                    Channel::Keyed(_) => None,
                })
                .collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nucleus_graph::scene::{presets, read_preset};

    #[test]
    fn every_preset_goes_to_maya_and_back() {
        let folder = tempfile::tempdir().unwrap();
        for preset in presets() {
            let path = folder.path().join(format!("{}.mel", preset.name));
            std::fs::write(&path, maya_preset(&preset)).unwrap();
            let (read, omissions) = read_maya_preset(&path).unwrap();
            assert!(omissions.is_empty(), "{omissions}");
            let sorted = |preset: &Preset| {
                let mut lines = preset.lines();
                lines.sort();
                lines
            };
            let own: Vec<String> = {
                let plain = Preset {
                    settings: preset.settings.iter().filter(|(row, _)| !row.extension).cloned().collect(),
                    ..preset.clone()
                };
                sorted(&plain)
            };
            assert_eq!(sorted(&read), own, "{}", preset.name);
            let again = read_preset("a", &preset_text(&read), Path::new("a.ron")).unwrap();
            assert_eq!(sorted(&again), sorted(&read));
        }
    }

    #[test]
    fn a_preset_as_maya_writes_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.mel");
        let text = "startAttrPreset( \"nCloth\" );\nblendAttr \"friction\" 0.05;\nsetAttr \"collisionFlag\" 2;\n\
                    blendAttr \"localForceY\" 0.25;\nblendAttr \"fieldScale[0].fieldScale_Position\" 0;\n\
                    blendAttr \"fieldScale[0].fieldScale_FloatValue\" 0.5;\nsetAttr \"fieldScale[0].fieldScale_Interp\" 2;\n\
                    blendAttr \"noSuchThing\" 1;\nendAttrPreset();\n";
        std::fs::write(&path, text).unwrap();
        let (preset, omissions) = read_maya_preset(&path).unwrap();
        let mut lines = preset.lines();
        lines.sort();
        assert_eq!(
            lines,
            [
                "collisionFlag: edge",
                "fieldScale: [(0, 0.5, smooth)]",
                "friction: 0.05",
                "localForce: (0, 0.25, 0)"
            ]
        );
        assert!(omissions.to_string().contains("noSuchThing"), "{omissions}");
        std::fs::write(&path, "hello;").unwrap();
        assert!(read_maya_preset(&path).unwrap_err().to_string().contains("line 1: it is no preset"));
        std::fs::write(&path, "\n\nstartAttrPreset(\"lambert\");").unwrap();
        assert!(read_maya_preset(&path).unwrap_err().to_string().contains("line 3: presets of `lambert`"));
    }
}
