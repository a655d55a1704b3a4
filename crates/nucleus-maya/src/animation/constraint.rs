//! Constraints of transforms: `parentConstraint`, `pointConstraint`, `orientConstraint`.
//!
//! A constraint lies under the transform that it drives, and its targets are connected to `target[i]`.

use std::collections::BTreeMap;

use crate::scene::{NodeId, Vector3};

use super::evaluator::Evaluator;
use super::names::{self, Driven};
use super::placement::Matrix;

const OFFSET: Vector3 =
    Vector3 { whole: &["o", "offset"], parts: [&["ox", "offsetX"], &["oy", "offsetY"], &["oz", "offsetZ"]] };

impl Evaluator<'_> {
    /// What a constraint gives its transform at a frame; `None` where it is not read.
    pub(super) fn constrained(&self, id: NodeId, frame: f64) -> Option<Driven> {
        let key = (id, frame.to_bits());
        if let Some(known) = self.constraints.borrow().get(&key) {
            return *known;
        }
        // A constraint that depends on itself finds this.
        self.constraints.borrow_mut().insert(key, None);
        let found = self.nested(|| self.solve(id, frame));
        self.constraints.borrow_mut().insert(key, found);
        found
    }

    fn solve(&self, id: NodeId, frame: f64) -> Option<Driven> {
        let (scene, kind) = (self.scene, self.scene.kind(id));
        let own = scene.node(id).parent?;
        let targets = self.targets(id, frame);
        let total: f64 = targets.values().map(|(_, weight)| weight).sum();
        if total <= 0.0 {
            return None;
        }
        let above = scene.node(own).parent.filter(|_| scene.switch_or(own, names::INHERITS, true));
        let back = above.map_or(Some(Matrix::IDENTITY), |above| self.world(above, frame).inverse())?;
        let (unit, own_unit) = (scene.units, scene.units_of(id));
        let offset = self.vector(id, OFFSET, [0.0; 3], frame);
        // Several targets share a position by weight; a turn comes from one.
        let single = targets.values().filter(|(_, weight)| *weight > 0.0).count() == 1;
        let mut at = [0.0; 3];
        let mut turn = Matrix::IDENTITY;
        for (index, (target, weight)) in &targets {
            let world = self.world(*target, frame);
            let place = match kind {
                "parentConstraint" => {
                    let carried = self.target_offset(id, *index).then(&rigid(&world)?);
                    turn = carried;
                    carried.point([0.0; 3])
                }
                _ => {
                    turn = Matrix::rotation(offset.map(|x| x * own_unit.degrees), 0).then(&rigid(&world)?);
                    world.point(self.lengths(*target, names::ROTATE_PIVOT, frame))
                }
            };
            (0..3).for_each(|k| at[k] += place[k] * weight / total);
        }
        let at = back.point(at);
        let pivots = [names::ROTATE_PIVOT, names::ROTATE_PIVOT_TRANSLATE]
            .map(|vector| self.lengths(own, vector, frame));
        let is_point = kind == "pointConstraint";
        let translate = std::array::from_fn(|k| {
            let by = if is_point { offset[k] * own_unit.centimetres } else { 0.0 };
            (at[k] - pivots[0][k] - pivots[1][k] + by) / unit.centimetres
        });
        if is_point {
            return Some([translate, [0.0; 3]]);
        }
        let order = scene.stored_or(own, names::ROTATE_ORDER, 0.0) as usize;
        let mut local = rigid(&turn.then(&back))?;
        if scene.kind(own) == "joint" {
            let orient = Matrix::rotation(self.degrees(own, names::JOINT_ORIENT, frame), 0);
            local = local.then(&orient.inverse()?);
        }
        let [_, rotate, _] = local.decomposed(order)?;
        single.then(|| [translate, rotate.map(|x| x / unit.degrees)])
    }

    /// The targets of a constraint by their index, with their weights.
    fn targets(&self, id: NodeId, frame: f64) -> BTreeMap<u32, (NodeId, f64)> {
        let wires = self.scene.sources(id, &["tg", "target"]);
        let last = |wire: &crate::scene::Wire| self.scene.path(wire.to).last().name;
        let is_weight = |name: &str| matches!(name, "tw" | "targetWeight");
        let nodes = wires.iter().filter(|(_, wire)| !is_weight(last(wire)) && wire.from.node != id);
        let mut targets: BTreeMap<u32, (NodeId, f64)> =
            nodes.map(|(index, wire)| (*index, (wire.from.node, 1.0))).collect();
        for (index, wire) in wires.iter().filter(|(_, wire)| is_weight(last(wire))) {
            if let (Some(target), Some(weight)) = (targets.get_mut(index), self.output(wire.from, frame)) {
                target.1 = weight;
            }
        }
        targets
    }

    /// The placement of a driven transform in the space of a target of its parent constraint.
    fn target_offset(&self, id: NodeId, index: u32) -> Matrix {
        let units = self.scene.units_of(id);
        let all = |short: &str, long: &str| {
            let mut stored = [0.0; 3];
            let own = self.scene.assigned(id, &["tg", "target"]);
            for set in own.filter(|set| set.segment.range.is_some_and(|(first, _)| first == index)) {
                let name = set.rest.last().name;
                let Some(rest) = name.strip_prefix(long).or_else(|| name.strip_prefix(short)) else {
                    continue;
                };
                let numbers = set.values.numbers().filter(|x| x.is_finite());
                match rest {
                    "" => numbers.take(3).enumerate().for_each(|(part, x)| stored[part] = x),
                    "x" | "X" => numbers.take(1).for_each(|x| stored[0] = x),
                    "y" | "Y" => numbers.take(1).for_each(|x| stored[1] = x),
                    "z" | "Z" => numbers.take(1).for_each(|x| stored[2] = x),
                    _ => {}
                }
            }
            stored
        };
        let [at, turn] = [all("tot", "targetOffsetTranslate"), all("tor", "targetOffsetRotate")];
        let turn = Matrix::rotation(turn.map(|x| x * units.degrees), 0);
        turn.then(&Matrix::translation(at.map(|x| x * units.centimetres)))
    }
}

/// A placement without its scale; `None` if it has shear.
fn rigid(matrix: &Matrix) -> Option<Matrix> {
    let [at, rotate, _] = matrix.decomposed(0)?;
    Some(Matrix::rotation(rotate, 0).then(&Matrix::translation(at)))
}
