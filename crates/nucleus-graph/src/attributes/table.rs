//! How a table is written: groups of rows, each a doc comment, a key and what it holds.

/// Makes a node type and a typed key for each of its rows.
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
        pub static $type: crate::attributes::NodeType = crate::attributes::NodeType {
            name: $name,
            parent: $parent,
            rows: &[$($(&$key.row,)*)*],
            hides: &[$($hides),*],
            doc: concat!($($type_doc),+),
            index: std::sync::OnceLock::new(),
        };
        $($(
            $(#[doc = $doc])+
            pub static $key: crate::attributes::Key<$value> = ($row).described($group, concat!($($doc),+));
        )*)*
    };
}

pub(super) use node_table;
