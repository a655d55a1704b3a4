//! Why a change to a graph is refused.

/// A change that would break a graph.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GraphError {
    /// Two nodes cannot have one name.
    #[error("there is already a node `{name}`")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// The value is of another kind than the attribute, or keyed where that cannot be, or out of range.
    #[error("`{node}.{attribute}` cannot hold this value")]
    NotAdmitted {
        /// The node.
        node: String,
        /// The attribute.
        attribute: &'static str,
    },
    /// The node's type has no such attribute.
    #[error("`{node}` is a {node_type} and has no attribute `{attribute}`")]
    NoAttribute {
        /// The node.
        node: String,
        /// Its type.
        node_type: &'static str,
        /// The attribute.
        attribute: &'static str,
    },
    /// An input takes one connection.
    #[error("`{input}` is connected already")]
    InputTaken {
        /// The input.
        input: String,
    },
    /// A node would be its own parent, or its parent's parent ...
    #[error("`{node}` cannot hang from `{parent}`, which hangs from it")]
    ParentCircle {
        /// The node.
        node: String,
        /// The parent it was to get.
        parent: String,
    },
}
