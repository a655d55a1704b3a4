//! Which lists a cloth needs: those whose attribute is ever other than zero.

use nucleus_core::ClothLists;

use crate::attributes::{Key, n_base, n_cloth, nucleus};
use crate::graph::{Graph, NodeId};

use super::objects::CLASSIC;

/// The lists of a cloth in a nucleus.
pub(super) fn lists(graph: &Graph, cloth: NodeId, nucleus: NodeId) -> ClothLists {
    use n_cloth::{
        ADD_CROSS_LINKS, BEND_RESISTANCE, BEND_STIFFNESS, COMPRESSION_RESISTANCE, COMPRESSION_STIFFNESS,
        DRAG, LIFT, SHEAR_RESISTANCE, SHEAR_STIFFNESS, STRETCH_DAMP, STRETCH_RESISTANCE, STRETCH_STIFFNESS,
    };
    let used = |key| graph.is_ever_nonzero(cloth, key);
    let node = graph.node(cloth);
    let classic = graph.node(nucleus).get(&nucleus::RESISTANCE_MODEL) == CLASSIC;
    let resists = |resistance: &Key<f64>, stiffness: &Key<f64>| match node.setting(stiffness) {
        _ if !classic && graph.changes(cloth, stiffness) => true,
        Some(_) if !classic && node.get(stiffness) >= 0.0 => node.get(stiffness) > 0.0,
        _ => graph.is_ever_nonzero(cloth, resistance),
    };
    let stretch = resists(&STRETCH_RESISTANCE, &STRETCH_STIFFNESS)
        || resists(&COMPRESSION_RESISTANCE, &COMPRESSION_STIFFNESS);
    ClothLists {
        stretch,
        cross_links: stretch && node.get(&ADD_CROSS_LINKS),
        shear: resists(&SHEAR_RESISTANCE, &SHEAR_STIFFNESS),
        bend: resists(&BEND_RESISTANCE, &BEND_STIFFNESS),
        air: (used(&DRAG) || used(&LIFT)) && graph.is_ever_nonzero(nucleus, &nucleus::AIR_DENSITY),
        damp: used(&STRETCH_DAMP) || used(&n_base::DAMP),
        self_collision: graph.is_ever_nonzero(cloth, &n_base::SELF_COLLIDE),
    }
}
