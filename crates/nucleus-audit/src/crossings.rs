//! All pairs that do not stay apart in a motion.

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::event::{Event, Pair};
use crate::passage::{Kind, Passage, passage};
use crate::window::Windows;
use crate::world::{Rules, World};

/// The pairs that do not stay apart while all points go straight from `before` to `after`, in order.
/// Positions are those of all bodies one after the other.
///
/// # Panics
/// When there are not as many positions as points.
pub fn crossings(
    world: &World,
    rules: &Rules,
    before: &[Vector3<f64>],
    after: &[Vector3<f64>],
) -> Vec<Event> {
    Windows::default().crossings(&Motion::new(world, rules, [before, after]))
}

/// All points on their straight ways from one state to the next.
pub struct Motion<'a> {
    pub world: &'a World,
    pub rules: &'a Rules,
    pub before: &'a [Vector3<f64>],
    pub after: &'a [Vector3<f64>],
}

impl<'a> Motion<'a> {
    pub fn new(world: &'a World, rules: &'a Rules, [before, after]: [&'a [Vector3<f64>]; 2]) -> Self {
        let count = world.points();
        assert!(before.len() == count && after.len() == count, "a position for every point");
        Self { world, rules, before, after }
    }

    /// The box that an element sweeps.
    pub fn swept<const N: usize>(&self, points: &[u32; N]) -> Bounds {
        let ends = |&point: &u32| [&self.before[point as usize], &self.after[point as usize]];
        Bounds::of(points.iter().flat_map(ends))
    }

    /// The points of a pair, in the order of [`Kind`]; nothing where it need not stay apart.
    pub fn elements(&self, pair: Pair) -> Option<(Kind, [u32; 4])> {
        match pair {
            Pair::PointFace(point, face) => {
                let corners @ [a, b, c] = self.world.triangles()[face.0 as usize];
                let apply = self.rules.apply(self.world, &[point], &corners);
                apply.then_some((Kind::PointFace, [point, a, b, c]))
            }
            Pair::EdgeEdge(one, other) => {
                let [ends @ [a, b], others @ [c, d]] =
                    [one, other].map(|edge| self.world.edges()[edge.0 as usize]);
                let apply = self.rules.apply(self.world, &ends, &others);
                apply.then_some((Kind::EdgeEdge, [a, b, c, d]))
            }
        }
    }

    /// What candidates do, of those that do not stay apart.
    pub fn passages(&self, candidates: impl Iterator<Item = Pair>) -> Vec<Event> {
        candidates.filter_map(|pair| self.passage(pair)).collect()
    }

    fn passage(&self, pair: Pair) -> Option<Event> {
        let (kind, points) = self.elements(pair)?;
        let [a, b, c, d] = points;
        let meet = match kind {
            Kind::PointFace => self.swept(&[a]).meets(&self.swept(&[b, c, d])),
            Kind::EdgeEdge => self.swept(&[a, b]).meets(&self.swept(&[c, d])),
        };
        let [before, after] =
            [self.before, self.after].map(|state| points.map(|point| state[point as usize]));
        let passage = if meet { passage(kind, &before, &after) } else { Passage::Apart };
        (passage != Passage::Apart).then_some(Event { pair, passage })
    }
}
