//! A table with a value for each pair of objects: of cloths with cloths, or of cloths with colliders.

use std::ops::{Index, IndexMut};

use crate::bytes::{Encode, Reader};
use crate::contact::material::ContactMaterial;

/// Contact materials of a frame; `None` where two objects do not collide.
pub type ContactMaterials<R> = PairTable<Option<ContactMaterial<R>>>;

/// A value for each pair of a row and a column. Without values until a frame sets them.
#[derive(Debug, Clone)]
pub struct PairTable<T> {
    columns: usize,
    values: Vec<T>,
}

impl<T> PairTable<T> {
    /// Without values.
    pub const EMPTY: Self = Self { columns: 0, values: Vec::new() };

    /// The values of all pairs, row after row.
    pub fn new(columns: usize, values: Vec<T>) -> Self {
        Self { columns, values }
    }

    /// The value of each pair of so many rows and columns.
    pub fn of([rows, columns]: [usize; 2], value: impl Fn([usize; 2]) -> T) -> Self {
        let pairs = (0..rows * columns).map(|index| [index / columns, index % columns]);
        Self::new(columns, pairs.map(value).collect())
    }

    /// The number of objects in a row.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The number of pairs.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The index of a pair in the values.
    #[inline(always)]
    pub fn index_of(&self, [row, column]: [usize; 2]) -> usize {
        row * self.columns + column
    }

    /// The pair at an index.
    #[inline(always)]
    pub fn pair(&self, index: usize) -> [usize; 2] {
        [index / self.columns, index % self.columns]
    }

    /// The value of a pair; `None` in an empty table.
    pub fn get(&self, pair: [usize; 2]) -> Option<&T> {
        self.values.get(self.index_of(pair))
    }

    /// The values of an object with each object of the columns; none in an empty table.
    pub fn row(&self, row: usize) -> &[T] {
        self.values.get(row * self.columns..(row + 1) * self.columns).unwrap_or_default()
    }

    /// All values, row after row.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The same, to work on.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

impl<T> PairTable<Option<T>> {
    /// The values of the pairs that have one.
    pub fn present(&self) -> impl Iterator<Item = &T> {
        self.values.iter().flatten()
    }
}

impl<T> Index<[usize; 2]> for PairTable<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, pair: [usize; 2]) -> &T {
        &self.values[self.index_of(pair)]
    }
}

impl<T> IndexMut<[usize; 2]> for PairTable<T> {
    fn index_mut(&mut self, pair: [usize; 2]) -> &mut T {
        let index = self.index_of(pair);
        &mut self.values[index]
    }
}

/// Decodes a table of cloths with cloths: it is square, so that the number of columns follows from that of values.
impl<T: Encode> Encode for PairTable<T> {
    const SIZE: usize = 0;
    fn encode(&self, out: &mut Vec<u8>) {
        self.values.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let values = Vec::decode(from)?;
        let columns = values.len().isqrt();
        (columns * columns == values.len()).then_some(Self { columns, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pair_has_its_own_value() {
        let table = PairTable::of([3, 2], |pair| pair);
        assert_eq!(table.len(), 6);
        for index in 0..table.len() {
            let pair = table.pair(index);
            assert_eq!((table[pair], table.index_of(pair)), (pair, index));
        }
        assert_eq!(table.row(2), [[2, 0], [2, 1]]);
        assert!(table.row(3).is_empty());
    }
}
