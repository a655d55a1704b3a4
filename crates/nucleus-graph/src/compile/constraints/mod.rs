//! Dynamic constraints: from nodes to the links, pins and exclusions of each frame.
//!
//! | You want to know...                                    | Read         |
//! |--------------------------------------------------------|--------------|
//! | what each of Maya's ten kinds stands for               | `kinds.rs`   |
//! | which objects and elements are members               | `members.rs`, `member.rs` |
//! | which elements are joined, and where                   | `forming.rs` |
//! | welds of tearable surfaces and of borders              | `borders.rs` |
//! | joined edges that resist folding                      | `folding.rs` |
//! | the closest places of elements                         | `near.rs`    |
//! | the nearest of many elements                           | `bvh.rs`     |
//! | the sheet on which sliding links walk                  | `sheet.rs`   |
//! | meshes that are split where they can tear              | `tearing.rs`, `split_mesh.rs` |
//! | attributes without effect beside the others          | `unused.rs`    |
//! | the attributes of a frame; keyed `enable`              | `frame.rs`   |
//!
//! A transform constraint without any attribute of springs pins its points; see `attachments.rs`. Every other kind is
//! links of the solver, exclusions of its contact, or both.

mod borders;
mod bvh;
mod folding;
mod forming;
mod frame;
pub(super) mod kinds;
pub(super) mod member;
mod members;
pub(super) mod near;
mod sheet;
pub(super) mod split_mesh;
mod tearing;
mod unused;
