//! A scene as Maya stores it: nodes, the DAG, attributes as text, and connections.
//!
//! | You want to know...                                 | Read              |
//! |-----------------------------------------------------|-------------------|
//! | which nodes and connections there are               | [`MayaScene`]     |
//! | which statements are read, and how                  | `read.rs`         |
//! | which files a scene refers to, and edits of those   | `reference.rs`    |
//! | the value of an attribute                           | `attributes.rs`   |
//! | units of length, angle and time                     | [`Units`]         |
//!
//! **Invariant:** a name leads to a node through the DAG as in Maya: by its last part, and the parents that a partial path
//! gives.

mod attributes;
mod graph;
mod read;
mod reference;
mod units;

pub use attributes::{ANY, Names, Set, Vector3};
pub(crate) use reference::locate;

pub use graph::{Assigned, MayaNode, MayaScene, NodeId, PlugRef, Wire};
pub(crate) use units::is_shape;
pub use units::{Quantity, Units};
