//! A scene as text. Equal scenes give equal texts.

use std::fmt::Write;

use crate::animation::{Curve, Infinity, Tangent};
use crate::attributes::{
    Attribute, Choice, ColorPoint, Kind, RampPoint, Value, dynamic_constraint, n_particle,
};
use crate::graph::{Channel, Graph, Node, NodeId, Setting};

use super::comments::Comments;
use super::document::{Record, Scene, TimeSpan};
use super::layout::with_comments;
use super::short_form::ShortForm;
use super::syntax;

/// Writes a scene as RON that reads back to the same scene, to the bit.
///
/// Nodes are in the order of their names, attributes in that of their tables. Connections of creation commands are
/// left out, because reading makes them again; all others are written one by one.
pub fn write_scene(scene: &Scene) -> String {
    write(scene, "")
}

/// As [`write_scene`], with the comments of the text that the scene was read from. Each stays with its item: a field of
/// the scene, a node, an attribute, a check, a connection or an entry of a list. `record: frames` is left out unless it
/// has a comment.
pub fn format_scene(scene: &Scene, text: &str) -> String {
    let Ok(source) = syntax::parse(text) else { return write_scene(scene) };
    for record in ["    record: frames,\n", ""] {
        let written = write(scene, record);
        let Ok(root) = syntax::parse(&written) else { break };
        let comments = Comments::of(text, &source, &root, &scene.graph);
        if record.is_empty() || comments.are_at(&root, "record") {
            return with_comments(&written, &root, &comments);
        }
    }
    write_scene(scene)
}

/// Writes a scene, with this line if every frame is recorded.
fn write(scene: &Scene, record_frames: &str) -> String {
    let TimeSpan { start, end, fps } = scene.time;
    let every = if scene.every == 1.0 { String::new() } else { format!(", every: {}", scene.every) };
    let mut text = format!("Scene(\n    time: (start: {start}, end: {end}, fps: {fps}{every}),\n");
    match scene.record {
        Record::Frames => text.push_str(record_frames),
        Record::Substeps => text.push_str("    record: substeps,\n"),
        Record::Every(n) => {
            let _ = writeln!(text, "    record: every({n}),");
        }
        Record::None => text.push_str("    record: none,\n"),
    }
    text.push_str("    nodes: {\n");
    let short = ShortForm::of(&scene.graph);
    let mut nodes: Vec<(NodeId, &Node)> =
        scene.graph.iter().filter(|(id, _)| short.is_written(*id)).collect();
    nodes.sort_by_key(|(_, node)| node.name());
    for (id, node) in nodes {
        write_node(&scene.graph, id, node, &short, &mut text);
    }
    text.push_str("    },\n");
    write_connections(&short.explicit, &mut text);
    if !scene.checks.is_empty() {
        let checks: Vec<String> = scene.checks.iter().map(ToString::to_string).collect();
        let _ = writeln!(text, "    checks: [{}],", checks.join(", "));
    }
    text + ")\n"
}

/// Connections that no short form implies.
fn write_connections(pairs: &[[String; 2]], text: &mut String) {
    if pairs.is_empty() {
        return;
    }
    text.push_str("    connections: [\n");
    for [from, to] in pairs {
        let _ = writeln!(text, "        ({}, {}),", quoted(from), quoted(to));
    }
    text.push_str("    ],\n");
}

fn write_node(graph: &Graph, id: NodeId, node: &Node, short: &ShortForm, text: &mut String) {
    let (name, node_type) = (quoted(node.name()), node.node_type());
    let rows = node_type.attributes().into_iter();
    let fields: Vec<String> = rows.flat_map(|row| fields_of(graph, id, row, short)).collect();
    let head = format!("        {name}: {}(", node_type.name);
    match fields.as_slice() {
        [] => *text += &format!("{head}),\n"),
        [field] => *text += &format!("{head}{field}),\n"),
        fields => {
            *text += &format!("{head}\n");
            for field in fields {
                let _ = writeln!(text, "            {field},");
            }
            *text += "        ),\n";
        }
    }
}

/// `name: value` for an attribute, or for each component of a vector. Empty if it is not set.
fn fields_of(graph: &Graph, id: NodeId, row: &'static Attribute, short: &ShortForm) -> Vec<String> {
    let node = graph.node(id);
    let target = match row.name {
        "parent" => node.parent(),
        "blendTarget" => graph.blend_target(id),
        "restShapeMesh" => graph.rest_shape(id),
        name => short.named(id, name),
    };
    if let Some(target) = target {
        return vec![format!("{}: {}", row.name, quoted(graph.node(target).name()))];
    }
    // Reading a list of components makes their connections, which here are written one by one.
    if row.name == dynamic_constraint::COMPONENTS.row.name && short.is_connected_explicitly(graph, id) {
        return Vec::new();
    }
    let is_particles = node.node_type().is_a(&n_particle::N_PARTICLE);
    if row.name == "nucleus"
        && is_particles
        && !short.is_object(id)
        && !short.joins_a_nucleus_explicitly(node.name())
    {
        return vec!["nucleus: \"\"".to_owned()];
    }
    node.settings().get(row.name).map_or_else(Vec::new, |setting| setting_lines(row, setting))
}

/// `name: value` for a setting, or a line per component of a vector.
pub(super) fn setting_lines(row: &Attribute, setting: &Setting) -> Vec<String> {
    match setting {
        Setting::Fixed(value) => vec![format!("{}: {}", row.name, value_text(value, row))],
        Setting::Keyed(curve) => vec![format!("{}: {}", row.name, keyed(curve, row))],
        Setting::Parts(channels) => parts(channels, row),
    }
}

