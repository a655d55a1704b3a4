//! A particle and one of its neighbours.

/// Added to the number of a neighbour, so that its bits are those of a normal number: lanes compute with it, and discard the
/// result. Subnormal numbers would be slow.
const NORMAL: u32 = 0x4000_0000;

/// A neighbour of a particle: the derivative of the density of either by the position of the first, per rest distance, and
/// the bits of the neighbour's number.
#[derive(Debug, Clone, Copy)]
pub struct Pair([f32; 4]);

impl Pair {
    /// A neighbour by its number, below 2²⁹.
    pub const fn new([x, y, z]: [f32; 3], other: u32) -> Self {
        Self([x, y, z, Self::tag(other)])
    }

    /// The same, with the [tag](Self::tag) of the number as the last.
    #[inline(always)]
    pub fn from_row(row: [f32; 4]) -> Self {
        Self(row)
    }

    /// The gradient.
    #[inline(always)]
    pub fn gradient(&self) -> [f32; 3] {
        let [x, y, z, _] = self.0;
        [x, y, z]
    }

    /// The gradient, and a fourth number that is finite and means nothing.
    #[inline(always)]
    pub fn row(&self) -> [f32; 4] {
        self.0
    }

    /// The neighbour, in the sorted order.
    #[inline(always)]
    pub fn other(&self) -> usize {
        (self.0[3].to_bits() ^ NORMAL) as usize
    }

    /// The number of a particle as a finite scalar.
    #[inline(always)]
    pub const fn tag(number: u32) -> f32 {
        f32::from_bits(number + NORMAL)
    }
}
