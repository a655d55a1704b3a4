//! Assignments: `cloth1.bendResistance=0.1` sets an attribute of a scene from outside its file.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use super::edit::{Edit, EditError, NewValue, edit};
use super::read::preset::read_preset;
use super::syntax;
use crate::attributes::{Attribute, Kind, NodeType};
use crate::diagnostic::{Diagnostic, Severity, nearest};
use crate::graph::Graph;

/// A value for one attribute, as it is written in a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// The name of the node.
    pub node: String,
    /// The name of the attribute, or of a component of a vector (`translateX`).
    pub attribute: String,
    /// The value in the syntax of scenes: `0.1`, `(0, 1, 0)`, `classic`, `keys([(1, 0), (24, 5)])`.
    pub value: String,
}

/// Reasons why an assignment does not fit a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AssignError {
    /// The text is not an assignment.
    #[error("`{text}` is not an assignment; write `node.attribute=value`")]
    NotAnAssignment {
        /// The text.
        text: String,
    },
    /// The scene has no such node.
    #[error("the scene has no node `{node}`{}", hint(.near))]
    NoNode {
        /// Its name.
        node: String,
        /// The nearest name.
        near: Option<String>,
    },
    /// The node has no such attribute.
    #[error("`{node}` is of type {node_type}, which has no attribute `{attribute}`{}", hint(.near))]
    NoAttribute {
        /// The node.
        node: String,
        /// Its type.
        node_type: &'static str,
        /// The attribute.
        attribute: String,
        /// The nearest name.
        near: Option<String>,
    },
    /// The attribute does not take this value.
    #[error("{message}{}", hint(.help))]
    Value {
        /// The values that the attribute accepts, and the value found.
        message: String,
        /// How to fix it.
        help: Option<String>,
    },
    /// The scene cannot be edited.
    #[error(transparent)]
    Edit(#[from] EditError),
}

/// Whether a character needs no quotes.
fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '/')
}

/// `; did you mean ...?`, or a help as it is.
fn hint(near: &Option<String>) -> String {
    match near {
        None => String::new(),
        Some(help) if help.contains(' ') => format!("; {help}"),
        Some(name) => format!("; did you mean `{name}`?"),
    }
}

/// `node.attribute=value`.
impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}={}", self.node, self.attribute, self.value)
    }
}

impl FromStr for Assignment {
    type Err = AssignError;

    fn from_str(text: &str) -> Result<Self, AssignError> {
        let refused = || AssignError::NotAnAssignment { text: text.to_owned() };
        let (plug, value) = text.split_once('=').ok_or_else(refused)?;
        let (node, attribute) = plug.split_once('.').ok_or_else(refused)?;
        let [node, attribute, value] = [node, attribute, value].map(str::trim);
        match [node, attribute, value].iter().any(|part| part.is_empty()) {
            true => Err(refused()),
            false => {
                Ok(Self { node: node.to_owned(), attribute: attribute.to_owned(), value: value.to_owned() })
            }
        }
    }
}

impl Assignment {
    /// Checks node, attribute and value against a graph, and replaces a short name of the attribute by its long one. A word
    /// for an attribute that takes text is put in quotes, which shells remove.
    /// Returns the row of the attribute.
    ///
    /// # Errors
    /// When the node or the attribute does not exist, or the value does not fit the attribute.
    pub fn resolve(&mut self, graph: &Graph) -> Result<&'static Attribute, AssignError> {
        let node_type = self.node_type(graph)?;
        let part = || {
            let (row, part) = node_type.part(&self.attribute)?;
            row.parts().map(|parts| (row, parts[part].0.clone()))
        };
        let whole = node_type.attribute(&self.attribute).map(|row| (row, row.name.to_owned()));
        let Some((row, name)) = whole.or_else(part) else { return Err(self.unknown_attribute(node_type)) };
        self.attribute = name;
        if matches!(row.kind, Kind::Text) && self.value.chars().all(is_of_word) {
            self.value = format!("\"{}\"", self.value);
        }
        self.check_value(node_type, row)?;
        Ok(row)
    }

    fn node_type(&self, graph: &Graph) -> Result<&'static NodeType, AssignError> {
        let found = graph.find(&self.node).map(|id| graph.node(id).node_type());
        found.ok_or_else(|| {
            let names = graph.iter().filter(|(_, node)| node.created_by().is_none());
            let near = nearest(&self.node, names.map(|(_, node)| node.name())).map(str::to_owned);
            AssignError::NoNode { node: self.node.clone(), near }
        })
    }

    fn unknown_attribute(&self, node_type: &'static NodeType) -> AssignError {
        let rows = node_type.attributes();
        let settable = rows.iter().filter(|row| !matches!(row.kind, Kind::Plug(_))).map(|row| row.name);
        let parts: Vec<String> =
            rows.iter().filter_map(|row| row.parts()).flatten().map(|(long, _)| long).collect();
        let near = nearest(&self.attribute, settable.chain(parts.iter().map(String::as_str)));
        AssignError::NoAttribute {
            node: self.node.clone(),
            node_type: node_type.name,
            attribute: self.attribute.clone(),
            near: near.map(str::to_owned),
        }
    }

    /// Reads the value as the only setting of a node of this type.
    fn check_value(&self, node_type: &NodeType, row: &Attribute) -> Result<(), AssignError> {
        if let Err(errors) = syntax::parse(&self.value) {
            let first = errors.into_iter().next().map(|error| error.message).unwrap_or_default();
            let message = format!("`{}` is not one value: {first}", self.value);
            return Err(AssignError::Value { message, help: None });
        }
        // What names other nodes is checked when the whole scene is read.
        if matches!(row.kind, Kind::Node(_) | Kind::Components) {
            return Ok(());
        }
        let text = format!("{}({}: {}\n)", node_type.name, self.attribute, self.value);
        match read_preset("value", &text, Path::new("")) {
            Ok(_) => Ok(()),
            Err(found) => Err(self.refusal(found)),
        }
    }

    fn refusal(&self, found: Vec<Diagnostic>) -> AssignError {
        let first = found.into_iter().find(|one| one.severity == Severity::Error);
        let (message, help) = first.map(|first| (first.message, first.help)).unwrap_or_default();
        AssignError::Value { message: message.replace("of `preset`", &format!("of `{}`", self.node)), help }
    }

    fn edit(&self) -> Edit {
        Edit {
            node: self.node.clone(),
            attribute: self.attribute.clone(),
            to: NewValue::Text(self.value.clone()),
        }
    }
}

