//! Which lists a cloth needs: those whose attribute is ever other than zero.

use nucleus_core::ClothLists;

use crate::attributes::{Key, n_base, n_cloth, nucleus};
use crate::graph::Node;

use super::objects::CLASSIC;

/// The lists of a cloth in a nucleus.
pub(super) fn lists(cloth: &Node, nucleus: &Node) -> ClothLists {
    use n_cloth::{
        ADD_CROSS_LINKS, BEND_RESISTANCE, BEND_STIFFNESS, COMPRESSION_RESISTANCE, COMPRESSION_STIFFNESS,
        DRAG, LIFT, SHEAR_RESISTANCE, SHEAR_STIFFNESS, STRETCH_DAMP, STRETCH_RESISTANCE, STRETCH_STIFFNESS,
    };
    let used = |key| cloth.is_ever_nonzero(key);
    let classic = nucleus.get(&nucleus::RESISTANCE_MODEL) == CLASSIC;
    let resists = |resistance: &Key<f64>, stiffness: &Key<f64>| match cloth.setting(stiffness) {
        Some(_) if !classic && cloth.changes(stiffness) => true,
        Some(_) if !classic && cloth.get(stiffness) >= 0.0 => cloth.get(stiffness) > 0.0,
        _ => cloth.is_ever_nonzero(resistance),
    };
    let stretch = resists(&STRETCH_RESISTANCE, &STRETCH_STIFFNESS)
        || resists(&COMPRESSION_RESISTANCE, &COMPRESSION_STIFFNESS);
    ClothLists {
        stretch,
        cross_links: stretch && cloth.get(&ADD_CROSS_LINKS),
        shear: resists(&SHEAR_RESISTANCE, &SHEAR_STIFFNESS),
        bend: resists(&BEND_RESISTANCE, &BEND_STIFFNESS),
        air: (used(&DRAG) || used(&LIFT)) && nucleus.is_ever_nonzero(&nucleus::AIR_DENSITY),
        damp: used(&STRETCH_DAMP) || used(&n_base::DAMP),
        self_collision: cloth.is_ever_nonzero(&n_base::SELF_COLLIDE),
    }
}
