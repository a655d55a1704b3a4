//! The Nucleus solver: points, links and collisions, advanced one frame at a time.

mod builder;
mod frame;
mod ids;
mod observe;
mod report;
mod solver;
mod surface;

pub use builder::{BuildError, Cloth, ClothLists, Collider, Mass, ModelBuilder};
pub use frame::{COUNT_PERIOD, ClothFrame, ColliderFrame, FrameInput, GroundPlane, Pin, ResistanceModel};
pub use ids::{ClothId, ColliderId, PointId};
pub use observe::{Moment, StateView, StepObserver};
pub use report::StepReport;
pub use solver::{PassCost, Real, Solver};
pub use surface::{Faces, Surface};
