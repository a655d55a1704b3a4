//! Files that a scene refers to: where they are, and the edits that the scene makes to them.
//!
//! Paths in a scene lead to reading only, of regular files whose names end with `.ma`.

use std::path::{Path, PathBuf};

use crate::ascii::{Arguments, PlugPath, SourceText, Span, Token, Tokens};
use crate::omissions::Cause;

use super::graph::{Assigned, MayaScene, NodeId, PlugRef};

/// A `file -r` or `file -rdi` statement.
#[derive(Debug, Clone)]
pub(super) struct Reference {
    pub(super) namespace: String,
    pub(super) path: String,
    /// The reference node, by which the two statements of a reference belong together.
    node: String,
    /// Nested references are listed at depth 2 and more; the file that holds them names them itself.
    depth: f64,
}

impl Reference {
    pub(super) fn of(arguments: &Arguments) -> Option<Self> {
        let text = |flag| arguments.get(flag).map(|token| token.text().into_owned());
        if !arguments.has("r") && !arguments.has("rdi") {
            return None;
        }
        Some(Self {
            namespace: text("ns").or_else(|| text("rpr")).unwrap_or_default(),
            path: arguments.plain.first()?.text().into_owned(),
            node: text("rfn").unwrap_or_default(),
            depth: text("rdi").and_then(|depth| depth.parse().ok()).unwrap_or(1.0),
        })
    }
}

/// Each reference once: its `-rdi` and its `-r` statement are one.
pub(super) fn merged(all: Vec<Reference>) -> Vec<Reference> {
    let mut merged: Vec<Reference> = Vec::new();
    for reference in all.into_iter().filter(|reference| reference.depth <= 1.0) {
        let same =
            |other: &&Reference| other.node == reference.node && other.namespace == reference.namespace;
        if !merged.iter().any(|other| same(&other)) {
            merged.push(reference);
        }
    }
    merged
}

/// The file that a path in a scene means, of a type by its extension: as it is; else by its last folders and name, beside
/// the scene or in a folder above it, because projects are moved.
pub(crate) fn locate(scene: &Path, path: &str, extension: &str) -> Option<PathBuf> {
    // A file that is referred to twice has `{1}` after its name.
    let path = path.split('{').next().unwrap_or(path).replace('\\', "/");
    let is_it = |file: &PathBuf| {
        let fits = file.extension().is_some_and(|end| end.eq_ignore_ascii_case(extension));
        fits && std::fs::metadata(file).is_ok_and(|about| about.is_file())
    };
    let folder = scene.parent().unwrap_or(Path::new(""));
    let given = folder.join(&path);
    if is_it(&given) {
        return Some(given);
    }
    let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
    let start = parts.len().saturating_sub(4);
    let tails = (start..parts.len()).map(|k| parts[k..].join("/")).filter(|tail| !tail.contains(".."));
    let tails: Vec<String> = tails.collect();
    let folders = folder.ancestors().take(4);
    folders.flat_map(|folder| tails.iter().map(move |tail| folder.join(tail))).find(is_it)
}

/// Applies the edits that reference nodes hold: values, connections and parents of nodes in referenced files.
pub(super) fn apply_edits(scene: &mut MayaScene) {
    let mut placeholders: Vec<(String, String)> = Vec::new();
    let references: Vec<NodeId> = scene.of_kind("reference").collect();
    for id in references {
        let Some(values) = scene.value(id, &["ed", "edits"]) else { continue };
        for edit in edits(values.tokens()) {
            apply(scene, &edit, &mut placeholders);
        }
    }
    connect_placeholders(scene, &placeholders);
}

/// An edit: its number, and its strings.
struct Edit {
    number: u32,
    strings: Vec<String>,
}

fn edits(tokens: Tokens) -> Vec<Edit> {
    let mut all: Vec<Edit> = Vec::new();
    for token in tokens {
        match token {
            Token::Word(word) => {
                let Ok(number) = word.parse() else { continue };
                match all.last_mut() {
                    // `5 4 "RN" ...` has two numbers.
                    Some(last) if last.number == 5 && last.strings.is_empty() => {}
                    _ => all.push(Edit { number, strings: Vec::new() }),
                }
            }
            Token::Quoted(_) => {
                if let Some(last) = all.last_mut() {
                    last.strings.push(token.text().into_owned());
                }
            }
        }
    }
    all
}

fn apply(scene: &mut MayaScene, edit: &Edit, placeholders: &mut Vec<(String, String)>) {
    let strings: Vec<&str> = edit.strings.iter().map(String::as_str).collect();
    match (edit.number, &strings[..]) {
        (0, [child, parent, ..]) if !parent.is_empty() => {
            if let [Some(child), Some(parent)] = [child, parent].map(|path| scene.find(path))
                && !scene.self_and_ancestors(parent).contains(&child)
            {
                scene.nodes[child.0 as usize].parent = Some(parent);
            }
        }
        (2, [node, attribute, value, ..]) => match scene.find(node) {
            Some(node) => set(scene, node, attribute, value),
            None => scene.omissions.add((*node).to_owned(), Cause::EditOfMissing),
        },
        (3, [from, to, ..]) => {
            disconnect(scene, from, to);
        }
        (5, [_, plug, placeholder, ..]) if is_placeholder(placeholder) => {
            placeholders.push(((*placeholder).to_owned(), (*plug).to_owned()));
        }
        (5, [_, from, to, ..]) => {
            connect(scene, from, to);
        }
        _ => {}
    }
}

