//! Points that pins carry through the ground plane: nothing can stop them, so they are counted as unresolved.

use nalgebra::Vector3;

use super::Plane;
use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, Pin};
use crate::math::Real;
use crate::model::ClothModel;

/// Depth below the plane up to which a pin counts as resting on it: the share of its thickness, and metres for rounding.
const RESTING_DEPTH: [f64; 2] = [0.02, 1e-9];

/// The number of points that pins carry from above the plane to below it in a frame. A contact that is carried out in part
/// lets them.
pub fn count_carried_points<R: Real>(
    contact: &ContactSystem<R>,
    cloths: &[ClothModel<R>],
    frame: &FrameInput,
) -> u64 {
    let (Some(from), Some(to)) = (contact.ground.start, contact.ground.end) else { return 0 };
    let is_carried = |pin: &&Pin| {
        let (cloth, point) = (&cloths[pin.cloth.index()], pin.point.index());
        let material = contact.ground_materials[pin.cloth.index()].filter(|material| {
            point < cloth.points().len()
                && !material.is_partial(&contact.material_maps)
                && !contact.pair_filter.excludes_ground(cloth.place(point))
        });
        material.is_some_and(|material| {
            let depth = RESTING_DEPTH[0] * material.thickness + RESTING_DEPTH[1];
            let is_above = |plane: Plane, place: Vector3<f64>| plane.height(place.into()) >= -depth;
            is_above(from, pin.start) && !is_above(to, pin.end)
        })
    };
    frame.pins.iter().filter(is_carried).count() as u64
}
