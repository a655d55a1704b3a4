//! Reading a scene from text, with all its diagnostics.
//!
//! | You want to know...                                  | Read            |
//! |------------------------------------------------------|-----------------|
//! | in which order a file is read                        | this file       |
//! | how `time` and `record` are read                     | `time.rs`       |
//! | how `checks` are read, and their former names        | `checks.rs`     |
//! | how the fields of a record are read                  | `fields.rs`     |
//! | how `nodes` are read                                 | `declaration.rs`, `nodes.rs` |
//! | how a setting is read: values, keys, maps            | `setting.rs`, `value.rs`, `keys.rs` |
//! | how material presets are found and read              | `preset.rs`     |
//! | how names of nodes are resolved                      | `references.rs` |
//! | how nodes are connected as Maya's commands do        | `creation.rs`   |
//! | which components of a constraint are refused         | `components.rs` |
//! | how `connections` are read                           | `connections.rs` |

mod checks;
mod components;
mod connections;
mod creation;
mod declaration;
mod fields;
mod keys;
mod nodes;
pub(super) mod preset;
mod references;
mod setting;
mod time;
mod value;

use std::collections::BTreeSet;
use std::path::Path;

use crate::compile;
use crate::diagnostic::{Diagnostic, Findings};
use crate::graph::NodeId;
use crate::memory::{self, Budget, Memory};

use crate::scene::document::{Scene, Source, TimeSpan};
use crate::scene::file_text::{TextError, read_text};
use crate::scene::syntax::{self, Node};

use fields::Fields;

/// Reads a scene file. Also returns warnings, such as settings without effect.
///
/// # Errors
/// All mistakes that can be found, with warnings among them, in the order of the file.
pub fn read_scene(path: impl AsRef<Path>) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    let path = path.as_ref();
    let mut findings = Findings::new(path.to_owned());
    match read_text(path, Memory::of_machine()) {
        Ok(text) => return read_scene_text(&text, path),
        Err(TextError::NotText { at, .. }) => {
            findings.error(&(at..at), "this is not text: scenes are UTF-8");
        }
        Err(error) => {
            findings.error(&(0..0), error.to_string());
        }
    }
    Err(findings.in_order())
}

/// Reads a scene from text. Diagnostics name `file`, and relative paths start from its folder.
///
/// # Errors
/// All mistakes that can be found, with warnings among them, in the order of the text.
pub fn read_scene_text(text: &str, file: &Path) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    read_scene_within(text, file, Memory::of_machine())
}

/// As [`read_scene_text`], with a limit on the memory of the scene, from its text to its run.
///
/// # Errors
/// As [`read_scene_text`]; a part that exceeds the limit is a mistake at its place.
pub fn read_scene_within(
    text: &str,
    file: &Path,
    memory: Memory,
) -> Result<(Scene, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut findings = Findings::new(file.to_owned());
    if let Err(refused) = Budget::new(memory).check(values(text).saturating_mul(memory::VALUE)) {
        let error = findings.error(&(0..0), format!("the scene is so long that reading it takes {refused}"));
        error.help(refused.help("take parts of it out"));
        return Err(findings.in_order());
    }
    let source = Source::within(file, memory);
    let root = match syntax::parse(text) {
        Ok(root) => root,
        Err(errors) => {
            for error in errors {
                findings.error(&error.span, error.message).help = error.help;
            }
            return Err(findings.in_order());
        }
    };
    let read = read_root(&root, source, &mut findings);
    if findings.errors() == 0
        && let Some((scene, _)) = read
    {
        return Ok((scene, findings.in_order()));
    }
    // Mistakes that need the meshes are reported together with the others.
    if let Some((scene, broken)) = read {
        findings.extend(compile::survey(&scene, &broken));
    }
    Err(findings.in_order())
}

/// An upper bound of the number of values in a text: each but the first follows one of these characters.
fn values(text: &str) -> u64 {
    text.bytes().filter(|byte| b",:([{".contains(byte)).count() as u64
}

/// The scene as far as it can be read, and the nodes with mistakes.
fn read_root(root: &Node, mut source: Source, findings: &mut Findings) -> Option<(Scene, BTreeSet<NodeId>)> {
    let mut fields = Fields::of_scene(root, findings)?;
    let time =
        time::read(fields.take_required("time", "`time: (start: 1, end: 120, fps: 24)`", findings), findings);
    let record = fields.take("record").and_then(|node| time::read_record(node, findings));
    let end = time.as_ref().map(|(time, _)| time.end);
    let checks = fields.take("checks").map(|node| checks::read(node, end, findings));
    let nodes = fields.take_required("nodes", "`nodes: {\"nucleus1\": nucleus()}`", findings);
    let connections = connections::read(fields.take("connections"), findings);
    fields.refuse_rest("a scene", &["time", "record", "nodes", "connections", "checks"], findings);
    let (graph, broken) = nodes::read_nodes(nodes?, &connections, &mut source, &preset::find, findings);
    let (time, every) = time.unwrap_or((TimeSpan { start: 1, end: 1, fps: 24.0 }, 1.0));
    let record = record.unwrap_or_default();
    Some((Scene { time, every, record, graph, checks: checks.unwrap_or_default(), source }, broken))
}
