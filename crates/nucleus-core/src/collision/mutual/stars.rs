//! The star of a point: the edges and triangles that have it. Rows that only fill up a block are no points, and have none.

use crate::model::ClothModel;
use crate::scalar::Real;

/// The stars of all points.
#[derive(Debug, Clone, Default)]
pub struct Stars {
    edges: Lists,
    triangles: Lists,
    is_point: Vec<bool>,
}

/// A list of elements for each point, one after the other.
#[derive(Debug, Clone, Default)]
struct Lists {
    elements: Vec<u32>,
    ends: Vec<u32>,
}

impl Stars {
    /// Of all cloths, whose points are `rows` in all.
    pub fn new<R: Real>(cloths: &[ClothModel<R>], rows: usize) -> Self {
        let mut is_point = vec![false; rows];
        cloths.iter().flat_map(|cloth| &cloth.skin.points).for_each(|&point| is_point[point as usize] = true);
        Self {
            is_point,
            edges: Lists::new(rows, cloths.iter().map(|cloth| &cloth.skin.edges[..])),
            triangles: Lists::new(rows, cloths.iter().map(|cloth| &cloth.skin.triangles[..])),
        }
    }

    /// Whether a row is a point.
    pub fn has(&self, row: u32) -> bool {
        self.is_point[row as usize]
    }

    /// The edges of a point, in the skin of its cloth.
    pub fn edges(&self, point: u32) -> &[u32] {
        self.edges.of(point)
    }

    /// The triangles of a point, in the skin of its cloth.
    pub fn triangles(&self, point: u32) -> &[u32] {
        self.triangles.of(point)
    }
}

impl Lists {
    fn new<'a, const N: usize>(rows: usize, skins: impl Iterator<Item = &'a [[u32; N]]> + Clone) -> Self {
        let all = || skins.clone().flat_map(|skin| (0..).zip(skin));
        let mut ends = vec![0; rows];
        all().flat_map(|(_, points)| points).for_each(|&point| ends[point as usize] += 1);
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        // Each stands at its start now, and comes to its end as it is filled.
        let mut elements = vec![0; sum as usize];
        for (element, points) in all() {
            for &point in points {
                elements[ends[point as usize] as usize] = element;
                ends[point as usize] += 1;
            }
        }
        Self { elements, ends }
    }

    fn of(&self, point: u32) -> &[u32] {
        let from = (point as usize).checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.elements[from as usize..self.ends[point as usize] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_star_of_a_point_has_every_element_that_has_it_and_no_other() {
        // Two cloths, of two triangles on a shared edge and of one; a point of no face between them.
        let skins = [vec![[0, 1, 2], [2, 1, 3]], vec![[5, 6, 7]]];
        let lists = Lists::new(8, skins.iter().map(|skin| &skin[..]));
        let expected: [&[u32]; 8] = [&[0], &[0, 1], &[0, 1], &[1], &[], &[0], &[0], &[0]];
        for (point, expected) in (0..).zip(expected) {
            assert_eq!(lists.of(point), expected, "{point}");
        }
    }
}
