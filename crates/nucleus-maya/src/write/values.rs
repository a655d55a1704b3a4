//! Settings as `setAttr` statements, and curves as `animCurve` nodes.

use std::fmt::Write;

use nucleus_graph::animation::{Curve, Infinity, Tangent};
use nucleus_graph::attributes::{Attribute, Kind, Painting, Value, transform};
use nucleus_graph::graph::{Channel, NodeId, Setting};

use crate::nucleus_nodes::MARK_PAINT;
use crate::omissions::Cause;

use super::writer::{Writer, is_of_transform, quoted};

impl Writer<'_> {
    /// Writes the settings of a node whose rows are picked.
    pub(super) fn settings(&mut self, id: NodeId, picked: impl Fn(&Attribute) -> bool) {
        let [outer, shape] = self.names[&id].clone();
        let graph = self.graph();
        let rows = graph.node(id).settings().iter();
        for (name, setting) in rows {
            let Some(row) = graph.node(id).node_type().attribute(name).filter(|row| picked(row)) else {
                continue;
            };
            let node = if is_of_transform(row) { &outer } else { &shape };
            self.setting(node, row, setting);
        }
    }

    /// As [`settings`](Self::settings), on another node of Maya's.
    pub(super) fn settings_of(&mut self, id: NodeId, node: &str, picked: impl Fn(&Attribute) -> bool) {
        let graph = self.graph();
        for (name, setting) in graph.node(id).settings() {
            if let Some(row) = graph.node(id).node_type().attribute(name).filter(|row| picked(row)) {
                self.setting(node, row, setting);
            }
        }
    }

    /// Writes a setting: of the current node, and of curves that are connected to it later.
    pub(super) fn setting(&mut self, node: &str, row: &'static Attribute, setting: &Setting) {
        if row.extension {
            self.add_attribute(row);
        }
        let name = if row.extension { row.name } else { row.short };
        match setting {
            Setting::Fixed(value) => self.value(node, name, row, value),
            Setting::Keyed(curve) => self.curve(node, name, row, curve),
            Setting::Parts(channels) => self.parts(node, name, row, channels),
        }
    }

    fn value(&mut self, node: &str, name: &str, row: &'static Attribute, value: &Value) {
        let numbers =
            |all: &mut dyn Iterator<Item = f64>| all.map(|x| x.to_string()).collect::<Vec<_>>().join(" ");
        let line = match value {
            Value::Bool(on) => format!("\".{name}\" {}", if *on { "yes" } else { "no" }),
            Value::Int(x) => format!("\".{name}\" {x}"),
            Value::Float(x) => format!("\".{name}\" {x}"),
            Value::Choice(choice) => format!("\".{name}\" {}", choice.0),
            Value::Vector([x, y, z]) => format!("\".{name}\" -type \"double3\" {x} {y} {z}"),
            Value::Text(text) => format!("\".{name}\" -type \"string\" {}", quoted(text)),
            Value::Texts(all) => {
                let list: Vec<String> = all.iter().map(|text| quoted(text)).collect();
                format!("\".{name}\" -type \"stringArray\" {} {}", all.len(), list.join(" "))
            }
            Value::Ints(all) if all.is_empty() => return,
            Value::Ints(all) => {
                let list = numbers(&mut all.iter().map(|x| f64::from(*x)));
                format!("-s {} \".{name}[0:{}]\" {list}", all.len(), all.len() - 1)
            }
            Value::Floats(all) => {
                let list = numbers(&mut all.iter().copied());
                format!("\".{name}\" -type \"doubleArray\" {} {list}", all.len())
            }
            Value::Vectors(all) => {
                let list = numbers(&mut all.iter().flatten().copied());
                format!("\".{name}\" -type \"vectorArray\" {} {list}", all.len())
            }
            Value::Ramp(points) if points.is_empty() => return,
            Value::Ramp(points) => {
                let point = |p: &nucleus_graph::attributes::RampPoint| {
                    [p.position, p.value, f64::from(p.interpolation.0)]
                };
                let list = numbers(&mut points.iter().flat_map(point));
                format!("-s {} \".{name}[0:{}]\" {list}", points.len(), points.len() - 1)
            }
            Value::ColorRamp(points) if points.is_empty() => return,
            Value::ColorRamp(points) => {
                let point = |p: &nucleus_graph::attributes::ColorPoint| {
                    let [r, g, b] = p.color;
                    [p.position, r, g, b, f64::from(p.interpolation.0)]
                };
                let list = numbers(&mut points.iter().flat_map(point));
                format!("-s {} \".{name}[0:{}]\" {list}", points.len(), points.len() - 1)
            }
            Value::Components(parts) => {
                let list: Vec<String> = parts.iter().map(ToString::to_string).collect();
                format!("\".{name}\" -type \"string\" {}", quoted(&list.join(" ")))
            }
            Value::Painting(painting) => return self.painting(node, name, row, painting),
        };
        let _ = writeln!(self.text, "\tsetAttr {line};");
    }

    /// A texture is a file node; other sources of values are kept as text, which Maya does not read.
    fn painting(&mut self, node: &str, name: &str, row: &Attribute, painting: &Painting) {
        let (word, argument) = painting.parts();
        if let Painting::Texture(file) = painting {
            let texture = self.free_name(&format!("{node}_{name}"));
            let _ = write!(
                self.tail,
                "createNode file -n \"{texture}\";\n\tsetAttr \".ftn\" -type \"string\" {};\n\
                 connectAttr \"{texture}.oa\" \"{node}.{name}\";\n",
                quoted(file)
            );
            return;
        }
        self.add_text(&format!("{MARK_PAINT}{}", row.name), &format!("{word}:{argument}"));
        let what = format!("{node}.{}", row.name);
        self.omissions.add(what, Cause::Value(format!("Maya has no {word} of values for points")));
    }

    /// Components that are fixed, and a curve for each of the others.
    fn parts(&mut self, node: &str, name: &str, row: &'static Attribute, channels: &[Channel; 3]) {
        if let [Channel::Fixed(x), Channel::Fixed(y), Channel::Fixed(z)] = channels {
            self.value(node, name, row, &Value::Vector([*x, *y, *z]));
            return;
        }
        let Some(parts) = row.parts() else { return };
        for (channel, (_, short)) in channels.iter().zip(parts) {
            match channel {
                Channel::Fixed(x) => {
                    let _ = writeln!(self.text, "\tsetAttr \".{short}\" {x};");
                }
                Channel::Keyed(curve) => self.curve(node, short, row, curve),
            }
        }
    }

    /// An `animCurve` node, and its connection.
    fn curve(&mut self, node: &str, name: &str, row: &Attribute, curve: &Curve) {
        let kind = match row {
            row if row == &transform::TRANSLATE.row => "animCurveTL",
            row if row == &transform::ROTATE.row => "animCurveTA",
            _ => "animCurveTU",
        };
        let own = self.free_name(&format!("{node}_{name}"));
        let keys = curve.keys();
        let last = keys.len() - 1;
        let (mut pairs, mut into, mut out) = (String::new(), String::new(), String::new());
        for (k, key) in keys.iter().enumerate() {
            let [a, b] = tangents(key.tangent, k == 0 || k == last);
            let _ = write!(pairs, " {} {}", key.frame, key.value);
            let _ = write!(into, " {a}");
            let _ = write!(out, " {b}");
        }
        let count = keys.len();
        let mut text = format!(
            "createNode {kind} -n \"{own}\";\n\tsetAttr \".tan\" 2;\n\tsetAttr \".wgt\" no;\n\
             \tsetAttr -s {count} \".ktv[0:{last}]\" {pairs};\n\tsetAttr -s {count} \".kit[0:{last}]\" {into};\n\
             \tsetAttr -s {count} \".kot[0:{last}]\" {out};\n"
        );
        for (plug, infinity) in ["pre", "pst"].into_iter().zip(curve.infinities()) {
            if infinity != Infinity::Constant {
                let _ = writeln!(text, "\tsetAttr \".{plug}\" {};", number_of(infinity));
            }
        }
        let _ = writeln!(text, "connectAttr \"{own}.o\" \"{node}.{name}\";");
        self.tail.push_str(&text);
    }

    /// Adds an attribute that Maya's node does not have.
    fn add_attribute(&mut self, row: &Attribute) {
        let kind = match row.kind {
            Kind::Choice(_) => return self.add_enum(row),
            Kind::Bool => "-at \"bool\"",
            Kind::Int => "-at \"long\"",
            Kind::Float => "-at \"double\"",
            Kind::Texts => "-dt \"stringArray\"",
            _ => "-dt \"string\"",
        };
        let _ = writeln!(self.text, "\taddAttr -ci true -k true -sn \"{0}\" -ln \"{0}\" {kind};", row.name);
    }
}

/// Maya's tangents before and after a key. At the ends of a curve, ours of a spline are flat, as Maya's of a plateau.
fn tangents(tangent: Tangent, is_end: bool) -> [u8; 2] {
    match tangent {
        Tangent::Stepped => [2, 5],
        Tangent::Linear => [2, 2],
        Tangent::Spline if is_end => [16, 16],
        Tangent::Spline => [9, 9],
        Tangent::Flat => [3, 3],
        Tangent::Auto => [18, 18],
    }
}

fn number_of(infinity: Infinity) -> u8 {
    match infinity {
        Infinity::Constant => 0,
        Infinity::Linear => 1,
        Infinity::Cycle => 3,
        Infinity::CycleOffset => 4,
        Infinity::Oscillate => 5,
    }
}
