//! Which lists a cloth needs: those whose attribute is ever other than zero.

use nucleus_core::ClothLists;

use crate::attributes::{n_base, n_cloth, nucleus};
use crate::graph::{Graph, NodeId};

/// The lists of a cloth in a nucleus.
pub(super) fn lists(graph: &Graph, cloth: NodeId, nucleus: NodeId) -> ClothLists {
    use n_cloth::{
        BEND_RESISTANCE, COMPRESSION_RESISTANCE, DRAG, LIFT, SHEAR_RESISTANCE, STRETCH_DAMP,
        STRETCH_RESISTANCE,
    };
    let used = |key| graph.is_ever_nonzero(cloth, key);
    ClothLists {
        stretch: used(&STRETCH_RESISTANCE) || used(&COMPRESSION_RESISTANCE),
        shear: used(&SHEAR_RESISTANCE),
        bend: used(&BEND_RESISTANCE),
        air: (used(&DRAG) || used(&LIFT)) && graph.is_ever_nonzero(nucleus, &nucleus::AIR_DENSITY),
        damp: used(&STRETCH_DAMP) || used(&n_base::DAMP),
        self_collision: graph.is_ever_nonzero(cloth, &n_base::SELF_COLLIDE),
    }
}
