//! Translate, rotate and scale as in Maya's transform nodes, and placements in the space of a parent.

use nalgebra::{Matrix3, Vector3};

use super::angle::sin_cos_degrees;

/// Translation, rotation and scale, relative to the parent.
///
/// Points are scaled, then rotated about the three axes (x, then y, then z, unless `order` differs), then translated.
/// The pivots are at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// Translation in scene units.
    pub translate: Vector3<f64>,
    /// Rotation about each axis in degrees.
    pub rotate: Vector3<f64>,
    /// The axes in the order of rotation.
    pub order: [usize; 3],
    /// Scale factors along the local axes.
    pub scale: Vector3<f64>,
}

impl Transform {
    /// The placement in the space of the parent.
    pub fn affine(&self) -> Affine {
        let [x, y, z] = [self.rotate.x, self.rotate.y, self.rotate.z].map(sin_cos_degrees);
        let turns = [about_x(x), about_y(y), about_z(z)];
        let [first, second, third] = self.order.map(|axis| turns[axis]);
        let linear = third * second * first * Matrix3::from_diagonal(&self.scale);
        Affine { linear, offset: self.translate }
    }

    /// The point in the space of the parent. For many points, call [`affine`](Self::affine) once.
    pub fn point(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.affine().point(point)
    }
}

impl Default for Transform {
    fn default() -> Self {
        Self {
            translate: Vector3::zeros(),
            rotate: Vector3::zeros(),
            order: [0, 1, 2],
            scale: Vector3::repeat(1.0),
        }
    }
}

fn about_x((sin, cos): (f64, f64)) -> Matrix3<f64> {
    Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, -sin, 0.0, sin, cos)
}

fn about_y((sin, cos): (f64, f64)) -> Matrix3<f64> {
    Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos)
}

fn about_z((sin, cos): (f64, f64)) -> Matrix3<f64> {
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}

/// A placement: a linear map and an offset, from one space to another. Lengths in the unit of the points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    /// Rotation, scale and shear.
    pub linear: Matrix3<f64>,
    /// The image of the origin.
    pub offset: Vector3<f64>,
}

impl Affine {
    /// The placement that moves no point.
    pub fn identity() -> Self {
        Self { linear: Matrix3::identity(), offset: Vector3::zeros() }
    }

    /// The image of a point. The identity changes no bit of it.
    pub fn point(&self, point: Vector3<f64>) -> Vector3<f64> {
        // Adding zeros would turn -0 into 0.
        if *self == Self::identity() {
            return point;
        }
        self.linear * point + self.offset
    }

    /// The placement at a share of the way to another, on which every point moves along a straight line.
    pub fn toward(&self, other: &Self, share: f64) -> Self {
        Self {
            linear: self.linear + (other.linear - self.linear) * share,
            offset: self.offset + (other.offset - self.offset) * share,
        }
    }

    /// Whether it makes a mirror image, as an odd number of negative scales does.
    pub fn mirrors(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// This placement, followed by that of the parent.
    pub fn under(&self, parent: &Self) -> Self {
        Self { linear: parent.linear * self.linear, offset: parent.point(self.offset) }
    }
}

impl Default for Affine {
    fn default() -> Self {
        Self::identity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
        [-size..size, -size..size, -size..size].prop_map(Vector3::from)
    }

    fn transforms() -> impl Strategy<Value = Transform> {
        (vector(100.0), vector(720.0), vector(3.0)).prop_map(|(translate, rotate, scale)| Transform {
            translate,
            rotate,
            scale,
            ..Transform::default()
        })
    }

    #[test]
    fn the_order_is_scale_then_x_then_y_then_z_then_translate() {
        let transform = Transform {
            translate: Vector3::new(10.0, 20.0, 30.0),
            rotate: Vector3::new(90.0, 90.0, 0.0),
            scale: Vector3::new(1.0, 2.0, 1.0),
            ..Transform::default()
        };
        // y is doubled, then rotated to z about x, then to x about y.
        assert_eq!(transform.point(Vector3::y()), Vector3::new(12.0, 20.0, 30.0));
        let z_last = Transform { rotate: Vector3::new(90.0, 0.0, 90.0), ..Transform::default() };
        assert_eq!(z_last.point(Vector3::y()), Vector3::z());
        // The rotation about z takes y to -x, which the rotation about x leaves.
        let z_first = Transform { order: [2, 0, 1], ..z_last };
        assert_eq!(z_first.point(Vector3::y()), -Vector3::x());
    }

    proptest! {
        #[test]
        fn the_identity_changes_no_bit(point in prop::array::uniform3(any::<f64>())) {
            let after = Transform::default().point(Vector3::from(point));
            prop_assert_eq!(after.map(f64::to_bits), Vector3::from(point).map(f64::to_bits));
        }

        #[test]
        fn a_transform_without_scale_keeps_distances(transform in transforms(), a in vector(50.0), b in vector(50.0)) {
            let rigid = Transform { scale: Vector3::repeat(1.0), ..transform };
            let distance = (rigid.point(a) - rigid.point(b)).norm();
            prop_assert!((distance - (a - b).norm()).abs() < 1e-12);
        }

        #[test]
        fn the_placement_of_a_child_is_its_own_followed_by_that_of_its_parent(child in transforms(), parent in transforms(), p in vector(50.0)) {
            let together = child.affine().under(&parent.affine()).point(p);
            prop_assert!((together - parent.point(child.point(p))).norm() < 1e-9);
        }
    }
}
