//! From text to a scene, with everything there is to say about it.
//!
//! | You want to know...                                  | Read            |
//! |------------------------------------------------------|-----------------|
//! | in which order a file is read                        | this file       |
//! | how the fields of a record are taken                 | `fields.rs`     |
//! | which nodes there are, and how one is read           | `drafts.rs`, `nodes.rs` |
//! | how an attribute's value is read, keyed or not       | `value.rs`, `keys.rs` |
//! | what `"cloth1.vtx[0:8]"` means                       | `component.rs`  |
//! | how names become connections                         | `links.rs`      |
//! | how connections are made by hand                     | `wires.rs`      |

mod checks;
mod component;
mod drafts;
mod fields;
mod keys;
mod links;
mod nodes;
mod time;
mod value;
mod wires;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::attributes::{Attribute, NodeType};
use crate::compile;
use crate::graph::{NodeId, Setting};

use super::diagnostic::Diagnostic;
use super::document::{Record, Scene, TimeSpan};
use super::findings::Findings;
use super::source::Source;
use super::syntax::{self, Node};

use fields::Fields;
pub(super) use value::INTERPOLATIONS;

/// Reads a scene file. With the scene come warnings: what is set and has no effect.
///
/// # Errors
/// All mistakes that can be found, with warnings among them, in the order of the file.
pub fn read_scene(path: impl AsRef<Path>) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    let path = path.as_ref();
    let mut findings = Findings::new(path.to_owned());
    let message = match fs::read(path) {
        Ok(bytes) => match String::from_utf8(bytes) {
            Ok(text) => return read_scene_text(&text, path),
            Err(error) => {
                let at = error.utf8_error().valid_up_to();
                findings.error(&(at..at), "this is not text: scenes are UTF-8");
                return Err(findings.in_order());
            }
        },
        Err(error) => format!("cannot read `{}`: {error}", path.display()),
    };
    findings.error(&(0..0), message);
    Err(findings.in_order())
}

/// Reads a scene from text. `file` is what diagnostics name, and where relative paths begin.
///
/// # Errors
/// All mistakes that can be found, with warnings among them, in the order of the text.
pub fn read_scene_text(text: &str, file: &Path) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut findings = Findings::new(file.to_owned());
    let root = match syntax::parse(text) {
        Ok(root) => root,
        Err(errors) => {
            for error in errors {
                findings.error(&error.span, error.message).help = error.help;
            }
            return Err(findings.in_order());
        }
    };
    let read = read_root(&root, file, &mut findings);
    if findings.errors() == 0
        && let Some((scene, _)) = read
    {
        return Ok((scene, findings.in_order()));
    }
    // Mistakes that only show when meshes are there are worth telling in the same go.
    if let Some((scene, broken)) = read {
        findings.extend(compile::survey(&scene, &broken));
    }
    Err(findings.in_order())
}

/// The scene as far as it can be read, and the nodes on which something could not.
fn read_root(root: &Node, file: &Path, findings: &mut Findings) -> Option<(Scene, BTreeSet<NodeId>)> {
    let mut fields = Fields::of_scene(root, findings)?;
    let time =
        time::read(fields.take_required("time", "`time: (start: 1, end: 120, fps: 24)`", findings), findings);
    let record = fields.take("record").and_then(|node| read_record(node, findings));
    let checks = fields.take("checks").map(|node| checks::read(node, findings));
    let nodes = fields.take_required("nodes", "`nodes: {\"nucleus1\": nucleus()}`", findings);
    let wires = wires::read(fields.take("connections"), findings);
    fields.refuse_rest("a scene", &["time", "record", "nodes", "connections", "checks"], findings);
    let mut source = Source::new(file);
    let (graph, broken) = nodes::read_nodes(nodes?, &wires, &mut source, findings);
    let (time, every) = time.unwrap_or((TimeSpan { start: 1, end: 1, fps: 24.0 }, 1.0));
    let record = record.unwrap_or_default();
    Some((Scene { time, every, record, graph, checks: checks.unwrap_or_default(), source }, broken))
}

fn read_record(node: &Node, findings: &mut Findings) -> Option<Record> {
    match &node.value {
        syntax::Value::Word(word) if word == "frames" => Some(Record::Frames),
        syntax::Value::Word(word) if word == "substeps" => Some(Record::Substeps),
        syntax::Value::Word(word) if word == "none" => Some(Record::None),
        syntax::Value::Tuple { name: Some(name), items } if name.text == "every" => {
            every(items).or_else(|| {
                let error = findings.error(&node.span, "`every` takes a whole number above zero".to_owned());
                error.help("`every(10)` records each tenth frame and the last");
                None
            })
        }
        other => {
            let error =
                findings.error(&node.span, format!("`record` takes a word, found {}", value::found(other)));
            error.help("write `frames`, `substeps`, `every(10)` or `none`");
            None
        }
    }
}

/// `every(10)`.
fn every(items: &[Node]) -> Option<Record> {
    match items {
        [Node { value: syntax::Value::Number(n), .. }] if n.fract() == 0.0 && (1.0..=1e9).contains(n) => {
            Some(Record::Every(*n as u32))
        }
        _ => None,
    }
}

/// Reads a text that is one node without a name: what it sets.
pub(super) fn read_lone_node(
    text: &str,
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
    let draft = drafts::lone(&root, findings)?;
    let node_type = draft.node_type;
    let graph = nodes::read_lone(&draft, findings);
    let (_, node) = graph.iter().find(|(_, node)| node.name() == draft.name)?;
    let row = |name: &&'static str| node_type.attribute(name);
    let set = node.settings().iter().filter_map(|(name, setting)| Some((row(name)?, setting.clone())));
    Some((node_type, set.collect()))
}
