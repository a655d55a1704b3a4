//! Scenes as text: their diagnostics, and attributes by node and name.

use std::path::Path;

use nucleus_graph::attributes::{Attribute, Kind, NodeType, Value, node_type};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::graph::Setting;
use nucleus_graph::scene::{Assignment, Diagnostic, Scene, Severity, assigned, read_scene_text};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use serde_json::json;

/// Reads and compiles a scene. The result is JSON: its diagnostics, its nodes with their types, its frames.
#[pyfunction]
pub fn check(py: Python, text: &str, path: &str) -> String {
    py.detach(|| {
        let (scene, found) = match read_scene_text(text, Path::new(path)) {
            Ok((scene, mut found)) => {
                match compile(&scene) {
                    Ok(program) => found.extend(program.warnings().iter().cloned()),
                    Err(errors) => found.extend(errors),
                }
                (Some(scene), found)
            }
            Err(found) => (None, found),
        };
        let nodes = scene.as_ref().map(|scene| {
            let own = scene.graph.iter().filter(|(_, node)| node.created_by().is_none());
            own.map(|(_, node)| (node.name(), node.node_type().name))
                .collect::<std::collections::BTreeMap<_, _>>()
        });
        let time = scene
            .as_ref()
            .map(|scene| json!({ "start": scene.time.start, "end": scene.time.end, "fps": scene.time.fps }));
        let diagnostics: Vec<_> = found.iter().map(|one| described(one, text)).collect();
        json!({ "diagnostics": diagnostics, "nodes": nodes, "time": time }).to_string()
    })
}

/// A diagnostic with its line and column, from 1.
fn described(one: &Diagnostic, text: &str) -> serde_json::Value {
    let before = text.get(..one.span.start).unwrap_or_default();
    let (line, start) = (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |end| end + 1));
    json!({
        "severity": if one.severity == Severity::Error { "error" } else { "warning" },
        "message": one.message,
        "file": one.file,
        "line": line,
        "column": before[start..].chars().count() + 1,
        "help": one.help,
    })
}

/// The first error of a scene, as an exception.
pub fn refusal(found: &[Diagnostic], text: &str) -> PyErr {
    let first = found.iter().find(|one| one.severity == Severity::Error).or(found.first());
    let said = first.map(|one| {
        let at = described(one, text);
        let help = one.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
        format!("{}:{}:{}: {}{help}", one.file.display(), at["line"], at["column"], one.message)
    });
    PyValueError::new_err(said.unwrap_or_default())
}

/// A scene and its program.
pub fn compiled(text: &str, path: &str) -> PyResult<(Scene, Program)> {
    let (scene, _) = read_scene_text(text, Path::new(path)).map_err(|found| refusal(&found, text))?;
    let program = compile(&scene).map_err(|found| refusal(&found, text))?;
    Ok((scene, program))
}

/// The text of a scene with an attribute set; comments and layout stay.
#[pyfunction]
pub fn assign(text: &str, path: &str, node: &str, attribute: &str, value: &str) -> PyResult<String> {
    let (scene, _) = read_scene_text(text, Path::new(path)).map_err(|found| refusal(&found, text))?;
    let [node, attribute, value] = [node, attribute, value].map(str::to_owned);
    let mut one = Assignment { node, attribute, value };
    let refused = |error: nucleus_graph::scene::AssignError| PyValueError::new_err(error.to_string());
    one.resolve(&scene.graph).map_err(refused)?;
    assigned(text, &[one]).map_err(refused)
}

/// The value of an attribute at a frame, as JSON: `null` where it has none.
#[pyfunction]
pub fn value(text: &str, path: &str, node: &str, attribute: &str, frame: f64) -> PyResult<String> {
    let (scene, _) = read_scene_text(text, Path::new(path)).map_err(|found| refusal(&found, text))?;
    let id = scene
        .graph
        .find(node)
        .ok_or_else(|| PyKeyError::new_err(format!("the scene has no node `{node}`")))?;
    let node = scene.graph.node(id);
    let of = node.node_type();
    let whole = of.attribute(attribute).map(|row| (row, None));
    let (row, part) = whole
        .or_else(|| of.part(attribute).map(|(row, part)| (row, Some(part))))
        .ok_or_else(|| PyKeyError::new_err(no_attribute(node.name(), of, attribute)))?;
    let found = node.settings().get(row.name).or(node.preset().get(row.name));
    let value = found.map(|setting: &Setting| setting.at(frame, row)).or(row.default.clone());
    let value = value.map_or(serde_json::Value::Null, |value| plain(&value, row));
    Ok(part.map_or(&value, |part| &value[part]).to_string())
}

fn no_attribute(name: &str, of: &NodeType, attribute: &str) -> String {
    format!("`{name}` is of type {}, which has no attribute `{attribute}`", of.name)
}

/// A value in the types of JSON; words for enums, the text of a scene for everything that JSON lacks.
fn plain(value: &Value, row: &Attribute) -> serde_json::Value {
    match value {
        Value::Bool(on) => json!(on),
        Value::Int(number) => json!(number),
        Value::Float(number) => json!(number),
        Value::Vector(vector) => json!(vector),
        Value::Text(text) => json!(text),
        Value::Texts(texts) => json!(texts),
        Value::Ints(numbers) => json!(numbers),
        Value::Floats(numbers) => json!(numbers),
        Value::Vectors(vectors) => json!(vectors),
        Value::Choice(choice) => {
            let word = row.words().into_iter().find(|(index, _)| index == choice).map(|(_, word)| word);
            json!(word)
        }
        Value::Components(parts) => json!(parts.iter().map(ToString::to_string).collect::<Vec<_>>()),
        Value::Ramp(points) => {
            json!(points.iter().map(|point| [point.position, point.value]).collect::<Vec<_>>())
        }
        Value::ColorRamp(points) => {
            json!(points.iter().map(|point| (point.position, point.color)).collect::<Vec<_>>())
        }
        Value::Painting(painting) => {
            let (word, text) = painting.parts();
            json!(format!("{word}({})", json!(text)))
        }
    }
}

/// Whether an attribute takes one of its words, rather than text in quotes. False for unknown names.
#[pyfunction]
pub fn takes_word(type_name: &str, attribute: &str) -> bool {
    let row = node_type(type_name).and_then(|of| of.attribute(attribute));
    row.is_some_and(|row| matches!(row.kind, Kind::Choice(_)))
}

/// The names of all attributes of a type of node. None for an unknown type.
#[pyfunction]
pub fn attributes(type_name: &str) -> Vec<&'static str> {
    node_type(type_name).map_or(Vec::new(), |of| of.attributes().iter().map(|row| row.name).collect())
}
