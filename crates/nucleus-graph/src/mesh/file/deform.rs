//! Linear blend skinning of the points of a mesh (Magnenat-Thalmann et al. 1988).

use nalgebra::{Matrix4, Vector3};

/// The joints that move the points of a mesh.
pub(super) struct Influences {
    /// Joints of each point, the same number for each.
    pub(super) joints: Vec<u32>,
    /// Their weights.
    pub(super) weights: Vec<f64>,
}

impl Influences {
    /// `None` unless there are as many joints as weights, the same number for each point, and each joint exists.
    pub(super) fn new(joints: Vec<u32>, weights: Vec<f64>, points: usize, bones: usize) -> Option<Self> {
        let fits = joints.len() == weights.len()
            && points > 0
            && !joints.is_empty()
            && joints.len().is_multiple_of(points)
            && joints.iter().all(|joint| (*joint as usize) < bones);
        fits.then_some(Self { joints, weights })
    }

    /// Moves the points; `bones` take a point at rest to where each joint carries it.
    pub(super) fn skin(&self, points: &mut [Vector3<f64>], bones: &[Matrix4<f64>]) {
        let each = self.joints.len() / points.len().max(1);
        let influences = self.joints.chunks(each).zip(self.weights.chunks(each));
        for (point, (joints, weights)) in points.iter_mut().zip(influences) {
            let moved = |(joint, weight): (&u32, &f64)| transform(&bones[*joint as usize], point) * *weight;
            *point = joints.iter().zip(weights).map(moved).sum();
        }
    }
}

pub(super) fn transform(matrix: &Matrix4<f64>, point: &Vector3<f64>) -> Vector3<f64> {
    matrix.fixed_view::<3, 3>(0, 0) * point + matrix.fixed_view::<3, 1>(0, 3)
}
