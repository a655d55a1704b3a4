//! Blend shapes: each target adds its difference from the base, times its weight. Targets of one group that are reached at
//! other weights than 1 are in-betweens: the shape moves from one to the next.

use std::collections::BTreeMap;

use crate::animation::Evaluator;
use crate::mesh::History;
use crate::mesh::{Components, InputMesh, Poly};
use crate::omissions::Cause;
use crate::scene::{NodeId, Set};

/// The item of a target that is reached at weight 0; a weight of 1 is a thousand more.
const NONE: u32 = 5000;

/// Offsets of the points that a target moves.
type Offsets = Vec<(u32, [f64; 3])>;

/// The targets of a group, by their items.
type Targets = BTreeMap<u32, Offsets>;

pub(super) fn apply(
    evaluator: &Evaluator,
    id: NodeId,
    frame: f64,
    envelope: f64,
    mesh: &mut Poly,
    input: &InputMesh,
    history: &mut History,
) {
    let weights = evaluator.elements(id, &["w", "weight"], frame);
    let painted = Painted::of(evaluator, id);
    let mut groups = stored(evaluator, id);
    for (group, targets) in connected(evaluator, id, mesh, input, history) {
        groups.entry(group).or_default().extend(targets);
    }
    for (group, targets) in &groups {
        let weight = weights.get(*group as usize).copied().unwrap_or(0.0);
        for (item, share) in shares(targets, weight) {
            for (point, offset) in &targets[&item] {
                let factor = share * envelope * painted.at(*group, *point);
                if let Some(point) = mesh.points.get_mut(*point as usize) {
                    (0..3).for_each(|k| point[k] += offset[k] * factor);
                }
            }
        }
    }
}

/// How much of each target a weight takes: between two neighbours, linearly. Before the first and after the last, the
/// segment at the end goes on.
fn shares(targets: &Targets, weight: f64) -> Vec<(u32, f64)> {
    let at = |item: u32| (f64::from(item) - f64::from(NONE)) / 1000.0;
    let mut knots: Vec<(f64, Option<u32>)> = targets.keys().map(|item| (at(*item), Some(*item))).collect();
    knots.retain(|(at, _)| *at != 0.0);
    knots.push((0.0, None));
    knots.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(last) = knots.len().checked_sub(2) else { return Vec::new() };
    let first = knots.partition_point(|(at, _)| *at <= weight).saturating_sub(1).min(last);
    let [(a, before), (b, after)] = [knots[first], knots[first + 1]];
    let share = (weight - a) / (b - a);
    let all = [(before, 1.0 - share), (after, share)];
    all.into_iter().filter_map(|(item, share)| Some((item?, share))).collect()
}

/// Weights of single points: of the whole node, and of each target. A point without one has 1.
#[derive(Default)]
struct Painted {
    base: BTreeMap<u32, f64>,
    targets: BTreeMap<(u32, u32), f64>,
}

impl Painted {
    fn of(evaluator: &Evaluator, id: NodeId) -> Self {
        let mut painted = Self::default();
        for set in evaluator.scene.assigned(id, &["it", "inputTarget"]) {
            let last = set.rest.last();
            let Some((first, _)) = last.range else { continue };
            let values = (first..).zip(set.values.numbers().filter(|x| x.is_finite()));
            match (last.name, place(&set).0) {
                ("bw" | "baseWeights", _) => painted.base.extend(values),
                ("tw" | "targetWeights", Some(group)) => {
                    painted.targets.extend(values.map(|(point, x)| ((group, point), x)));
                }
                _ => {}
            }
        }
        painted
    }

    fn at(&self, group: u32, point: u32) -> f64 {
        let weights = [self.base.get(&point), self.targets.get(&(group, point))];
        weights.into_iter().flatten().product()
    }
}

