//! Attributes of constraints that have no effect beside the other values of the constraint: a warning says why.

use crate::attributes::{Attribute, ElementKind, dynamic_constraint as con};
use crate::compile::compiler::Compiler;
use crate::graph::{NodeId, Setting};

use super::kinds::{self, Values};
use super::member::Member;

/// The properties of a constraint that decide which of its attributes have an effect. One that keys can change is false.
struct Properties {
    /// Points are held in the space of the constraint.
    to_space: bool,
    /// Links join pairs, and their rest lengths are measured at the start.
    from_start: bool,
    /// Links join pairs, and their rest length is given.
    is_constant: bool,
    /// Links never slide.
    stays: bool,
    /// Links slide without a strength along the surface.
    is_loose: bool,
    /// No link joins a point with a face.
    has_no_surface: bool,
    /// A constant rest length of zero.
    is_on_surface: bool,
    /// `localCollide` is off.
    passes: bool,
    /// Joined edges never resist folding.
    folds_freely: bool,
}

/// Attributes without effect on constraints with a property.
struct Unused {
    rows: &'static [&'static Attribute],
    when: fn(&Properties) -> bool,
    because: &'static str,
    help: &'static str,
}

static UNUSED: &[Unused] = &[
    Unused {
        rows: &[
            &con::CONNECTION_METHOD.row,
            &con::COMPONENT_RELATION.row,
            &con::CONNECT_WITHIN_COMPONENT.row,
            &con::CONNECTION_DENSITY.row,
            &con::CONNECTION_DENSITY_RANGE.row,
            &con::MAX_DISTANCE.row,
        ],
        when: |constraint| constraint.to_space,
        because: "points are held at their own places, not in pairs",
        help: "leave it out, or join two components: `type: pointToPoint`",
    },
    Unused {
        rows: &[&con::REST_LENGTH_METHOD.row, &con::REST_LENGTH.row, &con::REST_LENGTH_SCALE.row],
        when: |constraint| constraint.to_space,
        because: "its links have no length: points are held at their own places",
        help: "leave it out, or join two components: `type: pointToPoint`",
    },
    Unused {
        rows: &[&con::REST_LENGTH.row],
        when: |constraint| constraint.from_start,
        because: "`restLengthMethod` is fromStartDistance",
        help: "write `restLengthMethod: constant`",
    },
    Unused {
        rows: &[&con::REST_LENGTH_SCALE.row],
        when: |constraint| constraint.is_constant,
        because: "`restLengthMethod` is constant",
        help: "give `restLength`, which can be keyed",
    },
    Unused {
        rows: &[&con::FRICTION.row, &con::SINGLE_SIDED.row],
        when: |constraint| constraint.stays,
        because: "its links do not slide",
        help: "`tangentStrength` holds points along a surface; with `type: slideOnSurface` they slide",
    },
    Unused {
        rows: &[&con::FRICTION.row],
        when: |constraint| constraint.is_loose,
        because: "`tangentStrength` is 0",
        help: "give `tangentStrength`, which friction weakens or strengthens",
    },
    Unused {
        rows: &[&con::LOCAL_COLLIDE.row],
        when: |constraint| constraint.has_no_surface,
        because: "no link joins a point with a surface",
        help: "name faces, or write `type: pointToSurface`",
    },
    Unused {
        rows: &[&con::LOCAL_COLLIDE.row],
        when: |constraint| constraint.is_on_surface && !constraint.has_no_surface,
        because: "`restLength` is 0",
        help: "write `restLengthScale: 0` instead of a constant rest length",
    },
    Unused {
        rows: &[&con::BEND_STRENGTH.row, &con::BEND_BREAK_ANGLE.row],
        when: |constraint| constraint.folds_freely,
        because: "`bend` is false",
        help: "write `bend: true`",
    },
    Unused {
        rows: &[&con::COLLIDE_WIDTH_SCALE.row],
        when: |constraint| constraint.passes,
        because: "`localCollide` is false",
        help: "write `localCollide: true`",
    },
];

impl Compiler<'_> {
    /// Warns of attributes of a constraint that have no effect. Pins need no members.
    pub(super) fn warn_of_unused_attributes(&mut self, constraint: NodeId, members: &[Member]) {
        let properties = self.properties(constraint, members);
        let node = self.scene.graph.node(constraint);
        for Unused { rows, because, help, .. } in UNUSED.iter().filter(|unused| (unused.when)(&properties)) {
            let is_set = |row: &&&Attribute| {
                node.settings().get(row.name).is_some_and(|setting| !is_default(setting, row))
            };
            for row in rows.iter().filter(is_set) {
                let place = self.scene.source.place(&format!("{}.{}", node.name(), row.name));
                let message = format!("`{}` of `{}` has no effect: {because}", row.name, node.name());
                self.findings.warning(&place, message).help(*help);
            }
        }
    }

    fn properties(&self, constraint: NodeId, members: &[Member]) -> Properties {
        let values = Values::new(&self.start, constraint);
        let graph = &self.scene.graph;
        let never = |key, wanted: i32| !graph.changes(constraint, key) && values.choice(key) != wanted;
        let always = |key, wanted: i32| !graph.changes(constraint, key) && values.choice(key) == wanted;
        let constant = con::CONSTANT_REST_LENGTH.0;
        let to_space = always(&con::CONSTRAINT_RELATION, kinds::TO_SPACE);
        let in_pairs = never(&con::CONSTRAINT_RELATION, kinds::TO_SPACE);
        let grips = values.ever(&con::TANGENT_STRENGTH, |strength| strength > 0.0);
        let is_constant = in_pairs && always(&con::REST_LENGTH_METHOD, constant);
        Properties {
            to_space,
            from_start: in_pairs && never(&con::REST_LENGTH_METHOD, constant),
            is_constant,
            is_on_surface: is_constant && !values.ever(&con::REST_LENGTH, |length| length != 0.0),
            stays: !values.slides() && !graph.changes(constraint, &con::CONNECTION_UPDATE),
            is_loose: values.slides() && !grips && never(&con::CONSTRAINT_METHOD, kinds::WELD),
            has_no_surface: to_space || members.iter().all(|member| member.kind != ElementKind::Face),
            folds_freely: !graph.is_ever_nonzero(constraint, &con::BEND) && values.kind != kinds::TEARABLE,
            passes: !values.toggle(&con::LOCAL_COLLIDE) && !graph.changes(constraint, &con::LOCAL_COLLIDE),
        }
    }
}

/// A setting of the default value says nothing.
fn is_default(setting: &Setting, row: &Attribute) -> bool {
    matches!(setting, Setting::Fixed(value) if Some(value) == row.default.as_ref())
}
