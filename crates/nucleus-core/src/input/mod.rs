//! Input of one frame: positions of pins and colliders, forces and attributes; and its validation.
//!
//! Animation is evaluated once per frame and interpolated linearly inside it (§2.4). Everything is in metres, kilograms
//! and seconds.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the attributes and motion of a frame | [`frame`] |
//! | force fields of the scene | [`fields`] |
//! | what objects do to the air and to each other at a distance | [`object_fields`] |
//! | links of dynamic constraints | [`links`] |
//! | ramps as evenly spaced samples | [`samples`] |
//! | how NaN, infinite and absurdly large values are replaced | [`validation`] |

pub mod fields;
pub mod frame;
pub mod links;
pub mod object_fields;
pub mod particles;
pub mod samples;
pub mod validation;

/// A cloth of a model, counted in the order in which the builder received them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClothId(pub u32);

/// A collider (passive object) of a model, counted in the order in which the builder received them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ColliderId(pub u32);

/// A point of one object, in the order of its mesh; the solver's internal order differs.
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
