//! Compares the tables with Maya: names, type, default, ranges and enum values of every attribute.
//!
//! `maya.csv` and `inherited.csv` hold facts about Maya's nodes. Intended differences are listed here with the reason.

use super::*;

/// A fact about one attribute.
struct Fact<'a> {
    node_type: &'static NodeType,
    name: &'a str,
    short: &'a str,
    kind: &'a str,
    multi: bool,
    default: &'a str,
    range: [Option<f64>; 4],
    words: &'a str,
    readable: bool,
    writable: bool,
    hidden: bool,
    used: bool,
    part_of: &'a str,
}

/// A type by its name, including base types that a scene cannot name.
fn any_type(name: &str) -> Option<&'static NodeType> {
    let base = [&particle::PARTICLE, &n_base::N_BASE, &dyn_base::DYN_BASE, &field::FIELD];
    node_type(name).or_else(|| base.into_iter().find(|known| known.name == name))
}

fn facts() -> Vec<Fact<'static>> {
    include_str!("maya.csv").lines().skip(1).map(fact).collect()
}

fn fact(line: &'static str) -> Fact<'static> {
    let cells: Vec<&str> = line.split(',').collect();
    let [
        node,
        name,
        short,
        kind,
        multi,
        default,
        min,
        max,
        soft_min,
        soft_max,
        words,
        r,
        w,
        hidden,
        used,
        part_of,
    ] = cells[..]
    else {
        panic!("{line}")
    };
    let number = |text: &str| text.parse::<f64>().ok();
    Fact {
        node_type: any_type(node).unwrap_or_else(|| panic!("there is no {node}")),
        name,
        short,
        kind,
        multi: multi == "yes",
        default,
        range: [min, max, soft_min, soft_max].map(number),
        words,
        readable: r == "yes",
        writable: w == "yes",
        hidden: hidden == "yes",
        used: used == "yes",
        part_of,
    }
}

impl Fact<'_> {
    fn label(&self) -> String {
        format!("{}.{}", self.node_type.name, self.name)
    }

    /// The row; `None` for a component of a vector or of a ramp.
    fn row(&self) -> Option<&'static Attribute> {
        let own = self.node_type.rows.iter().copied().find(|row| row.name == self.name);
        let inside = || {
            self.node_type.rows.iter().find(|row| row.short == self.part_of).is_some_and(|whole| {
                let is_part = whole.parts().is_some_and(|parts| {
                    parts.iter().any(|(long, short)| long == self.name && *short == self.short)
                });
                is_part || whole.kind == Kind::Ramp && self.name.starts_with(whole.name)
            })
        };
        assert!(own.is_some() || inside(), "there is no {}", self.label());
        own
    }
}

// EVIDENCE: N3.1-1  the solver, its objects, constraints and components are here with all that they hold
#[test]
fn every_attribute_of_mayas_nodes_exists_with_its_long_and_short_name() {
    let facts = facts();
    assert_eq!(facts.len(), 687);
    for fact in &facts {
        if let Some(row) = fact.row() {
            assert_eq!(row.short, fact.short, "{}", fact.label());
        }
    }
}

#[test]
fn every_attribute_has_mayas_type() {
    for fact in facts() {
        let Some(row) = fact.row() else { continue };
        let multi = fact.multi && !matches!(row.kind, Kind::Ramp | Kind::ColorRamp);
        assert!(row.multi || !multi, "{}", fact.label());
        let fits = match fact.kind {
            // Most lists of single values can only be connected, element by element.
            _ if multi && matches!(row.kind, Kind::Plug(_) | Kind::Floats) => true,
            "int" if multi && row.kind == Kind::Ints => true,
            "bool" => row.kind == Kind::Bool,
            "int" | "short" => row.kind == Kind::Int,
            "double" | "float" | "time" | "distance" | "angle" => {
                matches!(row.kind, Kind::Float | Kind::Texture)
            }
            "enum" => matches!(row.kind, Kind::Choice(_)),
            "double3" | "float3" | "int3" => matches!(row.kind, Kind::Vector(_)),
            "string" => row.kind == Kind::Text,
            "intArray" => row.kind == Kind::Ints,
            "doubleArray" => row.kind == Kind::Floats,
            "vectorArray" => row.kind == Kind::Vectors,
            "ramp_float" | "FalloffCurve" => row.kind == Kind::Ramp,
            "ramp_color" => row.kind == Kind::ColorRamp,
            _ => matches!(row.kind, Kind::Plug(_) | Kind::Node(Some(_))),
        };
        assert!(fits, "{}: {} is {:?}", fact.label(), fact.kind, row.kind);
    }
}

/// Defaults that Maya's commands set at creation.
const SET_BY_CREATION: [&str; 1] = ["gravityField.direction"];

