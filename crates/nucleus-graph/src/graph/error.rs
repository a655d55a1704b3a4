//! Reasons to refuse a change to a graph.

/// A change that would break an invariant of the graph.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GraphError {
    /// Names are unique.
    #[error("there is already a node `{name}`")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// The value has another kind than the attribute, is out of range, or is keyed on an attribute without keys.
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
    /// The name is empty, or has a character other than letters, digits, `_`, `-` and `:`.
    #[error("`{name}` is not a name")]
    NoName {
        /// The text.
        name: String,
    },
    /// The clock cannot be renamed, and has no parent.
    #[error("`time1` is the clock of every scene: it keeps its name and has no parent")]
    Clock,
    /// An input takes one connection.
    #[error("`{input}` is connected already, from `{source_plug}`")]
    InputTaken {
        /// The input.
        input: String,
        /// The output that it is connected from.
        source_plug: String,
    },
    /// Only outputs can be the source of a connection.
    #[error("`{plug}` is an input: nothing can be connected from it")]
    OnlyInput {
        /// The plug.
        plug: String,
    },
    /// Only inputs can be the target of a connection.
    #[error("`{plug}` is an output: nothing can be connected to it")]
    OnlyOutput {
        /// The plug.
        plug: String,
    },
    /// The two plugs carry different data.
    #[error("`{from}` gives {carries}, but `{to}` takes {takes}")]
    OtherData {
        /// The output.
        from: String,
        /// The data that it carries.
        carries: &'static str,
        /// The input.
        to: String,
        /// The data that it takes.
        takes: &'static str,
    },
    /// The attribute can be set, but not connected.
    #[error("`{plug}` cannot be connected")]
    NotPluggable {
        /// The plug.
        plug: String,
    },
    /// A multi attribute is connected element by element.
    #[error("`{plug}` holds many: it needs an index, like `{plug}[0]`")]
    NeedsIndex {
        /// The plug.
        plug: String,
    },
    /// An attribute that is not multi has no elements.
    #[error("`{plug}` does not hold many: it takes no index")]
    HoldsOne {
        /// The plug.
        plug: String,
    },
    /// The output would depend on itself.
    #[error("`{from}` depends on `{to}`: connecting them would make a cycle")]
    Cycle {
        /// The output.
        from: String,
        /// The input.
        to: String,
    },
    /// The node belongs to another graph, or has been deleted.
    #[error("there is no such node: it has been deleted, or belongs to another graph")]
    NoNode,
    /// Only a node with a transform can be a parent.
    #[error("`{parent}` is a {node_type} and cannot be the parent of `{node}`: it has no transform")]
    NoTransform {
        /// The node.
        node: String,
        /// The refused parent.
        parent: String,
        /// Its type.
        node_type: &'static str,
    },
    /// Only a mesh is blended, and only into a mesh.
    #[error("`{node}` is a {node_type} and cannot be blended: it is no mesh")]
    NoMesh {
        /// The node.
        node: String,
        /// Its type.
        node_type: &'static str,
    },
    /// The chain of blend targets would lead back to the mesh.
    #[error("`{mesh}` cannot be blended into `{target}`, which is blended into it")]
    BlendCycle {
        /// The mesh.
        mesh: String,
        /// The refused blend target.
        target: String,
    },
    /// The node would be its own ancestor.
    #[error("`{parent}` cannot be the parent of `{node}`: that would make a cycle")]
    ParentCycle {
        /// The node.
        node: String,
        /// The refused parent.
        parent: String,
    },
}
