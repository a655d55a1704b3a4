//! A list of numbers for each point, one list after the other.

/// The lists.
#[derive(Debug, Clone, Default)]
pub struct Lists {
    numbers: Vec<u32>,
    ends: Vec<u32>,
}

impl Lists {
    /// For so many points, from which numbers belong to which.
    pub fn new(points: usize, all: impl Iterator<Item = (u32, u32)> + Clone) -> Self {
        let mut ends = vec![0; points];
        all.clone().for_each(|(point, _)| ends[point as usize] += 1);
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        // Each stands at its start now, and comes to its end as it is filled.
        let mut numbers = vec![0; sum as usize];
        for (point, number) in all {
            numbers[ends[point as usize] as usize] = number;
            ends[point as usize] += 1;
        }
        Self { numbers, ends }
    }

    /// One point's.
    pub fn of(&self, point: u32) -> &[u32] {
        let from = (point as usize).checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.numbers[from as usize..self.ends[point as usize] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_every_number_that_was_given_for_it_and_no_other() {
        let given = [(0, 7), (2, 8), (1, 7), (2, 9), (2, 7)];
        let lists = Lists::new(4, given.into_iter());
        let expected: [&[u32]; 4] = [&[7], &[7], &[8, 9, 7], &[]];
        for (point, expected) in (0..).zip(expected) {
            assert_eq!(lists.of(point), expected, "{point}");
        }
    }
}