/// A value of an edit, such as ` -type "double3" 1 2 3`, becomes a text of its own.
fn set(scene: &mut MayaScene, node: NodeId, attribute: &str, value: &str) {
    let mut tokens = Tokens::new(value);
    let mut data_type = "";
    let mut rest = value;
    while let Some(Token::Word(word)) = tokens.clone().next().filter(|token| matches!(token, Token::Word(word) if word.starts_with('-') && word.len() > 1 && word.as_bytes()[1].is_ascii_alphabetic())) {
        tokens.next();
        if matches!(word, "-type" | "-typ") {
            data_type = match tokens.next() {
                Some(Token::Quoted(name) | Token::Word(name)) => name,
                None => "",
            };
        } else if matches!(word, "-k" | "-l" | "-cb" | "-s" | "-keyable" | "-lock" | "-size") {
            tokens.next();
        }
        rest = tokens.rest();
    }
    let (plug, kind) = (attribute.trim_start_matches('.'), data_type);
    let Some(spans) = own_text(scene, &[plug, kind, rest]) else { return };
    scene.nodes[node.0 as usize].assigned.push(Assigned {
        plug: spans[0],
        data_type: spans[1],
        value: spans[2],
    });
}

/// Keeps texts that stand in no file, one after the other, and gives their places.
fn own_text(scene: &mut MayaScene, parts: &[&str]) -> Option<Vec<Span>> {
    let file = match scene.texts.last() {
        Some(last) if last.path.as_os_str().is_empty() => scene.texts.len() - 1,
        _ => {
            scene.texts.push(SourceText { path: PathBuf::new(), text: String::new() });
            scene.texts.len() - 1
        }
    };
    let number = u16::try_from(file).ok()?;
    let text = &mut scene.texts[file].text;
    let mut spans = Vec::new();
    for part in parts {
        let start = u32::try_from(text.len()).ok()?;
        text.push_str(part);
        spans.push(Span { file: number, start, end: u32::try_from(text.len()).ok()? });
    }
    Some(spans)
}

/// Whether a plug is an element of the list of placeholders of a reference node.
fn is_placeholder(plug: &str) -> bool {
    plug.split_once('.').is_some_and(|(_, path)| {
        matches!(path.split('[').next().unwrap_or_default(), "phl" | "placeHolderList")
    })
}

fn disconnect(scene: &mut MayaScene, from: &str, to: &str) -> Option<()> {
    let (from, out) = from.split_once('.')?;
    let (to, input) = to.split_once('.')?;
    if !scene.disconnect([scene.find(from)?, scene.find(to)?], [PlugPath(out), PlugPath(input)]) {
        scene.omissions.add(format!("{to}.{input}"), Cause::EditOfMissing);
    }
    Some(())
}

fn connect(scene: &mut MayaScene, from: &str, to: &str) -> Option<()> {
    let (from, out) = from.split_once('.')?;
    let (to, input) = to.split_once('.')?;
    let [from, to] = [scene.find(from)?, scene.find(to)?];
    let spans = own_text(scene, &[out, input])?;
    scene.connect(PlugRef { node: from, path: spans[0] }, PlugRef { node: to, path: spans[1] });
    Some(())
}

/// Connections of the scene to `fooRN.phl[3]` lead to the plug that this placeholder stands for.
fn connect_placeholders(scene: &mut MayaScene, placeholders: &[(String, String)]) {
    let index_of =
        |path: &str| path.rsplit_once('[').map(|(_, index)| index.trim_end_matches(']').to_owned());
    let of = |scene: &MayaScene, plug: PlugRef| {
        let path = scene.path(plug);
        let is_placeholder = matches!(path.segments().next()?.name, "phl" | "placeHolderList");
        let index = index_of(path.0).filter(|_| is_placeholder)?;
        let name = scene.name(plug.node);
        placeholders.iter().find_map(|(placeholder, plug)| {
            let (node, path) = placeholder.split_once('.')?;
            (node == name && index_of(path)? == index).then(|| plug.clone())
        })
    };
    let found: Vec<(String, String)> = scene
        .wires
        .iter()
        .filter_map(|wire| {
            let whole = |plug: PlugRef| format!("{}.{}", scene.name(plug.node), scene.text(plug.path));
            match (of(scene, wire.from), of(scene, wire.to)) {
                (None, None) => None,
                (from, to) => {
                    Some((from.unwrap_or_else(|| whole(wire.from)), to.unwrap_or_else(|| whole(wire.to))))
                }
            }
        })
        .collect();
    for (from, to) in found {
        connect(scene, &from, &to);
    }
}
