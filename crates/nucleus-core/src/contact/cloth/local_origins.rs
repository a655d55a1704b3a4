//! The origins of swept positions, one for each cloth: how they are rounded depends on no other cloth, and how two cloths are
//! rounded to each other on those two alone.

use crate::contact::bvh::SweptBox;
use crate::model::ClothModel;

/// Relative rounding error of a position.
pub const ROUNDING: f32 = 1e-6;

/// The origin of each cloth in metres: the anchor of its first point.
#[derive(Debug, Default)]
pub struct LocalOrigins(Vec<[f64; 3]>);

impl LocalOrigins {
    /// Takes up the anchors of this frame. All swept positions are to be updated after it.
    pub fn set<R>(&mut self, cloths: &[ClothModel<R>], anchors: &[[f64; 3]]) {
        let first = |cloth: &ClothModel<R>| anchors.get(cloth.blocks.rows().start as usize).copied();
        self.0.clear();
        self.0.extend(cloths.iter().map(|cloth| first(cloth).unwrap_or_default()));
    }

    /// A position relative to the origin of a cloth.
    #[inline(always)]
    pub fn relative(&self, cloth: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let origin = self.0[cloth];
        [x - origin[0], y - origin[1], z - origin[2]]
    }

    /// From positions relative to the origin of the first cloth to those relative to the second's.
    pub fn shift(&self, [from, to]: [usize; 2]) -> OriginShift {
        let metres = self.relative(to, self.0[from]).map(|x| x as f32);
        let [x, y, z] = metres.map(f32::abs);
        OriginShift { metres, rounding: (x + y + z) * ROUNDING }
    }
}

/// The way from the origin of one cloth to that of another.
#[derive(Debug, Clone, Copy)]
pub struct OriginShift {
    /// In metres, to be added to a position.
    pub metres: [f32; 3],
    /// Rounding error of a position that is shifted, in metres.
    pub rounding: f32,
}

impl OriginShift {
    /// A swept box relative to the other origin, inflated by a margin and by the rounding error.
    #[inline(always)]
    pub fn apply(&self, swept_box: &SweptBox, margin: f32) -> SweptBox {
        [0, 1].map(|end| swept_box[end].translate(self.metres).inflate(margin + self.rounding))
    }
}
