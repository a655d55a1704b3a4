//! Blend shapes: each target adds its difference from the base, times its weight.

use crate::animation::Evaluator;
use crate::mesh::{Built, Components, InputMesh, Poly};
use crate::omissions::Cause;
use crate::scene::NodeId;

/// The item of a target that is reached at weight 1.
const FULL: u32 = 6000;

/// Offsets of the points that a target moves.
struct Target {
    weight: f64,
    offsets: Vec<(u32, [f64; 3])>,
}

pub(super) fn apply(
    evaluator: &Evaluator,
    id: NodeId,
    frame: f64,
    envelope: f64,
    mesh: &mut Poly,
    input: &InputMesh,
    built: &mut Built,
) {
    let weights = evaluator.elements(id, &["w", "weight"], frame);
    let mut targets = connected(evaluator, id, &weights, mesh, input, built);
    let known: Vec<u32> = targets.iter().map(|(index, _)| *index).collect();
    targets.extend(stored(evaluator, id, &weights).into_iter().filter(|(index, _)| !known.contains(index)));
    for (_, target) in targets {
        let weight = target.weight * envelope;
        for (point, offset) in target.offsets {
            if let Some(point) = mesh.points.get_mut(point as usize) {
                (0..3).for_each(|k| point[k] += offset[k] * weight);
            }
        }
    }
}

/// Targets that are meshes of the scene: `it[0].itg[2].iti[6000].igt`.
fn connected(
    evaluator: &Evaluator,
    id: NodeId,
    weights: &[f64],
    base: &Poly,
    input: &InputMesh,
    built: &mut Built,
) -> Vec<(u32, Target)> {
    let scene = evaluator.scene;
    let mut targets = Vec::new();
    for wire in scene.arriving(id) {
        let (mut group, mut item) = (None, None);
        let path = scene.path(wire.to);
        for step in path.segments() {
            match step.name {
                "itg" | "inputTargetGroup" => group = step.range,
                "iti" | "inputTargetItem" => item = step.range,
                _ => {}
            }
        }
        let (Some((group, _)), true) = (group, matches!(path.last().name, "igt" | "inputGeomTarget")) else {
            continue;
        };
        if item.is_some_and(|(item, _)| item != FULL) {
            built
                .omitted
                .push((scene.name(id).to_owned(), Cause::Operator("an in-between target".to_owned())));
            continue;
        }
        let weight = weights.get(group as usize).copied().unwrap_or(0.0);
        match input(wire.from, built) {
            Ok(target) if target.points.len() == base.points.len() => {
                let offset = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| b[k] - a[k]);
                let pairs = base.points.iter().zip(&target.points).map(offset);
                targets.push((group, Target { weight, offsets: (0..).zip(pairs).collect() }));
            }
            Ok(_) => {
                let what = "a target with another number of points".to_owned();
                built.omitted.push((scene.name(id).to_owned(), Cause::Operator(what)));
            }
            Err(why) => built.omitted.push((scene.name(id).to_owned(), Cause::Mesh(why))),
        }
    }
    targets
}

/// Targets whose offsets the file stores: `ipt` are the offsets of the points that `ict` lists.
fn stored(evaluator: &Evaluator, id: NodeId, weights: &[f64]) -> Vec<(u32, Target)> {
    let scene = evaluator.scene;
    let mut found: Vec<(u32, Vec<f64>, Components)> = Vec::new();
    for set in scene.assigned(id, &["it", "inputTarget"]) {
        let (mut group, mut item) = (None, None);
        for step in set.rest.segments() {
            match step.name {
                "itg" | "inputTargetGroup" => group = step.range,
                "iti" | "inputTargetItem" => item = step.range,
                _ => {}
            }
        }
        let (Some((group, _)), Some((FULL, _))) = (group, item) else { continue };
        let at = found.iter().position(|(own, ..)| *own == group).unwrap_or_else(|| {
            found.push((group, Vec::new(), Components::default()));
            found.len() - 1
        });
        match set.rest.last().name {
            // A point array has four numbers for each point.
            "ipt" | "inputPointsTarget" => found[at].1 = set.values.counted(4).unwrap_or_default(),
            "ict" | "inputComponentsTarget" => found[at].2 = Components::of(&set.values),
            _ => {}
        }
    }
    let target = |(group, points, list): (u32, Vec<f64>, Components)| {
        let weight = weights.get(group as usize).copied().unwrap_or(0.0);
        let numbers = list.numbers("vtx", 1 << 24);
        let offsets = numbers.into_iter().zip(points.chunks_exact(4).map(|p| [p[0], p[1], p[2]])).collect();
        (group, Target { weight, offsets })
    };
    found.into_iter().map(target).collect()
}
