//! Time integration: symplectic Euler, the scheme of position-based dynamics (Müller et al. 2007, §3.1).
//!
//! With external acceleration g and a time step of h seconds, a free point of position x and velocity v goes
//!
//! ```text
//! v  <-  v + h g          external forces, then drag and lift (implicit)
//! p  <-  x + h v          the predicted position
//! x  <-  p + corrections  constraints and contacts project positions
//! v  <-  v + (x - p) / h  velocities follow the corrections
//! ```
//!
//! The last line is v = (x - x_start) / h of the paper, written so that no velocity is a difference of rounded
//! positions.
//!
//! | Stage | Read |
//! |---|---|
//! | gravity, forces, inertia; velocities after the corrections | [`predict`] |
//! | the motion of points by forces, eight at a time | [`move_points`] |
//! | drag, lift and wind, implicit per time step | [`aerodynamics`] |
//! | what is added to the wind at each point | [`local_wind`] |
//! | wind that varies in space and time | [`gusts`] |
//! | objects that keep the wind from others, and that push air | [`wind_shadow`], [`air_push`] |

pub mod aerodynamics;
pub mod air_push;
pub mod gusts;
pub mod local_wind;
mod move_points;
pub mod predict;
pub mod wind_shadow;
