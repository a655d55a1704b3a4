//! Union-find: disjoint sets of points that are joined one pair at a time (Galler and Fischer 1964).

/// Disjoint sets of points. A set is named by its lowest point.
#[derive(Debug, Default)]
pub struct UnionFind {
    /// A point of the same set that is no higher; a root points to itself.
    parent: Vec<u32>,
    /// The size of each root's set.
    sizes: Vec<u32>,
}

impl UnionFind {
    /// `points` sets of one point each.
    pub fn new(points: usize) -> Self {
        Self { parent: (0..points as u32).collect(), sizes: vec![1; points] }
    }

    /// The same, in the memory of older sets.
    pub fn reset(&mut self, points: usize) {
        self.parent.clear();
        self.parent.extend(0..points as u32);
        self.sizes.clear();
        self.sizes.resize(points, 1);
    }

    /// The set of a point.
    pub fn find(&mut self, mut point: u32) -> u32 {
        while self.parent[point as usize] != point {
            let next = self.parent[point as usize];
            self.parent[point as usize] = self.parent[next as usize];
            point = next;
        }
        point
    }

    /// The number of points in a set.
    pub fn size(&self, set: u32) -> u32 {
        self.sizes[set as usize]
    }

    /// Gives all points of a set the value that most of them have.
    pub fn take_majority(&mut self, values: &mut [bool]) {
        let mut yes = vec![0u32; values.len()];
        for point in 0..values.len() as u32 {
            yes[self.find(point) as usize] += u32::from(values[point as usize]);
        }
        for point in 0..values.len() as u32 {
            let set = self.find(point);
            values[point as usize] = yes[set as usize] * 2 > self.size(set);
        }
    }

    /// Joins the sets of two points.
    pub fn union(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        if a != b {
            self.parent[a.max(b) as usize] = a.min(b);
            self.sizes[a.min(b) as usize] += self.sizes[a.max(b) as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_is_named_by_its_lowest_point_and_counts_its_points() {
        let mut sets = UnionFind::new(6);
        [(5, 3), (1, 2), (3, 2), (4, 4)].into_iter().for_each(|(a, b)| sets.union(a, b));
        let of: Vec<u32> = (0..6).map(|point| sets.find(point)).collect();
        assert_eq!(of, [0, 1, 1, 1, 4, 1]);
        assert_eq!((sets.size(0), sets.size(1), sets.size(4)), (1, 4, 1));
    }
}
