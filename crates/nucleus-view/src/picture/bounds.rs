//! The box that holds a set of points.

use super::{Object, Vec3, is_drawable, object::Kind};

/// An axis-aligned box, in scene units. Empty until something is put in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: [f32; 3],
    /// Largest coordinates.
    pub high: [f32; 3],
}

impl Default for Bounds {
    fn default() -> Self {
        Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] }
    }
}

impl Bounds {
    /// The box round what a picture of `objects` is about: its cloths and particles, or,
    /// where there is none, everything.
    pub fn of_interest<'a>(objects: &[Object<'a>]) -> Self {
        let mut moving = Self::default();
        let mut all = Self::default();
        for object in objects {
            all.include(object.positions);
            if object.kind != Kind::Collider {
                moving.include(object.positions);
            }
        }
        if moving.is_empty() { all } else { moving }
    }

    /// Grows the box to hold these points too. Points that cannot be drawn are left out.
    pub fn include(&mut self, positions: &[[f32; 3]]) {
        for point in positions.iter().filter(|point| is_drawable(point)) {
            for axis in 0..3 {
                self.low[axis] = self.low[axis].min(point[axis]);
                self.high[axis] = self.high[axis].max(point[axis]);
            }
        }
    }

    /// Grows the box to hold another.
    pub fn merge(&mut self, other: &Self) {
        if !other.is_empty() {
            self.include(&[other.low, other.high]);
        }
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.low[axis] > self.high[axis])
    }

    pub(super) fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            Vec3::from_fn(|axis, _| if corner >> axis & 1 == 0 { self.low[axis] } else { self.high[axis] })
        })
    }

    pub(super) fn centre(&self) -> Vec3 {
        (Vec3::from(self.low) + Vec3::from(self.high)) * 0.5
    }
}
