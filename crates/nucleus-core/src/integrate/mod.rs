//! Time integration: symplectic Euler, the scheme of position-based dynamics (Müller et al. 2007, §3.1).
//!
//! | Stage | Read |
//! |---|---|
//! | external forces change velocities, velocities move points | [`predict`] |
//! | drag, lift and wind, implicit per time step | [`aerodynamics`] |
//! | wind that varies in space and time | [`gusts`] |
//! | velocities follow the position corrections of constraints and contacts | [`velocities`] |

pub mod aerodynamics;
pub mod gusts;
pub mod predict;
pub mod velocities;
