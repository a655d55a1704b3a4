//! Which cloths alternate the direction of their sweeps in a frame.
//!
//! Alternating sweeps have two balances, one per direction: cloth that bears a load because it is pinned, rests or is under
//! pressure would tremble between them, a still balloon at up to 1 m/s. Only cloth that moves freely is stirred by sweeps in
//! one direction, and closed cloth under pressure keeps its angular momentum by itself.

use crate::constraints::link::lists::Links;
use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, Pressure};
use crate::math::Real;
use crate::model::ClothModel;

/// Whether each cloth moves freely: no closed pressure, no pin, no link to a fixed place, and no contact in the last frame,
/// neither of its own nor of any cloth that links join it with.
pub fn alternating_cloths<R: Real>(
    cloths: &[ClothModel<R>],
    contact: &ContactSystem<R>,
    links: &Links<R>,
    frame: &FrameInput,
) -> Vec<bool> {
    let mut is_held = contact.touches.clone();
    frame.pins.iter().for_each(|pin| is_held[pin.cloth.index()] = true);
    for (is_held, (cloth, settings)) in is_held.iter_mut().zip(cloths.iter().zip(&frame.cloths)) {
        let pressure = &settings.pressure;
        *is_held |= *pressure != Pressure::Off && cloth.pressure.is_closed(pressure);
    }
    while hold_linked(links, &mut is_held) {}
    is_held.iter().map(|is_held| !is_held).collect()
}

/// Marks the cloths that a link joins with a fixed place or with a marked cloth. Returns whether there were new ones.
fn hold_linked<R: Real>(links: &Links<R>, is_held: &mut [bool]) -> bool {
    let mut has_grown = false;
    for link in links.constraints.iter().flat_map(|constraint| &constraint.links) {
        let holds = link.sides.iter().any(|side| side.cloth().is_none_or(|cloth| is_held[cloth]));
        for cloth in link.cloths().filter(|_| holds) {
            has_grown |= !std::mem::replace(&mut is_held[cloth], true);
        }
    }
    has_grown
}
