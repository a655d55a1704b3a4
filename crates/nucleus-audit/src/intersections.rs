//! All edges that are inside faces in a state.

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::event::Overlapping;
use crate::overlap::{Overlap, overlap};
use crate::threads::in_chunks;
use crate::tree::Tree;
use crate::world::{EdgeId, FaceId, Rules, World};

/// The edges and faces that have a point in common, in order. Positions are those of all bodies one after the
/// other.
///
/// # Panics
/// When there are not as many positions as points.
pub fn intersections(world: &World, rules: &Rules, positions: &[Vector3<f64>]) -> Vec<Overlapping> {
    assert!(positions.len() == world.points(), "a position for every point");
    let at = |point: u32| &positions[point as usize];
    let boxes: Vec<Bounds> = world.triangles().iter().map(|corners| Bounds::of(corners.map(at))).collect();
    let tree = Tree::new(rules.concerned(world, world.triangles()), &boxes);
    let mut found = in_chunks(&rules.concerned(world, world.edges()), |edges| {
        let (mut stack, mut found) = (Vec::new(), Vec::new());
        for &edge in edges {
            let ends = &world.edges()[edge as usize];
            tree.meeting(&Bounds::of(ends.map(at)), &boxes, &mut stack, |face| {
                let corners = &world.triangles()[face as usize];
                if rules.apply(world, ends, corners) {
                    let overlap = overlap(&ends.map(|p| *at(p)), &corners.map(|p| *at(p)));
                    if overlap != Overlap::Apart {
                        found.push(Overlapping { edge: EdgeId(edge), face: FaceId(face), overlap });
                    }
                }
            });
        }
        found
    });
    found.sort_by_key(|found| (found.edge, found.face));
    found
}
