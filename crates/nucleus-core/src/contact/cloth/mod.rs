//! Contact in which both sides can move: cloth against itself, cloth against cloth, particles against both.
//!
//! | You want to know... | Read |
//! |---|---|
//! | which cloths are in contact, at which thickness and friction | [`material`](super::material) |
//! | the elements of all cloths in groups, under a BVH for each cloth | [`elements`] |
//! | the trajectory and radius that bound each point over a candidate interval | [`motion_bounds`] |
//! | broad phase: which elements can touch while all points keep their bounds | [`broad_phase`], [`query`], [`element_bounds`] |
//! | the contacts by kind, in batches that threads share | [`cache`], [`batches`] |
//! | one contact | [`contact`] |
//! | its push, friction anchor, adhesion and restitution | [`response`] |
//! | its certificate, truncation and freezing | [`certify`] |
//! | intersecting meshes: detection, and untangling | [`intersections`], [`untangling`] |
//! | the passes of a time step | [`pass`] |

pub mod batches;
pub mod broad_phase;
pub mod cache;
mod certify;
pub mod contact;
mod element_bounds;
pub mod elements;
pub mod intersections;
pub mod motion_bounds;
pub mod pass;
mod query;
pub mod response;
pub mod untangling;

use broad_phase::SearchBuffers;
use cache::ContactCache;
use elements::ElementGroups;
use motion_bounds::Trajectories;
use untangling::Untangling;

use crate::contact::material::ContactMaterial;
use crate::math::{Real, Row4};
use crate::model::ClothModel;

/// All contact among cloths; empty where a scene has none.
pub struct ClothContacts<R> {
    /// The elements of all cloths.
    pub elements: ElementGroups,
    /// Contact materials in this frame, by cloth and cloth.
    pub materials: Vec<Option<ContactMaterial<R>>>,
    /// The motion bound of each point over the candidate interval.
    pub trajectories: Trajectories<R>,
    /// Displacements at the start of the candidate interval.
    pub interval_start: Vec<Row4<R>>,
    /// The candidate interval, as shares of the frame.
    pub interval: [f64; 2],
    /// Points that violate their motion bound.
    pub bounds_violated: Vec<bool>,
    /// All contacts that can touch within the candidate interval.
    pub cache: ContactCache<R>,
    /// Buffers of the search.
    pub buffers: SearchBuffers<R>,
    /// Points that the safeguard has frozen in this step.
    pub frozen: Vec<bool>,
    /// Intersections, and their corrections.
    pub untangling: Untangling,
}

impl<R: Real> ClothContacts<R> {
    /// For cloths of which some may collide with others or with themselves.
    pub fn new(cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) -> Self {
        let rows = anchors.len();
        Self {
            elements: ElementGroups::new(cloths, anchors),
            materials: Vec::new(),
            trajectories: Trajectories::new(rows),
            interval_start: vec![Row4::ZERO; rows],
            interval: [1.0, 0.0], // expired
            bounds_violated: vec![true; rows],
            cache: ContactCache::default(),
            buffers: SearchBuffers::default(),
            frozen: Vec::new(),
            untangling: Untangling::new(rows),
        }
    }

    /// Whether any two cloths can collide in this frame.
    pub fn is_enabled(&self) -> bool {
        self.materials.iter().any(Option::is_some)
    }
}
