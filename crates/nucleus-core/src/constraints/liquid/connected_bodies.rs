//! Connected bodies of particles, whose rigid motion can be taken out of a field of velocities.

use nalgebra::{Matrix3, Vector3};

use crate::union_find::UnionFind;

use super::neighbours::{CHUNK, Neighbours, chunk_range};

/// The determinant of the inertia of a body, as a share of that of a ball of the same trace, below which it counts as a line:
/// its turn about that is not defined.
const THINNEST: f64 = 1e-4;

/// Bodies of particles that pairs join.
#[derive(Debug, Default)]
pub(super) struct ConnectedBodies {
    sets: UnionFind,
    /// By the name of the set.
    bodies: Vec<Body>,
}

/// Particles of equal mass, and how they move.
#[derive(Debug, Clone, Copy, Default)]
struct Body {
    count: f64,
    /// Sums over the particles, then their mean.
    centre: Vector3<f64>,
    velocity: Vector3<f64>,
    /// About the centre.
    inertia: Matrix3<f64>,
    angular_momentum: Vector3<f64>,
    /// Angular velocity; `None` of a body that is a line or a point.
    turn: Option<Vector3<f64>>,
}

impl ConnectedBodies {
    /// Finds the bodies of a search.
    pub fn find(&mut self, neighbours: &Neighbours) {
        let count = neighbours.len();
        self.sets.reset(count);
        for chunk in 0..count.div_ceil(CHUNK as usize) {
            for (k, at) in chunk_range(chunk, count).enumerate() {
                for other in neighbours.of(chunk, k).iter().map(|pair| pair.other() as u32) {
                    if other > at {
                        self.sets.union(at, other);
                    }
                }
            }
        }
    }

    /// Removes the mean motion and the mean turn of each body from the velocities of its particles. A body that is a line or
    /// a point is left at rest.
    pub fn remove_rigid_motion(&mut self, positions: &[[f32; 4]], velocities: &mut [[f32; 4]]) {
        let Self { sets, bodies } = self;
        bodies.clear();
        bodies.resize(velocities.len(), Body::default());
        let triple = |[x, y, z, _]: [f32; 4]| Vector3::new(x, y, z).map(f64::from);
        for (at, (place, velocity)) in (0..).zip(positions.iter().zip(&*velocities)) {
            let body = &mut bodies[sets.find(at) as usize];
            body.count += 1.0;
            body.centre += triple(*place);
            body.velocity += triple(*velocity);
        }
        for body in bodies.iter_mut().filter(|body| body.count > 0.0) {
            body.centre /= body.count;
            body.velocity /= body.count;
        }
        for (at, (place, velocity)) in (0..).zip(positions.iter().zip(&*velocities)) {
            let body = &mut bodies[sets.find(at) as usize];
            let arm = triple(*place) - body.centre;
            body.inertia += Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            body.angular_momentum += arm.cross(&(triple(*velocity) - body.velocity));
        }
        bodies.iter_mut().filter(|body| body.count > 0.0).for_each(Body::find_turn);
        for (at, (place, velocity)) in (0..).zip(positions.iter().zip(velocities)) {
            let body = &bodies[sets.find(at) as usize];
            let rest = match body.turn {
                Some(turn) => triple(*velocity) - body.velocity - turn.cross(&(triple(*place) - body.centre)),
                None => Vector3::zeros(),
            };
            *velocity = [rest.x as f32, rest.y as f32, rest.z as f32, 0.0];
        }
    }
}

impl Body {
    fn find_turn(&mut self) {
        let mean = self.inertia.trace() / 3.0;
        let is_solid = self.inertia.determinant() > THINNEST * mean * mean * mean;
        self.turn =
            self.inertia.try_inverse().filter(|_| is_solid).map(|inverse| inverse * self.angular_momentum);
    }
}
