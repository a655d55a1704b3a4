//! The motion and the attributes of one collider in one frame.

use nalgebra::Vector3;

use crate::input::frame::cloth::ClothFrame;
use crate::input::frame::contact::{Elements, ForceField, PushOut};
use crate::input::object_fields::{PointField, WindField};

/// One collider in one frame: its motion and contact attributes.
#[derive(Debug, Clone, PartialEq)]
pub struct ColliderFrame {
    /// Positions at the start of the frame in metres, in the mesh's order. Empty: those at the end of the frame before.
    pub start: Vec<Vector3<f64>>,
    /// Positions at the end of the frame in metres, in the mesh's order. Empty: it does not move.
    pub end: Vec<Vector3<f64>>,
    /// Whether cloth collides with it in this frame.
    pub collide: bool,
    /// The elements of it that collide with cloth: with less than faces, points of cloth pass through it. Points of no face,
    /// such as particles, collide with its faces at any value.
    pub elements: Elements,
    /// `collisionLayer`: it collides with objects in the same layer and in higher ones, less than `layer_range` away.
    pub layer: f64,
    /// Thickness in metres.
    pub thickness: f64,
    /// Friction; the two sides' values are added.
    pub friction: f64,
    /// Stickiness, 0 to 2; the two sides' values are added, and at 1 they never separate.
    pub stickiness: f64,
    /// Bounce, 0 to 1; the larger of the two sides' values counts.
    pub bounce: f64,
    /// Strength of contacts, as of a cloth.
    pub collide_strength: f64,
    /// Moves points of other objects to a side of its surface.
    pub push_out: PushOut,
    /// Whether points inside it, if it is closed, are depenetrated; otherwise they stay inside (`trappedCheck`).
    pub trapped_check: bool,
    /// Its force field on cloth.
    pub field: Option<ForceField>,
    /// The force fields of its points.
    pub point_field: Option<PointField>,
    /// Its wind shadow, and the air that it pushes.
    pub wind_field: WindField,
}

impl Default for ColliderFrame {
    /// The contact attributes of [`ClothFrame::DEFAULT`], without friction or motion.
    fn default() -> Self {
        let ClothFrame { collide, thickness, stickiness, bounce, collide_strength, .. } = ClothFrame::DEFAULT;
        let ClothFrame { elements, layer, push_out, field, point_field, wind_field, .. } =
            ClothFrame::DEFAULT;
        Self {
            start: Vec::new(),
            end: Vec::new(),
            collide,
            elements,
            layer,
            thickness,
            friction: 0.0,
            stickiness,
            bounce,
            collide_strength,
            push_out,
            trapped_check: true,
            field,
            point_field,
            wind_field,
        }
    }
}
