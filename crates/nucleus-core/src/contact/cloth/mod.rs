//! Contact in which both sides can move: cloth against itself, cloth against cloth, particles against both.
//!
//! | You want to know... | Read |
//! |---|---|
//! | which cloths are in contact, at which thickness and friction | [`material`](super::material) |
//! | all state of contact among cloths | [`contacts`] |
//! | the elements of all cloths in groups, under a BVH for each cloth | [`elements`] |
//! | the trajectory and radius that bound each point over a candidate interval | [`motion_bounds`] |
//! | broad phase: predicts motion bounds, and searches where points violate theirs | [`broad_phase`] |
//! | which elements can touch while all points keep their bounds | [`search`], [`query`], [`new_elements`], [`element_bounds`], [`group_bounds`] |
//! | which of them come near, and their normals | [`near_pairs`], [`swept_points`], [`local_origins`], [`normals`] |
//! | what a search task finds | [`found_contacts`] |
//! | the contacts by kind, in tasks that threads share | [`cache`], [`contact_list`], [`contact_task`] |
//! | one contact | [`contact`] |
//! | a fast lower bound on its gap | [`local_anchors`] |
//! | its push, friction anchor, adhesion and restitution | [`response`] |
//! | its certificate, and truncation at a division plane | [`certify`] |
//! | points that are frozen, or carried | [`frozen`] |
//! | islands of cloths, and the mean motion of each | [`islands`] |
//! | intersecting meshes: detection, and untangling | [`intersections`], [`untangling`] |
//! | the passes of a time step | [`pass`] |

pub mod broad_phase;
pub mod cache;
pub mod certify;
pub mod contact;
pub mod contact_list;
pub mod contact_task;
pub mod contacts;
mod element_bounds;
pub mod elements;
pub mod found_contacts;
pub mod frozen;
mod group_bounds;
pub mod intersections;
pub mod islands;
pub mod local_anchors;
mod local_origins;
pub mod motion_bounds;
mod near_pairs;
mod new_elements;
mod normals;
pub mod pass;
mod query;
pub mod response;
mod search;
mod swept_points;
pub mod untangling;
