//! Node types, and how they inherit: the nearest row wins.

use std::collections::HashMap;
use std::fmt;
use std::sync::OnceLock;

use super::row::Attribute;
use super::*;

/// A type of node.
pub struct NodeType {
    /// Maya's name of the type, which scenes use.
    pub name: &'static str,
    /// The type it inherits from.
    pub parent: Option<&'static NodeType>,
    /// Its own rows, in the order of the table.
    pub rows: &'static [&'static Attribute],
    /// Inherited attributes that it does not show. They can still be read and written.
    pub hides: &'static [&'static [&'static str]],
    pub(super) doc: &'static str,
    pub(super) index: OnceLock<HashMap<&'static str, &'static Attribute>>,
}

/// Its name is enough to tell it by.
impl fmt::Debug for NodeType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Types are compared by identity: there is one static per type.
impl PartialEq for NodeType {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

/// All types that a scene can name, in the order in which they are best read about.
pub fn node_types() -> &'static [&'static NodeType] {
    &TYPES
}

/// The type of this name that a scene can name.
pub fn node_type(name: &str) -> Option<&'static NodeType> {
    TYPES.iter().copied().find(|node_type| node_type.name == name)
}

static TYPES: [&NodeType; 24] = [
    &nucleus::NUCLEUS,
    &n_cloth::N_CLOTH,
    &n_rigid::N_RIGID,
    &n_particle::N_PARTICLE,
    &dynamic_constraint::DYNAMIC_CONSTRAINT,
    &n_component::N_COMPONENT,
    &point_emitter::POINT_EMITTER,
    &gravity_field::GRAVITY_FIELD,
    &turbulence_field::TURBULENCE_FIELD,
    &vortex_field::VORTEX_FIELD,
    &drag_field::DRAG_FIELD,
    &air_field::AIR_FIELD,
    &radial_field::RADIAL_FIELD,
    &uniform_field::UNIFORM_FIELD,
    &volume_axis_field::VOLUME_AXIS_FIELD,
    &newton_field::NEWTON_FIELD,
    &mesh::MESH,
    &poly_plane::POLY_PLANE,
    &poly_sphere::POLY_SPHERE,
    &poly_cube::POLY_CUBE,
    &poly_cylinder::POLY_CYLINDER,
    &camera::CAMERA,
    &transform::TRANSFORM,
    &time::TIME,
];

impl NodeType {
    /// What such a node is, in one line.
    pub fn doc(&self) -> &'static str {
        self.doc.trim_start()
    }

    /// This type, the type it inherits from, and so on up.
    pub fn lineage(&'static self) -> impl Iterator<Item = &'static NodeType> {
        std::iter::successors(Some(self), |node_type| node_type.parent)
    }

    /// Whether this type is `other` or inherits from it.
    pub fn is_a(&'static self, other: &NodeType) -> bool {
        self.lineage().any(|ancestor| ancestor == other)
    }

    /// The attribute of this long or short name. A long name goes before a short one, and within each the
    /// row nearest to this type wins.
    pub fn attribute(&'static self, name: &str) -> Option<&'static Attribute> {
        self.index.get_or_init(|| self.by_name()).get(name).copied()
    }

    fn by_name(&'static self) -> HashMap<&'static str, &'static Attribute> {
        let rows = || self.lineage().flat_map(|ancestor| ancestor.rows).copied();
        let mut index = HashMap::new();
        for row in rows() {
            index.entry(row.name).or_insert(row);
        }
        for row in rows() {
            index.entry(row.short).or_insert(row);
        }
        index
    }

    /// The vector attribute that has a part of this long or short name, and which part it is.
    pub fn part(&'static self, name: &str) -> Option<(&'static Attribute, usize)> {
        self.attributes().into_iter().find_map(|row| {
            let part = row.parts()?.iter().position(|(long, short)| long == name || *short == name)?;
            Some((row, part))
        })
    }

    /// All attributes, own ones first; what a nearer type redefines is left out.
    pub fn attributes(&'static self) -> Vec<&'static Attribute> {
        let mut all: Vec<&'static Attribute> = Vec::new();
        for row in self.lineage().flat_map(|ancestor| ancestor.rows) {
            if all.iter().all(|nearer| nearer.name != row.name) {
                all.push(row);
            }
        }
        all
    }

    /// Whether this type keeps an attribute from view.
    pub fn keeps_from_view(&'static self, row: &Attribute) -> bool {
        row.hidden || self.has_no_use_for(row)
    }

    /// Whether this type, or one that it inherits from, has no use for an attribute that it inherits.
    pub fn has_no_use_for(&'static self, row: &Attribute) -> bool {
        self.lineage().any(|ancestor| ancestor.hides.iter().any(|names| names.contains(&row.name)))
    }
}
