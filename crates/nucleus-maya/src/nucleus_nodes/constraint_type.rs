//! The menu type of a constraint, which Maya does not store: the one whose links are those that the attributes describe.
//!
//! A type forms links in a way of its own where it joins points to a surface, welds borders, or splits a mesh along the
//! edges that can tear. All other links are between pairs of elements, and follow from the attributes alone.

use nucleus_graph::attributes::{Attribute, Choice, Value, dynamic_constraint as con};
use nucleus_graph::compile::defaults_by_type;
use nucleus_graph::graph::{NodeId as OwnId, Setting};

use crate::scene::NodeId;

use super::constraints::{Part, PointsOfPart};
use super::importer::Importer;

/// Numbers of `constraintType`.
const TRANSFORM: i32 = 0;
const PAIRS: i32 = 1;
const TO_SURFACE: i32 = 2;
const SLIDE_ON_SURFACE: i32 = 3;
const WELD_BORDERS: i32 = 4;
const FORCE: i32 = 5;
const MATCH: i32 = 6;
const TEARABLE: i32 = 7;
const DISABLE_COLLISION: i32 = 8;
const EXCLUDE_PAIRS: i32 = 9;

/// Numbers of Maya's choices.
const TO_TRANSFORM: f64 = 0.0;
const ALL_TO_FIRST: f64 = 0.0;
const WELD: f64 = 0.0;
const WITHIN_DISTANCE: f64 = 1.0;
const UNBREAKABLE: f64 = 1.0;

impl Importer<'_> {
    /// Sets the type of a constraint, and what the file leaves out to the defaults of Maya's node.
    pub(super) fn set_constraint_type(&mut self, from: NodeId, to: OwnId, parts: &[Part]) {
        let kind = self.constraint_type(from, parts);
        if kind != TRANSFORM {
            self.set(to, &con::CONSTRAINT_TYPE.row, Setting::Fixed(Value::Choice(Choice(kind))));
        }
        self.set_node_defaults(from, to, kind);
    }

    fn constraint_type(&self, id: NodeId, parts: &[Part]) -> i32 {
        let number = |row| self.number_of(id, row);
        let is_weak = number(&con::STRENGTH.row) == 0.0;
        let is_to_transform = number(&con::CONSTRAINT_RELATION.row) == TO_TRANSFORM;
        if is_weak && number(&con::EXCLUDE_COLLISIONS.row) != 0.0 {
            return match parts {
                _ if is_to_transform => DISABLE_COLLISION,
                [_, _, ..] => EXCLUDE_PAIRS,
                _ => PAIRS,
            };
        }
        if is_to_transform {
            return if is_weak && number(&con::FORCE.row) != 0.0 { FORCE } else { TRANSFORM };
        }
        if number(&con::COMPONENT_RELATION.row) == ALL_TO_FIRST {
            return self.type_to_first(id, parts);
        }
        match number(&con::CONSTRAINT_METHOD.row) == WELD
            && number(&con::CONNECTION_METHOD.row) == WITHIN_DISTANCE
        {
            true if !parts.is_empty() && parts.iter().all(Part::is_border) => WELD_BORDERS,
            true if self.can_tear(id, parts) => TEARABLE,
            _ => PAIRS,
        }
    }

    /// The type of a constraint that joins all components to the first.
    fn type_to_first(&self, id: NodeId, parts: &[Part]) -> i32 {
        let number = |row| self.number_of(id, row);
        match parts {
            [first, others @ ..] if first.is_surface() && !others.is_empty() => {
                let slides = number(&con::CONNECTION_UPDATE.row) != 0.0;
                match slides && others.iter().any(|other| other.object != first.object) {
                    true => SLIDE_ON_SURFACE,
                    false => TO_SURFACE,
                }
            }
            [a, b] if number(&con::REST_LENGTH_SCALE.row) == 0.0 => {
                let [ours, theirs] = [a, b].map(|part| self.points_in(part));
                if ours.is_some() && ours == theirs { MATCH } else { PAIRS }
            }
            _ => PAIRS,
        }
    }

    /// Whether a weld within a distance tears a surface: it joins the points of one object with each other, and breaks.
    ///
    /// Our type splits the mesh itself. One that is split already, as Maya's command leaves it, is held by pairs.
    fn can_tear(&self, id: NodeId, parts: &[Part]) -> bool {
        let glue = &con::GLUE_STRENGTH.row;
        let breaks = self.number_of(id, glue) < UNBREAKABLE
            || self.scene.source(id, &[glue.short, glue.name], None).is_some();
        let [first, others @ ..] = parts else { return false };
        let is_split = self.mesh_elements(first.object).is_some_and(|elements| elements.is_split);
        breaks
            && !is_split
            && self.number_of(id, &con::CONNECT_WITHIN_COMPONENT.row) != 0.0
            && others.iter().all(|other| other.object == first.object)
    }

    /// The number of points of a component of points; `None` for other components, and where it is not known.
    fn points_in(&self, part: &Part) -> Option<usize> {
        match part.points() {
            PointsOfPart::Listed(count) => Some(count),
            PointsOfPart::All => self.points_of(part.object),
            PointsOfPart::None => None,
        }
    }

    /// A stored number of a constraint, or the default of the node.
    fn number_of(&self, id: NodeId, row: &'static Attribute) -> f64 {
        let default = match row.default {
            Some(Value::Float(x)) => x,
            Some(Value::Choice(choice)) => f64::from(choice.0),
            Some(Value::Bool(on)) => f64::from(u8::from(on)),
            _ => 0.0,
        };
        self.scene.stored_or(id, &[row.short, row.name], default)
    }

    /// Sets what the file leaves out to the default of Maya's node, where our type has another.
    fn set_node_defaults(&mut self, from: NodeId, to: OwnId, kind: i32) {
        let node_type = &con::DYNAMIC_CONSTRAINT;
        let words = con::CONSTRAINT_TYPE.row.words();
        let Some((_, word)) = words.into_iter().find(|(index, _)| index.0 == kind) else { return };
        for row in node_type.attributes() {
            let is_of_type = defaults_by_type(node_type, row).iter().any(|(of, _)| *of == word)
                || kind == FORCE && row == &con::STRENGTH_DROPOFF.row
                || kind == TEARABLE && row == &con::BEND.row;
            let is_given = self.graph.node(to).settings().contains_key(row.name)
                || self.is_fed_by_kept(from, &[row.short, row.name]);
            if let (true, false, Some(default)) = (is_of_type, is_given, &row.default) {
                // A default fits its own row.
                let _ = self.graph.set(to, row, Setting::from(default.clone()));
            }
        }
    }
}
