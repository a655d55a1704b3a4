//! A placement: what carries points from one space into another.

use nalgebra::{Matrix3, Vector3};

/// A linear map and an offset. Lengths in the unit of the points it is applied to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    /// Rotation, scale and shear.
    pub linear: Matrix3<f64>,
    /// Where the origin goes.
    pub offset: Vector3<f64>,
}

impl Affine {
    /// Leaves everything where it is.
    pub fn identity() -> Self {
        Self { linear: Matrix3::identity(), offset: Vector3::zeros() }
    }

    /// Where a point goes. The identity changes no bit of it.
    pub fn point(&self, point: Vector3<f64>) -> Vector3<f64> {
        // Sums with zeros would turn -0 into 0.
        if *self == Self::identity() {
            return point;
        }
        self.linear * point + self.offset
    }

    /// This placement inside that of a parent: first this one, then the parent's.
    pub fn under(&self, parent: &Self) -> Self {
        Self { linear: parent.linear * self.linear, offset: parent.point(self.offset) }
    }
}

impl Default for Affine {
    fn default() -> Self {
        Self::identity()
    }
}
