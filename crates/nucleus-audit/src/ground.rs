//! Vertices that pass through the ground plane.
//!
//! A plane has no far side to come from: a vertex that was above it and is below it in a later state has passed
//! through. So states suffice, without the motion between them.

use nalgebra::Vector3;

use crate::collision_filter::CollisionFilter;
use crate::collision_mesh::CollisionMesh;

/// Tolerance below the plane, as a fraction of the largest coordinate of the body and of the plane's origin: 1e-6 m at
/// one metre. It covers only the rounding of single-precision states.
const TOLERANCE: f64 = 1e-6;

/// A ground plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    origin: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Plane {
    /// Through a point in metres, with a normal of any length; `None` when the normal is zero or a coordinate is not
    /// finite.
    pub fn new(origin: Vector3<f64>, normal: Vector3<f64>) -> Option<Self> {
        let normal = normal.try_normalize(0.0)?;
        let is_finite = origin.iter().chain(&normal).all(|x| x.is_finite());
        is_finite.then_some(Self { origin, normal })
    }

    /// Linear interpolation of origin and normal to another plane.
    pub fn towards(&self, end: &Self, share: f64) -> Self {
        let origin = self.origin + (end.origin - self.origin) * share;
        let normal = self.normal + (end.normal - self.normal) * share;
        Self::new(origin, normal).unwrap_or(*end)
    }

    fn height(&self, place: &Vector3<f64>) -> f64 {
        (place - self.origin).dot(&self.normal)
    }
}

/// Which vertices were above the ground plane in the last state.
#[derive(Debug, Default)]
pub struct Ground {
    above: Vec<bool>,
    /// Whether a body had a ground plane in the last state.
    has_met: Vec<bool>,
}

impl Ground {
    /// The vertices of a body that a motion takes from above the plane to below it. `planes` are those at the start and
    /// at the end of the motion; `None` where the body has no ground plane.
    pub fn passed(
        &mut self,
        (mesh, filter): (&CollisionMesh, &CollisionFilter),
        body: usize,
        planes: Option<[Plane; 2]>,
        [before, after]: [&[Vector3<f64>]; 2],
    ) -> Vec<u32> {
        self.above.resize(mesh.points(), false);
        self.has_met.resize(mesh.bodies().len(), false);
        let points = mesh.points_of(body);
        let had_met = std::mem::replace(&mut self.has_met[body], planes.is_some());
        let Some([start, end]) = planes else { return Vec::new() };
        if !had_met {
            let depth = -tolerance(&start, &before[points.clone()]);
            points.clone().for_each(|k| self.above[k] = start.height(&before[k]) >= depth);
        }
        let depth = -tolerance(&end, &after[points.clone()]);
        let mut passed = Vec::new();
        for point in points {
            let height = end.height(&after[point]);
            // A NaN height keeps the previous side.
            let is_above = if height.is_nan() { self.above[point] } else { height >= depth };
            let was_above = std::mem::replace(&mut self.above[point], is_above);
            if was_above && !is_above && !filter.is_free_of_ground(point) {
                passed.push(point as u32);
            }
        }
        passed
    }
}

fn tolerance(plane: &Plane, places: &[Vector3<f64>]) -> f64 {
    let sizes = places.iter().map(Vector3::amax).filter(|size| size.is_finite());
    TOLERANCE * sizes.fold(plane.origin.amax(), f64::max)
}