/// Group and item of a path: `it[0].itg[2].iti[6000]`.
fn place(set: &Set) -> (Option<u32>, Option<u32>) {
    let (mut group, mut item) = (None, None);
    for step in set.rest.segments() {
        match step.name {
            "itg" | "inputTargetGroup" => group = step.range.map(|range| range.0),
            "iti" | "inputTargetItem" => item = step.range.map(|range| range.0),
            _ => {}
        }
    }
    (group, item)
}

/// Targets that are meshes of the scene: `it[0].itg[2].iti[6000].igt`.
fn connected(
    evaluator: &Evaluator,
    id: NodeId,
    base: &Poly,
    input: &InputMesh,
    history: &mut History,
) -> BTreeMap<u32, Targets> {
    let scene = evaluator.scene;
    let mut groups: BTreeMap<u32, Targets> = BTreeMap::new();
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
        let is_target = matches!(path.last().name, "igt" | "inputGeomTarget");
        let (Some((group, _)), Some((item, _)), true) = (group, item, is_target) else { continue };
        match input(wire.from, history) {
            Ok(target) if target.points.len() == base.points.len() => {
                let offset = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| b[k] - a[k]);
                let pairs = base.points.iter().zip(&target.points).map(offset);
                // Most targets move few points.
                let offsets: Offsets = (0..).zip(pairs).filter(|(_, offset)| *offset != [0.0; 3]).collect();
                match history.budget.take(offsets.len() as u64) {
                    Ok(()) => drop(groups.entry(group).or_default().insert(item, offsets)),
                    Err(why) => history.omitted.push((scene.name(id).to_owned(), Cause::Mesh(why))),
                }
            }
            Ok(_) => {
                let what = "a target with another number of points".to_owned();
                history.omitted.push((scene.name(id).to_owned(), Cause::Operator(what)));
            }
            Err(why) => history.omitted.push((scene.name(id).to_owned(), Cause::Mesh(why))),
        }
    }
    groups
}

/// Targets whose offsets the file stores: `ipt` are the offsets of the points that `ict` lists.
fn stored(evaluator: &Evaluator, id: NodeId) -> BTreeMap<u32, Targets> {
    let scene = evaluator.scene;
    let mut found: BTreeMap<(u32, u32), (Vec<f64>, Components)> = BTreeMap::new();
    for set in scene.assigned(id, &["it", "inputTarget"]) {
        let (Some(group), Some(item)) = place(&set) else { continue };
        let (points, list) = found.entry((group, item)).or_default();
        match set.rest.last().name {
            // A point array has four numbers for each point.
            "ipt" | "inputPointsTarget" => *points = set.values.counted(4).unwrap_or_default(),
            "ict" | "inputComponentsTarget" => *list = Components::of(&set.values),
            _ => {}
        }
    }
    let mut groups: BTreeMap<u32, Targets> = BTreeMap::new();
    for ((group, item), (points, list)) in found.into_iter().filter(|(_, (points, _))| !points.is_empty()) {
        let numbers = list.numbers("vtx", 1 << 24);
        let offsets = numbers.zip(points.chunks_exact(4).map(|p| [p[0], p[1], p[2]])).collect();
        groups.entry(group).or_default().insert(item, offsets);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weight_takes_its_share_of_the_targets_beside_it() {
        let targets = |items: &[u32]| items.iter().map(|item| (*item, Vec::new())).collect::<Targets>();
        assert_eq!(shares(&targets(&[6000]), 0.25), [(6000, 0.25)]);
        assert_eq!(shares(&targets(&[6000]), 1.5), [(6000, 1.5)]);
        let both = targets(&[5500, 6000]);
        assert_eq!(shares(&both, 0.25), [(5500, 0.5)]);
        assert_eq!(shares(&both, 0.5), [(5500, 1.0), (6000, 0.0)]);
        assert_eq!(shares(&both, 0.75), [(5500, 0.5), (6000, 0.5)]);
        assert_eq!(shares(&both, -0.5), [(5500, -1.0)]);
        assert!(shares(&targets(&[]), 1.0).is_empty());
    }
}
