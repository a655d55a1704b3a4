//! Transforms of Maya: pivots, rotation orders, joint orientation, shear, parents, and offsets of the parent.

use nucleus_graph::animation::sin_cos_degrees;

use crate::scene::{NodeId, is_shape};

use super::evaluator::Evaluator;
use super::names;

/// A 4 x 4 matrix for row vectors, as Maya's: a point is `p * M`. Lengths in centimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matrix(pub [[f64; 4]; 4]);

/// The axes of a rotation order, in the order of turning: xyz, yzx, zxy, xzy, yxz, zyx.
pub(crate) const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]];

impl Matrix {
    /// The identity.
    pub const IDENTITY: Self =
        Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]);

    /// From rows one after the other.
    pub fn of_rows(rows: [f64; 16]) -> Self {
        Self([0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| rows[4 * row + column])))
    }

    /// A translation.
    pub fn translation(by: [f64; 3]) -> Self {
        let mut all = Self::IDENTITY;
        all.0[3][..3].copy_from_slice(&by);
        all
    }

    /// A scale along the axes.
    pub fn scaling(by: [f64; 3]) -> Self {
        let mut all = Self::IDENTITY;
        (0..3).for_each(|k| all.0[k][k] = by[k]);
        all
    }

    /// A shear: xy, xz, yz.
    pub fn shearing([xy, xz, yz]: [f64; 3]) -> Self {
        let mut all = Self::IDENTITY;
        (all.0[1][0], all.0[2][0], all.0[2][1]) = (xy, xz, yz);
        all
    }

    /// A rotation by angles in degrees, in an order of axes.
    pub fn rotation(degrees: [f64; 3], order: usize) -> Self {
        let about = |axis: usize| {
            let (sin, cos) = sin_cos_degrees(degrees[axis]);
            let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
            let mut turn = Self::IDENTITY;
            turn.0[a][a] = cos;
            turn.0[a][b] = sin;
            turn.0[b][a] = -sin;
            turn.0[b][b] = cos;
            turn
        };
        let [first, second, third] = ORDERS[order.min(5)].map(about);
        first.then(&second).then(&third)
    }

    /// This map, followed by another.
    pub fn then(&self, next: &Self) -> Self {
        let (a, b) = (&self.0, &next.0);
        let entry = |row: usize, column: usize| (0..4).map(|k| a[row][k] * b[k][column]).sum();
        Self([0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| entry(row, column))))
    }

    /// The image of a point.
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        let m = &self.0;
        [0, 1, 2].map(|k| p[0] * m[0][k] + p[1] * m[1][k] + p[2] * m[2][k] + m[3][k])
    }

    /// The image of a vector between two points.
    pub fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        let m = &self.0;
        [0, 1, 2].map(|k| v[0] * m[0][k] + v[1] * m[1][k] + v[2] * m[2][k])
    }

    /// The inverse; `None` if a scale is zero.
    pub fn inverse(&self) -> Option<Self> {
        let m = nalgebra::Matrix4::from_fn(|row, column| self.0[row][column]);
        let inverse = m.try_inverse()?;
        Some(Self([0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| inverse[(row, column)]))))
    }

    /// Whether it is the identity, up to rounding.
    pub fn is_identity(&self) -> bool {
        let pairs = self.0.iter().flatten().zip(Self::IDENTITY.0.iter().flatten());
        pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12)
    }

    /// Translation, rotation in degrees in an order of axes, and scale. `None` if it has shear.
    pub fn decomposed(&self, order: usize) -> Option<[[f64; 3]; 3]> {
        let rows = [0, 1, 2].map(|k| nalgebra::Vector3::new(self.0[k][0], self.0[k][1], self.0[k][2]));
        let mut scale = rows.map(|row| row.norm());
        if scale.iter().any(|s| !(1e-12..1e12).contains(s)) {
            return None;
        }
        let mut axes = [0, 1, 2].map(|k| rows[k] / scale[k]);
        let skew = [(0, 1), (0, 2), (1, 2)].iter().any(|(a, b)| axes[*a].dot(&axes[*b]).abs() > 1e-6);
        if skew {
            return None;
        }
        if axes[0].cross(&axes[1]).dot(&axes[2]) < 0.0 {
            scale[2] = -scale[2];
            axes[2] = -axes[2];
        }
        let rotate = angles(&axes.map(|axis| [axis.x, axis.y, axis.z]), order);
        Some([[self.0[3][0], self.0[3][1], self.0[3][2]], rotate, scale])
    }
}

/// The angles of a rotation matrix (row vectors) in an order of axes, in degrees.
fn angles(m: &[[f64; 3]; 3], order: usize) -> [f64; 3] {
    let [i, j, k] = ORDERS[order.min(5)];
    // The sign of an odd permutation of the axes.
    let sign = if (j + 3 - i) % 3 == 1 { 1.0 } else { -1.0 };
    let sin = (-sign * m[i][k]).clamp(-1.0, 1.0);
    let turn = |y: f64, x: f64| libm::atan2(y, x) * 180.0 / std::f64::consts::PI;
    let mut all = [0.0; 3];
    all[j] = turn(sin, (1.0 - sin * sin).max(0.0).sqrt());
    if sin.abs() < 1.0 - 1e-12 {
        all[i] = turn(sign * m[j][k], m[k][k]);
        all[k] = turn(sign * m[i][j], m[i][i]);
    } else {
        // Gimbal lock: one angle does for two axes.
        all[i] = turn(-sign * m[k][j], m[j][j]);
    }
    all
}

