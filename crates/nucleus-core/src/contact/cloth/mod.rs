//! Contact in which both sides can be moved: cloth against itself, cloth against cloth, particles against both.
//!
//! | You want to know... | Read |
//! |---|---|
//! | who meets whom, at which thickness and friction | [`terms`](super::terms) |
//! | the elements of all cloths in one tree | [`bodies`] |
//! | where each point is foreseen to go | [`paths`], [`ahead`] |
//! | broad phase: which elements can touch while the points keep to that | [`search`], [`sought`], [`local`], [`seen`], [`ways`] |
//! | the contacts that were found, by kind and by task | [`active`], [`contacts`] |
//! | one contact | [`near`] |
//! | how it pushes its elements apart, with friction | [`push`] |
//! | the proof that they did not pass, and what is done where there is none | [`proof`] |
//! | what sticks, and what bounces | [`stick`], [`bounce`] |
//! | free points, which can go far in a step | [`swept`] |
//! | which contacts may be worked on side by side | [`tasks`] |
//! | meshes that pass through each other: found, and worked apart | [`crossings`], [`tangle`] |
//!
//! The proof is that of [`contact`](super::contact): both elements of a pair move along straight lines within
//! a step, so the gap along one fixed direction is a concave function of time; if it is positive at both
//! ends of the step, nothing passed in between.

pub mod active;
pub mod ahead;
pub mod bodies;
mod bounce;
pub mod contacts;
pub mod crossings;
pub mod friction;
mod lists;
mod local;
pub mod near;
pub mod paths;
mod pieces;
mod proof;
mod push;
pub mod search;
mod seen;
mod sought;
mod stick;
mod swept;
pub mod tangle;
pub mod tasks;
mod ways;

use active::Active;
use bodies::Bodies;
use paths::Paths;
use search::Room;
use tangle::Tangle;

use crate::contact::terms::Terms;
use crate::math::{Real, Row4};
use crate::model::ClothModel;

/// Everything that contact among cloths keeps; empty where a scene has none.
pub struct Mutual<R> {
    /// The elements.
    pub bodies: Bodies,
    /// Who meets whom in this frame, by cloth and cloth.
    pub terms: Vec<Option<Terms<R>>>,
    /// Where each point is foreseen to go in the span.
    pub paths: Paths<R>,
    /// Displacements as the span began.
    pub began_at: Vec<Row4<R>>,
    /// Start and end of a few time steps, as shares of the frame.
    pub span: [f64; 2],
    /// Points that do not keep to what was foreseen for them.
    pub strayed: Vec<bool>,
    /// All that can touch in the span.
    pub active: Active<R>,
    /// Where that is searched for.
    pub room: Room<R>,
    /// Points that go nowhere in this step, or where something carries them; set where nothing else helps.
    pub held: Vec<bool>,
    /// Elements that pass through each other.
    pub tangle: Tangle,
}

impl<R: Real> Mutual<R> {
    /// For cloths of which some may meet others or themselves.
    pub fn new(cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) -> Self {
        let rows = anchors.len();
        Self {
            bodies: Bodies::new(cloths, anchors),
            terms: Vec::new(),
            paths: Paths::new(rows),
            began_at: vec![Row4::ZERO; rows],
            span: [1.0, 0.0], // as a frame that nothing was foreseen in leaves it
            strayed: vec![true; rows],
            active: Active::default(),
            room: Room::default(),
            held: Vec::new(),
            tangle: Tangle::new(rows),
        }
    }

    /// Whether anything can meet in this frame.
    pub fn is_on(&self) -> bool {
        self.terms.iter().any(Option::is_some)
    }
}
