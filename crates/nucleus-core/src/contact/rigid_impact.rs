//! Impacts of bodies that keep their shape (`rigidity`): the whole body rebounds, not the points that touch.
//!
//! A rigid body that lands on one point rebounds by an impulse on all of it. If the velocity of that point alone were
//! reversed, its shape would undo it in the next step; and what the contact has pressed into the shape would throw the body
//! back whatever its `bounce`. The velocities of the body's best rigid motion therefore get the impulses of its contacts, by
//! sequential impulses on mass and moment of inertia (Catto 2005, *Iterative dynamics with temporal coherence*). Each contact's
//! accumulated tangential impulse is at most its friction times its accumulated normal impulse (Coulomb's law).
//!
//! How much of an impulse the whole takes follows from its shape's period: a body that would spring back within a film
//! frame takes all of it.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use crate::contact::response::{Impact, Restitution, TouchingPoint};
use crate::math::{Real, Row4, dot, sub};
use crate::schedule::{Schedule, WholeEffect, WholeSweep};
use crate::state::State;

/// Rounds of sequential impulses over the contacts of a body.
const ROUNDS: usize = 20;
/// Seconds within which a body that springs back looks rigid: a frame of film.
const IMPACT_DURATION: f64 = 1.0 / 24.0;
/// Share of a body's largest moment of inertia that each axis has at least: a straight line has none about itself.
const MIN_INERTIA: f64 = 1e-6;

/// The share of an impulse that the whole of a cloth takes, by its index; 0 without `rigidity`.
pub fn share_of_impact<R: Real>(schedule: &Schedule<R>, cloth: usize) -> f64 {
    let rigid = |whole: &WholeSweep| match whole.effect {
        WholeEffect::Shape(strength) if whole.cloth == cloth => Some(strength.rigid),
        _ => None,
    };
    let rigid = schedule.wholes.iter().find_map(rigid).unwrap_or(0.0);
    // The spring that moves a point by this share of its way in a step; an impact lasts for half of its period.
    let frequency = (rigid / (1.0 - rigid).max(f64::MIN_POSITIVE)).sqrt() / schedule.h;
    (frequency * IMPACT_DURATION / PI).min(1.0)
}

/// The best rigid motion of a body.
struct RigidMotion {
    centre: Vector3<f64>,
    velocity: Vector3<f64>,
    spin: Vector3<f64>,
    inverse_mass: f64,
    inverse_inertia: Matrix3<f64>,
}

/// A contact of a body.
struct RigidContact {
    normal: Vector3<f64>,
    /// From the centre of mass, in metres.
    arm: Vector3<f64>,
    /// The normal speed that the body shall have here at least, in m/s.
    least: f64,
    /// Sum of its normal impulses in N·s; contacts do not pull.
    impulse: f64,
    /// Velocity of the surface, in m/s.
    surface: Vector3<f64>,
    /// The sum of both frictions.
    friction: f64,
    /// Sum of its impulses along the surface, in N·s.
    tangential_impulse: Vector3<f64>,
}

/// Applies the impulses of what a body of these rows touches. Nothing changes where it touches nothing fast enough, or where
/// one of its points is pinned. `touches` are sorted by row.
pub fn rebound<R: Real>(
    state: &mut State<R>,
    rows: &[u32],
    touches: &[TouchingPoint<R>],
    restitution: Restitution<R>,
    share: f64,
) {
    let is_pinned = |row: &u32| state.displacement[*row as usize].0[3] <= R::ZERO;
    let is_hit = |touch: &TouchingPoint<R>| {
        let impact = Impact::of(state, touch.row as usize);
        let after = dot(touch.normal, sub(impact.velocity, touch.surface));
        impact.push_speed(touch.normal, restitution.h) - after > restitution.min_speed
    };
    // A body at rest costs no more than its touches.
    if !touches.iter().any(is_hit) || rows.iter().any(is_pinned) {
        return;
    }
    let pushes = push_velocities(state, touches, restitution.h);
    let mut motion = RigidMotion::new(state, rows, &pushes);
    let before = [motion.velocity, motion.spin];
    let mut contacts = Vec::with_capacity(touches.len());
    let mut is_impact = false;
    for touch in touches {
        let (contact, is_hit) = motion.contact_at(state, touch, restitution.min_speed.to_f64());
        contacts.push(contact);
        is_impact |= is_hit;
    }
    if !is_impact {
        return;
    }
    for _ in 0..ROUNDS {
        // Normal impulses go last: not to penetrate matters more than not to slide.
        contacts.iter_mut().for_each(|contact| motion.apply_friction(contact));
        contacts.iter_mut().for_each(|contact| motion.push(contact));
    }
    for (row, push) in pushes {
        add_velocity(state, row, -push * share);
    }
    let [velocity, spin] = [motion.velocity - before[0], motion.spin - before[1]];
    for &row in rows {
        let arm = Vector3::from(state.position(row)) - motion.centre;
        add_velocity(state, row, (velocity + spin.cross(&arm)) * share);
    }
}

