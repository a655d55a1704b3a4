//! All pairs that do not stay apart in a motion.

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::event::{Event, Pair};
use crate::passage::{Kind, Passage, passage};
use crate::tree::Tree;
use crate::world::{EdgeId, FaceId, Rules, World};

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
    assert!(before.len() == world.points() && after.len() == world.points(), "a position for every point");
    let motion = Motion { world, rules, before, after, stack: Vec::new(), events: Vec::new() };
    motion.points_and_faces().edges().sorted()
}

struct Motion<'a> {
    world: &'a World,
    rules: &'a Rules,
    before: &'a [Vector3<f64>],
    after: &'a [Vector3<f64>],
    stack: Vec<u32>,
    events: Vec<Event>,
}

impl Motion<'_> {
    fn swept<const N: usize>(&self, points: &[u32; N]) -> Bounds {
        let ends = |&point: &u32| [&self.before[point as usize], &self.after[point as usize]];
        Bounds::of(points.iter().flat_map(ends))
    }

    fn points_and_faces(mut self) -> Self {
        let world = self.world;
        let boxes: Vec<Bounds> = world.triangles().iter().map(|corners| self.swept(corners)).collect();
        let tree = Tree::new(self.rules.concerned(world, world.triangles()), &boxes);
        let mut stack = std::mem::take(&mut self.stack);
        for point in 0..world.points() as u32 {
            let bounds = self.swept(&[point]);
            tree.meeting(&bounds, &boxes, &mut stack, |face| {
                let [a, b, c] = world.triangles()[face as usize];
                if self.rules.apply(world, &[point], &[a, b, c]) {
                    self.test(Kind::PointFace, [point, a, b, c], Pair::PointFace(point, FaceId(face)));
                }
            });
        }
        self.stack = stack;
        self
    }

    fn edges(mut self) -> Self {
        let world = self.world;
        let boxes: Vec<Bounds> = world.edges().iter().map(|ends| self.swept(ends)).collect();
        let concerned = self.rules.concerned(world, world.edges());
        let tree = Tree::new(concerned.clone(), &boxes);
        let mut stack = std::mem::take(&mut self.stack);
        for edge in concerned {
            let [a, b] = world.edges()[edge as usize];
            tree.meeting(&boxes[edge as usize], &boxes, &mut stack, |other| {
                let [c, d] = world.edges()[other as usize];
                if other > edge && self.rules.apply(world, &[a, b], &[c, d]) {
                    self.test(Kind::EdgeEdge, [a, b, c, d], Pair::EdgeEdge(EdgeId(edge), EdgeId(other)));
                }
            });
        }
        self.stack = stack;
        self
    }

    fn test(&mut self, kind: Kind, points: [u32; 4], pair: Pair) {
        let [before, after] =
            [self.before, self.after].map(|state| points.map(|point| state[point as usize]));
        let passage = passage(kind, &before, &after);
        if passage != Passage::Apart {
            self.events.push(Event { pair, passage });
        }
    }

    fn sorted(mut self) -> Vec<Event> {
        self.events.sort_by_key(|event| event.pair);
        self.events
    }
}
