//! Validation of attributes: every invalid number is replaced by its default.

use nalgebra::Vector3;

use crate::input::frame::{
    ClothFrame, ColliderFrame, ForceField, FrameInput, Liquid, Pressure, ResistanceModel, Stiffness,
};
use crate::input::object_fields::{PointField, WindField};

/// Largest distance from the origin in metres, and largest force, speed or acceleration in SI units: its square and the
/// volumes it spans are finite in `f32`.
pub const MAX_COORDINATE: f64 = 1e12;

/// Largest factor on a force, a strength or a length, and largest entry of a linear map.
pub const MAX_FACTOR: f64 = 1e6;

/// Least duration of a frame in seconds: velocities over the shortest step are finite in `f32`.
pub(super) const MIN_DURATION: f64 = 1e-12;

/// Limits of what a frame is divided into; more would never return. They are those of `subSteps` and `evaluations`.
pub(super) const MAX_SUBSTEPS: u32 = 100_000;
pub(super) const MAX_EVALUATIONS: f64 = 1e6;

/// Least distance of the particles of a liquid in metres.
pub(super) const MIN_SPACING: f64 = 1e-6;

/// Whether a frame can last so long, in seconds.
pub(super) fn is_duration(duration: f64) -> bool {
    (MIN_DURATION..=MAX_COORDINATE).contains(&duration)
}

