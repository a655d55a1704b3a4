//! Input of one frame: positions of pins and colliders, forces, attributes; and its validation.
//!
//! Animated values are read once per frame and interpolated inside it (paper, §2.4).

pub mod frame;
pub mod ids;
pub mod validation;
