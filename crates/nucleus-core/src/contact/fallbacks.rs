//! How often the fallbacks of the [`safeguard`](super::safeguard) are tried, for cloth and for free points alike.

/// Attempts to push by the whole thickness.
pub const PUSH_ATTEMPTS: usize = 4;
/// Attempts to push by a smaller and smaller share of it.
pub const SCALED_ATTEMPTS: usize = 6;
/// Attempts to truncate motion, or to move points with the surface.
pub const TRUNCATE_ATTEMPTS: usize = 8;
/// Attempts to freeze points, or to move them with what carries them.
pub const FREEZE_ATTEMPTS: usize = 32;

/// Attempts after which nothing pushes any more.
pub const PUSHING_ENDS: usize = PUSH_ATTEMPTS + SCALED_ATTEMPTS;
/// Attempts after which free points stay as they are.
pub const TRUNCATING_ENDS: usize = PUSHING_ENDS + TRUNCATE_ATTEMPTS;

/// The share of the thickness by which an attempt pushes.
pub fn thickness_scale(attempt: usize) -> f64 {
    let halvings = (attempt + 1).saturating_sub(PUSH_ATTEMPTS).min(SCALED_ATTEMPTS);
    0.5f64.powi(halvings as i32)
}