/// Whether no component is NaN or beyond [`MAX_COORDINATE`].
pub fn is_in_range(v: &Vector3<f64>) -> bool {
    v.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

/// Replaces invalid settings of the solver; whether there were any.
pub(super) fn sanitize_settings(frame: &mut FrameInput) -> bool {
    let default = FrameInput::default();
    let mut replaced = sanitize_vectors([&mut frame.gravity, &mut frame.wind]);
    replaced |= sanitize_numbers([
        (&mut frame.air_density, 0.0),
        (&mut frame.collision_iterations, default.collision_iterations),
        (&mut frame.wind_noise, 0.0),
        (&mut frame.layer_range, default.layer_range),
        (&mut frame.self_collision_iterations, default.self_collision_iterations),
    ]);
    replaced |= raise_to_zero([&mut frame.air_density, &mut frame.wind_noise]);
    replaced |= frame.substeps > MAX_SUBSTEPS;
    frame.substeps = frame.substeps.min(MAX_SUBSTEPS);
    if let ResistanceModel::Physical { evaluations } = &mut frame.resistance {
        replaced |= sanitize_numbers([(evaluations, 1.0)]) || *evaluations > MAX_EVALUATIONS;
        *evaluations = evaluations.min(MAX_EVALUATIONS);
    }
    if let Some(plane) = &mut frame.plane {
        replaced |= sanitize_numbers([
            (&mut plane.bounce, 0.0),
            (&mut plane.friction, 0.0),
            (&mut plane.stickiness, 0.0),
        ]);
        replaced |= raise_to_zero([&mut plane.bounce, &mut plane.friction, &mut plane.stickiness]);
        if !is_plane(&plane.origin, &plane.normal) {
            frame.plane = None;
            replaced = true;
        } else if plane.start.is_some_and(|[origin, normal]| !is_plane(&origin, &normal)) {
            plane.start = None;
            replaced = true;
        }
    }
    replaced
}

fn is_plane(origin: &Vector3<f64>, normal: &Vector3<f64>) -> bool {
    is_in_range(origin) && is_in_range(normal) && *normal != Vector3::zeros()
}

pub(super) fn sanitize_cloth(cloth: &mut ClothFrame) -> bool {
    let vectors = sanitize_vectors([&mut cloth.local_force, &mut cloth.local_wind]);
    let numbers = sanitize_cloth_numbers(cloth);
    let below_zero = raise_cloth_to_zero(cloth);
    let tethers = cloth.tethers.as_mut().is_some_and(|scale| sanitize_numbers([(scale, 1.0)]));
    let fields = tethers
        | cloth.field.as_mut().is_some_and(sanitize_field)
        | cloth.point_field.as_mut().is_some_and(sanitize_point_field)
        | sanitize_wind_field(&mut cloth.wind_field)
        | sanitize_liquid(&mut cloth.liquid);
    let yields = sanitize_yields(cloth);
    vectors
        | numbers
        | below_zero
        | yields
        | fields
        | sanitize_stiffness(&mut cloth.stiffness)
        | sanitize_pressure(&mut cloth.pressure)
}

fn sanitize_cloth_numbers(cloth: &mut ClothFrame) -> bool {
    let default = ClothFrame::default();
    sanitize_numbers([
        (&mut cloth.stretch_resistance, default.stretch_resistance),
        (&mut cloth.compression_resistance, default.compression_resistance),
        (&mut cloth.shear_resistance, default.shear_resistance),
        (&mut cloth.bend_resistance, default.bend_resistance),
        (&mut cloth.rest_length_scale, default.rest_length_scale),
        (&mut cloth.stretch_damp, default.stretch_damp),
        (&mut cloth.damp, default.damp),
        (&mut cloth.conserve, default.conserve),
        (&mut cloth.rotation_friction, default.rotation_friction),
        (&mut cloth.rotation_damp, default.rotation_damp),
        (&mut cloth.overlap_pruning, default.overlap_pruning),
        (&mut cloth.drag, default.drag),
        (&mut cloth.tangential_drag, default.tangential_drag),
        (&mut cloth.lift, default.lift),
        (&mut cloth.thickness, default.thickness),
        (&mut cloth.friction, default.friction),
        (&mut cloth.stickiness, default.stickiness),
        (&mut cloth.bounce, default.bounce),
        (&mut cloth.collide_strength, default.collide_strength),
        (&mut cloth.layer, default.layer),
        (&mut cloth.push_out.share, default.push_out.share),
        (&mut cloth.push_out.radius, default.push_out.radius),
        (&mut cloth.crossover_push, default.crossover_push),
        (&mut cloth.self_crossover_push, default.self_crossover_push),
        (&mut cloth.bending.angle_scale, default.bending.angle_scale),
        (&mut cloth.bending.angle_dropoff, default.bending.angle_dropoff),
        (&mut cloth.rigidity, default.rigidity),
        (&mut cloth.deform_resistance, default.deform_resistance),
        (&mut cloth.input_attract.strength, 0.0),
        (&mut cloth.input_attract.damp, 0.0),
        (&mut cloth.input_attract.motion_drag, 0.0),
        (&mut cloth.self_collision.thickness, default.self_collision.thickness),
    ])
}

fn raise_cloth_to_zero(cloth: &mut ClothFrame) -> bool {
    raise_to_zero([
        &mut cloth.stretch_resistance,
        &mut cloth.compression_resistance,
        &mut cloth.shear_resistance,
        &mut cloth.bend_resistance,
        &mut cloth.rest_length_scale,
        &mut cloth.stretch_damp,
        &mut cloth.damp,
        &mut cloth.drag,
        &mut cloth.tangential_drag,
        &mut cloth.lift,
        &mut cloth.thickness,
        &mut cloth.friction,
        &mut cloth.stickiness,
        &mut cloth.bounce,
        &mut cloth.collide_strength,
        &mut cloth.rigidity,
        &mut cloth.deform_resistance,
        &mut cloth.input_attract.strength,
        &mut cloth.input_attract.damp,
        &mut cloth.self_collision.thickness,
    ])
}

/// Replaces numbers below zero by zero, of attributes that would create energy or push the wrong way below it.
fn raise_to_zero<const N: usize>(numbers: [&mut f64; N]) -> bool {
    let below = numbers.into_iter().filter(|number| **number < 0.0);
    below.map(|number| *number = 0.0).count() > 0
}

/// Without a valid limit nothing yields. One below zero would yield at rest; a link cannot be shorter than nothing.
fn sanitize_yields(cloth: &mut ClothFrame) -> bool {
    let bending = &mut cloth.bending;
    let limits = [&mut cloth.yield_strain, &mut bending.yield_sine, &mut bending.yield_half_angle];
    let invalid = limits.into_iter().filter(|limit| limit.is_nan() || **limit < 0.0);
    invalid.map(|limit| *limit = f64::INFINITY).count() > 0
}

/// Without a valid stiffness the resistance counts.
fn sanitize_stiffness(given: &mut Stiffness) -> bool {
    let Stiffness { stretch, compression, shear, bend, warp, weft } = given;
    let is_valid = |stiffness: &mut f64| stiffness.abs() <= MAX_COORDINATE;
    let all = [stretch, compression, shear, bend, warp, weft].into_iter();
    all.filter_map(|stiffness| stiffness.take_if(|given| !is_valid(given))).count() > 0
}

/// A liquid without a spacing is none.
fn sanitize_liquid(liquid: &mut Option<Liquid>) -> bool {
    let Some(settings) = liquid else { return false };
    let replaced = sanitize_numbers([
        (&mut settings.incompressibility, 1.0),
        (&mut settings.viscosity, 0.0),
        (&mut settings.surface_tension, 0.0),
    ]);
    let is_valid = (MIN_SPACING..=MAX_COORDINATE).contains(&settings.spacing);
    if !is_valid {
        *liquid = None;
    }
    replaced | !is_valid
}

fn sanitize_pressure(pressure: &mut Pressure) -> bool {
    match pressure {
        Pressure::Off => false,
        Pressure::Manual { pascals, damping } => sanitize_numbers([(pascals, 0.0), (damping, 0.0)]),
        Pressure::Gas { start, bulk, pump, tightness, damping, .. } => {
            sanitize_numbers([(start, 0.0), (bulk, 0.0), (pump, 0.0), (tightness, 1.0), (damping, 0.0)])
        }
    }
}

fn sanitize_field(field: &mut ForceField) -> bool {
    sanitize_samples(&mut field.falloff)
        | sanitize_numbers([(&mut field.magnitude, 0.0), (&mut field.distance, 0.0)])
}

fn sanitize_point_field(field: &mut PointField) -> bool {
    let PointField { magnitude, self_attract, radius, distance, falloff } = field;
    sanitize_samples(falloff)
        | sanitize_numbers([(magnitude, 0.0), (self_attract, 0.0), (radius, 0.0), (distance, 0.0)])
}

/// Where a falloff has no valid factor the field does not act.
fn sanitize_samples(samples: &mut [f64]) -> bool {
    let invalid = samples.iter_mut().filter(|sample| sample.is_nan() || sample.abs() > MAX_FACTOR);
    invalid.map(|sample| *sample = 0.0).count() > 0
}

fn sanitize_wind_field(field: &mut WindField) -> bool {
    let WindField { shadow_distance, shadow_diffusion, push_distance, push_vorticity, .. } = field;
    sanitize_numbers([
        (shadow_distance, 0.0),
        (shadow_diffusion, 0.0),
        (push_distance, 0.0),
        (push_vorticity, 0.0),
    ])
}

pub(super) fn sanitize_collider_settings(collider: &mut ColliderFrame) -> bool {
    let fields = collider.field.as_mut().is_some_and(sanitize_field)
        | collider.point_field.as_mut().is_some_and(sanitize_point_field)
        | sanitize_wind_field(&mut collider.wind_field);
    fields
        | sanitize_numbers([
            (&mut collider.thickness, 0.0),
            (&mut collider.friction, 0.0),
            (&mut collider.stickiness, 0.0),
            (&mut collider.bounce, 0.0),
            (&mut collider.collide_strength, 1.0),
            (&mut collider.layer, 0.0),
            (&mut collider.push_out.share, 0.0),
            (&mut collider.push_out.radius, 0.0),
        ])
        | raise_to_zero([
            &mut collider.thickness,
            &mut collider.friction,
            &mut collider.stickiness,
            &mut collider.bounce,
            &mut collider.collide_strength,
        ])
}

fn sanitize_vectors<const N: usize>(vectors: [&mut Vector3<f64>; N]) -> bool {
    let bad = vectors.into_iter().filter(|vector| !is_in_range(vector));
    bad.map(|vector| *vector = Vector3::zeros()).count() > 0
}

/// Replaces each invalid number by the default beside it; whether there were any.
pub(super) fn sanitize_numbers<const N: usize>(numbers: [(&mut f64, f64); N]) -> bool {
    let bad = numbers.into_iter().filter(|(number, _)| number.is_nan() || number.abs() > MAX_COORDINATE);
    bad.map(|(number, default)| *number = default).count() > 0
}
