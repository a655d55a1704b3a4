//! The dependency graph: nodes, their settings and the connections between their plugs.
//!
//! | You want to know...                                | Read                       |
//! |----------------------------------------------------|----------------------------|
//! | which operations a graph has                       | [`Graph`]                  |
//! | what a node stores, and how a value is read        | [`Node`], [`Setting`]      |
//! | which connections Maya's creation commands make    | `creation.rs`              |
//! | which plugs can be connected, and the cycle test   | [`Graph::connect`]         |
//! | the value of a plug at a frame                     | [`EvalContext::get`]       |
//! | the transform of a node from its space to world    | [`EvalContext::placement`] |
//! | how connections are found                          | `wires.rs`                 |
//! | how a plug is written                              | [`Graph::plug`]            |
//! | how a graph is drawn                               | [`Graph::dot`]             |
//!
//! **Invariant:** a setting fits its attribute. Names are unique. Parents and connections form no cycle. An
//! input has at most one connection, and both ends of a connection carry the same data. A change that breaks
//! one of these is refused, and the graph stays as it was.

mod connections;
mod creation;
mod error;
mod eval_context;
mod node;
mod nodes;
mod setting;
mod text;
mod wires;

pub use connections::{joins_a_nucleus, may_be_from_creation};
pub use creation::Creation;
pub use error::GraphError;
pub use eval_context::EvalContext;
pub use node::{Connection, Node, NodeId, Plug};
pub use nodes::{CLOCK, Graph, is_a_name};
pub use setting::{Channel, Setting};
pub use text::PlugError;

#[cfg(test)]
mod tests;
