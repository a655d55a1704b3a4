//! What a frame brings is looked at before it is used: a number that is none is held or left out, and counted,
//! so that one bad point does not cost the run.
//!
//! | What is no number, or farther than [`MAX_COORDINATE`] | What is done |
//! |---|---|
//! | a point of a collider | it stays where it was |
//! | an end of a pin's way | the other end; without one, the point is held where it is |
//! | gravity, wind, a force | left out |
//! | an input mesh | left out |
//! | any other attribute | takes its default |
//! | the length of the frame | the frame is not solved |

use std::borrow::Cow;

use nalgebra::Vector3;

use crate::input::frame::{ClothFrame, ColliderFrame, FrameInput, InputMesh, Pressure, ResistanceModel};
use crate::input::ids::{ClothId, ColliderId, PointId};
use crate::math::Real;
use crate::solver::Solver;

/// The farthest that anything may be from the origin, in metres, and the largest force, speed or acceleration:
/// squares of it, and the volumes that it spans, are still numbers in `f32`.
pub const MAX_COORDINATE: f64 = 1e12;

/// Something that a frame brought and that could not be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum InvalidInput {
    /// Where a point of a collider is.
    ColliderPoint(ColliderId, PointId),
    /// Where a collider is: not as many positions as it has points.
    ColliderMotion(ColliderId),
    /// Where a pin holds a point.
    Pin(ClothId, PointId),
    /// Positions of the input mesh of a cloth: not as many as it has points, or not finite. It attracts nothing in this frame.
    InputMesh(ClothId),
    /// An attribute of a cloth.
    Cloth(ClothId),
    /// An attribute of a collider.
    Collider(ColliderId),
    /// Gravity, wind, the ground plane or another setting of the solver.
    Setting,
    /// The length of the frame, which is not above nought.
    Duration,
}

/// How much of a frame could not be used, and the first of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sanitized {
    /// How many things.
    pub count: u64,
    /// The first of them.
    pub first: Option<InvalidInput>,
}

impl Sanitized {
    fn add(&mut self, what: InvalidInput) {
        self.count += 1;
        self.first = self.first.or(Some(what));
    }
}

