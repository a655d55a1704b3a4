//! Skin clusters: linear blend skinning, `p' = p G Σ wⱼ Bⱼ Mⱼ G⁻¹` with the bind matrix `B` and the world matrix `M` of
//! each joint, and the geometry matrix `G`.

use crate::animation::{Evaluator, Matrix};
use crate::mesh::Poly;
use crate::scene::NodeId;

pub(super) fn apply(evaluator: &Evaluator, id: NodeId, frame: f64, envelope: f64, mesh: &mut Poly) {
    let scene = evaluator.scene;
    let geometry = scene.matrix(id, &["gm", "geomMatrix"], None).map_or(Matrix::IDENTITY, Matrix::of_rows);
    let back = geometry.inverse().unwrap_or(Matrix::IDENTITY);
    let mut joints: Vec<(u32, Matrix)> = Vec::new();
    for (index, wire) in scene.sources(id, &["ma", "matrix"]) {
        let bind =
            scene.matrix(id, &["pm", "bindPreMatrix"], Some(index)).map_or(Matrix::IDENTITY, Matrix::of_rows);
        joints.push((index, bind.then(&evaluator.world(wire.from.node, frame))));
    }
    for (point, weights) in (0..).zip(weights(evaluator, id, mesh.points.len())) {
        let start = mesh.points[point];
        let placed = geometry.point(start);
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for (joint, weight) in weights {
            let Some((_, matrix)) = joints.iter().find(|(index, _)| *index == joint) else { continue };
            let moved = matrix.point(placed);
            (0..3).for_each(|k| sum[k] += moved[k] * weight);
            total += weight;
        }
        if total <= 0.0 {
            continue;
        }
        // Weights sum to 1 in Maya, up to the digits that the file has.
        let moved = back.point(sum.map(|x| x / total));
        mesh.points[point] = [0, 1, 2].map(|k| start[k] + envelope * (moved[k] - start[k]));
    }
}

/// The joints and weights of each point. A packed list is `count joint weight joint weight ...` for each point:
/// `setAttr ".wl[0:3].w" 2 0 0.9 1 0.1 ...`.
fn weights(evaluator: &Evaluator, id: NodeId, points: usize) -> Vec<Vec<(u32, f64)>> {
    let mut all = vec![Vec::new(); points];
    for set in evaluator.scene.assigned(id, &["wl", "weightList"]) {
        let (Some((first, last)), step) = (set.segment.range, set.rest.last()) else { continue };
        if !matches!(step.name, "w" | "weights") {
            continue;
        }
        let mut numbers = set.values.numbers();
        if let Some((joint, _)) = step.range {
            // `wl[4].w[0:1] 0.5 0.5`: neighbouring joints of one point.
            if let Some(own) = all.get_mut(first as usize) {
                own.extend((joint..).zip(numbers));
            }
            continue;
        }
        for point in first..=last {
            let Some(count) = numbers.next() else { break };
            let pairs: Vec<f64> = numbers.by_ref().take(2 * count.clamp(0.0, 1e4) as usize).collect();
            if let Some(own) = all.get_mut(point as usize) {
                own.extend(pairs.chunks_exact(2).map(|pair| (pair[0] as u32, pair[1])));
            }
        }
    }
    all
}