impl RigidMotion {
    /// That of these rows, without the velocities that contacts gave to some of them.
    fn new<R: Real>(state: &State<R>, rows: &[u32], pushes: &[(u32, Vector3<f64>)]) -> Self {
        let mass = |row: u32| 1.0 / state.inverse_mass[row as usize].to_f64();
        let place = |row: u32| Vector3::from(state.position(row));
        let total: f64 = rows.iter().map(|&row| mass(row)).sum();
        let origin = place(rows[0]);
        let centre =
            rows.iter().map(|&row| (place(row) - origin) * mass(row)).sum::<Vector3<f64>>() / total + origin;
        let (mut momentum, mut turning, mut inertia) = (Vector3::zeros(), Vector3::zeros(), Matrix3::zeros());
        for &row in rows {
            let (arm, velocity) = (place(row) - centre, velocity_of(state, row));
            momentum += velocity * mass(row);
            turning += arm.cross(&velocity) * mass(row);
            inertia += (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * mass(row);
        }
        for &(row, push) in pushes {
            momentum -= push * mass(row);
            turning -= (place(row) - centre).cross(&push) * mass(row);
        }
        inertia += Matrix3::identity() * (inertia.trace() * MIN_INERTIA + f64::MIN_POSITIVE);
        let inverse_inertia = inertia.try_inverse().unwrap_or_default();
        let (velocity, spin) = (momentum / total, inverse_inertia * turning);
        Self { centre, velocity, spin, inverse_mass: 1.0 / total, inverse_inertia }
    }

    fn velocity_at(&self, arm: &Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.spin.cross(arm)
    }

    /// The contact of a point that touches, and whether it approaches faster than `min_speed`, in m/s.
    fn contact_at<R: Real>(
        &self,
        state: &State<R>,
        touch: &TouchingPoint<R>,
        min_speed: f64,
    ) -> (RigidContact, bool) {
        let [normal, surface] = [touch.normal, touch.surface].map(|row| Vector3::from(row.map(R::to_f64)));
        let arm = Vector3::from(state.position(touch.row)) - self.centre;
        let approach = normal.dot(&(surface - self.velocity_at(&arm)));
        let is_hit = approach > min_speed;
        let rebound = if is_hit { touch.coefficient.to_f64() * approach } else { -approach.max(0.0) };
        let least = normal.dot(&surface) + rebound;
        let (friction, tangential_impulse) = (touch.friction.to_f64(), Vector3::zeros());
        (RigidContact { normal, arm, least, impulse: 0.0, surface, friction, tangential_impulse }, is_hit)
    }

    /// One impulse of friction: against the sliding of the contact, within its friction cone.
    fn apply_friction(&mut self, contact: &mut RigidContact) {
        let RigidContact { normal, arm, surface, friction, .. } = *contact;
        if friction <= 0.0 {
            return;
        }
        let motion = self.velocity_at(&arm) - surface;
        let sliding = motion - normal * normal.dot(&motion);
        let lever = arm.cross(&sliding.try_normalize(0.0).unwrap_or_default());
        let mobility = self.inverse_mass + lever.dot(&(self.inverse_inertia * lever));
        let before = contact.tangential_impulse;
        contact.tangential_impulse = (before - sliding / mobility).cap_magnitude(friction * contact.impulse);
        let change = contact.tangential_impulse - before;
        self.velocity += change * self.inverse_mass;
        self.spin += self.inverse_inertia * arm.cross(&change);
    }

    /// One normal impulse of a contact.
    fn push(&mut self, contact: &mut RigidContact) {
        let RigidContact { normal, arm, least, impulse, .. } = contact;
        let lever = arm.cross(normal);
        let turn = self.inverse_inertia * lever;
        let mobility = self.inverse_mass + lever.dot(&turn);
        let wanted = (*least - normal.dot(&self.velocity_at(arm))) / mobility;
        let change = wanted.max(-*impulse);
        *impulse += change;
        self.velocity += *normal * (change * self.inverse_mass);
        self.spin += turn * change;
    }
}

/// The velocity in m/s that contact gave to each point that touches, along the normal of its first touch and by friction.
fn push_velocities<R: Real>(
    state: &State<R>,
    touches: &[TouchingPoint<R>],
    h: R,
) -> Vec<(u32, Vector3<f64>)> {
    let first_touches = touches.chunk_by(|a, b| a.row == b.row).map(|touches| touches[0]);
    let push = |touch: TouchingPoint<R>| {
        let impact = Impact::of(state, touch.row as usize);
        let speed = impact.push_speed(touch.normal, h).to_f64();
        let normal = Vector3::from(touch.normal.map(R::to_f64));
        let friction = touch.friction.to_f64();
        if friction <= 0.0 {
            return (touch.row, normal * speed);
        }
        // Along the surface constraints move a point too; friction had no more than its share of the push.
        let correction =
            Vector3::from(sub(impact.displacement, impact.predicted).map(R::to_f64)) / h.to_f64();
        let along = (correction - normal * speed).cap_magnitude(friction * speed.max(0.0));
        (touch.row, normal * speed + along)
    };
    first_touches.map(push).collect()
}

fn velocity_of<R: Real>(state: &State<R>, row: u32) -> Vector3<f64> {
    state.velocity[row as usize].xyz().map(R::to_f64).into()
}

fn add_velocity<R: Real>(state: &mut State<R>, row: u32, change: Vector3<f64>) {
    let [x, y, z] = (velocity_of(state, row) + change).into();
    state.velocity[row as usize] = Row4([x, y, z, 0.0].map(R::from_f64));
}
