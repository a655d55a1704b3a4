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
    /// A name holds a character that names do not have, or none at all.
    #[error("`{name}` is not a name")]
    NoName {
        /// The text.
        name: String,
    },
    /// The clock keeps its name.
    #[error("`time1` is the clock of every scene and keeps its name")]
    Clock,
    /// An input takes one connection.
    #[error("`{input}` is connected already, from `{source_plug}`")]
    InputTaken {
        /// The input.
        input: String,
        /// Where its connection comes from.
        source_plug: String,
    },
    /// Nothing can be connected from there.
    #[error("`{plug}` is an input: nothing comes out of it")]
    OnlyInput {
        /// The plug.
        plug: String,
    },
    /// Nothing can be connected to there.
    #[error("`{plug}` is an output: nothing can be connected to it")]
    OnlyOutput {
        /// The plug.
        plug: String,
    },
    /// What comes out of one plug is not what the other takes.
    #[error("`{from}` gives {carries}, but `{to}` takes {takes}")]
    OtherData {
        /// The output.
        from: String,
        /// What flows out of it.
        carries: &'static str,
        /// The input.
        to: String,
        /// What it takes.
        takes: &'static str,
    },
    /// It can be set, but not connected.
    #[error("`{plug}` cannot be connected")]
    NotPluggable {
        /// The plug.
        plug: String,
    },
    /// A plug that holds many is connected element by element.
    #[error("`{plug}` holds many: it needs an index, like `{plug}[0]`")]
    NeedsIndex {
        /// The plug.
        plug: String,
    },
    /// A plug that holds one thing has no elements.
    #[error("`{plug}` does not hold many: it takes no index")]
    HoldsOne {
        /// The plug.
        plug: String,
    },
    /// An output would depend on itself.
    #[error("`{from}` depends on `{to}`: connecting them would make a circle")]
    Circle {
        /// The output.
        from: String,
        /// The input.
        to: String,
    },
    /// A mesh would be blended into itself by way of others.
    #[error("`{mesh}` cannot be blended into `{target}`, which is blended into it")]
    BlendCircle {
        /// The mesh.
        mesh: String,
        /// What it was to be blended into.
        target: String,
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
