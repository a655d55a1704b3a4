//! What changes with time: keyed values, and where things stand.
//!
//! | You want to know...                          | Read            |
//! |----------------------------------------------|-----------------|
//! | how a value runs between its keys            | [`Curve`]       |
//! | what translate, rotate and scale do          | [`Transform`]   |
//! | how a thing follows its parent               | [`Affine`]      |
//! | why an angle gives the same bits everywhere  | [`sin_cos_degrees`] |
//!
//! **Invariant:** only addition, multiplication, division and remainder are used, which every platform
//! rounds alike; no function of the platform's mathematics library is called.

mod affine;
mod angle;
mod curve;
mod transform;

pub use affine::Affine;
pub use angle::sin_cos_degrees;
pub use curve::{Curve, CurveError, Infinity, Key, Tangent};
pub use transform::Transform;
