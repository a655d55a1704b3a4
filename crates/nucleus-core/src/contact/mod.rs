//! Collisions: thickened elements that meet in space and time (§2.3).
//!
//! | Stage | Read |
//! |---|---|
//! | where each point is foreseen to be | [`foresee`] |
//! | a collider's motion, and boxes over it through a span of time | [`collider`], [`tree`], [`aabb`] |
//! | elements of one object, in groups | [`skin`] |
//! | broad phase: which elements can touch in this span | [`search`], [`pairs`] |
//! | narrow phase: how close two elements are, and whether they stay apart on their ways | [`narrow`], [`apart`] |
//! | contact: kept apart, with friction, and proven not to pass | [`contact`] |
//! | friction, and how a push is split | [`friction`] |
//! | what contacts move | [`mover`] |
//! | cloth against itself and other cloth | [`mutual`] |
//! | points inside a collider, and how they are led out | [`trapped`] |
//! | the ground plane | [`ground`] |
//! | stickiness | [`stick`] |
//! | bounce, once velocities are known | [`bounce`] |
//! | on which terms two objects meet, and maps of them | [`terms`], [`maps`] |
//! | one collision pass | [`resolve`] |

pub mod aabb;
pub mod apart;
pub mod bounce;
pub mod broad_phase;
pub mod cloth;
pub mod cloth_pass;
pub mod collider;
pub mod collider_contact;
pub mod collider_pass;
pub mod contact_state;
pub mod foresee;
pub mod friction;
pub mod ground;
pub mod maps;
pub mod mover;
pub mod narrow;
pub mod pairs;
pub mod pseudonormals;
pub mod push_out;
pub mod resolve;
pub mod restitution;
pub mod safeguard;
pub mod search;
pub mod skin;
pub mod stick;
pub mod terms;
pub mod trapped;
pub mod tree;
