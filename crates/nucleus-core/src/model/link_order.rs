//! The order of links: levels that grow outwards from given points (`sortLinks`), levels that keep the order of the mesh
//! (Classic), and the number of links at each point, by which a sweep over all links at once is damped (`evaluationOrder`: Parallel).

use crate::constraints::stretch::{LinkGroup, LinkRow};
use crate::math::Real;
use crate::model::objects::LinkOrder;
use crate::model::surface::Surface;
use crate::model::topology::stretch_links;

/// The number of links from each point of the mesh to the nearest of the points that links are sorted from; empty where
/// links are not sorted.
pub fn distances(surface: &Surface, order: &LinkOrder) -> Vec<u32> {
    let LinkOrder::Outwards(sources) = order else { return Vec::new() };
    let mut neighbours = vec![Vec::new(); surface.positions.len()];
    for link in stretch_links(surface, true) {
        let [a, b] = link.ends;
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(a);
    }
    let mut distances = vec![u32::MAX; neighbours.len()];
    let mut reached: Vec<u32> = sources.iter().map(|point| point.0).collect();
    let mut distance = 0;
    while !reached.is_empty() {
        reached.retain(|&point| {
            let is_new = distances[point as usize] == u32::MAX;
            distances[point as usize] = distances[point as usize].min(distance);
            is_new
        });
        reached = reached.iter().flat_map(|&point| &neighbours[point as usize]).copied().collect();
        distance += 1;
    }
    distances
}

/// The level of each row in the order of the list: one above those of all earlier rows that it shares a point with. Rows
/// of a level share no point, so that swept level by level they give the bits of the list's order. `first` is the first
/// of `columns` rows of the solver.
pub fn levels_of_list<R: Real>(rows: &[LinkRow<R>], first: u32, columns: u32) -> Vec<u32> {
    let mut next = vec![0; columns as usize];
    let level = |row: &LinkRow<R>| {
        let ends = row.ends.map(|end| (end - first) as usize);
        let level: u32 = ends.into_iter().map(|end| next[end]).max().unwrap_or(0);
        ends.into_iter().for_each(|end| next[end] = level + 1);
        level
    };
    rows.iter().map(level).collect()
}

/// The level of each row: the distance of its nearer end; empty where links are not sorted.
pub fn levels<R: Real>(rows: &[LinkRow<R>], distances: &[u32], point: impl Fn(u32) -> usize) -> Vec<u32> {
    if distances.is_empty() {
        return Vec::new();
    }
    rows.iter().map(|row| row.ends.map(|end| distances[point(end)]).into_iter().min().unwrap_or(0)).collect()
}

/// The number of links at each of `columns` rows from `first` on; at least 1.
pub fn valence<'a, R: Real>(
    groups: impl Iterator<Item = &'a LinkGroup<R>>,
    first: u32,
    columns: u32,
) -> Vec<R> {
    let mut counts = vec![0u32; columns as usize];
    for group in groups {
        for end in group.ends.iter().flatten() {
            counts[(end - first) as usize] += 1;
        }
    }
    counts.into_iter().map(|count| R::from_f64(f64::from(count.max(1)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rows_that_share_a_point_keep_the_order_of_the_list(
            ends in proptest::collection::vec((0u32..20, 0u32..20), 0..80),
        ) {
            let row = |&(a, b): &(u32, u32)| LinkRow { ends: [a + 5, b + 5], rest_length: 1.0f64, slenderness: 1.0, warp: 1.0 };
            let rows: Vec<_> = ends.iter().filter(|(a, b)| a != b).map(row).collect();
            let levels = levels_of_list(&rows, 5, 20);
            for later in 0..rows.len() {
                for earlier in 0..later {
                    let shared = rows[earlier].ends.iter().any(|end| rows[later].ends.contains(end));
                    prop_assert!(!shared || levels[earlier] < levels[later]);
                }
            }
        }
    }
}
