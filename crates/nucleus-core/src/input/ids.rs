//! Typed indices: which cloth, which collider, which of its points.

/// A cloth of a model, counted in the order in which the builder was given them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClothId(pub u32);

/// A collider (passive object) of a model, counted in the order in which the builder was given them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ColliderId(pub u32);

/// A point of one object in the order of the mesh it came from, whatever order the solver keeps inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointId(pub u32);

impl ClothId {
    /// The index into columns with one row per cloth.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl ColliderId {
    /// The index into columns with one row per collider.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl PointId {
    /// The index into the mesh's own columns.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}
