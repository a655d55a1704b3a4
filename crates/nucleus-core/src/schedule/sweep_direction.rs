//! Which cloths alternate the direction of their sweeps in a frame.
//!
//! Alternating sweeps have two balances, one per direction: pinned or resting cloth would tremble between them. Only cloth
//! that moves freely is stirred by sweeps in one direction.

use crate::constraints::link::lists::Links;
use crate::contact::system::ContactSystem;
use crate::input::frame::FrameInput;
use crate::math::Real;

/// Whether each cloth moves freely: no pin, no link to a fixed place, and no contact in the last frame, neither of its own
/// nor of any cloth that links join it with.
pub fn alternating_cloths<R: Real>(
    contact: &ContactSystem<R>,
    links: &Links<R>,
    frame: &FrameInput,
) -> Vec<bool> {
    let mut is_held = contact.touches.clone();
    frame.pins.iter().for_each(|pin| is_held[pin.cloth.index()] = true);
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
