//! Nodes, what is set on them, and what is connected to what.
//!
//! | You want to know...                                | Read                       |
//! |----------------------------------------------------|----------------------------|
//! | what can be done with a graph                      | [`Graph`]                  |
//! | what a node holds, and how a value is read         | [`Node`], [`Setting`]      |
//! | which connections Maya's creation commands make    | `creation.rs`              |
//! | what may be connected to what                      | [`Graph::connect`]         |
//! | what depends on what                               | `flow.rs`                  |
//! | how it is drawn                                    | [`Graph::dot`]             |
//! | how a plug is written                              | [`Graph::plug`]            |
//! | what a node holds at a frame                       | [`Moment`]                 |
//! | where a node stands in the world                   | `placement.rs`             |
//!
//! **Invariant:** what is set fits its row, names are unique, parents and connections form no circle, an input
//! has at most one connection, and what flows into it is what it takes. Whatever would break that is refused.

mod creation;
mod diagram;
mod error;
mod flow;
mod moment;
mod node;
mod nodes;
mod placement;
mod plug;
mod plug_text;
mod setting;
mod wiring;

pub use creation::Creation;
pub use error::GraphError;
pub use moment::Moment;
pub use node::{Node, NodeId};
pub use nodes::{CLOCK, Graph, is_a_name};
pub use plug::{Connection, Plug};
pub use plug_text::PlugError;
pub use setting::{Channel, Setting};

#[cfg(test)]
mod tests;