#[test]
fn every_default_is_mayas() {
    for fact in facts() {
        let Some(row) = fact.row() else { continue };
        if fact.default.is_empty() || row.multi || SET_BY_CREATION.contains(&fact.label().as_str()) {
            continue;
        }
        let numbers: Vec<f64> = fact.default.split(' ').filter_map(|word| word.parse().ok()).collect();
        let same = match row.default.as_ref().unwrap_or_else(|| panic!("{}", fact.label())) {
            Value::Bool(on) => on.to_string() == fact.default,
            Value::Int(x) => numbers == [*x as f64],
            Value::Float(x) => numbers == [*x],
            Value::Choice(index) => numbers == [f64::from(index.0)],
            Value::Vector(vector) => numbers == vector,
            Value::Ramp(points) => {
                let words = ["None", "Linear", "Smooth", "Spline"];
                let point = |p: &RampPoint| {
                    format!("{:?}:{:?}:{}", p.position, p.value, words[p.interpolation.0 as usize])
                };
                points.iter().map(point).collect::<Vec<_>>().join(" ") == fact.default
            }
            _ => fact.default == "[]",
        };
        assert!(same, "{}: {:?} is not {}", fact.label(), row.default, fact.default);
    }
}

/// Ranges narrower than Maya's: the solver divides by the value or takes its root, or a negative value has no meaning.
fn is_narrower_on_purpose(row: &Attribute, end: usize) -> bool {
    matches!(row.effect, Effect::Solved(_)) && end < 2
}

#[test]
fn every_range_is_mayas_or_narrower() {
    for fact in facts() {
        let Some(row) = fact.row() else { continue };
        let soft = |end: usize| row.range.soft.map(|soft| [soft.0, soft.1][end]);
        let ours = [row.range.min, row.range.max, soft(0), soft(1)];
        for (end, (mayas, ours)) in fact.range.into_iter().zip(ours).enumerate() {
            let Some(mayas) = mayas else {
                let free = end >= 2 || ours.is_none() || is_narrower_on_purpose(row, end);
                assert!(free, "{}: {ours:?} where Maya has no bound", fact.label());
                continue;
            };
            assert_eq!(ours, Some(mayas), "{}: bound {end}", fact.label());
        }
    }
}

#[test]
fn every_enum_value_is_mayas() {
    for fact in facts().iter().filter(|fact| !fact.words.is_empty()) {
        let Some(row) = fact.row() else { continue };
        let Kind::Choice(words) = row.kind else { panic!("{}", fact.label()) };
        let words: Vec<String> = words.iter().map(|(index, word)| format!("{index}={word}")).collect();
        assert_eq!(words.join("|"), fact.words, "{}", fact.label());
    }
}

#[test]
fn outputs_and_inputs_of_maya_are_outputs_and_inputs() {
    for fact in facts() {
        let Some(row) = fact.row() else { continue };
        assert!(fact.readable || !row.readable, "{} can be read", fact.label());
        assert!(fact.writable || !row.writable, "{} can be written", fact.label());
    }
}

#[test]
fn attributes_that_maya_hides_or_does_not_use_are_hidden_or_without_effect() {
    for fact in facts() {
        let Some(row) = fact.row() else { continue };
        // A scene names the mesh instead of connecting it.
        let named = matches!(row.kind, Kind::Node(_));
        assert!(!fact.hidden || row.hidden || named, "{} is shown", fact.label());
        assert!(fact.used || !matches!(row.effect, Effect::Solved(_)), "{} has an effect", fact.label());
    }
}

/// Type, attribute, and the type that defines it; whether it is used and shown.
fn inherited() -> impl Iterator<Item = (&'static NodeType, &'static str, &'static str, bool, bool)> {
    include_str!("inherited.csv").lines().skip(1).map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let [node, name, from, used, shown] = cells[..] else { panic!("{line}") };
        (any_type(node).expect(node), name, from, used == "yes", shown == "yes")
    })
}

// EVIDENCE: N3.1-8  cloth, colliders and particles inherit from one base, and that from classic particles
#[test]
fn objects_inherit_as_many_attributes_as_in_maya() {
    for (node_type, name, from, ..) in inherited() {
        let row = node_type.attribute(name).unwrap_or_else(|| panic!("{}.{name}", node_type.name));
        assert!(any_type(from).expect(from).rows.iter().any(|base| base.name == row.name));
    }
    let extensions =
        |node_type: &'static NodeType| node_type.attributes().iter().filter(|row| !row.extension).count();
    let counts = [&n_cloth::N_CLOTH, &n_rigid::N_RIGID, &n_particle::N_PARTICLE].map(extensions);
    assert_eq!(counts, [339, 248, 347]);
}

// EVIDENCE: N3.1-9  what a node inherits and does not use is hidden, and still there
#[test]
fn inherited_attributes_that_an_object_does_not_use_are_hidden_and_still_exist() {
    for (node_type, name, _, used, shown) in inherited() {
        let row = node_type.attribute(name).unwrap_or_else(|| panic!("{}.{name}", node_type.name));
        assert!(used && shown || node_type.keeps_from_view(row), "{}.{name} is shown", node_type.name);
    }
}