/// Whether a position or force can be reckoned with.
pub fn is_usable(v: &Vector3<f64>) -> bool {
    v.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

impl<R: Real> Solver<R> {
    /// The frame as it can be used, and what of it could not. Copied only if there is something.
    pub(crate) fn usable<'f>(&self, frame: &'f FrameInput) -> (Cow<'f, FrameInput>, Sanitized) {
        let mut refusals = Sanitized::default();
        if self.is_all_usable(frame) {
            return (Cow::Borrowed(frame), refusals);
        }
        let mut frame = frame.clone();
        if !is_duration(frame.duration) {
            refusals.add(InvalidInput::Duration);
        }
        if mend_settings(&mut frame) {
            refusals.add(InvalidInput::Setting);
        }
        for (id, cloth) in (0..).map(ClothId).zip(&mut frame.cloths) {
            if mend_cloth(cloth) {
                refusals.add(InvalidInput::Cloth(id));
            }
        }
        for (id, collider) in (0..).map(ColliderId).zip(&mut frame.colliders) {
            self.mend_collider(id, collider, &mut refusals);
        }
        self.mend_pins(&mut frame, &mut refusals);
        let meshes = std::mem::take(&mut frame.input_meshes);
        let (usable, other): (Vec<_>, Vec<_>) =
            meshes.into_iter().partition(|mesh| self.is_mesh_usable(mesh));
        other.iter().for_each(|mesh| refusals.add(InvalidInput::InputMesh(mesh.cloth)));
        frame.input_meshes = usable;
        (Cow::Owned(frame), refusals)
    }

    fn is_all_usable(&self, frame: &FrameInput) -> bool {
        let whole = |(collider, state): (&ColliderFrame, &crate::contact::collider::ColliderState)| {
            let of_length = |column: &[Vector3<f64>]| column.is_empty() || column.len() == state.end.len();
            of_length(&collider.start)
                && of_length(&collider.end)
                && collider.start.iter().chain(&collider.end).all(is_usable)
                && !mend_collider_settings(&mut collider_settings(collider))
        };
        is_duration(frame.duration)
            && !mend_settings(&mut settings_of(frame))
            && !frame.cloths.iter().any(|cloth| mend_cloth(&mut cloth.clone()))
            && frame.colliders.iter().zip(&self.collider_states).all(whole)
            && frame.pins.iter().all(|pin| is_usable(&pin.start) && is_usable(&pin.end))
            && frame.input_meshes.iter().all(|mesh| self.is_mesh_usable(mesh))
    }

    fn is_mesh_usable(&self, mesh: &InputMesh) -> bool {
        let points = self.cloths[mesh.cloth.index()].points().len();
        let usable = |column: &[Vector3<f64>]| column.len() == points && column.iter().all(is_usable);
        usable(&mesh.start) && usable(&mesh.end)
    }

    fn mend_collider(&self, id: ColliderId, collider: &mut ColliderFrame, refusals: &mut Sanitized) {
        let state = &self.collider_states[id.index()];
        for column in [&mut collider.start, &mut collider.end] {
            if !column.is_empty() && column.len() != state.end.len() {
                column.clear();
                refusals.add(InvalidInput::ColliderMotion(id));
            }
            for (point, (place, before)) in (0..).map(PointId).zip(column.iter_mut().zip(&state.end)) {
                if !is_usable(place) {
                    *place = *before;
                    refusals.add(InvalidInput::ColliderPoint(id, point));
                }
            }
        }
        if mend_collider_settings(collider) {
            refusals.add(InvalidInput::Collider(id));
        }
    }

    fn mend_pins(&self, frame: &mut FrameInput, refusals: &mut Sanitized) {
        for pin in &mut frame.pins {
            let (start, end) = (is_usable(&pin.start), is_usable(&pin.end));
            if start && end {
                continue;
            }
            refusals.add(InvalidInput::Pin(pin.cloth, pin.point));
            let row = self.cloths[pin.cloth.index()].place(pin.point.index());
            let now = Vector3::from(self.state.position(row));
            (pin.start, pin.end) = match (start, end) {
                (true, _) => (pin.start, pin.start),
                (false, true) => (pin.end, pin.end),
                (false, false) => (now, now),
            };
        }
    }
}

fn is_duration(duration: f64) -> bool {
    duration > 0.0 && duration <= MAX_COORDINATE
}

/// A frame without its long columns.
fn settings_of(frame: &FrameInput) -> FrameInput {
    FrameInput {
        cloths: Vec::new(),
        colliders: Vec::new(),
        pins: Vec::new(),
        input_meshes: Vec::new(),
        ..*frame
    }
}

fn collider_settings(collider: &ColliderFrame) -> ColliderFrame {
    ColliderFrame { start: Vec::new(), end: Vec::new(), ..*collider }
}

/// Leaves out what cannot be used; whether there was anything.
fn mend_settings(frame: &mut FrameInput) -> bool {
    let mut mended = mend_vectors([&mut frame.gravity, &mut frame.wind]);
    mended |= mend_numbers([
        (&mut frame.air_density, 0.0),
        (&mut frame.collision_iterations, 1.0),
        (&mut frame.wind_noise, 0.0),
    ]);
    if let ResistanceModel::Physical { evaluations } = &mut frame.resistance {
        mended |= mend_numbers([(evaluations, 1.0)]);
    }
    if let Some(plane) = &mut frame.plane {
        mended |= mend_numbers([
            (&mut plane.bounce, 0.0),
            (&mut plane.friction, 0.0),
            (&mut plane.stickiness, 0.0),
        ]);
        if !is_usable(&plane.origin) || !is_usable(&plane.normal) {
            frame.plane = None;
            mended = true;
        }
    }
    mended
}

