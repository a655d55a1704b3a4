//! Attributes of constraints that have no effect beside the other values of the constraint: a warning says why.

use crate::attributes::{Attribute, ElementKind, Ramp, Value, dynamic_constraint as con, nucleus, transform};
use crate::compile::compiler::Compiler;
use crate::compile::units::CLASSIC;
use crate::graph::{NodeId, Setting};

use super::kinds::{self, Values};
use super::member::{Member, MemberObject};
use super::members::{can_break, has_links};

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
    /// Links join pairs, none of them with a face, and have a strength along surfaces.
    grips_nothing: bool,
    /// Links are welds with a face, and have a strength along its surface.
    grips_rigidly: bool,
    /// Pairs are made whatever their distance.
    has_no_reach: bool,
    /// The falloff over the distance is the same everywhere.
    has_no_dropoff: bool,
    /// A surface tears at its own edges, not between pairs.
    tears: bool,
    /// No link ever breaks.
    never_breaks: bool,
    /// Links are welds, and resistances are stiffnesses.
    is_rigid: bool,
    /// A force to the origin of the constraint, without links.
    is_force_alone: bool,
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
    Unused {
        rows: &[&con::TANGENT_STRENGTH.row],
        when: |constraint| constraint.grips_nothing,
        because: "no link joins a point with a surface",
        help: "name faces, or write `type: pointToSurface`",
    },
    Unused {
        rows: &[&con::MAX_DISTANCE.row],
        when: |constraint| constraint.has_no_reach,
        because: "`connectionMethod` joins pairs at any distance",
        help: "write `connectionMethod: withinMaxDistance`, or let `connectionDensityRange` fall with the distance",
    },
    Unused {
        rows: &[&con::CONNECTION_METHOD.row, &con::MAX_DISTANCE.row],
        when: |constraint| constraint.tears,
        because: "a tearable surface joins the points that it splits, whatever their distance",
        help: "leave it out; `components` names where it tears",
    },
    Unused {
        rows: &[&con::DROPOFF.row, &con::DROPOFF_DISTANCE.row],
        when: |constraint| constraint.has_no_dropoff,
        because: "`strengthDropoff` is the same at all distances",
        help: "let it fall: `strengthDropoff: [(0, 1), (1, 0)]`",
    },
    Unused {
        rows: &[&con::GLUE_STRENGTH_SCALE.row],
        when: |constraint| constraint.never_breaks,
        because: "`glueStrength` is 1, which never breaks",
        help: "give a `glueStrength` below 1",
    },
    Unused {
        rows: &[&con::STRENGTH.row],
        when: |constraint| constraint.is_rigid,
        because: "a weld is rigid",
        help: "leave it out, or write `constraintMethod: spring`",
    },
    Unused {
        rows: &[&con::TANGENT_STRENGTH.row],
        when: |constraint| constraint.grips_rigidly,
        because: "a weld is rigid",
        help: "leave it out, or write `constraintMethod: spring`",
    },
    Unused {
        rows: &[&transform::ROTATE.row, &transform::ROTATE_ORDER.row, &transform::SCALE.row],
        when: |constraint| constraint.is_force_alone,
        because: "its force is towards a point, the same from all sides",
        help: "`dropoffDistance` sets how far it reaches",
    },
];