/// The text of a scene with these values. Comments and layout stay unchanged.
///
/// ```
/// use nucleus_graph::scene::assigned;
///
/// let text = "Scene(time: (start: 1, end: 9, fps: 24), nodes: {\"n\": nucleus(subSteps: 3 /* Maya's */)})";
/// let five = "n.subSteps=5".parse().unwrap();
/// assert_eq!(assigned(text, &[five]).unwrap(), text.replace("subSteps: 3", "subSteps: 5"));
/// ```
///
/// # Errors
/// When the text is not a scene, or a node is not in it.
pub fn assigned(text: &str, assignments: &[Assignment]) -> Result<String, AssignError> {
    let edits: Vec<Edit> = assignments.iter().map(Assignment::edit).collect();
    Ok(edit(text, &edits)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read_scene_text;

    const TEXT: &str = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "nucleus1": nucleus(), "plane": polyPlane(), "cloth1": nCloth(inputMesh: "plane"),
    })"#;

    fn resolved(text: &str) -> Result<Assignment, String> {
        let (scene, _) = read_scene_text(TEXT, "a.ron".as_ref()).unwrap();
        let mut assignment: Assignment = text.parse().map_err(|error: AssignError| error.to_string())?;
        assignment.resolve(&scene.graph).map_err(|error| error.to_string())?;
        Ok(assignment)
    }

    #[test]
    fn values_that_fit_are_accepted_and_short_names_become_long_ones() {
        assert_eq!(resolved("cloth1.bnd = 3").unwrap().to_string(), "cloth1.bendResistance=3");
        for value in ["nucleus1.windDirection=(0, 1, 0)", "nucleus1.resistanceModel=classic", "plane.tx=2"] {
            assert!(resolved(value).is_ok(), "{value}: {:?}", resolved(value));
        }
        assert!(resolved("nucleus1.windSpeed=keys([(1, 0), (9, 5)])").is_ok());
        assert!(resolved("cloth1.inputMesh=\"plane\"").is_ok());
        assert_eq!(resolved("cloth1.preset=silk").unwrap().value, "\"silk\"");
        assert_eq!(resolved("cloth1.preset=\"silk\"").unwrap().value, "\"silk\"");
        let refused = resolved("cloth1.preset=3 + 4").unwrap_err();
        assert!(refused.contains("is not one value"), "{refused}");
    }

    #[test]
    fn mistakes_name_node_attribute_value_and_the_fix() {
        let refusals = [
            ("cloth1.bend", "write `node.attribute=value`"),
            ("=3", "write `node.attribute=value`"),
            ("clot1.friction=3", "the scene has no node `clot1`; did you mean `cloth1`?"),
            (
                "cloth1.bendResistence=3",
                "`cloth1` is of type nCloth, which has no attribute `bendResistence`; did you mean `bendResistance`?",
            ),
            ("cloth1.friction=much", "`cloth1`"),
            ("nucleus1.subSteps=2.5", "a whole number"),
            ("nucleus1.resistanceModel=clasic", "did you mean `classic`?"),
            ("cloth1.friction=3, thickness: 1", "is not one value"),
            ("cloth1.friction=3), x(", "is not one value"),
        ];
        for (text, words) in refusals {
            let said = resolved(text).expect_err(text);
            assert!(said.contains(words), "{text}: {said}");
        }
    }

    #[test]
    fn an_assigned_scene_is_the_scene_that_was_edited_by_hand() {
        let assignment = resolved("cloth1.bendResistance=3").unwrap();
        let by_hand = TEXT.replace(r#"inputMesh: "plane""#, r#"inputMesh: "plane", bendResistance: 3"#);
        assert_eq!(assigned(TEXT, &[assignment]).unwrap(), by_hand);
    }
}
