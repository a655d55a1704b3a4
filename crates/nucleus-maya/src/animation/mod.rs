//! Values over time: keyed curves, expressions, and the nodes between them and an attribute.
//!
//! | You want to know...                                    | Read                |
//! |--------------------------------------------------------|---------------------|
//! | the value of a curve with Maya's tangents              | [`MayaCurve`]       |
//! | the value of an attribute at a frame                   | [`Evaluator`]       |
//! | an expression node                                     | [`Script`]          |
//! | how a driven attribute becomes Nucleus keys            | `channel.rs`        |
//! | where a transform is                                   | `placement.rs`      |
//! | the names of its attributes                            | [`names`]           |
//! | where a constraint puts a transform                    | `constraint.rs`     |
//!
//! **Invariant:** a curve that a Nucleus curve represents exactly keeps its keys. Any other is sampled at every frame, between
//! which the solver interpolates linearly anyway (N2.4-7).

mod channel;
mod constraint;
mod curve;
mod evaluator;
pub mod names;
mod placement;
mod script;
mod syntax;

pub(crate) use channel::keys_at_every_frame;
pub use curve::MayaCurve;
pub use evaluator::Evaluator;
pub use placement::Matrix;
pub use script::Script;
