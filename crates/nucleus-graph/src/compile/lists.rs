//! Which lists a cloth needs: those whose attribute is ever other than zero.

use nucleus_core::ClothLists;

use crate::attributes::{Key, n_base, n_cloth, nucleus};
use crate::graph::{Graph, NodeId};

use super::maps::Scales;
use super::objects::CLASSIC;

/// The lists of a cloth in a nucleus.
pub(super) fn lists(graph: &Graph, cloth: NodeId, nucleus: NodeId, scales: &Scales) -> ClothLists {
    use n_cloth::{
        ADD_CROSS_LINKS, BEND_RESISTANCE, BEND_STIFFNESS, COMPRESSION_RESISTANCE, COMPRESSION_STIFFNESS,
        DRAG, LIFT, SHEAR_RESISTANCE, SHEAR_STIFFNESS, STRETCH_DAMP, STRETCH_RESISTANCE, STRETCH_STIFFNESS,
    };
    let used = |key, scale: f64| scale != 0.0 && graph.is_ever_nonzero(cloth, key);
    let node = graph.node(cloth);
    let classic = graph.node(nucleus).get(&nucleus::RESISTANCE_MODEL) == CLASSIC;
    let resists = |resistance: &Key<f64>, stiffness: &Key<f64>, scale: f64| match node.setting(stiffness) {
        _ if scale == 0.0 => false,
        _ if !classic && graph.changes(cloth, stiffness) => true,
        Some(_) if !classic && node.get(stiffness) >= 0.0 => node.get(stiffness) > 0.0,
        _ => graph.is_ever_nonzero(cloth, resistance),
    };
    let stretch = resists(&STRETCH_RESISTANCE, &STRETCH_STIFFNESS, scales.stretch)
        || resists(&COMPRESSION_RESISTANCE, &COMPRESSION_STIFFNESS, scales.compression);
    ClothLists {
        stretch,
        cross_links: stretch && node.get(&ADD_CROSS_LINKS),
        shear: resists(&SHEAR_RESISTANCE, &SHEAR_STIFFNESS, 1.0),
        bend: resists(&BEND_RESISTANCE, &BEND_STIFFNESS, scales.bend),
        air: (used(&DRAG, scales.drag) || used(&LIFT, scales.lift))
            && graph.is_ever_nonzero(nucleus, &nucleus::AIR_DENSITY),
        damp: used(&STRETCH_DAMP, 1.0) || used(&n_base::DAMP, scales.damp),
        self_collision: graph.is_ever_nonzero(cloth, &n_base::SELF_COLLIDE),
    }
}
