//! The search for the walls beside a liquid: the ground plane, colliders, cloth and particles of other objects.

use nalgebra::Vector3;

use crate::contact::material::ContactMaterial;
use crate::contact::pair_filter::SidesOfAll;
use crate::math::Real;
use crate::model::ClothModel;
use crate::state::State;

use super::step::{LiquidScene, LiquidStep};
use super::walls::{Corner, Material, Plane, Walls};

/// Least radius in rest distances of the ball of liquid that a particle of another object counts as.
const MIN_BALL: f32 = 0.05;
/// Radius of a ball of the volume of a cube, in sides of the cube: the third root of 3 / 4 pi.
const RADIUS_OF_CUBE: f64 = 0.620_350_490_899_400_1;

/// A box around all particles, in rest distances.
type Bounds = [[f32; 3]; 2];

/// What the search for walls reads.
pub(super) struct WallSearch<'a, R: Real> {
    pub(super) scene: LiquidScene<'a, R>,
    pub(super) state: &'a State<R>,
    pub(super) step: &'a LiquidStep,
    /// What the liquid does not collide with: it is one element, excluded from what all of its particles are.
    pub(super) excluded: SidesOfAll<'a>,
}

impl<'a, R: Real> WallSearch<'a, R> {
    pub(super) fn new(scene: LiquidScene<'a, R>, state: &'a State<R>, step: &'a LiquidStep) -> Self {
        let points = scene.model.cloths[step.cloth].points();
        Self { scene, state, step, excluded: scene.contact.pair_filter.sides_of_all(points) }
    }

    /// Finds the walls near particles in `bounds`, at the end of the time step.
    pub(super) fn find(&self, walls: &mut Walls, bounds: Bounds) {
        walls.clear();
        walls.plane = self.plane();
        self.cover_colliders(walls, bounds);
        for (other, model) in self.scene.model.cloths.iter().enumerate() {
            if other != self.step.cloth {
                self.cover_cloth(walls, (other, model), bounds);
            }
        }
        walls.sort();
    }

    fn per_metre(&self) -> f64 {
        1.0 / self.step.settings.spacing
    }

    /// A place in metres, in rest distances from the origin of the liquid.
    fn place(&self, place: Vector3<f64>) -> [f32; 3] {
        let place = (place - self.step.origin) * self.per_metre();
        [place.x as f32, place.y as f32, place.z as f32]
    }

    /// The ground plane.
    fn plane(&self) -> Option<Plane> {
        let LiquidScene { model, contact, frame } = self.scene;
        let cloth = self.step.cloth;
        let factor = contact.material_maps.max_thickness_factor[cloth];
        let material = ContactMaterial::<R>::for_ground(&frame.cloths[cloth], frame.plane.as_ref()?, factor)?;
        let plane = contact.ground.in_step(self.step.span).filter(|_| !self.excluded.exclude_ground())?;
        let first = model.cloths[cloth].points().start;
        let above = plane.height_now(first, self.state.displacement[first as usize].xyz()).to_f64();
        let normal = plane.normal().map(|x| x.to_f64());
        let from_origin = Vector3::from(self.state.position(first)) - self.step.origin;
        let height = above - Vector3::from(normal).dot(&from_origin);
        Some(Plane {
            normal: normal.map(|x| x as f32),
            height: (height * self.per_metre()) as f32,
            offset: (material.thickness * self.per_metre() - 0.5).max(0.0) as f32,
        })
    }

    fn cover_colliders(&self, walls: &mut Walls, bounds: Bounds) {
        let LiquidScene { model, contact, frame } = self.scene;
        let cloth = self.step.cloth;
        let region = walls.new_region(bounds);
        for (at, model) in model.colliders.iter().enumerate() {
            let factors = contact.material_maps.max_thickness_factors(cloth, at);
            let (own, theirs) = (&frame.cloths[cloth], &frame.colliders[at]);
            let Some(material) = ContactMaterial::<R>::for_collider(own, theirs, factors, frame.layer_range)
            else {
                continue;
            };
            let material = Material { distance: (material.thickness * self.per_metre()) as f32 };
            let collider = &contact.collider_states[at];
            let is_excluded = |corners: &[u32; 3]| self.excluded.exclude_collider(at, &corners[..]);
            let triangles = model.boundary.triangles.iter().filter(|corners| !is_excluded(corners));
            let triangles = triangles
                .map(|corners| corners.map(|point| self.place(collider.point(point, self.step.span.to))));
            match (collider.moves, region) {
                (true, _) => triangles.for_each(|triangle| walls.cover(triangle, None, material, bounds)),
                (false, Some(region)) => {
                    triangles.for_each(|triangle| walls.cover_still(triangle, material, region));
                }
                (false, None) => {}
            }
        }
        if region.is_some() {
            walls.sort_still();
        }
    }

    /// Covers the faces of another cloth, or the particles of another object.
    fn cover_cloth(&self, walls: &mut Walls, (other, model): (usize, &ClothModel<R>), bounds: Bounds) {
        let LiquidScene { contact, frame, .. } = self.scene;
        let pair = [self.step.cloth, other];
        let factors = pair.map(|cloth| contact.material_maps.max_thickness_factor[cloth]);
        let settings = pair.map(|cloth| &frame.cloths[cloth]);
        let Some(material) = ContactMaterial::<R>::for_cloths(settings, factors, frame.layer_range) else {
            return;
        };
        let distance = (material.thickness * self.per_metre()) as f32;
        let mobility = material.mobility[1].to_f64();
        if model.boundary.triangles.is_empty() {
            let radius = match &frame.cloths[other].liquid {
                Some(liquid) => (RADIUS_OF_CUBE * liquid.spacing * self.per_metre()) as f32,
                // Up to where the liquid rests on it, which begins half a rest distance before its particles.
                None => (distance - 0.5).max(MIN_BALL),
            };
            for row in model.points().filter(|row| !self.excluded.exclude(&[*row])) {
                walls.particle(self.place_at_end(row), self.corner(row, mobility), radius, bounds);
            }
            return;
        }
        let first = walls.corners().len() as u32;
        for row in model.points() {
            walls.corner(self.corner(row, mobility));
        }
        for triangle in model.boundary.triangles.iter().filter(|rows| !self.excluded.exclude(&rows[..])) {
            let corners = triangle.map(|row| first + row - model.points().start);
            let triangle = triangle.map(|row| self.place_at_end(row));
            walls.cover(triangle, Some(corners), Material { distance }, bounds);
        }
    }

    /// A point at the end of the time step, at constant velocity.
    fn place_at_end(&self, row: u32) -> [f32; 3] {
        let velocity = Vector3::from(self.state.velocity[row as usize].xyz().map(R::to_f64));
        self.place(Vector3::from(self.state.position(row)) + velocity * self.step.ahead)
    }

    fn corner(&self, row: u32, mobility: f64) -> Corner {
        let inverse_mass = self.state.displacement[row as usize].0[3].to_f64() * mobility;
        Corner { row, inverse_mass: (inverse_mass / self.step.inverse_mass) as f32, moved: [0.0; 3] }
    }
}
