//! What particles touch at the end of a substep, with normals and velocities. Computed only for objects with rotation.

use nalgebra::Vector3;

use crate::contact::bvh::Aabb;
use crate::contact::cloth::contact::ClothContact;
use crate::contact::material::ContactMaterial;
use crate::contact::narrow_phase::shortest_line;
use crate::contact::pair_table::ContactMaterials;
use crate::contact::response::Restitution;
use crate::contact::system::ContactSystem;
use crate::math::Real;
use crate::model::Model;
use crate::state::State;

/// A surface that a particle touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The particle, as a row of the solver.
    pub point: u32,
    /// From the surface to the particle.
    pub normal: Vector3<f64>,
    /// Velocity of the particle relative to the surface, in m/s.
    pub velocity: Vector3<f64>,
}

/// All touches of particles with rotation, sorted by points. `end` is the time as a share of the frame, `duration` the
/// length of the frame in seconds.
pub fn list_touches<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    end: f64,
    duration: f64,
) -> Vec<Touch> {
    let mut finder = TouchFinder { model, state, contact, end, duration, found: Vec::new() };
    let rotating = state.populations.iter().filter(|population| !population.rotations().is_empty());
    for cloth in rotating.map(|population| population.cloth()) {
        finder.find_on_ground(cloth);
        finder.find_on_colliders(cloth);
    }
    finder.find_on_cloth();
    // Stable: the touches of a point keep their order.
    finder.found.sort_by_key(|touch| touch.point);
    finder.found
}

struct TouchFinder<'a, R: Real> {
    model: &'a Model<R>,
    state: &'a State<R>,
    contact: &'a ContactSystem<R>,
    end: f64,
    duration: f64,
    found: Vec<Touch>,
}

impl<R: Real> TouchFinder<'_, R> {
    fn find_on_ground(&mut self, cloth: usize) {
        let Some(material) = &self.contact.ground_materials[cloth] else { return };
        let filter = &self.contact.pair_filter;
        for point in self.model.cloths[cloth].points().filter(|point| !filter.excludes_ground(*point)) {
            let Some((normal, height)) = self.contact.ground.at(self.state.position(point), self.end) else {
                return;
            };
            let thickness = self.thickness(material, [point], [R::ONE]);
            if Restitution::touches(height, thickness) {
                let surface = Vector3::from(self.contact.ground.velocity(self.duration));
                self.add(point, normal.into(), surface);
            }
        }
    }

    /// Of each collider only the nearest face counts: two faces at an edge are one surface.
    fn find_on_colliders(&mut self, cloth: usize) {
        for collider in 0..self.contact.collider_states.len() {
            let Some(material) = self.contact.collider_materials_of(cloth)[collider] else { continue };
            for point in self.model.cloths[cloth].points() {
                if let Some((normal, surface)) = self.nearest_face(point, collider, &material) {
                    self.add(point, normal, surface);
                }
            }
        }
    }

    /// The normal and the velocity of the collider at the nearest point of it that a particle touches.
    fn nearest_face(
        &self,
        point: u32,
        collider: usize,
        material: &ContactMaterial<R>,
    ) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let state = &self.contact.collider_states[collider];
        let triangles = &self.model.colliders[collider].boundary.triangles;
        let place = self.state.position(point);
        let local = Vector3::from(place) - state.origin(self.end);
        let reach = self.thickness(material, [point], [R::ONE]) * Restitution::<f64>::MAX_TOUCHING_GAP;
        let (mut least, mut nearest) = (reach, None);
        state.bvh.query(&Aabb::new(local.add_scalar(-reach), local.add_scalar(reach)), |face| {
            let corners = triangles[face as usize];
            if self.contact.pair_filter.excludes_collider(&[point], collider, &corners) {
                return;
            }
            let (normal, (_, weights), distance) = shortest_line::<f64, 1, 3>((
                [place],
                corners.map(|corner| state.point(corner, self.end).into()),
            ));
            let maps = &self.contact.material_maps;
            let thickness =
                material.thickness_with_collider(maps, ([point], [1.0]), (collider, corners, weights));
            if distance <= least && Restitution::touches(distance, thickness) {
                let travel = |k: usize| state.end[corners[k] as usize] - state.start[corners[k] as usize];
                let travel: Vector3<f64> = (0..3).map(|k| travel(k) * weights[k]).sum();
                (least, nearest) = (distance, Some((Vector3::from(normal), travel / self.duration)));
            }
        });
        nearest
    }

    fn find_on_cloth(&mut self) {
        let Some(contacts) = self.contact.cloth_contacts.as_ref().filter(|contacts| contacts.is_enabled())
        else {
            return;
        };
        let (cache, materials) = (&contacts.cache, &contacts.materials);
        cache.point_face.iter().for_each(|contact| self.find_at(contact, materials));
        cache.point_edge.iter().for_each(|contact| self.find_at(contact, materials));
        for contact in cache.point_point.iter() {
            self.find_at(contact, materials);
            let ([point], [other]) = (contact.ours, contact.theirs);
            if let Some((normal, _)) = self.touching_line(contact, materials).filter(|_| self.rotates(other))
            {
                self.add(other, -normal, self.velocity(point));
            }
        }
    }

    fn find_at<const M: usize>(&mut self, contact: &ClothContact<R, 1, M>, materials: &ContactMaterials<R>) {
        let [point] = contact.ours;
        if !self.rotates(point) {
            return;
        }
        if let Some((normal, weights)) = self.touching_line(contact, materials) {
            let surface =
                contact.theirs.iter().zip(weights).map(|(&row, weight)| self.velocity(row) * weight).sum();
            self.add(point, normal, surface);
        }
    }

    /// The normal of a contact whose sides touch, and the weights of their points.
    fn touching_line<const M: usize>(
        &self,
        contact: &ClothContact<R, 1, M>,
        materials: &ContactMaterials<R>,
    ) -> Option<(Vector3<f64>, [f64; M])> {
        let place = |point: u32| self.state.position(point);
        let (normal, (ours, theirs), distance) =
            shortest_line((contact.ours.map(place), contact.theirs.map(place)));
        let weights = (ours.map(R::from_f64), theirs.map(R::from_f64));
        let thickness = contact.thickness_at(materials, &self.contact.material_maps, &weights).to_f64();
        Restitution::touches(distance, thickness).then_some((normal.into(), theirs))
    }

    /// Whether a point is a particle with rotation.
    fn rotates(&self, point: u32) -> bool {
        let mut rotating =
            self.state.populations.iter().filter(|population| !population.rotations().is_empty());
        rotating.any(|population| self.model.cloths[population.cloth()].points().contains(&point))
    }

    fn velocity(&self, point: u32) -> Vector3<f64> {
        self.state.seen_velocity(point).into()
    }

    fn add(&mut self, point: u32, normal: Vector3<f64>, surface: Vector3<f64>) {
        let velocity = self.velocity(point) - surface;
        self.found.push(Touch { point, normal, velocity });
    }

    /// The contact thickness of a point with a collider or the ground, in metres.
    fn thickness(&self, material: &ContactMaterial<R>, points: [u32; 1], shares: [R; 1]) -> f64 {
        let most = R::from_f64(material.thickness);
        material.thickness_at(&self.contact.material_maps, (points, [], &(shares, [])), most).to_f64()
    }
}
