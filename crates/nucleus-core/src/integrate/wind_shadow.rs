//! Wind shadows: an object blocks the solver's wind from points behind it (`windShadowDistance`).
//!
//! From each point a ray is cast against the wind. If it hits the surface at a distance d, the surface removes
//! 1 - (d / D)² of the wind, where D is the length of the shadow. With diffusion the result is the
//! mean of seven rays, six of them at an angle whose tangent is the diffusion: the shadow then has soft edges and
//! ends sooner behind a small object. Maya's falloffs are not published.

use nalgebra::Vector3;

use crate::contact::placed_surface::PlacedSurface;
use crate::input::object_fields::WindField;

/// Directions round the wind, evenly spaced.
const AROUND: [[f64; 2]; 6] = [
    [1.0, 0.0],
    [0.5, 0.866_025_403_784_438_6],
    [-0.5, 0.866_025_403_784_438_6],
    [-1.0, 0.0],
    [-0.5, -0.866_025_403_784_438_6],
    [0.5, -0.866_025_403_784_438_6],
];

/// The shadow of one object.
pub struct WindShadow {
    surface: PlacedSurface,
    /// The cloth that it is, and whether it shadows itself.
    cloth: Option<usize>,
    shadows_itself: bool,
    /// From a point to as far as an object can be that shadows it.
    rays: Vec<Vector3<f64>>,
}

impl WindShadow {
    /// The shadow of a surface in this wind.
    pub fn new(
        surface: PlacedSurface,
        settings: &WindField,
        cloth: Option<usize>,
        wind: Vector3<f64>,
    ) -> Self {
        let mut rays = Vec::new();
        if let Some(along) = wind.try_normalize(0.0) {
            rays.push(along * -settings.shadow_distance);
            let diffusion = settings.shadow_diffusion.clamp(0.0, 1.0);
            let side = along.cross(&if along.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() });
            if let Some(side) = side.try_normalize(0.0).filter(|_| diffusion > 0.0) {
                let sides = [side, along.cross(&side)];
                let tilted = AROUND.map(|[x, y]| (sides[0] * x + sides[1] * y) * diffusion - along);
                rays.extend(tilted.map(|ray| ray.normalize() * settings.shadow_distance));
            }
        }
        Self { surface, cloth, shadows_itself: settings.self_shadow, rays }
    }

    /// The share of the wind that gets to a place in metres, which is a point of a cloth, counted from its first.
    pub fn share(&self, place: Vector3<f64>, [cloth, point]: [u32; 2]) -> f64 {
        let is_own = self.cloth == Some(cloth as usize);
        if self.rays.is_empty() || is_own && !self.shadows_itself {
            return 1.0;
        }
        let own = is_own.then_some(point);
        let through = |ray: &Vector3<f64>| self.surface.first_hit(place, *ray, own).map_or(1.0, |at| at * at);
        self.rays.iter().map(through).sum::<f64>() / self.rays.len() as f64
    }
}
