//! Who meets whom: thickness, friction, layers and elements of each pair of cloths in a frame.

use crate::frame::{ClothFrame, Elements};
use crate::scalar::Real;

/// Thickness in metres below which none is kept: contact needs some room to prove that nothing passed.
pub const LEAST_THICKNESS: f64 = 1e-5;

/// How two cloths meet, or a cloth itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms<R> {
    /// The distance kept between the two, in metres.
    pub thickness: f64,
    /// Sum of the two frictions.
    pub friction: R,
    /// Factor on the mobility of each side: the lower layer is the heavier.
    pub mobility: [R; 2],
    /// Which elements of each side meet the points of the other.
    pub elements: [Elements; 2],
    /// Whether edges meet edges.
    pub edges: bool,
}

impl<R: Real> Terms<R> {
    /// How a cloth meets itself; nothing where it does not.
    pub fn with_itself(cloth: &ClothFrame) -> Option<Self> {
        let own = &cloth.self_collision;
        own.on.then(|| Self {
            thickness: (2.0 * own.thickness).max(LEAST_THICKNESS),
            friction: R::from_f64(2.0 * cloth.friction),
            mobility: [R::ONE; 2],
            elements: [own.elements; 2],
            edges: own.edges,
        })
    }

    /// How two cloths meet; nothing where they do not. `range` is the difference of layers from which on
    /// they pass through each other.
    pub fn between(a: &ClothFrame, b: &ClothFrame, range: f64) -> Option<Self> {
        let above = a.layer - b.layer;
        if !a.collide || !b.collide || above.abs() >= range {
            return None;
        }
        // At a difference of one the lower layer is not moved at all.
        let heavier = (1.0 - above.abs()).max(0.0);
        let mobility = if above < 0.0 { [heavier, 1.0] } else { [1.0, heavier] };
        let flat = |side: &ClothFrame| side.elements != Elements::Points;
        Some(Self {
            thickness: (a.thickness + b.thickness).max(LEAST_THICKNESS),
            friction: R::from_f64(a.friction + b.friction),
            mobility: mobility.map(R::from_f64),
            elements: [a.elements, b.elements],
            edges: flat(a) && flat(b),
        })
    }
}