fn value_text(value: &Value, row: &Attribute) -> String {
    match value {
        Value::Bool(on) => on.to_string(),
        Value::Int(number) => number.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Vector(vector) => triple(*vector),
        Value::Choice(choice) => word(*choice, row),
        Value::Text(text) => quoted(text),
        Value::Texts(texts) => match texts.as_slice() {
            [text] => quoted(text),
            texts => list(texts.iter().map(|text| quoted(text))),
        },
        Value::Ints(numbers) => list(numbers.iter().map(ToString::to_string)),
        Value::Floats(numbers) => list(numbers.iter().map(ToString::to_string)),
        Value::Vectors(vectors) => list(vectors.iter().map(|vector| triple(*vector))),
        Value::Ramp(points) => list(points.iter().map(ramp_point)),
        Value::ColorRamp(points) => list(points.iter().map(color_point)),
        Value::Painting(painting) => {
            let (word, text) = painting.parts();
            format!("{word}({})", quoted(text))
        }
        Value::Components(parts) => list(parts.iter().map(|part| quoted(&part.to_string()))),
    }
}

/// A vector: as one field if its components are all fixed or have equal keys, else one field per component.
fn parts(channels: &[Channel; 3], row: &Attribute) -> Vec<String> {
    use Channel::{Fixed, Keyed};
    match channels {
        [Fixed(x), Fixed(y), Fixed(z)] => vec![format!("{}: {}", row.name, triple([*x, *y, *z]))],
        [Keyed(x), Keyed(y), Keyed(z)] if have_equal_keys(x, y) && have_equal_keys(x, z) => {
            let key = |k: usize| {
                let value = triple([x, y, z].map(|curve| curve.keys()[k].value));
                key(x.keys()[k].frame, value, x.keys()[k].tangent, row)
            };
            vec![format!("{}: {}", row.name, keys(list((0..x.keys().len()).map(key)), x.infinities()))]
        }
        _ => {
            let names = row.parts().into_iter().flatten().map(|(long, _)| long);
            let each = names.zip(channels).map(|(name, channel)| match channel {
                Fixed(number) => format!("{name}: {number}"),
                Keyed(curve) => format!("{name}: {}", keyed(curve, row)),
            });
            each.collect()
        }
    }
}

/// Whether two curves have the same key frames, tangents and infinities.
fn have_equal_keys(a: &Curve, b: &Curve) -> bool {
    a.infinities() == b.infinities()
        && a.keys().len() == b.keys().len()
        && a.keys()
            .iter()
            .zip(b.keys())
            .all(|(a, b)| (a.frame.to_bits(), a.tangent) == (b.frame.to_bits(), b.tangent))
}

fn keyed(curve: &Curve, row: &Attribute) -> String {
    let value = |x: f64| match row.kind {
        Kind::Bool => (x != 0.0).to_string(),
        Kind::Choice(_) => word(Choice(x as i32), row),
        _ => x.to_string(),
    };
    let list = list(curve.keys().iter().map(|k| key(k.frame, value(k.value), k.tangent, row)));
    keys(list, curve.infinities())
}

/// Keys, with infinities that are not constant.
fn keys(list: String, infinities: [Infinity; 2]) -> String {
    let word =
        |infinity| Infinity::WORDS.iter().find(|(_, known)| *known == infinity).map_or("", |(word, _)| word);
    match infinities {
        [Infinity::Constant, Infinity::Constant] => format!("keys({list})"),
        [Infinity::Constant, post] => format!("keys(at: {list}, post: {})", word(post)),
        [pre, Infinity::Constant] => format!("keys(at: {list}, pre: {})", word(pre)),
        [pre, post] => format!("keys(at: {list}, pre: {}, post: {})", word(pre), word(post)),
    }
}

fn key(frame: f64, value: String, tangent: Tangent, row: &Attribute) -> String {
    let default =
        if matches!(row.kind, Kind::Bool | Kind::Choice(_)) { Tangent::Stepped } else { Tangent::Linear };
    let word = Tangent::WORDS.iter().find(|(_, known)| *known == tangent).map_or("", |(word, _)| word);
    if tangent == default { format!("({frame}, {value})") } else { format!("({frame}, {value}, {word})") }
}

fn ramp_point(point: &RampPoint) -> String {
    let suffix = interpolation_suffix(point.interpolation);
    format!("({}, {}{suffix})", point.position, point.value)
}

fn color_point(point: &ColorPoint) -> String {
    let suffix = interpolation_suffix(point.interpolation);
    format!("({}, {}{suffix})", point.position, triple(point.color))
}

/// The interpolation to the next point of a ramp, unless it is linear.
fn interpolation_suffix(interpolation: Choice) -> String {
    match usize::try_from(interpolation.0).ok().and_then(|index| RampPoint::INTERPOLATIONS.get(index)) {
        Some(&"linear") | None => String::new(),
        Some(word) => format!(", {word}"),
    }
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

fn word(choice: Choice, row: &Attribute) -> String {
    let found = row.words().into_iter().find(|(index, _)| *index == choice);
    found.map_or_else(|| choice.0.to_string(), |(_, word)| word)
}

/// Text in quotes, with escapes for quotes, backslashes and control characters.
fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{{{:x}}}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
