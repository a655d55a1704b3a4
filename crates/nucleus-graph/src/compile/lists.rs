//! Which lists a cloth needs: those whose attribute is ever other than zero.

use nucleus_core::ClothLists;

use crate::attributes::{n_base, n_cloth, nucleus};
use crate::graph::Node;

/// The lists of a cloth in a nucleus.
pub(super) fn lists(cloth: &Node, nucleus: &Node) -> ClothLists {
    use n_cloth::{
        BEND_RESISTANCE, COMPRESSION_RESISTANCE, DRAG, LIFT, SHEAR_RESISTANCE, STRETCH_DAMP,
        STRETCH_RESISTANCE,
    };
    let used = |key| cloth.is_ever_nonzero(key);
    ClothLists {
        stretch: used(&STRETCH_RESISTANCE) || used(&COMPRESSION_RESISTANCE),
        shear: used(&SHEAR_RESISTANCE),
        bend: used(&BEND_RESISTANCE),
        air: (used(&DRAG) || used(&LIFT)) && nucleus.is_ever_nonzero(&nucleus::AIR_DENSITY),
        damp: used(&STRETCH_DAMP) || used(&n_base::DAMP),
        self_collision: cloth.is_ever_nonzero(&n_base::SELF_COLLIDE),
    }
}
