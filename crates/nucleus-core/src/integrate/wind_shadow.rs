//! Wind shadows: an object blocks the solver's wind from points behind it (`windShadowDistance`).
//!
//! From each point a ray is cast against the wind. If it hits the surface at a distance d, the surface removes
//! 1 - (d / D)² of the wind, where D is the length of the shadow. With diffusion the result is the
//! mean of seven rays, six of them at an angle whose tangent is the diffusion: the shadow then has soft edges and
//! ends sooner behind a small object. Maya's falloffs are not published.
//!
//! The rays of all points are parallel, and neighbouring points are near in space: they are cast in bundles.

use nalgebra::Vector3;

use crate::contact::placed_surface::{PlacedSurface, RAYS};
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
pub struct WindShadow<'a> {
    surface: &'a PlacedSurface,
    /// The cloth that it is, and whether it shadows itself.
    cloth: Option<usize>,
    shadows_itself: bool,
    /// From a point to as far as an object can be that shadows it.
    rays: Vec<Vector3<f64>>,
}

impl<'a> WindShadow<'a> {
    /// The shadow of a surface in this wind.
    pub fn new(
        surface: &'a PlacedSurface,
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

    /// Multiplies `shares` by the shares of the wind that get to places in metres. They are consecutive points of a cloth;
    /// `point` is the first one's, counted from the first of the cloth. At most [`RAYS`].
    pub fn shade(&self, places: &[Vector3<f64>], [cloth, point]: [u32; 2], shares: &mut [f64; RAYS]) {
        let is_own = self.cloth == Some(cloth as usize);
        if self.rays.is_empty() || is_own && !self.shadows_itself {
            return;
        }
        let own = is_own.then_some(point);
        let mut through = [0.0; RAYS];
        for ray in &self.rays {
            let reached = self.surface.first_hits(places, *ray, own);
            through.iter_mut().zip(reached).for_each(|(sum, at)| *sum += at * at);
        }
        let count = self.rays.len() as f64;
        shares.iter_mut().zip(through).for_each(|(share, sum)| *share *= sum / count);
    }
}
