//! Keyed curves and transforms.
//!
//! | You want to know...                          | Read            |
//! |----------------------------------------------|-----------------|
//! | how a value is interpolated between keys     | [`Curve`]       |
//! | how translate, rotate and scale combine      | [`Transform`]   |
//! | how placements of parent and child combine   | [`Affine`]      |
//! | why an angle gives the same bits everywhere  | [`sin_cos_degrees`] |
//!
//! **Invariant:** results have the same bits on every platform. Only addition, multiplication, division and
//! remainder are used, which IEEE 754 rounds exactly, and no function of the platform's mathematics library.

mod angle;
mod curve;
mod transform;

pub use angle::sin_cos_degrees;
pub use curve::{Curve, CurveError, Infinity, Key, Tangent};
pub use transform::{Affine, Transform};
