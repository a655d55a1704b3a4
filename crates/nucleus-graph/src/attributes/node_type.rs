//! Node types: their rows, inheritance, and the macro that writes a table. Of rows with the same name, that of the
//! derived type applies.

use std::collections::HashMap;
use std::fmt;
use std::sync::OnceLock;

use super::row::Attribute;

/// A type of node.
pub struct NodeType {
    /// Maya's name of the type, which scenes use.
    pub name: &'static str,
    /// The type it inherits from.
    pub parent: Option<&'static NodeType>,
    /// Its rows without inherited ones, in the order of the table.
    pub rows: &'static [&'static Attribute],
    /// Inherited attributes that it hides, in groups. They can still be read and written.
    pub hides: &'static [&'static [&'static str]],
    pub(super) doc: &'static str,
    pub(super) index: OnceLock<HashMap<&'static str, &'static Attribute>>,
}

/// Prints the name.
impl fmt::Debug for NodeType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Compares by identity: there is one static per type.
impl PartialEq for NodeType {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl NodeType {
    /// Description in one line.
    pub fn doc(&self) -> &'static str {
        self.doc.trim_start()
    }

    /// This type and its ancestors, nearest first.
    pub fn lineage(&'static self) -> impl Iterator<Item = &'static NodeType> {
        std::iter::successors(Some(self), |node_type| node_type.parent)
    }

    /// Whether this type is `other` or inherits from it.
    pub fn is_a(&'static self, other: &NodeType) -> bool {
        self.lineage().any(|ancestor| ancestor == other)
    }

    /// The attribute of a long or short name. Long names take precedence over short ones, then derived types over their
    /// ancestors.
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

    /// The vector attribute with a component of this long or short name, and the index of the component.
    pub fn part(&'static self, name: &str) -> Option<(&'static Attribute, usize)> {
        self.attributes().into_iter().find_map(|row| {
            let part = row.parts()?.iter().position(|(long, short)| long == name || *short == name)?;
            Some((row, part))
        })
    }

    /// All attributes, those of derived types first. Redefined rows appear once.
    pub fn attributes(&'static self) -> Vec<&'static Attribute> {
        let mut all: Vec<&'static Attribute> = Vec::new();
        for row in self.lineage().flat_map(|ancestor| ancestor.rows) {
            if all.iter().all(|nearer| nearer.name != row.name) {
                all.push(row);
            }
        }
        all
    }

    /// Whether this type hides an attribute.
    pub fn keeps_from_view(&'static self, row: &Attribute) -> bool {
        row.hidden || self.has_no_use_for(row)
    }

    /// Whether this type or an ancestor lists an inherited attribute in `hides`.
    pub fn has_no_use_for(&'static self, row: &Attribute) -> bool {
        self.lineage().any(|ancestor| ancestor.hides.iter().any(|names| names.contains(&row.name)))
    }
}

/// Defines a node type, and a typed key for each of its rows. A row is a doc comment, a key and its value type.
///
/// ```text
/// node_table! {
///     /// A mesh that behaves as cloth.
///     N_CLOTH = "nCloth", inherits Some(&N_BASE), hides [NO_USE_TO_MESHES, &["mass"]];
///     "Dynamic Properties" {
///         /// How strongly faces keep the angle between them.
///         BEND_RESISTANCE: f64 = float("bendResistance", "bnd", 0.1).soft(0.0, 200.0).solved("nucleus_core::constraints::bend");
///     }
/// }
/// ```
macro_rules! node_table {
    (
        $(#[doc = $type_doc:literal])+
        $type:ident = $name:literal, inherits $parent:expr, hides [$($hides:expr),* $(,)?];
        $($group:literal {
            $($(#[doc = $doc:literal])+ $key:ident: $value:ty = $row:expr;)*
        })*
    ) => {
        $(#[doc = $type_doc])+
        pub static $type: crate::attributes::node_type::NodeType = crate::attributes::node_type::NodeType {
            name: $name,
            parent: $parent,
            rows: &[$($(&$key.row,)*)*],
            hides: &[$($hides),*],
            doc: concat!($($type_doc),+),
            index: std::sync::OnceLock::new(),
        };
        $($(
            $(#[doc = $doc])+
            pub static $key: crate::attributes::key::Key<$value> = ($row).described($group, concat!($($doc),+));
        )*)*
    };
}

pub(super) use node_table;
