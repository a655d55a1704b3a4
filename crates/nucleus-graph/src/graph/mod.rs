//! Nodes, what is set on them, and what is connected to what.
//!
//! | You want to know...                                | Read                       |
//! |----------------------------------------------------|----------------------------|
//! | what can be done with a graph                      | [`Graph`]                  |
//! | what a node holds, and how a value is read         | [`Node`], [`Setting`]      |
//! | which connections Maya's creation commands make    | `creation.rs`              |
//! | where a node stands in the world                   | `placement.rs`             |
//!
//! **Invariant:** what is set fits its row, names are unique, parents form no circle, and an input has at
//! most one connection. Whatever would break that is refused.

mod creation;
mod error;
mod node;
mod nodes;
mod placement;
mod plug;
mod setting;

pub use error::GraphError;
pub use node::{Node, NodeId};
pub use nodes::Graph;
pub use plug::{Connection, Plug};
pub use setting::{Channel, Setting};

#[cfg(test)]
mod tests;
