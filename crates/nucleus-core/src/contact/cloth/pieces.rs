//! What hangs together.

/// Points, joined into pieces. A piece goes by the lowest of its points.
pub struct Pieces {
    /// A point of the same piece that is no higher; itself for the lowest.
    lower: Vec<u32>,
    /// Points in the piece of each lowest point.
    sizes: Vec<u32>,
}

impl Pieces {
    /// So many points, each on its own.
    pub fn new(points: usize) -> Self {
        Self { lower: (0..points as u32).collect(), sizes: vec![1; points] }
    }

    /// The piece of a point.
    pub fn of(&mut self, mut point: u32) -> u32 {
        while self.lower[point as usize] != point {
            let next = self.lower[point as usize];
            self.lower[point as usize] = self.lower[next as usize];
            point = next;
        }
        point
    }

    /// How many points a piece has.
    pub fn size(&self, piece: u32) -> u32 {
        self.sizes[piece as usize]
    }

    /// Lets all points of a piece have the value that most of them have.
    pub fn agree(&mut self, values: &mut [bool]) {
        let mut yes = vec![0u32; values.len()];
        for point in 0..values.len() as u32 {
            yes[self.of(point) as usize] += u32::from(values[point as usize]);
        }
        for point in 0..values.len() as u32 {
            let piece = self.of(point);
            values[point as usize] = yes[piece as usize] * 2 > self.size(piece);
        }
    }

    /// Joins the pieces of two points.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        if a != b {
            self.lower[a.max(b) as usize] = a.min(b);
            self.sizes[a.min(b) as usize] += self.sizes[a.max(b) as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_goes_by_its_lowest_point_and_knows_its_size() {
        let mut pieces = Pieces::new(6);
        [(5, 3), (1, 2), (3, 2), (4, 4)].into_iter().for_each(|(a, b)| pieces.join(a, b));
        let of: Vec<u32> = (0..6).map(|point| pieces.of(point)).collect();
        assert_eq!(of, [0, 1, 1, 1, 4, 1]);
        assert_eq!((pieces.size(0), pieces.size(1), pieces.size(4)), (1, 4, 1));
    }
}
