//! A scene as text: always the same text for the same scene.

use std::fmt::Write;

use crate::animation::{Curve, Tangent};
use crate::attributes::{Attribute, Choice, ColorPoint, Kind, RampPoint, Value, n_base};
use crate::graph::{Channel, Graph, Node, NodeId, Setting};

use super::document::{Record, Scene, TimeSpan};
use super::read::INTERPOLATIONS;

/// Writes a scene as RON that reads back to the same scene, to the bit.
///
/// Nodes are in the order of their names, attributes in that of their tables. What creation commands make
/// is left out, because reading makes it again.
pub fn write_scene(scene: &Scene) -> String {
    let TimeSpan { start, end, fps } = scene.time;
    let mut text = format!("Scene(\n    time: (start: {start}, end: {end}, fps: {fps}),\n");
    if scene.record == Record::Substeps {
        text.push_str("    record: substeps,\n");
    }
    text.push_str("    nodes: {\n");
    let mut nodes: Vec<(NodeId, &Node)> =
        scene.graph.iter().filter(|(_, node)| node.made_by().is_none()).collect();
    nodes.sort_by_key(|(_, node)| node.name());
    for (id, node) in nodes {
        write_node(&scene.graph, id, node, &mut text);
    }
    text.push_str("    },\n");
    if !scene.checks.is_empty() {
        let checks: Vec<String> = scene.checks.iter().map(ToString::to_string).collect();
        let _ = writeln!(text, "    checks: [{}],", checks.join(", "));
    }
    text + ")\n"
}

fn write_node(graph: &Graph, id: NodeId, node: &Node, text: &mut String) {
    let (name, node_type) = (quoted(node.name()), node.node_type());
    let fields: Vec<String> =
        node_type.attributes().into_iter().flat_map(|row| fields_of(graph, id, row)).collect();
    let _ = write!(text, "        {name}: {}(", node_type.name);
    match fields.as_slice() {
        [] => text.push_str("),\n"),
        [field] => {
            let _ = writeln!(text, "{field}),");
        }
        fields => {
            text.push('\n');
            for field in fields {
                let _ = writeln!(text, "            {field},");
            }
            text.push_str("        ),\n");
        }
    }
}

/// `name: value` for one attribute, or for each part of it; nothing if it is not set.
fn fields_of(graph: &Graph, id: NodeId, row: &'static Attribute) -> Vec<String> {
    let node = graph.node(id);
    let target = match row.name {
        "inputMesh" => graph.source(id, &n_base::INPUT_MESH),
        "parent" => node.parent(),
        _ => None,
    };
    if let Some(target) = target {
        return vec![format!("{}: {}", row.name, quoted(graph.node(target).name()))];
    }
    match node.settings().get(row.name) {
        None => Vec::new(),
        Some(Setting::Fixed(value)) => vec![format!("{}: {}", row.name, held(value, row))],
        Some(Setting::Keyed(curve)) => vec![format!("{}: {}", row.name, keyed(curve, row))],
        Some(Setting::Parts(channels)) => parts(channels, row),
    }
}

fn held(value: &Value, row: &Attribute) -> String {
    match value {
        Value::Bool(on) => on.to_string(),
        Value::Int(number) => number.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Vector(vector) => triple(*vector),
        Value::Choice(choice) => word(*choice, row),
        Value::Text(text) => quoted(text),
        Value::Ints(numbers) => list(numbers.iter().map(ToString::to_string)),
        Value::Floats(numbers) => list(numbers.iter().map(ToString::to_string)),
        Value::Vectors(vectors) => list(vectors.iter().map(|vector| triple(*vector))),
        Value::Ramp(points) => list(points.iter().map(ramp_point)),
        Value::ColorRamp(points) => list(points.iter().map(color_point)),
        Value::Components(parts) => list(parts.iter().map(|part| quoted(&part.to_string()))),
    }
}

/// A vector: as one if its parts are alike, else part by part.
fn parts(channels: &[Channel; 3], row: &Attribute) -> Vec<String> {
    use Channel::{Fixed, Keyed};
    match channels {
        [Fixed(x), Fixed(y), Fixed(z)] => vec![format!("{}: {}", row.name, triple([*x, *y, *z]))],
        [Keyed(x), Keyed(y), Keyed(z)] if same_times(x, y) && same_times(x, z) => {
            let key = |k: usize| {
                let value = triple([x, y, z].map(|curve| curve.keys()[k].value));
                key(x.keys()[k].frame, value, x.keys()[k].tangent, row)
            };
            vec![format!("{}: keys({})", row.name, list((0..x.keys().len()).map(key)))]
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

/// Whether two curves have keys at the same frames, with the same tangents.
fn same_times(a: &Curve, b: &Curve) -> bool {
    a.keys().len() == b.keys().len()
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
    format!("keys({})", list(curve.keys().iter().map(|k| key(k.frame, value(k.value), k.tangent, row))))
}

fn key(frame: f64, value: String, tangent: Tangent, row: &Attribute) -> String {
    let usual =
        if matches!(row.kind, Kind::Bool | Kind::Choice(_)) { Tangent::Stepped } else { Tangent::Linear };
    match tangent {
        tangent if tangent == usual => format!("({frame}, {value})"),
        Tangent::Stepped => format!("({frame}, {value}, stepped)"),
        Tangent::Linear => format!("({frame}, {value}, linear)"),
        Tangent::Spline => format!("({frame}, {value}, spline)"),
    }
}

fn ramp_point(point: &RampPoint) -> String {
    let way = way_on(point.interpolation);
    format!("({}, {}{way})", point.position, point.value)
}

fn color_point(point: &ColorPoint) -> String {
    let way = way_on(point.interpolation);
    format!("({}, {}{way})", point.position, triple(point.color))
}

/// How a ramp goes on to its next point, unless that is the usual way.
fn way_on(interpolation: Choice) -> String {
    match usize::try_from(interpolation.0).ok().and_then(|index| INTERPOLATIONS.get(index)) {
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

/// Text in quotes, with escapes for what cannot stand there.
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