fn mend_cloth(cloth: &mut ClothFrame) -> bool {
    let usual = ClothFrame::default();
    let vectors = mend_vectors([&mut cloth.local_force, &mut cloth.local_wind]);
    let numbers = mend_numbers([
        (&mut cloth.stretch_resistance, usual.stretch_resistance),
        (&mut cloth.compression_resistance, usual.compression_resistance),
        (&mut cloth.shear_resistance, usual.shear_resistance),
        (&mut cloth.bend_resistance, usual.bend_resistance),
        (&mut cloth.rest_length_scale, usual.rest_length_scale),
        (&mut cloth.stretch_damp, usual.stretch_damp),
        (&mut cloth.damp, usual.damp),
        (&mut cloth.drag, usual.drag),
        (&mut cloth.tangential_drag, usual.tangential_drag),
        (&mut cloth.lift, usual.lift),
        (&mut cloth.thickness, usual.thickness),
        (&mut cloth.friction, usual.friction),
        (&mut cloth.stickiness, usual.stickiness),
        (&mut cloth.bounce, usual.bounce),
        (&mut cloth.collide_strength, usual.collide_strength),
        (&mut cloth.push_out.share, usual.push_out.share),
        (&mut cloth.push_out.radius, usual.push_out.radius),
        (&mut cloth.crossover_push, usual.crossover_push),
        (&mut cloth.self_crossover_push, usual.self_crossover_push),
        (&mut cloth.bending.angle_scale, usual.bending.angle_scale),
        (&mut cloth.bending.angle_dropoff, usual.bending.angle_dropoff),
        (&mut cloth.rigidity, usual.rigidity),
        (&mut cloth.deform_resistance, usual.deform_resistance),
        (&mut cloth.input_attract.strength, 0.0),
        (&mut cloth.input_attract.damp, 0.0),
        (&mut cloth.input_attract.motion_drag, 0.0),
    ]);
    let never = [&mut cloth.yield_strain, &mut cloth.bending.yield_sine].into_iter().filter(|x| x.is_nan());
    let yields = never.map(|x| *x = f64::INFINITY).count() > 0;
    vectors | numbers | yields | mend_pressure(&mut cloth.pressure)
}

fn mend_pressure(pressure: &mut Pressure) -> bool {
    match pressure {
        Pressure::Off => false,
        Pressure::Manual { pascals, damping } => mend_numbers([(pascals, 0.0), (damping, 0.0)]),
        Pressure::Gas { start, bulk, pump, tightness, damping, .. } => {
            mend_numbers([(start, 0.0), (bulk, 0.0), (pump, 0.0), (tightness, 1.0), (damping, 0.0)])
        }
    }
}

fn mend_collider_settings(collider: &mut ColliderFrame) -> bool {
    mend_numbers([
        (&mut collider.thickness, 0.0),
        (&mut collider.friction, 0.0),
        (&mut collider.stickiness, 0.0),
        (&mut collider.bounce, 0.0),
        (&mut collider.collide_strength, 1.0),
        (&mut collider.push_out.share, 0.0),
        (&mut collider.push_out.radius, 0.0),
    ])
}

fn mend_vectors<const N: usize>(vectors: [&mut Vector3<f64>; N]) -> bool {
    let bad = vectors.into_iter().filter(|vector| !is_usable(vector));
    bad.map(|vector| *vector = Vector3::zeros()).count() > 0
}

/// Each number with what it becomes if it cannot be used.
fn mend_numbers<const N: usize>(numbers: [(&mut f64, f64); N]) -> bool {
    let bad = numbers.into_iter().filter(|(number, _)| number.is_nan() || number.abs() > MAX_COORDINATE);
    bad.map(|(number, usual)| *number = usual).count() > 0
}