impl Evaluator<'_> {
    /// A length vector of a transform in centimetres.
    pub(crate) fn lengths(&self, id: NodeId, vector: crate::scene::Vector3, frame: f64) -> [f64; 3] {
        self.vector(id, vector, [0.0; 3], frame).map(|x| x * self.scene.units.centimetres)
    }

    /// An angle vector of a transform in degrees.
    pub(crate) fn degrees(&self, id: NodeId, vector: crate::scene::Vector3, frame: f64) -> [f64; 3] {
        self.vector(id, vector, [0.0; 3], frame).map(|x| x * self.scene.units.degrees)
    }

    /// The scale by which a joint undoes that of its parent, between its orientation and its translation.
    pub(crate) fn compensation(&self, id: NodeId, frame: f64) -> Option<[f64; 3]> {
        if self.scene.kind(id) != "joint" || !self.scene.switch_or(id, names::SEGMENT_SCALE, true) {
            return None;
        }
        let scale = self.vector(id, names::INVERSE_SCALE, [1.0; 3], frame);
        (scale != [1.0; 3]).then(|| scale.map(|s| if s == 0.0 { 1.0 } else { 1.0 / s }))
    }

    /// The placement of a transform in the space of its parent; a shape is where its transform is.
    pub fn local(&self, id: NodeId, frame: f64) -> Matrix {
        if is_shape(self.scene.kind(id)) {
            return Matrix::IDENTITY;
        }
        let scale = self.vector(id, names::SCALE, [1.0; 3], frame);
        let shear = self.vector(id, names::SHEAR, [0.0; 3], frame);
        let order = self.scene.stored_or(id, names::ROTATE_ORDER, 0.0) as usize;
        let turn = Matrix::rotation(self.degrees(id, names::ROTATE, frame), order);
        let axis = Matrix::rotation(self.degrees(id, names::ROTATE_AXIS, frame), 0);
        let minus = |v: [f64; 3]| v.map(|x| -x);
        let [rp, rpt, sp, spt, t] = [
            names::ROTATE_PIVOT,
            names::ROTATE_PIVOT_TRANSLATE,
            names::SCALE_PIVOT,
            names::SCALE_PIVOT_TRANSLATE,
            names::TRANSLATE,
        ]
        .map(|vector| self.lengths(id, vector, frame));
        let mut all = Matrix::scaling(scale).then(&Matrix::shearing(shear));
        if self.scene.kind(id) == "joint" {
            let orient = Matrix::rotation(self.degrees(id, names::JOINT_ORIENT, frame), 0);
            all = all.then(&axis).then(&turn).then(&orient);
            if let Some(scale) = self.compensation(id, frame) {
                all = all.then(&Matrix::scaling(scale));
            }
            return all.then(&Matrix::translation(t));
        }
        all = Matrix::translation(minus(sp)).then(&all).then(&Matrix::translation(sp));
        all = all.then(&Matrix::translation(spt)).then(&Matrix::translation(minus(rp)));
        all = all.then(&axis).then(&turn).then(&Matrix::translation(rp)).then(&Matrix::translation(rpt));
        all = all.then(&Matrix::translation(t));
        match self.scene.matrix(id, names::OFFSET, None) {
            Some(offset) => all.then(&Matrix::of_rows(offset)),
            None => all,
        }
    }

    /// The placement of a node in the world.
    pub fn world(&self, id: NodeId, frame: f64) -> Matrix {
        let mut all = Matrix::IDENTITY;
        for node in self.scene.self_and_ancestors(id) {
            all = all.then(&self.local(node, frame));
            let is_transform = !is_shape(self.scene.kind(node));
            if is_transform && !self.scene.switch_or(node, names::INHERITS, true) {
                break;
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_placement_is_taken_apart_into_its_parts(
            t in prop::array::uniform3(-9.0..9.0), r in prop::array::uniform3(-89.0..89.0),
            s in prop::array::uniform3(0.1..4.0), order in 0usize..6,
        ) {
            let whole = Matrix::scaling(s).then(&Matrix::rotation(r, order)).then(&Matrix::translation(t));
            let [t2, r2, s2] = whole.decomposed(order).unwrap();
            let again = Matrix::scaling(s2).then(&Matrix::rotation(r2, order)).then(&Matrix::translation(t2));
            for (a, b) in whole.0.iter().flatten().zip(again.0.iter().flatten()) {
                prop_assert!((a - b).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let turned = Matrix::rotation([0.0, 0.0, 90.0], 0).point([1.0, 0.0, 0.0]);
        assert!((turned[0]).abs() < 1e-12 && (turned[1] - 1.0).abs() < 1e-12, "{turned:?}");
    }

    #[test]
    fn gimbal_lock_is_taken_apart_too() {
        for order in 0..6 {
            let mut r = [20.0, 30.0, 40.0];
            r[ORDERS[order][1]] = 90.0;
            let whole = Matrix::rotation(r, order);
            let [_, again, _] = whole.decomposed(order).unwrap();
            let again = Matrix::rotation(again, order);
            for (a, b) in whole.0.iter().flatten().zip(again.0.iter().flatten()) {
                assert!((a - b).abs() < 1e-6, "order {order}: {a} is not {b}");
            }
        }
    }
}