impl Compiler<'_> {
    /// Warns of attributes of a constraint that have no effect. Pins need no members.
    pub(super) fn warn_of_unused_attributes(&mut self, constraint: NodeId, members: &[Member]) {
        let properties = self.properties(constraint, members);
        let node = self.scene.graph.node(constraint);
        let kind = Values::new(&self.start, constraint).kind;
        // The only attribute of springs of a transform constraint is why it has springs.
        let springs = self.only_soft(constraint).filter(|_| kind == kinds::TRANSFORM);
        for Unused { rows, because, help, .. } in UNUSED.iter().filter(|unused| (unused.when)(&properties)) {
            let is_set = |row: &&&Attribute| {
                let setting = node.settings().get(row.name);
                setting.is_some_and(|setting| !is_default(setting, row, kind)) && springs != Some(row.name)
            };
            for row in rows.iter().filter(is_set) {
                let place = self.scene.source.place(&format!("{}.{}", node.name(), row.name));
                let message = format!("`{}` of `{}` has no effect: {because}", row.name, node.name());
                self.findings.warning(&place, message).help(*help);
            }
        }
    }

    /// Warns of keys that say how elements are paired, where pairs are made once.
    pub(super) fn warn_of_keyed_pairing(&mut self, constraint: NodeId) {
        let graph = &self.scene.graph;
        let node = graph.node(constraint);
        let values = Values::new(&self.start, constraint);
        let to_space = values.choice(&con::CONSTRAINT_RELATION) == kinds::TO_SPACE;
        if to_space || values.updates_per_frame() || graph.changes(constraint, &con::CONNECTION_UPDATE) {
            return;
        }
        let has_reach = values.kind == kinds::WELD_BORDERS
            || values.choice(&con::CONNECTION_METHOD) == kinds::WITHIN_MAX_DISTANCE;
        let keyed = [
            (con::CONNECTION_METHOD.row.name, graph.changes(constraint, &con::CONNECTION_METHOD)),
            (con::COMPONENT_RELATION.row.name, graph.changes(constraint, &con::COMPONENT_RELATION)),
            (
                con::CONNECT_WITHIN_COMPONENT.row.name,
                graph.changes(constraint, &con::CONNECT_WITHIN_COMPONENT),
            ),
            (con::CONNECTION_DENSITY.row.name, graph.changes(constraint, &con::CONNECTION_DENSITY)),
            (con::MAX_DISTANCE.row.name, has_reach && graph.changes(constraint, &con::MAX_DISTANCE)),
        ];
        for (row, _) in keyed.into_iter().filter(|(_, changes)| *changes) {
            let place = self.scene.source.place(&format!("{}.{row}", node.name()));
            let message =
                format!("`{row}` of `{}` changes, and is read once: when its links form", node.name());
            let help = "write `connectionUpdate: perFrame`, or give it one value";
            self.findings.warning(&place, message).help(help);
        }
    }

    /// Warns of whole objects in a constraint that disables collisions: for a pair another kind is meant. Keys of `enable`
    /// switch collisions on purpose.
    pub(super) fn warn_of_disabled_objects(&mut self, constraint: NodeId, members: &[Member]) {
        let graph = &self.scene.graph;
        let disables = Values::new(&self.start, constraint).kind == kinds::DISABLE_COLLISION;
        if !disables || graph.changes(constraint, &con::ENABLE) {
            return;
        }
        let name = graph.node(constraint).name();
        for member in members {
            if !self.is_whole(member) {
                continue;
            }
            let place = self.scene.source.place(&format!("{name}.{}", con::COMPONENTS.row.name));
            let message = format!("`{name}` lets all of `{}` collide with nothing", member.name);
            let help = "to let two objects pass through each other only, write `type: collisionExclusion`; \
                for one that never collides, `collide: false`";
            self.findings.warning(&place, message).help(help);
        }
    }

    /// Whether a member is all points of its object.
    fn is_whole(&self, member: &Member) -> bool {
        let model = &self.program.model;
        let points = match member.object {
            MemberObject::Cloth(cloth) => model.cloths()[cloth.index()].surface.positions.len(),
            MemberObject::Collider(collider) => model.colliders()[collider.index()].surface.positions.len(),
        };
        member.capacity.is_some() || member.points().len() == points
    }

    /// The attribute that alone turns the pins of a constraint into springs.
    fn only_soft(&self, constraint: NodeId) -> Option<&'static str> {
        let graph = &self.scene.graph;
        let mut given = kinds::SOFT.iter().filter(|soft| graph.is_given_by_name(constraint, soft));
        given.next().filter(|_| given.next().is_none()).copied()
    }

    /// Whether another node is placed under a constraint.
    fn is_parent(&self, constraint: NodeId) -> bool {
        self.scene.graph.iter().any(|(_, node)| node.parent() == Some(constraint))
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
        let is_classic = self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL) == CLASSIC;
        let has_no_surface = to_space || members.iter().all(|member| member.kind != ElementKind::Face);
        let density_range = self.start.get(constraint, &con::CONNECTION_DENSITY_RANGE);
        let is_paired = !matches!(values.kind, kinds::WELD_BORDERS | kinds::TEARABLE);
        let is_rigid =
            always(&con::CONSTRAINT_METHOD, kinds::WELD) && !is_classic && !kinds::excludes(values.kind);
        let pulls_to_origin = to_space && values.ever(&con::FORCE, |force| force != 0.0);
        Properties {
            to_space,
            from_start: in_pairs && never(&con::REST_LENGTH_METHOD, constant),
            is_constant,
            is_on_surface: is_constant && !values.ever(&con::REST_LENGTH, |length| length != 0.0),
            stays: !values.slides() && !graph.changes(constraint, &con::CONNECTION_UPDATE),
            is_loose: values.slides() && !grips && never(&con::CONSTRAINT_METHOD, kinds::WELD),
            has_no_surface,
            grips_nothing: in_pairs && has_no_surface && grips,
            grips_rigidly: is_rigid && !has_no_surface && grips,
            has_no_reach: in_pairs
                && is_paired
                && never(&con::CONNECTION_METHOD, kinds::WITHIN_MAX_DISTANCE)
                && Ramp::new(&density_range).is_constant(),
            tears: values.kind == kinds::TEARABLE,
            has_no_dropoff: Ramp::new(&values.strength_dropoff()).is_constant(),
            never_breaks: !can_break(&values, members),
            is_rigid,
            is_force_alone: pulls_to_origin && !has_links(&values) && !self.is_parent(constraint),
            folds_freely: !graph.is_ever_nonzero(constraint, &con::BEND) && values.kind != kinds::TEARABLE,
            passes: !values.toggle(&con::LOCAL_COLLIDE) && !graph.changes(constraint, &con::LOCAL_COLLIDE),
        }
    }
}

/// A setting of the default value, or of the value that its kind has, says nothing.
fn is_default(setting: &Setting, row: &Attribute, kind: i32) -> bool {
    let of_kind = kinds::written_value(kind, row);
    match (setting, &row.default) {
        (Setting::Fixed(value), default) => {
            Some(value) == default.as_ref() || Some(value) == of_kind.as_ref()
        }
        (Setting::Parts(_), Some(Value::Vector(parts))) => *setting == Setting::from(Value::Vector(*parts)),
        _ => false,
    }
}
